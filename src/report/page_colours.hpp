// Colours of drawings inside a page, which follow its theme.
#pragma once

#include <string>

namespace wingbeat {

/// Definitions of the page's colours, " --ink: #000000; ...", for the light or the dark theme.
std::string colour_variables(bool dark);
/// Replaces the colours of an SVG by those names, var(--ink), and its font by the page's.
void use_page_colours(std::string& svg);

}  // namespace wingbeat
