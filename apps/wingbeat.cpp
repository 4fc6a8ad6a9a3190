// The program: parses the command line, runs a command, turns what goes wrong into a sentence and an exit status.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
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

namespace {

/// A file opened later must not land on the number of a stream that the caller has closed.
bool fill_standard_streams() {
  const bool output_open = ::fcntl(STDOUT_FILENO, F_GETFD) != -1;
  for (int file = ::open("/dev/null", O_RDWR); file >= 0 && file <= STDERR_FILENO;) file = ::open("/dev/null", O_RDWR);
  return output_open;
}

int run(int argc, char** argv) {
  Action action;
  const std::unique_ptr<CLI::App> tree = command_tree(action);
  CLI::App& program = *tree;
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
    constexpr std::size_t max_errors = 30;
    for (std::size_t n = 0; n < std::min(max_errors, error.others().size()); ++n) complain(error.others()[n].what());
    if (error.others().size() > max_errors)
      complain(fmt::format("and {} errors more", error.others().size() - max_errors));
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
