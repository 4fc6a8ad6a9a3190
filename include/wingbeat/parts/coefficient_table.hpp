// Tables of lift and drag coefficient against angle of attack; model.md section 3.
#pragma once

#include <array>
#include <vector>

namespace wingbeat {

/// The polynomial pieces of a coefficient table and how to find the one that holds. Plain numbers: it stays with the
/// table, and code built for a wide instruction set may read it.
struct CoefficientLookup {
  /// Of lift and drag a + b t + c t^2 + d t^3, t = alpha - x0 [rad].
  struct Row {
    double x0;
    std::array<double, 4> lift, drag;
  };
  const double* knot;  ///< [rad], growing, after the last one not a number
  const Row* row;      ///< [k]: where k knots lie at or below alpha
  const int* first;    ///< [b]: knots before bucket b of the table's angles
  int buckets;
  int max_in_bucket;  ///< knots in one bucket
  double front;       ///< first angle of the table [rad]
  double buckets_per_angle;
  /// Where all knots are a whole number of equal steps from the first: of each step, t counted in steps from its start;
  /// else null.
  struct Step {
    std::array<double, 4> lift, drag;
  };
  const Step* step;
  int steps;  ///< 0 without
  double steps_per_angle;

  /// How many knots lie at or below alpha.
  [[gnu::always_inline]] int knots_up_to(double alpha) const {
    const double bucket = (alpha - front) * buckets_per_angle, last = buckets - 1;
    int k = first[int(!(bucket > 0.0) ? 0.0 : bucket < last ? bucket : last)];
    k += alpha >= knot[k];
    for (int n = 1; n < max_in_bucket; ++n) k += alpha >= knot[k];
    return k;
  }
};

/// Lift and drag coefficient against angle of attack as natural cubic splines through a table; the end values hold
/// outside the table.
class CoefficientTable {
 public:
  /// `alpha` [rad] strictly growing, at least three rows. Throws ParameterError naming the row.
  CoefficientTable(std::vector<double> alpha, std::vector<double> lift, std::vector<double> drag);

  struct Cubic {
    double x0, a, b, c, d;  ///< a + b t + c t^2 + d t^3, t = x - x0
  };
  /// The polynomial piece that holds at alpha; a constant outside the table.
  [[gnu::pure]] Cubic lift_piece(double alpha) const;
  [[gnu::pure]] Cubic drag_piece(double alpha) const;

  const std::vector<double>& alpha() const { return alpha_; }
  const std::vector<double>& lift() const { return lift_values_; }
  const std::vector<double>& drag() const { return drag_values_; }
  /// Valid while the table lives.
  CoefficientLookup lookup() const;

 private:
  void lay_steps();

  std::vector<double> alpha_, lift_values_, drag_values_, knots_;
  std::vector<CoefficientLookup::Row> rows_;
  std::vector<int> first_;
  std::vector<CoefficientLookup::Step> steps_;
  int max_in_bucket_ = 0;
};

}  // namespace wingbeat
