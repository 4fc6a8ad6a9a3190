// The library for a web page. Nothing is computed here: vehicle files and values of keys go in as text, as on the
// command line, numbers come out as JSON and arrays.
#include <emscripten/bind.h>

#include <nlohmann/json.hpp>
#include <string>

#include "answers.hpp"
#include "binding_tools.hpp"
#include "explored.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::web {
namespace {

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
