// A period of a sine supply as the cycle of a periodic system, whatever it drives.
#pragma once

#include <array>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/solve/iterate.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// Base of the systems in the phase of the supply, whose first states are the stroke angle and its rate.
template <Scalar S>
class SupplyPeriod {
 public:
  static constexpr bool has_rod = false;
  /// What has an extreme that is a metric; those of the pitching are in PitchMetrics.
  static constexpr std::array extremes = {Extreme::current, Extreme::lift, Extreme::flapping_velocity,
                                          Extreme::stroke_max, Extreme::stroke_min};

  static double period() { return two_pi; }
  static const std::array<solver::FixedNode, 0>& fixed_nodes() {
    static constexpr std::array<solver::FixedNode, 0> none = {};
    return none;
  }

  template <class State>
  static const S& shaft_speed(const State& y) {
    return y[1];
  }
  template <class State>
  static const S& shaft_angle(const S&, const State& y) {
    return y[0];
  }
  template <class State>
  static const S& stroke_angle(const Motion<S>&, const State& y) {
    return y[0];
  }
};

}  // namespace wingbeat
