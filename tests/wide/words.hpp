// Words of a command line, for the programs that compare solvers on many vehicles.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace wingbeat {

/// One word after the other; a wrong one ends the program with a sentence and exit status 2.
class Words {
 public:
  Words(std::string program, int argc, char** argv) : program_(std::move(program)), argc_(argc), argv_(argv) {}

  /// Goes on to the next word; false where there is none.
  bool next() {
    if (at_ + 1 >= argc_) return false;
    word_ = argv_[++at_];
    return true;
  }
  const std::string& word() const { return word_; }
  bool is(const char* option) const { return word_ == option; }
  bool is_option() const { return word_.starts_with('-'); }

  /// The value that follows an option.
  std::string value() {
    const std::string option = word_;
    if (!next()) refuse(option + " needs a value");
    return word_;
  }
  std::size_t number() { return number_in(value()); }
  std::size_t number_in(const std::string& text) const {
    char* end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end || value < 0) refuse("\"" + text + "\" is not a number");
    return std::size_t(value);
  }

  [[noreturn]] void refuse(const std::string& why) const {
    std::fprintf(stderr, "%s: %s\n", program_.c_str(), why.c_str());
    std::exit(2);
  }

 private:
  std::string program_, word_;
  int argc_;
  char** argv_;
  int at_ = 0;
};

}  // namespace wingbeat
