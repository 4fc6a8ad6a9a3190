// Independent pieces of work, whose threads come from outside.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace wingbeat {

/// Calls `act` for 0 to count - 1, in any order, perhaps side by side.
using ForEach = std::function<void(std::size_t count, const std::function<void(std::size_t)>& act)>;

/// Calls `act` by `for_each`; one after another where there is none.
void for_all(const ForEach& for_each, std::size_t count, const std::function<void(std::size_t)>& act);

/// Runs all tasks by `for_each`, one after another where there is none; `done`, if given, is called with the share of
/// them that has finished, 0 to 1, by one thread at a time.
void run_tasks(const std::vector<std::function<void()>>& tasks, const ForEach& for_each,
               const std::function<void(double)>& done);

}  // namespace wingbeat
