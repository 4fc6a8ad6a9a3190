#include "files/motor_catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {
namespace {

/// What manufacturers and collections call the columns.
constexpr ColumnAlias aliases[] = {{"type", "model"},
                                   {"motor", "model"},
                                   {"part_number", "model"},
                                   {"ratio", "gear_ratio"},
                                   {"reduction", "gear_ratio"},
                                   {"r", "armature_resistance"},
                                   {"resistance", "armature_resistance"},
                                   {"terminal_resistance", "armature_resistance"},
                                   {"phase_to_phase_resistance", "armature_resistance"},
                                   {"k_t", "torque_constant"},
                                   {"kt", "torque_constant"},
                                   {"k_m", "torque_constant"},
                                   {"l", "armature_inductance"},
                                   {"inductance", "armature_inductance"},
                                   {"terminal_inductance", "armature_inductance"},
                                   {"rotor_inertia", "inertia"},
                                   {"j", "inertia"},
                                   {"coulomb_friction", "friction_torque"},
                                   {"viscous_friction", "viscous_damping"},
                                   {"weight", "mass"},
                                   {"i_0", "no_load_current"},
                                   {"i0", "no_load_current"},
                                   {"n_0", "no_load_speed"},
                                   {"n0", "no_load_speed"},
                                   {"rated_current", "nominal_current"},
                                   {"continuous_current", "nominal_current"},
                                   {"max_continuous_current", "nominal_current"},
                                   {"maximum_continuous_current", "nominal_current"},
                                   {"rth1", "thermal_resistance_winding"},
                                   {"rth2", "thermal_resistance_case"}};

/// A row as a vehicle, or what it lacks.
template <class Number>
MotorCandidate candidate(const std::string& model, const Number& number, double gear, std::optional<double> rest,
                         const Design<double>& design) {
  MotorCandidate motor{one_line(model), "", {}, design, {}};
  const auto resistance = number("armature_resistance"), constant = number("torque_constant");
  const auto inertia = number("inertia"), inductance = number("armature_inductance");
  const auto mass = number("mass");
  // Heat is a choice of the vehicle; the resistances are the motor's own.
  MotorThermalDesign<double>& thermal = motor.design.motor.thermal;
  const bool heats = thermal.resistance_winding.has_value();
  if (heats) {
    thermal.resistance_winding = number("thermal_resistance_winding");
    thermal.resistance_case = number("thermal_resistance_case");
  }
  std::string lacks;
  const auto need_value = [&](const std::optional<double>& x, const char* what) {
    if (!x) lacks += fmt::format("{}{}", lacks.empty() ? "" : ", ", what);
  };
  need_value(resistance, "armature resistance");
  need_value(constant, "torque constant");
  need_value(inertia, "rotor inertia");
  need_value(inductance, "inductance");
  if (heats) {
    need_value(thermal.resistance_winding, "thermal resistance of the winding");
    need_value(thermal.resistance_case, "thermal resistance of the case");
  }
  const bool weighed = rest || design.masses.motor;
  if (weighed) need_value(mass, "mass");
  if (!lacks.empty()) {
    motor.refused = "incomplete, no " + lacks;
    return motor;
  }
  auto& c = motor.design.motor.constants;
  c.armature_resistance = *resistance;
  c.torque_constant = *constant;
  c.inertia = *inertia;
  c.armature_inductance = *inductance;
  c.friction_torque = number("friction_torque").value_or(0.0);
  const auto no_load_current = number("no_load_current"), no_load_speed = number("no_load_speed");
  if (const auto damping = number("viscous_damping")) {
    c.viscous_damping = *damping;
  } else if (no_load_current && no_load_speed) {
    // At no load the motor's torque covers its own friction alone.
    const double rest_of_torque = *constant * *no_load_current - c.friction_torque;
    c.viscous_damping = std::max(0.0, rest_of_torque) / *no_load_speed;
    motor.derived.push_back(fmt::format("b = {:.2g} N m s/rad from the no-load current", c.viscous_damping));
  } else {
    motor.refused = "incomplete, neither viscous friction nor no-load current and speed";
    return motor;
  }
  // A gearmotor's sheet states its output shaft; a bare motor gets the study's gearbox.
  const double own = number("gear_ratio").value_or(1.0);
  if (own == 1.0) motor.design.motor.gear_ratio = gear;
  else motor.design.motor.gear_ratio.reset();
  motor.design.motor.gear_inertia = 0.0;
  motor.design.motor.gear_damping = 0.0;
  motor.nominal_current = number("nominal_current");
  if (rest) motor.design.mass = rest;
  if (weighed) motor.design.masses.motor = mass;
  try {
    validate(motor.design);
  } catch (const ParameterError& error) {
    motor.refused = error.what();
  }
  return motor;
}

}  // namespace

const std::vector<NamedColumn>& catalogue_columns() {
  static const std::vector<NamedColumn> columns = {{"model", "model", ""},
                                                   {"gear_ratio", "gear_ratio", "1"},
                                                   {"armature_resistance", "resistance_ohm", "ohm"},
                                                   {"torque_constant", "torque_constant_Nm_per_A", "N m/A"},
                                                   {"inertia", "rotor_inertia_kgm2", "kg m2"},
                                                   {"armature_inductance", "inductance_H", "H"},
                                                   {"friction_torque", "friction_torque_Nm", "N m"},
                                                   {"viscous_damping", "viscous_friction_Nms", "N m s/rad"},
                                                   {"mass", "mass_kg", "kg"},
                                                   {"no_load_current", "no_load_current_A", "A"},
                                                   {"no_load_speed", "no_load_speed_rad_s", "rad/s"},
                                                   {"nominal_current", "nominal_current_A", "A"},
                                                   {"thermal_resistance_winding", "Rth1_K_per_W", "K/W"},
                                                   {"thermal_resistance_case", "Rth2_K_per_W", "K/W"}};
  return columns;
}

namespace {

/// Which cell of a row a column is, and the factor to SI.
struct Place {
  std::size_t cell = 0;
  double factor = 1.0;
  std::string header;
  bool alias = false;
};

class Catalogue {
 public:
  Catalogue(std::string_view text, const std::string& name, const StatedTable& stated)
      : name_(name), stated_(stated), table_(read_bench_table(text, name, stated.form)) {
    for (const NamedColumn& c : catalogue_columns()) known_.push_back(&c);
    for (std::size_t n = 0; n < table_.header.cells.size(); ++n) place(n);
    for (const auto& [header, meaning] : stated.columns) {
      const auto has = [&, &h = header](const TableCell& cell) { return cell.text == h; };
      if (std::none_of(table_.header.cells.begin(), table_.header.cells.end(), has)) {
        refuse(table_.header.number, 1, "", "motors.columns names " + in_quotes(header) + ", which the header has not");
      }
    }
    for (const char* needed : {"model", "armature_resistance", "torque_constant", "inertia", "armature_inductance"}) {
      if (places_.count(needed) == 0) {
        refuse(table_.header.number, 1, needed,
               "missing; expected a column of that name, or motors.columns to name the one that it is");
      }
    }
  }

  const std::vector<TableLine>& rows() const { return table_.rows; }

  std::string text(const TableLine& row, std::string_view column) const {
    const auto found = places_.find(column);
    return found == places_.end() ? "" : row.cells[found->second.cell].text;
  }

  std::optional<double> number(const TableLine& row, std::string_view column) const {
    const auto found = places_.find(column);
    if (found == places_.end()) return std::nullopt;
    const TableCell& cell = row.cells[found->second.cell];
    if (is_missing(cell.text)) return std::nullopt;
    std::string content = cell.text;
    if (table_.decimal_comma) std::replace(content.begin(), content.end(), ',', '.');
    try {
      return found->second.factor * parse_quantity(content, "1");
    } catch (const UnitError&) {
      refuse(row.number, cell.column, found->second.header, "expected a number, got " + in_quotes(cell.text));
    }
  }

 private:
  [[noreturn]] void refuse(int line, int column, const std::string& key, const std::string& message) const {
    throw InputError(name_, line, column, key, message);
  }

  void place(std::size_t n) {
    const TableCell& cell = table_.header.cells[n];
    RecognisedHeader found;
    bool mapped = false;
    for (const auto& [header, meaning] : stated_.columns) {
      if (header != cell.text) continue;
      if (meaning == "ignore") return;
      mapped = true;
      found = recognise_stated(meaning, header, known_, aliases);
      if (found.column) continue;
      std::string names;
      for (const NamedColumn* c : known_) names += (names.empty() ? "" : ", ") + c->name;
      refuse(table_.header.number, cell.column, "",
             fmt::format("motors.columns names {}, which is none of {}", in_quotes(meaning), names));
    }
    if (!mapped) found = recognise_header(cell.text, known_, aliases);
    if (!found.column) return;
    if (!found.complaint.empty()) {
      if (found.renamed && !mapped) return;  // something else of that name
      refuse(table_.header.number, cell.column, cell.text,
             fmt::format("{}; motors.columns = {{ {} = \"{} [{}]\" }} says which", found.complaint,
                         in_quotes(cell.text), found.column->name, found.column->unit));
    }
    // A column's own name goes before what others call it.
    const Place here{n, found.factor, cell.text, found.renamed && !mapped};
    const auto [before, fresh] = places_.try_emplace(found.column->name, here);
    if (fresh || (here.alias && !before->second.alias)) return;
    if (before->second.alias && !here.alias) {
      before->second = here;
      return;
    }
    refuse(
        table_.header.number, cell.column, cell.text,
        fmt::format("{} is given twice, as {} and as {}; motors.columns = {{ {} = \"ignore\" }} leaves one out",
                    found.column->name, in_quotes(before->second.header), in_quotes(cell.text), in_quotes(cell.text)));
  }

  const std::string& name_;
  const StatedTable& stated_;
  BenchTable table_;
  std::vector<const NamedColumn*> known_;
  std::map<std::string, Place, std::less<>> places_;
};

}  // namespace

std::vector<MotorCandidate> parse_motor_catalogue(std::string_view text, const std::string& name, double gear,
                                                  std::optional<double> rest, const Design<double>& design,
                                                  const StatedTable& stated) {
  const Catalogue catalogue(text, name, stated);
  std::vector<MotorCandidate> motors;
  for (const TableLine& row : catalogue.rows()) {
    const auto number = [&](std::string_view column) { return catalogue.number(row, column); };
    motors.push_back(candidate(catalogue.text(row, "model"), number, gear, rest, design));
  }
  return motors;
}

}  // namespace wingbeat::detail
