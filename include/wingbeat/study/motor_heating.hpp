// Thermal resistances and time constants of a motor from a heating curve: least squares on the two lumps of model.md
// section 11.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/core/names.hpp"
#include "wingbeat/parts/motor_thermal.hpp"

namespace wingbeat {

/// How the motor is during the curve: in neither case does the shaft give power.
enum class HeatedMotor {
  stalled,  ///< held: all that goes in is copper loss
  idling    ///< runs without load: what is no copper loss is lost in the case
};
template <>
inline constexpr std::pair<const char*, HeatedMotor> names_of<HeatedMotor>[] = {{"stalled", HeatedMotor::stalled},
                                                                                {"idling", HeatedMotor::idling}};

/// A motor that heats up from one temperature. Columns are as long as `time`, or empty; NaN where a value is missing.
struct HeatingCurve {
  std::string source;  ///< the file, for messages
  HeatedMotor motor = HeatedMotor::stalled;
  std::vector<double> time;                            ///< growing, from the moment the voltage is switched on at 0 [s]
  std::vector<double> current;                         ///< [A]
  std::vector<double> voltage;                         ///< at the terminals [V]
  std::vector<double> winding_temperature;             ///< [K]
  std::vector<double> case_temperature;                ///< [K]
  std::vector<double> resistance;                      ///< of the winding [ohm]
  std::optional<double> held_current, held_voltage;    ///< one of them, where it is no column
  double ambient_temperature = catalogue_temperature;  ///< [K]
  std::optional<double> start_temperature;             ///< of winding and case at time 0 [K]; the air's unless given
  std::optional<double> cold_resistance;               ///< R_a at the reference temperature, where nothing shows it
  double reference_temperature = catalogue_temperature;             ///< T_0 [K]
  double copper_temperature_coefficient = copper_resistance_slope;  ///< a_Cu [1/K]
};

enum class HeatConstant { resistance_winding, resistance_case, time_constant_winding, time_constant_case };
inline constexpr int heat_constant_count = 4;

/// A constant with its 95 % interval.
struct HeatValue {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// How well one column of the curve is met.
struct HeatColumn {
  std::string name;  ///< "winding_temperature"
  std::string unit;
  std::size_t count = 0;  ///< values used
  double scatter = 0.0;   ///< standard deviation about the fitted curve
};

struct HeatIdentification {
  /// By HeatConstant, SI; empty where the curve does not determine it.
  std::array<std::optional<HeatValue>, heat_constant_count> constants;
  /// What is determined where its parts are not: R_th1 + R_th2 [K/W], tau_c / R_th2 [J/K].
  std::optional<HeatValue> resistance_sum, case_heat_capacity;
  std::optional<HeatValue> start_resistance;  ///< of the winding at the start [ohm], where the curve shows it
  std::vector<HeatColumn> columns;            ///< those fitted
  std::vector<std::string> missing;  ///< which constants are not determined, why, and what would determine them
  std::vector<std::string> remarks;

  const std::optional<HeatValue>& operator[](HeatConstant c) const { return constants[std::size_t(c)]; }
  bool complete() const;
};

/// "thermal_resistance_winding", the key of [motor], and its unit.
std::string_view key_of(HeatConstant c);
std::string_view unit_of(HeatConstant c);

/// The curve that the constants lead to, at its times: temperatures [K] of winding and case, from the start. With the
/// rise \f$x\f$ of the winding over the case and \f$y\f$ of the case over the air:
/// \f[
/// \tau_\mathrm{w} \dot x = R_\mathrm{th1} P_\mathrm{cu} - x, \qquad
/// \tau_\mathrm{c} \dot y = R_\mathrm{th2} (P_\mathrm{cu} + P_\mathrm{case}) - y
/// \f]
std::vector<MotorTemperatures<double>> heating_of(const HeatingCurve& curve,
                                                  const std::array<double, heat_constant_count>& constants,
                                                  double start_resistance);

/// Throws ParameterError, by the key of [heating], for a curve that is no heating curve.
void validate(const HeatingCurve& curve);

/// Fits what the curve determines. Standard deviations of the columns come from the curve's own scatter; where
/// neighbouring residuals resemble each other the intervals are widened. Throws as validate() does.
HeatIdentification identify_heat(const HeatingCurve& curve);

}  // namespace wingbeat
