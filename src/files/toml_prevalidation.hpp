// What is refused of a TOML text before toml++ reads it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wingbeat {

/// What a key without quotes consists of.
inline bool is_bare_key_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

struct TomlComplaint {
  int line;
  int column;
  std::string message;
};

/// Keeps from toml++ 3.3 what it meets with undefined behaviour instead of an error:
/// - deep nesting: it builds and destroys nested tables recursively and does not limit dotted keys;
/// - a table header that does not begin with a key, "[=" (its issue 294);
/// - more sections or keys than any file has, for which it takes minutes;
/// - letters beyond ASCII where it looks for white space (is_non_ascii_horizontal_whitespace).
std::optional<TomlComplaint> prevalidation_complaint(std::string_view text);

}  // namespace wingbeat
