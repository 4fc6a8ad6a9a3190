#include "wingbeat/flight/body_loads.hpp"

#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/parts/flow_strips.hpp"

namespace wingbeat {
namespace {

/// Adds forces along e_t and n, and the same times the radius, of the wings of a mount.
void add_mount(const WingMount& mount, const WingAxes<double>& axes, const MountLoads<double>& loads,
               double pitch_moment, BodyLoads& sum) {
  Triple force, by_radius, about_span;
  for (std::size_t k = 0; k < 3; ++k) {
    force[k] = loads.ahead * axes.ahead[k] + loads.down * axes.down[k];
    by_radius[k] = loads.ahead_by_radius * axes.ahead[k] + loads.down_by_radius * axes.down[k];
    // A positive pitch turns about s e_r.
    about_span[k] = -pitch_moment * mount.side * axes.span[k];
  }
  add_force(mount.shoulder, force, sum);
  const Triple moment = cross(axes.span, by_radius);
  for (std::size_t k = 0; k < 3; ++k) sum.moment[k] += moment[k] + about_span[k];
}

/// Loads of a mount's share of wings on hinges, and their moment about the pitch axis.
MountLoads<double> hinged_loads(const Vehicle<double>& v, const PitchState<double>& state, const PitchMotion<double>& m,
                                const Mode<double>& mode, const WingMount& mount, const StripDrift<double>& drift,
                                double& pitch_moment) {
  const BladeElement<double>& w = v.wings;
  const PitchingWings<double>& p = v.pitch;
  const double even = even_normal_force(w, p, state.psi);
  TranslationLoads<double> strips;
  const ChordwiseForce<double> along = add_strips_in_flow(w, p, mount, drift, state, mode.stroke, even, strips);
  TranslationLoads<double> tips;
  add_tip_drag(w, state, mode.stroke, centre_of_pressure(p, m.aero.angle_of_attack) - p.axis, tips);
  // What the rotation and the air's inertia add is the same on every wing.
  const auto [rotation, damping] = pitch_rotation(w, p, p.moments.s40, state, mode.stroke, mode.turn);
  const double turning = m.stroke_acceleration * state.cos_psi - state.stroke_velocity * state.velocity * state.sin_psi;
  const double normal = strips.normal + mount.share * (tips.normal + rotation * p.moments.s21 + p.air.r * turning +
                                                       p.air.p * m.pitch_acceleration);
  const double by_radius = strips.stroke_moment + mount.share * (tips.stroke_moment + rotation * p.moments.s22 +
                                                                 p.air.rr * turning + p.air.rp * m.pitch_acceleration);
  pitch_moment =
      mount.sense *
      (strips.pitch_moment + mount.share * (tips.pitch_moment + (0.5 - p.axis) * rotation * p.moments.s31 + damping));
  // Of the angles of the vehicle; ahead is each wing's own.
  const double sin_psi = state.sin_psi, cos_psi = state.cos_psi, sense = mount.sense;
  MountLoads<double> loads;
  loads.ahead = sense * (along.force * sin_psi - normal * cos_psi);
  loads.down = normal * sin_psi + along.force * cos_psi;
  loads.ahead_by_radius = sense * (along.by_radius * sin_psi - by_radius * cos_psi);
  loads.down_by_radius = by_radius * sin_psi + along.by_radius * cos_psi;
  return loads;
}

}  // namespace

BodyLoads wing_loads_on_body(const Vehicle<double>& v, const FullState<double>& instant, const PitchMotion<double>& m,
                             const Mode<double>& mode) {
  BodyLoads sum;
  const OnsetFlow& flow = *v.wings.flow;
  const double beta = instant.configuration.stroke_angle, clap = clap_factor(v, instant.configuration, mode);
  const PitchState<double> state =
      pitch_state(instant.pitch_angle, instant.pitch_velocity, m.stroke_velocity, clap, beta);
  for (std::size_t n = 0; n < flow.count; ++n) {
    const WingMount& mount = flow.mounts[n];
    const WingAxes<double> axes = wing_axes(mount, beta);
    const StripDrift<double> drift = strip_drift(flow, mount, axes);
    double pitch_moment = 0.0;
    MountLoads<double> loads;
    if (pitches(v)) {
      loads = hinged_loads(v, state, m, mode, mount, drift, pitch_moment);
    } else {
      loads = loads_of_mount(v.wings.coefficients, 0.5 * v.wings.air_density, v.wings.wake, mount, drift,
                             m.aero.angle_of_attack, m.stroke_velocity, mode.stroke, clap);
      const double tip = mount.share * mount.sense * mode.stroke * clap * 0.5 * v.wings.air_density *
                         v.wings.tip.profile_drag * square(m.stroke_velocity);
      loads.ahead -= tip * v.wings.tip.s2;
      loads.ahead_by_radius -= tip * v.wings.tip.s3;
    }
    add_mount(mount, axes, loads, pitch_moment, sum);
  }
  return sum;
}

}  // namespace wingbeat
