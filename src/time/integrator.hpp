// What integrates a model in time, step by step, with located roots: SUNDIALS CVODE or the project's own steps.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "wingbeat/time/transient.hpp"

namespace wingbeat::detail {

/// One initial value problem with root functions.
struct IntegratorProblem {
  int size = 0;
  int coupled = 0;  ///< the rates depend on the first `coupled` unknowns alone; the rest are quadratures
  int roots = 0;
  bool stiff = false;
  std::function<bool(double t, const double* y, double* rates)> rates;  ///< false: cannot be evaluated there
  std::function<void(double t, const double* y, double* values)> root_functions;
  std::function<void(const double* y, double* errors)> tolerated;  ///< admissible local error of each unknown, > 0
  double longest_step = std::numeric_limits<double>::infinity();   ///< of own steps, so that no root hides within one
  std::vector<double> typical;   ///< size of the coupled unknowns, for the difference quotients of the Jacobian
  double root_resolution = 0.0;  ///< of own steps: part of a step to which roots are located [1]; 0: to rounding
  double* next_step = nullptr;   ///< of own steps: kept from piece to piece, where it stands > 0 the first one [s]
};

class Integrator {
 public:
  enum class Outcome { step, root, stop, failed };

  virtual ~Integrator() = default;

  /// The unknowns at time(); set before restart().
  virtual double* state() = 0;
  /// Starts afresh from state() at time t. `directions`: which sign changes of each root function count (+1 rising,
  /// -1 falling, 0 both). `horizon`: a time ahead that bounds the first step. Steps end at `stop` exactly. `longest`:
  /// the longest step of one that looks at the root functions several times within it [s].
  virtual bool restart(double t, int* directions, double horizon, double stop, double longest) = 0;
  /// One internal step, cut short at a root or at the stop time; state() and time() are there then. Throws Cancelled.
  virtual Outcome advance() = 0;
  virtual double time() const = 0;
  virtual bool found(int root) const = 0;
  /// The coupled unknowns, or their first derivatives, at a time within the last internal step.
  virtual const double* dense(double t, int derivative = 0) = 0;
};

/// Adams or BDF by SUNDIALS CVODE; ParameterError where the library was built without.
std::unique_ptr<Integrator> sundials_integrator(IntegratorProblem problem);
/// Dormand and Prince's 8(5,3) pair, or five-stage Radau IIA where the problem is stiff.
std::unique_ptr<Integrator> own_integrator(IntegratorProblem problem);

/// The integrator that the options name.
std::unique_ptr<Integrator> make_integrator(TimeIntegrator which, IntegratorProblem problem);

}  // namespace wingbeat::detail
