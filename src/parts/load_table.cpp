#include "wingbeat/parts/load_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat {
namespace {

struct Column {
  const char* name;
  const char* unit;
};
constexpr std::array<Column, LoadTable::columns> named = {{{"stroke_angle", "rad"},
                                                           {"flapping_velocity", "rad/s"},
                                                           {"pitch_angle", "rad"},
                                                           {"pitch_velocity", "rad/s"},
                                                           {"lift", "N"},
                                                           {"stroke_moment", "N m"},
                                                           {"pitch_moment", "N m"}}};

[[noreturn]] void refuse(const std::string& reason) { throw ParameterError(load_table_key::file, reason); }

constexpr std::size_t velocity_column = std::size_t(LoadCoordinate::flapping_velocity);
constexpr std::size_t turn_column = std::size_t(LoadCoordinate::pitch_velocity);
constexpr std::size_t lift_column = load_coordinate_count, stroke_moment_column = lift_column + 1;
constexpr std::size_t pitch_moment_column = lift_column + 2;

/// A place of the grid in words: "flapping_velocity = 20 rad/s, pitch_angle = 0.5 rad".
std::string place_of(const std::vector<LoadTable::Axis>& axes, const LoadTable::Row& row) {
  std::string text;
  for (const LoadTable::Axis& axis : axes) {
    const auto k = std::size_t(axis.coordinate);
    text += detail::format("%s%s = %g %s", text.empty() ? "" : ", ", named[k].name, row[k], named[k].unit);
  }
  return text;
}

/// Rows whose numbers are finite, or absent in all of a column.
void check_numbers(const std::vector<LoadTable::Row>& rows) {
  for (std::size_t k = 0; k < LoadTable::columns; ++k) {
    const bool given = !std::isnan(rows.front()[k]);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      if (std::isnan(rows[n][k]) != given && (std::isfinite(rows[n][k]) || !given)) continue;
      refuse(detail::format("row %zu of the load table must hold a finite %s", n + 1, named[k].name));
    }
  }
}

/// The mirror image of each row, with which both half-strokes are alike.
std::vector<LoadTable::Row> with_mirror_images(std::vector<LoadTable::Row> rows) {
  const std::size_t count = rows.size();
  for (std::size_t n = 0; n < count; ++n) {
    LoadTable::Row image = rows[n];
    for (std::size_t k = velocity_column; k < LoadTable::columns; ++k) {
      if (k != lift_column && image[k] != 0.0) image[k] = -image[k];
    }
    rows.push_back(image);
  }
  return rows;
}

/// Slopes at the knots of a line, limited to be monotone where the values are.
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> secant(n - 1), slope(n);
  for (std::size_t k = 0; k + 1 < n; ++k) secant[k] = (y[k + 1] - y[k]) / (x[k + 1] - x[k]);
  if (n == 2) return {secant[0], secant[0]};
  const auto limited = [](double d, double before, double after) {
    if (!(before * after > 0.0)) return 0.0;
    const double limit = 3.0 * std::min(std::abs(before), std::abs(after));
    return std::clamp(d, -limit, limit);
  };
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double h0 = x[k] - x[k - 1], h1 = x[k + 1] - x[k];
    slope[k] = limited((h1 * secant[k - 1] + h0 * secant[k]) / (h0 + h1), secant[k - 1], secant[k]);
  }
  const auto at_end = [](double h0, double h1, double nearest, double next) {
    const double d = ((2.0 * h0 + h1) * nearest - h0 * next) / (h0 + h1);
    if (!(d * nearest > 0.0)) return 0.0;
    return nearest * next <= 0.0 && std::abs(d) > 3.0 * std::abs(nearest) ? 3.0 * nearest : d;
  };
  slope[0] = at_end(x[1] - x[0], x[2] - x[1], secant[0], secant[1]);
  slope[n - 1] = at_end(x[n - 1] - x[n - 2], x[n - 2] - x[n - 3], secant[n - 2], secant[n - 3]);
  return slope;
}

}  // namespace

LoadTable::LoadTable(const std::vector<Row>& stated) {
  if (stated.empty()) refuse("the load table has no rows");
  check_numbers(stated);
  for (const std::size_t k : {velocity_column, lift_column, stroke_moment_column}) {
    if (std::isnan(stated.front()[k])) refuse(detail::format("the load table needs a column %s", named[k].name));
  }
  has_pitch_moment_ = !std::isnan(stated.front()[pitch_moment_column]);
  std::vector<Row> rows = stated;
  for (Row& row : rows) {
    for (double& x : row) x = std::isnan(x) ? 0.0 : x + 0.0;  // no negative zero
  }
  const auto values_of = [&](std::size_t k) {
    std::vector<double> values;
    for (const Row& row : rows) values.push_back(row[k]);
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
  };
  const bool mirrored = values_of(velocity_column).front() >= 0.0;
  if (mirrored) {
    if (values_of(std::size_t(LoadCoordinate::stroke_angle)).size() > 1) {
      refuse(
          "the load table depends on the stroke angle: it needs rows of both half-strokes, with flapping velocities "
          "of both signs");
    }
    for (const LoadCoordinate c : {LoadCoordinate::pitch_angle, LoadCoordinate::pitch_velocity}) {
      const std::vector<double> values = values_of(std::size_t(c));
      for (std::size_t k = 0; k < values.size(); ++k) {
        if (values[k] == -values[values.size() - 1 - k]) continue;
        refuse(
            detail::format("the load table has flapping velocities of one sign, so that the other half-stroke is its "
                           "mirror image: %s must then be the same to either side of 0, got %g to %g %s",
                           named[std::size_t(c)].name, values.front(), values.back(), named[std::size_t(c)].unit));
      }
    }
    rows = with_mirror_images(std::move(rows));
  }

  std::size_t nodes = 1;
  for (std::size_t k = load_coordinate_count; k-- > 0;) {
    std::vector<double> values = values_of(k);
    if (values.size() < 2) continue;
    axes_.insert(axes_.begin(), {LoadCoordinate(k), values, nodes});
    nodes *= values.size();
    if (nodes > 10 * rows.size() + 100)
      refuse(
          "the rows of the load table are no grid: each value of a coordinate must "
          "stand with each value of the others");
  }
  if (!axis(LoadCoordinate::flapping_velocity)) refuse("the load table needs more than one flapping_velocity");
  for (const Axis& a : axes_) {
    if (a.coordinate != LoadCoordinate::flapping_velocity && a.coordinate != LoadCoordinate::pitch_velocity) continue;
    if (std::binary_search(a.knots.begin(), a.knots.end(), 0.0)) continue;
    refuse(detail::format("the load table needs rows at a %s of 0", named[std::size_t(a.coordinate)].name));
  }

  // A node at rest between its mirror images takes the mean of both.
  std::vector<int> rows_at(nodes, 0);
  values_.assign(nodes << axes_.size(), {});
  for (std::size_t n = 0; n < rows.size(); ++n) {
    std::size_t node = 0;
    for (const Axis& a : axes_) {
      const double x = rows[n][std::size_t(a.coordinate)];
      node += a.stride * std::size_t(std::lower_bound(a.knots.begin(), a.knots.end(), x) - a.knots.begin());
    }
    const int allowed = mirrored && rows[n][velocity_column] == 0.0 ? 2 : 1;
    if (++rows_at[node] > allowed) {
      refuse(detail::format("row %zu of the load table gives %s again", n % stated.size() + 1,
                            place_of(axes_, rows[n]).c_str()));
    }
    for (std::size_t q = 0; q < table_load_count; ++q) {
      values_[node << axes_.size()][q] += rows[n][lift_column + q] / allowed;
    }
  }
  const std::vector<Row> grid = this->rows();
  for (std::size_t node = 0; node < nodes; ++node) {
    const int wanted = mirrored && grid[node][velocity_column] == 0.0 ? 2 : 1;
    if (rows_at[node] != wanted) refuse("the load table has no row at " + place_of(axes_, grid[node]));
  }
  check_rest();
  find_slopes();
}

const LoadTable::Axis* LoadTable::axis(LoadCoordinate coordinate) const {
  const auto found =
      std::find_if(axes_.begin(), axes_.end(), [&](const Axis& a) { return a.coordinate == coordinate; });
  return found == axes_.end() ? nullptr : &*found;
}

std::vector<LoadTable::Row> LoadTable::rows() const {
  std::vector<Row> rows(values_.size() >> axes_.size(), Row{});
  for (std::size_t node = 0; node < rows.size(); ++node) {
    for (const Axis& a : axes_) rows[node][std::size_t(a.coordinate)] = a.knots[node / a.stride % a.knots.size()];
    for (std::size_t q = 0; q < table_load_count; ++q) {
      rows[node][lift_column + q] = values_[node << axes_.size()][q];
    }
  }
  return rows;
}

/// Wings at rest in still air have no loads.
void LoadTable::check_rest() const {
  constexpr double rounding = 1e-6;
  const std::vector<Row> grid = rows();
  for (std::size_t q = lift_column; q < columns; ++q) {
    double largest = 0.0;
    for (const Row& row : grid) largest = std::max(largest, std::abs(row[q]));
    for (const Row& row : grid) {
      const bool rests = row[velocity_column] == 0.0 && row[turn_column] == 0.0;
      if (!rests || std::abs(row[q]) <= rounding * largest) continue;
      refuse(detail::format("the load table has a %s of %g %s for wings at rest, at %s; loads of still air are 0 there",
                            named[q].name, row[q], named[q].unit, place_of(axes_, row).c_str()));
    }
  }
}

/// Derivatives along each axis, of the values and of the derivatives along the axes before it.
void LoadTable::find_slopes() {
  const std::size_t nodes = values_.size() >> axes_.size();
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const Axis& a = axes_[k];
    std::vector<double> line(a.knots.size());
    for (std::size_t node = 0; node < nodes; ++node) {
      if (node / a.stride % a.knots.size() != 0) continue;
      for (std::size_t along = 0; along < (std::size_t(1) << k); ++along) {
        for (std::size_t q = 0; q < table_load_count; ++q) {
          const auto place = [&](std::size_t n) { return (node + n * a.stride) << axes_.size(); };
          for (std::size_t n = 0; n < line.size(); ++n) line[n] = values_[place(n) + along][q];
          const std::vector<double> slopes = monotone_slopes(a.knots, line);
          for (std::size_t n = 0; n < line.size(); ++n) {
            values_[place(n) + (along | (std::size_t(1) << k))][q] = slopes[n];
          }
        }
      }
    }
  }
}

}  // namespace wingbeat
