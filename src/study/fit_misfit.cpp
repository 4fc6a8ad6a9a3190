#include "study/fit_misfit.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace wingbeat {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void assess_misfit(const BenchFit& fit, int fitted_count, FitResult& result) {
  std::map<MeasuredQuantity, std::vector<const FitPoint*>> by_quantity;
  std::size_t reached = 0;
  for (const FitPoint& p : result.points) {
    if (!std::isfinite(p.fitted)) continue;
    by_quantity[fit.logs[p.log].columns[p.column]].push_back(&p);
    ++reached;
  }
  double chi_square = 0.0;
  std::size_t stated = 0;
  const QuantityResiduals* worst = nullptr;
  result.quantities.clear();
  result.quantities.reserve(by_quantity.size());
  for (const auto& [quantity, points] : by_quantity) {
    QuantityResiduals q;
    q.quantity = quantity;
    q.values = int(points.size());
    q.estimated = fit.deviations.at(quantity).kind == Deviation::Kind::estimated;
    double weights = 0.0, squares = 0.0, raw = 0.0, size = 0.0, mean = 0.0, spread = 0.0;
    std::vector<double> ratios;
    for (const FitPoint* p : points) {
      squares += p->weight * p->residual() * p->residual();
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
      chi_square += squares;
      stated += points.size();
    }
  }
  for (const QuantityResiduals& q : result.quantities) {
    if (!q.estimated && (!worst || q.rms > worst->rms)) worst = &q;
  }
  // The parameters fit all values; their share of those with stated deviations counts here.
  const double freedom =
      double(stated) - double(fitted_count) * double(stated) / double(std::max<std::size_t>(reached, 1));
  if (!worst || !(freedom > 0.0)) return;
  result.p_value =
      boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), std::min(chi_square, 1e300)));
  if (result.p_value < misfit_probability && chi_square > misfit_variance * freedom) {
    result.misfit = Misfit{.worst = *worst,
                           .chi_square = chi_square,
                           .freedom = freedom,
                           .rms_deviations = std::sqrt(chi_square / double(stated))};
  }
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
