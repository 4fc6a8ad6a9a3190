// The two drives that vehicles have, and what follows from which one it is. Files that need to know ask here.
#pragma once

#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// What a drive is to the rest. A crank turns on a direct voltage, and the transmission makes a stroke of it; the shaft
/// of a direct drive is the wing's hinge and swings on a sine.
struct Drive {
  bool rotates;                 ///< crank angle and crank speed mean something; the cycle is a turn, its variable the
                                ///< crank angle. Else the cycle is a period of the supply, its variable the phase
  bool alternating;             ///< the vehicle holds all of the supply, a sine: Vehicle::voltage is its amplitude
  bool has_rod;                 ///< an internal force, the rod force, is a result, and friction may follow it
  bool voltage_sets_frequency;  ///< else the supply's frequency is the wings'
  bool stroke_is_fixed;         ///< by the geometry; else it is a result
};

constexpr Drive drive_of(TransmissionType transmission) {
  const bool crank = transmission != TransmissionType::direct;
  return {.rotates = crank,
          .alternating = !crank,
          .has_rod = crank,
          .voltage_sets_frequency = crank,
          .stroke_is_fixed = crank};
}

/// Of a vehicle. A transmission that is none of the types turns a crank.
template <class V>
constexpr Drive drive_of(const V& vehicle) {
  if constexpr (requires { vehicle.transmission.type; }) return drive_of(vehicle.transmission.type);
  return drive_of(TransmissionType::slider_crank);
}
inline Drive drive_of(const Design<double>& design) { return drive_of(design.transmission.type); }

}  // namespace wingbeat
