// Published values beside computed ones: the files in data/published.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/io/design_file.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {

/// One published number: a metric of a design, or its ratio to the same metric of another.
struct PublishedValue {
  std::optional<double> voltage;    ///< operating point [V], or
  std::optional<double> frequency;  ///< [Hz]
  Metric metric;
  std::string design;
  std::optional<std::string> relative_to;  ///< the ratio's second design
  double published;  ///< in the metric's SI unit, or a ratio
  double tolerance;  ///< accepted relative deviation [1]
};

struct PublishedFile {
  std::string title;
  std::string source;
  std::map<std::string, Design<double>> designs;  ///< by the names that the values use
  std::vector<PublishedValue> values;
};

/// Reads the file and the vehicle files it names, which are sought beside it. Throws InputError.
PublishedFile read_published(const std::filesystem::path& file);

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

/// "3 V" or "22 Hz".
std::string operating_point(const std::optional<double>& voltage, const std::optional<double>& frequency);

}  // namespace wingbeat
