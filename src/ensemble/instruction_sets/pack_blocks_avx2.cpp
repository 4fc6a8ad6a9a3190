#include "wingbeat/ensemble/pack_block_body.hpp"

namespace wingbeat {

void solve_block_avx2(const EnsembleMember* const* members, int count, const PackSettings& settings,
                      PackResult* const* results) {
  using Block = Pack<xsimd::fma3<xsimd::avx2>, 2>;
  static_assert(Block::lanes == lanes_avx2);
  solve_block<Block>(members, count, settings, results);
}

}  // namespace wingbeat
