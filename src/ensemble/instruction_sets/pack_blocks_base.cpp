#include "wingbeat/ensemble/pack_blocks.hpp"

#ifdef WINGBEAT_NO_LANES

#include <limits>

#include "wingbeat/ensemble/direct_pack_blocks.hpp"

namespace wingbeat {

void solve_block_base(const EnsembleMember* const*, int count, const PackSettings&, PackResult* const* results) {
  for (int n = 0; n < count; ++n) results[n]->assessment = PackAssessment::unresolved;
}

void solve_direct_block_base(const EnsembleMember* const*, int count, const DirectPackSettings&,
                             DirectPackResult* const* results) {
  for (int n = 0; n < count; ++n) results[n]->error_estimate = std::numeric_limits<double>::infinity();
}

}  // namespace wingbeat

#else

#include "wingbeat/ensemble/direct_pack_block_body.hpp"
#include "wingbeat/ensemble/pack_block_body.hpp"

namespace wingbeat {

#ifdef WINGBEAT_X86
using Block = Pack<xsimd::sse2, 2>;
#else
using Block = Pack<xsimd::neon64, 2>;
#endif
static_assert(Block::lanes == lanes_base);

void solve_block_base(const EnsembleMember* const* members, int count, const PackSettings& settings,
                      PackResult* const* results) {
  solve_block<Block>(members, count, settings, results);
}

void solve_direct_block_base(const EnsembleMember* const* members, int count, const DirectPackSettings& settings,
                             DirectPackResult* const* results) {
  solve_direct_block<Block>(members, count, settings, results);
}

}  // namespace wingbeat

#endif
