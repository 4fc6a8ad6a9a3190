#include <cmath>
#include <memory>

#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/dynamics.hpp"
#include "wingbeat/wingbeat.hpp"

namespace wingbeat {

EquationsOfMotion::EquationsOfMotion(const Design<double>& design, Condition condition)
    : supply_(design.supply), direct_(drive_of(design).alternating) {
  validate(design);
  vehicle_ = std::make_shared<const Vehicle<double>>(in_settled_air(switched_on(resolve(design, condition))));
  inductive_ = has_current_state(*vehicle_);
  state_count_ = UnknownIndices(*vehicle_).count;
}

void EquationsOfMotion::rates(double time, const double* state, double* derivatives,
                              std::optional<double> voltage) const {
  const Vehicle<double>& vehicle = *vehicle_;
  if (!voltage) {
    voltage = direct_ ? vehicle.voltage_offset + vehicle.voltage * std::sin(two_pi * vehicle.drive_frequency * time)
                      : voltage_at(supply_, time);
  }
  const UnknownIndices indices(vehicle);
  Mode<double> mode;
  mode.direction = sign_of(state[1]);
  PitchMotion<double> m;
  mode.turn = sign_of(indices.pitching ? state[indices.pitch + 1] : 0.0);
  const Coordinates<double> c = indices.coordinates(state);
  if (!inductive_) mode = with_bridge(vehicle, *voltage, c.speed, mode);
  const FullState<double> instant = instant_at(vehicle, c, {*voltage}, mode);
  mode_at(vehicle, instant, mode, &m);
  indices.unknowns(rates_of(vehicle, c, instant, m), derivatives);
}

}  // namespace wingbeat
