// Impacts on stops in a recorded cycle, for tests.
#pragma once

#include "wingbeat/cycle/pitch_stops.hpp"
#include "wingbeat/solve/iterate.hpp"

namespace wingbeat {

/// Energy that stops take in the impacts of a cycle [J], each taken anew from where it met the stop.
template <class System>
double impact_loss(const System& system, const solver::Iterate<System>& cycle) {
  double lost = 0.0;
  for (std::size_t n = 1; n < cycle.steps.size(); ++n) {
    const auto& before = cycle.steps[n - 1];
    if (before.signs[System::impacts] == cycle.steps[n].signs[System::impacts]) continue;
    const double x = before.x + before.h;
    typename System::Quadrature totals{};
    pitch_stops::after_impact(system, x, solver::evaluate_inside<false>(system, cycle, before, x).y, before.signs,
                              &totals);
    lost += totals[System::hinge_work];
  }
  return lost;
}

}  // namespace wingbeat
