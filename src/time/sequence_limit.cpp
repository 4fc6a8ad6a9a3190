#include "time/sequence_limit.hpp"

#include <cstddef>
#include <utility>

#include <Eigen/Dense>

namespace wingbeat::detail {
namespace {

std::size_t states_known(std::size_t size) { return 3 * (size + 1); }

/// The polynomial's roots lie within the unit circle.
bool fade(const Eigen::VectorXd& c) {
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(c.size(), c.size());
  companion.rightCols(1) = -c;
  companion.diagonal(-1).setOnes();
  return companion.eigenvalues().cwiseAbs().maxCoeff() < 1.0;
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
  const Eigen::Index size = Eigen::Index(states_.back().size()), last = Eigen::Index(states_.size()) - 1;
  Eigen::MatrixXd x(size, last + 1);
  for (Eigen::Index j = 0; j <= last; ++j) {
    x.col(j) = Eigen::Map<const Eigen::VectorXd>(states_[std::size_t(j)].data(), size);
  }
  const Eigen::MatrixXd u = x.rightCols(last) - x.leftCols(last);
  for (Eigen::Index modes = 1; modes <= size; ++modes) {
    const Eigen::Index known = last - modes;
    const Eigen::VectorXd later = u.rightCols(known).reshaped();
    Eigen::MatrixXd earlier(size * known, modes);
    for (Eigen::Index i = 0; i < modes; ++i) earlier.col(i) = u.middleCols(i, known).reshaped();
    const Eigen::VectorXd c = earlier.colPivHouseholderQr().solve(-later);
    if (!((later + earlier * c).norm() <= unexplained * later.norm())) continue;
    const Eigen::VectorXd limit = (x.col(last) + x.middleCols(last - modes, modes) * c) / (1.0 + c.sum());
    if (!limit.allFinite() || !fade(c)) return std::nullopt;
    return Limit{{limit.begin(), limit.end()}, {c.begin(), c.end()}};
  }
  return std::nullopt;
}

}  // namespace wingbeat::detail
