// Whether a fitted model describes the data at all: before any interval is stated.
#pragma once

#include <map>

#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat {

/// Residuals with less than this probability of being so large by chance, and over twice the variance stated, are a
/// misfit.
inline constexpr double misfit_probability = 1e-6;
inline constexpr double misfit_variance = 2.0;
/// Where the deviation is estimated from the residuals themselves: shares of the values' own spread (of its variance)
/// and of their size that residuals must exceed both.
inline constexpr double misfit_spread = 0.5, misfit_size = 0.2;

/// Sums up the residuals of result.points by measured quantity and finds where the model misses the data; the fitted
/// parameters leave `freedom` to each. Under a robust loss residuals count to `counted_residual`, so that outliers are
/// no misfit. Sets result.quantities, result.p_value and result.misfit.
void assess_misfit(const BenchFit& fit, const std::map<MeasuredQuantity, double>& freedom, FitResult& result);

/// Takes back what a misfit leaves without meaning: standard errors, intervals, covariances, what the data determine.
void withdraw_intervals(FitResult& result);

}  // namespace wingbeat
