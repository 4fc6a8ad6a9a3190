// Every parameter of a vehicle as its designer states it: the aggregate behind a vehicle file. resolve() in
// vehicle/vehicle.hpp turns it into the constants the equations use.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "wingbeat/core/members.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/parts/blade_element.hpp"
#include "wingbeat/parts/body.hpp"
#include "wingbeat/parts/electronics.hpp"
#include "wingbeat/parts/friction.hpp"
#include "wingbeat/parts/motor.hpp"
#include "wingbeat/parts/motor_thermal.hpp"
#include "wingbeat/parts/piezo.hpp"
#include "wingbeat/parts/pitch_hinge.hpp"
#include "wingbeat/parts/planform.hpp"
#include "wingbeat/parts/stroke_table.hpp"
#include "wingbeat/parts/supply.hpp"
#include "wingbeat/parts/transmission_type.hpp"
#include "wingbeat/parts/wing_mass.hpp"
#include "wingbeat/parts/wing_torsion.hpp"

namespace wingbeat {

/// Environment of a test: model.md section 3.
enum class Condition {
  air,
  vacuum,   ///< no aerodynamics, wings present
  wingless  ///< no wing: rod force zero
};
template <>
inline constexpr std::pair<const char*, Condition> names_of<Condition>[] = {
    {"air", Condition::air}, {"vacuum", Condition::vacuum}, {"wingless", Condition::wingless}};

/// What [motor] says of heat: on as soon as the thermal resistances are given, both of them.
template <Scalar S>
struct MotorThermalDesign {
  std::optional<S> resistance_winding;                            ///< R_th1 [K/W]
  std::optional<S> resistance_case;                               ///< R_th2 [K/W]
  S ambient_temperature = S(catalogue_temperature);               ///< T_amb [K]
  S reference_temperature = S(catalogue_temperature);             ///< T_0 [K]
  S copper_temperature_coefficient = S(copper_resistance_slope);  ///< a_Cu [1/K]
  S magnet_temperature_coefficient = S(0);                        ///< a_B [1/K]
  S winding_temperature_max = S(usual_winding_temperature_max);   ///< [K]
  std::optional<S> time_constant_winding;  ///< tau_w of the winding over the case [s], for flights
  std::optional<S> time_constant_case;     ///< tau_c of the case over the air [s], for flights

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.resistance_winding, self.resistance_case, self.ambient_temperature, self.reference_temperature,
               self.copper_temperature_coefficient, self.magnet_temperature_coefficient, self.winding_temperature_max,
               self.time_constant_winding, self.time_constant_case);
  }
};

/// [motor]: constants at the output shaft, or at the motor shaft with a gear ratio.
template <Scalar S>
struct MotorDesign {
  std::optional<S> gear_ratio;  ///< given: the constants below are the motor shaft's
  Motor<S> constants;
  S gear_inertia = S(0);                  ///< J_G [kg m2], only with gear_ratio
  S gear_damping = S(0);                  ///< b_G [N m s/rad], only with gear_ratio
  std::optional<S> gear_efficiency = {};  ///< eta [1]; 1 unless given
  MotorThermalDesign<S> thermal = {};
  S core_torque = S(0);   ///< c_h of the core loss [N m], where the constants are
  S core_damping = S(0);  ///< c_e of the core loss [N m s/rad], where the constants are

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.gear_ratio, self.constants, self.gear_inertia, self.gear_damping, self.gear_efficiency,
               self.thermal, self.core_torque, self.core_damping);
  }
};

/// [electronics] of a brushless motor: there as soon as the efficiency is given.
template <Scalar S>
struct ElectronicsDesign {
  std::optional<S> efficiency;   ///< eta_esc [1]
  std::optional<S> current_max;  ///< i_max of one motor [A]; none unless given
  bool regenerates = false;      ///< current may flow back

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.efficiency, self.current_max, self.regenerates);
  }
};

/// [piezo] in the place of [motor]: there as soon as the force per volt is given.
template <Scalar S>
struct PiezoDesign {
  std::optional<S> force_per_volt;    ///< kappa [N/V]
  Piezo<S> constants;                 ///< what else is required of it
  std::optional<S> series_stiffness;  ///< k_s [N/m]; a rigid transmission unless given

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.force_per_volt, self.constants, self.series_stiffness);
  }
};

/// [transmission]. Of a slider-crank exactly one of hinge offset and stroke amplitude is given; of a direct drive
/// nothing but the type; of the others what they need.
template <Scalar S>
struct TransmissionDesign {
  S crank_radius = S(0);               ///< r_c [m], of a slider-crank or four-bar
  S rod_length = S(0);                 ///< l [m]
  std::optional<S> hinge_offset;       ///< H [m]
  std::optional<S> stroke_amplitude;   ///< half peak to peak [rad], 0 to pi/2; fixes H for the given crank
  std::optional<S> mid_stroke_height;  ///< y_0 [m]; l unless given
  Formulation formulation = Formulation::rod_force;
  TransmissionType type = TransmissionType::slider_crank;
  S coupler_length = S(0);             ///< four-bar: l [m]
  S rocker_length = S(0);              ///< four-bar: p [m]
  S ground_length = S(0);              ///< four-bar: d [m]
  S stroke_ratio = S(1);               ///< four-bar: n_s [1]
  std::optional<S> ground_angle = {};  ///< four-bar: phi_mid [rad]; the middle of the rocker's swing unless given
  StrokeTable<S> table = {};           ///< tabulated

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.crank_radius, self.rod_length, self.hinge_offset, self.stroke_amplitude, self.mid_stroke_height,
               self.formulation, self.type, self.coupler_length, self.rocker_length, self.ground_length,
               self.stroke_ratio, self.ground_angle, self.table);
  }
};

/// [friction]: one law and its coefficient.
template <Scalar S>
struct FrictionDesign {
  FrictionLaw law = FrictionLaw::none;
  S coefficient = S(0);  ///< radius [m], damping [N m s/rad], coefficient [N m s2/rad2] or torque [N m] by law
  std::optional<S> reference_radius = {};  ///< of a direct drive whose friction follows the load, see DirectDrive [m]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.law, self.coefficient, self.reference_radius);
  }
};

/// [spring]: at most one of the three; none means no spring.
template <Scalar S>
struct SpringDesign {
  std::optional<S> stiffness;  ///< k of one hinge spring [N m/rad]
  /// f_s [Hz]: k = J_w (2 pi f_s)^2 (eq 22); of a direct drive, whose rotor swings along, k = (J/N_w + J_w) (2 pi
  /// f_s)^2
  std::optional<S> resonance;
  std::optional<S> resonance_ratio;  ///< direct: resonance over drive frequency [1]
  std::optional<S> rest_angle;       ///< direct: beta_0 [rad]; 0 unless given

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.stiffness, self.resonance, self.resonance_ratio, self.rest_angle);
  }
};

/// [wing.torsion]: linear twist along the span, a degree of freedom as soon as its stiffness is given.
template <Scalar S>
struct TorsionDesign {
  std::optional<S> stiffness;  ///< k_tau of one wing [N m/rad]
  S damping = S(0);            ///< c_tau of one wing [N m s/rad]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.stiffness, self.damping);
  }
};

/// [wing]
template <Scalar S>
struct WingDesign {
  S count = S(2);    ///< N_w of one motor
  S inertia = S(0);  ///< J_w of ONE wing about its hinge at planform.scale 1 [kg m2]
  Planform<S> planform;
  /// Direct: resonance of rotor and wings on their springs [Hz]; given, the inertia follows: J_w = k/(2 pi f)^2 - J/N_w
  std::optional<S> resonance;
  std::optional<S> areal_density;  ///< sigma of the membrane [kg/m2]; given, the inertia follows from the outline
  S spar_density = S(0);           ///< lambda of the leading-edge spar [kg/m], only with areal_density
  S rib_density = S(0);            ///< lambda_r of a rib [kg/m], only with areal_density
  S rib_count = S(0);              ///< n_r, ribs of one wing, only with areal_density
  std::optional<S> pitch_inertia;  ///< I_psi of one wing about its leading edge [kg m2], only with a pitch hinge
  std::optional<S> mass_product;   ///< P = integral r x dm of one wing [kg m2], only with a pitch hinge
  TorsionDesign<S> torsion;
  bool scale_inertia = true;  ///< inertia, pitch_inertia and mass_product grow with planform.scale

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.count, self.inertia, self.planform, self.resonance, self.areal_density, self.spar_density,
               self.rib_density, self.rib_count, self.pitch_inertia, self.mass_product, self.torsion,
               self.scale_inertia);
  }
};

/// [pitch]: the hinge about which a wing pitches, a degree of freedom in place of the pitch law as soon as its
/// stiffness is given.
template <Scalar S>
struct PitchDesign {
  std::optional<S> stiffness;  ///< k_psi of one hinge [N m/rad]
  S damping = S(0);            ///< c_psi of one hinge [N m s/rad]
  std::optional<S> stop;       ///< psi_max to either side [rad]; none unless given
  /// In place of `stop`, both: psi goes no lower, and no higher [rad].
  std::optional<S> stop_low, stop_high;
  bool rotational_lift = true;   ///< the force that a pitching wing's circulation adds; see rotation_with()
  S damping_coefficient = S(0);  ///< C_rd [1]; see rotation_with()
  S edge_suction = S(0);         ///< s_L of the added mass [1]
  S friction = S(0);             ///< T_psi of one hinge [N m]
  S axis = S(0);                 ///< x_0, behind the leading edge over the chord [1]
  CentreOfPressure centre_of_pressure = CentreOfPressure::fourier;

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.stiffness, self.damping, self.stop, self.stop_low, self.stop_high, self.rotational_lift,
               self.damping_coefficient, self.edge_suction, self.friction, self.axis, self.centre_of_pressure);
  }
};

/// [aerodynamics.clap_and_fling]: there as soon as the amplitude is given.
template <Scalar S>
struct ClapDesign {
  std::optional<S> amplitude;      ///< A [1]
  S decay = S(1);                  ///< lambda, in mean chords [1]
  S gap = S(1);                    ///< g, in mean chords [1]
  std::optional<S> meeting_angle;  ///< stroke angle at which the wings meet [rad]; that of two on one body unless given

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.amplitude, self.decay, self.gap, self.meeting_angle);
  }
};

/// [aerodynamics]
template <Scalar S>
struct AerodynamicsDesign {
  S air_density = S(0);                                  ///< rho [kg/m3]
  S pitch_coefficient = S(0);                            ///< C_alpha [s]; 0 where the wings pitch on a hinge
  std::string coefficients_name = "translational-2022";  ///< the named set, "custom" or "table"
  ForceCoefficients<S> coefficients;
  std::optional<S> angle_of_attack_min;  ///< stop of the passive pitching [rad]; none unless given
  bool added_mass = false;  ///< air accelerated with the wings counts, by strip theory (model.md section 10)
  S kinematic_viscosity = S(air_kinematic_viscosity);  ///< nu [m2/s], of the Reynolds number alone
  /// Reynolds numbers for which the coefficients hold [1]; those of the named set unless given.
  std::optional<S> reynolds_number_min, reynolds_number_max;
  /// In place of pitch_coefficient: the angle of attack at the largest |beta'| that C_alpha is found for [rad].
  std::optional<S> angle_of_attack;
  std::optional<S> lifting_span;      ///< B, part of the distance from hinge to tip that lifts [1]; all unless given
  std::optional<S> induced_velocity;  ///< share of the momentum theory's induced velocity that counts [1]
  std::optional<S> swept_area;        ///< A_0 of all wings [m2]; that of the stroke's sectors unless given
  ClapDesign<S> clap = {};
  std::shared_ptr<const LoadTable> load_table = nullptr;  ///< in place of coefficients: aerodynamics.type = "tabulated"
  std::optional<S> table_air_density;                     ///< of the table's loads [kg/m3]; air_density unless given
  std::optional<S> table_wings;                           ///< how many wings they are of [1]; all unless given

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.air_density, self.pitch_coefficient, self.coefficients_name, self.coefficients,
               self.angle_of_attack_min, self.added_mass, self.kinematic_viscosity, self.reynolds_number_min,
               self.reynolds_number_max, self.angle_of_attack, self.lifting_span, self.induced_velocity,
               self.swept_area, self.clap, self.load_table, self.table_air_density, self.table_wings);
  }
};

/// Masses that are stated for themselves. What is not counts in Design::mass.
template <Scalar S>
struct ItemMasses {
  std::optional<S> supply;              ///< battery with its leads [kg], >= 0
  std::optional<S> motor;               ///< one motor with its gearbox [kg], >= 0
  std::optional<S> rod_linear_density;  ///< mass of rod or coupler over its length [kg/m], >= 0
  std::optional<S> spring;              ///< one hinge spring [kg], >= 0; one for each wing

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.supply, self.motor, self.rod_linear_density, self.spring);
  }
};

template <Scalar S>
struct Design {
  std::string name;
  std::optional<S> mass;  ///< of all that `masses` does not state [kg]; enables lift_to_weight
  S motors = S(1);        ///< M, whole number >= 1: so many copies of [motor] to [wing], in phase on one supply
  ItemMasses<S> masses;
  std::optional<S> bench_torque_constant;  ///< K_ref of eq (17) [N m/A]
  Supply<S> supply;
  std::optional<S> supply_resonance_ratio;  ///< direct: drive frequency over resonance [1]; replaces supply.frequency
  MotorDesign<S> motor;
  TransmissionDesign<S> transmission;
  FrictionDesign<S> friction;
  SpringDesign<S> spring;
  WingDesign<S> wing;
  PitchDesign<S> pitch;
  AerodynamicsDesign<S> aerodynamics;
  ElectronicsDesign<S> electronics = {};
  PiezoDesign<S> piezo = {};
  BodyDesign<S> body = {};

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.name, self.mass, self.motors, self.masses, self.bench_torque_constant, self.supply,
               self.supply_resonance_ratio, self.motor, self.transmission, self.friction, self.spring, self.wing,
               self.pitch, self.aerodynamics, self.electronics, self.piezo, self.body);
  }
};

/// True where the pitch of the wings follows the stroke by the pitch law: neither a hinge nor torsion is stated.
template <Scalar S>
bool follows_pitch_law(const Design<S>& design) {
  return !design.pitch.stiffness && !design.wing.torsion.stiffness;
}

/// True where hinge springs are stated.
template <Scalar S>
bool has_springs(const Design<S>& design) {
  return design.spring.stiffness || design.spring.resonance || design.spring.resonance_ratio;
}

/// Mass properties of one wing that is stated by its material and pitches about that axis [1]; empty where its inertia
/// is stated.
template <Scalar S>
std::optional<WingMass<S>> wing_mass(const WingDesign<S>& wing, const S& axis = S(0.0)) {
  if (!wing.areal_density) return std::nullopt;
  return wing_mass(WingMaterial<S>{*wing.areal_density, wing.spar_density, wing.rib_density, wing.rib_count},
                   wing.planform, axis);
}

/// Length of the rod, of a four-bar the coupler [m]; empty where there is none.
template <Scalar S>
std::optional<S> rod_length(const TransmissionDesign<S>& t) {
  if (t.type == TransmissionType::slider_crank) return t.rod_length;
  if (t.type == TransmissionType::four_bar) return t.coupler_length;
  return std::nullopt;
}

/// Mass of the whole vehicle [kg]: vehicle.mass, every mass stated for itself and that of a battery that weighs by its
/// capacity; empty where vehicle.mass is not known. M motors with a rod of the linear density \f$\lambda_l\f$ and N
/// wings each, a hinge spring at every wing:
/// \f[
/// m = m_\mathrm{vehicle} + m_\mathrm{supply} + m_\mathrm{battery}
/// + M \left( m_\mathrm{motor} + \lambda_l\, l + N m_\mathrm{spring} \right)
/// \f]
template <Scalar S>
std::optional<S> total_mass(const Design<S>& design) {
  if (!design.mass) return std::nullopt;
  const ItemMasses<S>& items = design.masses;
  const std::optional<S> rod = rod_length(design.transmission);
  const S& M = design.motors;
  S mass = *design.mass;
  if (items.supply) mass = mass + *items.supply;
  if (has_battery(design.supply.type)) {
    if (const std::optional<S> battery = battery_mass(design.supply.battery)) mass = mass + *battery;
  }
  if (items.motor) mass = mass + M * *items.motor;
  if (items.rod_linear_density && rod) mass = mass + M * (*items.rod_linear_density * *rod);
  if (items.spring && has_springs(design)) mass = mass + M * (design.wing.count * *items.spring);
  return mass;
}

/// Holds the flapping frequency of a design whose supply sets it; false where the voltage does, as with a crank.
template <Scalar S>
bool set_drive_frequency(Design<S>& design, const S& frequency) {
  if (design.transmission.type != TransmissionType::direct) return false;
  design.supply.frequency = frequency;
  design.supply_resonance_ratio.reset();
  return true;
}

/// Throws ParameterError, naming the vehicle-file key, for the first parameter out of its physical range.
void validate(const Design<double>& design);

}  // namespace wingbeat
