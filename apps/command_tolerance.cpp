// wingbeat tolerance STUDY: what uncertain parameters do to a vehicle's metrics.
#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "operating_point.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "progress.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/files/tolerance_data.hpp"
#include "wingbeat/files/tolerance_file.hpp"
#include "wingbeat/report/tolerance_report.hpp"
#include "wingbeat/run/parallel.hpp"
#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat::app {
namespace {

struct ToleranceArguments {
  std::vector<std::string> overrides;
  std::string study, output, plot, plot_metric, plot_width, speed;
  int threads = 0;
  bool json = false, force = false;
  bool allow_extrapolation = false, flight = false;
};

/// Each vehicle trimmed, with its modes.
int run_flights(const ToleranceArguments& arguments) {
  for (const auto& [option, file] : {std::pair("-o", &arguments.output), std::pair("--plot", &arguments.plot)}) {
    if (!file->empty())
      throw InputError(option, 0, 0, "", "flights are neither written nor drawn; --json has their spread");
  }
  if (arguments.allow_extrapolation) {
    throw InputError("--allow-extrapolation", 0, 0, "", "is of the metrics of a cycle; with --flight leave it out");
  }
  const ToleranceStudy study = read_tolerance_study(arguments.study, arguments.overrides);
  FlightCondition condition;
  if (!arguments.speed.empty()) condition.speed = quantity_of("--speed", arguments.speed, "m/s");
  ProgressLine line("tolerance: ");
  const auto progress = [&](double share) {
    line.show(fmt::format("{:.0f} % of {} vehicles", 100.0 * share, study.count));
  };
  try {
    const ForEach for_each = [&](std::size_t count, const std::function<void(std::size_t)>& act) {
      for_each_in_parallel(count, act, arguments.threads);
    };
    const FlightToleranceResult result = flight_tolerance(study, condition, for_each, progress);
    line.clear();
    print(arguments.json ? json_flight_tolerance(study, condition, result)
                         : text_flight_tolerance(study, condition, result));
    return result.flies.count > 0 ? done : does_not_flap;
  } catch (const ParameterError& e) {
    throw InputError(arguments.study, 0, 0, e.key(), e.reason());
  }
}

int run(const ToleranceArguments& arguments) {
  if (arguments.flight) return run_flights(arguments);
  const auto format = asked_format("--plot", arguments.plot, arguments.plot_width);
  if (!arguments.output.empty() && std::filesystem::path(arguments.output).extension() != ".nc") {
    throw InputError("-o " + arguments.output, 0, 0, "", "the name must end in .nc");
  }
  ToleranceStudy study = read_tolerance_study(arguments.study, arguments.overrides);
  study.allow_extrapolation |= arguments.allow_extrapolation;
  const std::string option = "--plot-metric " + arguments.plot_metric;
  if (!arguments.plot_metric.empty()) {
    const int index = metric_index(arguments.plot_metric);
    if (index == metric_count || !study.options.metrics[std::size_t(index)]) {
      throw InputError(option, 0, 0, "", "is not among the metrics of the study");
    }
  }
  std::optional<OutputFile> output, plot;
  if (!arguments.output.empty()) output.emplace("-o", arguments.output, OutputRules{".nc", arguments.force});
  if (format) plot.emplace("--plot", arguments.plot, OutputRules{plot_extensions, arguments.force});

  ProgressLine line("tolerance: ");
  const auto progress = [&](const SweepProgress& p) {
    line.show(fmt::format("{:.0f} % of {} vehicles", 100.0 * double(p.done) / double(p.designs), p.designs));
  };
  const SweepColumns columns = solve_sweep(tolerance_sweep(study), arguments.threads, progress);
  line.clear();
  const ToleranceResult result = assess_tolerance(study, columns, start_up_in_time());

  if (output) {
    write_tolerance(study, result, columns, read_text_file(arguments.study), version, output->temporary());
    output->commit();
  }
  if (plot) {
    const ToleranceOutput* drawn =
        arguments.plot_metric.empty() ? main_output(result) : result.find(arguments.plot_metric);
    if (!drawn || !(drawn->deviation > 0.0)) {
      throw InputError("--plot " + arguments.plot, 0, 0, "",
                       "nothing to draw: no vehicle flaps, or the metric does not vary");
    }
    plot_tolerance(study, columns, *drawn, *format, plot->temporary());
    plot->commit();
  }
  print(arguments.json ? json_tolerance(study, result) : text_tolerance(study, result));
  return result.status[std::size_t(SweepStatus::flapping)].count > 0 ? done : does_not_flap;
}

}  // namespace

void add_tolerance(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("tolerance", "Find how uncertain parameters affect the metrics");
  const auto a = std::make_shared<ToleranceArguments>();
  add_input(command, a->study, InputKind::study, "study", "Study file (TOML): vehicle, distributions", "STUDY");
  add_set(command, a->overrides);
  add_file(command, "-o,--output", a->output, ".nc", "Write samples, metrics and indices (NetCDF-4)", "FILE.nc");
  command->add_flag("--allow-extrapolation", a->allow_extrapolation,
                    "Samples outside the model's domain count and may hover (docs/domain.md)");
  CLI::Option* flight =
      command->add_flag("--flight", a->flight,
                        "Trim each vehicle, which has a body: spread of voltage, power and modes (docs/flight.md)");
  command->add_option("--speed", a->speed, "With --flight: forward, against the air; hover unless given")
      ->needs(flight)
      ->type_name("SPEED");
  add_json(command, a->json);
  add_threads(command, a->threads);
  CLI::Option* plot = add_file(command, "--plot", a->plot, plot_extensions,
                               "Draw a metric's distribution and sources to FILE.svg, .pdf or .png");
  takes(command->add_option("--plot-metric", a->plot_metric, "Which one (default: lift to weight, else mean lift)")
            ->needs(plot)
            ->type_name("METRIC"),
        metric_choices());
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  command->footer(
      "Example:\n  wingbeat tolerance tolerance-hover --plot tolerance.svg\n\n"
      "Exit status: 0 done, 2 bad input or usage, 3 no vehicle flaps, 1 anything else.");
  command->callback([a, &action] {
    action = [a] {
      a->study = find_input(a->study, InputKind::study).string();
      return run(*a);
    };
  });
}

}  // namespace wingbeat::app
