// The steady flapping of a crank with wings under the pitch law.
#include "cycle/crank_search.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {

SteadyFlapping find_crank_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                   const StartUp& start_up, SharedSearch& shared) {
  const auto search = has_current_state(vehicle) ? search_flapping<CrankSearch<CrankSystem<double, 2>>>
                                                 : search_flapping<CrankSearch<CrankSystem<double, 1>>>;
  return search(vehicle, options, start_up, shared);
}

}  // namespace wingbeat::detail
