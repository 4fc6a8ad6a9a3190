#include "study/local_search.hpp"

#include <exception>
#include <nlopt.hpp>
#include <vector>

namespace wingbeat::detail {
namespace {

/// What NLopt's functions are handed: the last evaluation, which serves objective and constraints.
struct Memory {
  const SearchedFunction& function;
  LocalSearch& search;
  Vector last;
  OptimiseProblem::Evaluation evaluation;
  double scale;
  int walls = 0;
  std::exception_ptr raised{};  ///< by an evaluation: it must not pass through NLopt, which is C

  const OptimiseProblem::Evaluation& at(const double* u) {
    const Eigen::Map<const Vector> x(u, function.size);
    if (last.size() == 0 || last != x) {
      last = x;
      try {
        evaluation = function.evaluate(last);
      } catch (...) {
        raised = std::current_exception();
        throw nlopt::forced_stop();
      }
      ++search.evaluations;
      if (!evaluation.flaps) ++walls;
      const bool good = evaluation.flaps && evaluation.violation() <= feasible_to;
      if (good && (!search.feasible || evaluation.objective < search.objective)) {
        search.feasible = true;
        search.objective = evaluation.objective;
        search.end = last;
      }
    }
    return evaluation;
  }
};

double objective_of(unsigned n, const double* u, double* gradient, void* data) {
  Memory& memory = *static_cast<Memory*>(data);
  const OptimiseProblem::Evaluation& e = memory.at(u);
  if (gradient) Eigen::Map<Vector>(gradient, n) = e.gradient / memory.scale;
  return e.objective / memory.scale;
}

void constraints_of(unsigned m, double* values, unsigned n, const double* u, double* gradient, void* data) {
  Memory& memory = *static_cast<Memory*>(data);
  const OptimiseProblem::Evaluation& e = memory.at(u);
  Eigen::Map<Vector>(values, m) = e.constraints;
  if (!gradient) return;
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(gradient, m, n) = e.jacobian;
}

}  // namespace

void LocalSearch::run(const SearchedFunction& function, const Vector& start) {
  Memory memory{function, *this, {}, {}, 1.0};
  std::vector<double> u(start.data(), start.data() + start.size());
  try {
    memory.at(u.data());
  } catch (const nlopt::forced_stop&) {
    std::rethrow_exception(memory.raised);
  }
  const OptimiseProblem::Evaluation& first = memory.evaluation;
  if (!first.flaps) return;
  began = first.objective;
  memory.scale = std::max(std::abs(first.objective), 1e-300);
  // A search that runs into designs that do not flap may end there; from its best point it then starts anew.
  const std::vector<nlopt::algorithm> algorithms = function.gradients
                                                       ? std::vector{nlopt::LD_SLSQP, nlopt::LD_SLSQP, nlopt::LD_CCSAQ}
                                                       : std::vector{nlopt::LN_COBYLA, nlopt::LN_COBYLA};
  for (const nlopt::algorithm algorithm : algorithms) {
    nlopt::opt solver(algorithm, unsigned(function.size));
    solver.set_lower_bounds(0.0);
    solver.set_upper_bounds(1.0);
    solver.set_min_objective(&objective_of, &memory);
    const unsigned constraints = unsigned(function.constraints);
    if (constraints > 0) {
      solver.add_inequality_mconstraint(&constraints_of, &memory, std::vector<double>(constraints, 1e-9));
    }
    solver.set_xtol_abs(1e-8);
    solver.set_ftol_rel(1e-10);
    if (function.gradients) {
      solver.set_maxeval(algorithm == nlopt::LD_CCSAQ ? 200 : 100);
    } else {
      solver.set_initial_step(0.1);
      solver.set_maxeval(200 * int(function.size));
    }
    double value = 0.0;
    bool converged = false;
    try {
      converged = int(solver.optimize(u, value)) > 0 && solver.last_optimize_result() != nlopt::MAXEVAL_REACHED;
    } catch (const std::exception&) {
      // What was reached until then counts.
    }
    if (memory.raised) std::rethrow_exception(memory.raised);
    // Where gradients lack, a second search, from where the first ended, shows that it had not merely become slow.
    if (function.gradients && memory.walls == 0 && (converged || !feasible)) break;
    memory.walls = 0;
    if (feasible) u.assign(end.data(), end.data() + end.size());
    else u.assign(start.data(), start.data() + start.size());
  }
}

}  // namespace wingbeat::detail
