#include "wingbeat/run/parallel.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <optional>

#include "wingbeat/core/cancellation.hpp"

namespace wingbeat {

void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& act, int threads) {
  std::optional<tbb::global_control> limit;
  if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  Cancellation* const cancellation = current_cancellation();
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t n) {
    const CancellationScope scope(cancellation);
    check_cancellation();
    act(n);
  });
}

}  // namespace wingbeat
