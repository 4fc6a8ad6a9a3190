// One step of an explicit Runge-Kutta pair, unrolled at compile time, the zeros of its tableau skipped.
//
// Dormand and Prince's 8(5,3) pair with 12 stages: E. Hairer, S. P. Noersett, G. Wanner, "Solving Ordinary Differential
// Equations I", 2nd ed., Springer 1993, section II.10 (DOP853); tests/solve measures its order.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include "wingbeat/core/scalar.hpp"

namespace wingbeat::solver {

namespace dop853 {
inline constexpr int stages = 12;
inline constexpr int order = 8;
// clang-format off
inline constexpr double c[stages] =
    {0, 0.05260015195876773, 0.0789002279381516, 0.1183503419072274, 0.2816496580927726, 0.3333333333333333, 0.25,
     0.3076923076923077, 0.6512820512820513, 0.6, 0.8571428571428571, 1.0};
inline constexpr double a[stages][stages] = {
    {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {0.05260015195876773, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {0.0197250569845379, 0.0591751709536137, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {0.02958758547680685, 0, 0.08876275643042054, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {0.2413651341592667, 0, -0.8845494793282861, 0.924834003261792, 0, 0, 0, 0, 0, 0, 0, 0},
    {0.037037037037037035, 0, 0, 0.17082860872947386, 0.12546768756682242, 0, 0, 0, 0, 0, 0, 0},
    {0.037109375, 0, 0, 0.17025221101954405, 0.06021653898045596, -0.017578125, 0, 0, 0, 0, 0, 0},
    {0.03709200011850479, 0, 0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402, 0.008273789163814023,
     0, 0, 0, 0, 0},
    {0.6241109587160757, 0, 0, -3.3608926294469414, -0.868219346841726, 27.59209969944671, 20.154067550477894,
     -43.48988418106996, 0, 0, 0, 0},
    {0.47766253643826434, 0, 0, -2.4881146199716677, -0.590290826836843, 21.230051448181193, 15.279233632882423,
     -33.28821096898486, -0.020331201708508627, 0, 0, 0},
    {-0.9371424300859873, 0, 0, 5.186372428844064, 1.0914373489967295, -8.149787010746927, -18.52006565999696,
     22.739487099350505, 2.4936055526796523, -3.0467644718982196, 0, 0},
    {2.273310147516538, 0, 0, -10.53449546673725, -2.0008720582248625, -17.9589318631188, 27.94888452941996,
     -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636, 0},
};
inline constexpr double b[stages] =
    {0.054293734116568765, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003, -5.801203960010585, 0.3111643669578199,
     -0.1521609496625161, 0.20136540080403034, 0.04471061572777259};
// Errors of the embedded formulas of order 3 and 5.
inline constexpr double e3[stages] =
    {-0.18980075407240762, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003, -5.801203960010585, -0.4226823213237919,
     -0.1521609496625161, 0.20136540080403034, 0.02265179219836082};
inline constexpr double e5[stages] =
    {0.01312004499419488, 0, 0, 0, 0, -1.2251564463762044, -0.4957589496572502, 1.6643771824549864,
     -0.35032884874997366, 0.3341791187130175, 0.08192320648511571, -0.022355307863886294};
// clang-format on
}  // namespace dop853

/// True of systems that compute many configurations at once: `configuration(x)` holds all that depends on x alone,
/// `configurations(x, h, c)` those at x + c[n] h, and rates() takes a configuration as it takes x.
template <class System>
concept HasConfigurations = requires(const System& system, const typename System::Real& x, const double (&c)[1]) {
  system.configurations(x, x, c);
};

/// Where a system is at x, as its rates() take it.
template <class System>
auto configuration_at(const System& system, const typename System::Real& x) {
  if constexpr (HasConfigurations<System>) {
    return system.configuration(x);
  } else {
    return x;
  }
}

template <class System>
using ConfigurationOf =
    decltype(configuration_at(std::declval<const System&>(), std::declval<const typename System::Real&>()));

/// What a right-hand side returns at one point: dy/dx, and the integrands dq/dx where asked for.
template <class System>
struct Rates {
  typename System::State dy;
  typename System::Quadrature dq;
  typename System::Switches switches;  ///< values whose sign changes end a smooth branch
};

/// The outcome of one step from x to x + h.
template <class System>
struct StepResult {
  typename System::State y;                     ///< state at x + h
  ConfigurationOf<System> end;                  ///< x + h
  typename System::Quadrature dq;               ///< integrals over the step; meaningful with quadratures only
  typename System::State error3;                ///< error of the embedded third-order formula
  typename System::State error5;                ///< error of the embedded fifth-order formula
  typename System::Quadrature integral_error3;  ///< the same of the integrals
  typename System::Quadrature integral_error5;
  typename System::Switches lowest;   ///< least switch times its sign over the later stages: < 0 hints at a crossing
  typename System::State last_stage;  ///< with quadratures: where the explicit pair's last stage is, at x + h as y is,
  typename System::State last_slope;  ///< and the rates there
  std::array<typename System::State, 5> stages;  ///< of the implicit method: the states at its stages
  bool admissible = true;                        ///< false: a stage left the region where the equations hold
};

namespace detail {

/// The stages' places.
template <class System>
auto stage_configurations(const System& system, const typename System::Real& x, const typename System::Real& h) {
  if constexpr (HasConfigurations<System>) {
    return system.configurations(x, h, dop853::c);
  } else {
    std::array<typename System::Real, dop853::stages> configurations;
    for (std::size_t stage = 0; stage < configurations.size(); ++stage)
      configurations[stage] = x + dop853::c[stage] * h;
    return configurations;
  }
}

template <std::size_t... j, class F>
constexpr void unroll(std::index_sequence<j...>, F&& f) {
  (f(std::integral_constant<std::size_t, j>{}), ...);
}

/// explicit_step() between stages at given places, which rates() takes; `end` is left out.
template <bool quadratures, class System, class Places>
StepResult<System> explicit_step_at(const System& system, const Places& places, const typename System::State& y,
                                    const typename System::Real& h, const typename System::Signs& branch,
                                    const Rates<System>& first) {
  using Real = typename System::Real;
  constexpr std::size_t states = std::tuple_size_v<typename System::State>;
  constexpr std::size_t integrals = std::tuple_size_v<typename System::Quadrature>;
  constexpr std::size_t stages = dop853::stages;

  StepResult<System> result;
  std::array<typename System::State, stages> k;
  k[0] = first.dy;
  if constexpr (quadratures) {
    for (std::size_t q = 0; q < integrals; ++q) result.dq[q] = dop853::b[0] * first.dq[q];
    for (const std::size_t q : System::controlled_integrals) {
      result.integral_error3[q] = dop853::e3[0] * first.dq[q];
      result.integral_error5[q] = dop853::e5[0] * first.dq[q];
    }
  }
  unroll(std::make_index_sequence<stages - 1>{}, [&](auto before) {
    constexpr std::size_t stage = before + 1;
    if (!result.admissible) return;
    typename System::State moved = y;
    for (std::size_t n = 0; n < states; ++n) {
      Real sum = dop853::a[stage][0] * k[0][n];
      unroll(std::make_index_sequence<stage - 1>{}, [&](auto earlier) {
        constexpr std::size_t j = earlier + 1;
        if constexpr (dop853::a[stage][j] != 0.0) sum = sum + dop853::a[stage][j] * k[j][n];
      });
      moved[n] = moved[n] + h * sum;
    }
    if (!system.admissible(moved)) {
      result.admissible = false;
      return;
    }
    const Rates<System> rates =
        system.template rates < quadratures && dop853::b[stage] != 0.0 > (places[stage], moved, branch);
    k[stage] = rates.dy;
    if constexpr (quadratures && stage == stages - 1) {
      result.last_stage = moved;
      result.last_slope = rates.dy;
    }
    // The first stages are of too low an order to tell.
    if constexpr (stage >= 5) {
      for (std::size_t w = 0; w < rates.switches.size(); ++w) {
        const Real signed_switch = rates.switches[w] * branch[w];
        result.lowest[w] =
            stage == 5 ? signed_switch : select(signed_switch < result.lowest[w], signed_switch, result.lowest[w]);
      }
    }
    if constexpr (quadratures && dop853::b[stage] != 0.0) {
      for (std::size_t q = 0; q < integrals; ++q) {
        result.dq[q] = result.dq[q] + dop853::b[stage] * rates.dq[q];
      }
      for (const std::size_t q : System::controlled_integrals) {
        result.integral_error3[q] = result.integral_error3[q] + dop853::e3[stage] * rates.dq[q];
        result.integral_error5[q] = result.integral_error5[q] + dop853::e5[stage] * rates.dq[q];
      }
    }
  });
  if (!result.admissible) return result;

  for (std::size_t n = 0; n < states; ++n) {
    Real sum = dop853::b[0] * k[0][n];
    Real third = dop853::e3[0] * k[0][n];
    Real fifth = dop853::e5[0] * k[0][n];
    unroll(std::make_index_sequence<stages - 1>{}, [&](auto before) {
      constexpr std::size_t j = before + 1;
      if constexpr (dop853::b[j] != 0.0) sum = sum + dop853::b[j] * k[j][n];
      if constexpr (dop853::e3[j] != 0.0) third = third + dop853::e3[j] * k[j][n];
      if constexpr (dop853::e5[j] != 0.0) fifth = fifth + dop853::e5[j] * k[j][n];
    });
    result.y[n] = y[n] + h * sum;
    result.error3[n] = h * third;
    result.error5[n] = h * fifth;
  }
  if constexpr (quadratures) {
    for (std::size_t q = 0; q < integrals; ++q) {
      result.dq[q] = h * result.dq[q];
    }
    for (const std::size_t q : System::controlled_integrals) {
      result.integral_error3[q] = h * result.integral_error3[q];
      result.integral_error5[q] = h * result.integral_error5[q];
    }
  }
  result.admissible = system.admissible(result.y);
  return result;
}

}  // namespace detail

/// One step of the 8(5,3) pair. `first` holds the rates at (x, y) on this branch. `System` provides Real, State,
/// Quadrature, Switches, Signs and
///   `template <bool quadratures> Rates<System> rates(const Real& x, const State& y, const Signs& branch) const`
///   `bool admissible(const State& y) const`
///   `static controlled_integrals`: indices of the integrals whose error is wanted
/// The system's equations must be smooth on the branch over the whole step.
template <bool quadratures, class System>
StepResult<System> explicit_step(const System& system, const typename System::Real& x, const typename System::State& y,
                                 const typename System::Real& h, const typename System::Signs& branch,
                                 const Rates<System>& first) {
  const auto places = detail::stage_configurations(system, x, h);
  StepResult<System> result = detail::explicit_step_at<quadratures>(system, places, y, h, branch, first);
  result.end = places[dop853::stages - 1];
  return result;
}

/// True where move_a_little() is far more accurate than a step of length h, taken at `tolerance`: the step's error is
/// about (h / r)^8, that of the move below (by / r)^5.
inline bool is_little(double by, double h, double tolerance) {
  return std::abs(by) < 0.1 * h * std::pow(tolerance, 0.2 - 1.0 / dop853::order);
}

/// Moves a state from x to x + by, a small part of a step, by the classical method of fourth order; `first` holds the
/// rates at x. What integrals gain is added to `*gained`. False, nothing changed, where that is not admissible.
template <bool quadratures, class System>
bool move_a_little(const System& system, double x, double by, const typename System::Signs& branch,
                   const Rates<System>& first, typename System::State& y, ConfigurationOf<System>& configuration,
                   typename System::Quadrature* gained = nullptr) {
  typename System::State moved = y;
  ConfigurationOf<System> there = configuration;
  std::array<Rates<System>, 4> r;
  r[0] = first;
  for (std::size_t stage = 1; stage < 4; ++stage) {
    const double part = stage == 3 ? by : 0.5 * by;
    for (std::size_t n = 0; n < y.size(); ++n) moved[n] = y[n] + part * r[stage - 1].dy[n];
    if (!system.admissible(moved)) return false;
    if (stage != 2) there = configuration_at(system, x + part);
    r[stage] = system.template rates<quadratures>(there, moved, branch);
  }
  const auto mean = [](double a, double b, double c, double d) { return (a + 2.0 * (b + c) + d) / 6.0; };
  for (std::size_t n = 0; n < y.size(); ++n) {
    moved[n] = y[n] + by * mean(r[0].dy[n], r[1].dy[n], r[2].dy[n], r[3].dy[n]);
  }
  if (!system.admissible(moved)) return false;
  y = moved;
  configuration = there;
  if constexpr (quadratures) {
    for (std::size_t q = 0; q < gained->size(); ++q) {
      (*gained)[q] += by * mean(r[0].dq[q], r[1].dq[q], r[2].dq[q], r[3].dq[q]);
    }
  }
  return true;
}

}  // namespace wingbeat::solver
