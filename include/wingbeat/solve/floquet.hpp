// The return map's derivative along a recorded iterate, and its Floquet multipliers: a product of one factor for each
// step that neither overflows nor underflows.
//
// A factor is the derivative of the step itself where the step resolves the flow's own decay. Where it does not - a
// mode that decays quickly and is not excited lets an error control take steps far beyond the method's stability - the
// derivative of an explicit step grows where the flow's falls; there the variational equation is solved along the step
// by Radau IIA.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/solve/iterate.hpp"
#include "wingbeat/solve/linear.hpp"

namespace wingbeat::solver {

/// A product of n x n matrices, exp(log_scale) times `scaled`, with the logarithm of its determinant's magnitude.
template <std::size_t n>
struct MatrixProduct {
  std::array<double, n * n> scaled;  ///< row-major, of largest entry 1
  double log_scale = 0.0;
  double log_determinant = 0.0;

  MatrixProduct() {
    for (std::size_t k = 0; k < n * n; ++k) scaled[k] = k % (n + 1) == 0 ? 1.0 : 0.0;
  }

  /// Multiplies by a factor from the left.
  void append(const std::array<double, n * n>& factor) {
    const std::array<double, n * n> before = scaled;
    double largest = 0.0;
    for (std::size_t row = 0; row < n; ++row) {
      for (std::size_t column = 0; column < n; ++column) {
        double sum = 0.0;
        for (std::size_t k = 0; k < n; ++k) sum += factor[row * n + k] * before[k * n + column];
        scaled[row * n + column] = sum;
        largest = std::max(largest, std::abs(sum));
      }
    }
    double size = 0.0;
    for (const double entry : factor) size = std::max(size, std::abs(entry));
    std::array<double, n * n> shape = factor;
    for (double& entry : shape) entry = size > 0.0 ? entry / size : 0.0;
    log_determinant += double(n) * std::log(size) + std::log(std::abs(determinant(int(n), shape.data())));
    if (!(largest > 0.0)) {
      log_scale = -std::numeric_limits<double>::infinity();
      return;
    }
    log_scale += std::log(largest);
    for (double& entry : scaled) entry /= largest;
  }

  /// The product itself: 0 or infinity where that is beyond the range of numbers.
  std::array<double, n * n> matrix() const {
    std::array<double, n * n> result = scaled;
    const double scale = std::exp(log_scale);
    for (double& entry : result) entry = entry == 0.0 ? 0.0 : entry * scale;
    return result;
  }

  /// Largest modulus of its eigenvalues.
  double spectral_radius() const {
    if (std::isinf(log_scale)) return 0.0;
    if constexpr (n == 2) {
      // A complex pair's modulus is the root of the determinant, which the sum of logarithms knows without
      // cancellation.
      const double half_difference = 0.5 * (scaled[0] - scaled[3]);
      if (half_difference * half_difference + scaled[1] * scaled[2] < 0.0) return std::exp(0.5 * log_determinant);
    }
    return solver::spectral_radius(int(n), scaled.data()) * std::exp(log_scale);
  }
};

namespace detail {

/// A place of the iterate for the system on dual numbers. Where the system computes configurations, those are computed
/// on doubles: they do not depend on the state.
template <class JetSystem, class System>
auto place_on(const ConfigurationOf<System>& place) {
  using Real = typename JetSystem::Real;
  if constexpr (HasConfigurations<System>) return cast<Real>(place);
  else return Real(place);
}

/// The derivative of a recorded explicit step.
template <class JetSystem, class System>
typename JetSystem::State explicit_factor(const System& system, const JetSystem& jets, const Step<System>& step,
                                          const typename JetSystem::State& y, const Rates<JetSystem>& first) {
  const auto places = stage_configurations(system, step.x, step.h);
  std::array<decltype(place_on<JetSystem, System>(places[0])), dop853::stages> on_jets;
  for (std::size_t stage = 1; stage < dop853::stages; ++stage) {
    on_jets[stage] = place_on<JetSystem, System>(places[stage]);
  }
  return explicit_step_at<false>(jets, on_jets, y, typename JetSystem::Real(step.h), signs_of<JetSystem>(step), first)
      .y;
}

/// The flow's derivative over a recorded explicit step, by `pieces` implicit steps on the variational equation.
template <class JetSystem, class System>
auto stiff_factor(const System& system, const JetSystem& jets, const Iterate<System>& iterate, const Step<System>& step,
                  int pieces) {
  constexpr std::size_t n = std::tuple_size_v<typename System::State>;
  constexpr std::size_t stages = RadauTableau::stages, unknowns = stages * n;
  const RadauTableau& tableau = radau_tableau();
  const typename JetSystem::Signs signs = signs_of<JetSystem>(step);
  const double h = step.h / pieces;
  std::array<double, n * n> factor;
  for (std::size_t k = 0; k < n * n; ++k) factor[k] = k % (n + 1) == 0 ? 1.0 : 0.0;
  for (int piece = 0; piece < pieces; ++piece) {
    std::array<double, unknowns * unknowns> matrix;
    std::array<double, unknowns * n> trajectory;  // of the derivative at the stages
    for (std::size_t j = 0; j < stages; ++j) {
      const double x = step.x + (piece + tableau.c[j]) * h;
      const auto place = place_on<JetSystem, System>(configuration_at(system, x));
      const typename System::State state = evaluate_inside<false>(system, iterate, step, x).y;
      typename JetSystem::State y;
      for (std::size_t k = 0; k < n; ++k) y[k] = typename JetSystem::Real(state[k], int(k));
      const Rates<JetSystem> rates = jets.template rates<false>(place, y, signs);
      for (std::size_t i = 0; i < stages; ++i) {
        for (std::size_t k = 0; k < n * n; ++k) {
          const std::size_t row = i * n + k / n, column = j * n + k % n;
          matrix[row * unknowns + column] =
              (row == column ? 1.0 : 0.0) - h * tableau.a[i][j] * rates.dy[k / n].v[Eigen::Index(k % n)];
        }
      }
      std::copy(factor.begin(), factor.end(), trajectory.begin() + std::ptrdiff_t(j * n * n));
    }
    solve_linear(int(unknowns), matrix.data(), int(n), trajectory.data());
    std::copy(trajectory.end() - std::ptrdiff_t(n * n), trajectory.end(), factor.begin());
  }
  return factor;
}

}  // namespace detail

/// The derivative d y(period) / d y(0) of a recorded iterate; `jets` is the system with Jet<states> scalars.
template <class JetSystem, class System>
auto monodromy_product(const System& system, const JetSystem& jets, const Iterate<System>& iterate) {
  constexpr std::size_t n = std::tuple_size_v<typename System::State>;
  using Real = typename JetSystem::Real;
  using State = typename JetSystem::State;
  constexpr double resolved = 2.0;  // decay rate times step up to which a step's derivative is the flow's
  constexpr int max_pieces = 4;

  const auto decay = [&](const State& y, const Rates<JetSystem>& rates, double h) {
    std::array<double, n * n> jacobian;
    for (std::size_t k = 0; k < n * n; ++k) jacobian[k] = h * rates.dy[k / n].v[Eigen::Index(k % n)];
    if constexpr (n > 2) {
      // A bound at less work: the norm where each state is measured by its size.
      typename System::State plain;
      for (std::size_t k = 0; k < n; ++k) plain[k] = value_of(y[k]);
      const typename System::State scale = system.error_scale(plain);
      std::array<double, n * n> scaled;
      for (std::size_t k = 0; k < n * n; ++k) scaled[k] = jacobian[k] * scale[k % n] / scale[k / n];
      const double bound = norm(int(n), scaled.data());
      if (bound <= resolved) return bound;
    }
    return spectral_radius(int(n), jacobian.data());
  };
  // Where the state jumps, the derivative of the jump is taken where it came from.
  const auto before = [&](std::size_t k) {
    if constexpr (state_jumps<System>()) {
      if (k > 0 && iterate.steps[k].signs != iterate.steps[k - 1].signs) {
        const Step<System>& step = iterate.steps[k - 1];
        return evaluate_inside<false>(system, iterate, step, step.x + step.h).y;
      }
    }
    return iterate.steps[k].y;
  };
  const auto start_of = [&](std::size_t k) {
    const typename System::State start = before(k);
    State y;
    for (std::size_t j = 0; j < n; ++j) y[j] = Real(start[j], int(j));
    reset_map<false>(jets, iterate.steps, k, y, nullptr);
    return y;
  };
  const auto rates_at_start = [&](std::size_t k, const State& y) {
    const Step<System>& step = iterate.steps[k];
    const auto place = detail::place_on<JetSystem, System>(configuration_at(system, step.x));
    return jets.template rates<false>(place, y, signs_of<JetSystem>(step));
  };

  MatrixProduct<n> product;
  State y = start_of(0);
  Rates<JetSystem> first = rates_at_start(0, y);
  for (std::size_t k = 0; k < iterate.steps.size(); ++k) {
    const Step<System>& step = iterate.steps[k];
    const bool last = k + 1 == iterate.steps.size();
    const State next_y = last ? y : start_of(k + 1);
    const Rates<JetSystem> next = last ? first : rates_at_start(k + 1, next_y);
    double quickest = 0.0;
    if (iterate.method == Method::explicit_pair) {
      quickest = std::max(decay(y, first, step.h), last ? 0.0 : decay(next_y, next, step.h));
    }
    const auto append_derivatives = [&](const State& state) {
      std::array<double, n * n> factor;
      for (std::size_t m = 0; m < n * n; ++m) factor[m] = state[m / n].v[Eigen::Index(m % n)];
      product.append(factor);
    };
    if (quickest > resolved) {
      append_derivatives(y);
      const int pieces = std::min(int(std::ceil(quickest / resolved)), max_pieces);
      product.append(detail::stiff_factor(system, jets, iterate, step, pieces));
    } else {
      append_derivatives(
          iterate.method == Method::explicit_pair
              ? detail::explicit_factor(system, jets, step, y, first)
              : implicit_step<false>(jets, system, Real(step.x), y, Real(step.h), signs_of<JetSystem>(step)).y);
    }
    y = next_y;
    first = next;
  }
  return product;
}

/// The monodromy matrix, row-major.
template <class JetSystem, class System>
auto monodromy(const System& system, const JetSystem& jets, const Iterate<System>& iterate) {
  return monodromy_product(system, jets, iterate).matrix();
}

}  // namespace wingbeat::solver
