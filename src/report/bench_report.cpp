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

const char* unit_of(const BenchLog& log) { return log.given == Given::voltage ? "V" : "Hz"; }

std::string range_of(const LogNotes::Column& c) {
  if (c.values == 0) return "";
  if (c.unit_si == "rad") {
    return fmt::format("{:.4g} deg to {:.4g} deg", degrees_per_radian * c.min, degrees_per_radian * c.max);
  }
  if (c.unit_si == "1") return fmt::format("{:.4g} to {:.4g}", c.min, c.max);
  return fmt::format("{} to {}", readable(c.min, c.unit_si), readable(c.max, c.unit_si));
}

/// The mean cycles of a record.
std::string bursts_of(const BenchLog& log, const LogNotes& notes) {
  if (notes.bursts.empty()) return "";
  std::string text = fmt::format("\n  {:<6} {:>8} {:>8}  {:<24} {:>14}  {}\n", "burst", "samples", "cycles",
                                 "frequency", "rate", log.given == Given::voltage ? "voltage" : "set frequency");
  for (const LogNotes::Burst& b : notes.bursts) {
    const std::string error =
        std::isfinite(b.frequency_error) ? fmt::format(" +- {}", readable(b.frequency_error, "Hz")) : "";
    std::string line =
        fmt::format("  {:<6} {:>8} {:>8.1f}  {:<24} {:>14}  {}", b.number > 0 ? fmt::format("{}", b.number) : "-",
                    b.samples, b.cycles, readable(b.frequency, "Hz") + error, fmt::format("{:+.3g} Hz/s", b.rate),
                    std::isfinite(b.given) ? readable(b.given, unit_of(log)) : "not stated");
    text += line + "\n";
  }
  if (notes.rows_in_short_burst > 0) {
    text += fmt::format("  left out: {} behind the last whole burst\n",
                        counted(std::size_t(notes.rows_in_short_burst), "row"));
  }
  return text;
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
    text +=
        fmt::format("  {}{}\n", counted(notes.bursts.empty() ? log.rows.size() : std::size_t(notes.rows_read), "row"),
                    notes.sorted ? ""
                                 : fmt::format(", sorted by the {}", !notes.bursts.empty()         ? "time"
                                                                     : log.waveform                ? "crank angle"
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
    text += bursts_of(log, notes);
  }
  return text;
}

namespace described {
namespace {

const Description<LogNotes::Column>& column_description() {
  using R = LogNotes::Column;
  static const Description<R> description =
      Description<R>()
          .always("header", "", "as in the file", &R::header)
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

const Description<LogNotes::Burst>& burst_description() {
  using R = LogNotes::Burst;
  static const Description<R> description =
      Description<R>()
          .always("line", "", "of its first row", &R::line)
          .always("number", "", "of the burst; 0 where the record is one", &R::number)
          .always("samples", "", "rows", &R::samples)
          .always("cycles", "1", "", &R::cycles)
          .always("frequency_hz", "Hz", "in its middle", &R::frequency)
          .always("frequency_error_hz", "Hz", "standard error", &R::frequency_error)
          .always("rate_hz_per_s", "Hz/s", "by which the frequency changes", &R::rate)
          .always("given", "", "voltage [V] or frequency [Hz] that was set; null where not known", &R::given)
          .always(
              "correlation", "1",
              "variance of a mean of neighbouring samples over that of independent ones, the largest of the columns",
              &R::correlation);
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
          .always("sorted", "", "the rows were in the order of the quantity that was set",
                  [](const R& r) { return r.notes.sorted; })
          .always("values_left_out", "", "cells without a value", [](const R& r) { return r.log.values_left_out; })
          .always("rows_left_out", "", "lines of rows without what was set or measured",
                  [](const R& r) { return r.log.rows_left_out; })
          .parts("bursts", "mean cycles of a record of signals", burst_description(),
                 [](const R& r) { return r.notes.bursts; })
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
