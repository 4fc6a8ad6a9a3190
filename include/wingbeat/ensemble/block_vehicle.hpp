// The vehicles of a block on SIMD lanes.
#pragma once

#include "wingbeat/core/pack.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

template <class L>
struct BlockVehicle {
  Vehicle<L> vehicle;
  WakeStrips<L> strips;  ///< set where any has a wake

  /// vehicle_of(lane) is the Vehicle<double> of a lane.
  template <class VehicleOf>
  explicit BlockVehicle(const VehicleOf& vehicle_of) : vehicle(in_packs<L, Vehicle>(vehicle_of)) {
    if (!has_wake(vehicle.wings)) return;
    strips = in_packs<L, WakeStrips>([&](int lane) -> const auto& { return vehicle_of(lane).wings.wake.strips; });
    vehicle.wings.wake.strips = &strips;
  }
  BlockVehicle(const BlockVehicle&) = delete;
  BlockVehicle& operator=(const BlockVehicle&) = delete;
};

}  // namespace wingbeat
