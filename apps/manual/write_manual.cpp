// wingbeat_manual FOLDER: writes the manual pages (FOLDER/man) and the completions of bash, zsh and fish
// (FOLDER/completions) from the tree of commands. SOURCE_DATE_EPOCH dates the pages.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <stdexcept>

#include "../command.hpp"
#include "command_facts.hpp"
#include "wingbeat/files/stored_file.hpp"

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::filesystem::path beside = file;
  beside += ".part";
  try {
    wingbeat::store(beside, text);
    std::filesystem::rename(beside, file);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw;
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace wingbeat::app;
  try {
    if (argc != 2) throw std::runtime_error("give the folder to be written");
    const std::filesystem::path folder = argv[1];
    const char* const epoch = std::getenv("SOURCE_DATE_EPOCH");
    const std::time_t time = epoch ? std::atoll(epoch) : std::time(nullptr);
    const std::string date = fmt::format("{:%Y-%m-%d}", fmt::gmtime(time));
    Action action;
    const auto program = command_tree(action);
    const std::vector<CommandFacts> all = command_facts(*program);
    for (const CommandFacts& command : all) {
      const std::string name = command.name.empty() ? "wingbeat" : "wingbeat-" + command.name;
      write(folder / "man" / (name + ".1"), man_page(command, all, date));
    }
    write(folder / "completions/wingbeat.bash", bash_completion(all));
    write(folder / "completions/_wingbeat", zsh_completion(all));
    write(folder / "completions/wingbeat.fish", fish_completion(all));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wingbeat_manual: %s\n", error.what());
    return 1;
  }
}
