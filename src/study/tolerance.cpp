#include "wingbeat/study/tolerance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "study/model_choices.hpp"
#include "wingbeat/cycle/metric_gradients.hpp"

namespace wingbeat {
namespace {

std::vector<std::size_t> correlated(const ToleranceStudy& study) {
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    if (study.parameters[k].correlated) which.push_back(k);
  }
  return which;
}

/// Lower triangular root of the covariance.
Eigen::MatrixXd root_of(const std::vector<std::vector<double>>& covariance) {
  const Eigen::Index n = Eigen::Index(covariance.size());
  // In units of the standard deviations: parameters differ by many powers of ten.
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = std::sqrt(covariance[std::size_t(i)][std::size_t(i)]);
  Eigen::MatrixXd c(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) c(i, j) = covariance[std::size_t(i)][std::size_t(j)] / (scale[i] * scale[j]);
  }
  const Eigen::LLT<Eigen::MatrixXd> factored(c);
  if (factored.info() != Eigen::Success || !c.allFinite()) {
    throw ParameterError("covariance.matrix", "is not positive definite");
  }
  return scale.asDiagonal() * factored.matrixL().toDenseMatrix();
}

/// Parameters that ToleranceStudy::correlations link with each other, each group in the order of the study.
std::vector<std::vector<std::size_t>> linked(const ToleranceStudy& study) {
  std::vector<std::size_t> group(study.parameters.size());
  for (std::size_t k = 0; k < group.size(); ++k) group[k] = k;
  for (const Correlation& c : study.correlations) {
    const std::size_t from = std::max(group[c.first], group[c.second]), to = std::min(group[c.first], group[c.second]);
    std::replace(group.begin(), group.end(), from, to);
  }
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t first = 0; first < group.size(); ++first) {
    std::vector<std::size_t> members;
    for (std::size_t k = first; k < group.size(); ++k) {
      if (group[k] == first) members.push_back(k);
    }
    if (members.size() > 1) groups.push_back(std::move(members));
  }
  return groups;
}

/// Correlation matrix of a group.
std::vector<std::vector<double>> correlation_of(const ToleranceStudy& study, const std::vector<std::size_t>& group) {
  std::vector<std::vector<double>> matrix(group.size(), std::vector<double>(group.size(), 0.0));
  const auto place = [&](std::size_t k) {
    return std::size_t(std::find(group.begin(), group.end(), k) - group.begin());
  };
  for (std::size_t i = 0; i < group.size(); ++i) matrix[i][i] = 1.0;
  for (const Correlation& c : study.correlations) {
    const std::size_t i = place(c.first), j = place(c.second);
    if (i < group.size()) matrix[i][j] = matrix[j][i] = c.value;
  }
  return matrix;
}

/// Whether every vehicle has a weight.
bool states_mass(const ToleranceStudy& study) {
  return study.design.mass && std::all_of(study.combinations.begin(), study.combinations.end(),
                                          [](const Design<double>& design) { return design.mass.has_value(); });
}

}  // namespace

SampleMoments moments_of(std::span<const double> values) {
  std::vector<double> there;
  for (const double x : values) {
    if (std::isfinite(x)) there.push_back(x);
  }
  SampleMoments moments;
  if (there.empty()) return moments;
  std::sort(there.begin(), there.end());
  double sum = 0.0, squares = 0.0;
  for (const double x : there) sum += x;
  moments.mean = sum / double(there.size());
  for (const double x : there) squares += (x - moments.mean) * (x - moments.mean);
  moments.deviation = there.size() > 1 ? std::sqrt(squares / double(there.size() - 1)) : absent;
  moments.min = there.front();
  moments.p025 = percentile(there, 0.025);
  moments.median = percentile(there, 0.5);
  moments.p975 = percentile(there, 0.975);
  moments.max = there.back();
  return moments;
}

std::vector<ToleranceFactor> factors(const ToleranceStudy& study) {
  std::vector<ToleranceFactor> result;
  const std::vector<std::size_t> together = correlated(study);
  if (!together.empty()) result.push_back({study.covariance_name, together, {}});
  const auto groups = linked(study);
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    if (study.parameters[k].correlated) continue;
    ToleranceFactor factor{study.parameters[k].parameter.key, {k}, {}};
    const auto own = std::find_if(groups.begin(), groups.end(), [k](const auto& group) {
      return std::find(group.begin(), group.end(), k) != group.end();
    });
    if (own != groups.end()) {
      if (own->front() != k) continue;
      factor.parameters = *own;
      for (std::size_t n = 1; n < own->size(); ++n) factor.name += " + " + study.parameters[(*own)[n]].parameter.key;
    }
    result.push_back(std::move(factor));
  }
  for (std::size_t k = 0; k < study.choices.size(); ++k) result.push_back({study.choices[k].name, {}, k});
  return result;
}

bool is_correlated(const ToleranceStudy& study, std::size_t parameter) {
  return study.parameters[parameter].correlated ||
         std::any_of(study.correlations.begin(), study.correlations.end(),
                     [&](const Correlation& c) { return c.first == parameter || c.second == parameter; });
}

std::vector<std::vector<double>> parameter_covariance(const ToleranceStudy& study) {
  const std::size_t n = study.parameters.size();
  std::vector<std::vector<double>> c(n, std::vector<double>(n, 0.0));
  for (std::size_t k = 0; k < n; ++k) c[k][k] = study.parameters[k].distribution.variance();
  const std::vector<std::size_t> together = correlated(study);
  for (std::size_t i = 0; i < together.size(); ++i) {
    for (std::size_t j = 0; j < together.size(); ++j) c[together[i]][together[j]] = study.covariance[i][j];
  }
  for (const Correlation& pair : study.correlations) {
    const Distribution &a = study.parameters[pair.first].distribution, &b = study.parameters[pair.second].distribution;
    const bool log_a = a.kind == DistributionKind::lognormal, log_b = b.kind == DistributionKind::lognormal;
    const double spreads = pair.value * a.spread * b.spread;
    // Moments of the joint (log)normal distribution.
    c[pair.first][pair.second] = c[pair.second][pair.first] =
        log_a && log_b ? a.mean() * b.mean() * std::expm1(spreads)
                       : spreads * (log_a ? a.mean() : 1.0) * (log_b ? b.mean() : 1.0);
  }
  return c;
}

std::uint64_t base_count(const ToleranceStudy& study) { return study.indices ? 2 * study.count : study.count; }

Sweep tolerance_sweep(const ToleranceStudy& study) {
  const std::size_t d = study.parameters.size();
  const std::size_t samples = study.indices ? 2 : 1;
  std::function<double(std::uint64_t, std::size_t)> uniform = PseudoRandom{study.seed};
  if (study.method == ToleranceMethod::sobol && d > 0) uniform = ScrambledSobol(samples * d, study.seed);

  const std::vector<std::size_t> together = correlated(study);
  Eigen::MatrixXd root;
  if (!together.empty()) root = root_of(study.covariance);
  const auto groups = linked(study);
  std::vector<Eigen::MatrixXd> roots;
  for (const auto& group : groups) roots.push_back(root_of(correlation_of(study, group)));
  const std::vector<ToleranceFactor> inputs = factors(study);
  const std::uint64_t blocks = study.indices ? 2 + inputs.size() : 1;

  SweepAxis axis;
  axis.name = "sample";
  axis.samples = true;
  axis.count = blocks * study.count;
  for (const UncertainParameter& p : study.parameters) {
    SweptQuantity q;
    q.key = p.parameter.key;
    q.name = q.key;
    std::replace(q.name.begin(), q.name.end(), '.', '_');
    q.unit = p.parameter.unit;
    q.set = p.parameter.set;
    q.values.reserve(axis.count);
    q.values.resize(samples * study.count);
    axis.quantities.push_back(std::move(q));
  }
  for (std::size_t s = 0; s < samples; ++s) {
    for (std::uint64_t n = 0; n < study.count; ++n) {
      Eigen::VectorXd z(Eigen::Index(together.size()));
      for (std::size_t k = 0, c = 0; k < d; ++k) {
        const double u = uniform(n, s * d + k);
        if (study.parameters[k].correlated) z[Eigen::Index(c++)] = normal_quantile(u);
        else axis.quantities[k].values[s * study.count + n] = study.parameters[k].distribution.quantile(u);
      }
      for (std::size_t g = 0; g < groups.size(); ++g) {
        Eigen::VectorXd scores(Eigen::Index(groups[g].size()));
        for (std::size_t i = 0; i < groups[g].size(); ++i) {
          scores[Eigen::Index(i)] = normal_quantile(uniform(n, s * d + groups[g][i]));
        }
        scores = roots[g] * scores;
        for (std::size_t i = 0; i < groups[g].size(); ++i) {
          const Distribution& distribution = study.parameters[groups[g][i]].distribution;
          axis.quantities[groups[g][i]].values[s * study.count + n] =
              distribution.quantile(normal_probability(scores[Eigen::Index(i)]));
        }
      }
      if (together.empty()) continue;
      const Eigen::VectorXd shift = root * z;
      for (std::size_t c = 0; c < together.size(); ++c) {
        axis.quantities[together[c]].values[s * study.count + n] =
            study.parameters[together[c]].distribution.centre + shift[Eigen::Index(c)];
      }
    }
  }
  if (study.indices) {
    for (const ToleranceFactor& factor : inputs) {
      for (std::size_t k = 0; k < d; ++k) {
        const bool own = std::find(factor.parameters.begin(), factor.parameters.end(), k) != factor.parameters.end();
        std::vector<double>& values = axis.quantities[k].values;
        for (std::uint64_t n = 0; n < study.count; ++n) values.push_back(values[(own ? study.count : 0) + n]);
      }
    }
  }

  Sweep sweep;
  sweep.axes.push_back(std::move(axis));
  if (study.choices.empty()) {
    sweep.variants.push_back({study.design, study.condition, true});
  } else {
    for (const Design<double>& design : study.combinations) sweep.variants.push_back({design, study.condition, true});
    sweep.drawn_variants = drawn_combinations(study);
  }
  sweep.variant_stride = {0};
  sweep.hold = study.hold;
  sweep.options = study.options;
  sweep.allow_extrapolation = study.allow_extrapolation;
  return sweep;
}

Probability probability_of(std::uint64_t count, std::uint64_t total) {
  // Wilson, JASA 22, 1927.
  static const double z = normal_quantile(0.975);
  const double n = double(total), p = double(count) / n;
  const double middle = p + z * z / (2.0 * n), half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  const double scale = 1.0 / (1.0 + z * z / n);
  return {count, p, count == 0 ? 0.0 : scale * (middle - half), count == total ? 1.0 : scale * (middle + half)};
}

const ToleranceOutput* ToleranceResult::find(std::string_view name) const {
  for (const ToleranceOutput& output : outputs) {
    if (output.name == name) return &output;
  }
  return nullptr;
}

ToleranceResult assess_tolerance(const ToleranceStudy& study, const SweepColumns& columns, const StartUp& start_up) {
  const std::uint64_t base = base_count(study), rows = study.count;
  const std::vector<ToleranceFactor> inputs = factors(study);
  ToleranceResult result;
  result.vehicles = columns.status.size();
  std::array<std::uint64_t, sweep_status_count> counts{};
  for (std::uint64_t n = 0; n < base; ++n) ++counts[static_cast<unsigned char>(columns.status[n])];
  for (std::size_t s = 0; s < counts.size(); ++s) result.status[s] = probability_of(counts[s], base);

  std::uint64_t outside = 0;
  for (std::uint64_t n = 0; n < base; ++n) {
    outside += columns.domain[n] != 0;
    for (std::size_t k = 0; k < result.beyond.size(); ++k) result.beyond[k] += columns.domain[n] >> k & 1;
  }
  result.outside = probability_of(outside, base);

  Design<double> centre = study.design;
  std::vector<DesignParameter> parameters;
  for (const UncertainParameter& p : study.parameters) {
    p.parameter.set(centre, p.distribution.mean());
    parameters.push_back(p.parameter);
  }
  DesignPointOptions options{study.condition, study.hold, study.options.tolerance, true,
                             flight_metrics(study.options.metrics, study.allow_extrapolation)};
  if (options.hold) options.hold->range = search_range(study.allow_extrapolation);
  result.centre = design_point(centre, options, parameters, start_up);
  const auto covariance = parameter_covariance(study);

  const auto add_linear = [&](ToleranceOutput& output, Metric metric) {
    if (result.centre.status != SweepStatus::flapping) return;
    if (result.centre.domain.any() && !study.allow_extrapolation) return;
    const auto slope = [&](std::size_t k) { return result.centre.gradients[k][std::size_t(metric)]; };
    double variance = 0.0;
    std::vector<double> parts;
    for (const ToleranceFactor& factor : inputs) {
      double part = 0.0;
      for (const std::size_t k : factor.parameters) {
        for (const std::size_t l : factor.parameters) part += slope(k) * covariance[k][l] * slope(l);
      }
      variance += part;
      parts.push_back(factor.choice ? absent : part);
    }
    if (!std::isfinite(variance)) return;
    output.linear_mean = result.centre.metrics[metric];
    output.linear_deviation = std::sqrt(variance);
    if (!(variance > 0.0)) return;
    for (const double part : parts) output.linear_share.push_back(part / variance);
  };
  const auto add_indices = [&](ToleranceOutput& output, std::span<const double> values) {
    if (!study.indices) return;
    std::vector<std::vector<double>> mixed;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const auto from = values.begin() + std::ptrdiff_t((2 + i) * rows);
      mixed.emplace_back(from, from + std::ptrdiff_t(rows));
    }
    output.indices =
        sobol_indices(values.subspan(0, rows), values.subspan(rows, rows), mixed, study.resamples, study.seed);
  };

  const std::vector<std::uint32_t> combinations = drawn_combinations(study);
  const auto add_output = [&](ToleranceOutput& output, std::span<const double> values) {
    static_cast<SampleMoments&>(output) = moments_of(values.subspan(0, base));
    if (!study.choices.empty()) detail::add_choice_effects(output, study, values.subspan(0, base), combinations);
  };
  std::vector<double> lift_to_weight;
  double carries = 1.0;

  std::size_t column = 0;
  for (int m = 0; m < metric_count; ++m) {
    if (!study.options.metrics[std::size_t(m)]) continue;
    std::vector<double> values = columns.metrics[column++];
    for (std::size_t n = 0; n < values.size(); ++n) {
      if (!columns.counts(n, study.allow_extrapolation)) values[n] = absent;
    }
    ToleranceOutput output;
    output.name = metric_info(Metric(m)).key;
    output.metric = Metric(m);
    add_output(output, values);
    add_linear(output, Metric(m));
    // The Floquet multiplier stands near zero, where its error is all there is.
    const bool varies = output.deviation > study.options.tolerance * std::abs(output.mean);
    if (varies && Metric(m) != Metric::floquet_multiplier_max) add_indices(output, values);
    result.outputs.push_back(std::move(output));

    if (Metric(m) != Metric::lift_to_weight || !states_mass(study)) continue;
    std::vector<double> hovers(values.size());
    // A held lift is as exact as the tolerance.
    const bool held = study.hold && study.hold->held == Held::lift_to_weight;
    if (held) carries -= study.options.tolerance;
    std::uint64_t count = 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
      hovers[n] = values[n] >= carries ? 1.0 : 0.0;
      if (n < base) count += values[n] >= carries;
    }
    result.hover = probability_of(count, base);
    const ToleranceOutput& lift = result.outputs.back();
    if (lift.linear_deviation > 0.0 && !held) {
      result.linear_hover = normal_probability((lift.linear_mean - 1.0) / lift.linear_deviation);
    }
    lift_to_weight = std::move(values);
    if (count == 0 || count == base) continue;
    ToleranceOutput indicator;
    indicator.name = "hovers";
    add_output(indicator, hovers);
    add_indices(indicator, hovers);
    result.outputs.push_back(std::move(indicator));
  }
  if (counts[0] > 0 && counts[0] < base) {
    std::vector<double> flaps(columns.status.size());
    for (std::size_t n = 0; n < flaps.size(); ++n) flaps[n] = columns.status[n] == 0 ? 1.0 : 0.0;
    ToleranceOutput indicator;
    indicator.name = "flaps";
    add_output(indicator, flaps);
    add_indices(indicator, flaps);
    result.outputs.push_back(std::move(indicator));
  }
  result.choices = detail::alternative_samples(study, columns, combinations, lift_to_weight, carries);
  return result;
}

std::span<const double> samples_of(const ToleranceStudy& study, const SweepColumns& columns, Metric metric) {
  std::size_t column = 0;
  for (int m = 0; m < int(metric); ++m) column += study.options.metrics[std::size_t(m)];
  return std::span(columns.metrics[column]).subspan(0, base_count(study));
}

}  // namespace wingbeat
