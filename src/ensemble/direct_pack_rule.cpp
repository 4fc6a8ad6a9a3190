#include "wingbeat/ensemble/direct_pack_rule.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/solve/radau_collocation.hpp"

namespace wingbeat {
namespace {

DirectPackRule make_direct_pack_rule() {
  constexpr std::size_t stages = DirectPackRule::stages, points = DirectPackRule::points;
  using Matrix = Eigen::Matrix<long double, int(points), int(points)>;
  const auto collocation = solver::radau_collocation<int(stages)>();
  DirectPackRule rule{};
  for (std::size_t j = 0; j < stages; ++j) {
    rule.phase[j + 1] = collocation.c[j];
    for (std::size_t l = 0; l < stages; ++l) rule.a[j][l] = collocation.a[j][l];
  }
  for (std::size_t m = 0; m < points; ++m) rule.place[m] = 2.0 * rule.phase[m] - 1.0;
  Matrix powers;
  for (int m = 0; m < int(points); ++m) {
    for (int k = 0; k < int(points); ++k) powers(m, k) = std::pow((long double)(rule.place[m]), k);
  }
  const Matrix of_values = powers.fullPivLu().inverse();
  for (int k = 0; k < int(points); ++k) {
    for (int m = 0; m < int(points); ++m) rule.power[k][m] = double(of_values(k, m));
  }
  for (int m = 0; m < int(points); ++m) {
    for (int j = 0; j < int(points); ++j) {
      long double sum = 0.0L;
      for (int k = int(points) - 1; k > 0; --k) sum = sum * (long double)(rule.place[m]) + k * of_values(k, j);
      rule.slope[m][j] = double(2.0L * sum);
    }
  }
  for (std::size_t j = 0; j < 2 * stages; ++j) {
    const long double middle = j < stages ? -0.5L : 0.5L;
    const long double t = middle + 0.5L * (long double)(rule.place[1 + j % stages]);
    for (int m = 0; m < int(points); ++m) {
      long double value = 0.0L;
      for (int k = int(points) - 1; k >= 0; --k) value = value * t + of_values(k, m);
      rule.halved[j][m] = double(value);
    }
  }
  for (std::size_t n = 0; n < balance_samples; ++n) {
    rule.balance_sine[n] = std::sin(0.5 * pi * (double(n) + 0.5) / double(balance_samples));
  }
  rule.balance_ratio = std::pow(1e-4, 1.0 / double(balance_speeds));
  return rule;
}

}  // namespace

const DirectPackRule& direct_pack_rule() {
  static const DirectPackRule rule = make_direct_pack_rule();
  return rule;
}

}  // namespace wingbeat
