// Direct drives whose shaft something holds at rest, or whose torque jumps where it turns back: constant friction,
// friction that follows the load, gearboxes that lose torque, with wings under the pitch law and on hinges. The orbit
// search against the simulation from rest, which shares the equations alone; the energy balance of both.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/hinged_design.hpp"
#include "vehicle/orbit_and_simulation.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/time/simulation.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

double drive_torque(const Design<double>& d) {
  return d.motor.constants.torque_constant * d.supply.voltage / d.motor.constants.armature_resistance;
}

/// A random direct drive, every second one with stops where its wings are on hinges.
Design<double> lossy_drive(std::mt19937_64& random, bool hinges, int n) {
  return hinges ? random_hinged_design(random, n % 2 == 1) : smooth_direct_design(random);
}

template <class Change>
int flapping_of(unsigned seed, bool hinges, const Change& change) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int flapping = 0;
  for (int n = 0; n < 20; ++n) {
    Design<double> d = lossy_drive(random, hinges, n);
    change(d, uniform);
    flapping += expect_orbit_as_simulated(d, n).flaps;
  }
  return flapping;
}

TEST(DirectLosses, ConstantFrictionWithWingsOnHinges) {
  EXPECT_GE(flapping_of(31, true,
                        [](Design<double>& d, const auto& uniform) {
                          d.friction = {FrictionLaw::constant, uniform(0.01, 0.25) * drive_torque(d)};
                        }),
            16);
}

TEST(DirectLosses, FrictionByTheLoad) {
  for (const bool hinges : {false, true}) {
    EXPECT_GE(flapping_of(32, hinges,
                          [](Design<double>& d, const auto& uniform) {
                            d.friction = {FrictionLaw::load_proportional, uniform(1e-4, 1.5e-3), 5e-3};
                          }),
              16);
  }
}

TEST(DirectLosses, GearboxesThatLoseTorque) {
  for (const bool hinges : {false, true}) {
    EXPECT_GE(flapping_of(33, hinges,
                          [](Design<double>& d, const auto& uniform) { d.motor.gear_efficiency = uniform(0.6, 0.95); }),
              16);
  }
}

TEST(DirectLosses, AllOfThemTogether) {
  EXPECT_GE(flapping_of(34, true,
                        [](Design<double>& d, const auto& uniform) {
                          d.motor.gear_efficiency = uniform(0.7, 0.95);
                          d.motor.constants.friction_torque = uniform(0.0, 0.05) * drive_torque(d);
                          d.friction = {FrictionLaw::load_proportional, uniform(1e-4, 1e-3), 5e-3};
                        }),
            14);
}

// A spring that a lossy gearbox holds: between eta and 1 / eta times its moment the motor does not move it.
TEST(DirectLosses, AGearboxHoldsTheShaftBetweenItsTorques) {
  Design<double> d = direct_design();
  d.motor.gear_efficiency = 0.7;
  d.motor.constants.armature_inductance = 0.0;
  const Vehicle<double> v = resolve(d);
  constexpr double beta = 0.3;
  const double moment = v.wing_count * v.spring.stiffness * beta, K = v.motor.torque_constant;
  for (const double torque : {0.69 * moment, 0.71 * moment, 1.42 * moment, 1.44 * moment}) {
    SimulationOptions options;
    options.angle = beta;
    Simulation shaft(v, {}, options);
    shaft.command(torque / K * circuit_resistance(v));
    shaft.step_to(1e-4);
    EXPECT_EQ(shaft.stands(), torque > 0.7 * moment && torque < moment / 0.7) << torque / moment;
    const double direction = torque > moment / 0.7 ? 1.0 : torque < 0.7 * moment ? -1.0 : 0.0;
    EXPECT_EQ(shaft.state()[1] == 0.0, direction == 0.0);
    EXPECT_GE(direction * shaft.state()[1], 0.0);
  }
}

// The load's friction is that of a shaft in a bearing: mu r_e over r_ref times the wings' moment.
TEST(DirectLosses, FrictionByTheLoadIsAShareOfTheMoment) {
  Design<double> d = direct_design();
  d.friction = {FrictionLaw::load_proportional, 1e-3, 5e-3};
  const Vehicle<double> v = resolve(d);
  const SteadyFlapping s = find_steady_flapping(v, {.tolerance = 1e-9});
  ASSERT_EQ(s.status, FlappingStatus::flapping);
  for (int n = 0; n < 40; ++n) {
    const WaveformRow row = s.record.at(two_pi * (n + 0.5) / 40.0);
    const double moment = row.inertial_moment + row.aero_moment + row.spring_moment;
    EXPECT_NEAR(row.friction_torque, 0.2 * std::abs(moment) * (row.crank_speed < 0.0 ? -1.0 : 1.0),
                1e-9 * std::abs(moment) + 1e-12);
  }
}

}  // namespace
}  // namespace wingbeat
