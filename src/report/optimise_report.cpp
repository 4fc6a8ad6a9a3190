#include "wingbeat/report/optimise_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "report/report_tools.hpp"
#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

using detail::optimum_width, detail::parameter_text, detail::shown_unit, detail::with_unit;

/// "stroke_amplitude_rad <= 1.0472 (60 deg)"
std::string limit_text(const MetricConstraint& c) {
  const bool angle = std::string_view(metric_info(c.metric).unit) == "rad";
  return angle ? fmt::format("{} ({:.5g} deg)", name_of(c), degrees_per_radian * c.limit) : name_of(c);
}

/// A limit as it is read in the report: a parameter's bound in the unit of the table above it.
std::string limit_text(const OptimiseStudy& study, const ActiveLimit& a) {
  for (const OptimisedParameter& p : study.parameters) {
    for (const auto& [sense, bound] : {std::pair(" >= ", p.lower), std::pair(" <= ", p.upper)}) {
      if (!a.name.starts_with(p.parameter.key + sense)) continue;
      const detail::ShownUnit shown = shown_unit(p.parameter.unit);
      return fmt::format("{}{}{:.6g}{}", p.parameter.key, sense, shown.factor * bound, shown.suffix());
    }
  }
  for (const MetricConstraint& c : study.constraints) {
    if (a.name == name_of(c)) return limit_text(c);
  }
  return a.name;
}

/// What holds an optimum and how flat it is.
template <class Out>
void text_neighbourhood(Out& out, const OptimiseStudy& study, const OptimiseResult& r) {
  fmt::format_to(out, "\nWhat limits it{:>51}\n", "tightened by 1 %: worse by");
  for (const ActiveLimit& a : r.active) {
    const std::string worse = std::isfinite(a.sensitivity) ? fmt::format("{:.2g} %", a.sensitivity) : "-";
    fmt::format_to(out, "  {:<44}{:>18}\n", limit_text(study, a), worse);
  }
  if (r.active.empty()) fmt::format_to(out, "  no constraint and no bound: the optimum lies inside\n");
  if (std::any_of(r.active.begin(), r.active.end(), [](const ActiveLimit& a) { return a.domain; })) {
    fmt::format_to(out, "{}\n",
                   wrapped("  The model's domain limits this optimum: a better one would lie where the model no "
                           "longer holds.",
                           optimum_width, 2));
  }

  fmt::format_to(out, "\nHow flat it is: moving along each direction until the objective is {:g} % worse\n",
                 100.0 * flat_loss);
  if (r.directions.empty()) fmt::format_to(out, "  the active limits leave no freedom\n");
  int n = 0;
  for (const FlatDirection& d : r.directions) {
    fmt::format_to(out, "  direction {}, {:.0f} % of the bounds{}\n", ++n, 100.0 * d.width, d.flat ? ": FLAT" : "");
    for (std::size_t k = 0; k < study.parameters.size(); ++k) {
      const OptimisedParameter& p = study.parameters[k];
      // Only what moves visibly.
      if (std::abs(d.to[k] - d.from[k]) < 1e-3 * (p.upper - p.lower)) continue;
      const detail::ShownUnit shown = shown_unit(p.parameter.unit);
      fmt::format_to(out, "    {:<32}{:>13.5g} .. {:<.5g}{}\n", p.parameter.key, shown.factor * d.from[k],
                     shown.factor * d.to[k], shown.suffix());
    }
  }
}

}  // namespace

NothingFound nothing_found(const OptimiseStudy& study, const OptimiseResult& r) {
  return {r.outcome != OptimiseResult::Outcome::nothing_flaps, study.parameters.empty() ? 0 : study.screen,
          study.allow_extrapolation, study.constraints, r.screen};
}

NothingFound nothing_found(const ParetoStudy& study, const ParetoResult& r) {
  return {r.outcome != ParetoResult::Outcome::nothing_flaps, study.screen, study.allow_extrapolation, study.constraints,
          r.screen};
}

std::string describe(const NothingFound& n) {
  const ScreenCounts& screen = n.screen;
  if (!n.flaps) {
    std::string counts;
    for (int s = 1; s < sweep_status_count; ++s) {
      const std::uint64_t designs = screen.status[std::size_t(s)];
      if (designs > 0) counts += fmt::format("{}{} {}", counts.empty() ? ": " : ", ", designs, name_of(SweepStatus(s)));
    }
    return (n.screened > 0 ? fmt::format("none of {} designs within the bounds flaps", n.screened)
                           : std::string("the design does not flap")) +
           counts;
  }
  std::string text = n.screened == 0
                         ? std::string("the design flaps, but not ") +
                               (screen.outside > 0 ? "inside the model's domain" : "within every constraint")
                     : n.allow_extrapolation
                         ? "designs flap, but none within every constraint was found"
                         : "designs flap, but none inside the model's domain and within every constraint was found";
  if (screen.outside > 0) {
    std::string limits;
    for (std::size_t k = 0; k < screen.beyond.size(); ++k) {
      if (screen.beyond[k] == 0) continue;
      limits += fmt::format("{}{} {}", limits.empty() ? "" : ", ", screen.beyond[k], domain_limit_table()[k].key);
    }
    text += fmt::format("; {} of {} that flap are outside the model's domain ({})", screen.outside, screen.status[0],
                        limits);
  }
  for (std::size_t c = 0; c < n.constraints.size(); ++c) {
    if (screen.violated[c] == 0) continue;
    text +=
        fmt::format("; {}: {} of {} {} break it, the best of them reaches {}", limit_text(n.constraints[c]),
                    screen.violated[c], screen.status[0] - screen.outside, screen.outside > 0 ? "inside" : "that flap",
                    with_unit(screen.closest[c], metric_info(n.constraints[c].metric).unit));
  }
  if (screen.torque_exceeded[0] > 0) text += "; the rms torque exceeds the gearbox's continuous torque";
  if (screen.torque_exceeded[1] > 0) text += "; the peak torque exceeds the gearbox's";
  return text;
}

std::string text_optimum(const OptimiseFile& file, const OptimiseResult& r) {
  const OptimiseStudy& study = file.study;
  std::string text;
  auto out = std::back_inserter(text);
  if (!file.title.empty()) fmt::format_to(out, "{}\n", wrapped(file.title, optimum_width, 0));
  const MetricInfo& objective = metric_info(study.objective);
  std::string asked = fmt::format("{} {}", study.maximise ? "maximise" : "minimise", objective.key);
  std::vector<std::string> limits;
  for (const MetricConstraint& c : study.constraints) limits.push_back(limit_text(c));
  const std::vector<std::string> torques = limit_names(study.gear_torque);
  limits.insert(limits.end(), torques.begin(), torques.end());
  for (std::size_t l = 0; l < limits.size(); ++l) asked += (l == 0 ? " with " : ", ") + limits[l];
  if (study.options.hold) asked += "; " + describe(*study.options.hold);
  const bool of_parts = !torques.empty() || std::any_of(study.constraints.begin(), study.constraints.end(),
                                                        [](const MetricConstraint& c) { return !c.part.empty(); });
  text += of_parts ? wrapped(asked, optimum_width, 2) : asked;
  const std::uint64_t screened = std::accumulate(r.screen.status.begin(), r.screen.status.end(), std::uint64_t(0));
  fmt::format_to(out, "\nscreened {} designs: {} flap, {} of these within every constraint\n", screened,
                 r.screen.status[0], r.screen.feasible);
  if (r.screen.outside > 0) {
    fmt::format_to(out, "{} that flap are outside the model's domain and are excluded\n", r.screen.outside);
  }
  if (study.allow_extrapolation)
    fmt::format_to(out, "designs outside the model's domain count: extrapolation is allowed\n");
  if (r.outcome != OptimiseResult::Outcome::found) {
    fmt::format_to(out, "{}\n", wrapped("No design found: " + describe(nothing_found(study, r)), optimum_width, 2));
    return text;
  }
  fmt::format_to(out, "{} starts: {} ended in the best optimum, {} in a worse one, {} without a result\n\n", r.starts,
                 r.same, r.elsewhere, r.failed);
  fmt::format_to(out, "{} {}: {}\n", study.maximise ? "most" : "least", objective.long_name,
                 with_unit(r.point.metrics[study.objective], objective.unit));
  if (r.point.domain.any()) {
    fmt::format_to(
        out, "{}\n",
        wrapped(fmt::format("OUTSIDE THE MODEL'S DOMAIN ({}): these numbers are extrapolated", name_of(r.point.domain)),
                optimum_width, 2));
  }
  if (!study.parameters.empty()) {
    fmt::format_to(out, "\n{:<36}{:>13}{:>13}{:>13}\n", "Parameter", "optimum", "lower", "upper");
  }
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    const OptimisedParameter& p = study.parameters[k];
    const detail::ShownUnit shown = shown_unit(p.parameter.unit);
    fmt::format_to(out, "  {:<34}{:>13.5g}{:>13.5g}{:>13.5g}{}\n", p.parameter.key, shown.factor * r.parameters[k],
                   shown.factor * p.lower, shown.factor * p.upper, shown.suffix());
  }
  if (!study.parameters.empty()) text_neighbourhood(out, study, r);
  // The flight's throttle follows the weight; the cycle's metrics are those of the duty that is stated.
  const Supply<double>& supply = r.design.supply;
  const bool follows = supply.throttle == Throttle::hover && !study.options.hold;
  fmt::format_to(out, "\nThe design{}\n", follows ? fmt::format(" at a duty of {:.4g}", supply.duty) : "");
  for (const Metric m :
       {Metric::voltage, Metric::frequency, Metric::lift_to_weight, Metric::lift_mean, Metric::power_electrical,
        Metric::efficiency_system, Metric::current_peak, Metric::stroke_amplitude, Metric::rod_force_peak}) {
    if (!std::isfinite(r.point.metrics[m])) continue;
    fmt::format_to(out, "  {:<36}{}\n", metric_info(m).key, with_unit(r.point.metrics[m], metric_info(m).unit));
  }
  if (const GearTorque& torque = r.point.gear_torque; std::isfinite(torque.rms)) {
    fmt::format_to(out, "  {:<36}{} rms, {} peak\n", "torque behind the gearbox", with_unit(torque.rms, "N m"),
                   with_unit(torque.peak, "N m"));
  }
  return text;
}

std::string text_motors(const OptimiseFile& file, std::span<const MotorTrial> trials) {
  const OptimiseStudy& study = file.study;
  std::vector<const MotorTrial*> order;
  for (const MotorTrial& t : trials) order.push_back(&t);
  const auto rank = [&](const MotorTrial* t) {
    if (t->refused()) return std::pair(3, 0.0);
    if (t->result.outcome != OptimiseResult::Outcome::found) return std::pair(int(t->result.outcome), 0.0);
    return std::pair(0, (study.maximise ? -1.0 : 1.0) * t->result.point.metrics[study.objective]);
  };
  std::stable_sort(order.begin(), order.end(), [&](const auto* a, const auto* b) { return rank(a) < rank(b); });
  std::string text;
  auto out = std::back_inserter(text);
  const MotorTrial* best = best_trial(file, trials);
  fmt::format_to(out, "{:<30}{}\n", file.motors.empty() ? "Choice" : "Motor", metric_info(study.objective).key);
  for (const MotorTrial* t : order) {
    std::string what;
    if (t->refused()) {
      what = t->motor->refused;
    } else if (t->result.outcome != OptimiseResult::Outcome::found) {
      what = describe(nothing_found(trial_study(file, *t), t->result));
    } else {
      what = with_unit(t->result.point.metrics[study.objective], metric_info(study.objective).unit);
      for (std::size_t k = 0; k < study.parameters.size(); ++k) {
        const DesignParameter& p = study.parameters[k].parameter;
        what += fmt::format("; {} {}", p.key, parameter_text(t->result.parameters[k], p.unit));
      }
      if (t->motor) {
        for (const std::string& derived : t->motor->derived) what += "; " + derived;
      }
    }
    const std::string name = name_of(file, *t);
    if (name.size() > 29) fmt::format_to(out, "{}\n", name);
    // The name's columns are a stand-in while lines are broken.
    fmt::format_to(out, "{:<30}{}\n", name.size() > 29 ? "" : name,
                   wrapped(std::string(30, '_') + what, optimum_width, 30).substr(30));
  }
  if (!best) {
    return text + (file.motors.empty() ? "\nNone of the choices meets the constraints.\n"
                                       : "\nNo motor of the catalogue meets the constraints.\n");
  }
  OptimiseFile of_best = file;
  of_best.study = trial_study(file, *best);
  return text + "\nBest: " + name_of(file, *best) + "\n\n" + text_optimum(of_best, best->result);
}

}  // namespace wingbeat
