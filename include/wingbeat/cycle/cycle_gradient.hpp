// A recorded cycle repeated on dual numbers: what orbit_gradient.hpp differentiates any system by.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/cycle/record.hpp"
#include "wingbeat/solve/linear.hpp"

namespace wingbeat {

/// The recorded cycle of any system with its switches where the signs change, and its repetition on dual numbers, whose
/// slots are those of orbit_gradient.hpp.
template <class System>
class CycleGradient {
 public:
  using J = GradientJet;
  using Jets = decltype(std::declval<System>().template cast<J>());
  using Along = decltype(std::declval<System>().template cast<Jet<1>>());
  using State = typename System::State;
  using JetState = typename Jets::State;
  static constexpr int N = int(std::tuple_size_v<State>);
  static_assert(N <= gradient_first_slot);

  CycleGradient(const RecordedCycle<System>& recorded, const decltype(Jets::vehicle)& vehicle)
      : system_(recorded.system), cycle_(recorded.cycle), jets_(recorded.system.template cast<J>()) {
    jets_.vehicle = vehicle;
    sharpen();
    for (auto& constant : absent_slots_) constant = false;
    if (!(recorded.system.vehicle.motor.armature_inductance > 0.0)) {
      for (int k = 0; k < gradient_slots; ++k) absent_slots_[k] = vehicle.motor.armature_inductance.v[k] != 0.0;
    }
    // At 1 a gearbox's efficiency has a derivative to one side alone.
    if (!has_gear_loss(recorded.system.vehicle.motor)) {
      for (int k = 0; k < gradient_slots; ++k) {
        absent_slots_[k] = absent_slots_[k] || vehicle.motor.gear_efficiency.v[k] != 0.0;
      }
    }
  }

  /// One cycle from the orbit's start, its states in the first slots. False where the fixed point is singular.
  bool run() {
    JetState y;
    for (int n = 0; n < N; ++n) y[n] = J(cycle_.steps.front().y[n], n);
    totals_.fill(J(0.0));
    starts_.reserve(cycle_.steps.size());
    for (std::size_t at = 0; at < cycle_.steps.size(); ++at) {
      const auto& step = cycle_.steps[at];
      solver::reset_map<true>(jets_, cycle_.steps, at, y, &totals_);
      starts_.push_back(y);
      const auto signs = solver::signs_of<Jets>(step);
      const auto first = jets_.template rates<true>(J(step.x), y, signs);
      const auto result = solver::take_step<true>(cycle_.method, jets_, J(step.x), y, J(step.h), signs, first);
      for (std::size_t q = 0; q < totals_.size(); ++q) totals_[q] += result.dq[q];
      y = result.y;
    }
    // (I - M) dy/dp = dP/dp, one right-hand side per slot behind the states.
    for (int k = N; k < gradient_slots; ++k) {
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

  /// The total derivative: that of the start added, the slots of the states emptied.
  J total(J x) const {
    for (int k = N; k < gradient_slots; ++k) {
      for (int n = 0; n < N; ++n) x.v[k] += x.v[n] * start_change_[n][k];
      if (absent_slots_[k]) x.v[k] = absent;
    }
    for (int n = 0; n < N; ++n) x.v[n] = 0.0;
    return x;
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
      const JetState y = state_at(places[c].step, places[c].x);
      const auto signs = solver::signs_of<Jets>(cycle_.steps[places[c].step]);
      const Motion<J> m = jets_.motion(J(places[c].x), y, signs);
      peaks[c] = total(jets_.candidates(m, y, signs)[c]);
    }
    return peaks;
  }

  GradientInstant instant(double theta) const {
    std::size_t n = cycle_.steps.size() - 1;
    while (n > 0 && cycle_.steps[n].x > theta) --n;
    const JetState y = state_at(n, theta);
    const auto signs = solver::signs_of<Jets>(cycle_.steps[n]);
    const Motion<J> m = jets_.motion(J(theta), y, signs);
    return {total(jets_.shaft_speed(y)),
            total(m.current),
            total(m.stroke_velocity),
            total(m.aero.lift),
            System::has_rod ? total(m.rod_force) / jets_.vehicle.motors : J(absent),
            total(m.motor_torque)};
  }

 private:
  struct PeakLocation {
    std::size_t step;
    double x;
  };
  struct Sample {
    double x;
    CycleExtremes<Jet<1>> value;  ///< with the derivative along the solution
  };

  JetState state_at(std::size_t step, double x) const {
    const auto& s = cycle_.steps[step];
    if (x == s.x) return starts_[step];
    const auto signs = solver::signs_of<Jets>(s);
    const auto first = jets_.template rates<false>(J(s.x), starts_[step], signs);
    return solver::take_step<false>(cycle_.method, jets_, J(s.x), starts_[step], J(x - s.x), signs, first).y;
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
  void sharpen() {
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

  /// Where each extreme lies.
  std::array<PeakLocation, extreme_count> locate() const {
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
      const State& y1 = last ? cycle_.end : cycle_.steps[n + 1].y;
      const State& dy1 = last ? cycle_.steps.front().first.dy : cycle_.steps[n + 1].first.dy;
      Sample before{};
      for (int k = 0; k <= pieces; ++k) {
        const double t = double(k) / pieces;
        Sample sample{step.x + t * step.h, {}};
        const State y = k == 0 ? step.y : solver::detail::hermite<System>(step.y, step.first.dy, y1, dy1, step.h, t);
        sample.value = candidates(n, sample.x, y);
        for (const Extreme e : System::extremes) {
          const auto c = std::size_t(e);
          const Jet<1>& v = sample.value[c];
          if ((k == 0) && v.a > highest[c]) {
            highest[c] = v.a;
            best[c] = {n, sample.x};
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
          const Jet<1> at = candidates(b.step, x, inside.y)[c];
          value = at.a;
          if (std::abs(x - previous) < 1e-11 || at.v[0] == 0.0) break;
          if (at.v[0] > 0.0) {
            b.x0 = x, b.d0 = at.v[0];
            if (side == 1) b.d1 *= 0.5;
            side = 1;
          } else {
            b.x1 = x, b.d1 = at.v[0];
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

  CycleExtremes<Jet<1>> candidates(std::size_t n, double x, const State& y) const {
    const auto signs = solver::signs_of<Along>(cycle_.steps[n]);
    const auto state = moving(y, system_.template rates<false>(x, y, cycle_.steps[n].signs).dy);
    return along_.candidates(along_.motion(Jet<1>(x, 0), state, signs), state, signs);
  }

  System system_;
  solver::Iterate<System> cycle_;
  Jets jets_;
  Along along_ = system_.template cast<Jet<1>>();
  CycleIntegrals<J> totals_;
  std::vector<JetState> starts_;
  double start_change_[N][gradient_slots] = {};
  bool absent_slots_[gradient_slots];
};

}  // namespace wingbeat
