// The library for a web page. Nothing is computed here: vehicle files and values of keys go in as text, as on the
// command line, numbers come out as JSON and arrays. A computation that throws gives {"errors": [...]} in place of its
// result, each with the program's sentence.
#include <emscripten/bind.h>

#include <list>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "answers.hpp"
#include "explored.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::web {
namespace {

using emscripten::val;

/// A copy of the numbers, which outlives them.
val array_of(const std::vector<double>& numbers) {
  return val(emscripten::typed_memory_view(numbers.size(), numbers.data())).call<val>("slice");
}

std::vector<std::string> texts_of(const std::string& json) { return nlohmann::json::parse(json); }
std::vector<double> numbers_of(const val& array) { return emscripten::convertJSArrayToNumberVector<double>(array); }

std::string in_json(const std::string& message, const InputError* error = nullptr) {
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

val json_result(const Json& json) {
  val result = val::object();
  result.set("json", json.dump(-1, ' ', false, Json::error_handler_t::replace));
  return result;
}

val with_columns(const Json& json, const Columns& columns) {
  val arrays = val::object();
  for (const auto& [name, numbers] : columns) arrays.set(name, array_of(numbers));
  val result = json_result(json);
  result.set("columns", arrays);
  return result;
}

val read(const std::string& text, const std::string& name, const std::string& tables) {
  return attempted([&] { return json_result(read_vehicle(text, name, nlohmann::json::parse(tables))); });
}

val values(const std::string& text, const std::string& assignments) {
  return attempted([&] { return json_result(values_of(explored(text, texts_of(assignments)))); });
}

val edited(const std::string& text, const std::string& assignments) {
  return attempted([&] { return json_result({{"toml", edited_design(text, explored(text, texts_of(assignments)))}}); });
}

val solve_one(const std::string& text, const std::string& assignments, const std::string& options) {
  return attempted([&] {
    Columns columns;
    const Json json =
        solved(explored(text, texts_of(assignments)), options_of(nlohmann::json::parse(options)), columns);
    return with_columns(json, columns);
  });
}

val start_up(const std::string& text, const std::string& assignments, const std::string& options) {
  return attempted([&] {
    Columns columns;
    const Json json =
        started(explored(text, texts_of(assignments)), options_of(nlohmann::json::parse(options)), columns);
    return with_columns(json, columns);
  });
}

val gradients(const std::string& text, const std::string& assignments, const std::string& keys,
              const std::string& options) {
  return attempted([&] {
    return json_result(differentiated(explored(text, texts_of(assignments)), texts_of(keys),
                                      options_of(nlohmann::json::parse(options))));
  });
}

val mechanism(const std::string& text, const std::string& assignments, const val& angles) {
  return attempted([&] {
    Columns columns;
    const Json json = mechanism_of(explored(text, texts_of(assignments)), numbers_of(angles), columns);
    return with_columns(json, columns);
  });
}

val ensemble(const std::string& text, const std::string& assignments, const std::string& keys, const val& values,
             const std::string& options) {
  return attempted([&] {
    Columns columns;
    const Json json = solved_together(explored(text, texts_of(assignments)), texts_of(keys), numbers_of(values),
                                      options_of(nlohmann::json::parse(options)), columns);
    return with_columns(json, columns);
  });
}

val motors(const std::string& text, const std::string& assignments, const std::string& catalogue, double gear) {
  return attempted([&] { return json_result(motors_for(explored(text, texts_of(assignments)), catalogue, gear)); });
}

val quantity(const std::string& text, const std::string& unit) {
  return attempted([&] { return json_result({{"value", parse_quantity(text, unit)}}); });
}

std::string tables() { return tables_of_the_library().dump(); }

}  // namespace
}  // namespace wingbeat::web

EMSCRIPTEN_BINDINGS(wingbeat) {
  using namespace wingbeat::web;
  emscripten::function("tables", &tables);
  emscripten::function("read", &read);
  emscripten::function("values", &values);
  emscripten::function("edited", &edited);
  emscripten::function("solve", &solve_one);
  emscripten::function("startUp", &start_up);
  emscripten::function("gradients", &gradients);
  emscripten::function("mechanism", &mechanism);
  emscripten::function("ensemble", &ensemble);
  emscripten::function("motors", &motors);
  emscripten::function("quantity", &quantity);
}
