// Periodic orbits of known period: the fixed point of the lap map y(0) -> y(period).
//
// Damped systems forget their start within a lap, so plain laps are the iteration: coarse ones first, then one at the
// tolerance asked for. What is left of the start's error fades within a fraction of the next lap, which is taken on the
// same mesh and only as far as it changes anything. Where laps contract slowly, Newton steps with the monodromy matrix.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/solve/lap.hpp"
#include "wingbeat/solve/linear.hpp"

namespace wingbeat::solve {

struct PeriodicOptions {
  double tolerance = 1e-6;      ///< wanted relative accuracy of the orbit and its integrals
  int max_laps = 200;
  Method method = Method::explicit_pair;
  int max_steps = 80;           ///< of a lap at the coarsest level, more is called stiff; ten times as many later
  bool stability = true;        ///< compute the monodromy matrix and the Floquet multipliers
  bool near = false;            ///< the guess is close to the orbit: no coarse laps, which may lose it
};

enum class PeriodicStatus {
  converged,
  barrier,        ///< laps run into the edge of the admissible region: no orbit was found
  too_many_steps, ///< a lap needs more steps than allowed
  not_converged   ///< laps neither settle nor fail within max_laps
};

/// How a search for an orbit ended, in the manner of Ceres and SUNDIALS.
struct PeriodicSummary {
  PeriodicStatus status = PeriodicStatus::not_converged;
  std::string message;
  int laps = 0;           ///< laps integrated, those with derivatives included
  int newton_steps = 0;
  int steps = 0;          ///< integration steps of the final lap
  double residual = 0.0;  ///< largest |y(period) - y(0)| over its error scale
  double stop = 0.0;      ///< where the last lap ended, if it did not complete
  double floquet_multiplier_max = std::numeric_limits<double>::quiet_NaN();
};

/// The monodromy matrix d y(period) / d y(0), row-major, of a recorded lap; `jets` is the system with Jet<states> scalars.
template <class JetSystem, class System>
auto monodromy(const JetSystem& jets, const Lap<System>& lap) {
  constexpr std::size_t n = std::tuple_size_v<typename System::State>;
  typename JetSystem::State start;
  for (std::size_t j = 0; j < n; ++j) start[j] = Jet<int(n)>(lap.steps.front().y[j], int(j));
  const typename JetSystem::State end = repeat_lap<false>(jets, start, lap);
  std::array<double, n * n> matrix;
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column < n; ++column) matrix[row * n + column] = end[row].v[Eigen::Index(column)];
  }
  return matrix;
}

namespace detail {

template <class System>
double scaled_distance(const System& system, const typename System::State& a, const typename System::State& b) {
  const typename System::State scale = system.error_scale(a);
  double distance = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) distance = std::max(distance, std::abs(a[n] - b[n]) / scale[n]);
  return distance;
}

/// Runs the recorded steps again from the lap's own end, until the solution has merged with the recorded one.
/// Returns the scaled residual of the closed orbit, at most `tolerance` if it merged before the end.
template <class System>
double merge_lap(const System& system, Lap<System>& lap, double tolerance) {
  typename System::State y = lap.end;
  double apart = scaled_distance(system, y, lap.steps.front().y);
  for (std::size_t n = 0; n < lap.steps.size() && apart > tolerance; ++n) {
    Step<System>& step = lap.steps[n];
    typename System::Quadrature gained{};
    carry_over<true>(system, lap.steps, n, y, &gained);
    if (n > 0) {
      for (std::size_t q = 0; q < gained.size(); ++q) lap.steps[n - 1].dq[q] += gained[q];
    }
    step.y = y;
    step.first = system.template rates<true>(step.x, y, step.signs);
    const StepResult<System> result = take_step<true>(lap.method, system, step.x, y, step.h, step.signs, step.first);
    if (!result.admissible) return std::numeric_limits<double>::infinity();
    step.dq = result.dq;
    y = result.y;
    const bool last = n + 1 == lap.steps.size();
    apart = scaled_distance(system, y, last ? lap.end : lap.steps[n + 1].y);
    if (last) lap.end = y;
  }
  return apart;
}

/// True of systems whose laps contract too slowly to be merged by repeating them alone.
template <class System>
constexpr bool contracts_slowly() {
  if constexpr (requires { System::contracts_slowly; }) {
    return System::contracts_slowly;
  } else {
    return false;
  }
}

/// Moves y, the end of a lap, to the fixed point of the linearised lap map. False, y unchanged, where that is not
/// trustworthy.
template <class System, class JetSystem>
bool newton_step(const System& system, const JetSystem& jets, const Lap<System>& lap, typename System::State& y) {
  constexpr std::size_t n = std::tuple_size_v<typename System::State>;
  std::array<double, n * n> matrix = monodromy(jets, lap);
  typename System::State moved;
  for (std::size_t row = 0; row < n; ++row) {
    moved[row] = lap.end[row] - lap.steps.front().y[row];
    for (std::size_t column = 0; column < n; ++column) {
      matrix[row * n + column] = (row == column ? 1.0 : 0.0) - matrix[row * n + column];
    }
  }
  if (!solve_linear(int(n), matrix.data(), moved.data())) return false;
  for (std::size_t row = 0; row < n; ++row) moved[row] += lap.steps.front().y[row];
  if (!system.admissible(moved) || !(scaled_distance(system, y, moved) < 0.5)) return false;
  y = moved;
  return true;
}

}  // namespace detail

/// Finds a periodic orbit from the state `guess` at x = 0. On success `lap` holds the orbit's lap with its integrals.
/// `system.cast<Jet<states>>()` must give it dual numbers for Newton steps and stability. Never throws.
template <class System>
PeriodicSummary solve_periodic(const System& system, const typename System::State& guess,
                               const PeriodicOptions& options, Lap<System>& lap) {
  using State = typename System::State;
  constexpr std::size_t n = std::tuple_size_v<State>;
  constexpr double slow_contraction = 0.1;
  // Local errors add up over a lap: this leaves the metrics of all but the oddest vehicles within the tolerance.
  const double fine = std::clamp(0.35 * options.tolerance, 1e-13, 1e-3);
  const double closed = 0.1 * options.tolerance;

  PeriodicSummary summary;
  const auto failed = [&](LapStatus status) {
    summary.stop = lap.stop;
    summary.status =
        status == LapStatus::barrier ? PeriodicStatus::barrier : PeriodicStatus::too_many_steps;
    summary.message = status == LapStatus::barrier ? "a lap ran into the edge of the admissible region"
                                                   : "a lap needs more steps than allowed";
    return summary;
  };
  lap.switches.clear();
  lap.largest_step = 0.0;

  const std::array<double, 3> tolerances = {std::max(fine, 1e-2), std::max(10.0 * fine, 1e-7), fine};
  State y = guess;
  double residual = 1.0, before_tolerance = tolerances[0];
  for (std::size_t level = options.near ? 1 : 0; summary.laps < options.max_laps;) {
    // Coarse laps need only the switches that bend the solution itself.
    const bool is_fine = level + 1 == tolerances.size();
    const LapOptions lap_options = {.method = options.method,
                                    .tolerance = tolerances[level],
                                    .max_steps = level == 0 ? options.max_steps : 10 * options.max_steps,
                                    .switches = is_fine ? 1000 : System::state_switches};
    if (is_fine) {
      run_lap<true>(system, y, lap_options, lap);
    } else {
      run_lap<false>(system, y, lap_options, lap);
    }
    ++summary.laps;
    if (lap.status != LapStatus::complete) return failed(lap.status);
    const double before = residual;
    residual = detail::scaled_distance(system, lap.end, y);
    if (!std::isfinite(residual)) break;
    y = lap.end;

    // A fine lap closes by merging if its start was close enough for its switches to stay where they are.
    constexpr double near = detail::contracts_slowly<System>() ? 3e-3 : 0.1;
    if (is_fine && residual < near * std::sqrt(options.tolerance)) {
      for (double previous = 1.0; residual > closed && residual < 0.5 * previous;) {
        previous = residual;
        if constexpr (detail::contracts_slowly<System>()) {
          if (detail::newton_step(system, system.template cast<Jet<int(n)>>(), lap, lap.end)) ++summary.newton_steps;
        }
        residual = detail::merge_lap(system, lap, closed);
        ++summary.laps;
      }
      if (residual <= closed) {
        summary.status = PeriodicStatus::converged;
        break;
      }
      y = lap.end;
    }
    // What the coarser of the two laps got wrong says nothing about the contraction.
    const bool slow = summary.laps > 1 && residual > slow_contraction * before && residual > before_tolerance;
    before_tolerance = lap_options.tolerance;
    if (slow && residual < 0.5) {
      if (detail::newton_step(system, system.template cast<Jet<int(n)>>(), lap, y)) ++summary.newton_steps;
      ++summary.laps;
    }
    if (!is_fine && residual < 0.1) ++level;
  }
  summary.residual = residual;
  summary.steps = int(lap.steps.size());
  if (summary.status != PeriodicStatus::converged) {
    summary.message = "laps did not close";
    return summary;
  }
  summary.message = "orbit closed";
  if (options.stability) {
    const std::array<double, n * n> matrix = monodromy(system.template cast<Jet<int(n)>>(), lap);
    summary.floquet_multiplier_max = spectral_radius(int(n), matrix.data());
  }
  return summary;
}

}  // namespace wingbeat::solve
