// What logs of a test bench were understood as, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "wingbeat/files/bench_file.hpp"

namespace wingbeat {

struct BenchReading {
  BenchLog log;
  LogNotes notes;
};

/// A table of the columns of each log, and what was left out.
std::string text_readings(const std::vector<BenchReading>& readings);

/// One JSON object: columns, units, ranges and what was left out of each log.
std::string json_readings(const std::vector<BenchReading>& readings);

/// What was left out of a log, in a sentence; empty where nothing was.
std::string left_out(const BenchLog& log);

}  // namespace wingbeat
