// wingbeat compare FILE: published values beside ours.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <vector>

#include "command.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/files/published.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/reproduction/comparison.hpp"

namespace wingbeat::app {
namespace {

struct CompareArguments {
  std::vector<std::string> overrides;
  std::string file;
  bool json = false, force = false;
  std::string plot_power, plot_width;
};

std::string spaced(std::string text) {
  for (char& c : text) c = c == '_' ? ' ' : c;
  return text;
}

int run(const CompareArguments& arguments) {
  const auto format = asked_format("--plot-power", arguments.plot_power, arguments.plot_width);
  const PublishedFile file = read_published(arguments.file, arguments.overrides);
  std::optional<OutputFile> plot;
  if (format) plot.emplace("--plot-power", arguments.plot_power, OutputRules{plot_extensions, arguments.force});
  const Comparison comparison = compare(file);

  bool all_flap = true;
  std::vector<PowerBar> bars;
  for (const Comparison::Run& r : comparison.runs) {
    if (r.result.status != FlappingStatus::flapping ||
        r.result.search.value_or(FrequencySearch{}).outcome == FrequencyOutcome::too_high) {
      complain(fmt::format("{} at {} does not flap: {}", spaced(r.design), operating_point(r.voltage, r.frequency),
                           describe(r.result)));
      all_flap = false;
      continue;
    }
    bars.push_back({fmt::format("{}, {}", operating_point(r.voltage, r.frequency), spaced(r.design)),
                    energy_audit(r.result.metrics)});
  }
  if (plot && !bars.empty()) {
    plot_powers(bars, "Where the electrical power goes", *format, plot->temporary());
    plot->commit();
  }
  print(arguments.json ? json_comparison(file, comparison) : text_comparison(file, comparison));
  if (!all_flap) return does_not_flap;
  return done;
}

}  // namespace

void add_compare(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("compare", "Compare published values with those of the program");
  const auto a = std::make_shared<CompareArguments>();
  add_input(command, a->file, InputKind::published, "file", "File of published values (TOML)", "FILE");
  add_set(command, a->overrides);
  add_json(command, a->json);
  add_file(command, "--plot-power", a->plot_power, plot_extensions,
           "Plot the power breakdowns to FILE.svg, .pdf or .png");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  command->footer(
      "Example:\n"
      "  wingbeat compare friction2022\n\n"
      "Exit status: 0 done, whatever the deviations, 2 bad input or usage, 3 a vehicle does not flap, "
      "1 anything else.");
  command->callback([a, &action] {
    action = [a] {
      a->file = find_input(a->file, InputKind::published).string();
      return run(*a);
    };
  });
}

}  // namespace wingbeat::app
