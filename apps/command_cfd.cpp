// wingbeat export-kinematics VEHICLE and wingbeat compare-loads VEHICLE LOADS: the loop through CFD.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "command.hpp"
#include "operating_point.hpp"
#include "options.hpp"
#include "plot_option.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/kinematics_file.hpp"
#include "wingbeat/files/loads_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/loads_report.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/study/load_grid.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::app {
namespace {

/// A vehicle whose sides move alike.
Design<double> read_alike(const OperatingPointArguments& arguments, RunOptions& options) {
  const VehicleFile vehicle = read_operating_point(arguments, options);
  if (!vehicle.sides) return vehicle.design;
  throw InputError(arguments.vehicle, 0, 0, "left", sides_refused);
}

/// Of wings on hinges the rows grow with the cube of the values.
constexpr int grid_values = 17, grid_values_max = 101;
constexpr int csv_rows = 361, series_steps = 1024, harmonics_max = 40;
constexpr double series_error = 0.01 / degrees_per_radian;  ///< [rad]

/// A vehicle at its operating point.
struct Operated {
  RunResult result;
  CycleRecord cycle;  ///< empty where there is none
};

Operated operate(const OperatingPointArguments& arguments, const Design<double>& design, const RunOptions& options) {
  Operated operated{run_design(design, options), {}};
  require_reached(arguments, operated.result);
  if (operated.result.status != FlappingStatus::flapping) return operated;
  const Design<double>& found = operated.result.design;
  operated.cycle =
      find_steady_flapping(resolve(found, options.condition), {1e-10, false, reporting_of(found)}, start_up_in_time())
          .record;
  return operated;
}

/// The exit status where there is no cycle to work with.
int without_cycle(const Operated& operated, const char* what) {
  complain(fmt::format("no {}: {}", what, describe(operated.result)));
  if (operated.result.status == FlappingStatus::flapping) {
    complain("it flaps, but its cycle was found in time alone: there is no orbit to take the motion from");
    return failed;
  }
  return operated.result.status == FlappingStatus::undecided ? failed : does_not_flap;
}

std::string vehicle_name(const OperatingPointArguments& arguments, const Design<double>& design) {
  return design.name.empty() ? written_name(arguments.vehicle) : design.name;
}

struct ExportKinematicsArguments {
  OperatingPointArguments operating_point;
  std::string output, format = "csv";
  int rows = 0, harmonics = 0;  ///< 0: as the format has them
  bool loads = false, json = false, force = false;
};

AngleSeries series_for(const std::vector<double>& values, int harmonics) {
  return harmonics > 0 ? angle_series(values, harmonics) : angle_series_within(values, series_error, harmonics_max);
}

const char* extension_of(KinematicsFormat format) {
  switch (format) {
    case KinematicsFormat::wabbit: return ".ini";
    case KinematicsFormat::pterasoftware: return ".py";
    default: return ".csv";
  }
}

int run(const ExportKinematicsArguments& arguments) {
  const auto format = choice_of<KinematicsFormat>("--format", arguments.format);
  const bool table = format == KinematicsFormat::load_table;
  if (arguments.harmonics > 0 && (table || format == KinematicsFormat::csv)) {
    throw InputError("--harmonics", 0, 0, "", "a csv file has no series; use --format wabbit or pterasoftware");
  }
  if (arguments.loads && format != KinematicsFormat::csv) {
    throw InputError("--loads", 0, 0, "", "only a csv file has loads; use --format csv");
  }
  if (table && arguments.rows > grid_values_max) {
    throw InputError(
        "--rows", 0, 0, "",
        fmt::format("a load-table has at most {} flapping velocities, got {}", grid_values_max, arguments.rows));
  }
  RunOptions options;
  const Design<double> design = read_alike(arguments.operating_point, options);
  if (format == KinematicsFormat::pterasoftware) wing_sections(design.wing.planform, 2);
  OutputFile output("-o", arguments.output, {extension_of(format), arguments.force});
  const Operated operated = operate(arguments.operating_point, design, options);
  if (operated.cycle.empty()) return without_cycle(operated, "motion to write");

  WrittenKinematics written;
  written.format = format;
  written.frequency = 1.0 / operated.cycle.period();
  const int asked = arguments.rows > 0 ? arguments.rows : table ? grid_values : csv_rows;
  const int count = format == KinematicsFormat::csv ? asked : series_steps + 1;
  const std::vector<WingInstant> wings = wing_motion(operated.cycle, count);
  written.twists = std::isfinite(wings.front().twist);
  const auto [stroke_min, stroke_max] = std::minmax_element(
      wings.begin(), wings.end(), [](const auto& a, const auto& b) { return a.stroke.value < b.stroke.value; });
  const auto [pitch_min, pitch_max] = std::minmax_element(
      wings.begin(), wings.end(), [](const auto& a, const auto& b) { return a.pitch.value < b.pitch.value; });
  written.stroke_min = stroke_min->stroke.value, written.stroke_max = stroke_max->stroke.value;
  written.pitch_min = pitch_min->pitch.value, written.pitch_max = pitch_max->pitch.value;
  if (format == KinematicsFormat::csv) {
    written.rows = count;
    output.write(kinematics_csv(wings, arguments.loads));
  } else if (table) {
    const std::vector<LoadTable::Row> rows =
        load_grid(resolve(operated.result.design, options.condition), wings, asked);
    written.rows = int(rows.size());
    output.write(load_table_csv(rows, fmt::format("Loads of {} by wingbeat {}, of all wings, at an air density of {} "
                                                  "kg/m3, without the inertia of the air",
                                                  vehicle_name(arguments.operating_point, design), version,
                                                  operated.result.design.aerodynamics.air_density)));
  } else {
    if (written.twists) {
      throw InputError("--format " + arguments.format, 0, 0, "",
                       "has one pitch angle for a whole wing, but these wings twist; use --format csv");
    }
    std::vector<double> stroke, pitch;
    for (int k = 0; k < series_steps; ++k) {
      stroke.push_back(wings[std::size_t(k)].stroke.value);
      pitch.push_back(wings[std::size_t(k)].pitch.value);
    }
    const KinematicsSource source{vehicle_name(arguments.operating_point, design), version, written.frequency,
                                  series_for(stroke, arguments.harmonics), series_for(pitch, arguments.harmonics)};
    written.stroke = source.stroke, written.pitch = source.pitch;
    output.write(format == KinematicsFormat::wabbit ? kinematics_wabbit(source)
                                                    : kinematics_pterasoftware(source, operated.result.design));
  }
  output.commit();
  print(arguments.json ? json_kinematics(written) : text_kinematics(written));
  return done;
}

struct CompareLoadsArguments {
  OperatingPointArguments operating_point;
  std::string loads, loads_frequency, plot, plot_width;
  double skip_cycles = 0.0;
  bool own_motion = false, json = false, force = false;
};

int run(const CompareLoadsArguments& arguments) {
  std::optional<double> frequency;
  if (!arguments.loads_frequency.empty()) {
    frequency = quantity_of("--loads-frequency", arguments.loads_frequency, "Hz");
    if (!(*frequency > 0.0)) throw InputError("--loads-frequency", 0, 0, "", "must be > 0 Hz");
  }
  const auto format = asked_format("--plot", arguments.plot, arguments.plot_width);
  RunOptions options;
  const Design<double> design = read_alike(arguments.operating_point, options);
  LoadReport report;
  LoadsNotes notes;
  SimulatedLoads loads = read_loads(arguments.loads, &notes);
  report.loads_file = written_name(arguments.loads);
  for (const LoadsNotes::Column& column : notes.columns) {
    if (column.name.empty()) report.not_read.push_back(column.header);
  }
  std::optional<OutputFile> plot;
  if (format) plot.emplace("--plot", arguments.plot, OutputRules{plot_extensions, arguments.force});

  const bool stated = !loads.stroke.empty() && !arguments.own_motion;
  if (!loads.pitch.empty() && loads.stroke.empty() && !arguments.own_motion) {
    throw InputError(loads.file, 0, 0, "pitch_angle",
                     "comes without stroke_angle; add that column, or give --own-motion for the vehicle's own cycle");
  }
  if (!frequency) frequency = loads.frequency;
  std::optional<Operated> operated;
  if (!stated || !frequency) {
    operated = operate(arguments.operating_point, design, options);
    if (operated->cycle.empty()) return without_cycle(*operated, "motion to compare at");
    if (!frequency) frequency = 1.0 / operated->cycle.period();
  }
  if (loads.in_time) {
    for (double& place : loads.places) place *= *frequency;
    loads.in_time = false;
  }
  try {
    if (arguments.skip_cycles > 0.0) loads = without_first_cycles(loads, arguments.skip_cycles, *frequency);
    report.comparison = stated ? compare_loads_of_motion(loads, resolve(design, options.condition), *frequency)
                               : compare_loads_of_cycle(loads, operated->cycle);
  } catch (const ParameterError& error) {
    const bool named = error.key() == loads.file;
    throw InputError(loads.file, 0, 0, named ? "" : error.key(), error.reason());
  }
  if (plot) {
    plot_loads(report,
               fmt::format("{}, {}", vehicle_name(arguments.operating_point, design),
                           readable(report.comparison.frequency, "Hz")),
               *format, plot->temporary());
    plot->commit();
  }
  print(arguments.json ? json_loads(report) : text_loads(report));
  return done;
}

}  // namespace

void add_export_kinematics(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("export-kinematics", "Write the motion of the wings for CFD");
  const auto a = std::make_shared<ExportKinematicsArguments>();
  add_operating_point(command, a->operating_point);
  add_allow_extrapolation(command, a->operating_point);
  add_file(command, "-o,--output", a->output, ".csv .ini .py", "The file: .csv, of wabbit .ini, of pterasoftware .py")
      ->required();
  add_choice<KinematicsFormat>(command, "--format", a->format, "csv (default), wabbit, pterasoftware or load-table",
                               "FORMAT");
  command
      ->add_option("--rows", a->rows,
                   "Instants of a csv file (default 361), or flapping velocities of a load-table (default 17)")
      ->check(CLI::Range(3, 100000))
      ->type_name("NUMBER");
  command
      ->add_option("--harmonics", a->harmonics,
                   "Of the Fourier series of other formats (default: as many as 0.01 deg needs, at most 40)")
      ->check(CLI::Range(1, 400))
      ->type_name("NUMBER");
  command->add_flag("--loads", a->loads, "In a csv file also the model's loads, in columns that compare-loads reads");
  add_json(command, a->json);
  add_force(*command, a->force);
  command->footer(
      "Example:\n"
      "  wingbeat export-kinematics friction2022 --frequency \"22 Hz\" -o wings.ini --format wabbit\n\n"
      "csv: angles, velocities, stroke acceleration over time and phase. wabbit: kinematics file of WABBIT and FLUSI.\n"
      "pterasoftware: a Python script that sets wings and motion up and writes what compare-loads reads.\n"
      "load-table: a grid that covers the motion, with the model's loads, as aerodynamics.type = \"tabulated\"\n"
      "reads it. docs/cfd.md states the signs.\n\n"
      "Exit status: 0 done, 2 bad input or usage, 3 the vehicle does not flap, 1 anything else.");
  act_at_operating_point(command, action, a, run);
}

void add_compare_loads(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("compare-loads", "Compare loads from CFD with those of the model");
  const auto a = std::make_shared<CompareLoadsArguments>();
  add_operating_point(command, a->operating_point);
  takes(command->add_option("loads", a->loads, "Loads over the cycle (CSV)")->required()->type_name("LOADS"),
        {.choices = {}, .extensions = {".csv"}, .shipped = {}});
  add_allow_extrapolation(command, a->operating_point);
  command->add_flag("--own-motion", a->own_motion,
                    "Compare at the vehicle's settled cycle although the file has the stroke angle");
  command
      ->add_option("--loads-frequency", a->loads_frequency,
                   "Frequency of the simulated motion, as \"22 Hz\" (default: that of the file, or of the vehicle)")
      ->type_name("QUANTITY");
  command->add_option("--skip-cycles", a->skip_cycles, "Omit this many first cycles, in which the wake is growing")
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("NUMBER");
  add_json(command, a->json);
  add_file(command, "--plot", a->plot, plot_extensions, "Plot the loads over the cycle to FILE.svg, .pdf or .png");
  add_plot_width(command, a->plot_width);
  add_force(*command, a->force);
  command->footer(
      "Example:\n"
      "  wingbeat export-kinematics friction2022 --set wing.planform.s2=\"2.7e-6 m4\" --loads -o loads.csv\n"
      "  wingbeat compare-loads friction2022 loads.csv --plot loads.svg\n\n"
      "The file has a header with units: time_s, phase_deg or cycle; lift_mN or lift_per_wing_mN, stroke_moment_mN_m,\n"
      "pitch_moment_mN_m; stroke_angle_deg and pitch_angle_deg where the motion is another than the vehicle's own.\n"
      "docs/cfd.md states the signs and what each number means. The loads of the example are the model's own with a\n"
      "larger S_2, which the comparison finds.\n\n"
      "Exit status: 0 done, 2 bad input or usage, 3 the vehicle does not flap, 1 anything else.");
  act_at_operating_point(command, action, a, run);
}

}  // namespace wingbeat::app
