// What the bindings of both libraries share: a computation that throws gives {"errors": [...]} in place of its result,
// each with the program's sentence.
#pragma once

#include <emscripten/bind.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "answers.hpp"
#include "explored.hpp"
#include "wingbeat/files/design_file.hpp"

namespace wingbeat::web {

using emscripten::val;

/// A copy of the numbers, which outlives them.
inline val array_of(const std::vector<double>& numbers) {
  return val(emscripten::typed_memory_view(numbers.size(), numbers.data())).call<val>("slice");
}

inline std::vector<std::string> texts_of(const std::string& json) { return nlohmann::json::parse(json); }
inline std::vector<double> numbers_of(const val& array) {
  return emscripten::convertJSArrayToNumberVector<double>(array);
}

inline std::string in_json(const std::string& message, const InputError* error = nullptr) {
  Problem problem{message, {}, {}, {}};
  if (error) problem = {message, error->key(), error->line(), error->column()};
  return problem_answer(problem).dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The result of `work` as an object for JavaScript, or its errors.
template <class Work>
val attempted(const Work& work) {
  std::string errors;
  try {
    return work();
  } catch (const InputError& error) {
    errors = in_json(error.what(), &error);
    for (const InputError& other : error.others()) errors += "," + in_json(other.what(), &other);
  } catch (const ParameterError& error) {
    const InputError named("", 0, 0, error.key(), error.reason());
    errors = in_json(named.what(), &named);
  } catch (const std::exception& error) {
    errors = in_json(error.what());
  }
  val result = val::object();
  result.set("json", "{\"errors\":[" + errors + "]}");
  return result;
}

inline val json_result(const Json& json) {
  val result = val::object();
  result.set("json", json.dump(-1, ' ', false, Json::error_handler_t::replace));
  return result;
}

inline val with_columns(const Json& json, const Columns& columns) {
  val arrays = val::object();
  for (const auto& [name, numbers] : columns) arrays.set(name, array_of(numbers));
  val result = json_result(json);
  result.set("columns", arrays);
  return result;
}

}  // namespace wingbeat::web
