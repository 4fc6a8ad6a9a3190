// The limits of the domain that a cycle exceeds, in words.
#include "wingbeat/core/text.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/parts/motor_thermal.hpp"

namespace wingbeat {
namespace {

using detail::format;

std::string describe(const DomainEvidence& e) {
  using Quantity = DomainEvidence::Quantity;
  switch (e.quantity) {
    case Quantity::angle_of_attack_min:
      return format("the angle of attack falls to %.4g deg (the coefficients hold from %.4g to %.4g deg)", e.value,
                    e.lowest, e.highest);
    case Quantity::angle_of_attack_max:
      return format("the angle of attack rises to %.4g deg (the coefficients hold from %.4g to %.4g deg)", e.value,
                    e.lowest, e.highest);
    case Quantity::angle_of_attack_range:
      return format("the angle of attack runs from %.4g to 90 deg (the coefficients hold from %.4g to %.4g deg)",
                    e.value, e.lowest, e.highest);
    case Quantity::stroke_angle:
      return format("the stroke angle reaches %.4g deg (the mechanism's law holds to %.4g deg)", e.value, e.highest);
    case Quantity::stroke_amplitude:
      return format("the stroke amplitude is %.4g deg (at most %.4g deg)", e.value, e.highest);
    case Quantity::wings_meet:
      return format("the stroke angle reaches %.4g deg (two wings on one body meet at %.4g deg)", e.value, e.highest);
    case Quantity::residual_share:
      return format("the formulation fails to conserve %.3g %% of the input power (at most %.3g %%)", 100.0 * e.value,
                    100.0 * e.highest);
    case Quantity::mechanism_efficiency:
      return format("the mechanism efficiency is %.4g %% (0 to 100 %%)", 100.0 * e.value);
    case Quantity::aerodynamic_power:
      return format("the wings take %.3g W from a motor output of %.3g W", e.value, e.highest);
    case Quantity::motor_efficiency: return format("the motor efficiency is %.4g %% (0 to 100 %%)", 100.0 * e.value);
    case Quantity::input_power: return format("the input power is %.3g W (positive where the motor drives)", e.value);
    case Quantity::flow_speed:
      return format("the wings reach %.4g m/s (incompressible flow to %.4g m/s)", e.value, e.highest);
    case Quantity::winding_temperature:
      return format("the winding heats up to %.4g degC (at most %.4g degC)", e.value, e.highest);
    case Quantity::thermal_runaway:
      return format("thermal runaway: the losses do not settle before copper melts at %.4g degC (at most %.4g degC)",
                    copper_melting_point - zero_celsius, e.highest);
    case Quantity::reynolds_number:
      return format(e.value < 10.0 ? "the Reynolds number is %.3g (the coefficients hold from %.6g to %.6g)"
                                   : "the Reynolds number is %.0f (the coefficients hold from %.6g to %.6g)",
                    e.value, e.lowest, e.highest);
    case Quantity::table_stroke_angle:
      return format("the stroke angle reaches %.4g deg (the table of loads holds to %.4g deg)", e.value, e.highest);
    case Quantity::table_flapping_velocity:
      return format("the flapping velocity reaches %.4g rad/s (the table of loads holds to %.4g rad/s)", e.value,
                    e.highest);
    case Quantity::table_pitch_angle:
      return format("the pitch angle reaches %.4g deg (the table of loads holds to %.4g deg)", e.value, e.highest);
  }
  return "";
}

}  // namespace

std::string describe(std::span<const DomainEvidence> evidence) {
  std::string text;
  for (const DomainEvidence& e : evidence) text += (text.empty() ? "" : "; ") + describe(e);
  return text;
}

std::string residual_warning(double share) {
  return format("the formulation rod-force fails to conserve %.3g %% of the input power; virtual-work conserves it",
                100.0 * share);
}

std::string added_mass_warning(double share, double suction) {
  return format(
      "%.3g %% of the mean lift comes from added mass, since %s of its force along the chord counts; with "
      "pitch.leading_edge_suction = 1 it has no mean lift",
      100.0 * share, suction > 0.0 ? format("%.3g %%", 100.0 * suction).c_str() : "none");
}

std::string winding_warning(double temperature, double allowed) {
  return format("the winding heats up to %.4g degC, above motor.winding_temperature_max = %.4g degC", temperature,
                allowed);
}

}  // namespace wingbeat
