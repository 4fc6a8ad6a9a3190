// How the wings pitch over a recorded cycle, under either drive (model.md section 12).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/solve/iterate.hpp"

namespace wingbeat {

struct PitchMetrics {
  double amplitude;  ///< half of psi from peak to peak [rad]
  /// Of the first harmonics in time, by how much pitching is ahead of the pitch that opposes the stroke velocity [rad],
  /// -pi to pi: 0 where wings flip symmetrically about the reversal, positive where they flip early (advanced).
  double phase;
  double angle_of_attack_min, angle_of_attack_max;  ///< [rad]; beyond pi/2 the wing over-rotates, its lift is negative
};

/// Extremes are where the pitch velocity or the stroke velocity changes sign or a stop holds the wings, which is where
/// steps end.
template <class System>
PitchMetrics pitch_metrics(const System& system, const solver::Iterate<System>& cycle) {
  double lowest = infinity, highest = -infinity, period = 0.0;
  PitchMetrics m{0.0, 0.0, infinity, -infinity};
  for (std::size_t n = 0; n < cycle.steps.size(); ++n) {
    const auto& step = cycle.steps[n];
    const auto& end = n + 1 == cycle.steps.size() ? cycle.end : cycle.steps[n + 1].y;
    for (const double psi : {step.y[System::pitch], end[System::pitch]}) {
      lowest = std::min(lowest, psi);
      highest = std::max(highest, psi);
      const double alpha = 0.5 * pi + System::stroke_sign(step.signs) * psi;
      m.angle_of_attack_min = std::min(m.angle_of_attack_min, alpha);
      m.angle_of_attack_max = std::max(m.angle_of_attack_max, alpha);
    }
    period += step.dq[std::size_t(Integral::time)];
  }
  m.amplitude = 0.5 * (highest - lowest);

  // Integrals of stroke and pitch times exp(-j w t), by Gauss's rule of five points on each step.
  constexpr std::array nodes = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array weights = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                  0.2369268850561891};
  std::complex<double> stroke = 0.0, pitching = 0.0;
  double time = 0.0;
  for (const auto& step : cycle.steps) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double x = step.x + 0.5 * (1.0 + nodes[k]) * step.h;
      const auto inside = solver::evaluate_inside<true>(system, cycle, step, x);
      const double t = time + inside.dq[std::size_t(Integral::time)];
      const double dt = system.template rates<true>(x, inside.y, step.signs).dq[std::size_t(Integral::time)];
      const auto weighted = std::polar(0.5 * step.h * weights[k] * dt, -two_pi * t / period);
      stroke += weighted * system.stroke_angle(x, inside.y);
      pitching += weighted * inside.y[System::pitch];
    }
    time += step.dq[std::size_t(Integral::time)];
  }
  // The pitch that opposes the stroke velocity is along -j stroke.
  m.phase = std::arg(pitching / (std::complex<double>(0.0, -1.0) * stroke));
  return m;
}

}  // namespace wingbeat
