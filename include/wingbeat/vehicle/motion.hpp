// The equations of motion of a vehicle; model.md section 2.
#pragma once

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// Which smooth branch of the kinked equations holds, and what holds still: each +-1.
template <Scalar S>
struct Mode {
  S stroke = S(1.0);        ///< sign of beta'
  S force = S(1.0);         ///< sign of the rod force F
  S direction = S(1.0);     ///< sign of omega, of a shaft that is at rest the one it leaves in; +1 in steady flapping
  S stored_power = S(1.0);  ///< sign of (N_w J_w beta'' + N_w k beta) beta', for the reactive power (eq 23) alone
  S pitching = S(1.0);      ///< -1 where the angle of attack is at its lower bound
  S gear = S(1.0);          ///< sign of T_g omega: -1 where the load drives the motor
  S turn = S(1.0);          ///< sign of psi', of wings that pitch on hinges
  S held = S(1.0);          ///< -1 where a stop, or friction of their joint, holds such wings
  S slip = S(1.0);          ///< -1 where friction holds crank or shaft
  S bridge = S(1.0);        ///< -1 where electronics block a current that would flow back
  S limit = S(1.0);         ///< -1 where they limit the current

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.stroke, self.force, self.direction, self.stored_power, self.pitching, self.gear, self.turn,
               self.held, self.slip, self.bridge, self.limit);
  }
};

/// Everything that acts at one instant.
template <Scalar S>
struct Motion {
  CrankKinematics<S> kinematics;
  S crank_acceleration;   ///< omega' [rad/s2]
  S inductive_voltage;    ///< \f$v - R_\mathrm{a} i - K \omega = L_\mathrm{a}\,\mathrm{d}i/\mathrm{d}t\f$ [V]
  S current;              ///< i [A]
  S voltage;              ///< v at the terminals [V]
  S rod_force;            ///< F [N], positive when the crank pushes the slider up
  S force_switch;         ///< has the sign of F on either branch while the equations have one solution [N kg m3]
  S stroke_velocity;      ///< beta' [rad/s]
  S stroke_acceleration;  ///< beta'' [rad/s2]
  AeroLoads<S> aero;      ///< of all wings
  S friction_torque;      ///< T_f of the mechanism [N m]; of a shaft that stands, all that holds it
  S motor_torque;         ///< \f$T_\mathrm{m} = F h + T_\mathrm{f}\f$ [N m] (eq 5), behind the motor's own friction;
                          ///< standing, K i
  S gear_torque;          ///< T_g that the gearbox takes from the motor, along omega [N m] (model.md section 9)
  S gear_loss;            ///< \f$(1 - e)\, T_\mathrm{g} \omega\f$ [W]
  S stored_moment;        ///< \f$N_\mathrm{w} J_\mathrm{w} \ddot\beta + N_\mathrm{w} k \beta\f$ [N m]
};

/// J + A (h + s mu r_e) [kg m2], the divisor of omega' on the branch s (model.md section 2), with all of the added mass
/// that there may be: that at rest; eta J behind a gearbox that loses torque. The equations have one solution while it
/// is positive for s = +1 and s = -1 and the lever g is positive.
/// \f[
/// J + A (h + s \mu r_\mathrm{e}), \qquad A = \frac{(N_\mathrm{w} J_\mathrm{w} + J_\mathrm{a}) B_1}{g}
/// \f]
template <template <Scalar> class V, Scalar S>
S effective_inertia(const V<S>& v, const CrankKinematics<S>& k, const S& s) {
  const S A = (v.wing_count * v.wing_inertia + v.wings.added_inertia) * k.stroke_slope / k.wing_jacobian;
  const S J = has_gear_loss(v.motor) ? S(v.motor.gear_efficiency * v.motor.inertia) : v.motor.inertia;
  return J + A * (k.crank_jacobian + s * v.friction.radius);
}

/// Moment of all hinge springs, \f$N_\mathrm{w} k \beta\f$ [N m].
template <template <Scalar> class V, Scalar S>
S spring_moment(const V<S>& v, const CrankKinematics<S>& k) {
  // Without springs the arc tangent is a tenth of all the work; its derivative by the stiffness is still wanted.
  if (!ScalarTraits<S>::differentiates && !any<S>(v.spring.stiffness > S(0.0))) return S(0.0);
  return v.wing_count * spring_loads(v.spring, stroke_angle(k)).moment;
}

/// All that depends on the crank angle alone.
template <Scalar S>
struct Configuration {
  CrankKinematics<S> kinematics;
  S spring_moment;          ///< N_w k beta [N m]
  S stroke_angle = S(0.0);  ///< beta [rad], of wings whose loads depend on it; 0 of others

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.kinematics, self.spring_moment, self.stroke_angle);
  }
};

/// The configuration at a crank angle given by its sine and cosine.
template <template <Scalar> class V, Scalar S>
[[gnu::always_inline]] inline Configuration<S> configuration_at(const V<S>& v, const S& sin_theta, const S& cos_theta) {
  Configuration<S> configuration;
  configuration.kinematics = crank_kinematics(v.transmission, sin_theta, cos_theta);
  configuration.spring_moment = spring_moment(v, configuration.kinematics);
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (needs_stroke_angle(v.wings)) configuration.stroke_angle = stroke_angle(configuration.kinematics);
  }
  return configuration;
}

/// An instant as the equations of motion take it: where everything is, how it moves, what drives it.
template <Scalar S>
struct MotionState {
  Configuration<S> configuration;
  S omega;                    ///< speed of crank or shaft [rad/s]
  S current;                  ///< i [A]
  S voltage;                  ///< v at the motor's terminals [V]
  S pitch_angle = S(0.0);     ///< psi, of wings that pitch on hinges [rad]
  S pitch_velocity = S(0.0);  ///< psi' [rad/s]
};

/// A MotionState of wings under the pitch law without a copy of its configuration.
template <Scalar S>
struct MotionStateView {
  const Configuration<S>& configuration;
  S omega, current, voltage;
};

/// What a stroke is to its drive, springs apart: the wings ask for the moment (inertia) beta'' + moment.
template <Scalar S>
struct StrokeLoads {
  AeroLoads<S> aero;  ///< of all wings
  S inertia;          ///< I [kg m2]
  S moment;           ///< M_0 [N m]
};

/// Whether the air's inertia, and the accelerations with it, jump where the pitching of wings under the pitch law meets
/// its stop (model.md section 10).
template <template <Scalar> class V, Scalar S>
bool jumps_at_pitch_stop(const V<S>& v) {
  return value_of(v.wings.added_inertia) > 0.0 && has_pitch_stop(v.wings) && value_of(v.wings.pitch_coefficient) > 0.0;
}

/// clap_factor() at an instant of these signs; lanes have no wings that clap.
template <template <Scalar> class V, Scalar S>
WINGBEAT_INLINE_FOR_SPEED S clap_factor(const V<S>& v, const Configuration<S>& configuration, const Mode<S>& mode) {
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (claps(v.wings.clap)) return clap_factor(v.wings.clap, configuration.stroke_angle, mode.stroke);
  }
  return S(1.0);
}

/// StrokeLoads of wings under the pitch law, `every_law` as in aero_loads().
/// \f[
/// I = N_\mathrm{w} J_\mathrm{w} + J_\mathrm{am}, \qquad M_0 = M_\mathrm{aero}
/// \f]
template <bool every_law = true, template <Scalar> class V, Scalar S>
[[gnu::always_inline]] inline StrokeLoads<S> stroke_loads(const V<S>& v, const Configuration<S>& configuration,
                                                          const S& stroke_velocity, const Mode<S>& mode) {
  const AeroLoads<S> aero = aero_loads<every_law>(v.wings, stroke_velocity, mode.stroke, mode.pitching,
                                                  clap_factor(v, configuration, mode), configuration.stroke_angle);
  S inertia = v.wing_count * v.wing_inertia;
  if constexpr (every_law) inertia = inertia + aero.added_inertia;
  return {aero, inertia, aero.moment};
}

/// What is known of an instant before the sign of the rod force.
template <Scalar S>
struct IntermediateTerms {
  MotorLoads<S> motor;
  S stroke_velocity;  ///< beta' [rad/s]
  AeroLoads<S> aero;  ///< of all wings
  S load_free;        ///< friction of the mechanism that does not depend on F [N m]
  S drive;            ///< K i - b omega - T_c,m - load_free - T_x [N m]; the motor's share of it behind a gearbox
  S gear_ratio;       ///< e, torque behind the gearbox over torque before it [1]
  S inertia;          ///< e J [kg m2]
  S A_g;              ///< A g of F = A omega' + C [kg m2]
  S C_g;              ///< C g [N m]
  S force_switch;  ///< e J C_g + A_g drive: has the sign of F on either branch while there is one solution [N m kg m2]
};

/// The instant under the loads of the stroke; of `mode` the signs of omega and gear torque matter. The wings' equation
/// (1, 21) gives the rod force as \f$F = A \dot\omega + C\f$, with the loads \f$I\f$ and \f$M_0\f$. The torque D
/// drives the crank before the rod force acts, e being that of gear_torque_ratio(), \f$T_\mathrm{l}\f$ that of
/// load_free_friction() and \f$T_\mathrm{x}\f$ the load's:
/// \f[
/// \begin{aligned}
/// A g &= I B_1, \qquad C g = I B_2 \omega^2 + M_0 + N_\mathrm{w} k \beta \cr
/// D &= e \left( K i - b\, \omega - T_\mathrm{c,m} \operatorname{sign}\omega \right) - T_\mathrm{l} - T_\mathrm{x}
/// \end{aligned}
/// \f]
///
/// State: MotionState, or FullState, whose actuator takes the torque \f$T_\mathrm{act}\f$ from D and adds to J.
template <bool every_law = true, template <Scalar> class V, Scalar S, class State>
[[gnu::always_inline]] inline IntermediateTerms<S> terms_under(const V<S>& v, const State& instant,
                                                               const StrokeLoads<S>& loads, const Mode<S>& mode) {
  const CrankKinematics<S>& k = instant.configuration.kinematics;
  IntermediateTerms<S> terms;
  terms.motor = motor_loads(v.motor, instant.voltage, instant.current, instant.omega);
  terms.stroke_velocity = k.stroke_slope * instant.omega;
  terms.aero = loads.aero;
  // The motor's own friction acts before the gearbox.
  const S mechanism = load_free_friction(v.friction, instant.omega, mode.direction);
  const S own = mode.direction * v.motor.friction_torque;
  terms.load_free = mechanism;
  terms.gear_ratio = S(1.0);
  terms.inertia = v.motor.inertia;
  terms.drive = terms.motor.torque - terms.motor.drag_torque - (mechanism + own);
  if (every_law && has_gear_loss(v.motor)) {
    terms.gear_ratio = gear_torque_ratio(v.motor, mode.gear);
    terms.inertia = terms.gear_ratio * v.motor.inertia;
    terms.drive = terms.gear_ratio * (terms.motor.torque - terms.motor.drag_torque - own) - mechanism;
  }

  if constexpr (ScalarTraits<S>::reads_tables) terms.drive = terms.drive - v.load_torque;
  if constexpr (requires { instant.load; }) {
    terms.drive = terms.drive - instant.load;
    terms.inertia = terms.inertia + instant.inertia;
  }

  // F = A omega' + C of model.md, both sides times g, which saves dividing by it twice.
  terms.A_g = loads.inertia * k.stroke_slope;
  terms.C_g = loads.inertia * k.stroke_second_derivative * square(instant.omega) + loads.moment +
              instant.configuration.spring_moment;
  terms.force_switch = terms.inertia * terms.C_g + terms.A_g * terms.drive;
  return terms;
}

/// terms_under() of wings under the pitch law, `every_law` as in aero_loads().
template <bool every_law = true, template <Scalar> class V, Scalar S, class State>
[[gnu::always_inline]] inline IntermediateTerms<S> terms_at(const V<S>& v, const State& instant, const Mode<S>& mode) {
  const S stroke_velocity = instant.configuration.kinematics.stroke_slope * instant.omega;
  return terms_under<every_law>(v, instant, stroke_loads<every_law>(v, instant.configuration, stroke_velocity, mode),
                                mode);
}

/// Rod force and accelerations of an instant, in a given mode (model.md section 2, eqs 1, 5-11, 21). With A, C and
/// the driving torque D of terms_under(), and \f$s = \operatorname{sign} F \operatorname{sign}\omega\f$ on that
/// branch:
/// \f[
/// \begin{aligned}
/// \dot\omega &= \frac{D - C (h + s \mu r_\mathrm{e})}{e J + A (h + s \mu r_\mathrm{e})}, \qquad
/// F = A \dot\omega + C = \frac{e J\, C + A D}{e J + A (h + s \mu r_\mathrm{e})} \cr
/// \ddot\beta &= B_1 \dot\omega + B_2 \omega^2, \qquad
/// T_\mathrm{m} = F h + \mu r_\mathrm{e} |F| \operatorname{sign}\omega + T_\mathrm{l} + T_\mathrm{x}
/// \end{aligned}
/// \f]
template <bool every_law = true, template <Scalar> class V, Scalar S, class State>
[[gnu::always_inline]] inline Motion<S> motion_on(const V<S>& v, const State& instant,
                                                  const IntermediateTerms<S>& terms, const Mode<S>& mode) {
  Motion<S> m;
  m.kinematics = instant.configuration.kinematics;
  const CrankKinematics<S>& k = instant.configuration.kinematics;
  const S J = terms.inertia;
  const S g = k.wing_jacobian;
  const S omega2 = square(instant.omega);
  // mu r_e |F| sign(omega) = s mu r_e F with s = sign(F) sign(omega), on this branch.
  const S lever = k.crank_jacobian + mode.force * mode.direction * v.friction.radius;
  const S inertia_g = J * g + terms.A_g * lever;
  const S divisor = inverse_of(inertia_g);

  m.current = instant.current;
  m.voltage = instant.voltage;
  m.stroke_velocity = terms.stroke_velocity;
  m.aero = terms.aero;
  m.force_switch = terms.force_switch;
  m.rod_force = terms.force_switch * divisor;
  m.crank_acceleration = (terms.drive * g - terms.C_g * lever) * divisor;
  m.stroke_acceleration = k.stroke_slope * m.crank_acceleration + k.stroke_second_derivative * omega2;
  m.friction_torque = load_friction(v.friction, mode.force * m.rod_force, mode.direction) + terms.load_free;
  m.motor_torque = m.rod_force * k.crank_jacobian + m.friction_torque;
  if constexpr (ScalarTraits<S>::reads_tables) m.motor_torque = m.motor_torque + v.load_torque;
  m.gear_torque = m.gear_loss = S(0.0);
  if (every_law && has_gear_loss(v.motor)) {
    m.gear_torque =
        mode.direction * (terms.motor.torque - terms.motor.drag_torque - v.motor.inertia * m.crank_acceleration) -
        v.motor.friction_torque;
    m.gear_loss = (S(1.0) - terms.gear_ratio) * m.gear_torque * mode.direction * instant.omega;
  }
  m.stored_moment = v.wing_count * v.wing_inertia * m.stroke_acceleration + instant.configuration.spring_moment;
  m.inductive_voltage = terms.motor.inductive_voltage;
  return m;
}

/// What acts at an instant on wings under the pitch law, in a given mode.
template <template <Scalar> class V, Scalar S, class State>
[[gnu::always_inline]] inline Motion<S> motion_at(const V<S>& v, const State& instant, const Mode<S>& mode) {
  return motion_on(v, instant, terms_at(v, instant, mode), mode);
}

/// Voltage at the motor terminals, \f$v - R_\mathrm{i} i\f$ [V], under the current i [A], where the supply drives
/// `voltage` v [V].
template <template <Scalar> class V, Scalar S>
S terminal_voltage(const V<S>& v, const S& voltage, const S& i) {
  return voltage - v.source_resistance * i;
}

/// All resistance that the current passes, \f$R_\mathrm{a} + R_\mathrm{i}\f$ [ohm].
template <template <Scalar> class V, Scalar S>
S circuit_resistance(const V<S>& v) {
  return v.motor.armature_resistance + v.source_resistance;
}

/// The current [A] without inductance, where the supply drives `voltage` v [V] (eq 11 with L_a = 0).
/// \f[
/// i = \frac{v - K \omega}{R_\mathrm{a} + R_\mathrm{i}}
/// \f]
template <template <Scalar> class V, Scalar S>
S algebraic_current(const V<S>& v, const S& voltage, const S& omega) {
  return (voltage - v.motor.torque_constant * omega) / circuit_resistance(v);
}

/// Steady speed without load and friction [rad/s]: the closed form of the wingless condition.
/// \f[
/// \omega_0 = \frac{K v}{K^2 + (R_\mathrm{a} + R_\mathrm{i})\, b}
/// \f]
template <template <Scalar> class V, Scalar S>
S no_load_speed(const V<S>& v) {
  const S& K = v.motor.torque_constant;
  return K * v.voltage / (K * K + circuit_resistance(v) * v.motor.viscous_damping);
}

/// Angle that a crank turns by at the speed without load while its motor's current decays by a factor of e [rad].
/// \f[
/// \frac{L_\mathrm{a}}{R_\mathrm{a} + R_\mathrm{i}}\, \omega_0
/// \f]
template <template <Scalar> class V, Scalar S>
S electrical_lag(const V<S>& v) {
  return v.motor.armature_inductance / circuit_resistance(v) * no_load_speed(v);
}

/// Below such an angle of crank or supply, or share of the motor's mechanical time constant, the current is
/// quasi-steady: it differs from v / R - K omega / R by less, and L_a di/dt is a difference of voltages that rounding
/// outweighs.
inline constexpr double quasi_steady_lag = 1e-9;

/// Whether the current is a state of its own, for every solver: elsewhere it is algebraic_current(), as without
/// inductance.
template <template <Scalar> class V, Scalar S>
bool has_current_state(const V<S>& v) {
  if constexpr (requires { v.piezo; }) {
    if (is_given(v.piezo)) return false;
  }
  const double L = value_of(v.motor.armature_inductance), R = value_of(circuit_resistance(v));
  const double K = value_of(v.motor.torque_constant);
  const double rate = std::fmax(K * K / (R * value_of(v.motor.inertia)), two_pi * value_of(v.drive_frequency));
  return L * std::fmax(rate, value_of(no_load_speed(v))) > quasi_steady_lag * R;
}

/// Kinetic energy of all wings, without the air that moves with them, and elastic energy of all hinge springs [J].
/// \f[
/// E_\mathrm{w} = \tfrac12 N_\mathrm{w} J_\mathrm{w} \dot\beta^2 + \tfrac12 N_\mathrm{w} k \beta^2
/// \f]
template <template <Scalar> class V, Scalar S>
S wing_energy(const V<S>& v, const CrankKinematics<S>& k, const S& stroke_velocity) {
  const S kinetic = S(0.5) * v.wing_count * v.wing_inertia * square(stroke_velocity);
  if (!ScalarTraits<S>::differentiates && !any<S>(v.spring.stiffness > S(0.0))) return kinetic;
  return kinetic + v.wing_count * spring_loads(v.spring, stroke_angle(k)).energy;
}

/// Energy of rotor, wings, springs and inductance [J], with wing_energy() \f$E_\mathrm{w}\f$.
/// \f[
/// E = \tfrac12 J \omega^2 + E_\mathrm{w} + \tfrac12 L_\mathrm{a} i^2
/// \f]
template <template <Scalar> class V, Scalar S>
S stored_energy(const V<S>& v, const CrankKinematics<S>& k, const S& omega, const S& i) {
  return S(0.5) * v.motor.inertia * square(omega) + wing_energy(v, k, S(k.stroke_slope * omega)) +
         S(0.5) * v.motor.armature_inductance * square(i);
}

}  // namespace wingbeat
