// PETSc TS: its embedded explicit Runge-Kutta methods.
#pragma once

#include <petscts.h>
#include <algorithm>

#include "peers/equations.hpp"

namespace wingbeat::peers {

struct Petsc {
  Petsc() {
    PetscInitializeNoArguments();
    PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  }
  Petsc(const Petsc&) = delete;
  Petsc& operator=(const Petsc&) = delete;
  ~Petsc() { PetscFinalize(); }
};

template <std::size_t N>
class TsRk {
 public:
  explicit TsRk(TSRKType method) {
    VecCreateSeq(PETSC_COMM_SELF, PetscInt(N), &y_);
    TSCreate(PETSC_COMM_SELF, &ts_);
    TSSetProblemType(ts_, TS_NONLINEAR);
    TSSetRHSFunction(ts_, nullptr, &rates, this);
    TSSetFunctionDomainError(ts_, &turns_forwards);
    TSSetType(ts_, TSRK);
    TSRKSetType(ts_, method);
    TSAdapt adapt = nullptr;
    TSGetAdapt(ts_, &adapt);
    TSAdaptSetType(adapt, TSADAPTDSP);  // a PI controller, faster here than the default
    TSSetExactFinalTime(ts_, TS_EXACTFINALTIME_MATCHSTEP);
    TSSetMaxSteps(ts_, 100000);
    TSSetMaxStepRejections(ts_, -1);
    TSSetSolution(ts_, y_);
  }
  TsRk(const TsRk&) = delete;
  TsRk& operator=(const TsRk&) = delete;
  ~TsRk() {
    TSDestroy(&ts_);
    VecDestroy(&y_);
  }

  void begin(const Peer& peer, const double*, double tolerance) {
    peer_ = &peer;
    TSSetTolerances(ts_, tolerance, nullptr, tolerance, nullptr);
    step_ = first_step;
  }

  // The next iterate begins with the mean step of this one.
  bool iterate(double* u) {
    double* y = nullptr;
    VecGetArrayWrite(y_, &y);
    std::copy_n(u, N, y);
    VecRestoreArrayWrite(y_, &y);
    TSSetTime(ts_, iterate_start);
    TSSetStepNumber(ts_, 0);
    TSSetTimeStep(ts_, step_);
    TSSetMaxTime(ts_, iterate_start + two_pi);
    TSConvergedReason reason = TS_CONVERGED_ITERATING;
    if (TSSolve(ts_, nullptr) != 0 || TSGetConvergedReason(ts_, &reason) != 0 || reason != TS_CONVERGED_TIME)
      return false;
    PetscInt steps = 1;
    TSGetStepNumber(ts_, &steps);
    step_ = two_pi / double(steps);
    const double* end = nullptr;
    VecGetArrayRead(y_, &end);
    std::copy_n(end, N, u);
    VecRestoreArrayRead(y_, &end);
    return u[0] > 0.0;
  }

 private:
  static PetscErrorCode rates(TS, PetscReal theta, Vec y, Vec dy, void* self) {
    const double* u = nullptr;
    double* du = nullptr;
    VecGetArrayRead(y, &u);
    VecGetArrayWrite(dy, &du);
    static_cast<TsRk*>(self)->peer_->template rates<N>(theta, u, du);
    VecRestoreArrayWrite(dy, &du);
    VecRestoreArrayRead(y, &u);
    return 0;
  }
  static PetscErrorCode turns_forwards(TS, PetscReal, Vec y, PetscBool* accept) {
    const double* u = nullptr;
    VecGetArrayRead(y, &u);
    *accept = u[0] > 0.0 ? PETSC_TRUE : PETSC_FALSE;
    VecRestoreArrayRead(y, &u);
    return 0;
  }

  const Peer* peer_ = nullptr;
  Vec y_ = nullptr;
  TS ts_ = nullptr;
  double step_ = first_step;
};

}  // namespace wingbeat::peers
