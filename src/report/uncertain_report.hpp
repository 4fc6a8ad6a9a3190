// Uncertain parameters and probabilities, as text and JSON: parts of the reports of tolerance studies.
#pragma once

#include <string>
#include <vector>

#include "report/described.hpp"
#include "wingbeat/study/tolerance.hpp"

namespace wingbeat {

/// A share in percent, never rounded to certainty.
std::string probability_text(double share);
/// The heading "Uncertain parameters" and a line for each, with correlations.
std::string text_uncertain(const ToleranceStudy& study);
/// A table of probabilities: its heading, and a line of it.
inline constexpr const char* probability_head = "\nProbability                             95 % interval\n";
std::string probability_line(const char* name, const Probability& p, const std::string& note = "");

namespace described {

struct UncertainKey {
  const ToleranceStudy& study;
  std::size_t place;
  const UncertainParameter& parameter() const { return study.parameters[place]; }
};
std::vector<UncertainKey> uncertain_keys(const ToleranceStudy& study);
const Description<UncertainKey>& uncertain_description();

const Description<Probability>& probability_description();
const Description<SampleMoments>& moments_description();

}  // namespace described

}  // namespace wingbeat
