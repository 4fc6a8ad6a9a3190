// --plot and what goes with it, for every command that draws.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "wingbeat/report/plot.hpp"

namespace wingbeat::app {

/// --plot-width, beside --plot or --plot-power.
void add_plot_width(CLI::App* command, std::string& width);

/// Format and width of the figure that `option` names; nothing where it names no file. `pages`: it may be a page
/// (.html). Throws InputError.
std::optional<PlotFormat> asked_format(const std::string& option, const std::string& file, const std::string& width,
                                       bool pages = false);

}  // namespace wingbeat::app
