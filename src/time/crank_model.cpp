#include "time/crank_model.hpp"

#include <algorithm>
#include <cmath>

#include "time/transient_tools.hpp"
#include "wingbeat/cycle/direct_balance.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

// A cycle holds some hundred steps of Adams at usual tolerances; only if the fastest decay is much quicker than that do
// the larger steps of BDF make up for its lower order.
constexpr double stiff_decays_per_cycle = 500.0;

}  // namespace

CrankModel::CrankModel(const Vehicle<double>& v, const Supply<double>& on) : vehicle(v), supply(on) {
  validate(vehicle.motor);
  validate(vehicle.transmission);
  validate(vehicle.friction);
  validate(vehicle.spring);
  validate(vehicle.wings);
  validate(supply);
  require(vehicle.wing_count >= 0.0, "wing.count", "must be >= 0", "1", vehicle.wing_count);
  require(vehicle.wing_inertia >= 0.0, "wing.inertia", "must be >= 0", "kg m2", vehicle.wing_inertia);
  require(vehicle.source_resistance >= 0.0, "supply.internal_resistance", "must be >= 0", "ohm",
          vehicle.source_resistance);
  pitching = pitches(vehicle);
  if (pitching) validate(vehicle.pitch, vehicle.wing_count * vehicle.wing_inertia);
  vehicle.voltage = mean_voltage(supply);
  const bool steady_pwm = supply.type == SupplyType::pwm && (supply.duty <= 0.0 || supply.duty >= 1.0);
  if (steady_pwm || supply.type == SupplyType::battery) supply = {SupplyType::constant, vehicle.voltage, 0.0, 1.0};
}

void CrankModel::start(double theta, double omega, double current, double psi, double pitch_velocity) {
  now = {};
  now.theta = theta;
  now.omega = omega;
  inductive = has_current_state(vehicle);
  coupled = (inductive ? 3 : 2) + (pitching ? 2 : 0);
  now.psi = psi;
  now.pitch_velocity = pitch_velocity;
  wingless = vehicle.wing_count * vehicle.wing_inertia == 0.0 && vehicle.wing_count * vehicle.spring.stiffness == 0.0 &&
             vehicle.wings.air_density * vehicle.wings.s3 == 0.0;
  constant_friction = breakaway_torque(vehicle);
  now.switched_voltage = supply.voltage;
  now.i = inductive ? current : algebraic_current(vehicle, voltage(0.0), omega);
  start_speed_ = omega;
  start_current_ = inductive ? current : 0.0;
  start_pitch_ = psi;
  start_pitch_velocity_ = pitch_velocity;
  find_jams();
  scale_to(supply.voltage);
  now.jammed = !wingless && uniqueness_now() <= smallest_margin;
}

void CrankModel::scale_to(double highest_voltage) {
  const Motor<double>& m = vehicle.motor;
  const double R = circuit_resistance(vehicle), K = m.torque_constant, omega = start_speed_;
  const double damping = m.viscous_damping + vehicle.friction.damping;
  current_scale = highest_voltage / R;
  speed_scale = K * highest_voltage / (K * K + R * damping);
  if (vehicle.friction.quadratic > 0.0) {
    speed_scale = std::min(speed_scale, std::sqrt(K * current_scale / vehicle.friction.quadratic));
  }
  if (!(speed_scale > 0.0)) speed_scale = omega != 0.0 ? std::abs(omega) : 1.0;
  if (!(current_scale > 0.0)) current_scale = std::max(std::abs(start_current_), K * speed_scale / R);
  const double wings = vehicle.wing_count * vehicle.wing_inertia * square(typical_stroke_slope(vehicle.transmission));
  electrical_time = m.armature_inductance / R;
  mechanical_time = (m.inertia + wings) * R / (K * K + R * m.viscous_damping);
  drive_period = supply.type == SupplyType::constant ? 0.0 : 1.0 / supply.frequency;
  time_scale = two_pi / speed_scale;
  force_scale = (m.inertia + wings) * K * current_scale / typical_stroke_slope(vehicle.transmission);
  if (pitching) {
    const double slope = typical_stroke_slope(vehicle.transmission);
    pitch_scale = std::max({typical_pitch(vehicle, slope * speed_scale, speed_scale), std::abs(start_pitch_),
                            std::abs(start_pitch_velocity_) / speed_scale});
    pitch_velocity_scale = speed_scale * pitch_scale;
  }
  fastest_decay = inductive ? std::max(1.0 / electrical_time, damping / smallest_inertia)
                            : (damping + K * K / R) / smallest_inertia;
}

Motion<double> CrankModel::motion(double t, const double* y, Branch<double>* used) const {
  if (pitching) return pitch_motion(t, y, used).stroke;
  const CrankKinematics<double> k = kinematics(y[0]);
  const double stroke_velocity = k.stroke_slope * y[1];
  Branch<double> branch = now.branch;
  branch.stroke = sign_of(stroke_velocity);
  branch.pitching = sign_of(pitch_margin(vehicle.wings, std::abs(stroke_velocity)));
  const double i = current_of(t, y), v_t = terminal_voltage(vehicle, voltage(t), i);
  const double N_k_beta = spring_moment(vehicle, k);
  const auto on_branch = [&] {
    const IntermediateTerms<double> terms =
        terms_at(vehicle, k, N_k_beta, y[1], i, v_t, branch.stroke, branch.direction, branch.pitching, branch.gear);
    return motion_on(vehicle, terms, i, v_t, branch);
  };
  branch.gear = 1.0;
  Motion<double> m = on_branch();
  if (m.gear_torque < 0.0) {
    branch.gear = -1.0;
    m = on_branch();
  }
  if (used) *used = branch;
  return m;
}

Motion<double> CrankModel::motion_now() const {
  double y[5];
  unknowns(y);
  Motion<double> m = motion(now.t, y);
  if (!now.stuck) return m;
  m.crank_acceleration = m.stroke_acceleration = 0.0;
  m.stored_moment = spring_moment(vehicle, m.kinematics);
  double moment = m.stored_moment;
  if (pitching) {
    const WingsAtPitch<double> wings = wings_standing(y);
    m.aero.lift = standing_lift(y, wings);
    moment += wings.moment;
  }
  m.rod_force = wingless ? 0.0 : moment / m.kinematics.wing_jacobian;
  m.motor_torque = vehicle.motor.torque_constant * m.current;
  m.friction_torque = m.motor_torque - m.rod_force * m.kinematics.crank_jacobian - vehicle.load_torque;
  return m;
}

bool CrankModel::rates(double t, const double* y, double* dy, bool quadrature) const {
  if (now.stuck) {
    dy[0] = dy[1] = 0.0;
    if (inductive) dy[2] = (voltage(t) - circuit_resistance(vehicle) * y[2]) / vehicle.motor.armature_inductance;
    if (!pitching) return true;
    const WingsAtPitch<double> wings = wings_standing(y);
    const CrankKinematics<double> k = kinematics(y[0]);
    dy[pitch_at()] = now.held ? 0.0 : y[pitch_at() + 1];
    dy[pitch_at() + 1] = wings.free_acceleration;
    const double i = current_of(t, y);
    for (int n = 0; quadrature && n < quadrature_count; ++n) {
      double& rate = dy[coupled + n] = 0.0;
      switch (quadratures[n]) {
        case Integral::current: rate = i; break;
        case Integral::current_square: rate = square(i); break;
        case Integral::electrical_work: rate = i * terminal_voltage(vehicle, voltage(t), i); break;
        case Integral::rod_force: rate = std::abs(spring_moment(vehicle, k) + wings.moment) / k.wing_jacobian; break;
        case Integral::aero_work: rate = wings.aero.power; break;
        case Integral::lift: rate = standing_lift(y, wings); break;
        default: break;
      }
    }
    return true;
  }
  Branch<double> branch;
  Motion<double> m;
  if (pitching) {
    const PitchMotion<double> all = pitch_motion(t, y, &branch);
    m = all.stroke;
    dy[pitch_at()] = now.held ? 0.0 : y[pitch_at() + 1];
    dy[pitch_at() + 1] = all.acceleration;
  } else {
    m = motion(t, y, &branch);
  }
  dy[0] = y[1];
  dy[1] = m.crank_acceleration;
  if (inductive) dy[2] = m.inductive_voltage / vehicle.motor.armature_inductance;
  if (quadrature) {
    const CycleIntegrals<double> all = integrands(m, y[1], branch);
    for (int k = 0; k < quadrature_count; ++k) dy[coupled + k] = all[std::size_t(quadratures[k])];
  }
  return std::isfinite(dy[1]) && std::isfinite(y[coupled - 1]);
}

double CrankModel::static_force(const CrankKinematics<double>& k) const {
  if (wingless) return 0.0;
  return wingbeat::static_rod_force(k, spring_moment(vehicle, k));
}

/// K i - F_s h - T_x [N m]: what would turn the crank at rest. Behind a gearbox that loses torque, from the middle of
/// the standing torques.
double CrankModel::net_static_torque(double theta, double i) const {
  if (has_gear_loss(vehicle.motor)) {
    const StandingTorques<double> torques = standing_torques(theta);
    return vehicle.motor.torque_constant * i - 0.5 * (torques.low + torques.high);
  }
  const CrankKinematics<double> k = kinematics(theta);
  return vehicle.motor.torque_constant * i - static_force(k) * k.crank_jacobian - vehicle.load_torque;
}

/// mu r_e |F_s| + T_c [N m]: what friction, and the gearbox with it, can hold at rest.
double CrankModel::holding_torque(double theta) const {
  if (has_gear_loss(vehicle.motor)) {
    const StandingTorques<double> torques = standing_torques(theta);
    return 0.5 * (torques.high - torques.low);
  }
  return wingbeat::holding_torque(vehicle, static_force(kinematics(theta)));
}

/// Torques of the motor [N m] between which the crank stands.
StandingTorques<double> CrankModel::standing_torques(double theta) const {
  const CrankKinematics<double> k = kinematics(theta);
  return wingbeat::standing_torques(vehicle, k, static_force(k));
}

double CrankModel::wing_energy() const {
  const CrankKinematics<double> k = kinematics(now.theta);
  return wingbeat::wing_energy(vehicle, k, k.stroke_slope * now.omega);
}

double CrankModel::motor_energy() const {
  return 0.5 * (vehicle.motor.inertia * square(now.omega) + vehicle.motor.armature_inductance * square(now.i));
}

double CrankModel::stored_energy() const {
  const CrankKinematics<double> k = kinematics(now.theta);
  const double velocity = k.stroke_slope * now.omega;
  if (pitching) return motor_energy() + wing_energy() + pitch_energy(velocity);
  const double alpha = aero_loads(vehicle.wings, std::abs(velocity)).angle_of_attack;
  return motor_energy() + wing_energy() + 0.5 * vehicle.wings.added_inertia * square(std::sin(alpha) * velocity);
}

/// di/dt [A/s]; `rates` are needed without inductance only.
double CrankModel::current_slope(double t, const double* y, const double* rates) const {
  const Motor<double>& m = vehicle.motor;
  const double R = circuit_resistance(vehicle);
  if (inductive) return (voltage(t) - R * y[2] - m.torque_constant * y[1]) / m.armature_inductance;
  const double angular = two_pi * supply.frequency;
  const double voltage_slope = supply.type == SupplyType::sine ? supply.voltage * angular * std::cos(angular * t) : 0.0;
  return (voltage_slope - m.torque_constant * rates[1]) / R;
}

double CrankModel::rotor_inertia() const {
  return has_gear_loss(vehicle.motor) ? vehicle.motor.gear_efficiency * vehicle.motor.inertia : vehicle.motor.inertia;
}

/// Nearest crank angles on either side of the start that the crank cannot pass.
void CrankModel::find_jams() {
  smallest_inertia = vehicle.motor.inertia;
  if (wingless) return;
  const double least = static_balance(vehicle).inertia_min / vehicle.motor.inertia;
  smallest_inertia *= std::clamp(least, 1e-3, 1.0);
  // Of wings that pitch it depends on how they stand: indicators() looks at that.
  if (pitching) return;
  const JamAngles jams = nearest_jams(vehicle, now.theta, smallest_margin);
  jam_below = jams.below;
  jam_above = jams.above;
}

double CrankModel::next_switch() const {
  if (supply.type != SupplyType::pwm || command) return infinity;
  // Even switches turn on, odd ones off; number 0 is the switching on at t = 0.
  const std::int64_t next = now.switches + 1;
  const bool off = (next & 1) != 0;
  const std::int64_t whole_periods = (next - (off ? 1 : 0)) / 2;
  return (double(whole_periods) + (off ? supply.duty : 0.0)) / supply.frequency;
}

void CrankModel::choose_force_branch() {
  if (wingless) return;
  if (now.force_branch_known) {
    now.force_branch_known = false;
    return;
  }
  double y[5];
  unknowns(y);
  double value = motion(now.t, y).force_switch / force_scale;
  if (std::abs(value) < 1e-9) {
    // The sign is about to be decided: look a little ahead, by the midpoint rule.
    const double ahead = 1e-5 * time_scale;
    double dy[5] = {}, mid[5] = {}, dmid[5] = {};
    rates(now.t, y, dy, false);
    for (int k = 0; k < coupled; ++k) mid[k] = y[k] + 0.5 * ahead * dy[k];
    rates(now.t + 0.5 * ahead, mid, dmid, false);
    for (int k = 0; k < coupled; ++k) y[k] += ahead * dmid[k];
    value = motion(now.t + ahead, y).force_switch;
  }
  now.branch.force = sign_of(value);
}

std::array<double, CrankModel::indicator_count> CrankModel::indicators(double t, const double* y) const {
  std::array<double, indicator_count> values;
  values[standstill] = y[1] / speed_scale;
  if (now.stuck) {
    values.fill(1.0);
    if (pitching) {
      const StandingTorques<double> torques = standing_torques(y);
      const double torque = vehicle.motor.torque_constant * current_of(t, y);
      values[standstill] =
          std::min(torques.high - torque, torque - torques.low) / (vehicle.motor.torque_constant * current_scale);
      values[stop] = stop_room(t, y);
      values[turn] = now.held ? 1.0 : y[pitch_at() + 1] / pitch_velocity_scale;
      return values;
    }
    const double hold = holding_torque(y[0]);
    values[standstill] = (hold - std::abs(net_static_torque(y[0], current_of(t, y)))) / hold;
    return values;
  }
  values[jam] = pitching ? std::min(1.0, uniqueness_at(y) - smallest_margin)
                         : std::min({1.0, jam_above - y[0], y[0] - jam_below});
  values[force] = values[stored_moment] = values[reversal] = values[stop] = values[turn] = 1.0;
  if (wingless) return values;
  const Motion<double> m = motion(t, y);
  values[force] = m.force_switch / force_scale;
  values[stored_moment] = m.stored_moment / (force_scale / vehicle.motor.inertia);
  values[reversal] = m.kinematics.stroke_slope / typical_stroke_slope(vehicle.transmission);
  if (pitching) {
    values[stop] = stop_room(t, y);
    values[turn] = now.held ? 1.0 : y[pitch_at() + 1] / pitch_velocity_scale;
  }
  return values;
}

/// At a standstill it is held, or moves on in the direction of the torque.
void CrankModel::begin_piece() {
  resume();
  // Without inductance the current jumps with the voltage, and what friction held may not be held any more.
  if (now.jammed || (now.stuck && inductive)) return;
  now.branch.direction = sign_of(now.omega);
  if (now.omega == 0.0) {
    if (!inductive) now.i = algebraic_current(vehicle, voltage(now.t), 0.0);
    double net = net_static_torque(now.theta, now.i), hold = holding_torque(now.theta);
    if (pitching) {
      double y[5];
      unknowns(y);
      const StandingTorques<double> torques = standing_torques(y);
      net = vehicle.motor.torque_constant * now.i - 0.5 * (torques.low + torques.high);
      hold = 0.5 * (torques.high - torques.low);
    }
    now.branch.direction = sign_of(net);
    now.stuck = hold > 0.0 && std::abs(net) <= hold;
    if (now.stuck) return;
  }
  choose_force_branch();
}

void CrankModel::unknowns(double* y) const {
  y[0] = now.theta;
  y[1] = now.omega;
  if (inductive) y[2] = now.i;
  if (pitching) {
    y[pitch_at()] = now.psi;
    y[pitch_at() + 1] = now.pitch_velocity;
  }
}

void CrankModel::set(double t, const double* y) {
  now.t = t;
  now.theta = y[0];
  now.omega = y[1];
  now.i = current_of(t, y);
  if (pitching) {
    now.psi = y[pitch_at()];
    now.pitch_velocity = y[pitch_at() + 1];
  }
}

std::array<double, 5> CrankModel::typical() const {
  std::array<double, 5> sizes = {0.1, speed_scale, current_scale};
  sizes[pitch_at()] = pitch_scale;
  sizes[std::min<std::size_t>(pitch_at() + 1, 4)] = pitch_velocity_scale;
  return sizes;
}

std::array<int, CrankModel::indicator_count> CrankModel::directions() const {
  return {int(-now.branch.force), now.stuck ? -1 : int(-now.branch.direction), -1, 0, 0, -1, 0};
}

void CrankModel::handle(std::size_t indicator) {
  if (indicator == jam) now.jammed = true;
  if (indicator == standstill) {
    now.stuck = false;
    now.omega = 0.0;
  }
  if (indicator == force) {
    now.branch.force = -now.branch.force;
    now.force_branch_known = now.omega != 0.0;
  }
  if (indicator == stop) {
    if (now.held) now.held = false;
    else meet_stop();
  }
}

std::optional<TransientEvent::Kind> CrankModel::event_at(std::size_t indicator) const {
  using Kind = TransientEvent::Kind;
  if (indicator == standstill) return now.stuck ? Kind::breakaway : Kind::standstill;
  if (indicator == force) return Kind::force_sign_change;
  return std::nullopt;
}

/// True where a sign was wrong from the start of the piece, which an integrator may not see as a change.
bool CrankModel::branch_lost() {
  if (pitching && !now.held && std::abs(now.psi) > vehicle.pitch.hinge.stop * (1.0 + 1e-9)) {
    meet_stop();
    return true;
  }
  if (now.stuck) return false;
  if (now.branch.direction * now.omega < -1e-9 * speed_scale) return true;
  double y[5];
  unknowns(y);
  if (wingless || now.branch.force * indicators(now.t, y)[force] >= -1e-8) return false;
  now.branch.force = -now.branch.force;
  now.force_branch_known = true;
  return true;
}

void CrankModel::tolerated(double relative, const double* y, double* errors) const {
  // The crank angle grows for ever: its admissible error must not grow with it.
  errors[0] = relative;
  errors[1] = relative * (std::abs(y[1]) + 0.01 * speed_scale);
  if (inductive) errors[2] = relative * (std::abs(y[2]) + 0.01 * current_scale);
  if (pitching) {
    const std::size_t pitch = pitch_at();
    errors[pitch] = relative * (std::abs(y[pitch]) + 0.01 * pitch_scale);
    errors[pitch + 1] = relative * (std::abs(y[pitch + 1]) + 0.01 * pitch_velocity_scale);
  }
}

bool CrankModel::stiff() const {
  const double span = drive_period > 0.0 ? std::min(time_scale, drive_period) : time_scale;
  const double pitch_decay = pitching ? vehicle.pitch.hinge.damping / vehicle.pitch.pitch_inertia : 0.0;
  return std::max(fastest_decay, pitch_decay) * span > stiff_decays_per_cycle;
}

void CrankModel::switch_supply() {
  ++now.switches;
  now.switched_voltage = now.switches % 2 == 0 ? supply.voltage : 0.0;
  if (!inductive) now.i = algebraic_current(vehicle, now.switched_voltage, now.omega);
}

void CrankModel::catch_up_with_supply() {
  if (supply.type != SupplyType::pwm || command) return;
  now.switches = 2 * std::int64_t(std::floor(now.t * supply.frequency));
  now.switched_voltage = supply.voltage;
  while (next_switch() <= now.t) switch_supply();
}

}  // namespace wingbeat::detail
