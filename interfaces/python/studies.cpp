// Arrays of designs, sweeps and the studies that files describe, for Python. Nothing is computed here.
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "binding.hpp"
#include "report/result_trees.hpp"
#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/files/bench_file.hpp"
#include "wingbeat/files/datasheet_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/netcdf.hpp"
#include "wingbeat/files/tolerance_file.hpp"
#include "wingbeat/report/control_report.hpp"
#include "wingbeat/report/endurance_report.hpp"
#include "wingbeat/report/fit_report.hpp"
#include "wingbeat/report/identification_report.hpp"
#include "wingbeat/report/tolerance_report.hpp"
#include "wingbeat/study/sweep_gradients.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat::python {
namespace {

// ---- very many

/// A design for each row of the columns, which are in the order of the keys of the study's one axis. That study, of a
/// single design, is where the program's checks are made.
Sweep sweep_of_columns(const std::string& study, const Design<double>& base,
                       const std::vector<py::array_t<double>>& columns, std::size_t count,
                       const std::string& condition) {
  Sweep sweep = parse_study({.study_name = "columns", .study = study, .design = base}).sweep;
  sweep.variants.at(0).condition = choice<Condition>("condition", condition);
  SweepAxis& axis = sweep.axes.at(0);
  if (sweep.axes.size() != 1 || axis.quantities.size() != columns.size()) throw py::value_error("one axis of columns");
  axis.count = count;
  axis.samples = true;
  for (std::size_t q = 0; q < columns.size(); ++q) {
    if (std::size_t(columns[q].size()) != count) throw py::value_error("columns of different lengths");
    axis.quantities[q].values.assign(columns[q].data(), columns[q].data() + count);
  }
  return sweep;
}

py::dict solve_columns(const std::string& study, const Design<double>& base,
                       const std::vector<py::array_t<double>>& columns, std::size_t count, const std::string& condition,
                       int threads, const py::object& progress) {
  const Sweep sweep = sweep_of_columns(study, base, columns, count, condition);
  SweepColumns found = watched(progress, [&](Watch& watch) {
    return solve_sweep(sweep, threads, [&watch](const SweepProgress& now) { watch.report(now); });
  });
  py::list numbers;
  for (std::vector<double>& metric : found.metrics) numbers.append(array_of(std::move(metric)));
  py::list kept;
  for (std::size_t m = 0; m < std::size_t(metric_count); ++m) {
    if (sweep.options.metrics[m]) kept.append(m);
  }
  py::dict result;
  result["status"] = array_of(std::move(found.status));
  result["recomputed"] = array_of(std::move(found.recomputed));
  result["domain"] = array_of(std::move(found.domain));
  result["error_estimate"] = array_of(std::move(found.error_estimate));
  result["metrics"] = numbers;
  result["kept"] = kept;
  return result;
}

/// Derivatives [row][metric][key] of those rows.
py::array_t<double> gradient_of_columns(const std::string& study, const Design<double>& base,
                                        const std::vector<py::array_t<double>>& columns, std::size_t count,
                                        const std::string& condition, int threads, const py::object& progress,
                                        const std::vector<std::uint64_t>& rows, const std::vector<int>& metrics,
                                        const std::vector<std::string>& keys) {
  const Sweep sweep = sweep_of_columns(study, base, columns, count, condition);
  std::vector<Metric> wanted;
  for (const int m : metrics) wanted.push_back(Metric(m));
  std::vector<DesignParameter> parameters;
  for (const std::string& key : keys) parameters.push_back(design_parameter(key));
  std::vector<double> found = watched(progress, [&](Watch& watch) {
    return sweep_gradients(
        sweep, rows, wanted, parameters, start_up_in_time(), side_by_side(threads),
        [&](double share) { watch.report({rows.size(), std::uint64_t(std::lround(share * double(rows.size())))}); });
  });
  return array_of(std::move(found)).reshape({rows.size(), metrics.size(), keys.size()});
}

/// Computes the data set of a study on that vehicle.
void write_sweep(const std::string& study, const Design<double>& vehicle, const std::string& output, int threads,
                 bool force, const py::object& progress) {
  forget_files();
  silence_hdf5();  // here xarray will open the file
  watched(progress, [&](Watch& watch) {
    silence_hdf5();
    const Study parsed =
        parse_study({.study_name = "sweep", .study = study, .vehicle = write_design(vehicle), .design = vehicle});
    SweepRunOptions options;
    options.output = output;
    options.version = WINGBEAT_VERSION;
    options.threads = threads;
    options.force = force;
    options.progress = [&watch](const SweepProgress& now) { watch.report(now); };
    return run_sweep(parsed, options);
  });
}

// ---- studies

py::dict endurance(Design<double> design, bool hover, bool allow_extrapolation) {
  if (!has_battery(design.supply.type)) {
    throw ParameterError("supply.type", "only a battery runs down; expected battery or battery-sine");
  }
  if (hover) {
    if (!design.mass) throw ParameterError("vehicle.mass", "is the weight to be carried, which hover needs");
    design.supply.throttle = Throttle::hover;
  }
  EnduranceOptions options;
  options.allow_extrapolation = allow_extrapolation;
  const EnduranceResult found = listening([&] { return simulate_discharge(design, options); });
  py::dict result = reported(detail::endurance_tree(found), text_endurance(design, found));
  const auto column = [&](const auto& value) {
    std::vector<double> numbers;
    numbers.reserve(found.rows.size());
    for (const EnduranceRow& row : found.rows) numbers.push_back(value(row));
    return array_of(std::move(numbers));
  };
  result["time"] = column([](const EnduranceRow& row) { return row.time; });
  result["charge"] = column([](const EnduranceRow& row) { return row.charge; });
  py::list metrics;
  for (int m = 0; m < metric_count; ++m) {
    metrics.append(column([m](const EnduranceRow& row) { return row.metrics[Metric(m)]; }));
  }
  result["metrics"] = metrics;
  return result;
}

py::dict identify(const std::string& file, std::optional<double> frequency, bool assume_steel_cylinder,
                  bool assume_typical_damping, const std::string& shaft) {
  forget_files();
  const Shaft stated = choice<Shaft>("shaft", shaft);
  MotorDatasheet sheet = read_datasheet(find_input(file, InputKind::datasheet));
  sheet.assume_steel_cylinder |= assume_steel_cylinder;
  sheet.assume_typical_damping |= assume_typical_damping;
  const MotorIdentification found = listening([&] { return identify_motor(sheet, frequency); });
  py::dict result = reported(detail::identification_tree(found, sheet), text_identification(found, sheet));
  result["motor"] =
      has_motor_section(found, sheet)
          ? py::object(py::str(motor_section(found, sheet, "Identified by wingbeat " WINGBEAT_VERSION, stated)))
          : py::none();
  return result;
}

py::dict fit(const std::string& file, const std::vector<std::string>& overrides, bool profiles,
             bool compare_friction_laws, int threads) {
  forget_files();
  BenchFit bench = read_bench(find_input(file, InputKind::bench), overrides);
  bench.profiles = profiles;
  FitResult found;
  std::vector<FrictionCandidate> candidates;
  watched(py::none(), [&](const Watch&) {
    const ForEach for_each = side_by_side(threads);
    found = fit_bench(bench, {}, for_each);
    if (compare_friction_laws) candidates = compare_friction(bench, design_parameter, {}, for_each);
    return true;
  });
  py::dict result = reported(detail::fit_tree(bench, found, candidates),
                             text_fit(bench, found) + (candidates.empty() ? "" : text_friction(candidates)));
  result["design"] = found.misfit ? py::none() : py::cast(found.design);
  return result;
}

py::dict tolerance(const std::string& file, const std::vector<std::string>& overrides, bool allow_extrapolation,
                   int threads, const py::object& progress) {
  forget_files();
  ToleranceStudy study = read_tolerance_study(find_input(file, InputKind::study), overrides);
  study.allow_extrapolation |= allow_extrapolation;
  const ToleranceResult found = watched(progress, [&](Watch& watch) {
    const SweepColumns columns =
        solve_sweep(tolerance_sweep(study), threads, [&watch](const SweepProgress& now) { watch.report(now); });
    return assess_tolerance(study, columns, start_up_in_time());
  });
  return reported(detail::tolerance_tree(study, found), text_tolerance(study, found));
}

py::dict tolerance_of_flight(const std::string& file, const std::vector<std::string>& overrides, double speed,
                             int threads, const py::object& progress) {
  forget_files();
  const ToleranceStudy study = read_tolerance_study(find_input(file, InputKind::study), overrides);
  const FlightCondition condition{speed};
  const FlightToleranceResult found = watched(progress, [&](Watch& watch) {
    SweepProgress now{.designs = study.count};
    return flight_tolerance(study, condition, side_by_side(threads), [&](double share) {
      now.done = std::uint64_t(std::llround(share * double(study.count)));
      watch.report(now);
    });
  });
  return reported(detail::Json::parse(json_flight_tolerance(study, condition, found)),
                  text_flight_tolerance(study, condition, found));
}

py::dict linearise(const Design<double>& design, const std::string& condition, std::optional<double> frequency,
                   std::optional<double> lift, bool allow_extrapolation, int cycles, double hinge_offset, bool maps) {
  ControlOptions options;
  options.operating_point.condition = choice<Condition>("condition", condition);
  options.operating_point.frequency = frequency;
  options.operating_point.lift = lift;
  options.operating_point.allow_extrapolation = allow_extrapolation;
  options.step_cycles = cycles;
  options.hinge_offset = hinge_offset;
  options.allocation_maps = maps;
  const ControlModels found = listening([&] { return control_models(design, options); });
  return reported(detail::control_tree(found, WINGBEAT_VERSION), text_control(found));
}

}  // namespace

void add_studies(py::module_& m) {
  m.def("solve_columns", &solve_columns);
  m.def("gradient_of_columns", &gradient_of_columns);
  m.def("sweep", &write_sweep);
  m.def("endurance", &endurance);
  m.def("identify_motor", &identify);
  m.def("fit", &fit);
  m.def("tolerance", &tolerance);
  m.def("flight_tolerance", &tolerance_of_flight);
  m.def("linearise", &linearise);
}

}  // namespace wingbeat::python
