// Fits to waveforms: logs in time with unknown phase, readings of a balance.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <random>

#include "study/balance_response.hpp"
#include "study/bench_model.hpp"
#include "study/bench_unknowns.hpp"
#include "study/synthetic_bench.hpp"
#include "vehicle/hinged_design.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat {
namespace {

constexpr Balance soft_balance{8e-3, 8e-3 * 2.1e5, 8e-3 * 60.0};  // resonates at 73 Hz

SteadyFlapping orbit_of(const Design<double>& design, double tolerance = 1e-9) {
  return find_steady_flapping(resolve(design), {.tolerance = tolerance});
}

/// The deflection force of a balance under the lift of an orbit, by its equation of motion in time; at the end of
/// `periods` periods and then at `count` equal parts of the next one.
std::vector<double> reading_in_time(const SteadyFlapping& orbit, const Balance& b, int count) {
  const double period = orbit.record.period();
  constexpr int steps = 2000;
  std::vector<double> lift;  // at half steps
  for (int n = 0; n < 2 * steps; ++n)
    lift.push_back(orbit.record.at(orbit.record.phase_at(period * n / (2 * steps))).lift);
  const double h = period / steps;
  std::array<double, 2> y{0.0, 0.0};
  const auto rate = [&](const std::array<double, 2>& s, double force) {
    return std::array<double, 2>{s[1], (force - b.damping * s[1] - b.stiffness * s[0]) / b.mass};
  };
  std::vector<double> readings;
  constexpr int settle = 60;
  for (int n = 0; n < (settle + 1) * steps; ++n) {
    if (n >= settle * steps && n % (steps / count) == 0) readings.push_back(b.stiffness * y[0]);
    const double f0 = lift[std::size_t(2 * (n % steps))], f1 = lift[std::size_t(2 * (n % steps) + 1)],
                 f2 = lift[std::size_t((2 * (n % steps) + 2) % (2 * steps))];
    const auto moved = [&](const std::array<double, 2>& k, double by) {
      return std::array<double, 2>{y[0] + by * k[0], y[1] + by * k[1]};
    };
    const auto k1 = rate(y, f0), k2 = rate(moved(k1, 0.5 * h), f1), k3 = rate(moved(k2, 0.5 * h), f1),
               k4 = rate(moved(k3, h), f2);
    for (std::size_t i = 0; i < 2; ++i) y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  }
  return readings;
}

TEST(BalanceResponse, IsThatOfTheEquationInTime) {
  for (const bool direct : {false, true}) {
    const SteadyFlapping orbit = orbit_of(direct ? hinged_design(3e-4) : reference_design());
    ASSERT_EQ(orbit.status, FlappingStatus::flapping);
    std::vector<double> lift;
    const double period = orbit.record.period();
    for (int n = 0; n < balance_instants; ++n) {
      lift.push_back(orbit.record.at(orbit.record.phase_at(period * n / balance_instants)).lift);
    }
    const auto harmonics = BalanceResponse::harmonics_of(lift);
    const BalanceResponse response(soft_balance, 1.0 / period);
    const std::vector<double> expected = reading_in_time(orbit, soft_balance, 20);
    double size = 0.0;
    for (const double x : expected) size = std::max(size, std::abs(x));
    for (int k = 0; k < 20; ++k) {
      EXPECT_NEAR(response.reading(harmonics, k / 20.0), expected[std::size_t(k)], 1e-5 * size) << direct << " " << k;
    }
  }
}

TEST(BalanceResponse, SlopesAgainstDifferences) {
  std::vector<double> force;
  for (int n = 0; n < balance_instants; ++n) force.push_back(std::exp(std::sin(two_pi * n / balance_instants)));
  const auto harmonics = BalanceResponse::harmonics_of(force);
  const double place = 0.37, f = 22.0;
  const auto reading = [&](double periods, const Balance& b, double frequency) {
    return BalanceResponse(b, frequency).reading(harmonics, periods);
  };
  const BalanceResponse::Slopes s = BalanceResponse(soft_balance, f).slopes(harmonics, place);
  const auto difference = [](double up, double down, double step) { return (up - down) / (2.0 * step); };
  const double e = 1e-6;
  EXPECT_NEAR(s.periods, difference(reading(place + e, soft_balance, f), reading(place - e, soft_balance, f), e),
              1e-6 * std::abs(s.periods));
  EXPECT_NEAR(s.frequency, difference(reading(place, soft_balance, f + e), reading(place, soft_balance, f - e), e),
              1e-6 * std::abs(s.frequency));
  const auto by = [&](double Balance::* member) {
    Balance up = soft_balance, down = soft_balance;
    const double step = e * (soft_balance.*member);
    up.*member += step;
    down.*member -= step;
    return difference(reading(place, up, f), reading(place, down, f), step);
  };
  EXPECT_NEAR(s.balance.mass, by(&Balance::mass), 1e-6 * std::abs(s.balance.mass));
  EXPECT_NEAR(s.balance.stiffness, by(&Balance::stiffness), 1e-6 * std::abs(s.balance.stiffness));
  EXPECT_NEAR(s.balance.damping, by(&Balance::damping), 1e-6 * std::abs(s.balance.damping));
}

constexpr MeasuredQuantity waveform_of(WaveformQuantity q) { return {true, {}, q}; }

struct Case {
  const char* name;
  bool direct, in_time;
  Given given;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

/// Every quantity of a waveform, at instants that are no steps of the solver.
BenchFit all_quantities(const Case& c) {
  BenchFit fit;
  fit.design = c.direct ? hinged_design(3e-4) : reference_design();
  fit.tolerance = 1e-11;
  fit.balance = soft_balance;
  BenchLog log;
  log.file = "all.csv";
  log.waveform = true;
  log.in_time = c.in_time;
  log.given = c.given;
  log.springs = c.direct;
  for (int q = 0; q < waveform_quantity_count; ++q) {
    const auto quantity = WaveformQuantity(q);
    if (quantity == WaveformQuantity::pitch_angle && !c.direct) continue;
    if (quantity == WaveformQuantity::rod_force && c.direct) continue;
    log.columns.push_back(waveform_of(quantity));
  }
  log.unknown_zeros = {WaveformQuantity::stroke_angle};
  for (int n = 0; n < 9; ++n) {
    const double given = c.given == Given::frequency ? 21.0 : c.direct ? fit.design.supply.voltage : 3.0;
    log.rows.push_back({n + 2, given, two_pi * (n + 0.31) / 9.0, std::vector<double>(log.columns.size(), 1.0)});
  }
  fit.logs = {log};
  set_deviations(fit, 0.01);
  const char* keys[] = {"motor.viscous_damping",    "motor.torque_constant", "wing.inertia",
                        "aerodynamics.air_density", "motor.inertia",         "motor.armature_resistance"};
  for (const char* key : keys) {
    const DesignParameter p = design_parameter(key);
    const std::optional<double> value = p.value(fit.design);
    if (value && *value > 0.0) fit.parameters.push_back({p, 0.5 * *value, 2.0 * *value, *value});
  }
  for (const char* key : {"balance.mass", "balance.stiffness", "balance.damping"}) {
    FreeParameter p{{key, ""}, 1e-6, 1e6, 0.0};
    p.of_bench = balance_unknown(key);
    p.start = soft_balance.*p.of_bench->of_balance->number;
    fit.parameters.push_back(p);
  }
  return with_bench_unknowns(fit);
}

class Waveforms : public testing::TestWithParam<Case> {};

// Exact derivatives of all that a waveform shows, at fixed crank angles and at fixed shares of the period, by numbers
// of the vehicle and of the bench: fourth-order differences of orbits found anew.
TEST_P(Waveforms, DerivativesAgainstDifferences) {
  const BenchFit fit = all_quantities(GetParam());
  BenchModel model(fit);
  std::vector<double> x;
  for (const FreeParameter& p : fit.parameters) {
    const bool phase = p.of_bench && p.of_bench->kind == BenchUnknown::Kind::phase;
    x.push_back(phase ? 1.234 : p.start);
  }
  model.evaluate(x, true);
  ASSERT_TRUE(model.predictions()[0].reached);
  const Eigen::MatrixXd exact = model.jacobian();
  const std::vector<double> values = model.fitted();
  std::vector<double> size(waveform_quantity_count, 0.0);
  for (std::size_t o = 0; o < values.size(); ++o) {
    double& s = size[std::size_t(model.observations()[o].quantity.quantity)];
    s = std::max(s, std::abs(values[o]));
  }
  double worst = 0.0;
  std::string where;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const bool log_unknown =
        fit.parameters[k].of_bench && fit.parameters[k].of_bench->kind >= BenchUnknown::Kind::phase;
    const double scale = log_unknown ? 1.0 : x[k], step = 1e-3 * scale;
    std::vector<std::vector<double>> at;
    for (const double by : {-2.0, -1.0, 1.0, 2.0}) {
      std::vector<double> moved = x;
      moved[k] += by * step;
      model.evaluate(moved, false);
      at.push_back(model.fitted());
    }
    for (std::size_t o = 0; o < values.size(); ++o) {
      const double difference = (at[0][o] - 8.0 * at[1][o] + 8.0 * at[2][o] - at[3][o]) / (12.0 * step);
      const double unit = size[std::size_t(model.observations()[o].quantity.quantity)] / scale;
      const double error = std::abs(exact(Eigen::Index(o), Eigen::Index(k)) - difference) / unit;
      if (error > worst) {
        worst = error;
        where = fit.parameters[k].parameter.key + " of " + name_of(model.observations()[o].quantity);
      }
    }
  }
  EXPECT_LT(worst, 2e-6) << where;
}

INSTANTIATE_TEST_SUITE_P(All, Waveforms,
                         testing::Values(Case{"crank_in_time", false, true, Given::voltage},
                                         Case{"crank_by_angle", false, false, Given::voltage},
                                         Case{"frequency_set", false, true, Given::frequency},
                                         Case{"direct", true, true, Given::voltage}),
                         [](const auto& test) { return std::string(test.param.name); });

/// Rows in time of the reference vehicle, from an unknown phase, with noise; the balance's in time, too.
BenchFit bench_in_time(double noise, std::uint64_t seed) {
  static const SteadyFlapping orbit = orbit_of(reference_design());
  static const std::vector<double> readings = reading_in_time(orbit, soft_balance, 50);
  BenchFit fit;
  fit.design = reference_design();
  fit.profiles = false;
  fit.tolerance = 1e-7;
  fit.balance = Balance{soft_balance.mass, 0.8 * soft_balance.stiffness, 1.5 * soft_balance.damping};
  BenchLog log;
  log.file = "signals.csv";
  log.waveform = log.in_time = true;
  log.columns = {waveform_of(WaveformQuantity::current),
                 waveform_of(WaveformQuantity::stroke_angle),
                 waveform_of(WaveformQuantity::balance_force),
                 {false, Metric::frequency, {}}};
  log.unknown_zeros = {WaveformQuantity::stroke_angle};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const double period = orbit.record.period();
  const double deviations[] = {noise * 0.2, noise * 0.7, noise * 0.02, noise * 0.1 / period};
  for (int n = 0; n < 50; ++n) {
    const int place = (n + 17) % 50;  // the log starts at 0.34 periods
    const WaveformRow row = orbit.record.at(orbit.record.phase_at(period * place / 50.0));
    std::vector<double> values = {row.current, row.stroke_angle + 0.3, readings[std::size_t(place)],
                                  n == 0 ? 1.0 / period : absent};
    std::vector<double> scatter;
    for (std::size_t c = 0; c < values.size(); ++c) {
      values[c] += deviations[c] * normal(random);
      scatter.push_back(std::max(deviations[c], 1e-7));
    }
    log.rows.push_back({n + 2, 3.0, two_pi * n / 50.0, values, scatter});
  }
  fit.logs = {log};
  for (const MeasuredQuantity& q : log.columns) fit.deviations[q] = {Deviation::Kind::scatter, 0.0};
  fit.parameters = {free_parameter("friction.radius", 0.0, 8e-3, 1.5e-3),
                    free_parameter("motor.inertia", 1e-8, 1e-6, 2.5e-7),
                    free_parameter("aerodynamics.pitch_coefficient", 1e-3, 1e-2, 4e-3)};
  for (const char* key : {"balance.stiffness", "balance.damping"}) {
    const bool stiffness = key == std::string("balance.stiffness");
    const double start = stiffness ? fit.balance->stiffness : fit.balance->damping;
    FreeParameter p{{key, stiffness ? "N/m" : "N s/m"}, 0.2 * start, 5.0 * start, start};
    p.of_bench = balance_unknown(key);
    fit.parameters.push_back(p);
  }
  return fit;
}

double truth(const std::string& key) {
  if (key == "balance.stiffness") return soft_balance.stiffness;
  if (key == "balance.damping") return soft_balance.damping;
  if (key.starts_with("phase")) return two_pi * 0.34;
  if (key.starts_with("zero")) return 0.3;
  return *design_parameter(key).value(reference_design());
}

TEST(WaveformFit, FindsVehicleBalancePhaseAndZero) {
  const FitResult r = fit_bench(bench_in_time(0.0, 1));
  EXPECT_TRUE(r.converged) << r.message;
  ASSERT_EQ(r.parameters.size(), 7u);
  for (const FittedParameter& p : r.parameters) EXPECT_NEAR(*p.value / truth(p.key), 1.0, 3e-4) << p.key;
  EXPECT_EQ(r.parameters[0].of, FittedParameter::Of::vehicle);
  EXPECT_EQ(r.parameters[3].of, FittedParameter::Of::balance);
  EXPECT_EQ(r.parameters[5].of, FittedParameter::Of::log);
  EXPECT_EQ(r.cycles.size(), 3u);
}

TEST(WaveformFit, IntervalsHoldTheTruth) {
  std::map<std::string, int> inside;
  constexpr int experiments = 20;
  for (int n = 0; n < experiments; ++n) {
    const FitResult r = fit_bench(bench_in_time(0.01, 10 + std::uint64_t(n)));
    ASSERT_FALSE(r.misfit);
    for (const FittedParameter& p : r.parameters) {
      inside[p.key] += p.lower_95 <= truth(p.key) && truth(p.key) <= p.upper_95;
    }
  }
  // 95 %: fewer than 16 of 20 have a probability of 3e-4.
  for (const auto& [key, count] : inside) EXPECT_GE(count, 16) << key;
}

TEST(WaveformFit, ASignalAtTwiceTheFrequencyIsAQuestion) {
  BenchFit fit = bench_in_time(0.0, 1);
  for (BenchRow& row : fit.logs[0].rows) row.values[3] *= 2.0;
  try {
    fit_bench(fit);
    FAIL() << "no question";
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.key(), "log.cycle_frequency");
  }
}

TEST(WaveformFit, WithoutABalanceItsReadingsAreRefused) {
  BenchFit fit = bench_in_time(0.0, 1);
  fit.balance.reset();
  fit.parameters.resize(3);
  EXPECT_THROW(fit_bench(fit), ParameterError);
}

}  // namespace
}  // namespace wingbeat
