#include "study/motor_contradictions.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat::detail {
namespace {

/// Apart by more than contradiction_factor and three standard deviations, which are given for the logarithm.
bool is_gross(double ratio, double deviation) {
  return !(ratio > 0.0) || std::abs(std::log(ratio)) > std::log(contradiction_factor) + 3.0 * deviation;
}

}  // namespace

void find_contradictions(const std::string& constant_name, const std::string& unit,
                         const std::vector<Estimate>& estimates, std::vector<Contradiction>& out) {
  for (std::size_t a = 0; a < estimates.size(); ++a) {
    for (std::size_t b = a + 1; b < estimates.size(); ++b) {
      const double ratio = estimates[b].value / estimates[a].value, size = std::abs(ratio - 1.0);
      if (size > 5e-4) {
        out.push_back({constant_name, unit, estimates[a].source, estimates[b].source, estimates[a].value,
                       estimates[b].value, size,
                       is_gross(ratio, std::hypot(estimates[a].deviation, estimates[b].deviation))});
      }
    }
  }
}

void compare_ways(const MotorDatasheet& s, double friction_torque, double torque_factor,
                  std::vector<Contradiction>& out) {
  const double v = s.voltage.value_or(1.0);
  std::vector<Estimate> resistances, constants;
  const auto add = [&](std::vector<Estimate>& to, const char* source, double value,
                       std::initializer_list<const char*> rests_on) {
    double variance = 0.0;
    for (const char* name : rests_on) variance += square(deviation_in(s, name));
    to.push_back({source, value, std::sqrt(variance)});
  };
  if (s.resistance) add(resistances, "resistance", *s.resistance, {"resistance"});
  if (s.stall_current) add(resistances, "stall current", v / *s.stall_current, {"stall_current"});
  if (s.torque_constant) add(constants, "torque constant", *s.torque_constant, {"torque_constant"});
  if (s.speed_constant) add(constants, "speed constant", 1.0 / *s.speed_constant, {"speed_constant"});
  if (s.stall_torque && s.stall_current) {
    add(constants, "stall torque and current", (*s.stall_torque / torque_factor + friction_torque) / *s.stall_current,
        {"stall_torque", "stall_current"});
  }
  if (s.no_load_speed && !resistances.empty()) {
    const double i_0 = s.no_load_current.value_or(0.0);
    add(constants, "no-load speed", (v - resistances[0].value * i_0) / *s.no_load_speed, {"no_load_speed"});
  }
  if (!constants.empty() && s.stall_torque && !s.stall_current) {
    add(resistances, "stall torque", constants[0].value * v * torque_factor / *s.stall_torque, {"stall_torque"});
    resistances.back().deviation = std::hypot(resistances.back().deviation, constants[0].deviation);
  }
  find_contradictions("armature resistance", "ohm", resistances, out);
  find_contradictions("torque constant", "N m/A", constants, out);
  if (s.no_load_current && s.friction_torque && !constants.empty()) {
    find_contradictions(
        "friction torque", "N m",
        {{"friction torque", *s.friction_torque, deviation_in(s, "friction_torque")},
         {"no-load current", constants[0].value * *s.no_load_current, deviation_in(s, "no_load_current")}},
        out);
  }
}

void refuse_contradictions(const std::vector<Datum>& data, MotorIdentification& result) {
  const auto take_back = [](IdentifiedConstant& c) { c = {std::nullopt, 0.0, "contradicted"}; };
  const auto advice = [](const std::string& constants, const std::string& reason) {
    return constants + ": " + reason +
           "; correct the sheet, leave one of them out, or state in [deviation] how uncertain it is";
  };
  std::string electrical, inertia;
  for (const Contradiction& c : result.contradictions) {
    if (!c.gross) continue;
    const double factor = std::max(c.first_value / c.second_value, c.second_value / c.first_value);
    const std::string reason =
        format("%s and %s contradict each other about the %s by a factor of %.3g (%s and %s)", c.first.c_str(),
               c.second.c_str(), c.constant.c_str(), factor, datasheet_text(c.first_value, c.unit).c_str(),
               datasheet_text(c.second_value, c.unit).c_str());
    std::string& which = c.constant == "rotor inertia" ? inertia : electrical;
    if (which.empty()) which = reason;
  }
  for (const Datum& d : data) {
    const auto check = std::find_if(result.checks.begin(), result.checks.end(),
                                    [&](const DatasheetCheck& c) { return c.name == d.name; });
    if (!electrical.empty() || check == result.checks.end()) continue;
    if (!is_gross(check->identified / check->published, d.deviation)) continue;
    electrical = format("%s (%s) and the rest of the sheet (%s) contradict each other", detail::spaced(d.name).c_str(),
                        datasheet_text(check->published, check->unit).c_str(),
                        datasheet_text(check->identified, check->unit).c_str());
  }
  if (!electrical.empty()) {
    for (IdentifiedConstant* c :
         {&result.armature_resistance, &result.torque_constant, &result.viscous_damping, &result.friction_torque}) {
      take_back(*c);
    }
    result.missing.push_back(advice("armature resistance, torque constant and losses", electrical));
  }
  if (!inertia.empty()) {
    take_back(result.inertia);
    result.missing.push_back(advice("rotor inertia", inertia));
  }
}

}  // namespace wingbeat::detail
