// Chord moments S_2 and S_3 of a wing whose planform is not published, from two peak lifts.
#pragma once

#include <array>

#include "wingbeat/study/reproduction.hpp"

namespace wingbeat {

/// Chord moments with which a pair of vehicles has, at one flapping frequency, the peak lifts that are wanted of it.
struct MomentCalibration {
  Formulation formulation;
  double s2 = absent;                               ///< [m4]; absent where the vehicles do not flap
  double s3 = absent;                               ///< [m5]
  std::array<double, 2> wanted{absent, absent};     ///< peak lift without and with springs [N]
  std::array<double, 2> lift_peak{absent, absent};  ///< what the calibrated vehicles have [N]
  bool met = false;  ///< both peaks are met; false: they are as near as S_2 and S_3 can bring them
};

/// Calibrates S_2 and S_3 with a held flapping frequency [Hz]. The motion depends on S_3 alone and lift is proportional
/// to S_2, so that S_3 follows from the ratio of the two peaks and S_2 from their size. Of the values of S_3 between a
/// quarter and four times that of the pair which give the ratio, the smallest is taken; where none does, the nearest
/// approach. S_2 then minimises the sum of the squared logarithms of computed over wanted peak.
MomentCalibration calibrate_moments(const SpringPair& pair, Formulation formulation, double frequency,
                                    const std::array<double, 2>& lift_peaks);

/// The design with that formulation and these chord moments.
Design<double> with_moments(Design<double> design, const MomentCalibration& calibration);

}  // namespace wingbeat
