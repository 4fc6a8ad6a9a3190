// The steady flapping of a direct drive with wings under the pitch law.
#include "cycle/direct_search.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {

SteadyFlapping find_direct_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                    const StartUp& start_up, SharedSearch& shared) {
  const auto search = has_current_state(vehicle) ? search_flapping<DirectSearch<DirectSystem<double, 3>>>
                                                 : search_flapping<DirectSearch<DirectSystem<double, 2>>>;
  return search(vehicle, options, start_up, shared);
}

}  // namespace wingbeat::detail
