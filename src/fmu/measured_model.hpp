// A model in time that sums up its cycles: what a co-simulation steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "fmu/dynamics.hpp"
#include "time/crank_model.hpp"
#include "time/direct_model.hpp"
#include "time/pitch_direct_model.hpp"
#include "time/simulation.hpp"

namespace wingbeat::fmu {

using detail::quadrature_count;

/// Integrals since the start, the means of the last whole cycle, and whether there was one since the last standstill.
struct CycleMeans {
  std::array<double, quadrature_count> sums{}, at_begin{}, mean{};  ///< in the order of detail::quadratures
  double begin = 0.0;                                               ///< of the cycle under way [s]
  double mark = 0.0;    ///< crank angle, of a direct drive phase of its supply, where that cycle began [rad]
  double period = 0.0;  ///< of the last whole one [s]
  double phase = 0.0, phase_time = 0.0;  ///< of a direct drive's supply: phase [rad] at that time [s]
  double direction = 0.0;                ///< in which the crank turns; 0: it has not turned yet
  double stood_since = 0.0;              ///< [s]
  bool whole = false;                    ///< there was a whole cycle since the start, a standstill or a reversal
  bool rests = false;                    ///< hardly moves, without friction that holds it
  bool stood = false;                    ///< stood at the last event
  std::int64_t cycles = 0;

  /// Calls use(number) for each of them.
  template <class Self, class Use>
  static void each(Self& self, const Use& use) {
    for (auto* numbers : {&self.sums, &self.at_begin, &self.mean}) {
      for (auto& x : *numbers) use(x);
    }
    use(self.begin), use(self.mark), use(self.period), use(self.phase), use(self.phase_time), use(self.direction);
    use(self.stood_since), use(self.whole), use(self.rests), use(self.stood), use(self.cycles);
  }

  void begin_cycle(double time) {
    at_begin = sums;
    begin = time;
  }
  void end_cycle(double time) {
    if (time > begin) {
      period = time - begin;
      for (std::size_t k = 0; k < sums.size(); ++k) mean[k] = (sums[k] - at_begin[k]) / period;
      whole = true;
    }
    begin_cycle(time);
    ++cycles;
  }
};

/// The work that a step may take has been done.
struct WorkSpent {};

/// CrankModel, DirectModel or PitchDirectModel; satisfies TimeModel. A crank's cycle ends where the crank has turned
/// once more in either direction, a direct drive's at the end of a period of its supply.
template <class Base>
class MeasuredModel : public Base {
 public:
  static constexpr bool crank = std::is_same_v<Base, detail::CrankModel>;
  static constexpr std::size_t cycle_end = std::size_t(Base::indicator_count), rest = cycle_end + 1;
  static constexpr std::size_t indicator_count = cycle_end + (crank ? 2 : 0);
  /// Of typical speeds and currents: below it a crank rests, above the double it turns. Of a direct drive: of its
  /// typical speed, the root mean square over a cycle.
  static constexpr double rest_level = 1e-3;

  using Base::Base;

  CycleMeans means;
  double rest_speed = 1.0, rest_current = 1.0;  ///< typical sizes at the voltage that the vehicle states [rad/s], [A]
  mutable std::int64_t work_left = 0;           ///< evaluations of the rates

  /// Typical sizes are now those by which rest is assessed.
  void judge_rest_by_typical() {
    rest_speed = this->typical()[1];
    if constexpr (crank) rest_current = this->current_scale;
  }

  /// After the model's own start.
  void start_cycles() {
    means = {};
    means.begin = means.phase_time = this->now.t;
    if constexpr (crank) means.mark = this->now.theta;
    else means.mark = means.phase = this->w * this->now.t;
  }

  /// Of a direct drive's supply [rad].
  double phase_at(double t) const
    requires(!crank)
  {
    return means.phase + this->w * (t - means.phase_time);
  }
  /// The supply goes on at another frequency [Hz] from now on.
  void set_frequency(double frequency)
    requires(!crank)
  {
    means.phase = phase_at(this->now.t);
    means.phase_time = this->now.t;
    this->vehicle.drive_frequency = frequency;
    this->w = two_pi * frequency;
    this->period = 1.0 / frequency;
  }

  void unknowns(double* y) const {
    Base::unknowns(y);
    std::copy(means.sums.begin(), means.sums.end(), y + this->coupled);
  }
  void set(double t, const double* y) {
    Base::set(t, y);
    std::copy_n(y + this->coupled, quadrature_count, means.sums.begin());
  }
  std::array<double, indicator_count> indicators(double t, const double* y) const {
    std::array<double, indicator_count> all;
    const auto own = Base::indicators(t, y);
    std::copy(own.begin(), own.end(), all.begin());
    if constexpr (crank) {
      all[cycle_end] = 1.0 - std::abs(y[0] - means.mark) / two_pi;
      all[rest] = rest_margin(t, y);
    }
    return all;
  }
  std::array<int, indicator_count> directions() const {
    std::array<int, indicator_count> all;
    const auto own = Base::directions();
    std::copy(own.begin(), own.end(), all.begin());
    if constexpr (crank) all[cycle_end] = all[rest] = -1;
    return all;
  }
  bool branch_lost() {
    bool lost = false;
    adding_impulses([&] { lost = Base::branch_lost(); });
    return lost;
  }
  void handle(std::size_t indicator) {
    if (indicator < cycle_end) return adding_impulses([&] { Base::handle(indicator); });
    if constexpr (crank) {
      if (indicator == rest) {
        means.rests = !means.rests;
      } else {
        means.end_cycle(this->now.t);
        const double turns = std::round((this->now.theta - means.mark) / two_pi);
        means.mark = turns == 0.0 ? this->now.theta : means.mark + two_pi * turns;
      }
    }
  }
  std::optional<TransientEvent::Kind> event_at(std::size_t indicator) const {
    if (indicator < cycle_end) return Base::event_at(indicator);
    return indicator == cycle_end ? std::optional(TransientEvent::Kind::revolution) : std::nullopt;
  }
  void begin_piece() {
    adding_impulses([&] { Base::begin_piece(); });
    if constexpr (crank) note_motion();
  }
  double next_switch() const {
    if constexpr (crank) return Base::next_switch();
    else return means.phase_time + (means.mark + two_pi - means.phase) / this->w;
  }
  void switch_supply() {
    if constexpr (crank) {
      Base::switch_supply();
    } else {
      means.phase = phase_at(this->now.t);
      means.phase_time = this->now.t;
      means.end_cycle(this->now.t);
      means.mark += two_pi * std::max(1.0, std::floor((means.phase - means.mark) / two_pi));
      const double speed_square = means.mean[detail::quadrature_of(Integral::speed_square)];
      means.rests = !(speed_square > square(rest_level * rest_speed));
    }
  }
  /// The supply as it is by now, however long ago it switched last.
  void follow_supply() {
    const double t = this->now.t, due = t + 1e-14 * std::abs(t);
    for (int n = 0; n < 4 && next_switch() <= due; ++n) switch_supply();
    if constexpr (crank) {
      if (next_switch() <= t) Base::catch_up_with_supply();
    }
  }

  bool stands() const { return means.rests || (crank && this->now.stuck); }
  /// False: the means are 0.
  bool has_means() const { return means.whole && !stands() && !this->ended(); }

  Mode mode() const {
    Mode mode;
    mode.stuck = this->now.stuck;
    if constexpr (requires { this->now.held; }) mode.held = this->now.held;
    if constexpr (crank) mode.direction = this->now.branch.direction;
    else if constexpr (requires { this->now.direction; }) mode.direction = this->now.direction;
    return mode;
  }

 private:
  /// What impacts add to the integrals at once is added to the sums.
  template <class Change>
  void adding_impulses(const Change& change) {
    if constexpr (requires { this->now.impulses; }) {
      const auto before = this->now.impulses;
      change();
      for (std::size_t k = 0; k < quadrature_count; ++k) {
        const auto which = std::size_t(detail::quadratures[k]);
        means.sums[k] += this->now.impulses[which] - before[which];
      }
    } else {
      change();
    }
  }

  /// How far speed and rates of speed and current, over their typical sizes, are above what counts as rest, where the
  /// crank turns; how far below what counts as turning, where it rests.
  double rest_margin(double t, const double* y) const {
    constexpr double max_motion = 4.0 * rest_level;
    double motion = std::abs(y[1]) / rest_speed, dy[max_unknowns] = {};
    if (motion < max_motion && Base::rates(t, y, dy, false)) {
      motion = std::max(motion, std::abs(dy[1]) / square(rest_speed));
      if (this->inductive) motion = std::max(motion, std::abs(dy[2]) / (rest_speed * rest_current));
    }
    motion = std::min(motion, max_motion) / rest_level;
    return means.rests ? 2.0 - motion : motion - 1.0;
  }

  /// Whether it rests, stands or turns back. After a standstill of more than a cycle, and where the crank turns back, a
  /// new cycle begins.
  void note_motion() {
    double y[max_unknowns] = {};
    Base::unknowns(y);
    if (rest_margin(this->now.t, y) < 0.0) means.rests = !means.rests;
    const double t = this->now.t, direction = this->now.branch.direction;
    const bool stands_now = stands();
    bool anew = means.stood && !stands_now && !(t - means.stood_since <= means.period);
    if (stands_now && !means.stood) means.stood_since = t;
    means.stood = stands_now;
    if (!this->now.stuck && direction != means.direction) {
      anew |= means.direction != 0.0;
      means.direction = direction;
    }
    if (!anew) return;
    means.begin_cycle(t);
    means.mark = this->now.theta;
    means.whole = false;
  }
};

}  // namespace wingbeat::fmu

namespace wingbeat::detail {

/// Its unknowns with the sums behind them.
template <class Base>
IntegratorProblem problem_of(const fmu::MeasuredModel<Base>& model, const double& relative) {
  IntegratorProblem p = problem_of(static_cast<const Base&>(model), relative);
  p.size = model.coupled + quadrature_count;
  p.roots = int(fmu::MeasuredModel<Base>::indicator_count);
  p.rates = [&model](double t, const double* y, double* dy) {
    if (--model.work_left < 0) throw fmu::WorkSpent();
    if (!model.Base::rates(t, y, dy, false)) return false;
    const auto all = fmu::evaluate<double>(model.vehicle, model.mode(), y, model.voltage(t));
    for (int k = 0; k < quadrature_count; ++k) dy[model.coupled + k] = all.integrands[std::size_t(quadratures[k])];
    return true;
  };
  p.root_functions = [&model](double t, const double* y, double* values) {
    const auto indicators = model.indicators(t, y);
    std::copy(indicators.begin(), indicators.end(), values);
  };
  // Loose for the sums, which nothing depends on: they follow the unknowns' steps.
  p.tolerated = [&model, &relative](const double* y, double* errors) {
    model.tolerated(relative, y, errors);
    std::fill_n(errors + model.coupled, quadrature_count, 1e300);
  };
  return p;
}

}  // namespace wingbeat::detail
