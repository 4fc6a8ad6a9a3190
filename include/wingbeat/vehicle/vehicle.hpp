// A vehicle ready for the equations of motion (vehicle/motion.hpp), from what its designer states.
#pragma once

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/any_transmission.hpp"
#include "wingbeat/parts/blade_element.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"
#include "wingbeat/parts/electronics.hpp"
#include "wingbeat/parts/friction.hpp"
#include "wingbeat/parts/motor.hpp"
#include "wingbeat/parts/motor_thermal.hpp"
#include "wingbeat/parts/piezo.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/parts/spring.hpp"
#include "wingbeat/parts/wing_limits.hpp"
#include "wingbeat/vehicle/design.hpp"
#include "wingbeat/vehicle/drive.hpp"

namespace wingbeat {

inline constexpr double standard_gravity = 9.80665;  ///< [m/s2], CGPM 1901

/// The constants of one vehicle in one condition, all referred to the output shaft. Several motors with their
/// transmissions and wings are one that acts as they do together (model.md section 13): its current, torques, forces
/// and powers are the sums of theirs. The equations of motion and the system of a crank take any template V of
/// the same members whose `transmission` satisfies the concept Transmission.
template <Scalar S>
struct Vehicle {
  S voltage;  ///< v that steady flapping sees [V], at the motor terminals where there is no source resistance
  Motor<S> motor;
  AnyTransmission<S> transmission;
  Friction<S> friction;
  HingeSpring<S> spring;
  S wing_count;    ///< N_w, of all motors
  S wing_inertia;  ///< \f$J_\mathrm{w}\f$ of one wing [kg m2]; 0 when wingless
  BladeElement<S> wings;
  S source_resistance = S(0);          ///< R_i inside the supply [ohm], >= 0: the terminals see v - R_i i
  S drive_frequency = S(0);            ///< of a sine supply, whose amplitude is `voltage` [Hz]; else 0
  MotorThermal<S> thermal;             ///< what changes `motor` where it heats up; see with_motor_at()
  S motors = S(1);                     ///< M: rod forces are reported of one of so many rods
  OffLanes<PitchingWings, S> pitch{};  ///< of wings whose pitch is a degree of freedom; see pitches()
  /// T_x that a load outside the vehicle takes from crank or shaft, against a positive speed [N m]; no design states
  /// one. SIMD packs do not know it.
  S load_torque = S(0);
  WingLimits<S> wing_limits;  ///< beyond which the wings or their coefficients are no longer what the equations say
  S voltage_offset = S(0);    ///< V_0 of a sine supply [V]
  OffLanes<Electronics, S> electronics{};
  /// In place of the motor, of which `motor` then has inertia and damping, about stroke angle zero.
  OffLanes<Piezo, S> piezo{};

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.voltage, self.motor, self.transmission, self.friction, self.spring, self.wing_count,
               self.wing_inertia, self.wings, self.source_resistance, self.drive_frequency, self.thermal, self.motors,
               self.pitch, self.load_torque, self.wing_limits, self.voltage_offset, self.electronics, self.piezo);
  }
};

/// True where pitch, or the torsion of wings that are clamped at their root, is a degree of freedom (model.md sections
/// 12, 16) instead of following the stroke by the pitch law.
template <Scalar S>
bool pitches(const Vehicle<S>& v) {
  return value_of(v.pitch.pitch_inertia) > 0.0;
}

/// The transmission that a design describes.
template <Scalar S>
AnyTransmission<S> transmission_of(const TransmissionDesign<S>& t) {
  return transmission_from<S>(t);
}

/// What a design says of its motor's temperatures.
template <Scalar S>
MotorThermal<S> motor_thermal_of(const MotorThermalDesign<S>& t) {
  MotorThermal<S> thermal;
  if (!t.resistance_winding || !t.resistance_case) return thermal;
  thermal = {*t.resistance_winding,
             *t.resistance_case,
             t.ambient_temperature,
             t.reference_temperature,
             t.copper_temperature_coefficient,
             t.magnet_temperature_coefficient,
             t.winding_temperature_max};
  return thermal;
}

/// By what the stated moments of inertia of a wing are multiplied to be those of the scaled one, whose materials have
/// the density of the stated one's: \f$s^5\f$; 1 where they are stated of the scaled wing.
template <Scalar S>
S inertia_scale(const WingDesign<S>& wing) {
  const S& s = wing.planform.scale;
  return wing.scale_inertia ? S(square(square(s)) * s) : S(1.0);
}

/// Wings that pitch on the hinges that a design describes, or twist, `count` of them, in air of that density [kg/m3].
template <Scalar S>
PitchingWings<S> pitching_wings_of(const Design<S>& design, const S& count, const S& air_density) {
  const PitchDesign<S>& p = design.pitch;
  const TorsionDesign<S>& torsion = design.wing.torsion;
  PitchingWings<S> wings;
  PitchHinge<S> hinge{p.stiffness ? *p.stiffness : S(0.0), p.damping};
  if (p.stop) set_stops(hinge, *p.stop);
  if (p.stop_low && p.stop_high) hinge.stop_low = *p.stop_low, hinge.stop_high = *p.stop_high;
  if (!p.stiffness) set_stops(hinge, S(0.0));
  if (p.stiffness) hinge.friction = p.friction;
  wings.hinge = hinges_together(hinge, count);
  if (torsion.stiffness) {
    wings.torsion = wing_torsion(design.wing.planform, count, *torsion.stiffness, torsion.damping);
  }
  if (const std::optional<WingMass<S>> drawn = wing_mass(design.wing, p.axis)) {
    wings.pitch_inertia = count * drawn->pitch_inertia;
    wings.mass_product = count * drawn->mass_product;
  }
  if (design.wing.pitch_inertia)
    wings.pitch_inertia = count * (inertia_scale(design.wing) * *design.wing.pitch_inertia);
  if (design.wing.mass_product) wings.mass_product = count * (inertia_scale(design.wing) * *design.wing.mass_product);
  wings.moments = pitch_chord_moments(design.wing.planform, count);
  wings.axis = p.axis;
  wings.centre_of_pressure = p.centre_of_pressure;
  if (design.aerodynamics.added_mass) wings.air = pitch_added_mass(air_density, wings.moments, p.axis);
  wings.rotational_coefficient = p.rotational_lift ? rotational_coefficient_of(p.axis) : S(0.0);
  wings.damping_coefficient = p.damping_coefficient;
  wings.edge_suction = p.edge_suction;
  if (design.aerodynamics.coefficients_name == normal_force_set) wings.normal_force = NormalForce::normal_force;
  return wings;
}

/// The stroke angle [rad] at which a turning crank reverses with the largest of its stroke angles.
template <Scalar S>
S largest_stroke_angle(const AnyTransmission<S>& t) {
  const Reversals found = reversals(cast<double>(t));
  S largest(-infinity);
  const auto take = [&](double crank_angle) {
    const S angle = stroke_angle(crank_kinematics(t, S(std::sin(crank_angle)), S(std::cos(crank_angle))));
    if (value_of(angle) > value_of(largest)) largest = angle;
  };
  for (std::size_t n = 0; n < found.count; ++n) take(found.angle[n]);
  take(0.0);
  return largest;
}

/// What of the air acts by strips, at tips and between wings, of wings that a design describes, `count` of them.
template <Scalar S>
void set_air_of_strips(const Design<S>& design, const S& count, Vehicle<S>& v) {
  const AerodynamicsDesign<S>& a = design.aerodynamics;
  const Planform<S>& planform = design.wing.planform;
  if (planform.shape == PlanformShape::moments) return;
  const S R = length_of(planform), d = hub_offset_of(planform), tip_radius = R + d;
  const S B = a.lifting_span ? *a.lifting_span : S(1.0);
  if (a.lifting_span) v.wings.tip = tip_loss(planform, count, B, drag_coefficient(v.wings.coefficients, S(0.0)));
  if (a.induced_velocity) {
    v.wings.wake.share = *a.induced_velocity;
    v.wings.wake.sector = count * square(tip_radius);
    if (a.swept_area) v.wings.wake.swept_area = *a.swept_area;
    v.wings.wake.strips = wake_strips(planform, count, a.lifting_span ? S((B * tip_radius - d) / R) : S(1.0));
  }
  if (a.clap.amplitude) {
    const S chord = wing_area(planform) / R;
    const S meeting = a.clap.meeting_angle ? *a.clap.meeting_angle : stroke_where_wings_meet(planform);
    v.wings.clap.amplitude = *a.clap.amplitude;
    v.wings.clap.decay_angle = a.clap.decay * chord / (S(clap_station) * tip_radius);
    v.wings.clap.reach = clap_reach(meeting, a.clap.gap, chord, tip_radius);
    if (drive_of(v).stroke_is_fixed) v.wings.clap.reversal = largest_stroke_angle(v.transmission);
  }
}

/// Limits of the wings that a design describes, `count` of them on one body.
template <Scalar S>
WingLimits<S> wing_limits_of(const Design<S>& design, const S& count, Condition condition) {
  const Planform<S>& planform = design.wing.planform;
  WingLimits<S> limits;
  if (condition == Condition::wingless) return limits;
  if (value_of(count) >= 2.0) limits.stroke_max = stroke_where_wings_meet(planform);
  const AerodynamicsDesign<S>& a = design.aerodynamics;
  if (condition != Condition::air || !(value_of(a.air_density) > 0.0)) return limits;
  limits.reynolds_number_per_speed = reynolds_number_per_speed(planform, a.kinematic_viscosity);
  const ReynoldsRange published = reynolds_range_of(a.coefficients_name);
  limits.reynolds_number_min = a.reynolds_number_min ? *a.reynolds_number_min : S(published.lowest);
  limits.reynolds_number_max = a.reynolds_number_max ? *a.reynolds_number_max : S(published.highest);
  return limits;
}

/// The piezo that a design describes in the place of a motor, `count` of them, and what it is about the stroke angle
/// zero: \f$J = m_\mathrm{a} / T_1^2\f$, \f$b = c_\mathrm{a} / T_1^2\f$.
template <Scalar S>
void set_piezo(Vehicle<S>& v, const PiezoDesign<S>& d, const S& count) {
  Piezo<S> one = d.constants;
  one.force_per_volt = *d.force_per_volt;
  if (d.series_stiffness) one.series_stiffness = *d.series_stiffness;
  v.piezo = side_by_side(one, count);
  const S per_ratio = S(1.0) / square(v.piezo.transmission_ratio);
  v.motor = {S(0.0), S(0.0), S(0.0), v.piezo.mass * per_ratio, v.piezo.damping * per_ratio};
}

/// Gives the motor the mean voltage [V] that a search tries: a battery's speed control does so by its duty D, with
/// whose square the resistance between them goes. `v` stands at a voltage > 0 where it has such a resistance.
template <Scalar S>
void set_mean_voltage(Vehicle<S>& v, const S& voltage) {
  if (value_of(v.source_resistance) > 0.0) v.source_resistance = v.source_resistance * square(voltage / v.voltage);
  v.voltage = voltage;
}

/// True where C_alpha is still to be found for an angle of attack. Without air it has no effect.
template <Scalar S>
bool needs_pitch_coefficient(const Design<S>& design, Condition condition) {
  return condition == Condition::air && design.aerodynamics.angle_of_attack.has_value() && follows_pitch_law(design);
}

[[noreturn]] void throw_missing_pitch_coefficient();

/// C_alpha [s] with which searches for one begin.
inline constexpr double usual_pitch_coefficient = 5e-3;

/// The design with a C_alpha > 0 in place of the angle of attack that it states: for what no C_alpha changes.
Design<double> with_any_pitch_coefficient(Design<double> design);

/// The vehicle that a design describes, in a condition, its motor's constants as stated, at the reference temperature.
/// Does not check ranges: validate(design) does. Throws ParameterError for a design that states an angle of attack, for
/// which C_alpha is to be found first (study/pitch_search.hpp).
template <Scalar S>
Vehicle<S> resolve(const Design<S>& design, Condition condition = Condition::air) {
  if (needs_pitch_coefficient(design, condition)) throw_missing_pitch_coefficient();
  Vehicle<S> v;
  v.voltage = mean_voltage(design.supply);
  v.source_resistance = source_resistance(design.supply);
  const MotorDesign<S>& m = design.motor;
  Motor<S> constants = m.constants;
  constants.friction_torque = constants.friction_torque + m.core_torque;
  constants.viscous_damping = constants.viscous_damping + m.core_damping;
  v.motor = m.gear_ratio ? at_output_shaft(GearMotor<S>{*m.gear_ratio, constants, m.gear_inertia, m.gear_damping})
                         : constants;
  if (m.gear_efficiency) v.motor.gear_efficiency = *m.gear_efficiency;
  v.thermal = motor_thermal_of(m.thermal);
  const S& M = v.motors = design.motors;
  v.motor = side_by_side(v.motor, M);
  if (heats_up(v.thermal)) v.thermal = side_by_side(v.thermal, M);
  if (design.piezo.force_per_volt) set_piezo(v, design.piezo, M);
  if (design.electronics.efficiency) {
    v.electronics.efficiency = *design.electronics.efficiency;
    v.electronics.regenerates = design.electronics.regenerates;
    if (design.electronics.current_max) v.electronics.current_max = M * *design.electronics.current_max;
  }

  const bool direct = design.transmission.type == TransmissionType::direct;
  v.transmission = transmission_of(design.transmission);
  if (design.friction.reference_radius) v.transmission.direct.reference_radius = *design.friction.reference_radius;

  const S& coefficient = design.friction.coefficient;
  if (S* of_law = coefficient_of(v.friction, design.friction.law)) *of_law = coefficient;
  v.friction = side_by_side(v.friction, M);

  const bool wings = condition != Condition::wingless;
  v.wing_count = M * design.wing.count;
  // Inertia on one spring, spring and drive frequency: of a direct drive any of them may follow from the others.
  const S rotor_share = direct ? v.motor.inertia / v.wing_count : S(0.0);
  S wing_inertia = inertia_scale(design.wing) * design.wing.inertia;
  if (const std::optional<WingMass<S>> drawn = wing_mass(design.wing)) wing_inertia = drawn->inertia;
  S stiffness = design.spring.stiffness ? *design.spring.stiffness : S(0.0);
  if (design.wing.resonance) wing_inertia = stiffness / square(S(two_pi) * *design.wing.resonance) - rotor_share;
  const S inertia = rotor_share + wing_inertia;
  const bool sine = is_sine(design.supply.type);
  v.drive_frequency = sine ? design.supply.frequency : S(0.0);
  v.voltage_offset = sine ? design.supply.offset : S(0.0);
  if (design.spring.resonance) stiffness = stiffness_for_resonance(inertia, *design.spring.resonance);
  if (design.spring.resonance_ratio) {
    stiffness = stiffness_for_resonance<S>(inertia, *design.spring.resonance_ratio * design.supply.frequency);
  }
  if (design.supply_resonance_ratio) {
    v.drive_frequency = *design.supply_resonance_ratio * resonance_of(inertia, stiffness);
  }
  v.wing_inertia = wings ? wing_inertia : S(0.0);
  v.spring.stiffness = wings ? stiffness : S(0.0);
  if (design.spring.rest_angle && wings && direct) v.spring.rest_angle = *design.spring.rest_angle;

  const bool air = condition == Condition::air;
  const ChordMoments<S> moments = chord_moments(design.wing.planform, design.wing.count);
  v.wings.air_density = air ? design.aerodynamics.air_density : S(0.0);
  v.wings.pitch_coefficient = follows_pitch_law(design) ? design.aerodynamics.pitch_coefficient : S(0.0);
  v.wings.s2 = wings ? S(M * moments.s2) : S(0.0);
  v.wings.s3 = wings ? S(M * moments.s3) : S(0.0);
  v.wings.coefficients = design.aerodynamics.coefficients;
  if (design.aerodynamics.angle_of_attack_min) v.wings.angle_of_attack_min = *design.aerodynamics.angle_of_attack_min;
  if (design.aerodynamics.added_mass && wings) {
    const S s22 = M * squared_chord_moment(design.wing.planform, design.wing.count);
    v.wings.added_inertia = added_inertia_of(v.wings.air_density, s22);
  }
  if (!follows_pitch_law(design) && wings) v.pitch = pitching_wings_of(design, v.wing_count, v.wings.air_density);
  if (air) set_air_of_strips(design, v.wing_count, v);
  if (air && design.aerodynamics.load_table) {
    const AerodynamicsDesign<S>& a = design.aerodynamics;
    v.wings.tabulated.table = a.load_table;
    if (a.table_air_density) v.wings.tabulated.factor = a.air_density / *a.table_air_density;
    if (a.table_wings) v.wings.tabulated.factor = v.wings.tabulated.factor * v.wing_count / *a.table_wings;
  }
  v.wing_limits = wing_limits_of(design, v.wing_count, condition);
  return v;
}
extern template Vehicle<double> resolve(const Design<double>&, Condition);  // compiled once, in src/vehicle/vehicle.cpp

/// The vehicle with its motor, stated at the reference temperature, at other temperatures [K].
template <template <Scalar> class V, Scalar S>
V<S> with_motor_at(V<S> vehicle, const MotorTemperatures<S>& temperatures) {
  vehicle.motor = at_temperatures(vehicle.motor, vehicle.thermal, temperatures);
  return vehicle;
}

/// The vehicle as it is switched on: the motor as warm as its surroundings.
template <template <Scalar> class V, Scalar S>
V<S> switched_on(const V<S>& v) {
  return heats_up(v.thermal) ? with_motor_at(v, {v.thermal.ambient_temperature, v.thermal.ambient_temperature}) : v;
}

}  // namespace wingbeat
