// Wings whose forces are summed over strips: induced velocity, loss at the tips, clap and fling, pitch axis. Orbits
// against momentum theory, simulation in time, packs and differences.
#include <gtest/gtest.h>

#include <random>

#include "parts/expect_error.hpp"
#include "vehicle/direct_design.hpp"
#include "vehicle/hinged_design.hpp"
#include "vehicle/metrics_apart.hpp"
#include "vehicle/orbit_and_simulation.hpp"
#include "vehicle/orbit_derivatives.hpp"
#include "vehicle/random_vehicle.hpp"
#include "vehicle/steady_orbit.hpp"
#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {
namespace {

Design<double> with_outline(Design<double> d) {
  d.wing.planform = {};
  d.wing.planform.shape = PlanformShape::semi_ellipse;
  d.wing.planform.length = 63e-3;
  d.wing.planform.root_chord = 25e-3;
  d.wing.planform.hub_offset = 3e-3;
  return d;
}

Design<double> in_its_wake(Design<double> d, double share = 1.0) {
  d.aerodynamics.induced_velocity = share;
  return d;
}

Design<double> clapping(Design<double> d, double meeting_angle) {
  d.aerodynamics.clap = {0.3, 1.0, 1.0, meeting_angle};
  return d;
}

/// Stated by value, that of the orbit; a crank that meets at its reversal, a direct drive that does at 1.1 times it.
double meeting_angle_of(const Design<double>& d) {
  const SteadyFlapping found = steady_orbit(d);
  return found.metrics[Metric::stroke_amplitude] + 0.05;
}

TEST(InducedVelocity, IsThatOfTheLiftThatItLeaves) {
  for (const double share : {0.4, 1.0}) {
    const Design<double> d = in_its_wake(with_outline(reference_design()), share);
    const SteadyFlapping found = steady_orbit(d);
    const Metrics<double>& m = found.metrics;
    const double disc = 2.0 * m[Metric::stroke_amplitude] * square(66e-3);
    const double expected = share * std::sqrt(m[Metric::lift_mean] / (2.0 * d.aerodynamics.air_density * disc));
    EXPECT_NEAR(m[Metric::induced_velocity] / expected, 1.0, 1e-13);
    EXPECT_NEAR(found.record.vehicle().wings.wake.velocity / expected, 1.0, 1e-8);
    EXPECT_LT(m[Metric::lift_mean], steady_orbit(with_outline(reference_design())).metrics[Metric::lift_mean]);
    EXPECT_LT(std::abs(energy_audit(m).imbalance), 1e-8 * m[Metric::power_electrical]);
  }
  Design<double> stated = in_its_wake(with_outline(reference_design()));
  stated.aerodynamics.swept_area = 0.02;
  const Metrics<double> m = steady_orbit(stated).metrics;
  EXPECT_NEAR(m[Metric::induced_velocity] / std::sqrt(m[Metric::lift_mean] / (2.0 * 1.225 * 0.02)), 1.0, 1e-13);
}

TEST(SettledAir, WithoutAnyOptionNothingSettles) {
  const Design<double> d = with_outline(reference_design());
  EXPECT_FALSE(settles_air(resolve(d)));
  EXPECT_TRUE(std::isnan(steady_orbit(d).metrics[Metric::induced_velocity]));
  Design<double> none = d;
  none.aerodynamics.induced_velocity = 0.0;
  none.aerodynamics.lifting_span = 1.0;
  none.aerodynamics.clap = {0.0, 1.0, 1.0, 0.7};
  const SteadyFlapping plain = steady_orbit(d), off = steady_orbit(none);
  for (int m = 0; m < metric_count; ++m) {
    const double a = plain.metrics[Metric(m)], b = off.metrics[Metric(m)];
    EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << metric_info(Metric(m)).key;
  }
}

TEST(SettledAir, OrbitsAgreeWithTheSimulationInTime) {
  const Design<double> crank = with_outline(reference_design()), direct = with_outline(direct_design());
  const Design<double> hinged = hinged_design(4e-4);
  Design<double> tips = crank, sets = crank, axis = in_its_wake(hinged);
  tips.aerodynamics.lifting_span = 0.93;
  sets.aerodynamics.coefficients_name = normal_tangential_set;
  sets.aerodynamics.coefficients = *named_coefficients(normal_tangential_set);
  axis.pitch.axis = 0.2;
  axis.pitch.centre_of_pressure = CentreOfPressure::chen;
  axis.aerodynamics.lifting_span = 0.95;
  axis.aerodynamics.coefficients_name = robobee_set;
  axis.aerodynamics.coefficients = *named_coefficients(robobee_set);
  const Design<double> all[] = {in_its_wake(crank),
                                clapping(crank, meeting_angle_of(crank)),
                                tips,
                                in_its_wake(tips),
                                sets,
                                in_its_wake(sets),
                                in_its_wake(direct),
                                clapping(in_its_wake(direct), meeting_angle_of(direct)),
                                axis,
                                clapping(hinged, meeting_angle_of(hinged))};
  for (const Design<double>& d : all) {
    EXPECT_TRUE(expect_orbit_as_simulated(d, int(&d - all)).flaps);
  }
}

TEST(SettledAir, PacksAgreeWithTheScalarSolver) {
  std::mt19937_64 random(20262);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  std::vector<EnsembleMember> members;
  std::vector<SteadyFlapping> alone;
  for (int n = 0; n < 60; ++n) {
    Design<double> d = with_outline(random_design(random, 1.3));
    d.aerodynamics.angle_of_attack_min = {};
    d.aerodynamics.coefficients.table = nullptr;
    if (n % 3 != 0) d.aerodynamics.induced_velocity = uniform(0.1, 1.0);
    if (n % 2 == 0) d.aerodynamics.lifting_span = uniform(0.85, 1.0);
    const char* sets[] = {translational_set, robobee_set, normal_tangential_set};
    d.aerodynamics.coefficients_name = sets[n % 3];
    d.aerodynamics.coefficients = *named_coefficients(sets[n % 3]);
    if (n % 7 == 0) d.aerodynamics.clap = {uniform(0.1, 0.5), 1.0, 3.0, 0.8};
    validate(d);
    members.push_back({resolve(d), {}});
    alone.push_back(find_steady_flapping(members.back().vehicle, {.tolerance = 1e-9}, start_up_in_time()));
  }
  std::vector<EnsembleOutcome> found(members.size());
  EnsembleOptions options;
  options.tolerance = 1e-7;
  solve_ensemble(members, options, start_up_in_time(), found);
  int flaps = 0, packs = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    ASSERT_EQ(alone[n].status, found[n].status) << n << ": " << describe(alone[n].evidence);
    if (alone[n].status != FlappingStatus::flapping) continue;
    ++flaps;
    packs += found[n].scalar ? 0 : 1;
    std::string where;
    EXPECT_LT(metrics_apart(alone[n].metrics, found[n].metrics, where), 1e-6) << n << ", " << where;
  }
  EXPECT_GE(flaps, 40);
  EXPECT_GE(packs, has_packs ? 30 : 0);
}

TEST(SettledAir, DerivativesFollowTheAir) {
  const std::initializer_list<Metric> metrics = {Metric::power_electrical, Metric::lift_mean,
                                                 Metric::power_aerodynamic};
  Design<double> crank = in_its_wake(with_outline(reference_design()), 0.8);
  crank.aerodynamics.lifting_span = 0.94;
  expect_orbit_derivatives(
      crank,
      [](auto& d) {
        return std::array{&*d.aerodynamics.induced_velocity, &*d.aerodynamics.lifting_span, &d.wing.planform.length,
                          &d.wing.planform.hub_offset, &d.aerodynamics.pitch_coefficient};
      },
      {Metric::frequency, Metric::induced_velocity, Metric::power_electrical, Metric::lift_mean}, 1e-7);
  const Design<double> plain = with_outline(reference_design());
  expect_orbit_derivatives(
      clapping(plain, meeting_angle_of(plain)),
      [](auto& d) {
        return std::array{&*d.aerodynamics.clap.amplitude, &d.aerodynamics.clap.decay, &d.transmission.crank_radius,
                          &d.wing.planform.root_chord};
      },
      metrics, 1e-7);
  const Design<double> direct = with_outline(direct_design());
  expect_orbit_derivatives(
      clapping(in_its_wake(direct), meeting_angle_of(direct)),
      [](auto& d) {
        return std::array{&*d.aerodynamics.clap.amplitude, &*d.aerodynamics.induced_velocity, &d.supply.voltage,
                          &d.wing.planform.length};
      },
      metrics, 1e-6);
  Design<double> hinged = in_its_wake(hinged_design(4e-4));
  hinged.pitch.axis = 0.15;
  hinged.aerodynamics.lifting_span = 0.95;
  expect_orbit_derivatives(
      hinged,
      [](auto& d) {
        return std::array{&d.pitch.axis, &*d.aerodynamics.induced_velocity, &*d.aerodynamics.lifting_span,
                          &*d.pitch.stiffness};
      },
      metrics, 1e-6);
}

TEST(ClapAndFling, NeedsWingsThatComeClose) {
  const Design<double> d = with_outline(reference_design());
  const double amplitude = steady_orbit(d).metrics[Metric::stroke_amplitude];
  const Metrics<double> plain = steady_orbit(d).metrics, close = steady_orbit(clapping(d, amplitude + 0.05)).metrics,
                        far = steady_orbit(clapping(d, amplitude + 0.8)).metrics;
  EXPECT_GT(close[Metric::lift_mean], 1.005 * plain[Metric::lift_mean]);
  EXPECT_EQ(far[Metric::lift_mean], plain[Metric::lift_mean]);
}

TEST(AirOfStrips, IsRefusedWhereItMakesNoSense) {
  const auto refusal = [](const Design<double>& d) { return error_of([&] { validate(d); }); };
  Design<double> d = in_its_wake(reference_design());
  EXPECT_EQ(refusal(d), "aerodynamics.induced_velocity: needs the wing's outline: give a planform with a shape");
  d = with_outline(reference_design());
  d.aerodynamics.lifting_span = 0.04;
  EXPECT_EQ(
      refusal(d),
      "aerodynamics.lifting_span: leaves nothing of the wing that lifts: its root is at 0.045 of the distance from "
      "hinge to tip, got 0.04");
  d = with_outline(reference_design());
  d.aerodynamics.clap.amplitude = 0.2;
  d.wing.planform.shoulder_distance = 0.2;
  EXPECT_EQ(
      refusal(d),
      "aerodynamics.clap_and_fling.meeting_angle: missing: by wing.planform.shoulder_distance the wings never meet");
  EXPECT_STREQ(missing_key(Metric::induced_velocity, reference_design()), "aerodynamics.induced_velocity");
}

}  // namespace
}  // namespace wingbeat
