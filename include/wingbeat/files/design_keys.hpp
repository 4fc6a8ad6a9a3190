// The one table of vehicle-file keys. Reading, writing, messages, the reference in docs/vehicle-file.md and access to
// a parameter by name (sweeps, fits, optimisers) all follow it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "wingbeat/core/status.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// What the reference says about a key.
struct KeyText {
  std::string_view path;      ///< "motor.torque_constant"
  std::string_view unit;      ///< SI unit, "1" for a plain number, empty for a key that is not a number
  std::string_view range;     ///< allowed values
  std::string_view fallback;  ///< "required", "required or OTHER" for alternatives, else the default
  std::string_view meaning;   ///< one line, with the symbol of model.md
  /// The choice this key belongs to, "friction.type = viscous" with "|" between values, or a key that must be given
  /// too, "motor.gear_ratio"; empty: belongs everywhere.
  std::string_view only_with = {};
};

/// One key with access to its parameter. `set` and `get` are null for keys that are not numbers.
template <Scalar S>
struct Key : KeyText {
  /// Sets the parameter [SI]; false if the design's choices leave no place for it (a duty with a constant voltage).
  /// Alternatives replace each other: hinge_offset and stroke_amplitude, stiffness and resonance, the friction laws,
  /// a named set of force coefficients and its single numbers.
  bool (*set)(Design<S>&, const S&) = nullptr;
  /// The parameter [SI]; empty where the design does not have it.
  std::optional<S> (*get)(const Design<S>&) = nullptr;
  /// The text of a key that is not a number; empty where the design does not have it.
  std::string (*text)(const Design<S>&) = nullptr;
};

namespace detail {

inline constexpr auto always = [](const auto&) { return true; };

/// A number at `access(design)`, present where `applies(design)`. Both are captureless lambdas.
template <Scalar S, class Access, class Applies = decltype(always)>
constexpr Key<S> number(KeyText text, Access, Applies = {}) {
  return {text,
          [](Design<S>& d, const S& x) {
            if (!Applies{}(d)) return false;
            Access{}(d) = x;
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> {
            if (!Applies{}(d)) return std::nullopt;
            return Access{}(d);
          }};
}

/// One of several optional numbers that exclude each other, with a place where `applies(design)`.
template <Scalar S, class Applies, class Access, class... Others>
constexpr Key<S> alternative(KeyText text, Applies, Access, Others...) {
  return {text,
          [](Design<S>& d, const S& x) {
            if (!Applies{}(d)) return false;
            (Others{}(d).reset(), ...);
            Access{}(d) = x;
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> { return Access{}(d); }};
}

/// A plain number with a place where `applies(design)`, unless an optional one replaces it.
template <Scalar S, class Applies, class Access, class Other>
constexpr Key<S> replaceable(KeyText text, Applies, Access, Other) {
  return {text,
          [](Design<S>& d, const S& x) {
            if (!Applies{}(d)) return false;
            Access{}(d) = x;
            Other{}(d).reset();
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> {
            if (!Applies{}(d) || Other{}(d)) return std::nullopt;
            return Access{}(d);
          }};
}

/// A battery's voltage at any charge, in place of its discharge curve.
template <Scalar S>
constexpr Key<S> battery_voltage(KeyText text) {
  return {text,
          [](Design<S>& d, const S& x) {
            if (d.supply.type != SupplyType::battery) return false;
            d.supply.battery.cell_voltage = x;
            d.supply.battery.discharge_curve.clear();
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> {
            if (d.supply.type != SupplyType::battery || !d.supply.battery.discharge_curve.empty()) return std::nullopt;
            return d.supply.battery.cell_voltage;
          }};
}

template <Scalar S, FrictionLaw law>
constexpr Key<S> friction_number(KeyText text) {
  return {text,
          [](Design<S>& d, const S& x) {
            d.friction.law = law;
            d.friction.coefficient = x;
            return true;
          },
          [](const Design<S>& d) -> std::optional<S> {
            if (d.friction.law != law) return std::nullopt;
            return d.friction.coefficient;
          }};
}

/// A number of the force coefficients; setting it makes a named set the vehicle's own.
template <Scalar S, class Access>
constexpr Key<S> wave_number(KeyText text, Access) {
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

template <Scalar S>
constexpr Key<S> text(KeyText text, std::string (*read)(const Design<S>&)) {
  return {text, nullptr, nullptr, read};
}

}  // namespace detail

/// Every key, in the order of the reference.
template <Scalar S>
std::span<const Key<S>> vehicle_keys() {
  using D = Design<S>;
  using detail::alternative, detail::always, detail::battery_voltage, detail::friction_number, detail::number,
      detail::replaceable, detail::text, detail::wave_number;
  constexpr std::string_view of_crank = "transmission.type = slider-crank";
  constexpr auto sine = [](const auto& d) { return d.supply.type == SupplyType::sine; };
  constexpr auto with_voltage = [](const auto& d) {
    return d.supply.type == SupplyType::constant || d.supply.type == SupplyType::pwm;
  };
  constexpr auto periodic = [](const auto& d) {
    return d.supply.type == SupplyType::sine || d.supply.type == SupplyType::pwm;
  };
  constexpr auto pwm = [](const auto& d) { return d.supply.type == SupplyType::pwm; };
  constexpr auto battery = [](const auto& d) { return d.supply.type == SupplyType::battery; };
  constexpr auto weighed = [](const auto& d) { return d.mass.has_value(); };
  constexpr auto weighed_springs = [](const auto& d) { return d.mass.has_value() && has_springs(d); };
  constexpr auto geared = [](const auto& d) { return d.motor.gear_ratio.has_value(); };
  constexpr auto crank = [](const auto& d) { return d.transmission.type == TransmissionType::slider_crank; };
  constexpr auto direct = [](const auto& d) { return d.transmission.type == TransmissionType::direct; };
  constexpr auto outline = [](const auto& d) {
    return d.wing.planform.shape == PlanformShape::semi_ellipse || d.wing.planform.shape == PlanformShape::rectangle;
  };
  constexpr auto not_moments = [](const auto& d) { return d.wing.planform.shape != PlanformShape::moments; };
  constexpr auto moments = [](const auto& d) { return d.wing.planform.shape == PlanformShape::moments; };
  constexpr auto hinge_offset = [](auto& d) -> auto& { return d.transmission.hinge_offset; };
  constexpr auto stroke_amplitude = [](auto& d) -> auto& { return d.transmission.stroke_amplitude; };
  constexpr auto stiffness = [](auto& d) -> auto& { return d.spring.stiffness; };
  constexpr auto resonance = [](auto& d) -> auto& { return d.spring.resonance; };
  constexpr auto spring_ratio = [](auto& d) -> auto& { return d.spring.resonance_ratio; };
  constexpr auto drive_ratio = [](auto& d) -> auto& { return d.supply_resonance_ratio; };
  constexpr auto wing_resonance = [](auto& d) -> auto& { return d.wing.resonance; };
  constexpr auto chord_ratio = [](auto& d) -> auto& { return d.wing.planform.chord_ratio; };

  static constexpr Key<S> keys[] = {
      text<S>({"vehicle.name", "", "any text", "no name", "name of the vehicle, for reports"},
              [](const D& d) { return d.name; }),
      number<S>({"vehicle.mass", "kg", "> 0", "unknown",
                 "mass of the vehicle but for the masses stated for themselves (motor.mass, supply.mass, "
                 "spring.mass, transmission.rod_linear_density); enables lift_to_weight"},
                [](auto& d) -> auto& { return d.mass; }),

      text<S>({"supply.type", "", "constant, sine, pwm or battery", "required", "what feeds the motor terminals"},
              [](const D& d) { return std::string(name_of(d.supply.type)); }),
      number<S>(
          {"supply.voltage", "V", ">= 0", "required", "v, terminal voltage; pwm: while switched on",
           "supply.type = constant|pwm"},
          [](auto& d) -> auto& { return d.supply.voltage; }, with_voltage),
      number<S>(
          {"supply.amplitude", "V", ">= 0", "required", "amplitude of the sine", "supply.type = sine"},
          [](auto& d) -> auto& { return d.supply.voltage; }, sine),
      replaceable<S>(
          {"supply.frequency", "Hz", "> 0", "required or resonance_ratio",
           "drive frequency (sine) or switching frequency (pwm)", "supply.type = sine|pwm"},
          periodic, [](auto& d) -> auto& { return d.supply.frequency; }, drive_ratio),
      alternative<S>({"supply.resonance_ratio", "1", "> 0", "required or frequency",
                      "drive frequency over the frequency at which rotor and wings resonate on the springs; 1 drives a "
                      "direct drive at resonance",
                      "transmission.type = direct"},
                     direct, drive_ratio),
      number<S>(
          {"supply.duty", "1", "0 to 1", "required", "fraction of a period switched on", "supply.type = pwm"},
          [](auto& d) -> auto& { return d.supply.duty; }, pwm),
      number<S>(
          {"supply.cells", "1", "whole number >= 1", "1", "cells in series", "supply.type = battery"},
          [](auto& d) -> auto& { return d.supply.battery.cells; }, battery),
      battery_voltage<S>({"supply.cell_voltage", "V", "> 0", "required or discharge_curve",
                          "E, open-circuit voltage of one cell at any charge", "supply.type = battery"}),
      text<S>({"supply.discharge_curve", "", "name of a CSV file, or rows from charge 0 to 1, voltages not falling",
               "required or cell_voltage",
               "open-circuit voltage of one cell: rows [state of charge, voltage], monotone cubics, see below",
               "supply.type = battery"},
              [](const D&) { return std::string(); }),
      number<S>(
          {"supply.internal_resistance", "ohm", ">= 0", "required",
           "R_i of one cell: the terminals see E - R_i i, times cells", "supply.type = battery"},
          [](auto& d) -> auto& { return d.supply.battery.internal_resistance; }, battery),
      number<S>(
          {"supply.capacity", "C", "> 0", "required", "charge that a full cell holds", "supply.type = battery"},
          [](auto& d) -> auto& { return d.supply.battery.capacity; }, battery),
      number<S>(
          {"supply.charge", "1", "0 to 1", "1", "state of charge: where a run computes, where a flight starts",
           "supply.type = battery"},
          [](auto& d) -> auto& { return d.supply.battery.charge; }, battery),
      number<S>(
          {"supply.cutoff_voltage", "V", ">= 0", "none", "mean terminal voltage of one cell at which a flight ends",
           "supply.type = battery"},
          [](auto& d) -> auto& { return d.supply.battery.cutoff_voltage; }, battery),
      number<S>(
          {"supply.mass", "kg", ">= 0", "none: in vehicle.mass", "mass of the battery, in addition to vehicle.mass",
           "vehicle.mass"},
          [](auto& d) -> auto& { return d.masses.supply; }, weighed),

      number<S>({"motor.gear_ratio", "1", "> 0", "none: constants at the output shaft",
                 "n, motor turns per output turn; given, the motor constants below are the motor shaft's"},
                [](auto& d) -> auto& { return d.motor.gear_ratio; }),
      number<S>(
          {"motor.gear_inertia", "kg m2", ">= 0", "0 kg m2", "J_G, inertia of the gearbox at the output shaft",
           "motor.gear_ratio"},
          [](auto& d) -> auto& { return d.motor.gear_inertia; }, geared),
      number<S>(
          {"motor.gear_damping", "N m s/rad", ">= 0", "0 N m s/rad",
           "b_G, viscous damping of the gearbox at the output shaft", "motor.gear_ratio"},
          [](auto& d) -> auto& { return d.motor.gear_damping; }, geared),
      number<S>({"motor.armature_resistance", "ohm", "> 0", "required", "R_a, armature resistance"},
                [](auto& d) -> auto& { return d.motor.constants.armature_resistance; }),
      number<S>({"motor.armature_inductance", "H", ">= 0", "required",
                 "L_a, armature inductance; 0 makes the current algebraic"},
                [](auto& d) -> auto& { return d.motor.constants.armature_inductance; }),
      number<S>({"motor.torque_constant", "N m/A", "> 0", "required",
                 "K at the output shaft; K_b at the motor shaft with gear_ratio"},
                [](auto& d) -> auto& { return d.motor.constants.torque_constant; }),
      number<S>({"motor.inertia", "kg m2", "> 0", "required",
                 "J, rotor and gearbox at the output shaft; J_m of the rotor with gear_ratio"},
                [](auto& d) -> auto& { return d.motor.constants.inertia; }),
      number<S>({"motor.viscous_damping", "N m s/rad", ">= 0", "required",
                 "b, motor and gearbox at the output shaft; b_m of the motor with gear_ratio"},
                [](auto& d) -> auto& { return d.motor.constants.viscous_damping; }),
      number<S>({"motor.friction_torque", "N m", ">= 0", "0 N m",
                 "constant friction torque of the motor itself, at the motor shaft with gear_ratio; "
                 "adds to every friction law"},
                [](auto& d) -> auto& { return d.motor.constants.friction_torque; }),
      number<S>(
          {"motor.mass", "kg", ">= 0", "none: in vehicle.mass",
           "mass of the motor with its gearbox, in addition to vehicle.mass", "vehicle.mass"},
          [](auto& d) -> auto& { return d.masses.motor; }, weighed),

      text<S>({"transmission.type", "", "slider-crank or direct", "required",
               "kind of mechanism between motor and wings; direct: the motor shaft is the wing hinge"},
              [](const D& d) { return std::string(name_of(d.transmission.type)); }),
      number<S>(
          {"transmission.crank_radius", "m", "> 0, < rod_length", "required", "r_c, crank radius", of_crank},
          [](auto& d) -> auto& { return d.transmission.crank_radius; }, crank),
      number<S>(
          {"transmission.rod_length", "m", "> crank_radius", "required", "l, rod length", of_crank},
          [](auto& d) -> auto& { return d.transmission.rod_length; }, crank),
      alternative<S>({"transmission.hinge_offset", "m", "> 0", "required or stroke_amplitude",
                      "H, horizontal distance from slider to wing hinge", of_crank},
                     crank, hinge_offset, stroke_amplitude),
      alternative<S>({"transmission.stroke_amplitude", "rad", "> 0, < pi/2", "required or hinge_offset",
                      "half the peak-to-peak stroke angle; fixes H = r_c / tan(stroke_amplitude); "
                      "not with mid_stroke_height",
                      of_crank},
                     crank, stroke_amplitude, hinge_offset),
      number<S>(
          {"transmission.mid_stroke_height", "m", "any", "rod_length",
           "y_0, slider height over the crank axis at stroke angle zero", of_crank},
          [](auto& d) -> auto& { return d.transmission.mid_stroke_height; }, crank),
      number<S>(
          {"transmission.rod_linear_density", "kg/m", ">= 0", "none: in vehicle.mass",
           "mass of the rod over its length: rod_length times this, in addition to vehicle.mass", "vehicle.mass"},
          [](auto& d) -> auto& { return d.masses.rod_linear_density; }, weighed),
      text<S>({"transmission.formulation", "", "rod-force or virtual-work", "required",
               "how the rod force turns the wings: the paper's eq (1), or conserving power exactly", of_crank},
              [](const D& d) {
                return d.transmission.type == TransmissionType::direct
                           ? std::string()
                           : std::string(name_of(d.transmission.formulation));
              }),

      text<S>({"friction.type", "", "none, load-proportional, viscous, quadratic or constant", "required",
               "law of the transmission's friction torque T_f on the crank or shaft; load-proportional needs a rod"},
              [](const D& d) { return std::string(name_of(d.friction.law)); }),
      friction_number<S, FrictionLaw::load_proportional>({"friction.radius", "m", ">= 0", "required",
                                                          "mu r_e, effective friction radius: T_f = mu r_e abs(F)",
                                                          "friction.type = load-proportional"}),
      friction_number<S, FrictionLaw::viscous>(
          {"friction.damping", "N m s/rad", ">= 0", "required", "b_f: T_f = b_f omega", "friction.type = viscous"}),
      friction_number<S, FrictionLaw::quadratic>({"friction.coefficient", "N m s2/rad2", ">= 0", "required",
                                                  "c_f: T_f = c_f omega abs(omega)", "friction.type = quadratic"}),
      friction_number<S, FrictionLaw::constant>(
          {"friction.torque", "N m", ">= 0", "required", "T_c: T_f = T_c sign(omega)", "friction.type = constant"}),

      alternative<S>({"spring.stiffness", "N m/rad", ">= 0", "required or resonance",
                      "k, stiffness of one hinge spring, at rest at stroke angle zero"},
                     always, stiffness, resonance, spring_ratio),
      alternative<S>(
          {"spring.resonance", "Hz", ">= 0", "required or stiffness",
           "f_s, resonance of one wing on its spring, k = J_w (2 pi f_s)^2; direct drive: of rotor and wings "
           "on all springs, N_w k = (J + N_w J_w) (2 pi f_s)^2"},
          always, resonance, stiffness, spring_ratio),
      alternative<S>(
          {"spring.resonance_ratio", "1", "> 0", "required or stiffness",
           "frequency at which rotor and wings resonate on the springs, over the drive frequency; 1 tunes the "
           "springs to the supply",
           "transmission.type = direct"},
          direct, spring_ratio, stiffness, resonance),
      number<S>(
          {"spring.mass", "kg", ">= 0", "none: in vehicle.mass",
           "mass of one hinge spring, in addition to vehicle.mass; one for each wing", "vehicle.mass"},
          [](auto& d) -> auto& { return d.masses.spring; }, weighed_springs),

      number<S>({"wing.count", "1", "whole number >= 1", "2", "N_w, number of wings"},
                [](auto& d) -> auto& { return d.wing.count; }),
      replaceable<S>(
          {"wing.inertia", "kg m2", "> 0", "required or resonance", "J_w, inertia of one wing about its hinge"}, always,
          [](auto& d) -> auto& { return d.wing.inertia; }, wing_resonance),
      alternative<S>(
          {"wing.resonance", "Hz", "> 0", "required or inertia",
           "frequency at which rotor and wings resonate on springs of a given stiffness: the inertia follows, "
           "J + N_w J_w = N_w k / (2 pi f)^2",
           "transmission.type = direct"},
          direct, wing_resonance),
      text<S>({"wing.planform.shape", "", "semi-ellipse, rectangle, tabulated or moments", "required",
               "how the wing's outline is given"},
              [](const D& d) { return std::string(name_of(d.wing.planform.shape)); }),
      number<S>(
          {"wing.planform.length", "m", "> 0", "required", "R, wing root to tip",
           "wing.planform.shape = semi-ellipse|rectangle"},
          [](auto& d) -> auto& { return d.wing.planform.length; }, outline),
      replaceable<S>(
          {"wing.planform.root_chord", "m", "> 0", "required or chord_ratio", "c_0, chord at the root",
           "wing.planform.shape = semi-ellipse|rectangle"},
          outline, [](auto& d) -> auto& { return d.wing.planform.root_chord; }, chord_ratio),
      alternative<S>({"wing.planform.chord_ratio", "1", "> 0", "required or root_chord",
                      "c_0 / R, chord at the root over the length: it follows when the length changes",
                      "wing.planform.shape = semi-ellipse|rectangle"},
                     outline, chord_ratio),
      number<S>(
          {"wing.planform.hub_offset", "m", ">= 0", "0 m", "distance from the hinge to the wing root",
           "wing.planform.shape = semi-ellipse|rectangle|tabulated"},
          [](auto& d) -> auto& { return d.wing.planform.hub_offset; }, not_moments),
      text<S>({"wing.planform.file", "", "name of a CSV file", "required or chords",
               "chord table: columns distance (from the root) and chord, see below", "wing.planform.shape = tabulated"},
              [](const D&) { return std::string(); }),
      text<S>({"wing.planform.chords", "", "two or more rows, distances growing, chords >= 0", "required or file",
               "chord table in place: rows [distance from the root, chord], linear between",
               "wing.planform.shape = tabulated"},
              [](const D&) { return std::string(); }),
      number<S>(
          {"wing.planform.s2", "m4", ">= 0", "required", "S_2 = N_w integral c r^2 dr of all wings",
           "wing.planform.shape = moments"},
          [](auto& d) -> auto& { return d.wing.planform.s2; }, moments),
      number<S>(
          {"wing.planform.s3", "m5", ">= 0", "required", "S_3 = N_w integral c r^3 dr of all wings",
           "wing.planform.shape = moments"},
          [](auto& d) -> auto& { return d.wing.planform.s3; }, moments),

      number<S>({"aerodynamics.air_density", "kg/m3", ">= 0", "required", "rho, air density"},
                [](auto& d) -> auto& { return d.aerodynamics.air_density; }),
      number<S>({"aerodynamics.pitch_coefficient", "s", ">= 0", "required",
                 "C_alpha, passive pitching: alpha = pi/2 - C_alpha abs(beta')"},
                [](auto& d) -> auto& { return d.aerodynamics.pitch_coefficient; }),
      number<S>({"aerodynamics.angle_of_attack_min", "rad", ">= 0, < pi/2", "none",
                 "stop of the passive pitching: alpha falls no lower"},
                [](auto& d) -> auto& { return d.aerodynamics.angle_of_attack_min; }),
      text<S>({"aerodynamics.coefficients", "", "translational-2022, or a table of the keys below",
               "translational-2022", "lift and drag coefficient against angle of attack, eqs (12, 13)"},
              [](const D& d) {
                const std::string& name = d.aerodynamics.coefficients_name;
                return name == "custom" || d.aerodynamics.coefficients.table ? std::string() : name;
              }),
      wave_number<S>({"aerodynamics.coefficients.lift.offset", "1", "any", "required unless coefficients is a name",
                      "A of C_L = A + B sin(C alpha + D)"},
                     [](auto& c) -> auto& { return c.lift.offset; }),
      wave_number<S>({"aerodynamics.coefficients.lift.amplitude", "1", "any", "required unless coefficients is a name",
                      "B of C_L = A + B sin(C alpha + D)"},
                     [](auto& c) -> auto& { return c.lift.amplitude; }),
      wave_number<S>({"aerodynamics.coefficients.lift.rate", "1", "any", "required unless coefficients is a name",
                      "C of C_L = A + B sin(C alpha + D)"},
                     [](auto& c) -> auto& { return c.lift.rate; }),
      wave_number<S>({"aerodynamics.coefficients.lift.phase", "rad", "any", "required unless coefficients is a name",
                      "D of C_L = A + B sin(C alpha + D)"},
                     [](auto& c) -> auto& { return c.lift.phase; }),
      wave_number<S>({"aerodynamics.coefficients.drag.offset", "1", "any", "required unless coefficients is a name",
                      "A of C_D = A + B cos(C alpha + D)"},
                     [](auto& c) -> auto& { return c.drag.offset; }),
      wave_number<S>({"aerodynamics.coefficients.drag.amplitude", "1", "any", "required unless coefficients is a name",
                      "B of C_D = A + B cos(C alpha + D)"},
                     [](auto& c) -> auto& { return c.drag.amplitude; }),
      wave_number<S>({"aerodynamics.coefficients.drag.rate", "1", "any", "required unless coefficients is a name",
                      "C of C_D = A + B cos(C alpha + D)"},
                     [](auto& c) -> auto& { return c.drag.rate; }),
      wave_number<S>({"aerodynamics.coefficients.drag.phase", "rad", "any", "required unless coefficients is a name",
                      "D of C_D = A + B cos(C alpha + D)"},
                     [](auto& c) -> auto& { return c.drag.phase; }),
      text<S>({"aerodynamics.coefficients.table", "", "name of a CSV file, or three or more rows, angles growing",
               "none", "instead of lift and drag: rows [angle of attack, C_L, C_D], natural cubic splines, see below"},
              [](const D&) { return std::string(); }),

      number<S>({"bench.torque_constant", "N m/A", "> 0", "none",
                 "K_ref of a test bench, eq (17); enables power_motor_reference_w"},
                [](auto& d) -> auto& { return d.bench_torque_constant; }),
  };
  return keys;
}

/// The key of that path, or null.
template <Scalar S>
const Key<S>* find_key(std::string_view path) {
  for (const Key<S>& key : vehicle_keys<S>()) {
    if (key.path == path) return &key;
  }
  return nullptr;
}

/// "unknown key; did you mean motor.inertia?", or with the keys of its section where none is near.
std::string unknown_key_message(std::string_view path);

/// The key or section that an unknown key was probably to be, or empty where none is near.
std::string nearest_key(std::string_view path);

/// The name nearest to the given one, or empty where none is near.
std::string_view nearest_name(std::string_view given, std::span<const std::string_view> known);

/// The numeric key of that path. Throws ParameterError for an unknown key and for one that is not a number.
template <Scalar S>
const Key<S>& numeric_key(std::string_view path) {
  const Key<S>* key = find_key<S>(path);
  if (!key) throw ParameterError(std::string(path), unknown_key_message(path));
  if (!key->set) throw ParameterError(std::string(path), "is not a number");
  return *key;
}

/// Sets a numeric parameter [SI] by name. Throws ParameterError where numeric_key does, and where the design's choices
/// leave no place for the key. Does not check ranges: validate(design) does.
template <Scalar S>
void set_parameter(Design<S>& design, std::string_view path, const S& value) {
  const Key<S>& key = numeric_key<S>(path);
  if (key.set(design, value)) return;
  throw ParameterError(std::string(path), key.only_with.empty() ? "has no place in this design"
                                                                : "only with " + std::string(key.only_with));
}

/// True if some key lies below this path: "wing", "wing.planform".
bool is_section(std::string_view path);

/// The reference of all keys as Markdown: the generated part of docs/vehicle-file.md.
std::string vehicle_file_reference();

}  // namespace wingbeat
