// wingbeat trim VEHICLE, wingbeat stability VEHICLE: steady flight, and small motions about it.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "operating_point.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "wingbeat/files/control_file.hpp"
#include "wingbeat/files/flight_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/report/flight_report.hpp"

namespace wingbeat::app {
namespace {

struct FlightArguments {
  std::string vehicle, plot, output, plot_width, speed, speed_to, climb, turn_rate;
  std::vector<std::string> overrides;
  int points = 9;
  bool json = false, force = false, sensitivity = false;
};

double asked(const char* option, const std::string& text, const char* unit) {
  return text.empty() ? 0.0 : quantity_of(option, text, unit);
}

/// The vehicle with its body. Throws InputError with the vehicle's file.
FlightVehicle read_flight_vehicle(const FlightArguments& a, Design<double>& design) {
  const VehicleFile file = read_vehicle(a.vehicle, a.overrides);
  design = file.design;
  try {
    return flight_vehicle(file);
  } catch (const ParameterError& e) {
    throw InputError(a.vehicle, 0, 0, e.key(), e.reason());
  }
}

FlightCondition condition_of(const FlightArguments& a) {
  return {asked("--speed", a.speed, "m/s"), asked("--climb", a.climb, "m/s"),
          asked("--turn-rate", a.turn_rate, "rad/s")};
}

std::string title_of(const FlightArguments& a, const FlightVehicle& vehicle) {
  return vehicle.name.empty() ? written_name(a.vehicle) : vehicle.name;
}

int run_trim(const FlightArguments& a) {
  const auto format = asked_format("--plot", a.plot, a.plot_width);
  const FlightCondition first = condition_of(a);
  std::vector<FlightCondition> conditions = {first};
  if (!a.speed_to.empty()) {
    const double last = quantity_of("--to", a.speed_to, "m/s");
    if (!(last > first.speed)) {
      throw InputError("--to", 0, 0, "",
                       fmt::format("must be faster than --speed, {:g} m/s, got {:g} m/s", first.speed, last));
    }
    if (a.points < 2 || a.points > 200) {
      throw InputError("--points", 0, 0, "", fmt::format("must be a number of speeds from 2 to 200, got {}", a.points));
    }
    for (int n = 1; n < a.points; ++n) {
      conditions.push_back({first.speed + (last - first.speed) * n / (a.points - 1), first.climb, first.turn_rate});
    }
  } else if (format) {
    throw InputError("--plot", 0, 0, "", "draws over the speed: give --to as well, such as --to \"3 m/s\"");
  }
  Design<double> design;
  const FlightVehicle vehicle = read_flight_vehicle(a, design);
  std::optional<OutputFile> plot;
  if (format) plot.emplace("--plot", a.plot, OutputRules{plot_extensions, a.force});
  TrimReport report{title_of(a, vehicle), trim_all(vehicle, conditions), absent};
  if (has_battery(design.supply.type)) report.battery_energy = usable_energy(design.supply.battery);
  if (plot) {
    plot_trim(vehicle, report, *format, plot->temporary());
    plot->commit();
  }
  print(a.json ? json_trim(report) : text_trim(vehicle, report));
  bool flies = false;
  for (const TrimResult& t : report.flights) flies |= t.status == TrimStatus::trimmed;
  return flies ? done : does_not_flap;
}

constexpr const char* linear_model_extensions = ".mat";

int run_stability(const FlightArguments& a) {
  const auto format = asked_format("--plot", a.plot, a.plot_width);
  const FlightCondition condition = condition_of(a);
  Design<double> design;
  const FlightVehicle vehicle = read_flight_vehicle(a, design);
  std::optional<OutputFile> plot, output;
  if (!a.output.empty()) output.emplace("-o", a.output, OutputRules{linear_model_extensions, a.force});
  if (format) plot.emplace("--plot", a.plot, OutputRules{plot_extensions, a.force});
  AveragedFlight flight(vehicle);
  const TrimResult steady = trim(flight, condition);
  StabilityReport report{title_of(a, vehicle), {}, {}};
  const bool flies = steady.flies();
  if (flies) report.result = flight_stability(flight, steady);
  else report.result.trim = steady;
  if (flies && a.sensitivity) report.sensitivities = mode_sensitivities(design, condition);
  if (plot && report.result.model) {
    plot_stability(report, *format, plot->temporary());
    plot->commit();
  }
  if (output && report.result.model) {
    write_flight_mat(report.result, version, output->temporary());
    output->commit();
  }
  print(a.json ? json_stability(report) : text_stability(report));
  if ((plot || output) && !report.result.model) complain("the vehicle is not in trim: no file was written");
  return flies ? done : does_not_flap;
}

void add_condition(CLI::App* command, FlightArguments& a) {
  command->add_option("--speed", a.speed, "Forward, against the air; hover unless given")->type_name("SPEED");
  command->add_option("--climb", a.climb, "Upwards, such as \"0.5 m/s\"")->type_name("SPEED");
  command->add_option("--turn-rate", a.turn_rate, "To the right, such as \"30 deg/s\"")->type_name("RATE");
}

void act(CLI::App* command, Action& action, const std::shared_ptr<FlightArguments>& a,
         int (*run)(const FlightArguments&)) {
  command->callback([a, run, &action] {
    action = [a, run] {
      a->vehicle = find_input(a->vehicle, InputKind::vehicle).string();
      return run(*a);
    };
  });
}

}  // namespace

void add_trim(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("trim", "Find the controls of steady flight");
  const auto a = std::make_shared<FlightArguments>();
  add_input(command, a->vehicle, InputKind::vehicle, "vehicle", "Vehicle file (TOML) with a body", "VEHICLE");
  add_set(command, a->overrides);
  add_condition(command, *a);
  command->add_option("--to", a->speed_to, "Speeds from --speed to this one")->type_name("SPEED");
  command->add_option("--points", a->points, "How many speeds, with --to")->type_name("NUMBER");
  add_file(command, "--plot", a->plot, plot_extensions, "With --to: plot power and controls over the speed");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  add_json(command, a->json);
  command->footer(
      "Example:\n  wingbeat trim flight-x-wing --to \"2 m/s\" --plot trim.svg\n\n"
      "Finds voltage, attitude and controls at which the mean accelerations over a wingbeat vanish, the drives\n"
      "settled to their cycles under the motion of the body. A vehicle without a control for an axis is in trim only\n"
      "if the moment about it vanishes; otherwise the report states what remains. Needs [body] in the vehicle file.\n\n"
      "Exit status: 0 done, 2 bad input or usage, 3 not in trim at any speed, 1 anything else.");
  act(command, action, a, run_trim);
}

void add_stability(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("stability", "Find the modes of steady flight");
  const auto a = std::make_shared<FlightArguments>();
  add_input(command, a->vehicle, InputKind::vehicle, "vehicle", "Vehicle file (TOML) with a body", "VEHICLE");
  add_set(command, a->overrides);
  add_condition(command, *a);
  command->add_flag("--sensitivity", a->sensitivity, "By how much each parameter changes the least stable mode");
  add_file(command, "-o,--output", a->output, linear_model_extensions, "Write the averaged linear model to FILE.mat");
  add_file(command, "--plot", a->plot, plot_extensions, "Plot the modes in the complex plane");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  add_json(command, a->json);
  command->footer(
      "Example:\n  wingbeat stability flight-x-wing --plot modes.svg\n\n"
      "Linear model, derivatives and modes of the flight averaged over the wingbeat, beside the Floquet exponents of\n"
      "the whole flight that repeats with the wingbeat: where they differ, averaging does not hold. The inputs of the\n"
      "linear model are the controls and the wind.\n\n"
      "Exit status: 0 done, 2 bad input or usage, 3 not in trim, 1 anything else.");
  act(command, action, a, run_stability);
}

}  // namespace wingbeat::app
