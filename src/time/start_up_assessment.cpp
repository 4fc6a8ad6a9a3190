#include <algorithm>

#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

constexpr double tightest = 1e-11;    // what TransientOptions::tolerance admits
constexpr long least_steps = 150000;  ///< what is left for an assessment's cycle in any case

}  // namespace

StartUp start_up_in_time(double tolerance, TimeIntegrator integrator) {
  return [tolerance, integrator](const Vehicle<double>& vehicle, const Arrival& arrived) {
    TransientOptions options;
    options.arrived = arrived;
    options.integrator = integrator;
    options.tolerance = std::max(tolerance, tightest);
    options.metrics = false;
    const long max_steps = options.max_steps;  // as a simulation of its own, lest the two decide differently
    const TransientResult r = simulate_start_up(vehicle, options);
    StartUpOutcome outcome{r.status, r.settled, r.evidence, r.state, {}};
    if (r.status != FlappingStatus::flapping || !r.settled) return outcome;
    outcome.cycle = [vehicle, integrator, left = max_steps - r.steps, state = outcome.state](
                        double wanted, const Reporting& reporting) {
      TransientOptions onward;
      onward.integrator = integrator;
      onward.tolerance = std::max(wanted, tightest);
      onward.reporting = reporting;
      onward.max_steps = std::max(left, least_steps);
      onward.start = state;
      const TransientResult cycle = simulate_start_up(vehicle, onward);
      if (!cycle.settled || !cycle.metrics) return std::optional<SimulatedCycle>();
      return std::optional(
          SimulatedCycle{*cycle.metrics, std::max(onward.tolerance, cycle.closure), cycle.averaged_cycles});
    };
    return outcome;
  };
}

}  // namespace wingbeat
