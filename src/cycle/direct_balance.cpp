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

}  // namespace

DirectBalance direct_balance(const Vehicle<double>& v) {
  using Complex = std::complex<double>;
  const Motor<double>& m = v.motor;
  const double w = two_pi * v.drive_frequency, K = m.torque_constant, V = v.voltage;
  const Complex j(0.0, 1.0);
  const Complex electrical = m.armature_resistance + j * w * m.armature_inductance;
  const Complex from_motor = K * K / electrical;
  const double inertia = m.inertia + v.wing_count * v.wing_inertia;
  const double reactance = w * inertia - v.wing_count * v.spring.stiffness / w;

  DirectBalance balance{K * V / std::abs(electrical), breakaway_torque(v), {}};
  // |Z(Omega)| Omega = K V / |R_a + j w L_a|; the left side grows with Omega unless drag falls with speed.
  const auto impedance = [&](double speed) { return resistance(v, speed) / speed + j * reactance + from_motor; };
  const auto surplus = [&](double speed) { return balance.drive_torque - std::abs(impedance(speed)) * speed; };
  const double fastest = balance.drive_torque / std::abs(from_motor + m.viscous_damping + j * reactance);
  constexpr int speeds = 80;
  const double ratio = std::pow(1e-4, 1.0 / speeds);
  double high = 1.001 * fastest, at_high = surplus(high);
  for (int n = 0; n < speeds && fastest > 0.0; ++n) {
    const double low = high * ratio, at_low = surplus(low);
    if (at_low >= 0.0 && at_high < 0.0) {
      const double equal = bisect([&](double speed) { return surplus(speed) >= 0.0; }, low, high).before;
      const Complex speed = K * V / (electrical * impedance(equal));
      balance.responses.insert(balance.responses.begin(), {speed / (j * w), speed, (V - K * speed) / electrical});
    }
    high = low;
    at_high = at_low;
  }
  return balance;
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
  const double rigidity =
      std::max(std::abs(p.hinge.stiffness - square(w) * (p.pitch_inertia + p.air.pp)), 0.2 * p.hinge.stiffness);
  // What a stiff hinge leaves of the pitch acts on nothing: its oscillations of that size need not be resolved.
  constexpr double least = 0.02;
  return std::min({std::max(moment / rigidity, least), p.hinge.stop, 1.0}) + 1e-12;
}

}  // namespace wingbeat
