// Where the extremes of a recorded cycle lie: the part of CycleGradient that looks for them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "wingbeat/cycle/cycle_gradient.hpp"

namespace wingbeat {

template <class System>
auto CycleGradient<System>::locate() const -> std::array<PeakLocation, extreme_count> {
  constexpr int pieces = 4;
  std::array<PeakLocation, extreme_count> best{};
  std::array<double, extreme_count> highest;
  highest.fill(-std::numeric_limits<double>::infinity());
  struct Bracket {
    std::size_t step;
    double x0, d0, x1, d1, estimate;
  };
  std::array<std::vector<Bracket>, extreme_count> brackets;
  for (std::size_t n = 0; n < cycle_.steps.size(); ++n) {
    const auto& step = cycle_.steps[n];
    const bool last = n + 1 == cycle_.steps.size();
    State y1 = last ? cycle_.end : cycle_.steps[n + 1].y;
    State dy1 = last ? cycle_.steps.front().first.dy : cycle_.steps[n + 1].first.dy;
    if constexpr (pitching) {
      const double x1 = step.x + step.h;
      if (!last && impact_before(n + 1)) y1 = solver::evaluate_inside<false>(system_, cycle_, step, x1).y;
      dy1 = system_.template rates<false>(x1, y1, step.signs).dy;
    }
    Sample before{};
    for (int k = 0; k <= pieces; ++k) {
      const double t = double(k) / pieces;
      Sample sample{step.x + t * step.h, {}};
      const State y = k == 0 ? step.y : solver::detail::hermite<System>(step.y, step.first.dy, y1, dy1, step.h, t);
      sample.value = candidates(n, sample.x, y);
      for (const Extreme e : System::extremes) {
        const auto c = std::size_t(e);
        const Jet<1>& v = sample.value[c];
        if ((k == 0 || (pitching && k == pieces)) && v.a > highest[c]) {
          highest[c] = v.a;
          best[c] = {n, sample.x, k == pieces};
        }
        const Jet<1>& u = before.value[c];
        if (k == 0 || !(u.v[0] > 0.0 && v.v[0] <= 0.0)) continue;
        const double h = sample.x - before.x;
        const double t0 = u.v[0] / (u.v[0] - v.v[0]);
        brackets[c].push_back({n, before.x, u.v[0], sample.x, v.v[0], u.a + 0.5 * t0 * h * u.v[0]});
      }
      before = sample;
    }
  }
  for (const Extreme e : System::extremes) {
    const auto c = std::size_t(e);
    double top = highest[c];
    for (const Bracket& b : brackets[c]) top = std::max(top, b.estimate);
    for (Bracket b : brackets[c]) {
      if (b.estimate < top - 0.02 * std::abs(top)) continue;
      const auto& step = cycle_.steps[b.step];
      // The zero of the slope by false position in the manner of Illinois.
      double x = b.x0, value = 0.0;
      int side = 0;
      for (int iteration = 0; iteration < 60; ++iteration) {
        const double previous = x;
        x = b.d0 - b.d1 > 0.0 ? b.x0 + (b.x1 - b.x0) * b.d0 / (b.d0 - b.d1) : 0.5 * (b.x0 + b.x1);
        const auto inside = solver::evaluate_inside<false>(system_, cycle_, step, x);
        const Jet<1> candidate = candidates(b.step, x, inside.y)[c];
        value = candidate.a;
        if (std::abs(x - previous) < 1e-11 || candidate.v[0] == 0.0) break;
        if (candidate.v[0] > 0.0) {
          b.x0 = x, b.d0 = candidate.v[0];
          if (side == 1) b.d1 *= 0.5;
          side = 1;
        } else {
          b.x1 = x, b.d1 = candidate.v[0];
          if (side == -1) b.d0 *= 0.5;
          side = -1;
        }
      }
      if (value > highest[c]) {
        highest[c] = value;
        best[c] = {b.step, x};
      }
    }
  }
  return best;
}

}  // namespace wingbeat
