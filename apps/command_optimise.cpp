// wingbeat optimise STUDY: the best design within bounds and constraints.
#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <mutex>
#include <optional>

#include "command.hpp"
#include "wingbeat/io/design_file.hpp"
#include "wingbeat/io/optimise_file.hpp"
#include "wingbeat/io/output_file.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat::app {
namespace {

struct Arguments {
  std::string study, output;
  int threads = 0;
  bool json = false;
};

int run(const Arguments& arguments) {
  const OptimiseFile file = read_optimise_study(arguments.study);
  std::optional<OutputFile> output;
  if (!arguments.output.empty()) output.emplace("-o", arguments.output);
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  const auto show = [&](const std::string& what) {
    if (terminal) fmt::print(stderr, "\r{:<78}", what.empty() ? "" : "optimise: " + what);
  };
  const ForEach for_each = [&](std::size_t count, const std::function<void(std::size_t)>& act) {
    for_each_in_parallel(count, act, arguments.threads);
  };
  const StartUp start_up = start_up_in_time();

  std::vector<MotorTrial> trials;
  OptimiseResult own;
  if (file.motors.empty()) {
    show("searching");
    own = optimise(file.study, start_up, for_each);
  }
  for (const MotorCandidate& motor : file.motors) trials.push_back({&motor, {}});
  std::mutex mutex;
  std::size_t finished = 0;
  for_each(trials.size(), [&](std::size_t n) {
    const MotorCandidate& motor = *trials[n].motor;
    if (motor.refused.empty()) {
      OptimiseStudy study = file.study;
      study.design = motor.design;
      trials[n].result = optimise(study, start_up);
    }
    const std::lock_guard<std::mutex> lock(mutex);
    show(fmt::format("{} of {} motors", ++finished, trials.size()));
  });
  show("");
  if (terminal) fmt::print(stderr, "\r");

  const MotorTrial* best = best_trial(file, trials);
  const OptimiseResult& result = best ? best->result : own;
  const bool found = result.outcome == OptimiseResult::Outcome::found;
  if (output && found) {
    std::string head = fmt::format("# Found by wingbeat {} optimise {}: {} = {:.6g}\n", version,
                                   std::filesystem::path(arguments.study).filename().string(),
                                   metric_table()[std::size_t(file.study.objective)].key,
                                   result.point.metrics[file.study.objective]);
    if (best) head += fmt::format("# Motor: {}\n", best->motor->model);
    output->write(head + "\n" + write_design(result.design));
    output->commit();
  }
  if (file.motors.empty()) print(arguments.json ? json_optimum(file, own) : text_optimum(file, own));
  else print(arguments.json ? json_motors(file, trials) : text_motors(file, trials));
  return found ? done : does_not_flap;
}

}  // namespace

void add_optimise(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("optimise", "Find the best design within bounds and constraints");
  const auto a = std::make_shared<Arguments>();
  command->add_option("study", a->study, "Study file (TOML): objective, parameters, constraints, motors")
      ->required()
      ->type_name("STUDY");
  command->add_option("-o,--output", a->output, "Write the optimum as a vehicle file")->type_name("FILE");
  command->add_flag("--json", a->json, "Print one JSON object instead of tables");
  command->add_option("--threads", a->threads, "Use at most so many threads (default: one for each core)")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  command->footer("Example:\n  wingbeat optimise data/studies/optimise-hover.toml -o hover.toml\n\n"
                  "Exit status: 0 found, 2 bad input or usage, 3 no design within the constraints, 1 anything else.");
  command->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace wingbeat::app
