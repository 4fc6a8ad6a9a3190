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

/// What [motor] has from the sheet as it stands there.
struct SheetValue {
  std::string_view key, unit;
  std::optional<double> MotorDatasheet::* value;
};
constexpr SheetValue thermal_values[] = {
    {"thermal_resistance_winding", "K/W", &MotorDatasheet::thermal_resistance_winding},
    {"thermal_resistance_case", "K/W", &MotorDatasheet::thermal_resistance_case},
    {"winding_temperature_max", "K", &MotorDatasheet::winding_temperature_max},
    {"thermal_time_constant_winding", "s", &MotorDatasheet::thermal_time_constant_winding},
    {"thermal_time_constant_case", "s", &MotorDatasheet::thermal_time_constant_case}};

std::string percent(double x) { return fmt::format("{:.{}f} %", 100.0 * x, std::abs(x) < 0.1 ? 1 : 0); }

std::string sentence(const Contradiction& c) {
  return fmt::format("{} and {} disagree about the {} by {}", c.first, c.second, c.constant, percent(c.size));
}

std::string scientific(double x, std::string_view unit) { return fmt::format("{:.4g} {}", x, unit); }

}  // namespace

std::string motor_section(const MotorIdentification& motor, const MotorDatasheet& sheet, const std::string& made_by,
                          Shaft shaft) {
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
    text += fmt::format("{} = \"{} {}\"\n", c.key, *(motor.*c.value).value / std::pow(n, c.power), c.unit);
  }
  if (sheet.gear_efficiency) text += fmt::format("gear_efficiency = {}\n", *sheet.gear_efficiency);
  for (const SheetValue& v : thermal_values) {
    if (sheet.*v.value) text += fmt::format("{} = \"{} {}\"\n", v.key, *(sheet.*v.value), v.unit);
  }
  return text;
}

std::string text_identification(const MotorIdentification& motor, const MotorDatasheet& sheet) {
  std::string text = sheet.name.empty() ? "" : one_line(sheet.name, 88) + "\n";
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
    text += "\nThe sheet beside the identified motor    published    identified   deviation\n";
    for (const DatasheetCheck& c : motor.checks) {
      text += fmt::format("  {:<34}{:>14.4g}{:>14.4g}{:>12}\n", detail::spaced(c.name), c.published, c.identified,
                          fmt::format("{:+.1f} %", 100.0 * c.deviation));
    }
  }
  if (!motor.contradictions.empty()) {
    text += "\nContradictions of the sheet\n";
    for (const Contradiction& c : motor.contradictions) {
      text += "  " + wrapped(fmt::format("{}: {:.4g} and {:.4g}", sentence(c), c.first_value, c.second_value), 88, 4) +
              "\n";
    }
  }
  if (!motor.remarks.empty()) text += "\nRemarks\n";
  for (const std::string& remark : motor.remarks) text += "  " + wrapped(remark, 88, 4) + "\n";
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
          .always("source", "", "what it rests on, or what is missing", [](const R& r) { return r.found.source; });
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
          .always("first", "", "what the first value rests on", &R::first)
          .always("second", "", "what the second value rests on", &R::second)
          .always("first_value", "", "", &R::first_value, schema::any_number)
          .always("second_value", "", "", &R::second_value, schema::any_number)
          .always("size", "1", "relative difference", &R::size, schema::any_number)
          .always("sentence", "", "", &sentence);
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
