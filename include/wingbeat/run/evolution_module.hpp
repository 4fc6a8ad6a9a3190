// The library with pagmo beside the program.
#pragma once

#include <filesystem>
#include <span>

#include "wingbeat/study/evolution.hpp"

namespace wingbeat {

/// Loads it. Throws std::runtime_error, with the reason, where it cannot be loaded.
Evolve load_evolution();
/// Loads it from the first of these folders that has it, else from where the program has it: for processes that are not
/// the program.
Evolve load_evolution(std::span<const std::filesystem::path> folders);

}  // namespace wingbeat
