// Heat constants from heating curves: synthetic ones of known constants, integrated here by fourth-order steps of their
// own, with noise.
#include "wingbeat/study/motor_heating.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <random>

#include "wingbeat/core/status.hpp"

namespace wingbeat::motor_heating_tests {
namespace {

using testing::HasSubstr;

struct Truth {
  double R1 = 20.0, R2 = 48.0, tau_w = 5.0, tau_c = 200.0;  // [K/W], [s]
  double R0 = 5.4, a = 0.0039, ambient = 22.0;              // at 25 degC [ohm], [1/K], [degC]
};
struct Noise {
  double current = 0.0, voltage = 0.0, temperature = 0.0, resistance = 0.0;
};

/// Winding and case [degC] at the times; `power(t, R)` gives the copper loss and that in the case.
std::vector<std::pair<double, double>> integrated(const Truth& k, const std::vector<double>& times,
                                                  const std::function<std::pair<double, double>(double, double)>& power,
                                                  double start) {
  std::vector<std::pair<double, double>> result;
  double t = 0.0, over_case = 0.0, casing = start;
  const auto rates = [&](double moment, double x, double T) {
    const double R = k.R0 * (1.0 + k.a * (T + x - 25.0));
    const auto [copper, rest] = power(moment, R);
    return std::pair((k.R1 * copper - x) / k.tau_w, (k.ambient + k.R2 * (copper + rest) - T) / k.tau_c);
  };
  for (const double end : times) {
    const int steps = std::max(1, int(std::ceil((end - t) / (0.02 * k.tau_w))));
    const double h = (end - t) / steps;
    for (int n = 0; n < steps && end > t; ++n) {
      const double now = t + n * h;
      const auto [a1, b1] = rates(now, over_case, casing);
      const auto [a2, b2] = rates(now + 0.5 * h, over_case + 0.5 * h * a1, casing + 0.5 * h * b1);
      const auto [a3, b3] = rates(now + 0.5 * h, over_case + 0.5 * h * a2, casing + 0.5 * h * b2);
      const auto [a4, b4] = rates(now + h, over_case + h * a3, casing + h * b3);
      over_case += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      casing += h / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
    }
    t = end;
    result.emplace_back(casing + over_case, casing);
  }
  return result;
}

std::vector<double> times(double end, double dense = 30.0, double fine = 0.5, double coarse = 5.0) {
  std::vector<double> t;
  for (double x = fine; x <= std::min(end, dense); x += fine) t.push_back(x);
  for (double x = dense + coarse; x <= end; x += coarse) t.push_back(x);
  return t;
}

enum class Drive { current, voltage };

/// A stalled motor; the columns that `winding`, `casing` and `electrical` ask for.
HeatingCurve curve(const Truth& k, Drive drive, double held, const std::vector<double>& t, const Noise& noise,
                   std::mt19937_64& random, bool winding, bool casing, bool electrical) {
  const auto temperatures = integrated(
      k, t,
      [&](double, double R) { return std::pair(drive == Drive::current ? held * held * R : held * held / R, 0.0); },
      k.ambient);
  std::normal_distribution<double> normal;
  HeatingCurve c;
  c.time = t;
  c.ambient_temperature = k.ambient + zero_celsius;
  c.cold_resistance = k.R0;
  (drive == Drive::current ? c.held_current : c.held_voltage) = held;
  for (const auto& [T_w, T_c] : temperatures) {
    const double R = k.R0 * (1.0 + k.a * (T_w - 25.0));
    if (winding) c.winding_temperature.push_back(T_w + zero_celsius + noise.temperature * normal(random));
    if (casing) c.case_temperature.push_back(T_c + zero_celsius + noise.temperature * normal(random));
    if (electrical && drive == Drive::current) c.voltage.push_back(held * R + noise.voltage * normal(random));
    if (electrical && drive == Drive::voltage) c.current.push_back(held / R + noise.current * normal(random));
  }
  return c;
}

std::array<double, heat_constant_count> constants(const Truth& k) { return {k.R1, k.R2, k.tau_w, k.tau_c}; }

TEST(Heating, TheModelIsIntegratedAsHere) {
  const Truth k;
  std::mt19937_64 random(1);
  for (const Drive drive : {Drive::current, Drive::voltage}) {
    const HeatingCurve c =
        curve(k, drive, drive == Drive::current ? 0.35 : 2.0, times(1000.0), {}, random, true, true, false);
    const double start = k.R0 * (1.0 + k.a * (k.ambient - 25.0));
    const auto found = heating_of(c, constants(k), start);
    ASSERT_EQ(found.size(), c.time.size());
    for (std::size_t n = 0; n < found.size(); ++n) {
      EXPECT_NEAR(found[n].winding, c.winding_temperature[n], 2e-3) << c.time[n];
      EXPECT_NEAR(found[n].casing, c.case_temperature[n], 2e-3) << c.time[n];
    }
    // Where it settles: under a held current the closed form of model.md section 11.
    if (drive == Drive::voltage) continue;
    const HeatingCurve last = curve(k, drive, 0.35, {8000.0}, {}, random, true, false, false);
    const double share = 0.35 * 0.35 * start * (k.R1 + k.R2), a = k.a / (1.0 + k.a * (k.ambient - 25.0));
    HeatingCurve settled = last;
    settled.time = {1.0, 8000.0};
    EXPECT_NEAR(heating_of(settled, constants(k), start)[1].winding - c.ambient_temperature, share / (1.0 - a * share),
                1e-3 * share);
  }
}

/// Each kind of curve that a bench can give.
struct Kind {
  const char* name;
  Drive drive;
  double held;
  bool winding, casing, electrical;
};
constexpr Kind kinds[] = {{"current, both temperatures", Drive::current, 0.35, true, true, false},
                          {"current, winding", Drive::current, 0.35, true, false, false},
                          {"current, voltage and case", Drive::current, 0.35, false, true, true},
                          {"voltage, current", Drive::voltage, 2.0, false, false, true},
                          {"voltage, current and case", Drive::voltage, 2.0, false, true, true}};

// 95 % intervals hold the truth in 95 of 100 curves: of each kind 12 curves, four constants each.
TEST(Heating, TheTruthLiesInTheIntervals) {
  const Truth k;
  const Noise noise{3e-4, 2e-3, 0.3, 0.0};
  std::mt19937_64 random(7);
  constexpr int curves = 12;
  int all_held = 0, all = 0;
  for (const Kind& kind : kinds) {
    std::array<int, heat_constant_count> held{};
    double widest = 0.0;
    for (int n = 0; n < curves; ++n) {
      const HeatIdentification heat = identify_heat(
          curve(k, kind.drive, kind.held, times(1000.0), noise, random, kind.winding, kind.casing, kind.electrical));
      ASSERT_TRUE(heat.complete()) << kind.name << ": " << heat.missing.front();
      for (int c = 0; c < heat_constant_count; ++c) {
        const HeatValue& x = *heat.constants[std::size_t(c)];
        const double truth = constants(k)[std::size_t(c)];
        held[std::size_t(c)] += truth >= x.low && truth <= x.high;
        widest = std::max(widest, x.high / x.low - 1.0);
      }
    }
    for (const int count : held) {
      // The number of hits has a standard deviation of 0.8.
      EXPECT_GE(count, 9) << kind.name;
      all_held += count;
      all += curves;
    }
    EXPECT_LT(widest, 0.8) << kind.name;
  }
  RecordProperty("held", all_held);
  std::printf("%d of %d intervals hold the truth\n", all_held, all);
  EXPECT_GE(all_held, 0.92 * all);
}

TEST(Heating, OfAMotorThatRunsWithoutLoad) {
  const Truth k;
  const Noise noise{0.0, 0.0, 0.2, 0.0};
  const double v = 6.0, i = 0.09;  // much of it lost in bearings and air
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const std::vector<double> t = times(1000.0);
  const auto temperatures =
      integrated(k, t, [&](double, double R) { return std::pair(i * i * R, v * i - i * i * R); }, k.ambient);
  HeatingCurve c;
  c.motor = HeatedMotor::idling;
  c.time = t;
  c.held_current = i;
  c.held_voltage = v;
  c.ambient_temperature = k.ambient + zero_celsius;
  c.cold_resistance = k.R0;
  for (const auto& [T_w, T_c] : temperatures) {
    c.winding_temperature.push_back(T_w + zero_celsius + noise.temperature * normal(random));
    c.case_temperature.push_back(T_c + zero_celsius + noise.temperature * normal(random));
  }
  const HeatIdentification heat = identify_heat(c);
  // 0.04 W in the winding raise it by less than 1 K over a case that 0.5 W raise by 26 K.
  ASSERT_TRUE(heat[HeatConstant::resistance_case]);
  ASSERT_TRUE(heat[HeatConstant::time_constant_case]);
  EXPECT_NEAR(heat[HeatConstant::resistance_case]->value, k.R2, 0.01 * k.R2);
  EXPECT_NEAR(heat[HeatConstant::time_constant_case]->value, k.tau_c, 0.02 * k.tau_c);
  ASSERT_TRUE(heat[HeatConstant::resistance_winding]);
  EXPECT_NEAR(heat[HeatConstant::resistance_winding]->value, k.R1, 0.1 * k.R1);
  EXPECT_GT(heat[HeatConstant::resistance_winding]->high, k.R1);
  EXPECT_LT(heat[HeatConstant::resistance_winding]->low, k.R1);
}

TEST(Heating, ACurveThatIsTooShortSaysSo) {
  const Truth k;
  std::mt19937_64 random(5);
  const HeatIdentification heat =
      identify_heat(curve(k, Drive::current, 0.35, times(40.0), {3e-4, 2e-3, 0.3, 0.0}, random, true, true, false));
  ASSERT_TRUE(heat[HeatConstant::resistance_winding]);
  ASSERT_TRUE(heat[HeatConstant::time_constant_winding]);
  EXPECT_FALSE(heat[HeatConstant::resistance_case]);
  EXPECT_FALSE(heat[HeatConstant::time_constant_case]);
  ASSERT_EQ(heat.missing.size(), 2U);
  EXPECT_THAT(heat.missing[0], HasSubstr("thermal_resistance_case: the curve of 40 s is too short for the case"));
  // What such a curve does show: how fast the case begins to warm.
  ASSERT_TRUE(heat.case_heat_capacity);
  EXPECT_LT(heat.case_heat_capacity->low, k.tau_c / k.R2);
  EXPECT_GT(heat.case_heat_capacity->high, k.tau_c / k.R2);
}

TEST(Heating, RowsThatAreTooFarApartSaySo) {
  const Truth k;
  std::mt19937_64 random(6);
  const HeatIdentification heat = identify_heat(
      curve(k, Drive::current, 0.35, times(1500.0, 0.0, 1.0, 30.0), {3e-4, 2e-3, 0.3, 0.0}, random, true, true, false));
  EXPECT_FALSE(heat[HeatConstant::time_constant_winding]);
  EXPECT_TRUE(heat[HeatConstant::resistance_winding]);
  EXPECT_TRUE(heat[HeatConstant::time_constant_case]);
  ASSERT_EQ(heat.missing.size(), 1U);
  EXPECT_THAT(heat.missing[0], HasSubstr("are too far apart for the winding"));
}

TEST(Heating, TheCaseAloneShowsItsOwnConstants) {
  const Truth k;
  std::mt19937_64 random(8);
  const HeatIdentification heat =
      identify_heat(curve(k, Drive::current, 0.35, times(1000.0), {3e-4, 2e-3, 0.1, 0.0}, random, false, true, false));
  EXPECT_FALSE(heat[HeatConstant::time_constant_winding]);
  EXPECT_THAT(heat.missing.back(), HasSubstr("the case alone does not show the winding's rise"));
}

// A network of two heat capacities, in which the winding's heat reaches the case with a delay, is not the model: how
// far the fit is off where the case's capacity is 17 times the winding's.
TEST(Heating, OfTwoHeatCapacities) {
  const Truth k;
  const double i = 0.35, C_w = k.tau_w / k.R1, C_c = k.tau_c / k.R2, h = 0.01;
  HeatingCurve c;
  c.held_current = i;
  c.ambient_temperature = k.ambient + zero_celsius;
  c.cold_resistance = k.R0;
  c.time = times(1000.0);
  double t = 0.0, T_w = k.ambient, T_c = k.ambient;
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  for (const double end : c.time) {
    for (; t < end - 0.5 * h; t += h) {
      const double power = i * i * k.R0 * (1.0 + k.a * (T_w - 25.0)), through = (T_w - T_c) / k.R1;
      T_w += h * (power - through) / C_w;
      T_c += h * (through - (T_c - k.ambient) / k.R2) / C_c;
    }
    c.winding_temperature.push_back(T_w + zero_celsius + 0.3 * normal(random));
    c.case_temperature.push_back(T_c + zero_celsius + 0.3 * normal(random));
  }
  const HeatIdentification heat = identify_heat(c);
  ASSERT_TRUE(heat.complete());
  EXPECT_NEAR(heat[HeatConstant::resistance_winding]->value / k.R1, 1.0, 0.03);
  EXPECT_NEAR(heat[HeatConstant::resistance_case]->value / k.R2, 1.0, 0.03);
  EXPECT_NEAR(heat[HeatConstant::time_constant_winding]->value / k.tau_w, 1.0, 0.3);
  EXPECT_NEAR(heat[HeatConstant::time_constant_case]->value / k.tau_c, 1.0, 0.15);
}

TEST(Heating, WhatIsNoHeatingCurveIsRefused) {
  const Truth k;
  std::mt19937_64 random(10);
  const HeatingCurve good = curve(k, Drive::current, 0.35, times(100.0), {}, random, true, false, false);
  const auto said = [](const HeatingCurve& c) {
    try {
      identify_heat(c);
    } catch (const ParameterError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  HeatingCurve c = good;
  c.time.resize(5);
  c.winding_temperature.resize(5);
  EXPECT_THAT(said(c), HasSubstr("has 5 rows; a heating curve needs at least 8"));
  c = good;
  c.held_current.reset();
  EXPECT_THAT(said(c), HasSubstr("current: missing"));
  c = good;
  c.winding_temperature.clear();
  EXPECT_THAT(said(c), HasSubstr("shows no temperature"));
  c = good;
  c.cold_resistance.reset();
  EXPECT_THAT(said(c), HasSubstr("resistance: missing"));
  c = good;
  c.held_voltage = 2.0;
  EXPECT_THAT(said(c), HasSubstr("cannot be combined with the current"));
  c = good;
  c.motor = HeatedMotor::idling;
  EXPECT_THAT(said(c), HasSubstr("voltage: missing: of a motor that runs without load both are needed"));
}

}  // namespace
}  // namespace wingbeat::motor_heating_tests
