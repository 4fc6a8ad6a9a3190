#include "wingbeat/vehicle/design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/core/text.hpp"
#include "wingbeat/parts/any_transmission.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"
#include "wingbeat/parts/friction.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/parts/spring.hpp"
#include "wingbeat/parts/wing_limits.hpp"
#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/parameters.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

/// What a number of a design may be, apart from the table's long rows: sweeps ask for it with every design.
struct NumberBounds {
  std::optional<double> (*get)(const Design<double>&);
  double lower, upper;  ///< finite; none of whole numbers
  const Parameter<double>* parameter;
};

std::vector<NumberBounds> bounds_of_numbers() {
  constexpr double infinity = std::numeric_limits<double>::infinity(), largest = std::numeric_limits<double>::max();
  std::vector<NumberBounds> numbers;
  for (const Parameter<double>& parameter : parameter_table<double>()) {
    if (!parameter.get) continue;
    const ParameterRange& r = parameter.range;
    NumberBounds number{parameter.get, r.above_lower ? std::nextafter(r.lower, infinity) : r.lower,
                        r.below_upper ? std::nextafter(r.upper, -infinity) : r.upper, &parameter};
    number.lower = r.whole ? infinity : std::max(number.lower, -largest);
    number.upper = r.whole ? -infinity : std::min(number.upper, largest);
    numbers.push_back(number);
  }
  return numbers;
}

/// Of a transmission that either fixes.
void validate_hinge_offset(const Design<double>& d) {
  const TransmissionDesign<double>& t = d.transmission;
  if (!takes_key(t.type, slider_crank_key::hinge_offset.path)) return;
  if (t.hinge_offset.has_value() == t.stroke_amplitude.has_value()) {
    throw ParameterError("transmission.hinge_offset", "give exactly one of hinge_offset and stroke_amplitude");
  }
  if (t.stroke_amplitude && t.mid_stroke_height) {
    throw ParameterError("transmission.stroke_amplitude",
                         "cannot be combined with mid_stroke_height; give hinge_offset instead");
  }
}

/// What a direct drive needs and cannot have.
void validate_direct(const Design<double>& d) {
  if (d.spring.rest_angle && !has_springs(d)) {
    throw ParameterError(spring_key::rest_angle.path, "there are no springs to be at rest: give spring.stiffness");
  }
  if (!is_sine(d.supply.type)) {
    throw ParameterError("supply.type", "a direct drive swings as its supply does: expected sine or battery-sine");
  }
  if (d.friction.law == FrictionLaw::load_proportional) {
    const std::optional<double>& r_ref = d.friction.reference_radius;
    if (!r_ref) {
      throw ParameterError(direct_drive_key::reference_radius.path,
                           "missing: load-proportional friction of a direct drive acts on the wings' moment over this "
                           "radius, at which the shaft takes it up");
    }
    if (!(d.friction.coefficient < *r_ref)) {
      throw ParameterError(friction_key::radius.path,
                           detail::format("must be < friction.reference_radius, %.4g m: such friction would exceed any "
                                          "moment, got %.4g m",
                                          *r_ref, d.friction.coefficient));
    }
  }
  if (d.friction.reference_radius && d.friction.law != FrictionLaw::load_proportional) {
    throw ParameterError(
        direct_drive_key::reference_radius.path,
        std::string("is where load-proportional friction acts: friction.type is ") + name_of(d.friction.law));
  }
  if (d.supply_resonance_ratio && d.spring.resonance_ratio) {
    throw ParameterError("supply.resonance_ratio",
                         "ties the frequency to the springs, which spring.resonance_ratio "
                         "ties to the frequency; give one of them");
  }
  if (d.wing.resonance && d.wing.areal_density) {
    throw ParameterError("wing.resonance",
                         "gives the wing's inertia, which wing.areal_density gives; give one of them");
  }
  if (d.wing.resonance && !d.spring.stiffness) {
    throw ParameterError("wing.resonance", "gives the inertia that resonates on a known spring; give spring.stiffness");
  }
  if (d.supply_resonance_ratio && !d.spring.stiffness && !d.spring.resonance) {
    throw ParameterError("supply.resonance_ratio",
                         "needs springs to resonate with; give spring.stiffness or "
                         "spring.resonance");
  }
}

/// What a piezo needs and cannot have.
void validate_piezo(const Design<double>& d) {
  if (d.transmission.type != TransmissionType::direct) {
    throw ParameterError("transmission.type",
                         "a piezo swings the wings through the transmission that [piezo] states: expected direct");
  }
  if (d.spring.resonance || d.spring.resonance_ratio || d.supply_resonance_ratio || d.wing.resonance) {
    const char* key = d.spring.resonance         ? "spring.resonance"
                      : d.spring.resonance_ratio ? "spring.resonance_ratio"
                      : d.wing.resonance         ? "wing.resonance"
                                                 : "supply.resonance_ratio";
    throw ParameterError(key,
                         "the stiffness of a piezo counts beside the springs': give spring.stiffness, wing.inertia "
                         "and supply.frequency");
  }
  if (d.electronics.efficiency) {
    throw ParameterError(electronics_key::efficiency.path,
                         "is of a brushless motor; what a piezo's electronics lose is piezo.recovered_share");
  }
}

/// Electronics turn a brushless motor one way.
void validate_electronics(const Design<double>& d) {
  if (!drive_of(d).rotates) {
    throw ParameterError(electronics_key::efficiency.path, "a brushless motor turns a crank: not of a direct drive");
  }
}

/// A bridge swings a direct drive, by no more than its battery's voltage; under load simulate_discharge() tells.
void validate_bridge(const Design<double>& d) {
  if (d.transmission.type != TransmissionType::direct) {
    throw ParameterError("supply.type", "the sine that a bridge makes is for a direct drive: expected battery");
  }
  const double E = open_circuit_voltage(d.supply.battery, d.supply.battery.charge);
  if (d.supply.voltage <= E) return;
  throw ParameterError(supply_key::amplitude.path,
                       detail::format("%.4g V exceed what the bridge has from the battery, %.4g V without load at a "
                                      "charge of %.4g",
                                      d.supply.voltage, E, d.supply.battery.charge));
}

/// Added mass takes inertia away where the wings pitch fast (model.md section 10): what is left must stay positive at
/// every angle of attack from the stop of the pitching or 0 to 90 deg, or the equations of motion have no unique
/// solution. At the stop itself the air's inertia is positive.
void validate_added_mass(const Design<double>& d, const Vehicle<double>& v) {
  const double J_a = v.wings.added_inertia;
  if (!(J_a > 0.0)) return;
  if (!(v.wings.pitch_coefficient > 0.0)) return;
  // C_alpha |beta'| where the share is least, to which it falls from 0: 1.5 sin(2 x) + x cos(2 x) = 0
  constexpr double least = 1.2278223736171916;
  const double x = std::min(least, 0.5 * pi - d.aerodynamics.angle_of_attack_min.value_or(0.0));
  const double share = square(std::cos(x)) - x * std::sin(x) * std::cos(x);
  const double own = v.wing_count * v.wing_inertia + (drive_of(d).rotates ? 0.0 : v.motor.inertia);
  if (own + share * J_a > 0.0) return;
  throw ParameterError(
      "aerodynamics.added_mass",
      detail::format(
          "the air's inertia of %.4g kg m2 is too large beside that of the wings, %.4g kg m2: at an angle of "
          "attack of %.1f deg %.3f of it counts, and no inertia is left",
          J_a, own, 90.0 - degrees_per_radian * x, share));
}

/// An angle of attack stands for the C_alpha that leads to it.
void validate_angle_of_attack(const AerodynamicsDesign<double>& air) {
  if (!air.angle_of_attack || !air.angle_of_attack_min) return;
  throw ParameterError(aerodynamics_key::angle_of_attack.path,
                       "is held by the stop angle_of_attack_min whatever C_alpha is; give pitch_coefficient beside it");
}

/// What acts by strips, at tips or between wings needs an outline, and not all of it goes together.
void validate_air_of_strips(const Design<double>& d) {
  const AerodynamicsDesign<double>& air = d.aerodynamics;
  const Planform<double>& planform = d.wing.planform;
  if (planform.shape == PlanformShape::moments) {
    for (const auto& [given, key] : {std::pair{air.lifting_span.has_value(), tip_loss_key::lifting_span.path},
                                     {air.induced_velocity.has_value(), induced_velocity_key::share.path},
                                     {air.clap.amplitude.has_value(), clap_and_fling_key::amplitude.path}}) {
      if (given) throw ParameterError(key, "needs the wing's outline: give a planform with a shape");
    }
    return;
  }
  const double tip = length_of(planform) + hub_offset_of(planform);
  if (air.lifting_span) {
    if (!(*air.lifting_span * tip > hub_offset_of(planform))) {
      throw ParameterError(tip_loss_key::lifting_span.path,
                           detail::format("leaves nothing of the wing that lifts: its root is at %.3f of the distance "
                                          "from hinge to tip, got %g",
                                          hub_offset_of(planform) / tip, *air.lifting_span));
    }
    if (d.wing.torsion.stiffness) {
      throw ParameterError(tip_loss_key::lifting_span.path, "is for wings that do not twist: without wing.torsion");
    }
    if (air.induced_velocity && planform.shape == PlanformShape::tabulated) {
      throw ParameterError(tip_loss_key::lifting_span.path,
                           "is not for a tabulated outline with induced_velocity; give one of them, or another shape");
    }
  }
  if (air.clap.amplitude && !air.clap.meeting_angle && !std::isfinite(stroke_where_wings_meet(planform))) {
    throw ParameterError(clap_and_fling_key::meeting_angle.path,
                         "missing: by wing.planform.shoulder_distance the wings never meet");
  }
}

/// Loads of a table come in the place of what blade elements need, and depend on no motion that the wings do not have.
void validate_load_table(const Design<double>& d) {
  const AerodynamicsDesign<double>& air = d.aerodynamics;
  if (!air.load_table) {
    for (const auto& [given, key] : {std::pair{air.table_air_density.has_value(), load_table_key::air_density.path},
                                     {air.table_wings.has_value(), load_table_key::wings.path}}) {
      if (given) throw ParameterError(key, "is of a table of loads: give aerodynamics.type = \"tabulated\"");
    }
    return;
  }
  for (const auto& [given, key] : {std::pair{air.lifting_span.has_value(), tip_loss_key::lifting_span.path},
                                   {air.induced_velocity.has_value(), induced_velocity_key::share.path},
                                   {air.clap.amplitude.has_value(), clap_and_fling_key::amplitude.path},
                                   {d.wing.torsion.stiffness.has_value(), torsion_key::stiffness.path}}) {
    if (given) throw ParameterError(key, "is not for tabulated loads, which hold for the wings as they are");
  }
  const LoadTable& table = *air.load_table;
  const bool of_pitch = table.axis(LoadCoordinate::pitch_angle) || table.axis(LoadCoordinate::pitch_velocity);
  if (follows_pitch_law(d) && of_pitch) {
    throw ParameterError(load_table_key::file,
                         "the load table depends on the pitch, which follows the stroke here; leave its columns out, "
                         "or give pitch.stiffness");
  }
  if (follows_pitch_law(d)) return;
  if (!table.axis(LoadCoordinate::pitch_angle) || !table.has_pitch_moment()) {
    throw ParameterError(load_table_key::file,
                         "of wings that pitch on a hinge the load table needs the columns pitch_angle, with more than "
                         "one value, and pitch_moment");
  }
}

/// A body needs a mass, all its moments of inertia, wings on both sides and an outline by whose strips they fly.
void validate_body(const Design<double>& d) {
  const BodyDesign<double>& b = d.body;
  if (!b.inertia_pitch) return;
  for (const auto& [given, key] : {std::pair{b.inertia_roll.has_value(), body_key::inertia_roll.path},
                                   {b.inertia_yaw.has_value(), body_key::inertia_yaw.path}}) {
    if (!given) throw ParameterError(key, "missing: a body has the three moments of inertia");
  }
  if (!d.mass) throw ParameterError("vehicle.mass", "missing: a body has a mass");
  const double I_x = *b.inertia_roll, I_y = *b.inertia_pitch, I_z = *b.inertia_yaw;
  if (!(square(b.inertia_product) < I_x * I_z)) {
    throw ParameterError(
        body_key::inertia_product.path,
        detail::format("must be smaller in size than sqrt(I_xx I_zz), %.4g kg m2", std::sqrt(I_x * I_z)));
  }
  if (b.inertia_product == 0.0 && !(I_x + I_y >= I_z && I_y + I_z >= I_x && I_z + I_x >= I_y)) {
    throw ParameterError(body_key::inertia_pitch.path,
                         "no body has these three moments of inertia: one is larger than the sum of the others");
  }
  if (b.wing_mass && !(b.wing_centre > 0.0)) {
    throw ParameterError(body_key::wing_centre.path, "missing: with wing_mass the distance of its centre of mass");
  }
  const double wings = d.motors * d.wing.count;
  if (!(d.motors == 1.0 || d.motors == 2.0) || !(wings == 2.0 || wings == 4.0)) {
    throw ParameterError("wing.count",
                         detail::format("a body carries two or four wings, driven by one motor, or by one "
                                        "on either side; got %g wings and %g motor%s",
                                        wings, d.motors, d.motors == 1.0 ? "" : "s"));
  }
  if (b.opposed && wings != 4.0) {
    throw ParameterError("body.opposed", "is of four wings, two on either side");
  }
}

/// A moment of inertia that is stated grows with the scale or does not; one that follows has no choice.
void validate_scale(const WingDesign<double>& wing) {
  if (wing.scale_inertia || !(wing.areal_density || wing.resonance)) return;
  throw ParameterError("wing.planform.scale_inertia",
                       std::string("is of a stated wing.inertia, which here follows from ") +
                           (wing.areal_density ? "wing.areal_density" : "wing.resonance"));
}

/// What wings that pitch on a hinge need and cannot have.
void validate_pitching(const Design<double>& d, const Vehicle<double>& v) {
  const bool inertia = d.wing.pitch_inertia.has_value(), product = d.wing.mass_product.has_value();
  if (follows_pitch_law(d)) {
    if (inertia || product) {
      throw ParameterError(inertia ? pitch_key::pitch_inertia.path : pitch_key::mass_product.path,
                           "is for wings that pitch or twist; give pitch.stiffness or wing.torsion.stiffness");
    }
    const CoefficientSet* set = coefficient_set(d.aerodynamics.coefficients_name);
    if (!set || !set->hinged_alone) return;
    throw ParameterError(
        "aerodynamics.coefficients",
        std::string(set->name) + " is for wings that pitch on a hinge; give pitch.stiffness, or translational-2022");
  }
  if (d.pitch.stop_low.has_value() != d.pitch.stop_high.has_value()) {
    throw ParameterError(d.pitch.stop_low ? pitch_key::stop_high.path : pitch_key::stop_low.path,
                         "missing: give both stop_low and stop_high, or stop to either side alike");
  }
  const char* key = d.pitch.stiffness ? pitch_key::stiffness.path : torsion_key::stiffness.path;
  if (d.wing.planform.shape == PlanformShape::moments) {
    throw ParameterError(key, "needs the wing's outline: give a planform with a shape");
  }
  if (d.wing.areal_density && (inertia || product)) {
    throw ParameterError(inertia ? pitch_key::pitch_inertia.path : pitch_key::mass_product.path,
                         "follows from wing.areal_density; give one of them");
  }
  if (!d.wing.areal_density && !(inertia && product)) {
    throw ParameterError(inertia ? pitch_key::mass_product.path : pitch_key::pitch_inertia.path,
                         "missing: wings that pitch or twist need pitch_inertia and mass_product, or areal_density");
  }
  validate(v.pitch, v.wing_count * v.wing_inertia);
}

}  // namespace

void throw_missing_pitch_coefficient() {
  throw ParameterError(aerodynamics_key::angle_of_attack.path,
                       "stands for a C_alpha that this does not find; give aerodynamics.pitch_coefficient instead, "
                       "which wingbeat run prints for the vehicle");
}

Design<double> with_any_pitch_coefficient(Design<double> d) {
  std::optional<double>& angle = d.aerodynamics.angle_of_attack;
  if (!angle) return d;
  angle.reset();
  if (!(d.aerodynamics.pitch_coefficient > 0.0)) d.aerodynamics.pitch_coefficient = usual_pitch_coefficient;
  return d;
}

void validate(const Design<double>& d) {
  static const std::vector<NumberBounds> numbers = bounds_of_numbers();
  for (const NumberBounds& number : numbers) {
    const std::optional<double> x = number.get(d);
    if (!x || (*x >= number.lower && *x <= number.upper)) continue;
    const ParameterRange& range = number.parameter->range;
    if (range.whole && range.holds(*x) && std::isfinite(*x)) continue;
    throw ParameterError(std::string(number.parameter->path),
                         range_message(range.expected, std::string(number.parameter->unit).c_str(), *x));
  }
  if (has_battery(d.supply.type)) {
    validate(d.supply.battery);
    if (d.supply.battery.specific_energy && d.masses.supply) {
      throw ParameterError(battery_key::specific_energy.path,
                           "gives the mass of the battery, which supply.mass states; give one of them");
    }
  }
  if (has_battery(d.supply.type) && d.supply.throttle == Throttle::hover && !d.mass) {
    throw ParameterError("supply.throttle", "hover needs vehicle.mass, the weight to be carried");
  }
  if (d.supply.type == SupplyType::battery_sine) validate_bridge(d);
  if (d.piezo.force_per_volt) validate_piezo(d);
  else if (d.electronics.efficiency) validate_electronics(d);

  const TransmissionType type = d.transmission.type;
  if (d.masses.rod_linear_density && !rod_length(d.transmission)) {
    throw ParameterError(
        "transmission.rod_linear_density",
        std::string("a ") + name_of(type) + (drive_of(d).rotates ? " transmission" : " drive") + " has no rod");
  }
  validate_hinge_offset(d);
  if (type == TransmissionType::direct) validate_direct(d);
  if (int(d.spring.stiffness.has_value()) + d.spring.resonance.has_value() + d.spring.resonance_ratio.has_value() > 1) {
    throw ParameterError("spring.stiffness", drive_of(d).alternating
                                                 ? "give one of stiffness, resonance and resonance_ratio"
                                                 : "give one of stiffness and resonance, not both");
  }
  validate(d.wing.planform);
  const Planform<double>& planform = d.wing.planform;
  if (d.aerodynamics.added_mass && planform.shape == PlanformShape::moments && !planform.s22) {
    throw ParameterError("aerodynamics.added_mass",
                         "needs the wing's outline: give wing.planform.s22, or a planform with a shape");
  }
  if (d.wing.areal_density && planform.shape == PlanformShape::moments) {
    throw ParameterError(wing_material_key::areal_density.path,
                         "needs the wing's outline: give a planform with a shape, or wing.inertia");
  }
  if ((d.wing.rib_count > 0.0) != (d.wing.rib_density > 0.0)) {
    const bool counted = d.wing.rib_count > 0.0;
    throw ParameterError(counted ? wing_material_key::rib_density.path : wing_material_key::rib_count.path,
                         counted ? detail::format("0 or missing beside wing.rib_count = %g: a rib has a mass over its "
                                                  "length",
                                                  d.wing.rib_count)
                                 : detail::format("0 or missing beside wing.rib_density = %.4g kg/m: there is no rib "
                                                  "to have it",
                                                  d.wing.rib_density));
  }
  const AerodynamicsDesign<double>& air = d.aerodynamics;
  if (air.reynolds_number_min && air.reynolds_number_max && !(*air.reynolds_number_min < *air.reynolds_number_max)) {
    throw ParameterError(wing_limits_key::reynolds_number_max.path, "must exceed reynolds_number_min");
  }
  const MotorThermalDesign<double>& thermal = d.motor.thermal;
  if (thermal.resistance_winding.has_value() != thermal.resistance_case.has_value()) {
    throw ParameterError(thermal.resistance_winding ? motor_thermal_key::resistance_case.path
                                                    : motor_thermal_key::resistance_winding.path,
                         "missing: give both thermal resistances, of winding and case, or neither");
  }

  validate_angle_of_attack(air);
  validate_air_of_strips(d);
  validate_load_table(d);
  validate_body(d);
  validate_scale(d.wing);

  const Vehicle<double> v = resolve(with_any_pitch_coefficient(d));
  if (drive_of(d).rotates) validate(v.transmission);
  if (thermal.time_constant_winding.has_value() != thermal.time_constant_case.has_value()) {
    throw ParameterError(thermal.time_constant_winding ? motor_thermal_key::time_constant_case.path
                                                       : motor_thermal_key::time_constant_winding.path,
                         "missing: give both thermal time constants, of winding and case, or neither");
  }
  validate(v.spring);
  validate(v.thermal);
  validate(v.wings);
  validate_added_mass(d, v);
  validate_pitching(d, v);
  if (d.supply_resonance_ratio && !(v.drive_frequency > 0.0)) {
    throw ParameterError("supply.resonance_ratio", "the springs' stiffness is 0: nothing resonates");
  }
  if (d.wing.resonance) {
    require(v.wing_inertia > 0.0, "wing.resonance", "leaves the wings no inertia beside the rotor's: must be lower",
            "Hz", *d.wing.resonance);
  }
}

}  // namespace wingbeat
