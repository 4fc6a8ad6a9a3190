// The path of a few slow states over the charge drawn from a battery: Dormand and Prince's steps of order 5 (by
// Boost.Odeint), whose rates may cease to exist on the way.
#pragma once

#include <algorithm>
#include <array>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <optional>
#include <utility>

namespace wingbeat::detail {

/// `Rates`: (double x, const State&) -> std::optional<State>, empty where the motion has no rates. `scale`: what errors
/// of each state are a part of.
template <std::size_t N, class Rates>
class FlightPath {
 public:
  using State = std::array<double, N>;

  FlightPath(Rates rates, const State& scale, double tolerance, double first_step)
      : rates_(std::move(rates)), scale_(scale), tolerance_(tolerance), step_(first_step) {}

  struct Step {
    State y;
    double error;  ///< in tolerances
  };

  /// One step from x; empty where rates are missing on it.
  std::optional<Step> take(double x, const State& y, double h) {
    struct NoRates {};
    const auto system = [this](const State& state, State& dy, double where) {
      const std::optional<State> r = rates_(where, state);
      if (!r) throw NoRates{};
      dy = *r;
    };
    try {
      boost::numeric::odeint::runge_kutta_dopri5<State> stepper;
      State error, first, last;
      Step step;
      system(y, first, x);
      stepper.do_step(system, y, first, x, step.y, last, h, error);
      double worst = 0.0;
      for (std::size_t n = 0; n < N; ++n) {
        const double scale = std::max(scale_[n], std::abs(step.y[n]));
        worst = std::max(worst, std::abs(error[n]) / (tolerance_ * scale));
      }
      step.error = worst;
      return step;
    } catch (const NoRates&) {
      return std::nullopt;
    }
  }

  /// The longest step from x to at most `end` that the tolerance allows: its length, and the state behind it. Empty
  /// where rates end at x.
  std::optional<std::pair<double, State>> advance(double x, const State& y, double end) {
    const double shortest = 1e-12 * std::max(std::abs(end), 1e-3);
    for (double h = std::min(step_, end - x);;) {
      const bool whole = h >= end - x;
      const std::optional<Step> step = take(x, y, h);
      if (step && step->error <= 1.0) {
        const double growth = std::clamp(0.9 * std::pow(std::max(step->error, 1e-8), -0.2), 0.5, 4.0);
        if (!whole || growth * h > step_) step_ = growth * h;
        return std::pair{h, step->y};
      }
      h *= step ? std::clamp(0.9 * std::pow(step->error, -0.2), 0.1, 0.7) : 0.5;
      if (!(h > shortest)) return std::nullopt;
    }
  }

 private:
  Rates rates_;
  State scale_;
  double tolerance_;
  double step_;
};

}  // namespace wingbeat::detail
