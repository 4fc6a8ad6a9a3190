#include "wingbeat/study/scaling.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include "wingbeat/core/status.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

/// Of quantities with the dimensions of a unit, at constant density, stress, speed and voltage.
int exponent_of_unit(std::string_view unit) {
  constexpr std::pair<std::string_view, int> exponents[] = {
      {"1", 0},     {"rad", 0},     {"m", 1},   {"m2", 2},    {"m4", 4},    {"m5", 5},        {"m2/s", 1},
      {"s", 1},     {"Hz", -1},     {"kg", 3},  {"kg/m", 2},  {"kg/m2", 1}, {"kg/m3", 0},     {"kg m2", 5},
      {"N m", 3},   {"N m/rad", 3}, {"N/m", 1}, {"N s/m", 2}, {"N/V", 2},   {"N m s/rad", 4}, {"N m s2/rad2", 5},
      {"N m/A", 1}, {"V", 0},       {"1/V", 0}, {"A", 2},     {"ohm", -2},  {"H", -1},        {"C", 3},
      {"F", 3},     {"J/kg", 0},    {"K", 0},   {"1/K", 0},   {"K/W", -2},  {"rad/m", -1},    {"rad/m3", -3}};
  for (const auto& [known, exponent] : exponents) {
    if (known == unit) return exponent;
  }
  throw ParameterError("scale", "knows no law for the unit " + std::string(unit));
}

int exponent_of(const ParameterText& parameter) {
  if (parameter.path == "aerodynamics.kinematic_viscosity") return 0;
  if (parameter.path == "motor.armature_resistance") return -3;
  return exponent_of_unit(parameter.unit);
}

bool is_of_wing(std::string_view path) {
  // The stiffness of hinges belongs to what drives the wings, the distance between them to the body.
  return path.starts_with("wing.") && !path.starts_with("wing.torsion.") && path != "wing.resonance" &&
         path != planform_key::shoulder_distance.path;
}

}  // namespace

ScaledDesign scaled(const Design<double>& design, double factor, ScaledPart part) {
  require(factor >= 1e-3 && factor <= 1e3, "scale", "must lie between 0.001 and 1000", "1", factor);
  ScaledDesign result{design, {}, !design.wing.planform.chord_table.empty()};
  for (const Parameter<double>& parameter : parameter_table<double>()) {
    if (!parameter.get || !parameter.set) continue;
    const std::optional<double> before = parameter.get(design);
    if (!before || (part == ScaledPart::wing && !is_of_wing(parameter.path))) continue;
    const int exponent = exponent_of(parameter);
    if (exponent == 0) continue;
    const double after = *before * std::pow(factor, exponent);
    parameter.set(result.design, after);
    if (after != *before) {
      result.parameters.push_back({std::string(parameter.path), std::string(parameter.unit), *before, after, exponent});
    }
  }
  for (auto& [radius, chord] : result.design.wing.planform.chord_table) {
    radius *= factor;
    chord *= factor;
  }
  validate(result.design);
  return result;
}

}  // namespace wingbeat
