#include "wingbeat/files/design_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <system_error>

#include "files/design_write.hpp"
#include "files/toml_document.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace fs = std::filesystem;
namespace {

constexpr double rounding = 1e-15;

using Keys = std::map<std::string_view, WrittenKey, std::less<>>;

Keys keys_of(const Design<double>& design) {
  Keys keys;
  for (WrittenKey& key : written_keys(design)) keys.emplace(key.path, std::move(key));
  return keys;
}

bool same(const WrittenKey& a, const WrittenKey& b) {
  if (a.is_number() && b.is_number()) {
    return std::abs(a.value.number - b.value.number) <= rounding * std::abs(b.value.number);
  }
  return a.text == b.text;
}

bool agree(const Keys& a, const Keys& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
           return x.first == y.first && same(x.second, y.second);
         });
}

std::string_view parent_of(std::string_view path) { return path.substr(0, std::min(path.rfind('.'), path.size())); }
std::string_view leaf_of(std::string_view path) { return path.substr(path.rfind('.') + 1); }

/// A number [SI] in the unit of a quantity that stands in the file, with as few digits as give it back; empty where the
/// unit cannot hold it.
std::optional<std::string> in_unit_of(std::string_view quantity, double si, std::string_view si_unit) {
  const std::string given(quantity);
  char* end = nullptr;
  std::strtod(given.c_str(), &end);
  const std::string unit = end;
  if (end == given.c_str()) return std::nullopt;
  try {
    const double zero = parse_quantity("0" + unit, si_unit);  // of a temperature not 0
    const double one = parse_quantity("1" + unit, si_unit) - zero;
    std::optional<std::string> best;
    double least = rounding * std::abs(si);
    const auto attempt = [&](const std::string& number) {
      const double error = std::abs(parse_quantity(number + unit, si_unit) - si);
      if (error <= least && (!best || error < least)) {
        best = number + unit;
        least = error;
      }
      return error == 0.0;
    };
    double x = (si - zero) / one;
    for (int digits = 1; digits <= 17; ++digits) {
      if (attempt(fmt::format("{}", std::strtod(fmt::format("{:.{}g}", x, digits).c_str(), nullptr)))) return best;
    }
    x = std::nextafter(std::nextafter(x, -HUGE_VAL), -HUGE_VAL);
    for (int n = 0; n < 5; ++n, x = std::nextafter(x, HUGE_VAL)) {
      if (attempt(fmt::format("{}", x))) return best;
    }
    return best;
  } catch (const UnitError&) {
    return std::nullopt;
  }
}

/// A key with its value in a vehicle file.
struct StatedKey {
  std::string path;
  const TomlNode* node;
  bool in_line;  ///< within a table in braces
};

void collect(const TomlNode& table, const std::string& above, std::vector<StatedKey>& keys) {
  for (const auto& [key, node] : table.members) {
    const std::string path = above.empty() ? key : fmt::format("{}.{}", above, key);
    const bool is_section = node.kind == TomlNode::Kind::table && !node.in_line;
    if (!is_section) keys.push_back({path, &node, table.in_line});
    collect(node, path, keys);
  }
}

class Editor {
 public:
  Editor(std::string_view text, const Design<double>& before, const Design<double>& after)
      : text_(text), tree_(parse_toml_tree(text, "")), before_(keys_of(before)), after_(keys_of(after)) {
    newline_ = text.find("\r\n") != std::string_view::npos ? "\r\n" : "\n";
    collect(tree_, "", stated_);
    std::sort(stated_.begin(), stated_.end(),
              [](const auto& a, const auto& b) { return a.node->key_begin < b.node->key_begin; });
  }

  std::string edit() {
    std::vector<const WrittenKey*> added;
    for (const auto& [path, key] : after_) {
      const auto old = before_.find(path);
      if (old != before_.end() && old->second.text == key.text) continue;
      if (const TomlNode* node = tree_.find_path(path)) {
        replace(node->begin, node->end, value_for(*node, key));
      } else {
        added.push_back(&key);
      }
    }
    for (const StatedKey& stated : stated_) {
      if (after_.contains(stated.path) || !before_.contains(stated.path)) continue;
      const auto instead = std::find_if(added.begin(), added.end(), [&](const WrittenKey* key) {
        return parent_of(key->path) == parent_of(stated.path) && are_alternatives(key->path, stated.path);
      });
      if (instead == added.end()) {
        remove(stated);
        continue;
      }
      const TomlNode& node = *stated.node;
      replace(node.key_begin, node.key_end, std::string(leaf_of((*instead)->path)));
      replace(node.begin, node.end, value_for(node, **instead));
      added.erase(instead);
    }
    for (const WrittenKey* key : added) add(*key);
    return applied();
  }

 private:
  struct Edit {
    std::size_t begin, end;
    std::string text;
  };

  std::string_view of(std::size_t begin, std::size_t end) const { return text_.substr(begin, end - begin); }

  std::string value_for(const TomlNode& node, const WrittenKey& key) const {
    const std::string_view old = of(node.begin, node.end);
    const bool quoted = old.size() >= 2 && (old.front() == '"' || old.front() == '\'');
    if (!key.is_number()) return key.text;
    if (!quoted) return toml_quantity(key.value.number, "1");
    const std::string_view inside = old.substr(1, old.size() - 2);
    const bool plain = inside.find_first_of("\\\"'\n") == std::string_view::npos;
    const auto text = plain ? in_unit_of(inside, key.value.number, key.unit) : std::nullopt;
    return text ? fmt::format("{}{}{}", old.front(), *text, old.front()) : key.text;
  }

  void replace(std::size_t begin, std::size_t end, std::string text) {
    edits_.push_back({begin, end, std::move(text)});
  }

  std::size_t line_begin(std::size_t position) const {
    const auto newline = position == 0 ? std::string_view::npos : text_.rfind('\n', position - 1);
    return newline == std::string_view::npos ? 0 : newline + 1;
  }

  std::size_t line_end(std::size_t position) const {
    std::size_t end = std::min(text_.find('\n', position), text_.size());
    if (end > position && text_[end - 1] == '\r') --end;
    return end;
  }

  /// A line becomes a comment; in an inline table nothing can.
  void remove(const StatedKey& key) {
    const TomlNode& node = *key.node;
    if (!key.in_line) {
      for (std::size_t position = line_begin(node.key_begin); position <= node.end && position < text_.size();) {
        replace(position, position, "# ");
        position = std::min(text_.find('\n', position), text_.size()) + 1;
      }
      return;
    }
    // The whole of a dotted key, behind the brace or comma before it.
    std::size_t begin = text_.find_first_not_of(" \t\r\n", text_.find_last_of("{,", node.key_begin) + 1),
                end = node.end;
    while (end < text_.size() && (text_[end] == ' ' || text_[end] == '\t')) ++end;
    if (end < text_.size() && text_[end] == ',') {
      ++end;
      while (end < text_.size() && text_[end] == ' ') ++end;
    } else {
      end = node.end;
      const auto comma = text_.find_last_not_of(" \t", begin - 1);
      if (comma != std::string_view::npos && text_[comma] == ',') begin = comma;
    }
    replace(begin, end, "");
  }

  void add(const WrittenKey& key) {
    const std::string_view parent = parent_of(key.path);
    const StatedKey* sibling = nullptr;
    for (const StatedKey& stated : stated_) {
      if (parent_of(stated.path) == parent && stated.path != parent) sibling = &stated;
    }
    const std::string line = fmt::format("{} = {}", leaf_of(key.path), key.text);
    if (sibling && sibling->in_line) {
      replace(sibling->node->end, sibling->node->end, ", " + line);
    } else if (sibling) {
      const std::size_t key_begin = sibling->node->key_begin, to = line_end(sibling->node->end);
      replace(to, to, fmt::format("{}{}{}", newline_, of(line_begin(key_begin), key_begin), line));
    } else if (const TomlNode* section = tree_.find_path(parent); section && is_header_of(section->begin, parent)) {
      const std::size_t to = line_end(section->begin);
      replace(to, to, newline_ + line);
    } else {
      new_sections_[std::string(parent)] += line + newline_;
    }
  }

  /// [path]; a section may also be there by that of one below it, or by a dotted key.
  bool is_header_of(std::size_t begin, std::string_view path) const {
    if (text_[begin] != '[') return false;
    std::string name(of(begin + 1, std::min(text_.find(']', begin), text_.size())));
    std::erase_if(name, [](char c) { return std::string_view(" \t\"'").find(c) != std::string_view::npos; });
    return name == path;
  }

  std::string applied() {
    std::stable_sort(edits_.begin(), edits_.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
    std::string result;
    std::size_t position = 0;
    for (const Edit& edit : edits_) {
      if (edit.begin < position) continue;  // within a part that went; what comes of it is checked afterwards
      result += of(position, edit.begin);
      result += edit.text;
      position = edit.end;
    }
    result += text_.substr(position);
    for (const auto& [name, lines] : new_sections_) {
      if (!result.empty() && result.back() != '\n') result += newline_;
      result += fmt::format("{}[{}]{}{}", newline_, name, newline_, lines);
    }
    return result;
  }

  std::string_view text_;
  TomlNode tree_;
  std::vector<StatedKey> stated_;  ///< in the order of the text
  Keys before_, after_;
  std::string newline_;
  std::vector<Edit> edits_;
  std::map<std::string, std::string> new_sections_;
};

/// Keys that may name a table file, with its name as it stands there.
constexpr std::string_view naming[] = {"wing.planform.file", "supply.discharge_curve", "transmission.file",
                                       "aerodynamics.coefficients.table", load_table_key::file};

/// The text with the names of table files as they are seen from another folder.
std::string moved(const std::string& text, const fs::path& from, const fs::path& to) {
  std::string result = text;
  std::error_code error;
  for (const std::string_view path : naming) {
    const TomlNode tree = parse_toml_tree(result, "");
    const TomlNode* value = tree.find_path(path);
    if (!value || value->kind != TomlNode::Kind::text || fs::path(value->text).is_absolute()) continue;
    const fs::path file = fs::weakly_canonical(from / value->text, error);
    const fs::path name = error ? fs::path() : fs::relative(file, to, error);
    if (error || name.empty()) continue;
    result.replace(value->begin, value->end - value->begin, toml_text(name.string()));
  }
  return result;
}

}  // namespace

std::string edited_design(std::string_view original, const Design<double>& design, const TableLoader& tables) {
  if (original.starts_with("\xEF\xBB\xBF")) original.remove_prefix(3);
  try {
    const std::string text = Editor(original, parse_design(original, "", {}, tables), design).edit();
    if (agree(keys_of(parse_design(text, "", {}, tables)), keys_of(design))) return text;
  } catch (const InputError&) {
    // Not a file to edit: written anew.
  }
  return write_design(design);
}

std::string edited_design(const fs::path& original, const fs::path& output, const Design<double>& design) {
  try {
    const auto folder_of = [](const fs::path& file) { return fs::weakly_canonical(fs::absolute(file)).parent_path(); };
    const fs::path from = folder_of(original), to = folder_of(output);
    const std::string text = read_text_file(original);
    return edited_design(from == to ? text : moved(text, from, to), design,
                         [&](const std::string& name) { return read_text_file(to / name); });
  } catch (const InputError&) {
    // No file to edit: written anew.
  } catch (const fs::filesystem_error&) {
    // Neither.
  }
  return write_design(design);
}

}  // namespace wingbeat
