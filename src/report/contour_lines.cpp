#include "report/contour_lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace wingbeat {
namespace {

/// Where the value at g.x[i], g.y[j] stands in g.z.
std::size_t index_of(const ContourGrid& g, int i, int j) { return std::size_t(i) * g.y.size() + std::size_t(j); }

}  // namespace

std::vector<Loop> boundaries(const ContourGrid& g, double level) {
  const int nx = int(g.x.size()), ny = int(g.y.size());
  // A frame around the grid, of no width, that lies outside the region.
  const auto inside = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < nx && j < ny && g.z[index_of(g, i, j)] >= level;
  };
  const auto between = [](double a, double b, double t, bool logarithmic) {
    return logarithmic ? a * std::pow(b / a, t) : a + t * (b - a);
  };
  const auto node = [&](int i, int j) {
    return ContourPoint{g.x[std::size_t(std::clamp(i, 0, nx - 1))], g.y[std::size_t(std::clamp(j, 0, ny - 1))]};
  };
  const auto value = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < nx && j < ny ? g.z[index_of(g, i, j)] : -std::numeric_limits<double>::infinity();
  };
  struct Edge {
    int i, j;  ///< its lower node
    bool along_x;
    auto operator<=>(const Edge&) const = default;
  };
  const auto crossing = [&](const Edge& e) {
    const int i = e.along_x ? e.i + 1 : e.i, j = e.along_x ? e.j : e.j + 1;
    const ContourPoint p = node(e.i, e.j), q = node(i, j);
    const double a = value(e.i, e.j), b = value(i, j);
    const double t = std::isinf(a) ? 1.0 : std::isinf(b) ? 0.0 : std::clamp((level - a) / (b - a), 0.0, 1.0);
    return ContourPoint{between(p.x, q.x, t, g.log_x), between(p.y, q.y, t, g.log_y)};
  };

  std::map<Edge, Edge> next;
  for (int i = -1; i < nx; ++i) {
    for (int j = -1; j < ny; ++j) {
      const bool corner[4] = {inside(i, j), inside(i + 1, j), inside(i + 1, j + 1), inside(i, j + 1)};
      const Edge edge[4] = {{i, j, true}, {i + 1, j, false}, {i, j + 1, true}, {i, j, false}};
      int leaving[2], entering[2], count = 0, entries = 0;
      for (int k = 0; k < 4; ++k) {
        if (corner[k] && !corner[(k + 1) % 4]) leaving[count++] = k;
        if (!corner[k] && corner[(k + 1) % 4]) entering[entries++] = k;
      }
      if (count == 1) next.emplace(edge[leaving[0]], edge[entering[0]]);
      if (count == 2) {
        const double middle = 0.25 * (value(i, j) + value(i + 1, j) + value(i + 1, j + 1) + value(i, j + 1));
        for (const int k : leaving) next.emplace(edge[k], edge[(k + (middle >= level ? 1 : 3)) % 4]);
      }
    }
  }
  std::vector<Loop> loops;
  while (!next.empty()) {
    Loop loop;
    for (auto found = next.begin(); found != next.end();) {
      const ContourPoint p = crossing(found->first);
      if (loop.empty() || p.x != loop.back().x || p.y != loop.back().y) loop.push_back(p);
      const Edge to = found->second;
      next.erase(found);
      found = next.find(to);
    }
    if (loop.size() > 2) loops.push_back(std::move(loop));
  }
  return loops;
}

void add_filled(Figure& figure, const std::string& name, const std::vector<Loop>& loops) {
  figure.add("${} << END\n", name);
  if (loops.empty()) figure.add("NaN NaN\n");
  for (const Loop& loop : loops) {
    for (const ContourPoint& p : loop) figure.add("{} {}\n", p.x, p.y);
    figure.add("{} {}\n{} {}\n", loop.front().x, loop.front().y, loops.front().front().x, loops.front().front().y);
  }
  figure.add("END\n");
}

void add_outline(Figure& figure, const std::string& name, const ContourGrid& g, const std::vector<Loop>& loops) {
  figure.add("${} << END\nNaN NaN\n", name);
  const auto on_edge = [&](const ContourPoint& p, const ContourPoint& q) {
    return (p.x == q.x && (p.x == g.x.front() || p.x == g.x.back())) ||
           (p.y == q.y && (p.y == g.y.front() || p.y == g.y.back()));
  };
  for (const Loop& loop : loops) {
    for (std::size_t n = 0; n < loop.size(); ++n) {
      const ContourPoint &p = loop[n], &q = loop[(n + 1) % loop.size()];
      if (on_edge(p, q)) figure.add("\n");
      else figure.add("{} {}\n{} {}\n", p.x, p.y, q.x, q.y);
    }
    figure.add("\n");
  }
  figure.add("END\n");
}

void extend(ContourGrid& g) {
  const int nx = int(g.x.size()), ny = int(g.y.size());
  std::vector<std::size_t> front;
  for (std::size_t n = 0; n < g.z.size(); ++n) {
    if (std::isfinite(g.z[n])) front.push_back(n);
  }
  for (std::size_t next = 0; next < front.size(); ++next) {
    const int i = int(front[next]) / ny, j = int(front[next]) % ny;
    for (const auto& [di, dj] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      if (i + di < 0 || j + dj < 0 || i + di >= nx || j + dj >= ny) continue;
      const std::size_t n = index_of(g, i + di, j + dj);
      if (std::isfinite(g.z[n])) continue;
      g.z[n] = g.z[front[next]];
      front.push_back(n);
    }
  }
}

void smooth(ContourGrid& g) {
  const int nx = int(g.x.size()), ny = int(g.y.size());
  const auto pass = [&](int di, int dj) {
    const std::vector<double> z = g.z;
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        const auto value_at = [&](int s) {
          return z[index_of(g, std::clamp(i + s * di, 0, nx - 1), std::clamp(j + s * dj, 0, ny - 1))];
        };
        g.z[index_of(g, i, j)] = 0.25 * value_at(-1) + 0.5 * value_at(0) + 0.25 * value_at(1);
      }
    }
  };
  pass(1, 0);
  pass(0, 1);
}

}  // namespace wingbeat
