#include "time/integrator.hpp"

#include <utility>

namespace wingbeat::detail {

#ifdef WINGBEAT_SUNDIALS
constexpr bool has_sundials = true;
#else
constexpr bool has_sundials = false;

std::unique_ptr<Integrator> sundials_integrator(IntegratorProblem) {
  throw ParameterError("transient.integrator", "this build has no SUNDIALS; choose its own steps");
}
#endif

std::unique_ptr<Integrator> make_integrator(TimeIntegrator which, IntegratorProblem problem) {
  const bool sundials = which == TimeIntegrator::sundials || (which == TimeIntegrator::automatic && has_sundials);
  return sundials ? sundials_integrator(std::move(problem)) : own_integrator(std::move(problem));
}

}  // namespace wingbeat::detail
