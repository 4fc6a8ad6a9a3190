#include "files/toml_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/input_errors.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {

TomlFields::TomlFields(std::string file, std::string path, const TomlNode& table)
    : file_(std::move(file)), path_(std::move(path)), table_(table) {}

std::string TomlFields::name_of(std::string_view key) const {
  return path_.empty() ? std::string(key) : key.empty() ? path_ : fmt::format("{}.{}", path_, key);
}

void TomlFields::refuse(const TomlNode& node, std::string_view key, const std::string& message) const {
  throw InputError(file_, node.line, node.column, name_of(key), message);
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
    errors.attempt([&, &k = key, &n = node] {
      refuse(n, one_line(k),
             near.empty() ? fmt::format("unknown key; known here: {}", fmt::join(keys, ", "))
                          : fmt::format("unknown key; did you mean {}?", near));
    });
  }
  errors.refuse();
}

std::optional<std::string> TomlFields::text(std::string_view key) const {
  const TomlNode* node = table_.find(key);
  if (!node) return std::nullopt;
  if (node->kind != TomlNode::Kind::text) refuse(*node, key, fmt::format("expected a text, got {}", kind_of(*node)));
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
  double x = 0.0;
  if (node->kind == TomlNode::Kind::number) {
    x = node->number;
  } else if (node->kind == TomlNode::Kind::text) {
    try {
      x = parse_quantity(node->text, unit);
    } catch (const UnitError& error) {
      refuse(*node, key, error.what());
    }
  } else {
    refuse(*node, key, fmt::format("expected {}, got {}", quantity_example(unit), kind_of(*node)));
  }
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
  if (!node) return std::nullopt;
  if (node->kind != TomlNode::Kind::boolean) {
    refuse(*node, key, fmt::format("expected true or false, got {}", kind_of(*node)));
  }
  return node->number != 0.0;
}

std::optional<int> TomlFields::count(std::string_view key, int least) const {
  const TomlNode* node = table_.find(key);
  if (!node) return std::nullopt;
  const bool whole = node->kind == TomlNode::Kind::number && node->whole;
  if (!whole || node->number < least || node->number > 1e9) {
    refuse(*node, key, fmt::format("expected a whole number >= {}, got {}", least, kind_of(*node)));
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
  if (node->kind != TomlNode::Kind::table) {
    refuse(*node, key, fmt::format("expected a section [{}], got {}", name_of(key), kind_of(*node)));
  }
  return TomlFields(file_, name_of(key), *node);
}

std::vector<TomlFields> TomlFields::tables(std::string_view key) const {
  std::vector<TomlFields> result;
  const TomlNode* node = table_.find(key);
  if (!node) return result;
  const auto wrong = [&](const TomlNode& at) {
    refuse(at, key, fmt::format("expected [[{}]] sections, got {}", name_of(key), kind_of(at)));
  };
  if (node->kind != TomlNode::Kind::array) wrong(*node);
  for (const TomlNode& item : node->items) {
    if (item.kind != TomlNode::Kind::table) wrong(item);
    result.emplace_back(file_, fmt::format("{}[{}]", name_of(key), result.size() + 1), item);
  }
  return result;
}

}  // namespace wingbeat
