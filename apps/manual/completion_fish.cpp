#include <fmt/format.h>

#include "command_facts.hpp"

namespace wingbeat::app {
namespace {

constexpr const char* fish_head = R"(# Completion of wingbeat for fish, written by apps/manual from the command tree.

# Whether the command on the line is this one; without a name: whether there is none yet.
function __wingbeat_is --argument-names wanted
    set -l words (commandline -opc)
    set -e words[1]
    set -l found
    for word in $words
        if not string match -q -- '-*' $word
            set found $word
            break
        end
    end
    test "$found" = "$wanted"
end

# Files with one of these extensions, and folders.
function __wingbeat_files
    set -l typed (commandline -ct | string replace -r -- '^-[^=]*=' '')
    complete -C "__fish_command_without_completions $typed" |
        string match -r -- '.*(?:/|\.(?:'(string join '|' $argv)'))$'
end
)";

std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + "'";
}

/// The expressions that give what may stand there.
std::vector<std::string> fish_candidates(const OptionFacts& option, const SharedChoices& shared) {
  const Values& values = option.values;
  const int list = shared.index(values);
  const std::string call = fmt::format("__wingbeat_list{}", list);
  if (list >= 0 && option.delimiter != '\0') {
    return {fmt::format("(__fish_append {} ({} | string replace -r '\\t.*' ''))", option.delimiter, call)};
  }
  if (list >= 0) return {"(" + call + ")"};
  if (values.folder) return {"(__fish_complete_directories)"};
  std::vector<std::string> candidates;
  if (!option.shipped.empty()) candidates.push_back(joined(option.shipped, " "));
  std::vector<std::string> words;
  for (const std::string& extension : values.extensions) words.push_back(extension.substr(1));
  if (!words.empty()) candidates.push_back("(__wingbeat_files " + joined(words, " ") + ")");
  words.clear();
  for (const Values::Choice& choice : values.choices) words.push_back(choice.text);
  if (!words.empty()) candidates.push_back(joined(words, " "));
  return candidates;
}

}  // namespace

std::string fish_completion(const std::vector<CommandFacts>& all) {
  const SharedChoices shared(all);
  std::string script = fish_head;
  for (std::size_t n = 0; n < shared.lists().size(); ++n) {
    script += fmt::format("\nfunction __wingbeat_list{}\n    printf '%s\\t%s\\n'", n);
    for (const Values::Choice& choice : shared.lists()[n]) {
      script += " \\\n        " + fish_quoted(choice.text) + " " + fish_quoted(choice.meaning);
    }
    script += "\nend\n";
  }
  script += "\ncomplete -c wingbeat -f\n";
  for (const CommandFacts& command : all) {
    if (command.name.empty()) continue;
    script += fmt::format("complete -c wingbeat -n __wingbeat_is -a {} -d {}\n", command.name,
                          fish_quoted(command.description));
  }
  for (const CommandFacts& command : all) {
    const std::string start =
        fmt::format("complete -c wingbeat -n {}",
                    command.name.empty() ? std::string("__wingbeat_is") : fish_quoted("__wingbeat_is " + command.name));
    script += "\n";
    for (const OptionFacts& argument : command.arguments) {
      for (const std::string& candidates : fish_candidates(argument, shared)) {
        script += fmt::format("{} -a {} -d {}\n", start, fish_quoted(candidates), argument.type);
      }
    }
    for (const OptionFacts& option : command.options) {
      std::string line = start;
      for (const std::string& name : option.names)
        line += is_long(name) ? " -l " + name.substr(2) : " -s " + name.substr(1);
      line += " -d " + fish_quoted(option.description);
      if (!option.type.empty()) line += " -x";
      const auto candidates = fish_candidates(option, shared);
      script += line + (candidates.empty() ? "" : " -a " + fish_quoted(joined(candidates, " "))) + "\n";
    }
  }
  return script;
}

}  // namespace wingbeat::app
