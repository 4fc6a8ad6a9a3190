// wingbeat optimise STUDY: the best design within bounds and constraints.
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "progress.hpp"
#include "wingbeat/files/design_edit.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/optimise_data.hpp"
#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/report/pareto_report.hpp"
#include "wingbeat/run/evolution_module.hpp"
#include "wingbeat/run/parallel.hpp"
#include "wingbeat/study/drive_train.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat::app {
namespace {

struct OptimiseArguments {
  std::vector<std::string> overrides;
  std::string study, output, plot, plot_width, designs;
  int threads = 0;
  bool json = false, force = false;
  bool allow_extrapolation = false;
};

bool is_data_set(const std::string& name) { return std::filesystem::path(name).extension() == ".nc"; }

/// The study's, for a comment.
std::string file_name(const OptimiseArguments& arguments) {
  return one_line(std::filesystem::path(arguments.study).filename().string(), 200);
}

/// Refuses before the search what write_designs() would meet after it.
void check_designs(const OptimiseArguments& arguments, const OptimiseFile& file) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& why) {
    throw InputError("--designs " + arguments.designs, 0, 0, "", why);
  };
  const fs::path folder = arguments.designs;
  std::error_code error;
  if (!fs::exists(folder, error)) {
    fs::path above = fs::absolute(folder, error);
    while (!above.empty() && !fs::exists(above, error) && above != above.parent_path()) above = above.parent_path();
    if (!fs::is_directory(above, error)) refuse(fmt::format("cannot be made: {} is no folder", above.string()));
    if (::access(above.c_str(), W_OK | X_OK) != 0) refuse(fmt::format("cannot be made: {}", std::strerror(errno)));
    return;
  }
  if (!fs::is_directory(folder, error)) refuse("is a file, not a folder");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) refuse(fmt::format("cannot be written: {}", std::strerror(errno)));
  for (const std::string& name : pick_names(file.objectives, file.designs)) {
    checked_output("--designs", folder / (name + ".toml"), {".toml", arguments.force});
  }
}

/// Writes the picked designs of a front into a folder, which is made where it is not there.
void write_designs(const std::string& folder, const OptimiseArguments& arguments, const OptimiseFile& optimise,
                   const ParetoStudy& study, const ParetoResult& result) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError("--designs " + folder, 0, 0, "", "cannot be made: " + error.message());
  for (const auto& [name, place] : named_picks(study, result)) {
    const ParetoDesign& design = result.front[place];
    std::string head =
        fmt::format("# {} of the front found by wingbeat {} optimise {}:\n#", name, version, file_name(arguments));
    for (const ParetoObjective& o : study.objectives) {
      head += fmt::format(" {} = {:.6g}", metric_info(o.metric).key, design.metrics[o.metric]);
    }
    if (study.vehicles.size() > 1) head += fmt::format("\n# Motor: {}", one_line(study.vehicles[design.vehicle].name));
    const std::filesystem::path path = std::filesystem::path(folder) / (name + ".toml");
    OutputFile file("--designs", path, {".toml", arguments.force});
    file.write(head + "\n\n" + edited_design(optimise.vehicle_file, path, vehicle_of(study, design)));
    file.commit();
  }
}

/// Several objectives.
int run_front(const OptimiseArguments& arguments, const OptimiseFile& file, const ForEach& for_each) {
  if (!arguments.output.empty() && !is_data_set(arguments.output)) {
    throw InputError("-o " + arguments.output, 0, 0, "",
                     "several objectives have many best designs: the name must end in .nc; --designs writes vehicles");
  }
  const auto format = asked_format("--plot", arguments.plot, arguments.plot_width, true);
  std::optional<OutputFile> output, plot;
  if (!arguments.output.empty()) output.emplace("-o", arguments.output, OutputRules{".nc", arguments.force});
  if (!arguments.plot.empty()) {
    plot.emplace("--plot", arguments.plot, OutputRules{page_extensions, arguments.force});
  }
  ProgressLine line("optimise: ");
  std::function<void(std::uint64_t, std::uint64_t)> progress;
  if (line.on_terminal()) {
    progress = [&](std::uint64_t done, std::uint64_t all) {
      line.show(fmt::format("{:.0f} % of {} designs", 100.0 * double(done) / double(all), all));
    };
  }
  if (!arguments.designs.empty()) check_designs(arguments, file);
  const ParetoStudy study = pareto_study(file);
  const ParetoResult result = pareto_front(study, load_evolution(), start_up_in_time(), for_each, progress);
  line.clear();
  const bool found = result.outcome == ParetoResult::Outcome::found;
  if (found && output) {
    write_front(study, result, file.title, read_text_file(arguments.study), version, output->temporary());
    output->commit();
  }
  if (found && plot) {
    plot_front(study, result, file.title, *format, plot->temporary());
    plot->commit();
  }
  if (found && !arguments.designs.empty()) {
    write_designs(arguments.designs, arguments, file, study, result);
  }
  print(arguments.json ? json_front(file, study, result) : text_front(file, study, result));
  return found ? done : does_not_flap;
}

int run(const OptimiseArguments& arguments) {
  const auto format = asked_format("--plot", arguments.plot, arguments.plot_width, true);
  OptimiseFile file = read_optimise_study(arguments.study, arguments.overrides);
  file.study.allow_extrapolation |= arguments.allow_extrapolation;
  const ForEach for_each = [&](std::size_t count, const std::function<void(std::size_t)>& act) {
    for_each_in_parallel(count, act, arguments.threads);
  };
  if (!file.objectives.empty()) return run_front(arguments, file, for_each);
  if (format && *format == PlotFormat::html) {
    throw InputError("--plot " + arguments.plot, 0, 0, "",
                     "pages show fronts; the optimum of one objective is drawn to .svg, .pdf or .png");
  }
  if (!arguments.designs.empty()) {
    throw InputError("--designs " + arguments.designs, 0, 0, "", "one objective has one best design; -o writes it");
  }
  std::optional<OutputFile> output, plot;
  if (!arguments.output.empty()) output.emplace("-o", arguments.output, OutputRules{".toml .nc", arguments.force});
  if (!arguments.plot.empty()) {
    plot.emplace("--plot", arguments.plot, OutputRules{plot_extensions, arguments.force});
  }
  ProgressLine line("optimise: ");
  const StartUp start_up = start_up_in_time();

  const bool drive_trains = file.drive_train.any();
  DriveTrainScreen screen;
  const auto progress = [&line](const std::string& text) { line.show(text); };
  std::vector<MotorTrial> trials =
      drive_trains ? choose_drive_train(file, start_up, for_each, progress, screen) : trials_of(file);
  const bool single = !drive_trains && trials.size() == 1 && !trials[0].motor;
  if (drive_trains) {
    // Searched already.
  } else if (single) {
    // Screening, searches and the neighbourhood of the best are one call each.
    const ForEach shown = [&](std::size_t count, const std::function<void(std::size_t)>& act) {
      std::atomic<std::size_t> finished = 0;
      line.show(fmt::format("0 of {} designs or searches", count));
      for_each(count, [&](std::size_t n) {
        act(n);
        line.show(fmt::format("{} of {} designs or searches", ++finished, count));
      });
    };
    trials[0].result = optimise(trial_study(file, trials[0]), start_up, shown);
  } else {
    std::atomic<std::size_t> finished = 0;
    for_each(trials.size(), [&](std::size_t n) {
      if (!trials[n].refused()) trials[n].result = optimise(trial_study(file, trials[n]), start_up, for_each);
      line.show(fmt::format("{} of {} {}", ++finished, trials.size(), file.motors.empty() ? "choices" : "motors"));
    });
  }
  line.clear();

  const MotorTrial* best = best_trial(file, trials);
  if (output && is_data_set(arguments.output)) {
    write_optimum(file, trials, read_text_file(arguments.study), version, output->temporary());
    output->commit();
  } else if (output && best) {
    std::string head =
        fmt::format("# Found by wingbeat {} optimise {}: {} = {:.6g}\n", version, file_name(arguments),
                    metric_info(file.study.objective).key, best->result.point.metrics[file.study.objective]);
    if (best->motor) head += fmt::format("# Motor: {}\n", one_line(best->motor->model));
    if (best->gearbox) head += fmt::format("# Gearbox: {}\n", one_line(best->gearbox->model));
    if (best->battery) head += fmt::format("# Battery: {}\n", one_line(best->battery->model));
    output->write(head + "\n" + edited_design(file.vehicle_file, arguments.output, best->result.design));
    output->commit();
  }
  if (plot && best) {
    plot_optimum(file, *best, *format, plot->temporary());
    plot->commit();
  }
  if (drive_trains) {
    print(arguments.json ? json_drive_trains(file, screen, trials) : text_drive_trains(file, screen, trials));
  } else if (single)
    print(arguments.json ? json_optimum(file, trials[0].result) : text_optimum(file, trials[0].result));
  else print(arguments.json ? json_motors(file, trials) : text_motors(file, trials));
  return best ? done : does_not_flap;
}

}  // namespace

void add_optimise(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("optimise", "Find the best design within bounds and constraints");
  const auto a = std::make_shared<OptimiseArguments>();
  add_input(command, a->study, InputKind::study, "study",
            "Study file (TOML): objective, parameters, constraints, lists of parts", "STUDY");
  add_set(command, a->overrides);
  add_file(command, "-o,--output", a->output, ".toml .nc",
           "Write the optimum as a vehicle file, or what was found on the way, and any front, as FILE.nc (NetCDF-4)");
  add_file(
      command, "--plot", a->plot, page_extensions,
      "Draw the optimum and its neighbourhood, or the front, to FILE.svg, .pdf or .png, the front also to FILE.html, "
      "which shows the numbers of each design");
  add_folder(command, "--designs", a->designs, "Write designs of the front as vehicle files: ends, knee, even steps",
             "FOLDER");
  command->add_flag("--allow-extrapolation", a->allow_extrapolation,
                    "Search outside the model's domain too (docs/domain.md)");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  add_json(command, a->json);
  add_threads(command, a->threads);
  command->footer(
      "Example:\n  wingbeat optimise optimise-hover -o hover.toml\n"
      "  wingbeat optimise optimise-pareto --plot front.svg --designs front\n\n"
      "Exit status: 0 found, 2 bad input or usage, 3 no design within the constraints, 1 anything else.");
  command->callback([a, &action] {
    action = [a] {
      a->study = find_input(a->study, InputKind::study).string();
      return run(*a);
    };
  });
}

}  // namespace wingbeat::app
