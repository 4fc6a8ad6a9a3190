// The steady flapping of a direct drive of any kind.
#include "cycle/direct_search.hpp"

namespace wingbeat::detail {

SteadyFlapping find_any_direct_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                        const StartUp& start_up, SharedSearch& shared) {
  return search_flapping<DirectSearch<AnyDirectSystem<double>>>(vehicle, options, start_up, shared);
}

}  // namespace wingbeat::detail
