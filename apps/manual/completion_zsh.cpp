#include <fmt/format.h>

#include "command_facts.hpp"

namespace wingbeat::app {
namespace {

constexpr const char* zsh_head = R"zsh(#compdef wingbeat
# Completion of wingbeat for zsh, written by apps/manual from the command tree.

# Files with the extensions of pattern $1, and the names $2... of those that come with the program.
_wingbeat_input() {
  local pattern=$1
  shift
  _alternative "names:name of a file that comes with the program:($*)" "files:file:_files -g '$pattern'"
}
)zsh";

std::string zsh_escaped(const std::string& text, std::string_view special) {
  std::string result;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

std::string zsh_pattern(const Values& values) {
  std::string text;
  for (const std::string& extension : values.extensions) text += (text.empty() ? "" : "|") + extension.substr(1);
  return values.extensions.size() > 1 ? "*.(" + text + ")" : "*." + text;  // (toml) alone would be a qualifier
}

std::string zsh_action(const OptionFacts& option, const SharedChoices& shared) {
  const Values& values = option.values;
  const int list = shared.index(values);
  if (list >= 0) return fmt::format("_wingbeat_list{}{}", list, option.delimiter != '\0' ? "s" : "");
  if (values.folder) return "_files -/";
  if (!option.shipped.empty()) {
    return fmt::format(" _wingbeat_input \"{}\" {}", zsh_pattern(values), joined(option.shipped, " "));
  }
  if (!values.extensions.empty()) return fmt::format("_files -g \"{}\"", zsh_pattern(values));
  std::vector<std::string> words;
  for (const Values::Choice& choice : values.choices) words.push_back(choice.text);
  return words.empty() ? " " : "(" + joined(words, " ") + ")";
}

std::string zsh_option(const OptionFacts& option, const SharedChoices& shared) {
  std::vector<std::string> others = option.excludes;
  if (!option.repeatable && option.names.size() > 1)
    others.insert(others.begin(), option.names.begin(), option.names.end());
  std::string before = others.empty() ? "" : "(" + joined(others, " ") + ")";
  if (option.repeatable) before += "*";
  const bool flag = option.type.empty();
  std::vector<std::string> names;
  for (const std::string& name : option.names) names.push_back(name + (flag ? "" : is_long(name) ? "=" : "+"));
  std::string after = fmt::format("[{}]", zsh_escaped(option.description, "\\[]:"));
  if (!flag) after += fmt::format(":{}:{}", zsh_escaped(option.type, ":"), zsh_action(option, shared));
  if (names.size() == 1) return shell_quoted(before + names.front() + after);
  return (before.empty() ? "" : shell_quoted(before)) + "{" + joined(names, ",") + "}" + shell_quoted(after);
}

std::string zsh_arguments(const CommandFacts& command, const SharedChoices& shared) {
  std::string text;
  for (const OptionFacts& option : command.options) text += " \\\n        " + zsh_option(option, shared);
  int n = 0;
  for (const OptionFacts& argument : command.arguments) {
    const std::string spec = fmt::format("{}:{}{}:{}", ++n, argument.required ? "" : ":",
                                         zsh_escaped(argument.type, ":"), zsh_action(argument, shared));
    text += " \\\n        " + shell_quoted(spec);
  }
  return text;
}

}  // namespace

std::string zsh_completion(const std::vector<CommandFacts>& all) {
  const SharedChoices shared(all);
  std::string script = zsh_head;
  for (std::size_t n = 0; n < shared.lists().size(); ++n) {
    std::string items, values;
    bool open = false;
    for (Values::Choice choice : shared.lists()[n]) {
      values += "    " +
                shell_quoted(zsh_escaped(choice.text, "\\[]:") + "[" + zsh_escaped(choice.meaning, "\\[]:") + "]") +
                " \\\n";
      // What ends in "=" gets it as a suffix, after which no blank follows.
      open = choice.text.ends_with('=');
      if (open) choice.text.pop_back();
      items += "    " + shell_quoted(zsh_escaped(choice.text, "\\:") + ":" + choice.meaning) + "\n";
    }
    script += fmt::format("\n_wingbeat_list{}() {{\n  local -a items=(\n{}  )\n", n, items);
    if (open) script += "  if compset -P '*='; then\n    _message value\n    return\n  fi\n";
    script += fmt::format("  _describe choice items{}\n}}\n", open ? " -S =" : "");
    script += fmt::format("\n_wingbeat_list{}s() {{\n  _values -s , choice \\\n{}    && return\n}}\n", n, values);
  }
  script += "\n_wingbeat() {\n  local curcontext=$curcontext state line\n  typeset -A opt_args\n";
  script += "  _arguments -C" + zsh_arguments(all.front(), shared);
  script += " \\\n        '1:command:->command' '*::argument:->argument' && return\n  case $state in\n    command)\n";
  script += "      local -a commands=(\n";
  for (const CommandFacts& command : all) {
    if (!command.name.empty()) script += "        " + shell_quoted(command.name + ":" + command.description) + "\n";
  }
  script += "      )\n      _describe command commands ;;\n    argument)\n      case $words[1] in\n";
  for (const CommandFacts& command : all) {
    if (command.name.empty()) continue;
    script += fmt::format("        {}) _arguments{} ;;\n", command.name, zsh_arguments(command, shared));
  }
  // Autoloaded, the file is the function's body when it is first called; read in by hand, it names its function.
  script += R"zsh(      esac ;;
  esac
}

if [[ $funcstack[1] == _wingbeat ]]; then
  _wingbeat "$@"
else
  compdef _wingbeat wingbeat
fi
)zsh";
  return script;
}

}  // namespace wingbeat::app
