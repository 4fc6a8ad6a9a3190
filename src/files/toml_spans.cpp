#include "files/toml_spans.hpp"

#include <algorithm>

namespace wingbeat {
namespace {

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  TomlSpans scan() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    std::string section;
    while (skip_blank(true), at_ < text_.size()) {
      const std::size_t before = at_;
      if (text_[at_] == '[') {
        while (at_ < text_.size() && text_[at_] == '[') ++at_;
        section.clear();
        std::size_t from = 0, to = 0;
        dotted_key(section, from, to);
        at_ = line_end(at_);
        spans_.headers.push_back({section, at_});
      } else {
        key_value(section, false, 0);
      }
      if (at_ == before) ++at_;
    }
    return std::move(spans_);
  }

 private:
  std::size_t line_end(std::size_t from) const {
    std::size_t end = std::min(text_.find('\n', from), text_.size());
    if (end > from && text_[end - 1] == '\r') --end;
    return end;
  }

  /// Past white space, and past the ends of lines and comments where `lines`.
  void skip_blank(bool lines) {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == ' ' || c == '\t' || (lines && (c == '\n' || c == '\r'))) continue;
      if (!lines || c != '#') return;
      at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
    }
  }

  void skip_string() {
    const char quote = text_[at_];
    const std::string triple(3, quote);
    const bool multiline = text_.substr(at_).starts_with(triple);
    for (at_ += multiline ? 3 : 1; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\\' && quote == '"') {
        ++at_;
      } else if (multiline && text_.substr(at_).starts_with(triple)) {
        at_ += 3;
        while (at_ < text_.size() && text_[at_] == quote) ++at_;
        return;
      } else if (!multiline && text_[at_] == quote) {
        ++at_;
        return;
      }
    }
    at_ = text_.size();
  }

  /// Appends the parts of a key; `from` and `to`: the last of them.
  void dotted_key(std::string& path, std::size_t& from, std::size_t& to) {
    while (true) {
      skip_blank(false);
      from = at_;
      std::string part;
      if (at_ < text_.size() && (text_[at_] == '"' || text_[at_] == '\'')) {
        skip_string();
        part = text_.substr(from + 1, std::max(at_, from + 2) - from - 2);
      } else {
        at_ = std::min(text_.find_first_of(".=] \t\r\n", at_), text_.size());
        part = text_.substr(from, at_ - from);
      }
      to = at_;
      path += (path.empty() ? "" : ".") + part;
      skip_blank(false);
      if (at_ >= text_.size() || text_[at_] != '.') return;
      ++at_;
    }
  }

  void key_value(const std::string& section, bool in_line, int depth) {
    TomlSpan span;
    span.path = section;
    span.in_line = in_line;
    span.begin = at_;
    dotted_key(span.path, span.key, span.key_end);
    skip_blank(false);
    if (at_ >= text_.size() || text_[at_] != '=') return;
    ++at_;
    skip_blank(false);
    span.value = at_;
    const std::size_t place = spans_.values.size();
    spans_.values.push_back(span);
    value(span.path, depth);
    spans_.values[place].value_end = at_;
  }

  void value(const std::string& path, int depth) {
    constexpr int deepest = 64;
    if (at_ >= text_.size()) return;
    const char c = text_[at_];
    if (c == '"' || c == '\'') {
      skip_string();
    } else if (c == '[') {
      int open = 0;
      do {
        const char d = text_[at_];
        if (d == '"' || d == '\'') {
          skip_string();
          continue;
        }
        if (d == '#') {
          at_ = std::min(text_.find('\n', at_), text_.size());
          continue;
        }
        open += d == '[' ? 1 : d == ']' ? -1 : 0;
        ++at_;
      } while (open > 0 && at_ < text_.size());
    } else if (c == '{' && depth < deepest) {
      ++at_;
      while (skip_blank(false), at_ < text_.size() && text_[at_] != '}') {
        const std::size_t before = at_;
        key_value(path, true, depth + 1);
        skip_blank(false);
        if (at_ < text_.size() && text_[at_] == ',') ++at_;
        if (at_ == before) return;
      }
      at_ = std::min(at_ + 1, text_.size());
    } else {
      const std::size_t from = at_;
      at_ = std::min(text_.find_first_of(",]}#\r\n", at_), text_.size());
      while (at_ > from && (text_[at_ - 1] == ' ' || text_[at_ - 1] == '\t')) --at_;
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  TomlSpans spans_;
};

}  // namespace

const TomlSpan* TomlSpans::find(std::string_view path) const {
  const auto found = std::find_if(values.begin(), values.end(), [&](const TomlSpan& s) { return s.path == path; });
  return found == values.end() ? nullptr : &*found;
}

TomlSpans toml_spans(std::string_view text) { return Scanner(text).scan(); }

}  // namespace wingbeat
