// Vehicles whose loads come from a table: against the model that the table was made of, the simulation in time, batches
// and differences.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "parts/expect_error.hpp"
#include "vehicle/direct_design.hpp"
#include "vehicle/hinged_design.hpp"
#include "vehicle/orbit_and_simulation.hpp"
#include "vehicle/orbit_derivatives.hpp"
#include "vehicle/random_vehicle.hpp"
#include "vehicle/steady_orbit.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"

namespace wingbeat {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::vector<double> even(double largest, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(k == count / 2 ? 0.0 : largest * (2.0 * k / (count - 1) - 1.0));
  return values;
}

/// The design with the loads of its own blade elements as a table; `skew` makes them depend on the stroke angle.
Design<double> tabulated(Design<double> d, int count, double skew = 0.0) {
  const Metrics<double> m = steady_orbit(d, 1e-6).metrics;
  const double fastest = 1.3 * m[Metric::flapping_velocity_peak], widest = 1.2 * m[Metric::stroke_amplitude];
  const Vehicle<double> v = resolve(d);
  const std::vector<double> strokes = skew != 0.0 ? even(widest, 5) : std::vector{none};
  std::vector<LoadTable::Row> rows;
  const auto add = [&](double velocity, double psi, double psi_velocity, double lift, double moment, double pitch) {
    for (const double beta : strokes) {
      const double factor = skew != 0.0 ? 1.0 + skew * beta : 1.0;
      rows.push_back({beta, velocity, psi, psi_velocity, factor * lift, factor * moment, factor * pitch});
    }
  };
  for (const double velocity : even(fastest, count)) {
    if (!pitches(v)) {
      const AeroLoads<double> loads = aero_loads(v.wings, std::abs(velocity));
      add(velocity, none, none, loads.lift, velocity < 0.0 ? -loads.moment : loads.moment, none);
      continue;
    }
    for (const double psi : even(1.4, count)) {
      for (const double turn : even(600.0, 3)) {
        const PitchAeroLoads<double> loads = aero_loads(v.wings, v.pitch, pitch_state(psi, turn, velocity),
                                                        velocity < 0.0 ? -1.0 : 1.0, turn < 0.0 ? -1.0 : 1.0);
        const double lift = -loads.normal_force * std::sin(psi) + loads.tangential_lift;
        add(velocity, psi, turn, lift, loads.stroke_moment, loads.pitch_moment);
      }
    }
  }
  d.aerodynamics.load_table = std::make_shared<LoadTable>(rows);
  d.aerodynamics.coefficients_name = "tabulated";
  return d;
}

/// On hinges, without rotational damping: its square of the pitch velocity is no parabola across 0.
Design<double> hinged() {
  Design<double> d = hinged_design(4e-4);
  d.pitch.damping_coefficient = 0.0;
  return d;
}

TEST(TabulatedLoads, OfTheModelGiveTheModel) {
  const Design<double> designs[] = {reference_design(), direct_design(), hinged()};
  for (const Design<double>& d : designs) {
    const std::ptrdiff_t n = &d - designs;
    const Metrics<double> model = steady_orbit(d).metrics;
    double before = 1.0;
    for (const int count : {11, 21, 41}) {
      const Metrics<double> of_table = steady_orbit(tabulated(d, count)).metrics;
      double apart = 0.0;
      for (const Metric m : {Metric::power_electrical, Metric::lift_mean, Metric::power_aerodynamic}) {
        apart = std::max(apart, std::abs(of_table[m] / model[m] - 1.0));
      }
      EXPECT_LT(apart, count == 41 ? 2e-3 : 0.5 * before) << n << " with " << count;
      before = apart;
    }
  }
}

TEST(TabulatedLoads, OrbitsAgreeWithTheSimulationInTime) {
  const Design<double> all[] = {tabulated(reference_design(), 11), tabulated(reference_design(), 11, 0.4),
                                tabulated(direct_design(), 11),    tabulated(direct_design(), 11, 0.4),
                                tabulated(hinged(), 11),           tabulated(hinged(), 11, 0.2)};
  for (const Design<double>& d : all) {
    const std::ptrdiff_t n = &d - all;
    const SteadyFlapping orbit = steady_orbit(d, 1e-8);
    EXPECT_EQ(name_of(domain_of(orbit.record.vehicle(), orbit.metrics)), "inside") << n;
    EXPECT_TRUE(expect_orbit_as_simulated(d, int(n)).flaps);
  }
}

TEST(TabulatedLoads, BatchesLeaveThemToTheScalarSolver) {
  expect_left_to_scalar_solver(tabulated(reference_design(), 11),
                               {Metric::lift_mean, Metric::power_electrical, Metric::frequency});
}

TEST(TabulatedLoads, DerivativesAreThoseOfDifferences) {
  const std::initializer_list<Metric> metrics = {Metric::power_electrical, Metric::lift_mean,
                                                 Metric::power_aerodynamic};
  // Differences of orbits lose an order where second derivatives jump at a line of the grid.
  constexpr double tolerance = 1e-5;
  Design<double> crank = tabulated(reference_design(), 11, 0.4);
  crank.aerodynamics.table_air_density = 1.1;
  crank.aerodynamics.table_wings = 2.0;
  expect_orbit_derivatives(
      crank,
      [](auto& d) {
        return std::array{&d.aerodynamics.air_density, &*d.aerodynamics.table_air_density, &*d.aerodynamics.table_wings,
                          &d.transmission.crank_radius};
      },
      metrics, tolerance);
  expect_orbit_derivatives(
      tabulated(hinged(), 11), [](auto& d) { return std::array{&d.supply.voltage, &*d.pitch.stiffness}; }, metrics,
      tolerance);
}

TEST(TabulatedLoads, GoWithDensityAndNumberOfWings) {
  const Design<double> d = tabulated(reference_design(), 11);
  const Metrics<double> plain = steady_orbit(d).metrics;
  Design<double> stated = d;
  stated.aerodynamics.table_air_density = d.aerodynamics.air_density;
  stated.aerodynamics.table_wings = 2.0;
  EXPECT_NEAR(steady_orbit(stated).metrics[Metric::lift_mean] / plain[Metric::lift_mean], 1.0, 1e-12);
  stated.aerodynamics.air_density *= 0.5;
  stated.aerodynamics.table_wings = 1.0;
  EXPECT_NEAR(resolve(stated).wings.tabulated.factor, 1.0, 1e-15);
  EXPECT_EQ(resolve(stated, Condition::vacuum).wings.tabulated.table, nullptr);
}

TEST(TabulatedLoads, AMotionBeyondTheTableIsOutsideTheDomain) {
  Design<double> d = tabulated(reference_design(), 11, 0.4);
  d.supply.voltage *= 2.0;
  const SteadyFlapping fast = steady_orbit(d);
  const auto evidence = domain_evidence(fast.record.vehicle(), fast.metrics);
  EXPECT_NE(describe(evidence).find("the flapping velocity reaches"), std::string::npos) << describe(evidence);
  EXPECT_NE(name_of(domain_of(fast.record.vehicle(), fast.metrics)).find("load_table"), std::string::npos);
}

TEST(TabulatedLoads, AreRefusedWhereTheyMakeNoSense) {
  const auto refusal = [](const Design<double>& d) { return error_of([&] { validate(d); }); };
  const auto table = tabulated(hinged(), 5).aerodynamics.load_table;
  Design<double> d = reference_design();
  d.aerodynamics.table_wings = 2.0;
  EXPECT_EQ(refusal(d), "aerodynamics.table_wings: is of a table of loads: give aerodynamics.type = \"tabulated\"");
  d = reference_design();
  d.aerodynamics.load_table = table;
  EXPECT_NE(refusal(d).find("depends on the pitch, which follows the stroke here"), std::string::npos) << refusal(d);
  d = hinged();
  d.aerodynamics.load_table = tabulated(reference_design(), 5).aerodynamics.load_table;
  EXPECT_NE(refusal(d).find("needs the columns pitch_angle"), std::string::npos) << refusal(d);
  d = tabulated(hinged(), 5);
  d.aerodynamics.induced_velocity = 0.5;
  EXPECT_EQ(refusal(d),
            "aerodynamics.induced_velocity: is not for tabulated loads, which hold for the wings as they are");
}

}  // namespace
}  // namespace wingbeat
