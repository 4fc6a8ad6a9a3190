// The loads of the air on body and wings at one instant, and of a body whose wings have mass the accelerations: what
// flights and FMUs share; model.md section 18.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "wingbeat/flight/body_loads.hpp"
#include "wingbeat/flight/flight_vehicle.hpp"
#include "wingbeat/flight/wing_reaction.hpp"
#include "wingbeat/parts/body.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat::detail {

inline constexpr std::size_t max_flight_drives = 2;

/// One drive at an instant, at which `motion` acts in `mode`.
struct DriveInstant {
  FullState<double> at;
  PitchMotion<double> motion;
  Mode<double> mode;
  Coordinates<double> place;
};

/// Flows of all drives, which their vehicles feel.
using DriveFlows = std::vector<std::shared_ptr<OnsetFlow>>;

/// How the body moves through the air, with the wind [m/s] in earth axes.
inline void set_flows(const DriveFlows& flows, const BodyState& body, const Triple& wind) {
  Triple air = body.velocity;
  if (wind != Triple{}) {
    const Triple blows = to_body(body.attitude, wind);
    for (std::size_t k = 0; k < 3; ++k) air[k] -= blows[k];
  }
  for (const auto& flow : flows) {
    flow->velocity = air;
    flow->rates = body.rates;
    flow->reaction_moment = 0.0;
  }
}

struct AirOnBody {
  BodyLoads loads;                         ///< of wings and plates
  std::optional<BodyState> accelerations;  ///< where wings have mass: of velocity and rates alone
  std::array<DriveInstant, max_flight_drives> drives;
};

/// `drives` feel the flows as they are; instant_of(n) evaluates one of them. Wings that have mass act on the body where
/// `wings_act`: the reaction moments of the flows are set then.
template <class InstantOf>
AirOnBody air_on_body(const FlightVehicle& vehicle, const std::array<const Vehicle<double>*, max_flight_drives>& drives,
                      const DriveFlows& flows, const BodyState& body, double gravity, bool wings_act,
                      const InstantOf& instant_of) {
  AirOnBody air{};
  air.loads = plate_loads(vehicle.body, flows[0]->velocity, body.rates);
  const std::size_t count = flows.size();
  const auto evaluate_all = [&] {
    for (std::size_t n = 0; n < count; ++n) air.drives[n] = instant_of(n);
  };
  const auto add_wings = [&] {
    for (std::size_t n = 0; n < count; ++n) {
      const DriveInstant& d = air.drives[n];
      const BodyLoads wings = wing_loads_on_body(*drives[n], d.at, d.motion, d.mode);
      for (std::size_t k = 0; k < 3; ++k) {
        air.loads.force[k] += wings.force[k], air.loads.moment[k] += wings.moment[k];
      }
    }
  };
  evaluate_all();
  if (!(vehicle.wing_mass > 0.0) || !wings_act) {
    add_wings();
    return air;
  }
  // How each drive answers to a moment, on its branch.
  std::vector<StrokeOnBody> strokes;
  std::vector<const OnsetFlow*> felt;
  bool pitching = false;
  for (std::size_t n = 0; n < count; ++n) {
    const DriveInstant& d = air.drives[n];
    strokes.push_back({d.at.configuration.stroke_angle, d.motion.stroke_velocity, d.motion.stroke_acceleration, 0.0});
    felt.push_back(flows[n].get());
    pitching = pitching || pitches(*drives[n]);
    const double probe = 1e-3 * vehicle.body.mass * standard_gravity * vehicle.wing_centre;
    flows[n]->reaction_moment = probe;
    const PitchMotion<double> probed = evaluate(*drives[n], d.at, d.mode);
    strokes[n].compliance = (strokes[n].acceleration - probed.stroke_acceleration) / probe;
  }
  const BodyLoads plates = air.loads;
  BodyWithWings found;
  // The air's inertia on hinges follows the accelerations, a little.
  for (int pass = 0; pass < (pitching ? 2 : 1); ++pass) {
    air.loads = plates;
    add_wings();
    found = body_with_wings(vehicle, felt, strokes, body, air.loads, gravity);
    for (std::size_t n = 0; n < count; ++n) flows[n]->reaction_moment = found.moments[n];
    evaluate_all();
  }
  air.accelerations.emplace();
  air.accelerations->velocity = found.acceleration;
  air.accelerations->rates = found.angular_acceleration;
  return air;
}

/// Rates of the body under what acts on it.
inline BodyState body_rates_in(const FlightVehicle& vehicle, const BodyState& body, const AirOnBody& air,
                               double gravity) {
  BodyState moves = body_rates(vehicle.body, body, air.loads, gravity);
  if (air.accelerations) moves.velocity = air.accelerations->velocity, moves.rates = air.accelerations->rates;
  return moves;
}

}  // namespace wingbeat::detail
