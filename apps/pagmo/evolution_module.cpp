// The one part that is linked with pagmo: a library of its own beside the program, loaded for several objectives alone,
// because pagmo takes longer to load than a run takes.
#include <algorithm>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/moead.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/batch_evaluators/member_bfe.hpp>
#include <pagmo/bfe.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/utils/multi_objective.hpp>

#include "wingbeat/study/evolution.hpp"

namespace {

/// MOEA/D knows no whole numbers: for it they are taken from the cells of a continuous coordinate.
struct Problem {
  const wingbeat::EvolutionProblem* given = nullptr;
  bool relaxed = false;

  bool whole(std::size_t k) const { return k >= given->continuous; }
  double choices(std::size_t k) const { return double(given->choices[k - given->continuous]); }
  double encoded(std::size_t k, double x) const { return relaxed && whole(k) ? (x + 0.5) / choices(k) : x; }
  double decoded(std::size_t k, double x) const {
    return relaxed && whole(k) ? std::min(std::floor(x * choices(k)), choices(k) - 1.0) : x;
  }

  pagmo::vector_double batch_fitness(const pagmo::vector_double& points) const {
    const std::size_t n = given->dimensions(), count = points.size() / n;
    pagmo::vector_double decoded_points(points.size()), values(count * given->objectives);
    for (std::size_t i = 0; i < points.size(); ++i) decoded_points[i] = decoded(i % n, points[i]);
    given->evaluate(decoded_points, values);
    return values;
  }
  pagmo::vector_double fitness(const pagmo::vector_double& point) const { return batch_fitness(point); }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    const std::size_t n = given ? given->dimensions() : 1;
    pagmo::vector_double low(n, 0.0), high(n, 1.0);
    for (std::size_t k = 0; given && k < n; ++k) {
      if (whole(k) && !relaxed) high[k] = choices(k) - 1.0;
    }
    return {low, high};
  }
  pagmo::vector_double::size_type get_nobj() const { return given ? given->objectives : 1; }
  pagmo::vector_double::size_type get_nix() const { return given && !relaxed ? given->choices.size() : 0; }
};

void evolve(const wingbeat::EvolutionProblem& problem, const wingbeat::EvolutionOptions& options,
            std::span<const double> points, std::span<const double> values) {
  const bool nsga2 = options.method == wingbeat::EvolutionMethod::nsga2;
  const Problem own{&problem, !nsga2};
  const std::size_t n = problem.dimensions(), m = problem.objectives;
  std::vector<pagmo::vector_double> objectives;
  for (std::size_t i = 0; i < values.size(); i += m) objectives.emplace_back(&values[i], &values[i] + m);
  pagmo::population population(pagmo::problem(own), 0, options.seed);
  for (const std::size_t i : pagmo::select_best_N_mo(objectives, options.population)) {
    pagmo::vector_double point(n);
    for (std::size_t k = 0; k < n; ++k) point[k] = own.encoded(k, points[i * n + k]);
    population.push_back(point, objectives[i]);
  }
  if (nsga2) {
    // Crossover and mutation as Deb et al. (2002), one mutation for each point on average.
    pagmo::nsga2 method(options.generations, 0.9, 15.0, 1.0 / double(n), 20.0, options.seed);
    method.set_bfe(pagmo::bfe(pagmo::member_bfe()));
    pagmo::algorithm(method).evolve(population);
  } else {
    const unsigned neighbours = std::min(20u, options.population / 4);
    const pagmo::moead method(options.generations, m == 2 ? "grid" : "low discrepancy", "tchebycheff", neighbours, 1.0,
                              0.5, 20.0, 0.9, 2u, true, options.seed);
    pagmo::algorithm(method).evolve(population);
  }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const wingbeat::Evolve wingbeat_evolution_module;
const wingbeat::Evolve wingbeat_evolution_module = &evolve;
