// Vehicles with a four-bar or a tabulated stroke law: orbit, simulation in time and energy balance.
#include <gtest/gtest.h>

#include "vehicle/reference_vehicle.hpp"
#include "vehicle/stroke_law.hpp"
#include "vehicle/wide_boxes.hpp"
#include "wingbeat/cycle/cycle_system.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/recorded_cycle.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/solve/periodic.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

Design<double> four_bar_design() {
  Design<double> d = reference_design();
  d.transmission = {};
  d.transmission.type = TransmissionType::four_bar;
  d.transmission.crank_radius = 4e-3;
  d.transmission.coupler_length = 20e-3;
  d.transmission.rocker_length = 6e-3;
  d.transmission.ground_length = 20.5e-3;
  d.transmission.stroke_ratio = 2.0;
  return d;
}

SteadyFlapping mechanism_orbit(const Vehicle<double>& v, double tolerance) {
  SteadyOptions options;
  options.tolerance = tolerance;
  return find_steady_flapping(v, options, start_up_in_time());
}

TEST(FourBarVehicle, FlapsToEitherSideWithAClosedEnergyBalance) {
  Design<double> d = four_bar_design();
  validate(d);
  for (const double tolerance : {1e-6, 1e-10}) {
    const SteadyFlapping found = mechanism_orbit(resolve(d), tolerance);
    ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
    const EnergyAudit audit = energy_audit(found.metrics);
    EXPECT_NEAR(audit.imbalance, 0.0, tolerance * audit.electrical);
    EXPECT_NEAR(audit.residual, 0.0, 1e-14 * audit.electrical);  // conserves power by construction
    EXPECT_GT(found.metrics[Metric::stroke_amplitude], 1.4);
    EXPECT_LT(found.metrics[Metric::stroke_amplitude], 1.7);
  }
}

// Stretched to 1e4 crank radii, of small stroke: beta, its tangent and a slider's height over H are then one.
TEST(FourBarVehicle, LongRockerFlapsAsASliderCrankByVirtualWork) {
  Design<double> slider = reference_design();
  slider.spring.stiffness = 1.377e-3;
  slider.transmission.formulation = Formulation::virtual_work;
  const double p = 50.0, l = slider.transmission.rod_length;
  double before = 0.0;
  for (const double H : {0.2, 0.4}) {
    slider.transmission.hinge_offset = H;
    Design<double> bars = slider;
    bars.transmission = {};
    bars.transmission.type = TransmissionType::four_bar;
    bars.transmission.crank_radius = slider.transmission.crank_radius;
    bars.transmission.coupler_length = l;
    bars.transmission.rocker_length = p;
    bars.transmission.ground_length = std::hypot(p, l);
    bars.transmission.stroke_ratio = p / H;
    bars.transmission.ground_angle = pi - std::atan(l / p);
    const SteadyFlapping one = mechanism_orbit(resolve(slider), 1e-9), other = mechanism_orbit(resolve(bars), 1e-9);
    ASSERT_EQ(one.status, FlappingStatus::flapping) << describe(one.evidence);
    ASSERT_EQ(other.status, FlappingStatus::flapping) << describe(other.evidence);
    double off = 0.0;
    for (const Metric m : {Metric::frequency, Metric::power_electrical, Metric::power_friction, Metric::lift_mean,
                           Metric::rod_force_peak, Metric::power_aerodynamic, Metric::stroke_amplitude}) {
      off = std::max(off, std::abs(other.metrics[m] / one.metrics[m] - 1.0));
    }
    EXPECT_LT(off, 2e-3);
    if (before > 0.0) {
      EXPECT_NEAR(before / off, 4.0, 0.8);  // falls as beta^2
    }
    before = off;
  }
}

// One stroke law by its formula and as a table of 1,440 rows.
TEST(TabulatedVehicle, FlapsAsTheLawThatItSamples) {
  const StrokeLaw<double> law = {0.6, 0.08, 0.4, 0.1, 12e-3};
  const StrokeLawVehicle<double> exact = stroke_law_vehicle(law);
  Vehicle<double> v = resolve(reference_design());
  v.spring = exact.spring;
  std::vector<std::pair<double, double>> rows;
  for (int k = 0; k < 1440; ++k) {
    const double theta = two_pi * k / 1440;
    rows.emplace_back(theta, stroke_angle(crank_kinematics(law, std::sin(theta), std::cos(theta))));
  }
  v.transmission = {};
  v.transmission.type = TransmissionType::tabulated;
  v.transmission.tabulated = {std::make_shared<const StrokeCurve>(rows), 1.0, law.radius};
  const SteadyFlapping found = mechanism_orbit(v, 1e-8);
  ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
  using System = CrankSystem<double, 2, StrokeLawVehicle<double>>;
  const double speed = 0.6 * no_load_speed(exact);
  const System system(exact, {no_load_speed(exact), exact.voltage / circuit_resistance(exact)},
                      1e-4 * no_load_speed(exact));
  solver::Iterate<System> cycle;
  const auto summary = solver::solve_periodic(system, {speed, algebraic_current(exact, exact.voltage, speed)},
                                              {.tolerance = 1e-10}, cycle);
  ASSERT_EQ(summary.status, solver::PeriodicStatus::converged) << describe(summary.status);
  EXPECT_NEAR(found.metrics[Metric::frequency] * cycle_integrals(cycle)[std::size_t(Integral::time)], 1.0, 1e-7);
}

class WideMechanism : public testing::TestWithParam<FarBox> {};

TEST_P(WideMechanism, OrbitAndSimulationInTimeAgree) {
  int flapping = 0, others = 0;
  for (std::uint32_t n = 0; n < 24; ++n) {
    const WideVehicle drawn = wide_vehicle(GetParam(), n);
    const Vehicle<double> v = resolve(drawn.design, drawn.condition);
    const SteadyFlapping orbit = mechanism_orbit(v, 1e-8);
    TransientOptions options;
    options.tolerance = 1e-7;
    const TransientResult time = simulate_start_up(v, options);
    ASSERT_EQ(orbit.status, time.status) << n << ": " << describe(orbit.evidence) << " / " << describe(time.evidence);
    if (orbit.status != FlappingStatus::flapping) {
      ++others;
      continue;
    }
    ++flapping;
    ASSERT_TRUE(time.metrics);
    const Metrics<double>&a = *time.metrics, &b = orbit.metrics;
    for (const Metric m :
         {Metric::frequency, Metric::power_electrical, Metric::power_friction, Metric::power_aerodynamic,
          Metric::lift_peak, Metric::rod_force_mean, Metric::rod_force_peak, Metric::current_peak,
          Metric::flapping_velocity_peak, Metric::stroke_amplitude, Metric::crank_speed_max}) {
      EXPECT_NEAR(a[m], b[m], 1e-6 * std::abs(b[m])) << n << ": " << metric_info(m).key;
    }
  }
  EXPECT_GT(flapping, 8);
  EXPECT_GT(others, 0);
}
INSTANTIATE_TEST_SUITE_P(Transmissions, WideMechanism, testing::Values(FarBox::four_bar, FarBox::tabulated),
                         [](const auto& tested) { return std::string(far_box_names[std::size_t(tested.param)]); });

}  // namespace
}  // namespace wingbeat
