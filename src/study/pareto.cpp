#include "wingbeat/study/pareto.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/study/sampling.hpp"
#include "wingbeat/study/sweep.hpp"

namespace wingbeat {
namespace {

constexpr double search_tolerance = 1e-5;
/// Objectives of the feasible designs are of order 1; these must lie beyond any of them.
constexpr double infeasible_from = 1e6, not_flapping = 1e9;
/// Designs that one thread solves at once; several blocks of lanes.
constexpr std::size_t chunk = 32;

/// The problem in coordinates from 0 to 1 between the bounds, and whole numbers.
class Problem {
 public:
  Problem(const ParetoStudy& study, const StartUp& start_up, const ForEach& for_each)
      : study_(study), start_up_(start_up), for_each_(for_each) {
    space.continuous = study.parameters.size();
    for (const DiscreteParameter& p : study.choices) space.choices.push_back(p.values.size());
    if (study.vehicles.size() > 1) space.choices.push_back(study.vehicles.size());
    space.objectives = study.objectives.size();
    for (const ParetoObjective& o : study.objectives) wanted_.set(std::size_t(o.metric));
    for (const MetricConstraint& c : study.constraints) wanted_.set(std::size_t(c.metric));
  }

  ParetoDesign design_of(const double* point) const {
    ParetoDesign d;
    d.metrics.values.fill(absent);
    for (const OptimisedParameter& p : study_.parameters) {
      const double u = *point++;
      const double x = p.logarithmic ? p.lower * std::pow(p.upper / p.lower, u) : p.lower + u * (p.upper - p.lower);
      d.parameters.push_back(std::clamp(x, p.lower, p.upper));
    }
    for (const DiscreteParameter& p : study_.choices) d.parameters.push_back(p.values[std::size_t(*point++)]);
    if (study_.vehicles.size() > 1) d.vehicle = std::size_t(*point);
    return d;
  }

  Design<double> vehicle(const ParetoDesign& d) const {
    Design<double> v = study_.vehicles[d.vehicle].design;
    const std::size_t continuous = study_.parameters.size();
    for (std::size_t k = 0; k < continuous; ++k) study_.parameters[k].parameter.set(v, d.parameters[k]);
    for (std::size_t k = 0; k < study_.choices.size(); ++k) {
      study_.choices[k].parameter.set(v, d.parameters[continuous + k]);
    }
    return v;
  }

  /// Solves designs side by side into their metrics.
  void solve(std::span<ParetoDesign> designs, std::span<SweepStatus> status, double tolerance,
             const MetricSet& metrics) const {
    const auto part = [&](std::size_t n) {
      const std::size_t first = n * chunk, count = std::min(chunk, designs.size() - first);
      Sweep sweep;
      sweep.axes.emplace_back();
      sweep.axes.back().name = "design";
      sweep.axes.back().count = count;
      sweep.axes.back().samples = true;
      sweep.variant_stride = {1};
      for (std::size_t k = 0; k < count; ++k) {
        sweep.variants.push_back({vehicle(designs[first + k]), study_.condition, true});
      }
      sweep.hold = study_.hold;
      sweep.allow_extrapolation = study_.allow_extrapolation;
      sweep.options.tolerance = tolerance;
      sweep.options.metrics = metrics;
      SweepColumns columns;
      columns.resize(count, metrics.count());
      SweepSolver(sweep, start_up_).solve(columns, 0, count);
      for (std::size_t k = 0; k < count; ++k) {
        status[first + k] = SweepStatus(columns.status[k]);
        designs[first + k].domain = DomainStatus(static_cast<unsigned long long>(columns.domain[k]));
        std::size_t column = 0;
        for (std::size_t m = 0; m < metric_count; ++m) {
          if (metrics[m]) designs[first + k].metrics.values[m] = columns.metrics[column++][k];
        }
      }
    };
    const std::size_t parts = (designs.size() + chunk - 1) / chunk;
    if (for_each_ && parts > 1) for_each_(parts, part);
    else
      for (std::size_t n = 0; n < parts; ++n) part(n);
  }

  const MetricSet& wanted() const { return wanted_; }

  /// How far beyond the constraints, in shares of their limits, all of them together; infinite if a metric is absent.
  double violation(const ParetoDesign& d) const {
    // By how much a limit of the domain is exceeded is not known here: each counts as much as twice a constraint.
    double sum = study_.allow_extrapolation ? 0.0 : double(d.domain.count());
    for (const MetricConstraint& c : study_.constraints) sum += std::max(0.0, beyond(c, d.metrics[c.metric]));
    for (const ParetoObjective& o : study_.objectives) {
      if (!std::isfinite(d.metrics[o.metric])) return HUGE_VAL;
    }
    return std::isnan(sum) ? HUGE_VAL : sum;
  }
  static double beyond(const MetricConstraint& c, double x) {
    const double excess = (c.at_least ? c.limit - x : x - c.limit) / (c.limit == 0.0 ? 1.0 : std::abs(c.limit));
    return std::isnan(excess) ? HUGE_VAL : excess;
  }

  /// Objectives to be minimised [SI].
  ObjectivePoint objectives(const ParetoDesign& d) const {
    ObjectivePoint p;
    for (const ParetoObjective& o : study_.objectives) p.push_back((o.maximise ? -1.0 : 1.0) * d.metrics[o.metric]);
    return p;
  }

  EvolutionProblem space;

 private:
  const ParetoStudy& study_;
  const StartUp& start_up_;
  const ForEach& for_each_;
  MetricSet wanted_;
};

/// All that has been solved, and how the evolution sees it.
class Archive {
 public:
  Archive(const Problem& problem, ParetoResult& result) : problem_(problem), result_(result) {}

  /// Solves points and appends them.
  void solve(std::span<const double> points) {
    const std::size_t n = problem_.space.dimensions(), first = result_.evaluated.size();
    for (std::size_t i = 0; i < points.size(); i += n) result_.evaluated.push_back(problem_.design_of(&points[i]));
    result_.status.resize(result_.evaluated.size());
    problem_.solve(std::span(result_.evaluated).subspan(first), std::span(result_.status).subspan(first),
                   search_tolerance, problem_.wanted());
    for (std::size_t k = first; k < result_.evaluated.size(); ++k) {
      const bool flaps = result_.status[k] == SweepStatus::flapping;
      violation_.push_back(flaps ? problem_.violation(result_.evaluated[k]) : HUGE_VAL);
      result_.feasible.push_back(violation_.back() <= 0.0);
    }
  }

  /// Shift and scale of the objectives: the ranges of what the screening found feasible, else of what flaps.
  void scale() {
    const bool any = std::find(result_.feasible.begin(), result_.feasible.end(), true) != result_.feasible.end();
    low_.assign(problem_.space.objectives, HUGE_VAL);
    std::vector<double> high(problem_.space.objectives, -HUGE_VAL);
    for (std::size_t k = 0; k < result_.evaluated.size(); ++k) {
      if (any ? !result_.feasible[k] : !std::isfinite(violation_[k])) continue;
      const ObjectivePoint p = problem_.objectives(result_.evaluated[k]);
      for (std::size_t m = 0; m < p.size(); ++m) {
        low_[m] = std::min(low_[m], p[m]);
        high[m] = std::max(high[m], p[m]);
      }
    }
    range_.clear();
    for (std::size_t m = 0; m < high.size(); ++m) range_.push_back(high[m] > low_[m] ? high[m] - low_[m] : 1.0);
  }

  /// What the evolution minimises, of the designs from `first` on.
  void fitness(std::size_t first, std::span<double> values) const {
    const std::size_t m = problem_.space.objectives;
    for (std::size_t k = first; k < result_.evaluated.size(); ++k) {
      double* row = &values[(k - first) * m];
      if (result_.feasible[k]) {
        const ObjectivePoint p = problem_.objectives(result_.evaluated[k]);
        for (std::size_t j = 0; j < m; ++j) row[j] = std::min((p[j] - low_[j]) / range_[j], infeasible_from);
      } else {
        std::fill(row, row + m,
                  std::isfinite(violation_[k]) ? std::min(infeasible_from + violation_[k], not_flapping)
                                               : 2.0 * not_flapping);
      }
    }
  }

  std::size_t size() const { return result_.evaluated.size(); }

 private:
  const Problem& problem_;
  ParetoResult& result_;
  std::vector<double> violation_, low_, range_;
};

void count_screening(const ParetoStudy& study, ParetoResult& result) {
  ScreenCounts& counts = result.screen;
  counts.violated.assign(study.constraints.size(), 0);
  counts.closest.assign(study.constraints.size(), absent);
  for (std::size_t n = 0; n < result.evaluated.size(); ++n) {
    ++counts.status[std::size_t(result.status[n])];
    counts.feasible += result.feasible[n];
    if (result.status[n] != SweepStatus::flapping) continue;
    const DomainStatus domain = result.evaluated[n].domain;
    if (!study.allow_extrapolation && domain.any()) {
      ++counts.outside;
      for (std::size_t k = 0; k < domain.size(); ++k) counts.beyond[k] += domain[k];
      continue;
    }
    for (std::size_t c = 0; c < study.constraints.size(); ++c) {
      const MetricConstraint& limit = study.constraints[c];
      const double x = result.evaluated[n].metrics[limit.metric], sign = limit.at_least ? 1.0 : -1.0;
      counts.violated[c] += Problem::beyond(limit, x) > 0.0;
      if (!(sign * counts.closest[c] >= sign * x)) counts.closest[c] = x;
    }
  }
}

/// By objective, to be minimised: what the study says, else the worst feasible value of the first `count` designs.
ObjectivePoint reference_of(const ParetoStudy& study, const Problem& problem, const ParetoResult& result,
                            std::size_t count) {
  ObjectivePoint reference(study.objectives.size(), -HUGE_VAL);
  for (std::size_t n = 0; n < count; ++n) {
    if (!result.feasible[n]) continue;
    const ObjectivePoint p = problem.objectives(result.evaluated[n]);
    for (std::size_t m = 0; m < p.size(); ++m) reference[m] = std::max(reference[m], p[m]);
  }
  for (std::size_t m = 0; m < reference.size(); ++m) {
    const ParetoObjective& o = study.objectives[m];
    if (o.reference) reference[m] = (o.maximise ? -1.0 : 1.0) * *o.reference;
  }
  return reference;
}

}  // namespace

Design<double> vehicle_of(const ParetoStudy& study, const ParetoDesign& design) {
  Design<double> v = Problem(study, {}, {}).vehicle(design);
  if (study.hold && !(study.hold->held == Held::frequency && set_drive_frequency(v, study.hold->value))) {
    DesignPointOptions options{study.condition, study.hold, study.tolerance};
    options.hold->range = search_range(study.allow_extrapolation);
    set_voltage(v.supply, design_point(v, options, {}, start_up_in_time()).voltage);
  }
  return v;
}

ParetoResult pareto_front(const ParetoStudy& study, Evolve evolve, const StartUp& start_up, const ForEach& for_each,
                          const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
  ParetoResult result;
  Problem problem(study, start_up, for_each);
  Archive archive(problem, result);
  EvolutionProblem& space = problem.space;
  const std::size_t n = space.dimensions(), population = study.evolution.population;
  const std::uint64_t all = study.screen + std::uint64_t(population) * study.evolution.generations;
  const auto report = [&] {
    if (progress) progress(archive.size(), all);
  };

  const ScrambledSobol sobol(n, study.evolution.seed);
  std::vector<double> points;
  for (std::uint64_t i = 0; i < study.screen; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      const double u = sobol(i, k);
      const bool whole = k >= space.continuous;
      const double choices = whole ? double(space.choices[k - space.continuous]) : 1.0;
      points.push_back(whole ? std::min(std::floor(u * choices), choices - 1.0) : u);
    }
  }
  for (std::size_t first = 0; first < study.screen; first += sweep_block) {
    const std::size_t count = std::min<std::size_t>(sweep_block, study.screen - first);
    archive.solve(std::span(points).subspan(first * n, count * n));
    report();
  }
  count_screening(study, result);
  if (result.screen.status[0] == 0) return result;
  archive.scale();
  std::vector<double> values(study.screen * space.objectives);
  archive.fitness(0, values);
  space.evaluate = [&](std::span<const double> asked, std::span<double> answers) {
    const std::size_t first = archive.size();
    archive.solve(asked);
    archive.fitness(first, answers);
    report();
  };
  evolve(space, study.evolution, points, values);

  std::vector<ObjectivePoint> feasible;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < archive.size(); ++k) {
    if (!result.feasible[k]) continue;
    feasible.push_back(problem.objectives(result.evaluated[k]));
    places.push_back(k);
  }
  std::vector<ParetoDesign> front;
  for (const std::size_t k : nondominated(feasible)) front.push_back(result.evaluated[places[k]]);
  std::vector<SweepStatus> status(front.size());
  problem.solve(front, status, study.tolerance, all_metrics() | problem.wanted());
  std::vector<ObjectivePoint> objectives;
  for (std::size_t k = 0; k < front.size(); ++k) {
    if (status[k] != SweepStatus::flapping || problem.violation(front[k]) > 0.0) continue;
    objectives.push_back(problem.objectives(front[k]));
    result.front.push_back(std::move(front[k]));
  }
  if (result.front.empty()) {
    result.outcome = ParetoResult::Outcome::infeasible;
    return result;
  }
  result.outcome = ParetoResult::Outcome::found;
  std::vector<std::size_t> order = nondominated(objectives);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return objectives[a] < objectives[b]; });
  std::vector<ParetoDesign> sorted;
  std::vector<ObjectivePoint> sorted_objectives;
  for (const std::size_t k : order) {
    sorted.push_back(std::move(result.front[k]));
    sorted_objectives.push_back(objectives[k]);
  }
  result.front = std::move(sorted);
  result.picks = pick_designs(sorted_objectives, study.designs);

  const std::size_t referred = result.screen.feasible > 0 ? std::size_t(study.screen) : archive.size();
  const ObjectivePoint reference = reference_of(study, problem, result, referred);
  for (std::size_t m = 0; m < reference.size(); ++m) {
    result.reference.push_back((study.objectives[m].maximise ? -1.0 : 1.0) * reference[m]);
  }
  result.hypervolume = hypervolume(sorted_objectives, reference);
  // Points of one generation after the other; those beaten meanwhile add nothing.
  std::vector<ObjectivePoint> met;
  std::size_t next = 0;
  for (std::size_t end = study.screen; end <= archive.size(); end += population) {
    for (; next < feasible.size() && places[next] < end; ++next) met.push_back(feasible[next]);
    std::vector<ObjectivePoint> best;
    for (const std::size_t k : nondominated(met)) best.push_back(met[k]);
    met = std::move(best);
    result.history.push_back(hypervolume(met, reference));
  }
  return result;
}

}  // namespace wingbeat
