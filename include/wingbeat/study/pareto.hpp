// The designs that no other beats in every objective, within bounds and constraints: evolution on the batched solver.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/study/evolution.hpp"
#include "wingbeat/study/optimise.hpp"

namespace wingbeat {

// ---- Points in the space of objectives, all of them to be minimised

using ObjectivePoint = std::vector<double>;

/// True if `a` is nowhere worse than `b` and somewhere better.
bool dominates(const ObjectivePoint& a, const ObjectivePoint& b);

/// Places of the points that no other dominates, in ascending order; of equal points the first.
std::vector<std::size_t> nondominated(std::span<const ObjectivePoint> points);

/// Measure of what the points dominate within the box that ends at `reference`, exact, for two and three objectives.
/// Points that do not lie before the reference in every objective add nothing.
double hypervolume(std::span<const ObjectivePoint> points, const ObjectivePoint& reference);

/// Designs picked from a front, by their places in it.
struct FrontPicks {
  std::vector<std::size_t> ends;  ///< the best by each objective
  std::size_t knee = 0;  ///< farthest from the plane through the ends, each objective scaled by the front's range
  std::vector<std::size_t> even;  ///< spread evenly over the front, from end to end
};
/// `front` must not be empty. With two objectives distances are taken along the front, else each pick is the point
/// farthest from those picked before.
FrontPicks pick_designs(std::span<const ObjectivePoint> front, std::size_t count);

// ---- The study

struct ParetoObjective {
  Metric metric = Metric::power_electrical;
  bool maximise = false;
  std::optional<double> reference;  ///< of the hypervolume [SI]; else the worst feasible value of the screening
};

/// A number that is one of a list.
struct DiscreteParameter {
  DesignParameter parameter;
  std::vector<double> values;  ///< SI, at least two
};

/// One of the vehicles to choose from: that of the study, or it with a motor of a catalogue.
struct ParetoVehicle {
  std::string name;
  Design<double> design;
};

struct ParetoStudy {
  std::vector<ParetoVehicle> vehicles;
  Condition condition = Condition::air;
  std::optional<Hold> hold;                 ///< the voltage follows
  double tolerance = 1e-8;                  ///< of the orbits of the front
  std::vector<ParetoObjective> objectives;  ///< two or three
  std::vector<OptimisedParameter> parameters;
  std::vector<DiscreteParameter> choices;
  std::vector<MetricConstraint> constraints;
  bool allow_extrapolation = false;  ///< else designs outside the model's domain are infeasible
  EvolutionOptions evolution;
  std::uint64_t screen = 1024;  ///< designs of a scrambled Sobol sequence solved first; at least the population
  std::size_t designs = 5;      ///< picked evenly along the front
};

struct ParetoDesign {
  std::size_t vehicle = 0;
  std::vector<double> parameters;  ///< those of the study, then the choices [SI]
  Metrics<double> metrics;         ///< of front designs all, of the others the objectives and constraints
  DomainStatus domain = {};        ///< limits of the model that are exceeded; none unless flapping
};

struct ParetoResult {
  enum class Outcome { found, infeasible, nothing_flaps } outcome = Outcome::nothing_flaps;
  ScreenCounts screen;
  std::vector<ParetoDesign> front;      ///< by the first objective, best first
  std::vector<ParetoDesign> evaluated;  ///< every design solved, in the order of solving
  std::vector<SweepStatus> status;      ///< of `evaluated`
  std::vector<bool> feasible;           ///< of `evaluated`: flapping, inside the domain and within every constraint
  FrontPicks picks;
  std::vector<double> reference;  ///< by objective [SI]
  double hypervolume = 0.0;       ///< product of the objectives' units
  std::vector<double> history;    ///< hypervolume after the screening and after each generation
};

/// The front of all designs that were solved. Search: scrambled Sobol sequence, then evolution, in which a design
/// beyond a constraint loses against every feasible one, and of two such designs the one beyond by less wins (Deb
/// 2000); a design that does not flap loses against all. The front is solved anew at the study's tolerance with every
/// metric, and what is then beyond a constraint or dominated is left out. The result depends on the study alone.
/// `progress` gets designs solved and designs in all.
ParetoResult pareto_front(const ParetoStudy& study, Evolve evolve, const StartUp& start_up,
                          const ForEach& for_each = {},
                          const std::function<void(std::uint64_t, std::uint64_t)>& progress = {});

/// A design of the result as a vehicle; where something is held, with the voltage found for it.
Design<double> vehicle_of(const ParetoStudy& study, const ParetoDesign& design);

}  // namespace wingbeat
