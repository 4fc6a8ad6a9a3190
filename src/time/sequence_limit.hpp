// Where a sequence of states that approaches its limit linearly will settle.
#pragma once

#include <deque>
#include <optional>
#include <vector>

namespace wingbeat::detail {

/// The last states of a sequence, and its limit by minimal polynomial extrapolation (Cabay and Jackson, SIAM Journal on
/// Numerical Analysis 13, 1976). Of \f$ x_{j+1} = A x_j + b \f$ with changes \f$ u_j = x_{j+1} - x_j \f$ that k modes
/// explain,
/// \f[
/// u_{j+k} + \sum_{i<k} c_i u_{j+i} = 0, \qquad s = \frac{x_{j+k} + \sum_{i<k} c_i x_{j+i}}{1 + \sum_{i<k} c_i}
/// \f]
/// where all known changes determine the c, and the roots of their polynomial are the eigenvalues of these modes.
class SequenceLimit {
 public:
  struct Limit {
    std::vector<double> state;
    std::vector<double> recurrence;  ///< c_0, c_1, ...: of the changes, and of all deviations from the limit
  };

  /// One more state; all are of one size, each number of it relative to what is typical of it.
  void add(std::vector<double> state);
  void clear() { states_.clear(); }
  /// The limit by as few modes as leave no more than 3 % of the changes unexplained; none where no number of
  /// modes does, where one of them does not fade, or before three states for each number and the limit are known.
  std::optional<Limit> limit() const;

 private:
  std::deque<std::vector<double>> states_;
};

}  // namespace wingbeat::detail
