// How far the metrics of random vehicles are from those of a far tighter tolerance, over the tolerance asked for:
//   benchmarks/accuracy orbit|transient|batched [VEHICLES] [TOLERANCE] [BOX] [SEED]
// VEHICLES of each box of tests/vehicle/wide_design.hpp (1000, 1e-6, all, 1 unless given). Exit status 1 if more than
// one vehicle in a thousand is off by more than the tolerance, or any by more than three times. With LIST in the
// environment, the worst of each box are listed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "vehicle/wide_design.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/time/transient.hpp"

using namespace wingbeat;

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Found {
  double off = 0.0;
  int metric = 0, number = 0;
  double multiplier = 0.0, multiplier_exact = 0.0, estimate = 0.0, seconds = 0.0;
  bool recomputed = false;
  std::string note;
};

struct Sums {
  int vehicles = 0, compared = 0, outside = 0, outside_three = 0, other = 0, longest = 0;
  double worst = 0.0, seconds = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
  const std::string solver = argc > 1 ? argv[1] : "orbit";
  const int count = argc > 2 ? std::atoi(argv[2]) : 1000;
  const double tolerance = argc > 3 ? std::atof(argv[3]) : 1e-6;
  const int only = argc > 4 ? std::atoi(argv[4]) : -1;
  const unsigned seed = argc > 5 ? unsigned(std::atoi(argv[5])) : 1;
  const bool list = std::getenv("LIST") != nullptr;
  std::printf(
      "| box | vehicles | compared | outside the tolerance | by three times | largest error / tolerance | metric | "
      "other orbits | s |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  Sums all;
  std::map<std::string, int> metrics_outside;
  for (int b = 0; b < int(wide_boxes.size()); ++b) {
    if (only >= 0 && b != only) continue;
    std::mt19937_64 random(seed);
    std::vector<Vehicle<double>> vehicles;
    std::vector<EnsembleMember> members;
    while (int(vehicles.size()) < count) {
      try {
        const Design<double> design = wide_design(WideBox(b), random);
        vehicles.push_back(resolve(design));
        members.push_back({vehicles.back(), reporting_of(design)});
      } catch (const ParameterError&) {}
    }
    Sums sums;
    sums.vehicles = count;
    std::vector<EnsembleOutcome> outcomes(members.size());
    if (solver == "batched") {
      EnsembleOptions options;
      options.tolerance = tolerance;
      const auto start = std::chrono::steady_clock::now();
      solve_ensemble(members, options, {}, outcomes);
      sums.seconds = seconds_since(start);
    }
    std::vector<Found> found;
    for (int n = 0; n < count; ++n) {
      const Vehicle<double>& v = vehicles[std::size_t(n)];
      const Reporting& reporting = members[std::size_t(n)].reporting;
      Found f;
      f.number = n;
      Metrics<double> got;
      if (solver == "batched") {
        const EnsembleOutcome& o = outcomes[std::size_t(n)];
        if (o.status != FlappingStatus::flapping) continue;
        got = o.metrics;
        f.estimate = o.error_estimate;
        f.recomputed = o.scalar;
      } else if (solver == "transient") {
        TransientOptions options;
        options.tolerance = tolerance;
        options.reporting = reporting;
        const auto start = std::chrono::steady_clock::now();
        const TransientResult r = simulate_start_up(v, options);
        f.seconds = seconds_since(start);
        sums.seconds += f.seconds;
        f.note = describe(r.evidence);
        if (r.status != FlappingStatus::flapping || !r.metrics) continue;
        got = *r.metrics;
      } else {
        const auto start = std::chrono::steady_clock::now();
        const SteadyFlapping r =
            find_steady_flapping(v, {.tolerance = tolerance, .stability = true, .reporting = reporting});
        f.seconds = seconds_since(start);
        sums.seconds += f.seconds;
        if (r.status != FlappingStatus::flapping) continue;
        got = r.metrics;
        f.estimate = r.summary.error_estimate;
        f.note = std::to_string(r.summary.iterates) + " iterates, " + std::to_string(r.summary.newton_steps) +
                 " Newton, " + std::to_string(r.summary.steps) + " steps";
      }
      const SteadyFlapping exact =
          find_steady_flapping(v, {.tolerance = 1e-12, .stability = true, .reporting = reporting});
      if (exact.status != FlappingStatus::flapping) {
        ++sums.other;
        if (list) std::printf("box %d number %d: not found at 1e-12: %s\n", b, n, describe(exact.evidence).c_str());
        continue;
      }
      f.multiplier = got[Metric::floquet_multiplier_max];
      f.multiplier_exact = exact.metrics[Metric::floquet_multiplier_max];
      if (solver != "orbit" && std::abs(got[Metric::frequency] / exact.metrics[Metric::frequency] - 1.0) > 1e-2) {
        ++sums.other;
        if (list) {
          std::printf("box %d number %d: frequency %g, exact %g, %s\n", b, n, got[Metric::frequency],
                      exact.metrics[Metric::frequency], f.note.c_str());
        }
        continue;
      }
      f.off = metrics_apart(got, exact.metrics, &f.metric) / tolerance;
      ++sums.compared;
      sums.longest = std::max(sums.longest, int(1e3 * f.seconds));
      if (!(f.off <= 1.0)) {
        ++sums.outside;
        ++metrics_outside[metric_table()[std::size_t(f.metric)].key];
        if (!(f.off <= 3.0)) ++sums.outside_three;
      }
      found.push_back(f);
    }
    std::sort(found.begin(), found.end(), [](const Found& x, const Found& y) { return x.off > y.off; });
    if (!found.empty()) sums.worst = found.front().off;
    std::printf("| %d %s | %d | %d | %d | %d | %.3g | %s | %d | %.2f (%d ms) |\n", b, wide_boxes[std::size_t(b)],
                sums.vehicles, sums.compared, sums.outside, sums.outside_three, sums.worst,
                found.empty() ? "" : metric_table()[std::size_t(found.front().metric)].key, sums.other, sums.seconds,
                sums.longest);
    std::fflush(stdout);
    if (list) {
      for (std::size_t k = 0; k < std::min<std::size_t>(found.size(), 8); ++k) {
        const Found& f = found[k];
        std::printf("   number %d: %.3g at %s, multiplier %.3g exact %.3g, estimate %.2g%s, %s\n", f.number, f.off,
                    metric_table()[std::size_t(f.metric)].key, f.multiplier, f.multiplier_exact, f.estimate,
                    f.recomputed ? " recomputed" : "", f.note.c_str());
      }
      double worst = 0.0, is = 0.0, should = 0.0;
      int worst_number = 0;
      for (const Found& f : found) {
        const double off = std::abs(f.multiplier - f.multiplier_exact) / std::max(1e-6, std::abs(f.multiplier_exact));
        if (!(off <= worst)) worst = off, worst_number = f.number, is = f.multiplier, should = f.multiplier_exact;
      }
      std::printf("   multiplier: worst %g, number %d: %g exact %g\n", worst, worst_number, is, should);
    }
    all.vehicles += sums.vehicles, all.compared += sums.compared, all.outside += sums.outside;
    all.outside_three += sums.outside_three, all.other += sums.other, all.seconds += sums.seconds;
    all.worst = std::max(all.worst, sums.worst);
  }
  std::printf("| all | %d | %d | %d | %d | %.3g | | %d | %.2f |\n", all.vehicles, all.compared, all.outside,
              all.outside_three, all.worst, all.other, all.seconds);
  for (const auto& [key, n] : metrics_outside) std::printf("  %s: %d\n", key.c_str(), n);
  return all.outside * 1000 > all.compared || all.outside_three > 0 ? 1 : 0;
}
