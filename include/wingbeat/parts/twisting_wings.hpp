// Wings that twist along their span, beside the hinge about which they pitch or in its place: sums over strips, each of
// which feels the velocity that it has; model.md section 16.
#pragma once

#include "wingbeat/parts/pitching_wings.hpp"

namespace wingbeat {

/// Twist of the tip against the root, \f$\tau\f$ [rad], and its rate [rad/s].
template <Scalar S>
struct TwistState {
  S angle;
  S velocity;
};

/// Inertia of stroke, pitch and twist [kg m2], sums over the strips of section 12's with the station x of each:
/// \f[
/// M_{b\tau} = \sum x M_{bp}, \qquad M_{p\tau} = \sum x M_{pp}, \qquad M_{\tau\tau} = \sum x^2 M_{pp}
/// \f]
template <Scalar S>
struct TwistInertia : PitchInertia<S> {
  S bt, pt, tt;
};

/// How the lift follows accelerations, or its impulse velocities that jump: \f$L_b\f$ [N s2/rad] and so on.
template <Scalar S>
struct LiftByMotion {
  S stroke, pitch, twist;
};

/// What strips add up to; `loads` oppose positive velocities.
template <Scalar S>
struct StripSums {
  TwistInertia<S> inertia;
  PitchAeroLoads<S> aero;  ///< its pitch_moment of the hinge
  S twist_moment;          ///< of the air against tau [N m]
  S h_b, h_p, h_t;         ///< of the inertia, at constant velocities [N m]
  S steady_lift;           ///< without accelerations [N]
  LiftByMotion<S> lift;
  S chordwise_lift;  ///< chordwise_lift() [N]
};

/// Sums over the strips of wings with `stroke_inertia` N_w J_w [kg m2]; `root` holds pitch and pitch velocity of the
/// hinge. The local pitch \f$\psi + x \tau\f$ and its rate take the place of psi and psi' in each strip. The mass is
/// spread as that of a membrane of even density.
template <Scalar S>
StripSums<S> strip_sums(const BladeElement<S>& w, const PitchingWings<S>& p, const S& stroke_inertia,
                        const PitchState<S>& root, const TwistState<S>& twist, const S& stroke) {
  const S none(0.0), density = value_of(p.air.rr) > 0.0 ? w.air_density : none;
  const S inertia_per_s30 = p.pitch_inertia / p.moments.s30, product_per_s21 = p.mass_product / p.moments.s21;
  const S& beta_rate = root.stroke_velocity;
  StripSums<S> sum{{{stroke_inertia, none, none}, none, none, none},
                   {none, none, none, none, none},
                   none,
                   none,
                   none,
                   none,
                   none,
                   {none, none, none},
                   none};
  for (std::size_t k = 0; k < p.torsion.strips->position.size(); ++k) {
    const WingStrip<S> strip = strip_of(p.torsion, k);
    const S& x = strip.station;
    const PitchState<S> state =
        pitch_state<S>(root.psi + x * twist.angle, root.velocity + x * twist.velocity, beta_rate, root.clap);
    const PitchAddedMass<S> air = pitch_added_mass(density, strip.moments, p.axis);
    const S own = inertia_per_s30 * strip.moments.s30, product = product_per_s21 * strip.moments.s21;

    const S bp = (product + air.rp) * state.cos_psi, pp = own + air.pp;
    sum.inertia.bb = sum.inertia.bb + own * square(state.sin_psi) + air.rr * square(state.cos_psi);
    sum.inertia.bp = sum.inertia.bp + bp;
    sum.inertia.pp = sum.inertia.pp + pp;
    sum.inertia.bt = sum.inertia.bt + x * bp;
    sum.inertia.pt = sum.inertia.pt + x * pp;
    sum.inertia.tt = sum.inertia.tt + square(x) * pp;
    const S sc = (own - air.rr) * state.sin_psi * state.cos_psi, h_p = -sc * square(beta_rate);
    sum.h_b = sum.h_b + S(2.0) * sc * beta_rate * state.velocity -
              (product + air.rp) * state.sin_psi * square(state.velocity);
    sum.h_p = sum.h_p + h_p;
    sum.h_t = sum.h_t + x * h_p;

    const PitchAeroLoads<S> aero =
        aero_loads_of(w, p, strip.s2, strip.s3, strip.moments, state, stroke, sign_of(state.velocity),
                      [&](const AngleOfAttack<S>& alpha, TranslationLoads<S>& in_wake) {
                        const S r = strip.s3 / strip.s2, area = strip.s2 / square(r);
                        add_strip_in_wake(w, p, {r, area, strip.moments.s22 / strip.s2}, state, stroke, alpha,
                                          even_normal_force(w, p, state.psi), in_wake);
                      });
    sum.aero.normal_force = sum.aero.normal_force + aero.normal_force;
    sum.aero.stroke_moment = sum.aero.stroke_moment + aero.stroke_moment;
    sum.aero.pitch_moment = sum.aero.pitch_moment + aero.pitch_moment;
    sum.aero.power = sum.aero.power + aero.power;
    sum.twist_moment = sum.twist_moment + x * aero.pitch_moment;

    const S momentum = air.r * beta_rate * state.cos_psi + air.p * state.velocity;
    const S chordwise = momentum * state.velocity * state.cos_psi;
    sum.chordwise_lift = sum.chordwise_lift + chordwise;
    sum.steady_lift = sum.steady_lift + aero.tangential_lift - p.edge_suction * chordwise -
                      (aero.normal_force - air.r * beta_rate * state.velocity * state.sin_psi) * state.sin_psi;
    const S by_pitch = -air.p * state.sin_psi;
    sum.lift.stroke = sum.lift.stroke - air.r * state.cos_psi * state.sin_psi;
    sum.lift.pitch = sum.lift.pitch + by_pitch;
    sum.lift.twist = sum.lift.twist + x * by_pitch;
  }
  sum.aero.angle_of_attack = S(0.5 * pi) + stroke * (root.psi + S(reported_station) * twist.angle);
  return sum;
}

/// Kinetic energy [J] of stroke, pitch and twist.
template <Scalar S>
S kinetic_energy(const TwistInertia<S>& m, const PitchState<S>& root, const S& twist_velocity) {
  return kinetic_energy(static_cast<const PitchInertia<S>&>(m), root) +
         twist_velocity * (m.bt * root.stroke_velocity + m.pt * root.velocity + S(0.5) * m.tt * twist_velocity);
}

/// Wings that twist, as the stroke sees them.
template <Scalar S>
struct TwistingWings : WingsAtPitch<S> {
  S twist_free;      ///< \f$\ddot\tau_0\f$ of a stroke at constant velocity [rad/s2]
  S twist_coupling;  ///< of tau'' to beta'' [1]
  S torsion_loss;    ///< [W]
  S steady_lift;
  LiftByMotion<S> lift;
  S chordwise_lift;
};

/// wings_at_pitch() of wings that twist: the equations of motion of pitch and twist, or of twist alone where the pitch
/// is held, solved for psi'' and tau'' at any beta''.
/// \f[
/// \begin{pmatrix} M_{pp} & M_{p\tau} \cr M_{p\tau} & M_{\tau\tau} \end{pmatrix}
/// \begin{pmatrix} \ddot\psi \cr \ddot\tau \end{pmatrix} = -\begin{pmatrix} h_p + M_\mathrm{h} + M_\mathrm{pitch} \cr
/// h_\tau + k_\tau \tau + c_\tau \dot\tau + \sum x M_\mathrm{pitch} \end{pmatrix}
/// - \begin{pmatrix} M_{bp} \cr M_{b\tau} \end{pmatrix} \ddot\beta
/// \f]
template <Scalar S>
TwistingWings<S> wings_at_twist(const BladeElement<S>& w, const PitchingWings<S>& p, const S& stroke_inertia,
                                const PitchState<S>& root, const TwistState<S>& twist, const S& stroke, const S& turn,
                                const S& held) {
  const StripSums<S> sum = strip_sums(w, p, stroke_inertia, root, twist, stroke);
  const TwistInertia<S>& m = sum.inertia;
  const bool free = value_of(held) >= 0.0;
  TwistingWings<S> wings;
  wings.aero = sum.aero;
  wings.hinge = hinge_loads(p.hinge, root.psi, root.velocity, free ? turn : S(0.0));
  wings.torsion_loss = p.torsion.damping * square(twist.velocity);
  wings.steady_lift = sum.steady_lift;
  wings.lift = sum.lift;
  wings.chordwise_lift = sum.chordwise_lift;
  const S on_pitch = -(sum.h_p + wings.hinge.moment + sum.aero.pitch_moment);
  const S on_twist =
      -(sum.h_t + p.torsion.stiffness * twist.angle + p.torsion.damping * twist.velocity + sum.twist_moment);
  if (free) {
    const S determinant = m.pp * m.tt - square(m.pt);
    const auto solve = [&](const S& a, const S& b, S* pitch, S* along) {
      *pitch = (a * m.tt - b * m.pt) / determinant;
      *along = (b * m.pp - a * m.pt) / determinant;
    };
    solve(on_pitch, on_twist, &wings.free_acceleration, &wings.twist_free);
    solve(S(-m.bp), S(-m.bt), &wings.coupling, &wings.twist_coupling);
  } else {
    wings.free_acceleration = wings.coupling = S(0.0);
    wings.twist_free = on_twist / m.tt;
    wings.twist_coupling = -m.bt / m.tt;
  }
  wings.pitching_moment = on_pitch - m.pt * wings.twist_free;
  wings.coupling_moment = -m.bp - m.pt * wings.twist_coupling;
  wings.inertia = m.bb + m.bp * wings.coupling + m.bt * wings.twist_coupling;
  wings.moment = sum.h_b + sum.aero.stroke_moment + m.bp * wings.free_acceleration + m.bt * wings.twist_free;
  return wings;
}

}  // namespace wingbeat
