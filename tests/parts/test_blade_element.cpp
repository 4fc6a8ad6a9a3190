#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "parts/expect_error.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/parts/blade_element.hpp"

namespace wingbeat {
namespace {

BladeElement<double> reference_wings() { return {1.225, 5e-3, 2.457e-6, 1.048e-7, translational_2022()}; }

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
  const auto w = reference_wings();
  EXPECT_DOUBLE_EQ(degrees_per_radian * aero_loads(w, 0.0).angle_of_attack, 90.0);
  EXPECT_NEAR(degrees_per_radian * aero_loads(w, 100.0).angle_of_attack, 90.0 - 0.5 * 180.0 / pi, 1e-13);
}

TEST(BladeElement, ForcesFollowTheirDefinition) {
  const auto w = reference_wings();
  const double speed = 120.0, alpha = radians(90.0 - 0.6 * 180.0 / pi);
  const double C_L = 0.225 + 1.58 * std::sin(2.13 * alpha - radians(7.2));
  const double C_D = 1.92 - 1.55 * std::cos(2.04 * alpha - radians(9.82));
  EXPECT_NEAR(aero_loads(w, speed).lift, 0.5 * 1.225 * C_L * speed * speed * 2.457e-6, 1e-16);
  EXPECT_NEAR(aero_loads(w, speed).moment, 0.5 * 1.225 * C_D * speed * speed * 1.048e-7, 1e-18);
}

TEST(BladeElement, DragMomentNeverDrives) {
  const auto w = reference_wings();
  for (double speed = 0.0; speed < 500.0; speed += 5.0) EXPECT_GE(aero_loads(w, speed).moment, 0.0);
}

TEST(BladeElement, NoForceWithoutMotionOrAir) {
  auto w = reference_wings();
  EXPECT_EQ(aero_loads(w, 0.0).lift, 0.0);
  EXPECT_EQ(aero_loads(w, 0.0).moment, 0.0);
  w.air_density = 0.0;
  EXPECT_EQ(aero_loads(w, 120.0).lift, 0.0);
  EXPECT_EQ(aero_loads(w, 120.0).moment, 0.0);
}

TEST(BladeElement, SlowStrokeMeetsTheBroadsideWing) {
  const auto w = reference_wings();
  const double speed = 1e-6;
  EXPECT_NEAR(aero_loads(w, speed).moment / (0.5 * 1.225 * speed * speed * 1.048e-7), 3.46087546700445, 1e-7);
}

BladeElement<double> with_pitch_stop() {
  auto w = reference_wings();
  w.angle_of_attack_min = radians(40.0);
  return w;
}

TEST(AeroLoads, PowerIsMomentTimesVelocityAndNeverDrives) {
  for (const auto& w : {reference_wings(), with_pitch_stop()}) {
    for (double velocity = -400.0; velocity <= 400.0; velocity += 12.5) {
      const double stroke = sign_of(velocity);
      const auto loads = aero_loads(w, velocity, stroke, sign_of(pitch_margin(w, std::abs(velocity))));
      EXPECT_EQ(loads.power, loads.moment * velocity);
      EXPECT_GE(loads.power, 0.0);
    }
  }
}

TEST(AeroLoads, BothStrokesAreEachOthersMirrorImage) {
  const auto w = reference_wings();
  for (double speed = 0.0; speed < 400.0; speed += 12.5) {
    const auto forth = aero_loads(w, speed, 1.0, 1.0), back = aero_loads(w, -speed, -1.0, 1.0);
    EXPECT_EQ(forth.angle_of_attack, back.angle_of_attack);
    EXPECT_EQ(forth.lift, back.lift);
    EXPECT_EQ(forth.moment, -back.moment);
    EXPECT_EQ(forth.power, back.power);
  }
}

TEST(AeroLoads, BranchesOfThePitchingMeetAtTheStop) {
  const auto w = with_pitch_stop();
  const double at_stop = stroke_speed_at(w, w.angle_of_attack_min);
  EXPECT_NEAR(at_stop, radians(50.0) / 5e-3, 1e-12);
  const auto free = aero_loads(w, at_stop, 1.0, 1.0), stopped = aero_loads(w, at_stop, 1.0, -1.0);
  EXPECT_NEAR(free.pitch_margin, 0.0, 1e-15);
  EXPECT_EQ(stopped.angle_of_attack, w.angle_of_attack_min);
  EXPECT_NEAR(free.angle_of_attack, stopped.angle_of_attack, 1e-15);
  EXPECT_NEAR(free.lift, stopped.lift, 1e-14 * free.lift);
  EXPECT_NEAR(free.moment, stopped.moment, 1e-14 * free.moment);
  // Whichever branch is asked for, the margin says which one holds.
  for (const double speed : {0.5 * at_stop, 1.5 * at_stop}) {
    const auto loads = aero_loads(w, speed);
    EXPECT_EQ(loads.pitch_margin > 0.0, speed < at_stop);
    EXPECT_EQ(loads.pitch_margin, aero_loads(w, speed, 1.0, -1.0).pitch_margin);
    EXPECT_EQ(loads.angle_of_attack, std::max(pi / 2.0 - 5e-3 * speed, w.angle_of_attack_min));
  }
  EXPECT_EQ(aero_loads(reference_wings(), 300.0).pitch_margin, 1.0);
}

TEST(AeroLoads, DualNumbersAgreeWithDifferences) {
  using J = Jet<1>;
  for (const auto& w : {reference_wings(), with_pitch_stop()}) {
    for (const double pitching : {1.0, -1.0}) {
      for (const double velocity : {-310.0, -90.0, -1.0, 1.0, 90.0, 310.0}) {
        const double stroke = sign_of(velocity), h = 1e-3 * std::abs(velocity);
        const auto loads_at = [&](double x) { return aero_loads(w, x, stroke, pitching); };
        const auto dual = aero_loads(cast<J>(w), J(velocity, 0), J(stroke), J(pitching));
        const auto p1 = loads_at(velocity + h), m1 = loads_at(velocity - h), p2 = loads_at(velocity + 2.0 * h);
        const auto m2 = loads_at(velocity - 2.0 * h), here = loads_at(velocity);
        for (double AeroLoads<double>::* load :
             {&AeroLoads<double>::angle_of_attack, &AeroLoads<double>::lift, &AeroLoads<double>::moment,
              &AeroLoads<double>::power, &AeroLoads<double>::pitch_margin}) {
          if (!(pitching > 0.0) && !has_pitch_stop(w)) continue;  // no such branch
          J AeroLoads<J>::* of_jets = load == &AeroLoads<double>::angle_of_attack ? &AeroLoads<J>::angle_of_attack
                                      : load == &AeroLoads<double>::lift          ? &AeroLoads<J>::lift
                                      : load == &AeroLoads<double>::moment        ? &AeroLoads<J>::moment
                                      : load == &AeroLoads<double>::power         ? &AeroLoads<J>::power
                                                                                  : &AeroLoads<J>::pitch_margin;
          EXPECT_EQ((dual.*of_jets).a, here.*load);
          const double difference = (8.0 * (p1.*load - m1.*load) - (p2.*load - m2.*load)) / (12.0 * h);
          EXPECT_NEAR((dual.*of_jets).v[0], difference,
                      1e-8 * (std::abs((dual.*of_jets).v[0]) + std::abs(here.*load / velocity)));
        }
      }
    }
  }
}

TEST(AeroLoads, HaveDerivativesAtTheReversal) {
  using J = Jet<1>;
  const auto w = cast<J>(reference_wings());
  for (const double stroke : {1.0, -1.0}) {
    const auto loads = aero_loads(w, J(0.0, 0), J(stroke), J(1.0));
    // Forces grow with the square of the speed; the angle falls at the rate C_alpha on either side.
    EXPECT_EQ(loads.lift.v[0], 0.0);
    EXPECT_EQ(loads.moment.v[0], 0.0);
    EXPECT_EQ(loads.power.v[0], 0.0);
    EXPECT_EQ(loads.angle_of_attack.v[0], -stroke * 5e-3);
  }
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

TEST(CoefficientTable, FindsThePieceThatHolds) {
  std::mt19937_64 random(5);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  for (int n = 0; n < 50; ++n) {
    // Rows from evenly spaced to one upon the other.
    std::vector<double> alpha = {uniform(-1.0, 1.0)};
    const double unevenness = uniform(0.0, 12.0);
    for (int row = 0; row < 3 + n; ++row) alpha.push_back(alpha.back() + std::exp(-unevenness * uniform(0.0, 1.0)));
    const std::vector<double> zero(alpha.size(), 0.0);
    const CoefficientTable table(alpha, zero, zero);
    std::vector<double> angles = alpha;
    for (const double x : alpha) angles.insert(angles.end(), {std::nextafter(x, -10.0), std::nextafter(x, 1e3)});
    for (int k = 0; k < 200; ++k) angles.push_back(uniform(alpha.front() - 0.1, alpha.back() + 0.1));
    angles.insert(angles.end(), {-1e300, 1e300, -INFINITY, INFINITY});
    for (const double x : angles) {
      const auto after = std::upper_bound(alpha.begin(), alpha.end(), x);
      ASSERT_EQ(table.lookup().knots_up_to(x), after - alpha.begin()) << x;
    }
  }
}

TEST(CoefficientTable, HasTheSamePiecesByEqualSteps) {
  const std::vector<double> alpha = {0.1, 0.2, 0.5, 0.6, 0.9}, lift = {0.3, 0.1, 0.9, 1.2, 0.8},
                            drag = {0.5, 0.9, 1.1, 2.1, 2.0};
  const CoefficientTable table(alpha, lift, drag);
  const CoefficientLookup found = table.lookup();
  ASSERT_EQ(found.steps, 8);
  for (double x = 0.1; x < 0.9; x += 0.013) {
    const double place = (x - found.front) * found.steps_per_angle, t = place - std::floor(place);
    const CoefficientLookup::Step& step = found.step[int(place)];
    for (const auto& [c, piece] :
         {std::pair{step.lift, table.lift_piece(x)}, std::pair{step.drag, table.drag_piece(x)}}) {
      const double d = x - piece.x0;
      EXPECT_NEAR(c[0] + t * (c[1] + t * (c[2] + t * c[3])), piece.a + d * (piece.b + d * (piece.c + d * piece.d)),
                  1e-14)
          << x;
    }
  }
  const CoefficientTable uneven({0.1, 0.2, 0.5 + 1e-4 * pi, 0.9}, {0.3, 0.1, 0.9, 1.2}, {0.5, 0.9, 1.1, 2.1});
  EXPECT_EQ(uneven.lookup().steps, 0);
  EXPECT_EQ(uneven.lookup().step, nullptr);
}

TEST(CoefficientTable, ReplacesTheWavesInTheForces) {
  auto w = reference_wings();
  w.coefficients = tabulated({0.0, 1.0, 2.0}, {1.5, 1.5, 1.5}, {2.5, 2.5, 2.5});
  EXPECT_NEAR(aero_loads(w, 50.0).lift, 0.5 * 1.225 * 1.5 * 2500.0 * 2.457e-6, 1e-16);
  EXPECT_NEAR(aero_loads(w, 50.0).moment, 0.5 * 1.225 * 2.5 * 2500.0 * 1.048e-7, 1e-17);
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
  EXPECT_NO_THROW(validate(reference_wings()));
  EXPECT_EQ(refusal(reference_wings(), [](W& w) { w.air_density = -1.0; }),
            "aerodynamics.air_density: must be >= 0 [kg/m3], got -1");
  EXPECT_EQ(refusal(reference_wings(), [](W& w) { w.pitch_coefficient = -5e-3; }),
            "aerodynamics.pitch_coefficient: must be >= 0 [s], got -0.005");
  EXPECT_EQ(refusal(reference_wings(), [](W& w) { w.s2 = -1.0; }), "wing.planform.s2: must be >= 0 [m4], got -1");
  EXPECT_EQ(refusal(reference_wings(), [](W& w) { w.s3 = -1.0; }), "wing.planform.s3: must be >= 0 [m5], got -1");
}

}  // namespace
}  // namespace wingbeat
