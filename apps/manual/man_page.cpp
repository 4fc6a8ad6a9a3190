#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "command_facts.hpp"

namespace wingbeat::app {

extern const char* const version;

namespace {

/// Text for troff: minus signs and backslashes as they are typed, no line that looks like a request.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if ((result.empty() || result.back() == '\n') && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c == '\'') {
      result += "\\(aq";
    } else if (c == '"') {
      result += "\\(dq";
    } else {
      result += c;
    }
  }
  return result;
}

/// Words in lines of at most 72 characters, for whoever reads the source.
std::string filled(const std::string& text) {
  std::string result;
  std::size_t length = 0;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (length > 0) {
      const bool fits = length + 1 + word.size() <= 72;
      result += fits ? ' ' : '\n';
      length = fits ? length + 1 : 0;
    }
    result += word;
    length += word.size();
  }
  return escaped(result) + "\n";
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fR"; }

std::string page_name(const CommandFacts& command) {
  return command.name.empty() ? "wingbeat" : "wingbeat-" + command.name;
}
std::string page_reference(const CommandFacts& command) { return "\\%" + bold(page_name(command)) + "(1)"; }

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  return text;
}

/// "--output FILE" with the words of the syntax set apart.
std::string with_type(const std::string& name, const std::string& type) {
  return bold(name) + (type.empty() ? "" : " " + italic(type));
}

std::string typed_lines(const std::string& lines) {
  std::string text;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    const std::size_t indent = std::min<std::size_t>(2, line.find_first_not_of(' '));
    text += escaped(line.substr(indent)) + "\n";
  }
  return ".RS 4\n.EX\n" + text + ".EE\n.RE\n";
}

/// A paragraph of --help: lines that are indented are typed, others flow.
std::string paragraph_text(const std::string& paragraph) {
  std::string text, flowing, typed;
  const auto finish = [&] {
    if (!flowing.empty()) text += ".PP\n" + filled(flowing);
    if (!typed.empty()) text += ".PP\n" + typed_lines(typed);
    flowing.clear();
    typed.clear();
  };
  std::istringstream in(paragraph);
  for (std::string line; std::getline(in, line);) {
    std::string& kind = line.starts_with(' ') ? typed : flowing;
    if (kind.empty()) finish();
    kind += line + "\n";
  }
  finish();
  return text;
}

std::string option_text(const OptionFacts& option) {
  std::string names;
  for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + with_type(name, option.type);
  std::string text = option.description;
  if (!text.empty() && !text.ends_with('.')) text += '.';
  std::string conditions;
  if (option.required) conditions += " Required.";
  if (!option.needs.empty()) conditions += " Only with " + joined(option.needs, ", ") + ".";
  if (!option.excludes.empty()) conditions += " Not with " + joined(option.excludes, ", ") + ".";
  return ".TP\n" + names + "\n" + filled(text + conditions);
}

std::string synopsis(const CommandFacts& command) {
  if (command.name.empty()) return bold("wingbeat") + " " + italic("COMMAND") + " ...\n";
  std::string text = bold("wingbeat " + command.name);
  for (const OptionFacts& argument : command.arguments) {
    text += " " + (argument.required ? italic(argument.type) : "[" + italic(argument.type) + "]");
  }
  for (const OptionFacts& option : command.options) {
    if (option.required) text += " " + with_type(option.names.front(), option.type);
  }
  return text + " [" + italic("OPTION") + " ...]\n";
}

}  // namespace

std::string man_page(const CommandFacts& command, const std::vector<CommandFacts>& all, const std::string& date) {
  std::string page =
      fmt::format(".\\\" Written by apps/manual from the command tree.\n.TH {} 1 {} \"wingbeat {}\" \"wingbeat\"\n",
                  escaped(upper(page_name(command))), date, version);
  page += ".SH NAME\n" + escaped(page_name(command)) + " \\- " + escaped(command.description) + "\n";
  page += ".SH SYNOPSIS\n" + synopsis(command);
  page += ".SH DESCRIPTION\n";
  if (command.name.empty()) {
    page += filled(
        "wingbeat computes how a motor-driven flapping-wing micro air vehicle flaps and what that costs: from a "
        "vehicle file it gives flapping frequency, lift, forces, where the electrical power goes, waveforms, and, for "
        "a design that does not flap, the reason.");
    page += ".SH COMMANDS\n";
    for (const CommandFacts& other : all) {
      if (!other.name.empty()) page += ".TP\n" + page_reference(other) + "\n" + filled(other.description + ".");
    }
  } else {
    page += filled(command.description + ".");
    for (const std::string& paragraph : command.footer.paragraphs) page += paragraph_text(paragraph);
    page += ".SH ARGUMENTS\n";
    for (OptionFacts argument : command.arguments) {
      argument.names = {argument.type};
      argument.type.clear();
      page += option_text(argument);
    }
  }
  page += ".SH OPTIONS\n";
  for (const OptionFacts& option : command.options) page += option_text(option);
  if (command.name.empty()) {
    page += ".SH FILES\n.TP\n" + italic("share/wingbeat") + "\n" +
            filled(
                "Beside the folder of the program: vehicles (designs), studies, bench files, data sheets (motors) and "
                "published values. Commands find them by name, as in the example.");
  }
  page += ".SH EXIT STATUS\n";
  if (command.footer.statuses.empty()) page += "As that of " + page_reference(all.front()) + ".\n";
  for (const auto& [status, meaning] : command.footer.statuses) {
    page += ".TP\n" + bold(status) + "\n" + filled(meaning);
  }
  page += ".SH EXAMPLES\n" + typed_lines(command.footer.example);
  page += ".SH SEE ALSO\n.ad l\n";
  std::vector<std::string> others;
  for (const CommandFacts& other : all) {
    if (other.name != command.name) others.push_back(page_reference(other));
  }
  page += joined(others, ",\n") + "\n.PP\n";
  page += filled("The manual: docs/ in the sources, the package wingbeat-doc on Debian.");
  return page;
}

}  // namespace wingbeat::app
