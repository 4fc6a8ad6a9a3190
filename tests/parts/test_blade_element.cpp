#include <gtest/gtest.h>

#include <cmath>

#include "parts/expect_error.hpp"
#include "wingbeat/parts/blade_element.hpp"

namespace wingbeat {
namespace {

BladeElement<double> reference() { return {1.225, 5e-3, 2.457e-6, 1.048e-7, translational_2022()}; }

double radians(double degrees) { return degrees / degrees_per_radian; }

TEST(BladeElement, CoefficientsHaveThePublishedNumbers) {
  const ForceCoefficients<double> c = translational_2022();
  struct Row {
    double degrees, lift, drag;
  };
  // Eqs (12, 13) evaluated apart.
  const Row rows[] = {{90.0, 0.101034628750005, 3.46087546700445},
                      {45.0, 1.80456143974444, 1.70374592007851},
                      {20.0, 1.14026425230143, 0.591112102445303},
                      {0.0, 0.0269734909683993, 0.392709942603704}};
  for (const Row& row : rows) {
    EXPECT_NEAR(lift_coefficient(c, radians(row.degrees)), row.lift, 1e-14);
    EXPECT_NEAR(drag_coefficient(c, radians(row.degrees)), row.drag, 1e-14);
  }
}

TEST(BladeElement, AngleOfAttackFallsWithTheStrokeSpeed) {
  const auto w = reference();
  EXPECT_DOUBLE_EQ(degrees_per_radian * angle_of_attack(w, 0.0), 90.0);
  EXPECT_NEAR(degrees_per_radian * angle_of_attack(w, 100.0), 90.0 - 0.5 * 180.0 / pi, 1e-13);
}

TEST(BladeElement, ForcesFollowTheirDefinition) {
  const auto w = reference();
  const double speed = 120.0, alpha = radians(90.0 - 0.6 * 180.0 / pi);
  const double C_L = 0.225 + 1.58 * std::sin(2.13 * alpha - radians(7.2));
  const double C_D = 1.92 - 1.55 * std::cos(2.04 * alpha - radians(9.82));
  EXPECT_NEAR(lift_force(w, speed), 0.5 * 1.225 * C_L * speed * speed * 2.457e-6, 1e-16);
  EXPECT_NEAR(drag_moment(w, speed), 0.5 * 1.225 * C_D * speed * speed * 1.048e-7, 1e-18);
}

TEST(BladeElement, DragMomentNeverDrives) {
  const auto w = reference();
  for (double speed = 0.0; speed < 500.0; speed += 5.0) EXPECT_GE(drag_moment(w, speed), 0.0);
}

TEST(BladeElement, NoForceWithoutMotionOrAir) {
  auto w = reference();
  EXPECT_EQ(lift_force(w, 0.0), 0.0);
  EXPECT_EQ(drag_moment(w, 0.0), 0.0);
  w.air_density = 0.0;
  EXPECT_EQ(lift_force(w, 120.0), 0.0);
  EXPECT_EQ(drag_moment(w, 120.0), 0.0);
}

TEST(BladeElement, SlowStrokeMeetsTheBroadsideWing) {
  const auto w = reference();
  const double speed = 1e-6;
  EXPECT_NEAR(drag_moment(w, speed) / (0.5 * 1.225 * speed * speed * 1.048e-7), 3.46087546700445, 1e-7);
}

ForceCoefficients<double> tabulated(std::vector<double> alpha, std::vector<double> lift, std::vector<double> drag) {
  ForceCoefficients<double> c = translational_2022();
  c.table = std::make_shared<CoefficientTable>(std::move(alpha), std::move(lift), std::move(drag));
  return c;
}

TEST(CoefficientTable, GoesThroughItsPointsAndHoldsItsEnds) {
  const std::vector<double> alpha = {0.1, 0.3, 0.4, 0.9, 1.5}, lift = {0.0, 0.7, 0.6, 1.8, -0.2},
                            drag = {0.4, 0.3, 0.9, 2.0, 3.4};
  const auto c = tabulated(alpha, lift, drag);
  for (std::size_t n = 0; n < alpha.size(); ++n) {
    EXPECT_NEAR(lift_coefficient(c, alpha[n]), lift[n], 1e-15);
    EXPECT_NEAR(drag_coefficient(c, alpha[n]), drag[n], 1e-15);
  }
  EXPECT_EQ(lift_coefficient(c, -3.0), 0.0);
  EXPECT_EQ(drag_coefficient(c, 0.0999), 0.4);
  EXPECT_EQ(lift_coefficient(c, 1.5001), -0.2);
  EXPECT_EQ(drag_coefficient(c, 40.0), 3.4);
}

TEST(CoefficientTable, IsTwiceContinuouslyDifferentiableAndNatural) {
  const CoefficientTable table({0.1, 0.3, 0.4, 0.9, 1.5}, {0.0, 0.7, 0.6, 1.8, -0.2}, {0.4, 0.3, 0.9, 2.0, 3.4});
  const auto value = [](const CoefficientTable::Cubic& p, double x) {
    return detail::evaluate_table<double>([&](double) { return p; }, x);
  };
  const auto slope = [](const CoefficientTable::Cubic& p, double x) {
    const double t = x - p.x0;
    return p.b + t * (2.0 * p.c + t * 3.0 * p.d);
  };
  const auto bend = [](const CoefficientTable::Cubic& p, double x) { return 2.0 * p.c + 6.0 * p.d * (x - p.x0); };
  for (const double x : {0.3, 0.4, 0.9}) {
    const auto before = table.lift_piece(x - 1e-9), after = table.lift_piece(x);
    EXPECT_NEAR(value(before, x), value(after, x), 1e-14);
    EXPECT_NEAR(slope(before, x), slope(after, x), 1e-12);
    EXPECT_NEAR(bend(before, x), bend(after, x), 1e-11);
  }
  EXPECT_NEAR(bend(table.lift_piece(0.1), 0.1), 0.0, 1e-13);
  EXPECT_NEAR(bend(table.drag_piece(1.4999), 1.5), 0.0, 1e-11);
}

TEST(CoefficientTable, StraightLineIsReproduced) {
  const auto c = tabulated({0.0, 0.2, 0.7, 1.0}, {1.0, 1.4, 2.4, 3.0}, {3.0, 2.6, 1.6, 1.0});
  for (double x = 0.0; x < 1.0; x += 0.03) {
    EXPECT_NEAR(lift_coefficient(c, x), 1.0 + 2.0 * x, 1e-14);
    EXPECT_NEAR(drag_coefficient(c, x), 3.0 - 2.0 * x, 1e-14);
  }
}

TEST(CoefficientTable, SplineConvergesAtOrderFour) {
  const auto wave = translational_2022();
  double before = 0.0;
  for (const int rows : {20, 40, 80, 160}) {
    std::vector<double> alpha, lift, drag;
    for (int n = 0; n <= rows; ++n) {
      alpha.push_back(pi * n / rows);
      lift.push_back(lift_coefficient(wave, alpha.back()));
      drag.push_back(drag_coefficient(wave, alpha.back()));
    }
    const auto c = tabulated(alpha, lift, drag);
    double error = 0.0;
    // Away from the ends, where the natural condition costs two orders.
    for (double x = 1.2; x < 1.9; x += 0.0013) {
      error = std::max({error, std::abs(lift_coefficient(c, x) - lift_coefficient(wave, x)),
                        std::abs(drag_coefficient(c, x) - drag_coefficient(wave, x))});
    }
    if (rows > 40) {
      EXPECT_NEAR(std::log2(before / error), 4.0, 0.4) << rows;
    }
    before = error;
  }
}

TEST(CoefficientTable, ReplacesTheWavesInTheForces) {
  auto w = reference();
  w.coefficients = tabulated({0.0, 1.0, 2.0}, {1.5, 1.5, 1.5}, {2.5, 2.5, 2.5});
  EXPECT_NEAR(lift_force(w, 50.0), 0.5 * 1.225 * 1.5 * 2500.0 * 2.457e-6, 1e-16);
  EXPECT_NEAR(drag_moment(w, 50.0), 0.5 * 1.225 * 2.5 * 2500.0 * 1.048e-7, 1e-17);
}

TEST(CoefficientTable, RefusesTablesThatAreNoFunction) {
  const auto refused = [](std::vector<double> alpha, std::vector<double> lift, std::vector<double> drag) {
    return error_of([&] { CoefficientTable(alpha, lift, drag); });
  };
  EXPECT_EQ(refused({0.0, 1.0, 2.0}, {0.0, 1.0, 2.0}, {0.0, 1.0, 2.0}), "no error");
  EXPECT_EQ(refused({0.0, 1.0}, {0.0, 1.0}, {0.0, 1.0}),
            "aerodynamics.coefficients: the coefficient table needs at least three rows");
  const std::string incomplete =
      "aerodynamics.coefficients: every row of the coefficient table needs an angle, a lift and a drag coefficient";
  EXPECT_EQ(refused({0.0, 1.0, 2.0}, {0.0, 1.0}, {0.0, 1.0, 2.0}), incomplete);
  EXPECT_EQ(refused({0.0, 1.0, 2.0}, {0.0, 1.0, 2.0}, {0.0, 1.0, 2.0, 3.0}), incomplete);
  EXPECT_EQ(refused({0.0, 1.0, 1.0}, {0.0, 1.0, 2.0}, {0.0, 1.0, 2.0}),
            "aerodynamics.coefficients: row 3 of the coefficient table must have a larger angle of attack than the row "
            "before it");
  EXPECT_EQ(refused({0.0, 1.0, 2.0}, {0.0, std::nan(""), 2.0}, {0.0, 1.0, 2.0}),
            "aerodynamics.coefficients: row 2 of the coefficient table must hold three finite numbers");
}

TEST(BladeElement, RefusesValuesOutOfRange) {
  using W = BladeElement<double>;
  EXPECT_NO_THROW(validate(reference()));
  EXPECT_EQ(refusal(reference(), [](W& w) { w.air_density = -1.0; }),
            "aerodynamics.air_density: must be >= 0 [kg/m3], got -1");
  EXPECT_EQ(refusal(reference(), [](W& w) { w.pitch_coefficient = -5e-3; }),
            "aerodynamics.pitch_coefficient: must be >= 0 [s], got -0.005");
  EXPECT_EQ(refusal(reference(), [](W& w) { w.s2 = -1.0; }), "wing.planform.s2: must be >= 0 [m4], got -1");
  EXPECT_EQ(refusal(reference(), [](W& w) { w.s3 = -1.0; }), "wing.planform.s3: must be >= 0 [m5], got -1");
}

}  // namespace
}  // namespace wingbeat
