#pragma once

#include "vehicle/reference_vehicle.hpp"

namespace wingbeat {

/// The wings of the reference vehicle on a motor shaft: 3 V at 22 Hz, where the springs resonate, without friction.
inline Design<double> direct_design() {
  Design<double> d = reference_design();
  d.transmission = {};
  d.transmission.type = TransmissionType::direct;
  d.supply = {SupplyType::sine, 3.0, 22.0, 1.0};
  d.friction = {FrictionLaw::none, 0.0};
  d.spring.resonance = 22.0;
  return d;
}

}  // namespace wingbeat
