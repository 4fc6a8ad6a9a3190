// What the commands of the program share.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace wingbeat::app {

/// Exit status; see docs of the program.
enum ExitStatus { done = 0, failed = 1, bad_input = 2, does_not_flap = 3 };

extern const char* const version;

/// Writes to standard output at once; throws std::runtime_error if it does not take everything.
void print(std::string_view text);
/// One line on standard error, after "wingbeat: ".
void complain(std::string_view sentence);

/// Each adds one command; its action, which gives the exit status, is stored in `action` when the command is parsed.
using Action = std::function<int()>;
void add_run(CLI::App& program, Action& action);
void add_compare(CLI::App& program, Action& action);
void add_sweep(CLI::App& program, Action& action);
void add_identify_motor(CLI::App& program, Action& action);
void add_read_bench(CLI::App& program, Action& action);
void add_fit(CLI::App& program, Action& action);
void add_tolerance(CLI::App& program, Action& action);
void add_optimise(CLI::App& program, Action& action);
void add_endurance(CLI::App& program, Action& action);
void add_export_fmu(CLI::App& program, Action& action);
void add_linearise(CLI::App& program, Action& action);
void add_export_kinematics(CLI::App& program, Action& action);
void add_compare_loads(CLI::App& program, Action& action);
void add_reproduce(CLI::App& program, Action& action);
void add_new(CLI::App& program, Action& action);
void add_scale(CLI::App& program, Action& action);
void add_synthesise(CLI::App& program, Action& action);
void add_validate(CLI::App& program, Action& action);
void add_trim(CLI::App& program, Action& action);
void add_stability(CLI::App& program, Action& action);
void add_fly(CLI::App& program, Action& action);
void add_keys(CLI::App& program, Action& action);
void add_metrics(CLI::App& program, Action& action);
void add_schema(CLI::App& program, Action& action);

/// The whole tree of commands. Parsing a command line by it stores what is to be done in `action`, which must outlive
/// it.
std::unique_ptr<CLI::App> command_tree(Action& action);

}  // namespace wingbeat::app
