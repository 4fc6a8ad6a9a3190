// Decimal numbers in texts.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#ifndef __cpp_lib_to_chars
#include <fast_float/fast_float.h>
#endif

namespace wingbeat::detail {

/// std::from_chars of a double, by a library where the standard one has none (libc++ of emscripten 3).
inline std::from_chars_result read_number(const char* first, const char* last, double& value) {
#ifdef __cpp_lib_to_chars
  return std::from_chars(first, last, value);
#else
  const auto [end, error] = fast_float::from_chars(first, last, value);
  return {end, error};
#endif
}

/// The finite number that a whole text is, with a sign or without; none where it is another text.
inline std::optional<double> finite_number(std::string text, bool decimal_comma) {
  if (decimal_comma) std::replace(text.begin(), text.end(), ',', '.');
  const char* const end = text.data() + text.size();
  double number = 0.0;
  const auto [last, error] = read_number(text.data() + (text.starts_with('+') ? 1 : 0), end, number);
  if (error != std::errc{} || last != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace wingbeat::detail
