#include "wingbeat/report/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "report/described.hpp"
#include "report/layout.hpp"
#include "report/result_schemas.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

const char* separator_name(char c) { return c == ',' ? "commas" : c == ';' ? "semicolons" : "tabs"; }

std::string counted(std::size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

const char* role_of(const LogNotes::Column& c) {
  return c.name.empty() ? "not read" : c.is_set ? "set" : c.is_used ? "measured" : "not used";
}

std::string range_of(const LogNotes::Column& c) {
  if (c.values == 0) return "";
  if (c.unit_si == "1") return fmt::format("{:.4g} to {:.4g}", c.min, c.max);
  return fmt::format("{} to {}", readable(c.min, c.unit_si), readable(c.max, c.unit_si));
}

}  // namespace

std::string left_out(const BenchLog& log) {
  std::string text;
  if (log.values_left_out > 0) {
    text = fmt::format("{} without a value", counted(std::size_t(log.values_left_out), "cell"));
  }
  if (!log.rows_left_out.empty()) {
    constexpr std::size_t listed = 8;
    const std::size_t n = std::min(log.rows_left_out.size(), listed);
    text += fmt::format("{}{} without what was set or measured (line{} {}{})", text.empty() ? "" : ", ",
                        counted(log.rows_left_out.size(), "row"), log.rows_left_out.size() == 1 ? "" : "s",
                        fmt::join(log.rows_left_out.begin(), log.rows_left_out.begin() + std::ptrdiff_t(n), ", "),
                        log.rows_left_out.size() > listed ? ", ..." : "");
  }
  return text.empty() ? "" : "left out: " + text;
}

std::string text_readings(const std::vector<BenchReading>& readings) {
  std::string text;
  for (const auto& [log, notes] : readings) {
    if (!text.empty()) text += "\n";
    text += log.file + "\n";
    text += fmt::format("  {}, cells between {}, decimal {}{}\n", notes.encoding, separator_name(notes.separator),
                        notes.decimal_comma ? "comma" : "point",
                        notes.remarks > 0 ? ", " + counted(std::size_t(notes.remarks), "line") + " of remarks" : "");
    text += fmt::format("  {}{}\n", counted(log.rows.size(), "row"),
                        notes.sorted ? ""
                                     : fmt::format(", sorted by the {}", log.waveform                  ? "crank angle"
                                                                         : log.given == Given::voltage ? "voltage"
                                                                                                       : "frequency"));
    if (const std::string missing = left_out(log); !missing.empty()) text += "  " + missing + "\n";
    std::size_t header = 6, name = 4;
    for (const LogNotes::Column& c : notes.columns) {
      header = std::max(header, c.header.size());
      name = std::max(name, c.name.size());
    }
    text += fmt::format("\n  {:<{}}  {:<{}}  {:<9} {:>6}  {}\n", "column", header, "read as",
                        std::max<std::size_t>(name, 7), "role", "values", "range");
    for (const LogNotes::Column& c : notes.columns) {
      std::string line = fmt::format("  {:<{}}  {:<{}}  {:<9} {:>6}  {}", c.header, header,
                                     c.name.empty() ? "-" : c.name, std::max<std::size_t>(name, 7), role_of(c),
                                     c.name.empty() ? "" : fmt::format("{}", c.values), range_of(c));
      while (line.back() == ' ') line.pop_back();
      text += line + "\n";
    }
  }
  return text;
}

namespace described {
namespace {

const Description<LogNotes::Column>& column_description() {
  using R = LogNotes::Column;
  static const Description<R> description =
      Description<R>()
          .always("header", "", "as it stands in the file", &R::header)
          .always("read_as", "", "quantity; null where the column is not read",
                  [](const R& r) { return r.name.empty() ? std::nullopt : std::optional(r.name); })
          .always("role", "", "set, measured, not used or not read", [](const R& r) { return role_of(r); })
          .always("unit", "", "as written", &R::unit)
          .always("unit_si", "", "of the next three", &R::unit_si)
          .always("factor", "", "SI value over the number", &R::factor)
          .always("min", "", "SI", [](const R& r) { return r.values > 0 ? r.min : absent; })
          .always("max", "", "SI", [](const R& r) { return r.values > 0 ? r.max : absent; })
          .always("values", "", "numbers in it", &R::values);
  return description;
}

const Description<BenchReading>& reading_description() {
  using R = BenchReading;
  static const Description<R> description =
      Description<R>()
          .always("file", "", "", [](const R& r) { return r.log.file; })
          .always("encoding", "", "", [](const R& r) { return r.notes.encoding; })
          .always("separator", "", "between cells", [](const R& r) { return std::string(1, r.notes.separator); })
          .always("decimal", "", "sign", [](const R& r) { return std::string(r.notes.decimal_comma ? "," : "."); })
          .always("remarks", "", "lines of comments", [](const R& r) { return r.notes.remarks; })
          .always("rows", "", "", [](const R& r) { return r.log.rows.size(); })
          .always("sorted", "", "rows stood in the order of what was set", [](const R& r) { return r.notes.sorted; })
          .always("values_left_out", "", "cells without a value", [](const R& r) { return r.log.values_left_out; })
          .always("rows_left_out", "", "lines of rows without what was set or measured",
                  [](const R& r) { return r.log.rows_left_out; })
          .parts("columns", "in the order of the file", column_description(),
                 [](const R& r) { return r.notes.columns; });
  return description;
}

struct Readings {
  const std::vector<BenchReading>& all;
};

const Description<Readings>& readings_description() {
  static const Description<Readings> description = Description<Readings>().parts(
      "logs", "in the order of the bench file", reading_description(), [](const Readings& r) { return r.all; });
  return description;
}

}  // namespace

Json readings_schema() { return readings_description().schema(); }

}  // namespace described

std::string json_readings(const std::vector<BenchReading>& readings) {
  return detail::dumped(described::readings_description().json({readings}));
}

}  // namespace wingbeat
