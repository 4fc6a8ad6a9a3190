// What the reports of several commands share.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "wingbeat/core/text.hpp"

namespace wingbeat::detail {

/// Columns of the texts about optima and fronts.
inline constexpr int optimum_width = 100;

using Json = nlohmann::ordered_json;

/// JSON knows neither infinity nor NaN.
inline Json number_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

/// As it is printed and written: bytes that are not UTF-8 replaced, hidden characters escaped.
inline std::string dumped(const Json& json) {
  return printable(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

/// "12.3 mN"; no unit where it is "1".
inline std::string with_unit(double x, std::string_view unit) {
  return unit == "1" ? fmt::format("{:.5g}", x) : fmt::format("{:.5g} {}", x, unit);
}

}  // namespace wingbeat::detail
