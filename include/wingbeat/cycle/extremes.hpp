// Peaks of a recorded lap: zeros of the derivative on the solution itself, never the largest sample.
#pragma once

#include <cmath>
#include <vector>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/crank_system.hpp"

namespace wingbeat {

/// Maxima over the lap of extreme_candidates(), to the relative accuracy `tolerance`.
template <int N>
CycleExtremes<double> lap_extremes(const CrankSystem<double, N>& system,
                                   const solve::Lap<CrankSystem<double, N>>& lap, double tolerance) {
  using Derivative = Jet<1>;
  using Along = CrankSystem<Derivative, N>;
  using Candidates = CycleExtremes<Derivative>;
  const Along along = system.template cast<Derivative>();

  // Candidates and their derivatives along the solution at crank angle x.
  const auto candidates = [&](double x, const std::array<double, N>& y, const std::array<double, N>& dy,
                              const std::array<double, 3>& s) -> Candidates {
    typename Along::State state;
    for (std::size_t n = 0; n < N; ++n) {
      state[n].a = y[n];
      state[n].v[0] = dy[n];
    }
    const typename Along::Signs signs = {Derivative(s[0]), Derivative(s[1]), Derivative(s[2])};
    const Motion<Derivative> m = along.motion(Derivative(x, 0), state, signs);
    return extreme_candidates(along.vehicle, m, state[0], Along::branch(signs));
  };

  struct Bracket {
    const solve::Step<CrankSystem<double, N>>* step;
    double v0, d0, v1, d1;
    double estimate;
    double x;
  };
  // The maximum of the cubic through end values and slopes, d0 > 0 > d1.
  const auto cubic_maximum = [](double h, Bracket& b) {
    const double slope = (b.v1 - b.v0) / h;
    const double z = b.d0 + b.d1 - 3.0 * slope;
    const double root = std::sqrt(std::max(z * z - b.d0 * b.d1, 0.0));
    const double t = std::clamp((b.d0 + root - z) / (b.d0 - b.d1 + 2.0 * root), 0.0, 1.0);
    const double c2 = 3.0 * slope - 2.0 * b.d0 - b.d1, c3 = b.d0 + b.d1 - 2.0 * slope;
    b.estimate = b.v0 + h * t * (b.d0 + t * (c2 + t * c3));
    return t;
  };

  CycleExtremes<double> best;
  best.fill(-std::numeric_limits<double>::infinity());
  std::array<std::vector<Bracket>, extreme_count> brackets;
  Candidates at;
  for (std::size_t n = 0; n < lap.steps.size(); ++n) {
    const auto& step = lap.steps[n];
    const bool last = n + 1 == lap.steps.size();
    const bool same_branch = n > 0 && step.signs == lap.steps[n - 1].signs;
    if (!same_branch) at = candidates(step.x, step.y, step.first.dy, step.signs);
    const auto& y1 = last ? lap.end : lap.steps[n + 1].y;
    const auto& dy1 = last ? lap.steps.front().first.dy : lap.steps[n + 1].first.dy;
    const Candidates end = candidates(step.x + step.h, y1, dy1, step.signs);
    for (std::size_t c = 0; c < extreme_count; ++c) {
      best[c] = std::max({best[c], at[c].a, end[c].a});
      const double d0 = at[c].v[0], d1 = end[c].v[0];
      if (!(d0 > 0.0 && d1 < 0.0)) continue;
      Bracket bracket{&step, at[c].a, d0, end[c].a, d1, 0.0, 0.0};
      bracket.x = step.x + step.h * cubic_maximum(step.h, bracket);
      brackets[c].push_back(bracket);
    }
    at = end;
  }

  for (std::size_t c = 0; c < extreme_count; ++c) {
    double highest = best[c], lowest_candidate = std::numeric_limits<double>::infinity();
    for (const Bracket& b : brackets[c]) highest = std::max(highest, b.estimate);
    for (const Bracket& b : brackets[c]) lowest_candidate = std::min({lowest_candidate, b.v0, b.v1});
    for (Bracket b : brackets[c]) {
      // The cubic's own error is a small part of what it rises over its ends.
      const double doubt = 0.2 * (b.estimate - std::min(b.v0, b.v1)) + 1e-3 * (highest - lowest_candidate);
      if (b.estimate + doubt < highest) continue;
      double x0 = b.step->x, x1 = b.step->x + b.step->h, x = b.x;
      for (int iteration = 0; iteration < 30; ++iteration) {
        const auto inside = solve::evaluate_inside<false>(system, *b.step, x);
        const auto rates = system.template rates<false>(x, inside.y, b.step->signs);
        const Derivative value = candidates(x, inside.y, rates.dy, b.step->signs)[c];
        const double v = value.a, d = value.v[0];
        // What is left to gain, from the steeper of the two secants of the slope.
        const double curvature = std::max(std::abs((b.d0 - d) / (x - x0)), std::abs((d - b.d1) / (x1 - x)));
        const double gain = curvature > 0.0 ? 0.5 * d * d / curvature : 0.0;
        best[c] = std::max(best[c], v);
        if (!(gain > 0.03 * tolerance * std::abs(v)) || x1 - x0 < 1e-13) {
          best[c] = std::max(best[c], v + gain);
          break;
        }
        if (d > 0.0) {
          x0 = x, b.v0 = v, b.d0 = d;
        } else {
          x1 = x, b.v1 = v, b.d1 = d;
        }
        x = x0 + (x1 - x0) * cubic_maximum(x1 - x0, b);
      }
    }
  }
  return best;
}

}  // namespace wingbeat
