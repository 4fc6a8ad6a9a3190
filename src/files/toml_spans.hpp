// Where the values of a TOML file stand in its text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace wingbeat {

/// A key with its value; offsets into the text [bytes], ends exclusive.
struct TomlSpan {
  std::string path;                  ///< dotted, from the root
  std::size_t begin = 0;             ///< of the whole dotted key
  std::size_t key = 0, key_end = 0;  ///< the last part of it
  std::size_t value = 0, value_end = 0;
  bool in_line = false;  ///< within an inline table
};

struct TomlHeader {
  std::string path;
  std::size_t end = 0;  ///< of its line, before the line's end
};

struct TomlSpans {
  std::vector<TomlSpan> values;  ///< in the order of the text, inline tables before what they hold
  std::vector<TomlHeader> headers;

  const TomlSpan* find(std::string_view path) const;
};

/// Of a text that is known to be TOML; of any other something within its bounds.
TomlSpans toml_spans(std::string_view text);

}  // namespace wingbeat
