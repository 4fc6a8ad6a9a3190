#include "command_facts.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>

namespace wingbeat::app {
namespace {

std::vector<std::string> names_of_option(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> names_of_options(const std::set<CLI::Option*>& options, const CLI::App& command) {
  std::vector<std::string> names;
  // In the order of the command, not of addresses.
  for (const CLI::Option* option : command.get_options()) {
    if (options.count(const_cast<CLI::Option*>(option)) != 0 && !option->get_group().empty()) {
      for (const std::string& name : names_of_option(*option)) names.push_back(name);
    }
  }
  return names;
}

OptionFacts facts_of(const CLI::Option& option, const CLI::App& command) {
  OptionFacts facts;
  facts.names = names_of_option(option);
  facts.description = option.get_description();
  facts.required = option.get_required();
  facts.excludes = names_of_options(option.get_excludes(), command);
  facts.needs = names_of_options(option.get_needs(), command);
  if (option.get_items_expected_max() == 0) return facts;
  facts.type = option.get_type_name();
  facts.repeatable = option.get_items_expected_max() > 1;
  facts.delimiter = option.get_delimiter();
  facts.values = taken_by(&option);
  if (facts.values.shipped) facts.shipped = shipped_names(*facts.values.shipped);
  return facts;
}

/// "Exit status: 0 done, 2 bad input or usage." -> {"0", "done"}, {"2", "bad input or usage"}
std::vector<std::pair<std::string, std::string>> statuses_of(const std::string& text) {
  std::vector<std::pair<std::string, std::string>> statuses;
  std::size_t position = 0;
  while (position < text.size()) {
    std::size_t end = position + 2;
    const auto next_begins = [&] {
      return text[end] == ',' && end + 3 < text.size() && std::isdigit(static_cast<unsigned char>(text[end + 2])) &&
             text[end + 3] == ' ';
    };
    while (end < text.size() && !next_begins()) ++end;
    std::string meaning = text.substr(position + 2, end - position - 2);
    if (end >= text.size() && meaning.ends_with('.')) meaning.pop_back();
    statuses.emplace_back(text.substr(position, 1), meaning);
    position = end + 2;
  }
  std::sort(statuses.begin(), statuses.end());
  return statuses;
}

FooterFacts facts_of_footer(const std::string& footer) {
  FooterFacts facts;
  std::istringstream lines(footer);
  std::vector<std::string> paragraphs(1);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) {
      paragraphs.emplace_back();
    } else {
      paragraphs.back() += line + "\n";
    }
  }
  constexpr std::string_view example = "Example:\n", exit_status = "Exit status: ";
  for (std::string& paragraph : paragraphs) {
    if (paragraph.starts_with(example)) {
      facts.example = paragraph.substr(example.size());
    } else if (paragraph.starts_with(exit_status)) {
      paragraph.pop_back();
      std::replace(paragraph.begin(), paragraph.end(), '\n', ' ');
      facts.statuses = statuses_of(paragraph.substr(exit_status.size()));
    } else if (!paragraph.empty()) {
      facts.paragraphs.push_back(paragraph);
    }
  }
  return facts;
}

CommandFacts facts_of(const CLI::App& command, const std::string& name) {
  CommandFacts facts{name, command.get_description(), {}, {}, facts_of_footer(command.get_footer())};
  if (facts.description.ends_with('.')) facts.description.pop_back();
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    (option->get_positional() ? facts.arguments : facts.options).push_back(facts_of(*option, command));
  }
  return facts;
}

}  // namespace

std::vector<CommandFacts> command_facts(const CLI::App& program) {
  std::vector<CommandFacts> all = {facts_of(program, "")};
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    all.push_back(facts_of(*command, command->get_name()));
  }
  return all;
}

SharedChoices::SharedChoices(const std::vector<CommandFacts>& all) {
  constexpr std::size_t few = 8;
  for (const CommandFacts& command : all) {
    for (const auto* options : {&command.arguments, &command.options}) {
      for (const OptionFacts& option : *options) {
        if (option.values.choices.size() > few && index(option.values) < 0) lists_.push_back(option.values.choices);
      }
    }
  }
}

int SharedChoices::index(const Values& values) const {
  const auto found = std::find(lists_.begin(), lists_.end(), values.choices);
  return found == lists_.end() ? -1 : int(found - lists_.begin());
}

std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

bool is_long(const std::string& name) { return name.starts_with("--"); }

}  // namespace wingbeat::app
