// What choices of model are worth, as text and JSON: parts of the report of a tolerance study.
#pragma once

#include <string>

#include "report/described.hpp"
#include "wingbeat/study/tolerance.hpp"

namespace wingbeat {

/// "translational-2022 50 %, robobee 50 %"
std::string alternatives_text(const ModelChoice& choice);
/// "translational-2022 (coefficients), none (added_mass)": the vehicle of the linear prediction.
std::string likeliest_text(const ToleranceStudy& study);
/// A table for each choice: what its alternatives do, and every metric that varies where each of them is chosen.
std::string text_choices(const ToleranceStudy& study, const ToleranceResult& result);

namespace described {

/// A choice of a study with what came out.
struct ChoiceFound {
  const ToleranceStudy& study;
  const ToleranceResult& result;
  std::size_t place;
  const ModelChoice& choice() const { return study.choices[place]; }
};
const Description<ChoiceFound>& choice_description();

}  // namespace described

}  // namespace wingbeat
