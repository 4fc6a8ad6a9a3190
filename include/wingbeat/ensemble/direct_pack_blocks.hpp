// The batched solver of direct drives behind plain numbers: one function for each instruction set, none of whose types
// show.
#pragma once

#include "wingbeat/ensemble/pack_blocks.hpp"

namespace wingbeat {

inline constexpr int max_direct_segments = 96;  ///< of half a period, on the second mesh

struct DirectPackSettings {
  int segments = 4;            ///< of half a period on the first mesh; the second has twice as many
  int newton_iterations = 16;  ///< at most, on either mesh
  double closed = 1e-4;        ///< a correction after which the next would not matter, relative
  // What is wanted; the peak velocity is found in any case, and counts among the errors where it is wanted.
  bool current_peak = false, exchanged_energy = false, lift_peak = false, velocity_peak = false;
};

struct DirectPackResult {
  Metrics<double> metrics;
  /// Of what is wanted, relative. Infinite where this is not known for the answer: harmonic balance has another number
  /// of responses than one, or no orbit, or none that is stable, was found.
  double error_estimate;
};

/// Solves `count` direct drives, at most lanes_* of them, alike in whether they have inductance and whether they count
/// the added mass; without constant friction, pitch stop and coefficient table. A member's result does not depend on
/// the others.
void solve_direct_block_base(const EnsembleMember* const* members, int count, const DirectPackSettings& settings,
                             DirectPackResult* const* results);
#ifdef WINGBEAT_HAS_WIDE_LANES
void solve_direct_block_avx2(const EnsembleMember* const* members, int count, const DirectPackSettings& settings,
                             DirectPackResult* const* results);
void solve_direct_block_avx512(const EnsembleMember* const* members, int count, const DirectPackSettings& settings,
                               DirectPackResult* const* results);
#endif

}  // namespace wingbeat
