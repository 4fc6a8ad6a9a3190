// wingbeat run VEHICLE: the steady flapping of one vehicle.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "command.hpp"
#include "operating_point.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/files/waveform_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/report/two_sides_report.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat::app {
namespace {

constexpr int waveform_rows = 361;

struct RunArguments {
  OperatingPointArguments operating_point;
  std::string method = "orbit";
  std::string tolerance = "1e-6";
  bool json = false, force = false, endurance = false;
  std::string waveforms, plot, plot_power, plot_width;
};

/// A file to be written, its place reserved before anything is computed.
std::optional<OutputFile> reserved(const char* option, const std::string& path, const OutputRules& rules) {
  return path.empty() ? std::nullopt : std::optional<OutputFile>(std::in_place, option, path, rules);
}

std::string case_title(const Design<double>& design, const RunResult& result, Condition condition) {
  std::string voltage = readable(result.metrics[Metric::voltage], "V");
  if (design.supply.offset != 0.0) voltage += fmt::format(" about {}", readable(design.supply.offset, "V"));
  std::string title = fmt::format("{}, {}", voltage, readable(result.metrics[Metric::frequency], "Hz"));
  if (condition != Condition::air) title += fmt::format(", {}", name_of(condition));
  if (is_sine(design.supply.type)) title = fmt::format("sine supply, {}", title);
  if (result.domain.any()) title += fmt::format("; OUTSIDE THE DOMAIN ({})", name_of(result.domain));
  return title;
}

int run_sides(const TwoSides& sides, const RunArguments& arguments, const RunOptions& options) {
  for (const auto& [option, text] :
       {std::pair("--waveforms", &arguments.waveforms), std::pair("--plot", &arguments.plot),
        std::pair("--plot-power", &arguments.plot_power)}) {
    if (!text->empty()) throw InputError(option, 0, 0, "", "takes no vehicle whose sides differ, which has two cycles");
  }
  if (arguments.endurance) throw InputError("--endurance", 0, 0, "", "takes no vehicle whose sides differ");
  const TwoSidesResult result = run_two_sides(sides, options);
  print(arguments.json ? json_two_sides(result) : text_two_sides(result, options));
  if (result.status == FlappingStatus::flapping) return done;
  return result.status == FlappingStatus::undecided ? failed : does_not_flap;
}

int run(const RunArguments& arguments) {
  RunOptions options;
  options.method = choice_of<Method>("--method", arguments.method);
  try {
    options.tolerance = quantity_of("--tolerance", arguments.tolerance, "1");
  } catch (const InputError&) {
    options.tolerance = absent;
  }
  if (!(options.tolerance >= 1e-12 && options.tolerance <= 1e-2)) {
    throw InputError("--tolerance " + arguments.tolerance, 0, 0, "", "must be a number between 1e-12 and 1e-2");
  }
  bool waveforms_csv_wanted = false;
  if (!arguments.waveforms.empty()) {
    const std::string extension = std::filesystem::path(arguments.waveforms).extension().string();
    if (extension != ".csv" && extension != ".nc") {
      throw InputError("--waveforms " + arguments.waveforms, 0, 0, "", "the name must end in .csv or .nc");
    }
    waveforms_csv_wanted = extension == ".csv";
  }
  const auto cycle_format = asked_format("--plot", arguments.plot, arguments.plot_width);
  const auto power_format = asked_format("--plot-power", arguments.plot_power, arguments.plot_width);

  const VehicleFile vehicle = read_operating_point(arguments.operating_point, options);
  if (vehicle.sides) return run_sides(*vehicle.sides, arguments, options);
  const Design<double>& design = vehicle.design;
  const OutputRules drawing{plot_extensions, arguments.force};
  auto waveforms = reserved("--waveforms", arguments.waveforms, {".csv .nc", arguments.force});
  auto cycle_plot = reserved("--plot", arguments.plot, drawing);
  auto power_plot = reserved("--plot-power", arguments.plot_power, drawing);
  if (waveforms || cycle_plot) options.waveform_rows = waveform_rows;

  options.endurance = arguments.endurance;
  if (arguments.endurance && !has_battery(design.supply.type)) {
    throw InputError("--endurance", 0, 0, "",
                     "only a battery runs down: supply.type is " + std::string(name_of(design.supply.type)) +
                         "; expected battery or battery-sine");
  }
  const RunResult result = run_design(design, options);
  require_reached(arguments.operating_point, result);
  const bool flaps = result.status == FlappingStatus::flapping;
  const bool has_metrics = std::isfinite(result.metrics[Metric::frequency]);

  if (has_metrics) {
    const std::string title = case_title(result.design, result, options.condition);
    if (options.waveform_rows > 0 && result.cycle.empty()) throw std::runtime_error("no whole cycle was recorded");
    if (waveforms) {
      if (waveforms_csv_wanted) {
        waveforms->write(waveforms_csv(result.cycle));
      } else {
        write_waveforms_netcdf(
            waveforms->temporary(), result.cycle,
            {.title = fmt::format("One flapping cycle of {}",
                                  design.name.empty() ? written_name(arguments.operating_point.vehicle) : design.name),
             .command = "run",
             .version = version,
             .vehicle = write_design(result.design),
             .condition = name_of(options.condition),
             .method = name_of(options.method),
             .domain = name_of(result.domain),
             .tolerance = options.tolerance});
      }
      waveforms->commit();
    }
    if (cycle_plot) {
      plot_cycle(result.cycle, result.design, title, *cycle_format, cycle_plot->temporary());
      cycle_plot->commit();
    }
    if (power_plot) {
      const PowerBar bar{title, energy_audit(result.metrics)};
      plot_powers({&bar, 1}, "Where the electrical power goes", *power_format, power_plot->temporary());
      power_plot->commit();
    }
  }

  print(arguments.json ? json_report(result) : text_report(result, options));
  if (flaps && has_metrics) return done;
  if (waveforms || cycle_plot || power_plot) complain("no steady flapping: no file was written");
  if (flaps || result.status == FlappingStatus::undecided) {
    complain("no decision: " + describe(result));
    return failed;
  }
  return does_not_flap;
}

}  // namespace

void add_run(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("run", "Find the steady flapping of one vehicle and report its metrics");
  const auto a = std::make_shared<RunArguments>();
  add_operating_point(command, a->operating_point);
  add_choice<Method>(command, "--method", a->method, "orbit (default), or transient: simulated from rest", "METHOD");
  command->add_option("--tolerance", a->tolerance, "Relative accuracy of every metric, 1e-12 to 1e-2 (default 1e-6)")
      ->type_name("NUMBER");
  add_allow_extrapolation(command, a->operating_point);
  command->add_flag("--endurance", a->endurance,
                    "Also find how long it hovers and flaps on its battery (docs/endurance.md): takes about fifty "
                    "times as long");
  add_json(command, a->json);
  add_file(command, "--waveforms", a->waveforms, ".csv .nc", "Write one cycle to FILE.csv or FILE.nc");
  add_file(command, "--plot", a->plot, plot_extensions, "Plot one cycle to FILE.svg, .pdf or .png");
  add_file(command, "--plot-power", a->plot_power, plot_extensions,
           "Plot the power breakdown to FILE.svg, .pdf or .png");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  command->footer(
      "Example:\n"
      "  wingbeat run friction2022 --frequency \"22 Hz\" \\\n"
      "    --set friction.radius=\"2 mm\" --plot cycle.svg\n\n"
      "--frequency finds the voltage for a flapping frequency, --lift the lowest one for a mean lift. Both keep\n"
      "to the domain of validity (angles of attack from 0 to 90 deg and more) unless --allow-extrapolation;\n"
      "otherwise the message states the limit. With a pwm supply the orbit and the searches use the mean voltage;\n"
      "--frequency changes its voltage, --lift its duty; on a battery both find the duty. A direct drive takes\n"
      "--frequency as that of its sine and --lift by its amplitude; a crank on a sine needs --method transient,\n"
      "which also reports the start-up.\n\n"
      "Exit status: 0 steady flapping, 2 bad input or usage, 3 the vehicle does not flap, 1 anything else.");
  act_at_operating_point(command, action, a, run);
}

}  // namespace wingbeat::app
