#include "files/toml_prevalidation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace wingbeat {
namespace {

constexpr int max_nesting = 16;
// toml++ looks through all sections, and all dotted keys, again for each; InputErrors has a sentence for each.
constexpr int max_sections = 10000, max_keys = 20000;

class Prevalidation {
 public:
  explicit Prevalidation(std::string_view text) : text_(text) {}

  std::optional<TomlComplaint> complaint() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = line_begin_ = 3;
    for (; at_ < text_.size() && !complaint_; ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        next_line();
        dots_ = 0;
        if (brackets_ == 0) in_value_ = false;
      } else if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
      } else if (c == '"' || c == '\'') {
        check_string_begin();
        skip_string(c);
      } else if (c == '.') {
        limit(++dots_);
      } else if (c == '[' || c == '{') {
        dots_ = 0;
        if (c == '[' && brackets_ == 0 && !in_value_) {
          check_header();
          if (++sections_ > max_sections)
            complain(fmt::format("more than {} sections, which no file has", max_sections));
        }
        limit(++brackets_);
      } else if (c == ']' || c == '}') {
        dots_ = 0;
        brackets_ = std::max(brackets_ - 1, 0);
      } else if (c == '=' || c == ',') {
        dots_ = 0;
        in_value_ = true;
        if (c == '=' && ++keys_ > max_keys) complain(fmt::format("more than {} keys, which no file has", max_keys));
      } else if (!is_ascii(c)) {
        complain("not TOML: a letter outside ASCII belongs in quotes");
      }
    }
    return complaint_;
  }

 private:
  static bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }

  void next_line() {
    ++line_;
    line_begin_ = at_ + 1;
  }

  void complain(std::string message) {
    if (complaint_) return;
    const std::string_view before = text_.substr(line_begin_, at_ - line_begin_);
    const auto characters = std::count_if(before.begin(), before.end(),
                                          [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
    complaint_ = {line_, int(characters) + 1, std::move(message)};
  }

  void limit(int nesting) {
    if (nesting > max_nesting) {
      complain(fmt::format("nested more than {} levels deep, which no vehicle file is", max_nesting));
    }
  }

  void check_header() {
    std::size_t name = at_ + 1;
    if (name < text_.size() && text_[name] == '[') ++name;
    name = std::min(text_.find_first_not_of(" \t", name), text_.size());
    const char first = name < text_.size() ? text_[name] : '\n';
    if (!is_bare_key_character(first) && first != '"' && first != '\'') {
      complain("not TOML: a table header needs a name, as in [motor]");
    }
  }

  /// toml++ reads on through a quote inside a number or word.
  void check_string_begin() {
    const char before = at_ > line_begin_ ? text_[at_ - 1] : '\n';
    const std::string_view allowed = in_value_ ? " \t\n=,[{" : " \t\n=,[{.";
    if (allowed.find(before) == std::string_view::npos) complain("not TOML: a quote inside a word");
  }

  /// Moves to the last character of a string, or of the line where a string of one line does not end.
  void skip_string(char quote) {
    const std::string_view triple = quote == '"' ? "\"\"\"" : "'''";
    const bool multiline = text_.substr(at_).starts_with(triple);
    for (at_ += multiline ? 3 : 1; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        if (!multiline) break;
        next_line();
      } else if (c == '\\' && quote == '"') {
        if (multiline) check_line_end();
        if (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
      } else if (multiline ? text_.substr(at_).starts_with(triple) : c == quote) {
        if (!multiline) return;
        at_ += 2;
        while (at_ + 1 < text_.size() && text_[at_ + 1] == quote) ++at_;  // quotes may end the text itself
        return;
      }
    }
    --at_;
  }

  /// The backslash at the end of a line makes toml++ skip white space.
  void check_line_end() {
    const std::size_t next = text_.find_first_not_of(" \t\r\n", at_ + 1);
    if (next != std::string_view::npos && !is_ascii(text_[next])) {
      complain("a backslash before a letter outside ASCII is not supported");
    }
  }

  std::string_view text_;
  std::size_t at_ = 0, line_begin_ = 0;
  int line_ = 1, dots_ = 0, brackets_ = 0, sections_ = 0, keys_ = 0;
  bool in_value_ = false;  ///< after the = of a key
  std::optional<TomlComplaint> complaint_;
};

}  // namespace

std::optional<TomlComplaint> prevalidation_complaint(std::string_view text) { return Prevalidation(text).complaint(); }

}  // namespace wingbeat
