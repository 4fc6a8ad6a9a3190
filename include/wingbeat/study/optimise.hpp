// The best design within bounds and constraints: gradient-based from several starts, with what holds the optimum and
// how flat it is.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/for_each.hpp"

namespace wingbeat {

struct OptimisedParameter {
  DesignParameter parameter;
  double lower = 0.0, upper = 1.0;  ///< SI
  bool logarithmic = false;         ///< searched in the logarithm
};

/// A bound on a metric, SI.
struct MetricConstraint {
  Metric metric = Metric::lift_to_weight;
  bool at_least = true;
  double limit = 1.0;
  std::string part = {};  ///< the part whose limit it is: "speed of the gearbox"; empty of a study's own
};

struct OptimiseStudy {
  Design<double> design;
  DesignPointOptions options{Condition::air, std::nullopt, 1e-8, true};
  Metric objective = Metric::power_electrical;
  bool maximise = false;
  std::vector<OptimisedParameter> parameters;
  std::vector<MetricConstraint> constraints;
  GearTorqueLimits gear_torque = {};  ///< of the gearbox, constraints like those
  bool allow_extrapolation = false;   ///< else the limits of the model's domain are constraints as well
  int starts = 20;  ///< the design as given where it lies within the bounds, the others from the screening
  std::uint64_t seed = 1;
  std::uint64_t screen = 1024;  ///< designs of a scrambled Sobol sequence solved first
};

/// What the screening found.
struct ScreenCounts {
  std::array<std::uint64_t, sweep_status_count> status{};
  std::uint64_t feasible = 0;                              ///< flapping, inside the domain and within every constraint
  std::uint64_t outside = 0;                               ///< flapping outside the domain, where that does not count
  std::array<std::uint64_t, domain_limit_count> beyond{};  ///< of those, by DomainLimit
  std::vector<std::uint64_t> violated;                     ///< by constraint: flapping inside the domain, but beyond it
  std::vector<double> closest;  ///< by constraint: the metric's best value met there [SI]; absent if none
  /// Of those within every constraint: above the continuous and above the peak torque of the gearbox.
  std::array<std::uint64_t, 2> torque_exceeded{};
};

/// A constraint or bound that holds the optimum.
struct ActiveLimit {
  std::string name;          ///< "lift_to_weight >= 1", "supply.voltage <= 5 V"
  double sensitivity = 0.0;  ///< relative loss for a relative tightening of the limit; absent for a limit of 0
  bool domain = false;       ///< a limit of the model's domain
};

/// How far the design can move along one direction, the active limits kept, until the objective is 0.1 % worse.
struct FlatDirection {
  std::vector<double> from, to;  ///< parameters at either end [SI]
  double width = 0.0;            ///< largest share of a parameter's bounds that is covered
  double curvature = 0.0;        ///< of the Lagrangian, relative to the objective, per (range of the bounds)^2
  bool flat = false;             ///< a null direction: a bound ends it, or its width exceeds half the bounds
  /// The designs tried on the way, `from` to `to`: steps along the direction [ranges of the bounds], 0 at the optimum,
  /// with parameters [SI] and objective [SI].
  struct Step {
    double distance = 0.0;
    std::vector<double> parameters;
    double objective = 0.0;
  };
  std::vector<Step> walk;
};
inline constexpr double flat_loss = 1e-3;

/// Where a local search began and ended [SI].
struct SearchEnd {
  std::vector<double> start, end;  ///< `end` is empty where nothing within the constraints was found
  double began = absent;           ///< objective at the start; absent if it does not flap
  double ended = absent;           ///< objective at the end
  int evaluations = 0;
};

struct OptimiseResult {
  enum class Outcome {
    found,
    infeasible,    ///< designs flap, but none within the constraints and the domain was found
    nothing_flaps  ///< in the screening
  };
  Outcome outcome = Outcome::nothing_flaps;
  ScreenCounts screen;
  std::vector<double> parameters;  ///< of the optimum [SI]
  Design<double> design;           ///< with them; where something is held, with the voltage found
  DesignPoint point;
  std::vector<ActiveLimit> active;
  std::vector<FlatDirection> directions;                ///< flattest first; empty where active limits leave no freedom
  int starts = 0, same = 0, elsewhere = 0, failed = 0;  ///< starts by where they ended
  int evaluations = 0;                                  ///< orbits with gradients
  std::vector<SearchEnd> searches;
};

/// Local searches by SLSQP (Kraft 1994; NLopt) with exact gradients. The result depends on the study alone. Throws
/// ParameterError for a parameter without a place in the design.
OptimiseResult optimise(const OptimiseStudy& study, const StartUp& start_up, const ForEach& for_each = {});

/// "lift_to_weight >= 1", "speed of the gearbox: crank_speed_max_rad_per_s <= 500"
std::string name_of(const MetricConstraint& constraint);
/// The limits of a gearbox that are given, by name: "continuous torque of the gearbox: 0.02 N m".
std::vector<std::string> limit_names(const GearTorqueLimits& limits);
/// How far a torque lies beyond each limit that is given, relative to it: positive beyond, absent where unknown.
std::vector<double> excess_of(const GearTorqueLimits& limits, const GearTorque& torque);
/// "angle_of_attack >= 0 deg"
std::string bound_of(DomainLimit limit, const Vehicle<double>& vehicle);

}  // namespace wingbeat
