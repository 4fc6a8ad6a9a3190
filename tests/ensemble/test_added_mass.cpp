// Added mass under the pitch law: closed forms, conservation, orbit against simulation in time, packs against scalar.
#include <gtest/gtest.h>

#include <random>

#include "vehicle/orbit_and_simulation.hpp"
#include "vehicle/orbit_derivatives.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
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
  d.aerodynamics.added_mass = true;
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

// J_a over N_w J_w, a constant of the vehicle: by orbit, in time and in packs; absent where nothing is added.
TEST(AddedMass, ItsShareOfTheWingsInertiaIsAMetric) {
  const auto ratio_of = [](const Design<double>& d, Condition condition) {
    const SteadyFlapping found = find_steady_flapping(resolve(d, condition), {.tolerance = 1e-4});
    EXPECT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
    return found.metrics[Metric::added_mass_inertia_ratio];
  };
  Design<double> d = with_added_mass();
  // Semi-ellipse without offset: integral c^2 r^2 dr = 2/15 c_0^2 R^3.
  const double J_a = 0.25 * pi * 1.225 * 2.0 / 15.0 * square(25e-3) * std::pow(63e-3, 3);
  const double expected = J_a / 7.205e-8;
  EXPECT_NEAR(ratio_of(d, Condition::air), expected, 1e-14);
  const Vehicle<double> v = resolve(d);
  TransientOptions loose;
  loose.tolerance = 1e-4;
  const TransientResult time = simulate_start_up(v, loose);
  ASSERT_TRUE(time.metrics);
  EXPECT_NEAR((*time.metrics)[Metric::added_mass_inertia_ratio], expected, 1e-14);
  const std::array<EnsembleMember, 1> member = {{{v, {}}}};
  std::array<EnsembleOutcome, 1> pack;
  solve_ensemble(member, {}, start_up_in_time(), pack);
  EXPECT_NEAR(pack[0].metrics[Metric::added_mass_inertia_ratio], expected, 1e-14);
  EXPECT_TRUE(std::isnan(ratio_of(d, Condition::vacuum)));
  EXPECT_TRUE(std::isnan(ratio_of(d, Condition::wingless)));

  Design<GradientJet> seeded = cast<GradientJet>(d);
  seeded.wing.planform.root_chord = gradient_seed(value_of(seeded.wing.planform.root_chord), 0);
  seeded.wing.inertia = gradient_seed(value_of(seeded.wing.inertia), 1);
  const SteadyFlapping found = find_steady_flapping(v, {.tolerance = 1e-8});
  const OrbitGradient g = orbit_gradient(found, gradient_vehicle(seeded, Condition::air));
  const auto& slope = g.metrics[Metric::added_mass_inertia_ratio].v;
  EXPECT_NEAR(slope[gradient_first_slot], 2.0 * expected / 25e-3, 1e-11);
  EXPECT_NEAR(slope[gradient_first_slot + 1] * 7.205e-8, -expected, 1e-13);

  EXPECT_STREQ(missing_key(Metric::added_mass_inertia_ratio, reference_design()), "aerodynamics.added_mass");
  EXPECT_EQ(missing_key(Metric::added_mass_inertia_ratio, d), nullptr);
  EXPECT_EQ(missing_key(Metric::lift_mean, reference_design()), nullptr);
  d.aerodynamics.added_mass = false;
  EXPECT_TRUE(std::isnan(ratio_of(d, Condition::air)));
}

TEST(AddedMass, NeedsAirAndAnOutline) {
  EXPECT_EQ(resolve(with_added_mass(), Condition::vacuum).wings.added_inertia, 0.0);
  EXPECT_EQ(resolve(reference_design()).wings.added_inertia, 0.0);
  Design<double> d = reference_design();
  d.aerodynamics.added_mass = true;
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
      ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
      const EnergyAudit audit = energy_audit(found.metrics);
      EXPECT_NEAR(audit.imbalance, 0.0, tolerance * audit.electrical);
      EXPECT_NEAR(audit.residual, 0.0, 1e-13 * audit.electrical);
      d.aerodynamics.added_mass = false;
      const SteadyFlapping without = find_steady_flapping(resolve(d), {.tolerance = tolerance});
      EXPECT_GT(std::abs(found.metrics[Metric::rod_force_peak] / without.metrics[Metric::rod_force_peak] - 1.0), 1e-2);
    }
  }
}

// Both are integrals of a function of beta' alone along a closed path, here by Gauss's rule between samples of it.
TEST(AddedMass, MeanPowerAndMeanRotationalLiftOverAnOrbitVanish) {
  for (const bool springs : {false, true}) {
    const Vehicle<double> v = resolve(with_added_mass(springs));
    const SteadyFlapping found = find_steady_flapping(v, {.tolerance = 1e-9});
    ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
    std::vector<double> velocities;
    for (const WaveformRow& row : found.record.waveform(721)) {
      if (!velocities.empty() && velocities.back() * row.flapping_velocity < 0.0) velocities.push_back(0.0);
      velocities.push_back(row.flapping_velocity);
    }
    double work = 0.0, taken = 0.0, rotational = 0.0, gross = 0.0;
    for (std::size_t n = 1; n < velocities.size(); ++n) {
      const double a = velocities[n - 1], b = velocities[n];
      constexpr double node = 0.77459666924148337704;
      for (const auto& [share, weight] : {std::pair{-node, 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {node, 5.0 / 9.0}}) {
        const double velocity = 0.5 * (a + b) + 0.5 * share * (b - a), step = 0.5 * weight * (b - a);
        const AeroLoads<double> loads = aero_loads(v.wings, velocity, sign_of(velocity), 1.0);
        const double power = loads.added_inertia * velocity * step;  // I beta'' beta' dt
        work += power;
        taken += std::abs(power);
        // F_rot ~ |beta'| d alpha / dt, its lift by cos(alpha).
        const double lift = -v.wings.pitch_coefficient * velocity * std::cos(loads.angle_of_attack) * step;
        rotational += lift;
        gross += std::abs(lift);
      }
    }
    EXPECT_GT(taken, 0.01 * found.metrics[Metric::power_electrical] / found.metrics[Metric::frequency]);
    EXPECT_GT(gross, 0.0);
    EXPECT_NEAR(work, 0.0, 1e-10 * taken);
    EXPECT_NEAR(rotational, 0.0, 1e-10 * gross);
  }
}

TEST(AddedMass, DerivativesAgreeWithDifferences) {
  const auto parameters = [](auto& design) {
    return std::array{&design.wing.planform.length, &design.wing.planform.root_chord,
                      &design.aerodynamics.pitch_coefficient, &design.aerodynamics.air_density, &design.wing.inertia};
  };
  for (const bool springs : {false, true}) {
    expect_orbit_derivatives(with_added_mass(springs), parameters,
                             {Metric::frequency, Metric::power_electrical, Metric::power_friction, Metric::lift_mean,
                              Metric::lift_peak, Metric::rod_force_peak, Metric::power_reactive},
                             1e-7);
  }
}

TEST(AddedMass, OrbitsOfRandomVehiclesAgreeWithTheSimulationAndWithPacks) {
  std::mt19937_64 random(20261);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int flapping = 0, direct = 0, packs = 0;
  for (int n = 0; n < 80; ++n) {
    const bool crank = n % 4 != 3;
    Design<double> d = crank ? random_design(random, 1.5) : random_direct_design(random, n % 8 == 7);
    d.aerodynamics.angle_of_attack_min = {};
    d.aerodynamics.added_mass = true;
    d.wing.planform.s22 = 4.17e-8 * d.wing.inertia / 7.205e-8 * uniform(0.3, 3.0);
    validate(d);
    const Vehicle<double> v = resolve(d);
    const auto [orbit, time] = orbit_and_simulation(v);
    ASSERT_EQ(orbit.status, time.status) << n << ": " << describe(orbit.evidence) << " / " << describe(time.evidence);
    const std::array<EnsembleMember, 1> member = {{{v, {}}}};
    std::array<EnsembleOutcome, 1> pack;
    EnsembleOptions pack_options;
    pack_options.tolerance = 1e-7;
    solve_ensemble(member, pack_options, start_up_in_time(), pack);
    ASSERT_EQ(orbit.status, pack[0].status) << n << ": " << describe(orbit.evidence);
    if (orbit.status != FlappingStatus::flapping) continue;
    ++(crank ? flapping : direct);
    packs += pack[0].scalar ? 0 : 1;
    std::string where;
    EXPECT_LT(metrics_apart(orbit.metrics, *time.metrics, where), 1e-6) << "vehicle " << n << " in time, " << where;
    EXPECT_LT(metrics_apart(orbit.metrics, pack[0].metrics, where), 1e-6) << "vehicle " << n << " in packs, " << where;
    const EnergyAudit audit = energy_audit(orbit.metrics);
    EXPECT_NEAR(audit.imbalance, 0.0, 1e-7 * audit.electrical) << n;
  }
  EXPECT_GE(flapping, 40);
  EXPECT_GE(direct, 15);
  EXPECT_GE(packs, has_packs ? 30 : 0);
}

TEST(AddedMass, ThatLeavesNoInertiaIsRefused) {
  Design<double> d = reference_design();
  d.aerodynamics.added_mass = true;
  const auto with_share = [&](double share) {  // J_a over the wings' own inertia
    d.wing.planform.s22 = share * 2.0 * 7.205e-8 / (0.25 * pi * 1.225);
    return d;
  };
  EXPECT_NO_THROW(validate(with_share(3.62)));
  try {
    validate(with_share(3.63));
    FAIL() << "accepted";
  } catch (const ParameterError& error) {
    EXPECT_STREQ(error.what(),
                 "aerodynamics.added_mass: the air's inertia of 5.231e-07 kg m2 is too large beside that of the wings, "
                 "1.441e-07 kg m2: at an angle of attack of 19.7 deg -0.276 of it counts, and no inertia is left");
  }
  // Right at the bound the effective inertia is all but used up, and no lower one is met in the fit's range.
  const Vehicle<double> v = resolve(with_share(3.62));
  double least = 1.0;
  for (int n = 0; n <= 9000; ++n) {
    const double speed = 0.5 * pi / 9000.0 * n / v.wings.pitch_coefficient;
    least = std::min(least, aero_loads(v.wings, speed).added_inertia);
  }
  EXPECT_GT(v.wing_count * v.wing_inertia + least, 0.0);
  EXPECT_LT(v.wing_count * v.wing_inertia + least, 0.01 * v.wing_count * v.wing_inertia);
  d.aerodynamics.pitch_coefficient = 0.0;  // wings that do not pitch
  EXPECT_NO_THROW(validate(with_share(5.0)));
}

/// Wings that reach a stop of their pitching at about half of their largest stroke speed.
Design<double> with_stop(bool springs = false) {
  Design<double> d = with_added_mass(springs);
  d.aerodynamics.pitch_coefficient = 10e-3;
  d.aerodynamics.angle_of_attack_min = 0.8;
  return d;
}

// Kinetic energy of the air as a function of the stroke velocity has no jump at the stop, and its slope by the velocity
// is the momentum's on either side.
TEST(AddedMass, IsConservativeAtAStopOfThePitching) {
  const Vehicle<double> v = resolve(with_stop());
  const double at_stop = stroke_speed_at(v.wings, 0.8);
  const auto energy = [&](double velocity) {
    return added_energy(v.wings, aero_loads(v.wings, std::abs(velocity)).angle_of_attack, velocity);
  };
  EXPECT_NEAR(energy(at_stop * (1.0 + 1e-12)) / energy(at_stop * (1.0 - 1e-12)), 1.0, 1e-11);
  double largest = 0.0;
  for (const double share : {0.2, 0.6, 0.95, 1.05, 1.4, 2.0, -0.6, -1.4}) {
    const double velocity = share * at_stop, step = 1e-4 * at_stop;
    const double slope = (energy(velocity + step) - energy(velocity - step)) / (2.0 * step);
    const double inertia = aero_loads(v.wings, std::abs(velocity)).added_inertia;
    EXPECT_NEAR(inertia * velocity, slope, 1e-7 * std::abs(v.wings.added_inertia * velocity)) << share;
    largest = std::max(largest, inertia);
  }
  // What jumps is the inertia.
  const double before = aero_loads(v.wings, 0.999999 * at_stop).added_inertia;
  const double beyond = aero_loads(v.wings, 1.000001 * at_stop).added_inertia;
  EXPECT_GT(beyond - before, 0.2 * v.wings.added_inertia);
}

TEST(AddedMass, OrbitsAtAStopOfThePitchingAgreeWithTheSimulation) {
  std::mt19937_64 random(20261127);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int cranks = 0, direct = 0, at_stop = 0;
  for (int n = 0; n < 200; ++n) {
    const bool crank = n % 4 != 3;
    Design<double> d = crank ? random_design(random, 1.5) : random_direct_design(random, n % 8 == 7);
    d.aerodynamics.angle_of_attack_min = uniform(0.2, 1.3);
    d.aerodynamics.pitch_coefficient = std::max(d.aerodynamics.pitch_coefficient, 1e-3) * uniform(0.7, 3.0);
    d.aerodynamics.added_mass = true;
    d.wing.planform.s22 = 4.17e-8 * d.wing.inertia / 7.205e-8 * uniform(0.3, 3.0);
    validate(d);
    const Vehicle<double> v = resolve(d);
    const auto [orbit, time] = orbit_and_simulation(v);
    ASSERT_EQ(orbit.status, time.status) << n << ": " << describe(orbit.evidence) << " / " << describe(time.evidence);
    const std::array<EnsembleMember, 1> member = {{{v, {}}}};
    std::array<EnsembleOutcome, 1> pack;
    solve_ensemble(member, {.tolerance = 1e-7}, start_up_in_time(), pack);
    ASSERT_EQ(orbit.status, pack[0].status) << n;
    if (orbit.status != FlappingStatus::flapping) continue;
    EXPECT_TRUE(pack[0].scalar) << n;
    ++(crank ? cranks : direct);
    at_stop += pitch_margin(v.wings, orbit.metrics[Metric::flapping_velocity_peak]) < 0.0;
    std::string where;
    ASSERT_TRUE(time.metrics) << n;
    EXPECT_LT(metrics_apart(orbit.metrics, *time.metrics, where), 1e-6) << "vehicle " << n << " in time, " << where;
    EXPECT_LT(metrics_apart(orbit.metrics, pack[0].metrics, where), 1e-6) << "vehicle " << n << " in batch, " << where;
    const EnergyAudit audit = energy_audit(orbit.metrics);
    EXPECT_NEAR(audit.imbalance, 0.0, 1e-7 * audit.electrical) << n;
  }
  EXPECT_GE(cranks, 100);
  EXPECT_GE(direct, 35);
  EXPECT_GE(at_stop, 70);
}

TEST(AddedMass, DerivativesAtAStopOfThePitchingAgreeWithDifferences) {
  const auto parameters = [](auto& design) {
    return std::array{&design.wing.planform.length, &design.aerodynamics.pitch_coefficient, &design.wing.inertia,
                      &design.supply.voltage};
  };
  const auto least_angle = [](auto& design) { return std::array{&*design.aerodynamics.angle_of_attack_min}; };
  for (const bool springs : {false, true}) {
    const std::initializer_list<Metric> metrics = {Metric::frequency, Metric::power_electrical, Metric::power_friction,
                                                   Metric::lift_mean, Metric::lift_peak};
    expect_orbit_derivatives(with_stop(springs), parameters, metrics, 1e-6);
    expect_orbit_derivatives(with_stop(springs), least_angle, metrics, 1e-6);
  }
}

}  // namespace
}  // namespace wingbeat
