// The SIMD instruction sets that ensembles are solved with.
#pragma once

#include <string_view>
#include <utility>

// What every processor of the target has: SSE2 on x86-64, NEON on 64-bit ARM; elsewhere nothing that lanes could use.
#if defined(__x86_64__) || defined(_M_X64)
#define WINGBEAT_X86
#define WINGBEAT_BASE_ISA "sse2"
#elif defined(__aarch64__)
#define WINGBEAT_BASE_ISA "neon64"
#else
#define WINGBEAT_BASE_ISA "none"
#define WINGBEAT_NO_LANES
#endif
// Wider ones beside it, unless a build leaves them out: CMake's WINGBEAT_WIDE_LANES.
#if defined(WINGBEAT_X86) && !defined(WINGBEAT_BASE_LANES_ALONE)
#define WINGBEAT_HAS_WIDE_LANES
#endif

namespace wingbeat {

/// SIMD instruction sets the batched solver is compiled for, narrowest first: `base` is what every processor of the
/// target has. Where that is none, the scalar solver does the work.
enum class InstructionSet { base, avx2, avx512 };
inline constexpr std::pair<std::string_view, InstructionSet> instruction_sets[] = {
    {WINGBEAT_BASE_ISA, InstructionSet::base},
#ifdef WINGBEAT_HAS_WIDE_LANES
    {"avx2", InstructionSet::avx2},
    {"avx512", InstructionSet::avx512},
#endif
};

#ifdef WINGBEAT_NO_LANES
inline constexpr bool has_packs = false;
#else
inline constexpr bool has_packs = true;
#endif

/// True if this processor can run it.
bool is_available(InstructionSet isa);
/// The widest one this processor can run.
InstructionSet best_instruction_set();

}  // namespace wingbeat
