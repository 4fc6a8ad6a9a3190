#include "wingbeat/report/describe.hpp"

#include <fmt/format.h>

#include <cmath>

#include "wingbeat/study/bench_fit.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/study/frequency_search.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

using Finding = SearchFinding::Kind;

/// "; below, it is locked (rests at ...)".
std::string below(const SearchFinding& f) {
  return fmt::format("; below, it is {} ({})", name_of(f.status), describe(f.evidence));
}

/// What grows with the voltage and is sought, in words.
struct RateWords {
  const char *unit, *name;
  const char *verb, *there;  ///< "it flaps at 5 Hz", "and there at 5 Hz"
};

/// Of a frequency or a power.
std::string describe_rate(const SearchFinding& f, const char* inside) {
  const bool power = f.sought == Sought::power;
  const RateWords words = power ? RateWords{"W", "electrical power", "takes", "takes"}
                                : RateWords{"Hz", "flapping frequency", "flaps at", "at"};
  const std::string cannot = fmt::format("{:.5g} {} cannot be reached", f.target, words.unit);
  const auto doing = [&](const SearchFinding::VoltagePoint& p) {
    return fmt::format("{} {:.4g} {}", words.verb, p.value, words.unit);
  };
  switch (f.kind) {
    case Finding::out_of_range: {
      const std::string why = f.range == SearchRange::domain
                                  ? describe(f.limits)
                                  : fmt::format("the angle of attack falls below {:.4g} deg", extrapolation_angle_deg);
      std::string text =
          fmt::format("{}{}: at {:.4g} V, where it {}, {}", cannot, inside, f.point->voltage, doing(*f.point), why);
      if (f.max_point) {
        text += fmt::format("; inside it {} at most, at {:.4g} V", doing(*f.max_point), f.max_point->voltage);
      }
      return text;
    }
    case Finding::beyond_any_voltage: {
      const bool domain = f.range == SearchRange::domain;
      return fmt::format(
          "{} {}: at a stroke amplitude of {:.4g} deg, whatever the voltage, wings that flap at more than {:.4g} Hz "
          "pass {}",
          cannot, domain ? "inside the domain of validity" : "in the range that is searched",
          degrees_per_radian * f.stroke_amplitude, f.highest_frequency,
          domain ? "an angle of attack of 0 deg or Mach 0.3" : "an angle of attack of -360 deg or Mach 3");
    }
    case Finding::jumps:
      return fmt::format(
          "at {0:.5g} V the {1} jumps from {2:.5g} {5} to {3:.5g} {5}: {4:.5g} {5} in between cannot be held",
          f.point->voltage, words.name, f.min_point->value, f.point->value, f.target, words.unit);
    case Finding::too_low_at_first:
      return fmt::format("{}: at {:.4g} V, the lowest voltage tried, it {} already", cannot, f.point->voltage,
                         doing(*f.point));
    case Finding::too_low_at_onset:
      return fmt::format("{}: from rest it flaps only above {:.4g} V, and there {} {:.4g} {} already", cannot,
                         f.point->voltage, words.there, f.point->value, words.unit) +
             below(f);
    case Finding::too_high:
      return fmt::format("{}: up to {:.4g} V it {} at most, at {:.4g} V", cannot, f.last_voltage, doing(*f.max_point),
                         f.max_point->voltage);
    default: return "";
  }
}

std::string describe_lift(const SearchFinding& f, const char* inside) {
  const std::string cannot = fmt::format("{:.5g} N cannot be reached", f.target);
  switch (f.kind) {
    case Finding::no_wings_in_air: return cannot + ": without wings in air there is no lift";
    case Finding::out_of_range:
      if (!f.max_point) {
        return fmt::format("{}{}: it leaves it at every voltage at which it flaps; at {:.4g} V {}", cannot, inside,
                           f.point->voltage, describe(f.limits));
      }
      return fmt::format(
          "{}{}: at {:.4g} V, where it lifts so much, {}; inside it lifts from {:.4g} N, at {:.4g} V, to {:.4g} N, at "
          "{:.4g} V",
          cannot, inside, f.point->voltage, describe(f.limits), f.min_point->value, f.min_point->voltage,
          f.max_point->value, f.max_point->voltage);
    case Finding::jumps:
      return fmt::format(
          "at {:.5g} V the mean lift jumps from {:.5g} N to {:.5g} N: {:.5g} N in between cannot be held",
          f.point->voltage, f.min_point->value, f.point->value, f.target);
    case Finding::too_low_at_first:
      return fmt::format("{}{}: at {:.4g} V, the lowest voltage tried, it lifts {:.4g} N already", cannot, inside,
                         f.point->voltage, f.point->value);
    case Finding::too_low_at_onset:
      return fmt::format("{}{}: from rest it flaps only above {:.4g} V, and there lifts {:.4g} N already", cannot,
                         inside, f.point->voltage, f.point->value) +
             below(f);
    case Finding::too_high:
      return fmt::format("{}{}: it lifts {:.4g} N at most, at {:.4g} V", cannot, inside, f.max_point->value,
                         f.max_point->voltage) +
             (f.limits.empty() ? fmt::format(" (voltages up to {:.4g} V)", f.last_voltage)
                               : fmt::format("; at {:.4g} V {}", f.last_voltage, describe(f.limits)));
    default: return "";
  }
}

}  // namespace

std::string describe(const SearchFinding& f) {
  const char* inside = f.range == SearchRange::domain         ? " inside the domain of validity"
                       : f.range == SearchRange::coefficients ? " where the force coefficients hold"
                                                              : "";
  std::string text;
  if (f.kind == Finding::reached) {
    text = describe(f.evidence);
  } else if (f.kind == Finding::never_flaps) {
    text = fmt::format("it flaps at no voltage up to {:.4g} V; there it is {}: {}", f.last_voltage, name_of(f.status),
                       describe(f.evidence));
  } else {
    text = f.sought == Sought::lift ? describe_lift(f, inside) : describe_rate(f, inside);
  }
  if (f.full_duty_voltage) text += fmt::format("; a duty of 1 gives {:.4g} V", *f.full_duty_voltage);
  return text;
}

std::string describe(const Hold& hold) {
  switch (hold.held) {
    case Held::lift: return fmt::format("mean lift held at {:.6g} mN", 1e3 * hold.value);
    case Held::lift_to_weight: return fmt::format("lift held at {:.6g} times the weight", hold.value);
    case Held::power: return fmt::format("electrical power held at {:.6g} mW", 1e3 * hold.value);
    default: return fmt::format("flapping held at {:.6g} Hz", hold.value);
  }
}

std::string describe(const RunResult& r) {
  if (r.search && r.search->outcome != FrequencyOutcome::reached) return describe(r.search->finding);
  std::string text = describe(r.evidence);
  if (r.mean_voltage) {
    text += fmt::format("; the orbit sees the mean voltage of the pwm supply, {:.4g} V", *r.mean_voltage);
    if (r.search && r.search->finding.sought == Sought::lift) {
      text += fmt::format(", at a duty of {:.6g}", r.design.supply.duty);
    }
  }
  if (r.search && r.design.supply.type == SupplyType::battery) {
    text += fmt::format("; the battery gives it at a duty of {:.6g}", r.design.supply.duty);
  }
  return text;
}

std::string describe(const DesignPoint& point) {
  if (!point.error.empty()) return point.error;
  return point.refused ? describe(*point.refused) : describe(point.evidence);
}

std::string describe(const UnreachedRow& row) { return row.refused ? describe(*row.refused) : describe(row.evidence); }

namespace {

/// How a flight ends.
std::string described_end(const EnduranceResult& r) {
  if (r.end == EnduranceEnd::never_starts) {
    return fmt::format("the battery cannot start the vehicle at a charge of {:.4g} ({:.4g} V without load): {}",
                       r.first_charge, r.first_voltage, describe(r.evidence));
  }
  if (r.rows.empty()) {
    return fmt::format("at full throttle, a charge of {:.4g} and {:.4g} V without load, {}", r.first_charge,
                       r.first_voltage, describe(r.evidence));
  }
  const EnduranceRow& last = r.rows.back();
  const double v = last.terminal_voltage;
  switch (r.end) {
    case EnduranceEnd::empty:
      return last.time > 0.0 ? fmt::format("the battery is empty after {:.4g} s", last.time)
                             : "the battery is empty from the start";
    case EnduranceEnd::cutoff:
      return last.time > 0.0
                 ? fmt::format(
                       "the terminal voltage falls to the cut-off voltage, {:.4g} V in all, after {:.4g} s, at a "
                       "charge of {:.4g}",
                       *r.cutoff_voltage, last.time, last.charge)
                 : fmt::format(
                       "the terminal voltage of {:.4g} V is not above the cut-off voltage, {:.4g} V in all, from the "
                       "start",
                       v, *r.cutoff_voltage);
    case EnduranceEnd::bridge: {
      const double amplitude = last.metrics[Metric::voltage];
      if (last.time > 0.0) {
        return fmt::format(
            "the battery's terminal voltage falls to the amplitude of the bridge's sine, {:.4g} V, after {:.4g} s, "
            "at a charge of {:.4g}",
            amplitude, last.time, last.charge);
      }
      if (std::isnan(v)) {
        return fmt::format("the battery cannot give the {:.4g} W that the bridge takes from it",
                           last.metrics[Metric::power_electrical]);
      }
      return fmt::format(
          "under load the battery gives the bridge {:.4g} V, less than the amplitude of its sine, {:.4g} V", v,
          amplitude);
    }
    case EnduranceEnd::stops:
      return fmt::format(
          "after {:.4g} s, at a charge of {:.4g} and {:.4g} V at the terminals, the battery no longer turns the crank",
          last.time, last.charge, v);
    case EnduranceEnd::sinks:
      return fmt::format("after {:.4g} s, at a charge of {:.4g}, full throttle no longer carries the weight", last.time,
                         last.charge);
    case EnduranceEnd::never_starts: break;
  }
  return "";
}

}  // namespace

std::string describe(const EnduranceResult& r) {
  const std::string end = described_end(r);
  if (r.rows.empty() && r.end == EnduranceEnd::sinks) {
    return fmt::format("it does not hover: full throttle lifts {:.4g} of the weight; {}", r.first_full_lift_to_weight,
                       end);
  }
  if (r.rows.empty() || !(r.endurance() > 0.0)) return end;
  const EnduranceRow& first = r.rows.front();
  const double lift_to_weight = first.metrics[Metric::lift_to_weight];
  switch (r.hover) {
    case Hover::unknown: return "the vehicle file gives no mass, so that hover is unknown; " + end;
    case Hover::never:
      return fmt::format("it does not hover: lift is {:.4g} of the weight at the start; {}", lift_to_weight, end);
    case Hover::outside:
      return fmt::format("it does not hover inside the model's domain ({}), though lift is {:.4g} times the weight; {}",
                         name_of(first.domain), lift_to_weight, end);
    case Hover::lost: {
      const EnduranceRow& lost = *r.hover_lost;
      const bool sinks = r.throttle == Throttle::fixed && std::abs(lost.metrics[Metric::lift_to_weight] - 1.0) < 1e-6;
      return fmt::format("it hovers for {:.4g} s, until {} at a charge of {:.4g}; {}", lost.time,
                         sinks ? "lift falls below the weight" : "it leaves the model's domain", lost.charge, end);
    }
    case Hover::kept:
      if (r.end == EnduranceEnd::sinks) {
        return fmt::format(
            "it hovers for {:.4g} s, until full throttle no longer carries the weight, at a charge of {:.4g}",
            r.endurance(), r.rows.back().charge);
      }
      return "it hovers until the flight ends; " + end;
  }
  return end;
}

}  // namespace wingbeat
