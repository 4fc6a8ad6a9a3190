#include "files/column_headers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "wingbeat/core/text.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {
namespace {

/// As benches write units, and what UDUNITS does not know of them.
struct Spelling {
  std::string_view written, expected;
  double factor;
};
constexpr double gram_force = 1e-3 * standard_gravity;
constexpr Spelling spellings[] = {{"g", "N", gram_force},
                                  {"gf", "N", gram_force},
                                  {"gram", "N", gram_force},
                                  {"grams", "N", gram_force},
                                  {"gram-force", "N", gram_force},
                                  {"mg", "N", 1e-3 * gram_force},
                                  {"mgf", "N", 1e-3 * gram_force},
                                  {"kg", "N", 1e3 * gram_force},
                                  {"kgf", "N", 1e3 * gram_force},
                                  {"rpm", "Hz", 1.0 / 60.0},
                                  {"1/min", "Hz", 1.0 / 60.0},
                                  {"min-1", "Hz", 1.0 / 60.0},
                                  {"1/s", "Hz", 1.0},
                                  {"volt", "V", 1.0},
                                  {"volts", "V", 1.0},
                                  {"mah", "C", 3.6},
                                  {"ah", "C", 3600.0},
                                  {"rpm", "rad/s", 0.10471975511965977},
                                  {"1/min", "rad/s", 0.10471975511965977},
                                  {"min-1", "rad/s", 0.10471975511965977},
                                  {"amp", "A", 1.0},
                                  {"amps", "A", 1.0}};

std::string small(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return result;
}

/// "Mean lift" as mean_lift.
std::string as_name(std::string_view text) {
  std::string name = small(trimmed(text));
  std::replace_if(name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return name;
}

/// A header taken apart: "Lift (g)", "lift [mN]", "Lift / mN", "lift_mean_mN" after any known name.
struct HeaderParts {
  std::string name, unit;
};
std::optional<HeaderParts> bracketed(std::string_view header) {
  for (const auto& [open, close] : {std::pair('(', ')'), std::pair('[', ']')}) {
    const std::size_t begin = header.rfind(open);
    if (begin == std::string_view::npos || begin == 0 || header.back() != close) continue;
    return HeaderParts{as_name(header.substr(0, begin)),
                       std::string(trimmed(header.substr(begin + 1, header.size() - begin - 2)))};
  }
  const std::size_t slash = header.find(" / ");
  if (slash != std::string_view::npos && slash > 0) {
    return HeaderParts{as_name(header.substr(0, slash)), std::string(trimmed(header.substr(slash + 3)))};
  }
  return std::nullopt;
}

/// SI value of a number in a column over the number. Throws UnitError for a unit of another kind.
double column_factor(std::string_view unit, std::string_view expected) {
  if (expected == "degC") {  // it has a zero of its own
    if (small(unit) == "degc" || unit == "°C") return 1.0;
    throw UnitError("expected degC");
  }
  for (const Spelling& s : spellings) {
    if (small(unit) == s.written && expected == s.expected) return s.factor;
  }
  if (expected == "degree") return degrees_per_radian * unit_factor(unit == "°" ? "degree" : unit, "rad");
  return unit_factor(unit.empty() ? "1" : unit, expected);
}

}  // namespace

std::string base_name(std::string_view key) {
  for (const std::string_view suffix : {"_rad_per_s", "_v", "_hz", "_a", "_w", "_n", "_rad", "_deg", "_degc", "_k"}) {
    if (key.ends_with(suffix)) return std::string(key.substr(0, key.size() - suffix.size()));
  }
  return std::string(key);
}

const NamedColumn* find_column(std::string_view name, std::span<const NamedColumn* const> known,
                               std::span<const ColumnAlias> aliases) {
  const std::string wanted = base_name(as_name(name));
  for (const NamedColumn* c : known) {
    if (c->name == wanted) return c;
  }
  for (const ColumnAlias& alias : aliases) {
    if (alias.written != wanted) continue;
    for (const NamedColumn* c : known) {
      if (c->name == alias.name) return c;
    }
  }
  return nullptr;
}

RecognisedHeader recognise_header(std::string_view header, std::span<const NamedColumn* const> known,
                                  std::span<const ColumnAlias> aliases) {
  // As JSON and data sets name it, in SI.
  for (const NamedColumn* c : known) {
    if (header == c->full && c->full != c->name) return {c, 1.0, c->unit, false, ""};
  }
  struct Candidate {
    const NamedColumn* column = nullptr;
    std::string unit;
    bool alias = false;
  };
  Candidate best;
  if (const auto parts = bracketed(header)) {
    if (const NamedColumn* found = find_column(parts->name, known, aliases)) {
      best = {found, parts->unit, found->name != base_name(parts->name)};
    }
  }
  if (!best.column) {
    const std::string name = as_name(header);
    std::size_t longest = 0;
    const auto offer = [&](std::string_view written, const NamedColumn& column, bool alias) {
      const bool whole = name == written;
      const bool begins = name.size() > written.size() && name.starts_with(written) && name[written.size()] == '_';
      if ((!whole && !begins) || written.size() <= longest) return;
      longest = written.size();
      std::string unit(header.substr(std::min(header.size(), written.size())));
      std::replace(unit.begin(), unit.end(), '_', ' ');
      best = {&column, std::string(trimmed(unit)), alias};
    };
    const std::size_t blanks = header.find_first_not_of(' ');
    header.remove_prefix(std::min(blanks, header.size()));
    for (const NamedColumn* c : known) offer(c->name, *c, false);
    for (const ColumnAlias& alias : aliases) {
      for (const NamedColumn* c : known) {
        if (c->name == alias.name) offer(alias.written, *c, true);
      }
    }
  }
  if (!best.column) return {};
  RecognisedHeader result{best.column, 1.0, best.unit, best.alias, ""};
  if (best.column->unit.empty()) return result;
  if (best.unit.empty() && best.column->unit != "1") {
    // A metric as the program writes it has its unit in its name; other names need one.
    result.complaint =
        fmt::format("names no unit; write {}_{} or {} [{}]", best.column->name,
                    best.column->unit == "degree" ? "deg" : best.column->unit, best.column->name, best.column->unit);
    return result;
  }
  try {
    result.factor = column_factor(best.unit, best.column->unit);
  } catch (const UnitError& error) {
    // What is no unit of the quantity shows that a bench's name stands for another one.
    if (best.alias) return {};
    result.complaint = fmt::format("the unit {} is wrong: {}", in_quotes(best.unit), error.what());
  }
  return result;
}

RecognisedHeader recognise_stated(std::string_view name, std::string_view header,
                                  std::span<const NamedColumn* const> known, std::span<const ColumnAlias> aliases) {
  RecognisedHeader found = recognise_header(name, known, aliases);
  const NamedColumn* column = found.column ? found.column : find_column(name, known, aliases);
  if (!column) return {};
  if (!found.column || !found.complaint.empty()) {
    const std::size_t bracket = std::min(header.find_first_of("[("), header.size());
    found = recognise_header(column->name + std::string(header.substr(bracket)), known, aliases);
  }
  found.renamed = true;
  return found;
}

}  // namespace wingbeat::detail
