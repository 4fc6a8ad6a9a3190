// Own steps in time: Dormand and Prince's 8(5,3) pair, or five-stage Radau IIA where the problem is stiff, with located
// roots.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "time/integrator.hpp"
#include "wingbeat/core/cancellation.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/solve/explicit_step.hpp"
#include "wingbeat/solve/implicit_step.hpp"
#include "wingbeat/solve/iterate_record.hpp"

namespace wingbeat::detail {

/// 0, 1, ... Q - 1
template <std::size_t... q>
constexpr std::array<std::size_t, sizeof...(q)> counted(std::index_sequence<q...>) {
  return {q...};
}

/// The problem of N coupled unknowns and Q quadratures as solve/explicit_step.hpp and implicit_step.hpp want it.
template <int N, int Q>
struct OwnSystem {
  using Real = double;
  using State = std::array<double, N>;
  using Quadrature = std::array<double, Q>;
  using Switches = std::array<double, 0>;
  using Signs = std::array<double, 0>;
  static constexpr std::array<std::size_t, Q> controlled_integrals = counted(std::make_index_sequence<Q>());

  const IntegratorProblem* problem;
  mutable bool evaluated = true;  ///< false: some rates could not be evaluated

  template <bool quadratures>
  solver::Rates<OwnSystem> rates(const double& t, const State& y, const Signs&) const {
    double dy[N + Q];
    solver::Rates<OwnSystem> result;
    if (!problem->rates(t, y.data(), dy)) evaluated = false;
    std::copy(dy, dy + N, result.dy.begin());
    if (quadratures) std::copy(dy + N, dy + N + Q, result.dq.begin());
    return result;
  }
  bool admissible(const State& y) const { return evaluated && std::isfinite(y[0]) && std::isfinite(y[N - 1]); }
  State error_scale(const State& y) const {
    State scale;
    for (std::size_t n = 0; n < N; ++n) scale[n] = std::max(std::abs(y[n]), problem->typical[n]);
    return scale;
  }
};

/// Where only the unknowns are integrated, none of the Q quadratures is. Without `radau` explicit steps alone.
template <int N, int Q, bool radau = true>
class OwnIntegrator : public Integrator {
 public:
  using System = OwnSystem<N, Q>;
  using State = typename System::State;

  explicit OwnIntegrator(IntegratorProblem problem)
      : problem_(std::move(problem)), system_{&problem_}, measuring_(problem_.size > N), state_(at(problem_.size)) {
    for (std::vector<double>* values : {&values_, &later_, &looked_again_}) values->resize(at(problem_.roots));
    signs_.resize(at(problem_.roots));
    found_.resize(at(problem_.roots));
    errors_.resize(at(problem_.size));
    for (std::vector<double>& values : looked_) values.resize(at(problem_.roots));
  }
  OwnIntegrator(const OwnIntegrator&) = delete;

  double* state() override { return state_.data(); }
  double time() const override { return t_; }
  bool found(int root) const override { return found_[at(root)]; }

  bool restart(double t, int* directions, double horizon, double stop, double longest) override {
    t_ = from_ = t;
    stop_ = stop;
    horizon_ = horizon;
    longest_ = std::min(longest, problem_.longest_step);
    directions_.assign(directions, directions + problem_.roots);
    std::copy_n(state_.begin(), N, y_.begin());
    std::fill(signs_.begin(), signs_.end(), 0.0);
    if (problem_.next_step && step_ == 0.0) step_ = *problem_.next_step;
    look_here();
    return first_rates();
  }

  Outcome advance() override {
    check_cancellation();
    if (at_root_) look_here();  // what is done at a root may move other root functions
    from_ = t_;
    start_ = y_;
    start_rates_ = rates_;
    std::fill(found_.begin(), found_.end(), false);
    double h = std::min(step_ > 0.0 ? step_ : first_step(), longest_);
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
      const bool last = from_ + 1.001 * h >= stop_;
      if (last) h = stop_ - from_;
      if (!(h > 4e-16 * std::abs(from_)) || !(h > 0.0)) return Outcome::failed;
      solver::StepResult<System> step = measuring_ ? take<true>(h) : take<false>(h);
      const double error = step.admissible ? error_of(step) : std::numeric_limits<double>::infinity();
      if (!(error <= 1.0)) {
        h *= std::isfinite(error) ? std::clamp(0.9 * std::pow(error, -1.0 / exponent()), 0.1, 0.9) : 0.25;
        continue;
      }
      const double wanted = h * std::clamp(0.9 * std::pow(std::max(error, 1e-12), -1.0 / exponent()), 0.3, 6.0);
      step_ = last ? std::max(step_, wanted) : wanted;
      if (problem_.next_step) *problem_.next_step = step_;
      y_ = step.y;
      if (!finish(h, last ? stop_ : from_ + h)) return Outcome::failed;
      double where = 0.0;
      if (crosses(h, where)) {
        if (where == kept_at_) step = kept_;
        else step = measuring_ ? take<true>(where) : take<false>(where);
        if (!step.admissible) return Outcome::failed;
        y_ = step.y;
        if (!finish(where, from_ + where)) return Outcome::failed;
        problem_.root_functions(t_, y_.data(), later_.data());
        note_roots();
        add_integrals(step);
        return Outcome::root;
      }
      settle_signs();
      add_integrals(step);
      return last ? Outcome::stop : Outcome::step;
    }
    return Outcome::failed;
  }

  const double* dense(double t, int derivative) override {
    dense_ = t >= t_ ? y_ : t <= from_ ? start_ : state_after(t - from_);
    if (derivative > 0) dense_ = system_.template rates<false>(t, dense_, {}).dy;
    return dense_.data();
  }

 private:
  static constexpr int max_attempts = 400;  ///< to take one step
  static constexpr int looks = 4;           ///< within a step, for root functions that change sign twice

  static std::size_t at(int n) { return std::size_t(n); }
  /// Order of the error estimate, plus one.
  double exponent() const { return problem_.stiff ? 6.0 : 8.0; }

  bool first_rates() {
    system_.evaluated = true;
    rates_ = measuring_ ? system_.template rates<true>(t_, y_, {}) : system_.template rates<false>(t_, y_, {});
    return system_.evaluated;
  }
  double first_step() {
    problem_.tolerated(state_.data(), errors_.data());
    double h = 0.01 * horizon_;
    for (std::size_t n = 0; n < N; ++n) {
      const double size = 0.01 * std::max(std::abs(y_[n]), problem_.typical[n]);
      if (std::abs(rates_.dy[n]) * h > size) h = size / std::abs(rates_.dy[n]);
    }
    return h;
  }
  template <bool quadratures>
  solver::StepResult<System> take(double h) {
    system_.evaluated = true;
    solver::StepResult<System> step;
    if constexpr (radau) {
      step = problem_.stiff ? solver::implicit_step<quadratures>(system_, from_, start_, h, {}, start_rates_)
                            : solver::explicit_step<quadratures>(system_, from_, start_, h, {}, start_rates_);
    } else {
      step = solver::explicit_step<quadratures>(system_, from_, start_, h, {}, start_rates_);
    }
    step.admissible = step.admissible && system_.evaluated;
    return step;
  }
  /// The step taken again, to a time within it: as accurate as its end.
  State state_after(double h) { return take<false>(h).y; }

  double error_of(const solver::StepResult<System>& step) {
    problem_.tolerated(state_.data(), errors_.data());
    double third = 0.0, fifth = 0.0;
    const auto add = [&](double error3, double error5, double tolerated) {
      third += square(error3 / tolerated);
      fifth += square(error5 / tolerated);
    };
    for (std::size_t n = 0; n < N; ++n) add(step.error3[n], step.error5[n], errors_[n]);
    if (measuring_) {
      for (std::size_t q = 0; q < Q; ++q) {
        add(step.integral_error3[q], step.integral_error5[q], errors_[N + q]);
      }
    }
    if (problem_.stiff) return std::sqrt(fifth / double(problem_.size));
    const double both = fifth + 0.01 * third;
    return both > 0.0 ? fifth / std::sqrt(both * double(problem_.size)) : 0.0;
  }

  /// Rates and root functions at the end of the step, which lies h after its start at the time t.
  bool finish(double h, double t) {
    length_ = h;
    t_ = t;
    return first_rates();
  }
  void add_integrals(const solver::StepResult<System>& step) {
    std::copy(y_.begin(), y_.end(), state_.begin());
    for (std::size_t q = 0; measuring_ && q < Q; ++q) state_[N + q] += step.dq[q];
  }

  bool changes(std::size_t k, double sign, double value) const {
    return sign * value < 0.0 && (directions_[k] == 0 || double(directions_[k]) * value > 0.0);
  }
  /// The cubic through both ends' states and rates, good enough to see signs by.
  State between(double share) const {
    const double s = share, h = length_;
    State y;
    for (std::size_t n = 0; n < N; ++n) {
      y[n] = start_[n] + s * s * (3.0 - 2.0 * s) * (y_[n] - start_[n]) +
             h * s * (1.0 - s) * ((1.0 - s) * start_rates_.dy[n] - s * rates_.dy[n]);
    }
    return y;
  }

  /// True if a root lies within the step of length h; `where` is the time from its start to just after the first.
  bool crosses(double h, double& where) {
    kept_at_ = -1.0;
    for (int look = 1; look <= looks; ++look) {
      const double share = double(look) / (looks + 1);
      problem_.root_functions(from_ + share * h, between(share).data(), looked_[at(look - 1)].data());
    }
    problem_.root_functions(t_, y_.data(), later_.data());
    looked_[looks] = later_;
    double first = std::numeric_limits<double>::infinity();
    std::vector<double>& signs = passing_signs_;
    signs = signs_;
    for (int look = 1; look <= looks + 1; ++look) {
      const double before = h * (look - 1) / (looks + 1), here = look > looks ? h : h * look / (looks + 1);
      if (before >= first) break;
      for (std::size_t k = 0; k < signs.size(); ++k) {
        const double value = looked_[at(look - 1)][k];
        if (changes(k, signs[k], value)) first = std::min(first, root_between(k, signs[k], before, here, h));
        if (value != 0.0) signs[k] = value > 0.0 ? 1.0 : -1.0;
      }
    }
    where = first;
    return std::isfinite(first);
  }
  /// As root_between(), to a part of the step: where the cubic has the root, then by the slope there. None where that
  /// does not settle soon.
  std::optional<double> root_near_cubic(std::size_t k, double sign, double a, double b, double h, double resolved) {
    constexpr int max_trials = 6;
    const auto by_cubic = [&](double s) {
      problem_.root_functions(from_ + s, between(s / h).data(), looked_again_.data());
      return sign * looked_again_[k];
    };
    const double fa = by_cubic(a), fb = by_cubic(b);
    if (!(fa >= 0.0 && fb < 0.0)) return std::nullopt;
    const Bracket<double> near = find_zero(by_cubic, a, fa, b, fb, 1e-3 * (b - a));
    double s = near.after;
    const double aside = std::min(0.01 * (b - a), std::min(s, h - s));
    const double slope = aside > 0.0 ? (by_cubic(s + aside) - by_cubic(s - aside)) / (2.0 * aside) : 0.0;
    if (!(slope < 0.0)) return std::nullopt;
    double before = -std::numeric_limits<double>::infinity(), after = std::numeric_limits<double>::infinity();
    for (int trial = 0; trial < max_trials; ++trial) {
      if (!(s > 0.0 && s < h)) return std::nullopt;
      solver::StepResult<System> step = measuring_ ? take<true>(s) : take<false>(s);
      if (!step.admissible) return std::nullopt;
      problem_.root_functions(from_ + s, step.y.data(), looked_again_.data());
      const double f = sign * looked_again_[k];
      if (f < 0.0) after = s, kept_ = step, kept_at_ = s;
      else before = s;
      if (after - before <= resolved) return after;
      // A little beyond, so that the other side is found.
      s += -f / slope + (f < 0.0 ? -0.4 : 0.4) * resolved;
      if (s <= before || s >= after) s = 0.5 * (before + after);
    }
    return std::nullopt;
  }
  /// Just after the sign change of root function k between a and b, times from the step's start; infinite where the
  /// cubic alone has one.
  double root_between(std::size_t k, double sign, double a, double b, double h) {
    const double resolved = std::max(4e-16 * (std::abs(from_) + h), problem_.root_resolution * h);
    if (problem_.root_resolution > 0.0) {
      if (const std::optional<double> root = root_near_cubic(k, sign, a, b, h, resolved)) return *root;
    }
    const auto value = [&](double s) {
      if (s <= 0.0) return values_[k];
      if (s >= h) return later_[k];
      problem_.root_functions(from_ + s, state_after(s).data(), looked_again_.data());
      return looked_again_[k];
    };
    double fa = value(a), fb = value(b);
    if (!(sign * fb < 0.0)) {
      // The cubic was off by a little: the change comes a little later, or not at all.
      if (b >= h) return std::numeric_limits<double>::infinity();
      a = b;
      b = h;
      fa = fb;
      fb = value(b);
      if (!(sign * fb < 0.0)) return std::numeric_limits<double>::infinity();
    }
    if (sign * fa < 0.0) a = 0.0, fa = sign * std::numeric_limits<double>::min();
    return find_zero([&](double s) { return sign * value(s); }, a, sign * fa, b, sign * fb, resolved).after;
  }
  void note_roots() {
    for (std::size_t k = 0; k < signs_.size(); ++k) found_[k] = changes(k, signs_[k], later_[k]);
    at_root_ = true;
  }
  void look_here() {
    problem_.root_functions(t_, y_.data(), later_.data());
    settle_signs();
    at_root_ = false;
  }
  void settle_signs() {
    values_ = later_;
    for (std::size_t k = 0; k < signs_.size(); ++k) {
      if (values_[k] != 0.0) signs_[k] = values_[k] > 0.0 ? 1.0 : -1.0;
    }
  }

  IntegratorProblem problem_;
  System system_;
  bool measuring_;
  std::vector<double> state_, values_, later_, looked_[looks + 1], looked_again_, errors_, signs_, passing_signs_;
  std::vector<bool> found_;
  bool at_root_ = false;
  std::vector<int> directions_;
  double t_ = 0.0, from_ = 0.0, stop_ = 0.0, horizon_ = 0.0, longest_ = 0.0, step_ = 0.0, length_ = 0.0;
  State y_{}, start_{}, dense_{};
  solver::StepResult<System> kept_{};  ///< of the step to a time from its start, where a root was located
  double kept_at_ = -1.0;
  solver::Rates<System> rates_{}, start_rates_{};
};

}  // namespace wingbeat::detail
