// Decimal numbers in texts.
#pragma once

#include <charconv>

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

}  // namespace wingbeat::detail
