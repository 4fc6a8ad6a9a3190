// A transmission that is no slider-crank, and a vehicle that has it.
#pragma once

#include <cmath>

#include "vehicle/random_vehicle.hpp"
#include "wingbeat/parts/transmission.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// beta = mean + amplitude (sin x + second sin 2x), x = theta + phase; friction acts on the wing moment's reaction at
/// the radius g, and power is conserved.
template <Scalar S>
struct StrokeLaw {
  S amplitude;  ///< [rad]
  S second;     ///< [1]
  S phase;      ///< [rad]
  S mean;       ///< [rad]
  S radius;     ///< [m]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.amplitude, self.second, self.phase, self.mean, self.radius);
  }
};

template <Scalar S>
CrankKinematics<S> crank_kinematics(const StrokeLaw<S>& law, const S& sin_theta, const S& cos_theta) {
  using std::cos;
  using std::sin;
  const S sine = sin_theta * cos(law.phase) + cos_theta * sin(law.phase);
  const S cosine = cos_theta * cos(law.phase) - sin_theta * sin(law.phase);
  const S sine2 = S(2.0) * sine * cosine, cosine2 = square(cosine) - square(sine);
  CrankKinematics<S> k;
  k.stroke_offset = law.mean + law.amplitude * (sine + law.second * sine2);
  k.tan_stroke = S(0.0);
  k.stroke_slope = law.amplitude * (cosine + S(2.0) * law.second * cosine2);
  k.stroke_second_derivative = -law.amplitude * (sine + S(4.0) * law.second * sine2);
  k.wing_jacobian = law.radius;
  k.crank_jacobian = law.radius * k.stroke_slope;
  return k;
}

inline void validate(const StrokeLaw<double>& law) {
  require(law.amplitude > 0.0, "transmission.amplitude", "must be > 0", "rad", law.amplitude);
  require(law.radius > 0.0, "transmission.radius", "must be > 0", "m", law.radius);
}

inline Reversals reversals(const StrokeLaw<double>& law) { return find_reversals(law); }

/// Extremes where cos x + 2 second cos 2x = 0: of the two roots of 4 second c^2 + c - 2 second the one that is a
/// cosine.
template <Scalar S>
S stroke_amplitude(const StrokeLaw<S>& law) {
  using std::sqrt;
  const S q = law.second;
  const S cosine = S(4.0) * q / (S(1.0) + sqrt(S(1.0) + S(32.0) * q * q));
  return law.amplitude * sqrt(S(1.0) - cosine * cosine) * (S(1.0) + S(2.0) * q * cosine);
}

template <Scalar S>
S typical_stroke_slope(const StrokeLaw<S>& law) {
  return law.amplitude;
}
template <Scalar S>
S typical_lever(const StrokeLaw<S>& law) {
  return law.radius;
}

template <Scalar S>
S typical_crank_lever(const StrokeLaw<S>& law) {
  return law.radius * law.amplitude;
}
inline double stroke_reach(const StrokeLaw<double>& law) { return stroke_amplitude(law) + std::abs(law.mean); }

/// The members of Vehicle, with a StrokeLaw for its transmission.
template <Scalar S>
struct StrokeLawVehicle {
  S voltage;
  Motor<S> motor;
  StrokeLaw<S> transmission;
  Friction<S> friction;
  HingeSpring<S> spring;
  S wing_count, wing_inertia;
  BladeElement<S> wings;
  S source_resistance = S(0);
  S drive_frequency = S(0);
  MotorThermal<S> thermal;
  S motors = S(1);
  S load_torque = S(0);
  WingLimits<S> wing_limits = {};
  Electronics<S> electronics = {};

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.voltage, self.motor, self.transmission, self.friction, self.spring, self.wing_count,
               self.wing_inertia, self.wings, self.source_resistance, self.drive_frequency, self.thermal, self.motors,
               self.load_torque, self.wing_limits, self.electronics);
  }
};

/// The reference vehicle with a stroke law of about its stroke.
inline StrokeLawVehicle<double> stroke_law_vehicle(const StrokeLaw<double>& law) {
  const Vehicle<double> v = resolve(reference_design());
  StrokeLawVehicle<double> w{v.voltage,    v.motor,        law,     v.friction,          v.spring,
                             v.wing_count, v.wing_inertia, v.wings, v.source_resistance, v.drive_frequency,
                             v.thermal};
  w.spring.stiffness = 6e-4;
  return w;
}

}  // namespace wingbeat
