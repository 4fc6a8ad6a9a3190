// A few parameters fitted to a list of numbers by least squares, derivatives by differences.
#pragma once

#include <functional>
#include <vector>

#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat {

/// What the model computes at parameters x [SI], one number for each measured one; not finite where it reaches none.
using Computed = std::function<std::vector<double>(const std::vector<double>& x)>;

struct ResidualFit {
  bool converged = false;
  std::vector<FittedParameter> parameters;
  std::vector<double> x;  ///< [SI]
};

/// The least squares of computed minus measured within the parameters' bounds, and 95 % intervals from the residuals'
/// own size with Student's distribution; without them where no degree of freedom is left, a parameter is at a bound or
/// the interval is as wide as the bounds.
/// `parameters` bring keys, units and bounds; their DesignParameter may be empty but for these.
ResidualFit fit_residuals(const Computed& computed, const std::vector<double>& measured,
                          const std::vector<FreeParameter>& parameters);

}  // namespace wingbeat
