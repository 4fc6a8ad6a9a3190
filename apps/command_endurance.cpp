// wingbeat endurance VEHICLE: how long a vehicle hovers and flaps on its battery.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/report/endurance_report.hpp"

namespace wingbeat::app {
namespace {

struct EnduranceArguments {
  std::string vehicle, output, plot, plot_width;
  std::vector<std::string> overrides;
  bool json = false, force = false;
  bool allow_extrapolation = false, hover = false;
};

int run(const EnduranceArguments& arguments) {
  const auto format = asked_format("--plot", arguments.plot, arguments.plot_width);
  if (!arguments.output.empty() && std::filesystem::path(arguments.output).extension() != ".nc") {
    throw InputError("-o " + arguments.output, 0, 0, "", "the name must end in .nc");
  }
  Design<double> design = read_design(arguments.vehicle, arguments.overrides);
  if (!has_battery(design.supply.type)) {
    throw InputError(arguments.vehicle, 0, 0, "supply.type",
                     "only a battery runs down; expected battery or battery-sine");
  }
  if (arguments.hover) {
    if (!design.mass) throw InputError("--hover", 0, 0, "", "needs vehicle.mass, which the vehicle does not give");
    design.supply.throttle = Throttle::hover;
  }
  std::optional<OutputFile> output, plot;
  if (!arguments.output.empty()) output.emplace("-o", arguments.output, OutputRules{".nc", arguments.force});
  if (format) plot.emplace("--plot", arguments.plot, OutputRules{plot_extensions, arguments.force});

  EnduranceOptions options;
  options.allow_extrapolation = arguments.allow_extrapolation;
  const EnduranceResult result = simulate_discharge(design, options);
  const bool flies = result.endurance() > 0.0;
  if (flies && output) {
    write_endurance(result,
                    {.title = fmt::format("Discharge of the battery of {}",
                                          design.name.empty() ? written_name(arguments.vehicle) : design.name),
                     .command = "endurance",
                     .version = version,
                     .vehicle = write_design(design),
                     .condition = "air",
                     .method = "orbit",
                     .tolerance = options.tolerance},
                    output->temporary());
    output->commit();
  }
  if (flies && plot) {
    plot_endurance(design, result, *format, plot->temporary());
    plot->commit();
  }
  print(arguments.json ? json_endurance(result) : text_endurance(design, result));
  if (!flies && (output || plot)) complain("the vehicle does not flap on this battery: no file was written");
  return result.end == EnduranceEnd::never_starts ? does_not_flap : done;
}

}  // namespace

void add_endurance(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("endurance", "Find how long a vehicle hovers and flaps on its battery");
  const auto a = std::make_shared<EnduranceArguments>();
  command->add_flag("--hover", a->hover,
                    "Fly at the throttle that just carries the weight, as supply.throttle = \"hover\"");
  command->add_flag("--allow-extrapolation", a->allow_extrapolation,
                    "Flight outside the model's domain may hover (docs/domain.md)");
  add_input(command, a->vehicle, InputKind::vehicle, "vehicle", "Vehicle file (TOML) with a battery", "VEHICLE");
  add_set(command, a->overrides);
  add_json(command, a->json);
  add_file(command, "-o,--output", a->output, ".nc", "Write the discharge (NetCDF-4)", "FILE.nc");
  add_file(command, "--plot", a->plot, plot_extensions, "Plot the discharge to FILE.svg, .pdf or .png");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  command->footer(
      "Example:\n  wingbeat endurance friction2022-battery --plot flight.svg\n\n"
      "The battery drains from supply.charge through steady flapping until it is empty, its terminals fall to\n"
      "supply.cutoff_voltage, or it no longer turns the crank. The vehicle hovers until its lift falls below the\n"
      "weight or it leaves the model's domain. With --hover the speed control sets the duty (of a direct drive the\n"
      "amplitude) at each charge so that the lift carries the weight, until full throttle no longer does.\n\n"
      "Exit status: 0 done, 2 bad input or usage, 3 the battery cannot start the vehicle, 1 anything else.");
  command->callback([a, &action] {
    action = [a] {
      a->vehicle = find_input(a->vehicle, InputKind::vehicle).string();
      return run(*a);
    };
  });
}

}  // namespace wingbeat::app
