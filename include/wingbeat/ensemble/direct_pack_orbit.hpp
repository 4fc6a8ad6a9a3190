// The orbits of many direct drives at once, one per lane, by collocation over half a period of the supply.
//
// Without constant friction and pitch stop the equations are odd: half a period later the drive does the same with
// every sign turned. From one reversal of the stroke to the next the velocity keeps its sign, so that the equations are
// smooth there, and where the next reversal finds the drive turned in sign the orbit is closed. The phase of the supply
// at the reversal is unknown, the velocity is zero.
//
// Harmonic balance gives the first trajectory. Newton's method makes it satisfy the equations at the Radau points of
// equal segments, first of few, then of twice as many: what changes by that is the error estimate. Everything is
// computed lane by lane without looking at the neighbours, so that a vehicle gets the same bits in any batch. For the
// same reason no product is added to another product below: a compiler may fuse either one with the addition, and
// another one in each half of a block.
//
// direct_pack_balance.hpp holds the harmonic balance, direct_pack_newton.hpp Newton's method, direct_pack_metrics.hpp
// what is read from the orbit.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/pack.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/ensemble/direct_pack_blocks.hpp"
#include "wingbeat/ensemble/direct_pack_rule.hpp"
#include "wingbeat/ensemble/pack_lift.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// States stroke angle, velocity and, with inductance (N = 3), current.
template <class L, int N>
class DirectPackOrbit {
  using Mask = wingbeat::Mask<L>;
  using Rule = DirectPackRule;
  static constexpr std::size_t stages = Rule::stages, points = Rule::points;
  static constexpr std::size_t max_segments = std::size_t(max_direct_segments), max_nodes = max_segments * stages;
  using Vector = std::array<L, stages>;
  using Square = std::array<Vector, stages>;
  /// What moves a state: the residuals, the N start states, the phase at the reversal.
  static constexpr std::size_t columns = N + 2, of_phase = N + 1;
  using Row = std::array<L, columns>;
  using Polynomial = std::array<L, points>;
  /// What twice as many segments leave of an error at most: of a mean, and of what is read between the stages.
  static constexpr double mean_gain = 1.0 / 16.0, extreme_gain = 1.0;
  static constexpr double longest_move = 0.15;  ///< of Newton's method, relative to the harmonic response

 public:
  DirectPackOrbit(const Vehicle<L>& vehicle, const DirectPackSettings& settings)
      : vehicle_(vehicle), settings_(settings), rule_(direct_pack_rule()) {
    added_mass_ = any<L>(vehicle.wings.added_inertia > L(0.0));
    omega_drive_ = L(two_pi) * vehicle.drive_frequency;
    per_drive_ = L(1.0) / omega_drive_;
    per_resistance_ = L(1.0) / circuit_resistance(vehicle);
    if constexpr (N == 3) per_inductance_ = L(1.0) / vehicle.motor.armature_inductance;
    for (Row& row : half_map_) row.fill(L(0.0));
  }

  /// Metrics of the orbit. `mass` [kg] and `bench_torque_constant` [N m/A] may be absent.
  Metrics<L> solve(const L& mass, const L& bench_torque_constant);

  // After solve():
  const L& error_estimate() const { return error_estimate_; }
  const Mask& decided() const { return decided_; }

 private:
  /// What a cycle is read for: over a whole period, in time.
  struct Cycle {
    L current_square, speed_square, electrical_work, friction_work, aero_work, lift;
    L reactive_work, current_peak, velocity_peak, stroke;
  };
  /// Acceleration [rad/s2] and its derivatives.
  struct Acceleration {
    L value, by_speed, per_inertia;
  };

  [[gnu::noinline, gnu::flatten]] void balance();
  [[gnu::noinline, gnu::flatten]] L resistance(const L& speed) const;
  void set_mesh(int segments);
  [[gnu::noinline, gnu::flatten]] void harmonic_trajectory();
  [[gnu::noinline, gnu::flatten]] void halve();
  [[gnu::noinline]] void newton();
  [[gnu::noinline, gnu::flatten]] void prepare_segments();
  [[gnu::noinline, gnu::flatten]] void linearise(std::size_t segment, const std::array<L, std::size_t(N)>& start,
                                                 std::array<Row, std::size_t(N)>& end);
  [[gnu::noinline, gnu::flatten]] void close(const std::array<Row, std::size_t(N)>& end,
                                             std::array<L, columns>& move) const;
  [[gnu::noinline, gnu::flatten]] L correct(const std::array<L, columns>& move, const Mask& where);
  template <bool has_added_mass>
  [[gnu::noinline, gnu::flatten]] void accelerate(std::size_t node, Acceleration& out) const;
  template <bool has_added_mass>
  Motion<L> motion_of(const L& beta, const L& omega, const L& i, const L& v) const;
  [[gnu::noinline, gnu::flatten]] Cycle read();
  template <bool has_added_mass>
  [[gnu::noinline, gnu::flatten]] void read_nodes(Cycle& cycle);
  [[gnu::noinline, gnu::flatten]] void read_extremes(Cycle& cycle);
  L stored_in_wings(const L& beta, const L& omega) const;
  template <class Visit>
  void for_each_zero(const std::array<L, max_nodes>& slopes, const Visit& visit) const;
  static L derivative_of(const Polynomial& p, std::size_t order, const L& x);
  static L zero_of(const Polynomial& p, std::size_t order, L x, const L& from, const L& to, const Mask& where);
  Polynomial polynomial(const std::array<L, points>& values) const;
  L inside(const std::array<L, max_nodes>& values, const L& start, std::size_t segment, const L& x) const;
  [[gnu::noinline, gnu::flatten]] L floquet_multiplier() const;
  [[gnu::noinline, gnu::flatten]] L apart(const Cycle& a, const Cycle& b) const;

  std::size_t nodes() const { return segments_ * stages; }
  L voltage(std::size_t node) const { return L(0.0) + sine_ * L(phase_cosine_[node]) + cosine_ * L(phase_sine_[node]); }
  L voltage_slope(std::size_t node) const {
    return L(0.0) + cosine_ * L(phase_cosine_[node]) - sine_ * L(phase_sine_[node]);
  }
  L current(std::size_t node) const {
    if constexpr (N == 3) {
      return current_[node];
    } else {
      return algebraic_current(vehicle_, voltage(node), omega_[node]);
    }
  }

  const Vehicle<L>& vehicle_;
  const DirectPackSettings& settings_;
  const Rule& rule_;
  bool added_mass_;
  L omega_drive_, per_drive_;  ///< 2 pi f [rad/s]
  L per_resistance_, per_inductance_;
  Mask decided_;

  // Of the harmonic response.
  L responses_;          ///< their number
  L speed_, per_speed_;  ///< amplitude of beta' [rad/s]
  L current_in_phase_, current_ahead_, per_current_;

  // Where half a period starts.
  L phase_;                              ///< of the supply [rad]
  L sine_, cosine_;                      ///< of it, times the amplitude of the voltage [V]
  std::array<L, std::size_t(N)> start_;  ///< the states, with velocity 0

  std::size_t segments_ = 0;
  double length_ = 0.0;                                      ///< of a segment [rad]
  std::array<double, max_nodes> phase_sine_, phase_cosine_;  ///< of the distance from the reversal
  std::array<L, max_nodes> beta_, omega_, current_, acceleration_, moment_, energy_, current_slope_;

  // Of all segments of a mesh: with inductance the current's answer to its start, to the rates and to the speed.
  L length_in_time_;
  Vector current_by_start_;
  Square current_by_residual_, current_by_speed_, torque_by_speed_;
  /// What a segment's linearisation leaves for the corrections.
  struct Linearised {
    std::array<Vector, columns> omega;  ///< changes of the velocity
    Vector beta, current, current_by_phase;
  };
  std::array<Linearised, max_segments> linearised_;
  std::array<Row, std::size_t(N)> half_map_;  ///< derivative of the state at the end by that at the start
  L newton_change_;

  L error_estimate_;
};

template <class L, int N>
Metrics<L> DirectPackOrbit<L, N>::solve(const L& mass, const L& bench_torque_constant) {
  balance();
  decided_ = responses_ == L(1.0);
  set_mesh(settings_.segments);
  harmonic_trajectory();
  newton();
  decided_ = decided_ && newton_change_ <= L(settings_.closed);
  const Cycle coarse = read();
  halve();
  newton();
  const Cycle fine = read();
  decided_ = decided_ && newton_change_ <= L(settings_.closed);

  // What is not integrated here leaves its metrics absent.
  CycleIntegrals<L> integrals;
  integrals.fill(L(absent));
  const auto total = [&](Integral which) -> L& { return integrals[std::size_t(which)]; };
  total(Integral::time) = inverse_of(vehicle_.drive_frequency);
  total(Integral::current_square) = fine.current_square;
  total(Integral::speed_square) = fine.speed_square;
  total(Integral::electrical_work) = fine.electrical_work;
  total(Integral::friction_work) = fine.friction_work;
  total(Integral::aero_work) = fine.aero_work;
  total(Integral::motor_work) = fine.friction_work + fine.aero_work;
  total(Integral::travel) = L(4.0) * fine.stroke;
  total(Integral::lift) = fine.lift;
  total(Integral::reactive_work) = fine.reactive_work;
  for (const Integral none : {Integral::current, Integral::residual_work, Integral::rod_force, Integral::gear_work}) {
    total(none) = L(0.0);
  }
  CycleExtremes<L> extremes;
  extremes.fill(L(0.0));
  const auto extreme = [&](Extreme which) -> L& { return extremes[std::size_t(which)]; };
  extreme(Extreme::current) = fine.current_peak;
  extreme(Extreme::flapping_velocity) = fine.velocity_peak;
  extreme(Extreme::stroke_max) = extreme(Extreme::stroke_min) = fine.stroke;
  if (settings_.lift_peak) extreme(Extreme::lift) = lift_peak_up_to(vehicle_.wings, fine.velocity_peak);
  // Nothing returns a shaft without springs to any angle.
  const Mask returns = vehicle_.spring.stiffness > L(0.0);
  const L multiplier = select<L>(returns, floquet_multiplier(), L(absent));
  decided_ = decided_ && (!returns || multiplier < L(0.999));
  error_estimate_ = apart(coarse, fine);
  // Written so that what is no number is not decided.
  error_estimate_ =
      select<L>(decided_ && error_estimate_ >= L(0.0), error_estimate_, L(std::numeric_limits<double>::infinity()));
  return cycle_metrics(vehicle_, integrals, extremes, multiplier, ReportingOf<L>{mass, bench_torque_constant});
}

}  // namespace wingbeat
