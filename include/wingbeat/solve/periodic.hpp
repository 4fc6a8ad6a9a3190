// Periodic orbits of known period: the fixed point of the return map y(0) -> y(period).
//
// Damped systems forget their start within an iterate, so plain iterates are the iteration: coarse ones first, then one
// at the tolerance asked for. What is left of the start's error fades within a fraction of the next iterate, which is
// taken on the same mesh and only as far as it changes anything. Where iterates contract slowly, Newton steps with the
// monodromy matrix.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/solve/floquet.hpp"
#include "wingbeat/solve/iterate.hpp"
#include "wingbeat/solve/linear.hpp"
#include "wingbeat/solve/periodic_summary.hpp"

namespace wingbeat::solver {

/// Limits the work of searches that share it. The unit is a step of the explicit pair: a count, so that where a search
/// ends does not depend on the machine.
struct WorkBudget {
  long limit = std::numeric_limits<long>::max();
  long used = 0;

  bool spent() const { return used >= limit; }
  long left() const { return spent() ? 0 : limit - used; }
  /// A part of what is left, of at most `most`; whoever spends it adds what was used.
  WorkBudget part(long max_evaluations) const { return {std::min(max_evaluations, left()), 0}; }

  // What else takes, in steps of the explicit pair.
  static constexpr long implicit_step = 8;
  static constexpr long located_switch = 4;  ///< in steps of the same method
  static constexpr long derivative = 5;      ///< of a step, in steps of the same method
};

struct PeriodicOptions {
  double tolerance = 1e-6;  ///< wanted relative accuracy of the orbit and its integrals
  int max_iterates = 200;
  Method method = Method::explicit_pair;
  int max_steps = 80;     ///< of an iterate at the coarsest level, more is called stiff; ten times as many later
  bool stability = true;  ///< compute the monodromy matrix and the Floquet multipliers
  bool near = false;      ///< the guess is close to the orbit: no coarse iterates, which may lose it
  double expected_multiplier = 1.0;  ///< what an iterate is thought to leave of a distance from the orbit; decides
                                     ///< about coarse iterates, not about what is found
};

namespace detail {

/// Distances of each component.
template <class System>
typename System::State scaled_distances(const System& system, const typename System::State& a,
                                        const typename System::State& b) {
  const typename System::State scale = system.error_scale(a);
  typename System::State distances;
  for (std::size_t n = 0; n < a.size(); ++n) distances[n] = std::abs(a[n] - b[n]) / scale[n];
  return distances;
}

template <class System>
double scaled_distance(const System& system, const typename System::State& a, const typename System::State& b) {
  double distance = 0.0;
  for (const double scaled : scaled_distances(system, a, b)) distance = std::max(distance, scaled);
  return distance;
}

/// Runs the recorded steps again from the iterate's own end, until the solution has merged with the recorded one.
/// Returns the scaled residual of the closed orbit, at most `tolerance` if it merged before the end. `grazes` becomes
/// true where a switch has the wrong sign on the way, deeper than by an error of `position_error` in where it changes:
/// it has changed twice on a step that the iterate recorded without.
template <class System>
double close_on_mesh(const System& system, Iterate<System>& iterate, double tolerance, double position_error,
                     bool& grazes) {
  typename System::State y = iterate.end;
  double apart = scaled_distance(system, y, iterate.steps.front().y);
  ConfigurationOf<System> configuration = configuration_at(system, iterate.steps.front().x);
  for (std::size_t n = 0; n < iterate.steps.size() && apart > tolerance; ++n) {
    Step<System>& step = iterate.steps[n];
    typename System::Quadrature gained{};
    reset_map<true>(system, iterate.steps, n, y, &gained);
    if (n > 0) {
      for (std::size_t q = 0; q < gained.size(); ++q) iterate.steps[n - 1].dq[q] += gained[q];
    }
    step.y = y;
    step.first = system.template rates<true>(configuration, y, step.signs);
    const StepResult<System> result =
        take_step<true>(iterate.method, system, step.x, y, step.h, step.signs, step.first);
    if (!result.admissible) return std::numeric_limits<double>::infinity();
    step.dq = result.dq;
    if (iterate.method == Method::radau) iterate.stages[n] = result.stages;
    y = result.y;
    configuration = result.end;
    for (std::size_t k = 0; k < result.lowest.size(); ++k) {
      grazes = grazes || result.lowest[k] < -position_error * iterate.switch_scale[k];
    }
    const bool last = n + 1 == iterate.steps.size();
    apart = scaled_distance(system, y, last ? iterate.end : iterate.steps[n + 1].y);
    if (last) iterate.end = y;
  }
  return apart;
}

/// True of systems whose iterates contract too slowly to be merged by repeating them alone.
template <class System>
constexpr bool contracts_slowly() {
  if constexpr (requires { System::contracts_slowly; }) {
    return System::contracts_slowly;
  } else {
    return false;
  }
}

/// (1 - M)^-1 of a return map's derivative M: what moves the start of an iterate onto the orbit, and magnifies an
/// iterate's errors.
template <class System>
class IterateInverse {
 public:
  using State = typename System::State;
  static constexpr std::size_t n = std::tuple_size_v<State>;

  /// The derivative is that of `iterate`.
  IterateInverse(const System& system, const Iterate<System>& iterate)
      : derivative_(monodromy_product(system, system.template cast<Jet<int(n)>>(), iterate)),
        inverse_(derivative_.matrix()),
        at_(iterate.steps.front().y),
        steps_error_(10.0 * iterate.tolerance) {
    for (std::size_t k = 0; k < n * n; ++k) inverse_[k] = (k % (n + 1) == 0 ? 1.0 : 0.0) - inverse_[k];
    if (!invert(int(n), inverse_.data())) return;
    const State scale = system.error_scale(iterate.steps.front().y);
    for (std::size_t row = 0; row < n; ++row) {
      double sum = 0.0;
      for (std::size_t column = 0; column < n; ++column) {
        sum += std::abs(inverse_[row * n + column]) * scale[column] / scale[row];
      }
      amplification_ = std::max(amplification_, sum);
    }
    isolated_ = amplification_ < 1e9;
  }

  const MatrixProduct<n>& derivative() const { return derivative_; }

  /// True where it serves an iterate from `start` as that iterate's own would, but for a tenth of what it moves by.
  bool serves(const System& system, const State& start) const {
    return isolated_ && amplification_ * (steps_error_ + scaled_distance(system, at_, start)) < 0.1;
  }

  /// False where something drifts freely: neither a fixed point nor errors of it are to be had from the derivative.
  bool isolated() const { return isolated_; }

  /// How much further from the orbit an iterate's start may be than its end is from its start, at least 1.
  double amplification() const { return isolated_ ? amplification_ : 1.0; }

  /// Moves y, the end of the iterate, to the fixed point of the linearised return map. False, y unchanged, where that
  /// is not trustworthy.
  bool move(const System& system, const Iterate<System>& iterate, State& y) const {
    if (!isolated_) return false;
    const State& start = iterate.steps.front().y;
    State moved = start;
    for (std::size_t row = 0; row < n; ++row) {
      for (std::size_t column = 0; column < n; ++column) {
        moved[row] += inverse_[row * n + column] * (iterate.end[column] - start[column]);
      }
    }
    if (!system.admissible(moved) || !(scaled_distance(system, y, moved) < 0.5)) return false;
    y = moved;
    return true;
  }

 private:
  MatrixProduct<n> derivative_;
  std::array<double, n * n> inverse_;
  State at_;            ///< where the iterate began
  double steps_error_;  ///< of the derivative, at most
  bool isolated_ = false;
  double amplification_ = 1.0;
};

template <class System>
typename System::Quadrature totals_of(const Iterate<System>& iterate) {
  typename System::Quadrature totals{};
  for (const Step<System>& step : iterate.steps) {
    for (std::size_t q = 0; q < totals.size(); ++q) totals[q] += step.dq[q];
  }
  return totals;
}

/// What iterates' integrals must be more accurate than the steps' own scale by, for metrics that are small differences.
template <class System>
double cancellation(const System& system, const Iterate<System>& iterate) {
  if constexpr (requires(typename System::Quadrature totals) { system.cancellation(totals, totals); }) {
    return system.cancellation(totals_of(iterate), iterate.integral_scale);
  } else {
    return 1.0;
  }
}

/// What a closed iterate's integrals show of their errors, relative: 0 of systems that have no balance of them.
template <class System>
double imbalance(const System& system, const Iterate<System>& iterate) {
  if constexpr (requires(typename System::Quadrature totals) { system.imbalance(totals); }) {
    return system.imbalance(totals_of(iterate));
  } else {
    return 0.0;
  }
}

}  // namespace detail

/// Finds a periodic orbit from the state `guess` at x = 0. On success `iterate` holds the orbit's iterate with its
/// integrals. `system.cast<Jet<states>>()` must give it dual numbers for Newton steps and stability. The search ends
/// where `work` is used up. Throws nothing but Cancelled.
template <class System>
PeriodicSummary solve_periodic(const System& system, const typename System::State& guess,
                               const PeriodicOptions& options, Iterate<System>& iterate, WorkBudget& work) {
  using State = typename System::State;
  constexpr std::size_t n = std::tuple_size_v<State>;
  constexpr double slow_contraction = 0.1;
  constexpr double tightest = 2e-14, rounding = 3e-15;
  // Local errors add up over an iterate: this leaves the metrics of all but the oddest vehicles within the tolerance.
  const double fine = std::clamp(0.15 * options.tolerance, 1e-13, 1e-3);
  double closed = 0.1 * options.tolerance;

  PeriodicSummary summary;
  summary.status = PeriodicStatus::not_converged;
  const auto failed = [&](IterateStatus status) {
    summary.stop = iterate.stop;
    summary.status = status == IterateStatus::barrier ? PeriodicStatus::barrier : PeriodicStatus::too_many_steps;
  };
  iterate.switches.clear();
  iterate.largest_step = 0.0;
  const long per_step = options.method == Method::radau ? WorkBudget::implicit_step : 1;
  const auto steps_taken = [&] { work.used += per_step * long(iterate.steps.size()); };
  const auto derivatives_taken = [&] { work.used += WorkBudget::derivative * per_step * long(iterate.steps.size()); };

  // A fine iterate closes by repeating its mesh if its start was close enough for its switches to stay where they are.
  const double near_quickly = 0.1 * std::sqrt(options.tolerance), near_slowly = 0.03 * near_quickly;
  // Where an iterate all but forgets its start, what a coarse one leaves is soon gone.
  const bool forgets = options.expected_multiplier < 0.03;
  std::array<double, 3> tolerances = {std::max(fine, 1e-2), std::max(10.0 * fine, forgets ? 0.3 * near_quickly : 1e-7),
                                      fine};
  State y = guess, distances;
  distances.fill(1.0);
  double residual = 1.0, before_tolerance = tolerances[0];
  // Errors of an iterate are left in the orbit 1 / (1 - multiplier) times: unless iterates have been seen to contract
  // quickly, the return map's derivative tells.
  bool contracts = false, moved_by_newton = true, known = false;
  double amplification = 1.0, cancellation = 1.0, off = 1.0;
  double imbalance = 0.0, imbalance_before = std::numeric_limits<double>::infinity();
  int repeats = 0, rebalanced = 0;
  std::optional<MatrixProduct<n>> derivative;             // of the return map along the iterate as it is
  std::optional<detail::IterateInverse<System>> earlier;  // along an iterate before
  // A fine iterate too many costs twice what a coarse one does: the next may be thought near where it hardly is.
  const auto is_near_after = [&](double distance) {
    return forgets && distance * options.expected_multiplier < 2.0 * near_quickly;
  };
  constexpr double distance_of_guess = 0.05;
  const bool one_is_enough = is_near_after(distance_of_guess);
  for (std::size_t level = options.near || one_is_enough ? 1 : 0; summary.iterates < options.max_iterates;) {
    // Coarse iterates need only the switches at which the solution has kinks.
    const bool is_fine = level + 1 == tolerances.size(), first = level == 0 || summary.iterates == 0;
    if (work.spent()) {
      summary.status = PeriodicStatus::out_of_work;
      summary.stop = iterate.stop;
      break;
    }
    const long max_steps = first && !options.near ? options.max_steps : 10L * options.max_steps;
    const long affordable = (work.left() - 1) / per_step + 1;
    const IterateOptions iterate_options = {.method = options.method,
                                            .tolerance = tolerances[level],
                                            .max_steps = int(std::min(max_steps, affordable)),
                                            .switches = is_fine ? 1000 : System::state_switches};
    derivative.reset();
    if (is_fine) {
      run_iterate<true>(system, y, iterate_options, iterate);
    } else {
      run_iterate<false>(system, y, iterate_options, iterate);
    }
    ++summary.iterates;
    steps_taken();
    work.used += WorkBudget::located_switch * per_step * long(iterate.switches.size());
    if (iterate.status != IterateStatus::complete) {
      failed(iterate.status);
      const bool cut_short = iterate.status == IterateStatus::too_many_steps && affordable < max_steps;
      if (cut_short) summary.status = PeriodicStatus::out_of_work;
      return summary;
    }
    const double before = residual;
    const State distances_before = std::exchange(distances, detail::scaled_distances(system, iterate.end, y));
    residual = detail::scaled_distance(system, iterate.end, y);
    if (!std::isfinite(residual)) break;
    if (!moved_by_newton && before > 3.0 * before_tolerance && residual < slow_contraction * before) {
      // In every component: a current settles at once, whatever the speed of a heavy rotor does.
      bool each = true;
      for (std::size_t k = 0; k < n; ++k) {
        each = each && (distances[k] < slow_contraction * distances_before[k] || distances[k] < before_tolerance);
      }
      contracts = contracts || each;
    }
    moved_by_newton = false;
    const State start = y;
    y = iterate.end;

    if (is_fine && !contracts && !known) {
      // Coarse iterates were left before they could tell how quickly they contract, and this one has not shown it.
      const detail::IterateInverse<System> of_iterate(system, iterate);
      ++summary.iterates;
      derivatives_taken();
      known = true;
      derivative = of_iterate.derivative();
      amplification = of_iterate.amplification();
      if (amplification > 1.0 + slow_contraction) {
        tolerances[2] = std::max(fine / amplification, tightest);
        if (of_iterate.move(system, iterate, y)) ++summary.newton_steps, moved_by_newton = true;
        continue;
      }
    }
    const bool slow = detail::contracts_slowly<System>() || amplification > 1.0 + slow_contraction;
    const double near = slow ? near_slowly : near_quickly;
    off = residual;
    bool grazes = false;
    const double position_error = 0.7 * detail::switch_tolerance(iterate_options.tolerance);
    std::optional<detail::IterateInverse<System>> inverse;
    if (is_fine && slow) {
      // Far from the orbit an earlier iterate's derivative leads as near as its own would; once, in case it does not.
      // With few states the derivative takes no longer than an iterate from a start that is a little worse.
      State moved = y;
      if (n > 5 && earlier && earlier->serves(system, start) && earlier->move(system, iterate, moved) &&
          detail::scaled_distance(system, start, moved) >= near) {
        earlier.reset();
        y = moved;
        moved_by_newton = true;
        ++summary.newton_steps;
        continue;
      }
      derivative = inverse.emplace(system, iterate).derivative();
      ++summary.iterates;
      derivatives_taken();
      amplification = inverse->amplification();
    }
    if (inverse && inverse->isolated()) {
      const auto move_on = [&] {
        State moved = iterate.end;
        const bool good = inverse->move(system, iterate, moved);
        off = detail::scaled_distance(system, iterate.steps.front().y, moved);
        return std::pair{good, moved};
      };
      auto [good, moved] = move_on();
      if (good && off < near) {
        for (double previous = 1.0; good && off > closed && off < 0.5 * previous;) {
          previous = off;
          iterate.end = moved;
          derivative.reset();
          ++summary.newton_steps;
          residual = detail::close_on_mesh(system, iterate, std::max(closed / amplification, rounding), position_error,
                                           grazes);
          ++summary.iterates;
          steps_taken();
          std::tie(good, moved) = move_on();
        }
        // The last digits of an iterate are rounding, whatever that makes of the orbit.
        if (off <= closed || residual <= 5.0 * rounding) summary.status = PeriodicStatus::converged;
      }
      if (summary.status != PeriodicStatus::converged && good) {
        earlier = inverse;
        y = moved;
        moved_by_newton = true;
        ++summary.newton_steps;
        continue;
      }
    } else if (is_fine && residual < near) {
      for (double previous = 1.0; residual > closed && residual < 0.5 * previous;) {
        previous = residual;
        derivative.reset();
        residual = detail::close_on_mesh(system, iterate, closed, position_error, grazes);
        ++summary.iterates;
        steps_taken();
      }
      off = residual;
      if (residual <= closed) summary.status = PeriodicStatus::converged;
      y = iterate.end;
    }
    if (summary.status == PeriodicStatus::converged && grazes && repeats++ < 2) {
      summary.status = PeriodicStatus::not_converged;
      y = iterate.steps.front().y;
      continue;
    }
    if (summary.status == PeriodicStatus::converged) {
      const double needed = detail::cancellation(system, iterate);
      imbalance = detail::imbalance(system, iterate);
      const bool open = imbalance > 0.5 * options.tolerance, finest = tolerances[2] <= tightest;
      if (open && contracts && !known) {
        contracts = false;  // the return map's derivative tells after all
      } else if (!finest && needed > 1.5 * cancellation) {
        // Metrics that are small differences of what was controlled: once more, with tighter steps.
        cancellation = needed;
        closed = 0.1 * options.tolerance / cancellation;
        tolerances[2] = std::max(fine / (amplification * cancellation), tightest);
      } else if (!finest && open && imbalance < 0.8 * imbalance_before && rebalanced++ < 4) {
        // Errors of steps that estimates do not see, as long as finer ones make them less.
        imbalance_before = imbalance;
        tolerances[2] = std::max(tolerances[2] * std::clamp(0.2 * options.tolerance / imbalance, 1e-3, 0.2), tightest);
      } else {
        break;
      }
      summary.status = PeriodicStatus::not_converged;
      y = iterate.steps.front().y;
      continue;
    }

    // What the coarser of the two iterates got wrong says nothing about the contraction.
    const bool stalls = summary.iterates > 1 && residual > slow_contraction * before && residual > before_tolerance;
    before_tolerance = iterate_options.tolerance;
    const bool closes = forgets && level > 0 ? is_near_after(residual) : residual < (forgets ? 0.5 : 0.1);
    const bool ask = level + 2 == tolerances.size() && closes && !contracts && !known && !forgets;
    if ((stalls && residual < 0.5) || ask) {
      earlier.emplace(system, iterate);
      ++summary.iterates;
      derivatives_taken();
      known = ask;
      if (ask) {
        amplification = earlier->amplification();
        tolerances[2] = std::max(fine / amplification, tightest);
      }
      if ((stalls || amplification > 1.0 + slow_contraction) && earlier->move(system, iterate, y)) {
        ++summary.newton_steps;
        moved_by_newton = true;
        // The fine iterate may start from here only if the step was small.
        if (ask && detail::scaled_distance(system, start, y) > 0.1) continue;
      }
    }
    if (!is_fine && closes) ++level;
  }
  summary.residual = off;
  summary.steps = int(iterate.steps.size());
  if (summary.status != PeriodicStatus::converged) return summary;
  // Estimates of single steps are pessimistic.
  summary.error_estimate =
      std::max(0.4 * amplification * cancellation * iterate.error_sum + cancellation * off, 1.5 * imbalance);
  if (options.stability) {
    if (!derivative) derivative = monodromy_product(system, system.template cast<Jet<int(n)>>(), iterate);
    summary.floquet_multiplier_max = derivative->spectral_radius();
  }
  return summary;
}

/// The search with no limits but those of the options.
template <class System>
PeriodicSummary solve_periodic(const System& system, const typename System::State& guess,
                               const PeriodicOptions& options, Iterate<System>& iterate) {
  WorkBudget unlimited;
  return solve_periodic(system, guess, options, iterate, unlimited);
}

}  // namespace wingbeat::solver
