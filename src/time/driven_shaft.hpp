// A shaft under a sine supply: what the models in time of direct drives share; model.md section 6.
#pragma once

#include <array>
#include <cmath>
#include <functional>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/direct_balance.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {

struct DrivenShaft {
  Vehicle<double> vehicle;
  double w, period;  ///< of the supply: angular frequency [rad/s], duration [s]
  bool inductive;
  double inertia;                           ///< of rotor and wings [kg m2]
  std::function<double(double t)> command;  ///< the voltage that drives in the supply's place [V], where there is one

  /// Throws ParameterError for numbers out of range.
  explicit DrivenShaft(const Vehicle<double>& v) : vehicle(v) {
    validate(vehicle.motor);
    validate(vehicle.friction);
    validate(vehicle.spring);
    validate(vehicle.wings);
    require(vehicle.voltage >= 0.0, "supply.amplitude", "must be >= 0", "V", vehicle.voltage);
    require(vehicle.drive_frequency > 0.0, "supply.frequency", "must be > 0", "Hz", vehicle.drive_frequency);
    w = two_pi * vehicle.drive_frequency;
    period = 1.0 / vehicle.drive_frequency;
    inductive = has_current_state(vehicle);
    inertia = vehicle.motor.inertia + vehicle.wing_count * vehicle.wing_inertia;
  }

  // As TimeModel asks.
  static bool ended() { return false; }
  static double next_switch() { return infinity; }
  static void switch_supply() {}
  static void catch_up_with_supply() {}

  double voltage(double t) const { return command ? command(t) : vehicle.voltage * std::sin(w * t); }
  /// Moment of all hinge springs [N m].
  double springs_of(double beta) const { return vehicle.wing_count * vehicle.spring.stiffness * beta; }
  /// Of what the reactive work is the variation: wings and springs [J].
  double wing_energy(double beta, double speed) const {
    return 0.5 * vehicle.wing_count * (vehicle.wing_inertia * square(speed) + vehicle.spring.stiffness * square(beta));
  }

  /// The balance at that amplitude [V].
  DirectBalance balance_at(double amplitude) const {
    Vehicle<double> there = vehicle;
    there.voltage = amplitude;
    return direct_balance(there);
  }
  /// Typical sizes of beta [rad], beta' [rad/s] and i [A] from these on.
  std::array<double, 3> typical_from(const DirectBalance& balance, double beta, double start_speed,
                                     double current) const {
    const Motor<double>& m = vehicle.motor;
    const double natural = std::max(w, std::sqrt(vehicle.wing_count * vehicle.spring.stiffness / inertia));
    double speed = balance.responses.empty()
                       ? std::max(0.0, balance.drive_torque - balance.breakaway_torque) / (inertia * w)
                       : std::abs(balance.responses.back().speed);
    speed = std::max({speed, std::abs(start_speed), std::abs(beta) * natural});
    if (!(speed > 0.0)) speed = 1.0;
    return {std::max(speed / natural, std::abs(beta)), speed,
            std::max({balance.drive_torque / m.torque_constant, std::abs(current),
                      1e-3 * m.torque_constant * speed / m.armature_resistance})};
  }
};

}  // namespace wingbeat::detail
