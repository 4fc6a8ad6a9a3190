// What every general-purpose solver integrates: the right-hand side in doubles, by crank angle, and iterates until
// periodic.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::peers {

inline constexpr double periodic = 1e-6;  // an iterate that returns to its start within this, relatively, is the orbit
inline constexpr double coarse = 1e-4;    // tolerance of the first iterates, which only approach the orbit
inline constexpr double settled = 3e-2;   // change over a coarse iterate below which the real ones begin
inline constexpr int max_iterates = 60;
inline constexpr double first_step = 0.1;           // of crank angle, where a method does not choose its own
inline constexpr double iterate_start = -0.5 * pi;  // the lower dead centre

struct Steady {
  double lift = absent;       // mean [N]
  double power = absent;      // mean electrical [W]
  double frequency = absent;  // [Hz]
};

inline Steady steady_of(const Metrics<double>& m) {
  return {m[Metric::lift_mean], m[Metric::power_electrical], m[Metric::frequency]};
}

inline constexpr std::size_t all_states = 5;  // crank speed, current; time, lift impulse, charge

// d(state)/d(theta), every state divided by a scale of its own.
struct Peer {
  Vehicle<double> vehicle;
  CrankGeometry<double> geometry;
  std::array<double, all_states> scale;
  std::array<double, 2> guess;

  explicit Peer(const Vehicle<double>& v) : vehicle(v), geometry(geometry_of(v.transmission.slider_crank)) {
    const double omega = 0.6 * no_load_speed(v.motor, v.voltage);
    const double iterate = two_pi / omega;
    const double stall_current = v.voltage / v.motor.armature_resistance;
    const double stroke_velocity =
        v.transmission.slider_crank.crank_radius / v.transmission.slider_crank.hinge_offset * omega;
    scale = {omega, stall_current, iterate, 0.5 * v.wings.air_density * v.wings.s2 * square(stroke_velocity) * iterate,
             stall_current * iterate};
    guess = {1.0, 1.0 - v.motor.torque_constant * omega / v.voltage};
  }

  template <std::size_t N>
  void rates(double theta, const double* u, double* du) const {
    const double omega = u[0] * scale[0];
    const double i = u[1] * scale[1];
    const CrankKinematics<double> k = crank_kinematics(geometry, std::sin(theta), std::cos(theta));
    const double stroke = k.stroke_slope >= 0.0 ? 1.0 : -1.0;
    Mode<double> mode{.stroke = stroke};
    const MotionState<double> instant{{k, spring_moment(vehicle, k)}, omega, i, vehicle.voltage};
    const IntermediateTerms<double> terms = terms_at(vehicle, instant, mode);
    mode.force = terms.force_switch >= 0.0 ? 1.0 : -1.0;
    const Motion<double> m = motion_on(vehicle, instant, terms, mode);
    const double dt = 1.0 / omega;
    du[0] = m.crank_acceleration * dt / scale[0];
    du[1] = m.inductive_voltage / vehicle.motor.armature_inductance * dt / scale[1];
    if constexpr (N == all_states) {
      du[2] = dt / scale[2];
      du[3] = m.aero.lift * dt / scale[3];
      du[4] = i * dt / scale[4];
    }
  }

  Steady metrics(const double* u) const {
    const double period = u[2] * scale[2];
    return {u[3] * scale[3] / period, vehicle.voltage * u[4] * scale[4] / period, 1.0 / period};
  }
};

inline double change_of(const double* from, const double* to) {
  return std::max(std::abs(to[0] - from[0]) / std::abs(to[0]), std::abs(to[1] - from[1]));
}

// Iterates until periodic: `plain` takes the two states over a coarse iterate, `measured` all states over an iterate at
// the tolerance asked for (the quadratures count from zero). Both return false where they fail.
template <class Plain, class Measured>
inline Steady flap(const Peer& peer, bool start_coarse, const Plain& plain, const Measured& measured,
                   std::array<double, 2>* start = nullptr) {
  std::array<double, all_states> u{peer.guess[0], peer.guess[1]};
  int iterates = 0;
  for (double change = 1.0; start_coarse && change > settled; ++iterates) {
    const std::array<double, 2> from{u[0], u[1]};
    if (iterates == max_iterates || !plain(iterates, u.data())) return {};
    change = change_of(from.data(), u.data());
  }
  for (; iterates < max_iterates; ++iterates) {
    const std::array<double, 2> from{u[0], u[1]};
    u[2] = u[3] = u[4] = 0.0;
    if (!measured(iterates, u.data())) return {};
    if (change_of(from.data(), u.data()) < periodic) {
      if (start) *start = {u[0], u[1]};
      return peer.metrics(u.data());
    }
  }
  return {};
}

}  // namespace wingbeat::peers
