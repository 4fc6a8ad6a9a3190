// How a search for a periodic orbit (solve/periodic.hpp) ended.
#pragma once

#include <limits>

namespace wingbeat::solver {

enum class PeriodicStatus {
  not_tried,  ///< nothing was searched for
  converged,
  barrier,         ///< iterates run into the edge of the admissible region: no orbit was found
  too_many_steps,  ///< an iterate needs more steps than allowed
  not_converged,   ///< iterates neither settle nor fail within max_iterates
  unbalanced,      ///< converged, but the energy balance does not close: said by the caller
  out_of_work      ///< the WorkBudget is used up
};

/// How the search ended, in words; empty where nothing was searched for.
constexpr const char* describe(PeriodicStatus status) {
  switch (status) {
    case PeriodicStatus::not_tried: break;
    case PeriodicStatus::converged: return "orbit closed";
    case PeriodicStatus::barrier: return "an iterate ran into the edge of the admissible region";
    case PeriodicStatus::too_many_steps: return "an iterate needs more steps than allowed";
    case PeriodicStatus::not_converged: return "iterates did not close";
    case PeriodicStatus::unbalanced: return "the energy balance of the orbit found does not close";
    case PeriodicStatus::out_of_work: return "the integration steps allowed for the search are used up";
  }
  return "";
}

/// How a search for an orbit ended, in the manner of Ceres and SUNDIALS.
struct PeriodicSummary {
  PeriodicStatus status = PeriodicStatus::not_tried;
  int iterates = 0;  ///< iterates integrated, those with derivatives included
  int newton_steps = 0;
  int steps = 0;                ///< integration steps of the final iterate
  double residual = 0.0;        ///< largest distance of the iterate's start from the orbit's, over its error scale
  double error_estimate = 0.0;  ///< of the orbit and its integrals, relative
  double stop = 0.0;            ///< where the last iterate ended, if it did not complete
  double floquet_multiplier_max = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace wingbeat::solver
