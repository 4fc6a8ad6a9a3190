#include "files/measured_flight.hpp"

#include <string>
#include <utility>

#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {
namespace {

using Kind = TomlNode::Kind;

/// Rows of two numbers.
std::vector<std::pair<double, double>> pairs_of(const TomlFields& section, std::string_view key,
                                                const std::string& expected) {
  const TomlNode& node = section.at(key);
  if (!section.has(key) || node.kind != Kind::array || node.items.empty()) section.refuse(node, key, expected);
  std::vector<std::pair<double, double>> pairs;
  for (const TomlNode& row : node.items) {
    const bool pair = row.kind == Kind::array && row.items.size() == 2 && row.items[0].kind == Kind::number &&
                      row.items[1].kind == Kind::number;
    if (!pair) section.refuse(row, key, expected);
    pairs.push_back({row.items[0].number, row.items[1].number});
  }
  return pairs;
}

/// An angle by its mean and rows of amplitude and phase, in degrees.
PeriodicAngle angle_of(const TomlFields& plan, const std::string& name) {
  PeriodicAngle angle;
  angle.mean = plan.needed_quantity(name + "_mean", "rad");
  for (const auto& [amplitude, phase] : pairs_of(
           plan, name + "_harmonics", "expected rows of amplitude and phase in degrees, from the first harmonic")) {
    angle.harmonics.push_back({amplitude / degrees_per_radian, phase / degrees_per_radian});
  }
  return angle;
}

}  // namespace

Planform<double> outline_of(const TomlFields& root, const std::string& key, const std::string& unit,
                            double hub_offset) {
  const auto tables = root.table("tables");
  if (!tables || !tables->has(key)) {
    root.refuse("tables", "the model needs tables." + key + ", rows of radius and chord");
  }
  Planform<double> p;
  p.shape = PlanformShape::tabulated;
  p.hub_offset = hub_offset;
  const double metre = unit_factor(unit, "m");
  for (const auto& [radius, chord] :
       pairs_of(*tables, key, "expected rows of radius and chord in " + unit + ", radii growing from 0")) {
    p.chord_table.push_back({radius * metre, chord * metre});
  }
  try {
    validate(p);
  } catch (const ParameterError& error) {
    tables->refuse(tables->at(key), key, error.reason());
  }
  return p;
}

PrescribedFlightProblem read_flight(const TomlFields& root, const TomlFields& plan, const MeasuredTable& table,
                                    ValidationSet& set) {
  PrescribedFlightProblem problem;
  problem.planform = outline_of(root, "chords", "m", 0.0);
  problem.count = plan.count("wings", 1).value_or(2);
  problem.air_density = plan.needed_quantity("air_density", "kg/m3");
  problem.motion = {plan.needed_quantity("frequency", "Hz"), angle_of(plan, "stroke"), angle_of(plan, "pitch")};
  problem.speed = plan.needed_quantity("speed", "m/s");
  problem.stroke_plane_tilt = plan.needed_quantity("stroke_plane_tilt", "rad");
  for (const TomlFields& load : plan.tables("load")) {
    const std::string_view keys[] = {"quantity", "unit", "gives", "row", "factor"};
    load.known_keys(keys);
    static constexpr std::string_view names[] = {"thrust", "lift", "power"};
    const std::string gives = load.choice("gives", names);
    problem.gives.push_back(gives == "thrust" ? &PrescribedFlightLoads::thrust
                            : gives == "lift" ? &PrescribedFlightLoads::lift
                                              : &PrescribedFlightLoads::power);
    const double measured = load.quantity("factor", "1").value_or(1.0) *
                            table.named(load, "row", load.needed_text("row", "a quantity of the rows"));
    set.points.push_back({gives, absent, set.quantities.size(), measured});
    set.quantities.push_back(
        {load.needed_text("quantity", "what is compared, in words"), load.needed_text("unit", "its unit")});
  }
  if (problem.gives.empty()) plan.refuse("load", "missing; expected [[validation.load]]");
  set.split = ValidationSplit::none;
  return problem;
}

}  // namespace wingbeat::detail
