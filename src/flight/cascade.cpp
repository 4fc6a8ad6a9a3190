// The cascade of flight: position, velocity, attitude, rates, each loop inside the last.
#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/flight/controller.hpp"

namespace wingbeat {
namespace {

/// Each loop is so many times slower than the one inside it.
constexpr double separation = 2.5;
/// The fastest loop turns its phase by so much over the delay [rad], and takes so many wingbeats for a turn.
constexpr double phase_lost = 0.5, wingbeats = 6.0;
/// The integral of a loop takes up what stays within so many of its time constants.
constexpr double integral_time = 8.0;
}  // namespace

void FlightController::design_cascade() {
  // The waves of direct drives bear less.
  const double rate = two_pi * task_.trim.frequency * (task_.vehicle->direct ? 0.5 : 1.0);
  design_.rates =
      options_.bandwidths.rates.value_or(std::min(rate / wingbeats, phase_lost / std::max(task_.delay, 0.5 * step_)));
  design_.attitude = options_.bandwidths.attitude.value_or(design_.rates / separation);
  design_.velocity = options_.bandwidths.velocity.value_or(design_.attitude / separation);
  design_.position = options_.bandwidths.position.value_or(design_.velocity / separation);
  for (std::size_t a = 0; a < flight_axis_count; ++a) {
    if (!design_.by_axis[a]) continue;
    const double effect = task_.linear.B(steered_row[a], task_.linear.column_of(*design_.by_axis[a]));
    const double damping = -task_.linear.A(steered_row[a], steered_row[a]);
    const double bandwidth = FlightAxis(a) == FlightAxis::climb ? design_.velocity : design_.rates;
    // Of x' = -d x + b u the gain w / b and the integral d w / b leave the pole -w.
    const LoopGains& given = options_.gains[a];
    LoopGains& loop = design_.loops[a];
    loop.proportional = given.proportional.value_or(bandwidth / effect);
    loop.integral = given.integral.value_or(*loop.proportional * std::max(damping, bandwidth / integral_time));
    loop.derivative =
        given.derivative.value_or(*loop.proportional * task_.actuator_lag[std::size_t(*design_.by_axis[a])]);
  }
}

/// Sets the control of an axis for an error, the integral held where it would drive the control beyond its limit.
void FlightController::drive_axis(FlightAxis axis, double wanted, double measured, FlightControls& controls) {
  const std::size_t a = std::size_t(axis);
  if (!design_.by_axis[a]) return;
  const FlightControl which = *design_.by_axis[a];
  const LoopGains& loop = design_.loops[a];
  const double error = wanted - measured;
  // The slope of what is measured, smoothed over four steps.
  if (!first_) slope_[a] += 0.25 * ((measured - last_rate_[a]) / step_ - slope_[a]);
  last_rate_[a] = measured;
  const double growth = step_ * error;
  const double asked = task_.trim.controls[which] + *loop.proportional * error +
                       *loop.integral * (rate_integral_[a] + growth) - *loop.derivative * slope_[a];
  controls[which] = limited(which, asked);
  if (!((asked - controls[which]) * *loop.integral * growth > 0.0)) rate_integral_[a] += growth;
}

FlightControls FlightController::cascade(const FlightMeasurement& m, const FlightReference& r) {
  FlightControls controls = task_.trim.controls;
  const ControllerDesign& d = design_;
  const Triple velocity = to_earth(attitude_of(m.angles), m.velocity);
  Triple wanted;
  for (std::size_t k = 0; k < 3; ++k) wanted[k] = d.position * (r.position[k] - m.position[k]);
  const double fast = std::hypot(wanted[0], wanted[1]);
  const double share = fast > options_.max_speed ? options_.max_speed / fast : 1.0;
  wanted = {share * wanted[0], share * wanted[1], std::clamp(wanted[2], -options_.max_speed, options_.max_speed)};
  for (std::size_t k = 0; k < 3; ++k) wanted[k] += r.velocity[k];
  drive_axis(FlightAxis::climb, wanted[2], velocity[2], controls);

  // Accelerations to the north and east, by tilt; their integral is held while the tilt is at its limit.
  const double error[2] = {wanted[0] - velocity[0], wanted[1] - velocity[1]};
  double a[2];
  for (std::size_t k = 0; k < 2; ++k) {
    a[k] = d.velocity * error[k] + d.velocity * d.velocity / integral_time * velocity_integral_[k];
  }
  const double largest = standard_gravity * options_.max_tilt, size = std::hypot(a[0], a[1]);
  if (size > largest) a[0] *= largest / size, a[1] *= largest / size;
  for (std::size_t k = 0; k < 2; ++k) {
    if (size <= largest || error[k] * a[k] < 0.0) velocity_integral_[k] += step_ * error[k];
  }
  const double c = std::cos(m.angles[2]), s = std::sin(m.angles[2]);
  const double pitch = task_.trim.pitch - (c * a[0] + s * a[1]) / standard_gravity;
  const double roll = task_.trim.roll + (-s * a[0] + c * a[1]) / standard_gravity;
  drive_axis(FlightAxis::pitch, d.attitude * (pitch - m.angles[1]), m.rates[1], controls);
  drive_axis(FlightAxis::roll, d.attitude * (roll - m.angles[0]), m.rates[0], controls);
  drive_axis(FlightAxis::yaw, d.attitude * std::remainder(r.yaw - m.angles[2], two_pi) + r.yaw_rate, m.rates[2],
             controls);
  return controls;
}

}  // namespace wingbeat
