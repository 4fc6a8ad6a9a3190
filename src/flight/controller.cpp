#include "wingbeat/flight/controller.hpp"

#include <algorithm>
#include <cmath>

#include "flight/periodic_flight.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// Rates of x, y, z and yaw at a state of body axes, the heading 0.
Eigen::Vector4d earth_rates(const FlightVector& x) {
  const Triple V = to_earth(attitude_of({x[6], x[7], 0.0}), {x[0], x[1], x[2]});
  const double yaw_rate = (x[4] * std::sin(x[6]) + x[5] * std::cos(x[6])) / std::cos(x[7]);
  return {V[0], V[1], V[2], yaw_rate};
}

/// Of the 8 states of the linear model in the 12.
constexpr Index row_of_state[8] = {4, 5, 6, 7, 8, 9, 10, 11};
constexpr const char* left_alone[flight_axis_count] = {
    "height and vertical speed are left to themselves", "pitch, forward speed and x are left to themselves",
    "roll, sideways speed and y are left to themselves", "heading and yaw rate are left to themselves"};

}  // namespace

LinearPlant regulated_plant(const FlightLinearModel& linear, const TrimResult& trim) {
  constexpr double step = 1e-5;
  LinearPlant plant{Eigen::MatrixXd::Zero(12, 12), Eigen::MatrixXd::Zero(12, linear.B.cols())};
  const FlightVector trimmed = detail::states_of(steady_body(trim.condition, trim.roll, trim.pitch));
  for (Index k = 0; k < 8; ++k) {
    for (Index j = 0; j < 8; ++j) plant.A(row_of_state[j], row_of_state[k]) = linear.A(j, k);
    FlightVector above = trimmed, below = trimmed;
    above[k] += step, below[k] -= step;
    plant.A.block<4, 1>(0, row_of_state[k]) = (earth_rates(above) - earth_rates(below)) / (2.0 * step);
    plant.B.row(row_of_state[k]) = linear.B.row(k);
  }
  return plant;
}

FlightController::FlightController(const ControllerOptions& options, ControlTask task)
    : options_(options), task_(std::move(task)), last_(task_.trim.controls), step_(1.0 / options.rate) {
  const FlightVehicle& v = *task_.vehicle;
  design_.type = options.type;
  design_.delay = task_.delay;
  if (options.type == ControllerType::none) return;
  design_.by_axis = {v.has(FlightControl::voltage) ? std::optional(FlightControl::voltage) : std::nullopt,
                     pitch_control(v), roll_control(v), yaw_control(v)};
  for (std::size_t a = 0; a < flight_axis_count; ++a) {
    std::optional<FlightControl>& control = design_.by_axis[a];
    if (control) {
      const Index column = task_.linear.column_of(*control);
      if (column < 0 || task_.linear.B(steered_row[a], column) == 0.0) control.reset();
    }
    if (control) {
      design_.controls.push_back(*control);
      continue;
    }
    design_.uncontrolled.push_back(
        detail::format("The vehicle has no control of %s: %s.", name_of(FlightAxis(a)), left_alone[a]));
  }
  if (options.type == ControllerType::lqr) design_regulator();
  else design_cascade();
}

double FlightController::limited(FlightControl which, double value) const {
  const ControlRange& range = task_.vehicle->ranges[std::size_t(which)];
  double low = range.low, high = range.high;
  if (const double speed = task_.speed[std::size_t(which)]; speed > 0.0) {
    low = std::max(low, last_[which] - speed * step_);
    high = std::min(high, last_[which] + speed * step_);
  }
  return std::clamp(value, std::min(low, high), std::max(low, high));
}

FlightControls FlightController::step(const FlightMeasurement& measured, const FlightReference& reference) {
  switch (design_.type) {
    case ControllerType::lqr: last_ = regulate(measured, reference); break;
    case ControllerType::pid: last_ = cascade(measured, reference); break;
    case ControllerType::none: break;
  }
  first_ = false;
  return last_;
}

}  // namespace wingbeat
