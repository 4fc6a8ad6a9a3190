// The speed control that makes the mean lift carry the weight, from one moment of a flight to the next.
#pragma once

#include <optional>

#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {

/// Steady flapping at a throttle.
struct ThrottledFlapping {
  SteadyFlapping flapping;
  double voltage = absent;  ///< mean one without load, or amplitude [V]; above what the supply has it is hypothetical
};

class HoverThrottle {
 public:
  /// `weight` [N] is carried to a relative `closeness`. Flight outside the domain is taken where there is none inside.
  HoverThrottle(double weight, const SteadyOptions& options, double closeness)
      : weight_(weight), options_(options), closeness_(closeness) {}

  /// Of a vehicle at full throttle, its motor as warm as `temperatures` say, or else settled: the lowest voltage that
  /// carries the weight; from the second call on, the one that continues the last one. Where none does, flapping.status
  /// tells what the vehicle does closest to it, and the voltage is absent.
  ThrottledFlapping find(const Vehicle<double>& full, const std::optional<MotorTemperatures<double>>& temperatures,
                         const StartUp& start_up);

  /// Steady flapping of a vehicle as it is.
  SteadyFlapping solve(const Vehicle<double>& vehicle, const std::optional<MotorTemperatures<double>>& temperatures,
                       const StartUp& start_up);

  int evaluations() const { return evaluations_; }

 private:
  std::optional<ThrottledFlapping> follow(const Vehicle<double>& full,
                                          const std::optional<MotorTemperatures<double>>& temperatures);

  double weight_;
  SteadyOptions options_;
  double closeness_;
  int evaluations_ = 0;
  double voltage_ = absent;  ///< of the last moment
  double slope_ = 2.0;       ///< there, d ln lift / d ln voltage
};

}  // namespace wingbeat::detail
