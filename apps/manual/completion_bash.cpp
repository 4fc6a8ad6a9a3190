#include <fmt/format.h>

#include "command_facts.hpp"

namespace wingbeat::app {
namespace {

constexpr const char* bash_head = R"(# Completion of wingbeat for bash, written by apps/manual from the command tree.

# Files that begin with $1 and have one of the extensions $2, and folders.
_wingbeat_files() {
  local name
  compopt -o filenames 2>/dev/null
  while IFS= read -r name; do
    if [[ -d ${name/#\~/$HOME} || $name == *.@($2) ]]; then COMPREPLY+=("$name"); fi
  done < <(compgen -f -- "$1")
}

# What the option $2 of command $1 takes, or its argument number $2: sets choices, extensions, folder and separator.
# False for flags and where there is no such argument.
_wingbeat_takes() {
  choices='' extensions='' folder='' separator=''
)";

constexpr const char* bash_tail = R"(
_wingbeat() {
  local -a words=()
  local n word value command='' awaited='' lead='' cut='' arguments=0 choices='' extensions='' folder='' separator=''
  COMPREPLY=()
  # Readline takes "=" for a word of its own: --plot=FILE, --set KEY=VALUE.
  for ((n = 1; n <= COMP_CWORD; ++n)); do
    word=${COMP_WORDS[n]}
    if ((${#words[@]} > 0)) && [[ $word == = || ${COMP_WORDS[n - 1]} == = ]]; then
      words[${#words[@]} - 1]+=$word
    else
      words+=("$word")
    fi
  done
  value=${words[${#words[@]} - 1]}
  unset "words[${#words[@]} - 1]"
  for word in "${words[@]}"; do
    if [[ -n $awaited ]]; then
      awaited=''
    elif [[ -z $command ]]; then
      if [[ $word != -* ]]; then command=$word; fi
    elif [[ $word == -?* ]]; then
      if _wingbeat_takes "$command" "$word"; then awaited=$word; fi
    else
      arguments=$((arguments + 1))
    fi
  done

  value=${value#[\"\']}
  value=${value//\\/}
  if [[ -n $awaited ]]; then
    _wingbeat_takes "$command" "$awaited"
  elif [[ -n $command && $value == --*=* ]]; then
    _wingbeat_takes "$command" "${value%%=*}" || return 0
    lead=${value%%=*}=
    value=${value#*=}
  elif [[ $value == -* || -z $command ]] || ! _wingbeat_takes "$command" $((arguments + 1)); then
    extensions='' folder='' separator='' choices=$(_wingbeat_words "$command" "$value")
  fi
  if [[ -n $separator && $value == *"$separator"* ]]; then
    lead+=${value%"$separator"*}$separator
    value=${value##*"$separator"}
  fi

  if [[ -n $choices ]]; then
    while IFS= read -r word; do COMPREPLY+=("$word"); done < <(compgen -W "$choices" -- "$value")
  fi
  if [[ -n $extensions ]]; then _wingbeat_files "$value" "$extensions"; fi
  if [[ -n $folder ]]; then _wingbeat_files "$value" /; fi
  if ((${#COMPREPLY[@]} == 1)) && [[ ${COMPREPLY[0]} == *= ]]; then compopt -o nospace 2>/dev/null; fi
  if [[ $COMP_WORDBREAKS == *=* && $lead$value == *=* ]]; then
    cut=$lead$value
    cut=${cut%=*}=
  fi
  for n in "${!COMPREPLY[@]}"; do
    word=$lead${COMPREPLY[n]}
    COMPREPLY[n]=${word#"$cut"}
    if [[ -z ${COMPREPLY[n]} ]]; then unset "COMPREPLY[n]"; fi
  done
}

complete -F _wingbeat wingbeat
)";

std::string bash_extensions(const Values& values) {
  std::string text;
  for (const std::string& extension : values.extensions) text += (text.empty() ? "" : "|") + extension.substr(1);
  return text;
}

std::string bash_case(const OptionFacts& option, const SharedChoices& shared) {
  const Values& values = option.values;
  std::string text;
  const int list = shared.index(values);
  std::vector<std::string> words = option.shipped;
  if (list < 0) {
    for (const Values::Choice& choice : values.choices) words.push_back(choice.text);
  }
  if (list >= 0) text += fmt::format("choices=$list{} ", list);
  if (!words.empty()) text += fmt::format("choices={} ", shell_quoted(joined(words, " ")));
  if (!values.extensions.empty()) text += fmt::format("extensions={} ", shell_quoted(bash_extensions(values)));
  if (values.folder) text += "folder=1 ";
  if (option.delimiter != '\0') text += fmt::format("separator='{}' ", option.delimiter);
  return text.empty() ? ": " : text;
}

}  // namespace

std::string bash_completion(const std::vector<CommandFacts>& all) {
  const SharedChoices shared(all);
  std::string script = bash_head;
  for (std::size_t n = 0; n < shared.lists().size(); ++n) {
    std::vector<std::string> words;
    for (const Values::Choice& choice : shared.lists()[n]) words.push_back(choice.text);
    script += fmt::format("  local list{}={}\n", n, shell_quoted(joined(words, " ")));
  }
  script += "  case \"$1 $2\" in\n";
  std::string commands, options;
  for (const CommandFacts& command : all) {
    std::vector<std::string> names;
    for (const OptionFacts& option : command.options) {
      std::vector<std::string> patterns;
      for (const std::string& name : option.names) {
        names.push_back(name);
        patterns.push_back(shell_quoted(command.name + " " + name));
      }
      if (!option.type.empty()) {
        script += fmt::format("    {}) {};;\n", joined(patterns, " | "), bash_case(option, shared));
      }
    }
    for (std::size_t n = 0; n < command.arguments.size(); ++n) {
      script += fmt::format("    '{} {}') {};;\n", command.name, n + 1, bash_case(command.arguments[n], shared));
    }
    if (!command.name.empty()) commands += (commands.empty() ? "" : " ") + command.name;
    options += fmt::format("    '{}') echo {} ;;\n", command.name, shell_quoted(joined(names, " ")));
  }
  script += "    *) return 1 ;;\n  esac\n}\n\n";
  script +=
      "# The options of command $1; without one the commands, or the program's options where $2 begins like one.\n";
  script += "_wingbeat_words() {\n  if [[ -z $1 && $2 != -* ]]; then\n";
  script += fmt::format("    echo {}\n    return\n  fi\n  case $1 in\n{}  esac\n}}\n", shell_quoted(commands), options);
  return script + bash_tail;
}

}  // namespace wingbeat::app
