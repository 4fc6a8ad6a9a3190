// The one table of what a designer states: key, unit, range, default, alternatives, meaning and access of every
// parameter of a Design. Range checks, vehicle files, messages, the reference, sweeps, fits and optimisers follow it.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "wingbeat/core/names.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// What a parameter may be: of a number the bounds [SI], of a choice or a text the words alone.
struct ParameterRange {
  std::string_view text;      ///< "> 0", "none, viscous or constant"
  const char* expected = "";  ///< "must be > 0", for messages
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool above_lower = false;  ///< the lower bound itself is not allowed
  bool below_upper = false;  ///< nor the upper one
  bool whole = false;        ///< whole numbers only

  bool holds(double x) const {
    return (above_lower ? x > lower : x >= lower) && (below_upper ? x < upper : x <= upper) &&
           (!whole || x == std::floor(x));
  }
};

namespace range {

inline constexpr double endless = std::numeric_limits<double>::infinity();
inline constexpr ParameterRange any{"any", "must be finite"};
inline constexpr ParameterRange positive{"> 0", "must be > 0", 0.0, endless, true};
inline constexpr ParameterRange not_negative{">= 0", "must be >= 0", 0.0};
inline constexpr ParameterRange zero_to_one{"0 to 1", "must lie between 0 and 1", 0.0, 1.0};
inline constexpr ParameterRange acute{"> 0, < pi/2", "must lie between 0 and pi/2", 0.0, pi / 2.0, true, true};
inline constexpr ParameterRange zero_to_acute{">= 0, < pi/2", "must be >= 0 and < pi/2", 0.0, pi / 2.0, false, true};
inline constexpr ParameterRange count{
    "whole number >= 1", "must be a whole number >= 1", 1.0, endless, false, false, true};
// validate() of the transmission compares it with the other links.
inline constexpr ParameterRange crank_radius{"> 0, < rod_length, < every other link", "must be > 0", 0.0, endless,
                                             true};
inline constexpr ParameterRange rod_length{"> crank_radius", "must be longer than the crank radius", 0.0, endless,
                                           true};

}  // namespace range

/// What is known of a parameter on any scalar.
struct ParameterText {
  std::string_view path;  ///< "motor.torque_constant": section, dot, name
  std::string_view unit;  ///< SI unit, "1" for a plain number, empty where the parameter is not a number
  ParameterRange range;
  std::string_view fallback;  ///< "required", or the default
  std::string_view meaning;   ///< one line, with the symbol of model.md
  /// Names, in the same section, of what may be stated in its place; a design has one of them.
  std::array<std::string_view, 2> alternatives = {};
  /// The choice this parameter belongs to, "friction.type = viscous" with "|" between values, or a parameter that must
  /// be given too, "motor.gear_ratio"; empty: belongs everywhere.
  std::string_view only_with = {};

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

namespace detail {

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
template <PlanformShape... shapes>
using ShapeIs = WhereChosen<ShapeChoice, shapes...>;

struct Geared {
  static constexpr std::string_view text = "motor.gear_ratio";
  static constexpr bool holds(const auto& d) { return d.motor.gear_ratio.has_value(); }
};
struct Weighed {
  static constexpr std::string_view text = "vehicle.mass";
  static constexpr bool holds(const auto& d) { return d.mass.has_value(); }
};
struct WeighedSprings : Weighed {
  static constexpr bool holds(const auto& d) { return Weighed::holds(d) && has_springs(d); }
};

template <class Where>
constexpr ParameterText placed(ParameterText text) {
  text.only_with = Where::text;
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

/// A plain number that an optional one replaces.
template <Scalar S, class Where = Everywhere, class Access, class Other>
constexpr Parameter<S> replaceable(const ParameterText& text, Access, Other) {
  return {placed<Where>(text),
          [](Design<S>& d, const S& x) {
            if (!Where::holds(d)) return false;
            Access{}(d) = x;
            Other{}(d).reset();
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> {
            if (!Where::holds(d) || Other{}(d)) return std::nullopt;
            return Access{}(d);
          }};
}

/// A battery's voltage at any charge, in place of its discharge curve.
template <Scalar S>
constexpr Parameter<S> battery_voltage(const ParameterText& text) {
  using Where = SupplyIs<SupplyType::battery>;
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
constexpr Parameter<S> wave_number(const ParameterText& text, Access) {
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
constexpr Parameter<S> choice(std::string_view meaning) {
  using E = decltype(Choice::of(std::declval<const Design<S>&>()));
  return text<S, Where>({Choice::key, "", {wingbeat::listed_names<E>()}, "required", meaning}, [](const Design<S>& d) {
    return Where::holds(d) ? std::string(name_of(Choice::of(d))) : std::string();
  });
}

/// A table, which is not written as one value.
template <Scalar S, class Where = Everywhere>
constexpr Parameter<S> table(const ParameterText& words) {
  return text<S, Where>(words, [](const Design<S>&) { return std::string(); });
}

}  // namespace detail

/// Every parameter, in the order of the reference.
template <Scalar S>
std::span<const Parameter<S>> parameter_table() {
  using D = Design<S>;
  using detail::alternative, detail::battery_voltage, detail::choice, detail::friction_number, detail::number,
      detail::replaceable, detail::table, detail::text, detail::wave_number;
  using detail::FormulationChoice, detail::FrictionChoice, detail::Geared, detail::ShapeChoice, detail::ShapeIs,
      detail::SupplyChoice, detail::SupplyIs, detail::TransmissionChoice, detail::TransmissionIs, detail::Weighed,
      detail::WeighedSprings;
  using enum PlanformShape;
  using Powered = SupplyIs<SupplyType::constant, SupplyType::pwm>;
  using Sine = SupplyIs<SupplyType::sine>;
  using Periodic = SupplyIs<SupplyType::sine, SupplyType::pwm>;
  using Pwm = SupplyIs<SupplyType::pwm>;
  using OnBattery = SupplyIs<SupplyType::battery>;
  using Crank = TransmissionIs<TransmissionType::slider_crank>;
  using FourBarOnly = TransmissionIs<TransmissionType::four_bar>;
  using Linkage = TransmissionIs<TransmissionType::slider_crank, TransmissionType::four_bar>;
  using StrokeTableOnly = TransmissionIs<TransmissionType::tabulated>;
  using Direct = TransmissionIs<TransmissionType::direct>;
  using Outline = ShapeIs<semi_ellipse, rectangle>;
  using FromRoot = ShapeIs<semi_ellipse, rectangle, tabulated>;
  using Tabulated = ShapeIs<tabulated>;
  using Moments = ShapeIs<moments>;
  constexpr auto hinge_offset = [](auto& d) -> auto& { return d.transmission.hinge_offset; };
  constexpr auto stroke_amplitude = [](auto& d) -> auto& { return d.transmission.stroke_amplitude; };
  constexpr auto stiffness = [](auto& d) -> auto& { return d.spring.stiffness; };
  constexpr auto resonance = [](auto& d) -> auto& { return d.spring.resonance; };
  constexpr auto spring_ratio = [](auto& d) -> auto& { return d.spring.resonance_ratio; };
  constexpr auto drive_ratio = [](auto& d) -> auto& { return d.supply_resonance_ratio; };
  constexpr auto wing_resonance = [](auto& d) -> auto& { return d.wing.resonance; };
  constexpr auto chord_ratio = [](auto& d) -> auto& { return d.wing.planform.chord_ratio; };

  static constexpr Parameter<S> parameters[] = {
      text<S>({"vehicle.name", "", {"any text"}, "no name", "name of the vehicle, for reports"},
              [](const D& d) { return d.name; }),
      number<S>({"vehicle.mass", "kg", range::positive, "unknown",
                 "mass of the vehicle but for the masses stated for themselves (motor.mass, supply.mass, "
                 "spring.mass, transmission.rod_linear_density); enables lift_to_weight"},
                [](auto& d) -> auto& { return d.mass; }),

      choice<S, SupplyChoice>("what feeds the motor terminals"),
      number<S, Powered>(
          {"supply.voltage", "V", range::not_negative, "required", "v, terminal voltage; pwm: while switched on"},
          [](auto& d) -> auto& { return d.supply.voltage; }),
      number<S, Sine>({"supply.amplitude", "V", range::not_negative, "required", "amplitude of the sine"},
                      [](auto& d) -> auto& { return d.supply.voltage; }),
      replaceable<S, Periodic>(
          {"supply.frequency",
           "Hz",
           range::positive,
           "required",
           "drive frequency (sine) or switching frequency (pwm)",
           {"resonance_ratio"}},
          [](auto& d) -> auto& { return d.supply.frequency; }, drive_ratio),
      alternative<S, Direct>({"supply.resonance_ratio",
                              "1",
                              range::positive,
                              "required",
                              "drive frequency over the frequency at which rotor and wings resonate on the springs; 1 "
                              "drives a direct drive at resonance",
                              {"frequency"}},
                             drive_ratio),
      number<S, Pwm>({"supply.duty", "1", range::zero_to_one, "required", "fraction of a period switched on"},
                     [](auto& d) -> auto& { return d.supply.duty; }),
      number<S, OnBattery>({"supply.cells", "1", range::count, "1", "cells in series"},
                           [](auto& d) -> auto& { return d.supply.battery.cells; }),
      battery_voltage<S>({"supply.cell_voltage",
                          "V",
                          range::positive,
                          "required",
                          "E, open-circuit voltage of one cell at any charge",
                          {"discharge_curve"}}),
      table<S, OnBattery>({"supply.discharge_curve",
                           "",
                           {"name of a CSV file, or rows from charge 0 to 1, voltages not falling"},
                           "required",
                           "open-circuit voltage of one cell: rows [state of charge, voltage], monotone cubics, see "
                           "below",
                           {"cell_voltage"}}),
      number<S, OnBattery>({"supply.internal_resistance", "ohm", range::not_negative, "required",
                            "R_i of one cell: the terminals see E - R_i i, times cells"},
                           [](auto& d) -> auto& { return d.supply.battery.internal_resistance; }),
      number<S, OnBattery>({"supply.capacity", "C", range::positive, "required", "charge that a full cell holds"},
                           [](auto& d) -> auto& { return d.supply.battery.capacity; }),
      number<S, OnBattery>({"supply.charge", "1", range::zero_to_one, "1",
                            "state of charge: where a run computes, where a flight starts"},
                           [](auto& d) -> auto& { return d.supply.battery.charge; }),
      number<S, OnBattery>({"supply.cutoff_voltage", "V", range::not_negative, "none",
                            "mean terminal voltage of one cell at which a flight ends"},
                           [](auto& d) -> auto& { return d.supply.battery.cutoff_voltage; }),
      number<S, Weighed>({"supply.mass", "kg", range::not_negative, "none: in vehicle.mass",
                          "mass of the battery, in addition to vehicle.mass"},
                         [](auto& d) -> auto& { return d.masses.supply; }),

      number<S>({"motor.gear_ratio", "1", range::positive, "none: constants at the output shaft",
                 "n, motor turns per output turn; given, the motor constants below are the motor shaft's"},
                [](auto& d) -> auto& { return d.motor.gear_ratio; }),
      number<S, Geared>({"motor.gear_inertia", "kg m2", range::not_negative, "0 kg m2",
                         "J_G, inertia of the gearbox at the output shaft"},
                        [](auto& d) -> auto& { return d.motor.gear_inertia; }),
      number<S, Geared>({"motor.gear_damping", "N m s/rad", range::not_negative, "0 N m s/rad",
                         "b_G, viscous damping of the gearbox at the output shaft"},
                        [](auto& d) -> auto& { return d.motor.gear_damping; }),
      number<S>({"motor.armature_resistance", "ohm", range::positive, "required", "R_a, armature resistance"},
                [](auto& d) -> auto& { return d.motor.constants.armature_resistance; }),
      number<S>({"motor.armature_inductance", "H", range::not_negative, "required",
                 "L_a, armature inductance; 0 makes the current algebraic"},
                [](auto& d) -> auto& { return d.motor.constants.armature_inductance; }),
      number<S>({"motor.torque_constant", "N m/A", range::positive, "required",
                 "K at the output shaft; K_b at the motor shaft with gear_ratio"},
                [](auto& d) -> auto& { return d.motor.constants.torque_constant; }),
      number<S>({"motor.inertia", "kg m2", range::positive, "required",
                 "J, rotor and gearbox at the output shaft; J_m of the rotor with gear_ratio"},
                [](auto& d) -> auto& { return d.motor.constants.inertia; }),
      number<S>({"motor.viscous_damping", "N m s/rad", range::not_negative, "required",
                 "b, motor and gearbox at the output shaft; b_m of the motor with gear_ratio"},
                [](auto& d) -> auto& { return d.motor.constants.viscous_damping; }),
      number<S>({"motor.friction_torque", "N m", range::not_negative, "0 N m",
                 "constant friction torque of the motor itself, at the motor shaft with gear_ratio; "
                 "adds to every friction law"},
                [](auto& d) -> auto& { return d.motor.constants.friction_torque; }),
      number<S, Weighed>({"motor.mass", "kg", range::not_negative, "none: in vehicle.mass",
                          "mass of the motor with its gearbox, in addition to vehicle.mass"},
                         [](auto& d) -> auto& { return d.masses.motor; }),

      choice<S, TransmissionChoice>(
          "kind of mechanism between motor and wings; direct: the motor shaft is the wing hinge"),
      number<S, Linkage>({"transmission.crank_radius", "m", range::crank_radius, "required", "r_c, crank radius"},
                         [](auto& d) -> auto& { return d.transmission.crank_radius; }),
      number<S, Crank>({"transmission.rod_length", "m", range::rod_length, "required", "l, rod length"},
                       [](auto& d) -> auto& { return d.transmission.rod_length; }),
      alternative<S, Crank>({"transmission.hinge_offset",
                             "m",
                             range::positive,
                             "required",
                             "H, horizontal distance from slider to wing hinge",
                             {"stroke_amplitude"}},
                            hinge_offset, stroke_amplitude),
      alternative<S, Crank>({"transmission.stroke_amplitude",
                             "rad",
                             range::acute,
                             "required",
                             "half the peak-to-peak stroke angle; fixes H = r_c / tan(stroke_amplitude); "
                             "not with mid_stroke_height",
                             {"hinge_offset"}},
                            stroke_amplitude, hinge_offset),
      number<S, Crank>({"transmission.mid_stroke_height", "m", range::any, "rod_length",
                        "y_0, slider height over the crank axis at stroke angle zero"},
                       [](auto& d) -> auto& { return d.transmission.mid_stroke_height; }),
      number<S, Weighed>({"transmission.rod_linear_density", "kg/m", range::not_negative, "none: in vehicle.mass",
                          "mass of the rod or coupler over its length: that length times this, in addition to "
                          "vehicle.mass"},
                         [](auto& d) -> auto& { return d.masses.rod_linear_density; }),
      number<S, FourBarOnly>(
          {"transmission.coupler_length", "m", range::positive, "required", "l, from crank pin to rocker pin"},
          [](auto& d) -> auto& { return d.transmission.coupler_length; }),
      number<S, FourBarOnly>(
          {"transmission.rocker_length", "m", range::positive, "required", "p, from rocker axis to rocker pin"},
          [](auto& d) -> auto& { return d.transmission.rocker_length; }),
      number<S, FourBarOnly>(
          {"transmission.ground_length", "m", range::positive, "required", "d, from crank axis to rocker axis"},
          [](auto& d) -> auto& { return d.transmission.ground_length; }),
      number<S, FourBarOnly>({"transmission.swing_ratio", "1", range::positive, "1",
                              "n_s, turning angle of the wings over that of the rocker: sector gear or string"},
                             [](auto& d) -> auto& { return d.transmission.swing_ratio; }),
      number<S, FourBarOnly>({"transmission.mid_angle", "rad", range::any, "middle of the rocker's swing",
                              "phi_mid, angle between rocker and the line from crank axis to rocker axis, produced, at "
                              "stroke angle zero"},
                             [](auto& d) -> auto& { return d.transmission.mid_angle; }),
      table<S, StrokeTableOnly>({"transmission.stroke_table",
                                 "",
                                 {"name of a CSV file, or four or more rows within a turn, crank angles growing"},
                                 "required",
                                 "rows [crank angle, stroke angle], periodic spline of degree five, see below"}),
      number<S, StrokeTableOnly>(
          {"transmission.stroke_scale", "1", range::positive, "1", "multiplies the stroke angles of the table"},
          [](auto& d) -> auto& { return d.transmission.table.scale; }),
      number<S, StrokeTableOnly>({"transmission.reference_radius", "m", range::positive, "required",
                                  "r_ref, radius at which the wings' moment is taken up; load-proportional friction "
                                  "acts on M_w / r_ref"},
                                 [](auto& d) -> auto& { return d.transmission.table.reference_radius; }),
      choice<S, FormulationChoice, Crank>(
          "how the rod force turns the wings: the paper's eq (1), or conserving power exactly"),

      choice<S, FrictionChoice>(
          "law of the transmission's friction torque T_f on the crank or shaft; load-proportional needs a rod"),
      friction_number<S, FrictionLaw::load_proportional>({"friction.radius", "m", range::not_negative, "required",
                                                          "mu r_e, effective friction radius: T_f = mu r_e abs(F)"}),
      friction_number<S, FrictionLaw::viscous>(
          {"friction.damping", "N m s/rad", range::not_negative, "required", "b_f: T_f = b_f omega"}),
      friction_number<S, FrictionLaw::quadratic>(
          {"friction.coefficient", "N m s2/rad2", range::not_negative, "required", "c_f: T_f = c_f omega abs(omega)"}),
      friction_number<S, FrictionLaw::constant>(
          {"friction.torque", "N m", range::not_negative, "required", "T_c: T_f = T_c sign(omega)"}),

      alternative<S>({"spring.stiffness",
                      "N m/rad",
                      range::not_negative,
                      "required",
                      "k, stiffness of one hinge spring, at rest at stroke angle zero",
                      {"resonance", "resonance_ratio"}},
                     stiffness, resonance, spring_ratio),
      alternative<S>(
          {"spring.resonance",
           "Hz",
           range::not_negative,
           "required",
           "f_s, resonance of one wing on its spring, k = J_w (2 pi f_s)^2; direct drive: of rotor and wings "
           "on all springs, N_w k = (J + N_w J_w) (2 pi f_s)^2",
           {"stiffness", "resonance_ratio"}},
          resonance, stiffness, spring_ratio),
      alternative<S, Direct>({"spring.resonance_ratio",
                              "1",
                              range::positive,
                              "required",
                              "frequency at which rotor and wings resonate on the springs, over the drive frequency; 1 "
                              "tunes the springs to the supply",
                              {"stiffness", "resonance"}},
                             spring_ratio, stiffness, resonance),
      number<S, WeighedSprings>({"spring.mass", "kg", range::not_negative, "none: in vehicle.mass",
                                 "mass of one hinge spring, in addition to vehicle.mass; one for each wing"},
                                [](auto& d) -> auto& { return d.masses.spring; }),

      number<S>({"wing.count", "1", range::count, "2", "N_w, number of wings"},
                [](auto& d) -> auto& { return d.wing.count; }),
      replaceable<S>(
          {"wing.inertia",
           "kg m2",
           range::positive,
           "required",
           "J_w, inertia of one wing about its hinge",
           {"resonance"}},
          [](auto& d) -> auto& { return d.wing.inertia; }, wing_resonance),
      alternative<S, Direct>(
          {"wing.resonance",
           "Hz",
           range::positive,
           "required",
           "frequency at which rotor and wings resonate on springs of a given stiffness: the inertia "
           "follows, J + N_w J_w = N_w k / (2 pi f)^2",
           {"inertia"}},
          wing_resonance),
      choice<S, ShapeChoice>("how the wing's outline is given"),
      number<S, Outline>({"wing.planform.length", "m", range::positive, "required", "R, wing root to tip"},
                         [](auto& d) -> auto& { return d.wing.planform.length; }),
      replaceable<S, Outline>(
          {"wing.planform.root_chord", "m", range::positive, "required", "c_0, chord at the root", {"chord_ratio"}},
          [](auto& d) -> auto& { return d.wing.planform.root_chord; }, chord_ratio),
      alternative<S, Outline>({"wing.planform.chord_ratio",
                               "1",
                               range::positive,
                               "required",
                               "c_0 / R, chord at the root over the length: it follows when the length changes",
                               {"root_chord"}},
                              chord_ratio),
      number<S, FromRoot>(
          {"wing.planform.hub_offset", "m", range::not_negative, "0 m", "distance from the hinge to the wing root"},
          [](auto& d) -> auto& { return d.wing.planform.hub_offset; }),
      table<S, Tabulated>({"wing.planform.file",
                           "",
                           {"name of a CSV file"},
                           "required",
                           "chord table: columns distance (from the root) and chord, see below",
                           {"chords"}}),
      table<S, Tabulated>({"wing.planform.chords",
                           "",
                           {"two or more rows, distances growing, chords >= 0"},
                           "required",
                           "chord table in place: rows [distance from the root, chord], linear between",
                           {"file"}}),
      number<S, Moments>(
          {"wing.planform.s2", "m4", range::not_negative, "required", "S_2 = N_w integral c r^2 dr of all wings"},
          [](auto& d) -> auto& { return d.wing.planform.s2; }),
      number<S, Moments>(
          {"wing.planform.s3", "m5", range::not_negative, "required", "S_3 = N_w integral c r^3 dr of all wings"},
          [](auto& d) -> auto& { return d.wing.planform.s3; }),

      number<S>({"aerodynamics.air_density", "kg/m3", range::not_negative, "required", "rho, air density"},
                [](auto& d) -> auto& { return d.aerodynamics.air_density; }),
      number<S>({"aerodynamics.pitch_coefficient", "s", range::not_negative, "required",
                 "C_alpha, passive pitching: alpha = pi/2 - C_alpha abs(beta')"},
                [](auto& d) -> auto& { return d.aerodynamics.pitch_coefficient; }),
      number<S>({"aerodynamics.angle_of_attack_min", "rad", range::zero_to_acute, "none",
                 "stop of the passive pitching: alpha falls no lower"},
                [](auto& d) -> auto& { return d.aerodynamics.angle_of_attack_min; }),
      text<S>({"aerodynamics.coefficients",
               "",
               {"translational-2022, or a table of the keys below"},
               "translational-2022",
               "lift and drag coefficient against angle of attack, eqs (12, 13)"},
              [](const D& d) {
                const std::string& name = d.aerodynamics.coefficients_name;
                return name == "custom" || d.aerodynamics.coefficients.table ? std::string() : name;
              }),
      wave_number<S>({"aerodynamics.coefficients.lift.offset", "1", range::any,
                      "required unless coefficients is a name", "A of C_L = A + B sin(C alpha + D)"},
                     [](auto& c) -> auto& { return c.lift.offset; }),
      wave_number<S>({"aerodynamics.coefficients.lift.amplitude", "1", range::any,
                      "required unless coefficients is a name", "B of C_L = A + B sin(C alpha + D)"},
                     [](auto& c) -> auto& { return c.lift.amplitude; }),
      wave_number<S>({"aerodynamics.coefficients.lift.rate", "1", range::any, "required unless coefficients is a name",
                      "C of C_L = A + B sin(C alpha + D)"},
                     [](auto& c) -> auto& { return c.lift.rate; }),
      wave_number<S>({"aerodynamics.coefficients.lift.phase", "rad", range::any,
                      "required unless coefficients is a name", "D of C_L = A + B sin(C alpha + D)"},
                     [](auto& c) -> auto& { return c.lift.phase; }),
      wave_number<S>({"aerodynamics.coefficients.drag.offset", "1", range::any,
                      "required unless coefficients is a name", "A of C_D = A + B cos(C alpha + D)"},
                     [](auto& c) -> auto& { return c.drag.offset; }),
      wave_number<S>({"aerodynamics.coefficients.drag.amplitude", "1", range::any,
                      "required unless coefficients is a name", "B of C_D = A + B cos(C alpha + D)"},
                     [](auto& c) -> auto& { return c.drag.amplitude; }),
      wave_number<S>({"aerodynamics.coefficients.drag.rate", "1", range::any, "required unless coefficients is a name",
                      "C of C_D = A + B cos(C alpha + D)"},
                     [](auto& c) -> auto& { return c.drag.rate; }),
      wave_number<S>({"aerodynamics.coefficients.drag.phase", "rad", range::any,
                      "required unless coefficients is a name", "D of C_D = A + B cos(C alpha + D)"},
                     [](auto& c) -> auto& { return c.drag.phase; }),
      table<S>({"aerodynamics.coefficients.table",
                "",
                {"name of a CSV file, or three or more rows, angles growing"},
                "none",
                "instead of lift and drag: rows [angle of attack, C_L, C_D], natural cubic splines, see below",
                {"lift", "drag"}}),

      number<S>({"bench.torque_constant", "N m/A", range::positive, "none",
                 "K_ref of a test bench, eq (17); enables power_motor_reference_w"},
                [](auto& d) -> auto& { return d.bench_torque_constant; }),
  };
  return parameters;
}

/// The parameter of that path, or null.
template <Scalar S>
const Parameter<S>* find_parameter(std::string_view path) {
  for (const Parameter<S>& parameter : parameter_table<S>()) {
    if (parameter.path == path) return &parameter;
  }
  return nullptr;
}

/// "required or stroke_amplitude", or the default.
std::string default_text(const ParameterText& parameter);

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
  throw ParameterError(std::string(path), parameter.only_with.empty()
                                              ? "has no place in this design"
                                              : "only with " + std::string(parameter.only_with));
}

}  // namespace wingbeat
