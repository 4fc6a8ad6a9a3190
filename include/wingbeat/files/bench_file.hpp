// Bench files: what was measured, how well, and which parameters are free. For the keys see docs/fit.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat {

/// A fit as its bench file describes it, logs read. Vehicle file and logs are sought beside it. Throws InputError with
/// file, line and reason.
BenchFit read_bench(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// The vehicle file that it names.
std::filesystem::path vehicle_of_bench(const std::filesystem::path& file);

/// One log: a header that names each column with its unit, rows growing strictly in what was set on the bench.
/// `log` brings the condition and, of a waveform log, the operating point in `given_value`. `measured` restricts the
/// columns used; empty: all.
struct LogRequest {
  BenchLog log;
  std::optional<Given> given;         ///< empty: the file holds one of voltage and frequency
  std::optional<double> given_value;  ///< of a waveform log
  std::vector<std::string> measured;
};
BenchLog parse_log(std::string_view text, const std::string& file_name, const LogRequest& request);

}  // namespace wingbeat
