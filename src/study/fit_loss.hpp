// The losses of bench fits, and how widely residuals scatter where a few of them are outliers.
#pragma once

#include <memory>

#include "wingbeat/study/bench_fit.hpp"

namespace ceres {
class LossFunction;
}

namespace wingbeat {

/// A loss at a residual r [standard deviations].
struct LossAt {
  double rho = 0.0;     ///< what is summed
  double weight = 1.0;  ///< rho'(r^2)
  double psi = 0.0;     ///< weight * r: what the residual pulls with
  double slope = 1.0;   ///< d psi/dr
};
LossAt loss_at(Loss loss, double scale, double residual);

/// Null for Loss::none.
std::unique_ptr<ceres::LossFunction> ceres_loss(Loss loss, double scale);

/// Under a robust loss squares are counted up to this many standard deviations where the scatter is concerned
/// (P. J. Huber, Ann. Math. Statist. 35, 73 (1964), proposal 2).
inline constexpr double counted_residual = 1.5;

/// r^2, under a robust loss bounded and scaled so that normal noise of deviation 1 has the mean 1 as well.
double counted_square(Loss loss, double residual);
/// A sum of n counted squares varies, relative to its mean, as chi square with n times this [1].
double counted_information(Loss loss);
/// How well the counted squares show a variance, beside the squares themselves: ratio of the variances [1].
double scale_efficiency(Loss loss);

}  // namespace wingbeat
