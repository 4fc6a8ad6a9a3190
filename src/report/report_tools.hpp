// What the reports of several commands share.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "wingbeat/core/math.hpp"
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

/// Lengths, angles, masses and charges of the vehicle file are written as its examples have them; the rest in SI.
struct ShownUnit {
  double factor = 1.0;
  std::string name;
  std::string suffix() const { return name == "1" ? "" : " " + name; }
};

inline ShownUnit shown_unit(std::string_view unit) {
  if (unit == "m") return {1e3, "mm"};
  if (unit == "rad") return {degrees_per_radian, "deg"};
  if (unit == "kg") return {1e3, "g"};
  if (unit == "C") return {1.0 / 3.6, "mA h"};
  if (unit == "J/kg") return {1.0 / 3600.0, "W h/kg"};
  return {1.0, std::string(unit)};
}

/// A parameter of the vehicle file, "8 mm".
inline std::string parameter_text(double x, std::string_view unit) {
  const ShownUnit shown = shown_unit(unit);
  return fmt::format("{:.5g}{}", shown.factor * x, shown.suffix());
}

/// A metric beside its key, whose unit is SI: "12.3 mN", "0.61099 rad (35.007 deg)"; no unit where it is "1".
inline std::string with_unit(double x, std::string_view unit) {
  if (unit == "1") return fmt::format("{:.5g}", x);
  const std::string text = fmt::format("{:.5g} {}", x, unit);
  return unit == "rad" ? fmt::format("{} ({:.5g} deg)", text, degrees_per_radian * x) : text;
}

}  // namespace wingbeat::detail
