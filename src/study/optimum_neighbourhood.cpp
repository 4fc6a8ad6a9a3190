#include "study/optimum_neighbourhood.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/text.hpp"
#include "wingbeat/solve/singular_values.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {
namespace {

constexpr double active_within = 1e-4;  ///< of a constraint, relative to its limit
constexpr double at_bound = 1e-6;       ///< of the range

}  // namespace

Neighbourhood::Neighbourhood(const OptimiseProblem& problem, const Vector& best, const ForEach& for_each,
                             int& evaluations)
    : problem_(problem), best_(best), for_each_(for_each), evaluations_(evaluations), at_(problem.evaluate(best)) {
  const Eigen::Index n = problem.size();
  for (Eigen::Index c = 0; c < at_.constraints.size(); ++c) {
    if (at_.constraints[c] > -active_within) constraints_.push_back(c);
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    // At a bound that the objective pushes against; where it does not care the direction is free.
    if (best_[k] < at_bound || best_[k] > 1.0 - at_bound) bounds_.push_back(k);
  }
  find_multipliers();
}

std::vector<ActiveLimit> Neighbourhood::active() const {
  const OptimiseStudy& study = problem_.study();
  std::vector<ActiveLimit> result;
  const double f = std::abs(at_.objective);
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    if (constraints_[i] >= problem_.own_constraints()) {
      const DomainLimit limit = DomainLimit(constraints_[i] - problem_.own_constraints());
      const bool from_zero = limit == DomainLimit::angle_of_attack;
      result.push_back({"domain: " + bound_of(limit, resolve(with_any_pitch_coefficient(problem_.design(best_)),
                                                             study.options.condition)),
                        from_zero ? absent : multipliers_[Eigen::Index(i)] / f, true});
      continue;
    }
    if (std::size_t(constraints_[i]) >= study.constraints.size()) {
      const std::size_t torque = std::size_t(constraints_[i]) - study.constraints.size();
      result.push_back({limit_names(study.gear_torque)[torque], multipliers_[Eigen::Index(i)] / f, false});
      continue;
    }
    const MetricConstraint& c = study.constraints[std::size_t(constraints_[i])];
    result.push_back({name_of(c), c.limit == 0.0 ? absent : multipliers_[Eigen::Index(i)] / f, false});
  }
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    const OptimisedParameter& p = study.parameters[std::size_t(bounds_[i])];
    const bool low = best_[bounds_[i]] < 0.5;
    const double x = low ? p.lower : p.upper;
    const double multiplier = multipliers_[Eigen::Index(constraints_.size() + i)];
    const double relative = multiplier * std::abs(x) / problem_.slope(bounds_[i], best_[bounds_[i]]) / f;
    result.push_back({p.parameter.key + (low ? " >= " : " <= ") + format("%.6g", x) +
                          (p.parameter.unit == "1" ? "" : " " + p.parameter.unit),
                      x == 0.0 ? absent : relative, false});
  }
  return result;
}

std::vector<FlatDirection> Neighbourhood::directions() {
  const Eigen::Index n = problem_.size();
  Eigen::MatrixXd normals(n, Eigen::Index(constraints_.size() + bounds_.size()));
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    normals.col(Eigen::Index(i)) = at_.jacobian.row(constraints_[i]).transpose();
  }
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    normals.col(Eigen::Index(constraints_.size() + i)) = Vector::Unit(n, bounds_[i]);
  }
  Eigen::MatrixXd free = Eigen::MatrixXd::Identity(n, n);
  if (normals.cols() > 0) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(normals);
    const Eigen::MatrixXd q = qr.householderQ();
    free = q.rightCols(n - qr.rank());
  }
  if (free.cols() == 0) return {};
  const Eigen::MatrixXd h = free.transpose() * hessian() * free / std::abs(at_.objective);
  const solver::SymmetricModes eigen = solver::symmetric_modes(0.5 * (h + h.transpose()));
  std::vector<Walk> walks(2 * std::size_t(free.cols()));
  for_all(for_each_, walks.size(), [&](std::size_t w) {
    const Vector direction = free * eigen.vectors.col(Eigen::Index(w / 2));
    walks[w] = w % 2 == 0 ? farthest(direction, 1.0) : farthest(-direction, -1.0);
  });
  std::vector<FlatDirection> result;
  for (Eigen::Index k = 0; k < free.cols(); ++k) {
    const Walk& up = walks[2 * std::size_t(k)];
    const Walk& down = walks[2 * std::size_t(k) + 1];
    evaluations_ += up.evaluations + down.evaluations;
    FlatDirection flat;
    flat.curvature = eigen.values[k];
    std::vector<FlatDirection::Step> beyond = up.steps;
    beyond.insert(beyond.end(), down.steps.begin(), down.steps.end());
    beyond.push_back({0.0, values(best_), problem_.study().maximise ? -at_.objective : at_.objective});
    std::sort(beyond.begin(), beyond.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
    flat.walk = std::move(beyond);
    for (Eigen::Index j = 0; j < n; ++j) {
      flat.from.push_back(problem_.value(j, down.end[j]));
      flat.to.push_back(problem_.value(j, up.end[j]));
    }
    flat.width = (up.end - down.end).lpNorm<Eigen::Infinity>();
    flat.flat = up.by_bound || down.by_bound || flat.width > 0.5;
    result.push_back(std::move(flat));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const FlatDirection& a, const FlatDirection& b) { return a.width > b.width; });
  return result;
}

void Neighbourhood::find_multipliers() {
  const Eigen::Index n = problem_.size();
  while (true) {
    Eigen::MatrixXd a(n, Eigen::Index(constraints_.size() + bounds_.size()));
    for (std::size_t i = 0; i < constraints_.size(); ++i) {
      a.col(Eigen::Index(i)) = at_.jacobian.row(constraints_[i]).transpose();
    }
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      const double outward = best_[bounds_[i]] < 0.5 ? -1.0 : 1.0;
      a.col(Eigen::Index(constraints_.size() + i)) = outward * Vector::Unit(n, bounds_[i]);
    }
    if (a.cols() == 0) {
      multipliers_.resize(0);
      return;
    }
    multipliers_ = a.colPivHouseholderQr().solve(-at_.gradient);
    // A limit that is touched but does not push back does not hold the optimum.
    Eigen::Index idle = 0;
    if (multipliers_.minCoeff(&idle) > 1e-9 * std::abs(at_.objective)) return;
    if (std::size_t(idle) < constraints_.size()) constraints_.erase(constraints_.begin() + idle);
    else bounds_.erase(bounds_.begin() + (idle - Eigen::Index(constraints_.size())));
  }
}

Eigen::MatrixXd Neighbourhood::hessian() {
  const Eigen::Index n = problem_.size();
  const auto slope = [&](const Vector& u) {
    const OptimiseProblem::Evaluation e = problem_.evaluate(u);
    Vector g = e.gradient;
    for (std::size_t i = 0; i < constraints_.size(); ++i) {
      g += multipliers_[Eigen::Index(i)] * e.jacobian.row(constraints_[i]).transpose();
    }
    return e.flaps ? g : Vector(Vector::Constant(n, absent));
  };
  constexpr double step = 1e-3;
  std::vector<Vector> slopes(2 * std::size_t(n));
  const auto beside = [&](std::size_t side) {
    const Eigen::Index k = Eigen::Index(side / 2);
    Vector u = best_;
    u[k] = side % 2 == 0 ? std::min(1.0, best_[k] + step) : std::max(0.0, best_[k] - step);
    return u;
  };
  for_all(for_each_, slopes.size(), [&](std::size_t side) { slopes[side] = slope(beside(side)); });
  evaluations_ += int(slopes.size());
  Eigen::MatrixXd h(n, n);
  for (std::size_t k = 0; k < std::size_t(n); ++k) {
    const double apart = (beside(2 * k) - beside(2 * k + 1))[Eigen::Index(k)];
    h.col(Eigen::Index(k)) = (slopes[2 * k] - slopes[2 * k + 1]) / apart;
  }
  // Beside designs that do not flap the curvature is unknown: taken as none, the walk below measures.
  return h.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
}

std::vector<double> Neighbourhood::values(const Vector& u) const {
  std::vector<double> x;
  for (Eigen::Index k = 0; k < u.size(); ++k) x.push_back(problem_.value(k, u[k]));
  return x;
}

std::optional<Vector> Neighbourhood::moved(const Vector& direction, double distance, double sign, Walk& walk) const {
  Vector u = best_ + distance * direction;
  if (u.minCoeff() < -1e-9 || u.maxCoeff() > 1.0 + 1e-9) return std::nullopt;
  u = u.cwiseMax(0.0).cwiseMin(1.0);
  for (int iteration = 0; iteration < 4; ++iteration) {
    const OptimiseProblem::Evaluation e = problem_.evaluate(u, !constraints_.empty());
    ++walk.evaluations;
    if (e.point.status != SweepStatus::flapping) return std::nullopt;
    Vector residual(Eigen::Index(constraints_.size()));
    Eigen::MatrixXd a(Eigen::Index(constraints_.size()), problem_.size());
    for (std::size_t i = 0; i < constraints_.size(); ++i) {
      residual[Eigen::Index(i)] = e.constraints[constraints_[i]];
      a.row(Eigen::Index(i)) = e.jacobian.row(constraints_[i]);
    }
    for (const Eigen::Index k : bounds_) a.col(k).setZero();
    const bool on = residual.size() == 0 || residual.lpNorm<Eigen::Infinity>() < 1e-6;
    if (on) {
      const bool worse = e.objective - at_.objective > flat_loss * std::abs(at_.objective);
      if (worse || e.violation() > active_within) return std::nullopt;
      walk.steps.push_back({sign * distance, values(u), problem_.study().maximise ? -e.objective : e.objective});
      return u;
    }
    u -= a.completeOrthogonalDecomposition().solve(residual);
    if (!(u.minCoeff() > -1e-9 && u.maxCoeff() < 1.0 + 1e-9)) return std::nullopt;
    u = u.cwiseMax(0.0).cwiseMin(1.0);
  }
  return std::nullopt;
}

Neighbourhood::Walk Neighbourhood::farthest(const Vector& direction, double sign) const {
  Walk walk;
  walk.end = best_;
  double room = HUGE_VAL;
  for (Eigen::Index k = 0; k < problem_.size(); ++k) {
    if (std::abs(direction[k]) < 1e-9) continue;
    room = std::min(room, ((direction[k] > 0.0 ? 1.0 : 0.0) - best_[k]) / direction[k]);
  }
  if (!(room > 1e-6)) return walk;
  if (const auto end = moved(direction, room, sign, walk)) {
    walk.end = *end;
    walk.by_bound = true;
    return walk;
  }
  // Doubling first: the end may be very near, and what lies beyond a first failure does not count.
  double good = 0.0, bad = room;
  for (double t = std::min(1e-3, 0.5 * room); t < room; t *= 2.0) {
    const auto u = moved(direction, t, sign, walk);
    if (!u) {
      bad = t;
      break;
    }
    good = t;
    walk.end = *u;
  }
  for (int k = 0; k < 8; ++k) {
    const double t = 0.5 * (good + bad);
    if (const auto u = moved(direction, t, sign, walk)) {
      good = t;
      walk.end = *u;
    } else {
      bad = t;
    }
  }
  return walk;
}

}  // namespace wingbeat::detail
