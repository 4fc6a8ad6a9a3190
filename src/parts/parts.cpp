// Range checks and the coefficient table: the untemplated half of parts/.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/parts/blade_element.hpp"
#include "wingbeat/parts/piezo.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/parts/planform.hpp"
#include "wingbeat/parts/wing_torsion.hpp"

namespace wingbeat {

std::string range_message(const char* expected, const char* unit, double value) {
  std::string text = detail::format("%s [%s], got %.10g", expected, unit, value);
  if (!std::isfinite(value) || value == 0.0) return text;
  // As the vehicle file has them.
  if (std::string_view(unit) == "m") text += detail::format(" (%.10g mm)", 1e3 * value);
  if (std::string_view(unit) == "rad") text += detail::format(" (%.4g deg)", degrees_per_radian * value);
  return text;
}

void require(bool condition, const char* key, const char* expected, const char* unit, double value) {
  if (!condition || !std::isfinite(value)) throw ParameterError(key, range_message(expected, unit, value));
}

void require(const ParameterKey& key, double value) {
  require(key.range.holds(value), key.path, key.range.expected, key.unit, value);
}

void validate(const Planform<double>& p) {
  require(planform_key::scale, p.scale);
  if (p.shape == PlanformShape::moments) {
    require(planform_key::s2, p.s2);
    require(planform_key::s3, p.s3);
    if (p.s22) require(planform_key::s22, *p.s22);
    return;
  }
  require(planform_key::hub_offset, p.hub_offset);
  require(planform_key::shoulder_distance, p.shoulder_distance);
  if (p.shape == PlanformShape::tabulated) {
    if (p.chord_table.size() < 2) {
      throw ParameterError("wing.planform.file", "the chord table needs at least two rows");
    }
    for (std::size_t row = 0; row < p.chord_table.size(); ++row) {
      const auto [x, chord] = p.chord_table[row];
      const std::string where = "row " + std::to_string(row + 1) + " of the chord table";
      if (!(std::isfinite(x) && std::isfinite(chord) && x >= 0.0 && chord >= 0.0)) {
        throw ParameterError("wing.planform.file", where + " must hold a distance and a chord >= 0");
      }
      if (row > 0 && !(x > p.chord_table[row - 1].first)) {
        throw ParameterError("wing.planform.file", where + " must lie farther from the root than the row before it");
      }
    }
    return;
  }
  require(planform_key::length, p.length);
  if (p.chord_ratio) require(planform_key::chord_ratio, *p.chord_ratio);
  else require(planform_key::root_chord, p.root_chord);
}

void validate(const BladeElement<double>& w) {
  require(aerodynamics_key::air_density, w.air_density);
  require(aerodynamics_key::pitch_coefficient, w.pitch_coefficient);
  if (w.angle_of_attack_min != -std::numeric_limits<double>::infinity()) {
    require(aerodynamics_key::angle_of_attack_min, w.angle_of_attack_min);
  }
  require(planform_key::s2, w.s2);
  require(planform_key::s3, w.s3);
}

namespace {

/// Each strip of a wing is a wing: with the parts of I_psi and P that strip_sums() gives it, it takes at least
/// P_k^2 / I_k of J_w. What that leaves of the bound of P of a wing as a whole.
double mass_product_share(const PitchingWings<double>& w) {
  double product = 0.0, inertia = 0.0, least = 0.0;
  for (std::size_t k = 0; k < w.torsion.strips->position.size(); ++k) {
    const PitchChordMoments<double> strip = strip_of(w.torsion, k).moments;
    product += strip.s21;
    inertia += strip.s30;
    least += square(strip.s21) / strip.s30;
  }
  return product / std::sqrt(inertia * least);
}

}  // namespace

void validate(const PitchingWings<double>& w, double stroke_inertia) {
  validate(w.hinge);
  require(pitch_key::pitch_inertia, w.pitch_inertia);
  require(pitch_key::mass_product, w.mass_product);
  require(pitch_key::damping_coefficient, w.damping_coefficient);
  require(pitch_key::edge_suction, w.edge_suction);
  const double largest = std::sqrt(stroke_inertia * w.pitch_inertia);
  if (twists(w.torsion) && !(std::abs(w.mass_product) < largest * mass_product_share(w))) {
    throw ParameterError(
        pitch_key::mass_product.path,
        detail::format("no wing that twists has that much: with its mass spread as that of an even "
                       "membrane, |P| < %.4g sqrt(J_w I_psi), %.4g of %.4g kg m2 in all wings",
                       mass_product_share(w), largest * mass_product_share(w), std::abs(w.mass_product)));
  }
  if (!(std::abs(w.mass_product) < largest)) {
    throw ParameterError(pitch_key::mass_product.path,
                         detail::format("no wing has that much: its square must be below wing.inertia times "
                                        "wing.pitch_inertia, |P| < %.4g of %.4g kg m2 in all wings",
                                        largest, std::abs(w.mass_product)));
  }
}

namespace {

/// Second derivatives of the natural cubic spline through (x, y), by the tridiagonal (Thomas) algorithm.
std::vector<double> natural_spline_curvature(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> curvature(n, 0.0), upper(n, 0.0), right(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i];
    const double diagonal = 2.0 * (h0 + h1) - h0 * upper[i - 1];
    upper[i] = h1 / diagonal;
    right[i] = (6.0 * ((y[i + 1] - y[i]) / h1 - (y[i] - y[i - 1]) / h0) - h0 * right[i - 1]) / diagonal;
  }
  for (std::size_t i = n - 1; i-- > 1;) curvature[i] = right[i] - upper[i] * curvature[i + 1];
  return curvature;
}

std::vector<CoefficientTable::Cubic> spline_pieces(const std::vector<double>& x, const std::vector<double>& y) {
  const std::vector<double> m = natural_spline_curvature(x, y);
  std::vector<CoefficientTable::Cubic> pieces;
  pieces.push_back({x.front(), y.front(), 0.0, 0.0, 0.0});
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double h = x[i + 1] - x[i];
    pieces.push_back({x[i], y[i], (y[i + 1] - y[i]) / h - h * (2.0 * m[i] + m[i + 1]) / 6.0, m[i] / 2.0,
                      (m[i + 1] - m[i]) / (6.0 * h)});
  }
  pieces.push_back({x.back(), y.back(), 0.0, 0.0, 0.0});
  return pieces;
}

}  // namespace

CoefficientTable::CoefficientTable(std::vector<double> alpha, std::vector<double> lift, std::vector<double> drag)
    : alpha_(std::move(alpha)), lift_values_(std::move(lift)), drag_values_(std::move(drag)) {
  const char* key = "aerodynamics.coefficients";
  if (alpha_.size() < 3) throw ParameterError(key, "the coefficient table needs at least three rows");
  if (lift_values_.size() != alpha_.size() || drag_values_.size() != alpha_.size()) {
    throw ParameterError(key, "every row of the coefficient table needs an angle, a lift and a drag coefficient");
  }
  for (std::size_t row = 0; row < alpha_.size(); ++row) {
    const std::string where = "row " + std::to_string(row + 1) + " of the coefficient table";
    if (!(std::isfinite(alpha_[row]) && std::isfinite(lift_values_[row]) && std::isfinite(drag_values_[row]))) {
      throw ParameterError(key, where + " must hold three finite numbers");
    }
    if (row > 0 && !(alpha_[row] > alpha_[row - 1])) {
      throw ParameterError(key, where + " must have a larger angle of attack than the row before it");
    }
  }
  const auto lift_pieces = spline_pieces(alpha_, lift_values_), drag_pieces = spline_pieces(alpha_, drag_values_);
  for (std::size_t k = 0; k < lift_pieces.size(); ++k) {
    const Cubic &l = lift_pieces[k], &d = drag_pieces[k];
    rows_.push_back({l.x0, {l.a, l.b, l.c, l.d}, {d.a, d.b, d.c, d.d}});
  }
  knots_ = alpha_;
  knots_.push_back(std::numeric_limits<double>::quiet_NaN());  // none of which lies below anything
  // One knot in a bucket, unless some are very near each other.
  double least = alpha_.back() - alpha_.front();
  for (std::size_t k = 1; k < alpha_.size(); ++k) least = std::min(least, alpha_[k] - alpha_[k - 1]);
  first_.resize(std::size_t(std::min(std::ceil((alpha_.back() - alpha_.front()) / least) + 1.0, 512.0)), 0);
  const CoefficientLookup found = lookup();
  std::vector<int> in_bucket(first_.size(), 0);
  for (const double x : alpha_) {
    const double position = (x - found.front) * found.buckets_per_angle;
    ++in_bucket[std::size_t(std::min(position, double(first_.size() - 1)))];
  }
  for (std::size_t b = 1; b < first_.size(); ++b) first_[b] = first_[b - 1] + in_bucket[b - 1];
  max_in_bucket_ = *std::max_element(in_bucket.begin(), in_bucket.end());
  lay_steps();
}

/// Fills steps_ where a few hundred steps do.
void CoefficientTable::lay_steps() {
  constexpr double rounding = 1e-9;
  const double range = alpha_.back() - alpha_.front();
  const auto knots_on_edges = [&](int steps) {
    return std::all_of(alpha_.begin(), alpha_.end(), [&](double x) {
      const double position = (x - alpha_.front()) / range * steps;
      return std::abs(position - std::round(position)) < rounding * steps;
    });
  };
  int steps = int(alpha_.size()) - 1;
  while (steps <= 512 && !knots_on_edges(steps)) ++steps;
  if (steps > 512) return;
  const double width = range / steps;
  const auto from = [&](const std::array<double, 4>& c, double x) {
    return std::array{c[0] + x * (c[1] + x * (c[2] + x * c[3])), width * (c[1] + x * (2.0 * c[2] + x * 3.0 * c[3])),
                      width * width * (c[2] + x * 3.0 * c[3]), width * width * width * c[3]};
  };
  std::size_t row = 1;
  for (int n = 0; n < steps; ++n) {
    const double x = alpha_.front() + n * width;
    while (row + 1 < alpha_.size() && alpha_[row] < x + 0.5 * width) ++row;
    steps_.push_back({from(rows_[row].lift, x - rows_[row].x0), from(rows_[row].drag, x - rows_[row].x0)});
  }
}

CoefficientLookup CoefficientTable::lookup() const {
  return {knots_.data(),
          rows_.data(),
          first_.data(),
          int(first_.size()),
          max_in_bucket_,
          alpha_.front(),
          double(first_.size()) / (alpha_.back() - alpha_.front()),
          steps_.empty() ? nullptr : steps_.data(),
          int(steps_.size()),
          double(steps_.size()) / (alpha_.back() - alpha_.front())};
}

CoefficientTable::Cubic CoefficientTable::lift_piece(double alpha) const {
  const CoefficientLookup::Row& r = rows_[std::size_t(lookup().knots_up_to(alpha))];
  return {r.x0, r.lift[0], r.lift[1], r.lift[2], r.lift[3]};
}

CoefficientTable::Cubic CoefficientTable::drag_piece(double alpha) const {
  const CoefficientLookup::Row& r = rows_[std::size_t(lookup().knots_up_to(alpha))];
  return {r.x0, r.drag[0], r.drag[1], r.drag[2], r.drag[3]};
}

void validate(const Piezo<double>& p) {
  require(piezo_key::force_per_volt, p.force_per_volt);
  require(piezo_key::voltage_factor, p.voltage_factor);
  require(piezo_key::stiffness, p.stiffness);
  require(piezo_key::damping, p.damping);
  require(piezo_key::mass, p.mass);
  require(piezo_key::capacitance, p.capacitance);
  require(piezo_key::loss_tangent, p.loss_tangent);
  require(piezo_key::recovered_share, p.recovered_share);
  require(piezo_key::transmission_ratio, p.transmission_ratio);
  require(piezo_key::transmission_cubic, p.transmission_cubic);
  if (is_compliant(p)) require(piezo_key::series_stiffness, p.series_stiffness);
}

}  // namespace wingbeat
