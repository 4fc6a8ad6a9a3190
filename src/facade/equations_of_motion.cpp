#include <cmath>
#include <memory>

#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/dynamics.hpp"
#include "wingbeat/wingbeat.hpp"

namespace wingbeat {

EquationsOfMotion::EquationsOfMotion(const Design<double>& design, Condition condition)
    : supply_(design.supply), direct_(drive_of(design).alternating) {
  validate(design);
  vehicle_ = std::make_shared<const Vehicle<double>>(switched_on(resolve(design, condition)));
  inductive_ = has_current_state(*vehicle_);
  pitching_ = pitches(*vehicle_);
}

void EquationsOfMotion::rates(double time, const double* state, double* derivatives,
                              std::optional<double> voltage) const {
  const Vehicle<double>& vehicle = *vehicle_;
  if (!voltage) {
    voltage = direct_ ? vehicle.voltage * std::sin(two_pi * vehicle.drive_frequency * time) : voltage_at(supply_, time);
  }
  const UnknownIndices indices(vehicle);
  Mode<double> mode;
  mode.direction = sign_of(state[1]);
  PitchMotion<double> m;
  mode_at(vehicle, instant_at(vehicle, indices.coordinates(state), *voltage, mode), mode, &m);
  derivatives[0] = state[1];
  derivatives[1] = m.crank_acceleration;
  if (inductive_) derivatives[indices.current] = m.inductive_voltage / vehicle.motor.armature_inductance;
  if (!pitching_) return;
  derivatives[indices.pitch] = state[indices.pitch + 1];
  derivatives[indices.pitch + 1] = m.pitch_acceleration;
}

}  // namespace wingbeat
