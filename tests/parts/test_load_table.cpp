// Tables of loads: values and slopes of the grid, the cubics between, what is mirrored, what is refused.
#include "wingbeat/parts/load_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/blade_element.hpp"

namespace wingbeat {
namespace {

using Row = LoadTable::Row;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::vector<double> even(double from, double to, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(from + (to - from) * k / (count - 1));
  return values;
}

/// Loads over all four coordinates; 0 at rest.
double smooth(double beta, double velocity, double psi, double psi_velocity) {
  return velocity * std::abs(velocity) * std::cos(psi) * (1.0 + 0.2 * beta) + 3.0 * psi_velocity * std::sin(psi + 0.3);
}

LoadTable smooth_table(int count) {
  std::vector<Row> rows;
  for (const double beta : even(-1.0, 1.0, count)) {
    for (const double velocity : even(-20.0, 20.0, count)) {
      for (const double psi : even(-1.0, 1.0, count)) {
        for (const double psi_velocity : even(-30.0, 30.0, count)) {
          const double load = smooth(beta, velocity, psi, psi_velocity);
          rows.push_back({beta, velocity, psi, psi_velocity, std::abs(velocity) * load, load, 0.5 * load});
        }
      }
    }
  }
  std::shuffle(rows.begin(), rows.end(), std::mt19937(7));
  return LoadTable(rows);
}

TabulatedLoads<double> use(LoadTable table) { return {std::make_shared<LoadTable>(std::move(table)), 1.0}; }

TEST(LoadTable, HasTheRowsAtItsNodes) {
  const LoadTable table = smooth_table(5);
  const TabulatedLoads<double> loads = use(table);
  ASSERT_EQ(table.axes().size(), 4u);
  for (const Row& row : table.rows()) {
    const TableLoads<double> found = table_loads<double>(loads, {row[0], row[1], row[2], row[3]});
    EXPECT_NEAR(found.lift, row[4], 1e-9);
    EXPECT_NEAR(found.stroke_moment, row[5], 1e-10);
    EXPECT_NEAR(found.pitch_moment, row[6], 1e-10);
  }
}

TEST(LoadTable, ConvergesToTheFunctionItWasMadeOf) {
  const auto largest_error = [](int count) {
    const TabulatedLoads<double> loads = use(smooth_table(count));
    std::mt19937_64 random(20263);
    std::uniform_real_distribution<double> unit(-0.99, 0.99);
    double error = 0.0;
    for (int n = 0; n < 500; ++n) {
      const WingPlace<double> p = {unit(random), 20.0 * unit(random), unit(random), 30.0 * unit(random)};
      error = std::max(error, std::abs(table_loads(loads, p).stroke_moment - smooth(p[0], p[1], p[2], p[3])));
    }
    return error;
  };
  const double coarse = largest_error(5), fine = largest_error(9), finest = largest_error(17);
  EXPECT_LT(finest, 0.01 * 400.0);
  EXPECT_LT(fine, 0.5 * coarse);
  EXPECT_LT(finest, 0.5 * fine);
}

TEST(LoadTable, IsExactForParabolasInTheSpeed) {
  // Loads that grow with the square of the speed: a parabola has the slopes that its points give.
  std::vector<Row> rows;
  for (const double velocity : even(0.0, 40.0, 9)) {
    rows.push_back({none, velocity, none, none, 2e-4 * velocity * velocity, 3e-5 * velocity * velocity, none});
  }
  const TabulatedLoads<double> loads = use(LoadTable(rows));
  ASSERT_EQ(loads.table->axes().size(), 1u);
  EXPECT_FALSE(loads.table->has_pitch_moment());
  for (double v = 5.0; v < 35.0; v += 0.37) {
    for (const double side : {1.0, -1.0}) {
      const TableLoads<double> found = table_loads<double>(loads, {0.3, side * v, 0.1, 9.0});
      EXPECT_NEAR(found.lift, 2e-4 * v * v, 1e-13);
      EXPECT_NEAR(found.stroke_moment, side * 3e-5 * v * v, 1e-14);
    }
  }
  EXPECT_EQ(table_loads<double>(loads, {0.0, 0.0, 0.0, 0.0}).stroke_moment, 0.0);
}

TEST(LoadTable, IsMonotoneWhereTheRowsAre) {
  // A step that an interpolating spline would overshoot.
  std::vector<Row> rows;
  const double values[] = {0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.3};
  for (int k = 0; k < 7; ++k) rows.push_back({none, double(k), none, none, values[k], values[k], none});
  const TabulatedLoads<double> loads = use(LoadTable(rows));
  double before = 0.0;
  for (double v = 0.0; v <= 6.0; v += 0.01) {
    const double lift = table_loads<double>(loads, {0.0, v, 0.0, 0.0}).lift;
    EXPECT_GE(lift, before - 1e-14) << v;
    EXPECT_LE(lift, 1.3 + 1e-14) << v;
    before = lift;
  }
}

TEST(LoadTable, SlopesAreContinuousAndGoOnBeyondTheGrid) {
  const TabulatedLoads<double> loads = use(smooth_table(5));
  const TabulatedLoads<Jet<4>> along{loads.table, Jet<4>(1.0)};
  std::mt19937_64 random(20264);
  std::uniform_real_distribution<double> unit(-1.3, 1.3);
  constexpr std::array<double, 4> size = {1.0, 20.0, 1.0, 30.0};
  for (int n = 0; n < 200; ++n) {
    WingPlace<double> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = size[k] * unit(random);
    // Every fourth at a knot, from below and above.
    if (n % 4 == 0) p[std::size_t(n / 4 % 4)] = 0.5 * size[std::size_t(n / 4 % 4)];
    WingPlace<Jet<4>> j;
    for (std::size_t k = 0; k < 4; ++k) j[k] = Jet<4>(p[k], int(k));
    const TableLoads<Jet<4>> found = table_loads(along, j);
    for (std::size_t k = 0; k < 4; ++k) {
      const double h = 1e-5 * size[k];
      for (const double side : {1.0, -1.0}) {
        WingPlace<double> q = p, r = p;
        q[k] += side * h, r[k] += 2.0 * side * h;
        const double slope = side *
                             (-3.0 * table_loads(loads, p).stroke_moment + 4.0 * table_loads(loads, q).stroke_moment -
                              table_loads(loads, r).stroke_moment) /
                             (2.0 * h);
        EXPECT_NEAR(found.stroke_moment.v[k], slope, 1e-4 * 400.0 / size[k]) << n << " " << k;
      }
    }
  }
}

TEST(LoadTable, HalfStrokesAreMirrorImages) {
  std::vector<Row> rows;
  for (const double velocity : {0.0, 10.0, 20.0}) {
    for (const double psi : {-1.0, -0.4, 0.4, 1.0}) {
      const double at_rest = velocity == 0.0 ? 0.0 : 1.0;
      rows.push_back({none, velocity, psi, none, -velocity * psi, velocity * (2.0 - psi) * at_rest, velocity * psi});
    }
  }
  const LoadTable table(rows);
  const TabulatedLoads<double> loads = use(table);
  for (const double v : {3.0, 10.0, 17.0}) {
    for (const double psi : {-0.9, -0.1, 0.4}) {
      const TableLoads<double> there = table_loads<double>(loads, {0.0, v, psi, 0.0});
      const TableLoads<double> back = table_loads<double>(loads, {0.0, -v, -psi, 0.0});
      EXPECT_NEAR(there.lift, back.lift, 1e-12);
      EXPECT_NEAR(there.stroke_moment, -back.stroke_moment, 1e-12);
      EXPECT_NEAR(there.pitch_moment, -back.pitch_moment, 1e-12);
    }
  }
  // Written whole, it is the same table.
  const TabulatedLoads<double> again = use(LoadTable(table.rows()));
  const WingPlace<double> place = {0.0, -7.0, 0.3, 0.0};
  EXPECT_EQ(table_loads(loads, place).stroke_moment, table_loads(again, place).stroke_moment);
}

TEST(LoadTable, ComesInPlaceOfTheCoefficients) {
  std::vector<Row> rows;
  for (const double beta : {-1.0, 0.0, 1.0}) {
    for (const double v : {-30.0, -10.0, 0.0, 10.0, 30.0}) {
      rows.push_back({beta, v, none, none, (2.0 + beta) * v * v, (3.0 + beta) * v * std::abs(v), none});
    }
  }
  BladeElement<double> wings{1.2, 5e-3, 1e-7, 2e-9, translational_2022()};
  wings.tabulated = use(LoadTable(rows));
  wings.tabulated.factor = 0.5;
  const AeroLoads<double> loads = aero_loads(wings, -10.0, -1.0, 1.0, 1.0, 1.0);
  EXPECT_NEAR(loads.lift, 0.5 * 3.0 * 100.0, 1e-10);
  EXPECT_NEAR(loads.moment, -0.5 * 4.0 * 100.0, 1e-10);
  EXPECT_NEAR(loads.power, 0.5 * 4.0 * 1000.0, 1e-9);
}

std::string refusal(const std::vector<Row>& rows) {
  try {
    const LoadTable table(rows);
  } catch (const ParameterError& error) {
    return error.reason();
  }
  return "accepted";
}

TEST(LoadTable, IsRefusedWithTheReason) {
  const auto expect = [](const std::vector<Row>& rows, const std::string& part) {
    const std::string reason = refusal(rows);
    EXPECT_NE(reason.find(part), std::string::npos) << reason << "\nexpected: " << part;
  };
  const Row rest = {none, 0.0, none, none, 0.0, 0.0, none}, fast = {none, 9.0, none, none, 1.0, 1.0, none};
  EXPECT_EQ(refusal({rest, fast}), "accepted");
  expect({}, "has no rows");
  expect({rest}, "more than one flapping_velocity");
  expect({rest, fast, fast}, "row 3 of the load table gives flapping_velocity = 9 rad/s again");
  expect({fast, {none, 5.0, none, none, 1.0, 1.0, none}}, "rows at a flapping_velocity of 0");
  Row wrong = fast;
  wrong[4] = std::numeric_limits<double>::infinity();
  expect({rest, wrong}, "row 2 of the load table must hold a finite lift");
  wrong[4] = none;
  expect({rest, wrong}, "row 2 of the load table must hold a finite lift");
  Row lifting = rest;
  lifting[4] = 0.1;
  expect({lifting, fast}, "a lift of 0.1 N for wings at rest, at flapping_velocity = 0 rad/s");
  // Places and what is missing of a grid.
  const auto row = [](double beta, double v, double psi) { return Row{beta, v, psi, none, v * v, v, v}; };
  expect({row(0.0, 0.0, none), row(1.0, 0.0, none), row(0.0, 5.0, none), row(1.0, 5.0, none)}, "both half-strokes");
  expect({row(none, 0.0, -1.0), row(none, 0.0, 1.0), row(none, 5.0, 1.0)},
         "no row at flapping_velocity = -5 rad/s, pitch_angle = 1 rad");
  expect({row(none, 0.0, 0.5), row(none, 0.0, 1.0), row(none, 5.0, 0.5), row(none, 5.0, 1.0)},
         "pitch_angle must then be the same to either side of 0, got 0.5 to 1 rad");
}

}  // namespace
}  // namespace wingbeat
