#include "wingbeat/flight/riccati.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "wingbeat/solve/eigenvalues.hpp"

namespace wingbeat {

using Eigen::MatrixXd;

MatrixXd matrix_exponential(const MatrixXd& M) {
  // The diagonal Pade approximant of order 6 of a matrix of norm at most 1/2.
  constexpr int order = 6;
  const double norm = M.cwiseAbs().rowwise().sum().maxCoeff();
  const int squarings = norm > 0.5 ? int(std::ceil(std::log2(norm / 0.5))) : 0;
  const MatrixXd X = M / std::pow(2.0, squarings);
  const MatrixXd one = MatrixXd::Identity(M.rows(), M.cols());
  MatrixXd power = one, numerator = one, denominator = one;
  double c = 1.0;
  for (int k = 1; k <= order; ++k) {
    c *= double(order - k + 1) / double(k * (2 * order - k + 1));
    power = X * power;
    numerator += c * power;
    denominator += (k % 2 == 0 ? c : -c) * power;
  }
  MatrixXd E = denominator.partialPivLu().solve(numerator);
  for (int k = 0; k < squarings; ++k) E = E * E;
  return E;
}

LinearPlant sampled(const LinearPlant& plant, double step) {
  const Eigen::Index n = plant.A.rows(), m = plant.B.cols();
  MatrixXd M = MatrixXd::Zero(n + m, n + m);
  M.topLeftCorner(n, n) = step * plant.A;
  M.topRightCorner(n, m) = step * plant.B;
  const MatrixXd E = matrix_exponential(M);
  return {E.topLeftCorner(n, n), E.topRightCorner(n, m)};
}

std::optional<Regulator> continuous_regulator(const LinearPlant& plant, const MatrixXd& Q, const MatrixXd& R) {
  const Eigen::Index n = plant.A.rows();
  const MatrixXd through = R.ldlt().solve(plant.B.transpose());
  const MatrixXd S = plant.B * through;
  MatrixXd H(2 * n, 2 * n);
  H << plant.A, -S, -Q, -plant.A.transpose();
  const solver::EigenModes modes = solver::eigen_modes(H);
  if (!modes.found) return std::nullopt;
  // Eigenvalues come in pairs on either side of the imaginary axis; on it there is no stable subspace.
  const double least = 1e-9 * std::max(1e-300, modes.values.cwiseAbs().maxCoeff());
  std::vector<Eigen::Index> stable;
  for (Eigen::Index k = 0; k < 2 * n; ++k) {
    if (modes.values[k].real() < -least) stable.push_back(k);
  }
  if (Eigen::Index(stable.size()) != n) return std::nullopt;
  MatrixXd upper(n, n), lower(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    upper.col(k) = modes.real_vectors.col(stable[std::size_t(k)]).head(n);
    lower.col(k) = modes.real_vectors.col(stable[std::size_t(k)]).tail(n);
  }
  // P = lower upper^-1.
  const MatrixXd found = upper.transpose().partialPivLu().solve(lower.transpose());
  Regulator result;
  result.P = 0.5 * (found + found.transpose());
  result.K = through * result.P;
  const MatrixXd left = plant.A.transpose() * result.P, quadratic = result.P * S * result.P;
  const double size = std::max({left.norm(), quadratic.norm(), Q.norm()});
  result.residual = (left + left.transpose() - quadratic + Q).norm() / size;
  if (!result.P.allFinite() || !(result.residual < 1e-6)) return std::nullopt;
  return result;
}

std::optional<Regulator> discrete_regulator(const LinearPlant& plant, const MatrixXd& Q, const MatrixXd& R) {
  constexpr int max_doublings = 60;
  const Eigen::Index n = plant.A.rows();
  const MatrixXd one = MatrixXd::Identity(n, n);
  MatrixXd A = plant.A, G = plant.B * R.ldlt().solve(plant.B.transpose()), P = Q;
  bool settled = false;
  for (int k = 0; k < max_doublings && !settled; ++k) {
    const Eigen::PartialPivLU<MatrixXd> W(one + G * P);
    const MatrixXd through = W.solve(A), input = W.solve(G);
    const MatrixXd added = A.transpose() * P * through;
    G += A * input * A.transpose();
    A = A * through;
    settled = added.norm() <= 1e-15 * P.norm();
    P += added;
    P = 0.5 * (P + P.transpose().eval());
    G = 0.5 * (G + G.transpose().eval());
    if (!P.allFinite() || !G.allFinite()) return std::nullopt;
  }
  Regulator result;
  result.P = P;
  const MatrixXd BP = plant.B.transpose() * P;
  result.K = (R + BP * plant.B).ldlt().solve(BP * plant.A);
  const MatrixXd first = plant.A.transpose() * P * plant.A;
  const MatrixXd rest = plant.A.transpose() * BP.transpose() * result.K;
  result.residual = (first - rest + Q - P).norm() / std::max(first.norm(), P.norm());
  if (!(result.residual < 1e-6) || !(spectral_radius(plant.A - plant.B * result.K) < 1.0)) return std::nullopt;
  return result;
}

double spectral_radius(const MatrixXd& M) {
  if (M.rows() == 0) return 0.0;
  return solver::eigenvalues_of(M).cwiseAbs().maxCoeff();
}

}  // namespace wingbeat
