// Intervals of a fitted parameter from the likelihood itself.
#pragma once

#include <vector>

#include "study/bench_fitter.hpp"

namespace wingbeat {

/// Profile of parameter k: -2 ln L with k fixed, the others of `free` fitted again, until it has risen from `least` by
/// the square of the quantile on either side of the best parameters [SI]. Sets out's profile and its interval.
void profile_likelihood(const BenchFit& fit, BenchFitter& fitter, const std::vector<double>& best, double least,
                        const std::vector<std::size_t>& free, std::size_t k, double quantile, FittedParameter& out);

}  // namespace wingbeat
