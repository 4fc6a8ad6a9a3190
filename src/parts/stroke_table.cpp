#include "wingbeat/parts/stroke_table.hpp"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>

#include "wingbeat/core/root.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {
namespace {

constexpr const char* key = "transmission.stroke_table";

void check(const std::vector<std::pair<double, double>>& rows) {
  if (rows.size() < 4) throw ParameterError(key, "needs at least four rows");
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto [theta, beta] = rows[row];
    const std::string where = "row " + std::to_string(row + 1) + " of the stroke table";
    if (!(std::isfinite(theta) && std::isfinite(beta))) {
      throw ParameterError(key, where + " must hold a crank angle and a stroke angle");
    }
    if (row > 0 && !(theta > rows[row - 1].first)) {
      throw ParameterError(key, where + " must have a larger crank angle than the row before it");
    }
    if (!(theta - rows.front().first < two_pi * (1.0 - 1e-12))) {
      throw ParameterError(key, where + " is a full turn after the first: the table is periodic, leave it out");
    }
  }
}

/// First and second derivatives at row n: unknowns 2 n and 2 n + 1 of the conditions that the third and the fourth
/// derivative of the pieces before and after a row agree.
Eigen::VectorXd derivatives(const std::vector<double>& h, const std::vector<double>& y) {
  const std::size_t n = y.size();
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * Eigen::Index(n));
  // Third and fourth derivative of the quintic from y0, m0, M0 to y1, m1, M1 over h, at its start (with `sign` 1) and,
  // mirrored, at its end.
  const auto add = [&](std::size_t row, std::size_t from, std::size_t to, double width, double sign) {
    const double rise = y[to] - y[from], h2 = width * width, h3 = h2 * width, h4 = h3 * width;
    const auto enter = [&](std::size_t condition, std::size_t unknown, double value) {
      entries.emplace_back(int(2 * row + condition), int(unknown), value);
    };
    // Seen from the end, t runs backwards: odd derivatives change their sign.
    enter(0, 2 * from, -sign * 36.0 / h2), enter(0, 2 * to, -sign * 24.0 / h2);
    enter(0, 2 * from + 1, -9.0 / width), enter(0, 2 * to + 1, 3.0 / width);
    right[Eigen::Index(2 * row)] -= 60.0 * rise / h3;
    enter(1, 2 * from, 192.0 / h3), enter(1, 2 * to, 168.0 / h3);
    enter(1, 2 * from + 1, sign * 36.0 / h2), enter(1, 2 * to + 1, -sign * 24.0 / h2);
    right[Eigen::Index(2 * row) + 1] += 360.0 * rise * sign / h4;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n, after = (i + 1) % n;
    add(i, i, after, h[i], 1.0);
    add(i, i, before, h[before], -1.0);
  }
  Eigen::SparseMatrix<double> matrix(2 * Eigen::Index(n), 2 * Eigen::Index(n));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SparseLU<Eigen::SparseMatrix<double>>(matrix).solve(right);
}

double slope_at(const StrokeCurve::Piece& p, double t) {
  double slope = 0.0;
  for (std::size_t n = 5; n > 0; --n) slope = slope * t + double(n) * p.coefficient[n];
  return slope;
}

/// Where the slope changes sign on [0, h], from its signs at nine points; at the end it is that of the next piece, so
/// that both agree at a row. Zeros count with what was before them; `sign` is that before 0, and becomes that at h.
std::vector<double> turns_of(const StrokeCurve::Piece& p, double h, double at_end, double& sign) {
  constexpr int parts = 8;
  std::vector<double> turns;
  for (int n = 1; n <= parts; ++n) {
    const double value = n < parts ? slope_at(p, h * n / parts) : at_end;
    if (value == 0.0 || sign_of(value) == sign) continue;
    const auto turned_not = [&](double t) { return sign_of(slope_at(p, t)) == sign; };
    turns.push_back(bisect(turned_not, h * (n - 1) / parts, h * n / parts).after);
    sign = sign_of(value);
  }
  return turns;
}

}  // namespace

StrokeCurve::StrokeCurve(std::vector<std::pair<double, double>> rows) : rows_(std::move(rows)) {
  check(rows_);
  const std::size_t n = rows_.size();
  std::vector<double> h(n), y(n);
  for (std::size_t i = 0; i < n; ++i) {
    h[i] = (i + 1 < n ? rows_[i + 1].first : rows_.front().first + two_pi) - rows_[i].first;
    y[i] = rows_[i].second;
  }
  const Eigen::VectorXd d = derivatives(h, y);
  high_ = *std::max_element(y.begin(), y.end());
  low_ = *std::min_element(y.begin(), y.end());
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    const double w = h[i], rise = y[j] - y[i];
    const double m0 = d[Eigen::Index(2 * i)], m1 = d[Eigen::Index(2 * j)];
    const double M0 = d[Eigen::Index(2 * i + 1)], M1 = d[Eigen::Index(2 * j + 1)];
    pieces_.push_back(
        {rows_[i].first - rows_.front().first,
         {y[i], m0, 0.5 * M0, (20.0 * rise - (8.0 * m1 + 12.0 * m0) * w - (3.0 * M0 - M1) * w * w) / (2.0 * w * w * w),
          (-30.0 * rise + (14.0 * m1 + 16.0 * m0) * w + (3.0 * M0 - 2.0 * M1) * w * w) / (2.0 * w * w * w * w),
          (12.0 * rise - 6.0 * (m1 + m0) * w - (M0 - M1) * w * w) / (2.0 * w * w * w * w * w)}});
  }
  std::vector<double> turning;
  const double first_slope = pieces_.front().coefficient[1];
  double sign = sign_of(first_slope != 0.0 ? first_slope : slope_at(pieces_.back(), 0.9 * h.back()));
  for (std::size_t i = 0; i < n; ++i) {
    const Piece& p = pieces_[i];
    for (const double t : turns_of(p, h[i], pieces_[(i + 1) % n].coefficient[1], sign)) {
      double beta = 0.0;
      for (std::size_t k = 6; k-- > 0;) beta = beta * t + p.coefficient[k];
      high_ = std::max(high_, beta);
      low_ = std::min(low_, beta);
      turning.push_back(wrap_angle(rows_[i].first + t));
    }
  }
  if (!(high_ > low_)) throw ParameterError(key, "the stroke angle must vary over the turn");
  std::sort(turning.begin(), turning.end());
  // A reversal at crank angle 0 itself is not listed.
  constexpr double zero = 1e-9;
  std::erase_if(turning, [](double angle) { return angle < zero || angle > two_pi - zero; });
  if (turning.size() > Reversals::max_count) {
    throw ParameterError(key, "the stroke turns " + std::to_string(turning.size()) +
                                  " times in a turn of the crank, at most " + std::to_string(Reversals::max_count) +
                                  " are allowed: smooth the table");
  }
  std::copy(turning.begin(), turning.end(), reversals_.angle.begin());
  reversals_.count = turning.size();
  const double before = position(0.5 * (turning.empty() ? two_pi : turning.front()));
  reversals_.first_sign = sign_of(slope_at(piece(before), before - piece(before).x0));
}

const StrokeCurve::Piece& StrokeCurve::piece(double position) const {
  const auto after =
      std::upper_bound(pieces_.begin() + 1, pieces_.end(), position, [](double x, const Piece& p) { return x < p.x0; });
  return *(after - 1);
}

void validate(const StrokeTable<double>& t) {
  if (!t.curve) throw ParameterError(key, "is missing");
  require(stroke_table_key::scale, t.scale);
  require(stroke_table_key::reference_radius, t.reference_radius);
}

}  // namespace wingbeat
