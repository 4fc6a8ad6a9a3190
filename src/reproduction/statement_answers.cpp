#include "reproduction/statement_answers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/study/reproduction.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/study/trend.hpp"

namespace wingbeat {
namespace {

using TrendKind = PublishedTrend::Kind;

/// The limits that a result must keep to count. The residual of the formulation is left out by name: what equation (1)
/// as printed does is itself under test; the answer says how large it is where it exceeds its limit.
DomainStatus limits_exceeded(DomainStatus status) {
  status.reset(std::size_t(DomainLimit::formulation_residual));
  return status;
}

std::string percent(double share) { return fmt::format("{:#.4g} %", 100.0 * share); }

std::string shown(double x, const std::string& unit, bool share) {
  if (!std::isfinite(x)) return "-";
  if (unit == "1") return share ? percent(x) : fmt::format("{:#.4g}", x);
  return readable(x, unit);
}

bool is_efficiency(Metric m) {
  return m == Metric::efficiency_system || m == Metric::efficiency_motor || m == Metric::efficiency_mechanism;
}

/// Runs the designs of a statement.
class Asked {
 public:
  Asked(const PublishedFile& file, const PublishedTrend& statement) : file_(file), t_(statement) {}

  /// The design with the statement's quantity at `x`; nothing where that is no vehicle.
  std::optional<Design<double>> design(const std::string& name, std::optional<double> x) const {
    Design<double> d = file_.designs.at(name);
    d.supply = {SupplyType::constant, t_.voltage.value_or(d.supply.voltage), 0.0, 1.0};
    if (!x) return d;
    if (t_.hold_stroke) {
      const SliderCrank<double> crank = resolve(d).transmission.slider_crank;
      d.transmission.stroke_amplitude = std::atan(crank.crank_radius / crank.hinge_offset);
      d.transmission.hinge_offset.reset();
    }
    design_parameter(t_.over).set(d, *x);
    try {
      validate(d);
    } catch (const ParameterError&) {
      return std::nullopt;
    }
    return d;
  }

  /// Metrics at a held frequency, or at the supply's voltage; all absent where it does not flap or leaves the domain.
  Metrics<double> metrics(const std::optional<Design<double>>& d, std::optional<double> frequency) const {
    Metrics<double> none;
    none.values.fill(absent);
    if (!d) return none;
    RunOptions options;
    options.tolerance = 1e-8;
    options.frequency = frequency;
    options.allow_extrapolation = true;  // the domain is assessed with the result, not by the search
    const RunResult run = run_design(*d, options);
    const bool reached = !run.search || run.search->outcome == FrequencyOutcome::reached;
    if (run.status != FlappingStatus::flapping || !reached) return none;
    return limits_exceeded(run.domain).any() ? none : run.metrics;
  }

  /// Along the statement's quantity: a frequency that is held, or a parameter of the vehicle. What was asked once is
  /// kept: several metrics are sought along the same samples.
  Metrics<double> along(const std::string& name, double x) const {
    const auto [entry, added] = known_.try_emplace({name, x});
    if (added) {
      entry->second = t_.over.empty() ? metrics(design(name, std::nullopt), x) : metrics(design(name, x), std::nullopt);
    }
    return entry->second;
  }

  /// At the statement's operating point.
  Metrics<double> here(const std::string& name) const {
    return metrics(design(name, t_.over.empty() ? std::nullopt : std::optional(t_.at)), t_.frequency);
  }

 private:
  const PublishedFile& file_;
  const PublishedTrend& t_;
  mutable std::map<std::pair<std::string, double>, Metrics<double>> known_;
};

/// Of a result beyond the limit of the formulation's residual.
std::string residual_remark(const Metrics<double>& m) {
  const double share = m[Metric::power_residual] / m[Metric::power_electrical];
  return std::abs(share) > formulation_residual_max
             ? fmt::format("outside the domain, residual {:.1f} %", 100.0 * share)
             : "";
}

Answer extreme(const Asked& ask, const PublishedTrend& t) {
  const auto value = [&](double x) { return ask.along(t.design, x)[t.metric]; };
  const bool dip = t.kind == TrendKind::trough_at;
  const TrendPeak peak = dip ? dip_along(value, t.from, t.to) : highest_along(value, t.from, t.to);
  if (!std::isfinite(peak.at)) return {absent, dip ? "no minimum" : "none flaps inside the domain", false};
  const std::string unit = t.over.empty() ? "Hz" : design_parameter(t.over).unit;
  const std::string at = readable(peak.at, unit);
  const std::string reached = shown(peak.value, metric_info(t.metric).unit, is_efficiency(t.metric));
  const bool height = t.kind == TrendKind::peak;
  std::string remark = height ? fmt::format("at {}", at) : reached;
  if (!peak.inside) {
    const double end = std::abs(peak.at - t.to) < std::abs(peak.at - t.from) ? t.to : t.from;
    const bool at_end = std::abs(peak.at - end) < 1e-3 * (t.to - t.from);
    remark += at_end ? ", end of the range" : ", at the edge of flapping or of the domain";
  }
  const std::string outside = residual_remark(ask.along(t.design, peak.at));
  if (!outside.empty()) remark += "; " + outside;
  return {height ? peak.value : peak.at, fmt::format("{} ({})", height ? reached : at, remark), false,
          !outside.empty()};
}

/// The range of held frequency, `width` wide, with equal values at both ends around the highest one.
Answer best_range(const Asked& ask, const PublishedTrend& t) {
  const auto design = ask.design(t.design, t.over.empty() ? std::nullopt : std::optional(t.at));
  const double width = *t.published_end - *t.published;
  const auto value = [&](double f) { return ask.metrics(design, f)[t.metric]; };
  const TrendPeak peak = highest_along(value, t.from, t.to, 13);
  if (!std::isfinite(peak.at)) return {absent, "none flaps inside the domain", false};
  const double low = std::max(t.from, peak.at - width), high = std::min(peak.at, t.to - width);
  double start = absent;
  if (peak.inside && low < high) {
    start = crossing_along([&](double f) { return value(f + width) - value(f); }, 0.0, low, high, 5);
  }
  if (!std::isfinite(start)) {
    return {absent, fmt::format("no such range; highest at {}", readable(peak.at, "Hz")), false};
  }
  return {start + 0.5 * width,
          fmt::format("{:.1f} to {:.1f} Hz (at least {} of the maximum of {}, which is at {})", start, start + width,
                      fmt::format("{:.1f} %", 100.0 * value(start) / peak.value), percent(peak.value),
                      readable(peak.at, "Hz")),
          false};
}

Answer between(const Asked& ask, const PublishedTrend& t) {
  const auto peak = [&](Metric m) {
    return highest_along([&](double f) { return ask.along(t.design, f)[m]; }, t.from, t.to);
  };
  const TrendPeak system = peak(Metric::efficiency_system), motor = peak(Metric::efficiency_motor),
                  mechanism = peak(Metric::efficiency_mechanism);
  return {absent,
          fmt::format("system {}, motor {}{}, mechanism {}", readable(system.at, "Hz"), readable(motor.at, "Hz"),
                      motor.inside ? "" : " (end of the range)", readable(mechanism.at, "Hz")),
          (system.at - motor.at) * (system.at - mechanism.at) <= 0.0};
}

Answer steadier(const Asked& ask, const PublishedTrend& t) {
  const auto fluctuation = [](const Metrics<double>& m) {
    return (m[Metric::crank_speed_max] - m[Metric::crank_speed_min]) / (two_pi * m[Metric::frequency]);
  };
  const auto one = ask.here(t.design), other = ask.here(*t.relative_to);
  const auto peak = Metric::flapping_velocity_peak;
  return {absent,
          fmt::format("fluctuation {:.3f} instead of {:.3f} of the mean speed; {:.1f} instead of {:.1f} rad/s",
                      fluctuation(one), fluctuation(other), one[peak], other[peak]),
          fluctuation(one) < fluctuation(other) && one[peak] > other[peak]};
}

Answer saturates(const Asked& ask, const PublishedTrend& t) {
  Answer answer{absent, "", true};
  for (const auto& [metric, name] :
       {std::pair(Metric::lift_mean, "lift"), std::pair(Metric::efficiency_system, "efficiency")}) {
    const double low = ask.along(t.design, t.from)[metric], mid = ask.along(t.design, t.at)[metric],
                 high = ask.along(t.design, t.to)[metric];
    answer.text += fmt::format("{}{} {:+.1f} % above, {:+.1f} % below", answer.text.empty() ? "" : "; ", name,
                               100.0 * (high / mid - 1.0), 100.0 * (mid / low - 1.0));
    answer.holds = answer.holds && high / mid < mid / low;
  }
  return answer;
}

Answer initial_guesses(const Asked& ask, const PublishedTrend& t) {
  const auto design = ask.design(t.design, std::nullopt);
  RunOptions options;
  options.tolerance = 1e-8;
  options.waveform_rows = 721;
  const RunResult run = run_design(*design, options);
  if (run.status != FlappingStatus::flapping) return {absent, "does not flap", false};
  const WaveformRow* largest = &run.cycle.front();
  for (const WaveformRow& row : run.cycle) {
    if (row.lift > largest->lift) largest = &row;
  }
  return {absent,
          fmt::format("friction {:.1f} % of the motor output; {:.1f} deg",
                      100.0 * run.metrics[Metric::power_friction] / run.metrics[Metric::power_motor],
                      largest->angle_of_attack_deg),
          false};
}

Answer of_number(double x, const PublishedTrend& t, bool share) { return {x, shown(x, t.unit, share), false}; }

}  // namespace

Answer answer_to(const PublishedFile& file, const PublishedTrend& t) {
  const Asked ask(file, t);
  switch (t.kind) {
    case TrendKind::crossing: {
      const auto ratio = [&](double x) {
        return ask.along(t.design, x)[t.metric] / ask.along(*t.relative_to, x)[t.metric];
      };
      const double at = crossing_along(ratio, 1.0, t.from, t.to);
      return std::isfinite(at) ? of_number(at, t, false) : Answer{absent, "never", false};
    }
    case TrendKind::peak_at:
    case TrendKind::trough_at:
    case TrendKind::peak: return extreme(ask, t);
    case TrendKind::value: {
      const Metrics<double> m = ask.here(t.design);
      Answer answer = of_number(m[t.metric], t, is_efficiency(t.metric));
      if (const std::string remark = residual_remark(m); !remark.empty()) {
        answer.text += fmt::format(" ({})", remark);
        answer.outside = true;
      }
      return answer;
    }
    case TrendKind::change:
      return of_number(ask.here(t.design)[t.metric] / ask.here(*t.relative_to)[t.metric] - 1.0, t, true);
    case TrendKind::difference: {
      const double one = ask.here(t.design)[t.metric], other = ask.here(*t.relative_to)[t.metric];
      if (!is_efficiency(t.metric)) return of_number(one - other, t, false);
      return {one - other, fmt::format("{:+.2f} percentage points, to {}", 100.0 * (one - other), percent(one)), false};
    }
    case TrendKind::best_range: return best_range(ask, t);
    case TrendKind::power_balance: {
      const Metrics<double> m = ask.here(t.design);
      const double left = m[Metric::power_motor] - m[Metric::power_friction], air = m[Metric::power_aerodynamic];
      return {left / air, fmt::format("{:#.4g} ({} against {})", left / air, readable(left, "W"), readable(air, "W")),
              false};
    }
    case TrendKind::between: return between(ask, t);
    case TrendKind::steadier: return steadier(ask, t);
    case TrendKind::saturates: return saturates(ask, t);
    case TrendKind::initial_guesses: return initial_guesses(ask, t);
    case TrendKind::constant_load_efficiency:
      return of_number(best_constant_load_efficiency(resolve(file.designs.at(t.design)).motor, *t.voltage), t, true);
    case TrendKind::spring_resonance: {
      const Vehicle<double> vehicle = resolve(file.designs.at(t.design));
      return of_number(std::sqrt(vehicle.spring.stiffness / vehicle.wing_inertia) / two_pi, t, false);
    }
    case TrendKind::weight:
      return of_number(total_mass(file.designs.at(t.design)).value_or(absent) * standard_gravity, t, false);
    case TrendKind::best_friction_law: break;
  }
  return {};
}

}  // namespace wingbeat
