#include "wingbeat/study/optimise.hpp"

#include <algorithm>
#include <cmath>

#include "study/local_search.hpp"
#include "study/optimise_screen.hpp"
#include "study/optimum_neighbourhood.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using detail::feasible_to;
using detail::format;
using detail::LocalSearch;
using detail::Neighbourhood;
using detail::OptimiseProblem;
using detail::Vector;

std::string number(double x) { return format("%.6g", x); }

/// A study without parameters: the one design there is.
void assess(const OptimiseProblem& problem, OptimiseResult& result) {
  const OptimiseStudy& study = problem.study();
  const OptimiseProblem::Evaluation only = problem.evaluate(Vector(), false);
  result.evaluations = result.starts = 1;
  result.screen.status[std::size_t(only.point.status)] = 1;
  result.screen.closest.assign(study.constraints.size(), absent);
  result.screen.violated.assign(study.constraints.size(), 0);
  if (!only.flaps) {
    result.failed = 1;
    return;
  }
  if (!study.allow_extrapolation && only.point.domain.any()) {
    result.screen.outside = 1;
    for (std::size_t k = 0; k < result.screen.beyond.size(); ++k) result.screen.beyond[k] = only.point.domain[k];
  }
  for (std::size_t c = 0; c < study.constraints.size() && result.screen.outside == 0; ++c) {
    result.screen.violated[c] = only.constraints[Eigen::Index(c)] > feasible_to;
    result.screen.closest[c] = only.point.metrics[study.constraints[c].metric];
  }
  if (result.screen.outside == 0) {
    const GearTorque& torque = only.point.gear_torque;
    const GearTorqueLimits& limits = study.gear_torque;
    result.screen.torque_exceeded = {limits.continuous && torque.rms > *limits.continuous,
                                     limits.peak && torque.peak > *limits.peak};
  }
  if (only.violation() > feasible_to) {
    result.outcome = OptimiseResult::Outcome::infeasible;
    result.failed = 1;
    return;
  }
  result.outcome = OptimiseResult::Outcome::found;
  result.screen.feasible = 1;
  result.same = 1;
  result.point = only.point;
  result.design = problem.found(Vector(), only.point);
}

}  // namespace

std::string name_of(const MetricConstraint& c) {
  const char* key = metric_info(c.metric).key;
  return (c.part.empty() ? "" : c.part + ": ") + key + std::string(c.at_least ? " >= " : " <= ") + number(c.limit);
}

std::vector<std::string> limit_names(const GearTorqueLimits& limits) {
  std::vector<std::string> names;
  if (limits.continuous)
    names.push_back("continuous torque of the gearbox: rms <= " + number(*limits.continuous) + " N m");
  if (limits.peak) names.push_back("peak torque of the gearbox: <= " + number(*limits.peak) + " N m");
  return names;
}

std::vector<double> excess_of(const GearTorqueLimits& limits, const GearTorque& torque) {
  std::vector<double> excess;
  if (limits.continuous) excess.push_back(torque.rms / *limits.continuous - 1.0);
  if (limits.peak) excess.push_back(torque.peak / *limits.peak - 1.0);
  return excess;
}

std::string bound_of(DomainLimit limit, const Vehicle<double>& vehicle) {
  const WingLimits<double>& wings = vehicle.wing_limits;
  switch (limit) {
    case DomainLimit::angle_of_attack: return "angle_of_attack >= 0 deg";
    case DomainLimit::stroke: return "stroke <= " + number(stroke_max_deg(vehicle)) + " deg";
    case DomainLimit::formulation_residual:
      return "formulation_residual <= " + number(100.0 * formulation_residual_max) + " %";
    case DomainLimit::mechanism_efficiency: return "mechanism_efficiency <= 1";
    case DomainLimit::motor_efficiency: return "motor_efficiency <= 1";
    case DomainLimit::input_power: return "input_power > 0";
    case DomainLimit::flow_speed: return "flow_speed <= " + number(flow_speed_max) + " m/s";
    case DomainLimit::winding_temperature:
      return "winding_temperature <= " + number(vehicle.thermal.winding_temperature_max - zero_celsius) + " degC";
    case DomainLimit::reynolds_number:
      return "reynolds_number from " + number(wings.reynolds_number_min) + " to " + number(wings.reynolds_number_max);
    case DomainLimit::load_table: return "motion within the table of loads";
  }
  return "unknown";
}

OptimiseResult optimise(const OptimiseStudy& study, const StartUp& start_up, const ForEach& for_each) {
  OptimiseResult result;
  const OptimiseProblem problem(study, start_up);
  if (study.parameters.empty()) {
    assess(problem, result);
    return result;
  }
  const std::vector<Vector> ranked = detail::screened(problem, start_up, for_each, result.screen);

  std::vector<Vector> starts;
  const std::optional<Vector> given = problem.given();
  if (given && problem.evaluate(*given).flaps) starts.push_back(*given);
  for (const Vector& u : detail::spread(ranked, std::size_t(study.starts) - starts.size())) starts.push_back(u);
  if (starts.empty()) return result;

  std::vector<LocalSearch> searches(starts.size());
  const auto run = [&](std::size_t first, std::size_t last) {
    for_all(for_each, last - first, [&](std::size_t n) { searches[first + n].run(problem, starts[first + n]); });
  };
  // Where the screening found nothing within the constraints, a few searches tell whether there is anything at all.
  const std::size_t scouts = result.screen.feasible > 0 ? 0 : std::min<std::size_t>(4, starts.size());
  run(0, scouts);
  const auto found_one = [](const LocalSearch& s) { return s.feasible; };
  if (scouts > 0 && std::none_of(searches.begin(), searches.end(), found_one)) {
    searches.resize(scouts);
    starts.resize(scouts);
  } else {
    run(scouts, starts.size());
  }

  result.starts = int(starts.size());
  const LocalSearch* best = nullptr;
  const auto values = [&](const Vector& u) {
    std::vector<double> x;
    for (Eigen::Index k = 0; k < u.size(); ++k) x.push_back(problem.value(k, u[k]));
    return x;
  };
  const double sign = study.maximise ? -1.0 : 1.0;
  for (std::size_t n = 0; n < searches.size(); ++n) {
    const LocalSearch& s = searches[n];
    result.evaluations += s.evaluations;
    result.searches.push_back({values(starts[n]), s.feasible ? values(s.end) : std::vector<double>(), sign * s.began,
                               s.feasible ? sign * s.objective : absent, s.evaluations});
    if (s.feasible && (!best || s.objective < best->objective)) best = &s;
  }
  if (!best) {
    result.outcome = OptimiseResult::Outcome::infeasible;
    result.failed = result.starts;
    return result;
  }
  for (const LocalSearch& s : searches) {
    const bool same = s.feasible && s.objective - best->objective <= 1e-4 * std::abs(best->objective);
    (same ? result.same : s.feasible ? result.elsewhere : result.failed)++;
  }
  result.outcome = OptimiseResult::Outcome::found;
  for (Eigen::Index k = 0; k < problem.size(); ++k) result.parameters.push_back(problem.value(k, best->end[k]));
  result.point = problem.evaluate(best->end).point;
  result.design = problem.found(best->end, result.point);
  Neighbourhood around(problem, best->end, for_each, result.evaluations);
  result.active = around.active();
  result.directions = around.directions();
  return result;
}

}  // namespace wingbeat
