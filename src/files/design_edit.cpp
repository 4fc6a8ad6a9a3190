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
#include "files/toml_spans.hpp"
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
  if (a.number && b.number) return std::abs(*a.number - *b.number) <= rounding * std::abs(*b.number);
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

class Editor {
 public:
  Editor(std::string_view text, const Design<double>& before, const Design<double>& after)
      : text_(text), spans_(toml_spans(text)), before_(keys_of(before)), after_(keys_of(after)) {
    newline_ = text.find("\r\n") != std::string_view::npos ? "\r\n" : "\n";
  }

  std::string edit() {
    std::vector<const WrittenKey*> added;
    for (const auto& [path, key] : after_) {
      const auto old = before_.find(path);
      if (old != before_.end() && old->second.text == key.text) continue;
      if (const TomlSpan* span = spans_.find(path)) {
        replace(span->value, span->value_end, value_for(*span, key));
      } else {
        added.push_back(&key);
      }
    }
    for (const TomlSpan& span : spans_.values) {
      if (after_.contains(span.path) || !before_.contains(span.path)) continue;
      const auto instead = std::find_if(added.begin(), added.end(), [&](const WrittenKey* key) {
        return parent_of(key->path) == parent_of(span.path) && are_alternatives(key->path, span.path);
      });
      if (instead == added.end()) {
        remove(span);
        continue;
      }
      replace(span.key, span.key_end, std::string(leaf_of((*instead)->path)));
      replace(span.value, span.value_end, value_for(span, **instead));
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

  std::string value_for(const TomlSpan& span, const WrittenKey& key) const {
    const std::string_view old = of(span.value, span.value_end);
    const bool quoted = old.size() >= 2 && (old.front() == '"' || old.front() == '\'');
    if (!key.number) return key.text;
    if (!quoted) return toml_quantity(*key.number, "1");
    const std::string_view inside = old.substr(1, old.size() - 2);
    const bool plain = inside.find_first_of("\\\"'\n") == std::string_view::npos;
    const auto text = plain ? in_unit_of(inside, *key.number, key.unit) : std::nullopt;
    return text ? fmt::format("{}{}{}", old.front(), *text, old.front()) : key.text;
  }

  void replace(std::size_t begin, std::size_t end, std::string text) {
    edits_.push_back({begin, end, std::move(text)});
  }

  std::size_t line_begin(std::size_t at) const {
    const auto newline = at == 0 ? std::string_view::npos : text_.rfind('\n', at - 1);
    return newline == std::string_view::npos ? 0 : newline + 1;
  }

  std::size_t line_end(std::size_t at) const {
    std::size_t end = std::min(text_.find('\n', at), text_.size());
    if (end > at && text_[end - 1] == '\r') --end;
    return end;
  }

  /// A line becomes a comment; in an inline table nothing can.
  void remove(const TomlSpan& span) {
    if (!span.in_line) {
      for (std::size_t at = line_begin(span.begin); at <= span.value_end && at < text_.size();) {
        replace(at, at, "# ");
        at = std::min(text_.find('\n', at), text_.size()) + 1;
      }
      return;
    }
    std::size_t begin = span.begin, end = span.value_end;
    while (end < text_.size() && (text_[end] == ' ' || text_[end] == '\t')) ++end;
    if (end < text_.size() && text_[end] == ',') {
      ++end;
      while (end < text_.size() && text_[end] == ' ') ++end;
    } else {
      end = span.value_end;
      const auto comma = text_.find_last_not_of(" \t", begin - 1);
      if (comma != std::string_view::npos && text_[comma] == ',') begin = comma;
    }
    replace(begin, end, "");
  }

  void add(const WrittenKey& key) {
    const std::string_view parent = parent_of(key.path);
    const TomlSpan* sibling = nullptr;
    for (const TomlSpan& span : spans_.values) {
      if (parent_of(span.path) == parent && span.path != parent) sibling = &span;
    }
    const std::string line = fmt::format("{} = {}", leaf_of(key.path), key.text);
    if (sibling && sibling->in_line) {
      replace(sibling->value_end, sibling->value_end, ", " + line);
    } else if (sibling) {
      const std::size_t from = line_begin(sibling->begin), at = line_end(sibling->value_end);
      replace(at, at, fmt::format("{}{}{}", newline_, of(from, sibling->key), line));
    } else if (const auto header = std::find_if(spans_.headers.begin(), spans_.headers.end(),
                                                [&](const TomlHeader& h) { return h.path == parent; });
               header != spans_.headers.end()) {
      replace(header->end, header->end, newline_ + line);
    } else {
      new_sections_[std::string(parent)] += line + newline_;
    }
  }

  std::string applied() {
    std::stable_sort(edits_.begin(), edits_.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
    std::string result;
    std::size_t at = 0;
    for (const Edit& edit : edits_) {
      if (edit.begin < at) continue;  // within a part that went; what comes of it is checked afterwards
      result += of(at, edit.begin);
      result += edit.text;
      at = edit.end;
    }
    result += text_.substr(at);
    for (const auto& [name, lines] : new_sections_) {
      if (!result.empty() && result.back() != '\n') result += newline_;
      result += fmt::format("{}[{}]{}{}", newline_, name, newline_, lines);
    }
    return result;
  }

  std::string_view text_;
  TomlSpans spans_;
  Keys before_, after_;
  std::string newline_;
  std::vector<Edit> edits_;
  std::map<std::string, std::string> new_sections_;
};

/// Keys that may name a table file, with its name as it stands there.
constexpr std::string_view naming[] = {"wing.planform.file", "supply.discharge_curve", "transmission.file",
                                       "aerodynamics.coefficients.table"};

/// The text with the names of table files as they are seen from another folder.
std::string moved(const std::string& text, const fs::path& from, const fs::path& to) {
  std::string result = text;
  std::error_code error;
  for (const std::string_view path : naming) {
    const TomlSpans spans = toml_spans(result);
    const TomlSpan* span = spans.find(path);
    if (!span || (result[span->value] != '"' && result[span->value] != '\'')) continue;
    const TomlNode value =
        *parse_toml_tree("name = " + result.substr(span->value, span->value_end - span->value), "").find("name");
    if (value.kind != TomlNode::Kind::text || fs::path(value.text).is_absolute()) continue;
    const fs::path file = fs::weakly_canonical(from / value.text, error);
    const fs::path name = error ? fs::path() : fs::relative(file, to, error);
    if (error || name.empty()) continue;
    result.replace(span->value, span->value_end - span->value, toml_text(name.string()));
  }
  return result;
}

}  // namespace

std::string edited_design(std::string_view original, const Design<double>& design, const TableLoader& tables) {
  if (original.starts_with("\xEF\xBB\xBF")) original.remove_prefix(3);
  try {
    const std::string text = Editor(original, parse_design(original, "", {}, tables), design).edit();
    if (agree(keys_of(parse_design(text, "", {}, tables)), keys_of(design))) return text;
  } catch (const InputError&) {}
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
  } catch (const fs::filesystem_error&) {}
  return write_design(design);
}

}  // namespace wingbeat
