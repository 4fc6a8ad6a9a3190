#include "study/fit_profile.hpp"

#include <algorithm>
#include <cmath>

namespace wingbeat {

ProfileSide profile_loss(const BenchFit& fit, BenchFitter& fitter, const std::vector<double>& best, double least,
                         const std::vector<std::size_t>& free, const FitResult& result, std::size_t k, int side) {
  const FreeParameter& p = fit.parameters[k];
  const FittedParameter& found = result.parameters[k];
  const double wanted = std::sqrt(found.profile_rise_95);
  std::vector<std::size_t> others;
  for (const std::size_t f : free) {
    if (f != k) others.push_back(f);
  }
  // Of the least loss: its rise is wanted to a few hundredths.
  constexpr double accuracy = 1e-4;
  ProfileSide crossing;
  // The others start where the straight line through the least and what was last found for them leads to, at first
  // the line that the covariance gives.
  std::vector<double> slope(best.size(), 0.0);
  for (const std::size_t f : others) slope[f] = result.covariance[f][k] / result.covariance[k][k];
  const auto excess = [&](double value) {
    std::vector<double> x = best;
    x[k] = value;
    for (const std::size_t f : others) {
      const double follows = best[f] + slope[f] * (value - best[k]);
      if (std::isfinite(follows)) x[f] = std::clamp(follows, fit.parameters[f].lower, fit.parameters[f].upper);
    }
    const BenchFitter::Outcome outcome = fitter.solve(x, others, 30, accuracy);
    if (value != best[k]) {
      for (const std::size_t f : others) slope[f] = (outcome.x[f] - best[f]) / (value - best[k]);
    }
    const double rise = std::max(outcome.cost - least, 0.0);
    crossing.points.push_back({value, rise});
    return std::sqrt(rise);
  };
  const double bound = side < 0 ? p.lower : p.upper;
  double inner = best[k], inner_root = 0.0, outer = absent, outer_root = absent;
  double next = best[k] + side * found.quantile_95 * found.standard_error;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const bool clipped = side * (next - bound) >= 0.0;
    if (clipped) next = bound;
    const double root = excess(next);
    if (std::abs(root - wanted) < 0.01 * wanted) {
      crossing.end = next;
      break;
    }
    if (root < wanted) {
      inner = next, inner_root = root;
      if (clipped) {
        crossing.end = bound;  // the loss does not end the interval, the bound does
        break;
      }
    } else {
      outer = next, outer_root = root;
    }
    if (std::isfinite(outer)) {
      next = inner + (outer - inner) * (wanted - inner_root) / (outer_root - inner_root);
    } else {
      next = best[k] + (inner - best[k]) * std::clamp(wanted / std::max(inner_root, 1e-9), 1.1, 3.0);
    }
  }
  return crossing;
}

void add_profile(const ProfileSide& lower, const ProfileSide& upper, double best, FittedParameter& parameter) {
  parameter.profile_lower_95 = lower.end;
  parameter.profile_upper_95 = upper.end;
  parameter.profile = lower.points;
  parameter.profile.insert(parameter.profile.end(), upper.points.begin(), upper.points.end());
  parameter.profile.push_back({best, 0.0});
  std::sort(parameter.profile.begin(), parameter.profile.end(),
            [](const auto& a, const auto& b) { return a.value < b.value; });
}

}  // namespace wingbeat
