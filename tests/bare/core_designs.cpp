// The bare core on 225 designs, voltages x springs x cranks, near locking too: prints status and metrics of each with
// all digits, to be compared between processors. Start-up is assessed by the core's own steps: eight of the designs
// lock though they have a rotating orbit. With an argument, by the batched solver.
#include <cstdio>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/time/transient.hpp"

using namespace wingbeat;

int main(int argc, char**) {
  std::vector<EnsembleMember> members;
  for (int v = 0; v < 15; ++v) {
    for (const double stiffness : {0.0, 1e-3, 3e-3}) {
      for (const double crank_radius : {4e-3, 5e-3, 6e-3, 7e-3, 8e-3}) {
        Design<double> d = reference_design();
        d.supply.voltage = 0.6 + 0.3 * v;
        d.spring.stiffness = stiffness;
        d.transmission.crank_radius = crank_radius;
        members.push_back({resolve(d), reporting_of(d)});
      }
    }
  }
  const StartUp start_up = start_up_in_time(1e-6, TimeIntegrator::own_steps);
  std::vector<EnsembleOutcome> outcomes(members.size());
  if (argc > 1) {
    solve_ensemble(members, {}, start_up, outcomes);
  } else {
    for (std::size_t n = 0; n < members.size(); ++n) {
      const SteadyFlapping found =
          find_steady_flapping(members[n].vehicle, {.tolerance = 1e-9, .reporting = members[n].reporting}, start_up);
      outcomes[n].status = found.status;
      outcomes[n].metrics = found.metrics;
    }
  }
  int flapping = 0;
  for (const EnsembleOutcome& o : outcomes) {
    std::printf("%s", name_of(o.status));
    for (const double x : o.metrics.values) std::printf(" %.17g", x);
    std::printf("\n");
    flapping += o.status == FlappingStatus::flapping;
  }
  return flapping > 100 && flapping < int(members.size()) ? 0 : 1;
}
