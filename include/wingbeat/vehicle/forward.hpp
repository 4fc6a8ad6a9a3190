// Vehicle and what acts on it, for declarations that take them by reference; vehicle/vehicle.hpp defines them.
#pragma once

#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

template <Scalar S>
struct Design;
template <Scalar S>
struct Vehicle;
template <Scalar S>
struct Motion;

}  // namespace wingbeat
