#include <memory>
#include <utility>

#include "time/own_steps.hpp"
#include "time/transient_tools.hpp"
#include "wingbeat/vehicle/unknowns.hpp"

namespace wingbeat::detail {
namespace {

/// Of 2 unknowns, 3, and so on.
template <std::size_t... extra>
std::unique_ptr<Integrator> integrator_of(IntegratorProblem problem, std::index_sequence<extra...>) {
  std::unique_ptr<Integrator> made;
  const auto make = [&]<std::size_t N>() {
    if (std::size_t(problem.coupled) != N) return false;
    made = std::make_unique<OwnIntegrator<int(N), quadrature_count>>(std::move(problem));
    return true;
  };
  (void)(make.template operator()<2 + extra>() || ...);
  return made;
}

}  // namespace

std::unique_ptr<Integrator> own_integrator(IntegratorProblem problem) {
  return integrator_of(std::move(problem), std::make_index_sequence<max_unknowns - 1>());
}

}  // namespace wingbeat::detail
