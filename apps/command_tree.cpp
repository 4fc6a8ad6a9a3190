// The tree of commands, and how commands speak.
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "command.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat::app {

const char* const version = WINGBEAT_VERSION;

void print(std::string_view from_files) {
  const std::string text = detail::printable(from_files);
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw std::runtime_error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  }
}

void complain(std::string_view sentence) {
  std::string line = "wingbeat: ";
  for (const char c : detail::printable(sentence)) line += c == '\n' ? ' ' : c;
  line += '\n';
  std::fputs(line.c_str(), stderr);
}

std::unique_ptr<CLI::App> command_tree(Action& action) {
  auto program = std::make_unique<CLI::App>("Electromechanical model of flapping-wing micro air vehicles.", "wingbeat");
  program->set_version_flag(
      "--version", fmt::format("wingbeat {} ({}, {} build)", WINGBEAT_VERSION, WINGBEAT_COMPILER, WINGBEAT_BUILD_TYPE));
  program->require_subcommand(1);
  program->footer(
      "Example:\n  wingbeat run friction2022\n\n"
      "Exit status: 0 done, 1 something failed, 2 bad input or usage, 3 the vehicle does not flap.");
  program->get_formatter()->column_width(34);
  add_run(*program, action);
  add_compare(*program, action);
  add_sweep(*program, action);
  add_identify_motor(*program, action);
  add_read_bench(*program, action);
  add_fit(*program, action);
  add_tolerance(*program, action);
  add_optimise(*program, action);
  add_endurance(*program, action);
  add_linearise(*program, action);
  add_export_fmu(*program, action);
  add_export_kinematics(*program, action);
  add_compare_loads(*program, action);
  add_reproduce(*program, action);
  add_new(*program, action);
  add_scale(*program, action);
  add_synthesise(*program, action);
  add_validate(*program, action);
  add_trim(*program, action);
  add_stability(*program, action);
  add_fly(*program, action);
  add_keys(*program, action);
  add_metrics(*program, action);
  add_schema(*program, action);
  return program;
}

}  // namespace wingbeat::app
