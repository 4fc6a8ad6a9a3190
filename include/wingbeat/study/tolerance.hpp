// What uncertain parameters and choices of model do to a vehicle's metrics: samples of their joint distribution, solved
// as a sweep, and the linear prediction from the gradient beside them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/distribution.hpp"
#include "wingbeat/study/sobol_indices.hpp"
#include "wingbeat/study/sweep.hpp"

namespace wingbeat {

struct UncertainParameter {
  DesignParameter parameter;
  Distribution distribution;
  bool correlated = false;  ///< one of those that share ToleranceStudy::covariance; `distribution` is its marginal
};

/// Correlation of two parameters, by their places, neither of them one of a covariance: of a lognormal parameter that
/// of its logarithm. Both without bounds.
struct Correlation {
  std::size_t first = 0, second = 1;
  double value = 0.0;  ///< -1 to 1, exclusive
};

/// One of the models that a choice is among.
struct ModelAlternative {
  std::string name;
  double weight = 1.0;  ///< > 0; of the sum over the choice it is the share of the samples
};

/// A choice of model, drawn like a parameter and independent of all else.
struct ModelChoice {
  std::string name;
  std::vector<std::string> keys;  ///< of the vehicle, that its alternatives set
  std::vector<ModelAlternative> alternatives;

  double share(std::size_t alternative) const;
  std::size_t likeliest() const;  ///< the first of equals
};

enum class ToleranceMethod {
  sobol,       ///< scrambled Sobol sequence
  monte_carlo  ///< pseudo-random
};
template <>
inline constexpr std::pair<const char*, ToleranceMethod> names_of<ToleranceMethod>[] = {
    {"sobol", ToleranceMethod::sobol}, {"monte-carlo", ToleranceMethod::monte_carlo}};

struct ToleranceStudy {
  std::string title;
  Design<double> design;
  Condition condition = Condition::air;
  std::optional<Hold> hold;  ///< the voltage follows
  EnsembleOptions options;
  std::vector<UncertainParameter> parameters;
  std::vector<std::vector<double>> covariance;  ///< of the correlated parameters, in their order [SI]; or empty
  std::string covariance_name;                  ///< what they are called together
  std::vector<Correlation> correlations;        ///< of others, pair by pair; 0 for pairs that are not named
  std::vector<ModelChoice> choices;
  /// With choices: the vehicle with each combination of their alternatives, those of the last choice varying fastest.
  /// `design` has the most likely ones.
  std::vector<Design<double>> combinations;
  ToleranceMethod method = ToleranceMethod::sobol;
  std::uint64_t count = 1024;  ///< N: rows of one sample
  std::uint64_t seed = 1;
  bool indices = true;               ///< Sobol indices: 2 N vehicles and N more for each factor, instead of N
  int resamples = 500;               ///< of the bootstrap
  bool allow_extrapolation = false;  ///< samples outside the model's domain count and may hover
};

/// Inputs that vary independently of each other: each parameter, the correlated ones together, and each choice.
struct ToleranceFactor {
  std::string name;
  std::vector<std::size_t> parameters;
  std::optional<std::size_t> choice = {};  ///< in the stead of parameters
};
std::vector<ToleranceFactor> factors(const ToleranceStudy& study);

/// True for a parameter that does not vary independently of all others.
bool is_correlated(const ToleranceStudy& study, std::size_t parameter);

/// The covariance matrix of all parameters [SI].
std::vector<std::vector<double>> parameter_covariance(const ToleranceStudy& study);

/// Number of combinations of the choices' alternatives, and the alternative that a choice has in one of them.
std::size_t combination_count(std::span<const ModelChoice> choices);
std::size_t alternative_in(std::span<const ModelChoice> choices, std::size_t combination, std::size_t choice);
/// The combination of each vehicle of tolerance_sweep(study); empty without choices.
std::vector<std::uint32_t> drawn_combinations(const ToleranceStudy& study);

/// Vehicles of the plain sample: N, or 2 N with indices. The others mix rows of its two halves.
std::uint64_t base_count(const ToleranceStudy& study);
/// The samples' values of an output that is a metric, those outside the domain included.
std::span<const double> samples_of(const ToleranceStudy& study, const SweepColumns& columns, Metric metric);

/// All vehicles of the study as one axis of samples: A, B, then A with the factor i taken from B for each i. Throws
/// ParameterError for more parameters and choices than a Sobol sequence has dimensions and for a covariance that is not
/// positive definite. Parameters have the values that they have without the choices.
Sweep tolerance_sweep(const ToleranceStudy& study);

/// A share of the samples with its 95 % interval (Wilson; wider than need be for a Sobol sequence).
struct Probability {
  std::uint64_t count = 0;
  double share = 0.0, lower = 0.0, upper = 1.0;
};
Probability probability_of(std::uint64_t count, std::uint64_t total);

/// An output where a choice has one of its alternatives.
struct ConditionalMoments {
  std::uint64_t count = 0;  ///< of samples with a value
  double mean = absent, deviation = absent;
};

/// What a choice does to an output.
struct ChoiceEffect {
  std::vector<ConditionalMoments> alternatives;
  double difference = absent;  ///< largest one of two conditional means; absent where an alternative has none
};

/// Moments and percentiles of samples; absent where there are none.
struct SampleMoments {
  double mean = absent, deviation = absent;
  double min = absent, p025 = absent, median = absent, p975 = absent, max = absent;
};
/// Those of the values that are finite.
SampleMoments moments_of(std::span<const double> values);

/// One output of the study. Moments and percentiles are of the vehicles that flap inside the model's domain, or of all
/// that flap where extrapolation is allowed.
struct ToleranceOutput : SampleMoments {
  std::string name;  ///< key of the metric; "flaps", "hovers" for 0 or 1
  std::optional<Metric> metric;
  double linear_mean = absent, linear_deviation = absent;  ///< from the gradient at the parameters' means
  std::vector<double> linear_share;     ///< of the linear variance, by factor, NaN for a choice; empty if there is none
  std::optional<SobolIndices> indices;  ///< where it varies by more than the tolerance of the orbits
  std::vector<ChoiceEffect> choices;    ///< of the study, in their order
  /// With choices: standard deviation by the parameters alone, pooled over the combinations of alternatives.
  double deviation_by_parameters = absent;
};

/// The samples in which a choice has one of its alternatives.
struct AlternativeSamples {
  std::uint64_t count = 0;
  Probability flapping;
  std::optional<Probability> hover;  ///< as ToleranceResult::hover
};

struct ToleranceResult {
  std::uint64_t vehicles = 0;  ///< solved, those for indices included
  std::array<Probability, sweep_status_count> status;
  Probability outside;                                     ///< flapping, but outside the model's domain
  std::array<std::uint64_t, domain_limit_count> beyond{};  ///< samples, by DomainLimit
  std::optional<Probability> hover;  ///< lift_to_weight >= 1 by what counts, where the mass is known
  double linear_hover = absent;      ///< the same from the linear prediction; absent where it has none
  DesignPoint centre;                ///< at the parameters' means, with the most likely alternatives
  std::vector<ToleranceOutput> outputs;
  std::vector<std::vector<AlternativeSamples>> choices;  ///< of the study, by alternative

  const ToleranceOutput* find(std::string_view name) const;
};

/// Sums up the solved sweep of tolerance_sweep(study).
ToleranceResult assess_tolerance(const ToleranceStudy& study, const SweepColumns& columns, const StartUp& start_up);

}  // namespace wingbeat
