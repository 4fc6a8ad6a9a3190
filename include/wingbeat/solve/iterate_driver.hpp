// Steps of an iterate from branch to branch: their size, and the search for the switches that end branches
// (iterate.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/minimise.hpp"
#include "wingbeat/solve/falling_zero.hpp"
#include "wingbeat/solve/iterate_record.hpp"
#include "wingbeat/solve/step_error.hpp"

namespace wingbeat::solver {
namespace detail {

/// Drives one iterate; see run_iterate.
template <bool quadratures, class System>
class IterateDriver {
 public:
  using State = typename System::State;
  using Signs = typename System::Signs;
  static constexpr double largest_decay = 6.0;  ///< |h lambda| within which the explicit pair is stable
  static constexpr std::size_t switch_count = std::tuple_size_v<typename System::Switches>;

  IterateDriver(const System& system, const IterateOptions& options, Iterate<System>& iterate)
      : system_(system),
        options_(options),
        iterate_(iterate),
        located_(std::min(switch_count, std::size_t(options.switches))),
        position_tolerance_(switch_tolerance(options.tolerance)),
        // A dip of a depth d, in which a branch is off by as much, is as long as sqrt(d): the error is its 3/2 power.
        dip_depth_(std::min(1e-6, std::pow(0.1 * options.tolerance, 2.0 / 3.0))),
        error_exponent_(options.method == Method::explicit_pair ? -1.0 / dop853::order
                                                                : -1.0 / RadauTableau::error_order) {}

  void run(const State& start) {
    begin(start);
    const double period = system_.period();
    double h = options_.first_step * period / two_pi;
    if (iterate_.largest_step > 0.0) {
      const double tighter = std::min(options_.tolerance / iterate_.tolerance, 1.0);
      h = iterate_.largest_step * std::pow(tighter, -error_exponent_);
    }
    iterate_.largest_step = 0.0;
    iterate_.tolerance = options_.tolerance;
    // A step must not jump over the shape of what is integrated along.
    const double longest = quadratures ? period / 12.0 : period;
    while (x_ < period) {
      if (int(iterate_.steps.size()) >= options_.max_steps) return stop(IterateStatus::too_many_steps);
      if (h < 1e-12 * period) return stop(IterateStatus::barrier);
      double node = period;
      if (fixed_ < system_.fixed_nodes().size()) node = std::min(node, system_.fixed_nodes()[fixed_].x);
      while (expected_ < plan_.size() && plan_[expected_].x <= x_ + position_tolerance_) ++expected_;
      // An expected switch right before a node is left to be found there: steps of no length are useless.
      const bool to_switch = expected_ < plan_.size() && plan_[expected_].x < node - position_tolerance_;
      const double target = to_switch ? plan_[expected_].x : node;

      const double left = target - x_;
      const double pieces = std::ceil(0.999 * left / std::min(h, longest));
      const bool reaches = pieces <= 1.0;
      double step = reaches ? left : left / pieces;
      StepResult<System> result = take_step<quadratures>(options_.method, system_, x_, y_, step, signs_, first_);
      if (!result.admissible || !is_finite(result.y) || (quadratures && !is_finite(result.dq))) {
        h = 0.25 * step;
        continue;
      }
      const double error = scaled_error<quadratures>(system_, result, options_.tolerance, integral_scale_);
      const double factor = error > 0.0 ? 0.9 * std::pow(error, error_exponent_) : 5.0;
      if (!(error <= 1.0)) {
        h = step * std::clamp(factor, 0.1, 0.9);
        if (!std::isfinite(error)) h = 0.25 * step;
        continue;
      }
      double x1 = reaches ? target : x_ + step;
      Rates<System> last = system_.template rates<quadratures>(result.end, result.y, signs_);
      if constexpr (quadratures) {
        // Beyond the pair's interval of stability, steps feed an oscillation that the error estimates hardly see.
        if (options_.method == Method::explicit_pair) {
          const double decay = step_times_decay(system_, result, last.dy, step);
          if (decay > largest_decay) {
            h = step * std::max(0.1, 0.9 * largest_decay / decay);
            continue;
          }
        }
      }
      bool flip = false;
      std::size_t flipped = switch_count;
      if (reaches && to_switch) {
        flip = end_on_expected(node, step, result, last);
        if (flip) flipped = plan_[expected_].sign;
        x1 = x_ + step;
      }
      std::size_t crossed = crossed_switch(last, flipped);
      if (crossed == switch_count && crossed_twice(step, result, last, flipped)) {
        // Two sign changes within the step: end it between them.
        flip = false;
        flipped = switch_count;
        x1 = x_ + step;
        crossed = crossed_switch(last, flipped);
      }
      if (crossed < switch_count) {
        if (!locate(crossed, step, result, last)) {
          // The switch lies where the step begins: flip there and take the step again.
          flip_here(crossed);
          continue;
        }
        flip = true;
        flipped = crossed;
        // Another switch that changed its sign before this one was seen at its end alone.
        for (std::size_t other = 0; other < switch_count; ++other) {
          const std::size_t earlier = crossed_switch(last, flipped);
          if (earlier == switch_count || !locate(earlier, step, result, last)) break;
          flipped = earlier;
        }
        x1 = x_ + step;
      }
      if (dips_beside_end(step, result, last, flipped)) {
        const std::size_t dips = crossed_switch(last, switch_count);
        if (dips < switch_count && !locate(dips, step, result, last)) {
          flip_here(dips);
          continue;
        }
        flip = dips < switch_count;
        flipped = dips;
        x1 = x_ + step;
      }
      note_others(step, result, last);
      iterate_.error_sum += error * options_.tolerance;
      accept(x1, step, result, last);
      if (flip) {
        flip_here(flipped);
      } else if (reaches && !to_switch && x1 < period) {
        pass_fixed_nodes();
      }
      h = std::max(h, step) * std::clamp(factor, 0.3, 3.0);
      if (!reaches || factor < 1.0) h = step * std::clamp(factor, 0.3, 3.0);
    }
    stop(IterateStatus::complete);
  }

 private:
  void begin(const State& start) {
    iterate_.method = options_.method;
    plan_.swap(iterate_.switches);
    if (located_ < switch_count) {
      std::erase_if(plan_, [&](const SwitchNode& node) { return node.sign >= located_; });
    }
    iterate_.switches.clear();
    iterate_.steps.clear();
    iterate_.stages.clear();
    iterate_.steps.reserve(64);
    iterate_.error_sum = 0.0;
    x_ = 0.0;
    y_ = start;
    configuration_ = configuration_at(system_, x_);
    if constexpr (requires { system_.start_signs(start); }) {
      signs_ = system_.start_signs(start);
    } else {
      signs_ = system_.start_signs();
    }
    // A switch may depend on the signs of those before it.
    for (std::size_t k = 0; k < switch_count; ++k) {
      if (jumps(system_, k)) continue;
      const Rates<System> rates = system_.template rates<quadratures>(configuration_, y_, signs_);
      signs_[k] = rates.switches[k] >= 0.0 ? 1.0 : -1.0;
    }
    first_ = system_.template rates<quadratures>(configuration_, y_, signs_);
    remember_switch_scale(first_);
    integral_scale_ = {};
    remember_integral_scale();
  }

  void stop(IterateStatus status) {
    iterate_.status = status;
    iterate_.stop = x_;
    iterate_.end = y_;
    iterate_.switch_scale = switch_scale_;
    iterate_.integral_scale = integral_scale_;
  }

  void remember_switch_scale(const Rates<System>& rates) {
    for (std::size_t k = 0; k < switch_count; ++k) {
      switch_scale_[k] = std::max(switch_scale_[k], std::abs(rates.switches[k]));
    }
  }

  /// How closely the position of switch k must be known.
  double position_tolerance(std::size_t k) const {
    return jumps(system_, k) ? std::max(0.01 * options_.tolerance, 1e-14) : position_tolerance_;
  }

  /// Moves the end of a step onto the expected switch there; false if that is not near, or beyond the next node.
  bool end_on_expected(double node, double& step, StepResult<System>& result, Rates<System>& last) {
    const std::size_t k = plan_[expected_].sign;
    const double near_end = 0.95;
    const State before = hermite<System>(y_, first_.dy, result.y, last.dy, step, near_end);
    double slope =
        (last.switches[k] - system_.template rates<false>(x_ + near_end * step, before, signs_).switches[k]) /
        ((1.0 - near_end) * step);
    if (slope * signs_[k] >= 0.0) return false;
    double moved = step;
    const int corrections = jumps(system_, k) ? 8 : 3;
    for (int correction = 0; correction < corrections; ++correction) {
      const double off = last.switches[k] / slope;
      if (std::abs(off) <= position_tolerance(k)) return true;
      const double value = last.switches[k];
      moved -= off;
      if (!(moved > 0.7 * step && moved < 1.3 * step && x_ + moved < node)) return false;
      if (!move_end(k, moved, step, result, last)) return false;
      if (corrections > 3) slope = (value - last.switches[k]) / off;
    }
    return false;
  }

  /// Moves the end of a step to where it is `to` long, for switch k; false, nothing changed, where the state there is
  /// not admissible.
  bool move_end(std::size_t k, double to, double& step, StepResult<System>& result, Rates<System>& last) {
    const bool little = is_little(to - step, step, options_.tolerance);
    if (little && options_.method == Method::explicit_pair && !jumps(system_, k)) {
      if (!move_a_little<quadratures>(system_, x_ + step, to - step, signs_, last, result.y, result.end, &result.dq)) {
        return false;
      }
    } else {
      const StepResult<System> again = take_step<quadratures>(options_.method, system_, x_, y_, to, signs_, first_);
      if (!again.admissible) return false;
      result = again;
    }
    step = to;
    last = system_.template rates<quadratures>(result.end, result.y, signs_);
    return true;
  }

  /// The switch that was crossed first in a step, or switch_count; `ended_on` is not looked at. Zero counts as not
  /// crossed.
  std::size_t crossed_switch(const Rates<System>& last, std::size_t ended_on) {
    remember_switch_scale(last);
    std::size_t crossed = switch_count;
    if (flips_here_ >= 2 * int(switch_count)) return crossed;
    double earliest = 2.0;
    for (std::size_t k = 0; k < located_; ++k) {
      if (last.switches[k] * signs_[k] >= 0.0 || std::abs(last.switches[k]) < 1e-15 * switch_scale_[k]) continue;
      if (k == ended_on) continue;
      const double from = std::max(0.0, first_.switches[k] * signs_[k]);
      const double fraction = from / (from + std::abs(last.switches[k]));
      if (fraction < earliest) {
        earliest = fraction;
        crossed = k;
      }
    }
    return crossed;
  }

  /// Looks for a switch that changes sign and back within a step; if there is one, shortens the step to end in between.
  bool crossed_twice(double& step, StepResult<System>& result, Rates<System>& last, std::size_t ended_on) {
    if (step < 4.0 * position_tolerance_) return false;
    bool seen = false;
    for (std::size_t k = 0; k < located_; ++k) {
      seen = seen || (k != ended_on && result.lowest[k] < -dip_depth_ * switch_scale_[k]);
    }
    if (seen) {
      for (const double t : {0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875, 0.9375}) {
        if (ends_between(t, step, result, last, ended_on)) return true;
      }
      return false;
    }
    // A short dip may lie between two stages: none sees more than that the switch comes near zero.
    for (std::size_t k = 0; k < located_; ++k) {
      const double ends = std::min(first_.switches[k] * signs_[k], last.switches[k] * signs_[k]);
      const bool comes_near = result.lowest[k] < std::min(0.05 * switch_scale_[k], 0.8 * ends);
      if (k == ended_on || !comes_near) continue;
      if (ends_between(lowest_within(k, 0.0, 1.0, step, result, last), step, result, last, ended_on)) return true;
    }
    return false;
  }

  /// A switch that is about zero at an end of the step, as where one with the same zero was crossed, may have the wrong
  /// sign right beside it, before the first or behind the last stage; if so, shortens the step to end there.
  bool dips_beside_end(double& step, StepResult<System>& result, Rates<System>& last, std::size_t ended_on) {
    for (std::size_t k = 0; k < located_; ++k) {
      if (k == ended_on || k == begun_on_ || jumps(system_, k)) continue;
      const auto dips = [&](double at_end, double place, double from, double to) {
        return is_about_zero(at_end, k) && switch_inside(k, place, step, result, last) < std::min(at_end, 0.0) &&
               ends_between(lowest_within(k, from, to, step, result, last), step, result, last, ended_on);
      };
      if (dips(first_.switches[k] * signs_[k], beside(step), 0.0, 0.5)) return true;
      if (dips(last.switches[k] * signs_[k], 1.0 - beside(step), 0.5, 1.0)) return true;
    }
    return false;
  }

  /// At an end of a step, where another zero may be beside(), that part of the step away.
  bool is_about_zero(double value, std::size_t k) const {
    return std::abs(value) <= 10.0 * position_tolerance_ * switch_scale_[k];
  }
  double beside(double step) const { return std::clamp(position_tolerance_ / step, 1e-4, 0.1); }

  /// If some switch has the wrong sign at the part t of a step, and at the end of a step that ends there, takes that.
  bool ends_between(double t, double& step, StepResult<System>& result, Rates<System>& last, std::size_t ended_on) {
    const State y = hermite<System>(y_, first_.dy, result.y, last.dy, step, t);
    const Rates<System> inside = system_.template rates<false>(x_ + t * step, y, signs_);
    for (std::size_t k = 0; k < located_; ++k) {
      if (k == ended_on || inside.switches[k] * signs_[k] >= -dip_depth_ * switch_scale_[k]) continue;
      const double shorter = t * step;
      const StepResult<System> again =
          take_step<quadratures>(options_.method, system_, x_, y_, shorter, signs_, first_);
      if (!again.admissible) return false;
      const Rates<System> end_rates = system_.template rates<quadratures>(again.end, again.y, signs_);
      if (end_rates.switches[k] * signs_[k] >= 0.0) continue;
      step = shorter;
      result = again;
      last = end_rates;
      return true;
    }
    return false;
  }

  /// Switch k at the part t of a step, by the cubic through its ends; positive where it has its sign.
  double switch_inside(std::size_t k, double t, double step, const StepResult<System>& result,
                       const Rates<System>& last) const {
    const State y = hermite<System>(y_, first_.dy, result.y, last.dy, step, t);
    return system_.template rates<false>(x_ + t * step, y, signs_).switches[k] * signs_[k];
  }

  /// Part of a step at which switch k is lowest, between two parts.
  double lowest_within(std::size_t k, double from, double to, double step, const StepResult<System>& result,
                       const Rates<System>& last) const {
    return minimise([&](double t) { return switch_inside(k, t, step, result, last); }, from, to, 1e-3).argument;
  }

  /// Shortens the step to end where switch k changes sign; false if that is at its very start.
  bool locate(std::size_t k, double& step, StepResult<System>& result, Rates<System>& last) {
    const double whole = step;
    const auto value = [&](double advance) {
      const State y = hermite<System>(y_, first_.dy, result.y, last.dy, whole, advance / whole);
      return system_.template rates<false>(x_ + advance, y, signs_).switches[k] * signs_[k];
    };
    double lo = 0.0, hi = whole;
    double f_lo = first_.switches[k] * signs_[k], f_hi = last.switches[k] * signs_[k];
    if (is_about_zero(f_lo, k) && value(beside(whole) * whole) > std::max(f_lo, 0.0)) {
      // The switch begins next to a zero of its own: what is sought lies beyond the rise from there.
      lo = minimise([&](double advance) { return -value(advance); }, 0.0, 0.5 * whole, 1e-3 * whole).argument;
      f_lo = value(lo);
      if (!(f_lo > 0.0)) lo = beside(whole) * whole, f_lo = value(lo);
    } else if (f_lo <= 1e-15 * switch_scale_[k]) {
      // A sign may have been flipped a little before its zero: look past it.
      lo = std::min(2.0 * position_tolerance_, 0.5 * whole);
      f_lo = value(lo);
      if (f_lo <= 0.0) return false;
    }
    // So the end may be a little beyond another zero, between which and the one sought the switch is lower.
    if (is_about_zero(f_hi, k) && value((1.0 - beside(whole)) * whole) < f_hi) {
      hi = lowest_within(k, 0.5, 1.0, whole, result, last) * whole;
      f_hi = value(hi);
    }
    auto [root, slope] = falling_zero(value, lo, f_lo, hi, f_hi, whole, 0.1 * position_tolerance_);
    if (root < 1e-3 * position_tolerance_) return false;
    // The Hermite state is of lower order than the step: correct with steps that end at the switch.
    const int corrections = jumps(system_, k) ? 12 : 4;
    double value_before = 0.0, moved = 0.0, least = std::numeric_limits<double>::infinity(), best = root;
    const auto end_at = [&](double to) {
      step = to;
      result = take_step<quadratures>(options_.method, system_, x_, y_, step, signs_, first_);
      last = system_.template rates<quadratures>(result.end, result.y, signs_);
    };
    for (int correction = 0; correction < corrections; ++correction) {
      if (correction == 0 || !move_end(k, root, step, result, last)) end_at(root);
      const double signed_value = last.switches[k] * signs_[k];
      if (std::abs(signed_value) > least) {
        // Next to a second zero the slope says little.
        root = 0.5 * (root + best);
        moved = 0.0;
        continue;
      }
      least = std::abs(signed_value);
      best = root;
      if (corrections > 4 && moved != 0.0 && signed_value != value_before) {
        slope = (value_before - signed_value) / moved;
      }
      const double off = slope != 0.0 ? signed_value / slope : 0.0;
      if (std::abs(off) <= position_tolerance(k) || root - off <= 0.0) break;
      root -= off;
      moved = off;
      value_before = signed_value;
    }
    if (std::abs(last.switches[k]) > least) end_at(best);
    return true;
  }

  /// Notes the sign changes of switches on which no step needs to end, to the accuracy of a secant.
  void note_others(double step, const StepResult<System>& result, const Rates<System>& last) {
    for (std::size_t k = located_; k < switch_count; ++k) {
      if (last.switches[k] * signs_[k] >= 0.0) continue;
      const double t = first_.switches[k] / (first_.switches[k] - last.switches[k]);
      if (t > 0.0 && t < 1.0) {
        const State y = hermite<System>(y_, first_.dy, result.y, last.dy, step, t);
        const double f0 = first_.switches[k], f1 = last.switches[k];
        const double ft = system_.template rates<false>(x_ + t * step, y, signs_).switches[k];
        // The parabola's zero, by one more secant on the side that holds it.
        const bool after = (ft > 0.0) == (f0 > 0.0);
        const double better = after ? t + (1.0 - t) * ft / (ft - f1) : t * f0 / (f0 - ft);
        iterate_.switches.push_back({x_ + better * step, k});
      }
      signs_[k] = -signs_[k];
    }
  }

  void accept(double x1, double step, const StepResult<System>& result, const Rates<System>& last) {
    iterate_.steps.push_back({x_, step, y_, signs_, first_, result.dq});
    if (options_.method == Method::radau) iterate_.stages.push_back(result.stages);
    iterate_.largest_step = std::max(iterate_.largest_step, step);
    x_ = x1;
    y_ = result.y;
    configuration_ = result.end;
    first_ = last;
    flips_here_ = 0;
    begun_on_ = switch_count;
    remember_integral_scale();
  }

  void remember_integral_scale() {
    if constexpr (quadratures) {
      // An iterate's integral is a good part of its largest integrand times the period.
      for (std::size_t q = 0; q < first_.dq.size(); ++q) {
        integral_scale_[q] = std::max(integral_scale_[q], 0.3 * system_.period() * std::abs(first_.dq[q]));
      }
    }
  }

  /// Flips a located sign at the present position.
  void flip_here(std::size_t k) {
    if constexpr (state_jumps<System>()) {
      typename System::Quadrature at_once{};
      system_.event_transition(k, x_, y_, signs_, &at_once);
      if (quadratures && !iterate_.steps.empty()) {
        for (std::size_t q = 0; q < at_once.size(); ++q) iterate_.steps.back().dq[q] += at_once[q];
      }
    } else if constexpr (requires { system_.event_transition(k, x_, y_, signs_); }) {
      system_.event_transition(k, x_, y_, signs_);
    } else {
      signs_[k] = -signs_[k];
    }
    ++flips_here_;
    begun_on_ = k;
    iterate_.switches.push_back({x_, k});
    // The other switches may have jumped over their zeros with the rates.
    if (jumps(system_, k)) settle_signs(system_, x_, y_, signs_);
    first_ = system_.template rates<quadratures>(configuration_, y_, signs_);
  }

  void pass_fixed_nodes() {
    while (fixed_ < system_.fixed_nodes().size() && system_.fixed_nodes()[fixed_].x <= x_) {
      const std::size_t k = system_.fixed_nodes()[fixed_].sign;
      signs_[k] = -signs_[k];
      ++fixed_;
    }
    first_ = system_.template rates<quadratures>(configuration_, y_, signs_);
  }

  const System& system_;
  const IterateOptions& options_;
  Iterate<System>& iterate_;
  const std::size_t located_;
  const double position_tolerance_;
  const double dip_depth_;  ///< that counts, of a switch's largest magnitude
  const double error_exponent_;
  std::vector<SwitchNode> plan_;
  std::size_t expected_ = 0;
  std::size_t fixed_ = 0;
  int flips_here_ = 0;
  std::size_t begun_on_ = switch_count;  ///< flipped where the step begins
  double x_ = 0.0;
  ConfigurationOf<System> configuration_;  ///< at x_
  State y_;
  Signs signs_;
  Rates<System> first_;
  std::array<double, switch_count> switch_scale_{};
  typename System::Quadrature integral_scale_;
};

}  // namespace detail

}  // namespace wingbeat::solver
