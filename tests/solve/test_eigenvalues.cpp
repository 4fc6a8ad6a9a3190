// Decompositions of small matrices against their definitions.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "wingbeat/solve/eigenvalues.hpp"
#include "wingbeat/solve/singular_values.hpp"

namespace wingbeat::solver {
namespace {

Eigen::MatrixXd example() {
  Eigen::MatrixXd M(4, 4);
  M << 1, 2, 0, -1, -3, 1, 2, 0, 0.5, 0, -2, 1, 1, -1, 0, 3;
  return M;
}

TEST(Eigenvalues, VectorsAreScaledByTheirValues) {
  const Eigen::MatrixXd M = example();
  const EigenModes modes = eigen_modes(M);
  ASSERT_TRUE(modes.found);
  for (Eigen::Index k = 0; k < 4; ++k) {
    EXPECT_LT((M * modes.vectors.col(k) - modes.values[k] * modes.vectors.col(k)).norm(), 1e-13) << k;
  }
  EXPECT_LT((eigenvalues_of(M) - modes.values).norm(), 1e-12);
  // What the real vectors of a pair span, M keeps.
  for (Eigen::Index k = 0; k < 4; ++k) {
    if (!(modes.values[k].imag() > 0.0)) continue;
    Eigen::Matrix2d turned;
    turned << modes.values[k].real(), modes.values[k].imag(), -modes.values[k].imag(), modes.values[k].real();
    const auto pair = modes.real_vectors.middleCols(k, 2);
    EXPECT_LT((M * pair - pair * turned).norm(), 1e-12);
  }
}

TEST(Eigenvalues, AreNaNWhereThereAreNone) {
  Eigen::MatrixXd M = example();
  M(1, 2) = std::numeric_limits<double>::quiet_NaN();
  const EigenModes modes = eigen_modes(M);
  EXPECT_FALSE(modes.found);
  ASSERT_EQ(modes.values.size(), 4);
  EXPECT_TRUE(std::isnan(modes.values[3].real()));
  EXPECT_TRUE(std::isnan(eigenvalues_of(M)[0].real()));
}

TEST(SingularValues, GiveTheMatrixBack) {
  const Eigen::MatrixXd M = example().leftCols(3);
  const SingularValues found = singular_values(M);
  EXPECT_LT((found.U * found.sizes.asDiagonal() * found.V.transpose() - M).norm(), 1e-13);
  EXPECT_LT((found.V.transpose() * found.V - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_GE(found.sizes[0], found.sizes[2]);
}

TEST(SymmetricModes, AreInOrder) {
  const Eigen::MatrixXd M = example() + example().transpose();
  const SymmetricModes modes = symmetric_modes(M);
  EXPECT_LT((M * modes.vectors - modes.vectors * modes.values.asDiagonal()).norm(), 1e-13);
  for (Eigen::Index k = 1; k < 4; ++k) EXPECT_LE(modes.values[k - 1], modes.values[k]);
}

}  // namespace
}  // namespace wingbeat::solver
