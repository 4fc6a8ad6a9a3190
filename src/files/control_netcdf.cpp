// Control models as NetCDF-4.
#include <span>
#include <vector>

#include "wingbeat/files/control_file.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace wingbeat {
namespace {

using Dimension = NetcdfFile::Dimension;

void put_numbers(NetcdfFile& data, const std::string& name, const std::vector<Dimension>& over, const std::string& unit,
                 const std::string& meaning, const std::vector<double>& values) {
  data.write(data.define_variable(name, over, unit, meaning), values);
}

void put_matrix(NetcdfFile& data, const std::string& name, Dimension rows, Dimension columns,
                const std::string& meaning, const Eigen::MatrixXd& m) {
  if (m.size() == 0) return;
  std::vector<double> values;
  for (const auto& row : m.rowwise()) values.insert(values.end(), row.begin(), row.end());
  put_numbers(data, name, {rows, columns}, "1", meaning, values);
}

/// A dimension with names, units and values along it.
Dimension put_signals(NetcdfFile& data, const std::string& name, const std::vector<CycleSignal>& signals) {
  std::vector<std::string> names, units;
  std::vector<double> values;
  for (const CycleSignal& s : signals) names.push_back(s.name), units.push_back(s.unit), values.push_back(s.value);
  const Dimension dimension = data.define_dimension(name, signals.size());
  data.define_texts(name, dimension, names, "name");
  data.define_texts(name + "_unit", dimension, units, "SI unit");
  put_numbers(data, name + "_value", {dimension}, "1", "on the orbit, in its SI unit", values);
  return dimension;
}

/// A copy of the names, for the second dimension of a square matrix.
Dimension put_copy(NetcdfFile& data, const std::string& name, const std::vector<CycleSignal>& signals) {
  std::vector<std::string> names;
  for (const CycleSignal& s : signals) names.push_back(s.name);
  const Dimension dimension = data.define_dimension(name, signals.size());
  data.define_texts(name, dimension, names, "name");
  return dimension;
}

Dimension put_names(NetcdfFile& data, const std::string& name, std::span<const char* const> names,
                    const std::string& meaning) {
  const Dimension dimension = data.define_dimension(name, names.size());
  data.define_texts(name, dimension, std::vector<std::string>(names.begin(), names.end()), meaning);
  return dimension;
}

}  // namespace

void write_control_netcdf(const ControlModels& models, const std::string& version, const std::filesystem::path& file) {
  const LinearModel& model = *models.linear.model;
  const CycleMap& map = model.map;
  const RunResult& operating_point = models.linear.operating_point;
  NetcdfFile data(file);
  write_provenance(data, {.title = "control models about steady flapping",
                          .command = "linearise",
                          .version = version,
                          .vehicle = write_design(operating_point.design),
                          .condition = name_of(models.options.operating_point.condition),
                          .domain = name_of(operating_point.domain),
                          .tolerance = models.options.operating_point.tolerance});
  put_numbers(data, "period", {}, "s", "time step of the cycle-to-cycle model", {map.period});
  const Dimension state = put_signals(data, "state", map.states), next = put_copy(data, "next_state", map.states);
  const Dimension input = put_signals(data, "input", map.inputs), output = put_signals(data, "output", map.outputs);
  const std::string per = " [SI unit per SI unit]";
  put_matrix(data, "A", next, state, "next state by state" + per, map.a);
  put_matrix(data, "B", next, input, "next state by input" + per, map.b);
  put_matrix(data, "C", output, state, "means of the cycle by state" + per, map.c);
  put_matrix(data, "D", output, input, "means of the cycle by input" + per, map.d);
  put_matrix(data, "steady_gain", output, input, "means by held inputs, once settled" + per, model.steady_gain);

  const Dimension mode = data.define_dimension("mode", model.modes.size());
  const auto modes = [&](const char* name, const char* unit, const char* meaning, const auto& value) {
    std::vector<double> values;
    for (const CycleMode& m : model.modes) values.push_back(value(m));
    put_numbers(data, name, {mode}, unit, meaning, values);
  };
  modes("multiplier_real", "1", "eigenvalue of A", [](const CycleMode& m) { return m.multiplier.real(); });
  modes("multiplier_imaginary", "1", "of a pair one stands for both",
        [](const CycleMode& m) { return m.multiplier.imag(); });
  modes("time_constant", "s", "in which the mode fades to 1/e", [](const CycleMode& m) { return m.time_constant; });
  modes("natural_frequency", "rad/s", "of its continuous-time equivalent",
        [](const CycleMode& m) { return m.natural_frequency; });
  modes("damping_ratio", "1", "of its continuous-time equivalent", [](const CycleMode& m) { return m.damping_ratio; });

  const ContinuousModel& c = model.continuous;
  if (!c.states.empty()) {
    const Dimension x = put_signals(data, "continuous_state", c.states);
    const Dimension rate = put_copy(data, "continuous_rate", c.states);
    put_matrix(data, "A_continuous", rate, x, "rate by state" + per, c.a);
    put_matrix(data, "B_continuous", rate, input, "rate by input" + per, c.b);
    put_matrix(data, "C_continuous", output, x, "means by state" + per, c.c);
  }
  put_matrix(data, "D_continuous", output, input, "means by input" + per, c.d);

  const auto cycles = std::size_t(model.step_responses.front().rows());
  const Dimension cycle = data.define_dimension("cycle", cycles);
  std::vector<double> steps;
  for (const Eigen::MatrixXd& response : model.step_responses) {
    for (const auto& row : response.rowwise()) steps.insert(steps.end(), row.begin(), row.end());
  }
  put_numbers(data, "step_response", {input, cycle, output}, "1", "means of cycles after a unit step of an input" + per,
              steps);

  if (models.body) {
    const Dimension load = put_names(data, "load", body_loads, "force [N] or moment [N m] on the body");
    const Dimension motion = put_names(data, "motion", body_motions, "velocity [m/s] or rate [rad/s] of the body");
    put_matrix(data, "body_derivative", load, motion, "cycle-averaged, in hover" + per, *models.body);
    put_numbers(data, "hinge_offset", {}, "m", "from the body's middle plane to a stroke axis",
                {models.options.hinge_offset});
  }
  for (const AllocationMap& m : models.maps) {
    const std::string name = name_of(m.input);
    const Dimension along = data.define_dimension(name, m.points.size());
    const auto column = [&](const std::string& variable, const char* unit, const char* meaning,
                            double AllocationPoint::* member) {
      std::vector<double> values;
      for (const AllocationPoint& p : m.points) values.push_back(p.*member);
      put_numbers(data, variable, {along}, unit, meaning, values);
    };
    column(name, unit_of(m.input), "commanded", &AllocationPoint::input);
    for (const AllocationColumn& c_of : allocation_columns) {
      column(std::string(c_of.name) + "_by_" + name, c_of.unit, c_of.meaning, c_of.member);
      const std::string unit = std::string(c_of.unit) + (unit_of(m.input) == std::string("V") ? " V-1" : "");
      for (const AllocationSlope& s : allocation_slopes) {
        const std::string variable = std::string(c_of.name) + "_" + s.name + "_by_" + name;
        put_numbers(data, variable, {}, s.of_input ? std::string(unit_of(m.input)) : unit,
                    std::string("slope of the ") + c_of.meaning + ", " + s.meaning, {(m.*s.member).*c_of.member});
      }
    }
  }
  data.close();
}

}  // namespace wingbeat
