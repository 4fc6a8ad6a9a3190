#include "wingbeat/flight/fly.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "flight/flight_run.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat {
namespace {

TrackingError error_of(const std::vector<FlightRow>& rows) {
  TrackingError error;
  for (const FlightRow& row : rows) {
    const Triple &p = row.position, &r = row.reference.position;
    const double across = std::hypot(p[0] - r[0], p[1] - r[1]), up = std::abs(p[2] - r[2]);
    error.horizontal_rms += square(across), error.vertical_rms += square(up);
    error.heading_rms += square(std::remainder(row.angles[2] - row.reference.yaw, two_pi));
    error.horizontal_max = std::max(error.horizontal_max, across);
    error.vertical_max = std::max(error.vertical_max, up);
    error.tilt_max = std::max(error.tilt_max, std::acos(std::cos(row.angles[0]) * std::cos(row.angles[1])));
  }
  for (double* sum : {&error.horizontal_rms, &error.vertical_rms, &error.heading_rms}) {
    *sum = std::sqrt(*sum / double(rows.size()));
  }
  return error;
}

}  // namespace

FlightRecord fly(const FlightVehicle& vehicle, const FlightPlan& plan) {
  detail::ReadyFlight ready = detail::ready_flight(vehicle, plan);
  FlightRecord flight;
  flight.trim = ready.trim;
  if (!ready.controller) {
    flight.outcome = FlightOutcome::no_trim;
    flight.detail = "There is no trim to start from: " + flight.trim.detail + ".";
    return flight;
  }
  flight.control_rate = ready.plan.controller.rate;
  flight.design = ready.controller->design();
  detail::FlightRun run(vehicle, std::move(ready),
                        [&](const FlightRow& row, const FlightSimulation&) { flight.rows.push_back(row); });
  run.fly_to(plan.duration);
  run.record_end();
  flight.end = run.simulation().time();
  flight.outcome = run.outcome();
  flight.detail = run.outcome() == FlightOutcome::completed ? detail::format("It flies the planned %.4g s.", flight.end)
                                                            : run.detail();
  flight.energy = run.energy();
  flight.error = error_of(flight.rows);
  if (flight.end > 0.0) flight.mean_power = flight.energy.electrical / flight.end;
  return flight;
}

}  // namespace wingbeat
