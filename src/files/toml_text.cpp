#include "wingbeat/files/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "files/toml_prevalidation.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat {

std::string toml_text(std::string_view text) {
  std::string result = "\"";
  for (std::size_t position = 0; position < text.size();) {
    const detail::Utf8Character c = detail::utf8_at(text, position);
    if (!c.valid) {
      result += "\\uFFFD";
    } else if (c.code == '"' || c.code == '\\') {
      result += '\\';
      result += char(c.code);
    } else if (detail::is_hidden(c.code)) {
      result += fmt::format("\\u{:04X}", c.code);
    } else {
      result += text.substr(position, c.length);
    }
    position += c.length;
  }
  return result + '"';
}

std::string toml_key(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), is_bare_key_character);
  return bare ? std::string(key) : toml_text(key);
}

}  // namespace wingbeat
