// SUNDIALS CVODE as an integrator.
#include <algorithm>
#include <cmath>
#include <new>
#include <utility>
#include <vector>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "time/integrator.hpp"
#include "wingbeat/core/cancellation.hpp"

namespace wingbeat::detail {
namespace {

/// Owns a CVODE integrator. The address of an object must not change: CVODE keeps it.
class Cvode : public Integrator {
 public:
  explicit Cvode(IntegratorProblem problem) : problem_(std::move(problem)), found_(std::size_t(problem_.roots)) {
    const sunindextype n = problem_.size;
    check(SUNContext_Create(nullptr, &context_) == 0);
    y_ = N_VNew_Serial(n, context_);
    dense_ = N_VNew_Serial(n, context_);
    shifted_.resize(std::size_t(n));
    shifted_rates_.resize(std::size_t(n));
    memory_ = CVodeCreate(problem_.stiff ? CV_BDF : CV_ADAMS, context_);
    check(y_ && dense_ && memory_);
    CVodeSetErrHandlerFn(memory_, [](int, const char*, const char*, char*, void*) {}, nullptr);
    N_VConst(0.0, y_);
    check(CVodeInit(memory_, &rates, 0.0, y_) == CV_SUCCESS);
    CVodeSetUserData(memory_, this);
    check(CVodeWFtolerances(memory_, &weights) == CV_SUCCESS);
    if (problem_.stiff) {
      matrix_ = SUNDenseMatrix(n, n, context_);
      linear_ = SUNLinSol_Dense(y_, matrix_, context_);
      check(matrix_ && linear_ && CVodeSetLinearSolver(memory_, linear_, matrix_) == CV_SUCCESS);
      check(CVodeSetJacFn(memory_, &jacobian) == CV_SUCCESS);
    } else {
      nonlinear_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
      check(nonlinear_ && CVodeSetNonlinearSolver(memory_, nonlinear_) == CV_SUCCESS);
    }
    if (problem_.roots > 0) check(CVodeRootInit(memory_, problem_.roots, &roots) == CV_SUCCESS);
    CVodeSetNoInactiveRootWarn(memory_);
    CVodeSetMaxHnilWarns(memory_, -1);
    CVodeSetMaxErrTestFails(memory_, 30);
    CVodeSetMaxConvFails(memory_, 30);
  }
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;
  ~Cvode() override {
    if (memory_) CVodeFree(&memory_);
    if (nonlinear_) SUNNonlinSolFree(nonlinear_);
    if (linear_) SUNLinSolFree(linear_);
    if (matrix_) SUNMatDestroy(matrix_);
    if (y_) N_VDestroy(y_);
    if (dense_) N_VDestroy(dense_);
    if (context_) SUNContext_Free(&context_);
  }

  double* state() override { return N_VGetArrayPointer(y_); }

  bool restart(double t, int* directions, double horizon, double stop, double longest) override {
    bool good = CVodeReInit(memory_, t, y_) == CV_SUCCESS;
    if (problem_.roots > 0) good = good && CVodeSetRootDirection(memory_, directions) == CV_SUCCESS;
    time_ = t;
    horizon_ = horizon;
    // CVODE looks at the root functions at the ends of steps alone; 0: as long as may be.
    good = good && CVodeSetMaxStep(memory_, std::isfinite(longest) ? longest / 8.0 : 0.0) == CV_SUCCESS;
    return good && CVodeSetStopTime(memory_, stop) == CV_SUCCESS;
  }

  Outcome advance() override {
    check_cancellation();
    realtype t = time_;
    const int flag = CVode(memory_, time_ + horizon_, y_, &t, CV_ONE_STEP);
    time_ = t;
    if (flag == CV_ROOT_RETURN) {
      CVodeGetRootInfo(memory_, found_.data());
      return Outcome::root;
    }
    if (flag == CV_TSTOP_RETURN) return Outcome::stop;
    if (flag < 0) return Outcome::failed;
    return Outcome::step;
  }
  double time() const override { return time_; }
  bool found(int root) const override { return found_[std::size_t(root)] != 0; }

  const double* dense(double t, int derivative) override {
    if (CVodeGetDky(memory_, t, derivative, dense_) != CV_SUCCESS) return state();
    return N_VGetArrayPointer(dense_);
  }

 private:
  static void check(bool good) {
    if (!good) throw std::bad_alloc();
  }
  static Cvode& self(void* p) { return *static_cast<Cvode*>(p); }

  static int rates(realtype t, N_Vector y, N_Vector dy, void* p) {
    return self(p).problem_.rates(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy)) ? 0 : 1;
  }
  static int roots(realtype t, N_Vector y, realtype* values, void* p) {
    self(p).problem_.root_functions(t, N_VGetArrayPointer(y), values);
    return 0;
  }
  static int weights(N_Vector y, N_Vector w, void* p) {
    double* weight = N_VGetArrayPointer(w);
    self(p).problem_.tolerated(N_VGetArrayPointer(y), weight);
    for (int k = 0; k < self(p).problem_.size; ++k) weight[k] = 1.0 / weight[k];
    return 0;
  }
  static int jacobian(realtype t, N_Vector y, N_Vector fy, SUNMatrix jac, void* p, N_Vector, N_Vector, N_Vector) {
    Cvode& c = self(p);
    const int n = c.problem_.size;
    const double* values = N_VGetArrayPointer(y);
    const double* f = N_VGetArrayPointer(fy);
    SUNMatZero(jac);
    c.shifted_.assign(values, values + n);
    for (int column = 0; column < c.problem_.coupled; ++column) {
      // Forward differences: the square root of rounding balances rounding against curvature.
      const double step = 1.5e-8 * std::max(std::abs(values[column]), c.problem_.typical[std::size_t(column)]);
      c.shifted_[std::size_t(column)] = values[column] + step;
      if (!c.problem_.rates(t, c.shifted_.data(), c.shifted_rates_.data())) return 1;
      realtype* entries = SUNDenseMatrix_Column(jac, column);
      for (int row = 0; row < n; ++row) entries[row] = (c.shifted_rates_[std::size_t(row)] - f[row]) / step;
      c.shifted_[std::size_t(column)] = values[column];
    }
    return 0;
  }

  IntegratorProblem problem_;
  std::vector<int> found_;
  std::vector<double> shifted_, shifted_rates_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  N_Vector dense_ = nullptr;
  void* memory_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  SUNNonlinearSolver nonlinear_ = nullptr;
  double time_ = 0.0;
  double horizon_ = 0.0;
};

}  // namespace

std::unique_ptr<Integrator> sundials_integrator(IntegratorProblem problem) {
  return std::make_unique<Cvode>(std::move(problem));
}

}  // namespace wingbeat::detail
