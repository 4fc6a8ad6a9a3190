// Every number of a vehicle, so that no parameter can be forgotten in a comparison of scalars.
#pragma once

#include <array>

#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

inline constexpr int parameter_count = number_count<Vehicle<double>>;

template <Scalar S>
std::array<S*, parameter_count> parameters(Vehicle<S>& v) {
  std::array<S*, parameter_count> all;
  std::size_t n = 0;
  for_each_number(v, [&](S& x) { all[n++] = &x; });
  return all;
}

}  // namespace wingbeat
