#include "files/choice_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {
namespace {

constexpr std::size_t max_combinations = 1000, max_alternatives = 100, longest_name = 40;

bool within(std::string_view path, std::string_view above) {
  return path.starts_with(above) && (path.size() == above.size() || path[above.size()] == '.');
}
bool overlap(std::string_view one, std::string_view other) { return within(one, other) || within(other, one); }

}  // namespace

std::string ChoiceSections::name_in(const TomlNode& node, const std::string& where, bool of_variable) const {
  const std::string expected = fmt::format("a name of letters, digits{}, at most {} of them",
                                           of_variable ? " and '_'" : ", '-', '_' and '.'", longest_name);
  const std::string name = text_of(node, where, expected);
  const bool fits = name.size() <= longest_name && std::all_of(name.begin(), name.end(), [&](unsigned char c) {
                      return std::isalnum(c) || c == '_' || (!of_variable && (c == '-' || c == '.'));
                    });
  if (!fits) wrong(node, where, expected);
  return name;
}

bool ChoiceSections::read_choices(std::vector<ModelChoice>& choices) {
  bool all = true;
  all &= attempt([&] {
    for (const TomlNode& node : sections_of("choice")) all &= attempt([&] { read_choice(node, choices); });
    if (choices.empty()) return;
    if (combination_count(choices) > max_combinations) {
      refuse(*root_.find("choice"), "choice", fmt::format("more than {} combinations of choices", max_combinations));
    }
  });
  return all;
}

void ChoiceSections::read_choice(const TomlNode& node, std::vector<ModelChoice>& choices) {
  known_keys(node, "choice", {"name", "alternative"});
  ModelChoice choice;
  const TomlNode& name = need(node, "choice", "name", "a name such as \"coefficients\"");
  choice.name = name_in(name, "choice.name", true);
  for (const ModelChoice& other : choices) {
    if (other.name == choice.name) {
      refuse(name, "choice.name", fmt::format("{} is the name of another choice", in_quotes(choice.name)));
    }
  }
  const TomlNode& list =
      need(node, "choice", "alternative", "[[choice.alternative]] sections, each with name, weight and set");
  std::vector<AlternativeSection> alternatives;
  for (const TomlNode& item : sections(list, "choice.alternative")) {
    AlternativeSection section{place_of(item), {{}, "choice.alternative.set"}};
    choice.alternatives.push_back(read_alternative(item, choice, section));
    alternatives.push_back(std::move(section));
  }
  if (alternatives.size() < 2) {
    refuse(node, "choice.alternative",
           fmt::format("the choice {} has {}; expected two alternatives or more", choice.name,
                       alternatives.empty() ? "none" : "one"));
  }
  if (alternatives.size() > max_alternatives) {
    refuse(node, "choice.alternative", fmt::format("more than {} alternatives", max_alternatives));
  }
  for (const AlternativeSection& section : alternatives) {
    for (const auto& [key, value] : section.keys.values) {
      const std::string shown = section.keys.shown + "." + key;
      if (const ModelChoice* other = choice_of(choices, key)) {
        refuse(*value, shown, fmt::format("the choice {} sets it already", other->name));
      }
      if (held_voltage_ && (key == "supply.voltage" || key == "supply.amplitude")) {
        refuse(*value, shown, "study.hold holds the voltage already");
      }
      no_override_of(key, fmt::format("has no effect: the choice {} sets it", choice.name));
      if (std::find(choice.keys.begin(), choice.keys.end(), key) == choice.keys.end()) choice.keys.push_back(key);
    }
  }
  if (choice.keys.empty()) {
    refuse(node, "choice.alternative",
           fmt::format("no alternative of {} sets anything; expected set = {{ ... }} with vehicle-file keys",
                       choice.name));
  }
  choices.push_back(std::move(choice));
  sections_.push_back(std::move(alternatives));
}

ModelAlternative ChoiceSections::read_alternative(const TomlNode& node, const ModelChoice& choice,
                                                  AlternativeSection& section) {
  const std::string where = "choice.alternative";
  known_keys(node, where, {"name", "weight", "set"});
  ModelAlternative alternative;
  const TomlNode& name = need(node, where, "name", "a name such as \"translational-2022\"");
  alternative.name = name_in(name, where + ".name", false);
  for (const ModelAlternative& other : choice.alternatives) {
    if (other.name == alternative.name) {
      refuse(name, where + ".name", fmt::format("{} is the name of another alternative", in_quotes(other.name)));
    }
  }
  if (const TomlNode* weight = node.find("weight")) {
    alternative.weight = quantity(*weight, where + ".weight", "1");
    if (!(alternative.weight > 0.0)) refuse(*weight, where + ".weight", "must be > 0");
  }
  if (const TomlNode* set = node.find("set")) {
    if (set->kind != Kind::table) wrong(*set, where + ".set", "a table of vehicle-file keys");
    read_keys(*set, "", section.keys);
  }
  return alternative;
}

const ModelChoice* ChoiceSections::choice_of(const std::vector<ModelChoice>& choices, std::string_view key) const {
  const auto found = std::find_if(choices.begin(), choices.end(), [key](const ModelChoice& choice) {
    return std::any_of(choice.keys.begin(), choice.keys.end(), [key](const auto& own) { return overlap(own, key); });
  });
  return found == choices.end() ? nullptr : &*found;
}

std::vector<const KeySettings*> ChoiceSections::keys_of(const ToleranceStudy& study, std::size_t combination) const {
  std::vector<const KeySettings*> keys;
  for (std::size_t k = 0; k < study.choices.size(); ++k) {
    keys.push_back(&sections_[k][alternative_in(study.choices, combination, k)].keys);
  }
  return keys;
}

SourceLocation ChoiceSections::place_of_combination(const ToleranceStudy& study, std::size_t combination) const {
  const std::size_t last = study.choices.size() - 1;
  return sections_[last][alternative_in(study.choices, combination, last)].place;
}

std::string ChoiceSections::in_words(const ToleranceStudy& study, std::size_t combination) const {
  std::string text;
  for (std::size_t k = 0; k < study.choices.size(); ++k) {
    const ModelChoice& choice = study.choices[k];
    text += fmt::format("{}{} = {}", text.empty() ? "" : " and ", choice.name,
                        choice.alternatives[alternative_in(study.choices, combination, k)].name);
  }
  return text;
}

bool ChoiceSections::read_combinations(ToleranceStudy& study, const std::filesystem::path& folder) {
  if (!attempt([&] { study.design = read_vehicle(folder); })) return false;
  if (study.choices.empty()) return true;
  bool all = true;
  std::size_t likeliest = 0;
  for (const ModelChoice& choice : study.choices) {
    likeliest = likeliest * choice.alternatives.size() + choice.likeliest();
  }
  for (std::size_t v = 0; v < combination_count(study.choices); ++v) {
    study.combinations.push_back(study.design);
    all &= try_combination(study, v, folder);
  }
  study.design = study.combinations[likeliest];
  return all;
}

bool ChoiceSections::try_combination(ToleranceStudy& study, std::size_t combination,
                                     const std::filesystem::path& folder) {
  for (const auto& [k, a] : refused_) {
    if (alternative_in(study.choices, combination, k) == a) return false;
  }
  const std::vector<const KeySettings*> keys = keys_of(study, combination);
  try {
    study.combinations[combination] = read_vehicle(folder, keys);
    return true;
  } catch (const InputError& error) {
    if (blame_alternative(study, combination, folder)) return false;
    const std::size_t last = study.choices.size() - 1;
    const AlternativeSection& section = sections_[last][alternative_in(study.choices, combination, last)];
    refuse_alternative(section, in_words(study, combination), error);
  }
  return false;
}

/// Finds the alternatives that are impossible whatever the other choices.
bool ChoiceSections::blame_alternative(const ToleranceStudy& study, std::size_t combination,
                                       const std::filesystem::path& folder) {
  const std::size_t before = refused_.size();
  for (std::size_t k = 0; k < study.choices.size(); ++k) {
    const std::size_t a = alternative_in(study.choices, combination, k);
    const KeySettings* const alone[] = {&sections_[k][a].keys};
    try {
      read_vehicle(folder, alone);
    } catch (const InputError& error) {
      refused_.emplace_back(k, a);
      const ModelChoice& choice = study.choices[k];
      refuse_alternative(sections_[k][a], fmt::format("{} = {}", choice.name, choice.alternatives[a].name), error);
    }
  }
  return refused_.size() > before;
}

/// What stands in the alternative is refused where it stands, all else where the alternative begins.
void ChoiceSections::refuse_alternative(const AlternativeSection& section, const std::string& with,
                                        const InputError& error) const {
  const auto add = [&](const InputError& e) {
    const bool own = e.file() == file() &&
                     std::any_of(section.keys.values.begin(), section.keys.values.end(), [&](const auto& given) {
                       return given.second->line == e.line() && given.second->column == e.column();
                     });
    attempt([&] {
      const std::string reason = reason_of(e);
      const std::string named = fmt::format("with {}: {}", with, reason.substr(e.key().size() + 2));
      if (own) throw InputError(e.file(), e.line(), e.column(), e.key(), named);
      refuse(section.place, "choice.alternative", fmt::format("with {}: {}", with, reason));
    });
  };
  add(error);
  for (const InputError& other : error.others()) add(other);
}

void ChoiceSections::check_combinations(const ToleranceStudy& study) const {
  for (std::size_t v = 0; v < study.combinations.size(); ++v) {
    const Design<double>& design = study.combinations[v];
    const SourceLocation place = place_of_combination(study, v);
    const std::string with = "with " + in_words(study, v);
    try {
      read_hold(design);
    } catch (const InputError& error) {
      refuse(place, "choice.alternative", fmt::format("{}: {}", with, reason_of(error)));
    }
    for (const KeySettings* keys : keys_of(study, v)) {
      for (const auto& [key, value] : keys->values) {
        const std::string shown = keys->shown + "." + key;
        if (held_target_ && is_void_at(*held_key_, key, design)) {
          refuse(*value, shown, fmt::format("has no effect where the {} is held", held_key_->name));
        }
      }
    }
  }
}

}  // namespace wingbeat::detail
