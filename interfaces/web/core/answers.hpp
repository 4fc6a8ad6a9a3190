// What the core answers, described once: the JSON is written by these descriptions, and the page's types are made from
// them by scripts/make-web-types.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "wingbeat/wingbeat.hpp"

namespace wingbeat::web {

using Json = nlohmann::ordered_json;

/// Keys, metrics and columns of waveforms.
Json tables_of_the_library();
Json solved_answer(const RunResult& result);
Json start_up_answer(const TransientResult& result);
Json mechanism_answer(const Vehicle<double>& vehicle);

/// The schema of each answer by the name of its type.
Json answer_schemas();

}  // namespace wingbeat::web
