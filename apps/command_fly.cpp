// wingbeat fly FLIGHT: a flight from a plan, with a controller in the loop.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "progress.hpp"
#include "wingbeat/files/flight_file.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/report/fly_report.hpp"

namespace wingbeat::app {
namespace {

struct FlyArguments {
  std::string flight, output, plot, plot_width;
  std::vector<std::string> overrides;
  bool json = false, force = false;
};

int run(const FlyArguments& a) {
  const auto format = asked_format("--plot", a.plot, a.plot_width);
  if (!a.output.empty() && std::filesystem::path(a.output).extension() != ".nc") {
    throw InputError("-o " + a.output, 0, 0, "", "the name must end in .nc");
  }
  FlightFile file = read_flight_file(a.flight, a.overrides);
  std::optional<OutputFile> output, plot;
  if (!a.output.empty()) output.emplace("-o", a.output, OutputRules{".nc", a.force});
  if (format) plot.emplace("--plot", a.plot, OutputRules{plot_extensions, a.force});
  ProgressLine line("fly: ");
  double shown = -1.0;
  file.plan.progress = [&](double time) {
    if (time < shown + 0.05 * file.plan.duration) return;
    shown = time;
    line.show(fmt::format("{:.3g} of {:.3g} s", time, file.plan.duration));
  };
  FlyReport report{file.title.empty() ? file.vehicle.name : file.title, &file.vehicle, &file.plan, {}};
  try {
    report.flight = fly(file.vehicle, file.plan);
  } catch (const ParameterError& e) {
    line.clear();
    throw InputError(input_name(a.flight), 0, 0, e.key(), e.reason());
  }
  line.clear();
  const bool flew = !report.flight.rows.empty();
  if (flew && output) {
    write_flight(file, report.flight, read_text_file(a.flight), version, output->temporary());
    output->commit();
  }
  if (flew && plot) {
    plot_fly(report, *format, plot->temporary());
    plot->commit();
  }
  print(a.json ? json_fly(report) : text_fly(report));
  if (!flew && (output || plot)) complain("there is no flight: no file was written");
  return report.flight.outcome == FlightOutcome::completed ? done : does_not_flap;
}

}  // namespace

void add_fly(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("fly", "Simulate flight with a controller, noise, delay, wind and gusts");
  const auto a = std::make_shared<FlyArguments>();
  add_input(command, a->flight, InputKind::study, "flight", "Flight file (TOML): vehicle, controller, path, wind",
            "FLIGHT");
  add_set(command, a->overrides);
  add_file(command, "-o,--output", a->output, ".nc", "Write the flight over time (NetCDF-4)", "FILE.nc");
  add_file(command, "--plot", a->plot, plot_extensions, "Plot path, attitude, controls and power");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  add_json(command, a->json);
  command->footer(
      "Example:\n  wingbeat fly fly-hover -o flight.nc --plot flight.svg\n\n"
      "The controller, a linear-quadratic regulator or a cascade of PID loops, is designed from the linear model\n"
      "about the trim that the flight starts from. docs/flight-fly.md describes flight files. The flight ends\n"
      "early where the vehicle hits the ground, tips over, flies too far away, jams or has emptied its battery.\n\n"
      "Exit status: 0 flown to the end, 2 bad input or usage, 3 the flight ends early or there is no trim,\n"
      "1 anything else.");
  command->callback([a, &action] {
    action = [a] {
      a->flight = find_input(a->flight, InputKind::study).string();
      return run(*a);
    };
  });
}

}  // namespace wingbeat::app
