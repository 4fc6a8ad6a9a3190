#include "wingbeat/study/moment_calibration.hpp"

#include <cmath>

#include "wingbeat/study/trend.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

Design<double> with_moments(Design<double> design, const MomentCalibration& calibration) {
  design.transmission.formulation = calibration.formulation;
  design.wing.planform = {};
  design.wing.planform.s2 = calibration.s2;
  design.wing.planform.s3 = calibration.s3;
  return design;
}

MomentCalibration calibrate_moments(const SpringPair& pair, Formulation formulation, double frequency,
                                    const std::array<double, 2>& lift_peaks) {
  const Vehicle<double> given = resolve(pair[0]);
  const double s2 = given.wings.s2, s3 = given.wings.s3;
  const auto peaks_at = [&](double log_scale) {
    std::array<double, 2> peaks{absent, absent};
    for (std::size_t n = 0; n < 2; ++n) {
      RunOptions options;
      options.tolerance = 1e-9;
      options.frequency = frequency;
      options.allow_extrapolation = true;
      const RunResult run = run_design(with_moments(pair[n], {formulation, s2, s3 * std::exp(log_scale)}), options);
      if (run.status == FlappingStatus::flapping && run.search && run.search->outcome == FrequencyOutcome::reached) {
        peaks[n] = run.metrics[Metric::lift_peak];
      }
    }
    return peaks;
  };
  const double wanted = std::log(lift_peaks[1] / lift_peaks[0]);
  const auto excess = [&](double log_scale) {
    const auto peaks = peaks_at(log_scale);
    return std::log(peaks[1] / peaks[0]) - wanted;
  };
  constexpr int samples = 17;
  const double low = -std::log(4.0), step = 2.0 * std::log(4.0) / (samples - 1);
  MomentCalibration result{formulation, absent, absent, lift_peaks, {absent, absent}, false};
  double scale = absent, before = excess(low);
  for (int n = 1; n < samples && !result.met; ++n) {
    const double from = low + step * (n - 1), to = from + step, here = excess(to);
    if (std::isfinite(before) && std::isfinite(here) && (before < 0.0) != (here < 0.0)) {
      scale = crossing_along(excess, 0.0, from, to, 2);
      result.met = std::isfinite(scale);
    }
    before = here;
  }
  if (!result.met) {
    scale = highest_along([&](double x) { return -std::abs(excess(x)); }, low, -low, samples).argument;
  }
  if (!std::isfinite(scale)) return result;
  const auto peaks = peaks_at(scale);
  const double factor = std::sqrt(lift_peaks[0] / peaks[0] * lift_peaks[1] / peaks[1]);
  result.s2 = s2 * factor;
  result.s3 = s3 * std::exp(scale);
  for (std::size_t n = 0; n < 2; ++n) result.lift_peak[n] = peaks[n] * factor;
  return result;
}

}  // namespace wingbeat
