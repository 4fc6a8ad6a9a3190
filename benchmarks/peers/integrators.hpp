// Boost.odeint and CVODE on the equations.
#pragma once

#include <cvode/cvode.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <tuple>

#include "peers/sundials.hpp"

namespace wingbeat::peers {

// Boost.odeint: an embedded method such as runge_kutta_dopri5.
template <class Method>
struct Controlled {
  using State = typename Method::state_type;
  static constexpr std::size_t N = std::tuple_size_v<State>;
  const Peer& peer;
  double tolerance;
  double step = first_step;

  void integrate(double* u, double from, double to) {
    namespace odeint = boost::numeric::odeint;
    State state;
    std::copy_n(u, N, state.begin());
    auto stepper = odeint::make_controlled(tolerance, tolerance, Method());
    const auto rates = [&](const State& x, State& dx, double theta) { peer.rates<N>(theta, x.data(), dx.data()); };
    // As odeint::integrate_adaptive, but the step found is kept for the next iterate, and a step to where the crank
    // would turn back (which odeint accepts if its error is no number) is taken again in quarters.
    double theta = from;
    while (to - theta > 1e-12) {
      const State before = state;
      const double theta_before = theta;
      double h = std::min(step, to - theta);
      const bool cut = h < step;
      if (stepper.try_step(rates, state, theta, h) != odeint::success) {
        step = h;
      } else if (!(state[0] > 0.0)) {
        state = before;
        theta = theta_before;
        step = 0.25 * std::min(step, to - theta);
        if (step < 1e-9) break;
        if constexpr (requires { stepper.reset(); }) stepper.reset();
      } else if (!cut) {
        step = h;
      }
    }
    if (to - theta > 1e-12) state[0] = absent;
    std::copy_n(state.begin(), N, u);
  }
};

template <std::size_t N>
using Dopri5 = boost::numeric::odeint::runge_kutta_dopri5<std::array<double, N>>;
template <std::size_t N>
using CashKarp = boost::numeric::odeint::runge_kutta_cash_karp54<std::array<double, N>>;

template <template <std::size_t> class Method>
Steady by_odeint(const Peer& peer, double tolerance, std::array<double, 2>* start = nullptr) {
  Controlled<Method<2>> plain{peer, std::max(coarse, tolerance)};
  Controlled<Method<all_states>> measured{peer, tolerance};
  const auto iterate = [](auto& method, double* u) {
    method.integrate(u, iterate_start, iterate_start + two_pi);
    return std::isfinite(u[0]) && u[0] > 0.0;
  };
  return flap(
      peer, tolerance < coarse, [&](int, double* u) { return iterate(plain, u); },
      [&](int, double* u) { return iterate(measured, u); }, start);
}

// CVODE: Adams with functional iteration.
template <std::size_t N>
class Adams : SundialsStates<N> {
  using States = SundialsStates<N>;
  using States::context_, States::peer_, States::y_;

 public:
  Adams() {
    memory_ = CVodeCreate(CV_ADAMS, context_);
    nonlinear_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
    CVodeInit(memory_, &States::rates, 0.0, y_);
    CVodeSetNonlinearSolver(memory_, nonlinear_);
    CVodeSetUserData(memory_, static_cast<States*>(this));
    CVodeSetErrHandlerFn(memory_, &States::say_nothing, nullptr);
    CVodeSetMaxNumSteps(memory_, 100000);
  }
  ~Adams() {
    CVodeFree(&memory_);
    SUNNonlinSolFree(nonlinear_);
  }

  void begin(const Peer& peer, const double* u, double tolerance) {
    peer_ = &peer;
    std::copy_n(u, N, N_VGetArrayPointer(y_));
    CVodeReInit(memory_, iterate_start, y_);
    CVodeSStolerances(memory_, tolerance, tolerance);
    begun_ = theta_ = iterate_start;
    last_.fill(0.0);
  }

  // Goes on to the next iterate's start without a restart, which would fall back to first order; quadratures by
  // difference.
  bool iterate(double* u) {
    begun_ += two_pi;
    if (CVode(memory_, begun_, y_, &theta_, CV_NORMAL) < 0) return false;
    const double* y = N_VGetArrayPointer(y_);
    for (std::size_t n = 0; n < N; ++n) {
      u[n] = n < 2 ? y[n] : y[n] - last_[n];
      last_[n] = y[n];
    }
    return u[0] > 0.0;
  }

 private:
  void* memory_ = nullptr;
  SUNNonlinearSolver nonlinear_ = nullptr;
  double begun_ = 0.0, theta_ = 0.0;
  std::array<double, N> last_{};
};

// With a method of two states and one of all, which `begin` at a state and go on from one iterate to the next.
template <class Plain, class Measured>
inline Steady by_stepping(Plain& plain, Measured& measured, const Peer& peer, double tolerance) {
  bool fine = false;
  return flap(
      peer, tolerance < coarse,
      [&](int iterates, double* u) {
        if (iterates == 0) plain.begin(peer, u, coarse);
        return plain.iterate(u);
      },
      [&](int, double* u) {
        if (!fine) measured.begin(peer, u, tolerance);
        fine = true;
        return measured.iterate(u);
      });
}

}  // namespace wingbeat::peers
