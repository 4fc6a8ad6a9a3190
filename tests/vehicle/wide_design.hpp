// Random designs of boxes far wider than the reference box, one difficulty each, and how far two sets of metrics are
// apart.
#pragma once

#include <array>
#include <string>

#include "vehicle/random_vehicle.hpp"
#include "wingbeat/cycle/metrics.hpp"

namespace wingbeat {

enum class WideBox {
  around_reference,  ///< every parameter within 50 % of the reference vehicle's
  heavy_rotor,
  light_rotor,
  strong_springs,
  small_inductance,
  near_stall,
  any_friction,  ///< all friction laws, factors of two
  wide,          ///< all friction laws, factors of five
  long_crank,    ///< the crank almost as long as the rod
  pitch_stop,
  wingless,
  direct
};
inline constexpr std::array<const char*, 12> wide_boxes = {
    "around the reference", "heavy rotor", "light rotor", "strong springs", "small inductance", "near stall",
    "any friction",         "wide",        "long crank",  "pitch stop",     "wingless",         "direct drive"};

inline Design<double> wide_design(WideBox box, std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto logarithmic = [&](double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); };
  if (box == WideBox::direct) return random_direct_design(random, uniform(0.0, 1.0) < 0.3);
  if (box == WideBox::any_friction) return random_design(random, 2.0);
  if (box == WideBox::wide) return random_design(random, 5.0);
  Design<double> d = box_design(random);
  const auto vary = [&](double& value) { value *= uniform(0.72, 1.15); };  // with the box's own 30 %: about 50 %
  Motor<double>& m = d.motor.constants;
  for (double* value : {&m.armature_resistance, &m.armature_inductance, &m.torque_constant, &m.inertia,
                        &m.viscous_damping, &d.transmission.crank_radius, &*d.transmission.hinge_offset,
                        &d.friction.coefficient, &d.wing.inertia, &d.wing.planform.s2, &d.wing.planform.s3}) {
    vary(*value);
  }
  switch (box) {
    case WideBox::heavy_rotor: m.inertia = logarithmic(1e-6, 1e-3); break;
    case WideBox::light_rotor: m.inertia = logarithmic(1e-8, 1e-7); break;
    case WideBox::strong_springs:
      d.spring.stiffness = logarithmic(2e-3, 2e-2);
      d.supply.voltage = uniform(3.0, 20.0);
      break;
    case WideBox::small_inductance:
      m.armature_inductance = uniform(0.0, 1.0) < 0.2 ? 0.0 : logarithmic(1e-8, 1e-3);
      break;
    case WideBox::near_stall: d.supply.voltage = logarithmic(0.1, 1.0); break;
    case WideBox::long_crank:
      d.transmission.rod_length = d.transmission.crank_radius * uniform(1.1, 2.0);
      d.transmission.formulation = Formulation::virtual_work;
      break;
    case WideBox::pitch_stop: d.aerodynamics.angle_of_attack_min = uniform(0.1, 1.3); break;
    case WideBox::wingless:
      d.wing.inertia = d.aerodynamics.air_density = 0.0;
      d.spring.stiffness.reset();
      m.inertia = logarithmic(1e-9, 1e-4);
      m.armature_inductance = uniform(0.0, 1.0) < 0.2 ? 0.0 : logarithmic(1e-7, 3e-1);
      break;
    default: break;
  }
  return d;
}

/// How far `m` is from `exact`: the largest deviation of a metric beside its error_scale(), the Floquet multiplier left
/// out; infinite where a metric is absent from one of them.
inline double metrics_apart(const Metrics<double>& m, const Metrics<double>& exact, int* where = nullptr) {
  double largest = 0.0;
  for (int k = 0; k < metric_count; ++k) {
    if (Metric(k) == Metric::floquet_multiplier_max) continue;
    const double a = m[Metric(k)], b = exact[Metric(k)];
    if (a == b || (std::isnan(a) && std::isnan(b))) continue;
    const bool comparable = std::isfinite(a) && std::isfinite(b);
    const double off = comparable ? std::abs(a - b) / error_scale(exact, Metric(k)) : HUGE_VAL;
    if (off > largest) {
      largest = off;
      if (where) *where = k;
    }
  }
  return largest;
}

}  // namespace wingbeat
