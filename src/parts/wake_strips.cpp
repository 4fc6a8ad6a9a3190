#include <Eigen/Dense>
#include <cmath>

#include "wingbeat/parts/induced_velocity.hpp"

namespace wingbeat {

/// Stieltjes's procedure on a fine rule for the weight, then the eigenvalues of the Jacobi matrix (Golub and Welsch,
/// Math. Comp. 23, 1969). The chord of a strip, by which pitch moments are weighted, is that of the polynomial nearest
/// to the outline: so the rule holds for the chord's square as it does for the chord.
std::array<WakeStrip<double>, wake_strip_count> detail::tabulated_strips(
    const std::vector<std::pair<double, double>>& rows) {
  constexpr Eigen::Index n = Eigen::Index(wake_strip_count);
  std::vector<double> place, share, outline;
  const double length = rows.back().first;
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const auto [x0, c0] = rows[row - 1];
    const auto [x1, c1] = rows[row];
    const double t0 = std::sqrt(x0 / length), t1 = std::sqrt(x1 / length), slope = (c1 - c0) / (x1 - x0);
    const double chord_0 = c0 - slope * x0;
    visit_gauss_16([&](double node, double weight) {
      const double t = t0 + (t1 - t0) * node, x = length * t * t;
      place.push_back(t);
      outline.push_back(chord_0 + slope * x);
      share.push_back((t1 - t0) * weight * (chord_0 + slope * x) * 2.0 * length * t);
    });
  }
  const Eigen::Map<const Eigen::ArrayXd> t(place.data(), Eigen::Index(place.size()));
  const Eigen::Map<const Eigen::ArrayXd> weight(share.data(), Eigen::Index(share.size()));
  const double area = weight.sum();
  Eigen::ArrayXd before = Eigen::ArrayXd::Zero(t.size()),
                 now = Eigen::ArrayXd::Constant(t.size(), 1.0 / std::sqrt(area));
  const Eigen::Map<const Eigen::ArrayXd> chord(outline.data(), Eigen::Index(outline.size()));
  Eigen::VectorXd diagonal(n), beside = Eigen::VectorXd::Zero(n), projection(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    diagonal[k] = (weight * t * now.square()).sum();
    projection[k] = (weight * chord * now).sum();
    Eigen::ArrayXd next = (t - diagonal[k]) * now - (k > 0 ? beside[k - 1] : 0.0) * before;
    if (k + 1 == n) break;
    beside[k] = std::sqrt((weight * next.square()).sum());
    before = now;
    now = next / beside[k];
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> jacobi;
  jacobi.computeFromTridiagonal(diagonal, beside.head(n - 1));
  std::array<WakeStrip<double>, wake_strip_count> strips;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double root = jacobi.eigenvalues()[k], first = jacobi.eigenvectors()(0, k);
    const double nearest = projection.dot(jacobi.eigenvectors().col(k)) / (first * std::sqrt(area));
    strips[std::size_t(k)] = {length * square(root), area * square(first), nearest};
  }
  return strips;
}

}  // namespace wingbeat
