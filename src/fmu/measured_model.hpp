// A model in time that sums up its cycles: what a co-simulation steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "time/event_loop.hpp"
#include "time/time_model.hpp"

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

/// A crank's cycle ends where the crank has turned once more in either direction, a direct drive's at the end of a
/// period of its supply.
class MeasuredModel : public detail::TimeModel {
 public:
  using Base = detail::TimeModel;
  /// Of cranks.
  static constexpr std::size_t cycle_end = std::size_t(Base::indicator_count), rest = cycle_end + 1;
  static constexpr std::size_t indicator_count = rest + 1;
  /// Of typical speeds and currents: below it a crank rests, above the double it turns. Of a direct drive: of its
  /// typical speed, the root mean square over a cycle.
  static constexpr double rest_level = 1e-3;

  using Base::Base;

  CycleMeans means;
  double rest_speed = 1.0, rest_current = 1.0;  ///< typical sizes at the voltage that the vehicle states [rad/s], [A]
  mutable std::int64_t work_left = 0;           ///< evaluations of the rates

  /// Typical sizes are now those by which rest is assessed.
  void judge_rest_by_typical() {
    rest_speed = speed_scale;
    if (!direct) rest_current = current_scale;
  }

  /// After the model's own start.
  void start_cycles() {
    means = {};
    means.begin = means.phase_time = now.t;
    if (direct) means.mark = means.phase = phase_rate() * now.t;
    else means.mark = now.moving.angle;
  }

  /// Of a direct drive's supply [rad].
  double phase_at(double t) const { return means.phase + phase_rate() * (t - means.phase_time); }
  double phase_rate() const { return two_pi * supply.frequency; }  ///< [rad/s]
  /// The supply goes on at another frequency [Hz] from now on.
  void set_frequency(double frequency) {
    means.phase = phase_at(now.t);
    means.phase_time = now.t;
    vehicle.drive_frequency = supply.frequency = frequency;
  }

  void unknowns(double* y) const {
    Base::unknowns(y);
    std::copy(means.sums.begin(), means.sums.end(), y + coupled);
  }
  void set(double t, const double* y) {
    Base::set(t, y);
    std::copy_n(y + coupled, quadrature_count, means.sums.begin());
  }
  std::array<double, indicator_count> indicators(double t, const double* y) const {
    std::array<double, indicator_count> all;
    const auto own = Base::indicators(t, y);
    std::copy(own.begin(), own.end(), all.begin());
    all[cycle_end] = direct ? 1.0 : 1.0 - std::abs(y[0] - means.mark) / two_pi;
    all[rest] = direct ? 1.0 : rest_margin(t, y);
    return all;
  }
  std::array<int, indicator_count> directions() const {
    std::array<int, indicator_count> all;
    const auto own = Base::directions();
    std::copy(own.begin(), own.end(), all.begin());
    all[cycle_end] = all[rest] = -1;
    return all;
  }
  bool branch_lost() {
    bool lost = false;
    adding_impulses([&] { lost = Base::branch_lost(); });
    return lost;
  }
  void handle(std::size_t indicator) {
    if (indicator < cycle_end) return adding_impulses([&] { Base::handle(indicator); });
    if (indicator == rest) {
      means.rests = !means.rests;
      return;
    }
    means.end_cycle(now.t);
    const double turns = std::round((now.moving.angle - means.mark) / two_pi);
    means.mark = turns == 0.0 ? now.moving.angle : means.mark + two_pi * turns;
  }
  std::optional<TransientEvent::Kind> event_at(std::size_t indicator) const {
    if (indicator < cycle_end) return Base::event_at(indicator);
    return indicator == cycle_end ? std::optional(TransientEvent::Kind::revolution) : std::nullopt;
  }
  void begin_piece() {
    adding_impulses([&] { Base::begin_piece(); });
    if (!direct) note_motion();
  }
  double next_switch() const {
    return direct ? means.phase_time + (means.mark + two_pi - means.phase) / phase_rate() : Base::next_switch();
  }
  void switch_supply() {
    if (!direct) return Base::switch_supply();
    means.phase = phase_at(now.t);
    means.phase_time = now.t;
    means.end_cycle(now.t);
    means.mark += two_pi * std::max(1.0, std::floor((means.phase - means.mark) / two_pi));
    const double speed_square = means.mean[detail::quadrature_of(Integral::speed_square)];
    means.rests = !(speed_square > square(rest_level * rest_speed));
  }
  /// The supply as it is by now, however long ago it switched last.
  void follow_supply() {
    const double t = now.t, due = t + 1e-14 * std::abs(t);
    for (int n = 0; n < 4 && next_switch() <= due; ++n) switch_supply();
    if (!direct && next_switch() <= t) Base::catch_up_with_supply();
  }

  bool stands() const { return means.rests || (!direct && now.stuck); }
  /// False: the means are 0.
  bool has_means() const { return means.whole && !stands() && !ended(); }

 private:
  /// What impacts add to the integrals at once is added to the sums.
  template <class Change>
  void adding_impulses(const Change& change) {
    const auto before = now.impulses;
    change();
    for (std::size_t k = 0; k < quadrature_count; ++k) {
      const auto which = std::size_t(detail::quadratures[k]);
      means.sums[k] += now.impulses[which] - before[which];
    }
  }

  /// How far speed and rates of speed and current, over their typical sizes, are above what counts as rest, where the
  /// crank turns; how far below what counts as turning, where it rests.
  double rest_margin(double t, const double* y) const {
    constexpr double max_motion = 4.0 * rest_level;
    double motion = std::abs(y[1]) / rest_speed, dy[max_unknowns] = {};
    if (motion < max_motion && Base::rates(t, y, dy, false)) {
      motion = std::max(motion, std::abs(dy[1]) / square(rest_speed));
      if (indices.inductive) motion = std::max(motion, std::abs(dy[2]) / (rest_speed * rest_current));
    }
    motion = std::min(motion, max_motion) / rest_level;
    return means.rests ? 2.0 - motion : motion - 1.0;
  }

  /// Whether it rests, stands or turns back. After a standstill of more than a cycle, and where the crank turns back, a
  /// new cycle begins.
  void note_motion() {
    double y[max_unknowns] = {};
    Base::unknowns(y);
    if (rest_margin(now.t, y) < 0.0) means.rests = !means.rests;
    const double t = now.t, direction = now.direction;
    const bool stands_now = stands();
    bool anew = means.stood && !stands_now && !(t - means.stood_since <= means.period);
    if (stands_now && !means.stood) means.stood_since = t;
    means.stood = stands_now;
    if (!now.stuck && direction != means.direction) {
      anew |= means.direction != 0.0;
      means.direction = direction;
    }
    if (!anew) return;
    means.begin_cycle(t);
    means.mark = now.moving.angle;
    means.whole = false;
  }
};

}  // namespace wingbeat::fmu

namespace wingbeat::detail {

/// Its unknowns with the sums behind them.
inline IntegratorProblem problem_of(const fmu::MeasuredModel& model, const double& relative) {
  IntegratorProblem p = problem_of(static_cast<const TimeModel&>(model), relative);
  p.size = model.coupled + quadrature_count;
  p.roots = int(fmu::MeasuredModel::indicator_count);
  p.rates = [&model](double t, const double* y, double* dy) {
    if (--model.work_left < 0) throw fmu::WorkSpent();
    return model.TimeModel::rates(t, y, dy, true);
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
