// What feeds the motor terminals; model.md section 1, v.
#pragma once

#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/battery.hpp"

namespace wingbeat {

enum class SupplyType {
  constant,
  sine,
  pwm,
  battery,
  battery_sine  ///< a bridge that makes a sine of a battery's voltage
};
template <>
inline constexpr std::pair<const char*, SupplyType> names_of<SupplyType>[] = {
    {"constant", SupplyType::constant},
    {"sine", SupplyType::sine},
    {"pwm", SupplyType::pwm},
    {"battery", SupplyType::battery},
    {"battery-sine", SupplyType::battery_sine}};

/// What the speed control of a vehicle on a battery does in flight.
enum class Throttle {
  fixed,  ///< holds the duty, or the amplitude of a bridge
  hover   ///< sets it so that the mean lift carries the weight
};
template <>
inline constexpr std::pair<const char*, Throttle> names_of<Throttle>[] = {{"fixed", Throttle::fixed},
                                                                          {"hover", Throttle::hover}};

constexpr bool is_sine(SupplyType type) { return type == SupplyType::sine || type == SupplyType::battery_sine; }
constexpr bool has_battery(SupplyType type) { return type == SupplyType::battery || type == SupplyType::battery_sine; }

template <Scalar S>
struct Supply {
  SupplyType type = SupplyType::constant;
  S voltage = S(
      0);  ///< constant: v; sine, battery_sine: amplitude; pwm: voltage while switched on [V], >= 0; battery: not used
  S frequency = S(0);  ///< sine, battery_sine: drive frequency; pwm: switching frequency [Hz], > 0
  S duty = S(1);       ///< pwm, battery: fraction of a period switched on [1], 0 to 1; 1 connects the motor directly
  Battery<S> battery = {};
  S offset = S(0);                      ///< sine, battery_sine: V_0, constant part of the voltage [V]
  Throttle throttle = Throttle::fixed;  ///< of a battery

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.type, self.voltage, self.frequency, self.duty, self.battery, self.offset, self.throttle);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace supply_key {
inline constexpr ParameterKey voltage{"supply.voltage", "V", range::not_negative};
inline constexpr ParameterKey amplitude{"supply.amplitude", "V", range::not_negative};
inline constexpr ParameterKey frequency{"supply.frequency", "Hz", range::positive};
inline constexpr ParameterKey duty{"supply.duty", "1", range::zero_to_one};
inline constexpr ParameterKey offset{"supply.offset", "V", range::any};
}  // namespace supply_key

inline void validate(const Supply<double>& s) {
  if (has_battery(s.type)) validate(s.battery);
  if (s.type == SupplyType::pwm || s.type == SupplyType::battery) require(supply_key::duty, s.duty);
  if (s.type == SupplyType::battery) return;
  require(is_sine(s.type) ? supply_key::amplitude : supply_key::voltage, s.voltage);
  if (s.type != SupplyType::constant) require(supply_key::frequency, s.frequency);
}

/// The constant voltage [V] that steady flapping sees: v itself (of a sine its amplitude), the mean \f$D v\f$ over a
/// switching period for pwm of the duty D, \f$D n E(s)\f$ for a battery with the open-circuit voltage \f$n E(s)\f$ at
/// its state of charge.
template <Scalar S>
S mean_voltage(const Supply<S>& s) {
  if (s.type == SupplyType::battery) return s.duty * open_circuit_voltage(s.battery, s.battery.charge);
  return s.type == SupplyType::pwm ? s.duty * s.voltage : s.voltage;
}

/// Resistance [ohm] between that voltage and the motor terminals: of a battery \f$D^2 n R_\mathrm{i}\f$, for of the
/// motor's current i the switches take \f$D i\f$ from it; none otherwise, for a bridge holds its amplitude.
/// \f[
/// v = D \left( n E(s) - n R_\mathrm{i} D i \right)
/// \f]
template <Scalar S>
S source_resistance(const Supply<S>& s) {
  return s.type == SupplyType::battery ? s.duty * s.duty * source_resistance(s.battery) : S(0.0);
}

/// Voltage [V] at time t [s] that the supply drives through its resistance: of a sine of the amplitude V, the offset
/// V_0 and the frequency f [Hz], of pwm of the voltage V while it is switched on; otherwise mean_voltage().
/// \f[
/// v_\mathrm{sine} = V_0 + V \sin 2 \pi f t, \qquad
/// v_\mathrm{pwm} = \begin{cases} V & f t - \lfloor f t \rfloor < D \\ 0 & \text{otherwise} \end{cases}
/// \f]
inline double voltage_at(const Supply<double>& s, double t) {
  if (is_sine(s.type)) return s.offset + s.voltage * std::sin(two_pi * s.frequency * t);
  if (s.type == SupplyType::pwm) {
    const double phase = s.frequency * t - std::floor(s.frequency * t);
    return phase < s.duty ? s.voltage : 0.0;
  }
  return mean_voltage(s);
}

}  // namespace wingbeat
