#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "wingbeat/solve/linear.hpp"

namespace wingbeat::solver {
namespace {

TEST(Linear, SolvesOneAndTwoUnknowns) {
  double a[] = {4.0}, b[] = {2.0};
  ASSERT_TRUE(solve_linear(1, a, b));
  EXPECT_DOUBLE_EQ(b[0], 0.5);
  // A zero pivot: rows must change places.
  double c[] = {0.0, 2.0, 3.0, 1.0}, d[] = {4.0, 5.0};
  ASSERT_TRUE(solve_linear(2, c, d));
  EXPECT_DOUBLE_EQ(d[0], 1.0);
  EXPECT_DOUBLE_EQ(d[1], 2.0);
}

TEST(Linear, ReadsMatricesRowByRow) {
  double a[] = {1.0, 5.0, 0.0, 1.0}, b[] = {11.0, 2.0};
  ASSERT_TRUE(solve_linear(2, a, b));
  EXPECT_DOUBLE_EQ(b[0], 1.0);
  double inverse[] = {1.0, 5.0, 0.0, 1.0};
  ASSERT_TRUE(invert(2, inverse));
  EXPECT_DOUBLE_EQ(inverse[1], -5.0);
  EXPECT_DOUBLE_EQ(inverse[2], 0.0);
}

TEST(Linear, RandomSystemsAreSolvedAndInverted) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const int n : {2, 3, 5, 10}) {
    std::vector<double> matrix(std::size_t(n * n)), x(std::size_t(n), 0.0), b(std::size_t(n), 0.0);
    for (double& value : matrix) value = normal(random);
    for (double& value : x) value = normal(random);
    const auto element = [&](int row, int column) { return matrix[std::size_t(row * n + column)]; };
    for (int row = 0; row < n; ++row) {
      for (int column = 0; column < n; ++column) b[std::size_t(row)] += element(row, column) * x[std::size_t(column)];
    }
    std::vector<double> work = matrix, inverse = matrix;
    ASSERT_TRUE(solve_linear(n, work.data(), b.data()));
    ASSERT_TRUE(invert(n, inverse.data()));
    for (int row = 0; row < n; ++row) {
      EXPECT_NEAR(b[std::size_t(row)], x[std::size_t(row)], 1e-12);
      for (int column = 0; column < n; ++column) {
        double sum = 0.0;
        for (int k = 0; k < n; ++k) sum += element(row, k) * inverse[std::size_t(k * n + column)];
        EXPECT_NEAR(sum, row == column ? 1.0 : 0.0, 1e-12);
      }
    }
  }
}

TEST(Linear, FactorsMultiplyToTheMatrix) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const int n : {1, 3, 5, 10, 20}) {
    std::vector<double> matrix(std::size_t(n * n));
    for (double& value : matrix) value = normal(random);
    for (int column = 0; column < n; ++column) matrix[std::size_t(column * n)] *= 1e6;  // a stiff row
    std::vector<double> factors = matrix;
    std::vector<int> pivots(std::size_t(n), 0);
    ASSERT_TRUE(factorise(n, factors.data(), pivots.data()));
    for (int k = 0; k < n; ++k) {
      for (int column = 0; column < n; ++column) {
        std::swap(matrix[std::size_t(column * n + k)], matrix[std::size_t(column * n + pivots[std::size_t(k)])]);
      }
    }
    for (int row = 0; row < n; ++row) {
      for (int column = 0; column < n; ++column) {
        double product = 0.0, size = 0.0;
        for (int k = 0; k <= std::min(row, column); ++k) {
          const double lower = k == row ? 1.0 : factors[std::size_t(k * n + row)];
          const double term = lower * factors[std::size_t(column * n + k)];
          product += term;
          size += std::abs(term);
        }
        EXPECT_NEAR(product, matrix[std::size_t(column * n + row)], 1e-14 * size) << n;
      }
    }
  }
  double singular[] = {1.0, 2.0, 2.0, 4.0};
  int pivots[2];
  EXPECT_FALSE(factorise(2, singular, pivots));
}

TEST(Linear, SingularMatricesAreRefused) {
  double a[] = {1.0, 2.0, 2.0, 4.0}, b[] = {1.0, 1.0};
  EXPECT_FALSE(solve_linear(2, a, b));
  double c[] = {1.0, 2.0, 2.0, 4.0};
  EXPECT_FALSE(invert(2, c));
  double zero[] = {0.0}, one[] = {1.0};
  EXPECT_FALSE(solve_linear(1, zero, one));
  double bad[] = {std::nan(""), 0.0, 0.0, 1.0}, right[] = {1.0, 1.0};
  EXPECT_FALSE(solve_linear(2, bad, right));
}

TEST(Linear, SpectralRadius) {
  const double one[] = {-0.7};
  EXPECT_DOUBLE_EQ(spectral_radius(1, one), 0.7);
  const double real[] = {2.0, 1.0, 1.0, 2.0};
  EXPECT_DOUBLE_EQ(spectral_radius(2, real), 3.0);
  const double negative[] = {-3.0, 0.0, 5.0, 1.0};
  EXPECT_DOUBLE_EQ(spectral_radius(2, negative), 3.0);
  const double rotation[] = {0.0, -0.5, 0.5, 0.0};
  EXPECT_DOUBLE_EQ(spectral_radius(2, rotation), 0.5);
  const double spiral[] = {-0.3, -0.4, 0.4, -0.3};
  EXPECT_DOUBLE_EQ(spectral_radius(2, spiral), 0.5);
  const double defective[] = {0.5, 1.0, 0.0, 0.5};
  EXPECT_DOUBLE_EQ(spectral_radius(2, defective), 0.5);
  const double opposite[] = {1.0, 0.0, 0.0, -1.0};
  EXPECT_DOUBLE_EQ(spectral_radius(2, opposite), 1.0);
  const double tiny[] = {1e-9, 1.0, 0.0, 1e-12};
  EXPECT_NEAR(spectral_radius(2, tiny), 1e-9, 1e-20);
  const double three[] = {0.0, -2.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.5};
  EXPECT_NEAR(spectral_radius(3, three), 2.0, 1e-14);
}

}  // namespace
}  // namespace wingbeat::solver
