// What bench data determine of a vehicle, and what each condition contributes.
#pragma once

#include <vector>

#include "study/bench_fitter.hpp"

namespace wingbeat {

/// At the fitted parameters x [SI], from the information of the data (Fisher's, and what a robust loss leaves of it):
/// result's parameters, covariance, correlation, directions, conditions, findings and degrees of freedom.
void assess_identifiability(const BenchFit& fit, BenchFitter& fitter, const std::vector<double>& x,
                            const std::vector<std::size_t>& free, FitResult& result);

}  // namespace wingbeat
