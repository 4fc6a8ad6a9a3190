// Flight that repeats with the wingbeat, and what small motions about it need.
#pragma once

#include <optional>
#include <string>

#include "wingbeat/flight/stability.hpp"

namespace wingbeat::detail {

FlightVector states_of(const BodyState& body);
BodyState body_of(const FlightVector& states);

/// Names of the states that take part most in a motion, over the steps; whether it is longitudinal.
std::string shape_of(const Eigen::VectorXcd& motion, const FlightVector& steps, bool& longitudinal);

/// The flight near a trim that repeats with the wingbeat and moves, in the mean, as the trim's condition has it:
/// voltage and the control of pitch follow, by the slopes of the averaged model. None, with the reason in `detail`,
/// where there is none. `steps`: small changes of the states.
std::optional<PeriodicFlight> periodic_flight(const FlightVehicle& vehicle, const TrimResult& steady,
                                              const FlightLinearModel& model, const FlightVector& steps,
                                              double tolerance, std::string& detail);

}  // namespace wingbeat::detail
