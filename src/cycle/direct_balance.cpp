#include "wingbeat/cycle/direct_balance.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/root.hpp"
#include "wingbeat/cycle/static_balance.hpp"

namespace wingbeat {
namespace {

/// Amplitude of the first harmonic of all that resists a harmonic motion of speed amplitude Omega [N m].
double resistance(const Vehicle<double>& v, double speed) {
  constexpr int samples = 24;  // of a quarter; midpoints of a periodic function
  double sum = 0.0;
  for (int n = 0; n < samples; ++n) {
    const double sine = std::sin(0.5 * pi * (n + 0.5) / samples);
    const double now = speed * sine;
    sum +=
        sine * (aero_loads(v.wings, now).moment + load_free_friction(v.friction, now, 1.0) + v.motor.friction_torque);
  }
  return 2.0 * sum / samples + v.motor.viscous_damping * speed;
}

/// Amplitude of a piezo's force on a shaft that stands [N]: half of what \f$F = \kappa(V) V\f$ changes by within a
/// period. A compliant transmission passes on its share of that, the tip swinging:
/// \f[
/// \frac{k_\mathrm{s}}{|k_\mathrm{a} + k_\mathrm{s} - m_\mathrm{a} w^2 + \mathrm{j} w c_\mathrm{a}|}
/// \cdot \frac{F(V_0 + V) - F(V_0 - V)}{2}
/// \f]
double alternating_force(const Vehicle<double>& v, double w) {
  const Piezo<double>& p = v.piezo;
  const auto force = [&](double voltage) { return force_per_volt_at(p, voltage) * voltage; };
  const double half = 0.5 * (force(v.voltage_offset + v.voltage) - force(v.voltage_offset - v.voltage));
  if (!is_compliant(p)) return half;
  return half * p.series_stiffness / std::hypot(p.stiffness + p.series_stiffness - p.mass * square(w), w * p.damping);
}

}  // namespace

DirectBalance direct_balance(const Vehicle<double>& v) {
  using Complex = std::complex<double>;
  const Motor<double>& m = v.motor;
  const double w = two_pi * v.drive_frequency, K = m.torque_constant, V = v.voltage;
  const Complex j(0.0, 1.0);
  const bool piezo = is_given(v.piezo);
  const Complex electrical = piezo ? Complex(1.0) : m.armature_resistance + j * w * m.armature_inductance;
  const Complex from_motor = K * K / electrical;
  // A piezo acts on the stroke about where it is not bent.
  const double per_ratio = piezo ? 1.0 / v.piezo.transmission_ratio : 0.0;
  const double own_stiffness = piezo ? v.piezo.stiffness * square(per_ratio) : 0.0;
  const Complex drive = piezo ? Complex(force_per_volt_at(v.piezo, V) * V * per_ratio) : K * V / electrical;
  const double inertia = m.inertia + v.wing_count * v.wing_inertia;
  const double reactance = w * inertia - (v.wing_count * v.spring.stiffness + own_stiffness) / w;

  const double push = std::abs(drive);
  DirectBalance balance{piezo ? alternating_force(v, w) * per_ratio : push, breakaway_torque(v), {}};
  // |Z(Omega)| Omega = K V / |R_a + j w L_a|; the left side grows with Omega unless drag falls with speed.
  const auto impedance = [&](double speed) { return resistance(v, speed) / speed + j * reactance + from_motor; };
  const auto surplus = [&](double speed) { return push - std::abs(impedance(speed)) * speed; };
  constexpr double limit = 1e6;  // [rad/s], of an undamped actuator at resonance
  const double fastest = std::min(limit, push / std::abs(from_motor + m.viscous_damping + j * reactance));
  constexpr int speeds = 80;
  const double ratio = std::pow(1e-4, 1.0 / speeds);
  double high = 1.001 * fastest, at_high = surplus(high);
  for (int n = 0; n < speeds && fastest > 0.0; ++n) {
    const double low = high * ratio, at_low = surplus(low);
    if (at_low >= 0.0 && at_high < 0.0) {
      const double equal = bisect([&](double speed) { return surplus(speed) >= 0.0; }, low, high).before;
      const Complex speed = drive / impedance(equal);
      const Complex current = piezo ? Complex(0.0) : (V - K * speed) / electrical;
      balance.responses.insert(balance.responses.begin(), {speed / (j * w), speed, current});
    }
    high = low;
    at_high = at_low;
  }
  return balance;
}

double typical_current(const Vehicle<double>& v, const DirectBalance& balance) {
  if (!is_given(v.piezo)) return balance.drive_torque / v.motor.torque_constant;
  const double speed = balance.responses.empty() ? 0.0 : std::abs(balance.responses.back().speed);
  return two_pi * v.drive_frequency * v.piezo.capacitance * v.voltage +
         force_per_volt_at(v.piezo, v.voltage) * speed / v.piezo.transmission_ratio;
}

double typical_pitch(const Vehicle<double>& vehicle, double stroke_velocity) {
  return typical_pitch(vehicle, stroke_velocity, two_pi * vehicle.drive_frequency);
}

double typical_pitch(const Vehicle<double>& vehicle, double stroke_velocity, double angular_frequency) {
  const PitchingWings<double>& p = vehicle.pitch;
  const double w = angular_frequency;
  const double drag = 0.5 * vehicle.wings.air_density * normal_force_coefficient(vehicle.wings, p, 0.5 * pi);
  const double moment = (std::abs(p.mass_product) + p.air.rp) * w * stroke_velocity +
                        drag * centre_of_pressure(0.5 * pi) * p.moments.s22 * square(stroke_velocity);
  const double stiffness = is_clamped(p.hinge) ? p.torsion.stiffness : p.hinge.stiffness;
  const double rigidity = std::max(std::abs(stiffness - square(w) * (p.pitch_inertia + p.air.pp)), 0.2 * stiffness);
  // What a stiff hinge leaves of the pitch acts on nothing: its oscillations of that size need not be resolved.
  constexpr double least = 0.02;
  return std::min({std::max(moment / rigidity, least), is_clamped(p.hinge) ? 1.0 : farther_stop(p.hinge), 1.0}) + 1e-12;
}

void add_typical_wings(const Vehicle<double>& vehicle, double stroke_velocity, double angular_frequency,
                       Coordinates<double>& typical) {
  if (!pitches(vehicle)) return;
  typical.pitch_angle = typical.twist_angle = typical_pitch(vehicle, stroke_velocity, angular_frequency);
  typical.pitch_velocity = typical.twist_velocity = angular_frequency * typical.pitch_angle;
}

}  // namespace wingbeat
