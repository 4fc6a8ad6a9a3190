// The batched solver on the reference box and on direct drives: designs a second on one core, the accuracy reached, and
// the distance to what the core's multipliers would allow.
//
//   benchmark_ensemble            every instruction set, four sets of metrics; tolerances; then what the recomputed
//                                 designs cost, and other kinds of vehicle
//   benchmark_ensemble SECONDS    measure each for that long (default 2)
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "ensemble_timing.hpp"
#include "vehicle/direct_design.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/study/run.hpp"

namespace {

using namespace wingbeat;

constexpr std::size_t design_count = 16384;
constexpr std::size_t checked_every = 8;
constexpr double tolerance = 1e-6;

std::vector<EnsembleMember> reference_box() {
  std::mt19937_64 random(20221);
  std::vector<EnsembleMember> members;
  for (std::size_t n = 0; n < design_count; ++n) {
    const Design<double> design = box_design(random);
    members.push_back({resolve(design), reporting_of(design)});
  }
  return members;
}

/// Direct drives without constant friction and pitch stop, whose equations are smooth between two reversals.
void measure_direct_drives(const StartUp& start_up, double seconds) {
  constexpr std::size_t sample_every = 32;
  constexpr double exact_tolerance = 1e-8;
  std::mt19937_64 random(20224);
  std::vector<EnsembleMember> members, sample;
  for (std::size_t n = 0; n < design_count; ++n) {
    const Design<double> design = smooth_direct_design(random);
    members.push_back({resolve(design), reporting_of(design)});
    if (n % sample_every == 0) sample.push_back(members.back());
  }
  EnsembleOptions options;
  options.scalar_only = true;
  options.tolerance = exact_tolerance;
  std::vector<EnsembleOutcome> expected(sample.size()), outcomes(members.size());
  solve_ensemble(sample, options, start_up, expected);
  options.tolerance = tolerance;
  options.metrics = wanted_sets()[2].metrics;
  const double scalar_time =
      best_time([&] { solve_ensemble(sample, options, start_up, std::span(outcomes).first(sample.size())); }, seconds) /
      double(sample.size());
  std::printf(
      "\ndirect drives, %zu designs, tolerance %g, one core; scalar solver %.0f designs/s; errors against it at "
      "%g, of %zu\n\n",
      design_count, tolerance, 1.0 / scalar_time, exact_tolerance, sample.size());
  std::printf("%-8s %-20s %10s %8s %10s %9s   %s\n", "isa", "metrics", "designs/s", "ratio", "recomputed", "statuses",
              "lift error 50 %, 99 %, 99.9 %; worst metric 99.9 %");
  options.scalar_only = false;
  for (const auto& [name, isa] : instruction_sets) {
    if (!is_available(isa)) continue;
    for (const Wanted& wanted : {wanted_sets()[1], wanted_sets()[3]}) {
      options.isa = isa;
      options.metrics = wanted.metrics;
      const double time = best_time([&] { solve_ensemble(members, options, start_up, outcomes); }, seconds);
      const Errors errors = errors_of(outcomes, expected, sample_every, wanted.metrics);
      const auto recomputed =
          std::count_if(outcomes.begin(), outcomes.end(), [](const EnsembleOutcome& out) { return out.scalar; });
      std::printf("%-8s %-20s %10.0f %8.1f %10td %9d   %.1e %.1e %.1e; %.1e\n", std::string(name).c_str(), wanted.name,
                  double(design_count) / time, scalar_time * double(design_count) / time, recomputed, errors.other,
                  quantile(errors.lift, 0.5), quantile(errors.lift, 0.99), quantile(errors.lift, 0.999),
                  quantile(errors.worst, 0.999));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 2.0;
  const std::vector<EnsembleMember> members = reference_box();
  const StartUp start_up = start_up_in_time();

  std::vector<EnsembleMember> checked;
  for (std::size_t n = 0; n < members.size(); n += checked_every) checked.push_back(members[n]);
  EnsembleOptions exact;
  exact.scalar_only = true;
  exact.tolerance = 1e-10;
  exact.metrics.reset(std::size_t(Metric::floquet_multiplier_max));
  std::vector<EnsembleOutcome> expected(checked.size());
  solve_ensemble(checked, exact, start_up, expected);

  // The rival: the same designs one by one.
  EnsembleOptions one_by_one;
  one_by_one.scalar_only = true;
  one_by_one.metrics.reset(std::size_t(Metric::floquet_multiplier_max));
  std::vector<EnsembleOutcome> outcomes(members.size());
  const double scalar_time =
      best_time([&] { solve_ensemble(checked, one_by_one, start_up, std::span(outcomes).first(checked.size())); },
                seconds) /
      double(checked.size());

  std::printf("reference box, %zu designs, tolerance %g, one core; scalar solver %.0f designs/s\n\n", design_count,
              tolerance, 1.0 / scalar_time);
  std::printf("%-8s %-20s %10s %8s %10s %9s   %s\n", "isa", "metrics", "designs/s", "ratio", "recomputed", "no flap",
              "lift error 50 %, 99 %, 99.9 %; worst metric 99.9 %");
  for (const auto& [name, isa] : instruction_sets) {
    if (!is_available(isa)) continue;
    for (const Wanted& wanted : wanted_sets()) {
      EnsembleOptions options;
      options.tolerance = tolerance;
      options.isa = isa;
      options.metrics = wanted.metrics;
      const double time = best_time([&] { solve_ensemble(members, options, start_up, outcomes); }, seconds);
      const Errors errors = errors_of(outcomes, expected, checked_every, wanted.metrics);
      int recomputed = 0, still = 0;
      for (const EnsembleOutcome& out : outcomes) {
        recomputed += out.scalar;
        still += out.status != FlappingStatus::flapping;
      }
      std::printf("%-8s %-20s %10.0f %8.1f %10d %9d   %.1e %.1e %.1e; %.1e\n", std::string(name).c_str(), wanted.name,
                  double(design_count) / time, scalar_time * double(design_count) / time, recomputed, still,
                  quantile(errors.lift, 0.5), quantile(errors.lift, 0.99), quantile(errors.lift, 0.999),
                  quantile(errors.worst, 0.999));
    }
  }

  std::printf("\npower and lift by tolerance, widest instruction set; outside and tenfold of %zu checked\n",
              checked.size());
  std::printf("%-10s %10s %10s %10s %10s   %s\n", "tolerance", "designs/s", "recomputed", "outside", "tenfold",
              "lift error 50 %, 99 %; worst metric 99 %");
  for (const double by_tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    EnsembleOptions options;
    options.tolerance = by_tolerance;
    options.metrics = wanted_sets()[1].metrics;
    const double time = best_time([&] { solve_ensemble(members, options, start_up, outcomes); }, seconds);
    const Errors errors = errors_of(outcomes, expected, checked_every, options.metrics);
    const auto beyond = [&](double limit) {
      return std::count_if(errors.worst.begin(), errors.worst.end(), [&](double e) { return e > limit; });
    };
    const auto recomputed =
        std::count_if(outcomes.begin(), outcomes.end(), [](const EnsembleOutcome& out) { return out.scalar; });
    std::printf("%-10g %10.0f %10td %10td %10td   %.1e %.1e; %.1e\n", by_tolerance, double(design_count) / time,
                recomputed, beyond(by_tolerance), beyond(10.0 * by_tolerance), quantile(errors.lift, 0.5),
                quantile(errors.lift, 0.99), quantile(errors.worst, 0.99));
  }

  EnsembleOptions options;
  options.tolerance = tolerance;
  options.metrics = wanted_sets()[1].metrics;
  const double whole = best_time([&] { solve_ensemble(members, options, start_up, outcomes); }, seconds);
  std::vector<EnsembleMember> batched;
  for (std::size_t n = 0; n < members.size(); ++n) {
    if (!outcomes[n].scalar) batched.push_back(members[n]);
  }
  const double without = best_time(
      [&] { solve_ensemble(batched, options, start_up, std::span(outcomes).first(batched.size())); }, seconds);
  std::printf("\npower and lift, without the %zu recomputed designs: %.0f designs/s, these take %.0f %% of the time\n",
              members.size() - batched.size(), double(batched.size()) / without, 1e2 * (1.0 - without / whole));

  // Real motors: stiff, for an explicit method.
  std::mt19937_64 random(20223);
  std::vector<EnsembleMember> coreless;
  for (std::size_t n = 0; n < design_count / 4; ++n) {
    const Design<double> design = coreless_design(random);
    coreless.push_back({resolve(design), reporting_of(design)});
  }
  const std::vector<EnsembleMember> some(coreless.begin(), coreless.begin() + std::ptrdiff_t(design_count / 16));
  const double one_by_one_time =
      best_time([&] { solve_ensemble(some, one_by_one, start_up, std::span(outcomes).first(some.size())); }, seconds);
  const double batched_time = best_time(
      [&] { solve_ensemble(coreless, options, start_up, std::span(outcomes).first(coreless.size())); }, seconds);
  const auto recomputed = std::count_if(outcomes.begin(), outcomes.begin() + std::ptrdiff_t(coreless.size()),
                                        [](const EnsembleOutcome& out) { return out.scalar; });
  std::printf("coreless motors, 1 us to 1 ms: %.0f designs/s, scalar %.0f; %td of %zu recomputed\n",
              double(coreless.size()) / batched_time, double(some.size()) / one_by_one_time, recomputed,
              coreless.size());
  measure_direct_drives(start_up, seconds);
  return 0;
}
