// Start-up of a direct drive in time, for simulate_start_up().
#pragma once

#include "wingbeat/time/transient.hpp"

namespace wingbeat::detail {

TransientResult simulate_direct_start_up(const Vehicle<double>& vehicle, const TransientOptions& options);

}  // namespace wingbeat::detail
