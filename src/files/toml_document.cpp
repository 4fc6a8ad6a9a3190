#include "files/toml_document.hpp"

#include <fmt/format.h>

// Where it is not a compiled library, toml++ asserts what malformed input violates ("[=", "T:") although the code after
// the assertion refuses such input properly.
#define TOML_ASSERT(expression) static_assert(true)
#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "files/toml_prevalidation.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/toml_text.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {

namespace {

// Which key was meant takes a comparison with every one there is.
constexpr int max_suggestions = 100;

int line_of(const toml::source_position& p) { return int(p.line); }
int column_of(const toml::source_position& p) { return int(p.column); }

std::string reason_in(const toml::parse_error& error) {
  std::string reason(error.description());
  for (const std::string_view prefix : {"Error while parsing ", "Encountered "}) {
    if (!reason.starts_with(prefix)) continue;
    reason.erase(0, prefix.size());
    if (prefix == "Encountered ") break;
    const auto colon = reason.find(": ");
    if (colon != std::string::npos) {
      const std::string what = reason.substr(0, colon);
      const bool vowel = what.find_first_of("aeiou") == 0;
      reason = fmt::format("in {} {}, {}", vowel ? "an" : "a", what, reason.substr(colon + 2));
    }
  }
  if (const auto redefined = reason.find("cannot redefine existing "); redefined != std::string::npos) {
    const auto name = reason.find('\'', redefined), end = reason.find('\'', name + 1);
    if (name != std::string::npos && end != std::string::npos) {
      return fmt::format("{} is given twice", in_quotes(reason.substr(name + 1, end - name - 1)));
    }
  }
  if (reason.find("expected a comment or whitespace, saw") != std::string::npos) {
    reason += "; a text or a quantity with a unit stands in quotes, as in \"5 mm\"";
  }
  return "not TOML: " + one_line(reason, 200);
}

/// From toml++'s lines and columns, which count characters, to offsets.
class TomlOffsets {
 public:
  explicit TomlOffsets(std::string_view text) : text_(text), lines_{text.starts_with("\xEF\xBB\xBF") ? 3u : 0u} {
    for (auto position = text.find('\n'); position != std::string_view::npos;
         position = text.find('\n', position + 1)) {
      lines_.push_back(position + 1);
    }
    for (std::size_t line = 0; line < lines_.size(); ++line) {
      const std::size_t end = line + 1 < lines_.size() ? lines_[line + 1] : text.size();
      if (end - lines_[line] <= stride) continue;
      std::vector<std::size_t>& marks = long_lines_[line];
      for (std::size_t position = lines_[line]; position < end; position = moved(position, stride)) {
        marks.push_back(position);
      }
    }
  }

  std::size_t of(const toml::source_position& p) const {
    const std::size_t line = std::clamp<std::size_t>(p.line, 1, lines_.size()) - 1;
    const std::size_t columns = p.column > 0 ? p.column - 1 : 0;
    const auto marks = long_lines_.find(line);
    if (marks == long_lines_.end()) return moved(lines_[line], columns);
    const std::size_t mark = std::min(columns / stride, marks->second.size() - 1);
    return moved(marks->second[mark], columns - mark * stride);
  }

 private:
  static constexpr std::size_t stride = 256;

  /// By so many characters of UTF-8, but not beyond the text.
  std::size_t moved(std::size_t position, std::size_t characters) const {
    for (; characters > 0 && position < text_.size(); --characters) {
      do ++position;
      while (position < text_.size() && (static_cast<unsigned char>(text_[position]) & 0xC0) == 0x80);
    }
    return position;
  }

  std::string_view text_;
  std::vector<std::size_t> lines_;  ///< where they begin
  /// Of lines longer than that, every 256th character: long tables stand in one line.
  std::unordered_map<std::size_t, std::vector<std::size_t>> long_lines_;
};

TomlNode tree_of(const toml::node& node, const TomlOffsets& offsets) {
  TomlNode tree;
  tree.line = line_of(node.source().begin);
  tree.column = column_of(node.source().begin);
  tree.begin = offsets.of(node.source().begin);
  tree.end = offsets.of(node.source().end);
  if (const auto* text = node.as_string()) {
    tree.kind = TomlNode::Kind::text;
    tree.text = text->get();
  } else if (const auto* whole = node.as_integer()) {
    tree.kind = TomlNode::Kind::number;
    tree.number = double(whole->get());
    tree.whole = true;
  } else if (const auto* real = node.as_floating_point()) {
    tree.kind = TomlNode::Kind::number;
    tree.number = real->get();
  } else if (const auto* boolean = node.as_boolean()) {
    tree.kind = TomlNode::Kind::boolean;
    tree.number = boolean->get() ? 1.0 : 0.0;
  } else if (const auto* array = node.as_array()) {
    tree.kind = TomlNode::Kind::array;
    for (const toml::node& item : *array) tree.items.push_back(tree_of(item, offsets));
  } else if (const auto* table = node.as_table()) {
    tree.kind = TomlNode::Kind::table;
    tree.in_line = table->is_inline();
    for (const auto& [key, value] : *table) {
      TomlNode member = tree_of(value, offsets);
      // What is wrong with a key is shown where its name stands.
      member.line = line_of(key.source().begin);
      member.column = column_of(key.source().begin);
      member.key_begin = offsets.of(key.source().begin);
      member.key_end = offsets.of(key.source().end);
      tree.members.push_back({std::string(key.str()), std::move(member)});
    }
    std::stable_sort(tree.members.begin(), tree.members.end(), [](const auto& a, const auto& b) {
      return std::pair(a.node.line, a.node.column) < std::pair(b.node.line, b.node.column);
    });
  } else {
    tree.text = node.is_time() ? "a time" : "a date";
  }
  return tree;
}

/// Parses TOML; refuses with `origin` moved to the place of the error unless the origin is an override.
TomlNode parse_toml(std::string_view text, const Origin& origin, std::size_t largest = largest_text) {
  const auto refuse = [&](int line, int column, const std::string& message) {
    throw InputError(origin.file, origin.overridden ? 0 : line, origin.overridden ? 0 : column, "", message);
  };
  if (text.size() > largest) {
    refuse(0, 0,
           fmt::format("larger than {} MB, which no {} file is", largest >> 20,
                       largest == largest_text ? "vehicle" : "study"));
  }
  if (const auto complaint = prevalidation_complaint(text)) {
    refuse(complaint->line, complaint->column, complaint->message);
  }
  try {
    return tree_of(toml::parse(text, std::string_view{}), TomlOffsets(text));
  } catch (const toml::parse_error& error) {
    refuse(line_of(error.source().begin), column_of(error.source().begin), reason_in(error));
    throw;
  }
}

/// Of a value in a text of its own, whose place is another.
void set_place(TomlNode& node, int line, int column) {
  node.line = line;
  node.column = column;
  for (TomlNode& item : node.items) set_place(item, line, column);
}

/// A key as it would stand in a file, so that "motor.inertia" in quotes is not taken for inertia in [motor].
std::string segment(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), is_bare_key_character);
  if (!bare) return in_quotes(key);
  constexpr std::size_t longest = 60;
  return key.size() <= longest ? std::string(key) : std::string(key.substr(0, longest)) + "...";
}

/// Enters tables and values into the document, and its errors for what has no place there.
class Flattener {
 public:
  Flattener(Document& document, Origin origin) : document_(document), base_(std::move(origin)) {}

  void enter_members(const TomlNode& table, const std::string& path) {
    for (const auto& [key, node] : table.members) {
      const std::string name = segment(key);
      const Origin origin = base_.overridden ? base_ : Origin{base_.file, node.line, node.column, false};
      enter(node, path.empty() ? name : fmt::format("{}.{}", path, name), origin);
    }
  }

  void enter(const TomlNode& node, const std::string& path, const Origin& origin) {
    const bool known = find_parameter<double>(path) != nullptr, section = is_section(path);
    if (!known && !section && ++unknown_ > max_suggestions) {
      document_.spoiled.push_back(path);
      offend(path, origin, "unknown key");
    } else if (!known && !section) {
      const std::string meant = nearest_key(path);
      if (!meant.empty()) document_.spoiled.push_back(meant);
      document_.spoiled.push_back(path);
      offend(path, origin, unknown_key_message(path));
    } else if (section && node.kind == TomlNode::Kind::table) {
      document_.sections.insert_or_assign(path, origin);
      enter_members(node, path);
    } else if (known) {
      Value value{node, origin};
      set_place(value, origin.line, origin.column);
      document_.values.insert_or_assign(path, std::move(value));
    } else {
      const std::string example = path == "wing.planform"
                                      ? "a table such as { shape = \"semi-ellipse\", length = \"63 mm\", "
                                        "root_chord = \"25 mm\" }"
                                  : path.find('.') == std::string::npos ? fmt::format("a section [{}]", path)
                                                                        : "a table";
      const auto is_table = [](const TomlNode& item) { return item.kind == TomlNode::Kind::table; };
      const bool list = !node.items.empty() && std::all_of(node.items.begin(), node.items.end(), is_table);
      document_.spoiled.push_back(path);
      offend(path, origin, fmt::format("expected {}, got {}", example, list ? "a list of tables" : kind_of(node)));
    }
  }

 private:
  void offend(const std::string& path, const Origin& origin, const std::string& message) {
    document_.errors.attempt([&] { origin.refuse(path, message); });
  }

  Document& document_;
  Origin base_;
  int unknown_ = 0;
};

bool at_or_below(std::string_view path, std::string_view above) {
  return path.starts_with(above) && (path.size() == above.size() || path[above.size()] == '.');
}

template <class Map, class Condition>
void erase_below(Map& map, std::string_view path, const Condition& condition) {
  std::erase_if(map, [&](const auto& entry) { return at_or_below(entry.first, path) && condition(entry.second); });
}

/// Before an override of a single number of the force coefficients: the named set, given or by default, written out.
void spell_out_coefficients(Document& document, std::string_view overridden) {
  const std::string path = "aerodynamics.coefficients";
  const Value* name = document.find(path);
  const bool single = at_or_below(overridden, path + ".lift") || at_or_below(overridden, path + ".drag") ||
                      overridden == path + ".tangential";
  const auto set = !name                                ? translational_2022()
                   : name->kind == TomlNode::Kind::text ? named_coefficients(name->text)
                                                        : std::nullopt;
  if (!single || document.has_section(path) || !set) return;
  Design<double> named{};
  named.aerodynamics.coefficients = *set;
  named.aerodynamics.coefficients_name = "custom";
  const Origin origin = document.locate(path);
  document.values.erase(path);
  document.sections.insert_or_assign(path, origin);
  for (const auto& key : parameter_table<double>()) {
    if (key.get && key.path != path && at_or_below(key.path, path)) {
      Value& value = document.values[std::string(key.path)];
      value.kind = TomlNode::Kind::number;
      value.number = *key.get(named);
      value.line = origin.line;
      value.column = origin.column;
      value.origin = origin;
    }
  }
}

/// The value of an override, a text where it is a bare string.
TomlNode override_value(std::string_view text, const Origin& origin) {
  if (text.find_first_of("\r\n") == std::string_view::npos) {
    try {
      return std::move(parse_toml(fmt::format("value = {}", text), origin).members.front().node);
    } catch (const InputError&) {
      // Perhaps a bare text.
    }
    try {
      parse_toml(fmt::format("# {}", text), origin);  // a comment too may hold no control characters
      TomlNode bare;
      bare.kind = TomlNode::Kind::text;
      bare.text = text;
      return bare;
    } catch (const InputError&) {
      // Refused below.
    }
  }
  origin.refuse("", "neither a TOML value nor one line of plain UTF-8 text");
}

/// `give()` makes the node.
template <class Give>
void apply_override(Document& document, const std::string& path, const Origin& origin, const Give& give) {
  if (!find_parameter<double>(path) && !is_section(path)) {
    origin.refuse(one_line(path), unknown_key_message(path));
  }

  spell_out_coefficients(document, path);
  const auto anything = [](const auto&) { return true; };
  erase_below(document.values, path, anything);
  erase_below(document.sections, path, anything);
  for (auto dot = path.rfind('.'); dot != std::string::npos; dot = dot == 0 ? dot : path.rfind('.', dot - 1)) {
    const std::string above = path.substr(0, dot);
    document.values.erase(above);
    document.sections.try_emplace(above, origin);
  }
  Flattener flattener(document, origin);
  flattener.enter(give(), path, origin);

  const auto from_file = [](const Value& value) { return !value.origin.overridden; };
  for (const auto& key : parameter_table<double>()) {
    for (const std::string& other : alternatives_of(key)) {
      if (at_or_below(path, key.path)) erase_below(document.values, other, from_file);
      if (at_or_below(path, other)) erase_below(document.values, key.path, from_file);
    }
  }
}

void apply_override(Document& document, const std::string& assignment) {
  const Origin origin{"--set " + one_line(assignment, 120), 0, 0, true};
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) origin.refuse("", "expected KEY=VALUE, as in --set supply.voltage=\"3 V\"");
  const std::string path(detail::trimmed(std::string_view(assignment).substr(0, equals)));
  const std::string_view text = detail::trimmed(std::string_view(assignment).substr(equals + 1));
  apply_override(document, path, origin, [&] { return override_value(text, origin); });
}

}  // namespace

const TomlNode* TomlNode::find(std::string_view key) const {
  for (const auto& [name, node] : members) {
    if (name == key) return &node;
  }
  return nullptr;
}

const TomlNode* TomlNode::find_path(std::string_view path) const {
  const TomlNode* node = this;
  for (std::size_t dot = 0; node && dot != std::string_view::npos;) {
    dot = path.find('.');
    node = node->find(path.substr(0, dot));
    path.remove_prefix(dot == std::string_view::npos ? path.size() : dot + 1);
  }
  return node;
}

TomlNode parse_toml_tree(std::string_view text, std::string_view file_name, std::size_t largest) {
  return parse_toml(text, Origin{std::string(file_name), 0, 0, false}, largest);
}

std::string kind_of(const TomlNode& node) {
  switch (node.kind) {
    case TomlNode::Kind::text: return in_quotes(node.text);
    case TomlNode::Kind::number: return fmt::format("the number {}", node.number);
    case TomlNode::Kind::boolean: return "a boolean";
    case TomlNode::Kind::array: return "an array";
    case TomlNode::Kind::table: return "a table";
    case TomlNode::Kind::other: break;
  }
  return node.text;
}

std::string toml_value(const TomlNode& node) {
  std::string text;
  switch (node.kind) {
    case TomlNode::Kind::text: return toml_text(node.text);
    case TomlNode::Kind::number:
      if (node.whole) return fmt::format("{:.0f}", node.number);
      text = fmt::format("{}", node.number);
      return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
    case TomlNode::Kind::boolean: return node.number != 0.0 ? "true" : "false";
    case TomlNode::Kind::array:
      for (const TomlNode& item : node.items) text += (text.empty() ? "" : ", ") + toml_value(item);
      return "[" + text + "]";
    case TomlNode::Kind::table:
      for (const auto& [key, value] : node.members) {
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", toml_key(key), toml_value(value));
      }
      return "{" + text + "}";
    case TomlNode::Kind::other: break;
  }
  return "1970-01-01";
}

const Value* Document::find(std::string_view path) const {
  const auto found = values.find(path);
  return found == values.end() ? nullptr : &found->second;
}

bool Document::has_section(std::string_view path) const { return sections.find(path) != sections.end(); }

Origin Document::locate(std::string_view path) const {
  if (const Value* value = find(path)) return value->origin;
  while (true) {
    if (const auto section = sections.find(path); section != sections.end()) return section->second;
    const auto dot = path.rfind('.');
    if (dot == std::string_view::npos) return {file_name, last_line, 1, false};
    path = path.substr(0, dot);
    if (const Value* value = find(path)) return value->origin;
  }
}

namespace {

/// The keys below a table of one side, which may be dotted or stand in sections.
void collect_settings(const TomlNode& table, const std::string& above, const std::string& file,
                      std::vector<Setting>& settings) {
  for (const auto& [key, node] : table.members) {
    const std::string path = above.empty() ? key : fmt::format("{}.{}", above, key);
    if (node.kind == TomlNode::Kind::table && is_section(path) && !node.in_line) {
      collect_settings(node, path, file, settings);
    } else {
      settings.push_back({path, node, {file, node.line, node.column, true}});
    }
  }
}

/// Moves [left] and [right] from the tree to the document.
void take_sides(TomlNode& tree, Document& document) {
  for (const char* name : {"left", "right"}) {
    const TomlNode* node = tree.find(name);
    if (!node) continue;
    const Origin origin{document.file_name, node->line, node->column, false};
    document.errors.attempt([&] {
      if (node->kind == TomlNode::Kind::table) return;
      origin.refuse(name,
                    fmt::format("expected a section [{}], keys of that side alone, got {}", name, kind_of(*node)));
    });
    SideTable& side = document.sides[name];
    side.origin = origin;
    collect_settings(*node, "", document.file_name, side.settings);
    std::erase_if(tree.members, [&](const TomlMember& member) { return member.key == name; });
  }
}

}  // namespace

Document parse_document(std::string_view text, std::string_view file_name) {
  Document document;
  document.file_name = file_name;
  document.last_line = 1 + int(std::count(text.begin(), text.end(), '\n')) - int(text.ends_with('\n'));
  document.last_line = std::max(document.last_line, 1);
  const Origin origin{document.file_name, 0, 0, false};
  TomlNode tree = parse_toml(text, origin);
  take_sides(tree, document);
  Flattener(document, origin).enter_members(tree, "");
  return document;
}

void apply_overrides(Document& document, std::span<const Setting> settings, std::span<const std::string> overrides) {
  InputErrors errors;
  for (const auto& [path, value, origin] : settings) {
    errors.attempt([&, &p = path, &v = value, &o = origin] { apply_override(document, p, o, [&] { return v; }); });
  }
  for (const std::string& assignment : overrides) errors.attempt([&] { apply_override(document, assignment); });
  for (const auto& key : parameter_table<double>()) {
    if (key.only_with.empty()) continue;
    const Requirement requirement = requirement_of(key.only_with);
    const Value* value = document.find(key.path);
    const Value* choice = document.find(requirement.path);
    if (value && choice && !value->origin.overridden && choice->origin.overridden &&
        !requirement.allows(choice->text)) {
      document.values.erase(std::string(key.path));
    }
  }
  errors.refuse();
}

std::string no_place_message(std::string_view path, const Requirement& requirement, std::string_view choice) {
  std::string text = fmt::format("belongs to {0} = {1}, but {0} is {2}", requirement.path,
                                 fmt::join(requirement.values, " or "), in_quotes(choice));
  // A four-bar's stroke follows from its links.
  if (path == "transmission.stroke_amplitude" && choice == "four-bar") {
    text += "; wingbeat synthesise four-bar --stroke ... finds links with that stroke";
  }
  return text;
}

}  // namespace wingbeat
