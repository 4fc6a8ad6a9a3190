// Everything that is wrong with an input, gathered while it is read on.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "wingbeat/io/design_file.hpp"

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

  void add(const InputError& error) {
    errors_.push_back(error);
    for (const InputError& other : error.others()) errors_.push_back(other);
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
    std::set<std::string> told = {first.what()};
    for (const InputError& error : sorted) {
      if (told.insert(error.what()).second) first.add_other(error);
    }
    throw first;
  }

 private:
  std::vector<InputError> in_order() const {
    std::map<std::string, std::size_t> files;  // in the order in which they were read
    for (const InputError& error : errors_) files.emplace(error.file(), files.size());
    std::vector<InputError> sorted = errors_;
    std::stable_sort(sorted.begin(), sorted.end(), [&](const InputError& a, const InputError& b) {
      return std::tuple(files.at(a.file()), a.line(), a.column()) < std::tuple(files.at(b.file()), b.line(), b.column());
    });
    return sorted;
  }

  std::vector<InputError> errors_;
};

}  // namespace wingbeat
