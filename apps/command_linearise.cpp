// wingbeat linearise VEHICLE: the models that controllers are designed on.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "command.hpp"
#include "operating_point.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "wingbeat/files/control_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/report/control_report.hpp"
#include "wingbeat/report/two_sides_report.hpp"

namespace wingbeat::app {
namespace {

constexpr const char* model_extensions = ".toml .json .nc .mat";

struct LineariseArguments {
  OperatingPointArguments operating_point;
  std::string output, plot, hinge_offset, plot_width;
  int cycles = 0;
  bool no_maps = false, json = false, force = false;
};

void write_models(const ControlModels& models, OutputFile& output, const std::string& extension) {
  if (extension == ".nc") write_control_netcdf(models, version, output.temporary());
  else if (extension == ".mat") write_control_mat(models, version, output.temporary());
  else output.write(extension == ".json" ? json_control(models, version) : toml_control(models, version));
  output.commit();
}

/// Of a vehicle whose sides differ the static maps.
int map_sides(const TwoSides& sides, const LineariseArguments& arguments, const ControlOptions& options) {
  for (const auto& [option, text] : {std::pair("-o", &arguments.output), std::pair("--plot", &arguments.plot)}) {
    if (!text->empty()) {
      throw InputError(option, 0, 0, "",
                       "of a vehicle whose sides differ there are static maps alone; --json has them");
    }
  }
  const TwoSidesMaps found = two_sides_maps(sides, options);
  print(arguments.json ? json_two_sides_maps(found, version) : text_two_sides_maps(found));
  if (!found.maps.empty() || arguments.no_maps) return done;
  if (found.operating_point.status != FlappingStatus::flapping) return does_not_flap;
  complain("it flaps, but a cycle was found in time alone: there is no orbit to be linearised about");
  return failed;
}

int run(const LineariseArguments& arguments) {
  const std::string extension = std::filesystem::path(arguments.output).extension().string();
  if (!arguments.output.empty() && extension != ".toml" && extension != ".json" && extension != ".nc" &&
      extension != ".mat") {
    throw InputError("-o " + arguments.output, 0, 0, "", "the name must end in .toml, .json, .nc or .mat");
  }
  const auto format = asked_format("--plot", arguments.plot, arguments.plot_width);
  ControlOptions options;
  options.allocation_maps = !arguments.no_maps;
  options.step_cycles = arguments.cycles;
  if (!arguments.hinge_offset.empty()) {
    options.hinge_offset = quantity_of("--hinge-offset", arguments.hinge_offset, "m");
    if (options.hinge_offset < 0.0) throw InputError("--hinge-offset", 0, 0, "", "must be >= 0 m");
  }
  const VehicleFile vehicle = read_operating_point(arguments.operating_point, options.operating_point);
  if (vehicle.sides) return map_sides(*vehicle.sides, arguments, options);
  const Design<double>& design = vehicle.design;
  std::optional<OutputFile> output, plot;
  if (!arguments.output.empty()) output.emplace("-o", arguments.output, OutputRules{model_extensions, arguments.force});
  if (format) plot.emplace("--plot", arguments.plot, OutputRules{plot_extensions, arguments.force});

  const ControlModels models = control_models(design, options);
  require_reached(arguments.operating_point, models.linear.operating_point);
  if (models.linear.model && output) write_models(models, *output, extension);
  if (models.linear.model && plot) {
    plot_step_responses(models, *format, plot->temporary());
    plot->commit();
  }
  print(arguments.json ? json_control(models, version) : text_control(models));
  if (models.linear.model) return done;
  if (output || plot) complain("no linear model: no file was written");
  if (models.linear.operating_point.status != FlappingStatus::flapping) return does_not_flap;
  complain("it flaps, but its cycle was found in time alone: there is no orbit to be linearised about");
  return failed;
}

}  // namespace

void add_linearise(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("linearise", "Give linear models and static maps for control design");
  const auto a = std::make_shared<LineariseArguments>();
  add_operating_point(command, a->operating_point);
  add_allow_extrapolation(command, a->operating_point);
  add_file(command, "-o,--output", a->output, model_extensions, "Write the models to FILE.toml, .json, .nc or .mat");
  add_file(command, "--plot", a->plot, plot_extensions, "Plot the step responses to FILE.svg, .pdf or .png");
  command->add_option("--cycles", a->cycles, "Length of the step responses (default: about five time constants)")
      ->check(CLI::Range(1, 100000))
      ->type_name("NUMBER");
  command
      ->add_option("--hinge-offset", a->hinge_offset,
                   "From the middle plane to a wing's stroke axis, as \"5 mm\" (default 0 m)")
      ->type_name("QUANTITY");
  command->add_flag("--no-maps", a->no_maps, "Leave the static maps for allocation out");
  add_json(command, a->json);
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  command->footer(
      "Example:\n"
      "  wingbeat linearise friction2022 --frequency \"22 Hz\" -o model.mat --plot steps.svg\n\n"
      "The cycle-to-cycle model x' = A x + B u, y = C x + D u is exact to first order (dual numbers); docs/control.md\n"
      "defines states, inputs, outputs, maps and body axes.\n\n"
      "Exit status: 0 done, 2 bad input or usage, 3 the vehicle does not flap, 1 anything else.");
  act_at_operating_point(command, action, a, run);
}

}  // namespace wingbeat::app
