// Texts and keys in TOML that the program writes.
#pragma once

#include <string>
#include <string_view>

namespace wingbeat {

/// A TOML string that reads back as this text: quotes, backslashes and hidden characters (core/text.hpp) escaped, so
/// that it is one line and shows what it holds. Bytes that are not UTF-8, which TOML cannot hold, become U+FFFD.
std::string toml_text(std::string_view text);

/// A key, in quotes where it needs them.
std::string toml_key(std::string_view key);

}  // namespace wingbeat
