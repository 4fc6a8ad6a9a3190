// The parts of a flight that work at instants of their own: sensors, actuators, battery.
#pragma once

#include <deque>
#include <vector>

#include "wingbeat/flight/fly.hpp"
#include "wingbeat/flight/simulation.hpp"

namespace wingbeat::detail {

/// Samples of the body's motion with noise; what is known of it a delay later, averaged over a while.
class SensorSet {
 public:
  SensorSet(const FlightSensors& sensors, double average);

  void sample(double time, const BodyState& body);
  /// Of the samples that have arrived by then, those within the averaging time.
  FlightMeasurement measured(double time);

 private:
  struct Sample {
    double time;
    FlightMeasurement seen;
  };
  FlightSensors sensors_;
  double average_;
  NormalNumbers noise_;
  std::deque<Sample> samples_;
};

/// First-order actuators, whose mean over a step is held over it.
class ActuatorSet {
 public:
  ActuatorSet(const FlightActuators& actuators, const FlightControls& first, double step)
      : actuators_(actuators), at_(first), step_(step) {}
  FlightControls follow(const FlightControls& command);

 private:
  FlightActuators actuators_;
  FlightControls at_;
  double step_;
};

/// The battery that all drives share: it gives their mean electrical power at the current (E - R I) I = P.
class BatteryInFlight {
 public:
  explicit BatteryInFlight(const FlightVehicle& vehicle);

  bool there() const { return there_; }
  /// After a time in which the drives took that energy [J].
  void use(double time, double energy);
  double charge() const { return charge_; }
  double available() const;  ///< the largest voltage, or amplitude of a bridge [V]
  double given() const { return given_; }
  /// Empty, or at its cut-off voltage.
  bool ended() const { return ended_; }
  /// Limits voltages to what there is.
  FlightControls within(FlightControls controls) const;

 private:
  Battery<double> battery_;
  bool there_ = false, bridge_ = false, ended_ = false;
  double charge_ = 1.0, current_ = 0.0, given_ = 0.0;
};

/// Tilt of the body's z axis from the vertical [rad].
double tilt_of(const BodyState& body);

}  // namespace wingbeat::detail
