// A solution next to a recorded one at an event that it reaches a little earlier or later.
#pragma once

#include <cstddef>

namespace wingbeat::detail {

/// A solution next to a recorded one of which the rates jump at x: it comes there later, by late_by(its rates before).
template <bool quadratures, class System, class LateBy>
void cross_late(const System& system, const typename System::Real& x, typename System::State& y,
                const typename System::Signs& from, const typename System::Signs& to,
                typename System::Quadrature* totals, const LateBy& late_by) {
  const auto before = system.template rates<quadratures>(x, y, from);
  const typename System::Real late = late_by(before);
  const auto after = system.template rates<quadratures>(x, y, to);
  for (std::size_t k = 0; k < y.size(); ++k) y[k] = y[k] + (before.dy[k] - after.dy[k]) * late;
  if constexpr (quadratures) {
    for (std::size_t q = 0; q < before.dq.size(); ++q)
      (*totals)[q] = (*totals)[q] + (before.dq[q] - after.dq[q]) * late;
  }
}

/// A solution next to a recorded one of which state n came to zero at x, where its rates jump: it does so a little
/// earlier or later.
template <bool quadratures, class System>
void cross_at_zero(const System& system, const typename System::Real& x, typename System::State& y, std::size_t n,
                   const typename System::Real& off, const typename System::Signs& from,
                   const typename System::Signs& to, typename System::Quadrature* totals) {
  using Real = typename System::Real;
  const auto late_by = [&](const auto& before) { return Real(-off / before.dy[n]); };
  cross_late<quadratures>(system, x, y, from, to, totals, late_by);
}

}  // namespace wingbeat::detail
