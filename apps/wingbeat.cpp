// The program: parses the command line, runs a command, turns what goes wrong into a sentence and an exit status.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "command.hpp"
#include "options.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/file_record.hpp"
#include "wingbeat/files/temporary_files.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/files/written_files.hpp"

namespace wingbeat::app {

const char* const version = WINGBEAT_VERSION;

void print(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw std::runtime_error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  }
}

void complain(std::string_view sentence) {
  std::string line = "wingbeat: ";
  for (const char c : sentence) line += c == '\n' ? ' ' : c;
  line += '\n';
  std::fputs(line.c_str(), stderr);
}

void add_force(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "Replace existing files that wingbeat did not write; never a file that is read");
}

namespace {

/// A file opened later must not land on the number of a stream that the caller has closed.
bool fill_standard_streams() {
  const bool output_open = ::fcntl(STDOUT_FILENO, F_GETFD) != -1;
  for (int file = ::open("/dev/null", O_RDWR); file >= 0 && file <= STDERR_FILENO;) file = ::open("/dev/null", O_RDWR);
  return output_open;
}

int run(int argc, char** argv) {
  CLI::App program("Electromechanical model of flapping-wing micro air vehicles.", "wingbeat");
  program.set_version_flag(
      "--version", fmt::format("wingbeat {} ({}, {} build)", WINGBEAT_VERSION, WINGBEAT_COMPILER, WINGBEAT_BUILD_TYPE));
  program.require_subcommand(1);
  program.footer(
      "Example:\n  wingbeat run friction2022\n\n"
      "Exit status: 0 done, 1 something failed, 2 bad input or usage, 3 the vehicle does not flap.");
  program.get_formatter()->column_width(34);
  Action action;
  add_run(program, action);
  add_compare(program, action);
  add_sweep(program, action);
  add_identify_motor(program, action);
  add_fit(program, action);
  add_tolerance(program, action);
  add_optimise(program, action);
  add_endurance(program, action);
  add_reproduce(program, action);
  add_new(program, action);
  add_keys(program, action);
  add_metrics(program, action);
  const auto named = [&](const CLI::App* command) { return command->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && program.get_subcommands([&](CLI::App* c) { return named(c); }).empty()) {
    complain(unknown_command(program, argv[1]));
    return bad_input;
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& wanted) {
    // Help and version go through print(), so that a closed or full output is noticed.
    std::string text = program.help();
    for (const CLI::App* command : program.get_subcommands()) text = command->help("wingbeat");
    if (dynamic_cast<const CLI::CallForVersion*>(&wanted)) text = std::string(wanted.what()) + "\n";
    print(text);
    return done;
  } catch (const CLI::ParseError& error) {
    complain(usage_complaint(program, error));
    return bad_input;
  }
  // Said last and in any case, on standard error: standard output is the result's.
  struct TellWritten {
    ~TellWritten() {
      for (const std::string& name : take_written()) fmt::print(stderr, "wrote {}\n", one_line(name, 1000));
    }
  } const tell;
  return action();
}

}  // namespace
}  // namespace wingbeat::app

int main(int argc, char** argv) {
  using namespace wingbeat::app;
  const bool output_open = fill_standard_streams();
  // A reader that went away is an error of writing like any other.
  std::signal(SIGPIPE, SIG_IGN);
  // So is a file above the limit of the shell.
  std::signal(SIGXFSZ, SIG_IGN);
  wingbeat::remove_temporaries_on_signals();
  try {
    if (!output_open) throw std::runtime_error("standard output is closed");
    return run(argc, argv);
  } catch (const wingbeat::InputError& error) {
    complain(error.what());
    constexpr std::size_t most = 30;
    for (std::size_t n = 0; n < std::min(most, error.others().size()); ++n) complain(error.others()[n].what());
    if (error.others().size() > most) complain(fmt::format("and {} errors more", error.others().size() - most));
    return bad_input;
  } catch (const wingbeat::ParameterError& error) {
    complain(error.what());
    return bad_input;
  } catch (const std::bad_alloc&) {
    complain("out of memory");
  } catch (const std::exception& error) {
    complain(wingbeat::FileRecord::of_this_program().with_given_names(error.what()));
  }
  return failed;
}
