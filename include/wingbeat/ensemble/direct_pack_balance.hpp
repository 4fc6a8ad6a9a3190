// Harmonic balance on SIMD lanes, as direct_balance() has it: the part of DirectPackOrbit that gives the first
// trajectory.
#pragma once

#include "wingbeat/ensemble/direct_pack_orbit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// Amplitude of the first harmonic of all that resists a harmonic motion of that speed amplitude [N m].
template <class L, int N>
L DirectPackOrbit<L, N>::resistance(const L& speed) const {
  L sum(0.0);
  for (const double sine : rule_.balance_sine) {
    const L now = L(sine) * speed;
    const L moment = aero_loads<false>(vehicle_.wings, now, L(1.0), L(1.0)).moment;
    sum = sum + L(sine) * (moment + load_free_friction(vehicle_.friction, now, L(1.0)));
  }
  return L(2.0 / double(balance_samples)) * sum + vehicle_.motor.viscous_damping * speed;
}

/// The responses' number, and the slowest: its speed and current, and the phase at which its stroke turns upward.
template <class L, int N>
void DirectPackOrbit<L, N>::balance() {
  const Motor<L>& m = vehicle_.motor;
  const L K = m.torque_constant, V = vehicle_.voltage;
  // R_a + j w L_a, and what the motor adds to the mechanical impedance, K^2 over it.
  const L real = circuit_resistance(vehicle_), imaginary = omega_drive_ * m.armature_inductance;
  const L size2 = L(0.0) + real * real + imaginary * imaginary;
  const L per_size = inverse_sqrt(size2), K_per_size2 = K * square(per_size);
  const L drive = K * V * per_size;
  const L motor_real = K * K_per_size2 * real, motor_imaginary = -(K * K_per_size2 * imaginary);
  const L inertia = m.inertia + vehicle_.wing_count * vehicle_.wing_inertia;
  const L stiffness = vehicle_.wing_count * vehicle_.spring.stiffness;
  const L reactive = omega_drive_ * inertia - stiffness * per_drive_ + motor_imaginary;
  const auto magnitude = [](const L& x, const L& y) { return sqrt(L(0.0) + x * x + y * y); };
  const auto surplus = [&](const L& resisting, const L& speed) {
    return drive - magnitude(resisting + motor_real * speed, reactive * speed);
  };

  // Below a speed at which even the largest drag coefficient leaves the drive a surplus, there is no response.
  const L b = m.viscous_damping;
  const CoefficientWave<L>& wave = vehicle_.wings.coefficients.drag;
  const L max_drag = L(0.5) * vehicle_.wings.air_density * vehicle_.wings.s3 * (abs(wave.offset) + abs(wave.amplitude));
  const L max_quadratic = L(1.01) * (max_drag + vehicle_.friction.quadratic);
  const auto has_surplus = [&](const L& speed) {
    const L max_moment = (b + vehicle_.friction.damping + motor_real + max_quadratic * speed) * speed;
    return magnitude(max_moment, reactive * speed) < L(0.99) * drive;
  };
  L high = L(1.001) * drive * inverse_of(magnitude(motor_real + b, reactive));
  L at_high = surplus(resistance(high), high);
  L low_bound = high, high_bound = high, at_low_bound(0.0), at_high_bound = at_high;
  responses_ = L(0.0);
  Mask searching = high > L(0.0);
  for (std::size_t n = 0; n < balance_speeds && any<L>(searching); ++n) {
    const L low = L(rule_.balance_ratio) * high, at_low = surplus(resistance(low), low);
    const Mask here = searching && at_low >= L(0.0) && at_high < L(0.0);
    responses_ = select<L>(here, responses_ + L(1.0), responses_);
    low_bound = select<L>(here, low, low_bound);
    high_bound = select<L>(here, high, high_bound);
    at_low_bound = select<L>(here, at_low, at_low_bound);
    at_high_bound = select<L>(here, at_high, at_high_bound);
    high = low;
    at_high = at_low;
    searching = searching && !has_surplus(low);
  }
  // Newton's method does the rest: a secant is enough.
  const L gap = at_low_bound - at_high_bound;
  const L part = select<L>(gap > L(0.0), at_low_bound * inverse_of(max(gap, L(1e-300))), L(0.5));
  speed_ = low_bound + part * (high_bound - low_bound);
  per_speed_ = inverse_of(max(speed_, L(1e-300)));

  // The velocity lags the voltage by the angles of both impedances.
  const L mechanical = resistance(speed_) * per_speed_ + motor_real;
  const L along = L(0.0) + real * mechanical - imaginary * reactive;
  const L across = L(0.0) + real * reactive + imaginary * mechanical;
  const L to_unit = inverse_of(max(magnitude(along, across), L(1e-300)));
  const L cosine = to_unit * along, sine = to_unit * across;
  phase_ = L(2.0) * atan(sine * inverse_of(max(L(1.0) + cosine, L(1e-12))));
  // The current, in phase with the velocity and ahead of it: (V - K speed) / (R_a + j w L_a), the speed being real.
  const L v_real = V * cosine - K * speed_, v_imaginary = V * sine;
  const L per_size2 = square(per_size);
  current_in_phase_ = per_size2 * (L(0.0) + v_real * real + v_imaginary * imaginary);
  current_ahead_ = per_size2 * (L(0.0) + v_imaginary * real - v_real * imaginary);
  per_current_ = K * inverse_of(max(drive, L(1e-300)));
}

/// The harmonic response from its reversal on, at the nodes.
template <class L, int N>
void DirectPackOrbit<L, N>::harmonic_trajectory() {
  const L angle = speed_ * per_drive_;
  start_[0] = -angle;
  start_[1] = L(0.0);
  if constexpr (N == 3) start_[2] = current_ahead_;
  for (std::size_t n = 0; n < nodes(); ++n) {
    const L sine(phase_sine_[n]), cosine(phase_cosine_[n]);
    beta_[n] = -(cosine * angle);
    omega_[n] = sine * speed_;
    if constexpr (N == 3) current_[n] = L(0.0) + sine * current_in_phase_ + cosine * current_ahead_;
  }
}

}  // namespace wingbeat
