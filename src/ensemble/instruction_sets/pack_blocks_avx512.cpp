#include "wingbeat/ensemble/pack_block_body.hpp"

namespace wingbeat {

void solve_block_avx512(const EnsembleMember* const* members, int count, const PackSettings& settings,
                        PackResult* const* results) {
  using Block = Pack<xsimd::avx512bw, 2>;
  static_assert(Block::lanes == lanes_avx512);
  solve_block<Block>(members, count, settings, results);
}

}  // namespace wingbeat
