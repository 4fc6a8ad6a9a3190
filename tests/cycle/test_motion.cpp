// The equations of motion, checked by putting what motion_at returns back into them (model.md section 2).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/random_vehicle.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

MotionState<double> instant_of(const Vehicle<double>& v, double theta, double omega, double current, double voltage) {
  return {configuration_at(v, std::sin(theta), std::cos(theta)), omega, current, voltage};
}

struct MotionCase {
  Vehicle<double> vehicle;
  double theta, omega, current, voltage;

  Motion<double> on(double force_sign) const {
    return motion_at(vehicle, instant_of(vehicle, theta, omega, current, voltage), mode(force_sign));
  }
  /// The branch of stroke velocity and direction that holds; of the force, the one asked for.
  Mode<double> mode(double force_sign) const {
    const auto k = crank_kinematics(vehicle.transmission, std::sin(theta), std::cos(theta));
    return {sign_of(k.stroke_slope * omega), force_sign, sign_of(omega), 1.0};
  }
  bool unique() const {
    const auto k = crank_kinematics(vehicle.transmission, std::sin(theta), std::cos(theta));
    return k.wing_jacobian > 0.0 && effective_inertia(vehicle, k, 1.0) > 0.0 &&
           effective_inertia(vehicle, k, -1.0) > 0.0;
  }
};

template <class F>
void for_random_instants(int count, const F& check) {
  std::mt19937_64 random(2022);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int n = 0; n < count; ++n) {
    MotionCase c{resolve(random_design(random)), two_pi * unit(random), 0.0, 0.0, 6.0 * unit(random)};
    const double speed = 300.0 * unit(random);
    c.omega = unit(random) < 0.75 ? speed : -speed;
    c.current = 1.2 * unit(random) - 0.4;
    check(c);
  }
}

/// |sum of terms| must be rounding beside their size.
void expect_balance(std::initializer_list<double> terms) {
  double sum = 0.0, size = 0.0;
  for (const double term : terms) {
    sum += term;
    size += std::abs(term);
  }
  EXPECT_LE(std::abs(sum), 1e-13 * size);
}

TEST(Motion, SatisfiesTheEquationsOnBothBranches) {
  int count = 0;
  for_random_instants(2000, [&](const MotionCase& c) {
    if (!c.unique()) return;
    ++count;
    const Vehicle<double>& v = c.vehicle;
    const double direction = sign_of(c.omega), omega = c.omega;
    for (const double force_sign : {1.0, -1.0}) {
      const Motion<double> m = c.on(force_sign);
      const auto& k = m.kinematics;
      const double beta1 = k.stroke_slope * omega;
      const double beta2 = k.stroke_slope * m.crank_acceleration + k.stroke_second_derivative * omega * omega;
      EXPECT_DOUBLE_EQ(m.stroke_velocity, beta1);
      EXPECT_NEAR(m.stroke_acceleration, beta2,
                  1e-13 * (std::abs(beta2) + std::abs(k.stroke_second_derivative) * omega * omega));
      // (3): the moment is along beta'.
      const double alpha = pi / 2.0 - v.wings.pitch_coefficient * std::abs(beta1);
      const double C_D = 1.92 - 1.55 * std::cos(2.04 * alpha - 9.82 * pi / 180.0);
      const double aero = 0.5 * v.wings.air_density * C_D * beta1 * std::abs(beta1) * v.wings.s3;
      EXPECT_NEAR(m.aero.moment, aero, 1e-13 * std::abs(aero));
      // (1, 21)
      expect_balance({v.wing_count * v.wing_inertia * m.stroke_acceleration, m.aero.moment,
                      v.wing_count * v.spring.stiffness * stroke_angle(k), -m.rod_force * k.wing_jacobian});
      // (6) and the other laws, |F| being force_sign F on this branch
      const double T_f = direction * v.friction.radius * force_sign * m.rod_force + v.friction.damping * omega +
                         v.friction.quadratic * omega * std::abs(omega) + direction * v.friction.torque;
      EXPECT_NEAR(m.friction_torque, T_f, 1e-12 * (std::abs(T_f) + std::abs(v.friction.radius * m.rod_force)));
      // (5)
      expect_balance({m.motor_torque, -m.rod_force * k.crank_jacobian, -m.friction_torque});
      // (9, 10)
      expect_balance({v.motor.torque_constant * c.current, -m.rod_force * k.crank_jacobian, -T_f,
                      -direction * v.motor.friction_torque, -v.motor.inertia * m.crank_acceleration,
                      -v.motor.viscous_damping * omega});
      // (11)
      expect_balance({c.voltage, -m.inductive_voltage, -v.motor.armature_resistance * c.current,
                      -v.motor.torque_constant * omega});
      EXPECT_DOUBLE_EQ(m.stored_moment, v.wing_count * v.wing_inertia * m.stroke_acceleration +
                                            v.wing_count * v.spring.stiffness * stroke_angle(k));
      EXPECT_NEAR(m.rod_force * effective_inertia(v, k, force_sign * direction) * k.wing_jacobian, m.force_switch,
                  1e-13 * std::abs(m.force_switch));
    }
  });
  EXPECT_GT(count, 1000);
}

TEST(Motion, ForceSwitchHasTheSignOfTheForceWhicheverTheBranch) {
  int count = 0, negative = 0;
  for_random_instants(2000, [&](const MotionCase& c) {
    if (!c.unique()) return;
    ++count;
    const Motion<double> up = c.on(1.0), down = c.on(-1.0);
    EXPECT_EQ(up.force_switch, down.force_switch);
    EXPECT_EQ(sign_of(up.force_switch), sign_of(up.rod_force));
    EXPECT_EQ(sign_of(down.force_switch), sign_of(down.rod_force));
    negative += up.force_switch < 0.0 ? 1 : 0;
  });
  EXPECT_GT(negative, 200);
  EXPECT_GT(count - negative, 200);
}

TEST(Motion, BranchesMeetWhereTheForceVanishes) {
  for_random_instants(500, [&](MotionCase c) {
    if (!c.unique()) return;
    // The force switch is linear in the current.
    c.current = 0.0;
    const double s0 = c.on(1.0).force_switch;
    c.current = 1.0;
    const double s1 = c.on(1.0).force_switch;
    if (std::abs(s1 - s0) < 1e-3 * std::abs(s0)) return;
    c.current = -s0 / (s1 - s0);
    const Motion<double> up = c.on(1.0), down = c.on(-1.0);
    const double per_force = up.kinematics.wing_jacobian * std::min(effective_inertia(c.vehicle, up.kinematics, 1.0),
                                                                    effective_inertia(c.vehicle, up.kinematics, -1.0));
    EXPECT_NEAR(up.rod_force * per_force, 0.0, 1e-13 * (std::abs(s0) + std::abs(s1)));
    EXPECT_NEAR(up.crank_acceleration, down.crank_acceleration, 1e-10 * std::abs(up.crank_acceleration) + 1e-8);
  });
}

TEST(Motion, PowerBalancesAtEveryInstant) {
  int count = 0;
  for_random_instants(2000, [&](const MotionCase& c) {
    if (!c.unique()) return;
    const Vehicle<double>& v = c.vehicle;
    const Motion<double> m = c.on(sign_of(c.on(1.0).force_switch));
    const double omega = c.omega, i = c.current;
    // d(stored)/dt by a dual number that carries the time derivative.
    using J = Jet<1>;
    J theta(c.theta), w(omega), current(i);
    theta.v[0] = omega;
    w.v[0] = m.crank_acceleration;
    if (v.motor.armature_inductance > 0.0) current.v[0] = m.inductive_voltage / v.motor.armature_inductance;
    const Vehicle<J> dual = cast<J>(v);
    const double stored =
        stored_energy(dual, crank_kinematics(dual.transmission, sin(theta), cos(theta)), w, current).v[0];
    // Without an inductance the state need not satisfy v = R i + K omega: its reserve does no work on the field.
    const double voltage = v.motor.armature_inductance > 0.0
                               ? c.voltage
                               : v.motor.armature_resistance * i + v.motor.torque_constant * omega;
    const auto& k = m.kinematics;
    const double formulation = m.rod_force * (k.crank_jacobian * omega - k.wing_jacobian * m.stroke_velocity);
    expect_balance({voltage * i, -v.motor.armature_resistance * i * i, -v.motor.viscous_damping * omega * omega,
                    -v.motor.friction_torque * std::abs(omega), -m.friction_torque * omega,
                    -m.aero.moment * m.stroke_velocity, -stored, -formulation});
    EXPECT_GE(m.friction_torque * omega, 0.0);
    EXPECT_GE(m.aero.moment * m.stroke_velocity, 0.0);
    if (v.transmission.slider_crank.formulation == Formulation::virtual_work) {
      EXPECT_LE(std::abs(formulation), 1e-14 * std::abs(m.rod_force * k.crank_jacobian * omega));
    }
    ++count;
  });
  EXPECT_GT(count, 1000);
}

TEST(Motion, IntegrandsAreTheirDefinitions) {
  for_random_instants(500, [&](const MotionCase& c) {
    if (!c.unique()) return;
    const Vehicle<double>& v = c.vehicle;
    const Motion<double> m = c.on(sign_of(c.on(1.0).force_switch));
    Mode<double> mode = c.mode(sign_of(m.force_switch));
    mode.stored_power = sign_of(m.stored_moment * m.stroke_velocity);
    const auto q = integrands(m, c.omega, mode);
    const auto value = [&](Integral which) { return q[std::size_t(which)]; };
    EXPECT_EQ(value(Integral::time), 1.0);
    EXPECT_DOUBLE_EQ(value(Integral::current), c.current);
    EXPECT_DOUBLE_EQ(value(Integral::current_square), c.current * c.current);
    EXPECT_DOUBLE_EQ(value(Integral::speed_square), c.omega * c.omega);
    EXPECT_DOUBLE_EQ(value(Integral::electrical_work), c.voltage * c.current);
    EXPECT_DOUBLE_EQ(value(Integral::motor_work), m.motor_torque * c.omega);
    EXPECT_DOUBLE_EQ(value(Integral::friction_work), m.friction_torque * c.omega);
    EXPECT_DOUBLE_EQ(value(Integral::aero_work), m.aero.moment * m.stroke_velocity);
    EXPECT_DOUBLE_EQ(value(Integral::reactive_work), std::abs(m.stored_moment * m.stroke_velocity));
    EXPECT_DOUBLE_EQ(value(Integral::lift), aero_loads(v.wings, std::abs(m.stroke_velocity)).lift);
    EXPECT_DOUBLE_EQ(value(Integral::rod_force), std::abs(m.rod_force));
    EXPECT_DOUBLE_EQ(value(Integral::travel), std::abs(c.omega));
  });
}

TEST(Motion, WinglessVehicleHasNoRodForceAndSettlesAtTheNoLoadSpeed) {
  Design<double> d = reference_design();
  d.spring.stiffness = 1.377e-3;
  const Vehicle<double> v = resolve(d, Condition::wingless);
  const double omega = no_load_speed(v.motor, v.voltage);
  const double i = algebraic_current(v, v.voltage, omega);
  for (double theta = 0.0; theta < two_pi; theta += 0.37) {
    const Motion<double> m = motion_at(v, instant_of(v, theta, omega, i, v.voltage), Mode<double>{});
    EXPECT_EQ(m.rod_force, 0.0);
    EXPECT_EQ(m.aero.moment, 0.0);
    EXPECT_NEAR(m.crank_acceleration, 0.0, 1e-9);
    EXPECT_NEAR(m.inductive_voltage, 0.0, 3e-14);
  }
}

TEST(Motion, VacuumKeepsWingsAndSprings) {
  Design<double> d = reference_design();
  d.spring.stiffness = 1.377e-3;
  const Vehicle<double> air = resolve(d), vacuum = resolve(d, Condition::vacuum);
  EXPECT_EQ(vacuum.wing_inertia, air.wing_inertia);
  EXPECT_EQ(vacuum.spring.stiffness, air.spring.stiffness);
  const Motion<double> m =
      motion_at(vacuum, MotionState<double>{configuration_at(vacuum, 0.6, 0.8), 150.0, 0.1, 3.0}, Mode<double>{});
  EXPECT_EQ(m.aero.moment, 0.0);
  EXPECT_NE(m.rod_force, 0.0);
}

TEST(Motion, AlgebraicCurrentLeavesNoVoltageReserve) {
  Design<double> d = reference_design();
  d.motor.constants.armature_inductance = 0.0;
  const Vehicle<double> v = resolve(d);
  const double i = algebraic_current(v, 3.0, 120.0);
  EXPECT_NEAR(i, (3.0 - 1.2) / 9.0, 1e-16);
  EXPECT_NEAR(
      motion_at(v, MotionState<double>{configuration_at(v, 0.6, 0.8), 120.0, i, 3.0}, Mode<double>{}).inductive_voltage,
      0.0, 1e-15);
}

TEST(Motion, DesignChecksNameTheirKey) {
  const auto refused = [](auto spoil) {
    Design<double> d = reference_design();
    spoil(d);
    try {
      validate(d);
    } catch (const ParameterError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  using D = Design<double>;
  EXPECT_EQ(refused([](D&) {}), "no error");
  EXPECT_EQ(refused([](D& d) { d.mass = 0.0; }), "vehicle.mass: must be > 0 [kg], got 0");
  EXPECT_EQ(refused([](D& d) { d.motor.gear_ratio = -4.0; }), "motor.gear_ratio: must be > 0 [1], got -4");
  EXPECT_EQ(refused([](D& d) { d.transmission.stroke_amplitude = 0.7; }),
            "transmission.hinge_offset: give exactly one of hinge_offset and stroke_amplitude");
  EXPECT_EQ(refused([](D& d) {
              d.transmission.hinge_offset.reset();
              d.transmission.stroke_amplitude = 1.6;
            }),
            "transmission.stroke_amplitude: must lie between 0 and pi/2 [rad], got 1.6 (91.67 deg)");
  EXPECT_EQ(refused([](D& d) {
              d.spring.stiffness = 1e-3;
              d.spring.resonance = 22.0;
            }),
            "spring.stiffness: give one of stiffness and resonance, not both");
  EXPECT_EQ(refused([](D& d) { d.wing.count = 1.5; }), "wing.count: must be a whole number >= 1 [1], got 1.5");
  EXPECT_EQ(refused([](D& d) { d.wing.inertia = 0.0; }), "wing.inertia: must be > 0 [kg m2], got 0");
}

}  // namespace
}  // namespace wingbeat
