#include <gtest/gtest.h>

#include <cmath>

#include "parts/expect_error.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/parts/friction.hpp"
#include "wingbeat/parts/spring.hpp"
#include "wingbeat/parts/supply.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

double torque(const Friction<double>& f, double force, double omega) {
  const double direction = omega > 0.0 ? 1.0 : -1.0;
  return load_free_friction(f, omega, direction) + load_friction(f, std::abs(force), direction);
}

TEST(Friction, EachLawGivesItsTorque) {
  EXPECT_DOUBLE_EQ(torque({.radius = 2.5e-3}, -0.4, 100.0), 1e-3);
  EXPECT_DOUBLE_EQ(torque({.damping = 3e-6}, -0.4, 100.0), 3e-4);
  EXPECT_DOUBLE_EQ(torque({.quadratic = 2e-8}, -0.4, 100.0), 2e-4);
  EXPECT_DOUBLE_EQ(torque({.torque = 4e-4}, -0.4, 100.0), 4e-4);
  EXPECT_EQ(torque({}, -0.4, 100.0), 0.0);
}

TEST(Friction, DissipatesForEitherDirectionAndEitherSignOfForce) {
  const Friction<double> laws[] = {
      {.radius = 2.5e-3}, {.damping = 3e-6}, {.quadratic = 2e-8}, {.torque = 4e-4}, {2.5e-3, 3e-6, 2e-8, 4e-4}};
  for (const Friction<double>& law : laws) {
    for (const double omega : {-150.0, -1e-9, 1e-9, 150.0}) {
      for (const double force : {-0.8, 0.3}) {
        EXPECT_GT(torque(law, force, omega) * omega, 0.0);
        EXPECT_DOUBLE_EQ(torque(law, force, -omega), -torque(law, force, omega));
        EXPECT_DOUBLE_EQ(torque(law, -force, omega), torque(law, force, omega));
      }
    }
  }
}

TEST(Friction, LawsAddUp) {
  const Friction<double> all{2.5e-3, 3e-6, 2e-8, 4e-4};
  EXPECT_DOUBLE_EQ(torque(all, 0.4, -100.0), -(1e-3 + 3e-4 + 2e-4 + 4e-4));
}

TEST(Friction, DesignLawReachesItsOwnCoefficientOnly) {
  Design<double> d = reference_design();
  const auto resolved = [&](FrictionLaw law) {
    d.friction = {law, 0.125};
    return resolve(d).friction;
  };
  const auto expect = [](const Friction<double>& f, double radius, double damping, double quadratic, double constant) {
    EXPECT_EQ(f.radius, radius);
    EXPECT_EQ(f.damping, damping);
    EXPECT_EQ(f.quadratic, quadratic);
    EXPECT_EQ(f.torque, constant);
  };
  expect(resolved(FrictionLaw::none), 0.0, 0.0, 0.0, 0.0);
  expect(resolved(FrictionLaw::load_proportional), 0.125, 0.0, 0.0, 0.0);
  expect(resolved(FrictionLaw::viscous), 0.0, 0.125, 0.0, 0.0);
  expect(resolved(FrictionLaw::quadratic), 0.0, 0.0, 0.125, 0.0);
  expect(resolved(FrictionLaw::constant), 0.0, 0.0, 0.0, 0.125);
}

TEST(Friction, RefusesNegativeCoefficients) {
  using F = Friction<double>;
  EXPECT_NO_THROW(validate(F{}));
  EXPECT_EQ(refusal(F{}, [](F& f) { f.radius = -2.5e-3; }), "friction.radius: must be >= 0 [m], got -0.0025 (-2.5 mm)");
  EXPECT_EQ(refusal(F{}, [](F& f) { f.damping = -1.0; }), "friction.damping: must be >= 0 [N m s/rad], got -1");
  EXPECT_EQ(refusal(F{}, [](F& f) { f.quadratic = -1.0; }), "friction.coefficient: must be >= 0 [N m s2/rad2], got -1");
  EXPECT_EQ(refusal(F{}, [](F& f) { f.torque = -1.0; }), "friction.torque: must be >= 0 [N m], got -1");
}

TEST(HingeSpring, EnergyIsTheIntegralOfTheMoment) {
  const HingeSpring<double> s{1.377e-3};
  for (const double end : {-0.7, 0.0, 0.9}) {
    // Two-point Gauss quadrature is exact for a linear moment.
    const double half = 0.5 * end, node = half / std::sqrt(3.0);
    const double work = half * (spring_loads(s, half - node).moment + spring_loads(s, half + node).moment);
    EXPECT_NEAR(spring_loads(s, end).energy, work, 1e-18);
    EXPECT_GE(spring_loads(s, end).energy, 0.0);
  }
}

TEST(HingeSpring, MomentGrowsWithTheStrokeAngle) {
  const HingeSpring<double> s{2e-3};
  EXPECT_DOUBLE_EQ(spring_loads(s, 0.5).moment, 1e-3);
  EXPECT_DOUBLE_EQ(spring_loads(s, -0.5).moment, -1e-3);
  EXPECT_EQ(spring_loads(s, 0.0).moment, 0.0);
  EXPECT_EQ(spring_loads(HingeSpring<double>{}, 0.5).energy, 0.0);
}

TEST(HingeSpring, StiffnessForResonanceTunesTheWing) {
  const double inertia = 7.205e-8;
  const double k = stiffness_for_resonance(inertia, 22.0);
  EXPECT_NEAR(k, 1.377e-3, 5e-7);
  EXPECT_NEAR(std::sqrt(k / inertia) / two_pi, 22.0, 1e-12);
  EXPECT_EQ(stiffness_for_resonance(inertia, 0.0), 0.0);
  Design<double> d = reference_design();
  d.spring.resonance = 22.0;
  EXPECT_DOUBLE_EQ(resolve(d).spring.stiffness, k);
}

TEST(HingeSpring, RefusesNegativeStiffness) {
  EXPECT_EQ(refusal(HingeSpring<double>{}, [](HingeSpring<double>& s) { s.stiffness = -1e-3; }),
            "spring.stiffness: must be >= 0 [N m/rad], got -0.001");
}

TEST(Supply, ConstantVoltageDoesNotDependOnTime) {
  const Supply<double> s{.voltage = 3.0};
  EXPECT_EQ(voltage_at(s, 0.0), 3.0);
  EXPECT_EQ(voltage_at(s, 17.3), 3.0);
  EXPECT_EQ(mean_voltage(s), 3.0);
}

TEST(Supply, SineStartsAtZeroAndRepeats) {
  const Supply<double> s{SupplyType::sine, 3.0, 25.0, 1.0};
  EXPECT_EQ(voltage_at(s, 0.0), 0.0);
  EXPECT_NEAR(voltage_at(s, 0.01), 3.0, 1e-14);
  EXPECT_NEAR(voltage_at(s, 0.03), -3.0, 1e-13);
  EXPECT_NEAR(voltage_at(s, 0.0123), voltage_at(s, 0.0123 + 0.4), 1e-12);
}

TEST(Supply, PwmIsOnForItsDutyAndAveragesToIt) {
  const Supply<double> s{SupplyType::pwm, 4.0, 1000.0, 0.3};
  EXPECT_EQ(voltage_at(s, 0.0), 4.0);
  EXPECT_EQ(voltage_at(s, 0.2999e-3), 4.0);
  EXPECT_EQ(voltage_at(s, 0.3001e-3), 0.0);
  EXPECT_EQ(voltage_at(s, 0.9999e-3), 0.0);
  EXPECT_EQ(voltage_at(s, 7.1e-3), 4.0);
  EXPECT_DOUBLE_EQ(mean_voltage(s), 1.2);
  double sum = 0.0;
  for (int n = 0; n < 10000; ++n) sum += voltage_at(s, (n + 0.5) * 1e-7);
  EXPECT_NEAR(sum / 10000.0, mean_voltage(s), 1e-12);
}

TEST(Supply, PwmLimitsAreOffAndOn) {
  for (double t = 0.0; t < 3e-3; t += 1.3e-4) {
    EXPECT_EQ(voltage_at({SupplyType::pwm, 4.0, 1000.0, 0.0}, t), 0.0);
    EXPECT_EQ(voltage_at({SupplyType::pwm, 4.0, 1000.0, 1.0}, t), 4.0);
  }
}

TEST(Supply, RefusesValuesOutOfRange) {
  using S = Supply<double>;
  const S constant{.voltage = 3.0}, sine{SupplyType::sine, 3.0, 25.0, 1.0}, pwm{SupplyType::pwm, 3.0, 25.0, 0.5};
  EXPECT_NO_THROW(validate(constant));
  EXPECT_NO_THROW(validate(sine));
  EXPECT_NO_THROW(validate(pwm));
  EXPECT_EQ(refusal(constant, [](S& s) { s.voltage = -3.0; }), "supply.voltage: must be >= 0 [V], got -3");
  EXPECT_EQ(refusal(sine, [](S& s) { s.voltage = -3.0; }), "supply.amplitude: must be >= 0 [V], got -3");
  EXPECT_EQ(refusal(sine, [](S& s) { s.frequency = 0.0; }), "supply.frequency: must be > 0 [Hz], got 0");
  EXPECT_EQ(refusal(pwm, [](S& s) { s.frequency = -1.0; }), "supply.frequency: must be > 0 [Hz], got -1");
  EXPECT_EQ(refusal(pwm, [](S& s) { s.duty = 1.5; }), "supply.duty: must lie between 0 and 1 [1], got 1.5");
}

}  // namespace
}  // namespace wingbeat
