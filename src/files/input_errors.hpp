// Everything that is wrong with an input, gathered while it is read on.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "wingbeat/files/design_file.hpp"

namespace wingbeat {

class InputErrors {
 public:
  /// Does it, keeping an InputError for later; false if there was one.
  template <class Do>
  bool attempt(const Do& act) {
    try {
      act();
      return true;
    } catch (const InputError& error) {
      add(error);
      return false;
    }
  }

  /// An error with others keeps their order: its reader has put them so.
  void add(const InputError& error) {
    errors_.push_back({error, error.line(), error.column()});
    for (const InputError& other : error.others()) errors_.push_back({other, error.line(), error.column()});
  }

  bool none() const { return errors_.empty(); }

  /// Throws if there is something: the first in the order of the inputs, with the others, each once. Those of `last`,
  /// what is missing, follow what is wrong where it stands.
  void refuse(const InputErrors& last = {}) const {
    std::vector<InputError> sorted = in_order();
    for (const InputError& error : last.in_order()) sorted.push_back(error);
    if (sorted.empty()) return;
    InputError first = sorted.front();
    first.forget_others();
    std::set<std::string> reported = {first.what()};
    for (const InputError& error : sorted) {
      if (reported.insert(error.what()).second) first.add_other(error);
    }
    throw first;
  }

 private:
  struct Kept {
    InputError error;
    int line, column;  ///< by which it is sorted
  };

  std::vector<InputError> in_order() const {
    std::map<std::string, std::size_t> files;  // in the order in which they were read
    for (const Kept& kept : errors_) files.emplace(kept.error.file(), files.size());
    std::vector<Kept> sorted = errors_;
    std::stable_sort(sorted.begin(), sorted.end(), [&](const Kept& a, const Kept& b) {
      return std::tuple(files.at(a.error.file()), a.line, a.column) <
             std::tuple(files.at(b.error.file()), b.line, b.column);
    });
    std::vector<InputError> errors;
    for (const Kept& kept : sorted) errors.push_back(kept.error);
    return errors;
  }

  std::vector<Kept> errors_;
};

}  // namespace wingbeat
