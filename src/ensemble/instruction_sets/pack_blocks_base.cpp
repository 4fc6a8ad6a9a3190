#include "wingbeat/ensemble/pack_blocks.hpp"

#ifdef WINGBEAT_NO_LANES

namespace wingbeat {

void solve_block_base(const EnsembleMember* const*, int count, const PackSettings&, PackResult* const* results) {
  for (int n = 0; n < count; ++n) results[n]->assessment = PackAssessment::unresolved;
}

}  // namespace wingbeat

#else

#include "wingbeat/ensemble/pack_block_body.hpp"

namespace wingbeat {

void solve_block_base(const EnsembleMember* const* members, int count, const PackSettings& settings,
                      PackResult* const* results) {
#ifdef WINGBEAT_X86
  using Arch = xsimd::sse2;
#else
  using Arch = xsimd::neon64;
#endif
  using Block = Pack<Arch, 2>;
  static_assert(Block::lanes == lanes_base);
  solve_block<Block>(members, count, settings, results);
}

}  // namespace wingbeat

#endif
