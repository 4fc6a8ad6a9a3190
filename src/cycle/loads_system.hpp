// A periodic system with what the air does to a body among its integrals, and with the wave of a direct drive changed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "wingbeat/cycle/recorded_cycle.hpp"
#include "wingbeat/parts/drive_wave.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {

/// What is integrated beside the integrals of all vehicles, over the time of a cycle.
enum class BodyIntegral {
  lift_sideways,    ///< lift cos beta [N s]
  lift_forward,     ///< lift sin beta [N s]
  moment,           ///< M_aero [N m s]
  moment_sideways,  ///< M_aero cos beta [N m s]
};
inline constexpr std::size_t body_integral_count = 4;

/// `System` with the loads on a body. Of a direct drive, `vehicle.voltage` remains the amplitude of the wave, whose
/// halves meet at fixed nodes; of a crank the wave means nothing, and cycles are repeated, not searched for.
template <class System>
struct LoadsSystem : System {
  using Real = typename System::Real;
  using State = typename System::State;
  static constexpr std::size_t first_load = std::tuple_size_v<typename System::Quadrature>;
  using Quadrature = std::array<Real, first_load + body_integral_count>;
  static constexpr std::size_t wave_half = std::tuple_size_v<typename System::Signs>;  ///< the sign that nodes flip
  using Signs = std::array<Real, wave_half + 1>;
  static constexpr bool waved = !System::turns;

  DriveWave<Real> wave;

  static constexpr std::size_t index_of(BodyIntegral which) { return first_load + std::size_t(which); }

  template <Scalar T>
  auto cast() const {
    using Of = decltype(std::declval<const System&>().template cast<T>());
    return LoadsSystem<Of>{System::template cast<T>(), {T(wave.bias), T(wave.split), T(wave.cosine_split)}};
  }

  auto fixed_nodes() const {
    if constexpr (waved) {
      std::array<solver::FixedNode, 3> nodes;
      const std::array<double, 3> times = nodes_of(wave);
      for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] = {times[n], wave_half};
      return nodes;
    } else {
      return System::fixed_nodes();
    }
  }

  Signs start_signs(const State& y) const {
    Signs signs;
    signs.fill(Real(1.0));
    take(driven(Real(0.0)).start_signs_at(phase(Real(0.0)), y), signs);
    return signs;
  }

  void event_transition(std::size_t k, const Real& x, State& y, Signs& signs) const
    requires(waved && !System::on_hinges)
  {
    auto own = own_signs(signs);
    driven(x).event_transition(k, phase(x), y, own);
    take(own, signs);
  }
  void event_transition(std::size_t k, const Real& x, State& y, Signs& signs, Quadrature* totals) const
    requires System::on_hinges
  {
    auto own = own_signs(signs);
    typename System::Quadrature own_gained{};
    driven(x).event_transition(k, phase(x), y, own, &own_gained);
    take(own, signs);
    Quadrature gained{};
    std::copy(own_gained.begin(), own_gained.end(), gained.begin());
    set_impulses(gained, Real(System::stroke_angle(x, y)));
    add(gained, totals);
  }

  template <bool quadratures>
  void reset_map(const Real& x, State& y, const Signs& from, const Signs& to, Quadrature* totals) const
    requires(waved || System::on_hinges)
  {
    if constexpr (!quadratures) {
      System::template reset_map_of<false>(*this, x, y, from, to, totals);
    } else {
      Quadrature gained{};
      if (System::on_hinges && meets_stop(from, to)) {
        // Where a neighbouring solution meets the stop.
        const auto before = rates<false>(x, y, from);
        const Real room = pitch_stops::room_to_stop(*this, y);
        const Real late = room / before.dy[System::pitch];
        State there = y;
        for (std::size_t n = 0; n < y.size(); ++n) there[n] = y[n] + before.dy[n] * late;
        System::template reset_map_of<true>(*this, x, y, from, to, &gained);
        set_impulses(gained, Real(System::stroke_angle(Real(x + late), there)));
      } else {
        System::template reset_map_of<true>(*this, x, y, from, to, &gained);
      }
      add(gained, totals);
    }
  }

  template <bool quadratures, class At>
  solver::Rates<LoadsSystem> rates(const At& x, const State& y, const Signs& signs) const {
    using std::cos;
    using std::sin;
    const auto own = own_signs(signs);
    const auto& system = driven(x);
    const At here = phase(x);
    const auto rates_of_system = system.template rates<quadratures>(here, y, own);
    solver::Rates<LoadsSystem> r;
    r.dy = rates_of_system.dy;
    r.switches = rates_of_system.switches;
    if constexpr (quadratures) {
      std::copy(rates_of_system.dq.begin(), rates_of_system.dq.end(), r.dq.begin());
      const Motion<Real> m = system.motion(here, y, own);
      const Real beta = system.stroke_angle(m, y), time = rates_of_system.dq[std::size_t(Integral::time)];
      r.dq[index_of(BodyIntegral::lift_sideways)] = m.aero.lift * cos(beta) * time;
      r.dq[index_of(BodyIntegral::lift_forward)] = m.aero.lift * sin(beta) * time;
      r.dq[index_of(BodyIntegral::moment)] = m.aero.moment * time;
      r.dq[index_of(BodyIntegral::moment_sideways)] = m.aero.moment * cos(beta) * time;
    }
    return r;
  }

 private:
  /// The system where its supply gives the wave's voltage at x: a copy, which it sees at the peak of a sine.
  template <class At>
  decltype(auto) driven([[maybe_unused]] const At& x) const {
    if constexpr (waved) {
      System driven_system = *this;
      driven_system.vehicle.voltage = voltage_of_wave(wave, this->vehicle.voltage, x);
      return driven_system;
    } else {
      return static_cast<const System&>(*this);
    }
  }
  template <class At>
  static At phase(const At& x) {
    if constexpr (waved) return At(0.5 * pi);
    else return x;
  }

  static typename System::Signs own_signs(const Signs& signs) {
    typename System::Signs own;
    std::copy_n(signs.begin(), own.size(), own.begin());
    return own;
  }
  static void take(const typename System::Signs& own, Signs& signs) {
    std::copy(own.begin(), own.end(), signs.begin());
  }

  static bool meets_stop([[maybe_unused]] const Signs& from, [[maybe_unused]] const Signs& to) {
    if constexpr (System::on_hinges) return pitch_stops::has_impact<System>(own_signs(from), own_signs(to));
    else return false;
  }
  /// Of what was gained at an impact, at the stroke angle beta: the lift acts there, M_aero has no impulse.
  static void set_impulses(Quadrature& gained, const Real& beta) {
    using std::cos;
    using std::sin;
    const Real& lift = gained[std::size_t(Integral::lift)];
    gained[index_of(BodyIntegral::lift_sideways)] = lift * cos(beta);
    gained[index_of(BodyIntegral::lift_forward)] = lift * sin(beta);
  }
  static void add(const Quadrature& gained, Quadrature* totals) {
    if (!totals) return;
    for (std::size_t q = 0; q < gained.size(); ++q) (*totals)[q] = (*totals)[q] + gained[q];
  }
};

/// A cycle of a system as one of the system with loads, without those.
template <class System>
solver::Iterate<LoadsSystem<System>> with_loads(const solver::Iterate<System>& cycle) {
  solver::Iterate<LoadsSystem<System>> iterate;
  for (const auto& step : cycle.steps) {
    solver::Step<LoadsSystem<System>> to{step.x, step.h, step.y, {}, {}, {}};
    to.signs.fill(1.0);
    std::copy(step.signs.begin(), step.signs.end(), to.signs.begin());
    to.first.dy = step.first.dy;
    to.first.switches = step.first.switches;
    std::copy(step.first.dq.begin(), step.first.dq.end(), to.first.dq.begin());
    std::copy(step.dq.begin(), step.dq.end(), to.dq.begin());
    iterate.steps.push_back(to);
  }
  iterate.stages = cycle.stages;
  iterate.switches = cycle.switches;
  iterate.end = cycle.end;
  iterate.status = cycle.status;
  iterate.method = cycle.method;
  iterate.stop = cycle.stop;
  iterate.largest_step = cycle.largest_step;
  iterate.tolerance = cycle.tolerance;
  iterate.error_sum = cycle.error_sum;
  iterate.switch_scale = cycle.switch_scale;
  std::copy(cycle.integral_scale.begin(), cycle.integral_scale.end(), iterate.integral_scale.begin());
  return iterate;
}

/// Ends a step of a recorded cycle at x, unless one does within rounding.
template <class System>
void end_step_at(double x, RecordedCycle<System>& recorded) {
  auto& steps = recorded.cycle.steps;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    constexpr double rounding = 1e-9;
    if (x < steps[n].x + rounding || x > steps[n].x + steps[n].h - rounding) continue;
    const System& system = recorded.system;
    const solver::Method method = recorded.cycle.method;
    auto first = steps[n], second = steps[n];
    first.h = x - first.x;
    second.x = x;
    second.h = steps[n].x + steps[n].h - x;
    const auto to_x = solver::take_step<true>(method, system, first.x, first.y, first.h, first.signs, first.first);
    second.y = to_x.y;
    second.first = system.template rates<true>(x, second.y, second.signs);
    const auto on = solver::take_step<true>(method, system, x, second.y, second.h, second.signs, second.first);
    first.dq = to_x.dq;
    second.dq = on.dq;
    steps[n] = first;
    steps.insert(steps.begin() + std::ptrdiff_t(n) + 1, second);
    if (auto& stages = recorded.cycle.stages; !stages.empty()) {
      stages[n] = to_x.stages;
      stages.insert(stages.begin() + std::ptrdiff_t(n) + 1, on.stages);
    }
    return;
  }
}

}  // namespace wingbeat::detail
