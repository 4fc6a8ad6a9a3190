#include "wingbeat/study/motor_identification.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "study/motor_contradictions.hpp"
#include "study/motor_data.hpp"
#include "study/motor_fit.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat {
namespace {

using detail::Datum;
using detail::Estimate;
using detail::format;
using detail::MotorFit;

/// Times this, the sheet's torques and its torque constant stand for the output shaft.
double to_output_of(const MotorDatasheet& s) { return s.shaft == Shaft::output ? 1.0 : s.gear_ratio; }

void take_electrical_constants(const MotorDatasheet& s, const MotorFit& fit, MotorIdentification& result) {
  const double to_output = to_output_of(s), R = fit.R, K = fit.K;
  if (fit.electrical) {
    result.armature_resistance = {R, R * fit.error(detail::resistance), "fitted"};
    result.torque_constant = {to_output * K, to_output * K * fit.error(detail::constant), "fitted"};
    for (const Datum& d : fit.data) {
      const double p = detail::predicted(d, fit.x, fit.scales);
      result.checks.push_back({d.name, detail::unit_of(d.kind), d.value, p, p / d.value - 1.0});
    }
  } else {
    if (fit.has_resistance) result.armature_resistance = {s.resistance, s.deviation * *s.resistance, "the sheet's"};
    if (!fit.has_resistance) {
      result.missing.push_back(
          "armature resistance: give resistance, stall_current with voltage, or points of the "
          "performance curve");
    }
    const bool K_known = s.torque_constant || s.speed_constant;
    if (K_known) result.torque_constant = {to_output * K, to_output * s.deviation * K, "the sheet's"};
    if (!K_known) {
      result.missing.push_back(
          "torque constant: give torque_constant, speed_constant, stall_torque with "
          "stall_current, or no_load_speed with resistance");
    }
    if (fit.has_resistance && K_known) {
      result.missing.push_back("torque constant and resistance: the sheet's values cannot be fitted");
    }
  }
}

void take_losses(const MotorDatasheet& s, const MotorFit& fit, MotorIdentification& result) {
  const double to_output = to_output_of(s), squared = to_output * to_output, n = s.gear_ratio;
  if (fit.losses_known()) {
    result.friction_torque = {to_output * fit.friction_torque(),
                              to_output * fit.error(detail::friction) * fit.scales.friction, "fitted"};
    result.viscous_damping = {squared * fit.viscous_damping(),
                              squared * fit.error(detail::damping) * fit.scales.damping, "fitted"};
    if (fit.both && fit.viscous_damping() * fit.speed < 1e-6 * fit.loss) {
      result.viscous_damping.value = 0.0;
      result.remarks.push_back("the losses are all constant friction: the sheet's values leave no viscous part");
    }
    if (!fit.both && fit.one && !s.friction_torque) {
      result.remarks.push_back(
          "the sheet does not separate constant from viscous friction: all of the loss is taken as viscous "
          "damping");
    }
    if (fit.only_constant || (!fit.both && s.friction_torque)) {
      result.remarks.push_back(
          "nothing on the sheet shows a viscous loss: all of the loss is taken as constant friction");
    }
  } else if (s.assume_typical_damping) {
    result.friction_torque = {0.0, 0.0, "assumed"};
    result.viscous_damping = {n * n * typical_motor_damping, 0.0, "fallback"};
    result.remarks.push_back(
        format("fallback: viscous damping %.3g N m s/rad at the motor shaft, a typical value; the "
               "sheet shows no loss",
               typical_motor_damping));
  } else {
    result.missing.push_back(
        "viscous damping: give no_load_current, friction_torque, viscous_damping or points of the "
        "performance curve, or ask for the fallback viscous_damping = \"typical\"");
  }
  if (fit.losses_known() && s.assume_typical_damping) {
    result.remarks.push_back("the fallback for viscous damping is not used: the sheet shows the losses");
  }
}

/// Found at the motor shaft.
void take_inertia(const MotorDatasheet& s, const MotorFit& fit, MotorIdentification& result) {
  const double n = s.gear_ratio;
  std::vector<Estimate> inertias;
  if (s.rotor_inertia) {
    inertias.push_back({"rotor inertia", *s.rotor_inertia, detail::deviation_in(s, "rotor_inertia")});
  }
  if (s.mechanical_time_constant && fit.electrical) {
    const double K_motor = s.shaft == Shaft::output ? fit.K / n : fit.K;
    inertias.push_back({"mechanical time constant", *s.mechanical_time_constant * K_motor * K_motor / fit.R,
                        detail::deviation_in(s, "mechanical_time_constant")});
  }
  if (!inertias.empty()) {
    double sum = 0.0, weight = 0.0;
    for (const Estimate& e : inertias) {
      sum += std::log(e.value) / square(e.deviation);
      weight += 1.0 / square(e.deviation);
    }
    const double J = std::exp(sum / weight);
    double chi_square = 0.0;
    for (const Estimate& e : inertias) chi_square += square(std::log(e.value / J) / e.deviation);
    const double birge = std::max(1.0, std::sqrt(chi_square / std::max(double(inertias.size()) - 1.0, 1.0)));
    result.inertia = {n * n * J, n * n * J * birge / std::sqrt(weight),
                      inertias.size() > 1 ? "fitted" : inertias[0].source};
  } else if (s.assume_steel_cylinder) {
    const double r = 0.5 * *s.rotor_diameter;
    const double J = 0.5 * steel_density * pi * r * r * *s.rotor_length * r * r;
    result.inertia = {n * n * J, 0.0, "fallback"};
    result.remarks.push_back(
        format("fallback: rotor inertia %.3g kg m2 of a solid steel cylinder of the rotor's size "
               "(a coreless rotor has less)",
               J));
  } else {
    result.missing.push_back(
        "rotor inertia: give rotor_inertia or mechanical_time_constant, or rotor_diameter and "
        "rotor_length with the fallback inertia = \"solid-steel-cylinder\"");
  }
  if (!inertias.empty() && s.assume_steel_cylinder) {
    result.remarks.push_back("the fallback for the inertia is not used: the sheet determines it");
  }
  detail::find_contradictions("rotor inertia", "kg m2", inertias, result.contradictions);
}

void take_inductance(const MotorDatasheet& s, const MotorFit& fit, std::optional<double> frequency,
                     MotorIdentification& result) {
  if (s.inductance) {
    result.armature_inductance = {s.inductance, 0.0, "the sheet's"};
  } else {
    result.armature_inductance = {0.0, 0.0, "assumed"};
    std::string remark = "no inductance given: assumed 0";
    if (frequency && fit.electrical) {
      // First-order lag of the current's ripple, at twice the flapping frequency.
      const double one_percent = fit.R * std::sqrt(1.0 / (0.99 * 0.99) - 1.0) / (2.0 * two_pi * *frequency);
      remark += format("; at %.4g Hz the ripple of the current, at twice that, would be 1 %% smaller with %.3g H",
                       *frequency, one_percent);
    } else {
      remark += "; give the flapping frequency to learn from which inductance on it matters";
    }
    result.remarks.push_back(remark);
  }
}

void remark_on_gear(const MotorDatasheet& s, MotorIdentification& result) {
  if (s.gear_efficiency && s.shaft == Shaft::output) {
    result.remarks.push_back(
        format("the gear efficiency of %.4g served to read the sheet's torques at the output, and the [motor] "
               "section holds it: a vehicle with this motor loses as much under load",
               *s.gear_efficiency));
  } else if (s.gear_efficiency) {
    result.remarks.push_back(
        format("the sheet's values stand for the motor shaft, before the gearbox: its efficiency of %.4g serves no "
               "reading, and the [motor] section holds it: a vehicle with this motor loses as much under load",
               *s.gear_efficiency));
  }
}

void remark_on_misfits(const std::vector<Datum>& data, MotorIdentification& result) {
  for (Datum const& d : data) {
    if (d.kind == detail::DatumKind::point_torque) continue;
    const auto check = std::find_if(result.checks.begin(), result.checks.end(),
                                    [&](const DatasheetCheck& c) { return c.name == d.name; });
    if (check != result.checks.end() && std::abs(check->deviation) > 3.0 * d.deviation) {
      result.remarks.push_back(
          format("%s does not fit the rest of the sheet: %s published, %s from the identified motor",
                 detail::spaced(d.name).c_str(), datasheet_text(d.value, check->unit).c_str(),
                 datasheet_text(check->identified, check->unit).c_str()));
    }
  }
  if (result.birge_ratio > 1.05) {
    result.remarks.push_back(
        format("the sheet's values scatter %.3g times as widely as their deviations allow: the standard "
               "errors are that much larger (Birge ratio)",
               result.birge_ratio));
  }
}

/// What the sheet states beside what the curve shows.
void compare_heat(const MotorDatasheet& s, HeatIdentification& heat) {
  const std::pair<HeatConstant, std::optional<double>> stated[] = {
      {HeatConstant::resistance_winding, s.thermal_resistance_winding},
      {HeatConstant::resistance_case, s.thermal_resistance_case},
      {HeatConstant::time_constant_winding, s.thermal_time_constant_winding},
      {HeatConstant::time_constant_case, s.thermal_time_constant_case}};
  for (const auto& [which, value] : stated) {
    const std::optional<HeatValue>& found = heat[which];
    if (!value || !found || (*value >= found->low && *value <= found->high)) continue;
    heat.remarks.push_back(format("the sheet states a %s of %.4g %s, outside the interval of the curve, which counts",
                                  detail::spaced(std::string(key_of(which))).c_str(), *value,
                                  std::string(unit_of(which)).c_str()));
  }
}

}  // namespace

bool is_of_heat_alone(const MotorDatasheet& s) {
  if (!s.heating || !s.points.empty()) return false;
  for (const auto& stated :
       {s.no_load_speed, s.no_load_current, s.stall_torque, s.stall_current, s.torque_constant, s.speed_constant,
        s.friction_torque, s.viscous_damping, s.inductance, s.rotor_inertia, s.mechanical_time_constant}) {
    if (stated) return false;
  }
  return true;
}

std::optional<double> thermal_constant(const MotorDatasheet& sheet, const MotorIdentification& motor,
                                       HeatConstant which) {
  if (motor.heat && (*motor.heat)[which]) return (*motor.heat)[which]->value;
  switch (which) {
    case HeatConstant::resistance_winding: return sheet.thermal_resistance_winding;
    case HeatConstant::resistance_case: return sheet.thermal_resistance_case;
    case HeatConstant::time_constant_winding: return sheet.thermal_time_constant_winding;
    case HeatConstant::time_constant_case: return sheet.thermal_time_constant_case;
  }
  return std::nullopt;
}

Motor<double> MotorIdentification::motor() const {
  if (!complete()) throw std::logic_error("the motor is not completely identified");
  return {*armature_resistance.value, *armature_inductance.value, *torque_constant.value, *inertia.value,
          *viscous_damping.value,     *friction_torque.value};
}

MotorIdentification identify_motor(const MotorDatasheet& s, std::optional<double> frequency) {
  detail::validate(s);
  MotorIdentification result;
  if (s.heating) {
    result.heat = identify_heat(*s.heating);
    compare_heat(s, *result.heat);
  }
  const std::vector<Datum> data = detail::data_of(s);
  const MotorFit fit(s, data);
  result.birge_ratio = fit.birge_ratio;
  take_electrical_constants(s, fit, result);
  take_losses(s, fit, result);
  take_inertia(s, fit, result);
  take_inductance(s, fit, frequency, result);
  remark_on_gear(s, result);
  detail::compare_ways(s, fit.friction_torque(), fit.scales.torque_factor, result.contradictions);
  std::stable_sort(result.contradictions.begin(), result.contradictions.end(),
                   [](const auto& a, const auto& b) { return a.size > b.size; });
  remark_on_misfits(data, result);
  detail::refuse_contradictions(data, result);
  for (IdentifiedConstant* c : {&result.armature_resistance, &result.armature_inductance, &result.torque_constant,
                                &result.inertia, &result.viscous_damping, &result.friction_torque}) {
    if (c->value) c->value = without_rounding_errors(*c->value);
  }
  return result;
}

}  // namespace wingbeat
