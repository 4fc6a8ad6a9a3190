// The vehicle of a command at an operating point: its file, overrides, and what its voltage follows from.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "command.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/two_sides_file.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat::app {

struct OperatingPointArguments {
  std::string vehicle;
  std::vector<std::string> overrides;
  std::string voltage, frequency, lift, lift_to_weight, power, angle_of_attack;
  std::string condition = "air";
  bool allow_extrapolation = false;
};

/// Adds the vehicle and its options to a command, in the order of their mention in its manual.
void add_operating_point(CLI::App* command, OperatingPointArguments& arguments);

/// Its flag for searches outside the model's domain.
void add_allow_extrapolation(CLI::App* command, OperatingPointArguments& arguments);

/// Makes `run` the command's action, with the vehicle's file found.
template <class Arguments>
void act_at_operating_point(CLI::App* command, Action& action, const std::shared_ptr<Arguments>& a,
                            std::type_identity_t<int (*)(const Arguments&)> run) {
  command->callback([a, run, &action] {
    action = [a, run] {
      a->operating_point.vehicle = find_input(a->operating_point.vehicle, InputKind::vehicle).string();
      return run(*a);
    };
  });
}

/// A number with a unit that an option gives. Throws InputError.
double quantity_of(const char* option, const std::string& text, const char* unit);

/// What the options ask for, into `options`; checked before the vehicle is read. Throws InputError.
VehicleFile read_operating_point(const OperatingPointArguments& arguments, RunOptions& options);

/// Throws InputError where the vehicle flaps, but not at the frequency, lift or power that was asked for.
void require_reached(const OperatingPointArguments& arguments, const RunResult& result);

}  // namespace wingbeat::app
