// Lanes of the instruction set that tests are compiled for, two registers a value as in the program's batches.
#pragma once

#include <cstddef>

#include "wingbeat/core/pack.hpp"

namespace wingbeat {

using Lanes = Pack<xsimd::default_arch, 2>;
inline constexpr std::size_t lanes = std::size_t(Lanes::lanes);

}  // namespace wingbeat
