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
  double computed;   ///< absent where a design does not flap
  double deviation;  ///< computed / published - 1
  bool within;       ///< abs(deviation) <= tolerance
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
};

Comparison compare(const PublishedFile& file, double tolerance = 1e-9);

std::string text_comparison(const PublishedFile& file, const Comparison& comparison);
std::string json_comparison(const PublishedFile& file, const Comparison& comparison);

}  // namespace wingbeat
