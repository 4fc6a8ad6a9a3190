#include "time/time_model.hpp"

#include <algorithm>
#include <cmath>

#include "time/transient_tools.hpp"
#include "wingbeat/cycle/direct_balance.hpp"

namespace wingbeat::detail {
namespace {

// A cycle holds some hundred steps of Adams at usual tolerances; only if the fastest decay is much quicker than that do
// the larger steps of BDF make up for its lower order.
constexpr double stiff_decays_per_cycle = 500.0;

Supply<double> supply_in_time(const Vehicle<double>& vehicle, const Supply<double>& supply) {
  if (!drive_of(vehicle).rotates) {
    return {SupplyType::sine, vehicle.voltage, vehicle.drive_frequency, 1.0, {}, vehicle.voltage_offset};
  }
  // The bridge of a brushless motor switches by itself, about the mean voltage.
  const bool steady_pwm = supply.type == SupplyType::pwm &&
                          (supply.duty <= 0.0 || supply.duty >= 1.0 || limits_current(vehicle.electronics));
  if (steady_pwm || supply.type == SupplyType::battery) {
    return {SupplyType::constant, mean_voltage(supply), 0.0, 1.0};
  }
  return supply;
}

}  // namespace

TimeModel::TimeModel(const Vehicle<double>& v, const Supply<double>& on)
    : vehicle(v),
      supply(supply_in_time(v, on)),
      indices(v),
      coupled(int(indices.count)),
      direct(!drive_of(v).rotates),
      force_matters(force_has_branches(v)),
      wings_pitch(pitches(v)),
      further(is_of_further_kind(v)),
      jumps_(jumps_at_rest(v)),
      jumps_at_bound_(jumps_at_pitch_stop(v)) {
  if (is_given(vehicle.piezo)) validate(vehicle.piezo);
  else validate(vehicle.motor);
  if (!direct) validate(vehicle.transmission);
  validate(vehicle.friction);
  validate(vehicle.spring);
  validate(vehicle.wings);
  if (direct) {
    require(vehicle.voltage >= 0.0, "supply.amplitude", "must be >= 0", "V", vehicle.voltage);
    require(vehicle.drive_frequency > 0.0, "supply.frequency", "must be > 0", "Hz", vehicle.drive_frequency);
  } else {
    validate(on);
    require(vehicle.wing_count >= 0.0, "wing.count", "must be >= 0", "1", vehicle.wing_count);
    require(vehicle.wing_inertia >= 0.0, "wing.inertia", "must be >= 0", "kg m2", vehicle.wing_inertia);
    require(vehicle.source_resistance >= 0.0, "supply.internal_resistance", "must be >= 0", "ohm",
            vehicle.source_resistance);
    vehicle.voltage = mean_voltage(on);
  }
  if (wings_pitch) validate(vehicle.pitch, vehicle.wing_count * vehicle.wing_inertia);
}

void TimeModel::start(const Coordinates<double>& from) {
  now = {};
  now.moving = from;
  indices = UnknownIndices(vehicle);
  coupled = int(indices.count);
  wings_pitch = pitches(vehicle);
  further = is_of_further_kind(vehicle);
  jumps_at_bound_ = jumps_at_pitch_stop(vehicle);
  wingless = vehicle.wing_count * vehicle.wing_inertia == 0.0 && vehicle.wing_count * vehicle.spring.stiffness == 0.0 &&
             vehicle.wings.air_density * vehicle.wings.s3 == 0.0;
  constant_friction = breakaway_torque(vehicle);
  now.switched_voltage = supply.voltage;
  start_ = from;
  if (!indices.inductive) {
    start_.current = 0.0;
    now.moving.current = current_now();
  }
  if (is_clamped(vehicle.pitch.hinge)) now.held = true;
  if (jumps_at_bound_) {
    double y[max_unknowns];
    unknowns(y);
    now.pitching = sign_of(pitch_margin_at(y));
  }
  find_jams();
  scale_to(supply.voltage);
  now.jammed = !wingless && uniqueness_now() <= smallest_margin;
  if (indices.pitching && has_friction(vehicle.pitch.hinge)) {
    now.turn = sign_of(from.pitch_velocity);
    if (from.pitch_velocity == 0.0 && !now.jammed) now.held = true;  // begin_piece() decides
  }
}

void TimeModel::scale_to(double highest_voltage) {
  const Motor<double>& m = vehicle.motor;
  const double R = circuit_resistance(vehicle);
  electrical_time = is_given(vehicle.piezo) ? 0.0 : m.armature_inductance / R;
  drive_period = supply.type == SupplyType::constant ? 0.0 : 1.0 / supply.frequency;
  if (direct) scale_direct(highest_voltage);
  else scale_crank(highest_voltage);
  const double damping = m.viscous_damping + vehicle.friction.damping;
  if (is_given(vehicle.piezo)) {
    fastest_decay = vehicle.piezo.damping / vehicle.piezo.mass;
  } else {
    fastest_decay = indices.inductive ? std::max(1.0 / electrical_time, damping / smallest_inertia)
                                      : (damping + square(m.torque_constant) / R) / smallest_inertia;
  }
}

void TimeModel::scale_crank(double highest_voltage) {
  const Motor<double>& m = vehicle.motor;
  const double R = circuit_resistance(vehicle), K = m.torque_constant, omega = start_.speed;
  const double damping = m.viscous_damping + vehicle.friction.damping;
  current_scale = highest_voltage / R;
  speed_scale = K * highest_voltage / (K * K + R * damping);
  if (vehicle.friction.quadratic > 0.0) {
    speed_scale = std::min(speed_scale, std::sqrt(K * current_scale / vehicle.friction.quadratic));
  }
  if (!(speed_scale > 0.0)) speed_scale = omega != 0.0 ? std::abs(omega) : 1.0;
  if (!(current_scale > 0.0)) current_scale = std::max(std::abs(start_.current), K * speed_scale / R);
  const double slope = typical_stroke_slope(vehicle.transmission);
  const double wings = vehicle.wing_count * vehicle.wing_inertia * square(slope);
  mechanical_time = (m.inertia + wings) * R / (K * K + R * m.viscous_damping);
  time_scale = two_pi / speed_scale;
  torque_scale = K * current_scale;
  force_scale = (m.inertia + wings) * torque_scale / slope;
  if (!wings_pitch) return;
  pitch_scale = std::max({typical_pitch(vehicle, slope * speed_scale, speed_scale), std::abs(start_.pitch_angle),
                          std::abs(start_.twist_angle), std::abs(start_.pitch_velocity) / speed_scale,
                          std::abs(start_.twist_velocity) / speed_scale});
  pitch_velocity_scale = speed_scale * pitch_scale;
}

void TimeModel::scale_direct(double highest_voltage) {
  const Motor<double>& m = vehicle.motor;
  Vehicle<double> at_highest = vehicle;
  at_highest.voltage = highest_voltage;
  const DirectBalance balance = direct_balance(at_highest);
  drive_torque = balance.drive_torque;
  time_scale = 1.0 / vehicle.drive_frequency;
  const double w = two_pi * vehicle.drive_frequency, inertia = smallest_inertia,
               from_rest = start_.angle - vehicle.spring.rest_angle;
  const double beta = std::abs(from_rest);
  const double natural = std::max(w, std::sqrt(vehicle.wing_count * vehicle.spring.stiffness / inertia));
  speed_scale = balance.responses.empty()
                    ? std::max(0.0, balance.drive_torque - balance.breakaway_torque) / (inertia * w)
                    : std::abs(balance.responses.back().speed);
  speed_scale = std::max({speed_scale, std::abs(start_.speed), beta * natural});
  if (!(speed_scale > 0.0)) speed_scale = 1.0;
  angle_scale = std::max(speed_scale / natural, beta);
  torque_scale = balance.drive_torque;
  current_scale = std::max(typical_current(at_highest, balance), std::abs(start_.current));
  if (is_given(vehicle.piezo)) {
    // Without capacitance, and where constant friction leaves no harmonic response, the typical current is 0.
    const double charge_rate = vehicle.piezo.force_per_volt * speed_scale / vehicle.piezo.transmission_ratio;
    current_scale = std::max(current_scale, 1e-3 * charge_rate);
  } else {
    current_scale = std::max(current_scale, 1e-3 * m.torque_constant * speed_scale / m.armature_resistance);
    torque_scale = m.torque_constant * current_scale;
    mechanical_time = inertia * circuit_resistance(vehicle) /
                      (square(m.torque_constant) + circuit_resistance(vehicle) * m.viscous_damping);
  }
  if (!(torque_scale > 0.0)) torque_scale = inertia * w * speed_scale;
  force_scale = inertia * torque_scale;
  if (!wings_pitch) return;
  pitch_scale =
      std::max({typical_pitch(vehicle, speed_scale), std::abs(start_.pitch_angle), std::abs(start_.twist_angle),
                std::abs(start_.pitch_velocity) / w, std::abs(start_.twist_velocity) / w});
  pitch_velocity_scale = w * pitch_scale;
}

SupplyMoment<double> TimeModel::supply_at(double t) const {
  if (!is_given(vehicle.piezo)) return {voltage(t)};
  if (command) {
    const double span = 1e-6 * time_scale;
    return {command(t), (command(t + span) - command(t - span)) / (2.0 * span)};
  }
  const double w = two_pi * supply.frequency;
  return {voltage(t), supply.voltage * w * std::cos(w * t)};
}

FullState<double> TimeModel::instant(double t, const Coordinates<double>& place) const {
  const SupplyMoment<double> moment = supply_at(t);
  Mode<double> here = mode();
  if (!indices.inductive && limits_current(vehicle.electronics)) {
    here = with_bridge(vehicle, moment.voltage, here.slip < 0.0 ? 0.0 : place.speed, here);
  }
  return instant_at(vehicle, place, moment, here);
}

double TimeModel::current_now() const {
  double y[max_unknowns];
  unknowns(y);
  return current_of(now.t, y);
}

Mode<double> TimeModel::mode() const {
  Mode<double> mode;
  mode.direction = now.direction;
  mode.force = now.force;
  mode.turn = now.turn;
  mode.pitching = now.pitching;
  if (now.held) mode.held = -1.0;
  if (now.stuck) mode.slip = -1.0;
  if (now.blocked) mode.bridge = -1.0;
  if (now.limited) mode.limit = -1.0;
  return mode;
}

PitchMotion<double> TimeModel::motion(double t, const double* y, Mode<double>* used) const {
  PitchMotion<double> m;
  const Mode<double> mode = on_force_branch(vehicle, instant(t, y), this->mode(), &m);
  if (used) *used = mode;
  return m;
}

PitchMotion<double> TimeModel::motion_now() const {
  double y[max_unknowns];
  unknowns(y);
  PitchMotion<double> m = motion(now.t, y);
  if (now.stuck && wingless) m.rod_force = 0.0;
  return m;
}

bool TimeModel::rates(double t, const double* y, double* dy, bool quadrature) const {
  Mode<double> mode;
  const Coordinates<double> place = indices.coordinates(y);
  const FullState<double> here = instant(t, place);
  PitchMotion<double> m;
  mode = on_force_branch(vehicle, here, this->mode(), &m);
  indices.unknowns(rates_of(vehicle, place, here, m), dy);
  if (quadrature) {
    const CycleIntegrals<double> all = integrands<double>(m, dy[0], mode);
    for (int k = 0; k < quadrature_count; ++k) dy[coupled + k] = all[std::size_t(quadratures[k])];
  }
  bool finite = std::isfinite(y[coupled - 1]);
  for (std::size_t n = 1; n < indices.count; ++n) finite = finite && std::isfinite(dy[n]);
  return finite;
}

double TimeModel::motor_energy() const {
  return 0.5 * (vehicle.motor.inertia * square(now.moving.speed) +
                vehicle.motor.armature_inductance * square(now.moving.current));
}

double TimeModel::current_slope(double t, const double* y, const double* rates) const {
  if (now.blocked || now.limited) return 0.0;
  const Motor<double>& m = vehicle.motor;
  const double R = circuit_resistance(vehicle);
  if (indices.inductive) return (voltage(t) - R * y[2] - m.torque_constant * y[1]) / m.armature_inductance;
  const double angular = two_pi * supply.frequency;
  const double voltage_slope = supply.type == SupplyType::sine ? supply.voltage * angular * std::cos(angular * t) : 0.0;
  return (voltage_slope - m.torque_constant * rates[1]) / R;
}

double TimeModel::rotor_inertia() const {
  return has_gear_loss(vehicle.motor) ? vehicle.motor.gear_efficiency * vehicle.motor.inertia : vehicle.motor.inertia;
}

/// Nearest crank angles on either side of the start that the crank cannot pass.
void TimeModel::find_jams() {
  smallest_inertia = vehicle.motor.inertia;
  if (direct) {
    smallest_inertia += vehicle.wing_count * vehicle.wing_inertia;
    return;
  }
  if (wingless) return;
  const double least = static_balance(vehicle).inertia_min / vehicle.motor.inertia;
  smallest_inertia *= std::clamp(least, 1e-3, 1.0);
  // Of wings that pitch it depends on how they stand: indicators() looks at that.
  if (wings_pitch) return;
  const JamAngles jams = nearest_jams(vehicle, now.moving.angle, smallest_margin);
  jam_below = jams.below;
  jam_above = jams.above;
}

double TimeModel::uniqueness_at(const double* y) const {
  if (direct) return 1.0;
  if (!wings_pitch) return uniqueness(vehicle, y[0]);
  const CrankKinematics<double> k = kinematics(y[0]);
  const double lever = k.wing_jacobian / typical_lever(vehicle.transmission);
  if (!(lever > 0.0)) return lever;
  const double inertia = wings_standing(vehicle, instant(now.t, y), mode()).inertia;
  const double A = inertia * k.stroke_slope / k.wing_jacobian, radius = vehicle.friction.radius;
  const double least = rotor_inertia() + std::min(A * (k.crank_jacobian + radius), A * (k.crank_jacobian - radius));
  return std::min(lever, least / vehicle.motor.inertia);
}

double TimeModel::uniqueness_now() const {
  double y[max_unknowns];
  unknowns(y);
  return uniqueness_at(y);
}

double TimeModel::least_inertia_now() const {
  if (!wings_pitch) return min_inertia(vehicle, kinematics(now.moving.angle));
  return uniqueness_now() * vehicle.motor.inertia;
}

void TimeModel::unknowns(double* y) const { indices.unknowns(now.moving, y); }

std::array<double, max_unknowns> TimeModel::coordinates_now() const {
  std::array<double, max_unknowns> y{};
  indices.unknowns(now.moving, y.data());
  return y;
}

void TimeModel::set(double t, const double* y) {
  now.t = t;
  now.moving = indices.coordinates(y);
  if (!indices.inductive) now.moving.current = current_of(t, y);
}

Coordinates<double> TimeModel::typical_coordinates() const {
  const double ratio = is_given(vehicle.piezo) ? vehicle.piezo.transmission_ratio : 1.0;
  return {.angle = angle_scale,
          .speed = speed_scale,
          .current = current_scale,
          .pitch_angle = pitch_scale,
          .pitch_velocity = pitch_velocity_scale,
          .twist_angle = pitch_scale,
          .twist_velocity = pitch_velocity_scale,
          .tip = angle_scale / ratio,
          .tip_velocity = speed_scale / ratio};
}

std::array<double, max_unknowns> TimeModel::typical() const {
  std::array<double, max_unknowns> sizes;
  sizes.fill(1.0);
  indices.unknowns(typical_coordinates(), sizes.data());
  return sizes;
}

void TimeModel::tolerated(double relative, const double* y, double* errors) const {
  const auto sizes = typical();
  for (std::size_t n = 0; n < indices.count; ++n) errors[n] = relative * (std::abs(y[n]) + 0.01 * sizes[n]);
  // The crank angle grows for ever: its admissible error must not grow with it.
  if (!direct) errors[0] = relative;
}

double TimeModel::longest_step() const {
  // Of a shaft that stands, no slip may hide within a step.
  const bool slips = now.stuck && supply.type == SupplyType::sine;
  return slips ? std::min(drive_period / 64.0, longest_moving_step()) : longest_moving_step();
}

double TimeModel::longest_moving_step() const { return time_scale / (direct && (wings_pitch || further) ? 16.0 : 4.0); }

bool TimeModel::stiff() const {
  const double span = drive_period > 0.0 ? std::min(time_scale, drive_period) : time_scale;
  const double pitch_decay =
      wings_pitch ? std::max(vehicle.pitch.hinge.damping, vehicle.pitch.torsion.damping) / vehicle.pitch.pitch_inertia
                  : 0.0;
  return std::max(fastest_decay, pitch_decay) * span > stiff_decays_per_cycle;
}

double TimeModel::next_switch() const {
  if (supply.type != SupplyType::pwm || command) return infinity;
  // Even switches turn on, odd ones off; number 0 is the switching on at t = 0.
  const std::int64_t next = now.switches + 1;
  const bool off = (next & 1) != 0;
  const std::int64_t whole_periods = (next - (off ? 1 : 0)) / 2;
  return (double(whole_periods) + (off ? supply.duty : 0.0)) / supply.frequency;
}

void TimeModel::switch_supply() {
  ++now.switches;
  now.switched_voltage = now.switches % 2 == 0 ? supply.voltage : 0.0;
  if (!indices.inductive) now.moving.current = current_now();
}

void TimeModel::catch_up_with_supply() {
  if (supply.type != SupplyType::pwm || command) return;
  now.switches = 2 * std::int64_t(std::floor(now.t * supply.frequency));
  now.switched_voltage = supply.voltage;
  while (next_switch() <= now.t) switch_supply();
}

}  // namespace wingbeat::detail
