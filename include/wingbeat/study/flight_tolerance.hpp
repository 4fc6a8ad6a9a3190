// What uncertain parameters do to steady flight: each vehicle drawn is trimmed anew, with the modes of its averaged
// flight.
#pragma once

#include <complex>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/flight/stability.hpp"
#include "wingbeat/study/for_each.hpp"
#include "wingbeat/study/tolerance.hpp"

namespace wingbeat {

/// One vehicle; NaN where it does not fly.
struct FlightSample {
  TrimStatus status = TrimStatus::untrimmable;
  double voltage = absent, power = absent, frequency = absent;  ///< [V], [W], [Hz]
  double pitch = absent;                                        ///< attitude, nose up [rad]
  std::complex<double> longitudinal{absent, absent};            ///< the least stable mode of its kind [1/s]
  std::complex<double> lateral{absent, absent};

  bool unstable() const { return longitudinal.real() > 0.0 || lateral.real() > 0.0; }
};

/// A number of a sample that is looked at over all of them.
struct FlightQuantity {
  const char* name;  ///< with its unit
  const char* meaning;
  double (*of)(const FlightSample&);
};
std::span<const FlightQuantity> flight_quantities();

/// One of flight_quantities() over the vehicles that fly.
struct FlightSpread : SampleMoments {
  double centre = absent;  ///< of the vehicle at the parameters' means
};

struct FlightToleranceResult {
  std::vector<FlightSample> samples;
  FlightSample centre;  ///< at the parameters' means
  std::string centre_detail;
  Probability flies;                   ///< in trim, within the ranges of the controls or beyond
  Probability beyond_controls;         ///< of which beyond
  Probability unstable;                ///< of all that fly
  std::vector<FlightSpread> quantity;  ///< in the order of flight_quantities()
};

/// Draws the plain sample of `study`, study.count vehicles without those for indices, and trims each in `condition`.
/// Throws ParameterError of a vehicle without a body, where the study holds something, as trim finds the voltage, and
/// where it is not in air.
FlightToleranceResult flight_tolerance(const ToleranceStudy& study, const FlightCondition& condition,
                                       const ForEach& for_each = {}, const std::function<void(double)>& progress = {});

}  // namespace wingbeat
