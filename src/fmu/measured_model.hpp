// A model in time that sums up its cycles: what a co-simulation steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>

#include "fmu/instant.hpp"
#include "time/crank_model.hpp"
#include "time/direct_model.hpp"
#include "time/pitch_direct_model.hpp"
#include "time/simulation.hpp"

namespace wingbeat::fmu {

using detail::quadrature_count;

/// Integrals since the start, and the means of the last whole cycle.
struct CycleMeans {
  std::array<double, quadrature_count> sums{}, at_begin{}, mean{};  ///< in the order of detail::quadratures
  double begin = 0.0;                                               ///< of the cycle under way [s]
  double period = 0.0;                                              ///< of the last whole one [s]; 0: there was none
  double next = 0.0;  ///< crank angle [rad], of a direct drive time [s], at which the cycle under way ends
  long cycles = 0;

  /// Calls use(number) for each of them.
  template <class Self, class Use>
  static void each(Self& of, const Use& use) {
    for (auto* numbers : {&of.sums, &of.at_begin, &of.mean}) {
      for (auto& x : *numbers) use(x);
    }
    use(of.begin), use(of.period), use(of.next), use(of.cycles);
  }

  void end_cycle(double time) {
    period = time - begin;
    for (std::size_t k = 0; k < sums.size(); ++k) mean[k] = (sums[k] - at_begin[k]) / period;
    at_begin = sums;
    begin = time;
    ++cycles;
  }
};

/// CrankModel, DirectModel or PitchDirectModel; satisfies TimeModel. A crank's cycle ends where the crank has turned
/// once more, a direct drive's at the end of a period of its supply.
template <class Base>
class MeasuredModel : public Base {
 public:
  static constexpr bool crank = std::is_same_v<Base, detail::CrankModel>;
  static constexpr std::size_t cycle_end = std::size_t(Base::indicator_count);
  static constexpr std::size_t indicator_count = cycle_end + (crank ? 1 : 0);

  using Base::Base;

  CycleMeans means;

  /// After the model's own start.
  void start_cycles() {
    means = {};
    means.begin = this->now.t;
    if constexpr (crank) means.next = two_pi * (std::floor(this->now.theta / two_pi) + 1.0);
    else means.next = this->period;
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
    if constexpr (crank) all[cycle_end] = (means.next - y[0]) / two_pi;
    return all;
  }
  std::array<int, indicator_count> directions() const {
    std::array<int, indicator_count> all;
    const auto own = Base::directions();
    std::copy(own.begin(), own.end(), all.begin());
    if constexpr (crank) all[cycle_end] = -1;
    return all;
  }
  void begin_piece() {
    adding_impulses([&] { Base::begin_piece(); });
  }
  bool branch_lost() {
    bool lost = false;
    adding_impulses([&] { lost = Base::branch_lost(); });
    return lost;
  }
  void handle(std::size_t indicator) {
    if (indicator < cycle_end) return adding_impulses([&] { Base::handle(indicator); });
    means.end_cycle(this->now.t);
    means.next += two_pi;
  }
  std::optional<TransientEvent::Kind> event_at(std::size_t indicator) const {
    return indicator < cycle_end ? Base::event_at(indicator) : TransientEvent::Kind::revolution;
  }
  double next_switch() const { return crank ? Base::next_switch() : means.next; }
  void switch_supply() {
    if constexpr (crank) {
      Base::switch_supply();
    } else {
      means.end_cycle(this->now.t);
      means.next = double(means.cycles + 1) * this->period;
    }
  }
  Mode mode() const {
    Mode of;
    of.stuck = this->now.stuck;
    if constexpr (requires { this->now.held; }) of.held = this->now.held;
    if constexpr (crank) of.direction = this->now.branch.direction;
    else if constexpr (requires { this->now.direction; }) of.direction = this->now.direction;
    return of;
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
    if (!model.Base::rates(t, y, dy, false)) return false;
    const auto all = fmu::evaluate<double>(model.vehicle, model.mode(), y, model.voltage(t));
    for (int k = 0; k < quadrature_count; ++k) dy[model.coupled + k] = all.integrands[std::size_t(quadratures[k])];
    return true;
  };
  p.root_functions = [&model](double t, const double* y, double* values) {
    const auto at = model.indicators(t, y);
    std::copy(at.begin(), at.end(), values);
  };
  // Loose for the sums, which nothing depends on: they follow the unknowns' steps.
  p.tolerated = [&model, &relative](const double* y, double* errors) {
    model.tolerated(relative, y, errors);
    std::fill_n(errors + model.coupled, quadrature_count, 1e300);
  };
  return p;
}

}  // namespace wingbeat::detail
