#include "wingbeat/study/own_search.hpp"

#include <algorithm>
#include <cmath>

#include "study/local_search.hpp"
#include "study/optimise_screen.hpp"
#include "wingbeat/study/sampling.hpp"

namespace wingbeat {
namespace {

using detail::LocalSearch;
using detail::OptimiseProblem;
using detail::Vector;

/// The study's problem with the caller's objective in place of its own, and the caller's constraints behind its own.
OptimiseProblem::Evaluation own_evaluation(const OptimiseProblem& problem, const OwnTerms& terms, const Vector& u,
                                           bool gradients, bool& differentiated) {
  OptimiseProblem::Evaluation e = problem.evaluate(u, gradients);
  const Eigen::Index m = problem.constraints(), own = Eigen::Index(terms.constraints), n = problem.size();
  e.constraints.conservativeResize(m + own);
  e.constraints.tail(own).setOnes();
  e.jacobian.conservativeResize(m + own, n);
  e.jacobian.bottomRows(own).setZero();
  if (!e.flaps) return e;
  const std::vector<OwnTerm> found = terms.evaluate(problem.found(u, e.point), e.point);
  for (const OwnTerm& term : found) {
    differentiated = differentiated && term.differentiated;
    if (gradients && !term.differentiated) {
      throw ParameterError("objective", "gave derivatives with its value before, and gives none now");
    }
  }
  const auto row = [&](const OwnTerm& term) {
    Vector slopes = Vector::Zero(n);
    for (Eigen::Index k = 0; k < n && gradients; ++k) {
      double slope = term.by_parameter.empty() ? 0.0 : term.by_parameter[std::size_t(k)];
      for (std::size_t metric = 0; metric < metric_count; ++metric) {
        // A metric that is absent has no derivative, which matters where it is used alone.
        if (term.by_metric[metric] != 0.0) slope += term.by_metric[metric] * e.point.gradients[std::size_t(k)][metric];
      }
      slopes[k] = slope * problem.slope(k, u[k]);
    }
    return slopes;
  };
  e.objective = found[0].value;
  e.gradient = row(found[0]);
  for (Eigen::Index c = 0; c < own; ++c) {
    const OwnTerm& term = found[std::size_t(c) + 1];
    e.constraints[m + c] = term.value;
    e.jacobian.row(m + c) = row(term).transpose();
  }
  e.flaps = std::isfinite(e.objective) && e.constraints.allFinite() && e.gradient.allFinite() && e.jacobian.allFinite();
  if (!e.flaps) e.objective = HUGE_VAL;
  return e;
}

}  // namespace

OwnOptimum optimise_own(const OptimiseStudy& study, const OwnTerms& terms, const StartUp& start_up) {
  const OptimiseProblem problem(study, start_up);
  OwnOptimum result;
  bool differentiated = true;
  const auto evaluate = [&](const Vector& u) {
    ++result.evaluations;
    return own_evaluation(problem, terms, u, false, differentiated);
  };

  std::vector<Vector> starts;
  const std::optional<Vector> given = problem.given();
  if (given && evaluate(*given).flaps) starts.push_back(*given);

  struct Rank {
    double violation, objective;
    std::uint64_t n;
    auto operator<=>(const Rank&) const = default;
  };
  std::vector<Rank> ranks;
  const ScrambledSobol sobol(study.parameters.size(), study.seed);
  const auto sample = [&](std::uint64_t n) {
    Vector u(problem.size());
    for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = sobol(n, std::size_t(k));
    return u;
  };
  for (std::uint64_t n = 0; n < study.screen; ++n) {
    const OptimiseProblem::Evaluation e = evaluate(sample(n));
    if (e.flaps) ranks.push_back({e.violation(), e.objective, n});
  }
  std::sort(ranks.begin(), ranks.end());
  std::vector<Vector> ranked;
  for (const Rank& rank : ranks) ranked.push_back(sample(rank.n));
  for (const Vector& u : detail::spread(ranked, std::size_t(study.starts) - starts.size())) starts.push_back(u);
  if (starts.empty()) return result;

  const bool gradients = differentiated;
  const detail::SearchedFunction function{
      problem.size(), problem.constraints() + Eigen::Index(terms.constraints), gradients,
      [&](const Vector& u) { return own_evaluation(problem, terms, u, gradients, differentiated); }};
  result.gradients = gradients;
  std::vector<LocalSearch> searches(starts.size());
  const LocalSearch* best = nullptr;
  const auto values = [&](const Vector& u) {
    std::vector<double> x;
    for (Eigen::Index k = 0; k < u.size(); ++k) x.push_back(problem.value(k, u[k]));
    return x;
  };
  for (std::size_t n = 0; n < starts.size(); ++n) {
    LocalSearch& s = searches[n];
    s.run(function, starts[n]);
    result.evaluations += s.evaluations;
    result.searches.push_back({values(starts[n]), s.feasible ? values(s.end) : std::vector<double>(), s.began,
                               s.feasible ? s.objective : absent, s.evaluations});
    if (s.feasible && (!best || s.objective < best->objective)) best = &s;
  }
  result.starts = int(starts.size());
  result.outcome = best ? OptimiseResult::Outcome::found : OptimiseResult::Outcome::infeasible;
  for (const LocalSearch& s : searches) {
    const bool same = s.feasible && s.objective - best->objective <= 1e-4 * std::abs(best->objective);
    (same ? result.same : s.feasible ? result.elsewhere : result.failed)++;
  }
  if (!best) return result;
  result.parameters = values(best->end);
  result.objective = best->objective;
  result.design = problem.found(best->end, problem.evaluate(best->end, false).point);
  return result;
}

}  // namespace wingbeat
