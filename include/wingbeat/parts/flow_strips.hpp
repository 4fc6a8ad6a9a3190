// What the air does to the strips of wings under the pitch law on a body that moves; model.md section 18.
#pragma once

#include <cmath>
#include <type_traits>

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
  using std::abs;
  const S beyond = abs(alpha) - S(0.5 * pi);
  const LiftAndDrag<S> straight = force_coefficients<true>(c, alpha);
  if (!any<S>(beyond > S(0.0))) return straight;
  const S turned = select<S>(alpha > S(0.0), S(pi), S(-pi)) - alpha;
  const LiftAndDrag<S> of_turned = force_coefficients<true>(c, turned);
  S part = select<S>(beyond < S(turning_range), S(beyond * S(1.0 / turning_range)), S(1.0));
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (c.table) part = S(1.0);
  }
  S share = square(part) * part * (S(10.0) - part * (S(15.0) - S(6.0) * part));
  share = select<S>(beyond > S(0.0), share, S(0.0));
  return {straight.lift - share * (straight.lift + of_turned.lift),
          straight.drag + share * (of_turned.drag - straight.drag)};
}

/// Adds a strip that moves with (u, w) against the air along e_t and n, of a wing whose chord is turned by psi, to the
/// loads of its mount. `scale`: half of rho times the mount's share; `along_the_flow`: C_L(0).
template <Scalar S>
void add_strip_of_mount(const ForceCoefficients<S>& coefficients, const S& scale, const WakeStrip<S>& strip, const S& u,
                        const S& w, const S& sin_psi, const S& cos_psi, const S& stroke, const S& along_the_flow,
                        const S& clap, MountLoads<S>& sum) {
  using std::sqrt;
  const S square_of_speed = square(u) + square(w) + S(1e-300), speed = sqrt(square_of_speed);
  const LiftAndDrag<S> of_set = coefficients_all_round(coefficients, flow_angle(u, w, speed, sin_psi, cos_psi, stroke));
  const S sine2 = square(w) / square_of_speed;
  const S C_L = stroke * (of_set.lift - along_the_flow * sine2), C_D = of_set.drag;
  const S closeness = S(1.0) + (clap - S(1.0)) * (S(1.0) - sine2);
  const S pressure = scale * speed * strip.area * closeness;
  const S ahead = pressure * (C_L * w - C_D * u), down = -(pressure * (C_L * u + C_D * w));
  sum.ahead = sum.ahead + ahead;
  sum.down = sum.down + down;
  sum.ahead_by_radius = sum.ahead_by_radius + ahead * strip.radius;
  sum.down_by_radius = sum.down_by_radius + down * strip.radius;
}

namespace detail {

/// What a mount's strips have in common.
template <Scalar S>
struct MountMotion {
  S stroke, velocity;  ///< sign and value of the wing's own stroke velocity [rad/s]
  S sin_psi, cos_psi;  ///< of its chord
  S scale, along_the_flow, clap;
};
/// The strips of a mount of coefficients without a table, several at a time.
MountLoads<double> strips_of_mount(const ForceCoefficients<double>& coefficients, const InducedVelocity<double>& wake,
                                   const StripDrift<double>& drift, const MountMotion<double>& motion);

}  // namespace detail

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
  const S own_stroke = S(mount.sense) * stroke;
  const S psi = own_stroke * (alpha - S(0.5 * pi) + S(mount.incidence));
  const detail::MountMotion<S> motion{
      own_stroke, S(mount.sense) * stroke_velocity, sin(psi),
      cos(psi),   half_density * S(mount.share),    force_coefficients<true>(coefficients, S(0.0)).lift,
      clap};
  if constexpr (std::is_same_v<S, double>) {
    if (!coefficients.table) return detail::strips_of_mount(coefficients, wake, drift, motion);
  }
  MountLoads<S> sum;
  for (const WakeStrip<S>& strip : wake.strips.at) {
    const S u = strip.radius * (motion.velocity + drift.u1) + drift.u0;
    const S w = drift.w0 + drift.w1 * strip.radius - wake.velocity;
    add_strip_of_mount(coefficients, motion.scale, strip, u, w, motion.sin_psi, motion.cos_psi, motion.stroke,
                       motion.along_the_flow, motion.clap, sum);
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
