// Encodings of the text files that benches, spreadsheets and manufacturers write.
#pragma once

#include <string>
#include <string_view>

namespace wingbeat::detail {

/// The text in UTF-8, which may come as UTF-8, as UTF-16 with its mark, or as Windows-1252; `encoding` tells
/// which. Throws InputError where it is none of them.
std::string decoded(std::string_view text, const std::string& file, std::string& encoding);

}  // namespace wingbeat::detail
