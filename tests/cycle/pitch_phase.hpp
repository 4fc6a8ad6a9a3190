// The phase of the pitch from the solution's own values at the nodes of Gauss's rule on thirds of its steps.
#pragma once

#include <complex>

#include "wingbeat/cycle/pitch_metrics.hpp"

namespace wingbeat {

template <class System>
double phase_by_own_values(const System& system, const solver::Iterate<System>& cycle) {
  constexpr int parts = 3;
  double period = 0.0, start = 0.0;
  for (const auto& step : cycle.steps) period += step.dq[std::size_t(Integral::time)];
  std::complex<double> stroke = 0.0, pitching = 0.0;
  for (const auto& step : cycle.steps) {
    for (int part = 0; part < parts; ++part) {
      for (std::size_t k = 0; k < detail::gauss_nodes.size(); ++k) {
        const double x = step.x + (part + 0.5 * (1.0 + detail::gauss_nodes[k])) * step.h / parts;
        const auto inside = solver::evaluate_inside<true>(system, cycle, step, x);
        const double time = start + inside.dq[std::size_t(Integral::time)];
        const auto weighted = std::polar(step.h / parts * detail::gauss_weights[k] / system.phase_rate(inside.y),
                                         -two_pi * time / period);
        stroke += weighted * system.stroke_angle(x, inside.y);
        pitching += weighted * System::local_pitch(inside.y);
      }
    }
    start += step.dq[std::size_t(Integral::time)];
  }
  return std::arg(pitching / (std::complex<double>(0.0, -1.0) * stroke));
}

}  // namespace wingbeat
