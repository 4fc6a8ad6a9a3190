#include "wingbeat/files/written_files.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

namespace wingbeat {
namespace {

std::mutex mutex;
std::vector<std::string> names;

}  // namespace

void note_written(const std::string& name) {
  const std::lock_guard lock(mutex);
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::vector<std::string> take_written() {
  const std::lock_guard lock(mutex);
  return std::exchange(names, {});
}

}  // namespace wingbeat
