// Data files that the program carries with it, so that it finds them wherever it is installed.
#pragma once

#include <string_view>

namespace wingbeat::embedded {

/// The text of a file of data/, by its path there. Throws std::out_of_range for one that is not embedded.
std::string_view text_of(std::string_view path);

}  // namespace wingbeat::embedded
