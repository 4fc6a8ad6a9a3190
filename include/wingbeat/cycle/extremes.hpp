// Peaks of a recorded cycle: zeros of the derivative on the solution itself, never the largest sample.
#pragma once

#include <cmath>
#include <vector>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/solve/iterate.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// Maxima over the cycle of extreme_candidates(), to the relative accuracy `tolerance`; absent those that the system
/// has not.
template <class System>
CycleExtremes<double> cycle_extremes(const System& system, const solver::Iterate<System>& cycle, double tolerance) {
  using Derivative = Jet<1>;
  using State = typename System::State;
  using Candidates = CycleExtremes<Derivative>;
  const auto along = system.template cast<Derivative>();
  using Along = std::remove_const_t<decltype(along)>;

  // Candidates and their derivatives along the solution at x.
  const auto candidates = [&](double x, const State& y, const State& dy,
                              const typename System::Signs& s) -> Candidates {
    typename Along::State state;
    for (std::size_t n = 0; n < state.size(); ++n) {
      state[n].a = y[n];
      state[n].v[0] = dy[n];
    }
    typename Along::Signs signs;
    for (std::size_t k = 0; k < signs.size(); ++k) signs[k] = Derivative(s[k]);
    const Motion<Derivative> m = along.motion(Derivative(x, 0), state, signs);
    return along.candidates(m, state, signs);
  };

  // A piece of a step on which the slope falls from d0 > 0 to d1 < 0.
  struct Bracket {
    const solver::Step<System>* step;
    double x0, v0, d0, x1, v1, d1;
    double x, estimate;  // of the maximum
  };
  // The maximum of the cubic through end values and slopes.
  const auto estimate_maximum = [](Bracket& b) {
    const double h = b.x1 - b.x0, slope = (b.v1 - b.v0) / h;
    const double z = b.d0 + b.d1 - 3.0 * slope;
    const double root = std::sqrt(std::max(z * z - b.d0 * b.d1, 0.0));
    const double t = std::clamp((b.d0 + root - z) / (b.d0 - b.d1 + 2.0 * root), 0.0, 1.0);
    const double c2 = 3.0 * slope - 2.0 * b.d0 - b.d1, c3 = b.d0 + b.d1 - 2.0 * slope;
    b.x = b.x0 + h * t;
    b.estimate = b.v0 + h * t * (b.d0 + t * (c2 + t * c3));
  };
  // Where the cubic through end values and slopes turns twice, the middle between its turns; 0 elsewhere.
  const auto between_turns = [](double h, double v0, double d0, double v1, double d1) {
    const double slope = (v1 - v0) / h;
    const double c2 = 3.0 * slope - 2.0 * d0 - d1, c3 = d0 + d1 - 2.0 * slope;
    if (c3 == 0.0 || c2 * c2 <= 3.0 * c3 * d0) return 0.0;
    const double middle = -c2 / (3.0 * c3), half = std::sqrt(c2 * c2 - 3.0 * c3 * d0) / std::abs(3.0 * c3);
    return middle - half > 0.0 && middle + half < 1.0 ? middle : 0.0;
  };

  CycleExtremes<double> best;
  best.fill(absent);
  for (const Extreme e : System::extremes) best[std::size_t(e)] = -std::numeric_limits<double>::infinity();
  std::array<std::vector<Bracket>, extreme_count> brackets;
  Candidates begin;
  for (std::size_t n = 0; n < cycle.steps.size(); ++n) {
    const auto& step = cycle.steps[n];
    const bool last = n + 1 == cycle.steps.size();
    const bool same_branch = n > 0 && step.signs == cycle.steps[n - 1].signs;
    if (!same_branch) begin = candidates(step.x, step.y, step.first.dy, step.signs);
    State y1 = last ? cycle.end : cycle.steps[n + 1].y;
    const double x1 = step.x + step.h;
    // Where the rates may jump, those of the next step do not belong to this one's end, and after an impact its state
    // does not.
    bool rates_jump = solver::jumps(system, 0);
    if constexpr (solver::state_jumps<System>()) {
      rates_jump = true;
      constexpr auto impacts = System::impacts;
      if (!last && step.signs[impacts] != cycle.steps[n + 1].signs[impacts]) {
        y1 = solver::evaluate_inside<false>(system, cycle, step, x1).y;
      }
    }
    const State dy1 = rates_jump ? system.template rates<false>(x1, y1, step.signs).dy
                      : last     ? cycle.steps.front().first.dy
                                 : cycle.steps[n + 1].first.dy;
    const Candidates end = candidates(x1, y1, dy1, step.signs);
    for (const Extreme e : System::extremes) {
      const auto c = std::size_t(e);
      best[c] = std::max({best[c], begin[c].a, end[c].a});
      Bracket bracket{&step, step.x, begin[c].a, begin[c].v[0], x1, end[c].a, end[c].v[0], 0.0, 0.0};
      if (!(bracket.d0 > 0.0 && bracket.d1 < 0.0)) {
        const double t = between_turns(step.h, bracket.v0, bracket.d0, bracket.v1, bracket.d1);
        if (t == 0.0) continue;
        const auto y = solver::detail::hermite<System>(step.y, step.first.dy, y1, dy1, step.h, t);
        const double x = step.x + t * step.h;
        const auto dy = system.template rates<false>(x, y, step.signs).dy;
        const Derivative middle = candidates(x, y, dy, step.signs)[c];
        if (middle.v[0] > 0.0) {
          bracket.x0 = x, bracket.v0 = middle.a, bracket.d0 = middle.v[0];
        } else {
          bracket.x1 = x, bracket.v1 = middle.a, bracket.d1 = middle.v[0];
        }
        if (!(bracket.d0 > 0.0 && bracket.d1 < 0.0)) continue;
      }
      estimate_maximum(bracket);
      brackets[c].push_back(bracket);
    }
    begin = end;
  }

  for (const Extreme e : System::extremes) {
    const auto c = std::size_t(e);
    double highest = best[c], lowest_candidate = std::numeric_limits<double>::infinity();
    for (const Bracket& b : brackets[c]) highest = std::max(highest, b.estimate);
    for (const Bracket& b : brackets[c]) lowest_candidate = std::min({lowest_candidate, b.v0, b.v1});
    for (Bracket b : brackets[c]) {
      // The cubic's own error is a small part of what it rises over its ends.
      const double doubt = 0.2 * (b.estimate - std::min(b.v0, b.v1)) + 5e-3 * (highest - lowest_candidate);
      if (b.estimate + doubt < highest) continue;
      double x = b.step->x;
      State y = b.step->y;
      solver::ConfigurationOf<System> configuration = solver::configuration_at(system, x);
      solver::Rates<System> rates = b.step->first;
      for (int iteration = 0; iteration < 30; ++iteration) {
        const bool moved = cycle.method == solver::Method::explicit_pair &&
                           solver::is_little(b.x - x, b.step->h, cycle.tolerance) &&
                           solver::move_a_little<false>(system, x, b.x - x, b.step->signs, rates, y, configuration);
        if (!moved) {
          auto inside = solver::evaluate_inside<false>(system, cycle, *b.step, b.x);
          if (!inside.admissible) {
            // Newton's method may fail for a part of an implicit step, if not for the whole: twice half the part then.
            const auto half = solver::evaluate_inside<false>(system, cycle, *b.step, 0.5 * (b.step->x + b.x));
            if (half.admissible) {
              const auto between = system.template rates<false>(half.end, half.y, b.step->signs);
              inside = solver::take_step<false>(cycle.method, system, 0.5 * (b.step->x + b.x), half.y,
                                                0.5 * (b.x - b.step->x), b.step->signs, between);
            }
          }
          if (!inside.admissible) break;
          y = inside.y;
          configuration = inside.end;
        }
        x = b.x;
        rates = system.template rates<false>(configuration, y, b.step->signs);
        const Derivative value = candidates(x, y, rates.dy, b.step->signs)[c];
        const double v = value.a, d = value.v[0];
        // What is left to gain, from the flatter of the two secants of the slope.
        const double curvature = std::min(std::abs((b.d0 - d) / (b.x - b.x0)), std::abs((d - b.d1) / (b.x1 - b.x)));
        // No more than the slope gives on the rest of the way: slopes that differ by rounding alone have no curvature.
        const double max_gain = d > 0.0 ? d * (b.x1 - x) : d * (b.x0 - x);
        const double gain = curvature > 0.0 ? std::min(0.5 * d * d / curvature, max_gain) : 0.0;
        best[c] = std::max(best[c], v);
        if (!(gain > 0.01 * tolerance * std::abs(v)) || b.x1 - b.x0 < 1e-13) {
          best[c] = std::max(best[c], v + gain);
          break;
        }
        if (d > 0.0) {
          b.x0 = b.x, b.v0 = v, b.d0 = d;
        } else {
          b.x1 = b.x, b.v1 = v, b.d1 = d;
        }
        estimate_maximum(b);
      }
    }
  }
  return best;
}

}  // namespace wingbeat
