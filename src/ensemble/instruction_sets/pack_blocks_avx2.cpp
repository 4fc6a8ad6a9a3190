#include "wingbeat/ensemble/direct_pack_block_body.hpp"
#include "wingbeat/ensemble/pack_block_body.hpp"

namespace wingbeat {

using Block = Pack<xsimd::fma3<xsimd::avx2>, 2>;
static_assert(Block::lanes == lanes_avx2);

void solve_block_avx2(const EnsembleMember* const* members, int count, const PackSettings& settings,
                      PackResult* const* results) {
  solve_block<Block>(members, count, settings, results);
}

void solve_direct_block_avx2(const EnsembleMember* const* members, int count, const DirectPackSettings& settings,
                             DirectPackResult* const* results) {
  solve_direct_block<Block>(members, count, settings, results);
}

}  // namespace wingbeat
