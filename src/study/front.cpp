#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "wingbeat/study/pareto.hpp"

namespace wingbeat {
namespace {

/// Area that points dominate, added one by one.
class Area {
 public:
  Area(double x, double y) : x_(x), y_(y) {}

  void add(double x, double y) {
    if (!(x < x_ && y < y_)) return;
    const auto first = std::lower_bound(steps_.begin(), steps_.end(), std::pair(x, y));
    if (first != steps_.begin() && std::prev(first)->second <= y) return;
    auto end = first;
    while (end != steps_.end() && end->second >= y) ++end;
    // What lies between the staircase as it was and the new corner.
    double left = x, top = first == steps_.begin() ? y_ : std::prev(first)->second;
    for (auto step = first; step != end; ++step) {
      value_ += (step->first - left) * (top - y);
      left = step->first;
      top = step->second;
    }
    value_ += ((end == steps_.end() ? x_ : end->first) - left) * (top - y);
    steps_.insert(steps_.erase(first, end), {x, y});
  }
  double value() const { return value_; }

 private:
  double x_, y_, value_ = 0.0;
  std::vector<std::pair<double, double>> steps_;  ///< x ascending, y descending
};

/// Objectives from 0 (best of the front) to 1 (worst).
std::vector<ObjectivePoint> scaled(std::span<const ObjectivePoint> front) {
  std::vector<ObjectivePoint> result(front.begin(), front.end());
  for (std::size_t m = 0; m < front[0].size(); ++m) {
    const auto by = [m](const ObjectivePoint& a, const ObjectivePoint& b) { return a[m] < b[m]; };
    const auto [low, high] = std::minmax_element(front.begin(), front.end(), by);
    const double range = (*high)[m] - (*low)[m];
    for (std::size_t n = 0; n < front.size(); ++n) {
      result[n][m] = range > 0.0 ? (front[n][m] - (*low)[m]) / range : 0.0;
    }
  }
  return result;
}

double distance(const ObjectivePoint& a, const ObjectivePoint& b) {
  double sum = 0.0;
  for (std::size_t m = 0; m < a.size(); ++m) sum += (a[m] - b[m]) * (a[m] - b[m]);
  return std::sqrt(sum);
}

std::vector<std::size_t> evenly_along(const std::vector<ObjectivePoint>& points, std::size_t count) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return points[a] < points[b]; });
  std::vector<double> along(1, 0.0);
  for (std::size_t k = 1; k < order.size(); ++k) {
    along.push_back(along.back() + distance(points[order[k]], points[order[k - 1]]));
  }
  std::vector<std::size_t> picked;
  for (std::size_t p = 0; p < count; ++p) {
    const double wanted = count == 1 ? 0.5 * along.back() : along.back() * double(p) / double(count - 1);
    std::size_t best = 0;
    for (std::size_t k = 1; k < along.size(); ++k) {
      if (std::abs(along[k] - wanted) < std::abs(along[best] - wanted)) best = k;
    }
    if (std::find(picked.begin(), picked.end(), order[best]) == picked.end()) picked.push_back(order[best]);
  }
  return picked;
}

std::vector<std::size_t> evenly_over(const std::vector<ObjectivePoint>& points, const std::vector<std::size_t>& ends,
                                     std::size_t count) {
  std::vector<std::size_t> picked;
  std::vector<double> nearest(points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t p = 0; p < count; ++p) {
    const std::size_t next =
        p < ends.size() ? ends[p] : std::size_t(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    if (nearest[next] > 0.0) picked.push_back(next);
    for (std::size_t n = 0; n < points.size(); ++n)
      nearest[n] = std::min(nearest[n], distance(points[n], points[next]));
  }
  return picked;
}

}  // namespace

bool dominates(const ObjectivePoint& a, const ObjectivePoint& b) {
  bool better = false;
  for (std::size_t m = 0; m < a.size(); ++m) {
    if (a[m] > b[m]) return false;
    better = better || a[m] < b[m];
  }
  return better;
}

std::vector<std::size_t> nondominated(std::span<const ObjectivePoint> points) {
  // In lexicographic order a point can only be dominated by one before it.
  std::vector<std::size_t> order(points.size()), kept;
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return points[a] < points[b]; });
  for (const std::size_t n : order) {
    const bool beaten = std::any_of(kept.rbegin(), kept.rend(), [&](std::size_t k) {
      return points[k] == points[n] || dominates(points[k], points[n]);
    });
    if (!beaten) kept.push_back(n);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

double hypervolume(std::span<const ObjectivePoint> points, const ObjectivePoint& reference) {
  Area area(reference[0], reference[1]);
  if (reference.size() == 2) {
    for (const ObjectivePoint& p : points) area.add(p[0], p[1]);
    return area.value();
  }
  // Slices of growing third objective.
  std::vector<const ObjectivePoint*> order;
  for (const ObjectivePoint& p : points) {
    if (p[2] < reference[2]) order.push_back(&p);
  }
  std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) { return (*a)[2] < (*b)[2]; });
  double volume = 0.0;
  for (std::size_t n = 0; n < order.size(); ++n) {
    area.add((*order[n])[0], (*order[n])[1]);
    volume += area.value() * ((n + 1 < order.size() ? (*order[n + 1])[2] : reference[2]) - (*order[n])[2]);
  }
  return volume;
}

FrontPicks pick_designs(std::span<const ObjectivePoint> front, std::size_t count) {
  const std::vector<ObjectivePoint> points = scaled(front);
  FrontPicks picks;
  const std::size_t m = points[0].size();
  for (std::size_t k = 0; k < m; ++k) {
    const auto by = [k](const ObjectivePoint& a, const ObjectivePoint& b) {
      return a[k] != b[k] ? a[k] < b[k] : a < b;
    };
    picks.ends.push_back(std::size_t(std::min_element(points.begin(), points.end(), by) - points.begin()));
  }
  const auto sum = [](const ObjectivePoint& p) { return std::accumulate(p.begin(), p.end(), 0.0); };
  picks.knee = std::size_t(
      std::min_element(points.begin(), points.end(), [&](const auto& a, const auto& b) { return sum(a) < sum(b); }) -
      points.begin());
  picks.even = m == 2 ? evenly_along(points, count) : evenly_over(points, picks.ends, count);
  return picks;
}

}  // namespace wingbeat
