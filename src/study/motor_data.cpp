#include "study/motor_data.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "wingbeat/core/status.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/parts/motor_thermal.hpp"

namespace wingbeat::detail {
namespace {

void check_range(const char* key, const char* unit, const std::optional<double>& x, bool zero_allowed = false) {
  if (x) require(zero_allowed ? *x >= 0.0 : *x > 0.0, key, zero_allowed ? "must be >= 0" : "must be > 0", unit, *x);
}

}  // namespace

const char* unit_of(DatumKind kind) {
  switch (kind) {
    case DatumKind::resistance: return "ohm";
    case DatumKind::torque_constant: return "N m/A";
    case DatumKind::speed_constant: return "rad/s/V";
    case DatumKind::no_load_speed:
    case DatumKind::point_speed: return "rad/s";
    case DatumKind::no_load_current:
    case DatumKind::stall_current:
    case DatumKind::point_current: return "A";
    case DatumKind::stall_torque:
    case DatumKind::friction_torque:
    case DatumKind::point_torque: return "N m";
    case DatumKind::viscous_damping: return "N m s/rad";
    case DatumKind::point_efficiency: return "1";
  }
  return "1";
}

void validate(const MotorDatasheet& s) {
  check_range("voltage", "V", s.voltage);
  check_range("no_load_speed", "rad/s", s.no_load_speed);
  check_range("no_load_current", "A", s.no_load_current);
  check_range("stall_torque", "N m", s.stall_torque);
  check_range("stall_current", "A", s.stall_current);
  check_range("resistance", "ohm", s.resistance);
  check_range("torque_constant", "N m/A", s.torque_constant);
  check_range("speed_constant", "rad/s/V", s.speed_constant);
  check_range("friction_torque", "N m", s.friction_torque);
  check_range("viscous_damping", "N m s/rad", s.viscous_damping);
  check_range("inductance", "H", s.inductance, true);
  check_range("rotor_inertia", "kg m2", s.rotor_inertia);
  check_range("mechanical_time_constant", "s", s.mechanical_time_constant);
  check_range("rotor_diameter", "m", s.rotor_diameter);
  check_range("rotor_length", "m", s.rotor_length);
  check_range("thermal_resistance_winding", "K/W", s.thermal_resistance_winding, true);
  check_range("thermal_resistance_case", "K/W", s.thermal_resistance_case, true);
  check_range("thermal_time_constant_winding", "s", s.thermal_time_constant_winding);
  check_range("thermal_time_constant_case", "s", s.thermal_time_constant_case);
  if (s.winding_temperature_max) {
    const ParameterRange& allowed = motor_thermal_key::winding_temperature_max.range;
    require(allowed.holds(*s.winding_temperature_max), "winding_temperature_max", allowed.expected, "K",
            *s.winding_temperature_max);
  }
  if (s.thermal_resistance_winding.has_value() != s.thermal_resistance_case.has_value()) {
    throw ParameterError(s.thermal_resistance_winding ? "thermal_resistance_case" : "thermal_resistance_winding",
                         "missing: give both thermal resistances, of winding and case, or neither");
  }
  if (!s.thermal_resistance_winding && !s.heating &&
      (s.winding_temperature_max || s.thermal_time_constant_winding || s.thermal_time_constant_case)) {
    throw ParameterError("thermal_resistance_winding", "missing: nothing can be said of the motor's heat without it");
  }
  require(s.gear_ratio > 0.0, "gear_ratio", "must be > 0", "1", s.gear_ratio);
  if (s.gear_efficiency) {
    require(*s.gear_efficiency > 0.0 && *s.gear_efficiency <= 1.0, "gear_efficiency", "must be > 0 and <= 1", "1",
            *s.gear_efficiency);
  }
  require(s.deviation > 0.0 && s.deviation < 1.0, "deviation", "must lie between 0 and 1", "1", s.deviation);
  const bool needs_voltage = s.no_load_speed || s.no_load_current || s.stall_torque || s.stall_current ||
                             std::any_of(s.points.begin(), s.points.end(), [](const auto& p) { return !p.voltage; });
  if (needs_voltage && !s.voltage) {
    throw ParameterError("voltage", "missing: no-load, stall and performance values hold at one voltage");
  }
  if (s.assume_steel_cylinder && !(s.rotor_diameter && s.rotor_length)) {
    throw ParameterError("fallback.inertia", "a solid steel cylinder needs rotor_diameter and rotor_length");
  }
  for (const MotorPoint& p : s.points) {
    if (!p.torque && !p.current) throw ParameterError("point", "needs a torque or a current");
    if (p.torque.has_value() + p.speed.has_value() + p.current.has_value() + p.efficiency.has_value() < 2) {
      throw ParameterError("point", "says nothing: give two or more of torque, speed, current, efficiency");
    }
  }
}

double deviation_in(const MotorDatasheet& s, const std::string& name) {
  const auto own = s.deviations.find(name);
  return own == s.deviations.end() ? s.deviation : own->second;
}

std::vector<Datum> data_of(const MotorDatasheet& s) {
  std::vector<Datum> data;
  const auto deviation_of = [&](const std::string& name) { return deviation_in(s, name); };
  const auto add = [&](const char* name, DatumKind kind, const std::optional<double>& value) {
    if (value) data.push_back({name, kind, *value, deviation_of(name), s.voltage.value_or(0.0)});
  };
  add("resistance", DatumKind::resistance, s.resistance);
  add("torque_constant", DatumKind::torque_constant, s.torque_constant);
  add("speed_constant", DatumKind::speed_constant, s.speed_constant);
  add("no_load_speed", DatumKind::no_load_speed, s.no_load_speed);
  add("no_load_current", DatumKind::no_load_current, s.no_load_current);
  add("stall_torque", DatumKind::stall_torque, s.stall_torque);
  add("stall_current", DatumKind::stall_current, s.stall_current);
  add("friction_torque", DatumKind::friction_torque, s.friction_torque);
  add("viscous_damping", DatumKind::viscous_damping, s.viscous_damping);
  int number = 0;
  for (const MotorPoint& p : s.points) {
    ++number;
    const double v = p.voltage.value_or(s.voltage.value_or(0.0));
    const bool by_torque = p.torque.has_value();
    const double load = by_torque ? *p.torque : *p.current;
    const auto of_point = [&](const char* what, DatumKind kind, const std::optional<double>& value) {
      if (!value) return;
      data.push_back({format("point %d %s", number, what), kind, *value, deviation_of("point"), v, load, by_torque});
    };
    of_point("speed", DatumKind::point_speed, p.speed);
    if (by_torque) of_point("current", DatumKind::point_current, p.current);
    of_point("efficiency", DatumKind::point_efficiency, p.efficiency);
  }
  return data;
}

}  // namespace wingbeat::detail

namespace wingbeat {

double without_rounding_errors(double x) {
  const double rounded = std::stod(detail::format("%.12g", x));
  return std::abs(rounded - x) <= 3e-13 * std::abs(x) ? rounded : x;
}

std::string datasheet_text(double x, std::string_view unit) {
  constexpr double rpm = 30.0 / std::numbers::pi;
  const std::tuple<std::string_view, double, const char*> shown[] = {
      {"rad/s", rpm, " rpm"},    {"rad/s/V", rpm, " rpm/V"}, {"N m", 1e3, " mN m"},
      {"N m/A", 1e3, " mN m/A"}, {"kg m2", 1e7, " g cm2"},   {"1", 1.0, ""}};
  for (const auto& [si, factor, name] : shown) {
    // Speeds are stated to whole revolutions.
    if (unit == si) return detail::format(factor == rpm ? "%.5g%s" : "%.4g%s", factor * x, name);
  }
  return detail::format("%.4g ", x) + std::string(unit);
}

}  // namespace wingbeat
