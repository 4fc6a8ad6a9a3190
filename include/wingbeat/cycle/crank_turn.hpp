// A turn of a crank as the cycle of a periodic system, whatever hangs on the crank.
#pragma once

#include <array>
#include <span>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/solve/iterate.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// Base of the systems in crank angle, whose first state is the crank speed: the reversals of the stroke, where beta'
/// changes sign, are nodes that are known in advance.
template <Scalar S>
class CrankTurn {
 public:
  static constexpr bool has_rod = true;
  /// What has an extreme that is a metric.
  static constexpr std::array extremes = {Extreme::current,         Extreme::lift,
                                          Extreme::rod_force,       Extreme::flapping_velocity,
                                          Extreme::crank_speed_min, Extreme::crank_speed_max};

  static double period() { return two_pi; }
  /// Of a system on plain numbers, which cycles are run on.
  std::span<const solver::FixedNode> fixed_nodes() const { return {nodes_.data(), node_count_}; }

  template <class State>
  static const S& shaft_speed(const State& y) {
    return y[0];
  }
  /// d theta / dt [rad/s].
  template <class State>
  static const S& phase_rate(const State& y) {
    return y[0];
  }
  template <class State>
  static S shaft_angle(const S& theta, const State&) {
    return theta;
  }
  template <class State>
  static S stroke_angle(const Motion<S>& m, const State&) {
    return wingbeat::stroke_angle(m.kinematics);
  }

 protected:
  /// `stroke`: which of the signs is that of beta'.
  void turn_at(const Reversals& reversals, std::size_t stroke) {
    node_count_ = reversals.count;
    first_stroke_ = reversals.first_sign;
    for (std::size_t n = 0; n < node_count_; ++n) nodes_[n] = {reversals.angle[n], stroke};
  }
  double first_stroke() const { return first_stroke_; }

 private:
  std::array<solver::FixedNode, Reversals::max_count> nodes_{};
  std::size_t node_count_ = 0;
  double first_stroke_ = 1.0;
};

}  // namespace wingbeat
