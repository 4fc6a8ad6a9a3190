// DC motor, its constants referred to the output (crank) shaft; model.md sections 1 and 2, eqs (9-11).
#pragma once

#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

/// A DC motor seen from the output shaft. Positive torque drives the crank towards larger crank angle. With the
/// terminal voltage \f$v\f$ [V], the current \f$i\f$ [A], the shaft speed \f$\omega\f$ [rad/s] and the torque
/// \f$T_\mathrm{m}\f$ that the mechanism takes [N m], without a loss in the gearbox (eqs 9-11; model.md section 2):
/// \f[
/// J \dot\omega = K i - b\, \omega - T_\mathrm{c,m} \operatorname{sign}\omega - T_\mathrm{m}, \qquad
/// L_\mathrm{a} \frac{\mathrm{d}i}{\mathrm{d}t} = v - R_\mathrm{a} i - K \omega
/// \f]
template <Scalar S>
struct Motor {
  S armature_resistance;     ///< R_a [ohm], > 0
  S armature_inductance;     ///< L_a [H], >= 0; 0 makes the current algebraic
  S torque_constant;         ///< K = n K_b [N m/A = V s/rad], > 0
  S inertia;                 ///< J = J_G + n^2 J_m [kg m2], > 0
  S viscous_damping;         ///< b = b_G + n^2 b_m [N m s/rad], >= 0
  S friction_torque = S(0);  ///< constant friction torque of the motor itself [N m], >= 0
  S gear_efficiency = S(1);  ///< eta of the gearbox under load [1], > 0, <= 1; 1 without

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.armature_resistance, self.armature_inductance, self.torque_constant, self.inertia,
               self.viscous_damping, self.friction_torque, self.gear_efficiency);
  }
};

/// Whether a gearbox loses torque, in any lane.
template <Scalar S>
bool has_gear_loss(const Motor<S>& m) {
  if constexpr (ScalarTraits<S>::lanes > 1) return any<S>(m.gear_efficiency < S(1.0));
  else return value_of(m.gear_efficiency) < 1.0;
}

/// e [1], the torque behind the gearbox over that before it (model.md section 9): eta where the motor drives the load,
/// `gear` = +1, and 1/eta where the load drives the motor, -1. With the torque \f$T_\mathrm{g}\f$ before the gearbox:
/// \f[
/// e = \begin{cases} \eta & T_\mathrm{g} \omega > 0 \\ 1/\eta & T_\mathrm{g} \omega < 0 \end{cases}
/// \f]
template <Scalar S>
S gear_torque_ratio(const Motor<S>& m, const S& gear) {
  if (!has_gear_loss(m)) return S(1.0);
  return select<S>(gear > S(0.0), m.gear_efficiency, S(1.0) / m.gear_efficiency);
}

/// Torque before the gearbox [N m] that balances the torque `load` behind it while the shaft starts forward. For a
/// start backward: the negative of it, of the negative load. In model.md section 9:
/// \f[
/// \operatorname{up}(T) = \begin{cases} T/\eta & T > 0 \\ \eta\, T & T \le 0 \end{cases}
/// \f]
template <Scalar S>
S torque_before_gear(const Motor<S>& m, const S& load) {
  if (!has_gear_loss(m)) return load;
  return select<S>(load > S(0.0), load / m.gear_efficiency, load * m.gear_efficiency);
}

/// Motor-shaft constants with a gearbox of ratio n (motor turns per output turn).
template <Scalar S>
struct GearMotor {
  S gear_ratio;           ///< n [1], > 0
  Motor<S> motor_shaft;   ///< K_b, J_m, b_m and friction torque at the motor shaft
  S gear_inertia = S(0);  ///< J_G of the gearbox at the output shaft [kg m2], >= 0
  S gear_damping = S(0);  ///< b_G of the gearbox at the output shaft [N m s/rad], >= 0

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.gear_ratio, self.motor_shaft, self.gear_inertia, self.gear_damping);
  }
};

/// Motor-shaft constants referred to the output shaft; resistance and inductance are unchanged (model.md section 1).
/// Index m: at the motor shaft, G: of the gearbox at the output shaft.
/// \f[
/// K = n K_\mathrm{b}, \qquad J = J_\mathrm{G} + n^2 J_\mathrm{m}, \qquad b = b_\mathrm{G} + n^2 b_\mathrm{m}, \qquad
/// T_\mathrm{c,m} = n\, T_\mathrm{c,m}^\mathrm{shaft}
/// \f]
template <Scalar S>
Motor<S> at_output_shaft(const GearMotor<S>& geared) {
  const S n = geared.gear_ratio;
  const Motor<S>& m = geared.motor_shaft;
  return {m.armature_resistance,
          m.armature_inductance,
          n * m.torque_constant,
          geared.gear_inertia + n * n * m.inertia,
          geared.gear_damping + n * n * m.viscous_damping,
          n * m.friction_torque,
          m.gear_efficiency};
}

/// The motor that acts as `count` equal ones do on the same terminals and on shafts that turn in phase: current and
/// torque are the sums of theirs (model.md section 13). For M motors, K and the gear efficiency being those of one:
/// \f[
/// R_\mathrm{a} / M, \qquad L_\mathrm{a} / M, \qquad M J, \qquad M b, \qquad M T_\mathrm{c,m}
/// \f]
template <Scalar S>
Motor<S> side_by_side(Motor<S> m, const S& count) {
  m.armature_resistance = m.armature_resistance / count;
  m.armature_inductance = m.armature_inductance / count;
  m.inertia = m.inertia * count;
  m.viscous_damping = m.viscous_damping * count;
  m.friction_torque = m.friction_torque * count;
  return m;
}

/// Keys, units and ranges; the table of parameters has them from here.
namespace motor_key {
inline constexpr ParameterKey armature_resistance{"motor.armature_resistance", "ohm", range::positive};
inline constexpr ParameterKey armature_inductance{"motor.armature_inductance", "H", range::not_negative};
inline constexpr ParameterKey torque_constant{"motor.torque_constant", "N m/A", range::positive};
inline constexpr ParameterKey inertia{"motor.inertia", "kg m2", range::positive};
inline constexpr ParameterKey viscous_damping{"motor.viscous_damping", "N m s/rad", range::not_negative};
inline constexpr ParameterKey friction_torque{"motor.friction_torque", "N m", range::not_negative};
inline constexpr ParameterKey gear_efficiency{"motor.gear_efficiency", "1", range::efficiency};
}  // namespace motor_key

/// Throws ParameterError unless every constant lies in its physical range.
inline void validate(const Motor<double>& m) {
  require(motor_key::armature_resistance, m.armature_resistance);
  require(motor_key::armature_inductance, m.armature_inductance);
  require(motor_key::torque_constant, m.torque_constant);
  require(motor_key::inertia, m.inertia);
  require(motor_key::viscous_damping, m.viscous_damping);
  require(motor_key::friction_torque, m.friction_torque);
  require(motor_key::gear_efficiency, m.gear_efficiency);
}

/// Electrical side of the motor at crank speed omega and current i.
template <Scalar S>
struct MotorLoads {
  S torque;             ///< \f$K i\f$ [N m]
  S drag_torque;        ///< \f$b\, \omega\f$ [N m], opposes rotation
  S inductive_voltage;  ///< \f$v - R_\mathrm{a} i - K \omega\f$ [V], what is left to change the current
  S power_copper;       ///< \f$R_\mathrm{a} i^2\f$ [W]
  S power_viscous;      ///< \f$b\, \omega^2\f$ [W]
};

/// Loads and losses of the motor (eqs 9-11) at terminal voltage v [V], current i [A], crank speed omega [rad/s].
template <Scalar S>
MotorLoads<S> motor_loads(const Motor<S>& m, const S& v, const S& i, const S& omega) {
  return {m.torque_constant * i, m.viscous_damping * omega, v - m.armature_resistance * i - m.torque_constant * omega,
          m.armature_resistance * i * i, m.viscous_damping * omega * omega};
}

/// Steady speed without load and friction [rad/s]: the closed form of the wingless condition (model.md section 3).
/// \f[
/// \omega_0 = \frac{K v}{K^2 + R_\mathrm{a} b}
/// \f]
template <Scalar S>
S no_load_speed(const Motor<S>& m, const S& v) {
  return m.torque_constant * v / (m.torque_constant * m.torque_constant + m.armature_resistance * m.viscous_damping);
}

}  // namespace wingbeat
