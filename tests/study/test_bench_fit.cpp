#include "wingbeat/study/bench_fit.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "study/synthetic_bench.hpp"
#include "vehicle/hinged_design.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/fit_report.hpp"
#include "wingbeat/run/parallel.hpp"

namespace wingbeat {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const std::vector<Metric> in_air = {Metric::frequency, Metric::current_mean, Metric::lift_mean, Metric::current_peak};
const std::vector<Metric> in_vacuum = {Metric::frequency, Metric::current_mean, Metric::current_peak};
const std::vector<Metric> without_wings = {Metric::frequency, Metric::current_mean};

/// Every second row, where a test needs no more.
void thin(BenchFit& fit) {
  for (BenchLog& log : fit.logs) {
    for (std::ptrdiff_t n = 4; n >= 0; n -= 2) log.rows.erase(log.rows.begin() + n);
  }
}

/// Exact logs of the reference vehicle, computed once.
const std::vector<BenchLog>& exact_logs() {
  static const std::vector<BenchLog> logs = [] {
    const Design<double> d = reference_design();
    const std::vector<double> v = spaced_voltages(1.5, 4.0, 6);
    return std::vector<BenchLog>{bench_log(d, Condition::air, false, v, in_air),
                                 bench_log(d, Condition::vacuum, false, v, in_vacuum),
                                 bench_log(d, Condition::wingless, false, v, without_wings)};
  }();
  return logs;
}

BenchFit bench(double noise, std::uint64_t seed, bool six = false) {
  BenchFit fit;
  fit.design = reference_design();
  fit.profiles = false;
  fit.tolerance = noise > 0.0 ? 1e-6 : 1e-7;
  std::mt19937_64 random(seed);
  for (const BenchLog& log : exact_logs()) fit.logs.push_back(with_noise(log, noise, random));
  set_deviations(fit, std::max(noise, 1e-3));
  fit.parameters = {free_parameter("friction.radius", 0.0, 8e-3, 1e-3),
                    free_parameter("aerodynamics.pitch_coefficient", 1e-3, 1e-2, 3e-3),
                    free_parameter("motor.viscous_damping", 0.0, 2e-5, 8e-6)};
  if (six) {
    fit.parameters.push_back(free_parameter("motor.inertia", 1e-8, 1e-6, 3e-7));
    fit.parameters.push_back(free_parameter("wing.planform.s2", 5e-7, 1e-5, 1.5e-6));
    fit.parameters.push_back(free_parameter("wing.planform.s3", 2e-8, 5e-7, 2e-7));
  }
  return fit;
}

double truth(const std::string& key) { return *design_parameter(key).value(reference_design()); }

TEST(BenchFit, ExactDataGiveTheVehicleBack) {
  const FitResult r = fit_bench(bench(0.0, 1, true));
  EXPECT_TRUE(r.converged) << r.message;
  for (const FittedParameter& p : r.parameters) EXPECT_NEAR(*p.value / truth(p.key), 1.0, 2e-4) << p.key;
  EXPECT_LT(r.chi_square, 1e-2);
  EXPECT_TRUE(r.unreached.empty());
}

// A power supply stands in the battery's place; what the battery weighs still counts.
TEST(BenchFit, AVehicleWithABatteryIsFittedOnAPowerSupply) {
  BenchFit fit = bench(0.0, 1, true);
  const FitResult expected = fit_bench(fit);
  const std::vector<Metric> seen = {Metric::voltage, Metric::frequency, Metric::lift_to_weight};
  Design<double> heavier = reference_design();
  heavier.mass = *heavier.mass + 2e-3;
  fit.logs.push_back(bench_log(heavier, Condition::air, false, {2.5, 3.5}, seen));
  set_deviations(fit, 0.01);
  Supply<double>& supply = fit.design.supply;
  supply = {};
  supply.type = SupplyType::battery;
  supply.battery.cells = 1.0;
  supply.battery.cell_voltage = 3.7;
  supply.battery.capacity = 100.0;
  supply.battery.specific_energy = 3.7 * 100.0 / 2e-3;
  supply.battery.internal_resistance = 0.5;
  const FitResult r = fit_bench(fit);
  EXPECT_TRUE(r.converged) << r.message;
  for (const FittedParameter& p : r.parameters) EXPECT_NEAR(*p.value / truth(p.key), 1.0, 2e-4) << p.key;
  EXPECT_LT(r.chi_square, 1e-2);
  EXPECT_EQ(r.parameters.size(), expected.parameters.size());
  EXPECT_EQ(r.design.supply.type, SupplyType::battery);
  EXPECT_EQ(r.design.supply.battery.internal_resistance, 0.5);
  EXPECT_FALSE(r.design.masses.supply.has_value());
}

TEST(BenchFit, FrequencySetOnTheBench) {
  BenchFit fit = bench(0.0, 1);
  const std::vector<double> v = spaced_voltages(2.0, 4.0, 6);
  const std::vector<Metric> seen = {Metric::voltage, Metric::current_mean, Metric::power_electrical};
  fit.logs = {bench_log(reference_design(), Condition::air, false, v, seen, Given::frequency),
              bench_log(reference_design(), Condition::wingless, false, v, seen, Given::frequency)};
  set_deviations(fit, 0.01);
  const FitResult r = fit_bench(fit);
  for (const FittedParameter& p : r.parameters) EXPECT_NEAR(*p.value / truth(p.key), 1.0, 1e-3) << p.key;
}

TEST(BenchFit, WaveformOfTheCurrentDeterminesTheInertia) {
  BenchFit fit = bench(0.0, 1);
  const SteadyFlapping orbit = find_steady_flapping(reference_vehicle(), {.tolerance = 1e-10});
  BenchLog wave;
  wave.file = "waveform";
  wave.waveform = true;
  wave.columns = {{true, {}, WaveformQuantity::current}, {true, {}, WaveformQuantity::crank_speed}};
  for (int n = 0; n < 24; ++n) {
    const double theta = two_pi * n / 24.0;
    const WaveformRow row = orbit.record.at(theta);
    wave.rows.push_back({n + 2, 3.0, theta, {row.current, row.crank_speed}});
  }
  fit.logs = {wave};
  fit.deviations.clear();
  set_deviations(fit, 0.01);
  fit.parameters = {free_parameter("friction.radius", 0.0, 8e-3, 1e-3),
                    free_parameter("motor.inertia", 1e-8, 1e-6, 3e-7)};
  const FitResult r = fit_bench(fit);
  for (const FittedParameter& p : r.parameters) {
    EXPECT_NEAR(*p.value / truth(p.key), 1.0, 1e-5) << p.key;
    EXPECT_LT(p.standard_error / *p.value, 0.02) << p.key;
  }
}

// The hinge takes the place of C_alpha: a log of a direct drive over the amplitude of its supply determines it.
TEST(BenchFit, DirectDriveDeterminesItsPitchHinges) {
  const Design<double> design = hinged_design(3e-4);
  const std::vector<Metric> seen = {Metric::current_rms, Metric::lift_mean, Metric::stroke_amplitude,
                                    Metric::pitch_amplitude, Metric::pitch_phase};
  const BenchLog exact = bench_log(design, Condition::air, true, spaced_voltages(1.0, 4.0, 5), seen);
  BenchFit fit;
  fit.design = design;
  fit.parameters = {free_parameter("pitch.stiffness", 1e-4, 1e-3, 6e-4),
                    free_parameter("pitch.damping", 0.0, 2e-7, 5e-8),
                    free_parameter("motor.viscous_damping", 0.0, 2e-5, 6e-6)};
  fit.logs = {exact};
  set_deviations(fit, 0.01);
  const FitResult r = fit_bench(fit);
  EXPECT_TRUE(r.converged) << r.message;
  EXPECT_LT(r.chi_square, 1e-4);
  for (const FittedParameter& p : r.parameters) {
    ASSERT_TRUE(p.value) << p.key;
    EXPECT_NEAR(*p.value / *design_parameter(p.key).value(design), 1.0, 1e-3) << p.key;
    EXPECT_GT(p.profile_upper_95, *p.value) << p.key;
  }
  // Without the lift and the wings' angles the current alone tells of the hinge, if much less.
  fit.profiles = false;
  fit.logs = {bench_log(design, Condition::air, true, spaced_voltages(1.0, 4.0, 5), {Metric::current_rms})};
  fit.deviations.clear();
  set_deviations(fit, 0.01);
  const FitResult poor = fit_bench(fit);
  EXPECT_TRUE(!poor.parameters[0].value || poor.parameters[0].standard_error > 3.0 * r.parameters[0].standard_error);
  // Nothing of the hinge is seen without wings.
  fit.logs = {bench_log(design, Condition::wingless, false, spaced_voltages(1.0, 4.0, 5), {Metric::current_rms})};
  const FitResult blind = fit_bench(fit);
  EXPECT_EQ(blind.parameters[0].undetermined, Undetermined::without_influence);
}

TEST(BenchFit, TruthLiesInsideTheIntervals) {
  // The study of 200 experiments is benchmarks/coverage; here enough to notice wrong intervals.
  int inside = 0, all = 0;
  for (std::uint64_t seed = 100; seed < 103; ++seed) {
    const FitResult r = fit_bench(bench(0.015, seed, true));
    for (const FittedParameter& p : r.parameters) {
      ASSERT_TRUE(p.value) << p.key;
      ++all;
      inside += truth(p.key) >= p.lower_95 && truth(p.key) <= p.upper_95;
    }
  }
  EXPECT_EQ(all, 18);
  // 17 of 18 expected; intervals too narrow by a half would hold 12.
  EXPECT_GE(inside, 15);
}

TEST(BenchFit, EstimatedDeviationsFindTheNoise) {
  BenchFit fit = bench(0.02, 7);
  for (auto& [quantity, deviation] : fit.deviations) deviation = {Deviation::Kind::estimated, 0.0};
  // One condition at a narrow range of voltages, so that relative and absolute noise are alike.
  fit.logs.clear();
  std::mt19937_64 random(7);
  const std::vector<double> v = spaced_voltages(2.9, 3.1, 40);
  BenchLog log = bench_log(reference_design(), Condition::air, false, v, {Metric::frequency, Metric::current_mean});
  fit.logs.push_back(with_noise(log, 0.02, random));
  fit.parameters.resize(1);
  const FitResult r = fit_bench(fit);
  ASSERT_EQ(r.estimated_deviations.size(), 2U);
  EXPECT_NEAR(r.estimated_deviations.at(measured(Metric::frequency)) / (0.02 * 22.0), 1.0, 0.3);
  EXPECT_NEAR(r.estimated_deviations.at(measured(Metric::current_mean)) / (0.02 * 0.18), 1.0, 0.3);
  EXPECT_NEAR(r.chi_square / r.degrees_of_freedom, 1.0, 1e-3);
}

TEST(BenchFit, WingsAndAirAreNotGuessedFromVacuumAndWinglessData) {
  BenchFit fit = bench(0.01, 3, true);
  std::erase_if(fit.logs, [](const BenchLog& log) { return log.condition == Condition::air; });
  const FitResult r = fit_bench(fit);
  for (const FittedParameter& p : r.parameters) {
    const bool aerodynamic = p.key.starts_with("aerodynamics") || p.key.starts_with("wing.planform");
    EXPECT_EQ(p.value.has_value(), !aerodynamic) << p.key;
    EXPECT_EQ(std::isnan(p.standard_error), aerodynamic) << p.key;
    if (aerodynamic) {
      EXPECT_EQ(describe(p.undetermined), "no measured quantity depends on it");
    }
  }
  EXPECT_THAT(describe(r.findings),
              Contains(HasSubstr("not identifiable, no measured quantity depends on it: "
                                 "aerodynamics.pitch_coefficient, wing.planform.s2, wing.planform.s3")));
  // The vehicle that comes out keeps the starts.
  EXPECT_EQ(r.design.wing.planform.s2, 1.5e-6);
  EXPECT_NEAR(r.design.friction.coefficient / 2.5e-3, 1.0, 0.05);
}

TEST(BenchFit, ProductsAreNamedAsSuch) {
  BenchFit fit = bench(0.01, 3);
  // Density and both chord moments enter as rho S_2 and rho S_3 alone.
  fit.parameters = {free_parameter("aerodynamics.air_density", 0.5, 3.0, 1.0),
                    free_parameter("wing.planform.s3", 2e-8, 5e-7, 1.2e-7),
                    free_parameter("friction.radius", 0.0, 8e-3, 1e-3)};
  for (BenchLog& log : fit.logs) {
    // No lift: it would fix the density.
    for (std::size_t c = log.columns.size(); c-- > 0;) {
      if (log.columns[c].metric != Metric::lift_mean) continue;
      log.columns.erase(log.columns.begin() + std::ptrdiff_t(c));
      for (BenchRow& row : log.rows) row.values.erase(row.values.begin() + std::ptrdiff_t(c));
    }
  }
  const FitResult r = fit_bench(fit);
  EXPECT_FALSE(r.parameters[0].value || r.parameters[1].value);
  ASSERT_TRUE(r.parameters[2].value.has_value());
  EXPECT_LT(std::abs(*r.parameters[2].value - 2.5e-3), 4.0 * r.parameters[2].standard_error);
  EXPECT_THAT(describe(r.findings), Contains(HasSubstr("of which the data know only the product")));
}

TEST(BenchFit, ConditionsNameWhatTheyContribute) {
  const FitResult r = fit_bench(bench(0.01, 5));
  EXPECT_THAT(describe(r.findings), Contains("only air determines aerodynamics.pitch_coefficient"));
  EXPECT_THAT(describe(r.findings), Contains(HasSubstr("without wingless the intervals would be wider")));
  EXPECT_THAT(describe(r.findings), Contains(HasSubstr("friction.radius is the product mu r_e")));
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0.0;
    for (const ConditionShare& c : r.conditions) sum += c.share[k];
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(BenchFit, ProfileAgreesWithTheStandardErrorWhereTheModelIsNearlyLinear) {
  BenchFit fit = bench(0.01, 5);
  fit.profiles = true;
  const FitResult r = fit_bench(fit);
  for (const FittedParameter& p : r.parameters) {
    EXPECT_NEAR((p.profile_upper_95 - *p.value) / (p.upper_95 - *p.value), 1.0, 0.1) << p.key;
    EXPECT_NEAR((*p.value - p.profile_lower_95) / (*p.value - p.lower_95), 1.0, 0.1) << p.key;
    for (const auto& point : p.profile) EXPECT_GE(point.excess, 0.0);
  }
}

TEST(BenchFit, DependsNeitherOnThreadsNorOnTheirOrder) {
  BenchFit fit = bench(0.01, 3);
  fit.design.motor.constants.armature_inductance = 2e-5;  // stiff
  const std::vector<double> v = spaced_voltages(2.0, 4.0, 3);
  const std::vector<Metric> seen = {Metric::voltage, Metric::current_mean};
  fit.logs = {bench_log(fit.design, Condition::air, false, v, seen, Given::frequency),
              bench_log(fit.design, Condition::wingless, false, v, {Metric::frequency, Metric::current_mean})};
  set_deviations(fit, 0.01);
  fit.starts = 3;
  fit.profiles = true;
  const FitResult alone = fit_bench(fit);
  EXPECT_TRUE(alone.converged);
  const auto backwards = [](std::size_t count, const auto& act) {
    while (count > 0) act(--count);
  };
  const auto at_once = [](std::size_t count, const auto& act) { for_each_in_parallel(count, act); };
  std::vector<std::string> reported;
  for (const ForEach& for_each : {ForEach(backwards), ForEach(at_once)}) {
    const FitResult other = fit_bench(fit, [&](const std::string& what) { reported.push_back(what); }, for_each);
    EXPECT_EQ(other.deviance, alone.deviance);
    EXPECT_EQ(other.evaluations, alone.evaluations);
    EXPECT_EQ(other.starts_converged, alone.starts_converged);
    for (std::size_t k = 0; k < alone.parameters.size(); ++k) {
      const FittedParameter &a = alone.parameters[k], &b = other.parameters[k];
      EXPECT_EQ(a.kept, b.kept) << a.key;
      EXPECT_EQ(a.standard_error, b.standard_error) << a.key;
      EXPECT_EQ(a.profile_lower_95, b.profile_lower_95) << a.key;
      EXPECT_EQ(a.profile_upper_95, b.profile_upper_95) << a.key;
      ASSERT_EQ(a.profile.size(), b.profile.size()) << a.key;
      for (std::size_t n = 0; n < a.profile.size(); ++n) EXPECT_EQ(a.profile[n].excess, b.profile[n].excess) << a.key;
    }
  }
  EXPECT_THAT(reported, testing::Contains("start 2 of 3"));
  EXPECT_THAT(reported, testing::Contains("side of the profiles 6 of 6"));
}

TEST(BenchFit, RobustLossShrugsOffOutliers) {
  BenchFit fit = bench(0.01, 9);
  fit.logs[0].rows[2].values[1] *= 1.6;
  fit.logs[1].rows[4].values[0] *= 0.5;
  const auto deviation_of_radius = [&](Loss loss) {
    fit.loss = loss;
    return std::abs(*fit_bench(fit).parameters[0].value - 2.5e-3);
  };
  const double plain = deviation_of_radius(Loss::none);
  EXPECT_GT(plain, 2e-4);
  for (const Loss loss : {Loss::huber, Loss::soft_l1, Loss::cauchy}) EXPECT_LT(deviation_of_radius(loss), 0.4 * plain);
}

TEST(BenchFit, RowsThatTheModelCannotReachAreNamed) {
  BenchFit fit = bench(0.01, 11);
  // A reading of a frequency at a voltage at which this motor cannot overcome its own friction.
  fit.design.motor.constants.friction_torque = 4e-4;
  fit.logs.resize(1);
  thin(fit);
  fit.logs[0].rows.insert(fit.logs[0].rows.begin(), BenchRow{2, 0.3, 0.0, {2.0, 0.03, 1e-4, 0.03}});
  const FitResult r = fit_bench(fit);
  ASSERT_EQ(r.unreached.size(), 1U);
  EXPECT_EQ(r.unreached[0].row, 0U);
  EXPECT_EQ(r.unreached[0].status, FlappingStatus::stalled);
  EXPECT_THAT(describe(r.unreached[0]), HasSubstr("stall torque"));
  EXPECT_TRUE(std::isnan(r.points[0].fitted));
  EXPECT_EQ(r.degrees_of_freedom, 3 * 4 - 3);
}

TEST(BenchFit, StartsOfAHypercubeFindTheSameLeast) {
  BenchFit fit = bench(0.01, 13);
  fit.starts = 4;
  const FitResult r = fit_bench(fit);
  EXPECT_GE(r.starts_converged, 3);
  EXPECT_EQ(r.starts_converged + r.starts_elsewhere, 4);
  EXPECT_NEAR(*r.parameters[0].value / 2.5e-3, 1.0, 0.05);
}

/// The radius at which half of the motor's output at 3 V in air is friction.
double half_friction_radius(Design<double> d) {
  double low = 0.0, high = 8e-3;
  for (int n = 0; n < 50; ++n) {
    const double middle = 0.5 * (low + high);
    d.friction.coefficient = middle;
    const SteadyFlapping s = find_steady_flapping(resolve(d));
    const bool less = s.metrics[Metric::power_friction] < 0.5 * s.metrics[Metric::power_motor];
    (less ? low : high) = middle;
  }
  return low;
}

/// The pitch coefficient at which alpha is 45 degrees where lift peaks.
double pitch_for_45_degrees(Design<double> d) {
  for (int n = 0; n < 100; ++n) {
    const SteadyFlapping s = find_steady_flapping(resolve(d));
    const auto rows = s.record.waveform(721);
    const auto peak =
        std::max_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.lift < b.lift; });
    d.aerodynamics.pitch_coefficient =
        0.5 * (d.aerodynamics.pitch_coefficient + 0.25 * pi / std::abs(peak->flapping_velocity));
  }
  return d.aerodynamics.pitch_coefficient;
}

TEST(BenchFit, ThePapersOwnPathArrivesAtItsTable) {
  BenchFit fit = bench(0.0, 1);
  Design<double> guess = reference_design();
  guess.aerodynamics.pitch_coefficient = pitch_for_45_degrees(guess);
  guess.friction.coefficient = half_friction_radius(guess);
  // Far from where it should end.
  EXPECT_GT(std::abs(guess.friction.coefficient / 2.5e-3 - 1.0), 0.1);
  EXPECT_GT(std::abs(guess.aerodynamics.pitch_coefficient / 5e-3 - 1.0), 0.3);
  fit.parameters = {
      free_parameter("friction.radius", 0.0, 8e-3, guess.friction.coefficient),
      free_parameter("aerodynamics.pitch_coefficient", 1e-3, 1.5e-2, guess.aerodynamics.pitch_coefficient)};
  const FitResult r = fit_bench(fit);
  EXPECT_NEAR(*r.parameters[0].value, 2.5e-3, 1e-6);
  EXPECT_NEAR(*r.parameters[1].value, 5e-3, 1e-6);
}

TEST(CompareFriction, DataOfALoadProportionalVehicleRankItFirst) {
  BenchFit fit = bench(0.01, 17);
  thin(fit);
  fit.design.spring.stiffness = 1.377e-3;
  const auto ranked = compare_friction(fit, [](const std::string& key) { return design_parameter(key); });
  ASSERT_EQ(ranked.size(), 5U);
  EXPECT_EQ(ranked[0].law, FrictionLaw::load_proportional);
  EXPECT_EQ(ranked[0].aicc_excess, 0.0);
  for (std::size_t n = 1; n < 5; ++n) {
    EXPECT_GT(ranked[n].aicc_excess, 100.0) << name_of(ranked[n].law);
    EXPECT_GT(ranked[n].prediction_error, 2.0 * ranked[0].prediction_error) << name_of(ranked[n].law);
    EXPECT_EQ(ranked[n].left_out.size(), 3U);
    // The paper's argument: without load-proportional friction, springs would not save power.
    EXPECT_GT(ranked[n].power_springs_on / ranked[n].power_springs_off, 0.95) << name_of(ranked[n].law);
  }
  EXPECT_LT(ranked[0].power_springs_on / ranked[0].power_springs_off, 0.9);
}

TEST(BenchFit, RefusesWhatCannotBeFitted) {
  const auto refusal = [](const BenchFit& fit) {
    try {
      fit_bench(fit);
    } catch (const ParameterError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  BenchFit fit = bench(0.01, 1);
  fit.parameters[0].start = 1.0;
  EXPECT_THAT(refusal(fit), HasSubstr("friction.radius: the start 1 does not lie within the bounds 0 to 0.008 [m]"));
  fit = bench(0.01, 1);
  fit.parameters.push_back(fit.parameters[0]);
  EXPECT_THAT(refusal(fit), HasSubstr("friction.radius: is given twice"));
  fit = bench(0.01, 1);
  fit.parameters.push_back(free_parameter("friction.damping", 0.0, 1e-5, 1e-6));
  EXPECT_THAT(refusal(fit), HasSubstr("friction.radius: another free parameter takes its place in the vehicle"));
  fit = bench(0.01, 1);
  fit.logs[0].springs = true;
  EXPECT_THAT(refusal(fit), HasSubstr("a log was taken with springs, but the vehicle file has none"));
  fit = bench(0.01, 1);
  fit.parameters = {free_parameter("supply.voltage", 1.0, 4.0, 3.0)};
  EXPECT_THAT(refusal(fit), HasSubstr("the logs state the supply"));
}

}  // namespace
}  // namespace wingbeat
