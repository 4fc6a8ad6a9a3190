// What the core answers, described once: the JSON is written by these descriptions, and the page's types are made from
// them by scripts/describe-results.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/wingbeat.hpp"

namespace wingbeat::web {

using Json = nlohmann::ordered_json;

/// What the library refuses, in its own sentence.
struct Problem {
  std::string message;
  std::optional<std::string> key;
  std::optional<int> line, column;
};

/// A motor of a catalogue in a design.
struct OfferedMotor {
  std::string model;
  std::optional<std::string> refused;                  ///< why it cannot be tried
  std::vector<std::pair<std::string, double>> values;  ///< of its keys [SI]
};

/// Derivatives of all metrics by keys.
struct Slopes {
  std::string status, detail;
  std::vector<std::pair<std::string, std::vector<double>>> by_key;  ///< [SI], in the order of metrics; NaN: none
};

/// Keys, metrics and columns of waveforms.
Json tables_of_the_library();
Json solved_answer(const RunResult& result);
Json start_up_answer(const TransientResult& result);
Json mechanism_answer(const Vehicle<double>& vehicle);
Json slopes_answer(const Slopes& slopes);
Json motors_answer(const std::vector<OfferedMotor>& motors);
Json problem_answer(const Problem& problem);
Json problem_schema();

/// The schema of each answer but those of flights by the name of its type.
Json answer_schemas();

}  // namespace wingbeat::web
