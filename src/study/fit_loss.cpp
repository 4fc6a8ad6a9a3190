#include "study/fit_loss.hpp"

#include <ceres/loss_function.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wingbeat/core/math.hpp"
#include "wingbeat/study/distribution.hpp"

namespace wingbeat {
namespace {

/// Of min(z^2, counted_residual^2), z normal.
struct BoundedSquare {
  double mean, variance, growth;  ///< growth: d mean / d ln(deviation of z)
};

BoundedSquare bounded_square() {
  constexpr double b = counted_residual;
  const double inside = 1.0 - 2.0 * normal_probability(-b);
  const double density = std::exp(-0.5 * b * b) / std::sqrt(2.0 * std::numbers::pi);
  const double second = inside - 2.0 * b * density;  // of z^2 inside the bounds, and of z^4
  const double fourth = 3.0 * inside - 2.0 * density * (b * b * b + 3.0 * b);
  const double mean = second + b * b * (1.0 - inside);
  return {mean, fourth + square(b * b) * (1.0 - inside) - mean * mean, 2.0 * second};
}

}  // namespace

std::unique_ptr<ceres::LossFunction> ceres_loss(Loss loss, double scale) {
  switch (loss) {
    case Loss::none: return nullptr;
    case Loss::huber: return std::make_unique<ceres::HuberLoss>(scale);
    case Loss::soft_l1: return std::make_unique<ceres::SoftLOneLoss>(scale);
    case Loss::cauchy: return std::make_unique<ceres::CauchyLoss>(scale);
  }
  return nullptr;
}

LossAt loss_at(Loss loss, double scale, double residual) {
  const std::unique_ptr<ceres::LossFunction> function = ceres_loss(loss, scale);
  const double s = residual * residual;
  if (!function) return {s, 1.0, residual, 1.0};
  double rho[3];
  function->Evaluate(s, rho);
  return {rho[0], rho[1], rho[1] * residual, rho[1] + 2.0 * s * rho[2]};
}

double counted_square(Loss loss, double residual) {
  const double s = residual * residual;
  if (loss == Loss::none) return s;
  static const BoundedSquare bounded = bounded_square();
  return std::min(s, square(counted_residual)) / bounded.mean;
}

double counted_information(Loss loss) {
  static const BoundedSquare bounded = bounded_square();
  return loss == Loss::none ? 1.0 : 2.0 * square(bounded.mean) / bounded.variance;
}

double scale_efficiency(Loss loss) {
  static const BoundedSquare bounded = bounded_square();
  return loss == Loss::none ? 1.0 : 0.5 * square(bounded.growth) / bounded.variance;
}

}  // namespace wingbeat
