#include "wingbeat/ensemble/lane_blocks.hpp"

#ifdef WINGBEAT_NO_LANES

namespace wingbeat {

void solve_block_base(const EnsembleMember* const*, int count, const LaneSettings&, LaneResult* const* results) {
  for (int n = 0; n < count; ++n) results[n]->assessment = LaneAssessment::unresolved;
}

}  // namespace wingbeat

#else

#include "wingbeat/ensemble/lane_block_body.hpp"

namespace wingbeat {

void solve_block_base(const EnsembleMember* const* members, int count, const LaneSettings& settings,
                      LaneResult* const* results) {
#ifdef WINGBEAT_X86
  using Arch = xsimd::sse2;
#else
  using Arch = xsimd::neon64;
#endif
  using Block = Lanes<Arch, 2>;
  static_assert(Block::lanes == lanes_base);
  solve_block<Block>(members, count, settings, results);
}

}  // namespace wingbeat

#endif
