// Piezos and brushless motors: the orbit search against the simulation from rest, which shares the equations alone; the
// energy balance of both; closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/orbit_and_simulation.hpp"
#include "vehicle/piezo_design.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/time/simulation.hpp"
#include "wingbeat/vehicle/dynamics.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

TEST(Actuators, PiezosByOrbitAndInTime) {
  std::mt19937_64 random(51);
  int flapping = 0;
  for (int n = 0; n < 25; ++n) flapping += expect_orbit_as_simulated(random_piezo_design(random), n).flaps;
  EXPECT_GE(flapping, 22);
}

TEST(Actuators, BrushlessMotorsByOrbitAndInTime) {
  std::mt19937_64 random(52);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int flapping = 0;
  for (int n = 0; n < 25; ++n) {
    Design<double> d = random_design(random, 1.6);
    d.electronics.efficiency = uniform(0.7, 1.0);
    const double stalled = d.supply.voltage / d.motor.constants.armature_resistance;
    if (n % 2) d.electronics.current_max = stalled * uniform(0.2, 0.9);
    if (n % 3 == 0) d.motor.constants.armature_inductance = 0.0;
    flapping += expect_orbit_as_simulated(d, n).flaps;
  }
  EXPECT_GE(flapping, 15);
}

// A piezo under a slow sine is a spring: x = kappa V / k, with all stiffness at the tip.
TEST(Actuators, APiezoFarBelowResonanceFollowsItsVoltage) {
  Design<double> d = piezo_design();
  d.supply.frequency = 0.5;
  d.supply.offset = 0.0;
  for (const double series : {0.0, 500.0}) {
    if (series > 0.0) d.piezo.series_stiffness = series;
    const Vehicle<double> v = resolve(d, Condition::vacuum);
    const SteadyFlapping s = find_steady_flapping(v, {.tolerance = 1e-9});
    ASSERT_EQ(s.status, FlappingStatus::flapping) << describe(s.evidence);
    const Piezo<double>& p = v.piezo;
    const double stroke_spring = v.spring.stiffness * square(p.transmission_ratio);
    // The stroke spring acts through the series stiffness.
    const double through = series > 0.0 ? series * stroke_spring / (series + stroke_spring) : stroke_spring;
    const double share = series > 0.0 ? series / (series + stroke_spring) : 1.0;
    const double tip = p.force_per_volt * 90.0 / (p.stiffness + through);
    EXPECT_NEAR(s.metrics[Metric::stroke_amplitude] / (p.transmission_ratio * share * tip), 1.0, 1e-4);
  }
}

// In vacuum a linear piezo vehicle is a harmonic oscillator: resonance and amplitude in closed form.
TEST(Actuators, APiezoInVacuumIsAHarmonicOscillator) {
  Design<double> d = piezo_design();
  d.pitch = {};
  d.aerodynamics.coefficients_name = "translational-2022";
  d.aerodynamics.coefficients = translational_2022();
  d.aerodynamics.added_mass = false;
  d.supply.offset = 20.0;
  const Vehicle<double> v = resolve(d, Condition::vacuum);
  const Piezo<double>& p = v.piezo;
  const double mass = p.mass + square(p.transmission_ratio) * v.wing_inertia;
  const double stiffness = p.stiffness + square(p.transmission_ratio) * v.spring.stiffness;
  for (const double share : {0.7, 1.0, 1.4}) {
    Vehicle<double> driven = v;
    const double w = share * std::sqrt(stiffness / mass);
    driven.drive_frequency = w / two_pi;
    const SteadyFlapping s = find_steady_flapping(driven, {.tolerance = 1e-9});
    ASSERT_EQ(s.status, FlappingStatus::flapping) << describe(s.evidence);
    const double tip = p.force_per_volt * v.voltage / std::hypot(stiffness - mass * w * w, p.damping * w);
    EXPECT_NEAR(s.metrics[Metric::stroke_amplitude] / (p.transmission_ratio * tip), 1.0, 1e-7);
    // The damping takes all: c <x'^2>.
    EXPECT_NEAR(s.metrics[Metric::power_electrical] / (0.5 * p.damping * square(w * tip)), 1.0, 1e-7);
  }
}

// What a stiff transmission would be: the compliant one tends to the rigid one.
TEST(Actuators, AStiffSeriesSpringIsARigidTransmission) {
  const Design<double> rigid = piezo_design();
  const SteadyFlapping a = find_steady_flapping(resolve(rigid), {.tolerance = 1e-8});
  double before = 1.0;
  for (const double stiffness : {1e4, 1e5}) {
    Design<double> d = rigid;
    d.piezo.series_stiffness = stiffness;
    const SteadyFlapping b = find_steady_flapping(resolve(d), {.tolerance = 1e-8});
    const double off = std::abs(b.metrics[Metric::stroke_amplitude] / a.metrics[Metric::stroke_amplitude] - 1.0);
    EXPECT_LT(off, 0.15 * before);
    before = off;
  }
  EXPECT_LT(before, 3e-3);
}

TEST(Actuators, GradientsOfAPiezoAreThoseOfDifferences) {
  for (const bool compliant : {false, true}) {
    Design<double> d = piezo_design();
    d.piezo.constants.transmission_cubic = 2e9;
    d.piezo.constants.capacitance = 1e-8;
    if (compliant) d.piezo.series_stiffness = 2000.0;
    const SteadyFlapping orbit = find_steady_flapping(resolve(d), {.tolerance = 1e-11});
    ASSERT_EQ(orbit.status, FlappingStatus::flapping);
    std::vector<const char*> keys = {"piezo.force_per_volt",     "piezo.stiffness", "piezo.transmission_ratio",
                                     "piezo.transmission_cubic", "pitch.stiffness", "supply.amplitude"};
    if (compliant) keys.push_back("piezo.series_stiffness");
    std::vector<DesignParameter> parameters;
    for (const char* key : keys) parameters.push_back(design_parameter(key));
    const MetricGradients g = metric_gradients(d, Condition::air, orbit, parameters, {});
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const auto& parameter = numeric_parameter<double>(keys[k]);
      const double value = *parameter.get(d), h = 1e-4 * value;
      Metrics<double> side[2];
      for (const int s : {0, 1}) {
        Design<double> moved = d;
        parameter.set(moved, value + (s ? h : -h));
        side[s] = find_steady_flapping(resolve(moved), {.tolerance = 1e-11}).metrics;
      }
      for (const Metric m : {Metric::stroke_amplitude, Metric::lift_mean, Metric::power_electrical,
                             Metric::pitch_amplitude, Metric::power_electronics}) {
        const double difference = (side[1][m] - side[0][m]) / (2.0 * h), size = std::abs(orbit.metrics[m] / value);
        EXPECT_NEAR(g.by_parameter[k][std::size_t(m)], difference, 2e-6 * size) << keys[k] << ' ' << metric_info(m).key;
      }
    }
  }
}

// Wings drive a light rotor back at the ends of the stroke: a brushless motor coasts there.
TEST(Actuators, ABrushlessMotorGivesNothingBack) {
  Design<double> d = reference_design();
  d.friction = {FrictionLaw::none, 0.0};
  d.motor.constants.inertia = 1e-8;
  d.motor.constants.armature_inductance = 0.0;
  const SteadyFlapping brushed = find_steady_flapping(resolve(d), {.tolerance = 1e-8});
  d.electronics.efficiency = 1.0;
  const SteadyFlapping blocked = find_steady_flapping(resolve(d), {.tolerance = 1e-8});
  ASSERT_EQ(blocked.status, FlappingStatus::flapping) << describe(blocked.evidence);
  double least = 1.0, least_brushed = 1.0;
  for (int n = 0; n < 400; ++n) {
    least = std::min(least, blocked.record.at(two_pi * n / 400.0).current);
    least_brushed = std::min(least_brushed, brushed.record.at(two_pi * n / 400.0).current);
  }
  EXPECT_LT(least_brushed, -1e-3);
  EXPECT_EQ(least, 0.0);
  EXPECT_GT(blocked.metrics[Metric::frequency], brushed.metrics[Metric::frequency]);  // nothing brakes it
}

// An offset moves the shaft at the start; what the voltage alternates by decides whether it moves for good.
TEST(Actuators, FrictionHoldsAPiezoWhoseVoltageAlternatesTooLittle) {
  Design<double> d = piezo_design();
  d.pitch = {};
  d.aerodynamics.pitch_coefficient = 2e-3;
  d.aerodynamics.coefficients_name = "translational-2022";
  d.aerodynamics.coefficients = translational_2022();
  d.aerodynamics.added_mass = false;
  d.supply.frequency = 20.0;
  d.supply.offset = 40.0;
  for (const double series : {0.0, 500.0}) {
    for (const double factor : {0.0, 2e-3}) {
      if (series > 0.0) d.piezo.series_stiffness = series;
      d.piezo.constants.voltage_factor = factor;
      const Piezo<double> p = resolve(d).piezo;
      const auto force = [&](double voltage) {
        return p.force_per_volt * (1.0 + factor * std::abs(voltage)) * voltage;
      };
      double torque = 0.5 * (force(130.0) - force(-50.0)) / p.transmission_ratio;
      const double w = two_pi * 20.0;
      if (series > 0.0) torque *= series / std::hypot(p.stiffness + series - p.mass * w * w, w * p.damping);
      d.friction = {FrictionLaw::constant, 1.02 * torque};
      const auto [held, held_in_time] = orbit_and_simulation(resolve(d));
      EXPECT_EQ(held.status, FlappingStatus::stalled) << describe(held.evidence);
      EXPECT_EQ(held_in_time.status, FlappingStatus::stalled) << describe(held_in_time.evidence);
      EXPECT_EQ(held.evidence.kind, StatusEvidence::Kind::weak_alternation);
      EXPECT_NE(held_in_time.lock_angle, 0.0);
      d.friction = {FrictionLaw::constant, 0.9 * torque};
      EXPECT_TRUE(expect_orbit_as_simulated(d, int(series)).flaps);
    }
  }
}

TEST(Actuators, ElectronicsHoldTheCurrentAtItsLimit) {
  Design<double> d = reference_design();
  d.electronics.efficiency = 0.85;
  d.electronics.current_max = 0.15;
  const SteadyFlapping s = find_steady_flapping(resolve(d), {.tolerance = 1e-8});
  ASSERT_EQ(s.status, FlappingStatus::flapping) << describe(s.evidence);
  EXPECT_NEAR(s.metrics[Metric::current_peak], 0.15, 1e-9);
  const double passed = s.metrics[Metric::power_electrical] - s.metrics[Metric::power_electronics];
  EXPECT_NEAR(passed / s.metrics[Metric::power_electrical], 0.85, 1e-12);
  Simulation in_time(resolve(d), d.supply);
  in_time.step_to(1e-3);
  double highest = 0.0;
  for (int n = 1; n <= 200; ++n) {
    in_time.step_to(1e-3 + 5e-4 * n);
    highest = std::max(highest, in_time.now().current);
  }
  EXPECT_NEAR(highest, 0.15, 1e-9);
  // A current that follows the speed has a kink there, at a place that is known to the tolerance alone.
  d.motor.constants.armature_inductance = 0.0;
  const SteadyFlapping at_once = find_steady_flapping(resolve(d));
  ASSERT_EQ(at_once.status, FlappingStatus::flapping) << describe(at_once.evidence);
  EXPECT_EQ(at_once.metrics[Metric::current_peak], 0.15);
}

TEST(Actuators, WhatTheyCannotBeIsSaid) {
  const auto refused = [](const Design<double>& d) {
    try {
      validate(d);
    } catch (const ParameterError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  Design<double> d = piezo_design();
  EXPECT_EQ(refused(d), "accepted");
  d.electronics.efficiency = 0.9;
  EXPECT_EQ(refused(d),
            "electronics.efficiency: is of a brushless motor; what a piezo's electronics lose is "
            "piezo.recovered_share");
  d = direct_design();
  d.electronics.efficiency = 0.9;
  EXPECT_EQ(refused(d), "electronics.efficiency: a brushless motor turns a crank: not of a direct drive");
  d = reference_design();
  d.piezo = piezo_design().piezo;
  EXPECT_EQ(refused(d),
            "transmission.type: a piezo swings the wings through the transmission that [piezo] states: "
            "expected direct");
}

}  // namespace
}  // namespace wingbeat
