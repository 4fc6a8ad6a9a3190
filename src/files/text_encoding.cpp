#include "files/text_encoding.hpp"

#include <fmt/format.h>
#include <iconv.h>

#include <cstdint>
#include <memory>
#include <optional>

#include "wingbeat/files/design_file.hpp"

namespace wingbeat::detail {
namespace {

/// Empty where the bytes are not of that encoding.
std::optional<std::string> from(const char* encoding, std::string_view text) {
  auto* const converter = iconv_open("UTF-8", encoding);
  if (reinterpret_cast<std::intptr_t>(converter) == -1) return std::nullopt;
  const std::unique_ptr<void, int (*)(iconv_t)> closes(converter, iconv_close);
  std::string input(text), output(4 * text.size() + 4, '\0');
  char* in = input.data();
  char* out = output.data();
  std::size_t in_left = input.size(), out_left = output.size();
  if (iconv(converter, &in, &in_left, &out, &out_left) == std::size_t(-1) || in_left > 0) return std::nullopt;
  output.resize(output.size() - out_left);
  return output;
}

}  // namespace

std::string decoded(std::string_view text, const std::string& file, std::string& encoding) {
  struct Mark {
    std::string_view bytes;
    const char* encoding;
  };
  constexpr Mark marks[] = {{"\xEF\xBB\xBF", "UTF-8"}, {"\xFF\xFE", "UTF-16LE"}, {"\xFE\xFF", "UTF-16BE"}};
  for (const Mark& mark : marks) {
    if (!text.starts_with(mark.bytes)) continue;
    encoding = mark.encoding;
    const auto converted = from(mark.encoding, text.substr(mark.bytes.size()));
    if (!converted) throw InputError(file, 0, 0, "", fmt::format("is marked as {} and is not", mark.encoding));
    return *converted;
  }
  for (const char* candidate : {"UTF-8", "WINDOWS-1252"}) {
    encoding = candidate;
    if (const auto converted = from(candidate, text)) return *converted;
  }
  throw InputError(file, 0, 0, "", "is no text in UTF-8, UTF-16 or Windows-1252");
}

}  // namespace wingbeat::detail
