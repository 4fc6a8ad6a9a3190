// What SIMD lanes know of the coefficient tables and pitch stops of a block's vehicles.
#pragma once

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// Angle of attack below which a vehicle's force coefficients are those there [rad]: the stop of its pitching, or where
/// its table begins; minus infinity without either.
inline double kink_of_coefficients(const Vehicle<double>& v) {
  const auto& table = v.wings.coefficients.table;
  const double stop = v.wings.angle_of_attack_min;
  return table ? std::max(stop, table->alpha().front()) : stop;
}

/// Whether lanes know all of a vehicle's table and stop: the table reaches to the reversals' angle of attack, and the
/// air's added mass sees no stop beyond the table's start.
inline bool lanes_know_coefficients(const Vehicle<double>& v) {
  constexpr double rounding = 1e-9;
  const auto& table = v.wings.coefficients.table;
  if (!table) return true;
  return table->alpha().back() >= 0.5 * pi - rounding && (v.wings.added_inertia == 0.0 || !has_pitch_stop(v.wings) ||
                                                          v.wings.angle_of_attack_min >= table->alpha().front());
}

}  // namespace wingbeat
