// wingbeat identify-motor DATASHEET: a motor's constants from what its maker publishes.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "command.hpp"
#include "options.hpp"
#include "wingbeat/files/datasheet_file.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/identification_report.hpp"

namespace wingbeat::app {
namespace {

constexpr const char* steel_cylinder = "inertia=solid-steel-cylinder";
constexpr const char* typical_damping = "viscous_damping=typical";

struct IdentifyMotorArguments {
  std::string file, output, frequency;
  std::vector<std::string> fallbacks;
  bool json = false, force = false, motor_shaft = false;
};

int run(const IdentifyMotorArguments& arguments) {
  std::optional<double> frequency;
  if (!arguments.frequency.empty()) {
    try {
      frequency = parse_quantity(arguments.frequency, "Hz");
    } catch (const UnitError& error) {
      throw InputError("--frequency", 0, 0, "", error.what());
    }
    if (!(*frequency > 0.0)) throw InputError("--frequency", 0, 0, "", "must be > 0 Hz");
  }
  MotorDatasheet sheet = read_datasheet(arguments.file);
  for (const std::string& fallback : arguments.fallbacks) {
    if (fallback == steel_cylinder) {
      sheet.assume_steel_cylinder = true;
    } else if (fallback == typical_damping) {
      sheet.assume_typical_damping = true;
    } else {
      throw InputError("--fallback " + one_line(fallback), 0, 0, "",
                       fmt::format("must be {} or {}", steel_cylinder, typical_damping));
    }
  }
  if (arguments.motor_shaft && arguments.output.empty()) {
    throw InputError("--motor-shaft", 0, 0, "", "says how -o writes the motor; give -o FILE.toml");
  }
  std::optional<OutputFile> output;
  if (!arguments.output.empty()) output.emplace("-o", arguments.output, OutputRules{".toml", arguments.force});
  const MotorIdentification motor = identify_motor(sheet, frequency);
  print(arguments.json ? json_identification(motor, sheet) : text_identification(motor, sheet));
  if (!has_motor_section(motor, sheet)) {
    complain(fmt::format("{}: {}{}", arguments.file,
                         is_of_heat_alone(sheet) ? "the curve does not determine both thermal resistances"
                                                 : "the data sheet does not determine the motor",
                         output ? ": no file was written" : ""));
    return bad_input;
  }
  if (output) {
    output->write(motor_section(motor, sheet,
                                fmt::format("Identified by wingbeat {} identify-motor from {}", version,
                                            one_line(std::filesystem::path(arguments.file).filename().string(), 200)),
                                arguments.motor_shaft ? Shaft::motor : Shaft::output));
    output->commit();
  }
  return done;
}

}  // namespace

void add_identify_motor(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("identify-motor", "Find a motor's constants, thermal ones included");
  const auto a = std::make_shared<IdentifyMotorArguments>();
  add_input(command, a->file, InputKind::datasheet, "datasheet", "Data sheet (TOML)", "DATASHEET");
  add_file(command, "-o,--output", a->output, ".toml", "Write the [motor] section of a vehicle file", "FILE.toml");
  command->add_flag("--motor-shaft", a->motor_shaft,
                    "Write gear_ratio and the constants at the motor shaft, so that the ratio stays free");
  command->add_option("--frequency", a->frequency, "Flapping frequency in mind, for the inductance's effect")
      ->type_name("QUANTITY");
  Values fallbacks;
  for (const char* fallback : {steel_cylinder, typical_damping}) fallbacks.choices.push_back({fallback});
  takes(command
            ->add_option(
                "--fallback", a->fallbacks,
                fmt::format("Assume what the sheet lacks: {} or {}; repeatable", steel_cylinder, typical_damping))
            ->type_name("NAME=VALUE")
            ->allow_extra_args(false),
        std::move(fallbacks));
  add_force(*command, a->force);
  add_json(command, a->json);
  command->footer(
      "Example:\n  wingbeat identify-motor 0816K003SR -o motor.toml\n\n"
      "Exit status: 0 identified, 2 bad input, or the sheet does not determine the motor.");
  command->callback([a, &action] {
    action = [a] {
      a->file = find_input(a->file, InputKind::datasheet).string();
      return run(*a);
    };
  });
}

}  // namespace wingbeat::app
