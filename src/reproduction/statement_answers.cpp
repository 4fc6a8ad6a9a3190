#include "reproduction/statement_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/study/reproduction.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/study/trend.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

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

/// A statement's quantity.
double quantity(const PublishedTrend& t, const Metrics<double>& m) {
  return t.share_of ? m[t.metric] / m[*t.share_of] : m[t.metric];
}

std::string shown_quantity(double x, const PublishedTrend& t) {
  return t.share_of ? percent(x) : shown(x, metric_info(t.metric).unit, is_efficiency(t.metric));
}

Metrics<double> no_metrics() {
  Metrics<double> none;
  none.values.fill(absent);
  return none;
}

Metrics<double> solved(const Design<double>& design, std::optional<double> frequency, Condition condition) {
  RunOptions options;
  options.condition = condition;
  options.tolerance = 1e-8;
  options.frequency = frequency;
  options.allow_extrapolation = true;  // the domain is assessed with the result, not by the search
  const RunResult run = run_design(design, options);
  const bool reached = !run.search || run.search->outcome == FrequencyOutcome::reached;
  if (run.status != FlappingStatus::flapping || !reached) return no_metrics();
  return limits_exceeded(run.domain).any() ? no_metrics() : run.metrics;
}

/// The design with the statement's quantity at `x`; nothing where that is no vehicle.
std::optional<Design<double>> design_at(const PublishedFile& file, const PublishedTrend& t, const std::string& name,
                                        std::optional<double> x) {
  Design<double> d = file.designs.at(name);
  d.supply = {SupplyType::constant, t.voltage.value_or(d.supply.voltage), 0.0, 1.0};
  if (!x) return d;
  if (t.hold_stroke) {
    const SliderCrank<double> crank = resolve(d).transmission.slider_crank;
    d.transmission.stroke_amplitude = std::atan(crank.crank_radius / crank.hinge_offset);
    d.transmission.hinge_offset.reset();
  }
  design_parameter(t.over).set(d, *x);
  try {
    validate(d);
  } catch (const ParameterError&) {
    return std::nullopt;
  }
  return d;
}

/// The designs of a statement.
class Asked {
 public:
  Asked(const PublishedFile& file, const PublishedTrend& statement, SolvedPoints& points)
      : file_(file), t_(statement), points_(points) {}

  std::optional<Design<double>> design(const std::string& name, std::optional<double> x) const {
    return design_at(file_, t_, name, x);
  }

  /// All absent where the design is no vehicle, and as SolvedPoints has it.
  Metrics<double> metrics(const std::optional<Design<double>>& d, std::optional<double> frequency,
                          Condition condition = Condition::air) const {
    return d ? points_.metrics(*d, frequency, condition) : no_metrics();
  }

  /// Along the statement's quantity: a frequency that is held, or a parameter of the vehicle.
  Metrics<double> along(const std::string& name, double x) const {
    return t_.over.empty() ? metrics(design(name, std::nullopt), x) : metrics(design(name, x), std::nullopt);
  }

  /// At the statement's operating point.
  Metrics<double> here(const std::string& name, Condition condition = Condition::air) const {
    return counted(
        metrics(design(name, t_.over.empty() ? std::nullopt : std::optional(t_.over_value)), t_.frequency, condition));
  }

  /// The metrics given, noted as what the answer rests on.
  Metrics<double> counted(const Metrics<double>& m) const {
    const double share = std::abs(residual_share(m));
    if (std::isfinite(share)) residual_ = std::isfinite(residual_) ? std::max(residual_, share) : share;
    return m;
  }
  double residual() const { return residual_; }

 private:
  mutable double residual_ = absent;
  const PublishedFile& file_;
  const PublishedTrend& t_;
  SolvedPoints& points_;
};

Answer extreme(const Asked& ask, const PublishedTrend& t) {
  const auto value = [&](double x) { return quantity(t, ask.along(t.design, x)); };
  const bool dip = t.kind == TrendKind::trough_at;
  const TrendPeak peak = dip ? dip_along(value, t.from, t.to) : highest_along(value, t.from, t.to);
  if (!std::isfinite(peak.argument)) return {absent, dip ? "no minimum" : "none flaps inside the domain"};
  ask.counted(ask.along(t.design, peak.argument));
  const std::string unit = t.over.empty() ? "Hz" : design_parameter(t.over).unit;
  const std::string location = readable(peak.argument, unit), reached = shown_quantity(peak.value, t);
  const bool height = t.kind == TrendKind::peak;
  std::string remark = height ? fmt::format("at {}", location) : reached;
  if (!peak.inside) {
    const double end = std::abs(peak.argument - t.to) < std::abs(peak.argument - t.from) ? t.to : t.from;
    const bool at_end = std::abs(peak.argument - end) < 1e-3 * (t.to - t.from);
    remark += at_end ? ", end of the range" : ", at the edge of flapping or of the domain";
  }
  if (dip) {
    // The dip is what a reader sees; an end of the range may lie lower.
    for (const double end : {t.from, t.to}) {
      if (value(end) < peak.value)
        remark += fmt::format("; {} at {}", shown_quantity(value(end), t), readable(end, unit));
    }
  }
  Answer answer{height ? peak.value : peak.argument, fmt::format("{} ({})", height ? reached : location, remark)};
  answer.place = peak.argument;
  answer.inside = peak.inside;
  return answer;
}

/// The range of held frequency, `width` wide, with equal values at both ends around the highest one.
Answer best_range(const Asked& ask, const PublishedTrend& t) {
  const auto design = ask.design(t.design, t.over.empty() ? std::nullopt : std::optional(t.over_value));
  const double width = *t.published_end - *t.published;
  const auto value = [&](double f) { return ask.metrics(design, f)[t.metric]; };
  const TrendPeak peak = highest_along(value, t.from, t.to, 13);
  if (!std::isfinite(peak.argument)) return {absent, "none flaps inside the domain"};
  const double low = std::max(t.from, peak.argument - width), high = std::min(peak.argument, t.to - width);
  double start = absent;
  if (peak.inside && low < high) {
    start = crossing_along([&](double f) { return value(f + width) - value(f); }, 0.0, low, high, 5);
  }
  if (!std::isfinite(start)) {
    ask.counted(ask.metrics(design, peak.argument));
    return {absent, fmt::format("no such range; highest at {}", readable(peak.argument, "Hz"))};
  }
  for (const double f : {start, start + width}) ask.counted(ask.metrics(design, f));
  Answer answer{start + 0.5 * width,
                fmt::format("{:.1f} to {:.1f} Hz (at least {} of the maximum of {}, which is at {})", start,
                            start + width, fmt::format("{:.1f} %", 100.0 * value(start) / peak.value),
                            percent(peak.value), readable(peak.argument, "Hz"))};
  answer.place = start;
  answer.inside = true;
  return answer;
}

Answer between(const Asked& ask, const PublishedTrend& t) {
  const auto peak = [&](Metric m) {
    return highest_along([&](double f) { return ask.along(t.design, f)[m]; }, t.from, t.to);
  };
  const TrendPeak system = peak(Metric::efficiency_system), motor = peak(Metric::efficiency_motor),
                  mechanism = peak(Metric::efficiency_mechanism);
  for (const TrendPeak& p : {system, motor, mechanism}) ask.counted(ask.along(t.design, p.argument));
  return {absent,
          fmt::format("system {}, motor {}{}, mechanism {}", readable(system.argument, "Hz"),
                      readable(motor.argument, "Hz"), motor.inside ? "" : " (end of the range)",
                      readable(mechanism.argument, "Hz")),
          (system.argument - motor.argument) * (system.argument - mechanism.argument) <= 0.0};
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
    const auto metric_at = [&, which = metric](double x) { return ask.counted(ask.along(t.design, x))[which]; };
    const double low = metric_at(t.from), mid = metric_at(t.over_value), high = metric_at(t.to);
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
  if (run.status != FlappingStatus::flapping) return {absent, "does not flap"};
  ask.counted(run.metrics);
  const WaveformRow* largest = &run.cycle.front();
  for (const WaveformRow& row : run.cycle) {
    if (row.lift > largest->lift) largest = &row;
  }
  return {absent, fmt::format("friction {:.1f} % of the motor output; {:.1f} deg",
                              100.0 * run.metrics[Metric::power_friction] / run.metrics[Metric::power_motor],
                              largest->angle_of_attack_deg)};
}

Answer of_number(double x, const PublishedTrend& t, bool share) { return {x, shown(x, t.unit, share)}; }

/// How the metric of the first design stands to that of the second along the range.
Answer compared_along(const Asked& ask, const PublishedTrend& t) {
  constexpr int samples = 81;
  const auto ratio = [&](double f) {
    return ask.along(t.design, f)[t.metric] / ask.along(*t.relative_to, f)[t.metric];
  };
  const auto place = [&](int n) { return t.from + (t.to - t.from) * n / (samples - 1); };
  const bool above = t.bound != PublishedTrend::Bound::below;
  int held = 0;
  for (int n = 0; n < samples; ++n) {
    const double x = ratio(place(n));
    held += above ? x > 1.0 : x < 1.0;
  }
  for (const double end : {t.from, t.to}) {
    for (const std::string& design : {t.design, *t.relative_to}) ask.counted(ask.along(design, end));
  }
  const double crossing = crossing_along(ratio, 1.0, t.from, t.to), low = ratio(t.from), high = ratio(t.to);
  const std::string where = std::isfinite(crossing) ? fmt::format("; equal at {}", readable(crossing, "Hz")) : "";
  if (t.kind == TrendKind::turns) {
    return {absent,
            fmt::format("{:+.1f} % at {}, {:+.1f} % at {}{}", 100.0 * (low - 1.0), readable(t.from, "Hz"),
                        100.0 * (high - 1.0), readable(t.to, "Hz"), where),
            low > 1.0 && high < 1.0};
  }
  return {absent,
          fmt::format("{} in {:.0f} % of {} to {}{}", above ? "higher" : "lower", 100.0 * held / samples,
                      readable(t.from, "Hz"), readable(t.to, "Hz"), where),
          2 * held > samples};
}

Answer ordered(const Asked& ask, const PublishedTrend& t) {
  constexpr std::pair<Condition, const char*> conditions[] = {
      {Condition::wingless, "without wings"}, {Condition::vacuum, "in vacuum"}, {Condition::air, "in air"}};
  Answer answer{absent, "", true};
  double before = -INFINITY;
  for (const auto& [condition, name] : conditions) {
    const double x = ask.here(t.design, condition)[t.metric];
    answer.text +=
        fmt::format("{}{} {}", answer.text.empty() ? "" : ", ", readable(x, metric_info(t.metric).unit), name);
    answer.holds = answer.holds && x > before;
    before = x;
  }
  return answer;
}

/// Of a difference, change or other number of one operating point.
Answer at_point(const Asked& ask, const PublishedTrend& t) {
  const Metrics<double> one = ask.here(t.design), other = t.relative_to ? ask.here(*t.relative_to) : one;
  const double x = number_of(t, one, other);
  const auto watts = [&](const Metrics<double>& m) { return shown_quantity(m[t.metric], t); };
  switch (t.kind) {
    case TrendKind::change:
      return {x, fmt::format("{:+#.4g} % ({} instead of {})", 100.0 * x, watts(one), watts(other))};
    case TrendKind::difference:
      if (!is_efficiency(t.metric)) return of_number(x, t, false);
      return {x, fmt::format("{:+.2f} percentage points, to {}", 100.0 * x, percent(one[t.metric]))};
    case TrendKind::power_balance: {
      const double left = one[Metric::power_motor] - one[Metric::power_friction];
      return {x, fmt::format("{:#.4g} ({} against {})", x, readable(left, "W"),
                             readable(one[Metric::power_aerodynamic], "W"))};
    }
    default: return of_number(x, t, is_efficiency(t.metric) || t.share_of.has_value());
  }
}

Answer answer_by(const Asked& ask, const PublishedFile& file, const PublishedTrend& t) {
  switch (t.kind) {
    case TrendKind::crossing: {
      const auto ratio = [&](double x) {
        return ask.along(t.design, x)[t.metric] / ask.along(*t.relative_to, x)[t.metric];
      };
      const double crossing = crossing_along(ratio, 1.0, t.from, t.to);
      if (!std::isfinite(crossing)) return {absent, "never"};
      for (const std::string& name : {t.design, *t.relative_to}) ask.counted(ask.along(name, crossing));
      Answer answer = of_number(crossing, t, false);
      answer.place = crossing;
      answer.inside = true;
      return answer;
    }
    case TrendKind::peak_at:
    case TrendKind::trough_at:
    case TrendKind::peak: return extreme(ask, t);
    case TrendKind::value:
    case TrendKind::change:
    case TrendKind::difference:
    case TrendKind::power_balance: return at_point(ask, t);
    case TrendKind::best_range: return best_range(ask, t);
    case TrendKind::between: return between(ask, t);
    case TrendKind::steadier: return steadier(ask, t);
    case TrendKind::saturates: return saturates(ask, t);
    case TrendKind::initial_guesses: return initial_guesses(ask, t);
    case TrendKind::generally:
    case TrendKind::turns: return compared_along(ask, t);
    case TrendKind::ordered_conditions: return ordered(ask, t);
    case TrendKind::constant_load_efficiency:
      return of_number(best_constant_load_efficiency(resolve(file.designs.at(t.design)).motor, *t.voltage), t, true);
    case TrendKind::spring_resonance: {
      const Vehicle<double> vehicle = resolve(file.designs.at(t.design));
      return of_number(std::sqrt(vehicle.spring.stiffness / vehicle.wing_inertia) / two_pi, t, false);
    }
    case TrendKind::weight:
      return of_number(total_mass(file.designs.at(t.design)).value_or(absent) * standard_gravity, t, false);
    case TrendKind::wording: return {absent, "not computed"};
    case TrendKind::best_friction_law: break;
  }
  return {};
}

}  // namespace

Metrics<double> SolvedPoints::metrics(const Design<double>& design, std::optional<double> frequency,
                                      Condition condition) {
  const std::string key = fmt::format("{} at {}, {}", write_design(design), frequency.value_or(0.0), int(condition));
  Point* point = nullptr;
  {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<Point>& entry = points_[key];
    if (!entry) entry = std::make_unique<Point>();
    point = entry.get();
  }
  std::call_once(point->solved, [&] { point->metrics = solved(design, frequency, condition); });
  return point->metrics;
}

Answer answer_to(const PublishedFile& file, const PublishedTrend& t, SolvedPoints& points) {
  const Asked ask(file, t, points);
  Answer answer = answer_by(ask, file, t);
  answer.residual = ask.residual();
  if (const std::string remark = residual_remark(answer.residual); !remark.empty()) answer.text += "; " + remark;
  return answer;
}

bool rests_on_points(const PublishedTrend& t) {
  return t.kind == TrendKind::value || t.kind == TrendKind::change || t.kind == TrendKind::difference ||
         t.kind == TrendKind::power_balance;
}

bool is_searched(const PublishedTrend& t) {
  return t.kind == TrendKind::peak_at || t.kind == TrendKind::trough_at || t.kind == TrendKind::peak ||
         t.kind == TrendKind::crossing || t.kind == TrendKind::best_range;
}

double searched_metric(const PublishedFile& file, const PublishedTrend& t, double x, SolvedPoints& points) {
  const Asked ask(file, t, points);
  if (t.kind == TrendKind::best_range) {
    return ask.metrics(ask.design(t.design, t.over.empty() ? std::nullopt : std::optional(t.over_value)), x)[t.metric];
  }
  if (t.kind == TrendKind::crossing) return ask.along(t.design, x)[t.metric] / ask.along(*t.relative_to, x)[t.metric];
  return quantity(t, ask.along(t.design, x));
}

std::vector<Design<double>> designs_of(const PublishedFile& file, const PublishedTrend& t) {
  const auto x = t.over.empty() ? std::nullopt : std::optional(t.over_value);
  std::vector<Design<double>> designs;
  for (const std::string& name : {t.design, t.relative_to.value_or("")}) {
    if (name.empty()) continue;
    const auto design = design_at(file, t, name, x);
    if (!design) return {};
    designs.push_back(*design);
  }
  return designs;
}

double number_of(const PublishedTrend& t, const Metrics<double>& one, const Metrics<double>& other) {
  switch (t.kind) {
    case TrendKind::change: return one[t.metric] / other[t.metric] - 1.0;
    case TrendKind::difference: return one[t.metric] - other[t.metric];
    case TrendKind::power_balance:
      return (one[Metric::power_motor] - one[Metric::power_friction]) / one[Metric::power_aerodynamic];
    default: return quantity(t, one);
  }
}

std::string residual_remark(double share) {
  return std::abs(share) > formulation_residual_max
             ? fmt::format("outside the domain, residual {:.1f} %", 100.0 * share)
             : "";
}

double residual_share(const Metrics<double>& m) { return m[Metric::power_residual] / m[Metric::power_electrical]; }

}  // namespace wingbeat
