// What the schemas of reports are put together from.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/report_tools.hpp"
#include "wingbeat/cycle/metrics.hpp"

namespace wingbeat::schema {

using detail::Json;
using SchemaKeys = std::vector<std::pair<std::string, Json>>;

inline Json of_type(const char* type) { return {{"type", type}}; }
inline const Json any_text = of_type("string"), any_number = of_type("number"),
                  any_count = {{"type", "integer"}, {"minimum", 0}}, yes_or_no = of_type("boolean"),
                  nothing = of_type("null");

inline Json either(std::vector<Json> schemas) { return {{"anyOf", std::move(schemas)}}; }

/// What the schema allows, or null.
inline Json or_null(Json schema) {
  if (!schema.contains("type") || !schema["type"].is_string() || schema.contains("enum"))
    return either({schema, nothing});
  schema["type"] = Json::array({schema["type"], "null"});
  return schema;
}
inline const Json number_if_any = or_null(any_number), text_if_any = or_null(any_text);

inline Json listed(Json item) { return {{"type", "array"}, {"items", std::move(item)}}; }
inline Json pair_of(const Json& item) { return {{"type", "array"}, {"items", item}, {"minItems", 2}, {"maxItems", 2}}; }

/// An object with all of `always`, any of `sometimes` and nothing else.
inline Json object(const SchemaKeys& always, const SchemaKeys& sometimes = {}) {
  Json schema = of_type("object");
  schema["properties"] = Json::object();
  for (const SchemaKeys* keys : {&always, &sometimes}) {
    for (const auto& [key, value] : *keys) schema["properties"][key] = value;
  }
  schema["required"] = Json::array();
  for (const auto& [key, value] : always) schema["required"].push_back(key);
  schema["additionalProperties"] = false;
  return schema;
}
/// An object whose keys depend on the input.
inline Json by_name(Json value) { return {{"type", "object"}, {"additionalProperties", std::move(value)}}; }

inline Json one_of(std::vector<std::string> names) { return {{"enum", std::move(names)}}; }
template <NamedEnum E>
Json one_of_names() {
  std::vector<std::string> names;
  for (const auto& [name, value] : names_of<E>) names.emplace_back(name);
  return one_of(std::move(names));
}
inline Json statuses() {
  std::vector<std::string> names;
  for (const FlappingStatus s :
       {FlappingStatus::flapping, FlappingStatus::stalled, FlappingStatus::locked, FlappingStatus::jammed})
    names.emplace_back(name_of(s));
  return one_of(std::move(names));
}
inline Json metric_key() {
  std::vector<std::string> names;
  for (const MetricInfo& metric : metric_table()) names.emplace_back(metric.key);
  return one_of(std::move(names));
}

inline SchemaKeys operator+(SchemaKeys a, const SchemaKeys& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline Json with_text(Json schema, const std::string& text) {
  schema["description"] = text;
  return schema;
}

}  // namespace wingbeat::schema
