#include "wingbeat/study/optimise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <nlopt.hpp>
#include <sstream>

namespace wingbeat {
namespace {

using Vector = Eigen::VectorXd;

constexpr double feasible_to = 1e-6;  ///< of a constraint, relative to its limit
constexpr double active_within = 1e-4;
constexpr double at_bound = 1e-6;  ///< of the range
/// Limits of the domain are kept by so much more, as a share: an optimum at one is inside at looser tolerances too.
constexpr double domain_margin = 1e-5;

std::string short_number(double x) {
  std::ostringstream text;
  text.precision(6);
  text << x;
  return text.str();
}

/// The problem in coordinates from 0 to 1 between the bounds.
class Problem {
 public:
  Problem(const OptimiseStudy& study, const StartUp& start_up) : study_(study), start_up_(start_up) {
    for (const OptimisedParameter& p : study.parameters) parameters_.push_back(p.parameter);
  }

  Eigen::Index size() const { return Eigen::Index(study_.parameters.size()); }
  /// Those of the study, then the limits of the domain.
  Eigen::Index constraints() const {
    return Eigen::Index(study_.constraints.size()) + (study_.allow_extrapolation ? 0 : domain_limit_count);
  }

  double value(Eigen::Index k, double u) const {
    const OptimisedParameter& p = study_.parameters[std::size_t(k)];
    const double x = p.logarithmic ? p.lower * std::pow(p.upper / p.lower, u) : p.lower + u * (p.upper - p.lower);
    return std::clamp(x, p.lower, p.upper);
  }
  double coordinate(Eigen::Index k, double x) const {
    const OptimisedParameter& p = study_.parameters[std::size_t(k)];
    return p.logarithmic ? std::log(x / p.lower) / std::log(p.upper / p.lower) : (x - p.lower) / (p.upper - p.lower);
  }
  /// dx/du
  double slope(Eigen::Index k, double u) const {
    const OptimisedParameter& p = study_.parameters[std::size_t(k)];
    return p.logarithmic ? value(k, u) * std::log(p.upper / p.lower) : p.upper - p.lower;
  }

  Design<double> design(const Vector& u) const {
    Design<double> d = study_.design;
    for (Eigen::Index k = 0; k < size(); ++k) study_.parameters[std::size_t(k)].parameter.set(d, value(k, u[k]));
    return d;
  }

  /// The design with what was found; where the frequency is held, with it or the voltage that holds it.
  Design<double> found(const Vector& u, const DesignPoint& point) const {
    Design<double> d = design(u);
    if (study_.options.frequency && !set_drive_frequency(d, *study_.options.frequency)) {
      const double duty = d.supply.type == SupplyType::pwm ? d.supply.duty : 1.0;
      d.supply.voltage = point.metrics[Metric::voltage] / duty;
    }
    return d;
  }

  /// Objective to be minimised and constraints <= 0, each relative, with gradients.
  struct Evaluation {
    DesignPoint point;
    bool flaps = false;
    double objective = HUGE_VAL;
    Vector gradient;
    Vector constraints;
    Eigen::MatrixXd jacobian;
    double violation() const { return constraints.size() == 0 ? 0.0 : std::max(0.0, constraints.maxCoeff()); }
  };

  Evaluation evaluate(const Vector& u, bool gradients = true) const {
    Evaluation e;
    std::span<const DesignParameter> wanted;
    if (gradients) wanted = parameters_;
    e.point = design_point(design(u), study_.options, wanted, start_up_);
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
    const Eigen::Index own = Eigen::Index(study_.constraints.size());
    for (Eigen::Index c = 0; c < own; ++c) {
      const MetricConstraint& limit = study_.constraints[std::size_t(c)];
      const double factor = (limit.at_least ? -1.0 : 1.0) / (limit.limit == 0.0 ? 1.0 : std::abs(limit.limit));
      e.constraints[c] = factor * (e.point.metrics[limit.metric] - limit.limit);
      e.jacobian.row(c) = row(limit.metric, factor).transpose();
    }
    for (Eigen::Index c = own; c < m; ++c) {
      const std::size_t limit = std::size_t(c - own);
      e.constraints[c] = e.point.domain_excess[limit] + domain_margin;
      if (!gradients) continue;
      const bool by_geometry = limit == std::size_t(DomainLimit::stroke) && drive_of(study_.design).stroke_is_fixed;
      for (Eigen::Index k = 0; k < size(); ++k) {
        e.jacobian(c, k) =
            by_geometry ? stroke_slope(u, k) : e.point.domain_slopes[std::size_t(k)][limit] * slope(k, u[k]);
      }
    }
    e.flaps =
        std::isfinite(e.objective) && e.constraints.allFinite() && e.gradient.allFinite() && e.jacobian.allFinite();
    if (!e.flaps) e.objective = HUGE_VAL;
    return e;
  }

  const OptimiseStudy& study() const { return study_; }

 private:
  /// Derivative of the stroke's excess, which is geometry alone, by central differences.
  double stroke_slope(const Vector& u, Eigen::Index k) const {
    constexpr double step = 1e-5;
    Vector up = u, down = u;
    up[k] = std::min(1.0, u[k] + step);
    down[k] = std::max(0.0, u[k] - step);
    const auto excess = [&](const Vector& at) { return stroke_excess(resolve(design(at), study_.options.condition)); };
    return (excess(up) - excess(down)) / (up[k] - down[k]);
  }

  const OptimiseStudy& study_;
  const StartUp& start_up_;
  std::vector<DesignParameter> parameters_;
};

/// One local search.
struct Search {
  Vector end;
  double objective = HUGE_VAL, began = absent;
  bool feasible = false;
  int evaluations = 0;

  void run(const Problem& problem, const Vector& start) {
    Memory memory{problem, *this, {}, {}, 1.0};
    std::vector<double> u(start.data(), start.data() + start.size());
    const Problem::Evaluation& first = memory.at(u.data());
    if (!first.flaps) return;
    began = first.objective;
    memory.scale = std::max(std::abs(first.objective), 1e-300);
    // A search that runs into designs that do not flap may end there; from its best point it then starts anew.
    for (const nlopt::algorithm algorithm : {nlopt::LD_SLSQP, nlopt::LD_SLSQP, nlopt::LD_CCSAQ}) {
      nlopt::opt solver(algorithm, unsigned(problem.size()));
      solver.set_lower_bounds(0.0);
      solver.set_upper_bounds(1.0);
      solver.set_min_objective(&objective_of, &memory);
      const unsigned constraints = unsigned(problem.constraints());
      if (constraints > 0) {
        solver.add_inequality_mconstraint(&constraints_of, &memory, std::vector<double>(constraints, 1e-9));
      }
      solver.set_xtol_abs(1e-8);
      solver.set_ftol_rel(1e-10);
      solver.set_maxeval(algorithm == nlopt::LD_CCSAQ ? 200 : 100);
      double value = 0.0;
      bool converged = false;
      try {
        converged = int(solver.optimize(u, value)) > 0 && solver.last_optimize_result() != nlopt::MAXEVAL_REACHED;
      } catch (const std::exception&) {
        // What was reached until then counts.
      }
      if (memory.walls == 0 && (converged || !feasible)) break;
      memory.walls = 0;
      if (feasible) u.assign(end.data(), end.data() + end.size());
      else u.assign(start.data(), start.data() + start.size());
    }
  }

 private:
  struct Memory {
    const Problem& problem;
    Search& search;
    Vector last;
    Problem::Evaluation evaluation;
    double scale;
    int walls = 0;

    const Problem::Evaluation& at(const double* u) {
      const Eigen::Map<const Vector> x(u, problem.size());
      if (last.size() == 0 || last != x) {
        last = x;
        evaluation = problem.evaluate(x);
        ++search.evaluations;
        if (!evaluation.flaps) ++walls;
        const bool good = evaluation.flaps && evaluation.violation() <= feasible_to;
        if (good && (!search.feasible || evaluation.objective < search.objective)) {
          search.feasible = true;
          search.objective = evaluation.objective;
          search.end = last;
        }
      }
      return evaluation;
    }
  };

  static double objective_of(unsigned n, const double* u, double* gradient, void* data) {
    Memory& memory = *static_cast<Memory*>(data);
    const Problem::Evaluation& e = memory.at(u);
    if (gradient) Eigen::Map<Vector>(gradient, n) = e.gradient / memory.scale;
    return e.objective / memory.scale;
  }
  static void constraints_of(unsigned m, double* values, unsigned n, const double* u, double* gradient, void* data) {
    Memory& memory = *static_cast<Memory*>(data);
    const Problem::Evaluation& e = memory.at(u);
    Eigen::Map<Vector>(values, m) = e.constraints;
    if (!gradient) return;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(gradient, m, n) = e.jacobian;
  }
};

/// Solves a Sobol sequence of designs; their coordinates, the most promising first.
std::vector<Vector> screened(const Problem& problem, const StartUp& start_up, ScreenCounts& counts) {
  const OptimiseStudy& study = problem.study();
  const std::size_t constraints = study.constraints.size();
  SweepAxis axis;
  axis.name = "sample";
  axis.samples = true;
  axis.count = study.screen;
  const ScrambledSobol sobol(study.parameters.size(), study.seed);
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    SweptQuantity q;
    q.key = study.parameters[k].parameter.key;
    q.set = study.parameters[k].parameter.set;
    for (std::uint64_t n = 0; n < study.screen; ++n) q.values.push_back(problem.value(Eigen::Index(k), sobol(n, k)));
    axis.quantities.push_back(std::move(q));
  }
  Sweep sweep;
  sweep.axes.push_back(std::move(axis));
  sweep.variants.push_back({study.design, study.options.condition, true});
  sweep.variant_stride = {0};
  sweep.frequency = study.options.frequency;
  sweep.options.tolerance = 1e-4;
  sweep.options.metrics.reset();
  sweep.options.metrics.set(std::size_t(study.objective));
  for (const MetricConstraint& c : study.constraints) sweep.options.metrics.set(std::size_t(c.metric));
  SweepColumns columns;
  columns.resize(study.screen, sweep.options.metrics.count());
  SweepSolver solver(sweep, start_up);
  for (std::size_t begin = 0; begin < study.screen; begin += sweep_block) {
    solver.solve(columns, begin, std::min<std::size_t>(study.screen, begin + sweep_block));
  }
  const auto column = [&](Metric metric) -> const std::vector<double>& {
    std::size_t c = 0;
    for (int m = 0; m < int(metric); ++m) c += sweep.options.metrics[std::size_t(m)];
    return columns.metrics[c];
  };

  counts.violated.assign(constraints, 0);
  counts.closest.assign(constraints, absent);
  struct Rank {
    double violation, objective;
    std::size_t n;
    auto operator<=>(const Rank&) const = default;
  };
  std::vector<Rank> ranks;
  for (std::size_t n = 0; n < study.screen; ++n) {
    ++counts.status[std::size_t(columns.status[n])];
    if (columns.status[n] != 0) continue;
    const bool counts_here = columns.counts(n, study.allow_extrapolation);
    counts.outside += !counts_here;
    double violation = 0.0;
    for (std::size_t k = 0; k < counts.beyond.size() && !counts_here; ++k) {
      const bool exceeded = columns.domain[n] >> k & 1;
      counts.beyond[k] += exceeded;
      violation += exceeded;  // by how much is not known here
    }
    for (std::size_t c = 0; c < constraints; ++c) {
      const MetricConstraint& limit = study.constraints[c];
      const double x = column(limit.metric)[n], sign = limit.at_least ? 1.0 : -1.0;
      const double beyond = sign * (limit.limit - x) / (limit.limit == 0.0 ? 1.0 : std::abs(limit.limit));
      if (counts_here && beyond > 0.0) ++counts.violated[c];
      if (counts_here && !(sign * counts.closest[c] >= sign * x)) counts.closest[c] = x;
      violation = std::max(violation, beyond);
    }
    counts.feasible += violation <= 0.0;
    ranks.push_back({violation, (study.maximise ? -1.0 : 1.0) * column(study.objective)[n], n});
  }
  std::sort(ranks.begin(), ranks.end());
  std::vector<Vector> result;
  for (const Rank& rank : ranks) {
    Vector u(problem.size());
    for (std::size_t k = 0; k < study.parameters.size(); ++k) u[Eigen::Index(k)] = sobol(rank.n, k);
    result.push_back(u);
  }
  return result;
}

/// Promising designs that are not each other's neighbours.
std::vector<Vector> spread(const std::vector<Vector>& ranked, std::size_t count) {
  std::vector<Vector> chosen;
  for (double distance = 0.25; chosen.size() < count && distance > 1e-3; distance *= 0.5) {
    for (const Vector& u : ranked) {
      if (chosen.size() >= count) break;
      const bool near = std::any_of(chosen.begin(), chosen.end(), [&](const Vector& other) {
        return (u - other).lpNorm<Eigen::Infinity>() < distance;
      });
      if (!near) chosen.push_back(u);
    }
  }
  return chosen;
}

/// What holds the optimum, and the freedom that it leaves.
class Neighbourhood {
 public:
  Neighbourhood(const Problem& problem, const Vector& best, int& evaluations)
      : problem_(problem), best_(best), evaluations_(evaluations), at_(problem.evaluate(best)) {
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

  std::vector<ActiveLimit> active() const {
    const OptimiseStudy& study = problem_.study();
    std::vector<ActiveLimit> result;
    const double f = std::abs(at_.objective);
    for (std::size_t i = 0; i < constraints_.size(); ++i) {
      if (std::size_t(constraints_[i]) >= study.constraints.size()) {
        const DomainLimit limit = DomainLimit(std::size_t(constraints_[i]) - study.constraints.size());
        const bool from_zero = limit == DomainLimit::angle_of_attack;
        result.push_back({"domain: " + bound_of(limit, study.design.transmission.type),
                          from_zero ? absent : multipliers_[Eigen::Index(i)] / f, true});
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
      result.push_back({p.parameter.key + (low ? " >= " : " <= ") + short_number(x) +
                            (p.parameter.unit == "1" ? "" : " " + p.parameter.unit),
                        x == 0.0 ? absent : relative, false});
    }
    return result;
  }

  std::vector<FlatDirection> directions() {
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
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (h + h.transpose()));
    std::vector<FlatDirection> result;
    for (Eigen::Index k = 0; k < free.cols(); ++k) {
      const Vector direction = free * eigen.eigenvectors().col(k);
      FlatDirection flat;
      flat.curvature = eigen.eigenvalues()[k];
      std::vector<FlatDirection::Step> beyond;
      const auto [up, up_by_bound] = farthest(direction, 1.0, beyond);
      const auto [down, down_by_bound] = farthest(-direction, -1.0, beyond);
      beyond.push_back({0.0, values(best_), problem_.study().maximise ? -at_.objective : at_.objective});
      std::sort(beyond.begin(), beyond.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
      flat.walk = std::move(beyond);
      for (Eigen::Index j = 0; j < n; ++j) {
        flat.from.push_back(problem_.value(j, down[j]));
        flat.to.push_back(problem_.value(j, up[j]));
      }
      flat.width = (up - down).lpNorm<Eigen::Infinity>();
      flat.flat = up_by_bound || down_by_bound || flat.width > 0.5;
      result.push_back(std::move(flat));
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const FlatDirection& a, const FlatDirection& b) { return a.width > b.width; });
    return result;
  }

 private:
  /// Least squares: gradient + sum of multiplier * normal = 0.
  void find_multipliers() {
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

  /// Of the Lagrangian, by differences of exact gradients: central ones, one-sided at a bound.
  Eigen::MatrixXd hessian() {
    const Eigen::Index n = problem_.size();
    const auto slope = [&](const Vector& u) {
      const Problem::Evaluation e = problem_.evaluate(u);
      ++evaluations_;
      Vector g = e.gradient;
      for (std::size_t i = 0; i < constraints_.size(); ++i) {
        g += multipliers_[Eigen::Index(i)] * e.jacobian.row(constraints_[i]).transpose();
      }
      return e.flaps ? g : Vector(Vector::Constant(n, absent));
    };
    constexpr double step = 1e-3;
    Eigen::MatrixXd h(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      Vector up = best_, down = best_;
      up[k] = std::min(1.0, best_[k] + step);
      down[k] = std::max(0.0, best_[k] - step);
      h.col(k) = (slope(up) - slope(down)) / (up[k] - down[k]);
    }
    // Beside designs that do not flap the curvature is unknown: taken as none, the walk below measures.
    return h.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
  }

  std::vector<double> values(const Vector& u) const {
    std::vector<double> x;
    for (Eigen::Index k = 0; k < u.size(); ++k) x.push_back(problem_.value(k, u[k]));
    return x;
  }

  /// The point at a distance along the direction, put back onto the active constraints; nothing if it is no design.
  std::optional<Vector> moved(const Vector& direction, double distance, double sign,
                              std::vector<FlatDirection::Step>& walk) {
    Vector u = best_ + distance * direction;
    if (u.minCoeff() < -1e-9 || u.maxCoeff() > 1.0 + 1e-9) return std::nullopt;
    u = u.cwiseMax(0.0).cwiseMin(1.0);
    for (int iteration = 0; iteration < 4; ++iteration) {
      const Problem::Evaluation e = problem_.evaluate(u, !constraints_.empty());
      ++evaluations_;
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
        walk.push_back({sign * distance, values(u), problem_.study().maximise ? -e.objective : e.objective});
        return u;
      }
      u -= a.completeOrthogonalDecomposition().solve(residual);
      if (!(u.minCoeff() > -1e-9 && u.maxCoeff() < 1.0 + 1e-9)) return std::nullopt;
      u = u.cwiseMax(0.0).cwiseMin(1.0);
    }
    return std::nullopt;
  }

  /// The farthest point that is not more than flat_loss worse; true if a bound of the parameters ends the way there.
  std::pair<Vector, bool> farthest(const Vector& direction, double sign, std::vector<FlatDirection::Step>& walk) {
    double room = HUGE_VAL;
    for (Eigen::Index k = 0; k < problem_.size(); ++k) {
      if (std::abs(direction[k]) < 1e-9) continue;
      room = std::min(room, ((direction[k] > 0.0 ? 1.0 : 0.0) - best_[k]) / direction[k]);
    }
    if (!(room > 1e-6)) return {best_, false};
    if (const auto end = moved(direction, room, sign, walk)) return {*end, true};
    // Doubling first: the end may be very near, and what lies beyond a first failure does not count.
    double good = 0.0, bad = room;
    Vector at = best_;
    for (double t = std::min(1e-3, 0.5 * room); t < room; t *= 2.0) {
      const auto u = moved(direction, t, sign, walk);
      if (!u) {
        bad = t;
        break;
      }
      good = t;
      at = *u;
    }
    for (int k = 0; k < 8; ++k) {
      const double t = 0.5 * (good + bad);
      if (const auto u = moved(direction, t, sign, walk)) {
        good = t;
        at = *u;
      } else {
        bad = t;
      }
    }
    return {at, false};
  }

  const Problem& problem_;
  Vector best_;
  int& evaluations_;
  Problem::Evaluation at_;
  std::vector<Eigen::Index> constraints_, bounds_;
  Vector multipliers_;
};

/// A study without parameters: the one design there is.
void assess(const Problem& problem, OptimiseResult& result) {
  const OptimiseStudy& study = problem.study();
  const Problem::Evaluation only = problem.evaluate(Vector(), false);
  result.evaluations = result.starts = 1;
  result.screen.status[std::size_t(only.point.status)] = 1;
  result.screen.closest.assign(study.constraints.size(), absent);
  result.screen.violated.assign(study.constraints.size(), 0);
  if (!only.flaps) {
    result.failed = 1;
    return;
  }
  if (!study.allow_extrapolation && only.point.domain.any()) {
    result.screen.outside = 1;
    for (std::size_t k = 0; k < result.screen.beyond.size(); ++k) result.screen.beyond[k] = only.point.domain[k];
  }
  for (std::size_t c = 0; c < study.constraints.size() && result.screen.outside == 0; ++c) {
    result.screen.violated[c] = only.constraints[Eigen::Index(c)] > feasible_to;
    result.screen.closest[c] = only.point.metrics[study.constraints[c].metric];
  }
  if (only.violation() > feasible_to) {
    result.outcome = OptimiseResult::Outcome::infeasible;
    result.failed = 1;
    return;
  }
  result.outcome = OptimiseResult::Outcome::found;
  result.screen.feasible = 1;
  result.same = 1;
  result.point = only.point;
  result.design = problem.found(Vector(), only.point);
}

}  // namespace

std::string name_of(const MetricConstraint& c) {
  const char* key = metric_info(c.metric).key;
  return key + std::string(c.at_least ? " >= " : " <= ") + short_number(c.limit);
}

std::string bound_of(DomainLimit limit, TransmissionType transmission) {
  switch (limit) {
    case DomainLimit::angle_of_attack: return "angle_of_attack >= 0 deg";
    case DomainLimit::stroke: return "stroke <= " + short_number(stroke_max_deg(transmission)) + " deg";
    case DomainLimit::formulation_residual:
      return "formulation_residual <= " + short_number(100.0 * formulation_residual_max) + " %";
    case DomainLimit::mechanism_efficiency: return "mechanism_efficiency <= 1";
    case DomainLimit::motor_efficiency: return "motor_efficiency <= 1";
    case DomainLimit::input_power: return "input_power > 0";
    case DomainLimit::flow_speed: return "flow_speed <= " + short_number(flow_speed_max) + " m/s";
  }
  return "unknown";
}

OptimiseResult optimise(const OptimiseStudy& study, const StartUp& start_up, const ForEach& for_each) {
  OptimiseResult result;
  const Problem problem(study, start_up);
  if (study.parameters.empty()) {
    assess(problem, result);
    return result;
  }
  const std::vector<Vector> ranked = screened(problem, start_up, result.screen);

  std::vector<Vector> starts;
  Vector given(problem.size());
  for (Eigen::Index k = 0; k < given.size(); ++k) {
    const auto x = study.parameters[std::size_t(k)].parameter.value(study.design);
    given[k] = x ? problem.coordinate(k, *x) : absent;
  }
  const bool inside = given.allFinite() && given.minCoeff() >= 0.0 && given.maxCoeff() <= 1.0;
  if (inside && problem.evaluate(given).flaps) starts.push_back(given);
  for (const Vector& u : spread(ranked, std::size_t(study.starts) - starts.size())) starts.push_back(u);
  if (starts.empty()) return result;

  std::vector<Search> searches(starts.size());
  const auto run = [&](std::size_t first, std::size_t last) {
    const auto one = [&](std::size_t n) { searches[first + n].run(problem, starts[first + n]); };
    if (for_each) for_each(last - first, one);
    else
      for (std::size_t n = 0; n < last - first; ++n) one(n);
  };
  // Where the screening found nothing within the constraints, a few searches tell whether there is anything at all.
  const std::size_t scouts = result.screen.feasible > 0 ? 0 : std::min<std::size_t>(4, starts.size());
  run(0, scouts);
  const auto found_one = [](const Search& s) { return s.feasible; };
  if (scouts > 0 && std::none_of(searches.begin(), searches.end(), found_one)) {
    searches.resize(scouts);
    starts.resize(scouts);
  } else {
    run(scouts, starts.size());
  }

  result.starts = int(starts.size());
  const Search* best = nullptr;
  const auto values = [&](const Vector& u) {
    std::vector<double> x;
    for (Eigen::Index k = 0; k < u.size(); ++k) x.push_back(problem.value(k, u[k]));
    return x;
  };
  const double sign = study.maximise ? -1.0 : 1.0;
  for (std::size_t n = 0; n < searches.size(); ++n) {
    const Search& s = searches[n];
    result.evaluations += s.evaluations;
    result.searches.push_back({values(starts[n]), s.feasible ? values(s.end) : std::vector<double>(), sign * s.began,
                               s.feasible ? sign * s.objective : absent, s.evaluations});
    if (s.feasible && (!best || s.objective < best->objective)) best = &s;
  }
  if (!best) {
    result.outcome = OptimiseResult::Outcome::infeasible;
    result.failed = result.starts;
    return result;
  }
  for (const Search& s : searches) {
    const bool same = s.feasible && s.objective - best->objective <= 1e-4 * std::abs(best->objective);
    (same ? result.same : s.feasible ? result.elsewhere : result.failed)++;
  }
  result.outcome = OptimiseResult::Outcome::found;
  for (Eigen::Index k = 0; k < problem.size(); ++k) result.parameters.push_back(problem.value(k, best->end[k]));
  result.point = problem.evaluate(best->end).point;
  result.design = problem.found(best->end, result.point);
  Neighbourhood around(problem, best->end, result.evaluations);
  result.active = around.active();
  result.directions = around.directions();
  return result;
}

}  // namespace wingbeat
