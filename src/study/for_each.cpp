#include "wingbeat/study/for_each.hpp"

#include <mutex>

namespace wingbeat {

void run_tasks(const std::vector<std::function<void()>>& tasks, const ForEach& for_each,
               const std::function<void(double)>& done) {
  std::mutex mutex;
  std::size_t finished = 0;
  for_each(tasks.size(), [&](std::size_t n) {
    tasks[n]();
    const std::lock_guard<std::mutex> lock(mutex);
    if (done) done(double(++finished) / double(tasks.size()));
  });
}

}  // namespace wingbeat
