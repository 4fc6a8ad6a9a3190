// What the air does to the strips of wings under the pitch law on a body that moves; model.md section 18.
#pragma once

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/force_coefficients.hpp"
#include "wingbeat/parts/induced_velocity.hpp"
#include "wingbeat/parts/onset_flow.hpp"

namespace wingbeat {

/// Forces of a wing's strips along its own e_t and n [N], and the same times the radius [N m].
template <Scalar S>
struct MountLoads {
  S ahead = S(0), down = S(0), ahead_by_radius = S(0), down_by_radius = S(0);
};

/// Beyond 90 degrees, where the trailing edge meets the air first, coefficients of waves go over to those of the chord
/// turned round within so much [rad]: to \f$-C_\mathrm{L}(\pi - \alpha)\f$ and \f$C_\mathrm{D}(\pi - \alpha)\f$.
inline constexpr double turning_range = pi / 6.0;

/// C_L and C_D [1] at any angle of attack, -180 to 180 degrees; those of force_coefficients() up to 90 degrees.
template <Scalar S>
LiftAndDrag<S> coefficients_all_round(const ForceCoefficients<S>& c, const S& alpha) {
  const double angle = value_of(alpha), beyond = std::abs(angle) - 0.5 * pi;
  if (beyond <= 0.0) return force_coefficients<true>(c, alpha);
  const S turned = S(angle > 0.0 ? pi : -pi) - alpha;
  const LiftAndDrag<S> of_turned = force_coefficients<true>(c, turned);
  const LiftAndDrag<S> folded{-of_turned.lift, of_turned.drag};
  if (beyond >= turning_range || c.table) return folded;
  const LiftAndDrag<S> straight = force_coefficients<true>(c, alpha);
  const S part = (S(angle > 0.0 ? 1.0 : -1.0) * alpha - S(0.5 * pi)) * S(1.0 / turning_range);
  const S share = square(part) * part * (S(10.0) - part * (S(15.0) - S(6.0) * part));
  return {straight.lift + share * (folded.lift - straight.lift), straight.drag + share * (folded.drag - straight.drag)};
}

/// Of the wings of a mount at the geometric angle of attack alpha [rad] that the pitch law gives, the stroke velocity
/// beta' [rad/s] of the sign `stroke`. With the strip's velocity (u, w) against the air along e_t and n, the angle of
/// flow_angle() and \f$\psi = s (\alpha - \pi/2)\f$:
/// \f[
/// F_t = \tfrac12 \rho\, U \left( s\, C_\mathrm{L} w - C_\mathrm{D} u \right) c\,\mathrm{d}r, \qquad
/// F_n = \tfrac12 \rho\, U \left( -s\, C_\mathrm{L} u - C_\mathrm{D} w \right) c\,\mathrm{d}r
/// \f]
/// C_L less \f$C_\mathrm{L}(0)\, w^2/U^2\f$, and the factor of clap and fling where flapping makes the flow, as in
/// loads_in_wake(); the induced velocity counts in w.
template <Scalar S>
MountLoads<S> loads_of_mount(const ForceCoefficients<S>& coefficients, const S& half_density,
                             const InducedVelocity<S>& wake, const WingMount& mount, const StripDrift<S>& drift,
                             const S& alpha, const S& stroke_velocity, const S& stroke, const S& clap) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const S along_the_flow = force_coefficients<true>(coefficients, S(0.0)).lift;
  const S own_stroke = S(mount.sense) * stroke, own_velocity = S(mount.sense) * stroke_velocity;
  const S psi = own_stroke * (alpha - S(0.5 * pi) + S(mount.incidence)), sin_psi = sin(psi), cos_psi = cos(psi);
  MountLoads<S> sum;
  for (const WakeStrip<S>& strip : wake.strips.at) {
    const S& r = strip.radius;
    const S u = r * (own_velocity + drift.u1) + drift.u0, w = drift.w0 + drift.w1 * r - wake.velocity;
    const S square_of_speed = square(u) + square(w) + S(1e-300), speed = sqrt(square_of_speed);
    const LiftAndDrag<S> of_set = coefficients_all_round(coefficients, flow_angle(u, w, sin_psi, cos_psi, own_stroke));
    const S sine2 = square(w) / square_of_speed;
    const S C_L = own_stroke * (of_set.lift - along_the_flow * sine2), C_D = of_set.drag;
    const S closeness = S(1.0) + (clap - S(1.0)) * (S(1.0) - sine2);
    const S pressure = half_density * S(mount.share) * speed * strip.area * closeness;
    const S ahead = pressure * (C_L * w - C_D * u), down = -(pressure * (C_L * u + C_D * w));
    sum.ahead = sum.ahead + ahead;
    sum.down = sum.down + down;
    sum.ahead_by_radius = sum.ahead_by_radius + ahead * r;
    sum.down_by_radius = sum.down_by_radius + down * r;
  }
  return sum;
}

/// Lift normal to the stroke plane [N] and moment against a positive stroke velocity [N m] of all wings.
template <Scalar S>
struct FlowTotals {
  S lift = S(0), moment = S(0);
};
template <Scalar S>
[[gnu::noinline]] FlowTotals<S> loads_in_flow(const ForceCoefficients<S>& coefficients, const S& half_density,
                                              const InducedVelocity<S>& wake, const OnsetFlow& flow, const S& alpha,
                                              const S& stroke_angle, const S& stroke_velocity, const S& stroke,
                                              const S& clap) {
  FlowTotals<S> totals;
  for (std::size_t n = 0; n < flow.count; ++n) {
    const WingMount& mount = flow.mounts[n];
    const MountLoads<S> loads =
        loads_of_mount(coefficients, half_density, wake, mount,
                       strip_drift(flow, mount, wing_axes(mount, stroke_angle)), alpha, stroke_velocity, stroke, clap);
    totals.lift = totals.lift - loads.down;
    totals.moment = totals.moment - S(mount.sense) * loads.ahead_by_radius;
  }
  totals.moment = totals.moment + S(flow.reaction_moment);
  return totals;
}

}  // namespace wingbeat
