// Bench files: what was measured, how well, and which parameters are free. For the keys see docs/fit.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat {

/// What a log was understood as.
struct LogNotes {
  struct Column {
    std::string header;  ///< as written
    std::string name;    ///< of the program; empty: not read
    std::string unit;    ///< as written
    double factor;       ///< SI value over the number
    std::string unit_si;
    bool is_set, is_used;  ///< what was set on the bench; what a fit uses
    bool renamed;          ///< the bench's name is another one
    int values;            ///< numbers in it
    double min, max;       ///< of them, SI
  };
  /// One mean cycle of a record of signals.
  struct Burst {
    int line, number, samples;  ///< first line; as BenchRow has it; rows
    double cycles, frequency;   ///< [1], [Hz]
    double frequency_error;     ///< standard error, with that of the voltage at which it was measured [Hz]
    double rate;                ///< of the frequency [Hz/s]
    double given;               ///< as BenchRow has it
    double correlation;         ///< largest of its channels, as AveragedChannel has it
  };
  std::string encoding;
  char separator = ',';
  bool decimal_comma = false;
  int remarks = 0;     ///< lines of comments
  bool sorted = true;  ///< rows stood in the order of what was set
  std::vector<Column> columns;
  std::vector<Burst> bursts;    ///< of a record of signals
  int rows_read = 0;            ///< of a record of signals
  int rows_in_short_burst = 0;  ///< rows behind the last whole burst, left out
};

/// A fit as its bench file describes it, logs read. Vehicle file and logs are sought beside it. Throws InputError with
/// file, line and reason. `notes` takes what each log was understood as.
BenchFit read_bench(const std::filesystem::path& file, std::span<const std::string> overrides = {},
                    std::vector<LogNotes>* notes = nullptr);

/// The vehicle file that it names.
std::filesystem::path vehicle_of_bench(const std::filesystem::path& file);

/// One log: a header that names each column with its unit, rows in any order, which come out sorted by what was set on
/// the bench. Cells without a value are NaN in the rows and counted; rows without what was set, or without any value,
/// are left out. `log` brings the condition and, of a waveform log, the operating point in `given_value`. `measured`
/// restricts the columns used; empty: all. A file with times (or of a known sampling rate) is a record of signals: it
/// becomes mean cycles, one for each burst.
struct LogRequest {
  BenchLog log;
  std::optional<Given> given;         ///< empty: the file holds one of voltage and frequency
  std::optional<double> given_value;  ///< of a waveform log
  std::vector<std::string> measured;
  /// A header as it stands in the file, and the quantity that it is, with or without unit; "ignore": not read.
  std::vector<std::pair<std::string, std::string>> columns = {};
  std::optional<char> separator = {}, decimal = {};  ///< where the file does not show them
  // Of waveforms.
  std::optional<double> sampling_rate = {};    ///< of a record without times [Hz]
  std::optional<double> burst = {};            ///< duration of the pieces that a record is cut into [s]
  std::optional<double> cycle_frequency = {};  ///< about, of the cycle in a record [Hz]
  std::optional<int> cycles = {};              ///< that were averaged, where columns of scatter are of one cycle
  bool alternating = false;                    ///< the drive's supply is a sine
  bool needs_point = false;                    ///< refuse a record of which voltage and frequency are unknown
};

BenchLog parse_log(std::string_view text, const std::string& file_name, const LogRequest& request,
                   LogNotes* notes = nullptr);

}  // namespace wingbeat
