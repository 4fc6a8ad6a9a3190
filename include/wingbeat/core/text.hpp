/// Sentences with numbers in them, for the layers below io.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace wingbeat::detail {

/// As std::printf, into a string; what is longer than 600 characters is cut.
[[gnu::format(printf, 1, 2)]] inline std::string format(const char* pattern, ...) {
  char text[600];
  std::va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

}  // namespace wingbeat::detail
