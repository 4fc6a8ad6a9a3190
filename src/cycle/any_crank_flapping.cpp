// The steady flapping of a crank of any kind.
#include "cycle/crank_search.hpp"

namespace wingbeat::detail {

SteadyFlapping find_any_crank_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                       const StartUp& start_up, SharedSearch& shared) {
  return search_flapping<CrankSearch<AnyCrankSystem<double>>>(vehicle, options, start_up, shared);
}

}  // namespace wingbeat::detail
