// Intervals from the rise of the loss (without a robust one, of -2 ln L): one parameter is moved, the others are fitted
// again.
#pragma once

#include <vector>

#include "study/bench_fitter.hpp"

namespace wingbeat {

/// One side of a parameter's profile.
struct ProfileSide {
  std::vector<FittedParameter::ProfilePoint> points;  ///< in the order in which they were tried
  double end = absent;                                ///< of the interval [SI]; absent where not found
};

/// Moves parameter k from the least loss, `least` at `best`, to one side (-1 or 1) until it has risen as `result` says
/// of k, with all of `free` (k among them) but k fitted again. The covariance of `result` says how they follow.
ProfileSide profile_loss(const BenchFit& fit, BenchFitter& fitter, const std::vector<double>& best, double least,
                         const std::vector<std::size_t>& free, const FitResult& result, std::size_t k, int side);

/// Puts both sides and the least, at `best`, into a parameter's profile.
void add_profile(const ProfileSide& lower, const ProfileSide& upper, double best, FittedParameter& parameter);

}  // namespace wingbeat
