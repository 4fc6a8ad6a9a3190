// A motor's constants from what its maker publishes: weighted least squares, contradictions and gaps in words.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/core/names.hpp"
#include "wingbeat/parts/motor.hpp"
#include "wingbeat/study/motor_heating.hpp"

namespace wingbeat {

/// A point of the performance curve; two of torque, speed and current fix it, the rest is checked.
struct MotorPoint {
  std::optional<double> voltage;     ///< [V]; the sheet's unless given
  std::optional<double> torque;      ///< [N m]
  std::optional<double> speed;       ///< [rad/s]
  std::optional<double> current;     ///< [A]
  std::optional<double> efficiency;  ///< torque speed / (voltage current) [1]
};

enum class Shaft { motor, output };
template <>
inline constexpr std::pair<const char*, Shaft> names_of<Shaft>[] = {{"motor", Shaft::motor}, {"output", Shaft::output}};

/// A data sheet. Torques, speeds, constants and the inertia stand for `shaft`; the rotor's own inertia and size always
/// for the motor shaft.
struct MotorDatasheet {
  std::string name;
  Shaft shaft = Shaft::motor;
  double gear_ratio = 1.0;                             ///< n, motor turns per output turn
  std::optional<double> gear_efficiency;               ///< output over input torque of the gearbox under load [1]
  std::optional<double> voltage;                       ///< at which the no-load, stall and point values hold [V]
  std::optional<double> no_load_speed;                 ///< [rad/s]
  std::optional<double> no_load_current;               ///< [A]
  std::optional<double> stall_torque;                  ///< [N m]
  std::optional<double> stall_current;                 ///< [A]
  std::optional<double> resistance;                    ///< R_a [ohm]
  std::optional<double> torque_constant;               ///< [N m/A]
  std::optional<double> speed_constant;                ///< [rad/s/V], the torque constant's reciprocal
  std::optional<double> friction_torque;               ///< constant friction torque [N m]
  std::optional<double> viscous_damping;               ///< [N m s/rad]
  std::optional<double> inductance;                    ///< L_a [H]
  std::optional<double> rotor_inertia;                 ///< J_m at the motor shaft [kg m2]
  std::optional<double> mechanical_time_constant;      ///< R_a J / K^2 of the motor alone [s]
  std::optional<double> rotor_diameter, rotor_length;  ///< [m]
  std::vector<MotorPoint> points;
  // Of the motor's heat, handed on as they are.
  std::optional<double> thermal_resistance_winding, thermal_resistance_case;  ///< R_th1, R_th2 [K/W], both or neither
  std::optional<double> winding_temperature_max;                              ///< [K]
  std::optional<double> thermal_time_constant_winding, thermal_time_constant_case;  ///< tau_w, tau_c [s]
  std::optional<HeatingCurve> heating;  ///< from which those not above are found, or all of them
  /// Relative standard deviation of a value by its name ("stall_current"), and of all others.
  std::map<std::string, double> deviations;
  double deviation = 0.05;
  // What may be assumed where the sheet says nothing; nothing is unless asked for here.
  bool assume_steel_cylinder = false;   ///< rotor inertia of a solid steel cylinder of rotor_diameter and rotor_length
  bool assume_typical_damping = false;  ///< typical_motor_damping
};

/// Viscous loss coefficient of a small coreless motor at the motor shaft [N m s/rad], a fallback.
inline constexpr double typical_motor_damping = 29.6e-9;
/// Density of steel [kg/m3], of the fallback for the rotor's inertia.
inline constexpr double steel_density = 7850.0;

/// Ways to one constant, or a published value and the identified motor, that lie further apart than by this factor are
/// no matter of accuracy: the sheet is refused, unless the deviations given for them allow it.
inline constexpr double contradiction_factor = 3.0;

/// A constant with its standard error from the sheet's deviations and its contradictions.
struct IdentifiedConstant {
  std::optional<double> value;  ///< empty: the sheet does not determine it
  double standard_error = 0.0;
  std::string source;  ///< what it rests on, or what is missing, in words
};

/// One value of the sheet beside what the identified motor gives for it.
struct DatasheetCheck {
  std::string name, unit;  ///< SI
  double published;
  double identified;
  double deviation;  ///< identified / published - 1
};

/// A number without the rounding errors of a fit: that of 12 digits where that is as near as fits converge, 3e-13.
double without_rounding_errors(double x);

/// A value [SI] in a unit of data sheets: "2.11 mN m/A", "13250 rpm".
std::string datasheet_text(double value, std::string_view unit);

/// Two ways to one constant that do not agree.
struct Contradiction {
  std::string constant, unit;  ///< "armature resistance", SI
  std::string first, second;   ///< what each rests on
  double first_value, second_value;
  double size;         ///< relative difference
  bool gross = false;  ///< beyond contradiction_factor
};

struct MotorIdentification {
  // At the output shaft.
  IdentifiedConstant armature_resistance, armature_inductance, torque_constant, inertia, viscous_damping,
      friction_torque;
  std::vector<DatasheetCheck> checks;
  std::vector<Contradiction> contradictions;  ///< largest first
  /// How much wider the sheet's values scatter about the identified motor than their deviations say, at least 1;
  /// standard errors are multiplied by it (Birge 1932, Phys. Rev. 40, 207).
  double birge_ratio = 1.0;
  std::vector<std::string> remarks;        ///< assumptions made, in words
  std::vector<std::string> missing;        ///< constants that could not be determined, and what would do it
  std::optional<HeatIdentification> heat;  ///< of the heating curve
  bool complete() const { return missing.empty(); }
  /// Throws std::logic_error unless complete().
  Motor<double> motor() const;
};

/// True of a sheet with a heating curve that states nothing of the motor but its resistance.
bool is_of_heat_alone(const MotorDatasheet& sheet);

/// A thermal constant for [motor]: from the heating curve where it determines it, else the sheet's.
std::optional<double> thermal_constant(const MotorDatasheet& sheet, const MotorIdentification& motor,
                                       HeatConstant which);

/// Identifies the motor. `frequency` [Hz], where the user has one in mind, serves the remark about the inductance.
/// Throws ParameterError for values out of range.
MotorIdentification identify_motor(const MotorDatasheet& sheet, std::optional<double> frequency = {});

}  // namespace wingbeat
