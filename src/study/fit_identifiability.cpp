#include "study/fit_identifiability.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "study/bench_unknowns.hpp"
#include "study/fit_covariance.hpp"
#include "wingbeat/solve/singular_values.hpp"

namespace wingbeat {
namespace {

using FindingKind = FitFinding::Kind;
/// Relative standard errors from which a direction counts as left free, and as known only roughly.
constexpr double free_error = 1.0, rough_error = 0.2;

/// Scale of relative changes of a parameter.
double scale_of(const FreeParameter& p, double value) {
  if (p.of_bench && p.of_bench->kind >= BenchUnknown::Kind::phase) return unknown_scale(p);
  return value != 0.0 ? std::abs(value) : p.upper - p.lower;
}

/// The information of some observations in relative parameter changes.
Eigen::MatrixXd information(const BenchFitter& fitter, const FitNoise& noise, const std::vector<double>& scales,
                            const std::function<bool(const OperatingPoint&)>& counts) {
  const BenchModel& bench = fitter.bench();
  const Eigen::Index n = Eigen::Index(scales.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t o = 0; o < bench.observations().size(); ++o) {
    const std::size_t point = bench.observations()[o].point;
    if (!bench.predictions()[point].reached || !counts(bench.points()[point])) continue;
    Eigen::VectorXd row(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      row[k] = bench.jacobian()(Eigen::Index(o), k) * scales[std::size_t(k)] / fitter.deviations()[o];
    }
    sum += noise.efficiency(o) * row * row.transpose();
  }
  return sum;
}

/// A direction with its larger components, largest first.
FitFinding direction_finding(FitFinding::Kind kind, const std::vector<FreeParameter>& parameters,
                             const Eigen::VectorXd& v, double error) {
  std::vector<std::pair<double, std::string>> parts;
  for (Eigen::Index k = 0; k < v.size(); ++k) {
    if (std::abs(v[k]) > 0.1) parts.emplace_back(v[k], parameters[std::size_t(k)].parameter.key);
  }
  std::sort(parts.begin(), parts.end(),
            [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  FitFinding finding{.kind = kind, .relative_error = error};
  for (const auto& [part, key] : parts) {
    finding.parameters.push_back(key);
    finding.numbers.push_back(part);
  }
  return finding;
}

}  // namespace

void assess_identifiability(const BenchFit& fit, BenchFitter& fitter, const std::vector<double>& x,
                            const std::vector<std::size_t>& free, FitResult& result) {
  BenchModel& bench = fitter.bench();
  bench.evaluate(x, true);
  const Eigen::Index count = Eigen::Index(fit.parameters.size());
  std::vector<double> scales(fit.parameters.size());
  for (std::size_t k = 0; k < scales.size(); ++k) scales[k] = scale_of(fit.parameters[k], x[k]);
  const auto every = [](const OperatingPoint&) { return true; };
  const FitNoise noise(fit, fitter, free);
  const Eigen::MatrixXd all = information(fitter, noise, scales, every);

  // Without influence: even with all others known the bounds say more.
  std::vector<bool> insensitive(std::size_t(count), false), loose(std::size_t(count), false);
  for (Eigen::Index k = 0; k < count; ++k) {
    const FreeParameter& p = fit.parameters[std::size_t(k)];
    const double alone = all(k, k) > 0.0 ? scales[std::size_t(k)] / std::sqrt(all(k, k)) : infinity;
    insensitive[std::size_t(k)] = !(alone < p.upper - p.lower);
  }
  std::vector<Eigen::Index> sensitive;
  for (Eigen::Index k = 0; k < count; ++k) {
    if (!insensitive[std::size_t(k)]) sensitive.push_back(k);
  }
  const Eigen::Index m = Eigen::Index(sensitive.size());
  const auto restricted = [&](const Eigen::MatrixXd& full) {
    Eigen::MatrixXd part(m, m);
    for (Eigen::Index a = 0; a < m; ++a) {
      for (Eigen::Index b = 0; b < m; ++b) part(a, b) = full(sensitive[std::size_t(a)], sensitive[std::size_t(b)]);
    }
    return part;
  };
  std::vector<FitFinding> free_directions, rough_directions;
  if (m > 0) {
    const solver::SymmetricModes eigen = solver::symmetric_modes(restricted(all));
    for (Eigen::Index d = m - 1; d >= 0; --d) {
      const double lambda = eigen.values[d];
      const double least = 1e-14 * std::max(eigen.values[m - 1], 0.0);
      const double error = lambda > least ? 1.0 / std::sqrt(lambda) : infinity;
      Eigen::VectorXd full = Eigen::VectorXd::Zero(count);
      for (Eigen::Index a = 0; a < m; ++a) full[sensitive[std::size_t(a)]] = eigen.vectors(a, d);
      result.directions.push_back({{full.data(), full.data() + count}, error});
      if (error > free_error) {
        for (Eigen::Index k = 0; k < count; ++k) {
          if (std::abs(full[k]) > 0.1) loose[std::size_t(k)] = true;
        }
        free_directions.push_back(direction_finding(FindingKind::left_free, fit.parameters, full, error));
      } else {
        if (error > rough_error) {
          rough_directions.push_back(direction_finding(FindingKind::known_roughly, fit.parameters, full, error));
        }
      }
    }
  }
  // What is not determined widens the rest, as far as its bounds let it.
  std::vector<bool> unknown(std::size_t(count), false);
  for (std::size_t k = 0; k < unknown.size(); ++k) unknown[k] = insensitive[k] || loose[k];
  const FitCovariance errors = fit_covariance(fit, fitter, noise, scales, unknown);
  Eigen::MatrixXd covariance = errors.covariance;
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b) {
      if (unknown[std::size_t(a)] || unknown[std::size_t(b)]) covariance(a, b) = absent;
      covariance(a, b) *= scales[std::size_t(a)] * scales[std::size_t(b)];
    }
  }

  int reached = 0;
  for (std::size_t o = 0; o < bench.observations().size(); ++o) {
    reached += bench.predictions()[bench.observations()[o].point].reached;
  }
  result.degrees_of_freedom = reached - int(m);
  for (std::size_t k = 0; k < std::size_t(count); ++k) {
    const FreeParameter& p = fit.parameters[k];
    FittedParameter f;
    f.key = p.parameter.key;
    f.unit = p.parameter.unit;
    if (p.of_bench) {
      f.of = p.of_bench->kind >= BenchUnknown::Kind::phase ? FittedParameter::Of::log : FittedParameter::Of::balance;
    }
    f.kept = x[k];
    const double range = p.upper - p.lower;
    f.at_bound = x[k] - p.lower < 1e-6 * range || p.upper - x[k] < 1e-6 * range;
    if (insensitive[k]) {
      f.undetermined = Undetermined::without_influence;
      f.kept = p.start;
    } else if (loose[k]) {
      f.undetermined = Undetermined::free_with_others;
    } else {
      f.value = x[k];
      f.standard_error = std::sqrt(covariance(Eigen::Index(k), Eigen::Index(k)));
      f.quantile_95 = quantile_95(errors.freedom[k]);
      f.profile_rise_95 = square(f.quantile_95) * errors.rise[k];
      f.lower_95 = std::max(x[k] - f.quantile_95 * f.standard_error, p.lower);
      f.upper_95 = std::min(x[k] + f.quantile_95 * f.standard_error, p.upper);
    }
    result.parameters.push_back(f);
  }
  result.covariance.assign(std::size_t(count), std::vector<double>(std::size_t(count), absent));
  result.correlation = result.covariance;
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b) {
      result.covariance[std::size_t(a)][std::size_t(b)] = covariance(a, b);
      result.correlation[std::size_t(a)][std::size_t(b)] =
          covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
    }
  }

  // What each condition contributes.
  std::vector<std::pair<Condition, bool>> conditions;
  for (const OperatingPoint& p : bench.points()) {
    const std::pair<Condition, bool> c{p.condition, p.springs};
    if (std::find(conditions.begin(), conditions.end(), c) == conditions.end()) conditions.push_back(c);
  }
  for (const auto& [condition, springs] : conditions) {
    const auto of_this = [&, c = condition, s = springs](const OperatingPoint& p) {
      return p.condition == c && p.springs == s;
    };
    ConditionShare share;
    share.name = condition_name(condition, springs);
    const Eigen::MatrixXd own = information(fitter, noise, scales, of_this);
    for (Eigen::Index k = 0; k < count; ++k) share.share.push_back(all(k, k) > 0.0 ? own(k, k) / all(k, k) : 0.0);
    share.error_without.assign(std::size_t(count), infinity);
    if (m > 0) {
      const solver::SymmetricModes rest = solver::symmetric_modes(restricted(all - own));
      for (Eigen::Index a = 0; a < m; ++a) {
        double variance = 0.0;
        for (Eigen::Index d = 0; d < m; ++d) {
          const double component = rest.vectors(a, d), lambda = rest.values[d];
          const double least = 1e-12 * std::max(rest.values[m - 1], 0.0);
          if (lambda <= least ? std::abs(component) > 1e-4 : component * component / lambda > free_error * free_error) {
            variance = infinity;
          } else if (lambda > least) {
            variance += component * component / lambda;
          }
        }
        const std::size_t k = std::size_t(sensitive[std::size_t(a)]);
        share.error_without[k] = scales[k] * std::sqrt(variance);
      }
    }
    double squares = 0.0;
    for (std::size_t o = 0; o < bench.observations().size(); ++o) {
      const std::size_t point = bench.observations()[o].point;
      if (!bench.predictions()[point].reached || !of_this(bench.points()[point])) continue;
      squares += fitter.residual(o) * fitter.residual(o);
      ++share.points;
    }
    share.rms = share.points > 0 ? std::sqrt(squares / share.points) : absent;
    result.conditions.push_back(share);
  }

  const auto keys_where = [&](const auto& condition) {
    std::vector<std::string> keys;
    for (std::size_t k = 0; k < std::size_t(count); ++k) {
      if (condition(k)) keys.push_back(fit.parameters[k].parameter.key);
    }
    return keys;
  };
  std::vector<FitFinding>& findings = result.findings;
  const auto unheard = keys_where([&](std::size_t k) { return insensitive[k]; });
  if (!unheard.empty()) findings.push_back({.kind = FindingKind::without_influence, .parameters = unheard});
  findings.insert(findings.end(), free_directions.begin(), free_directions.end());
  findings.insert(findings.end(), rough_directions.begin(), rough_directions.end());
  if (free_directions.empty() && m > 0) {
    const auto known = keys_where([&](std::size_t k) {
      return result.parameters[k].value.has_value() && result.parameters[k].of != FittedParameter::Of::log;
    });
    findings.push_back({.kind = FindingKind::determined, .parameters = known});
    FitFinding alike{.kind = FindingKind::most_correlated, .numbers = {0.0}};
    for (std::size_t a = 0; a < std::size_t(count); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double r = result.correlation[a][b];
        if (result.parameters[a].of == FittedParameter::Of::log) continue;  // the logs' own stand behind the others
        if (!(std::abs(r) > std::abs(alike.numbers[0]))) continue;
        alike.numbers[0] = r;
        alike.parameters = {fit.parameters[b].parameter.key, fit.parameters[a].parameter.key};
      }
    }
    if (!alike.parameters.empty()) findings.push_back(alike);
  }
  for (const ConditionShare& c : result.conditions) {
    if (result.conditions.size() < 2) break;
    FitFinding lost{.kind = FindingKind::determined_by, .condition = c.name};
    FitFinding wider{.kind = FindingKind::narrowed_by, .condition = c.name};
    for (std::size_t k = 0; k < std::size_t(count); ++k) {
      const FittedParameter& p = result.parameters[k];
      if (!p.value || p.of == FittedParameter::Of::log) continue;
      if (!std::isfinite(c.error_without[k])) {
        lost.parameters.push_back(p.key);
      } else if (c.error_without[k] > 2.0 * p.standard_error) {
        wider.parameters.push_back(p.key);
        wider.numbers.push_back(c.error_without[k] / p.standard_error);
      }
    }
    if (!lost.parameters.empty()) findings.push_back(lost);
    if (!wider.parameters.empty()) findings.push_back(wider);
  }
  const auto product = keys_where([&](std::size_t k) { return fit.parameters[k].parameter.key == "friction.radius"; });
  if (!product.empty()) findings.push_back({.kind = FindingKind::product_of_friction, .parameters = product});
}

}  // namespace wingbeat
