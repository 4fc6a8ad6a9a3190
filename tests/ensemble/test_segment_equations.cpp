// The collocation equations of the batched solver on equations whose solution is known, without a vehicle.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <random>

#include "ensemble/two_registers.hpp"
#include "wingbeat/core/pack.hpp"
#include "wingbeat/ensemble/direct_pack_rule.hpp"
#include "wingbeat/ensemble/pack_segment.hpp"

namespace wingbeat {
namespace {

using Matrix = std::array<std::array<double, 2>, 2>;

using LaneValues = std::array<double, lanes>;

Lanes in_lanes(const LaneValues& values) {
  alignas(64) LaneValues aligned = values;
  return Lanes::load(aligned.data());
}

double lane_of(const Lanes& x, std::size_t lane) {
  alignas(64) LaneValues values;
  x.store(values.data());
  return values[lane];
}

/// What the nodes of a segment move by, by the dense matrix of all nodes and states.
Eigen::VectorXd dense_solution(const solver::CollocationRule& rule, const Matrix* jacobian, double h,
                               const Eigen::VectorXd& residual, const Eigen::Vector2d& start) {
  const int n = rule.intervals;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  Eigen::VectorXd right = residual;
  for (int m = 1; m <= n; ++m) {
    for (int row = 0; row < 2; ++row) {
      right(2 * (m - 1) + row) += start(row);
      for (int column = 0; column < 2; ++column) {
        const auto r = std::size_t(row), c = std::size_t(column);
        right(2 * (m - 1) + row) += h * rule.up_to[m][0] * jacobian[0][r][c] * start(column);
        for (int j = 1; j <= n; ++j) {
          matrix(2 * (m - 1) + row, 2 * (j - 1) + column) -= h * rule.up_to[m][j] * jacobian[j][r][c];
        }
      }
    }
  }
  return matrix.fullPivLu().solve(right);
}

// Lanes of one register hold different equations, from mild to stiff: a current that relaxes up to a thousand times
// within the segment.
TEST(SegmentEquations, AreThoseOfTheDenseMatrixInEveryLane) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const int intervals : {4, 8}) {
    const solver::CollocationRule& rule = solver::collocation_rule(intervals);
    std::array<std::array<Matrix, solver::CollocationRule::max_points>, lanes> of_lane;
    std::array<Eigen::VectorXd, lanes> residual;
    SegmentEquations<Lanes, 2, 0, true> equations;
    std::array<SegmentEquations<Lanes, 2, 0, true>::Matrix, solver::CollocationRule::max_points> jacobian;
    const double h = 0.3;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double relaxation = std::pow(10.0, double(lane)) / h;
      residual[lane] = Eigen::VectorXd::NullaryExpr(2 * intervals, [&] { return unit(random); });
      for (std::size_t j = 0; j <= std::size_t(intervals); ++j) {
        of_lane[lane][j] = {{{-2.0 + unit(random), 3.0 + unit(random)},
                             {-relaxation * (0.4 + 0.1 * unit(random)), -relaxation * (1.0 + 0.3 * unit(random))}}};
      }
    }
    const auto gathered = [](const auto& value) {
      LaneValues values;
      for (std::size_t lane = 0; lane < lanes; ++lane) values[lane] = value(lane);
      return in_lanes(values);
    };
    for (std::size_t j = 0; j <= std::size_t(intervals); ++j) {
      for (std::size_t row = 0; row < 2; ++row) {
        for (std::size_t column = 0; column < 2; ++column) {
          jacobian[j][row][column] = gathered([&](std::size_t lane) { return of_lane[lane][j][row][column]; });
        }
        if (j == 0) continue;
        equations.moved[j - 1][row][0] =
            gathered([&](std::size_t lane) { return residual[lane](Eigen::Index(2 * (j - 1) + row)); });
      }
    }
    equations.solve(rule, jacobian.data(), Lanes(h));
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      for (int side = 0; side < 3; ++side) {
        const Eigen::VectorXd zero = Eigen::VectorXd::Zero(2 * intervals);
        const Eigen::VectorXd expected =
            dense_solution(rule, of_lane[lane].data(), h, side == 0 ? residual[lane] : zero,
                           {side == 1 ? 1.0 : 0.0, side == 2 ? 1.0 : 0.0});
        for (int n = 0; n < 2 * intervals; ++n) {
          EXPECT_NEAR(lane_of(equations.moved[std::size_t(n / 2)][std::size_t(n % 2)][std::size_t(side)], lane),
                      expected(n), 1e-11 * (1.0 + expected.cwiseAbs().maxCoeff()))
              << "lane " << lane << ", node " << n / 2 + 1 << ", side " << side;
        }
      }
    }
  }
}

// y' = -k y, and (x, y)' = (-x + y, -k y): what the end moves by when the start does is the matrix exponential, and its
// error falls as h^(2 n + 1).
TEST(SegmentEquations, MoveTheEndByTheExponentialToTheOrderOfTheRule) {
  constexpr int intervals = 2;
  const solver::CollocationRule& rule = solver::collocation_rule(intervals);
  const double k = 3.0;
  const auto errors = [&](double h) {
    SegmentEquations<double, 1, intervals, true> one;
    SegmentEquations<double, 2, intervals, true> two;
    std::array<SegmentEquations<double, 1, intervals, true>::Matrix, intervals + 1> slope;
    std::array<Matrix, intervals + 1> coupled;
    slope.fill({{{-k}}});
    coupled.fill({{{-1.0, 1.0}, {0.0, -k}}});
    for (std::size_t m = 0; m < intervals; ++m) {
      one.moved[m][0][0] = 0.0;
      two.moved[m][0][0] = two.moved[m][1][0] = 0.0;
    }
    one.solve(rule, slope.data(), h);
    two.solve(rule, coupled.data(), h);
    const double fast = std::exp(-k * h), slow = std::exp(-h);
    return std::array<double, 4>{one.moved[1][0][1] - fast, two.moved[1][0][1] - slow,
                                 two.moved[1][0][2] - (slow - fast) / (k - 1.0), two.moved[1][1][2] - fast};
  };
  const auto coarse = errors(0.04), fine = errors(0.02);
  for (std::size_t n = 0; n < coarse.size(); ++n) {
    EXPECT_NEAR(std::log2(std::abs(coarse[n] / fine[n])), 2.0 * intervals + 1.0, 0.2) << n;
  }
}

TEST(DirectPackRule, TakesPolynomialsApartDifferentiatesAndHalvesThem) {
  const DirectPackRule& rule = direct_pack_rule();
  for (std::size_t degree = 0; degree < DirectPackRule::points; ++degree) {
    std::array<double, DirectPackRule::points> value;
    for (std::size_t m = 0; m < value.size(); ++m) value[m] = std::pow(rule.place[m], degree);
    for (std::size_t k = 0; k < value.size(); ++k) {
      double coefficient = 0.0, slope = 0.0;
      for (std::size_t m = 0; m < value.size(); ++m) {
        coefficient += rule.power[k][m] * value[m];
        slope += rule.slope[k][m] * value[m];
      }
      EXPECT_NEAR(coefficient, k == degree ? 1.0 : 0.0, 1e-10) << "degree " << degree << ", power " << k;
      // `place` runs from -1 to 1 on a segment of length 1.
      const double expected = degree == 0 ? 0.0 : 2.0 * double(degree) * std::pow(rule.place[k], double(degree) - 1.0);
      EXPECT_NEAR(slope, expected, 1e-10) << "degree " << degree << ", point " << k;
    }
    for (std::size_t j = 0; j < 2 * DirectPackRule::stages; ++j) {
      const double half = j < DirectPackRule::stages ? -0.5 : 0.5;
      const double place = half + 0.5 * rule.place[1 + j % DirectPackRule::stages];
      double found = 0.0;
      for (std::size_t m = 0; m < value.size(); ++m) found += rule.halved[j][m] * value[m];
      EXPECT_NEAR(found, std::pow(place, degree), 1e-10) << "degree " << degree << ", stage " << j;
    }
  }
}

}  // namespace
}  // namespace wingbeat
