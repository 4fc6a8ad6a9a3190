// Sentences with numbers in them, and words made of identifiers.
#pragma once

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <string>
#include <string_view>

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

/// An identifier as words: spaces for underscores.
inline std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// A name as an identifier: underscores for hyphens and spaces.
inline std::string underscored(std::string name) {
  std::replace_if(name.begin(), name.end(), [](char c) { return c == '-' || c == ' '; }, '_');
  return name;
}

/// Without white space at either end.
inline std::string_view trimmed(std::string_view text) {
  constexpr const char* white = " \t\r\n";
  const auto first = text.find_first_not_of(white);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(white) - first + 1);
}

/// Of HTML, SVG and XML, in text and attributes; control characters become spaces.
inline std::string markup_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

}  // namespace wingbeat::detail
