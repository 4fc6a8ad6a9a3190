#include "wingbeat/report/control_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "report/report_tools.hpp"
#include "wingbeat/files/toml_text.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

using detail::Json, detail::number_or_null;

// ---- JSON

Json signals(const std::vector<CycleSignal>& of) {
  Json list = Json::array();
  for (const CycleSignal& s : of)
    list.push_back({{"name", s.name}, {"unit", s.unit}, {"value", number_or_null(s.value)}});
  return list;
}

Json rows_of(const Eigen::MatrixXd& m) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < m.cols(); ++c) row.push_back(number_or_null(m(r, c)));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json json_of(const AllocationMap& map) {
  Json of = {{"input", name_of(map.input)}, {"unit", unit_of(map.input)}};
  Json inputs = Json::array();
  for (const AllocationPoint& p : map.points) inputs.push_back(number_or_null(p.input));
  of["values"] = std::move(inputs);
  for (const AllocationColumn& c : allocation_columns) {
    Json column = Json::array();
    for (const AllocationPoint& p : map.points) column.push_back(number_or_null(p.*c.member));
    of[c.name] = std::move(column);
  }
  for (const AllocationSlope& s : allocation_slopes) {
    const AllocationPoint& slope = map.*s.member;
    Json by_name = {{"at", number_or_null(slope.input)}};
    for (const AllocationColumn& c : allocation_columns) by_name[c.name] = number_or_null(slope.*c.member);
    of[s.name] = std::move(by_name);
  }
  return of;
}

Json json_of(const BodyDerivatives& body) {
  Json of;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      of[fmt::format("{}_{}", body_loads[std::size_t(row)], body_motions[std::size_t(column)])] =
          number_or_null(body(row, column));
    }
  }
  return of;
}

Json json_of(const LinearModel& model) {
  const CycleMap& map = model.map;
  Json modes = Json::array(), responses;
  for (const CycleMode& m : model.modes) {
    modes.push_back({{"multiplier_real", m.multiplier.real()},
                     {"multiplier_imaginary", m.multiplier.imag()},
                     {"time_constant_s", number_or_null(m.time_constant)},
                     {"natural_frequency_rad_per_s", number_or_null(m.natural_frequency)},
                     {"damping_ratio", number_or_null(m.damping_ratio)},
                     {"settled", m.settled}});
  }
  for (std::size_t input = 0; input < map.inputs.size(); ++input) {
    Json outputs;
    const Eigen::MatrixXd& response = model.step_responses[input];
    for (std::size_t k = 0; k < map.outputs.size(); ++k) {
      Json column = Json::array();
      for (const double y : response.col(Eigen::Index(k))) column.push_back(number_or_null(y));
      outputs[map.outputs[k].name] = std::move(column);
    }
    responses[map.inputs[input].name] = std::move(outputs);
  }
  const ContinuousModel& c = model.continuous;
  return {{"period_s", map.period},
          {"states", signals(map.states)},
          {"inputs", signals(map.inputs)},
          {"outputs", signals(map.outputs)},
          {"A", rows_of(map.a)},
          {"B", rows_of(map.b)},
          {"C", rows_of(map.c)},
          {"D", rows_of(map.d)},
          {"steady_gain", rows_of(model.steady_gain)},
          {"modes", std::move(modes)},
          {"continuous",
           {{"states", signals(c.states)},
            {"A", rows_of(c.a)},
            {"B", rows_of(c.b)},
            {"C", rows_of(c.c)},
            {"D", rows_of(c.d)}}},
          {"step_responses", std::move(responses)}};
}

Json tree_of(const ControlModels& models, const std::string& version) {
  const RunResult& at = models.linear.operating_point;
  Json tree = {{"written_by", fmt::format("Written by wingbeat {} linearise", version)},
               {"vehicle", at.design.name},
               {"condition", name_of(models.options.at.condition)},
               {"status", name_of(at.status)},
               {"status_detail", describe(at)},
               {"domain", name_of(at.domain)},
               {"voltage_v", number_or_null(at.metrics[Metric::voltage])},
               {"frequency_hz", number_or_null(at.metrics[Metric::frequency])},
               {"lift_mean_n", number_or_null(at.metrics[Metric::lift_mean])}};
  if (!models.linear.model) {
    tree["model"] = nullptr;
    return tree;
  }
  tree["model"] = json_of(*models.linear.model);
  Json maps = Json::array();
  for (const AllocationMap& map : models.maps) maps.push_back(json_of(map));
  tree["static_maps"] = std::move(maps);
  tree["hinge_offset_m"] = models.options.hinge_offset;
  if (models.body) tree["body_derivatives"] = json_of(*models.body);
  return tree;
}

// ---- TOML

bool is_table(const Json& of) { return of.is_object(); }
bool is_tables(const Json& of) { return of.is_array() && !of.empty() && of.front().is_object(); }

std::string value_in_toml(const Json& of) {
  if (of.is_null()) return "nan";
  if (of.is_number_float()) {
    const std::string text = fmt::format("{}", of.get<double>());
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
  }
  if (of.is_string()) return toml_text(of.get<std::string>());
  if (!of.is_array()) return of.dump();
  std::string text = "[";
  for (const Json& x : of) text += fmt::format("{}{}", &x == &of.front() ? "" : ", ", value_in_toml(x));
  return text + "]";
}

void put_toml(const Json& table, const std::string& path, std::string& text) {
  for (const auto& [key, value] : table.items()) {
    if (!is_table(value) && !is_tables(value)) text += fmt::format("{} = {}\n", key, value_in_toml(value));
  }
  for (const auto& [key, value] : table.items()) {
    const std::string name = path.empty() ? key : path + "." + key;
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

std::vector<std::string> names_in(const std::vector<CycleSignal>& of) {
  std::vector<std::string> names;
  for (const CycleSignal& s : of) names.push_back(s.name);
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

void put_map(std::string& text, const AllocationMap& map) {
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
}

}  // namespace

std::string json_control(const ControlModels& models, const std::string& version) {
  return detail::dumped(tree_of(models, version));
}

std::string toml_control(const ControlModels& models, const std::string& version) {
  Json tree = tree_of(models, version);
  std::string text = fmt::format("# {}\n", tree["written_by"].get<std::string>());
  tree.erase("written_by");
  put_toml(tree, "", text);
  return text;
}

std::string text_control(const ControlModels& models) {
  const RunResult& at = models.linear.operating_point;
  std::string text = at.design.name.empty() ? std::string() : at.design.name + "\n";
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}: {}\n", name_of(at.status), describe(at));
  if (!models.linear.model) return text;
  fmt::format_to(out, "\nOperating point{}: {}, {}, mean lift {}\n",
                 models.options.at.condition == Condition::air
                     ? std::string()
                     : fmt::format(" ({})", name_of(models.options.at.condition)),
                 readable(at.metrics[Metric::voltage], "V"), readable(at.metrics[Metric::frequency], "Hz"),
                 readable(at.metrics[Metric::lift_mean], "N"));
  put_model(text, *models.linear.model);
  if (models.body) {
    text += "\nCycle-averaged derivatives by the body's motion, axes forward, right, down";
    fmt::format_to(out, " (stroke axes {} from the middle)", readable(models.options.hinge_offset, "m"));
    put_matrix(text, "\nN, N m per m/s, rad/s", *models.body, {body_loads.begin(), body_loads.end()},
               {body_motions.begin(), body_motions.end()});
  }
  for (const AllocationMap& map : models.maps) put_map(text, map);
  return text;
}

}  // namespace wingbeat
