// The library with pagmo beside the program.
#pragma once

#include "wingbeat/study/evolution.hpp"

namespace wingbeat {

/// Loads it. Throws std::runtime_error, with the reason, where it cannot be loaded.
Evolve load_evolution();

}  // namespace wingbeat
