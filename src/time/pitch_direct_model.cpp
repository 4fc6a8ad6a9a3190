#include "time/pitch_direct_model.hpp"

#include "time/transient_tools.hpp"
#include "wingbeat/cycle/direct_balance.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

constexpr double stiff_pitch_decays_per_period = 500.0;

}  // namespace

PitchDirectModel::PitchDirectModel(const Vehicle<double>& v) : DrivenShaft(v), coupled(inductive ? 5 : 4) {
  validate(vehicle.pitch, vehicle.wing_count * vehicle.wing_inertia);
  start({});
}

void PitchDirectModel::start(const std::array<double, 5>& y) {
  start_ = y;
  scale_to(vehicle.voltage);
  now = {};
  std::copy(y.begin(), y.end(), now.y);
  if (!inductive) now.y[4] = 0.0;
}

void PitchDirectModel::scale_to(double highest_voltage) {
  const std::array<double, 5>& y = start_;
  const auto [stroke, speed, current] = typical_from(balance_at(highest_voltage), y[0], y[1], y[4]);
  const double psi = std::max({typical_pitch(vehicle, speed), std::abs(y[2]), std::abs(y[3]) / w});
  scale = {stroke, speed, psi, w * psi, current};
}

PitchMotion<double> PitchDirectModel::pitch_motion(double t, const double* y) const {
  const double stroke = sign_of(y[1]), velocity_psi = now.held ? 0.0 : y[3];
  return pitch_motion_on<Vehicle, double>(vehicle, vehicle.pitch, direct_kinematics<double>(),
                                          vehicle.wing_count * vehicle.spring.stiffness * y[0], y[1], current_of(t, y),
                                          voltage(t), y[2], velocity_psi, {stroke, 1.0, stroke, 1.0},
                                          {sign_of(velocity_psi), now.held ? -1.0 : 1.0});
}

bool PitchDirectModel::rates(double t, const double* y, double* dy, bool quadrature) const {
  const PitchMotion<double> m = pitch_motion(t, y);
  dy[0] = m.stroke.stroke_velocity;
  dy[1] = m.stroke.crank_acceleration;
  dy[2] = now.held ? 0.0 : y[3];
  dy[3] = m.acceleration;
  if (inductive) dy[4] = m.stroke.inductive_voltage / vehicle.motor.armature_inductance;
  if (quadrature) {
    const CycleIntegrals<double> all = integrands(m.stroke, m.stroke.stroke_velocity, branch_at(y));
    for (int k = 0; k < quadrature_count; ++k) dy[coupled + k] = all[std::size_t(quadratures[k])];
    double* other = dy + coupled + quadrature_count;
    const double c = std::cos(w * t), s = std::sin(w * t);
    other[hinge_work] = m.hinge_loss;
    other[chordwise] = m.chordwise_lift;
    other[stroke_cosine] = y[0] * c;
    other[stroke_sine] = y[0] * s;
    other[pitch_cosine] = y[2] * c;
    other[pitch_sine] = y[2] * s;
  }
  return std::isfinite(dy[1]) && std::isfinite(dy[3]) && std::isfinite(y[coupled - 1]);
}

std::array<double, PitchDirectModel::indicator_count> PitchDirectModel::indicators(double t, const double* y,
                                                                                   bool all) const {
  std::array<double, indicator_count> values = {1.0, y[1] / scale[1], now.held ? 1.0 : y[3] / scale[3], 1.0};
  if (all) values[stored_moment] = motion(t, y).stored_moment / (inertia * w * scale[1]);
  if (now.held) {
    values[stop] = side() * pitch_motion(t, y).stop_moment / (inertia * w * scale[1]);
  } else if (has_stop(vehicle.pitch.hinge)) {
    values[stop] = (vehicle.pitch.hinge.stop - std::abs(y[2])) / vehicle.pitch.hinge.stop;
  }
  return values;
}

void PitchDirectModel::resume() {
  if (!now.held && side() * now.y[2] >= vehicle.pitch.hinge.stop && side() * now.y[3] > 0.0) meet_stop();
}

void PitchDirectModel::handle(std::size_t indicator) {
  if (indicator != stop) return;
  if (now.held) now.held = false;
  else meet_stop();
}

std::optional<TransientEvent::Kind> PitchDirectModel::interrupt() {
  const double lost = now.impact_loss;
  handle(stop);
  if (now.impact_loss > lost) return TransientEvent::Kind::stop_impact;
  return std::nullopt;
}

void PitchDirectModel::other_scales(double power, double* scales) const {
  scales[hinge_work] = period * power;
  scales[chordwise] = period * vehicle.wings.air_density * vehicle.wings.s2 * square(scale[1]) + 1e-6 * power / w;
  scales[stroke_cosine] = scales[stroke_sine] = period * scale[0];
  scales[pitch_cosine] = scales[pitch_sine] = period * scale[2];
}

void PitchDirectModel::put_state(TransientResult& in) const {
  in.stroke_angle = now.y[0];
  in.crank_speed = now.y[1];
  in.pitch_angle = now.y[2];
  in.pitch_velocity = now.y[3];
  in.current = current_of(now.t, now.y);
}

void PitchDirectModel::meet_stop() {
  now.y[2] = side() * vehicle.pitch.hinge.stop;
  const StopImpact<double> impact =
      stop_impact(vehicle, vehicle.pitch, direct_kinematics<double>(), now.y[1], now.y[2], now.y[3], sign_of(now.y[1]));
  now.y[1] += impact.shaft_speed;
  now.y[3] = 0.0;
  now.impact_loss += impact.stop_work;
  const CycleIntegrals<double> at_once = wingbeat::impulses(impact);
  for (std::size_t q = 0; q < at_once.size(); ++q) now.impulses[q] += at_once[q];
  now.held = true;
  if (side() * pitch_motion(now.t, now.y).stop_moment < 0.0) now.held = false;
}

void PitchDirectModel::tolerated(double relative, const double* y, double* errors) const {
  for (int n = 0; n < coupled; ++n) errors[n] = relative * (std::abs(y[n]) + 0.01 * scale[std::size_t(n)]);
}

bool PitchDirectModel::stiff() const {
  const Motor<double>& m = vehicle.motor;
  const double damping = m.viscous_damping + vehicle.friction.damping;
  const double electrical = inductive ? m.armature_resistance / m.armature_inductance
                                      : square(m.torque_constant) / m.armature_resistance / inertia;
  const double pitching = vehicle.pitch.hinge.damping / vehicle.pitch.pitch_inertia;
  return std::max({electrical, damping / inertia, pitching}) * period > stiff_pitch_decays_per_period;
}

double PitchDirectModel::stored_energy() const {
  const double* y = now.y;
  const PitchState<double> state = pitch_state(y[2], y[3], y[1]);
  return kinetic_energy(pitch_inertia(vehicle.pitch, inertia, state), state) +
         0.5 * vehicle.wing_count * vehicle.spring.stiffness * square(y[0]) +
         hinge_loads(vehicle.pitch.hinge, y[2], y[3]).energy +
         0.5 * vehicle.motor.armature_inductance * square(current_of(now.t, y));
}

}  // namespace wingbeat::detail
