// The vehicle of a command at an operating point: its file, overrides, and what its voltage follows from.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

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

/// A number with a unit that an option gives. Throws InputError.
double quantity_of(const char* option, const std::string& text, const char* unit);

/// What the options ask for, into `options`; checked before the vehicle is read. Throws InputError.
VehicleFile read_operating_point(const OperatingPointArguments& arguments, RunOptions& options);

/// Throws InputError where the vehicle flaps, but not at the frequency, lift or power that was asked for.
void require_reached(const OperatingPointArguments& arguments, const RunResult& result);

}  // namespace wingbeat::app
