// What rows of the parameter table are made of: where a parameter belongs, and access to it on any scalar.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "wingbeat/core/names.hpp"
#include "wingbeat/parts/any_transmission.hpp"
#include "wingbeat/vehicle/design.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::detail {

// Where a parameter has a place: its text for `only_with`, and whether it holds for a design.

struct Everywhere {
  static constexpr std::string_view text = {};
  static constexpr bool holds(const auto&) { return true; }
};

/// Where a choice has one of these values.
template <class Choice, auto... values>
struct WhereChosen {
  static constexpr ShortText words = [] {
    ShortText t;
    t.add(Choice::key);
    const char* before = " = ";
    ((t.add(before).add(name_of(values)), before = "|"), ...);
    return t;
  }();
  static constexpr std::string_view text = words;
  static constexpr bool holds(const auto& d) { return ((Choice::of(d) == values) || ...); }
};

struct SupplyChoice {
  static constexpr std::string_view key = "supply.type";
  static constexpr SupplyType of(const auto& d) { return d.supply.type; }
};
struct TransmissionChoice {
  static constexpr std::string_view key = "transmission.type";
  static constexpr TransmissionType of(const auto& d) { return d.transmission.type; }
};
struct FrictionChoice {
  static constexpr std::string_view key = "friction.type";
  static constexpr FrictionLaw of(const auto& d) { return d.friction.law; }
};
struct ShapeChoice {
  static constexpr std::string_view key = "wing.planform.shape";
  static constexpr PlanformShape of(const auto& d) { return d.wing.planform.shape; }
};
struct FormulationChoice {
  static constexpr std::string_view key = "transmission.formulation";
  static constexpr Formulation of(const auto& d) { return d.transmission.formulation; }
};
template <SupplyType... types>
using SupplyIs = WhereChosen<SupplyChoice, types...>;
template <TransmissionType... types>
using TransmissionIs = WhereChosen<TransmissionChoice, types...>;
/// Where the transmission's part lists the key.
template <const ParameterKey& key>
struct WhereTaken {
  static constexpr ShortText words = [] {
    ShortText t;
    t.add(TransmissionChoice::key);
    const char* before = " = ";
    for (const auto& [name, type] : names_of<TransmissionType>) {
      if (takes_key(type, key.path)) t.add(before).add(name), before = "|";
    }
    return t;
  }();
  static constexpr std::string_view text = words;
  static constexpr bool holds(const auto& d) { return takes_key(TransmissionChoice::of(d), key.path); }
};
template <PlanformShape... shapes>
using ShapeIs = WhereChosen<ShapeChoice, shapes...>;

struct Geared {
  static constexpr std::string_view text = "motor.gear_ratio";
  static constexpr bool holds(const auto& d) { return d.motor.gear_ratio.has_value(); }
};
struct Drawn {
  static constexpr std::string_view text = "wing.areal_density";
  static constexpr bool holds(const auto& d) { return d.wing.areal_density.has_value(); }
};
struct Pitching {
  static constexpr std::string_view text = "pitch.stiffness";
  static constexpr bool holds(const auto& d) { return d.pitch.stiffness.has_value(); }
};
/// Of wings that pitch or twist, for rows that stand before those stiffnesses in the table: validate() refuses it
/// elsewhere.
struct PitchingWing {
  static constexpr std::string_view text = {};
  static constexpr bool holds(const auto&) { return true; }
};
/// Without a pitch hinge or torsion. No choice of its own: the file reader refuses what set() does.
struct UnderPitchLaw {
  static constexpr std::string_view text = {};
  static constexpr std::string_view required_unless = "pitch.stiffness|wing.torsion.stiffness";
  static constexpr bool holds(const auto& d) { return follows_pitch_law(d); }
};
struct Twisting {
  static constexpr std::string_view text = "wing.torsion.stiffness";
  static constexpr bool holds(const auto& d) { return d.wing.torsion.stiffness.has_value(); }
};
struct InducedVelocityGiven {
  static constexpr std::string_view text = "aerodynamics.induced_velocity";
  static constexpr bool holds(const auto& d) { return d.aerodynamics.induced_velocity.has_value(); }
};
struct ClapGiven {
  static constexpr std::string_view text = "aerodynamics.clap_and_fling.amplitude";
  static constexpr bool holds(const auto& d) { return d.aerodynamics.clap.amplitude.has_value(); }
};
struct BodyGiven {
  static constexpr std::string_view text = "body.inertia_pitch";
  static constexpr bool holds(const auto& d) { return d.body.inertia_pitch.has_value(); }
};
struct WingMassGiven {
  static constexpr std::string_view text = "body.wing_mass";
  static constexpr bool holds(const auto& d) { return d.body.wing_mass.has_value(); }
};
struct TailGiven {
  static constexpr std::string_view text = "body.tail.area";
  static constexpr bool holds(const auto& d) { return d.body.tail.area.has_value(); }
};
struct FinGiven {
  static constexpr std::string_view text = "body.fin.area";
  static constexpr bool holds(const auto& d) { return d.body.fin.area.has_value(); }
};
struct LoadsTabulated {
  static constexpr std::string_view text = "aerodynamics.type = tabulated";
  static constexpr bool holds(const auto& d) { return d.aerodynamics.load_table != nullptr; }
};
struct PiezoDriven {
  static constexpr std::string_view text = "piezo.force_per_volt";
  static constexpr bool holds(const auto& d) { return d.piezo.force_per_volt.has_value(); }
};
/// With a motor, as all are that no piezo drives.
struct Motorised {
  static constexpr std::string_view text = {};
  static constexpr std::string_view required_unless = PiezoDriven::text;
  static constexpr bool holds(const auto& d) { return !PiezoDriven::holds(d); }
};
struct Brushless {
  static constexpr std::string_view text = "electronics.efficiency";
  static constexpr bool holds(const auto& d) { return d.electronics.efficiency.has_value(); }
};
struct Heated {
  static constexpr std::string_view text = "motor.thermal_resistance_winding";
  static constexpr bool holds(const auto& d) { return d.motor.thermal.resistance_winding.has_value(); }
};
struct Weighed {
  static constexpr std::string_view text = "vehicle.mass";
  static constexpr bool holds(const auto& d) { return d.mass.has_value(); }
};
struct WeighedSprings : Weighed {
  static constexpr bool holds(const auto& d) { return Weighed::holds(d) && has_springs(d); }
};

/// The text of a number that a part knows.
constexpr ParameterText row(const ParameterKey& key, std::string_view fallback, std::string_view meaning,
                            std::array<std::string_view, 2> alternatives = {}, std::string_view example = {}) {
  return {key.path, key.unit, key.range, fallback, meaning, alternatives, example};
}

template <class Where>
constexpr ParameterText placed(ParameterText text) {
  text.only_with = Where::text;
  if constexpr (requires { Where::required_unless; }) {
    if (text.fallback == "required") text.required_unless = Where::required_unless;
  }
  return text;
}

/// A number at `access(design)`. Access is a captureless lambda here and below.
template <Scalar S, class Where = Everywhere, class Access>
constexpr Parameter<S> number(const ParameterText& text, Access) {
  return {placed<Where>(text),
          [](Design<S>& d, const S& x) {
            if (!Where::holds(d)) return false;
            Access{}(d) = x;
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> {
            if (!Where::holds(d)) return std::nullopt;
            return Access{}(d);
          }};
}

/// One of several optional numbers that exclude each other.
template <Scalar S, class Where = Everywhere, class Access, class... Others>
constexpr Parameter<S> alternative(const ParameterText& text, Access, Others...) {
  return {placed<Where>(text),
          [](Design<S>& d, const S& x) {
            if (!Where::holds(d)) return false;
            (Others{}(d).reset(), ...);
            Access{}(d) = x;
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> { return Access{}(d); }};
}

/// alternative() that a design does not have where it has no place.
template <Scalar S, class Where, class Access, class... Others>
constexpr Parameter<S> placed_alternative(const ParameterText& text, Access access, Others... others) {
  Parameter<S> parameter = alternative<S, Where>(text, access, others...);
  parameter.get = [](const Design<S>& d) -> std::optional<S> {
    if (!Where::holds(d)) return std::nullopt;
    return Access{}(d);
  };
  return parameter;
}

/// A plain number that optional ones replace.
template <Scalar S, class Where = Everywhere, class Access, class... Others>
constexpr Parameter<S> replaceable(const ParameterText& text, Access, Others...) {
  return {placed<Where>(text),
          [](Design<S>& d, const S& x) {
            if (!Where::holds(d)) return false;
            Access{}(d) = x;
            (Others{}(d).reset(), ...);
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> {
            if (!Where::holds(d) || (Others{}(d) || ...)) return std::nullopt;
            return Access{}(d);
          }};
}

/// A battery's voltage at any charge, in place of its discharge curve.
template <Scalar S>
constexpr Parameter<S> battery_voltage(const ParameterText& text) {
  using Where = SupplyIs<SupplyType::battery, SupplyType::battery_sine>;
  return {placed<Where>(text),
          [](Design<S>& d, const S& x) {
            if (!Where::holds(d)) return false;
            d.supply.battery.cell_voltage = x;
            d.supply.battery.discharge_curve.clear();
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> {
            if (!Where::holds(d) || !d.supply.battery.discharge_curve.empty()) return std::nullopt;
            return d.supply.battery.cell_voltage;
          }};
}

/// The coefficient of a friction law; setting it chooses the law.
template <Scalar S, FrictionLaw law>
constexpr Parameter<S> friction_number(const ParameterText& text) {
  using Where = WhereChosen<FrictionChoice, law>;
  return {placed<Where>(text),
          [](Design<S>& d, const S& x) {
            d.friction.law = law;
            d.friction.coefficient = x;
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> {
            if (!Where::holds(d)) return std::nullopt;
            return d.friction.coefficient;
          }};
}

/// A number of the force coefficients; setting it makes a named set the vehicle's own.
template <Scalar S, class Access>
constexpr Parameter<S> wave_number(ParameterText text, Access) {
  text.required_unless = "aerodynamics.coefficients";
  return {text,
          [](Design<S>& d, const S& x) {
            if (d.aerodynamics.coefficients.table) return false;
            d.aerodynamics.coefficients_name = "custom";
            Access{}(d.aerodynamics.coefficients) = x;
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> {
            if (d.aerodynamics.coefficients.table) return std::nullopt;
            return Access{}(d.aerodynamics.coefficients);
          }};
}

template <Scalar S, class Where = Everywhere>
constexpr Parameter<S> text(const ParameterText& text, std::string (*read)(const Design<S>&)) {
  return {placed<Where>(text), nullptr, nullptr, read};
}

/// A value of an enumeration, by name; its range is the list of names.
template <Scalar S, class Choice, class Where = Everywhere>
constexpr Parameter<S> choice(std::string_view meaning, std::string_view example = {}) {
  using E = decltype(Choice::of(std::declval<const Design<S>&>()));
  return text<S, Where>(
      {Choice::key, "", {wingbeat::listed_names<E>()}, "required", meaning, {}, example},
      [](const Design<S>& d) { return Where::holds(d) ? std::string(name_of(Choice::of(d))) : std::string(); });
}

/// A table, which is not written as one value.
template <Scalar S, class Where = Everywhere>
constexpr Parameter<S> table(const ParameterText& words) {
  return text<S, Where>(words, [](const Design<S>&) { return std::string(); });
}

}  // namespace wingbeat::detail
