#include "study/optimise_problem.hpp"

#include <span>

#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {
namespace {

/// Limits of the domain are kept by so much more, as a share: an optimum at one is inside at looser tolerances too.
constexpr double domain_margin = 1e-5;

}  // namespace

std::optional<Vector> OptimiseProblem::given() const {
  Vector u(size());
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    const auto x = parameters_[std::size_t(k)].value(study_.design);
    if (!x) return std::nullopt;
    u[k] = coordinate(k, *x);
  }
  if (!u.allFinite() || (u.array() < 0.0).any() || (u.array() > 1.0).any()) return std::nullopt;
  return u;
}

Design<double> OptimiseProblem::found(const Vector& u, const DesignPoint& point) const {
  Design<double> d = design(u);
  const std::optional<Hold>& hold = study_.options.hold;
  if (hold && !(hold->held == Held::frequency && set_drive_frequency(d, hold->value))) {
    set_voltage(d.supply, point.voltage);
  }
  return d;
}

OptimiseProblem::Evaluation OptimiseProblem::evaluate(const Vector& u, bool gradients) const {
  Evaluation e;
  std::span<const DesignParameter> wanted;
  if (gradients) wanted = parameters_;
  e.point = design_point(design(u), options_, wanted, start_up_);
  const Eigen::Index m = constraints();
  e.gradient = Vector::Zero(size());
  e.constraints = Vector::Constant(m, 1.0);
  e.jacobian = Eigen::MatrixXd::Zero(m, size());
  if (e.point.status != SweepStatus::flapping) return e;
  const auto row = [&](Metric metric, double factor) {
    Vector g = Vector::Zero(size());
    if (!gradients) return g;
    for (Eigen::Index k = 0; k < size(); ++k) {
      g[k] = factor * e.point.gradients[std::size_t(k)][std::size_t(metric)] * slope(k, u[k]);
    }
    return g;
  };
  const double sign = study_.maximise ? -1.0 : 1.0;
  e.objective = sign * e.point.metrics[study_.objective];
  e.gradient = row(study_.objective, sign);
  const Eigen::Index metrics = Eigen::Index(study_.constraints.size()), own = own_constraints();
  for (Eigen::Index c = 0; c < metrics; ++c) {
    const MetricConstraint& limit = study_.constraints[std::size_t(c)];
    const double factor = (limit.at_least ? -1.0 : 1.0) / (limit.limit == 0.0 ? 1.0 : std::abs(limit.limit));
    e.constraints[c] = factor * (e.point.metrics[limit.metric] - limit.limit);
    e.jacobian.row(c) = row(limit.metric, factor).transpose();
  }
  const std::vector<double> torque = excess_of(study_.gear_torque, e.point.gear_torque);
  for (Eigen::Index c = metrics; c < own; ++c) e.constraints[c] = torque[std::size_t(c - metrics)];
  for (Eigen::Index k = 0; gradients && metrics < own && k < size(); ++k) {
    const auto& slopes = e.point.gear_torque_slopes;
    const GearTorque by = std::size_t(k) < slopes.size() ? slopes[std::size_t(k)] : GearTorque{};
    Eigen::Index c = metrics;
    if (study_.gear_torque.continuous) e.jacobian(c++, k) = slope(k, u[k]) * by.rms / *study_.gear_torque.continuous;
    if (study_.gear_torque.peak) e.jacobian(c++, k) = slope(k, u[k]) * by.peak / *study_.gear_torque.peak;
  }
  for (Eigen::Index c = own; c < m; ++c) {
    const std::size_t limit = std::size_t(c - own);
    e.constraints[c] = e.point.domain_excess[limit] + domain_margin;
  }
  for (Eigen::Index k = 0; gradients && own < m && k < size(); ++k) {
    const DomainExcess by_vehicle = vehicle_slopes(u, k, e.point.metrics);
    for (Eigen::Index c = own; c < m; ++c) {
      const std::size_t limit = std::size_t(c - own);
      e.jacobian(c, k) = e.point.domain_slopes[std::size_t(k)][limit] * slope(k, u[k]) + by_vehicle[limit];
    }
  }
  e.flaps = std::isfinite(e.objective) && e.constraints.allFinite() && e.gradient.allFinite() && e.jacobian.allFinite();
  if (!e.flaps) e.objective = HUGE_VAL;
  return e;
}

DomainExcess OptimiseProblem::vehicle_slopes(const Vector& u, Eigen::Index k, const Metrics<double>& metrics) const {
  constexpr double step = 1e-5;
  Vector up = u, down = u;
  up[k] = std::min(1.0, u[k] + step);
  down[k] = std::max(0.0, u[k] - step);
  const auto excess = [&](const Vector& moved) {
    return domain_excess(resolve(with_any_pitch_coefficient(design(moved)), study_.options.condition), metrics);
  };
  DomainExcess slopes = excess(up);
  const DomainExcess below = excess(down);
  for (std::size_t l = 0; l < slopes.size(); ++l) slopes[l] = (slopes[l] - below[l]) / (up[k] - down[k]);
  return slopes;
}

}  // namespace wingbeat::detail
