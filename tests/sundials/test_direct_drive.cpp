// The direct drive: closed forms, the orbit against the simulation in time, sticking, and how each tie of frequency,
// spring and inertia resolves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "vehicle/direct_design.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/cycle/direct_balance.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;

/// Largest relative deviation of metrics that both have. What vanishes over a period of a symmetric motion, the mean
/// current and what follows from it, is assessed beside the peak.
double deviation(const Metrics<double>& a, const Metrics<double>& b, std::string& where) {
  double worst = 0.0;
  for (int m = 0; m < metric_count; ++m) {
    const Metric which = Metric(m);
    if (which == Metric::floquet_multiplier_max) continue;
    const double x = a[which], y = b[which];
    EXPECT_EQ(std::isnan(x), std::isnan(y)) << metric_table()[std::size_t(m)].key;
    if (std::isnan(x)) continue;
    double scale = std::abs(x);
    if (which == Metric::current_mean) scale = a[Metric::current_peak];
    if (which == Metric::power_motor_reference) scale = a[Metric::power_electrical];
    if (which == Metric::power_residual) scale = a[Metric::power_electrical];
    // An angle of attack near zero degrees has no meaningful relative error.
    if (which == Metric::angle_of_attack_min) scale = std::max(scale, 10.0);
    const double off = scale > 0.0 ? std::abs(x - y) / scale : std::abs(x - y);
    if (!(off <= worst)) worst = off, where = metric_table()[std::size_t(m)].key;
  }
  return worst;
}

TEST(DirectDrive, OrbitAgreesWithTheSimulationOfRandomVehicles) {
  std::mt19937_64 random(11);
  int flapping = 0, sticking = 0;
  for (int n = 0; n < 120; ++n) {
    const Design<double> design = random_direct_design(random, n % 2 == 1);
    const Vehicle<double> vehicle = resolve(design);
    const Reporting reporting = reporting_of(design);
    const SteadyFlapping orbit = find_steady_flapping(vehicle, {.tolerance = 1e-8, .reporting = reporting});
    TransientOptions options;
    options.tolerance = 1e-7;
    options.reporting = reporting;
    const TransientResult transient = simulate_start_up(vehicle, options);
    ASSERT_EQ(orbit.status, transient.status)
        << "vehicle " << n << ": " << describe(orbit.evidence) << " / " << describe(transient.evidence);
    ASSERT_TRUE(transient.settled) << "vehicle " << n << ": " << describe(transient.evidence);
    if (orbit.status != FlappingStatus::flapping) continue;
    ++flapping;
    for (const TransientEvent& e : transient.events) {
      if (e.kind == TransientEvent::Kind::breakaway && e.time > transient.end_time - 1.0 / vehicle.drive_frequency) {
        ++sticking;
        break;
      }
    }
    std::string where;
    EXPECT_LT(deviation(orbit.metrics, *transient.metrics, where), 1e-6) << "vehicle " << n << ", " << where;
  }
  EXPECT_GE(flapping, 115);
  EXPECT_GE(sticking, 15);
}

TEST(DirectDrive, TightensToTheToleranceAskedFor) {
  std::mt19937_64 random(12);
  for (int n = 0; n < 60; ++n) {
    const Vehicle<double> vehicle = resolve(random_direct_design(random, n % 2 == 1));
    const SteadyFlapping tight = find_steady_flapping(vehicle, {.tolerance = 1e-12});
    ASSERT_EQ(tight.status, FlappingStatus::flapping) << n << ": " << describe(tight.evidence);
    for (const double tolerance : {1e-4, 1e-6, 1e-9}) {
      const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = tolerance});
      ASSERT_EQ(found.status, FlappingStatus::flapping) << n << ": " << describe(found.evidence);
      std::string where;
      EXPECT_LT(deviation(tight.metrics, found.metrics, where), 4.0 * tolerance) << "vehicle " << n << ", " << where;
    }
  }
}

TEST(DirectDrive, EnergyBooksClose) {
  std::mt19937_64 random(13);
  for (int n = 0; n < 60; ++n) {
    const Vehicle<double> vehicle = resolve(random_direct_design(random, n % 2 == 1));
    const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = 1e-12});
    ASSERT_EQ(found.status, FlappingStatus::flapping) << n << ": " << describe(found.evidence);
    const EnergyAudit audit = energy_audit(found.metrics);
    EXPECT_LT(std::abs(audit.imbalance), 2e-12 * audit.electrical) << n;
    EXPECT_EQ(audit.residual, 0.0);
  }
}

TEST(DirectDrive, WithoutAirTheResponseIsTheComplexImpedances) {
  std::mt19937_64 random(14);
  for (int n = 0; n < 40; ++n) {
    Design<double> d = random_direct_design(random, false);
    d.friction = {FrictionLaw::viscous, 2e-6};
    const Vehicle<double> v = resolve(d, Condition::vacuum);
    const SteadyFlapping found = find_steady_flapping(v, {.tolerance = 1e-11});
    ASSERT_EQ(found.status, FlappingStatus::flapping) << n << ": " << describe(found.evidence);
    const double w = two_pi * d.supply.frequency;
    const auto [speed, current] = linear_response(v);
    const Metrics<double>& m = found.metrics;
    EXPECT_NEAR(m[Metric::stroke_amplitude] * w / std::abs(speed), 1.0, 1e-10) << n;
    EXPECT_NEAR(m[Metric::flapping_velocity_peak] / std::abs(speed), 1.0, 1e-10) << n;
    EXPECT_NEAR(m[Metric::current_peak] / std::abs(current), 1.0, 1e-10) << n;
    EXPECT_NEAR(m[Metric::power_electrical] / (0.5 * v.voltage * current.real()), 1.0, 1e-9) << n;
    EXPECT_NEAR(m[Metric::frequency] / d.supply.frequency, 1.0, 1e-14) << n;
  }
}

TEST(DirectDrive, SmallAmplitudesResonateWithTotalInertia) {
  // At a small voltage the air is nothing: velocity is in phase with the voltage at resonance, and largest there.
  Design<double> d = direct_design();
  d.supply.voltage = 1e-7;
  d.motor.constants.armature_inductance = 0.0;
  const auto peak = [&](double ratio) {
    d.supply_resonance_ratio = ratio;
    const SteadyFlapping found = find_steady_flapping(resolve(d), {.tolerance = 1e-11});
    EXPECT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
    return found;
  };
  const SteadyFlapping resonant = peak(1.0);
  const Motor<double>& m = d.motor.constants;
  const double K = m.torque_constant;
  const double closed = K * 1e-7 / (K * K + m.armature_resistance * m.viscous_damping);
  EXPECT_NEAR(resonant.metrics[Metric::flapping_velocity_peak] / closed, 1.0, 1e-6);
  EXPECT_NEAR(resonant.crank_speed / closed, 0.0, 1e-6);
  EXPECT_NEAR(resonant.metrics[Metric::frequency], 22.0, 1e-12);
  EXPECT_LT(peak(0.99).metrics[Metric::flapping_velocity_peak], resonant.metrics[Metric::flapping_velocity_peak]);
  EXPECT_LT(peak(1.01).metrics[Metric::flapping_velocity_peak], resonant.metrics[Metric::flapping_velocity_peak]);
}

TEST(DirectDrive, PeakSpeedAtResonanceSolvesTheHarmonicBalance) {
  // (8 / (3 pi)) Gamma Omega^2 + (K^2/R_a + b) Omega = K V/R_a, Gamma = rho C_D S_3/2: the heavier the wings, the more
  // harmonic the response and the closer.
  Design<double> d = direct_design();
  d.motor.constants.armature_inductance = 0.0;
  d.aerodynamics.pitch_coefficient = 0.0;
  double before = 1.0;
  for (const double heavier : {1.0, 10.0, 100.0}) {
    d.wing.inertia = heavier * 7.205e-8;
    const Vehicle<double> v = resolve(d);
    const double K = v.motor.torque_constant, R_a = v.motor.armature_resistance;
    const double gamma = aero_loads(v.wings, 1.0).moment;
    EXPECT_NEAR(gamma, 0.5 * 1.225 * drag_coefficient(v.wings.coefficients, pi / 2.0) * 1.048e-7, 1e-18);
    const double a = 8.0 / (3.0 * pi) * gamma, b = K * K / R_a + v.motor.viscous_damping, c = K * v.voltage / R_a;
    const double closed = (-b + std::sqrt(b * b + 4.0 * a * c)) / (2.0 * a);
    const SteadyFlapping found = find_steady_flapping(v, {.tolerance = 1e-9});
    const double off = std::abs(found.metrics[Metric::flapping_velocity_peak] / closed - 1.0);
    EXPECT_LT(off, 0.4 * before);
    before = off;
    // The first guess of the orbit is this balance.
    const DirectBalance balance = direct_balance(v);
    ASSERT_EQ(balance.responses.size(), 1u);
    EXPECT_NEAR(std::abs(balance.responses.front().speed) / closed, 1.0, 1e-6);
  }
  EXPECT_LT(before, 1e-3);
}

TEST(DirectDrive, FreeSwingsLoseTwoFrictionAnglesEachAndStick) {
  // Without voltage and with a resistance that lets no current flow, only springs and constant friction act: each half
  // swing takes half a natural period and ends 2 T_c / (N k) nearer to the middle.
  Design<double> d = direct_design();
  d.supply.voltage = 0.0;
  d.motor.constants.armature_resistance = 1e15;
  d.motor.constants.armature_inductance = 0.0;
  d.motor.constants.viscous_damping = 0.0;
  d.friction = {FrictionLaw::constant, 2e-5};
  d.motor.constants.friction_torque = 1e-5;
  const Vehicle<double> v = resolve(d, Condition::vacuum);
  TransientOptions options;
  options.tolerance = 1e-9;
  options.start.angle = 0.3;
  const TransientResult r = simulate_start_up(v, options);
  const double step = 2.0 * 3e-5 / (2.0 * v.spring.stiffness);
  std::vector<TransientEvent> turns;
  for (const TransientEvent& e : r.events) {
    if (e.kind == TransientEvent::Kind::standstill) turns.push_back(e);
  }
  const auto expected = std::size_t(std::ceil((0.3 - 0.5 * step) / step));
  ASSERT_EQ(turns.size(), expected);
  ASSERT_GT(expected, 4u);
  for (std::size_t n = 0; n < turns.size(); ++n) {
    const double sign = n % 2 == 0 ? -1.0 : 1.0;
    EXPECT_NEAR(turns[n].crank_angle, sign * (0.3 - double(n + 1) * step), 1e-9) << n;
    EXPECT_NEAR(turns[n].time, double(n + 1) * 0.5 / 22.0, 1e-9) << n;
  }
  EXPECT_EQ(r.status, FlappingStatus::stalled);
  EXPECT_TRUE(r.settled);
  EXPECT_THAT(describe(r.evidence), HasSubstr("rests at stroke angle"));
  EXPECT_EQ(r.end_crank_angle, turns.back().crank_angle);
}

TEST(DirectDrive, SticksExactlyAsLongAsFrictionHolds) {
  Design<double> d = direct_design();
  d.motor.constants.armature_inductance = 2e-3;
  d.friction = {FrictionLaw::constant, 2.2e-3};
  const Vehicle<double> v = resolve(d);
  const SteadyFlapping found = find_steady_flapping(v, {.tolerance = 1e-9});
  ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
  int stuck = 0, slipping = 0;
  for (const WaveformRow& row : found.record.waveform(2001)) {
    const double net_torque = v.motor.torque_constant * row.current - 2.0 * v.spring.stiffness * row.stroke_angle;
    if (row.flapping_velocity == 0.0) {
      ++stuck;
      EXPECT_LE(std::abs(net_torque), 2.2e-3 * (1.0 + 1e-8));
      EXPECT_NEAR(row.friction_torque, net_torque, 1e-12);
    } else {
      ++slipping;
      EXPECT_NEAR(row.friction_torque, std::copysign(2.2e-3, row.flapping_velocity), 1e-15);
    }
  }
  EXPECT_GT(stuck, 200);
  EXPECT_GT(slipping, 200);
}

TEST(DirectDrive, ASupplyTooWeakToBreakAwayIsStalled) {
  Design<double> d = direct_design();
  const double w = two_pi * 22.0;
  const double drive = 0.01 * 3.0 / std::hypot(9.0, w * 29e-3);
  for (const double friction : {0.97 * drive, 1.001 * drive}) {
    d.friction = {FrictionLaw::constant, friction};
    const Vehicle<double> v = resolve(d);
    const SteadyFlapping found = find_steady_flapping(v);
    const TransientResult transient = simulate_start_up(v);
    EXPECT_EQ(found.status, friction < drive ? FlappingStatus::flapping : FlappingStatus::stalled)
        << describe(found.evidence);
    EXPECT_EQ(transient.status, found.status) << describe(transient.evidence);
    EXPECT_TRUE(transient.settled);
    if (friction < drive) continue;
    EXPECT_THAT(describe(found.evidence), HasSubstr("the motor never breaks away: at 22 Hz"));
    EXPECT_TRUE(std::isnan(found.metrics[Metric::frequency]));
  }
  d.friction = {FrictionLaw::none, 0.0};
  d.supply.voltage = 0.0;
  EXPECT_EQ(find_steady_flapping(resolve(d)).status, FlappingStatus::stalled);
}

TEST(DirectDrive, WithoutWingsTheRotorSwingsAlone) {
  const Vehicle<double> v = resolve(direct_design(), Condition::wingless);
  const SteadyFlapping found = find_steady_flapping(v, {.tolerance = 1e-9});
  ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
  const double w = two_pi * 22.0;
  const std::complex<double> j(0.0, 1.0), electrical = 9.0 + j * w * 29e-3;
  const auto speed = 0.01 * 3.0 / (electrical * (3.6e-6 + j * w * 1.5e-7) + 1e-4);
  EXPECT_NEAR(found.metrics[Metric::flapping_velocity_peak] / std::abs(speed), 1.0, 1e-8);
  EXPECT_TRUE(std::isnan(found.metrics[Metric::floquet_multiplier_max]));
  EXPECT_EQ(found.metrics[Metric::lift_mean], 0.0);
}

TEST(DirectDrive, HasNoRodAndNoCrankSpeed) {
  const SteadyFlapping found = find_steady_flapping(resolve(direct_design()));
  for (const Metric m :
       {Metric::rod_force_peak, Metric::rod_force_mean, Metric::crank_speed_min, Metric::crank_speed_max}) {
    EXPECT_TRUE(std::isnan(found.metrics[m]));
  }
  EXPECT_EQ(found.metrics[Metric::voltage], 3.0);
  for (const WaveformRow& row : found.record.waveform(5)) EXPECT_TRUE(std::isnan(row.rod_force));
}

TEST(DirectDrive, FrequencySpringAndInertiaFollowFromEachOther) {
  Design<double> d = direct_design();
  const double total = 1.5e-7 + 2.0 * 7.205e-8;
  const double k = 0.5 * total * square(two_pi * 22.0);
  EXPECT_NEAR(resolve(d).spring.stiffness / k, 1.0, 1e-15);
  d.spring = {};
  d.spring.stiffness = k;
  d.supply_resonance_ratio = 1.1;
  EXPECT_NEAR(resolve(d).drive_frequency, 1.1 * 22.0, 1e-12);
  EXPECT_NEAR(resolve(d, Condition::wingless).drive_frequency, 1.1 * 22.0, 1e-12);
  d.supply_resonance_ratio.reset();
  d.supply.frequency = 20.0;
  d.spring = {};
  d.spring.resonance_ratio = 1.1;
  EXPECT_NEAR(resolve(d).spring.stiffness / k, 1.0, 1e-14);
  d.spring = {};
  d.spring.stiffness = k;
  d.wing.resonance = 22.0;
  EXPECT_NEAR(resolve(d).wing_inertia / 7.205e-8, 1.0, 1e-14);
  EXPECT_NO_THROW(validate(d));
  // A crank's spring resonates with one wing, as in eq (22).
  Design<double> crank = reference_design();
  crank.spring.resonance = 22.0;
  EXPECT_EQ(resolve(crank).spring.stiffness, 7.205e-8 * square(two_pi * 22.0));
}

TEST(DirectDrive, ValidateNamesWhatItCannotHave) {
  const auto refused = [](const auto& change) {
    Design<double> d = direct_design();
    change(d);
    try {
      validate(d);
    } catch (const ParameterError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  using D = Design<double>;
  EXPECT_EQ(refused([](D&) {}), "accepted");
  EXPECT_EQ(
      refused([](D& d) { d.friction = {FrictionLaw::load_proportional, 1e-3}; }),
      "friction.reference_radius: missing: load-proportional friction of a direct drive acts on the wings' moment "
      "over this radius, at which the shaft takes it up");
  EXPECT_EQ(refused([](D& d) { d.friction = {FrictionLaw::load_proportional, 5e-3, 5e-3}; }),
            "friction.radius: must be < friction.reference_radius, 0.005 m: such friction would exceed any moment, got "
            "0.005 m");
  EXPECT_EQ(refused([](D& d) { d.friction = {FrictionLaw::viscous, 1e-6, 5e-3}; }),
            "friction.reference_radius: is where load-proportional friction acts: friction.type is viscous");
  EXPECT_EQ(refused([](D& d) { d.supply.type = SupplyType::constant; }),
            "supply.type: a direct drive swings as its supply does: expected sine or battery-sine");
  EXPECT_EQ(refused([](D& d) { d.supply_resonance_ratio = 0.0; }), "supply.resonance_ratio: must be > 0 [1], got 0");
  EXPECT_EQ(refused([](D& d) { d.spring = {}, d.supply_resonance_ratio = 1.0; }),
            "supply.resonance_ratio: needs springs to resonate with; give spring.stiffness or spring.resonance");
  EXPECT_EQ(refused([](D& d) { d.spring = {}, d.spring.resonance_ratio = d.supply_resonance_ratio = 1.0; }),
            "supply.resonance_ratio: ties the frequency to the springs, which spring.resonance_ratio ties to the "
            "frequency; give one of them");
  EXPECT_EQ(refused([](D& d) { d.spring = {}, d.spring.stiffness = 0.0, d.supply_resonance_ratio = 1.0; }),
            "supply.resonance_ratio: the springs' stiffness is 0: nothing resonates");
  EXPECT_EQ(refused([](D& d) { d.wing.resonance = 22.0; }),
            "wing.resonance: gives the inertia that resonates on a known spring; give spring.stiffness");
  EXPECT_EQ(refused([](D& d) { d.spring = {}, d.spring.stiffness = 1e-3, d.wing.resonance = 100.0; }),
            "wing.resonance: leaves the wings no inertia beside the rotor's: must be lower [Hz], got 100");
  EXPECT_EQ(refused([](D& d) { d.aerodynamics.angle_of_attack_min = 1.6; }),
            "aerodynamics.angle_of_attack_min: must be >= 0 and < pi/2 [rad], got 1.6 (91.67 deg)");
}

TEST(PitchStop, OrbitOfCranksAgreesWithTheSimulation) {
  std::mt19937_64 random(15);
  int flapping = 0, stopped = 0;
  for (int n = 0; n < 60; ++n) {
    Design<double> design = random_design(random);
    design.aerodynamics.angle_of_attack_min = std::uniform_real_distribution<double>(0.5, 1.3)(random);
    const Vehicle<double> vehicle = resolve(design);
    const Reporting reporting = reporting_of(design);
    const SteadyFlapping orbit =
        find_steady_flapping(vehicle, {.tolerance = 1e-8, .reporting = reporting}, start_up_in_time());
    if (orbit.status != FlappingStatus::flapping) continue;
    TransientOptions options;
    options.tolerance = 1e-7;
    options.reporting = reporting;
    const TransientResult transient = simulate_start_up(vehicle, options);
    ASSERT_EQ(transient.status, FlappingStatus::flapping) << n << ": " << describe(transient.evidence);
    ++flapping;
    const double least = degrees_per_radian * *design.aerodynamics.angle_of_attack_min;
    EXPECT_GE(orbit.metrics[Metric::angle_of_attack_min], least * (1.0 - 1e-15));
    stopped += orbit.metrics[Metric::angle_of_attack_min] == least ? 1 : 0;
    std::string where;
    EXPECT_LT(deviation(orbit.metrics, *transient.metrics, where), 1e-6) << "vehicle " << n << ", " << where;
  }
  EXPECT_GE(flapping, 40);
  EXPECT_GE(stopped, 15);
}

TEST(PitchStop, HoldsTheAngleOfAttackFromBelow) {
  Vehicle<double> v = reference_vehicle();
  v.wings.angle_of_attack_min = pi / 4.0;
  const double at_stop = (pi / 2.0 - pi / 4.0) / v.wings.pitch_coefficient;
  EXPECT_EQ(aero_loads(v.wings, 1.5 * at_stop).angle_of_attack, pi / 4.0);
  EXPECT_NEAR(aero_loads(v.wings, at_stop).angle_of_attack, pi / 4.0, 1e-15);
  EXPECT_EQ(aero_loads(v.wings, 0.5 * at_stop).angle_of_attack,
            aero_loads(reference_vehicle().wings, 0.5 * at_stop).angle_of_attack);
  // Above the stop lift and drag are quadratic in speed.
  EXPECT_NEAR(aero_loads(v.wings, 3.0 * at_stop).lift / aero_loads(v.wings, 1.5 * at_stop).lift, 4.0, 1e-14);
  EXPECT_NEAR(aero_loads(v.wings, 3.0 * at_stop).moment / aero_loads(v.wings, 1.5 * at_stop).moment, 4.0, 1e-14);
}

}  // namespace
}  // namespace wingbeat
