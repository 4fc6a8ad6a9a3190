#include "files/table_form.hpp"

#include <fmt/format.h>

namespace wingbeat::detail {

StatedTable stated_table(const TomlFields& fields, const char* example) {
  const auto one_of = [&](const char* key, std::string_view allowed, const char* expected) -> std::optional<char> {
    const auto text = fields.text(key);
    if (!text) return std::nullopt;
    if (text->size() != 1 || allowed.find((*text)[0]) == std::string_view::npos) {
      fields.refuse(fields.at(key), key, fmt::format("must be {}, got {}", expected, in_quotes(*text)));
    }
    return (*text)[0];
  };
  StatedTable stated;
  stated.form.separator = one_of("separator", ",;\t", "\",\", \";\" or \"\\t\"");
  stated.form.decimal = one_of("decimal", ".,", "\".\" or \",\"");
  const TomlNode* columns = fields.node().find("columns");
  if (!columns) return stated;
  const std::string expected = fmt::format("expected {{ \"header in the file\" = \"{}\" }}, or \"ignore\"", example);
  if (columns->kind != TomlNode::Kind::table) fields.refuse(*columns, "columns", expected);
  for (const auto& [header, name] : columns->members) {
    if (name.kind != TomlNode::Kind::text) fields.refuse(name, "columns", expected);
    stated.columns.emplace_back(header, name.text);
  }
  return stated;
}

}  // namespace wingbeat::detail
