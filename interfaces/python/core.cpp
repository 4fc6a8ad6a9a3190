// The compiled half of the Python package: the door of the library for Python. Nothing is computed here.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/files/bench_file.hpp"
#include "wingbeat/files/datasheet_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/files/file_record.hpp"
#include "wingbeat/files/netcdf.hpp"
#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/files/tolerance_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/files/waveform_file.hpp"
#include "wingbeat/report/endurance_report.hpp"
#include "wingbeat/report/fit_report.hpp"
#include "wingbeat/report/identification_report.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/report/tolerance_report.hpp"
#include "wingbeat/run/parallel.hpp"
#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/vehicle/parameters.hpp"
#include "wingbeat/wingbeat.hpp"

namespace py = pybind11;

namespace wingbeat::python {
namespace {

// ---- errors

/// `wingbeat.InputError` with what the library's error knows.
py::object python_error(const InputError& error) {
  const py::object made = py::module_::import("wingbeat._errors").attr("InputError")(error.what());
  if (!error.file().empty()) made.attr("file") = error.file();
  if (error.line() > 0) {
    made.attr("line") = error.line();
    made.attr("column") = error.column();
  }
  made.attr("key") = error.key();
  py::list others;
  for (const InputError& other : error.others()) others.append(python_error(other));
  made.attr("others") = others;
  return made;
}

void raise(const py::object& error) { PyErr_SetObject(py::type::of(error).ptr(), error.ptr()); }

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    raise(python_error(error));
  } catch (const ParameterError& error) {
    raise(python_error(InputError("", 0, 0, error.key(), error.reason())));
  }
}

// ---- arrays

/// The numbers as an array that owns them.
template <class T>
py::array_t<T> array_of(std::vector<T>&& numbers) {
  auto* kept = new std::vector<T>(std::move(numbers));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(py::ssize_t(kept->size()), kept->data(), owner);
}

template <std::size_t N>
py::array_t<double> array_of(const std::array<double, N>& numbers) {
  return py::array_t<double>(py::ssize_t(N), numbers.data());
}

// ---- long calls

/// Thrown by a callback where the user has interrupted.
struct Interrupted {};

/// What the thread that computes and the one that listens to Python share.
class Watch {
 public:
  void report(const SweepProgress& progress) {
    if (stop_) throw Interrupted();
    note(progress);
  }
  void note(const SweepProgress& progress) {
    const std::lock_guard<std::mutex> lock(mutex_);
    progress_ = progress;
  }
  SweepProgress progress() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return progress_;
  }
  void stop() { stop_ = true; }
  bool stopped() const { return stop_; }

 private:
  mutable std::mutex mutex_;
  SweepProgress progress_;
  std::atomic<bool> stop_ = false;
};

/// Does `work(watch)` on another thread, without the GIL. Meanwhile signals reach Python, and `progress(done,
/// designs)`, unless it is None, is called now and then. Where a signal handler or `progress` raises, `work` is told to
/// stop, and the exception goes on once it has.
template <class Work>
auto watched(const py::object& progress, const Work& work) {
  using namespace std::chrono_literals;
  Watch watch;
  std::optional<py::error_already_set> raised;
  std::uint64_t told = 0;
  auto found = std::async(std::launch::async, [&] { return work(watch); });
  while (true) {
    {
      const py::gil_scoped_release others;
      if (found.wait_for(50ms) == std::future_status::ready) break;
    }
    if (raised) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      const SweepProgress now = watch.progress();
      if (!progress.is_none() && now.done != told) progress(told = now.done, now.designs);
    } catch (py::error_already_set& error) {
      raised.emplace(error);
      watch.stop();
    }
  }
  if (raised) {
    try {
      found.get();
    } catch (const Interrupted&) {}
    throw py::error_already_set(*raised);
  }
  return found.get();
}

// ---- vehicles and tables

/// A process of Python runs many commands: what an earlier one read or wrote does not bind a later one.
void forget_files() { FileRecord::of_this_program().clear(); }

Design<double> read(const std::string& file) {
  forget_files();
  return read_design(file);
}

Design<double> parse(const std::string& text, const std::string& name) { return parse_design(text, name); }

Design<double> with(const std::vector<std::string>& assignments, const Design<double>* base) {
  forget_files();
  return design_with(assignments, base);
}

const Parameter<double>& parameter(std::string_view path) {
  if (const Parameter<double>* found = find_parameter<double>(path)) return *found;
  throw ParameterError(std::string(path), unknown_key_message(path));
}

/// A number [SI], a text, True or False, or None where the design does not have it.
py::object value_of(const Design<double>& design, std::string_view path) {
  const Parameter<double>& key = parameter(path);
  if (key.get) {
    const std::optional<double> number = key.get(design);
    return number ? py::object(py::float_(*number)) : py::object(py::none());
  }
  const std::string text = key.text ? key.text(design) : std::string();
  if (text.empty()) return py::none();
  if (key.range.text == "true or false") return py::bool_(text == "true");
  return py::str(text);
}

py::list parameters() {
  py::list rows;
  for (const ParameterText& p : parameter_table<double>()) {
    rows.append(py::make_tuple(p.path, p.unit, p.range.text, default_text(p), p.meaning, p.only_with,
                               py::tuple(py::cast(alternatives_of(p))), p.example));
  }
  return rows;
}

template <class Rows>
py::list described(const Rows& table) {
  py::list rows;
  for (const auto& row : table) {
    std::string_view key;
    if constexpr (requires { row.key; }) key = row.key;
    else key = row.name;
    rows.append(py::make_tuple(key, name_without_unit(key, row.unit), row.unit, row.long_name));
  }
  return rows;
}

double quantity(const std::string& name, const py::object& value, const std::string& unit) {
  if (!py::isinstance<py::str>(value)) {
    try {
      return value.cast<double>();
    } catch (const py::cast_error&) {
      throw InputError("", 0, 0, name,
                       "expected " + quantity_example(unit) + ", got " + one_line(std::string(py::repr(value))));
    }
  }
  try {
    return parse_quantity(value.cast<std::string>(), unit);
  } catch (const UnitError& error) {
    throw InputError("", 0, 0, name, error.what());
  }
}

template <NamedEnum E>
E choice(const char* name, const std::string& text) {
  if (const auto value = from_name<E>(text)) return *value;
  throw InputError("", 0, 0, name, "must be " + std::string(listed_names<E>()) + ", got " + in_quotes(text));
}

void require_tolerance(double tolerance) {
  if (tolerance >= 1e-12 && tolerance <= 1e-2) return;
  throw InputError("", 0, 0, "tolerance", "must be a number between 1e-12 and 1e-2");
}

// ---- one vehicle

/// The columns of a cycle, in the order of waveform_columns().
py::list columns_of(const std::vector<WaveformRow>& rows) {
  py::list columns;
  for (const WaveformColumn& column : waveform_columns(rows)) {
    std::vector<double> numbers;
    numbers.reserve(rows.size());
    for (const WaveformRow& row : rows) numbers.push_back(row.*column.value);
    columns.append(array_of(std::move(numbers)));
  }
  return columns;
}

/// A search that ended short of its aim is no flapping of the kind asked for.
bool unreached(const RunResult& result) {
  return result.search && result.search->outcome != FrequencyOutcome::reached &&
         result.status == FlappingStatus::flapping;
}

py::dict run(const Design<double>& design, const std::string& condition, const std::string& method, double tolerance,
             std::optional<double> frequency, std::optional<double> lift, bool allow_extrapolation, int points,
             bool endurance) {
  RunOptions options;
  options.condition = choice<Condition>("condition", condition);
  options.method = choice<Method>("method", method);
  require_tolerance(options.tolerance = tolerance);
  options.frequency = frequency;
  options.lift = lift;
  options.allow_extrapolation = allow_extrapolation;
  options.waveform_rows = points;
  options.endurance = endurance;
  RunResult found;
  {
    const py::gil_scoped_release others;
    found = solve(design, options);
  }
  py::dict result;
  result["status"] = unreached(found) ? name_of(SweepStatus::unreached) : name_of(found.status);
  result["evidence"] = describe(found);
  result["settled"] = found.settled;
  result["domain"] = name_of(found.domain);
  result["metrics"] = array_of(found.metrics.values);
  if (points > 0) result["cycle"] = columns_of(found.cycle);
  result["design"] = std::move(found.design);
  return result;
}

/// The members of EnergyAudit in their order [W], of metrics in the order of the table.
py::tuple balance(const py::array_t<double>& values) {
  Metrics<double> metrics;
  if (values.size() != py::ssize_t(metric_count)) throw py::value_error("expected a number for each metric");
  std::copy_n(values.data(), metric_count, metrics.values.begin());
  const EnergyAudit a = energy_audit(metrics);
  return py::make_tuple(a.electrical, a.copper, a.viscous, a.gear, a.friction, a.hinge, a.aerodynamic, a.residual,
                        a.imbalance);
}

py::dict differentiate(const Design<double>& design, const std::vector<std::string>& keys, const std::string& condition,
                       double tolerance, std::optional<double> frequency, bool endurance) {
  DesignPointOptions options;
  options.condition = choice<Condition>("condition", condition);
  require_tolerance(options.tolerance = tolerance);
  options.frequency = frequency;
  options.endurance = endurance;
  DesignPoint found;
  {
    const py::gil_scoped_release others;
    found = gradient(design, keys, options);
  }
  py::array_t<double> slopes({keys.size(), std::size_t(metric_count)});
  for (std::size_t k = 0; k < keys.size(); ++k) {
    for (std::size_t m = 0; m < std::size_t(metric_count); ++m) {
      slopes.mutable_at(k, m) = found.gradients.empty() ? absent : found.gradients[k][m];
    }
  }
  py::dict result;
  result["status"] = name_of(found.status);
  result["evidence"] = describe(found);
  result["metrics"] = array_of(found.metrics.values);
  result["gradients"] = slopes;
  return result;
}

py::dict start_up(const Design<double>& design, const std::string& condition, double tolerance, double max_time,
                  double crank_angle, double crank_speed, double current, double record_interval) {
  TransientOptions options;
  const Condition environment = choice<Condition>("condition", condition);
  options.tolerance = tolerance;
  options.max_time = max_time;
  options.crank_angle = crank_angle;
  options.crank_speed = crank_speed;
  options.current = current;
  options.record = true;
  options.record_interval = record_interval;
  TransientResult found = watched(py::none(), [&](const Watch& watch) {
    options.cancel = [&watch] { return watch.stopped(); };
    return simulate(design, options, environment);
  });
  const auto column = [&](double TransientSample::* member) {
    std::vector<double> numbers;
    numbers.reserve(found.samples.size());
    for (const TransientSample& sample : found.samples) numbers.push_back(sample.*member);
    return array_of(std::move(numbers));
  };
  py::list events;
  for (const TransientEvent& event : found.events) {
    events.append(py::make_tuple(event.time, event.crank_angle, name_of(event.kind)));
  }
  py::dict result;
  result["status"] = name_of(found.status);
  result["evidence"] = describe(found.evidence);
  result["settled"] = found.settled;
  result["end_time"] = found.end_time;
  result["time_to_steady"] = found.time_to_steady;
  result["inrush_current"] = found.inrush_current;
  result["inrush_current_time"] = found.inrush_current_time;
  result["cycles"] = found.cycles;
  Metrics<double> none;
  none.values.fill(absent);
  result["metrics"] = array_of(found.metrics.value_or(none).values);
  result["samples"] = py::make_tuple(column(&TransientSample::time), column(&TransientSample::crank_angle),
                                     column(&TransientSample::crank_speed), column(&TransientSample::current));
  result["events"] = events;
  return result;
}

// ---- equations of motion

/// Derivatives of states in rows, one column or many.
py::array_t<double> rates(const EquationsOfMotion& equations, double time,
                          const py::array_t<double, py::array::c_style | py::array::forcecast>& state,
                          std::optional<double> voltage) {
  const std::size_t rows = equations.state_count();
  if (state.ndim() < 1 || state.ndim() > 2 || std::size_t(state.shape(0)) != rows) {
    throw py::value_error("expected a state of " + std::to_string(rows) + " numbers, or an array with as many rows");
  }
  py::array_t<double> derivatives(std::vector<py::ssize_t>(state.shape(), state.shape() + state.ndim()));
  if (state.ndim() == 1) {
    equations.rates(time, state.data(), derivatives.mutable_data(), voltage);
    return derivatives;
  }
  const auto from = state.unchecked<2>();
  auto to = derivatives.mutable_unchecked<2>();
  std::array<double, 3> column, slopes;
  for (py::ssize_t n = 0; n < state.shape(1); ++n) {
    for (std::size_t r = 0; r < rows; ++r) column[r] = from(py::ssize_t(r), n);
    equations.rates(time, column.data(), slopes.data(), voltage);
    for (std::size_t r = 0; r < rows; ++r) to(py::ssize_t(r), n) = slopes[r];
  }
  return derivatives;
}

// ---- very many

StudyInput study_input(const std::string& name, const std::string& study, const Design<double>& vehicle) {
  StudyInput input;
  input.study_name = name;
  input.study = study;
  input.vehicle = write_design(vehicle);
  return input;
}

/// Solves a design for each row of the columns, which are in the order of the keys of the study's one axis. That study,
/// of a single design, is where the program's checks are made.
py::dict solve_columns(const std::string& study, const Design<double>& base,
                       const std::vector<py::array_t<double>>& columns, std::size_t count, const std::string& condition,
                       int threads, const py::object& progress) {
  Sweep sweep = parse_study(study_input("columns", study, base)).sweep;
  sweep.variants.at(0).condition = choice<Condition>("condition", condition);
  SweepAxis& axis = sweep.axes.at(0);
  if (sweep.axes.size() != 1 || axis.quantities.size() != columns.size()) throw py::value_error("one axis of columns");
  axis.count = count;
  axis.samples = true;
  for (std::size_t q = 0; q < columns.size(); ++q) {
    if (std::size_t(columns[q].size()) != count) throw py::value_error("columns of different lengths");
    axis.quantities[q].values.assign(columns[q].data(), columns[q].data() + count);
  }

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

/// Computes the data set of a study on that vehicle.
void write_sweep(const std::string& study, const Design<double>& vehicle, const std::string& output, int threads,
                 bool force, const py::object& progress) {
  forget_files();
  const Study parsed = parse_study(study_input("sweep", study, vehicle));
  silence_hdf5();  // here xarray will open the file
  watched(progress, [&](Watch& watch) {
    silence_hdf5();
    SweepRunOptions options;
    options.output = output;
    options.version = WINGBEAT_VERSION;
    options.threads = threads;
    options.force = force;
    options.progress = [&watch](const SweepProgress& now) { watch.note(now); };
    options.stop = [&watch] { return watch.stopped(); };
    return run_sweep(parsed, options);
  });
}

// ---- studies

/// What a study found, as `--json` and as the program's readable report.
py::dict told(const std::string& json, const std::string& text) {
  py::dict result;
  result["json"] = json;
  result["text"] = text;
  return result;
}

py::dict endurance(const Design<double>& design, bool allow_extrapolation) {
  if (!has_battery(design.supply.type)) {
    throw ParameterError("supply.type", "only a battery runs down; expected battery or battery-sine");
  }
  EnduranceOptions options;
  options.allow_extrapolation = allow_extrapolation;
  EnduranceResult found;
  {
    const py::gil_scoped_release others;
    found = simulate_discharge(design, options);
  }
  py::dict result = told(json_endurance(found), text_endurance(design, found));
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
  MotorDatasheet sheet = read_datasheet(file);
  sheet.assume_steel_cylinder |= assume_steel_cylinder;
  sheet.assume_typical_damping |= assume_typical_damping;
  const MotorIdentification found = identify_motor(sheet, frequency);
  py::dict result = told(json_identification(found, sheet), text_identification(found, sheet));
  result["motor"] =
      found.complete()
          ? py::object(py::str(motor_section(found, sheet, "Identified by wingbeat " WINGBEAT_VERSION, stated)))
          : py::none();
  return result;
}

py::dict fit(const std::string& file, const std::vector<std::string>& overrides, bool profiles,
             bool compare_friction_laws) {
  forget_files();
  BenchFit bench = read_bench(file, overrides);
  bench.profiles = profiles;
  FitResult found;
  std::vector<FrictionCandidate> candidates;
  watched(py::none(), [&](const Watch&) {
    found = fit_bench(bench, {});
    if (compare_friction_laws) candidates = compare_friction(bench, design_parameter, {});
    return true;
  });
  py::dict result = told(json_fit(bench, found, candidates),
                         text_fit(bench, found) + (candidates.empty() ? "" : text_friction(candidates)));
  result["design"] = found.misfit ? py::none() : py::cast(found.design);
  return result;
}

py::dict tolerance(const std::string& file, const std::vector<std::string>& overrides, bool allow_extrapolation,
                   int threads, const py::object& progress) {
  forget_files();
  ToleranceStudy study = read_tolerance_study(file, overrides);
  study.allow_extrapolation |= allow_extrapolation;
  const ToleranceResult found = watched(progress, [&](Watch& watch) {
    const SweepColumns columns =
        solve_sweep(tolerance_sweep(study), threads, [&watch](const SweepProgress& now) { watch.report(now); });
    return assess_tolerance(study, columns, start_up_in_time());
  });
  return told(json_tolerance(study, found), text_tolerance(study, found));
}

/// Of one objective.
py::dict find_optimum(const std::string& file, const std::vector<std::string>& overrides, bool allow_extrapolation,
                      int threads) {
  forget_files();
  OptimiseFile study = read_optimise_study(file, overrides);
  if (!study.objectives.empty()) {
    throw InputError(file, 0, 0, "objective", "several objectives give a front: wingbeat optimise computes it");
  }
  study.study.allow_extrapolation |= allow_extrapolation;
  std::vector<MotorTrial> trials = trials_of(study);
  watched(py::none(), [&](const Watch& watch) {
    const ForEach for_each = [&](std::size_t count, const std::function<void(std::size_t)>& act) {
      const auto unless_stopped = [&](std::size_t n) {
        if (watch.stopped()) throw Interrupted();
        act(n);
      };
      for_each_in_parallel(count, unless_stopped, threads);
    };
    for (MotorTrial& trial : trials) {
      if (!trial.refused()) trial.result = optimise(trial_study(study, trial), start_up_in_time(), for_each);
    }
    return true;
  });
  const MotorTrial* best = best_trial(study, trials);
  const bool single = trials.size() == 1 && !trials[0].motor;
  py::dict result = single ? told(json_optimum(study, trials[0].result), text_optimum(study, trials[0].result))
                           : told(json_motors(study, trials), text_motors(study, trials));
  result["design"] = best ? py::cast(best->result.design) : py::none();
  return result;
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  using namespace py::literals;
  py::register_exception_translator(translate);
  m.attr("version") = WINGBEAT_VERSION;

  py::class_<Design<double>>(m, "Design").def("value", &value_of).def("to_toml", &write_design);
  m.def("read", &read);
  m.def("parse", &parse);
  m.def("with_values", &with, "assignments"_a, "base"_a.none(true));
  m.def("parameters", &parameters);
  m.def("metrics", [] { return described(metric_table()); });
  m.def("waveforms", [] { return described(waveform_columns()); });
  m.def("statuses", [] {
    py::list names;
    for (int s = 0; s < sweep_status_count; ++s) names.append(name_of(SweepStatus(s)));
    return names;
  });
  m.def("domain_name", [](int bits) { return name_of(DomainStatus(std::uint64_t(bits))); });
  m.def("quantity", &quantity);
  m.def("run", &run, "design"_a, "condition"_a, "method"_a, "tolerance"_a, "frequency"_a, "lift"_a,
        "allow_extrapolation"_a, "points"_a, "endurance"_a);
  m.def("gradient", &differentiate, "design"_a, "keys"_a, "condition"_a, "tolerance"_a, "frequency"_a, "endurance"_a);
  m.def("energy_balance", &balance);
  m.def("simulate", &start_up);
  py::class_<EquationsOfMotion>(m, "EquationsOfMotion")
      .def(py::init([](const Design<double>& design, const std::string& condition) {
        return EquationsOfMotion(design, choice<Condition>("condition", condition));
      }))
      .def("state_names", &EquationsOfMotion::state_names)
      .def("rates", &rates);
  m.def("solve_columns", &solve_columns);
  m.def("sweep", &write_sweep);
  m.def("endurance", &endurance);
  m.def("identify_motor", &identify);
  m.def("fit", &fit);
  m.def("tolerance", &tolerance);
  m.def("optimise", &find_optimum);
}

}  // namespace wingbeat::python
