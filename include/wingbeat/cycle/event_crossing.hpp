// A solution next to a recorded one at an event that it reaches a little earlier or later.
#pragma once

#include <cstddef>

namespace wingbeat::detail {

/// A solution next to a recorded one of which state n came to zero at x, where its rates jump: it does so a little
/// earlier or later.
template <bool quadratures, class System>
void cross_at_zero(const System& system, const typename System::Real& x, typename System::State& y, std::size_t n,
                   const typename System::Real& off, const typename System::Signs& from,
                   const typename System::Signs& to, typename System::Quadrature* totals) {
  const auto before = system.template rates<quadratures>(x, y, from);
  const auto late = -off / before.dy[n];
  const auto after = system.template rates<quadratures>(x, y, to);
  for (std::size_t k = 0; k < y.size(); ++k) y[k] = y[k] + (before.dy[k] - after.dy[k]) * late;
  if constexpr (quadratures) {
    for (std::size_t q = 0; q < before.dq.size(); ++q)
      (*totals)[q] = (*totals)[q] + (before.dq[q] - after.dq[q]) * late;
  }
}

}  // namespace wingbeat::detail
