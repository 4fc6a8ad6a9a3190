#include "options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>
#include <system_error>
#include <utility>

#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::app {
namespace {

/// CLI11 has no room for it in an option, and the program has one tree of commands.
std::map<const CLI::Option*, Values>& noted_values() {
  static std::map<const CLI::Option*, Values> values;
  return values;
}

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

/// Names of the options as they are typed: "--voltage", "-o".
std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // an old spelling
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// The name that begins with what was given, else the nearest one; empty where none is near.
std::string meant(const std::string& given, const std::vector<std::string>& names) {
  std::vector<std::string> longer;
  for (const std::string& name : names) {
    if (given.size() >= 3 && name.starts_with(given)) longer.push_back(name);
  }
  if (longer.size() == 1) return longer.front();
  const std::vector<std::string_view> known(names.begin(), names.end());
  return std::string(nearest_name(given, known));
}

std::string unknown_option(const CLI::App& program, const CLI::App& command, const std::string& given) {
  const std::string name = given.substr(0, given.find('='));
  const std::string said = fmt::format("unknown option {} of wingbeat {}", one_line(name), command.get_name());
  for (const CLI::App* other : commands_of(program)) {
    const auto names = options_of(*other);
    if (other != &command && std::find(names.begin(), names.end(), name) != names.end()) {
      const std::string near = meant(name, options_of(command));
      return fmt::format("{}; {}wingbeat {} has it", said, near.empty() ? "" : "did you mean " + near + "? ",
                         other->get_name());
    }
  }
  const std::string near = meant(name, options_of(command));
  return near.empty() ? said : fmt::format("{}; did you mean {}?", said, near);
}

}  // namespace

void takes(CLI::Option* option, Values values) { noted_values()[option] = std::move(values); }

Values key_choices(const char* end) {
  Values values;
  for (const auto& key : parameter_table<double>()) {
    values.choices.push_back({std::string(key.path) + end, std::string(key.meaning)});
  }
  return values;
}

Values metric_choices() {
  Values values;
  for (const MetricInfo& metric : metric_table()) values.choices.push_back({metric.key, metric.long_name});
  return values;
}

const Values& taken_by(const CLI::Option* option) {
  static const Values any;
  const auto found = noted_values().find(option);
  return found == noted_values().end() ? any : found->second;
}

CLI::Option* add_input(CLI::App* command, std::string& file, InputKind kind, const char* name, const char* description,
                       const char* type) {
  CLI::Option* option = command->add_option(
      name, file, fmt::format("{}; - for standard input, or the name of one that comes with the program", description));
  option->required()->type_name(type);
  Values values;
  values.extensions = {".toml"};
  values.shipped = kind;
  takes(option, std::move(values));
  return option;
}

CLI::Option* add_file(CLI::App* command, const char* names, std::string& file, std::string_view extensions,
                      const char* description, const char* type) {
  CLI::Option* option = command->add_option(names, file, description)->type_name(type);
  Values values;
  std::istringstream words{std::string(extensions)};
  for (std::string extension; words >> extension;) values.extensions.push_back(extension);
  takes(option, std::move(values));
  return option;
}

CLI::Option* add_folder(CLI::App* command, const char* names, std::string& folder, const char* description,
                        const char* type) {
  CLI::Option* option = command->add_option(names, folder, description)->type_name(type);
  Values values;
  values.folder = true;
  takes(option, std::move(values));
  return option;
}

void add_set(CLI::App* command, std::vector<std::string>& overrides) {
  CLI::Option* option = command->add_option("--set", overrides, "Replace a key of the vehicle file; repeatable");
  option->type_name("KEY=VALUE")->allow_extra_args(false);
  takes(option, key_choices("="));
}

void add_force(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "Replace existing files that wingbeat did not write; never a file that is read");
}

void add_json(CLI::App* command, bool& json) {
  command->add_flag("--json", json, "Print one JSON object (SI) instead of text");
}

void add_threads(CLI::App* command, int& threads) {
  command->add_option("--threads", threads, "Use at most N threads (default: one for each core)")
      ->type_name("N")
      ->check(CLI::Validator(
          [](std::string& text) -> std::string {
            int n = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
            const bool whole = error == std::errc{} && end == text.data() + text.size();
            if (whole && n >= 1) return {};
            return fmt::format("must be a whole number >= 1, got {}", in_quotes(text));
          },
          "", "threads"));
}

std::string unknown_command(const CLI::App& program, const std::string& given) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(program)) names.push_back(command->get_name());
  const std::string near = meant(given, names);
  const std::string said = fmt::format("there is no command {}", in_quotes(given));
  if (!near.empty()) return fmt::format("{}; did you mean wingbeat {}?", said, near);
  if (given.ends_with(".toml")) return fmt::format("{}; did you mean wingbeat run {}?", said, one_line(given));
  return fmt::format("{}; the commands are {} (see wingbeat --help)", said, fmt::join(names, ", "));
}

std::string usage_complaint(const CLI::App& program, const CLI::ParseError& error) {
  std::string help = "wingbeat";
  for (const CLI::App* command : program.get_subcommands()) {
    help += " " + command->get_name();
    // An option that is not known leaves its value to be taken for something else: it is named before what follows.
    std::vector<std::string> remaining = command->remaining();
    for (const std::string& word : program.remaining()) remaining.push_back(word);
    const auto option = std::find_if(remaining.begin(), remaining.end(), [](const std::string& word) {
      return word.size() > 1 && word[0] == '-' && !(word[1] >= '0' && word[1] <= '9');
    });
    if (option != remaining.end()) {
      return fmt::format("{} (see {} --help)", unknown_option(program, *command, *option), help);
    }
    if (dynamic_cast<const CLI::ExtrasError*>(&error) && !remaining.empty()) {
      std::vector<std::string> words;
      for (const std::string& word : remaining) words.push_back(in_quotes(word));
      return fmt::format("one argument too many: {} (see {} --help)", fmt::join(words, ", "), help);
    }
  }
  return fmt::format("{} (see {} --help)", error.what(), help);
}

}  // namespace wingbeat::app
