// SUNDIALS ARKODE: its embedded explicit Runge-Kutta methods.
#pragma once

#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>
#include <algorithm>

#include "peers/equations.hpp"

namespace wingbeat::peers {

template <std::size_t N>
class ErkStep {
 public:
  explicit ErkStep(ARKODE_ERKTableID table) {
    SUNContext_Create(nullptr, &context_);
    y_ = N_VNew_Serial(sunindextype(N), context_);
    N_VConst(1.0, y_);
    memory_ = ERKStepCreate(&rates, 0.0, y_, context_);
    ERKStepSetTableNum(memory_, table);
    ERKStepSetUserData(memory_, this);
    ERKStepSetErrHandlerFn(memory_, [](int, const char*, const char*, char*, void*) {}, nullptr);
    ERKStepSetMaxNumSteps(memory_, 100000);
    // The rates jump where the sign of the rod force changes: more than seven failed steps there are no failure, and a
    // PI controller without further bias goes on faster than the default.
    ERKStepSetMaxErrTestFails(memory_, 50);
    ERKStepSetAdaptivityMethod(memory_, ARK_ADAPT_PI, 1, 0, nullptr);
    ERKStepSetErrorBias(memory_, 1.0);
    ERKStepSetSafetyFactor(memory_, 0.9);
  }
  ErkStep(const ErkStep&) = delete;
  ErkStep& operator=(const ErkStep&) = delete;
  ~ErkStep() {
    ERKStepFree(&memory_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }

  void begin(const Peer& peer, const double*, double tolerance) {
    peer_ = &peer;
    ERKStepSStolerances(memory_, tolerance, tolerance);
    step_ = first_step;
  }

  // Ends on a step: what ARKODE interpolates is of lower order. The next iterate begins with the mean step of this one.
  bool iterate(double* u) {
    std::copy_n(u, N, N_VGetArrayPointer(y_));
    ERKStepReInit(memory_, &rates, iterate_start, y_);
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
  static int rates(realtype theta, N_Vector y, N_Vector dy, void* self) {
    const double* u = N_VGetArrayPointer(y);
    if (!(u[0] > 0.0)) return 1;
    static_cast<ErkStep*>(self)->peer_->template rates<N>(theta, u, N_VGetArrayPointer(dy));
    return 0;
  }

  const Peer* peer_ = nullptr;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  void* memory_ = nullptr;
  double step_ = first_step;
};

}  // namespace wingbeat::peers
