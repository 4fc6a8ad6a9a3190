// The SIMD lanes that every processor of this kind has, for code that no choice of an instruction set reaches. Without
// such lanes WINGBEAT_BASE_LANES is not defined.
#pragma once

#if defined(__x86_64__) || defined(_M_X64)
#define WINGBEAT_BASE_LANES xsimd::sse2
#elif defined(__aarch64__)
#define WINGBEAT_BASE_LANES xsimd::neon64
#endif

#ifdef WINGBEAT_BASE_LANES
#include "wingbeat/core/pack.hpp"

namespace wingbeat {

template <int K>
using BaseLanes = Pack<WINGBEAT_BASE_LANES, K>;

}  // namespace wingbeat
#endif
