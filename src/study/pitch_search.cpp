#include "study/pitch_search.hpp"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <string>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {
namespace {

/// Thrown through a search for a zero by a trial that has no angle of attack.
struct NoAngle {};

bool flaps_as_asked(const RunResult& r) {
  return std::isfinite(r.metrics[Metric::angle_of_attack_min]) &&
         (!r.search || r.search->outcome == FrequencyOutcome::reached);
}

void require_pitch_law(const Design<double>& design, const RunOptions& options) {
  const auto refuse = [](const char* why) { throw ParameterError("angle_of_attack", why); };
  if (!follows_pitch_law(design)) refuse("follows from the hinge or the torsion of these wings: no C_alpha is sought");
  if (design.aerodynamics.angle_of_attack_min) {
    refuse("is held by aerodynamics.angle_of_attack_min: no C_alpha is sought beside a stop");
  }
  if (options.condition != Condition::air) refuse("is that of wings in air");
  require(*options.angle_of_attack > 0.0 && *options.angle_of_attack < 0.5 * pi, "angle_of_attack", "must be > 0, < 90",
          "deg", degrees_per_radian * *options.angle_of_attack);
}

}  // namespace

PitchSearch find_pitch_coefficient(double given, double wanted, double tolerance,
                                   const std::function<double(double)>& angle_with) {
  bool leaves_range = false;
  const auto angle_at = [&](double C) {
    const double angle = angle_with(C);
    if (std::isnan(angle)) throw NoAngle();
    leaves_range = leaves_range || angle == below_range;
    return angle;
  };
  try {
    // The speed hardly depends on how the wings pitch: alpha = pi/2 - C_alpha |beta'| at the peak is near already.
    double C = given > 0.0 ? given : usual_pitch_coefficient;
    for (int n = 0; n < 3; ++n) {
      const double angle = angle_at(C);
      C *= angle == below_range ? 0.5 : (90.0 - wanted) / std::max(90.0 - angle, 1e-3);
    }
    const auto excess = [&](double log_C) { return angle_at(std::exp(log_C)) - wanted; };
    double low = std::log(C) - 0.01, high = std::log(C) + 0.01;
    double at_low = excess(low), at_high = excess(high);
    for (double step = 0.02; at_low < 0.0 && step < 4.0; step *= 2.0) at_low = excess(low -= step);
    for (double step = 0.02; at_high > 0.0 && step < 4.0; step *= 2.0) at_high = excess(high += step);
    if (at_low < 0.0 && leaves_range) return {PitchOutcome::left_range, 0.0};
    if (at_low < 0.0 || at_high > 0.0) return {PitchOutcome::impossible, 0.0};
    std::uintmax_t rounds = 60;
    const auto found = boost::math::tools::toms748_solve(
        excess, low, high, at_low, at_high, [&](double a, double b) { return b - a < 1e-2 * tolerance; }, rounds);
    // The smaller C_alpha of the last bracket, with which the angle does not leave the range.
    return {PitchOutcome::found, std::exp(found.first)};
  } catch (const NoAngle&) {
    return {PitchOutcome::no_angle, 0.0};
  }
}

bool leaves_angle_range(const SearchFinding& finding) {
  return std::any_of(finding.limits.begin(), finding.limits.end(),
                     [](const DomainEvidence& e) { return e.limit == DomainLimit::angle_of_attack; });
}

std::string no_pitch_coefficient(double angle) {
  return format("no C_alpha leads to %.4g deg at mid-stroke", degrees_per_radian * angle);
}

Design<double> with_pitch_coefficient(Design<double> design, double found) {
  design.aerodynamics.angle_of_attack.reset();
  design.aerodynamics.pitch_coefficient = found;
  return design;
}

RunResult run_at_angle_of_attack(Design<double> design, RunOptions options) {
  if (!options.angle_of_attack) options.angle_of_attack = design.aerodynamics.angle_of_attack;
  require_pitch_law(design, options);
  const double angle = *options.angle_of_attack;
  options.angle_of_attack.reset();
  RunOptions trial = options;
  trial.waveform_rows = 0;
  trial.endurance = false;
  RunResult without, left_range;
  const auto angle_with = [&](double C) {
    RunResult r = run_design(with_pitch_coefficient(design, C), trial);
    if (flaps_as_asked(r)) return r.metrics[Metric::angle_of_attack_min];
    // Where the angle falls below the coefficients' range before what else is asked for is reached, C_alpha is too
    // large.
    if (r.status != FlappingStatus::flapping || !r.search || !leaves_angle_range(r.search->finding)) {
      without = std::move(r);
      return absent;
    }
    left_range = std::move(r);
    return below_range;
  };
  const PitchSearch search = find_pitch_coefficient(design.aerodynamics.pitch_coefficient, degrees_per_radian * angle,
                                                    options.tolerance, angle_with);
  if (search.outcome == PitchOutcome::no_angle) return without;
  if (search.outcome == PitchOutcome::left_range) return left_range;
  if (search.outcome == PitchOutcome::impossible) throw ParameterError("angle_of_attack", no_pitch_coefficient(angle));
  RunResult result = run_design(with_pitch_coefficient(design, search.pitch_coefficient), options);
  if (flaps_as_asked(result)) result.pitch_coefficient = search.pitch_coefficient;
  return result;
}

}  // namespace wingbeat::detail
