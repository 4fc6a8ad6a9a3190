// How often the truth lies inside the 95 % intervals of bench fits: every loss with every kind of stated deviation,
// under normal noise and, of robust losses, with outliers; intervals from the standard error and from the profile.
//   check_coverage [COUNT]        fits of each combination, 400 unless given
//     --loss NAME                 that loss alone
//     --loss-scale X              where it turns from square to robust
//     --threads T                 at once, 1 unless given
// Exit status 1 if a share lies outside 93 to 97 % by more than two of its standard errors, or a fit fails.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "study/coverage_bench.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/run/parallel.hpp"

using namespace wingbeat;

namespace {

struct Share {
  int inside = 0, all = 0;
  double value() const { return 100.0 * inside / all; }
};

}  // namespace

int main(int argc, char** argv) {
  std::size_t count = 400;
  int threads = 1;
  std::optional<std::string> only;
  double scale = BenchFit{}.loss_scale;
  for (int n = 1; n < argc; ++n) {
    const std::string option = argv[n];
    const auto next = [&] {
      if (n + 1 < argc) return std::string(argv[++n]);
      std::fprintf(stderr, "check_coverage: %s needs a value\n", option.c_str());
      std::exit(2);
    };
    if (option == "--loss") only = next();
    else if (option == "--loss-scale") scale = std::atof(next().c_str());
    else if (option == "--threads") threads = std::atoi(next().c_str());
    else if (std::atoi(option.c_str()) > 0) count = std::size_t(std::atoi(option.c_str()));
    else {
      std::fprintf(stderr, "check_coverage: unknown argument %s\n", option.c_str());
      return 2;
    }
  }
  const auto start = std::chrono::steady_clock::now();
  const CoverageBench bench;
  const double error = 100.0 * std::sqrt(0.95 * 0.05 / double(count));
  std::printf(
      "%zu fits each, of 32 values with normal noise of %.0f %%; a share of 95 %% has a standard error of %.1f %%\n\n",
      count, 100.0 * CoverageBench::noise, error);
  std::printf("%-9s%-16s%9s   %-24s%-24s\n", "", "", "", "friction.radius", "pitch_coefficient");
  std::printf("%-9s%-16s%9s   %-12s%-12s%-12s%-12s\n", "loss", "deviations", "outliers", "linear", "profile", "linear",
              "profile");
  int outside = 0, failed = 0;
  for (const auto& [loss_name, loss] : names_of<Loss>) {
    if (only && *only != loss_name) continue;
    for (const auto& [kind_name, kind] : names_of<StatedDeviations>) {
      for (const double outliers : {0.0, 0.05}) {
        if (outliers > 0.0 && loss == Loss::none) continue;
        std::vector<FitResult> results(count);
        std::vector<char> done(count, 0);
        for_each_in_parallel(
            count,
            [&, loss = loss, kind = kind](std::size_t n) {
              BenchFit fit = bench.fit(loss, kind, outliers, 1000 + n);
              fit.loss_scale = scale;
              try {
                results[n] = fit_bench(fit);
                done[n] = results[n].converged && !results[n].misfit;
              } catch (const std::exception& e) {
                std::fprintf(stderr, "%s, %s, fit %zu: %s\n", names_of<Loss>[int(loss)].first,
                             names_of<StatedDeviations>[int(kind)].first, n, e.what());
              }
            },
            threads);
        const std::vector<FreeParameter> parameters = bench.fit(loss, kind, 0.0, 1).parameters;
        std::vector<Share> linear(parameters.size()), profile(parameters.size());
        for (std::size_t n = 0; n < count; ++n) {
          failed += !done[n];
          if (!done[n]) continue;
          for (std::size_t k = 0; k < parameters.size(); ++k) {
            const FittedParameter& p = results[n].parameters[k];
            const double truth = bench.truth(parameters[k]);
            ++linear[k].all, ++profile[k].all;
            linear[k].inside += truth >= p.lower_95 && truth <= p.upper_95;
            profile[k].inside += truth >= p.profile_lower_95 && truth <= p.profile_upper_95;
          }
        }
        std::printf("%-9s%-16s%7.0f %%   ", loss_name, kind_name, 100.0 * outliers);
        for (std::size_t k = 0; k < parameters.size(); ++k) {
          for (const Share& share : {linear[k], profile[k]}) {
            const bool off = std::abs(share.value() - 95.0) > 2.0 + 2.0 * error;
            outside += off || share.all == 0;
            std::printf("%5.1f %%%-5s", share.value(), off ? " !" : "");
          }
        }
        std::printf("\n");
        std::fflush(stdout);
      }
    }
  }
  std::fprintf(stderr, "%.0f s\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  std::printf("\n%d outside 93 to 97 %% by more than two standard errors, %d fits without intervals\n", outside,
              failed);
  return outside + failed > 0 ? 1 : 0;
}
