// What is asked of a sweep as a whole once its study file is read.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "files/toml_reader.hpp"
#include "wingbeat/files/study_file.hpp"

namespace wingbeat::detail {

/// Where a sweep stands in its study file.
struct SweepPlaces {
  SourceLocation study;                                     ///< [study]
  std::map<std::string, SourceLocation, std::less<>> keys;  ///< of what is varied
  std::vector<SourceLocation> axes;
  std::vector<int> table_lines;           ///< of the designs in a CSV
  const TomlNode* set_voltage = nullptr;  ///< supply.voltage of [set]
};

/// Makes the vehicles of the sweep's choices. Refuses, by `reader`, names given twice, too many designs, a supply that
/// cannot do what is asked, and numbers without a place in the vehicle or out of their range.
void complete_sweep(Sweep& sweep, const TomlReader& reader, const SweepPlaces& places, const StudyInput& input);

}  // namespace wingbeat::detail
