#include "explored.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "answers.hpp"
#include "report/report_tools.hpp"
#include "wingbeat/files/waveform_file.hpp"
#include "wingbeat/parts/mechanism_pose.hpp"
#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/parameters.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::web {
namespace {

void keep_columns(std::span<const WaveformRow> rows, Columns& columns) {
  if (rows.empty()) return;
  for (const WaveformColumn& column : waveform_columns(rows)) {
    std::vector<double> numbers;
    numbers.reserve(rows.size());
    for (const WaveformRow& row : rows) numbers.push_back(row.*column.value);
    columns.emplace_back(column.name, std::move(numbers));
  }
}

}  // namespace

Json read_vehicle(const std::string& text, const std::string& name, const nlohmann::json& tables) {
  bool loaded = false;
  const Design<double> design = parse_design(text, name, {}, [&](const std::string& table) -> std::string {
    loaded = true;
    if (!tables.contains(table))
      throw InputError(table, 0, 0, "", "no such file; drop it together with the vehicle file");
    return tables[table];
  });
  return {{"toml", loaded ? write_design(design) : text}, {"name", design.name}};
}

Json values_of(const Design<double>& design) {
  Json values = Json::object();
  for (const Parameter<double>& key : parameter_table<double>()) {
    const std::string path(key.path);
    if (key.get) {
      if (const std::optional<double> number = key.get(design)) values[path] = detail::number_or_null(*number);
      continue;
    }
    const std::string text = key.text ? key.text(design) : std::string();
    if (!text.empty()) values[path] = key.range.text == "true or false" ? Json(text == "true") : Json(text);
  }
  return values;
}

RunOptions options_of(const nlohmann::json& options) {
  RunOptions run;
  const auto number = [&](const char* name) {
    return options.contains(name) && options[name].is_number() ? std::optional<double>(options[name]) : std::nullopt;
  };
  const std::string condition = options.value("condition", "air"), method = options.value("method", "orbit");
  run.condition = from_name<Condition>(condition).value_or(Condition::air);
  run.method = from_name<Method>(method).value_or(Method::orbit);
  run.tolerance = number("tolerance").value_or(run.tolerance);
  run.frequency = number("frequency");
  run.lift = number("lift");
  run.allow_extrapolation = options.value("allow_extrapolation", false);
  run.endurance = options.value("endurance", false);
  run.waveform_rows = options.value("rows", 0);
  return run;
}

Json solved(const Design<double>& design, const RunOptions& options, Columns& columns) {
  const RunResult result = solve(design, options);
  keep_columns(result.cycle, columns);
  return solved_answer(result);
}

Json started(const Design<double>& design, const RunOptions& options, Columns& columns) {
  TransientOptions transient;
  transient.tolerance = options.tolerance;
  transient.record = true;
  transient.metrics = false;
  const TransientResult result = simulate(design, transient, options.condition);
  const auto keep = [&](const char* name, double TransientSample::* member) {
    std::vector<double> numbers;
    numbers.reserve(result.samples.size());
    for (const TransientSample& sample : result.samples) numbers.push_back(sample.*member);
    columns.emplace_back(name, std::move(numbers));
  };
  keep("time_s", &TransientSample::time);
  keep("crank_angle_rad", &TransientSample::crank_angle);
  keep("crank_speed_rad_per_s", &TransientSample::crank_speed);
  keep("current_a", &TransientSample::current);
  return start_up_answer(result);
}

Json differentiated(const Design<double>& design, const std::vector<std::string>& keys, const RunOptions& options) {
  DesignPointOptions point;
  point.condition = options.condition;
  if (options.frequency) point.hold = Hold{Held::frequency, *options.frequency};
  point.tolerance = options.tolerance;
  const DesignPoint found = gradient(design, keys, point);
  Slopes slopes{name_of(found.status), describe(found), {}};
  for (std::size_t k = 0; k < keys.size(); ++k) {
    std::vector<double> by_metric(std::size_t(metric_count), absent);
    if (!found.gradients.empty()) by_metric.assign(found.gradients[k].begin(), found.gradients[k].end());
    slopes.by_key.emplace_back(keys[k], std::move(by_metric));
  }
  return slopes_answer(slopes);
}

Json mechanism_of(const Design<double>& design, const std::vector<double>& angles, Columns& columns) {
  const Vehicle<double> vehicle = resolve(with_any_pitch_coefficient(design), Condition::air);
  const AnyTransmission<double>& transmission = vehicle.transmission;
  const bool rotates = drive_of(vehicle).rotates;
  const double wing = drawn_wing_length(transmission);
  std::vector<double> stroke;
  std::vector<MechanismPose> poses;
  for (const double angle : angles) {
    stroke.push_back(rotates ? stroke_angle(crank_kinematics(transmission, std::sin(angle), std::cos(angle))) : angle);
    poses.push_back(pose_of(transmission, angle, stroke.back(), wing));
  }
  columns.emplace_back("stroke_angle_rad", std::move(stroke));
  for (std::size_t joint = 0; !poses.empty() && joint < poses.front().joints.size(); ++joint) {
    std::vector<double> x, y;
    for (const MechanismPose& pose : poses) {
      x.push_back(pose.joints[joint].position.x);
      y.push_back(pose.joints[joint].position.y);
    }
    const std::string name(poses.front().joints[joint].name);
    columns.emplace_back(name + "_x", std::move(x));
    columns.emplace_back(name + "_y", std::move(y));
  }
  return mechanism_answer(vehicle);
}

Json solved_together(const Design<double>& design, const std::vector<std::string>& keys,
                     const std::vector<double>& values, const RunOptions& options, Columns& columns) {
  std::vector<Design<double>> designs;
  std::vector<std::size_t> rows;
  const std::size_t count = keys.empty() ? 0 : values.size() / keys.size();
  for (std::size_t row = 0; row < count; ++row) {
    Design<double> one = design;
    try {
      for (std::size_t k = 0; k < keys.size(); ++k) set_parameter(one, keys[k], values[row * keys.size() + k]);
      validate(one);
    } catch (const ParameterError&) {
      continue;  // the status invalid
    }
    designs.push_back(std::move(one));
    rows.push_back(row);
  }
  EnsembleOptions ensemble;
  ensemble.tolerance = options.tolerance;
  const std::vector<EnsembleOutcome> outcomes = solve_ensemble(designs, ensemble, options.condition);

  std::vector<double> status(count, double(SweepStatus::invalid)), domain(count, 0.0);
  std::vector<std::vector<double>> metrics(std::size_t(metric_count), std::vector<double>(count, absent));
  for (std::size_t n = 0; n < outcomes.size(); ++n) {
    status[rows[n]] = double(sweep_status(outcomes[n].status));
    domain[rows[n]] = outcomes[n].domain.any() ? 1.0 : 0.0;
    for (std::size_t m = 0; m < metrics.size(); ++m) metrics[m][rows[n]] = outcomes[n].metrics.values[m];
  }
  columns.emplace_back("status", std::move(status));
  columns.emplace_back("domain", std::move(domain));
  for (std::size_t m = 0; m < metrics.size(); ++m) {
    columns.emplace_back(metric_table()[m].key, std::move(metrics[m]));
  }
  Json names = Json::array();
  for (int s = 0; s < sweep_status_count; ++s) names.push_back(name_of(SweepStatus(s)));
  return {{"statuses", std::move(names)}};
}

}  // namespace wingbeat::web
