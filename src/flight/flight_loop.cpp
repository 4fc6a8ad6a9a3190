#include "flight/flight_loop.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"

namespace wingbeat::detail {

SensorSet::SensorSet(const FlightSensors& sensors, double average)
    : sensors_(sensors), average_(average), noise_(sensors.seed) {}

void SensorSet::sample(double time, const BodyState& body) {
  Sample s{time, {body.position, body.velocity, euler_angles(body.attitude), body.rates}};
  const auto add = [&](Triple& vector, double deviation) {
    for (double& x : vector) x += deviation * noise_.next();
  };
  add(s.seen.position, sensors_.position);
  add(s.seen.velocity, sensors_.velocity);
  add(s.seen.angles, sensors_.attitude);
  add(s.seen.rates, sensors_.rates);
  samples_.push_back(s);
}

FlightMeasurement SensorSet::measured(double time) {
  constexpr double rounding = 1e-9;
  // Over a whole wingbeat its two ends count once.
  const double newest = time - sensors_.delay + rounding, oldest = newest - average_ + rounding;
  // The last one before the averaging time stays where there is none within it.
  while (samples_.size() > 1 && samples_[1].time <= newest && samples_[0].time <= oldest) samples_.pop_front();
  FlightMeasurement mean = samples_.front().seen;
  const double yaw = mean.angles[2];
  double count = 1.0;
  for (std::size_t n = 1; n < samples_.size() && samples_[n].time <= newest; ++n) {
    const FlightMeasurement& seen = samples_[n].seen;
    count += 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle = k == 2 ? yaw + std::remainder(seen.angles[k] - yaw, two_pi) : seen.angles[k];
      mean.position[k] += (seen.position[k] - mean.position[k]) / count;
      mean.velocity[k] += (seen.velocity[k] - mean.velocity[k]) / count;
      mean.angles[k] += (angle - mean.angles[k]) / count;
      mean.rates[k] += (seen.rates[k] - mean.rates[k]) / count;
    }
  }
  return mean;
}

FlightControls ActuatorSet::follow(const FlightControls& command) {
  FlightControls mean;
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    double target = command.at[k];
    if (const double limit = actuators_.rate_limit[k] * step_; limit > 0.0) {
      target = std::clamp(target, at_.at[k] - limit, at_.at[k] + limit);
    }
    const double lag = actuators_.time_constant[k], gap = at_.at[k] - target;
    if (lag > 0.0) {
      const double reached = -std::expm1(-step_ / lag);
      mean.at[k] = target + gap * reached * lag / step_;
      at_.at[k] = target + gap * (1.0 - reached);
    } else {
      mean.at[k] = at_.at[k] = target;
    }
  }
  return mean;
}

BatteryInFlight::BatteryInFlight(const FlightVehicle& vehicle) {
  const Supply<double>& supply = vehicle.drives[0].supply;
  there_ = has_battery(supply.type);
  bridge_ = supply.type == SupplyType::battery_sine;
  battery_ = supply.battery;
  charge_ = battery_.charge;
}

double BatteryInFlight::available() const {
  const double E = open_circuit_voltage(battery_, charge_);
  // Behind a speed control the resistance is part of the drive's circuit.
  return bridge_ ? E - battery_.cells * battery_.internal_resistance * current_ : E;
}

void BatteryInFlight::use(double time, double energy) {
  if (!there_ || ended_ || !(time > 0.0)) return;
  const double E = open_circuit_voltage(battery_, charge_), R = battery_.cells * battery_.internal_resistance;
  const double P = energy / time, root = E * E - 4.0 * R * P;
  current_ = root > 0.0 ? 2.0 * P / (E + std::sqrt(root)) : 0.5 * E / R;
  given_ += E * current_ * time;
  charge_ = std::min(1.0, charge_ - current_ * time / battery_.capacity);
  const double terminal = (E - R * current_) / battery_.cells;
  ended_ = charge_ <= 0.0 || root <= 0.0 || (battery_.cutoff_voltage && terminal <= *battery_.cutoff_voltage);
  charge_ = std::max(charge_, 0.0);
}

FlightControls BatteryInFlight::within(FlightControls controls) const {
  if (!there_) return controls;
  const double largest = available();
  double& mean = controls[FlightControl::voltage];
  double& difference = controls[FlightControl::voltage_difference];
  mean = std::min(mean, largest);
  difference = std::clamp(difference, -(largest - mean), largest - mean);
  return controls;
}

double tilt_of(const BodyState& body) {
  const Triple axis = to_earth(body.attitude, {0.0, 0.0, 1.0});
  return std::acos(std::clamp(axis[2], -1.0, 1.0));
}

}  // namespace wingbeat::detail
