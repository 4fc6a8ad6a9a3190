// Published values beside those computed at the same operating points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wingbeat/files/published.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {

struct ComparedValue {
  PublishedValue published;
  double computed;   ///< as the published number: of a change it is one, too; absent where a design does not flap
  double deviation;  ///< computed / published - 1
  bool within;       ///< abs(deviation) <= tolerance
  double
      ratio_deviation;  ///< of a change the deviation of the ratio, (1 + computed) / (1 + published) - 1; else absent
};

struct Comparison {
  std::vector<ComparedValue> values;  ///< in the order of the file
  struct Run {
    std::string design;
    std::optional<double> voltage, frequency;  ///< as in the values
    RunResult result;
  };
  std::vector<Run> runs;  ///< each design at each operating point, once
  int outside() const;    ///< values not within their tolerance
  /// The run of a design at the operating point of a value.
  const Run& run_of(const PublishedValue& value, const std::string& design) const;
};

Comparison compare(const PublishedFile& file, double tolerance = 1e-9);

std::string text_comparison(const PublishedFile& file, const Comparison& comparison);
std::string json_comparison(const PublishedFile& file, const Comparison& comparison);

}  // namespace wingbeat
