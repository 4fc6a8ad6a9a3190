// Battery: interpolation of the discharge curve, and what is refused.
#include "wingbeat/parts/battery.hpp"

#include <gtest/gtest.h>

#include "expect_error.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/members.hpp"

namespace wingbeat {
namespace {

Battery<double> lithium() {
  Battery<double> b;
  b.discharge_curve = {{0.0, 3.0}, {0.1, 3.6}, {0.35, 3.7}, {0.8, 3.7}, {1.0, 4.2}};
  b.internal_resistance = 1.5;
  b.capacity = 180.0;
  return b;
}

TEST(Battery, CurvePassesThroughItsRowsAndStaysMonotoneBetween) {
  const Battery<double> b = lithium();
  for (const auto& [charge, voltage] : b.discharge_curve) {
    EXPECT_DOUBLE_EQ(open_circuit_voltage(b, charge), voltage);
  }
  double before = 0.0;
  for (int n = 0; n <= 10000; ++n) {
    const double voltage = open_circuit_voltage(b, n / 10000.0);
    EXPECT_GE(voltage, before - 1e-14) << n;
    before = voltage;
  }
  EXPECT_DOUBLE_EQ(open_circuit_voltage(b, 0.5), 3.7);  // between equal rows there is no bulge
}

TEST(Battery, StraightCurveIsReproducedExactly) {
  Battery<double> b = lithium();
  b.discharge_curve = {{0.0, 3.0}, {0.2, 3.2}, {0.7, 3.7}, {1.0, 4.0}};
  for (int n = 0; n <= 100; ++n) EXPECT_NEAR(open_circuit_voltage(b, n / 100.0), 3.0 + n / 100.0, 1e-14);
}

// Fritsch and Butland's slopes of x^3 at 0, 1, 2, 4 by hand: secants 1, 7, 28; inside (w0 + w1)/(w0/s0 + w1/s1).
TEST(Battery, SlopesMatchHandCalculation) {
  const std::vector<std::pair<double, double>> cube = {{0.0, 0.0}, {1.0, 1.0}, {2.0, 8.0}, {4.0, 64.0}};
  EXPECT_DOUBLE_EQ(detail::monotone_slope(cube, 0), 0.0);  // (3*1 - 7)/2 = -2 has the wrong sign
  EXPECT_DOUBLE_EQ(detail::monotone_slope(cube, 1), 6.0 / (3.0 / 1.0 + 3.0 / 7.0));
  EXPECT_DOUBLE_EQ(detail::monotone_slope(cube, 2), 9.0 / (5.0 / 7.0 + 4.0 / 28.0));
  EXPECT_DOUBLE_EQ(detail::monotone_slope(cube, 3), (5.0 * 28.0 - 2.0 * 7.0) / 3.0);
}

// The integral of each cubic in closed form, against Simpson's rule on it, which is exact for cubics.
TEST(Battery, MeanVoltageIsTheIntegralOverTheCharge) {
  Battery<double> b = lithium();
  b.cells = 2.0;
  double sum = 0.0;
  for (std::size_t k = 1; k < b.discharge_curve.size(); ++k) {
    const double low = b.discharge_curve[k - 1].first, high = b.discharge_curve[k].first;
    sum += (high - low) / 6.0 *
           (open_circuit_voltage(b, low) + 4.0 * open_circuit_voltage(b, 0.5 * (low + high)) +
            open_circuit_voltage(b, high));
  }
  EXPECT_NEAR(mean_open_circuit_voltage(b), sum, 1e-13);
  Battery<double> constant;
  constant.cells = 3.0;
  constant.cell_voltage = 3.7;
  EXPECT_DOUBLE_EQ(mean_open_circuit_voltage(constant), 11.1);
}

TEST(Battery, WeighsByItsCapacity) {
  Battery<double> b = lithium();
  EXPECT_FALSE(battery_mass(b));
  b.specific_energy = 160.0 * 3600.0;
  EXPECT_DOUBLE_EQ(*battery_mass(b), 180.0 * mean_open_circuit_voltage(b) / (160.0 * 3600.0));
  EXPECT_NEAR(*battery_mass(b), 1.15e-3, 0.05e-3);  // 50 mA h at 160 W h/kg
  Battery<Jet<1>> dual = cast<Jet<1>>(b);
  dual.capacity = Jet<1>(180.0, 0);
  EXPECT_DOUBLE_EQ(battery_mass(dual)->v[0], *battery_mass(b) / 180.0);
  EXPECT_EQ(refusal(b, [](auto& x) { x.specific_energy = 0.0; }), "supply.specific_energy: must be > 0 [J/kg], got 0");
}

TEST(Battery, DerivativeByChargeIsExactAndContinuous) {
  const Battery<double> b = lithium();
  const auto dual = cast<Jet<1>>(b);
  for (const double charge : {0.03, 0.2, 0.6, 0.9}) {
    constexpr double h = 1e-5;
    const double difference = (open_circuit_voltage(b, charge + h) - open_circuit_voltage(b, charge - h)) / (2.0 * h);
    EXPECT_NEAR(open_circuit_voltage(dual, Jet<1>(charge, 0)).v[0], difference, 1e-7 * (1.0 + std::abs(difference)));
  }
  for (const double row : {0.1, 0.35, 0.8}) {
    const double left = open_circuit_voltage(dual, Jet<1>(row - 1e-12, 0)).v[0];
    EXPECT_NEAR(open_circuit_voltage(dual, Jet<1>(row, 0)).v[0], left, 1e-8);
  }
}

TEST(Battery, CellsAddVoltageAndResistance) {
  Battery<double> b = lithium();
  b.cells = 3.0;
  EXPECT_DOUBLE_EQ(open_circuit_voltage(b, 1.0), 12.6);
  EXPECT_DOUBLE_EQ(source_resistance(b), 4.5);
  b.discharge_curve.clear();
  b.cell_voltage = 3.7;
  EXPECT_DOUBLE_EQ(open_circuit_voltage(b, 0.0), 3.0 * 3.7);
  EXPECT_DOUBLE_EQ(open_circuit_voltage(b, 1.0), 3.0 * 3.7);
}

TEST(Battery, EveryParameterIsCheckedByName) {
  using B = Battery<double>;
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.cells = 1.5; }), "supply.cells: must be a whole number >= 1 [1], got 1.5");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.cells = 0.0; }), "supply.cells: must be a whole number >= 1 [1], got 0");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.discharge_curve.clear(); }), "supply.cell_voltage: must be > 0 [V], got 0");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.internal_resistance = -1.0; }),
            "supply.internal_resistance: must be >= 0 [ohm], got -1");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.capacity = 0.0; }), "supply.capacity: must be > 0 [C], got 0");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.charge = 1.1; }), "supply.charge: must lie between 0 and 1 [1], got 1.1");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.charge = -0.1; }), "supply.charge: must lie between 0 and 1 [1], got -0.1");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.cutoff_voltage = -3.0; }),
            "supply.cutoff_voltage: must be >= 0 [V], got -3");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.discharge_curve.resize(1); }),
            "supply.discharge_curve: needs at least two rows; give cell_voltage for a constant voltage");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.discharge_curve[1].first = 0.9; }),
            "supply.discharge_curve: row 3 of the discharge curve must have a larger state of charge than the row "
            "before it");
  EXPECT_EQ(
      refusal(lithium(), [](B& b) { b.discharge_curve[4].second = 3.6; }),
      "supply.discharge_curve: row 5 of the discharge curve must not have a lower voltage than the row before it");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.discharge_curve[0].second = 0.0; }),
            "supply.discharge_curve: row 1 of the discharge curve must hold a state of charge and a voltage > 0 V");
  EXPECT_EQ(refusal(lithium(), [](B& b) { b.discharge_curve[0].first = 0.05; }),
            "supply.discharge_curve: the states of charge must run from 0 to 1");
}

}  // namespace
}  // namespace wingbeat
