#include "reproduction/searched_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "wingbeat/files/design_parameter.hpp"

namespace wingbeat {
namespace {

using TrendKind = PublishedTrend::Kind;

constexpr double deviations_of_95 = 1.959963985;

/// The file with an uncertain parameter moved in all its designs that have it.
PublishedFile moved(PublishedFile file, const UncertainPublished& u, double deviations) {
  const DesignParameter parameter = design_parameter(u.key);
  for (auto& [name, design] : file.designs) {
    const std::optional<double> value = parameter.value(design);
    if (value && *value != 0.0) parameter.set(design, *value + deviations * u.relative_deviation * std::abs(*value));
  }
  return file;
}

/// What a statement searches for, as a condition on its place.
class PlaceSearch {
 public:
  PlaceSearch(const PublishedTrend& t, const Answer& answer, SolvedPoints& points)
      : t_(t), points_(points), place_(answer.place), inside_(answer.inside), step_(0.01 * (t.to - t.from)) {}

  /// Settles the place as stated; whether it has one that parameters move.
  bool settle(const PublishedFile& file) {
    if (!inside_) return t_.kind == TrendKind::peak && at_end();
    slope_ = (condition(file, place_ + step_) - condition(file, place_ - step_)) / (2.0 * step_);
    const double found = solved(file);
    if (!(std::abs(found - place_) < 2.0 * step_)) return false;
    place_ = found;
    return true;
  }

  double number(const PublishedFile& file) const {
    const double place = inside_ ? solved(file) : place_;
    if (t_.kind == TrendKind::peak) return searched_metric(file, t_, place, points_);
    return t_.kind == TrendKind::best_range ? place + 0.5 * width() : place;
  }

 private:
  bool at_end() const { return std::min(std::abs(place_ - t_.from), std::abs(place_ - t_.to)) < 0.1 * step_; }
  double width() const { return *t_.published_end - *t_.published; }

  double condition(const PublishedFile& file, double x) const {
    const auto metric_at = [&](double place) { return searched_metric(file, t_, place, points_); };
    switch (t_.kind) {
      case TrendKind::crossing: return metric_at(x) - 1.0;
      case TrendKind::best_range: return metric_at(x + width()) - metric_at(x);
      default: return metric_at(x + step_) - metric_at(x - step_);
    }
  }

  /// Secants from the place as stated; absent where they leave the window or do not settle.
  double solved(const PublishedFile& file) const {
    constexpr int max_iterations = 12;
    double x = place_, slope = slope_, value = condition(file, x);
    for (int n = 0; n < max_iterations; ++n) {
      const double next = x - value / slope;
      if (!(next >= t_.from && next <= t_.to)) return absent;
      if (std::abs(next - x) < 1e-3 * step_) return next;
      const double there = condition(file, next);
      slope = (there - value) / (next - x);
      x = next, value = there;
    }
    return absent;
  }

  const PublishedTrend& t_;
  SolvedPoints& points_;
  double place_, slope_ = absent;
  bool inside_;
  double step_;
};

}  // namespace

std::vector<Interval> propagated(const PublishedFile& file, const std::vector<double>& centre,
                                 const SearchedNumbers& numbers) {
  std::vector<double> squares(centre.size(), 0.0);
  for (const UncertainPublished& u : file.uncertain) {
    const std::vector<double> above = numbers(moved(file, u, 1.0)), below = numbers(moved(file, u, -1.0));
    for (std::size_t n = 0; n < centre.size(); ++n) squares[n] += std::pow(0.5 * (above[n] - below[n]), 2.0);
  }
  std::vector<Interval> intervals(centre.size());
  for (std::size_t n = 0; n < centre.size(); ++n) {
    const double half = deviations_of_95 * std::sqrt(squares[n]);
    if (half > 0.0) intervals[n] = {centre[n] - half, centre[n] + half};
  }
  return intervals;
}

Interval searched_interval(const PublishedFile& file, const PublishedTrend& t, const Answer& answer,
                           SolvedPoints& points) {
  if (!std::isfinite(answer.value) || file.uncertain.empty()) return {};
  if (!is_searched(t)) {
    return propagated(file, {answer.value}, [&](const PublishedFile& varied) {
      return std::vector<double>{answer_to(varied, t, points).value};
    })[0];
  }
  PlaceSearch search(t, answer, points);
  if (!search.settle(file)) return {};
  return propagated(file, {answer.value},
                    [&](const PublishedFile& varied) { return std::vector<double>{search.number(varied)}; })[0];
}

}  // namespace wingbeat
