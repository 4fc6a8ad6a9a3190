// What manual pages and completions say of commands, read from the tree that parses the command line.
#pragma once

#include <string>
#include <vector>

#include "../options.hpp"

namespace wingbeat::app {

struct OptionFacts {
  std::vector<std::string> names;  ///< "-o", "--output"; of an argument "study" alone
  std::string type;                ///< "FILE.nc"; empty for a flag
  std::string description;
  bool required = false;
  bool repeatable = false;
  char delimiter = '\0';              ///< between several values in one
  std::vector<std::string> excludes;  ///< options that it cannot stand beside
  std::vector<std::string> needs;
  Values values;
  std::vector<std::string> shipped;  ///< names that come with the program, of Values::shipped
};

/// The text below the options, by what its paragraphs are.
struct FooterFacts {
  std::string example;                                        ///< lines as typed
  std::vector<std::string> paragraphs;                        ///< indented lines are lines as typed
  std::vector<std::pair<std::string, std::string>> statuses;  ///< "3", "the vehicle does not flap"
};

struct CommandFacts {
  std::string name;  ///< empty: the program itself
  std::string description;
  std::vector<OptionFacts> arguments, options;
  FooterFacts footer;
};

/// The program, then its commands in the order of --help. Old spellings, which --help does not show, are left out.
std::vector<CommandFacts> command_facts(const CLI::App& program);

/// One page of the manual in the man macros, "wingbeat(1)" or "wingbeat-run(1)"; `date` is year-month-day.
std::string man_page(const CommandFacts& command, const std::vector<CommandFacts>& all, const std::string& date);

/// Scripts that complete commands, options and what options take.
std::string bash_completion(const std::vector<CommandFacts>& all);
std::string zsh_completion(const std::vector<CommandFacts>& all);
std::string fish_completion(const std::vector<CommandFacts>& all);

/// Long lists of choices stand once in a script; several options share them.
class SharedChoices {
 public:
  explicit SharedChoices(const std::vector<CommandFacts>& all);
  /// From 0; -1 for choices that are few, or none.
  int index(const Values& values) const;
  const std::vector<std::vector<Values::Choice>>& lists() const { return lists_; }

 private:
  std::vector<std::vector<Values::Choice>> lists_;
};

/// A quoted word of a shell.
std::string shell_quoted(const std::string& text);
std::string joined(const std::vector<std::string>& words, const char* between);
/// The names with a minus sign in front: "--output" of long ones, "-o" of short ones.
bool is_long(const std::string& name);

}  // namespace wingbeat::app
