// A gearbox that loses torque: closed forms, statics, energy balance, orbit against simulation in time, derivatives.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "vehicle/kind_boxes.hpp"
#include "vehicle/orbit_and_simulation.hpp"
#include "vehicle/orbit_derivatives.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

Vehicle<double> with_gear(double efficiency, bool springs = false) {
  Vehicle<double> v = reference_vehicle(springs);
  v.motor.gear_efficiency = efficiency;
  return v;
}

SteadyFlapping orbit_of(const Vehicle<double>& v, double tolerance) {
  return find_steady_flapping(v, {.tolerance = tolerance}, start_up_in_time());
}

// Of the four branches exactly one agrees with itself, and there the gearbox passes e times the motor's torque.
TEST(GearEfficiency, OneBranchHoldsAndTheGearboxOnlyTakes) {
  std::mt19937_64 random(91);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int driven = 0, states = 0;
  for (int n = 0; n < 4000; ++n) {
    Vehicle<double> v = resolve(random_design(random));
    v.motor.gear_efficiency = uniform(0.4, 1.0);
    const double theta = uniform(0.0, two_pi), omega = uniform(5.0, 400.0), i = uniform(-0.2, 0.5);
    const CrankKinematics<double> k = crank_kinematics(v.transmission, std::sin(theta), std::cos(theta));
    if (!(min_inertia(v, k) > 0.0) || !(k.wing_jacobian > 0.0)) continue;
    ++states;
    int agree = 0;
    for (const double gear : {1.0, -1.0}) {
      for (const double force : {1.0, -1.0}) {
        const Mode<double> mode{sign_of(k.stroke_slope), force, 1.0, 1.0, 1.0, gear};
        const Motion<double> m = motion_at(
            v, MotionState<double>{configuration_at(v, std::sin(theta), std::cos(theta)), omega, i, 3.0}, mode);
        if (m.force_switch * force < 0.0 || m.gear_torque * gear < 0.0) continue;
        ++agree;
        driven += gear < 0.0 ? 1 : 0;
        const Motor<double>& motor = v.motor;
        const double T_g = motor.torque_constant * i - motor.viscous_damping * omega - motor.friction_torque -
                           motor.inertia * m.crank_acceleration;
        const double e = gear > 0.0 ? motor.gear_efficiency : 1.0 / motor.gear_efficiency;
        const double behind = m.motor_torque;
        const double size = std::abs(T_g) + std::abs(m.rod_force * k.crank_jacobian) + std::abs(m.friction_torque);
        EXPECT_NEAR(m.gear_torque, T_g, 1e-12 * size);
        EXPECT_NEAR(behind, e * T_g, 1e-11 * size);
        EXPECT_NEAR(m.gear_loss, (T_g - behind) * omega, 1e-11 * size * omega);
        EXPECT_GE(m.gear_loss, 0.0);
      }
    }
    EXPECT_EQ(agree, 1) << n;
  }
  EXPECT_GT(states, 2000);
  EXPECT_GT(driven, 300);
}

// Wings away, the motor turns viscous friction of the mechanism through the gearbox at constant speed.
TEST(GearEfficiency, ConstantSpeedIsTheClosedForm) {
  for (const double eta : {1.0, 0.8, 0.5}) {
    Vehicle<double> v = wingless_vehicle();
    const double K = v.motor.torque_constant, R = v.motor.armature_resistance, b = v.motor.viscous_damping;
    const double b_f = 4e-6, T_own = 2e-4;
    v.friction = {};
    v.friction.damping = b_f;
    v.motor.friction_torque = T_own;
    v.motor.gear_efficiency = eta;
    const double omega = (K * v.voltage / R - T_own) / (K * K / R + b + b_f / eta);
    const SteadyFlapping found = orbit_of(v, 1e-10);
    ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
    EXPECT_NEAR(two_pi * found.metrics[Metric::frequency] / omega, 1.0, 1e-9);
    const Metrics<double>& m = found.metrics;
    EXPECT_NEAR(m[Metric::power_gear], (1.0 / eta - 1.0) * b_f * square(omega), 1e-9);
    EXPECT_NEAR(m[Metric::power_motor_friction], T_own * omega, 1e-9);
    EXPECT_NEAR(m[Metric::power_friction], b_f * square(omega), 1e-9);
    EXPECT_NEAR(m[Metric::power_motor], b_f * square(omega), 1e-9);
    EXPECT_NEAR(energy_audit(found.metrics).imbalance, 0.0, 1e-9 * found.metrics[Metric::power_electrical]);
  }
}

TEST(GearEfficiency, ApproachesTheIdealGearbox) {
  for (const bool springs : {false, true}) {
    const SteadyFlapping ideal = orbit_of(reference_vehicle(springs), 1e-10);
    EXPECT_EQ(ideal.metrics[Metric::power_gear], 0.0);
    std::string where;
    EXPECT_EQ(metrics_apart(orbit_of(with_gear(1.0, springs), 1e-10).metrics, ideal.metrics, where), 0.0) << where;
    double before = 0.0;
    for (const double loss : {1e-2, 1e-4, 1e-6}) {
      const double off = metrics_apart(orbit_of(with_gear(1.0 - loss, springs), 1e-10).metrics, ideal.metrics, where);
      EXPECT_GT(off, 0.1 * loss);
      EXPECT_LT(off, 10.0 * loss) << where;
      if (before > 0.0) {
        EXPECT_NEAR(off / before, 1e-2, 2e-3);
      }
      before = off;
    }
  }
}

TEST(GearEfficiency, OrbitsOfRandomVehiclesAgreeWithTheSimulationAndCloseTheEnergyBalance) {
  std::mt19937_64 random(92);
  int flapping = 0, others = 0;
  for (int n = 0; n < 120; ++n) {
    Vehicle<double> v = resolve(random_design(random, 1.5));
    v.motor.gear_efficiency = std::uniform_real_distribution<double>(0.5, 1.0)(random);
    const auto [orbit, time] = orbit_and_simulation(v);
    ASSERT_EQ(orbit.status, time.status) << n << ": " << describe(orbit.evidence) << " / " << describe(time.evidence);
    if (orbit.status != FlappingStatus::flapping) {
      ++others;
      continue;
    }
    ++flapping;
    std::string where;
    EXPECT_LT(metrics_apart(orbit.metrics, *time.metrics, where), 1e-6) << "vehicle " << n << ", " << where;
    const EnergyAudit audit = energy_audit(orbit.metrics);
    EXPECT_NEAR(audit.imbalance, 0.0, 1e-7 * audit.electrical) << n;
    EXPECT_GE(audit.gear, 0.0) << n;
    // Before the gearbox: what the motor gives is what it passes on and loses.
    const double lost = audit.copper + audit.viscous + audit.motor_friction + audit.gear;
    EXPECT_NEAR(audit.electrical - lost, orbit.metrics[Metric::power_motor], 1e-7 * audit.electrical) << n;
  }
  EXPECT_GE(flapping, 70);
  EXPECT_GE(others, 3);
}

TEST(GearEfficiency, EnergyBalanceTightensWithTheTolerance) {
  for (const bool springs : {false, true}) {
    for (const double tolerance : {1e-6, 1e-10}) {
      const SteadyFlapping found = orbit_of(with_gear(0.7, springs), tolerance);
      ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
      const EnergyAudit audit = energy_audit(found.metrics);
      EXPECT_NEAR(audit.imbalance, 0.0, tolerance * audit.electrical);
      EXPECT_GT(audit.gear, 0.02 * audit.electrical);
    }
  }
}

// From rest the motor's torque passes at eta. The gearbox adds to what holds the crank either way, but a load alone
// always drives the motor back.
TEST(GearEfficiency, Statics) {
  Vehicle<double> v = reference_vehicle();
  v.friction = {};
  v.friction.torque = 0.8 * stall_torque(v);
  EXPECT_FALSE(static_balance(v).stalled());
  v.motor.gear_efficiency = 0.79;
  EXPECT_TRUE(static_balance(v).stalled());
  EXPECT_EQ(orbit_of(v, 1e-6).status, FlappingStatus::stalled);
  EXPECT_EQ(simulate_start_up(v).status, FlappingStatus::stalled);

  v = with_gear(0.8, true);
  v.friction = {};
  int uphill = 0, downhill = 0;
  for (int n = 0; n < 360; ++n) {
    const double theta = two_pi * n / 360.0;
    const CrankKinematics<double> k = crank_kinematics(v.transmission, std::sin(theta), std::cos(theta));
    const double F_s = static_rod_force(k, spring_moment(v, k)), load = F_s * k.crank_jacobian;
    const StandingTorques<double> torques = standing_torques(v, k, F_s);
    EXPECT_NEAR(torques.high, load > 0.0 ? load / 0.8 : 0.8 * load, 1e-18);
    EXPECT_NEAR(torques.low, load > 0.0 ? 0.8 * load : load / 0.8, 1e-18);
    EXPECT_LE(torques.low, torques.high);
    ++(load > 0.0 ? uphill : downhill);
  }
  EXPECT_GT(uphill, 100);
  EXPECT_GT(downhill, 100);

  // A voltage at which springs are passed without the gearbox and lock with it.
  v.voltage = 1.0;
  while (static_balance(v).can_lock()) v.voltage *= 1.02;
  v.motor.gear_efficiency = 0.6;
  ASSERT_TRUE(static_balance(v).can_lock());
  for (const LockInterval& lock : lock_intervals(v)) {
    EXPECT_NEAR(lock_margin(v, lock.from), 0.0, 1e-12);
    EXPECT_NEAR(lock_margin(v, lock.to), 0.0, 1e-12);
    EXPECT_GT(lock.margin, 0.0);
  }
}

TEST(GearEfficiency, DerivativesAgreeWithDifferences) {
  const auto parameters = [](auto& design) {
    return std::array{&*design.motor.gear_efficiency, &design.motor.constants.inertia,
                      &design.motor.constants.friction_torque, &design.friction.coefficient, &design.wing.inertia};
  };
  for (const bool springs : {false, true}) {
    Design<double> d = reference_design();
    if (springs) d.spring.stiffness = 1.377e-3;
    d.motor.gear_efficiency = 0.75;
    d.motor.constants.friction_torque = 1e-4;
    expect_orbit_derivatives(d, parameters,
                             {Metric::frequency, Metric::power_electrical, Metric::power_friction, Metric::power_gear,
                              Metric::lift_mean, Metric::rod_force_peak, Metric::crank_speed_min},
                             1e-6);
  }
  // At 1 there is none to both sides.
  Design<GradientJet> seeded = cast<GradientJet>(reference_design());
  seeded.motor.gear_efficiency = gradient_seed(1.0, 0);
  const OrbitGradient g =
      orbit_gradient(find_steady_flapping(reference_vehicle()), gradient_vehicle(seeded, Condition::air));
  EXPECT_TRUE(std::isnan(g.metrics[Metric::frequency].v[gradient_first_slot]));
}

// Its kinks beside those of the rod force: where both are one, and, with friction that does not follow the force,
// apart.
TEST(GearEfficiency, EnsemblesKnowIt) {
  std::vector<EnsembleMember> members = {{with_gear(1.0), {}}};
  for (const double friction : {0.0, 2e-6, 1e-5, 5e-5}) {
    for (const bool springs : {false, true}) {
      members.push_back({with_gear(0.8, springs), {}});
      members.back().vehicle.friction.torque = friction;
    }
  }
  members.push_back({with_gear(0.6), {}});
  members.back().vehicle.friction.radius = 0.0;
  std::vector<EnsembleOutcome> outcomes(members.size());
  solve_ensemble(members, {}, start_up_in_time(), outcomes);
  EXPECT_EQ(outcomes[0].scalar, !has_packs);
  std::size_t scalar = 0;
  for (std::size_t n = 1; n < members.size(); ++n) {
    scalar += outcomes[n].scalar ? 1 : 0;
    std::string where;
    EXPECT_LT(metrics_apart(outcomes[n].metrics, orbit_of(members[n].vehicle, 1e-9).metrics, where), 2e-6)
        << n << " " << where;
    Vehicle<double> lossless = members[n].vehicle;
    lossless.motor.gear_efficiency = 1.0;
    EXPECT_LT(outcomes[n].metrics[Metric::frequency], 0.99 * orbit_of(lossless, 1e-6).metrics[Metric::frequency]) << n;
  }
  EXPECT_LE(scalar, has_packs ? 2u : members.size());
}

// The torque on the gearbox changes sign where the rod force does and where friction and lever are as large: where
// these are close to each other, it has the other sign for less than a step.
TEST(GearEfficiency, SignChangesBesideThoseOfTheRodForce) {
  std::mt19937_64 random(20225);
  for (int n = 0; n <= 613; ++n) {
    const Design<double> design = kind_design(KindBox::gear_loss, random);
    if (n != 370 && n != 457 && n != 613) continue;
    const Vehicle<double> v = resolve(design);
    const SteadyFlapping exact = orbit_of(v, 1e-12);
    for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
      std::string where;
      EXPECT_LT(metrics_apart(orbit_of(v, tolerance).metrics, exact.metrics, where), tolerance) << n << " " << where;
    }
  }
}

// One step holds both: two sign changes of that torque, and between them all but a double zero.
TEST(GearEfficiency, SignChangesNextToEachOther) {
  std::mt19937_64 random(20225);
  for (int n = 0; n < 3543; ++n) kind_design(KindBox::gear_loss, random);
  const Vehicle<double> v = resolve(kind_design(KindBox::gear_loss, random));
  const SteadyFlapping exact = orbit_of(v, 1e-12);
  for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8}) {
    std::string where;
    EXPECT_LT(metrics_apart(orbit_of(v, tolerance).metrics, exact.metrics, where), tolerance) << where;
  }
}

TEST(GearEfficiency, BadInputIsNamed) {
  const auto refused = [](auto change) -> std::string {
    Design<double> d = reference_design();
    change(d);
    try {
      validate(d);
    } catch (const ParameterError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused([](auto& d) { d.motor.gear_efficiency = 1.0; }), "");
  EXPECT_EQ(refused([](auto& d) { d.motor.gear_efficiency = 0.0; }),
            "motor.gear_efficiency: must be > 0 and <= 1 [1], got 0");
  EXPECT_EQ(refused([](auto& d) { d.motor.gear_efficiency = 1.01; }),
            "motor.gear_efficiency: must be > 0 and <= 1 [1], got 1.01");
}

}  // namespace
}  // namespace wingbeat
