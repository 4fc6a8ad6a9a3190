// wingbeat fit BENCH: a vehicle's parameters from bench measurements, and how sure they are.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "progress.hpp"
#include "wingbeat/files/bench_file.hpp"
#include "wingbeat/files/design_edit.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/report/fit_report.hpp"
#include "wingbeat/run/parallel.hpp"

namespace wingbeat::app {
namespace {

struct FitArguments {
  std::vector<std::string> overrides;
  std::string file, output, plot, plot_cycles, plot_width;
  int threads = 0;
  bool json = false, compare_friction = false, no_profiles = false, force = false;
};

int run(const FitArguments& arguments) {
  const auto format = asked_format("--plot", arguments.plot, arguments.plot_width);
  const auto cycles_format = asked_format("--plot-cycles", arguments.plot_cycles, arguments.plot_width);
  BenchFit fit = read_bench(arguments.file, arguments.overrides);
  fit.profiles = !arguments.no_profiles;
  std::optional<OutputFile> output, covariance, plot, cycles;
  const std::filesystem::path vehicle = arguments.output;
  if (!arguments.output.empty()) {
    const OutputRules rules{".toml", arguments.force};
    output.emplace("-o", vehicle, rules);
    covariance.emplace("-o", vehicle.parent_path() / (vehicle.stem().string() + ".covariance.toml"), rules);
  }
  if (format) plot.emplace("--plot", arguments.plot, OutputRules{plot_extensions, arguments.force});
  if (cycles_format) {
    if (std::none_of(fit.logs.begin(), fit.logs.end(), [](const BenchLog& log) { return log.waveform; })) {
      throw InputError(arguments.file, 0, 0, "--plot-cycles", "the bench has no waveforms");
    }
    cycles.emplace("--plot-cycles", arguments.plot_cycles, OutputRules{plot_extensions, arguments.force});
  }

  const ForEach for_each = [&](std::size_t count, const std::function<void(std::size_t)>& act) {
    for_each_in_parallel(count, act, arguments.threads);
  };
  ProgressLine line("fit: ");
  FitResult result;
  std::vector<FrictionCandidate> candidates;
  try {
    result = fit_bench(fit, line.shower(), for_each);
    if (arguments.compare_friction) {
      candidates = compare_friction(fit, design_parameter, line.shower(), for_each);
    }
  } catch (const ParameterError& error) {
    throw InputError(arguments.file, 0, 0, error.key(), error.reason());
  }
  line.clear();

  const std::string made_by =
      fmt::format("Fitted by wingbeat {} to {}", version, std::filesystem::path(arguments.file).filename().string());
  if (output && !result.misfit) {
    output->write(fitted_vehicle_head(fit, result, made_by) +
                  edited_design(vehicle_of_bench(arguments.file), vehicle, result.design));
    covariance->write(covariance_file(result, vehicle.filename().string(), made_by));
    output->commit();
    covariance->commit();
  }
  if (plot) {
    plot_residuals(fit, result, *format, plot->temporary());
    plot->commit();
  }
  if (cycles && !result.cycles.empty()) {
    plot_fitted_cycles(fit, result, *cycles_format, cycles->temporary());
    cycles->commit();
  }
  if (arguments.json) {
    print(json_fit(fit, result, candidates));
  } else {
    print(text_fit(fit, result) + (candidates.empty() ? "" : text_friction(candidates)));
  }
  if (result.misfit) {
    complain("the model does not describe the data: " + describe(*result.misfit) +
             (output ? "; no vehicle file was written" : ""));
    return does_not_flap;
  }
  if (!result.converged) {
    complain("the fit did not converge: " + result.message);
    return failed;
  }
  if (!result.unreached.empty()) {
    complain(fmt::format("{} of the rows cannot be reached by the fitted model", result.unreached.size()));
    return does_not_flap;
  }
  return done;
}

}  // namespace

void add_fit(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("fit", "Fit a vehicle's parameters to bench measurements");
  const auto a = std::make_shared<FitArguments>();
  add_input(command, a->file, InputKind::bench, "bench", "Bench file (TOML): vehicle, logs, free parameters", "BENCH");
  add_set(command, a->overrides);
  add_file(command, "-o,--output", a->output, ".toml",
           "Write the fitted vehicle file, and FILE.covariance.toml in its folder", "FILE.toml");
  command->add_flag("--compare-friction", a->compare_friction, "Fit every friction law to the same data and rank them");
  command->add_flag("--no-profiles", a->no_profiles,
                    "Skip the likelihood profiles: intervals from standard errors only");
  add_json(command, a->json);
  add_threads(command, a->threads);
  add_file(command, "--plot", a->plot, plot_extensions, "Plot the residuals by condition to FILE.svg, .pdf or .png");
  add_file(command, "--plot-cycles", a->plot_cycles, plot_extensions,
           "Plot measured waveforms over the fitted model's cycle to FILE.svg, .pdf or .png");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  command->footer(
      "Example:\n  wingbeat fit flapper -o fitted.toml\n\n"
      "Exit status: 0 fitted, 1 not converged, 2 bad input or usage, 3 the model does not describe the data, or\n"
      "cannot reach some rows.");
  command->callback([a, &action] {
    action = [a] {
      a->file = find_input(a->file, InputKind::bench).string();
      return run(*a);
    };
  });
}

}  // namespace wingbeat::app
