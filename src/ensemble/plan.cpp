#include "ensemble/plan.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/solve/collocation.hpp"

namespace wingbeat {
namespace {

std::vector<DirectPackSettings> direct_plan_for(const EnsembleOptions& options) {
  const auto wanted = [&](Metric m) { return options.metrics[std::size_t(m)]; };
  DirectPackSettings s;
  s.current_peak = wanted(Metric::current_peak);
  s.exchanged_energy = wanted(Metric::power_reactive);
  s.lift_peak = wanted(Metric::lift_peak);
  s.velocity_peak = wanted(Metric::flapping_velocity_peak) || wanted(Metric::angle_of_attack_min);
  s.closed = std::clamp(0.1 * std::sqrt(options.tolerance), 1e-7, 1e-3);
  // What is read between the stages converges with the eighth power of the segments.
  const double segments = 4.0 * std::pow(1e-6 / options.tolerance, 0.125);
  std::vector<DirectPackSettings> plan;
  for (int n = std::max(4, int(std::ceil(segments))); n < max_direct_segments / 2; n *= 2) {
    s.segments = n;
    plan.push_back(s);
  }
  s.segments = max_direct_segments / 2;
  plan.push_back(s);
  return plan;
}

/// Where benchmarks/benchmark_ensemble is fastest on the reference box, for tolerances down to 10^-digits.
struct MeshOfTolerance {
  double digits;
  int segments, intervals, newton_iterations;
};
constexpr std::array meshes_by_tolerance = {
    MeshOfTolerance{3.5, 6, 4, 2},  MeshOfTolerance{4.5, 8, 4, 2},   MeshOfTolerance{5.5, 6, 6, 3},
    MeshOfTolerance{6.5, 8, 6, 3},  MeshOfTolerance{7.5, 10, 6, 4},  MeshOfTolerance{8.5, 8, 8, 4},
    MeshOfTolerance{9.5, 10, 8, 5}, MeshOfTolerance{10.5, 8, 10, 6}, MeshOfTolerance{12.0, 8, 12, 7}};

}  // namespace

double max_lag(double tolerance) { return 0.007 * std::min(std::sqrt(tolerance / 1e-6), 1.0); }

Plan plan_for(const EnsembleOptions& options) {
  const auto wanted = [&](Metric m) { return options.metrics[std::size_t(m)]; };
  Plan plan{};
  PackSettings& s = plan.first;
  const auto want = [&](Quantity q, bool on) { s.wanted[std::size_t(q)] = on; };
  const bool velocity =
      wanted(Metric::lift_peak) || wanted(Metric::flapping_velocity_peak) || wanted(Metric::angle_of_attack_min);
  want(Quantity::velocity, velocity);
  want(Quantity::current, wanted(Metric::current_peak));
  want(Quantity::force, wanted(Metric::rod_force_peak));
  want(Quantity::negated_speed, wanted(Metric::crank_speed_min));
  want(Quantity::speed, wanted(Metric::crank_speed_max));
  want(Quantity::energy, wanted(Metric::power_reactive));
  s.multipliers = wanted(Metric::floquet_multiplier_max);

  want(Quantity::velocity, velocity || options.domain);
  s.velocity_aside = options.domain && !velocity;
  const double digits = -std::log10(options.tolerance);
  const auto mesh = std::find_if(meshes_by_tolerance.begin(), meshes_by_tolerance.end() - 1,
                                 [&](const MeshOfTolerance& m) { return digits <= m.digits; });
  s.segments = mesh->segments;
  s.intervals = mesh->intervals;
  s.newton_iterations = mesh->newton_iterations;
  s.settled = 0.1 * options.tolerance;
  // The error of a segment's end off its sign change is of third order: at 1e-6 it does not count.
  s.follow_switches = digits > 6.5;
  s.coarse_iterates = 2;
  s.peak_tolerance = 0.5 * options.tolerance;

  PackSettings finer = s;
  finer.approach = PackApproach::resume;
  finer.implicit = true;
  for (PackSettings& again : plan.again) {
    ++finer.newton_iterations;
    finer.segments = std::min(finer.segments + 2, max_half_segments);
    again = finer;
    finer.intervals = std::min(finer.intervals + 2, solver::max_collocation_intervals);
  }
  PackSettings from_rest = s;
  from_rest.approach = PackApproach::from_rest;
  from_rest.newton_iterations += 1;
  from_rest.segments = max_half_segments;
  from_rest.implicit = true;
  for (PackSettings& start : plan.from_rest) {
    start = from_rest;
    from_rest.start_up_steps *= 4;
    from_rest.start_up_cycles = 100;  // near stall they take a hundred times as long as without load
  }
  plan.direct = direct_plan_for(options);
  return plan;
}

}  // namespace wingbeat
