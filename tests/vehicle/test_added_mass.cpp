// Added mass under the pitch law: closed forms, conservation, orbit against simulation in time, packs against scalar.
#include <gtest/gtest.h>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {
namespace {

Planform<double> outline(PlanformShape shape, double hub_offset) {
  Planform<double> p;
  p.shape = shape;
  p.length = 63e-3;
  p.root_chord = 25e-3;
  p.hub_offset = hub_offset;
  return p;
}

Design<double> with_added_mass(bool springs = false) {
  Design<double> d = reference_design();
  if (springs) d.spring.stiffness = 1.377e-3;
  d.wing.planform = outline(PlanformShape::semi_ellipse, 0.0);
  d.aerodynamics.added_mass = AddedMass::strip_theory;
  return d;
}

TEST(AddedMass, SquaredChordMomentsAgreeWithIntegrals) {
  for (const PlanformShape shape : {PlanformShape::semi_ellipse, PlanformShape::rectangle}) {
    for (const double d : {0.0, 4e-3}) {
      const Planform<double> p = outline(shape, d);
      double sum = 0.0;
      const int count = 200000;
      for (int n = 0; n < count; ++n) {
        const double x = p.length * (n + 0.5) / count, share = square(x / p.length);
        const double c2 = square(p.root_chord) * (shape == PlanformShape::rectangle ? 1.0 : 1.0 - share);
        sum += c2 * square(x + d) * p.length / count;
      }
      EXPECT_NEAR(squared_chord_moment(p, 2.0) / (2.0 * sum), 1.0, 1e-9);
    }
  }
  const Planform<double> ellipse = outline(PlanformShape::semi_ellipse, 0.0);
  EXPECT_NEAR(squared_chord_moment(ellipse, 1.0), 2.0 / 15.0 * square(25e-3) * std::pow(63e-3, 3), 1e-20);
  Planform<double> table = outline(PlanformShape::tabulated, 4e-3);
  table.chord_table = {{0.0, 25e-3}, {63e-3, 25e-3}};
  EXPECT_NEAR(squared_chord_moment(table, 2.0) / squared_chord_moment(outline(PlanformShape::rectangle, 4e-3), 2.0),
              1.0, 1e-14);
}

// The moment is the rate of the momentum, the power the rate of the energy: both from the same kinetic energy.
TEST(AddedMass, IsConservative) {
  const Vehicle<double> v = resolve(with_added_mass());
  EXPECT_NEAR(v.wings.added_inertia / (v.wing_count * v.wing_inertia), 0.28, 0.02);  // model.md section 10
  using J = Jet<1>;
  const BladeElement<J> wings = cast<J>(v.wings);
  for (double velocity = -250.0; velocity <= 250.0; velocity += 17.0) {
    const J speed(velocity, 0);
    const J alpha = J(0.5 * pi) - wings.pitch_coefficient * abs(speed);
    const J energy = added_energy(wings, alpha, speed);
    const double inertia = aero_loads(v.wings, velocity, sign_of(velocity), 1.0).added_inertia;
    EXPECT_NEAR(energy.v[0], inertia * velocity, 1e-13 * std::abs(v.wings.added_inertia * velocity)) << velocity;
  }
}

TEST(AddedMass, NeedsAirAndAnOutline) {
  EXPECT_EQ(resolve(with_added_mass(), Condition::vacuum).wings.added_inertia, 0.0);
  EXPECT_EQ(resolve(reference_design()).wings.added_inertia, 0.0);
  Design<double> d = reference_design();
  d.aerodynamics.added_mass = AddedMass::strip_theory;
  try {
    validate(d);
    FAIL() << "accepted";
  } catch (const ParameterError& error) {
    EXPECT_STREQ(
        error.what(),
        "aerodynamics.added_mass: needs the wing's outline: give wing.planform.s22, or a planform with a shape");
  }
  d.wing.planform.s22 = 4e-8;
  EXPECT_NO_THROW(validate(d));
  EXPECT_NEAR(resolve(d).wings.added_inertia, 0.25 * pi * 1.225 * 4e-8, 1e-20);
}

TEST(AddedMass, EnergyBalanceClosesToTheToleranceAndTakesNoMeanPower) {
  for (const bool springs : {false, true}) {
    for (const double tolerance : {1e-6, 1e-10}) {
      Design<double> d = with_added_mass(springs);
      d.transmission.formulation = Formulation::virtual_work;
      const SteadyFlapping found = find_steady_flapping(resolve(d), {.tolerance = tolerance});
      ASSERT_EQ(found.status, FlappingStatus::flapping) << found.detail;
      const EnergyAudit audit = energy_audit(found.metrics);
      EXPECT_NEAR(audit.imbalance, 0.0, tolerance * audit.electrical);
      EXPECT_NEAR(audit.residual, 0.0, 1e-13 * audit.electrical);
      d.aerodynamics.added_mass = AddedMass::none;
      const SteadyFlapping without = find_steady_flapping(resolve(d), {.tolerance = tolerance});
      EXPECT_GT(std::abs(found.metrics[Metric::rod_force_peak] / without.metrics[Metric::rod_force_peak] - 1.0), 1e-2);
    }
  }
}

TEST(AddedMass, OrbitSimulationInTimeAndPacksAgree) {
  for (const bool springs : {false, true}) {
    for (const double stop : {0.0, 1.1}) {
      Design<double> d = with_added_mass(springs);
      if (stop > 0.0) d.aerodynamics.angle_of_attack_min = stop;
      const Vehicle<double> v = resolve(d);
      const SteadyFlapping orbit = find_steady_flapping(v, {.tolerance = 1e-9});
      TransientOptions options;
      options.tolerance = 1e-8;
      const TransientResult time = simulate_start_up(v, options);
      ASSERT_EQ(orbit.status, FlappingStatus::flapping) << orbit.detail;
      ASSERT_EQ(time.status, FlappingStatus::flapping) << time.detail;
      const std::array<EnsembleMember, 1> member = {{{v, {}}}};
      std::array<EnsembleOutcome, 1> pack;
      EnsembleOptions packs;
      packs.tolerance = 1e-7;
      solve_ensemble(member, packs, {}, pack);
      ASSERT_EQ(pack[0].status, FlappingStatus::flapping);
      EXPECT_EQ(pack[0].scalar, stop > 0.0);
      for (const Metric m : {Metric::frequency, Metric::power_electrical, Metric::power_friction, Metric::lift_peak,
                             Metric::rod_force_mean, Metric::rod_force_peak, Metric::power_aerodynamic}) {
        const double exact = orbit.metrics[m];
        EXPECT_NEAR((*time.metrics)[m], exact, 1e-7 * std::abs(exact)) << metric_info(m).key << " in time " << stop;
        EXPECT_NEAR(pack[0].metrics[m], exact, 1e-6 * std::abs(exact)) << metric_info(m).key << " packs " << stop;
      }
    }
  }
}

}  // namespace
}  // namespace wingbeat
