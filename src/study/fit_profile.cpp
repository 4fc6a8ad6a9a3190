#include "study/fit_profile.hpp"

#include <algorithm>
#include <cmath>

namespace wingbeat {

void profile_likelihood(const BenchFit& fit, BenchFitter& fitter, const std::vector<double>& best, double least,
                        const std::vector<std::size_t>& free, std::size_t k, double quantile, FittedParameter& out) {
  const FreeParameter& p = fit.parameters[k];
  std::vector<std::size_t> others;
  for (const std::size_t f : free) {
    if (f != k) others.push_back(f);
  }
  const auto excess = [&](double value, std::vector<double>& x) {
    x[k] = value;
    const BenchFitter::Outcome outcome = fitter.solve(x, others, 30);
    x = outcome.x;
    const double rise = std::max(outcome.cost - least, 0.0);
    out.profile.push_back({value, rise});
    return std::sqrt(rise);
  };
  for (const int side : {-1, 1}) {
    const double bound = side < 0 ? p.lower : p.upper;
    double& end = side < 0 ? out.profile_lower_95 : out.profile_upper_95;
    std::vector<double> x = best;
    double inner = best[k], inner_root = 0.0, outer = absent, outer_root = absent;
    double next = best[k] + side * quantile * out.standard_error;
    for (int iteration = 0; iteration < 12; ++iteration) {
      const bool clipped = side * (next - bound) >= 0.0;
      if (clipped) next = bound;
      const double root = excess(next, x);
      if (std::abs(root - quantile) < 0.01 * quantile) {
        end = next;
        break;
      }
      if (root < quantile) {
        inner = next, inner_root = root;
        if (clipped) {
          end = bound;  // the likelihood does not end the interval, the bound does
          break;
        }
      } else {
        outer = next, outer_root = root;
      }
      if (std::isfinite(outer)) {
        next = inner + (outer - inner) * (quantile - inner_root) / (outer_root - inner_root);
      } else {
        next = best[k] + (inner - best[k]) * std::clamp(quantile / std::max(inner_root, 1e-9), 1.1, 3.0);
      }
    }
  }
  out.profile.push_back({best[k], 0.0});
  std::sort(out.profile.begin(), out.profile.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
}

}  // namespace wingbeat
