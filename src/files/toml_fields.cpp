#include "files/toml_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/input_errors.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {

TomlFields::TomlFields(std::string file, std::string path, const TomlNode& table)
    : reader_(std::move(file)), path_(std::move(path)), table_(table) {}

std::string TomlFields::name_of(std::string_view key) const {
  return path_.empty() ? std::string(key) : key.empty() ? path_ : fmt::format("{}.{}", path_, key);
}

void TomlFields::refuse(const TomlNode& node, std::string_view key, const std::string& message) const {
  reader_.refuse(node, name_of(key), message);
}

const TomlNode& TomlFields::at(std::string_view key) const {
  const TomlNode* node = table_.find(key);
  return node ? *node : table_;
}

void TomlFields::known_keys(std::span<const std::string_view> keys) const {
  InputErrors errors;
  for (const auto& [key, node] : table_.members) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    const std::string_view near = nearest_name(key, keys);
    errors.attempt([&, &k = key, &n = node] { reader_.unknown(n, name_of(one_line(k)), near, keys); });
  }
  errors.refuse();
}

std::optional<std::string> TomlFields::text(std::string_view key) const {
  const TomlNode* node = table_.find(key);
  if (!node) return std::nullopt;
  if (node->kind != TomlNode::Kind::text) reader_.wrong(*node, name_of(key), "a text");
  return node->text;
}

std::string TomlFields::needed_text(std::string_view key, std::string_view expected) const {
  const auto found = text(key);
  if (!found) refuse(key, fmt::format("missing; expected {}", expected));
  return *found;
}

std::optional<double> TomlFields::quantity(std::string_view key, std::string_view unit) const {
  const TomlNode* node = table_.find(key);
  if (!node) return std::nullopt;
  const bool number = node->kind == TomlNode::Kind::number;
  const double x = number ? node->number : reader_.quantity(*node, name_of(key), unit);
  if (!std::isfinite(x)) refuse(*node, key, "must be finite");
  return x;
}

double TomlFields::needed_quantity(std::string_view key, std::string_view unit) const {
  const auto found = quantity(key, unit);
  if (!found) refuse(key, fmt::format("missing; expected {}", quantity_example(unit)));
  return *found;
}

std::optional<bool> TomlFields::boolean(std::string_view key) const {
  const TomlNode* node = table_.find(key);
  return node ? std::optional(reader_.boolean(*node, name_of(key))) : std::nullopt;
}

std::optional<int> TomlFields::count(std::string_view key, int least) const {
  const TomlNode* node = table_.find(key);
  if (!node) return std::nullopt;
  const bool whole = node->kind == TomlNode::Kind::number && node->whole;
  if (!whole || node->number < least || node->number > 1e9) {
    reader_.wrong(*node, name_of(key), fmt::format("a whole number >= {}", least));
  }
  return int(node->number);
}

std::string TomlFields::choice(std::string_view key, std::span<const std::string_view> names,
                               std::optional<std::string_view> fallback) const {
  const auto given = text(key);
  if (!given && fallback) return std::string(*fallback);
  const std::string expected = fmt::format("{}", fmt::join(names, ", "));
  if (!given) refuse(key, fmt::format("missing; expected one of {}", expected));
  if (std::find(names.begin(), names.end(), *given) == names.end()) {
    refuse(at(key), key, fmt::format("expected one of {}, got {}", expected, in_quotes(*given)));
  }
  return *given;
}

std::optional<TomlFields> TomlFields::table(std::string_view key) const {
  const TomlNode* node = table_.find(key);
  if (!node) return std::nullopt;
  reader_.must_be_section(*node, name_of(key));
  return TomlFields(file(), name_of(key), *node);
}

std::vector<TomlFields> TomlFields::tables(std::string_view key) const {
  std::vector<TomlFields> result;
  const TomlNode* node = table_.find(key);
  if (!node) return result;
  for (const TomlNode& item : reader_.sections(*node, name_of(key))) {
    result.emplace_back(file(), fmt::format("{}[{}]", name_of(key), result.size() + 1), item);
  }
  return result;
}

}  // namespace wingbeat
