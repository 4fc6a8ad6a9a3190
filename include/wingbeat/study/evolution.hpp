// Evolution of a population towards the Pareto front of several objectives: the plain interface of a library that is
// loaded where it is asked for.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "wingbeat/core/names.hpp"

namespace wingbeat {

/// Objectives, all to be minimised, of points whose coordinates are numbers from 0 to 1, then whole numbers.
struct EvolutionProblem {
  std::size_t continuous = 0;             ///< coordinates from 0 to 1
  std::vector<std::size_t> choices = {};  ///< of each whole number, 0 to choices[k] - 1; each at least 2
  std::size_t objectives = 2;
  /// Objectives of any number of points, point after point.
  std::function<void(std::span<const double> points, std::span<double> values)> evaluate;

  std::size_t dimensions() const { return continuous + choices.size(); }
};

enum class EvolutionMethod {
  nsga2,  ///< Deb, Pratap, Agarwal and Meyarivan, IEEE Trans. Evol. Comput. 6(2), 2002
  moead   ///< MOEA/D-DE: Li and Zhang, IEEE Trans. Evol. Comput. 13(2), 2009
};
template <>
inline constexpr std::pair<const char*, EvolutionMethod> names_of<EvolutionMethod>[] = {
    {"nsga2", EvolutionMethod::nsga2}, {"moead", EvolutionMethod::moead}};

struct EvolutionOptions {
  EvolutionMethod method = EvolutionMethod::nsga2;
  unsigned population = 100;   ///< a multiple of 4, at least 8
  unsigned generations = 100;  ///< as many points as the population each
  unsigned seed = 1;
};

/// Evolves the best of the points given, at least as many as the population; all that is evaluated passes through
/// EvolutionProblem::evaluate: NSGA-II asks for a generation at once, MOEA/D for one point after another.
using Evolve = void (*)(const EvolutionProblem& problem, const EvolutionOptions& options,
                        std::span<const double> points, std::span<const double> values);

}  // namespace wingbeat
