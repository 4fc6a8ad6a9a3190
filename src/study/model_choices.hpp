// What choices of model do to the outputs of a tolerance study.
#pragma once

#include <span>
#include <vector>

#include "wingbeat/study/tolerance.hpp"

namespace wingbeat::detail {

/// ChoiceEffect of each choice and the deviation by the parameters alone, from an output's values in the plain sample.
/// `combinations` begins with those of the sample.
void add_choice_effects(ToleranceOutput& output, const ToleranceStudy& study, std::span<const double> values,
                        std::span<const std::uint32_t> combinations);

/// The samples of each alternative; `lift_to_weight` of the plain sample, NaN where it does not count, and at least
/// `carries` where a vehicle hovers. Empty: none has a weight.
std::vector<std::vector<AlternativeSamples>> alternative_samples(const ToleranceStudy& study,
                                                                 const SweepColumns& columns,
                                                                 std::span<const std::uint32_t> combinations,
                                                                 std::span<const double> lift_to_weight,
                                                                 double carries);

}  // namespace wingbeat::detail
