// The one table of what a designer states: key, unit, range, default, alternatives, meaning and access of every
// parameter of a Design. Range checks, vehicle files, messages, the reference, sweeps, fits and optimisers follow it.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

template <Scalar S>
struct Design;

/// What is known of a parameter on any scalar.
struct ParameterText {
  std::string_view path;  ///< "motor.torque_constant": section, dot, name
  std::string_view unit;  ///< SI unit, "1" for a plain number, empty where the parameter is not a number
  ParameterRange range;
  std::string_view fallback;  ///< "required", or the default
  std::string_view meaning;   ///< one line, with the symbol of model.md
  /// Names, in the same section, of what may be stated in its place; a design has one of them.
  std::array<std::string_view, 2> alternatives = {};
  /// What a new vehicle states, "5 mm" or "semi-ellipse"; empty where it need not, or where it depends on the drive.
  std::string_view example = {};
  /// The choice this parameter belongs to, "friction.type = viscous" with "|" between values, or a parameter that must
  /// be given too, "motor.gear_ratio"; empty: belongs everywhere.
  std::string_view only_with = {};
  /// The parameters, with "|" between them, of which one makes a required one unnecessary: where it is given, or, for
  /// the numbers of a section whose name it is, where it holds a name.
  std::string_view required_unless = {};

  bool has_alternative() const { return !alternatives[0].empty(); }
};

/// One parameter with access to it. `set` and `get` are null where it is not a number.
template <Scalar S>
struct Parameter : ParameterText {
  /// Sets the parameter [SI]; false if the design's choices leave no place for it (a duty with a constant voltage).
  /// Alternatives replace each other: hinge_offset and stroke_amplitude, stiffness and resonance, the friction laws,
  /// a named set of force coefficients and its single numbers.
  bool (*set)(Design<S>&, const S&) = nullptr;
  /// The parameter [SI]; empty where the design does not have it.
  std::optional<S> (*get)(const Design<S>&) = nullptr;
  /// The text of a parameter that is not a number; empty where the design does not have it.
  std::string (*text)(const Design<S>&) = nullptr;
};

/// Every parameter, in the order of the reference. Its rows are in src/vehicle/drive_rows.hpp and parameter_rows.hpp;
/// there are tables of double and of GradientJet (cycle/orbit_gradient.hpp).
template <Scalar S>
std::span<const Parameter<S>> parameter_table();

/// The parameter of that path, or null.
template <Scalar S>
const Parameter<S>* find_parameter(std::string_view path) {
  for (const Parameter<S>& parameter : parameter_table<S>()) {
    if (parameter.path == path) return &parameter;
  }
  return nullptr;
}

/// "required or stroke_amplitude", "required unless pitch.stiffness", or the default.
std::string default_text(const ParameterText& parameter);

/// Alternatives with "|" between them, in words: "supply.type = pwm or battery".
std::string with_or(std::string_view alternatives);

/// True for two paths of which a design has one, such as transmission.hinge_offset and .stroke_amplitude.
bool are_alternatives(std::string_view one, std::string_view other);

/// The paths of a parameter's alternatives.
std::vector<std::string> alternatives_of(const ParameterText& parameter);

/// The two sides of ParameterText::only_with.
struct Requirement {
  std::string_view path;
  std::vector<std::string_view> values;  ///< empty: the parameter need only be given
  bool allows(std::string_view value) const;
};
Requirement requirement_of(std::string_view only_with);

/// True for a path that others begin with: "wing.planform".
bool is_section(std::string_view path);

/// "unknown key; did you mean motor.inertia?", or with the keys of its section where none is near.
std::string unknown_key_message(std::string_view path);

/// The key or section that an unknown key was probably to be, or empty where none is near.
std::string nearest_key(std::string_view path);

/// The name nearest to the given one, or empty where none is near.
std::string_view nearest_name(std::string_view given, std::span<const std::string_view> known);

/// The parameter of that path, a number. Throws ParameterError for an unknown path and for what is not a number.
template <Scalar S>
const Parameter<S>& numeric_parameter(std::string_view path) {
  const Parameter<S>* parameter = find_parameter<S>(path);
  if (!parameter) throw ParameterError(std::string(path), unknown_key_message(path));
  if (!parameter->set) throw ParameterError(std::string(path), "is not a number");
  return *parameter;
}

/// Sets a number [SI] by its path. Throws ParameterError where numeric_parameter does, and where the design's choices
/// leave no place for it. Does not check ranges: validate(design) does.
template <Scalar S>
void set_parameter(Design<S>& design, std::string_view path, const S& value) {
  const Parameter<S>& parameter = numeric_parameter<S>(path);
  if (parameter.set(design, value)) return;
  throw ParameterError(std::string(path), parameter.only_with.empty() ? "does not apply to this design"
                                                                      : "only with " + with_or(parameter.only_with));
}

}  // namespace wingbeat
