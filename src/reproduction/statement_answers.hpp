// What the model answers to one statement of a paper.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/files/published.hpp"

namespace wingbeat {

struct Answer {
  double value = absent;     ///< in the statement's unit
  std::string text;          ///< for reading
  bool holds = false;        ///< of a statement without a number
  double residual = absent;  ///< largest formulation residual over input of the cycles behind the value; absent: none
  double place = absent;     ///< of a number that is searched for: where along the quantity; of a range its lower end
  bool inside = false;       ///< that place is not an end of the window, nor an edge of flapping or of the domain
};

/// Orbits of designs, each solved once: statements of one paper look at many of the same operating points. Any number
/// of threads may ask.
class SolvedPoints {
 public:
  /// Metrics at a held frequency, or at the supply's voltage; all absent where the design does not flap or leaves the
  /// domain. Of its limits that on the formulation residual is not applied: what equation (1) as printed does is itself
  /// under test.
  Metrics<double> metrics(const Design<double>& design, std::optional<double> frequency, Condition condition);

 private:
  struct Point {
    std::once_flag solved;
    Metrics<double> metrics;
  };
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<Point>> points_;
};

/// `file` holds the designs in the formulation, and with the chord moments, to be asked for.
Answer answer_to(const PublishedFile& file, const PublishedTrend& statement, SolvedPoints& points);

/// A statement's number where it rests on operating points alone, not on a search along a quantity.
bool rests_on_points(const PublishedTrend& statement);
/// Of such a statement: its designs at their operating point, one or two, and the number from their metrics.
std::vector<Design<double>> designs_of(const PublishedFile& file, const PublishedTrend& statement);
double number_of(const PublishedTrend& statement, const Metrics<double>& one, const Metrics<double>& other);

/// What such a search looks at: the statement's metric at `x` along its quantity, of a crossing the ratio of two;
/// absent where it does not flap or leaves the domain.
double searched_metric(const PublishedFile& file, const PublishedTrend& statement, double x, SolvedPoints& points);
bool is_searched(const PublishedTrend& statement);

/// "outside the domain, residual 6.7 %" of such a share of the input; empty inside.
std::string residual_remark(double share);
/// Formulation residual over electrical input.
double residual_share(const Metrics<double>& metrics);

}  // namespace wingbeat
