#include "time/sequence_limit.hpp"

#include <utility>

#include <Eigen/Dense>

namespace wingbeat::detail {

void SequenceLimit::add(std::vector<double> state) {
  const std::size_t kept = state.size() + 2;
  states_.push_back(std::move(state));
  if (states_.size() > kept) states_.pop_front();
}

std::optional<std::vector<double>> SequenceLimit::limit() const {
  constexpr double unexplained = 1e-2;
  if (states_.size() < 3) return std::nullopt;
  const Eigen::Index size = Eigen::Index(states_.back().size()), last = Eigen::Index(states_.size()) - 1;
  Eigen::MatrixXd x(size, last + 1);
  for (Eigen::Index j = 0; j <= last; ++j) {
    x.col(j) = Eigen::Map<const Eigen::VectorXd>(states_[std::size_t(j)].data(), size);
  }
  const Eigen::MatrixXd u = x.rightCols(last) - x.leftCols(last);
  for (Eigen::Index modes = 1; modes < last; ++modes) {
    const Eigen::Index from = last - 1 - modes;
    const Eigen::MatrixXd changes = u.middleCols(from + 1, modes) - u.middleCols(from, modes);
    const Eigen::VectorXd shares = changes.colPivHouseholderQr().solve(-u.col(from));
    const double left = (u.col(from) + changes * shares).norm();
    if (!(left <= unexplained * u.col(last - 1).norm())) continue;
    const Eigen::VectorXd limit = x.col(from) + u.middleCols(from, modes) * shares;
    if (!limit.allFinite()) return std::nullopt;
    return std::vector<double>(limit.begin(), limit.end());
  }
  return std::nullopt;
}

}  // namespace wingbeat::detail
