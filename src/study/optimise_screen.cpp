#include "study/optimise_screen.hpp"

#include <algorithm>
#include <cstdint>

#include "wingbeat/study/sampling.hpp"
#include "wingbeat/study/sweep.hpp"

namespace wingbeat::detail {

std::vector<Vector> screened(const OptimiseProblem& problem, const StartUp& start_up, const ForEach& for_each,
                             ScreenCounts& counts) {
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
  sweep.hold = study.options.hold;
  sweep.allow_extrapolation = study.allow_extrapolation;
  sweep.options.tolerance = 1e-4;
  sweep.options.metrics.reset();
  sweep.options.metrics.set(std::size_t(study.objective));
  for (const MetricConstraint& c : study.constraints) sweep.options.metrics.set(std::size_t(c.metric));
  SweepColumns columns;
  columns.resize(study.screen, sweep.options.metrics.count());
  // Smaller blocks than a sweep's: there are as few designs as cores should share.
  constexpr std::size_t block = sweep_block / 2;
  for_all(for_each, (study.screen + block - 1) / block, [&](std::size_t n) {
    SweepSolver solver(sweep, start_up);
    solver.solve(columns, n * block, std::min<std::size_t>(study.screen, (n + 1) * block));
  });
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
    ++counts.status[static_cast<unsigned char>(columns.status[n])];
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

}  // namespace wingbeat::detail
