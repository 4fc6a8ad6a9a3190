// Options that several commands have, each spelled and described once.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "wingbeat/files/input_file.hpp"

namespace wingbeat::app {

/// The file that a command reads: a path, "-" for standard input, or the name of one that comes with the program. The
/// command finds it by find_input(file, kind) when it runs.
void add_input(CLI::App* command, std::string& file, const char* name, const char* description, const char* type);
void add_set(CLI::App* command, std::vector<std::string>& overrides);
void add_json(CLI::App* command, bool& json);
void add_threads(CLI::App* command, int& threads);

/// What is wrong with a command line, with the option or command that was probably meant.
std::string usage_complaint(const CLI::App& program, const CLI::ParseError& error);
/// "there is no command ...", with the one that was probably meant.
std::string unknown_command(const CLI::App& program, const std::string& given);

}  // namespace wingbeat::app
