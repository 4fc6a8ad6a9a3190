// The steady flapping of a direct drive whose wings pitch on hinges.
#include "cycle/direct_search.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {

SteadyFlapping find_pitching_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                      const StartUp& start_up, SharedSearch& shared) {
  const auto search = has_current_state(vehicle) ? search_flapping<DirectSearch<PitchDirectSystem<double, 5>>>
                                                 : search_flapping<DirectSearch<PitchDirectSystem<double, 4>>>;
  return search(vehicle, options, start_up, shared);
}

}  // namespace wingbeat::detail
