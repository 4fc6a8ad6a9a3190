// The library of flights for a web page, which is loaded when a flight is asked for.
#include <emscripten/bind.h>

#include <nlohmann/json.hpp>
#include <string>

#include "binding_tools.hpp"
#include "explored.hpp"
#include "flown.hpp"

namespace wingbeat::web {
namespace {

val begin(const std::string& text, const std::string& assignments, const std::string& options) {
  return attempted([&] {
    return json_result(
        begun_answer(begin_flight(explored(text, texts_of(assignments)), nlohmann::json::parse(options))));
  });
}

val fly(const std::string& wish) {
  return attempted([&] {
    Columns columns;
    const Json json = piece_answer(fly_on(nlohmann::json::parse(wish), columns));
    return with_columns(json, columns);
  });
}

}  // namespace
}  // namespace wingbeat::web

EMSCRIPTEN_BINDINGS(wingbeat_flight) {
  using namespace wingbeat::web;
  emscripten::function("begin", &begin);
  emscripten::function("fly", &fly);
}
