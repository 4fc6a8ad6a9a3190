// A vehicle on its battery at one moment of the discharge: how it flaps there, and what the battery gives.
#pragma once

#include <cmath>
#include <optional>

#include "study/hover_throttle.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {

struct FlightMoment {
  bool flaps = false;
  FlappingStatus status = FlappingStatus::stalled;
  StatusEvidence evidence;
  Metrics<double> metrics;
  DomainStatus domain = {};
  double voltage = absent;  ///< mean one without load, or a bridge's amplitude [V]
  double duty = 1.0;        ///< of a battery without a bridge
};

/// What the battery gives, on average.
struct BatteryLoad {
  double voltage, current;  ///< at its terminals [V], [A]; absent where it cannot give the power
  double internal_power;    ///< [W]
};

/// The mean current from the battery at a duty D [A]: that of the motor times D, or, where electronics or a bridge pass
/// the power on, the smaller of the two that give it (P_e the mean electrical power).
/// \f[
/// I = D\, \overline{i} \qquad \text{or} \qquad (E - R_\mathrm{i} I)\, I = P_\mathrm{e}
/// \f]
double battery_current(const Metrics<double>& metrics, double duty, double open_circuit_voltage, double resistance,
                       bool power_passed_on);

class FlightMoments {
 public:
  using Temperatures = std::optional<MotorTemperatures<double>>;

  FlightMoments(const Design<double>& design, const EnduranceOptions& options);

  /// At an open-circuit voltage [V]. At given temperatures the motor has not settled: metrics and domain are those of
  /// the instant. Without a start-up the vehicle turns already.
  FlightMoment at(double voltage, const Temperatures& temperatures, const StartUp& start_up);

  /// At full throttle: a duty of 1, or a bridge's amplitude of all that the battery has; with Throttle::hover alone.
  SteadyFlapping at_full_throttle(double voltage, const Temperatures& temperatures, const StartUp& start_up);
  DomainStatus domain_at_full_throttle(double voltage, const Metrics<double>& metrics) const;

  BatteryLoad load_of(const FlightMoment& moment, double voltage) const;

  /// Why there is no flight at that moment; empty where there is.
  std::optional<EnduranceEnd> end_at(const FlightMoment& moment, double voltage) const;

  /// A throttle holds the lift at the weight, to rounding on either side.
  bool carries(const FlightMoment& moment) const;

  bool bridged() const { return bridged_; }
  bool throttled() const { return throttle_.has_value(); }
  bool weighed() const { return std::isfinite(steady_.reporting.mass); }
  const MotorThermal<double>& thermal() const { return vehicle_.thermal; }
  int evaluations() const { return evaluations_ + (throttle_ ? throttle_->evaluations() : 0); }

 private:
  Vehicle<double> full_throttle(double voltage) const;
  void state_temperatures(Metrics<double>& metrics, const MotorTemperatures<double>& temperatures) const;

  const Battery<double>& battery_;
  bool bridged_;
  double duty_;  ///< fixed
  Vehicle<double> vehicle_;
  SteadyOptions steady_;
  std::optional<HoverThrottle> throttle_;
  std::optional<FlightMoment> on_bridge_;  ///< the same at any charge: the bridge holds its amplitude
  int evaluations_ = 0;
};

}  // namespace wingbeat::detail
