#include "fmu/body_in_time.hpp"

#include <utility>

namespace wingbeat::fmu {
namespace {

FlightVehicle in_order(FlightVehicle vehicle) {
  if (vehicle.drives.size() == 2) std::swap(vehicle.drives[0], vehicle.drives[1]);
  return vehicle;
}

}  // namespace

BodyInTime::BodyInTime(const Design<double>& design) : vehicle_(in_order(flight_vehicle(design))) {
  for (const FlightDrive& drive : vehicle_.drives) flows_.push_back(std::make_shared<OnsetFlow>(drive.flow));
  start();
}

void BodyInTime::build(const Design<double>& design) { vehicle_ = in_order(flight_vehicle(design)); }

void BodyInTime::connect(Drives& drives) const {
  set_flows(state);
  for (std::size_t n = 0; n < drives.size(); ++n) {
    drives[n]->feel(flows_[n], vehicle_.drives[n].vehicle.wings.wake.strips);
  }
}

void BodyInTime::start() {
  state = {};
  const BodySettings& s = settings;
  state.position = {s.position_x, s.position_y, s.position_z};
  state.velocity = {s.velocity_x, s.velocity_y, s.velocity_z};
  state.attitude = attitude_of({s.roll, s.pitch, s.yaw});
  state.rates = {s.rate_x, s.rate_y, s.rate_z};
}

void BodyInTime::set_flows(const BodyState& body) const {
  detail::set_flows(flows_, body, {inputs.wind_x, inputs.wind_y, inputs.wind_z});
  FlightControls controls;
  controls[FlightControl::mean_stroke_angle] = inputs.mean_stroke_angle;
  controls[FlightControl::stroke_plane_difference] = inputs.stroke_plane_difference;
  controls[FlightControl::incidence_difference] = inputs.incidence_difference;
  for (std::size_t n = 0; n < flows_.size(); ++n) set_mounts(vehicle_.drives[n], controls, *flows_[n]);
}

detail::AirOnBody BodyInTime::air_now(const Drives& drives) const {
  std::array<const Vehicle<double>*, detail::max_flight_drives> vehicles{};
  for (std::size_t n = 0; n < drives.size(); ++n) vehicles[n] = &drives[n]->vehicle();
  return air_of(state, vehicles, [&](std::size_t n) { return drives[n]->instant_now(); });
}

std::array<double, body_output_count> BodyInTime::outputs(const detail::AirOnBody& air) const {
  std::array<double, body_output_count> values{};
  std::size_t n = 0;
  const auto add = [&](const auto& list) {
    for (const double x : list) values[n++] = x;
  };
  add(state.position), add(state.velocity), add(state.rates), add(state.attitude), add(euler_angles(state.attitude));
  add(air.loads.force), add(air.loads.moment);
  for (std::size_t k = 0; k < 3; ++k) {
    values[n] += air.loads.force[k] * state.velocity[k] + air.loads.moment[k] * state.rates[k];
  }
  return values;
}

std::vector<double> BodyInTime::numbers() const {
  std::vector<double> all;
  BodyState::each(state, [&](const double& x) { all.push_back(x); });
  return all;
}

void BodyInTime::set_numbers(const double* y) {
  BodyState::each(state, [&](double& x) { x = *y++; });
}

}  // namespace wingbeat::fmu
