#include "wingbeat/report/control_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "report/control_tree.hpp"
#include "wingbeat/files/toml_text.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

using detail::Json;

// ---- TOML

bool is_table(const Json& value) { return value.is_object(); }
bool is_tables(const Json& value) { return value.is_array() && !value.empty() && value.front().is_object(); }

std::string value_in_toml(const Json& value) {
  if (value.is_null()) return "nan";
  if (value.is_number_float()) {
    const std::string text = fmt::format("{}", value.get<double>());
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
  }
  if (value.is_string()) return toml_text(value.get<std::string>());
  if (!value.is_array()) return value.dump();
  std::string text = "[";
  for (const Json& x : value) text += fmt::format("{}{}", &x == &value.front() ? "" : ", ", value_in_toml(x));
  return text + "]";
}

void put_toml(const Json& table, const std::string& path, std::string& text) {
  for (const auto& [key, value] : table.items()) {
    if (!is_table(value) && !is_tables(value)) text += fmt::format("{} = {}\n", key, value_in_toml(value));
  }
  for (const auto& [key, value] : table.items()) {
    const std::string name = path.empty() ? key : fmt::format("{}.{}", path, key);
    if (is_table(value)) {
      text += fmt::format("\n[{}]\n", name);
      put_toml(value, name, text);
    }
    if (!is_tables(value)) continue;
    for (const Json& element : value) {
      text += fmt::format("\n[[{}]]\n", name);
      put_toml(element, name, text);
    }
  }
}

// ---- text

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.5g}", x) : std::string("-"); }

void put_matrix(std::string& text, const char* name, const Eigen::MatrixXd& m, const std::vector<std::string>& rows,
                const std::vector<std::string>& columns) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, "\n{:<22}", name);
  for (const std::string& column : columns) fmt::format_to(out, "{:>19}", column);
  text += '\n';
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    fmt::format_to(out, "  {:<20}", rows[std::size_t(r)]);
    for (Eigen::Index c = 0; c < m.cols(); ++c) fmt::format_to(out, "{:>19}", number(m(r, c)));
    text += '\n';
  }
}

std::vector<std::string> names_in(const std::vector<CycleSignal>& signals) {
  std::vector<std::string> names;
  for (const CycleSignal& s : signals) names.push_back(s.name);
  return names;
}

void put_model(std::string& text, const LinearModel& model) {
  auto out = std::back_inserter(text);
  const CycleMap& map = model.map;
  const auto states = names_in(map.states), inputs = names_in(map.inputs), outputs = names_in(map.outputs);
  fmt::format_to(out, "\nOne cycle to the next, every {}: deviations in SI units\n", readable(map.period, "s"));
  put_matrix(text, "A", map.a, states, states);
  put_matrix(text, "B", map.b, states, inputs);
  put_matrix(text, "C", map.c, outputs, states);
  put_matrix(text, "D", map.d, outputs, inputs);
  put_matrix(text, "steady gain", model.steady_gain, outputs, inputs);
  fmt::format_to(out, "\n{:<26}{:>14}{:>19}{:>19}\n", "Multiplier", "time constant", "natural frequency",
                 "damping ratio");
  for (const CycleMode& m : model.modes) {
    const bool pair = m.multiplier.imag() != 0.0;
    const std::string value = pair ? fmt::format("{:.5g} +- {:.5g}i", m.multiplier.real(), m.multiplier.imag())
                                   : fmt::format("{:.5g}", m.multiplier.real());
    fmt::format_to(out, "  {:<24}{:>14}{:>19}{:>19}{}\n", value, readable(m.time_constant, "s"),
                   pair ? readable(m.natural_frequency, "rad/s") : "-", pair ? number(m.damping_ratio) : "-",
                   m.settled ? "  settled within a cycle" : "");
  }
  const ContinuousModel& c = model.continuous;
  text += "\nContinuous time, without what settles within a cycle\n";
  if (!c.states.empty()) {
    const auto kept = names_in(c.states);
    put_matrix(text, "A", c.a, kept, kept);
    put_matrix(text, "B", c.b, kept, inputs);
    put_matrix(text, "C", c.c, outputs, kept);
  }
  put_matrix(text, "D", c.d, outputs, inputs);
}

}  // namespace

std::string detail::map_text(const AllocationMap& map) {
  std::string text;
  auto out = std::back_inserter(text);
  const std::string input = fmt::format("{} [{}]", name_of(map.input), unit_of(map.input));
  fmt::format_to(out, "\n{:<26}{:>13}{:>15}{:>15}{:>15}{:>13}\n", input, "lift N", "roll N m", "pitch N m", "yaw N m",
                 "frequency Hz");
  const auto line = [&](const std::string& name, const AllocationPoint& p) {
    fmt::format_to(out, "  {:<24}{:>13}{:>15}{:>15}{:>15}{:>13}\n", name, number(p.lift), number(p.roll),
                   number(p.pitch), number(p.yaw), number(p.frequency));
  };
  for (const AllocationPoint& p : map.points) line(number(p.input), p);
  line(fmt::format("slope at {}", number(map.slope.input)), map.slope);
  line("  from these points", map.slope_of_points);
  line("  off by at most about", map.slope_of_points_error);
  line("  points apart by", map.slope_of_points_step);
  return text;
}

std::string toml_control(const ControlModels& models, const std::string& version) {
  Json tree = detail::control_tree(models, version);
  std::string text = fmt::format("# {}\n", tree["written_by"].get<std::string>());
  tree.erase("written_by");
  put_toml(tree, "", text);
  return text;
}

std::string text_control(const ControlModels& models) {
  const RunResult& operating_point = models.linear.operating_point;
  std::string text = operating_point.design.name.empty() ? std::string() : operating_point.design.name + "\n";
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}: {}\n", name_of(operating_point.status), describe(operating_point));
  if (!models.linear.model) return text;
  fmt::format_to(out, "\nOperating point{}: {}, {}, mean lift {}\n",
                 models.options.operating_point.condition == Condition::air
                     ? std::string()
                     : fmt::format(" ({})", name_of(models.options.operating_point.condition)),
                 readable(operating_point.metrics[Metric::voltage], "V"),
                 readable(operating_point.metrics[Metric::frequency], "Hz"),
                 readable(operating_point.metrics[Metric::lift_mean], "N"));
  put_model(text, *models.linear.model);
  if (models.body) {
    text += "\nCycle-averaged derivatives by the body's motion, axes forward, right, down";
    fmt::format_to(out, " (stroke axes {} from the middle)", readable(models.options.hinge_offset, "m"));
    put_matrix(text, "\nN, N m per m/s, rad/s", *models.body, {body_loads.begin(), body_loads.end()},
               {body_motions.begin(), body_motions.end()});
  }
  for (const AllocationMap& map : models.maps) text += detail::map_text(map);
  return text;
}

}  // namespace wingbeat
