#include "files/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wingbeat {

using Kind = TomlNode::Kind;

void TomlReader::refuse(SourceLocation place, const std::string& key, const std::string& message) const {
  throw InputError(file_, place.line, place.column, key, message);
}

void TomlReader::refuse(const TomlNode& node, const std::string& key, const std::string& message) const {
  refuse(place_of(node), key, message);
}

void TomlReader::wrong(const TomlNode& node, const std::string& key, std::string_view expected) const {
  refuse(node, key, fmt::format("expected {}, got {}", expected, kind_of(node)));
}

void TomlReader::unknown(const TomlNode& node, const std::string& key, std::string_view near,
                         std::span<const std::string_view> known) const {
  refuse(node, key,
         near.empty() ? fmt::format("unknown key; known here: {}", fmt::join(known, ", "))
                      : fmt::format("unknown key; did you mean {}?", near));
}

std::string TomlReader::text_of(const TomlNode& node, const std::string& key, std::string_view expected) const {
  if (node.kind != Kind::text || node.text.empty()) wrong(node, key, expected);
  return node.text;
}

double TomlReader::quantity(const TomlNode& node, const std::string& key, std::string_view unit,
                            SpeedConstant speed_constant) const {
  if (node.kind == Kind::number && std::isfinite(node.number)) return node.number;
  if (node.kind != Kind::text) wrong(node, key, quantity_example(unit));
  try {
    return parse_quantity(node.text, unit, speed_constant);
  } catch (const UnitError& error) {
    refuse(node, key, error.what());
  }
}

bool TomlReader::boolean(const TomlNode& node, const std::string& key) const {
  if (node.kind != Kind::boolean) wrong(node, key, "true or false");
  return node.number != 0.0;
}

std::uint64_t TomlReader::whole_number(const TomlNode& node, const std::string& key, std::uint64_t least,
                                       std::uint64_t max_value) const {
  const bool whole = node.kind == Kind::number && node.whole;
  if (!whole || !(node.number >= double(least) && node.number <= double(max_value))) {
    wrong(node, key, fmt::format("a whole number from {} to {}", least, max_value));
  }
  return std::uint64_t(node.number);
}

std::string TomlReader::one_of(const TomlNode& node, const std::string& key,
                               std::span<const std::string_view> known) const {
  if (node.kind == Kind::text && std::find(known.begin(), known.end(), node.text) != known.end()) return node.text;
  std::string expected;
  for (const std::string_view name : known) {
    expected += fmt::format("{}\"{}\"", expected.empty() ? "" : name == known.back() ? " or " : ", ", name);
  }
  wrong(node, key, expected);
}

void TomlReader::must_be_section(const TomlNode& node, const std::string& key) const {
  if (node.kind != Kind::table) wrong(node, key, fmt::format("a section [{}]", key));
}

std::span<const TomlNode> TomlReader::sections(const TomlNode& node, const std::string& key) const {
  const std::string expected = fmt::format("[[{}]] sections", key);
  if (node.kind != Kind::array) wrong(node, key, expected);
  for (const TomlNode& item : node.items) {
    if (item.kind != Kind::table) wrong(item, key, expected);
  }
  return node.items;
}

}  // namespace wingbeat
