// Options that several commands have, each spelled and described once.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wingbeat/core/names.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::app {

/// What may be given to an option or an argument, for completion: nothing of it is checked here.
struct Values {
  struct Choice {
    std::string text;  ///< "=" at its end: what follows is free
    std::string meaning = {};
    auto operator<=>(const Choice&) const = default;
  };
  std::vector<Choice> choices;          ///< one of these
  std::vector<std::string> extensions;  ///< a file with one of these: ".toml"
  std::optional<InputKind> shipped;     ///< the name of a file that comes with the program
  bool folder = false;
};

void takes(CLI::Option* option, Values values);
/// The keys of vehicle files, each followed by `end`; the metrics.
Values key_choices(const char* end);
Values metric_choices();
/// What was noted; nothing of it where the option takes any text, or no value.
const Values& taken_by(const CLI::Option* option);

/// The file that a command reads: a path, "-" for standard input, or the name of one that comes with the program. The
/// command finds it by find_input(file, kind) when it runs.
CLI::Option* add_input(CLI::App* command, std::string& file, InputKind kind, const char* name, const char* description,
                       const char* type);
/// A file to be written, by OutputFile; `extensions` as in OutputRules.
CLI::Option* add_file(CLI::App* command, const char* names, std::string& file, std::string_view extensions,
                      const char* description, const char* type = "FILE");
CLI::Option* add_folder(CLI::App* command, const char* names, std::string& folder, const char* description,
                        const char* type);
/// One of the names of an enumeration.
template <NamedEnum E>
CLI::Option* add_choice(CLI::App* command, const char* names, std::string& choice, const std::string& description,
                        const char* type) {
  CLI::Option* option = command->add_option(names, choice, description)->type_name(type);
  Values values;
  for (const auto& [name, value] : names_of<E>) values.choices.push_back({name});
  takes(option, std::move(values));
  return option;
}
/// What was chosen of them. Throws InputError.
template <NamedEnum E>
E choice_of(const char* option, const std::string& text) {
  if (const auto value = from_name<E>(text)) return *value;
  throw InputError(option, 0, 0, "", "must be " + std::string(listed_names<E>()) + ", got " + in_quotes(text));
}
void add_set(CLI::App* command, std::vector<std::string>& overrides);
void add_json(CLI::App* command, bool& json);
void add_threads(CLI::App* command, int& threads);
/// Of every command that writes files.
void add_force(CLI::App& command, bool& force);

/// What is wrong with a command line, with the option or command that was probably meant.
std::string usage_complaint(const CLI::App& program, const CLI::ParseError& error);
/// "there is no command ...", with the one that was probably meant.
std::string unknown_command(const CLI::App& program, const std::string& given);

}  // namespace wingbeat::app
