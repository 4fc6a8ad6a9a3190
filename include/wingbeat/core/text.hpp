// Sentences with numbers in them, and words made of identifiers.
#pragma once

#include <algorithm>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
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

/// A character of a UTF-8 text. A byte that belongs to none is not valid and counts alone.
struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t length = 1;
  bool valid = false;
};

inline Utf8Character utf8_at(std::string_view text, std::size_t position) {
  const auto byte = [&](std::size_t n) { return std::uint32_t(static_cast<unsigned char>(text[position + n])); };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return {first, 1, true};
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || position + length > text.size()) return {first, 1, false};
  std::uint32_t code = first & (0x7Fu >> length);
  for (std::size_t n = 1; n < length; ++n) {
    if ((byte(n) & 0xC0u) != 0x80u) return {first, 1, false};
    code = code << 6 | (byte(n) & 0x3Fu);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  if (overlong || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {first, 1, false};
  return {code, length, true};
}

/// True of what acts on a terminal or a page in place of being seen there: control characters (C0, DEL, C1), separators
/// of lines, marks that turn the direction of text, and what is no character.
inline bool is_hidden(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code <= 0x9F) || code == 0x61C || code == 0x200E || code == 0x200F ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF ||
         (code >= 0xFFF9 && code <= 0xFFFB) || code == 0xFFFE || code == 0xFFFF;
}

/// Text that comes from a file, as it may be shown: hidden characters as \u009b, bytes that are not UTF-8 as \x9b. Line
/// breaks and tabs stay. In JSON, where hidden characters stand in strings alone, the same text results.
inline std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t position = 0; position < text.size();) {
    const Utf8Character c = utf8_at(text, position);
    const bool kept = c.valid && (c.code == '\n' || c.code == '\t' || !is_hidden(c.code));
    if (kept) out += text.substr(position, c.length);
    else out += format(c.valid ? "\\u%04x" : "\\x%02x", unsigned(c.code));
    position += c.length;
  }
  return out;
}

/// Of HTML, SVG and XML, in text and attributes; line breaks and tabs become spaces.
inline std::string markup_escaped(std::string_view text) {
  std::string out;
  for (const char c : printable(text)) {
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
