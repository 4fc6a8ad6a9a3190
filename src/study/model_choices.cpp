#include "study/model_choices.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace wingbeat {
namespace {

double total_weight(const ModelChoice& choice) {
  double total = 0.0;
  for (const ModelAlternative& alternative : choice.alternatives) total += alternative.weight;
  return total;
}

/// The alternative at a place between 0 and 1 along the cumulative shares.
std::uint32_t alternative_at(const ModelChoice& choice, double u) {
  double left = u * total_weight(choice);
  for (std::size_t a = 0; a + 1 < choice.alternatives.size(); ++a) {
    left -= choice.alternatives[a].weight;
    if (left < 0.0) return std::uint32_t(a);
  }
  return std::uint32_t(choice.alternatives.size() - 1);
}

/// Mean and sum of squared deviations of values that come one by one (Welford, Technometrics 4, 1962).
struct RunningMoments {
  std::uint64_t count = 0;
  double mean = 0.0, squares = 0.0;

  void add(double x) {
    const double step = x - mean;
    mean += step / double(++count);
    squares += step * (x - mean);
  }
};

}  // namespace

double ModelChoice::share(std::size_t alternative) const {
  return alternatives[alternative].weight / total_weight(*this);
}

std::size_t ModelChoice::likeliest() const {
  const auto lighter = [](const ModelAlternative& a, const ModelAlternative& b) { return a.weight < b.weight; };
  return std::size_t(std::max_element(alternatives.begin(), alternatives.end(), lighter) - alternatives.begin());
}

std::size_t combination_count(std::span<const ModelChoice> choices) {
  std::size_t count = 1;
  for (const ModelChoice& choice : choices) count *= choice.alternatives.size();
  return count;
}

std::size_t alternative_in(std::span<const ModelChoice> choices, std::size_t combination, std::size_t choice) {
  return combination / combination_count(choices.subspan(choice + 1)) % choices[choice].alternatives.size();
}

std::vector<std::uint32_t> drawn_combinations(const ToleranceStudy& study) {
  const std::size_t c = study.choices.size();
  if (c == 0) return {};
  const std::size_t samples = study.indices ? 2 : 1;
  // Behind the dimensions of the parameters, whose values then do not depend on choices.
  const std::size_t first = samples * study.parameters.size();
  std::function<double(std::uint64_t, std::size_t)> uniform = PseudoRandom{study.seed};
  if (study.method == ToleranceMethod::sobol) uniform = ScrambledSobol(first + samples * c, study.seed);

  std::vector<std::vector<std::uint32_t>> alternatives(c);
  for (std::size_t k = 0; k < c; ++k) {
    for (std::size_t s = 0; s < samples; ++s) {
      for (std::uint64_t n = 0; n < study.count; ++n) {
        alternatives[k].push_back(alternative_at(study.choices[k], uniform(n, first + s * c + k)));
      }
    }
  }
  if (study.indices) {
    for (const ToleranceFactor& factor : factors(study)) {
      for (std::size_t k = 0; k < c; ++k) {
        const std::uint64_t from = factor.choice == k ? study.count : 0;
        for (std::uint64_t n = 0; n < study.count; ++n) alternatives[k].push_back(alternatives[k][from + n]);
      }
    }
  }
  std::vector<std::uint32_t> combinations(alternatives.front().size(), 0);
  for (std::size_t k = 0; k < c; ++k) {
    const std::uint32_t count = std::uint32_t(study.choices[k].alternatives.size());
    for (std::size_t n = 0; n < combinations.size(); ++n) {
      combinations[n] = combinations[n] * count + alternatives[k][n];
    }
  }
  return combinations;
}

void detail::add_choice_effects(ToleranceOutput& output, const ToleranceStudy& study, std::span<const double> values,
                                std::span<const std::uint32_t> combinations) {
  std::vector<RunningMoments> by_combination(combination_count(study.choices));
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (std::isfinite(values[n])) by_combination[combinations[n]].add(values[n]);
  }
  std::uint64_t freedom = 0;
  double within = 0.0;
  for (const RunningMoments& m : by_combination) {
    if (m.count == 0) continue;
    freedom += m.count - 1;
    within += m.squares;
  }
  if (freedom > 0) output.deviation_by_parameters = std::sqrt(within / double(freedom));

  for (std::size_t k = 0; k < study.choices.size(); ++k) {
    std::vector<RunningMoments> moments(study.choices[k].alternatives.size());
    for (std::size_t n = 0; n < values.size(); ++n) {
      if (std::isfinite(values[n])) moments[alternative_in(study.choices, combinations[n], k)].add(values[n]);
    }
    ChoiceEffect effect;
    for (const RunningMoments& m : moments) {
      ConditionalMoments conditional{m.count};
      if (m.count > 0) conditional.mean = m.mean;
      if (m.count > 1) conditional.deviation = std::sqrt(m.squares / double(m.count - 1));
      effect.alternatives.push_back(conditional);
    }
    const auto lower = [](const RunningMoments& a, const RunningMoments& b) { return a.mean < b.mean; };
    const auto [low, high] = std::minmax_element(moments.begin(), moments.end(), lower);
    const bool all = std::all_of(moments.begin(), moments.end(), [](const RunningMoments& m) { return m.count > 0; });
    if (all) effect.difference = high->mean - low->mean;
    output.choices.push_back(std::move(effect));
  }
}

std::vector<std::vector<AlternativeSamples>> detail::alternative_samples(const ToleranceStudy& study,
                                                                         const SweepColumns& columns,
                                                                         std::span<const std::uint32_t> combinations,
                                                                         std::span<const double> lift_to_weight,
                                                                         double carries) {
  std::vector<std::vector<AlternativeSamples>> all;
  for (std::size_t k = 0; k < study.choices.size(); ++k) {
    const std::size_t alternatives = study.choices[k].alternatives.size();
    std::vector<std::uint64_t> count(alternatives, 0), flapping = count, hover = count;
    for (std::uint64_t n = 0; n < base_count(study); ++n) {
      const std::size_t a = alternative_in(study.choices, combinations[n], k);
      ++count[a];
      flapping[a] += columns.status[n] == std::int8_t(SweepStatus::flapping);
      if (!lift_to_weight.empty()) hover[a] += lift_to_weight[n] >= carries;
    }
    std::vector<AlternativeSamples> samples(alternatives);
    for (std::size_t a = 0; a < alternatives; ++a) {
      samples[a].count = count[a];
      if (count[a] == 0) continue;
      samples[a].flapping = probability_of(flapping[a], count[a]);
      if (!lift_to_weight.empty()) samples[a].hover = probability_of(hover[a], count[a]);
    }
    all.push_back(std::move(samples));
  }
  return all;
}

}  // namespace wingbeat
