// Temperatures of a motor and what they change; docs/model.md section 11.
#pragma once

#include <cmath>
#include <limits>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/motor.hpp"

namespace wingbeat {

inline constexpr double zero_celsius = 273.15;           ///< [K]
inline constexpr double catalogue_temperature = 298.15;  ///< T_0 of motor catalogues [K], 25 degC
/// Largest winding temperature where a data sheet gives none [K], 125 degC: that of most small motors' data sheets lies
/// between 85 and 155 degC, 155 degC being the limit of insulation of class F (IEC 60085).
inline constexpr double usual_winding_temperature_max = 398.15;
inline constexpr double copper_melting_point = 1357.77;    ///< [K], fixed point of ITS-90
inline constexpr double copper_resistance_slope = 0.0039;  ///< a_Cu of annealed copper [1/K], IEC 60028 rounded

/// Two lumps: the copper loss heats the winding, which passes it on to the case, which passes it on to the air together
/// with what the motor loses in viscous damping and in its own friction. Not a number for both resistances: the motor
/// keeps its constants at any load. In steady flapping (model.md section 11), with what is lost in the case
/// \f$P_\mathrm{visc} + P_\mathrm{motor}\f$:
/// \f[
/// \begin{aligned}
/// T_\mathrm{case} &= T_\mathrm{amb} + R_\mathrm{th2} (P_\mathrm{cu} + P_\mathrm{visc} + P_\mathrm{motor}), \qquad
/// T_\mathrm{w} = T_\mathrm{case} + R_\mathrm{th1} P_\mathrm{cu} \cr
/// R_\mathrm{a} &= R_\mathrm{a0} \left( 1 + a_\mathrm{Cu} (T_\mathrm{w} - T_0) \right), \qquad
/// K = K_0 \left( 1 + a_B (T_\mathrm{case} - T_0) \right)
/// \end{aligned}
/// \f]
template <Scalar S>
struct MotorThermal {
  S resistance_winding = S(std::numeric_limits<double>::quiet_NaN());  ///< R_th1 [K/W], >= 0
  S resistance_case = S(std::numeric_limits<double>::quiet_NaN());     ///< R_th2 [K/W], >= 0
  S ambient_temperature = S(catalogue_temperature);                    ///< T_amb [K]
  S reference_temperature = S(catalogue_temperature);             ///< T_0 at which the motor's constants are stated [K]
  S copper_temperature_coefficient = S(copper_resistance_slope);  ///< \f$a_\mathrm{Cu}\f$ [1/K], >= 0
  S magnet_temperature_coefficient = S(0);                        ///< \f$a_B\f$ [1/K], <= 0
  S winding_temperature_max = S(usual_winding_temperature_max);   ///< largest temperature allowed to the winding [K]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.resistance_winding, self.resistance_case, self.ambient_temperature, self.reference_temperature,
               self.copper_temperature_coefficient, self.magnet_temperature_coefficient, self.winding_temperature_max);
  }
};

/// What the losses of `count` equal motors together heat each of them by: \f$R_\mathrm{th1}/M\f$,
/// \f$R_\mathrm{th2}/M\f$.
template <Scalar S>
MotorThermal<S> side_by_side(MotorThermal<S> t, const S& count) {
  t.resistance_winding = t.resistance_winding / count;
  t.resistance_case = t.resistance_case / count;
  return t;
}

/// Temperatures of the two lumps [K].
template <Scalar S>
struct MotorTemperatures {
  S winding;  ///< T_w
  S casing;   ///< T_case
};

/// True where thermal resistances are stated: the constants of the motor follow its temperatures.
template <Scalar S>
bool heats_up(const MotorThermal<S>& t) {
  return !std::isnan(value_of(t.resistance_winding));
}

/// Temperatures [K] at which the motor settles under steady losses [W], P_case being those in viscous damping and in
/// its own friction; not a number without thermal resistances.
/// \f[
/// T_\mathrm{case} = T_\mathrm{amb} + R_\mathrm{th2} (P_\mathrm{cu} + P_\mathrm{case}), \qquad
/// T_\mathrm{w} = T_\mathrm{case} + R_\mathrm{th1} P_\mathrm{cu}
/// \f]
template <Scalar S>
MotorTemperatures<S> settled_temperatures(const MotorThermal<S>& t, const S& P_copper, const S& P_case) {
  const S T_case = t.ambient_temperature + t.resistance_case * (P_copper + P_case);
  return {T_case + t.resistance_winding * P_copper, T_case};
}

/// The motor, whose constants are stated at T_0, at other temperatures. A magnet too hot to have a field has none: K is
/// never negative.
/// \f[
/// R_\mathrm{a}(T_\mathrm{w}) = R_\mathrm{a0} \left( 1 + a_\mathrm{Cu} (T_\mathrm{w} - T_0) \right), \qquad
/// K(T_\mathrm{case}) = K_0 \max\left( 1 + a_B (T_\mathrm{case} - T_0),\, 0 \right)
/// \f]
template <Scalar S>
Motor<S> at_temperatures(Motor<S> motor, const MotorThermal<S>& t, const MotorTemperatures<S>& temperatures) {
  const S T_0 = t.reference_temperature;
  const S field = S(1.0) + t.magnet_temperature_coefficient * (temperatures.casing - T_0);
  motor.armature_resistance =
      motor.armature_resistance * (S(1.0) + t.copper_temperature_coefficient * (temperatures.winding - T_0));
  motor.torque_constant = motor.torque_constant * select(field > S(0.0), field, S(0.0));
  return motor;
}

namespace range {
inline constexpr ParameterRange temperature{"173.15 to 1000 K (-100 to 727 degC)",
                                            "must lie between -100 and 727 degC, 173.15 and 1000", 173.15, 1000.0};
inline constexpr ParameterRange not_positive{"<= 0", "must be <= 0", -endless, 0.0};
}  // namespace range

/// Keys, units and ranges; the table of parameters has them from here.
namespace motor_thermal_key {
inline constexpr ParameterKey resistance_winding{"motor.thermal_resistance_winding", "K/W", range::not_negative};
inline constexpr ParameterKey resistance_case{"motor.thermal_resistance_case", "K/W", range::not_negative};
inline constexpr ParameterKey ambient_temperature{"motor.ambient_temperature", "K", range::temperature};
inline constexpr ParameterKey reference_temperature{"motor.reference_temperature", "K", range::temperature};
inline constexpr ParameterKey copper_temperature_coefficient{"motor.copper_temperature_coefficient", "1/K",
                                                             range::not_negative};
inline constexpr ParameterKey magnet_temperature_coefficient{"motor.magnet_temperature_coefficient", "1/K",
                                                             range::not_positive};
inline constexpr ParameterKey winding_temperature_max{"motor.winding_temperature_max", "K", range::temperature};
inline constexpr ParameterKey time_constant_winding{"motor.thermal_time_constant_winding", "s", range::positive};
inline constexpr ParameterKey time_constant_case{"motor.thermal_time_constant_case", "s", range::positive};
}  // namespace motor_thermal_key

/// Throws ParameterError where the surroundings leave the winding no resistance or the magnet no field.
inline void validate(const MotorThermal<double>& t) {
  if (!heats_up(t)) return;
  const double from_T_0 = t.ambient_temperature - t.reference_temperature;
  require(1.0 + t.copper_temperature_coefficient * from_T_0 > 0.0,
          motor_thermal_key::copper_temperature_coefficient.path,
          "leaves the winding no resistance at the ambient temperature: must be lower", "1/K",
          t.copper_temperature_coefficient);
  require(1.0 + t.magnet_temperature_coefficient * from_T_0 > 0.0,
          motor_thermal_key::magnet_temperature_coefficient.path,
          "leaves the magnet no field at the ambient temperature: must be nearer to 0", "1/K",
          t.magnet_temperature_coefficient);
}

}  // namespace wingbeat
