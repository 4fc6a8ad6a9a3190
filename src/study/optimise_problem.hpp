// The problem of a study of the best design, as searches see it: objective and constraints with gradients.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/study/optimise.hpp"

namespace wingbeat::detail {

using Vector = Eigen::VectorXd;

inline constexpr double feasible_to = 1e-6;  ///< of a constraint, relative to its limit

/// The problem in coordinates from 0 to 1 between the bounds.
class OptimiseProblem {
 public:
  OptimiseProblem(const OptimiseStudy& study, const StartUp& start_up)
      : study_(study), options_(study.options), start_up_(start_up) {
    for (const OptimisedParameter& p : study.parameters) parameters_.push_back(p.parameter);
    MetricSet wanted;
    wanted.set(std::size_t(study.objective));
    for (const MetricConstraint& c : study.constraints) wanted.set(std::size_t(c.metric));
    options_.flight = flight_metrics(wanted, study.allow_extrapolation);
    options_.gear_torque = study.gear_torque.any();
    // The domain's limits are constraints with slopes, which a search that ends at them would not have.
    if (options_.hold) options_.hold->range = SearchRange::extrapolation;
  }

  Eigen::Index size() const { return Eigen::Index(study_.parameters.size()); }
  /// Those of the study, then the torques of the gearbox, then the limits of the domain.
  Eigen::Index constraints() const { return own_constraints() + (study_.allow_extrapolation ? 0 : domain_limit_count); }
  /// Without the limits of the domain.
  Eigen::Index own_constraints() const {
    const GearTorqueLimits& torque = study_.gear_torque;
    return Eigen::Index(study_.constraints.size()) + torque.continuous.has_value() + torque.peak.has_value();
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
  /// The coordinates of the given design; nothing where it lies outside the box or lacks a parameter.
  std::optional<Vector> given() const;
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
  Design<double> found(const Vector& u, const DesignPoint& point) const;

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

  Evaluation evaluate(const Vector& u, bool gradients = true) const;

  const OptimiseStudy& study() const { return study_; }

 private:
  /// Derivatives of the excess over the domain's limits that are the vehicle's alone, its metrics held, by central
  /// differences.
  DomainExcess vehicle_slopes(const Vector& u, Eigen::Index k, const Metrics<double>& metrics) const;

  const OptimiseStudy& study_;
  DesignPointOptions options_;  ///< of the study, with the flight where it is asked for
  const StartUp& start_up_;
  std::vector<DesignParameter> parameters_;
};

}  // namespace wingbeat::detail
