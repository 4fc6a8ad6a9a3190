#include "wingbeat/vehicle/parameters.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "vehicle/parameter_rows.hpp"

namespace wingbeat {

template std::span<const Parameter<double>> parameter_table<double>();

namespace {

/// Edits that turn one text into the other: insert, remove, replace, or swap of neighbours.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last.back();
}

std::string_view leaf_of(std::string_view path) { return path.substr(path.rfind('.') + 1); }

std::string_view parent_of(std::string_view path) {
  const auto dot = path.rfind('.');
  return dot == std::string_view::npos ? std::string_view{} : path.substr(0, dot);
}

std::vector<std::string_view> sections() {
  std::vector<std::string_view> result;
  for (const auto& key : parameter_table<double>()) {
    for (std::string_view path = parent_of(key.path); !path.empty(); path = parent_of(path)) {
      if (std::find(result.begin(), result.end(), path) == result.end()) result.push_back(path);
    }
  }
  return result;
}

struct Nearest {
  std::string_view path;
  std::size_t distance = std::string_view::npos;
  void offer(std::string_view candidate, std::size_t d) {
    if (d < distance) *this = {candidate, d};
  }
};

/// True if every word of `asked`, two at least, is one of `name` and both end alike: wing.mass and body.wing_mass.
bool has_words_of(std::string_view name, std::string_view asked) {
  const auto words_of = [](std::string_view text) {
    std::vector<std::string_view> words;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find_first_of("._", begin), text.size());
      words.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
    return words;
  };
  const std::vector<std::string_view> known = words_of(name), wanted = words_of(asked);
  return wanted.size() > 1 && wanted.back() == known.back() &&
         std::all_of(wanted.begin(), wanted.end(),
                     [&](std::string_view word) { return std::find(known.begin(), known.end(), word) != known.end(); });
}

}  // namespace

std::string default_text(const ParameterText& parameter) {
  std::string text(parameter.fallback);
  if (text == "required" && parameter.has_alternative()) text += " or " + std::string(parameter.alternatives[0]);
  if (const std::string_view other = parameter.required_unless; is_section(other)) {
    text += " unless " + std::string(leaf_of(other)) + " is a name";
  } else if (!other.empty()) {
    text += " unless " + with_or(other);
  }
  return text;
}

std::string with_or(std::string_view alternatives) {
  std::string text;
  for (const char c : alternatives) text += c == '|' ? std::string(" or ") : std::string(1, c);
  return text;
}

std::vector<std::string> alternatives_of(const ParameterText& parameter) {
  std::vector<std::string> paths;
  for (const std::string_view name : parameter.alternatives) {
    if (!name.empty()) paths.push_back(std::string(parent_of(parameter.path)) + "." + std::string(name));
  }
  return paths;
}

bool are_alternatives(std::string_view one, std::string_view other) {
  const auto replaces = [](std::string_view path, std::string_view by) {
    const ParameterText* parameter = find_parameter<double>(path);
    if (!parameter) return false;
    const std::vector<std::string> paths = alternatives_of(*parameter);
    return std::find(paths.begin(), paths.end(), by) != paths.end();
  };
  return replaces(one, other) || replaces(other, one);
}

Requirement requirement_of(std::string_view only_with) {
  Requirement result;
  const auto equals = only_with.find(" = ");
  result.path = only_with.substr(0, equals);
  if (equals == std::string_view::npos) return result;
  for (std::string_view rest = only_with.substr(equals + 3);;) {
    const auto bar = rest.find('|');
    result.values.push_back(rest.substr(0, bar));
    if (bar == std::string_view::npos) return result;
    rest.remove_prefix(bar + 1);
  }
}

bool Requirement::allows(std::string_view value) const {
  return values.empty() || std::find(values.begin(), values.end(), value) != values.end();
}

bool is_section(std::string_view path) {
  for (const auto& key : parameter_table<double>()) {
    if (key.path.size() > path.size() && key.path.starts_with(path) && key.path[path.size()] == '.') return true;
  }
  return false;
}

std::string_view nearest_name(std::string_view given, std::span<const std::string_view> known) {
  if (given.size() > 80) return {};
  Nearest nearest;
  for (const std::string_view name : known) nearest.offer(name, edit_distance(given, name));
  return nearest.distance <= std::max<std::size_t>(2, given.size() / 3) ? nearest.path : std::string_view{};
}

std::string nearest_key(std::string_view path) {
  constexpr std::size_t longest = 80;
  if (path.size() > longest) return {};
  Nearest nearest;
  for (const auto& key : parameter_table<double>()) {
    nearest.offer(key.path, edit_distance(path, key.path));
    // The right name in the wrong section.
    if (leaf_of(key.path) == leaf_of(path)) nearest.offer(key.path, 2);
    if (has_words_of(key.path, path)) nearest.offer(key.path, 1);
  }
  for (const std::string_view section : sections()) nearest.offer(section, edit_distance(path, section));
  const bool near = nearest.distance <= std::max<std::size_t>(2, leaf_of(path).size() / 3);
  return near ? std::string(nearest.path) : std::string();
}

std::string unknown_key_message(std::string_view path) {
  const std::string_view parent = parent_of(path);
  const bool top = parent.empty();
  if (const std::string near = nearest_key(path); !near.empty()) {
    const bool section = is_section(near) && !find_parameter<double>(near);
    return "unknown key; did you mean " + (section && top ? "[" + near + "]" : near) + "?";
  }
  std::string known;
  if (!top && is_section(parent)) {
    for (const auto& key : parameter_table<double>()) {
      if (parent_of(key.path) == parent) known += (known.empty() ? "" : ", ") + std::string(leaf_of(key.path));
    }
    if (!known.empty()) return "unknown key; [" + std::string(parent) + "] knows " + known;
  }
  for (const std::string_view section : sections()) {
    if (parent_of(section).empty()) known += (known.empty() ? "[" : ", [") + std::string(section) + "]";
  }
  return "unknown key; the sections are " + known;
}

}  // namespace wingbeat
