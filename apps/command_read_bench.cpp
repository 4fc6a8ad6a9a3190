// wingbeat read-bench FILE: what a log of a test bench, or all logs of a bench file, are understood as.
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "options.hpp"
#include "wingbeat/files/bench_file.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/report/bench_report.hpp"

namespace wingbeat::app {
namespace {

struct ReadBenchArguments {
  std::string file;
  bool json = false;
};

std::vector<BenchReading> readings_of(const std::string& file) {
  std::vector<BenchReading> readings;
  if (std::filesystem::path(file).extension() == ".toml") {
    std::vector<LogNotes> notes;
    const BenchFit fit = read_bench(file, {}, &notes);
    for (std::size_t n = 0; n < fit.logs.size(); ++n) readings.push_back({fit.logs[n], notes[n]});
  } else {
    BenchReading reading;
    reading.log = parse_log(read_text_file(file), file, {}, &reading.notes);
    readings.push_back(std::move(reading));
  }
  return readings;
}

}  // namespace

void add_read_bench(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("read-bench", "Show how the program reads logs of a test bench");
  const auto a = std::make_shared<ReadBenchArguments>();
  add_input(command, a->file, InputKind::bench, "file", "A log (CSV), or a bench file (TOML) with its logs", "FILE");
  add_json(command, a->json);
  command->footer(
      "Example:\n  wingbeat read-bench flapper\n\n"
      "Logs may have commas, semicolons or tabs between cells, a decimal point or comma, rows in any order, and\n"
      "common names and units (current_mA, Lift (g), rpm). If a file has two possible meanings, the message names\n"
      "the key of [[log]] that decides.\n\n"
      "Exit status: 0 read, 2 bad input or a question.");
  command->callback([a, &action] {
    action = [a] {
      a->file = find_input(a->file, InputKind::bench).string();
      const std::vector<BenchReading> readings = readings_of(a->file);
      print(a->json ? json_readings(readings) : text_readings(readings));
      return done;
    };
  });
}

}  // namespace wingbeat::app
