// What the simulations of start-up share.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>

#include "wingbeat/core/minimise.hpp"
#include "wingbeat/cycle/metrics.hpp"

namespace wingbeat::detail {

/// Integrated as extra unknowns. Time is the difference of two crossings, and the reactive work the total variation of
/// the wings' and springs' energy, of which its integrand is the magnitude of the rate: both exact without quadrature.
constexpr Integral quadratures[] = {Integral::current,         Integral::current_square, Integral::speed_square,
                                    Integral::electrical_work, Integral::motor_work,     Integral::friction_work,
                                    Integral::aero_work,       Integral::residual_work,  Integral::lift,
                                    Integral::rod_force,       Integral::travel};
constexpr int quadrature_count = int(std::size(quadratures));

/// Where among them an integral is.
constexpr std::size_t quadrature_of(Integral which) {
  std::size_t place = 0;
  while (quadratures[place] != which) ++place;
  return place;
}

/// What the motor gives less what comes out of the gearbox is what that loses: sets it where the gearbox loses torque,
/// `stored` being what rotor and inductance have gained meanwhile [J].
inline void set_gear_work(const Motor<double>& m, double stored, CycleIntegrals<double>& integrals) {
  if (!has_gear_loss(m)) return;
  const auto total = [&](Integral which) { return integrals[std::size_t(which)]; };
  integrals[std::size_t(Integral::gear_work)] =
      total(Integral::electrical_work) - m.armature_resistance * total(Integral::current_square) -
      m.viscous_damping * total(Integral::speed_square) - m.friction_torque * total(Integral::travel) -
      total(Integral::motor_work) - stored;
}

/// Largest deviation of a metric of `m` from that of `other` beside its error_scale(). A metric that is absent counts
/// as equal.
inline double metrics_apart(const Metrics<double>& m, const Metrics<double>& other) {
  double largest = 0.0;
  for (int n = 0; n < metric_count; ++n) {
    const Metric which = Metric(n);
    // The last one repeats the mean lift.
    if (which == Metric::floquet_multiplier_max || which == Metric::lift_to_weight) continue;
    const double off = std::abs(m[which] - other[which]), size = error_scale(other, which);
    if (off > largest * size) largest = off / size;
  }
  return largest;
}

/// Raises extremes to what they reach between the times `from` and `to`, candidates(t) being the values there, read at
/// the ends of at least so many intervals.
template <class Candidates>
void raise_extremes(const Candidates& candidates, double from, double to, int intervals,
                    CycleExtremes<double>& extremes) {
  constexpr int min_intervals = 4, max_intervals = 128;
  intervals = std::clamp(intervals, min_intervals, max_intervals);
  const double spacing = (to - from) / intervals;
  if (!(spacing > 0.0)) return;
  CycleExtremes<double> samples[max_intervals + 1];
  for (int k = 0; k <= intervals; ++k) samples[k] = candidates(k == intervals ? to : from + k * spacing);
  for (std::size_t e = 0; e < extreme_count; ++e) {
    double& best = extremes[e];
    int top = 0;
    for (int k = 0; k <= intervals; ++k) {
      if (samples[k][e] > samples[top][e]) top = k;
    }
    const int middle = std::clamp(top, 1, intervals - 1);
    const double a = samples[middle - 1][e], b = samples[middle][e], c = samples[middle + 1][e];
    const double bend = a - 2.0 * b + c;
    best = std::max(best, samples[top][e]);
    if (bend >= 0.0) continue;
    const double vertex = 0.5 * (a - c) / bend;  // in spacings from the middle
    const double height = b - 0.125 * square(a - c) / bend;
    if (std::abs(vertex) > 1.5 || height < best - 0.1 * std::abs(bend)) continue;
    const double centre = from + middle * spacing, left = centre - spacing, right = std::min(centre + spacing, to);
    const auto value = [&](double t) { return -candidates(t)[e]; };
    best = std::max(best, -minimise(value, left, right, 1e-7 * (right - left)).value);
  }
}

}  // namespace wingbeat::detail
