// The domain of validity: where the metrics of a cycle mean something; model.md section 7, docs/domain.md.
#pragma once

#include <array>
#include <bitset>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

/// A limit of the domain. The order is that of the bits in data sets.
enum class DomainLimit {
  angle_of_attack,       ///< 0 to 90 deg over the whole cycle: what the force coefficients were fitted to
  stroke,                ///< of the tan-law mechanism 85 deg to either side, else 180; less where two wings meet
  formulation_residual,  ///< |P_residual| at most 5 % of the input power
  mechanism_efficiency,  ///< P_aero/P_m from 0 to 1, in air
  motor_efficiency,      ///< P_m/P_e from 0 to 1; with the above, so is the system efficiency
  input_power,           ///< P_e positive and finite
  flow_speed,            ///< wings below Mach 0.3: the coefficients are those of incompressible flow
  winding_temperature,   ///< of a motor that heats up: as the vehicle states, else 125 degC
  reynolds_number,       ///< that of the named force coefficients, or as the vehicle states
  load_table             ///< motion of the wings within the grid of a table of loads
};
inline constexpr int domain_limit_count = int(DomainLimit::load_table) + 1;

/// Indexed by DomainLimit. A set bit: that limit is exceeded; none(): inside.
using DomainStatus = std::bitset<domain_limit_count>;

inline constexpr double angle_of_attack_lowest_deg = 0.0;
inline constexpr double angle_of_attack_highest_deg = 90.0;
inline constexpr double pitching_angle_highest_deg = 180.0;  ///< of wings that pitch on a hinge
/// Largest stroke angle of the tan-law mechanism [deg]. The law reaches 90 deg only with a hinge offset of zero, so
/// that every amplitude obeys it; at 85 deg the side load on the slider, whose friction is not modelled, is 11 rod
/// forces.
inline constexpr double tan_law_stroke_max_deg = 85.0;
inline constexpr double other_stroke_max_deg = 180.0;  ///< of any other drive: beyond, a wing turns past its own start
inline constexpr double formulation_residual_max = 0.05;   ///< of the input power
inline constexpr double formulation_residual_warn = 0.01;  ///< of the input power: said beside the result
inline constexpr double added_mass_lift_warn = 0.05;       ///< of the mean lift: said beside the result
inline constexpr double efficiency_slack = 1e-4;           ///< efficiencies are as exact as the tolerance of the orbit
/// Largest speed of the wings at the radius S_3/S_2, two thirds of a semi-ellipse's length [m/s]: Mach 0.3 at 20 degC.
inline constexpr double flow_speed_max = 103.0;

/// How a limit is named outside the program.
struct DomainLimitInfo {
  const char* key;      ///< as in JSON and data sets, e.g. "angle_of_attack"
  const char* meaning;  ///< plain words, with the numbers
};
const std::array<DomainLimitInfo, domain_limit_count>& domain_limit_table();

/// By how much each limit is exceeded, as a share of it: positive outside, at most 0 inside, -1 where it does not
/// apply. NaN counts as outside.
using DomainExcess = std::array<double, domain_limit_count>;
/// Of a flapping vehicle. From what the vehicle is and what its cycle gives, by whichever solver; of the metrics it
/// needs those of domain_metrics().
DomainExcess domain_excess(const Vehicle<double>& vehicle, const Metrics<double>& metrics);

/// Derivative of domain_excess() where the metrics change at the rates `slopes`, the vehicle itself held: `stroke` with
/// a crank, which geometry alone decides, has 0.
DomainExcess domain_excess_slopes(const Vehicle<double>& vehicle, const Metrics<double>& metrics,
                                  const Metrics<double>& slopes);

/// The limit `stroke`: of the stroke angle to either side, of a direct drive of the amplitude [deg].
double stroke_max_deg(const Vehicle<double>& vehicle);

/// Metrics that domain_excess() reads.
std::bitset<metric_count> domain_metrics();

/// Which limits are exceeded by a flapping vehicle.
DomainStatus domain_of(const Vehicle<double>& vehicle, const Metrics<double>& metrics);
DomainStatus domain_of(const DomainExcess& excess);

/// "inside", or the limits that are exceeded, as "angle_of_attack, stroke".
std::string name_of(DomainStatus status);

/// A limit that a cycle exceeds: what lies outside which bounds. In words: describe().
struct DomainEvidence {
  enum class Quantity {
    angle_of_attack_min,      ///< smallest of the cycle [deg]
    angle_of_attack_max,      ///< largest of the cycle [deg], of wings that pitch on a hinge
    angle_of_attack_range,    ///< the same [deg], where the coefficients end before the 90 deg of the reversals
    stroke_angle,             ///< largest to either side, by the mechanism's geometry [deg]
    stroke_amplitude,         ///< of a direct drive [deg]
    wings_meet,               ///< either [deg], where two wings on one body meet before
    residual_share,           ///< |P_residual / P_e| [1]
    mechanism_efficiency,     ///< P_aero / P_m [1]
    aerodynamic_power,        ///< P_aero [W] where the motor gives nothing; at most P_m
    motor_efficiency,         ///< P_m / P_e [1]
    input_power,              ///< P_e [W]
    flow_speed,               ///< largest at the radius S_3/S_2 [m/s]
    winding_temperature,      ///< of a motor that heats up [degC]
    thermal_runaway,          ///< the same [degC], where the losses do not settle before copper melts
    reynolds_number,          ///< of the mean chord at the mean speed of the wing tips [1]
    table_stroke_angle,       ///< largest to either side [deg]
    table_flapping_velocity,  ///< largest [rad/s]
    table_pitch_angle         ///< largest to either side [deg]
  };
  DomainLimit limit;
  Quantity quantity;
  double value;            ///< in the quantity's unit
  double lowest, highest;  ///< bounds, in the same
};

/// The limits that a flapping vehicle exceeds, in the order of DomainLimit; empty inside.
std::vector<DomainEvidence> domain_evidence(const Vehicle<double>& vehicle, const Metrics<double>& metrics);

/// One clause for each limit: "the angle of attack falls to -103 deg (the coefficients hold from 0 to 90 deg)"; empty
/// inside.
std::string describe(std::span<const DomainEvidence> evidence);

/// The share of the input power that `rod-force` fails to conserve [1], where it exceeds formulation_residual_warn.
std::optional<double> notable_residual(const Vehicle<double>& vehicle, const Metrics<double>& metrics);

/// The sentence that says so.
std::string residual_warning(double share);

/// The part of the mean lift that added mass gives because its force along the chord is left out [1], where its
/// magnitude exceeds added_mass_lift_warn.
std::optional<double> notable_added_mass_lift(const Metrics<double>& metrics);

/// The sentence that says so, `suction` being the share of that force that counts.
std::string added_mass_warning(double share, double suction);

/// The winding temperature [degC], where it is above the largest that the vehicle allows.
std::optional<double> hot_winding(const Vehicle<double>& vehicle, const Metrics<double>& metrics);

/// The sentence that says so; both temperatures in degC.
std::string winding_warning(double temperature, double allowed);

}  // namespace wingbeat
