#include "operating_point.hpp"

#include <fmt/format.h>

#include <cmath>

#include "options.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/hold.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::app {
namespace {

void apply_voltage(Supply<double>& supply, const std::string& text) {
  if (is_sine(supply.type)) {
    throw InputError("--voltage", 0, 0, "", "the supply is a sine; use --set supply.amplitude=\"3 V\"");
  }
  if (supply.type == SupplyType::battery) {
    throw InputError("--voltage", 0, 0, "",
                     "the supply is a battery, whose charge gives its voltage; use --set "
                     "supply.charge=0.5, or --set supply.cell_voltage=\"3.7 V\"");
  }
  supply.voltage = quantity_of("--voltage", text, "V");
  if (supply.voltage < 0.0) throw InputError("--voltage", 0, 0, "", "must be >= 0 V");
}

/// What is asked of the whole vehicle, of which neither side has a known part.
void refuse_sums(const OperatingPointArguments& a) {
  for (const auto& [option, text] : {std::pair("--lift", &a.lift), std::pair("--lift-to-weight", &a.lift_to_weight),
                                     std::pair("--power", &a.power)}) {
    if (text->empty()) continue;
    throw InputError(option, 0, 0, "",
                     "the vehicle's sides differ, and neither has a known part of it; set supply.amplitude instead");
  }
}

}  // namespace

double quantity_of(const char* option, const std::string& text, const char* unit) {
  try {
    const double x = parse_quantity(text, unit);
    if (!std::isfinite(x)) throw InputError(option, 0, 0, "", "must be finite");
    return x;
  } catch (const UnitError& error) {
    throw InputError(option, 0, 0, "", error.what());
  }
}

void add_operating_point(CLI::App* command, OperatingPointArguments& a) {
  add_input(command, a.vehicle, InputKind::vehicle, "vehicle", "Vehicle file (TOML)", "VEHICLE");
  add_set(command, a.overrides);
  CLI::Option* voltage =
      command->add_option("--voltage", a.voltage, "Supply voltage (pwm: while switched on), as \"3 V\"")
          ->type_name("QUANTITY");
  CLI::Option* frequency = command->add_option("--frequency", a.frequency,
                                               "Find the voltage that gives this flapping frequency, as \"22 Hz\"");
  frequency->type_name("QUANTITY")->excludes(voltage);
  CLI::Option* lift = command->add_option(
      "--lift", a.lift, "Find the voltage (pwm, battery: the duty) that gives this mean lift, as \"20 mN\"");
  lift->type_name("QUANTITY")->excludes(voltage)->excludes(frequency);
  CLI::Option* ratio =
      command->add_option("--lift-to-weight", a.lift_to_weight, "The same for lift over weight; 1: hover");
  ratio->type_name("NUMBER")->excludes(voltage)->excludes(frequency)->excludes(lift);
  command->add_option("--power", a.power, "The same for the mean electrical power, as \"200 mW\"")
      ->type_name("QUANTITY")
      ->excludes(voltage)
      ->excludes(frequency)
      ->excludes(lift)
      ->excludes(ratio);
  command
      ->add_option("--angle-of-attack", a.angle_of_attack,
                   "Find the pitch_coefficient that leads to this angle at mid-stroke, as \"45 deg\"")
      ->type_name("ANGLE");
  add_choice<Condition>(command, "--condition", a.condition, "air (default), vacuum or wingless", "CONDITION");
}

void add_allow_extrapolation(CLI::App* command, OperatingPointArguments& arguments) {
  command->add_flag("--allow-extrapolation", arguments.allow_extrapolation,
                    "Search for a frequency or a lift outside the model's domain too (docs/targets.md)");
}

VehicleFile read_operating_point(const OperatingPointArguments& arguments, RunOptions& options) {
  options.allow_extrapolation = arguments.allow_extrapolation;
  options.condition = choice_of<Condition>("--condition", arguments.condition);
  if (!arguments.frequency.empty()) {
    options.frequency = quantity_of("--frequency", arguments.frequency, "Hz");
    if (!(*options.frequency > 0.0)) throw InputError("--frequency", 0, 0, "", "must be > 0 Hz");
  }
  if (!arguments.lift.empty()) {
    options.lift = quantity_of("--lift", arguments.lift, "N");
    if (!(*options.lift > 0.0)) throw InputError("--lift", 0, 0, "", "must be > 0 N");
  }
  if (!arguments.power.empty()) {
    options.power = quantity_of("--power", arguments.power, "W");
    if (!(*options.power > 0.0)) throw InputError("--power", 0, 0, "", "must be > 0 W");
  }
  if (!arguments.angle_of_attack.empty()) {
    options.angle_of_attack = quantity_of("--angle-of-attack", arguments.angle_of_attack, "rad");
    if (!(*options.angle_of_attack > 0.0 && *options.angle_of_attack < 0.5 * pi)) {
      throw InputError("--angle-of-attack", 0, 0, "", "must be > 0 deg, < 90 deg");
    }
  }
  VehicleFile vehicle = read_vehicle(arguments.vehicle, arguments.overrides);
  if (vehicle.sides) refuse_sums(arguments);
  Design<double>& design = vehicle.design;
  if (!arguments.lift_to_weight.empty()) {
    const double ratio = quantity_of("--lift-to-weight", arguments.lift_to_weight, "1");
    if (!(ratio > 0.0)) throw InputError("--lift-to-weight", 0, 0, "", "must be > 0");
    options.lift = held_lift({Held::lift_to_weight, ratio}, reporting_of(design));
    if (std::isnan(*options.lift)) {
      throw InputError("--lift-to-weight", 0, 0, "", "needs vehicle.mass, which the vehicle does not give");
    }
  }
  if (!arguments.voltage.empty()) apply_voltage(design.supply, arguments.voltage);
  return vehicle;
}

void require_reached(const OperatingPointArguments& arguments, const RunResult& result) {
  if (!result.search || result.search->outcome == FrequencyOutcome::reached ||
      result.status != FlappingStatus::flapping) {
    return;
  }
  // It flaps, only not so: no design that fails, but a request that cannot be met.
  const std::string asked = !arguments.frequency.empty() ? "--frequency " + arguments.frequency
                            : !arguments.lift.empty()    ? "--lift " + arguments.lift
                            : !arguments.power.empty()   ? "--power " + arguments.power
                                                         : "--lift-to-weight " + arguments.lift_to_weight;
  const bool leaves = result.search->finding.inside_domain_only();
  throw InputError(asked, 0, 0, "",
                   describe(result.search->finding) + (leaves ? "; --allow-extrapolation searches beyond" : ""));
}

}  // namespace wingbeat::app
