// What a step of an iterate is assessed by, and the state inside it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "wingbeat/solve/explicit_step.hpp"

namespace wingbeat::solver::detail {

/// Cubic Hermite state inside a step from its end values and slopes, at the fraction t of the step h.
template <class System>
typename System::State hermite(const typename System::State& y0, const typename System::State& dy0,
                               const typename System::State& y1, const typename System::State& dy1, double h,
                               double t) {
  typename System::State y;
  const double s = 1.0 - t;
  for (std::size_t n = 0; n < y.size(); ++n) {
    y[n] = s * s * (1.0 + 2.0 * t) * y0[n] + t * t * (3.0 - 2.0 * t) * y1[n] + h * t * s * (s * dy0[n] - t * dy1[n]);
  }
  return y;
}

template <class State>
bool is_finite(const State& y) {
  return std::all_of(y.begin(), y.end(), [](double value) { return std::isfinite(value); });
}

/// Error of a step relative to the tolerance; `integral_scale` holds the size of each integral over the whole iterate.
template <bool quadratures, class System>
double scaled_error(const System& system, const StepResult<System>& step, double tolerance,
                    const typename System::Quadrature& integral_scale) {
  const typename System::State scale = system.error_scale(step.y);
  double sum3 = 0.0, sum5 = 0.0;
  for (std::size_t n = 0; n < scale.size(); ++n) {
    const double per = 1.0 / (tolerance * scale[n]);
    sum3 += step.error3[n] * step.error3[n] * per * per;
    sum5 += step.error5[n] * step.error5[n] * per * per;
  }
  // Hairer's combination of both embedded formulas, of order 8 in the step.
  const double denominator = sum5 + 0.01 * sum3;
  double error = denominator > 0.0 ? sum5 / std::sqrt(denominator * double(scale.size())) : 0.0;
  if constexpr (quadratures) {
    for (const std::size_t q : System::controlled_integrals) {
      if (!(integral_scale[q] > 0.0)) continue;
      const double per = 1.0 / (tolerance * integral_scale[q]);
      const double fifth = std::abs(step.integral_error5[q]) * per, third = std::abs(step.integral_error3[q]) * per;
      const double denominator_q = std::hypot(fifth, 0.1 * third);
      if (denominator_q > 0.0) error = std::max(error, fifth * fifth / denominator_q);
    }
  }
  return error;
}

/// |h lambda| of the fastest decay, from two states at the end of a step and the rates there; 0 where the states are as
/// good as equal. Hairer's test of stiffness in DOP853.
template <class System>
double step_times_decay(const System& system, const StepResult<System>& step, const typename System::State& slope,
                        double h) {
  const typename System::State scale = system.error_scale(step.y);
  double apart = 0.0, change = 0.0;
  for (std::size_t n = 0; n < scale.size(); ++n) {
    const double y = (step.y[n] - step.last_stage[n]) / scale[n], dy = (slope[n] - step.last_slope[n]) / scale[n];
    apart += y * y;
    change += dy * dy;
  }
  return apart > 1e-24 ? h * std::sqrt(change / apart) : 0.0;
}

/// Position tolerance of a switch: an error e in its position costs about e^2 times the change of slope there.
inline double switch_tolerance(double tolerance) { return 0.4 * std::sqrt(tolerance); }

}  // namespace wingbeat::solver::detail
