// Trials of one vehicle at many voltages, with exact derivatives by the voltage: what both searches for one share.
#pragma once

#include <optional>
#include <vector>

#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/study/frequency_search.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {

struct VoltageTrial {
  double voltage = 0.0;
  bool flaps = false;
  FlappingStatus status = FlappingStatus::stalled;
  StatusEvidence evidence;
  double frequency = absent;           ///< [Hz]
  double power = absent;               ///< mean electrical [W]
  bool exact = false;                  ///< both slopes; else 1 and 0 stand for them
  double frequency_slope = absent;     ///< d ln f / d ln v
  double lift = absent;                ///< mean [N]
  double lift_peak = absent;           ///< [N]
  double lift_slope = absent;          ///< d lift / d ln v [N]
  double pitching = absent;            ///< 90 deg less the smallest angle of attack [deg]
  DomainExcess excess = {};            ///< over each limit of the range, > 0 outside
  bool inside = false;                 ///< the range that is searched
  bool beyond = false;                 ///< so fast that no higher voltage can be inside
  std::vector<DomainEvidence> limits;  ///< of the domain, where they are exceeded
};

class VoltageTrials {
 public:
  /// `slopes`: with derivatives, each of which costs about as much as its orbit. Without `simulate`, start-up is asked
  /// only which of several responses is reached; a vehicle without a response that was found counts as undecided.
  VoltageTrials(const Vehicle<double>& vehicle, const SteadyOptions& options, const StartUp& start_up,
                SearchRange range, bool slopes, bool simulate = true);

  VoltageTrial at(double voltage);

  const Vehicle<double>& vehicle() const { return vehicle_; }
  SearchRange range() const { return range_; }
  bool simulates() const { return simulate_; }
  int count() const { return count_; }
  /// How close to the value sought is close enough, relative.
  double closeness() const { return closeness_; }
  /// Relative accuracy of a trial's values.
  double accuracy() const { return options_.tolerance; }

 private:
  SteadyFlapping solve() const;

  Vehicle<double> vehicle_;
  SteadyOptions options_;
  const StartUp& start_up_;
  SearchRange range_;
  bool slopes_;
  bool simulate_;
  double closeness_;
  int count_ = 0;
};

/// The largest of trial.excess; 1 where one is no number.
double largest_excess(const VoltageTrial& trial);

/// Turns the motor at omega [rad/s] against constant friction [N m] and its own damping alone [V].
double unloaded_voltage(const Vehicle<double>& vehicle, double omega, double friction_torque);

/// A cubic over 0 to 1 by its values and slopes at the ends.
struct Hermite {
  double y0, d0, y1, d1;
  double value(double t) const {
    return y0 + t * (d0 + t * (3.0 * (y1 - y0) - 2.0 * d0 - d1 + t * (2.0 * (y0 - y1) + d0 + d1)));
  }
  double slope(double t) const {
    return d0 + t * (2.0 * (3.0 * (y1 - y0) - 2.0 * d0 - d1) + t * 3.0 * (2.0 * (y0 - y1) + d0 + d1));
  }
};

}  // namespace wingbeat::detail
