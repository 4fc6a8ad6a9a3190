#include "plot_option.hpp"

#include <fmt/format.h>

#include <cmath>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::app {
namespace {

constexpr double metres_per_inch = 0.0254;

double printed_width(const std::string& text) {
  double metres = 0.0;
  try {
    metres = parse_quantity(text, "m");
  } catch (const UnitError& error) {
    throw InputError("--plot-width", 0, 0, "", error.what());
  }
  for (const double width : {single_column_width, double_column_width}) {
    if (std::abs(metres - metres_per_inch * width) < 1e-6) return width;
  }
  throw InputError("--plot-width", 0, 0, "",
                   "must be 89 mm, one column of a journal, or 183 mm, both; got " + in_quotes(text));
}

}  // namespace

void add_plot_width(CLI::App* command, std::string& width) {
  command->add_option("--plot-width", width, "Width of the printed figure: \"89 mm\" (default) or \"183 mm\"")
      ->type_name("WIDTH");
}

std::optional<PlotFormat> asked_format(const std::string& option, const std::string& file, const std::string& width,
                                       bool pages) {
  const double inches = width.empty() ? single_column_width : printed_width(width);
  if (file.empty()) return std::nullopt;
  auto format = plot_format(file);
  if (!format || (*format == PlotFormat::html && !pages)) {
    throw InputError(
        fmt::format("{} {}", option, file), 0, 0, "",
        pages ? "the name must end in .svg, .pdf, .png or .html" : "the name must end in .svg, .pdf or .png");
  }
  format->width = inches;
  return format;
}

}  // namespace wingbeat::app
