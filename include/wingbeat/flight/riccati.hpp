// Linear-quadratic regulators: algebraic Riccati equations, and linear models sampled in time.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace wingbeat {

/// x' = A x + B u.
struct LinearPlant {
  Eigen::MatrixXd A, B;
};

/// The feedback u = -K x that makes the cost least, and the matrix P of that cost x^T P x.
struct Regulator {
  Eigen::MatrixXd P, K;
  double residual = 0.0;  ///< of the Riccati equation, over the largest of its terms [1]
};

/// e^M by scaling, squaring and a Pade approximant.
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& M);

/// x(k + 1) = A x(k) + B u(k) of a plant whose inputs are held for the time `step` [s].
LinearPlant sampled(const LinearPlant& plant, double step);

/// The regulator of x' = A x + B u for the integral of x^T Q x + u^T R u, by the stable subspace of the Hamiltonian:
/// \f[ A^\mathsf{T} P + P A - P B R^{-1} B^\mathsf{T} P + Q = 0, \qquad K = R^{-1} B^\mathsf{T} P \f]
/// None where no feedback stabilises the plant.
std::optional<Regulator> continuous_regulator(const LinearPlant& plant, const Eigen::MatrixXd& Q,
                                              const Eigen::MatrixXd& R);

/// The regulator of x(k + 1) = A x(k) + B u(k) for the sum of x^T Q x + u^T R u, by doubling, which takes a singular A:
/// \f[ P = A^\mathsf{T} P A - A^\mathsf{T} P B (R + B^\mathsf{T} P B)^{-1} B^\mathsf{T} P A + Q \f]
/// None where no feedback stabilises the plant.
std::optional<Regulator> discrete_regulator(const LinearPlant& plant, const Eigen::MatrixXd& Q,
                                            const Eigen::MatrixXd& R);

/// The largest magnitude of an eigenvalue.
double spectral_radius(const Eigen::MatrixXd& M);

}  // namespace wingbeat
