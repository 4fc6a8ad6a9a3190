// Where a sequence of states that approaches its limit linearly will settle.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace wingbeat::detail {

/// The last states of a sequence, and its limit by reduced rank extrapolation (Eddy 1979; Smith, Ford and Sidi, SIAM
/// Review 29, 1987): of \f$ x_{j+1} = A x_j + b \f$ with changes \f$ u_j = x_{j+1} - x_j \f$
/// \f[
/// s = x_0 + \sum_{j<k} \xi_j u_j, \qquad \min_\xi \Bigl| u_0 + \sum_{j<k} \xi_j (u_{j+1} - u_j) \Bigr|
/// \f]
/// which is the fixed point where k is the number of modes that have not yet decayed.
class SequenceLimit {
 public:
  /// One more state; all are of one size, each number of it relative to what is typical of it.
  void add(std::vector<double> state);
  void clear() { states_.clear(); }
  /// The limit by as few modes as leave no more than a hundredth of the last change unexplained; none where even as many
  /// as the state has numbers do not, or too few states are known.
  std::optional<std::vector<double>> limit() const;

 private:
  std::deque<std::vector<double>> states_;  ///< no more than all modes take
};

}  // namespace wingbeat::detail
