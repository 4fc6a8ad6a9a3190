// The result of a run for people (a table) and for programs (JSON).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wingbeat/study/run.hpp"

namespace wingbeat {

/// One JSON object with the keys of `wingbeat run --json` in their order, SI, absent metrics null; numbers read back to
/// the same double. With Method::transient it ends with an object `start_up`.
std::string json_report(const RunResult& result);

/// What else a user should know about a run: `warnings` of json_report, a sentence each.
std::vector<std::string> warnings_of(const RunResult& result);

/// A table of at most 90 columns with units chosen for reading. `options` are those of the run.
std::string text_report(const RunResult& result, const RunOptions& options);

/// A number with four significant digits and the SI prefix that suits it: 0.0123 "N" gives "12.30 mN".
/// An absent number is "-".
std::string readable(double value, std::string_view unit);

/// Text without control characters, broken at spaces so that no line exceeds `width` columns; every line after the
/// first starts with `indent` spaces. Counts UTF-8 characters, not bytes.
std::string wrapped(std::string_view text, int width, int indent);

}  // namespace wingbeat
