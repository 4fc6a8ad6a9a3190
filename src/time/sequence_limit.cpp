#include "time/sequence_limit.hpp"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace wingbeat::detail {
namespace {

using Column = std::vector<double>;

std::size_t states_known(std::size_t size) { return 3 * (size + 1); }

double dot(const Column& a, const Column& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

void subtract(double share, const Column& b, Column& from) {
  for (std::size_t n = 0; n < b.size(); ++n) from[n] -= share * b[n];
}

/// The shares x of the columns that leave least of `rest` - sum of x_i columns_i, which `rest` is afterwards; by
/// modified Gram-Schmidt, without a library: the explorer's page has no room for one.
Column least_squares(std::vector<Column> columns, Column& rest) {
  const std::size_t count = columns.size();
  std::vector<Column> upper(count, Column(count, 0.0));
  Column x(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    upper[i][i] = std::sqrt(dot(columns[i], columns[i]));
    for (double& value : columns[i]) value /= upper[i][i];
    for (std::size_t j = i + 1; j < count; ++j) {
      upper[i][j] = dot(columns[i], columns[j]);
      subtract(upper[i][j], columns[i], columns[j]);
    }
    x[i] = dot(columns[i], rest);
    subtract(x[i], columns[i], rest);
  }
  for (std::size_t i = count; i-- > 0;) {
    for (std::size_t j = i + 1; j < count; ++j) x[i] -= upper[i][j] * x[j];
    x[i] /= upper[i][i];
  }
  return x;
}

/// The roots of z^k + c_(k-1) z^(k-1) + ... + c_0 lie within the unit circle (Schur and Cohn).
bool fade(const Column& c) {
  Column a = c;
  for (a.push_back(1.0); a.size() > 1; a.pop_back()) {
    const std::size_t n = a.size() - 1;
    if (!(std::abs(a[0]) < std::abs(a[n]))) return false;
    const Column before = a;
    for (std::size_t i = 0; i < n; ++i) a[i] = before[n] * before[i + 1] - before[0] * before[n - 1 - i];
  }
  return true;
}

}  // namespace

void SequenceLimit::add(std::vector<double> state) {
  const std::size_t kept = states_known(state.size());
  states_.push_back(std::move(state));
  if (states_.size() > kept) states_.pop_front();
}

std::optional<SequenceLimit::Limit> SequenceLimit::limit() const {
  constexpr double unexplained = 3e-2;
  if (states_.empty() || states_.size() < states_known(states_.back().size())) return std::nullopt;
  const std::size_t size = states_.back().size(), changes = states_.size() - 1;
  // The changes from the one numbered `first` on, one behind the other.
  const auto column = [&](std::size_t first, std::size_t count) {
    Column u;
    for (std::size_t j = first; j < first + count; ++j) {
      for (std::size_t n = 0; n < size; ++n) u.push_back(states_[j + 1][n] - states_[j][n]);
    }
    return u;
  };
  for (std::size_t modes = 1; modes <= size; ++modes) {
    std::vector<Column> earlier;
    for (std::size_t i = 0; i < modes; ++i) earlier.push_back(column(i, changes - modes));
    const Column later = column(modes, changes - modes);
    Column rest = later;
    Column c = least_squares(std::move(earlier), rest);
    if (!(dot(rest, rest) <= unexplained * unexplained * dot(later, later))) continue;
    for (double& value : c) value = -value;
    if (!fade(c)) return std::nullopt;
    Limit limit{states_.back(), c};
    const double sum = std::accumulate(c.begin(), c.end(), 1.0);
    for (std::size_t n = 0; n < size; ++n) {
      for (std::size_t i = 0; i < modes; ++i) limit.state[n] += c[i] * states_[changes - modes + i][n];
      limit.state[n] /= sum;
      if (!std::isfinite(limit.state[n])) return std::nullopt;
    }
    return limit;
  }
  return std::nullopt;
}

}  // namespace wingbeat::detail
