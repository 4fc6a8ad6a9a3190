// The numbers that direct drives on SIMD lanes have in common: of Radau IIA collocation and of the harmonic balance.
#pragma once

#include <cstddef>

namespace wingbeat {

/// Speeds at which harmonic balance looks for responses, and instants of a quarter period for each: those of
/// direct_balance().
inline constexpr std::size_t balance_speeds = 80, balance_samples = 24;

/// A segment of length 1, its start and its stages being its points.
struct DirectPackRule {
  static constexpr std::size_t stages = 7, points = stages + 1;
  double phase[points];               ///< 0 and the stages, the last of them 1
  double a[stages][stages];           ///< RadauCollocation::a; the last row holds the weights
  double place[points];               ///< the points from the segment's middle, -1 to 1
  double power[points][points];       ///< [k][m]: coefficient of place^k in the polynomial that is 1 at point m alone
  double slope[points][points];       ///< [m][j]: derivative at point m of the polynomial that is 1 at point j alone
  double halved[2 * stages][points];  ///< [j][m]: that polynomial at the stages of the first and the second half
  double balance_sine[balance_samples];  ///< at the midpoints of a quarter period
  double balance_ratio;                  ///< of a speed to the next larger one
};

const DirectPackRule& direct_pack_rule();

}  // namespace wingbeat
