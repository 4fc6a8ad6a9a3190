#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "explored.hpp"

namespace wingbeat::web {

const Design<double>& explored(const std::string& text, const std::vector<std::string>& assignments) {
  struct Read {
    std::string text;
    Design<double> design;
  };
  static std::vector<Read> recent;  // most recent last
  static Design<double> current;
  constexpr std::size_t kept = 4;
  const auto found = std::find_if(recent.begin(), recent.end(), [&](const Read& read) { return read.text == text; });
  if (found != recent.end()) {
    std::rotate(found, found + 1, recent.end());
  } else {
    Design<double> design = parse_design(text, "vehicle");
    if (recent.size() == kept) recent.erase(recent.begin());
    recent.push_back({text, std::move(design)});
  }
  const Design<double>& base = recent.back().design;
  current = assignments.empty() ? base : design_with(assignments, &base);
  return current;
}

}  // namespace wingbeat::web
