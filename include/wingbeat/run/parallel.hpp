// Independent pieces of work on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace wingbeat {

/// Calls `act` for 0 to count - 1 on all cores, at most `threads` at once (0: one for each core). A request to cancel
/// the calling thread's computation reaches all of them.
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& act, int threads = 0);

}  // namespace wingbeat
