// What bench data determine of a vehicle, and what each condition contributes.
#pragma once

#include <vector>

#include "study/bench_fitter.hpp"

namespace wingbeat {

/// Two-sided 95 % quantile of the residuals' distribution: Student's where deviations are estimated from `freedom`
/// degrees of freedom, at least three, else the normal one.
double quantile_95(const BenchFitter& fitter, int freedom);

/// At the fitted parameters x [SI], from the Fisher information: result's parameters, covariance, correlation,
/// directions, conditions, findings and degrees of freedom.
void assess_identifiability(const BenchFit& fit, BenchFitter& fitter, const std::vector<double>& x, FitResult& result);

}  // namespace wingbeat
