// Loads that the model itself makes come back as equal; factors, lags and noise that are put in are found; the loads
// along a motion against other functions of the library and against power identities.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/load_comparison.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;

const std::string designs = std::string(WINGBEAT_DATA) + "/designs/";

SteadyFlapping settled(const std::string& name, const std::vector<std::string>& overrides = {}) {
  const SteadyFlapping found =
      find_steady_flapping(resolve(read_design(designs + name, overrides)), {1e-10, false}, start_up_in_time());
  EXPECT_EQ(found.status, FlappingStatus::flapping) << name;
  EXPECT_FALSE(found.record.empty()) << name;
  return found;
}

/// What the model has at `count` places of a cycle, ahead by `lead` of it, times `factor`.
SimulatedLoads loads_of_cycle(const CycleRecord& cycle, int count, int cycles = 1, double lead = 0.0,
                              double factor = 1.0) {
  SimulatedLoads loads;
  loads.file = "loads.csv";
  const bool hinges = std::isfinite(wing_instant(cycle, 0.1).loads.pitch_moment);
  loads.loads[0] = LoadSeries{};
  loads.loads[1] = LoadSeries{};
  if (hinges) loads.loads[2] = LoadSeries{};
  for (int n = 0; n <= count * cycles; ++n) {
    const double place = double(n) / count;
    loads.places.push_back(place);
    const AirLoads air = wing_instant(cycle, place + lead).loads;
    loads.loads[0]->values.push_back(factor * air.lift);
    loads.loads[1]->values.push_back(factor * air.stroke_moment);
    if (hinges) loads.loads[2]->values.push_back(factor * air.pitch_moment);
  }
  return loads;
}

TEST(LoadComparison, FindsTheModelInItsOwnLoads) {
  for (const char* name : {"friction2022.toml", "pitch-hinge-crank.toml", "two-wing-direct.toml"}) {
    const SteadyFlapping found = settled(name);
    const LoadComparison c = compare_loads_of_cycle(loads_of_cycle(found.record, 180, 2), found.record);
    EXPECT_EQ(c.loads.size(), std::string_view(name) == "pitch-hinge-crank.toml" ? 3u : 2u);
    EXPECT_EQ(c.rows, 361);
    EXPECT_NEAR(c.cycles, 2.0, 1e-12);
    EXPECT_NEAR(c.frequency, found.metrics[Metric::frequency], 1e-9 * c.frequency);
    for (const ComparedLoad& load : c.loads) {
      const LoadDisagreement& d = load.disagreement;
      EXPECT_NEAR(d.ratio, 1.0, 1e-9) << name;
      EXPECT_NEAR(d.correlation, 1.0, 1e-12) << name;
      EXPECT_LT(d.rms_difference, 1e-10) << name;
      EXPECT_NEAR(d.strongest_lag, 0.0, 1e-9) << name;
    }
    // The mean over the rows is that of the cycle: its kinks alone keep it from more digits.
    EXPECT_NEAR(c.loads[0].disagreement.mean_model / found.metrics[Metric::lift_mean], 1.0, 1e-4) << name;
  }
}

TEST(LoadComparison, FindsFactorAndLag) {
  const SteadyFlapping found = settled("pitch-hinge-crank.toml");
  constexpr double steps = 7.0, count = 200.0, lead = steps / count;
  const LoadComparison c =
      compare_loads_of_cycle(loads_of_cycle(found.record, int(count), 1, lead, 1.25), found.record);
  for (const ComparedLoad& load : c.loads) {
    const LoadDisagreement& d = load.disagreement;
    EXPECT_NEAR(d.ratio, 0.8, 1e-9);
    EXPECT_NEAR(std::remainder(d.first_harmonic_lag - 2.0 * M_PI * lead, 2.0 * M_PI), 0.0, 1e-9);
    ASSERT_GT(d.strongest_harmonic, 0);
    EXPECT_NEAR(std::remainder(d.strongest_lag - 2.0 * M_PI * d.strongest_harmonic * lead, 2.0 * M_PI), 0.0, 1e-9);
    EXPECT_LT(d.variance_in_phase, 0.99);
    EXPECT_NEAR(d.share_mean + d.share_size + d.share_phase, 1.0, 1e-12);
  }
}

TEST(LoadComparison, NumbersOfSinesInClosedForm) {
  // Model sin(x), simulated 1 + 2 sin(x + a): every number follows.
  constexpr double a = 0.4;
  std::vector<LoadPoint> points;
  for (int n = 0; n < 64; ++n) {
    const double x = 2.0 * M_PI * n / 64.0;
    points.push_back({n / 64.0, 1.0 + 2.0 * std::sin(x + a), std::sin(x)});
  }
  const LoadDisagreement d = disagreement_of(points);
  EXPECT_NEAR(d.mean_simulated, 1.0, 1e-14);
  EXPECT_NEAR(d.mean_model, 0.0, 1e-14);
  EXPECT_NEAR(d.rms_simulated, std::sqrt(3.0), 1e-14);
  const double squares = 1.0 + 0.5 * (1.0 + 4.0 - 4.0 * std::cos(a));
  EXPECT_NEAR(d.rms_difference, std::sqrt(squares / 3.0), 1e-14);
  EXPECT_NEAR(d.correlation, std::cos(a), 1e-14);
  EXPECT_NEAR(d.variance_in_phase, std::cos(a) * std::cos(a), 1e-14);
  EXPECT_NEAR(d.first_harmonic_lag, a, 1e-13);
  EXPECT_EQ(d.strongest_harmonic, 1);
  EXPECT_NEAR(d.share_mean, 1.0 / squares, 1e-14);
  EXPECT_NEAR(d.share_size, 0.5 / squares, 1e-14);
  EXPECT_NEAR(d.share_phase, 2.0 * (1.0 - std::cos(a)) / squares, 1e-14);
}

TEST(LoadComparison, NoiseLowersTheShareInPhaseByItsVariance) {
  std::mt19937 generator(7);
  std::normal_distribution<double> noise(0.0, 0.5);
  std::vector<LoadPoint> points;
  constexpr int rows = 40000;
  for (int n = 0; n < rows; ++n) {
    const double phase = double(n) / rows, clean = std::sin(4.0 * M_PI * phase);
    points.push_back({phase, 3.0 + clean + noise(generator), 3.0 + clean});
  }
  const LoadDisagreement d = disagreement_of(points);
  EXPECT_NEAR(d.variance_in_phase, 0.5 / (0.5 + 0.25), 0.01);  // four standard errors
  EXPECT_NEAR(d.ratio, 1.0, 4.0 * 0.5 / 3.0 / std::sqrt(double(rows)));
  EXPECT_EQ(d.strongest_harmonic, 2);
  EXPECT_NEAR(d.strongest_lag, 0.0, 0.02);
  EXPECT_TRUE(std::isnan(d.first_harmonic_lag) || std::abs(d.first_harmonic_lag) <= M_PI);
}

TEST(LoadComparison, OrderOfRowsDoesNotMatterAndRowsOfOnePhaseCountAsTheirMean) {
  const SteadyFlapping found = settled("friction2022.toml");
  SimulatedLoads loads = loads_of_cycle(found.record, 120, 3, 0.02);
  // The third cycle is off by as much as the second, the other way round.
  for (std::size_t n = 120; n < 361; ++n) loads.loads[0]->values[n] += n < 240 ? 1e-3 : n < 360 ? -1e-3 : 0.0;
  loads.loads[0]->values[360] = loads.loads[0]->values[0];
  const LoadDisagreement in_order = compare_loads_of_cycle(loads, found.record).loads[0].disagreement;
  std::vector<std::size_t> order(loads.places.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  SimulatedLoads mixed = loads;
  for (std::size_t n = 0; n < order.size(); ++n) {
    mixed.places[n] = loads.places[order[n]];
    for (std::size_t q = 0; q < 2; ++q) mixed.loads[q]->values[n] = loads.loads[q]->values[order[n]];
  }
  const LoadDisagreement shuffled = compare_loads_of_cycle(mixed, found.record).loads[0].disagreement;
  EXPECT_NEAR(shuffled.ratio, in_order.ratio, 1e-12);
  EXPECT_NEAR(shuffled.correlation, in_order.correlation, 1e-12);
  EXPECT_NEAR(shuffled.rms_difference, in_order.rms_difference, 1e-12);
  const LoadDisagreement clean =
      compare_loads_of_cycle(loads_of_cycle(found.record, 120, 1, 0.02), found.record).loads[0].disagreement;
  EXPECT_NEAR(in_order.mean_simulated, clean.mean_simulated, 1e-5);

  const SimulatedLoads late = without_first_cycles(loads, 2.0, 1.0);
  EXPECT_EQ(late.places.size(), 121u);
  EXPECT_EQ(late.loads[1]->values.size(), 121u);
}

TEST(LoadComparison, IrregularRowsGiveTheMeansOfRegularOnes) {
  const SteadyFlapping found = settled("friction2022.toml");
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> anywhere(0.0, 1.0);
  SimulatedLoads loads;
  loads.loads[0] = LoadSeries{{}, true};  // of one wing
  for (int n = 0; n < 3000; ++n) {
    loads.places.push_back(anywhere(generator));
    loads.loads[0]->values.push_back(0.5 * wing_instant(found.record, loads.places.back()).loads.lift);
  }
  const LoadDisagreement d = compare_loads_of_cycle(loads, found.record).loads[0].disagreement;
  EXPECT_NEAR(d.mean_model / found.metrics[Metric::lift_mean], 1.0, 1e-4);
  EXPECT_LT(d.rms_difference, 1e-10);
}

TEST(LoadComparison, MotionOfTheFile) {
  const Vehicle<double> v = resolve(read_design(designs + "pitch-hinge-crank.toml"));
  const PeriodicAngle stroke{0.05, {{0.7, 0.3}, {0.06, 1.2}, {0.02, -0.4}}};
  const PeriodicAngle pitch{-0.03, {{-0.7, 0.3 + 0.5 * M_PI + 0.2}, {0.1, 0.7}}};
  constexpr double frequency = 21.0;
  SimulatedLoads loads;
  loads.in_time = true;
  for (std::size_t q = 0; q < 3; ++q) loads.loads[q] = LoadSeries{};
  for (int n = 0; n < 2000; ++n) {
    const double t = n / (2000.0 * frequency);
    const AngleMotion beta = motion_of(stroke, frequency, t), psi = motion_of(pitch, frequency, t);
    loads.places.push_back(t);
    loads.stroke.push_back(beta.value);
    loads.pitch.push_back(psi.value);
    const AirLoads air = air_loads(v, beta, &psi);
    loads.loads[0]->values.push_back(air.lift);
    loads.loads[1]->values.push_back(air.stroke_moment);
    loads.loads[2]->values.push_back(air.pitch_moment);
  }
  const LoadComparison c = compare_loads_of_motion(loads, v, frequency);
  ASSERT_EQ(c.loads.size(), 3u);
  EXPECT_FALSE(c.own_motion);
  EXPECT_LT(c.stroke->error_max, 1e-12);
  EXPECT_LT(c.pitch->error_max, 1e-12);
  for (const ComparedLoad& load : c.loads) {
    EXPECT_LT(load.disagreement.rms_difference, 1e-8) << name_of(load.quantity);
    EXPECT_NEAR(load.disagreement.ratio, 1.0, 1e-8) << name_of(load.quantity);
  }
  // The mean lift against Gauss's rule between reversals.
  const PrescribedLoads means = prescribed_loads({v.wings, v.pitch}, {frequency, stroke, pitch});
  EXPECT_NEAR(c.loads[0].disagreement.mean_model / means.lift, 1.0, 1e-5);
}

TEST(WingMotion, LoadsAreThoseOfTheCycle) {
  for (const char* name : {"friction2022.toml", "pitch-hinge-crank.toml", "two-wing-direct-hinge.toml"}) {
    const SteadyFlapping found = settled(name);
    for (const double share : {0.0, 0.13, 0.31, 0.62, 0.87, 1.31}) {
      const WingInstant wings = wing_instant(found.record, share);
      const WaveformRow row = found.record.at(found.record.phase_at(wings.time));
      EXPECT_NEAR(wings.loads.lift, row.lift, 1e-12 * found.metrics[Metric::lift_peak]) << name << share;
      EXPECT_NEAR(wings.stroke.value, row.stroke_angle, 1e-13);
      EXPECT_NEAR(wings.stroke.velocity, row.flapping_velocity, 1e-11);
      const double side = row.flapping_velocity > 0.0 ? 1.0 : -1.0;
      EXPECT_NEAR(0.5 * M_PI + side * wings.pitch.value, row.angle_of_attack_deg * M_PI / 180.0, 1e-11) << name;
    }
  }
}

TEST(WingMotion, DerivativesAreThoseOfTheAngles) {
  for (const char* name : {"friction2022.toml", "pitch-hinge-crank.toml"}) {
    const SteadyFlapping found = settled(name);
    constexpr double h = 1e-5;
    const double step = h * found.record.period();
    for (const double share : {0.11, 0.4, 0.78}) {
      const WingInstant before = wing_instant(found.record, share - h), at = wing_instant(found.record, share),
                        after = wing_instant(found.record, share + h);
      const double speed = std::abs(at.stroke.velocity), size = std::abs(at.stroke.acceleration);
      EXPECT_NEAR((after.stroke.value - before.stroke.value) / (2.0 * step), at.stroke.velocity, 1e-5 * speed);
      EXPECT_NEAR((after.stroke.velocity - before.stroke.velocity) / (2.0 * step), at.stroke.acceleration, 1e-4 * size);
      EXPECT_NEAR((after.pitch.value - before.pitch.value) / (2.0 * step), at.pitch.velocity,
                  1e-4 * std::abs(at.pitch.velocity) + 1e-3);
      if (std::isfinite(at.pitch.acceleration)) {
        EXPECT_NEAR((after.pitch.velocity - before.pitch.velocity) / (2.0 * step), at.pitch.acceleration,
                    1e-4 * std::abs(at.pitch.acceleration) + 1.0);
      }
    }
  }
}

TEST(WingMotion, MomentsTakeTheAerodynamicPowerAndAddedMassNone) {
  const std::vector<std::string> with_air = {"aerodynamics.added_mass=true", "wing.planform.s22=1e-9 m5"};
  const std::string wake = "aerodynamics.induced_velocity=0.5";
  const std::string clap = "aerodynamics.clap_and_fling={ amplitude = 0.5, gap = 2, meeting_angle = ";
  for (const auto& [name, overrides] : {std::pair<const char*, std::vector<std::string>>{"pitch-hinge-crank.toml", {}},
                                        {"friction2022.toml", {}},
                                        {"friction2022.toml", with_air},
                                        {"x-wing-crank.toml", {wake}},
                                        {"x-wing-crank.toml", {clap + "\"22 deg\" }"}},
                                        {"pitch-hinge-crank.toml", {wake, clap + "\"42 deg\" }"}}}) {
    const SteadyFlapping found = settled(name, overrides);
    double power = 0.0, lift = 0.0;
    constexpr int count = 4000;
    for (int n = 0; n < count; ++n) {
      const WingInstant w = wing_instant(found.record, double(n) / count);
      lift += w.loads.lift / count;
      power += w.loads.stroke_moment * w.stroke.velocity / count;
      if (std::isfinite(w.loads.pitch_moment)) power += w.loads.pitch_moment * w.pitch.velocity / count;
    }
    EXPECT_NEAR(power / found.metrics[Metric::power_aerodynamic], 1.0, 1e-5) << name;
    EXPECT_NEAR(lift / found.metrics[Metric::lift_mean], 1.0, 1e-5) << name;
  }
}

TEST(WingMotion, StatedPitchThatIsTheLawsGivesTheLawsLoads) {
  const SteadyFlapping found =
      settled("friction2022.toml", {"aerodynamics.added_mass=true", "wing.planform.s22=1e-9 m5"});
  const Vehicle<double>& v = found.record.vehicle();
  for (const double share : {0.07, 0.21, 0.55, 0.93}) {
    const WingInstant w = wing_instant(found.record, share);
    const AirLoads stated = air_loads(v, w.stroke, &w.pitch), law = air_loads(v, w.stroke, nullptr);
    EXPECT_NEAR(stated.lift, law.lift, 1e-12 * std::abs(law.lift));
    EXPECT_NEAR(stated.stroke_moment, law.stroke_moment, 1e-10 * std::abs(law.stroke_moment));
  }
}

TEST(WingMotion, WhatSettlesHasNoLoadsAtAStatedMotion) {
  const SteadyFlapping found = settled("x-wing-crank.toml", {"aerodynamics.induced_velocity=0.5"});
  try {
    air_loads(found.record.vehicle(), {0.1, 20.0, 0.0}, nullptr);
    FAIL() << "accepted";
  } catch (const ParameterError& error) {
    EXPECT_STREQ(
        error.what(),
        "aerodynamics.induced_velocity: follows from a settled cycle, not from a stated motion; compare at the "
        "vehicle's own");
  }
}

TEST(WingMotion, WingsThatTwistHaveTheirTwistAndLiftAlone) {
  const SteadyFlapping found = settled("pitch-hinge-crank.toml", {"wing.torsion.stiffness=2e-3 N m/rad"});
  for (const double share : {0.2, 0.6}) {
    const WingInstant w = wing_instant(found.record, share);
    const WaveformRow row = found.record.at(found.record.phase_at(w.time));
    // Where the cycle is reported, at 70 % of the span.
    EXPECT_NEAR(w.pitch.value + 0.7 * w.twist, row.pitch_angle, 1e-12);
    EXPECT_GT(std::abs(w.twist), 1e-3);
    EXPECT_NEAR(w.loads.lift, row.lift, 1e-12);
    EXPECT_TRUE(std::isnan(w.loads.stroke_moment));
  }
  const LoadComparison c =
      compare_loads_of_cycle(loads_of_cycle(settled("pitch-hinge-crank.toml").record, 60), found.record);
  ASSERT_EQ(c.loads.size(), 1u);
  EXPECT_EQ(c.left_out.size(), 2u);
  EXPECT_THROW(air_loads(found.record.vehicle(), {}, nullptr), ParameterError);
}

TEST(WingMotion, SeriesStateTheirErrors) {
  std::vector<double> values;
  for (int n = 0; n < 256; ++n) {
    const double x = 2.0 * M_PI * n / 256.0;
    values.push_back(0.2 + 0.5 * std::cos(x) - 0.3 * std::sin(2.0 * x) + 0.01 * std::cos(5.0 * x));
  }
  const AngleSeries short_one = angle_series(values, 3), whole = angle_series_within(values, 1e-9, 40);
  EXPECT_NEAR(short_one.mean, 0.2, 1e-14);
  EXPECT_NEAR(short_one.cosine[0], 0.5, 1e-14);
  EXPECT_NEAR(short_one.sine[1], -0.3, 1e-14);
  EXPECT_NEAR(short_one.error_max, 0.01, 1e-13);
  EXPECT_NEAR(short_one.error_rms, 0.01 / std::sqrt(2.0), 1e-13);
  EXPECT_EQ(whole.cosine.size(), 5u);
  EXPECT_NEAR(motion_of(periodic_angle(whole), 3.0, 0.1).value, whole.at(0.3), 1e-14);
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "";
}

TEST(LoadComparison, RefusesInOneSentence) {
  const SteadyFlapping found = settled("friction2022.toml");
  SimulatedLoads half = loads_of_cycle(found.record, 40);
  for (double& place : half.places) place *= 0.45;
  EXPECT_EQ(refusal([&] { compare_loads_of_cycle(half, found.record); }),
            "phase: the rows leave 0.550 of a cycle out, from 0.450 to 1.000; expected a whole cycle without a gap "
            "above 0.100");
  SimulatedLoads pitching;
  pitching.file = "loads.csv";
  for (int n = 0; n < 20; ++n) pitching.places.push_back(n / 20.0);
  pitching.loads[2] = LoadSeries{std::vector<double>(20, 1e-5), false};
  EXPECT_EQ(refusal([&] { compare_loads_of_cycle(pitching, found.record); }),
            "loads.csv: pitch_moment: under the pitch law the model computes no moment about the pitch axis");
  const Vehicle<double> hinges = resolve(read_design(designs + "pitch-hinge-crank.toml"));
  pitching.stroke = std::vector<double>(20, 0.1);
  EXPECT_EQ(refusal([&] { compare_loads_of_motion(pitching, hinges, 20.0); }),
            "pitch_angle: is missing: of wings on hinges the stroke alone does not give the pitch");
  EXPECT_THAT(refusal([&] { without_first_cycles(half, 5.0, 1.0); }), HasSubstr("no row is left"));
}

}  // namespace
}  // namespace wingbeat
