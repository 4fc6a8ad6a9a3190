// [[choice]] of a tolerance study: models that are drawn, each with keys of the vehicle that it sets.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/study_sections.hpp"
#include "wingbeat/study/tolerance.hpp"

namespace wingbeat::detail {

class ChoiceSections : public StudySections {
 public:
  using StudySections::StudySections;

 protected:
  /// The choices without their vehicles; false if there is an error.
  bool read_choices(std::vector<ModelChoice>& choices);
  /// The vehicle with each combination of alternatives, its file being sought in that folder, and with the most likely
  /// ones; without choices the vehicle alone. False if there is an error.
  bool read_combinations(ToleranceStudy& study, const std::filesystem::path& folder);
  /// Every combination can hold what the study holds.
  void check_combinations(const ToleranceStudy& study) const;

  /// The choice that sets the key, one within it or one that holds it; null: none does.
  const ModelChoice* choice_of(const std::vector<ModelChoice>& choices, std::string_view key) const;
  /// Where the last alternative of a combination stands, and what it is: "coefficients = robobee".
  SourceLocation place_of_combination(const ToleranceStudy& study, std::size_t combination) const;
  std::string in_words(const ToleranceStudy& study, std::size_t combination) const;

 private:
  struct AlternativeSection {
    SourceLocation place;
    KeySettings keys;
  };

  void read_choice(const TomlNode& node, std::vector<ModelChoice>& choices);
  ModelAlternative read_alternative(const TomlNode& node, const ModelChoice& choice, AlternativeSection& section);
  /// `of_variable`: it becomes part of the names of variables.
  std::string name_in(const TomlNode& node, const std::string& where, bool of_variable) const;
  std::vector<const KeySettings*> keys_of(const ToleranceStudy& study, std::size_t combination) const;
  bool try_combination(ToleranceStudy& study, std::size_t combination, const std::filesystem::path& folder);
  bool blame_alternative(const ToleranceStudy& study, std::size_t combination, const std::filesystem::path& folder);
  void refuse_alternative(const AlternativeSection& section, const std::string& with, const InputError& error) const;

  std::vector<std::vector<AlternativeSection>> sections_;     ///< by choice
  std::vector<std::pair<std::size_t, std::size_t>> refused_;  ///< choices and alternatives that are refused alone
};

}  // namespace wingbeat::detail
