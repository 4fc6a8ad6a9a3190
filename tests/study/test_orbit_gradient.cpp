// Derivatives through the orbit against central differences, every metric by every numeric parameter.
#include "wingbeat/cycle/cycle_system.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/cycle/recorded_cycle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vehicle/random_vehicle.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

constexpr double orbit_tolerance = 1e-12;

SteadyFlapping orbit_of(const Design<double>& design, Condition condition) {
  return find_steady_flapping(resolve(design, condition),
                              {.tolerance = orbit_tolerance, .stability = false, .reporting = reporting_of(design)});
}

/// The design at the voltage that gives the frequency, by secants.
std::optional<Metrics<double>> metrics_at_frequency(Design<double> design, Condition condition, double frequency) {
  double v0 = design.supply.voltage, f0 = 0.0;
  double v = v0 * 1.0001;
  for (int iteration = 0; iteration < 20; ++iteration) {
    design.supply.voltage = iteration == 0 ? v0 : v;
    const SteadyFlapping s = orbit_of(design, condition);
    if (s.status != FlappingStatus::flapping) return std::nullopt;
    const double f = s.metrics[Metric::frequency];
    if (iteration > 1 && std::abs(f / frequency - 1.0) < 2e-13) return s.metrics;
    if (iteration > 0) {
      const double next = v + (frequency - f) * (v - v0) / (f - f0);
      if (iteration > 2 && std::abs(next / v - 1.0) < 1e-14) return s.metrics;
      v0 = v;
      v = next;
    }
    f0 = f;
  }
  return std::nullopt;
}

std::vector<DesignParameter> numeric_parameters(const Design<double>& design) {
  std::vector<DesignParameter> parameters;
  for (const auto& key : parameter_table<double>()) {
    if (!key.set || key.path == "wing.count" || key.path == "supply.cells") continue;  // whole
    const auto value = key.get(design);
    if (!value || (*value == 0.0 && key.path != "motor.friction_torque" && key.path != "spring.stiffness")) continue;
    parameters.push_back(design_parameter(key.path));
  }
  return parameters;
}

struct Worst {
  double error = 0.0;
  std::string where;
  int compared = 0;
};

/// Elasticities against the Richardson extrapolation of central differences.
void compare_gradients(const Design<double>& design, Condition condition, Held held, Worst& worst) {
  const SteadyFlapping orbit = orbit_of(design, condition);
  if (orbit.status != FlappingStatus::flapping) return;
  const double f = orbit.metrics[Metric::frequency];
  const auto parameters = numeric_parameters(design);
  const MetricGradients g = metric_gradients(design, condition, orbit, parameters, {.held = held});
  ASSERT_TRUE(g.regular);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const DesignParameter& p = parameters[k];
    if (held == Held::frequency && p.key == "supply.voltage") continue;
    const double value = *p.value(design);
    const double size = value != 0.0 ? std::abs(value) : 1e-3;
    const auto metrics_at = [&](double step) -> std::optional<Metrics<double>> {
      Design<double> moved = design;
      p.set(moved, value + step * size);
      if (held == Held::frequency) return metrics_at_frequency(moved, condition, f);
      const SteadyFlapping s = orbit_of(moved, condition);
      if (s.status != FlappingStatus::flapping) return std::nullopt;
      return s.metrics;
    };
    const double h = 4e-4;                // small enough not to pass from one of two nearly equal peaks to the other
    const bool one_sided = value == 0.0;  // a stiffness or torque cannot be negative
    std::optional<Metrics<double>> samples[5];
    // f' from five points, exact to order h^4: central, or forward where the parameter may not be negative.
    const double central[] = {-2, -1, 0, 1, 2}, forward[] = {0, 1, 2, 3, 4};
    const double central_weight[] = {1.0 / 12, -8.0 / 12, 0, 8.0 / 12, -1.0 / 12};
    const double forward_weight[] = {-25.0 / 12, 48.0 / 12, -36.0 / 12, 16.0 / 12, -3.0 / 12};
    bool all = true;
    for (int s = 0; s < 5 && all; ++s) {
      samples[s] = metrics_at(h * (one_sided ? forward[s] : central[s]));
      all = samples[s].has_value();
    }
    if (!all) continue;
    for (int m = 0; m < metric_count; ++m) {
      if (Metric(m) == Metric::floquet_multiplier_max) {
        EXPECT_TRUE(std::isnan(g.by_parameter[k][std::size_t(m)]));
        continue;
      }
      const double at_p = orbit.metrics.values[std::size_t(m)];
      if (!std::isfinite(at_p)) continue;
      double difference = 0.0, scale = std::abs(at_p);
      for (int s = 0; s < 5; ++s) {
        difference += (one_sided ? forward_weight : central_weight)[s] * samples[s]->values[std::size_t(m)] / h;
      }
      const double exact = g.by_parameter[k][std::size_t(m)] * size;
      if (Metric(m) == Metric::power_residual) scale = orbit.metrics[Metric::power_motor];
      if (scale == 0.0) scale = 1.0;
      const double error = std::abs(exact - difference) / (scale + std::abs(difference));
      ++worst.compared;
      if (!(error <= worst.error)) {
        worst.error = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
        worst.where = p.key + " -> " + metric_table()[std::size_t(m)].key + " exact " + std::to_string(exact / scale) +
                      " difference " + std::to_string(difference / scale);
      }
    }
  }
}

class OrbitGradients : public testing::TestWithParam<Held> {};

TEST_P(OrbitGradients, ReferenceVehiclesInEveryCondition) {
  Worst worst;
  for (const Condition condition : {Condition::air, Condition::vacuum, Condition::wingless}) {
    for (const bool springs : {false, true}) {
      Design<double> d = reference_design();
      d.transmission.formulation = springs ? Formulation::virtual_work : Formulation::rod_force;
      if (springs) d.spring.stiffness = 1.377e-3;
      compare_gradients(d, condition, GetParam(), worst);
    }
  }
  EXPECT_GT(worst.compared, 2500);
  EXPECT_LT(worst.error, 1e-6) << worst.where;
}

TEST(OrbitGradient, BatteriesByResistanceChargeAndEverythingElse) {
  Worst worst;
  for (const bool curve : {false, true}) {
    for (const double inductance : {29e-3, 0.0}) {
      Design<double> d = reference_design();
      d.motor.constants.armature_inductance = inductance;
      d.supply.type = SupplyType::battery;
      Battery<double>& b = d.supply.battery;
      b.internal_resistance = 1.7;
      b.capacity = 180.0;
      b.charge = 0.6;
      b.cell_voltage = 3.7;
      if (curve) b.discharge_curve = {{0.0, 3.0}, {0.2, 3.6}, {0.7, 3.8}, {1.0, 4.2}};
      const SteadyFlapping s = orbit_of(d, Condition::air);
      const DesignParameter by[] = {design_parameter("supply.internal_resistance"), design_parameter("supply.charge")};
      const MetricGradients g = metric_gradients(d, Condition::air, s, by);
      EXPECT_LT(g.by_parameter[0][std::size_t(Metric::frequency)], 0.0);
      EXPECT_LT(g.by_parameter[0][std::size_t(Metric::voltage)], 0.0);
      EXPECT_EQ(g.by_parameter[1][std::size_t(Metric::frequency)] > 0.0, curve);
      compare_gradients(d, Condition::air, Held::voltage, worst);
    }
  }
  EXPECT_GT(worst.compared, 1500);
  EXPECT_LT(worst.error, 1e-6) << worst.where;
}

TEST(OrbitGradient, ReferenceOrbitsCrossTheKink) {
  for (const bool springs : {false, true}) {
    const SteadyFlapping s = find_steady_flapping(reference_vehicle(springs));
    const auto& cycle = std::get<RecordedCycle<CrankSystem<double, 2>>>(s.record.recorded().cycle).cycle;
    EXPECT_GE(std::count_if(cycle.switches.begin(), cycle.switches.end(), [](const auto& w) { return w.sign == 0; }),
              2);
  }
}

TEST(OrbitGradient, MissingInductanceHasNoDerivative) {
  Design<double> d = reference_design();
  d.motor.constants.armature_inductance = 0.0;
  const SteadyFlapping s = orbit_of(d, Condition::air);
  const DesignParameter p = design_parameter("motor.armature_inductance");
  const MetricGradients g = metric_gradients(d, Condition::air, s, {&p, 1});
  EXPECT_TRUE(std::isnan(g.by_parameter[0][std::size_t(Metric::frequency)]));
}

TEST(OrbitGradient, InstantsAgainstDifferences) {
  const Design<double> d = reference_design();
  const DesignParameter p = design_parameter("motor.inertia");
  const SteadyFlapping s = orbit_of(d, Condition::air);
  const double theta[] = {0.1, 1.7, 4.0, 6.2};
  Design<GradientJet> seeded = cast<GradientJet>(d);
  p.set_jet(seeded, gradient_seed(*p.value(d), 0));
  const OrbitGradient g = orbit_gradient(s, gradient_vehicle(seeded, Condition::air), {.crank_angles = theta});
  const auto moved = [&](double factor) {
    Design<double> m = d;
    p.set(m, factor * *p.value(d));
    return orbit_of(m, Condition::air);
  };
  const SteadyFlapping up = moved(1.0 + 1e-4), down = moved(1.0 - 1e-4);
  for (int k = 0; k < 4; ++k) {
    const WaveformRow a = down.record.at(theta[k]), b = up.record.at(theta[k]);
    const auto by = [&](const GradientJet& x) { return x.v[gradient_first_slot] * 1.5e-7; };
    EXPECT_NEAR(by(g.instants[k].current), (b.current - a.current) / 2e-4, 1e-6);
    EXPECT_NEAR(by(g.instants[k].crank_speed), (b.crank_speed - a.crank_speed) / 2e-4, 1e-5);
    EXPECT_NEAR(by(g.instants[k].rod_force), (b.rod_force - a.rod_force) / 2e-4, 1e-5);
    EXPECT_NEAR(g.instants[k].current.a, s.record.at(theta[k]).current, 1e-10);
  }
}

TEST_P(OrbitGradients, WithoutInductanceAndStiff) {
  Worst worst;
  for (const double inductance : {0.0, 2e-5}) {
    // The stiff orbit is slow, and the held frequency the same algebra for either.
    if (inductance > 0.0 && GetParam() == Held::frequency) continue;
    Design<double> d = reference_design();
    d.motor.constants.armature_inductance = inductance;
    compare_gradients(d, Condition::air, GetParam(), worst);
  }
  EXPECT_GT(worst.compared, 500);
  EXPECT_LT(worst.error, 1e-6) << worst.where;
}

TEST_P(OrbitGradients, SpringlessVehicleByItsStiffness) {
  Design<double> d = reference_design();
  d.spring.stiffness = 0.0;
  Worst worst;
  compare_gradients(d, Condition::air, GetParam(), worst);
  EXPECT_LT(worst.error, 1e-6) << worst.where;
}

TEST_P(OrbitGradients, MassesThatAreStatedForThemselves) {
  Design<double> d = reference_design();
  d.spring.stiffness = 1.377e-3;
  d.mass = 1.5e-3;
  d.masses = {0.8e-3, 0.6e-3, 5e-3, 0.05e-3};
  Worst worst;
  compare_gradients(d, Condition::air, GetParam(), worst);
  EXPECT_LT(worst.error, 1e-6) << worst.where;
  // A longer rod weighs more: its own share of the derivative is -lift_to_weight (density / mass).
  const DesignParameter rod = design_parameter("transmission.rod_length");
  const SteadyFlapping orbit = orbit_of(d, Condition::air);
  const auto by_rod = [&] {
    return metric_gradients(d, Condition::air, orbit, {&rod, 1}).by_parameter[0][std::size_t(Metric::lift_to_weight)];
  };
  const double mass = *total_mass(d), weighed = by_rod();
  d.mass = mass;
  d.masses = {};
  EXPECT_NEAR(weighed - by_rod(), -orbit.metrics[Metric::lift_to_weight] * 5e-3 / mass, 1e-9);
}

TEST_P(OrbitGradients, MotorsThatHeatUp) {
  Design<double> d = reference_design();
  d.supply.voltage = 4.0;
  MotorThermalDesign<double>& thermal = d.motor.thermal;
  thermal.resistance_winding = 20.0;
  thermal.resistance_case = 48.0;
  thermal.ambient_temperature = 310.0;
  thermal.magnet_temperature_coefficient = -0.0011;
  thermal.winding_temperature_max = 358.0;
  Worst worst;
  compare_gradients(d, Condition::air, GetParam(), worst);
  EXPECT_GT(worst.compared, 600);
  EXPECT_LT(worst.error, 1e-6) << worst.where;
  // A motor that heats up loses more lift by its resistance, and some by the heat of the day.
  const DesignParameter by[] = {design_parameter("motor.ambient_temperature")};
  const SteadyFlapping orbit = orbit_of(d, Condition::air);
  const MetricGradients g = metric_gradients(d, Condition::air, orbit, by);
  EXPECT_LT(g.by_parameter[0][std::size_t(Metric::lift_mean)], 0.0);
  EXPECT_GT(g.by_parameter[0][std::size_t(Metric::winding_temperature)], 0.5);
}

TEST_P(OrbitGradients, RandomVehicles) {
  std::mt19937_64 random(4);
  Worst worst;
  for (int n = 0; n < (GetParam() == Held::voltage ? 12 : 6); ++n)
    compare_gradients(random_design(random, 1.6), Condition::air, GetParam(), worst);
  EXPECT_GT(worst.compared, 3000);
  EXPECT_LT(worst.error, 1e-6) << worst.where;
}

INSTANTIATE_TEST_SUITE_P(Held, OrbitGradients, testing::Values(Held::voltage, Held::frequency),
                         [](const auto& held) { return held.param == Held::voltage ? "Voltage" : "Frequency"; });

}  // namespace
}  // namespace wingbeat
