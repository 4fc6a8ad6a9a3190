// The steady flapping of a crank whose wings pitch on hinges.
#include "cycle/crank_search.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {

SteadyFlapping find_pitching_crank_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                            const StartUp& start_up, SharedSearch& shared) {
  const auto search = has_current_state(vehicle) ? search_flapping<CrankSearch<PitchCrankSystem<double, 4>>>
                                                 : search_flapping<CrankSearch<PitchCrankSystem<double, 3>>>;
  return search(vehicle, options, start_up, shared);
}

}  // namespace wingbeat::detail
