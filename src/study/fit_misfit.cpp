#include "study/fit_misfit.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "study/fit_loss.hpp"

namespace wingbeat {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Residuals of values with stated deviations.
struct Residuals {
  double counted = 0.0, squares = 0.0, freedom = 0.0;
  int values = 0;
};

/// Chance of residuals as large, or nothing to compare.
double chance(Loss loss, const Residuals& r) {
  if (!(r.freedom > 1e-3)) return absent;
  const double information = counted_information(loss);
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(information * r.freedom),
                                                  std::min(information * r.counted, 1e300)));
}

std::optional<Misfit> misfit_of(Loss loss, const Residuals& r, const QuantityResiduals& worst) {
  if (!(chance(loss, r) < misfit_probability && r.counted > misfit_variance * r.freedom)) return std::nullopt;
  return Misfit{.worst = worst,
                .chi_square = r.counted,
                .freedom = r.freedom,
                .spread = std::sqrt(2.0 * r.freedom / counted_information(loss)),
                .rms_deviations = std::sqrt(r.squares / r.values)};
}

}  // namespace

void assess_misfit(const BenchFit& fit, const std::map<MeasuredQuantity, double>& freedom, FitResult& result) {
  std::map<MeasuredQuantity, std::vector<const FitPoint*>> by_quantity;
  for (const FitPoint& p : result.points) {
    if (std::isfinite(p.fitted)) by_quantity[fit.logs[p.log].columns[p.column]].push_back(&p);
  }
  Residuals all;
  std::optional<Misfit> of_column;
  const QuantityResiduals* worst = nullptr;
  result.quantities.clear();
  result.quantities.reserve(by_quantity.size());
  for (const auto& [quantity, points] : by_quantity) {
    QuantityResiduals q;
    q.quantity = quantity;
    q.values = int(points.size());
    q.estimated = fit.deviations.at(quantity).kind == Deviation::Kind::estimated;
    double weights = 0.0, squares = 0.0, counted = 0.0, raw = 0.0, size = 0.0, mean = 0.0, spread = 0.0;
    std::vector<double> ratios;
    for (const FitPoint* p : points) {
      squares += p->residual() * p->residual();
      counted += counted_square(fit.loss, p->residual());
      raw += p->weight * (p->measured - p->fitted) * (p->measured - p->fitted);
      size += p->weight * p->measured * p->measured;
      mean += p->weight * p->measured;
      weights += p->weight;
      ratios.push_back(p->fitted != 0.0 ? p->measured / p->fitted : absent);
    }
    mean /= weights;
    for (const FitPoint* p : points) spread += p->weight * (p->measured - mean) * (p->measured - mean);
    q.rms = std::sqrt(squares / double(points.size()));
    q.unexplained = spread > 0.0 ? raw / spread : absent;
    q.relative = size > 0.0 ? std::sqrt(raw / size) : absent;
    if (std::none_of(ratios.begin(), ratios.end(), [](double r) { return std::isnan(r); })) {
      q.measured_over_fitted = median(ratios);
    }
    result.quantities.push_back(q);
    if (q.estimated) {
      // At one operating point the spread is noise; its size then tells.
      const bool missed = q.unexplained > misfit_spread && q.relative > misfit_size;
      if (missed && !result.misfit) result.misfit = Misfit{.worst = q};
    } else {
      const Residuals own{counted, squares, freedom.at(quantity), q.values};
      all = {all.counted + counted, all.squares + squares, all.freedom + own.freedom, all.values + q.values};
      // A loss that bounds residuals lets the others outvote a column that is wrong as a whole.
      if (fit.loss != Loss::none && !of_column) of_column = misfit_of(fit.loss, own, q);
    }
  }
  for (const QuantityResiduals& q : result.quantities) {
    if (!q.estimated && (!worst || q.rms > worst->rms)) worst = &q;
  }
  if (!worst) return;
  result.p_value = chance(fit.loss, all);
  if (const auto found = misfit_of(fit.loss, all, *worst)) result.misfit = found;
  else if (of_column) result.misfit = of_column;
}

void withdraw_intervals(FitResult& result) {
  for (FittedParameter& p : result.parameters) {
    p.standard_error = p.lower_95 = p.upper_95 = p.profile_lower_95 = p.profile_upper_95 = absent;
    p.profile.clear();
  }
  for (auto* matrix : {&result.covariance, &result.correlation}) {
    for (auto& row : *matrix) std::fill(row.begin(), row.end(), absent);
  }
  result.directions.clear();
  result.findings.clear();
  for (ConditionShare& c : result.conditions) std::fill(c.error_without.begin(), c.error_without.end(), absent);
}

}  // namespace wingbeat
