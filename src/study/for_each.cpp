#include "wingbeat/study/for_each.hpp"

#include <mutex>

namespace wingbeat {

void for_all(const ForEach& for_each, std::size_t count, const std::function<void(std::size_t)>& act) {
  if (for_each) return for_each(count, act);
  for (std::size_t n = 0; n < count; ++n) act(n);
}

void run_tasks(const std::vector<std::function<void()>>& tasks, const ForEach& for_each,
               const std::function<void(double)>& done) {
  std::mutex mutex;
  std::size_t finished = 0;
  for_all(for_each, tasks.size(), [&](std::size_t n) {
    tasks[n]();
    const std::lock_guard<std::mutex> lock(mutex);
    if (done) done(double(++finished) / double(tasks.size()));
  });
}

}  // namespace wingbeat
