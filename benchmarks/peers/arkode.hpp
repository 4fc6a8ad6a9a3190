// SUNDIALS ARKODE: its embedded explicit Runge-Kutta methods.
#pragma once

#include <arkode/arkode_erkstep.h>
#include <algorithm>

#include "peers/sundials.hpp"

namespace wingbeat::peers {

template <std::size_t N>
class ErkStep : SundialsStates<N> {
  using States = SundialsStates<N>;
  using States::context_, States::peer_, States::y_;

 public:
  explicit ErkStep(ARKODE_ERKTableID table) {
    memory_ = ERKStepCreate(&States::rates, 0.0, y_, context_);
    ERKStepSetTableNum(memory_, table);
    ERKStepSetUserData(memory_, static_cast<States*>(this));
    ERKStepSetErrHandlerFn(memory_, &States::say_nothing, nullptr);
    ERKStepSetMaxNumSteps(memory_, 100000);
    // The rates jump where the sign of the rod force changes: more than seven failed steps there are no failure, and a
    // PI controller without further bias goes on faster than the default.
    ERKStepSetMaxErrTestFails(memory_, 50);
    ERKStepSetAdaptivityMethod(memory_, ARK_ADAPT_PI, 1, 0, nullptr);
    ERKStepSetErrorBias(memory_, 1.0);
    ERKStepSetSafetyFactor(memory_, 0.9);
  }
  ~ErkStep() { ERKStepFree(&memory_); }

  void begin(const Peer& peer, const double*, double tolerance) {
    peer_ = &peer;
    ERKStepSStolerances(memory_, tolerance, tolerance);
    step_ = first_step;
  }

  // Ends on a step: what ARKODE interpolates is of lower order. The next iterate begins with the mean step of this one.
  bool iterate(double* u) {
    std::copy_n(u, N, N_VGetArrayPointer(y_));
    ERKStepReInit(memory_, &States::rates, iterate_start, y_);
    ERKStepSetInitStep(memory_, step_);
    ERKStepSetStopTime(memory_, iterate_start + two_pi);
    double theta = iterate_start;
    if (ERKStepEvolve(memory_, iterate_start + two_pi, y_, &theta, ARK_NORMAL) < 0) return false;
    long steps = 1;
    ERKStepGetNumSteps(memory_, &steps);
    step_ = two_pi / double(steps);
    std::copy_n(N_VGetArrayPointer(y_), N, u);
    return u[0] > 0.0;
  }

 private:
  void* memory_ = nullptr;
  double step_ = first_step;
};

}  // namespace wingbeat::peers
