// Study files: TOML in, a checked sweep out. For the grammar see docs/sweep.md.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/sweep.hpp"

namespace wingbeat {

/// Everything a study is made from, as texts: what goes into its data set, so that it can be run again.
struct StudyInput {
  std::string study_name;       ///< file name, for messages
  std::string study;            ///< the study file
  std::string vehicle = {};     ///< the vehicle with [set] and a held voltage applied, complete in itself
  std::string table_name = {};  ///< of a CSV of designs
  std::string table = {};
  std::optional<Design<double>> design = {};  ///< the vehicle; where it is not given, its text is read
};

struct Study {
  std::string title;
  StudyInput input;
  Sweep sweep;
};

/// The study in a TOML file; the vehicle file and a CSV that it names are sought beside it. `overrides` are applied to
/// the vehicle after [set], as read_design does. Throws InputError.
Study read_study(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// The study in the texts of its files; no file is touched. Throws InputError.
Study parse_study(const StudyInput& input);

}  // namespace wingbeat
