#include "wingbeat/study/sobol_indices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "wingbeat/study/distribution.hpp"

namespace wingbeat {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

SobolIndices sobol_indices(std::span<const double> a, std::span<const double> b,
                           std::span<const std::vector<double>> mixed, int resamples, std::uint64_t seed) {
  const std::size_t inputs = mixed.size();
  std::vector<std::size_t> rows;
  for (std::size_t n = 0; n < a.size(); ++n) {
    bool there = std::isfinite(a[n]) && std::isfinite(b[n]);
    for (const auto& column : mixed) there = there && std::isfinite(column[n]);
    if (there) rows.push_back(n);
  }
  SobolIndices result;
  result.rows = rows.size();
  result.inputs.assign(inputs, {nan, nan, nan, nan, nan, nan});
  result.variance = nan;
  if (rows.size() < 2) return result;

  // Counted from the mean: the estimator of first-order indices is then far less noisy.
  double mean = 0.0;
  for (const std::size_t n : rows) mean += a[n] + b[n];
  mean /= 2.0 * double(rows.size());
  const std::size_t width = 2 + 2 * inputs;
  std::vector<double> terms(rows.size() * width);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double fa = a[rows[r]] - mean, fb = b[rows[r]] - mean;
    double* row = &terms[r * width];
    row[0] = 0.5 * (fa + fb);
    row[1] = 0.5 * (fa * fa + fb * fb);
    for (std::size_t i = 0; i < inputs; ++i) {
      const double fi = mixed[i][rows[r]] - mean;
      row[2 + i] = fb * (fi - fa);
      row[2 + inputs + i] = 0.5 * (fa - fi) * (fa - fi);
    }
  }
  const auto shares = [&](const std::vector<double>& sums) {
    std::vector<double> share(2 * inputs);
    const double count = double(rows.size());
    const double variance = sums[1] / count - (sums[0] / count) * (sums[0] / count);
    for (std::size_t k = 0; k < share.size(); ++k) share[k] = variance > 0.0 ? sums[2 + k] / count / variance : nan;
    return std::pair(variance, share);
  };
  std::vector<double> sums(width, 0.0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t k = 0; k < width; ++k) sums[k] += terms[r * width + k];
  }
  const auto [variance, estimate] = shares(sums);
  result.variance = variance;
  for (std::size_t i = 0; i < inputs; ++i) {
    result.inputs[i].first = estimate[i];
    result.inputs[i].total = estimate[inputs + i];
  }
  if (resamples < 2) return result;

  std::vector<std::vector<double>> resampled(2 * inputs);
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::size_t> draw(0, rows.size() - 1);
  for (int s = 0; s < resamples; ++s) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double* row = &terms[draw(random) * width];
      for (std::size_t k = 0; k < width; ++k) sums[k] += row[k];
    }
    const auto share = shares(sums).second;
    for (std::size_t k = 0; k < share.size(); ++k) {
      if (std::isfinite(share[k])) resampled[k].push_back(share[k]);
    }
  }
  for (std::size_t k = 0; k < resampled.size(); ++k) {
    if (resampled[k].empty()) continue;
    std::sort(resampled[k].begin(), resampled[k].end());
    SobolIndex& index = result.inputs[k % inputs];
    (k < inputs ? index.first_lower : index.total_lower) = percentile(resampled[k], 0.025);
    (k < inputs ? index.first_upper : index.total_upper) = percentile(resampled[k], 0.975);
  }
  return result;
}

}  // namespace wingbeat
