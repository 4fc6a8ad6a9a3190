#include "wingbeat/cycle/metrics.hpp"

#include <algorithm>
#include <cmath>

namespace wingbeat {

const std::array<MetricInfo, metric_count>& metric_table() {
  static const std::array<MetricInfo, metric_count> table = {{
      {"voltage_v", "V", "supply voltage"},
      {"frequency_hz", "Hz", "flapping frequency"},
      {"current_mean_a", "A", "mean current"},
      {"current_peak_a", "A", "peak current"},
      {"current_rms_a", "A", "root mean square of the current"},
      {"power_electrical_w", "W", "mean electrical input power"},
      {"power_motor_w", "W", "mean motor output power"},
      {"power_motor_reference_w", "W", "bench estimate of the motor output power"},
      {"power_friction_w", "W", "mean friction loss of the transmission"},
      {"power_aerodynamic_w", "W", "mean aerodynamic power"},
      {"power_reactive_w", "W", "mean absolute reactive power"},
      {"power_copper_w", "W", "mean copper loss of the motor"},
      {"power_viscous_w", "W", "mean viscous loss of the motor"},
      {"power_motor_friction_w", "W", "mean loss in the motor's own constant friction"},
      {"power_gear_w", "W", "mean loss of the gearbox under load"},
      {"power_electronics_w", "W", "mean loss of the electronics, of a piezo with its dielectric's"},
      {"power_loss_w", "W", "mean total loss"},
      {"power_residual_w", "W", "mean power the transmission formulation fails to conserve"},
      {"lift_mean_n", "N", "mean lift"},
      {"lift_peak_n", "N", "peak lift"},
      {"rod_force_peak_n", "N", "peak magnitude of the rod force"},
      {"rod_force_mean_n", "N", "mean magnitude of the rod force"},
      {"stroke_amplitude_rad", "rad", "stroke amplitude, half peak to peak"},
      {"flapping_velocity_peak_rad_per_s", "rad/s", "peak flapping velocity"},
      {"angle_of_attack_min_deg", "degree", "smallest angle of attack"},
      {"crank_speed_min_rad_per_s", "rad/s", "smallest crank speed"},
      {"crank_speed_max_rad_per_s", "rad/s", "largest crank speed"},
      {"efficiency_system", "1", "system efficiency"},
      {"efficiency_motor", "1", "motor efficiency"},
      {"efficiency_mechanism", "1", "mechanism efficiency"},
      {"floquet_multiplier_max", "1", "largest modulus of the orbit's Floquet multipliers"},
      {"lift_to_weight", "1", "mean lift over weight"},
      {"winding_temperature_degc", "degC", "winding temperature of the motor"},
      {"case_temperature_degc", "degC", "case temperature of the motor"},
      {"winding_temperature_margin_k", "K", "largest winding temperature allowed, less the winding temperature"},
      {"added_mass_inertia_ratio", "1", "inertia of the air that moves with the wings over the wings' own"},
      {"power_hinge_w", "W", "mean loss in the damping and at the stops of the pitch hinges"},
      {"pitch_amplitude_deg", "degree", "pitch amplitude, half peak to peak"},
      {"pitch_phase_deg", "degree", "lead of the pitching over the pitch that opposes the flapping velocity"},
      {"angle_of_attack_max_deg", "degree", "largest angle of attack of wings that pitch on a hinge"},
      {"lift_added_mass_share", "1", "part of the mean lift that comes from the added mass of wings on pitch hinges"},
      {"reynolds_number", "1", "Reynolds number of the mean chord at the mean speed of the wing tips"},
      {"stroke_angle_max_rad", "rad", "largest stroke angle of a direct drive whose wings clap"},
      {"induced_velocity_m_per_s", "m/s", "induced velocity that the mean lift leads to, times the share that counts"},
      {"hover_s", "s", "flight time until lift falls below the weight"},
      {"endurance_s", "s", "flight time until the battery's end"},
  }};
  return table;
}

int metric_index(std::string_view key) {
  const auto& table = metric_table();
  for (int m = 0; m < metric_count; ++m) {
    if (key == table[std::size_t(m)].key) return m;
  }
  return metric_count;
}

Reporting reporting_of(const Design<double>& d) {
  return {total_mass(d).value_or(absent), d.bench_torque_constant.value_or(absent)};
}

const char* lacking_of_heat(Metric metric, const Design<double>& design) {
  const MotorThermalDesign<double>& thermal = design.motor.thermal;
  switch (metric) {
    case Metric::winding_temperature_margin:
    case Metric::winding_temperature:
    case Metric::case_temperature:
      return thermal.resistance_winding ? nullptr : motor_thermal_key::resistance_winding.path;
    default: return nullptr;
  }
}

const char* missing_key(Metric metric, const Design<double>& design) {
  if (metric == Metric::added_mass_inertia_ratio && !design.aerodynamics.added_mass) return "aerodynamics.added_mass";
  switch (metric) {
    case Metric::hover:
      if (!design.mass) return "vehicle.mass";
      [[fallthrough]];
    case Metric::endurance: return has_battery(design.supply.type) ? nullptr : "supply.type = \"battery\"";
    case Metric::reynolds_number:
      return design.wing.planform.shape != PlanformShape::moments ? nullptr : "a wing.planform with a shape";
    case Metric::induced_velocity:
      return design.aerodynamics.induced_velocity ? nullptr : induced_velocity_key::share.path;
    case Metric::stroke_angle_max:
      if (design.transmission.type != TransmissionType::direct) return "transmission.type = \"direct\"";
      return design.aerodynamics.clap.amplitude ? nullptr : clap_and_fling_key::amplitude.path;
    case Metric::power_electronics:
      return design.electronics.efficiency || design.piezo.force_per_volt ? nullptr : electronics_key::efficiency.path;
    case Metric::power_hinge:
    case Metric::pitch_amplitude:
    case Metric::pitch_phase:
    case Metric::angle_of_attack_max: return follows_pitch_law(design) ? pitch_key::stiffness.path : nullptr;
    case Metric::lift_added_mass_share:
      if (follows_pitch_law(design)) return pitch_key::stiffness.path;
      return design.aerodynamics.added_mass ? nullptr : "aerodynamics.added_mass";
    default: return lacking_of_heat(metric, design);
  }
}

double error_scale(const Metrics<double>& metrics, Metric which) {
  const double size = std::abs(metrics[which]);
  switch (which) {
    case Metric::angle_of_attack_min:
    case Metric::angle_of_attack_max:
    case Metric::pitch_phase: return std::max(size, 90.0);
    case Metric::power_gear:
    case Metric::power_hinge:
    case Metric::power_electronics:
    case Metric::power_residual: return std::max(size, std::abs(metrics[Metric::power_electrical]));
    case Metric::lift_mean: return std::max(size, 1e-3 * metrics[Metric::lift_peak]);
    case Metric::lift_added_mass_share:
      return std::max({size, 1.0, 1e-3 * metrics[Metric::lift_peak] / std::abs(metrics[Metric::lift_mean])});
    case Metric::lift_to_weight:
      return std::max(size, 1e-3 * metrics[Metric::lift_peak] * std::abs(metrics[which] / metrics[Metric::lift_mean]));
    case Metric::crank_speed_min: return std::max(size, 1e-2 * metrics[Metric::crank_speed_max]);
    case Metric::current_mean:
      return std::isnan(metrics[Metric::rod_force_mean]) ? std::max(size, metrics[Metric::current_peak]) : size;
    case Metric::winding_temperature:
    case Metric::case_temperature:
    case Metric::winding_temperature_margin: return size + zero_celsius;
    default: return size;
  }
}

}  // namespace wingbeat
