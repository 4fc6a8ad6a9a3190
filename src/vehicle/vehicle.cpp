#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

template Vehicle<double> resolve(const Design<double>&, Condition);

}  // namespace wingbeat
