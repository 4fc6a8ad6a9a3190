// What a stream holds, where it may hold too much.
#pragma once

#include <istream>
#include <string>

namespace wingbeat::detail {

/// The rest of a stream; of one that holds more than `largest` bytes, some more than these.
inline std::string read_stream(std::istream& stream, std::size_t largest) {
  std::string text;
  char block[1 << 14];
  while (text.size() <= largest && (stream.read(block, sizeof block), stream.gcount() > 0)) {
    text.append(block, std::size_t(stream.gcount()));
  }
  return text;
}

}  // namespace wingbeat::detail
