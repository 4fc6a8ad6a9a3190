// The reference vehicle on a battery.
#pragma once

#include "vehicle/reference_vehicle.hpp"

namespace wingbeat {

/// Two cells lift the vehicle until their charge has fallen to about a third.
inline Design<double> hovering_design() {
  Design<double> d = reference_design();
  d.spring.stiffness = 1.377e-3;
  d.supply = {};
  d.supply.type = SupplyType::battery;
  Battery<double>& b = d.supply.battery;
  b.cells = 2.0;
  b.discharge_curve = {{0.0, 2.4}, {0.1, 2.8}, {0.5, 3.0}, {0.8, 3.3}, {1.0, 3.6}};
  b.internal_resistance = 0.4;
  b.capacity = 108.0;
  return d;
}

}  // namespace wingbeat
