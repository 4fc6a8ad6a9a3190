// The compiled half of the Python package: the facade of the library for Python. Nothing is computed here.
//
// A vehicle is an immutable value, because computations run without the GIL. Every call that computes listens to
// signals (listening); one that computes on several threads does so on a thread of its own, while the calling one
// listens to signals and to the user's progress function (watched). What a signal handler raises stops the computation
// by Cancellation. Functions of the user come back into Python from the search of optimise_own, which takes the GIL for
// them. Arguments are checked in _arguments.py.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "binding.hpp"
#include "facade/design_values.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/waveform_file.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/vehicle/parameters.hpp"

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

// ---- vehicles and tables

Design<double> read(const std::string& file) {
  forget_files();
  return read_design(find_input(file, InputKind::vehicle).string());
}

Design<double> parse(const std::string& text, const std::string& name) { return parse_design(text, name); }

/// A number, True, False, a text, a list or a dict, as _vehicle.py gives them.
TomlNode node_of(const py::handle& value) {
  TomlNode node;
  if (py::isinstance<py::bool_>(value)) {
    node.kind = TomlNode::Kind::boolean;
    node.number = value.cast<bool>() ? 1.0 : 0.0;
  } else if (py::isinstance<py::float_>(value) || py::isinstance<py::int_>(value)) {
    node.kind = TomlNode::Kind::number;
    node.number = value.cast<double>();
    node.whole = py::isinstance<py::int_>(value);
  } else if (py::isinstance<py::str>(value)) {
    node.kind = TomlNode::Kind::text;
    node.text = value.cast<std::string>();
  } else if (py::isinstance<py::dict>(value)) {
    node.kind = TomlNode::Kind::table;
    for (const auto& [key, member] : value.cast<py::dict>()) {
      node.members.push_back({key.cast<std::string>(), node_of(member)});
    }
  } else {
    node.kind = TomlNode::Kind::array;
    for (const py::handle item : value.cast<py::list>()) node.items.push_back(node_of(item));
  }
  return node;
}

Design<double> with(const py::dict& values, const Design<double>* base) {
  forget_files();
  std::vector<Setting> settings;
  for (const auto& [key, value] : values) {
    settings.push_back({key.cast<std::string>(), node_of(value), {"values", 0, 0, true}});
  }
  return design_with(settings, base);
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

double quantity(const std::string& name, const std::string& text, const std::string& unit) {
  try {
    return parse_quantity(text, unit);
  } catch (const UnitError& error) {
    throw InputError("", 0, 0, name, error.what());
  }
}

void require_tolerance(double tolerance) {
  if (tolerance >= 1e-12 && tolerance <= 1e-2) return;
  throw InputError("", 0, 0, "tolerance", "must be a number between 1e-12 and 1e-2");
}

// ---- one vehicle

/// The mechanism as SVG; empty where it cannot be drawn.
std::string mechanism_svg(const Design<double>& design, double stroke_amplitude) {
  try {
    return drawn_mechanism(design, stroke_amplitude, PlotFormat::svg);
  } catch (const std::runtime_error&) {
    return {};
  }
}

/// A search that ended short of its aim is no flapping of the kind asked for.
bool unreached(const RunResult& result) {
  return result.search && result.search->outcome != FrequencyOutcome::reached &&
         result.status == FlappingStatus::flapping;
}

py::dict run(const Design<double>& design, const std::string& condition, const std::string& method, double tolerance,
             std::optional<double> frequency, std::optional<double> lift, std::optional<double> lift_to_weight,
             std::optional<double> power, bool allow_extrapolation, int points, bool endurance,
             std::optional<double> angle_of_attack) {
  RunOptions options;
  options.condition = choice<Condition>("condition", condition);
  options.method = choice<Method>("method", method);
  require_tolerance(options.tolerance = tolerance);
  options.frequency = frequency;
  options.lift = lift;
  options.power = power;
  options.angle_of_attack = angle_of_attack;
  if (lift_to_weight) {
    require(*lift_to_weight > 0.0, "lift_to_weight", "must be > 0", "1", *lift_to_weight);
    const Reporting reporting = reporting_of(design);
    if (std::isnan(reporting.mass))
      throw ParameterError("lift_to_weight", "needs vehicle.mass, which the vehicle does not give");
    options.lift = held_lift({Held::lift_to_weight, *lift_to_weight}, reporting);
  }
  options.allow_extrapolation = allow_extrapolation;
  options.waveform_rows = points;
  options.endurance = endurance;
  RunResult found = listening([&] { return solve(design, options); });
  py::dict result = outcome_of(found);
  if (points > 0) result["cycle"] = columns_of(found.cycle);
  result["design"] = std::move(found.design);
  return result;
}

/// The members of EnergyAudit by name [W], of metrics in the order of the table.
py::dict balance(const py::array_t<double>& values) {
  Metrics<double> metrics;
  if (values.size() != py::ssize_t(metric_count)) throw py::value_error("expected a number for each metric");
  std::copy_n(values.data(), metric_count, metrics.values.begin());
  const EnergyAudit a = energy_audit(metrics);
  using namespace py::literals;
  return py::dict("electrical"_a = a.electrical, "copper"_a = a.copper, "viscous"_a = a.viscous,
                  "electronics"_a = a.electronics, "motor_friction"_a = a.motor_friction, "gear"_a = a.gear,
                  "friction"_a = a.friction, "hinge"_a = a.hinge, "aerodynamic"_a = a.aerodynamic,
                  "residual"_a = a.residual, "imbalance"_a = a.imbalance);
}

py::dict differentiate(const Design<double>& design, const std::vector<std::string>& keys, const std::string& condition,
                       double tolerance, const std::string& held, double held_value, bool allow_extrapolation,
                       bool endurance) {
  DesignPointOptions options;
  options.condition = choice<Condition>("condition", condition);
  require_tolerance(options.tolerance = tolerance);
  const SearchRange range = search_range(allow_extrapolation);
  if (held == "frequency") options.hold = Hold{Held::frequency, held_value};
  if (held == "lift") options.hold = Hold{Held::lift, held_value, range};
  if (held == "power") options.hold = Hold{Held::power, held_value};
  if (held == "lift_to_weight") options.hold = Hold{Held::lift_to_weight, held_value, range};
  options.flight = {endurance, endurance, false};
  const DesignPoint found = listening([&] { return gradient(design, keys, options); });
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
  options.start.angle = crank_angle;
  options.start.speed = crank_speed;
  options.start.current = current;
  options.record = true;
  options.record_interval = record_interval;
  const TransientResult found = listening([&] { return simulate(design, options, environment); });
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

}  // namespace

py::object object_of(const detail::Json& tree) {
  using Kind = detail::Json::value_t;
  switch (tree.type()) {
    case Kind::object: {
      py::dict object;
      for (const auto& [key, value] : tree.items()) object[py::str(key)] = object_of(value);
      return object;
    }
    case Kind::array: {
      py::list list;
      for (const detail::Json& value : tree) list.append(object_of(value));
      return list;
    }
    case Kind::string: {
      // Bytes of a user's file that are not UTF-8 are replaced, as in text.
      const auto& text = tree.get_ref<const std::string&>();
      return py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(text.data(), Py_ssize_t(text.size()), "replace"));
    }
    case Kind::boolean: return py::bool_(tree.get<bool>());
    case Kind::number_integer: return py::int_(tree.get<std::int64_t>());
    case Kind::number_unsigned: return py::int_(tree.get<std::uint64_t>());
    case Kind::number_float: {
      const double x = tree.get<double>();
      return std::isfinite(x) ? py::object(py::float_(x)) : py::object(py::none());
    }
    default: return py::none();
  }
}

py::dict outcome_of(const RunResult& found) {
  py::dict result;
  result["status"] = unreached(found) ? name_of(SweepStatus::unreached) : name_of(found.status);
  result["evidence"] = describe(found);
  result["settled"] = found.settled;
  result["domain"] = name_of(found.domain);
  result["domain_detail"] =
      found.domain_evidence.empty() ? py::object(py::none()) : py::object(py::str(describe(found.domain_evidence)));
  result["warnings"] = warnings_of(found);
  result["metrics"] = array_of(found.metrics.values);
  return result;
}

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

PYBIND11_MODULE(_core, m) {
  using namespace py::literals;
  py::register_exception_translator(translate);
  m.attr("version") = WINGBEAT_VERSION;

  py::class_<Design<double>>(m, "Design").def("value", &value_of).def("to_toml", &write_design);
  m.def("set_shipped_data", [](const std::string& folder) { set_shipped_data(folder); });
  m.def("shipped_names", [](const std::string& kind) { return shipped_names(choice<InputKind>("kind", kind)); });
  m.def("read", &read);
  m.def("parse", &parse);
  m.def("with_values", &with, "values"_a, "base"_a.none(true));
  m.def("toml", [](const py::object& value) { return toml_value(node_of(value)); });
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
  m.def("quantity_example", [](const std::string& unit) { return quantity_example(unit); });
  m.def("run", &run, "design"_a, "condition"_a, "method"_a, "tolerance"_a, "frequency"_a, "lift"_a, "lift_to_weight"_a,
        "power"_a, "allow_extrapolation"_a, "points"_a, "endurance"_a, "angle_of_attack"_a = py::none());
  m.def("gradient", &differentiate, "design"_a, "keys"_a, "condition"_a, "tolerance"_a, "held"_a, "held_value"_a,
        "allow_extrapolation"_a, "endurance"_a);
  m.def("mechanism_svg", &mechanism_svg, "design"_a, "stroke_amplitude"_a, py::call_guard<Left>());
  m.def("energy_balance", &balance);
  m.def("simulate", &start_up);
  add_motion(m);
  add_flight(m);
  add_parts(m);
  add_studies(m);
  add_optima(m);
}

}  // namespace wingbeat::python
