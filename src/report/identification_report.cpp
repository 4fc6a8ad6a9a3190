#include "wingbeat/report/identification_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/described.hpp"
#include "report/result_schemas.hpp"
#include "report/result_trees.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/parts/motor_thermal.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

struct Constant {
  std::string_view key;  ///< of [motor]
  std::string_view name, unit;
  IdentifiedConstant MotorIdentification::* value;
  int power = 0;  ///< of the gear ratio in the value at the output shaft
};
constexpr Constant constants[] = {
    {"armature_resistance", "armature resistance", "ohm", &MotorIdentification::armature_resistance},
    {"armature_inductance", "armature inductance", "H", &MotorIdentification::armature_inductance},
    {"torque_constant", "torque constant", "N m/A", &MotorIdentification::torque_constant, 1},
    {"inertia", "inertia", "kg m2", &MotorIdentification::inertia, 2},
    {"viscous_damping", "viscous damping", "N m s/rad", &MotorIdentification::viscous_damping, 2},
    {"friction_torque", "friction torque", "N m", &MotorIdentification::friction_torque, 1}};

constexpr HeatConstant heat_constants[] = {HeatConstant::resistance_winding, HeatConstant::resistance_case,
                                           HeatConstant::time_constant_winding, HeatConstant::time_constant_case};

std::string percent(double x) { return fmt::format("{:.{}f} %", 100.0 * x, std::abs(x) < 0.1 ? 1 : 0); }

std::string sentence(const Contradiction& c) {
  return fmt::format("{} and {} disagree about the {} by {}", c.first, c.second, c.constant, percent(c.size));
}

std::string scientific(double x, std::string_view unit) { return fmt::format("{:.4g} {}", x, unit); }

/// The lines of [motor] about heat. A vehicle takes both resistances or neither, and time constants beside them.
std::string thermal_lines(const MotorIdentification& motor, const MotorDatasheet& sheet, bool rounded = false) {
  const auto value = [&](HeatConstant which) { return thermal_constant(sheet, motor, which); };
  if (!value(HeatConstant::resistance_winding) || !value(HeatConstant::resistance_case)) return "";
  std::string text;
  for (const HeatConstant which : heat_constants) {
    const auto x = value(which);
    if (!x) continue;
    text += fmt::format("{} = \"{} {}\"\n", key_of(which), rounded ? fmt::format("{:.5g}", *x) : fmt::format("{}", *x),
                        unit_of(which));
  }
  if (sheet.winding_temperature_max) {
    text += fmt::format("winding_temperature_max = \"{:.12g} degC\"\n", *sheet.winding_temperature_max - zero_celsius);
  }
  return text;
}

/// What a heating curve shows.
std::string text_heat(const HeatIdentification& heat, const MotorDatasheet& sheet, const MotorIdentification& motor) {
  std::string text = fmt::format("\nHeat, from {}{:>{}}\n", one_line(sheet.heating->source, 40), "95 % interval",
                                 std::max(14, 65 - int(std::min<std::size_t>(sheet.heating->source.size(), 40))));
  const auto row = [&](std::string_view name, const std::optional<HeatValue>& x, std::string_view unit) {
    if (!x) return void(text += fmt::format("  {:<38}{:>18}\n", name, "not determined"));
    text += fmt::format("  {:<38}{:>18}    {:.4g} to {:.4g}\n", name, scientific(x->value, unit), x->low, x->high);
  };
  for (const HeatConstant which : heat_constants) {
    row(detail::spaced(std::string(key_of(which))), heat[which], unit_of(which));
  }
  if (heat.resistance_sum) row("both thermal resistances together", heat.resistance_sum, "K/W");
  if (heat.case_heat_capacity) row("heat capacity of the case", heat.case_heat_capacity, "J/K");
  if (heat.start_resistance) row("winding at the start", heat.start_resistance, "ohm");
  for (const HeatColumn& c : heat.columns) {
    text += fmt::format("  {:<38}{:>18}    scatter {:.2g} {}\n", detail::spaced(c.name),
                        fmt::format("{} values", c.count), c.scatter, c.unit);
  }
  for (const std::string& missing : heat.missing) text += "  " + wrapped(missing, 88, 4) + "\n";
  for (const std::string& remark : heat.remarks) text += "  " + wrapped(remark, 88, 4) + "\n";
  const std::string lines = thermal_lines(motor, sheet, true);
  if (!lines.empty()) text += "\n[motor] of a vehicle file\n" + lines;
  return text;
}

}  // namespace

bool has_motor_section(const MotorIdentification& motor, const MotorDatasheet& sheet) {
  return is_of_heat_alone(sheet) ? !thermal_lines(motor, sheet).empty() : motor.complete();
}

std::string motor_section(const MotorIdentification& motor, const MotorDatasheet& sheet, const std::string& made_by,
                          Shaft shaft) {
  if (is_of_heat_alone(sheet)) {
    return fmt::format("# {}\n# {}: heat alone.\n\n[motor]\n{}",
                       sheet.name.empty() ? "Motor of a heating curve" : one_line(sheet.name, 100), made_by,
                       thermal_lines(motor, sheet));
  }
  motor.motor();
  std::string text = fmt::format("# {}\n# {}; constants at the {} shaft.\n",
                                 sheet.name.empty() ? "Motor of a data sheet" : one_line(sheet.name, 100), made_by,
                                 shaft == Shaft::motor ? "motor" : "output");
  for (const Contradiction& c : motor.contradictions) text += fmt::format("# On the sheet, {}.\n", sentence(c));
  for (const std::string& remark : motor.remarks) text += fmt::format("# {}.\n", remark);
  text += "\n[motor]\n";
  const double n = shaft == Shaft::motor ? sheet.gear_ratio : 1.0;
  if (shaft == Shaft::motor) text += fmt::format("gear_ratio = {}\n", n);
  for (const Constant& c : constants) {
    const double value = without_rounding_errors(*(motor.*c.value).value / std::pow(n, c.power));
    text += fmt::format("{} = \"{} {}\"\n", c.key, value, c.unit);
  }
  if (sheet.gear_efficiency) text += fmt::format("gear_efficiency = {}\n", *sheet.gear_efficiency);
  return text + thermal_lines(motor, sheet);
}

std::string text_identification(const MotorIdentification& motor, const MotorDatasheet& sheet) {
  std::string text = sheet.name.empty() ? "" : one_line(sheet.name, 88) + "\n";
  if (motor.heat && is_of_heat_alone(sheet)) return text + text_heat(*motor.heat, sheet, motor);
  text += "\nConstants at the output shaft\n";
  for (const Constant& c : constants) {
    const IdentifiedConstant& x = motor.*c.value;
    text += fmt::format("  {:<22}", c.name);
    if (!x.value) {
      text += "not determined\n";
    } else if (x.standard_error > 0.0) {
      text += fmt::format("{:>22} +- {:<10.2g}{}\n", scientific(*x.value, c.unit), x.standard_error, x.source);
    } else {
      text += fmt::format("{:>22}    {:<10}{}\n", scientific(*x.value, c.unit), "", x.source);
    }
  }
  if (!motor.checks.empty()) {
    text += fmt::format("\n{:<38}{:>20}{:>20}{:>12}\n", "The sheet and the identified motor", "published", "identified",
                        "deviation");
    for (const DatasheetCheck& c : motor.checks) {
      text += fmt::format("  {:<36}{:>20}{:>20}{:>12}\n", detail::spaced(c.name), datasheet_text(c.published, c.unit),
                          datasheet_text(c.identified, c.unit), fmt::format("{:+.1f} %", 100.0 * c.deviation));
    }
  }
  if (!motor.contradictions.empty()) {
    text += "\nContradictions of the sheet\n";
    for (const Contradiction& c : motor.contradictions) {
      text += "  " +
              wrapped(fmt::format("{}: {} and {}", sentence(c), datasheet_text(c.first_value, c.unit),
                                  datasheet_text(c.second_value, c.unit)),
                      88, 4) +
              "\n";
    }
  }
  if (!motor.remarks.empty()) text += "\nRemarks\n";
  for (const std::string& remark : motor.remarks) text += "  " + wrapped(remark, 88, 4) + "\n";
  if (motor.heat) text += text_heat(*motor.heat, sheet, motor);
  if (!motor.missing.empty()) text += "\nNot determined\n";
  for (const std::string& missing : motor.missing) text += "  " + wrapped(missing, 88, 4) + "\n";
  return text;
}

namespace described {
namespace {

struct IdentificationFound {
  const MotorIdentification& motor;
  const MotorDatasheet& sheet;
};
struct ConstantFound {
  const Constant& constant;
  const IdentifiedConstant& found;
};

const Description<ConstantFound>& constant_description() {
  using R = ConstantFound;
  static const Description<R> description =
      Description<R>()
          .always("value", "", "null where the sheet does not determine it", [](const R& r) { return r.found.value; })
          .always(
              "standard_error", "", "in the same unit",
              [](const R& r) { return r.found.value ? Json(r.found.standard_error) : Json(nullptr); },
              schema::number_if_any)
          .always("unit", "", "", [](const R& r) { return r.constant.unit; })
          .always("source", "", "its source, or what is missing", [](const R& r) { return r.found.source; });
  return description;
}

const Description<DatasheetCheck>& check_description() {
  using R = DatasheetCheck;
  static const Description<R> description =
      Description<R>()
          .always("name", "", "", &R::name)
          .always("published", "", "", &R::published, schema::any_number)
          .always("identified", "", "what the identified motor gives", &R::identified, schema::any_number)
          .always("deviation", "1", "identified / published - 1", &R::deviation, schema::any_number);
  return description;
}

const Description<Contradiction>& contradiction_description() {
  using R = Contradiction;
  static const Description<R> description =
      Description<R>()
          .always("constant", "", "", &R::constant)
          .always("first", "", "source of the first value", &R::first)
          .always("second", "", "source of the second value", &R::second)
          .always("first_value", "", "", &R::first_value, schema::any_number)
          .always("second_value", "", "", &R::second_value, schema::any_number)
          .always("size", "1", "relative difference", &R::size, schema::any_number)
          .always("sentence", "", "", &sentence);
  return description;
}

const Description<HeatValue>& heat_value_description() {
  using R = HeatValue;
  static const Description<R> description =
      Description<R>()
          .always("value", "", "", &R::value, schema::any_number)
          .always("low", "", "of the 95 % interval", &R::low, schema::any_number)
          .always("high", "", "of the 95 % interval", &R::high, schema::any_number);
  return description;
}

const Description<HeatColumn>& heat_column_description() {
  using R = HeatColumn;
  static const Description<R> description =
      Description<R>()
          .always("name", "", "", &R::name)
          .always("unit", "", "", &R::unit)
          .always("values", "", "fitted", &R::count)
          .always("scatter", "", "standard deviation about the fitted curve, in that unit", &R::scatter,
                  schema::any_number);
  return description;
}

const Description<HeatIdentification>& heat_description() {
  using R = HeatIdentification;
  static const Description<R> description = [] {
    Description<R> d;
    const auto value = [&](std::string_view key, std::string_view unit, std::string_view meaning, const auto& get) {
      d.part(std::string(key), fmt::format("{}{}[{}]", meaning, meaning.empty() ? "" : " ", unit),
             heat_value_description(), [get](const R& r) {
               const std::optional<HeatValue>& x = get(r);
               return x ? &*x : nullptr;
             });
    };
    for (const HeatConstant which : heat_constants) {
      value(key_of(which), unit_of(which), "null where the curve does not determine it",
            [which](const R& r) -> const std::optional<HeatValue>& { return r[which]; });
    }
    value("resistance_sum", "K/W", "of both thermal resistances, where one is not determined",
          [](const R& r) -> const std::optional<HeatValue>& { return r.resistance_sum; });
    value("case_heat_capacity", "J/K", "time constant over thermal resistance, where one is not determined",
          [](const R& r) -> const std::optional<HeatValue>& { return r.case_heat_capacity; });
    value("start_resistance", "ohm", "of the winding at the start, where the curve shows it",
          [](const R& r) -> const std::optional<HeatValue>& { return r.start_resistance; });
    return d.parts("columns", "of the curve", heat_column_description(), [](const R& r) { return r.columns; })
        .always("missing", "", "constants that the curve does not determine, and why", &R::missing)
        .always("remarks", "", "", &R::remarks);
  }();
  return description;
}

const Description<IdentificationFound>& identification_description() {
  using R = IdentificationFound;
  static const Description<R> description =
      Description<R>()
          .always("name", "", "of the data sheet", [](const R& r) { return r.sheet.name; })
          .always("complete", "", "all constants are determined", [](const R& r) { return r.motor.complete(); })
          .always(
              "birge_ratio", "1", "factor on the standard errors for the scatter of the sheet's values, at least 1",
              [](const R& r) { return r.motor.birge_ratio; }, schema::any_number)
          .always("gear_efficiency", "1", "of the sheet", [](const R& r) { return r.sheet.gear_efficiency; })
          .always(
              "motor", "", "constants at the output shaft",
              [](const R& r) {
                Json motor = Json::object();
                for (const Constant& c : constants) {
                  motor[std::string(c.key)] = constant_description().json({c, r.motor.*c.value});
                }
                return motor;
              },
              schema::by_name(constant_description().schema()))
          .parts("checks", "values of the sheet beside those of the identified motor", check_description(),
                 [](const R& r) { return r.motor.checks; })
          .parts("contradictions", "ways to one constant that do not agree, largest first", contradiction_description(),
                 [](const R& r) { return r.motor.contradictions; })
          .sometimes_part("heat", "of the heating curve", heat_description(),
                          [](const R& r) { return r.motor.heat ? &*r.motor.heat : nullptr; })
          .always("remarks", "", "assumptions made", [](const R& r) { return r.motor.remarks; })
          .always("missing", "", "constants that are not determined, and what would determine them",
                  [](const R& r) { return r.motor.missing; });
  return description;
}

}  // namespace

Json identification_schema() { return identification_description().schema(); }

}  // namespace described

detail::Json detail::identification_tree(const MotorIdentification& motor, const MotorDatasheet& sheet) {
  return described::identification_description().json({motor, sheet});
}

std::string json_identification(const MotorIdentification& motor, const MotorDatasheet& sheet) {
  return detail::dumped(detail::identification_tree(motor, sheet));
}

}  // namespace wingbeat
