// Pieces of the report's HTML.
#pragma once

#include <string>

#include "reproduction/sheet.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat::reproduction {

using detail::markup_escaped;

/// Of the page: its style sheet and its script.
std::string page_style();
std::string page_script();

/// Text with minus signs in place of the hyphens before digits that begin a number.
std::string with_minus_signs(std::string html);

/// The answer to the title question with its numbers.
std::string answer_html(const Material& m);
/// What the report says before any figure: how many predictions are met, what is not, errors of the paper, equation
/// (1).
std::string summary_html(const Material& m);
/// Parameters with where each one stands, and how S_2 and S_3 were calibrated.
std::string parameters_html(const Material& m);
/// Section 5 in both readings, and which of them the numbers support.
std::string readings_html(const Material& m);
/// What the intervals of computed numbers are made of.
std::string uncertainty_html(const Material& m);
/// Every statement against its tolerance: a table that a narrow page shows as a list.
std::string scorecard_html(const Assessment& a);
/// The table of all statements.
std::string claims_html(const Assessment& a);
/// The title question.
std::string question_html(const Material& m);

/// What physics beyond the paper's model does to its conclusions.
std::string further_html(const Material& m);

/// The prediction of a rival by a variant; nullptr where it was not asked for.
const LawPrediction* law_of(const Assessment& a, std::size_t rival, std::size_t variant);

}  // namespace wingbeat::reproduction
