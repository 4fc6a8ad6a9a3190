// The motion of the wings over one settled cycle, as other programs are given it, and what the air does to them along
// the way: of a recorded cycle and of a motion that is stated.
#pragma once

#include <span>
#include <vector>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/record.hpp"
#include "wingbeat/study/prescribed_flapping.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

/// What the air does to all wings together at one instant, its inertia included. Moments are positive against a
/// positive velocity, as the drive and the hinges feel them.
struct AirLoads {
  double lift = absent;           ///< normal to the stroke plane [N]
  double stroke_moment = absent;  ///< about the stroke axes [N m]; absent of wings that twist
  double pitch_moment = absent;   ///< about the pitch axes [N m]; of wings on hinges alone
};

/// The wings at one instant.
struct WingInstant {
  double time = 0.0;   ///< since crank angle zero; direct drive: since the supply's phase zero [s]
  double cycle = 0.0;  ///< the same over the period, 0 to 1
  AngleMotion stroke;  ///< beta
  AngleMotion pitch;   ///< psi at the root; under the pitch law -sign(beta') (pi/2 - alpha), without its acceleration
  double twist = absent;  ///< tau at the tip [rad]; absent of wings that do not twist
  AirLoads loads;
};

/// The wings at a share of the cycle, of which the whole part does not count.
WingInstant wing_instant(const CycleRecord& cycle, double share);
/// The wings at `count` instants equally spaced in time, both ends of the cycle included; count >= 2.
std::vector<WingInstant> wing_motion(const CycleRecord& cycle, int count);

/// The loads of a vehicle's wings at a stated motion, by the functions of the equations of motion. Without `pitch` the
/// wings follow the pitch law. Throws ParameterError for wings that twist, for those that clap or are in a wake, which
/// follow from a settled cycle, and without `pitch` for wings on hinges.
AirLoads air_loads(const Vehicle<double>& vehicle, const AngleMotion& stroke, const AngleMotion* pitch);

/// An angle over a cycle as a Fourier series, \f$\bar x + \sum_k a_k \cos 2 \pi k t + b_k \sin 2 \pi k t\f$, t in
/// cycles.
struct AngleSeries {
  double mean = 0.0;                 ///< [rad]
  std::vector<double> cosine, sine;  ///< of the first harmonic, of the second, ... [rad]
  double error_max = 0.0;            ///< largest difference from the values that it stands for [rad]
  double error_rms = 0.0;            ///< root of its mean square [rad]

  double at(double cycle) const;
};
/// As the sum of sines that prescribed flapping takes.
PeriodicAngle periodic_angle(const AngleSeries& series);

/// The series of values at equal steps over one cycle, the end left out; `harmonics` < half their number.
AngleSeries angle_series(std::span<const double> values, int harmonics);
/// The shortest series whose largest error is at most `error` [rad]; of `harmonics_max` harmonics, where none is.
AngleSeries angle_series_within(std::span<const double> values, double error, int harmonics_max);

}  // namespace wingbeat
