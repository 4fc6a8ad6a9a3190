// A recorded cycle repeated on dual numbers: what orbit_gradient.hpp differentiates any system by.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "wingbeat/core/members.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/cycle/pitch_metrics.hpp"
#include "wingbeat/cycle/recorded_cycle.hpp"
#include "wingbeat/solve/linear.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// What is a metric of wings that pitch alone, with derivatives; see PitchMetrics.
struct PitchGradient {
  GradientJet amplitude;                                 ///< [rad]
  GradientJet phase;                                     ///< [rad]
  GradientJet angle_of_attack_min, angle_of_attack_max;  ///< [rad]
};

/// The recorded cycle of any system with its switches where the signs change, and its repetition on dual numbers. Those
/// that it gives have the slots of orbit_gradient.hpp; within, the slots behind the states are shifted where a system
/// has more states than those leave room for.
template <class System>
class CycleGradient {
 public:
  using J = GradientJet;
  using State = typename System::State;
  static constexpr int N = int(std::tuple_size_v<State>);
  /// A crank's voltage has a slot of its own; that of a direct drive may be a state's.
  static constexpr int shift = std::max(0, N - (System::has_rod ? gradient_voltage_slot : gradient_first_slot));
  static constexpr int slots = gradient_slots + shift;
  using W = Jet<slots>;
  using Jets = decltype(std::declval<System>().template cast<W>());
  using Along = decltype(std::declval<System>().template cast<Jet<1>>());
  using JetState = typename Jets::State;
  static constexpr bool pitching = System::on_hinges;

  CycleGradient(const RecordedCycle<System>& recorded,
                const decltype(std::declval<System>().template cast<GradientJet>().vehicle)& vehicle)
      : system_(recorded.system),
        cycle_(recorded.cycle),
        jets_(recorded.system.template cast<W>()),
        motors_(vehicle.motors) {
    if constexpr (shift == 0) {
      jets_.vehicle = vehicle;
    } else {
      std::array<const J*, number_count<Vehicle<J>>> from;
      std::array<W*, number_count<Vehicle<J>>> to;
      std::size_t n = 0, m = 0;
      for_each_number(vehicle, [&](const J& x) { from[n++] = &x; });
      for_each_number(jets_.vehicle, [&](W& x) { to[m++] = &x; });
      for (std::size_t k = 0; k < n; ++k) *to[k] = shifted(*from[k]);
    }
    sharpen();
    for (auto& constant : absent_slots_) constant = false;
    if (!has_current_state(recorded.system.vehicle)) {
      for (int k = 0; k < gradient_slots; ++k) absent_slots_[k] = vehicle.motor.armature_inductance.v[k] != 0.0;
    }
    // At 1 a gearbox's efficiency has a derivative to one side alone.
    if (!has_gear_loss(recorded.system.vehicle.motor)) {
      for (int k = 0; k < gradient_slots; ++k) {
        absent_slots_[k] = absent_slots_[k] || vehicle.motor.gear_efficiency.v[k] != 0.0;
      }
    }
  }

  /// The system on dual numbers: what it has beside its vehicle may be seeded before run().
  Jets& system() { return jets_; }

  /// One cycle from the orbit's start, its states in the first slots. False where the fixed point is singular.
  bool run();

  /// The state behind the cycle and the integrals over it, after run(): functions of the state at its start, in the
  /// first slots, and of what `vehicle` was built from, in those behind.
  const JetState& end() const { return end_; }
  const typename Jets::Quadrature& totals() const { return totals_; }

  /// The total derivative: that of the start added, the slots of the states emptied.
  J total(W x) const {
    J result(x.a);
    for (int k = N; k < slots; ++k) {
      for (int n = 0; n < N; ++n) x.v[k] += x.v[n] * start_change_[n][k];
      result.v[k - shift] = absent_slots_[k - shift] ? absent : x.v[k];
    }
    return result;
  }

  CycleIntegrals<J> integrals() const {
    CycleIntegrals<J> sums;
    for (std::size_t q = 0; q < sums.size(); ++q) sums[q] = total(totals_[q]);
    return sums;
  }

  CycleExtremes<J> extremes() const {
    CycleExtremes<J> peaks;
    peaks.fill(J(absent));
    const std::array<PeakLocation, extreme_count> places = locate();
    for (const Extreme e : System::extremes) {
      const auto c = std::size_t(e);
      const PeakLocation& place = places[c];
      const auto signs = solver::signs_of<Jets>(cycle_.steps[place.step]);
      W x(place.x);
      JetState y;
      if constexpr (pitching) y = state_on(place, x);
      else y = state_at(place.step, place.x);
      const Motion<W> m = jets_.motion(x, y, signs);
      peaks[c] = total(jets_.candidates(m, y, signs)[c]);
    }
    return peaks;
  }

  /// Mean loss in damping and stops of all hinges [W].
  J hinge_power() const
    requires pitching
  {
    return total(totals_[System::hinge_work] / totals_[std::size_t(Integral::time)]);
  }

  /// Mean of chordwise_lift() over the mean lift [1].
  J chordwise_share() const
    requires pitching
  {
    return total(totals_[System::chordwise] / totals_[std::size_t(Integral::lift)]);
  }

  /// What pitch_metrics() finds on plain numbers.
  PitchGradient pitch_gradient() const
    requires pitching
  {
    std::array<W, 2> psi, alpha;  // least and largest
    for (std::size_t n = 0; n < cycle_.steps.size(); ++n) {
      const double way = System::stroke_sign(cycle_.steps[n].signs);
      for (const std::size_t node : {n, n + 1}) {
        const W pitch = pitch_at_start(node), attack = 0.5 * pi + way * pitch;
        const bool first = n == 0 && node == 0;
        if (first || pitch < psi[0]) psi[0] = pitch;
        if (first || pitch > psi[1]) psi[1] = pitch;
        if (first || attack < alpha[0]) alpha[0] = attack;
        if (first || attack > alpha[1]) alpha[1] = attack;
      }
    }
    PitchGradient gradient;
    gradient.amplitude = total(0.5 * (psi[1] - psi[0]));
    gradient.angle_of_attack_min = total(alpha[0]);
    gradient.angle_of_attack_max = total(alpha[1]);
    gradient.phase = total(phase_of_pitch(totals_[std::size_t(Integral::time)]));
    return gradient;
  }

  GradientInstant instant(double theta) const {
    std::size_t n = cycle_.steps.size() - 1;
    while (n > 0 && cycle_.steps[n].x > theta) --n;
    const auto& step = cycle_.steps[n];
    const auto signs = solver::signs_of<Jets>(step);
    JetState y = starts_[n];
    W time = begins_[n];
    if (theta != step.x) {
      const auto inside =
          solver::take_step<true>(cycle_.method, jets_, system_, W(step.x), y, W(theta - step.x), signs);
      y = inside.y;
      time += inside.dq[std::size_t(Integral::time)];
    }
    State at;
    for (int k = 0; k < N; ++k) at[k] = y[k].a;
    const auto rates = system_.template rates<true>(theta, at, step.signs);
    const auto along_signs = solver::signs_of<Along>(step);
    const auto moved = moving(at, rates.dy);
    GradientInstant instant;
    static_cast<InstantValues<J>&>(instant) =
        values_at<J>(jets_, W(theta), y, signs, time, motors_, [&](const W& x) { return total(x); });
    instant.slopes = values_at<double>(along_, Jet<1>(theta, 0), moved, along_signs, Jet<1>(0.0), motors_.a,
                                       [](const Jet<1>& x) { return x.v[0]; });
    instant.slopes.time = rates.dq[std::size_t(Integral::time)];
    return instant;
  }

 private:
  struct PeakLocation {
    std::size_t step;
    double x;
    bool at_end = false;  ///< of the step
  };
  struct Sample {
    double x;
    CycleExtremes<Jet<1>> value;  ///< with the derivative along the solution
  };

  /// What acts at x, each number taken out by `take`.
  template <class Result, class Scalar, class On, class OnState, class Signs, class Motors, class Take>
  static InstantValues<Result> values_at(const On& on, const Scalar& x, const OnState& y, const Signs& signs,
                                         const Scalar& time, const Motors& motors, const Take& take) {
    const Motion<Scalar> m = on.motion(x, y, signs);
    InstantValues<Result> values{take(time),
                                 take(on.shaft_speed(y)),
                                 take(m.current),
                                 take(m.voltage),
                                 take(on.stroke_angle(m, y)),
                                 take(m.stroke_velocity),
                                 Result(absent),
                                 take(m.aero.lift),
                                 System::has_rod ? Result(take(m.rod_force) / motors) : Result(absent),
                                 take(m.motor_torque)};
    if constexpr (pitching) values.pitch_angle = take(On::local_pitch(y));
    return values;
  }

  /// A number in the slots that are used within.
  static W shifted(const J& x) {
    W result(x.a);
    for (int k = N - shift; k < gradient_slots; ++k) result.v[k + shift] = x.v[k];
    return result;
  }

  /// Where known, the states at the stages of a step.
  const auto* stages_of(std::size_t step) const { return cycle_.stages.empty() ? nullptr : &cycle_.stages[step]; }

  JetState state_at(std::size_t step, double x) const {
    const auto& s = cycle_.steps[step];
    if (x == s.x) return starts_[step];
    const auto signs = solver::signs_of<Jets>(s);
    return solver::take_step<true>(cycle_.method, jets_, system_, W(s.x), starts_[step], W(x - s.x), signs).y;
  }

  /// True where step n begins with an impact on a stop.
  bool impact_before(std::size_t n) const
    requires pitching
  {
    return n > 0 && cycle_.steps[n - 1].signs[System::impacts] != cycle_.steps[n].signs[System::impacts];
  }

  /// By how much the place where step n begins moves: a sign changes there, of a switch on the branch before.
  W move_of_node(std::size_t n) const
    requires pitching
  {
    constexpr std::size_t switches = std::tuple_size_v<typename System::Switches>;
    if (n == 0 || n >= cycle_.steps.size()) return W(0.0);
    const auto& before = cycle_.steps[n - 1];
    const auto& after = cycle_.steps[n];
    std::size_t which = switches;
    for (std::size_t k = switches; k-- > 0;) {
      if (before.signs[k] != after.signs[k]) which = k;
    }
    if constexpr (!System::turns) {
      if (before.signs[System::slip] != after.signs[System::slip]) {
        which = before.signs[System::slip] > 0.0 ? System::velocity : System::release;
      }
    }
    if (before.signs[System::held] != after.signs[System::held]) {
      which = before.signs[System::held] > 0.0 ? System::turn : System::stop;
    }
    if (impact_before(n)) which = System::stop;
    if constexpr (System::general) {
      if (before.signs[System::blocked] != after.signs[System::blocked]) which = System::bridge;
      if (before.signs[System::limited] != after.signs[System::limited]) which = System::limit;
      const bool at_pitch_stop = before.signs[System::pitching] != after.signs[System::pitching];
      if (at_pitch_stop && jumps_at_pitch_stop(system_.vehicle)) which = System::pitching;
    }
    if (which == switches) return W(0.0);
    const JetState& y = ends_[n - 1];
    const auto signs = solver::signs_of<Jets>(before);
    const W value = jets_.template rates<true>(W(after.x), y, signs).switches[which];
    State state;
    for (int i = 0; i < N; ++i) state[i] = y[i].a;
    const State dy = system_.template rates<false>(after.x, state, before.signs).dy;
    const double slope =
        along_.template rates<false>(Jet<1>(after.x, 0), moving(state, dy), solver::signs_of<Along>(before))
            .switches[which]
            .v[0];
    W move(0.0);
    move.v = -value.v / slope;
    return move;
  }

  /// The state at a peak, and in `x` where it is: a peak at the end of a branch, where the value may be kinked or jump,
  /// moves with that.
  JetState state_on(const PeakLocation& place, W& x) const
    requires pitching
  {
    const auto& step = cycle_.steps[place.step];
    const bool at_start = place.x == step.x;
    if (!place.at_end && !at_start) return state_at(place.step, place.x);
    const W move = move_of_node(at_start ? place.step : place.step + 1);
    JetState y = at_start ? starts_[place.step] : ends_[place.step];
    const auto dy = jets_.template rates<true>(x, y, solver::signs_of<Jets>(step)).dy;
    for (int n = 0; n < N; ++n) y[n] += dy[n] * move;
    x += move;
    return y;
  }

  /// psi [rad] where step n begins, at a reversal of a stroke whose velocity is a state at the reversal itself.
  W pitch_at_start(std::size_t n) const
    requires pitching
  {
    if (n == cycle_.steps.size()) return Jets::local_pitch(ends_.back());
    if constexpr (!System::turns) {
      const auto& step = cycle_.steps[n];
      if (n > 0 && step.signs[System::velocity] != cycle_.steps[n - 1].signs[System::velocity] &&
          step.signs[System::slip] > 0.0) {
        const auto& dy = step.first.dy;
        return Jets::local_pitch(starts_[n]) - System::local_pitch(dy) / dy[System::shaft] * starts_[n][System::shaft];
      }
    }
    return Jets::local_pitch(starts_[n]);
  }

  /// Of the first harmonics in time, as in pitch_metrics().
  W phase_of_pitch(const W& period) const
    requires pitching
  {
    W stroke_cosine(0.0), stroke_sine(0.0), pitch_cosine(0.0), pitch_sine(0.0), ended(0.0);
    for (std::size_t n = 0; n < cycle_.steps.size(); ++n) {
      const auto& step = cycle_.steps[n];
      const auto signs = solver::signs_of<Jets>(step);
      const auto along = [&](double h) {
        return solver::take_step<true>(cycle_.method, jets_, system_, W(step.x), starts_[n], W(h), signs);
      };
      const W time = begins_[n];
      const auto add = [&](const W& weight, const W& t, const W& x, const JetState& y) {
        const W angle = two_pi * t / period, cosine = weight * cos(angle), sine = weight * sin(angle);
        const W stroke = jets_.stroke_angle(x, y);
        stroke_cosine += cosine * stroke;
        stroke_sine += sine * stroke;
        pitch_cosine += cosine * Jets::local_pitch(y);
        pitch_sine += sine * Jets::local_pitch(y);
      };
      // An impact changes the speed of a crank, so that the duration changes with the crank angle of the impact.
      if (n > 0) add(W(time - ended), time, W(step.x), starts_[n]);
      for (std::size_t k = 0; k < detail::gauss_nodes.size(); ++k) {
        const double h = 0.5 * (1.0 + detail::gauss_nodes[k]) * step.h;
        const auto inside = along(h);
        const W x(step.x + h);
        const W dt = jets_.template rates<true>(x, inside.y, signs).dq[std::size_t(Integral::time)];
        add(W(0.5 * step.h * detail::gauss_weights[k] * dt), W(time + inside.dq[std::size_t(Integral::time)]), x,
            inside.y);
      }
      ended = time + along(step.h).dq[std::size_t(Integral::time)];
    }
    // The pitch that opposes the stroke velocity is along -j stroke.
    return atan2(pitch_cosine * stroke_cosine + pitch_sine * stroke_sine,
                 pitch_sine * stroke_cosine - pitch_cosine * stroke_sine);
  }

  /// The state with its derivative along the solution.
  static typename Along::State moving(const State& y, const State& dy) {
    typename Along::State state;
    for (int n = 0; n < N; ++n) {
      state[n].a = y[n];
      state[n].v[0] = dy[n];
    }
    return state;
  }

  /// Moves the step ends at which a sign flips onto the sign change, by Newton from the recorded place. Not those at
  /// fixed nodes (dead centres) and at jumps, which are where they belong.
  void sharpen();

  /// Where each extreme lies (cycle_gradient_peaks.hpp).
  std::array<PeakLocation, extreme_count> locate() const;

  CycleExtremes<Jet<1>> candidates(std::size_t n, double x, const State& y) const {
    const auto signs = solver::signs_of<Along>(cycle_.steps[n]);
    const auto state = moving(y, system_.template rates<false>(x, y, cycle_.steps[n].signs).dy);
    return along_.candidates(along_.motion(Jet<1>(x, 0), state, signs), state, signs);
  }

  System system_;
  solver::Iterate<System> cycle_;
  Jets jets_;
  J motors_;
  Along along_ = system_.template cast<Jet<1>>();
  typename Jets::Quadrature totals_;
  JetState end_;
  std::vector<JetState> starts_;
  std::vector<JetState> ends_;  ///< of the steps, of wings that pitch
  std::vector<W> begins_;       ///< time from the cycle's start at which each step begins [s]
  double start_change_[N][slots] = {};
  bool absent_slots_[gradient_slots];
};

template <class System>
bool CycleGradient<System>::run() {
  JetState y;
  for (int n = 0; n < N; ++n) y[n] = W(cycle_.steps.front().y[n], n);
  constexpr auto time = std::size_t(Integral::time);
  totals_.fill(W(0.0));
  starts_.reserve(cycle_.steps.size());
  if constexpr (pitching) ends_.reserve(cycle_.steps.size());
  for (std::size_t ended = 0; ended < cycle_.steps.size(); ++ended) {
    const auto& step = cycle_.steps[ended];
    solver::reset_map<true>(jets_, cycle_.steps, ended, y, &totals_);
    starts_.push_back(y);
    const auto signs = solver::signs_of<Jets>(step);
    const auto result =
        solver::take_step<true>(cycle_.method, jets_, system_, W(step.x), y, W(step.h), signs, stages_of(ended));
    for (std::size_t q = 0; q < totals_.size(); ++q) totals_[q] += result.dq[q];
    y = result.y;
    if constexpr (pitching) ends_.push_back(y);
    begins_.push_back(totals_[time] - result.dq[time]);
  }
  end_ = y;
  // (I - M) dy/dp = dP/dp, one right-hand side per slot behind the states.
  for (int k = N; k < slots; ++k) {
    double matrix[N * N], change[N];
    for (int row = 0; row < N; ++row) {
      for (int column = 0; column < N; ++column) {
        matrix[row * N + column] = (row == column ? 1.0 : 0.0) - y[row].v[column];
      }
      change[row] = y[row].v[k];
    }
    if (!solver::solve_linear(N, matrix, change)) return false;
    for (int row = 0; row < N; ++row) start_change_[row][k] = change[row];
  }
  return true;
}

template <class System>
void CycleGradient<System>::sharpen() {
  constexpr std::size_t switches = std::tuple_size_v<typename System::Switches>;
  for (std::size_t n = 1; n < cycle_.steps.size(); ++n) {
    auto& before = cycle_.steps[n - 1];
    auto& after = cycle_.steps[n];
    std::size_t flipped = switches;
    bool stays = false;
    for (std::size_t k = before.signs.size(); k-- > 0;) {
      if (before.signs[k] == after.signs[k]) continue;
      flipped = k;
      stays = stays || k >= switches || solver::jumps(system_, k);
    }
    if (flipped == switches || stays) continue;
    const auto rates = along_.template rates<false>(Jet<1>(after.x, 0), moving(after.y, after.first.dy),
                                                    solver::signs_of<Along>(after));
    const Jet<1> which = rates.switches[flipped];
    const double move = -which.a / which.v[0];
    if (!(std::abs(move) < 0.25 * std::min(before.h, after.h))) continue;
    before.h += move;
    after.x += move;
    after.h -= move;
    for (int i = 0; i < N; ++i) after.y[i] += move * after.first.dy[i];
  }
}

}  // namespace wingbeat

#include "wingbeat/cycle/cycle_gradient_peaks.hpp"
