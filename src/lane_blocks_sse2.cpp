#include "wingbeat/cycle/lane_block_body.hpp"

namespace wingbeat {

void solve_block_sse2(const EnsembleMember* const* members, int count, const LaneSettings& settings,
                      LaneResult* const* results) {
  using Block = Lanes<xsimd::sse2, 2>;
  static_assert(Block::lanes == lanes_sse2);
  solve_block<Block>(members, count, settings, results);
}

}  // namespace wingbeat
