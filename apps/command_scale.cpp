// wingbeat scale VEHICLE: a vehicle file for a larger or smaller vehicle, by stated laws.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "command.hpp"
#include "operating_point.hpp"
#include "options.hpp"
#include "wingbeat/files/design_edit.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/report/scaling_report.hpp"
#include "wingbeat/study/scaling.hpp"

namespace wingbeat::app {
namespace {

struct ScaleArguments {
  std::string vehicle, wing, whole, output;
  std::vector<std::string> overrides;
  bool json = false, force = false;
};

int run(const ScaleArguments& a) {
  const bool of_wing = !a.wing.empty();
  const char* option = of_wing ? "--wing" : "--vehicle";
  if (!of_wing && a.whole.empty()) throw InputError("scale", 0, 0, "", "give --wing FACTOR or --vehicle FACTOR");
  const double factor = quantity_of(option, of_wing ? a.wing : a.whole, "1");
  if (!(factor >= 1e-3 && factor <= 1e3)) {
    throw InputError(option, 0, 0, "", fmt::format("must lie between 0.001 and 1000, got {:g}", factor));
  }
  const Design<double> design = read_design(a.vehicle, a.overrides);
  const ScaledDesign found = scaled(design, factor, of_wing ? ScaledPart::wing : ScaledPart::vehicle);
  std::optional<OutputFile> output;
  if (!a.output.empty()) {
    output.emplace("-o", a.output, OutputRules{".toml", a.force});
    const std::string head =
        fmt::format("# {} with {} {:g} times as large, by wingbeat {} scale. What scales how: wingbeat scale --help.\n",
                    one_line(std::filesystem::path(a.vehicle).filename().string(), 120),
                    of_wing ? "wings" : "everything", factor, version);
    output->write(head + edited_design(a.vehicle, a.output, found.design));
    output->commit();
  }
  print(a.json ? json_scaling(found, factor) : text_scaling(found, factor));
  return done;
}

}  // namespace

void add_scale(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("scale", "Make a larger or smaller vehicle by stated laws");
  const auto a = std::make_shared<ScaleArguments>();
  add_input(command, a->vehicle, InputKind::vehicle, "vehicle", "Vehicle file (TOML)", "VEHICLE");
  add_set(command, a->overrides);
  CLI::Option* wing = command->add_option("--wing", a->wing, "Factor of the size of the wings; the drive is kept");
  wing->type_name("FACTOR");
  command->add_option("--vehicle", a->whole, "Factor of the size of everything")->type_name("FACTOR")->excludes(wing);
  add_file(command, "-o,--output", a->output, ".toml", "Write the vehicle file", "FILE.toml");
  add_force(*command, a->force);
  add_json(command, a->json);
  command->footer(
      "Example:\n  wingbeat scale friction2022 --wing 1.1 -o larger.toml\n\n"
      "Lengths grow with the factor; densities, stresses, voltages and speeds do not. Times grow with it, currents\n"
      "with its 2nd power, masses, torques and stiffnesses of hinges with the 3rd, moments of inertia with the 5th.\n"
      "The air keeps its viscosity, so that the Reynolds number changes, and the armature resistance of a motor wound\n"
      "for the same voltage grows with the -3rd power: small motors lose more. --wing changes outline, masses and\n"
      "moments of the wings alone. Comments and units of the file are kept.\n\n"
      "Exit status: 0 done, 2 bad input or usage.");
  command->callback([a, &action] {
    action = [a] {
      a->vehicle = find_input(a->vehicle, InputKind::vehicle).string();
      return run(*a);
    };
  });
}

}  // namespace wingbeat::app
