// Wings that pitch about a hinge: their numbers, their coefficients, and what their motion through the air makes of
// them without rotation, in still air, in the wake and on a body that moves; model.md sections 12, 17, 18.
#pragma once

#include <cmath>
#include <utility>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/blade_element.hpp"
#include "wingbeat/parts/pitch_hinge.hpp"
#include "wingbeat/parts/planform.hpp"
#include "wingbeat/parts/wing_torsion.hpp"

namespace wingbeat {

/// C_rot of a pitch axis at the part \f$\hat x_0\f$ of the chord behind the leading edge (Sane and Dickinson, J. Exp.
/// Biol. 205, 2002).
/// \f[
/// C_\mathrm{rot} = \pi (0.75 - \hat x_0)
/// \f]
template <Scalar S>
S rotational_coefficient_of(const S& axis) {
  return S(pi) * (S(0.75) - axis);
}

/// A normal-force coefficient that is odd in the angle of attack and symmetric about 90 degrees.
/// \f[
/// C_\mathrm{N}(\alpha) = C_\mathrm{N,1} \sin\alpha + C_\mathrm{N,3} \sin 3\alpha
/// \f]
template <Scalar S>
struct NormalForceCoefficient {
  S first;  ///< \f$C_\mathrm{N,1}\f$ [1]
  S third;  ///< \f$C_\mathrm{N,3}\f$ [1]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.first, self.third);
  }
};

/// "normal-force-robofly": \f$C_\mathrm{L} = 1.8 \sin 2\alpha\f$ and \f$C_\mathrm{D} = 1.95 - 1.5 \cos 2\alpha\f$ along
/// the normal of the chord, in the form above.
/// \f[
/// C_\mathrm{N} = 1.8 \sin 2\alpha \cos\alpha + (1.95 - 1.5 \cos 2\alpha) \sin\alpha
/// = 3.6 \sin\alpha + 0.15 \sin 3\alpha
/// \f]
inline NormalForceCoefficient<double> normal_force_robofly() { return {3.6, 0.15}; }

/// Where the coefficient of the force normal to the chord comes from.
enum class NormalForce {
  lift_and_drag,  ///< C_L cos(alpha) + C_D sin(alpha) of the ForceCoefficients
  normal_force    ///< a NormalForceCoefficient
};

/// Added mass of strips that move normal to their chord, of all wings; zero in vacuum. The air is at mid-chord, the
/// part
/// \f$e = \tfrac12 - \hat x_0\f$ of the chord behind the pitch axis.
template <Scalar S>
struct PitchAddedMass {
  S rr = S(0);  ///< \f$m_{rr} = \tfrac{\pi}{4} \rho S_{22}\f$ [kg m2]
  S rp = S(0);  ///< \f$m_{rp} = \tfrac{\pi}{4} \rho\, e\, S_{31}\f$ [kg m2]
  S pp = S(0);  ///< \f$m_{pp} = \tfrac{\pi}{4} \rho \left( e^2 + \tfrac{1}{32} \right) S_{40}\f$ [kg m2]
  S r = S(0);   ///< \f$m_r = \tfrac{\pi}{4} \rho S_{21}\f$ [kg m]: momentum normal to the chord per stroke velocity
  S p = S(0);   ///< \f$m_p = \tfrac{\pi}{4} \rho\, e\, S_{30}\f$ [kg m]: the same per pitch velocity

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.rr, self.rp, self.pp, self.r, self.p);
  }
};

/// The added mass in air of that density [kg/m3] of wings with these chord moments, which pitch about an axis at that
/// part of the chord; formulas at the members.
template <Scalar S>
PitchAddedMass<S> pitch_added_mass(const S& air_density, const PitchChordMoments<S>& s, const S& axis) {
  const S quarter = S(0.25 * pi) * air_density, e = S(0.5) - axis, by_arm = S(0.25 * pi) * e * air_density;
  return {quarter * s.s22, by_arm * s.s31, S(0.25 * pi) * (square(e) + S(1.0 / 32.0)) * air_density * s.s40,
          quarter * s.s21, by_arm * s.s30};
}

/// What pitch as a degree of freedom needs of all wings beside their BladeElement, from which air density, S_2, S_3 and
/// force coefficients are taken.
template <Scalar S>
struct PitchingWings {
  static constexpr bool off_lanes = true;
  PitchHinge<S> hinge;  ///< all hinges together
  /// N_w I_psi = N_w integral x^2 dm, x from the axis along the chord [kg m2], > 0; 0 where the wings do not pitch so
  S pitch_inertia = S(0);
  S mass_product = S(0);  ///< N_w P = N_w integral r x dm [kg m2], P^2 <= J_w I_psi
  PitchChordMoments<S> moments;
  PitchAddedMass<S> air;
  S rotational_coefficient = S(0.75 * pi);  ///< C_rot [1]; 0 without rotational lift
  S damping_coefficient = S(5.0);           ///< C_rd [1], >= 0
  NormalForce normal_force = NormalForce::lift_and_drag;
  NormalForceCoefficient<S> coefficient = {S(3.6), S(0.15)};
  S edge_suction = S(0);  ///< s_L: share of the added mass's force along the chord that counts as lift, 0 to 1
  WingTorsion<S> torsion;
  S axis = S(0);  ///< \f$\hat x_0\f$: pitch axis behind the leading edge over the chord [1], 0 to 0.75
  CentreOfPressure centre_of_pressure = CentreOfPressure::fourier;

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.hinge, self.pitch_inertia, self.mass_product, self.moments, self.air, self.rotational_coefficient,
               self.damping_coefficient, self.normal_force, self.coefficient, self.edge_suction, self.torsion,
               self.axis, self.centre_of_pressure);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace pitch_key {
inline constexpr ParameterKey pitch_inertia{"wing.pitch_inertia", "kg m2", range::positive};
inline constexpr ParameterKey mass_product{"wing.mass_product", "kg m2", range::any};
inline constexpr ParameterKey damping_coefficient{"pitch.damping_coefficient", "1", range::not_negative};
inline constexpr ParameterKey edge_suction{"pitch.leading_edge_suction", "1", range::zero_to_one};
inline constexpr ParameterKey axis{"pitch.axis", "1", {"0 to 0.75", "must lie between 0 and 0.75", 0.0, 0.75}};
}  // namespace pitch_key

/// `stroke_inertia`: N_w J_w [kg m2], within which the mass product must stay (Cauchy and Schwarz).
void validate(const PitchingWings<double>& wings, double stroke_inertia);

/// How the wings stand and turn.
template <Scalar S>
struct PitchState {
  S sin_psi, cos_psi;
  S psi;                    ///< pitch angle [rad]
  S velocity;               ///< psi' [rad/s]
  S stroke_velocity;        ///< beta' [rad/s]
  S clap = S(1.0);          ///< clap_factor()
  S stroke_angle = S(0.0);  ///< beta [rad], where tabulated loads depend on it
};

template <Scalar S>
PitchState<S> pitch_state(const S& psi, const S& velocity, const S& stroke_velocity, const S& clap = S(1.0),
                          const S& stroke_angle = S(0.0)) {
  using std::cos;
  using std::sin;
  return {sin(psi), cos(psi), psi, velocity, stroke_velocity, clap, stroke_angle};
}

/// An angle of attack [rad] with its sine and cosine, which wings that pitch know without computing them.
template <Scalar S>
struct AngleOfAttack {
  S angle, sine, cosine;
};
template <Scalar S>
AngleOfAttack<S> angle_of_attack(const S& angle) {
  using std::cos;
  using std::sin;
  return {angle, sin(angle), cos(angle)};
}
/// \f[ \alpha = \frac{\pi}{2} + \psi \operatorname{sign}\dot\beta \f]
template <Scalar S>
AngleOfAttack<S> angle_of_attack(const PitchState<S>& state, const S& stroke) {
  return {S(0.5 * pi) + stroke * state.psi, state.cos_psi, -(stroke * state.sin_psi)};
}

/// C_N of a NormalForceCoefficient, and the Fourier series of centre_of_pressure(), by sine and cosine of the angle of
/// attack.
template <Scalar S>
S normal_force_of(const NormalForceCoefficient<S>& c, const S& sine) {
  return sine * (c.first + c.third * (S(3.0) - S(4.0) * square(sine)));
}
template <Scalar S>
S centre_of_pressure_of(const S& cosine) {
  const S c2 = square(cosine);
  const S third = S(4.0) * c2 - S(3.0), fifth = S(5.0) + c2 * (S(16.0) * c2 - S(20.0));
  return S(0.46) - cosine * (S(0.332) + S(0.037) * third + S(0.013) * fifth);
}

/// C_N [1] at the angle of attack alpha [rad]: a NormalForceCoefficient, or the components of lift and drag normal to
/// the chord.
/// \f[
/// C_\mathrm{N} = C_\mathrm{L} \cos\alpha + C_\mathrm{D} \sin\alpha
/// \f]
template <Scalar S>
S normal_force_coefficient(const BladeElement<S>& w, const PitchingWings<S>& p, const AngleOfAttack<S>& alpha) {
  if (p.normal_force == NormalForce::normal_force) return normal_force_of(p.coefficient, alpha.sine);
  return lift_coefficient(w.coefficients, alpha.angle) * alpha.cosine +
         drag_coefficient(w.coefficients, alpha.angle) * alpha.sine;
}
template <Scalar S>
S normal_force_coefficient(const BladeElement<S>& w, const PitchingWings<S>& p, const S& alpha) {
  return normal_force_coefficient(w, p, angle_of_attack(alpha));
}

/// C_T [1] of a force along the chord; none of a NormalForceCoefficient.
template <Scalar S>
S tangential_force_coefficient(const BladeElement<S>& w, const PitchingWings<S>& p, const S& alpha) {
  if (p.normal_force == NormalForce::normal_force || !acts(w.coefficients.tangential)) return S(0.0);
  return w.coefficients.tangential * tangential_coefficient(alpha);
}

/// Centre of pressure behind the leading edge over the chord at the angle of attack alpha [rad]: the first terms of the
/// Fourier series of \f$0.05 + 0.82\, \alpha/\pi\f$ (Dickson and others, AIAA 2006-34; Whitney and Wood 2010), which is
/// kinked at 0 and 180 degrees.
/// \f[
/// d(\alpha) = 0.46 - 0.332 \cos\alpha - 0.037 \cos 3\alpha - 0.013 \cos 5\alpha
/// \f]
template <Scalar S>
S centre_of_pressure(const S& alpha) {
  using std::cos;
  return centre_of_pressure_of(S(cos(alpha)));
}

/// Centre of pressure after Chen and others (IROS 2016), from a quarter of the chord to its half, whichever edge leads:
/// \f[
/// d = 0.25 + \frac{0.25}{1 + \exp\left( 5 \left( 1 - \tfrac{4}{\pi} \left( \tfrac{\pi}{2}
/// - \left| \alpha - \tfrac{\pi}{2} \right| \right) \right) \right)}
/// \f]
template <Scalar S>
S centre_of_pressure_chen(const S& alpha) {
  using std::abs;
  using std::exp;
  const S incidence = S(0.5 * pi) - abs(S(alpha - S(0.5 * pi)));
  return S(0.25) + S(0.25) / (S(1.0) + exp(S(S(5.0) * (S(1.0) - S(4.0 / pi) * incidence))));
}

/// By the law that the wings have.
template <Scalar S>
S centre_of_pressure(const PitchingWings<S>& p, const AngleOfAttack<S>& alpha) {
  return p.centre_of_pressure == CentreOfPressure::chen ? centre_of_pressure_chen(alpha.angle)
                                                        : centre_of_pressure_of(alpha.cosine);
}
template <Scalar S>
S centre_of_pressure(const PitchingWings<S>& p, const S& alpha) {
  return centre_of_pressure(p, angle_of_attack(alpha));
}

/// What the motion of a wing through the air makes of it, without rotation; against positive velocities.
template <Scalar S>
struct TranslationLoads {
  S normal = S(0);             ///< force normal to the chord [N]
  S stroke_moment = S(0);      ///< of that force about the stroke axis, over cos(psi) [N m]
  S pitch_moment = S(0);       ///< of that force about the pitch axis [N m]
  S tangential_lift = S(0);    ///< of the force along the chord [N]
  S tangential_moment = S(0);  ///< of that force about the stroke axis [N m]
};

/// Adds the profile drag of the tips that do not lift: of \f$\tfrac12 \rho\, C_\mathrm{D}(0)\, \dot\beta^2\f$ along the
/// stroke the share \f$\sin\alpha = \cos\psi\f$ normal to the chord, which acts as the lifting strips' force does.
template <Scalar S>
void add_tip_drag(const BladeElement<S>& w, const PitchState<S>& state, const S& stroke, const S& arm,
                  TranslationLoads<S>& sum) {
  const S drag =
      state.clap * S(0.5) * w.air_density * w.tip.profile_drag * state.cos_psi * stroke * square(state.stroke_velocity);
  sum.normal = sum.normal + drag * w.tip.s2;
  sum.stroke_moment = sum.stroke_moment + drag * w.tip.s3;
  sum.pitch_moment = sum.pitch_moment + drag * arm * w.tip.s22;
}

/// Of wings without induced velocity, with all chord moments less those of the tips that do not lift, and times the
/// factor of clap and fling:
/// \f[
/// \begin{aligned}
/// q &= \tfrac12 \rho\, C_\mathrm{N}(\alpha)\, \dot\beta |\dot\beta|, \qquad
/// F_\mathrm{N} = q\, S_2, \qquad M = q\, S_3 \cos\psi, \qquad
/// M_\psi = q \left( d(\alpha) - \hat x_0 \right) S_{22} \cr
/// L_\mathrm{T} &= -\tfrac12 \rho\, C_\mathrm{T}(\alpha)\, \dot\beta^2 S_2 \sin\alpha, \qquad
/// M_\mathrm{T} = \tfrac12 \rho\, C_\mathrm{T}(\alpha)\, \dot\beta |\dot\beta|\, S_3 \cos\alpha
/// \end{aligned}
/// \f]
template <Scalar S>
TranslationLoads<S> translation_loads(const BladeElement<S>& w, const PitchingWings<S>& p, const S& s2, const S& s3,
                                      const S& s22, const PitchState<S>& state, const S& stroke,
                                      const AngleOfAttack<S>& alpha) {
  const S speed = stroke * state.stroke_velocity, arm = centre_of_pressure(p, alpha) - p.axis;
  const S rho = w.air_density * state.clap;
  const S q = S(0.5) * rho * normal_force_coefficient(w, p, alpha) * speed * state.stroke_velocity;
  TranslationLoads<S> loads{q * (s2 - w.tip.s2), q * (s3 - w.tip.s3), q * arm * (s22 - w.tip.s22)};
  if (acts(w.tip.s3)) add_tip_drag(w, state, stroke, arm, loads);
  if (acts(w.coefficients.tangential)) {
    const S along = S(0.5) * rho * tangential_force_coefficient(w, p, alpha.angle) * square(state.stroke_velocity);
    loads.tangential_lift = -along * (s2 - w.tip.s2) * state.cos_psi;
    loads.tangential_moment = stroke * along * (s3 - w.tip.s3) * alpha.cosine;
  }
  return loads;
}

/// Adds a strip in the wake, at the geometric angle of attack alpha [rad]: with the speed U and the inflow angle phi of
/// strip_flow(), a force \f$\tfrac12 \rho\, U^2 c\,\mathrm{d}r\f$ times the coefficients at
/// \f$\alpha - \varphi\f$, normal to the chord and along it. Less \f$\sin^2\varphi\f$ times `even`, what the normal
/// force's coefficient has of an even function about the chord along the flow: as in loads_in_wake(), it would make the
/// moment jump where the stroke reverses.
template <Scalar S>
void add_strip_in_wake(const BladeElement<S>& w, const PitchingWings<S>& p, const WakeStrip<S>& strip,
                       const PitchState<S>& state, const S& stroke, const AngleOfAttack<S>& alpha, const S& even,
                       TranslationLoads<S>& sum) {
  const StripFlow<S> flow = strip_flow(w.wake.velocity, strip, S(stroke * state.stroke_velocity));
  const AngleOfAttack<S> angle = angle_of_attack(S(alpha.angle - flow.inflow_angle));
  const S closeness = S(1.0) + (state.clap - S(1.0)) * square(flow.cosine);
  const S pressure = S(0.5) * w.air_density * flow.square_of_speed * strip.area * closeness;
  const S force = stroke * pressure * (normal_force_coefficient(w, p, angle) - even * square(flow.sine));
  sum.normal = sum.normal + force;
  sum.stroke_moment = sum.stroke_moment + force * strip.radius;
  sum.pitch_moment = sum.pitch_moment + force * strip.chord * (centre_of_pressure(p, angle) - p.axis);
  if (acts(w.coefficients.tangential)) {
    const S along = pressure * tangential_force_coefficient(w, p, angle.angle);
    sum.tangential_lift = sum.tangential_lift - along * state.cos_psi;
    sum.tangential_moment = sum.tangential_moment + stroke * along * strip.radius * alpha.cosine;
  }
}

/// The even part of the normal force's coefficient at the pitch psi of a chord along a flow from above.
/// \f[
/// \tfrac12 \left( C_\mathrm{N}(\psi) + C_\mathrm{N}(-\psi) \right)
/// \f]
template <Scalar S>
S even_normal_force(const BladeElement<S>& w, const PitchingWings<S>& p, const S& psi) {
  return S(0.5) * (normal_force_coefficient(w, p, psi) + normal_force_coefficient(w, p, S(-psi)));
}

/// The angle of flow_angle(); its sine and cosine alone where the wings' laws ask for no more.
template <Scalar S>
AngleOfAttack<S> strip_angle(const PitchingWings<S>& p, const S& u, const S& w, const S& speed, const S& sin_psi,
                             const S& cos_psi, const S& stroke) {
  if (p.normal_force != NormalForce::normal_force || p.centre_of_pressure != CentreOfPressure::fourier) {
    return angle_of_attack(flow_angle(u, w, speed, sin_psi, cos_psi, stroke));
  }
  const S per_speed = S(1.0) / speed;
  return {S(std::nan("")), stroke * (u * cos_psi - w * sin_psi) * per_speed,
          -((u * sin_psi + w * cos_psi) * per_speed)};
}

/// Force along the chord towards the trailing edge [N], and the same times the radius [N m].
template <Scalar S>
struct ChordwiseForce {
  S force = S(0), by_radius = S(0);
};

/// Adds the strips of the wings of a mount on a body that moves, and returns what acts along their chords: with the
/// strip's velocity U against the air and the angle of flow_angle(), \f$\tfrac12 \rho\, U^2 c\,\mathrm{d}r\f$ times the
/// coefficients there; the rest as in add_strip_in_wake(), the induced velocity among the velocities.
template <Scalar S>
ChordwiseForce<S> add_strips_in_flow(const BladeElement<S>& w, const PitchingWings<S>& p, const WingMount& mount,
                                     const StripDrift<S>& drift, const PitchState<S>& state, const S& stroke,
                                     const S& even, TranslationLoads<S>& sum) {
  ChordwiseForce<S> chordwise;
  const S sense(mount.sense), own_stroke = sense * stroke, sin_psi = sense * state.sin_psi;
  using std::sqrt;
  for (const WakeStrip<S>& strip : w.wake.strips.at) {
    const S& r = strip.radius;
    const S u = r * (sense * state.stroke_velocity + drift.u1) + drift.u0;
    const S down = drift.w0 + drift.w1 * r - w.wake.velocity;
    const S square_of_speed = square(u) + square(down) + S(1e-300), speed = sqrt(square_of_speed);
    const S sine2 = square(down) / square_of_speed;
    const AngleOfAttack<S> angle = strip_angle(p, u, down, speed, sin_psi, state.cos_psi, own_stroke);
    const S closeness = S(1.0) + (state.clap - S(1.0)) * (S(1.0) - sine2);
    const S pressure = S(0.5) * w.air_density * S(mount.share) * square_of_speed * strip.area * closeness;
    // Of the wing `own_stroke`, of the vehicle's angles `sense` times that.
    const S force = stroke * pressure * (normal_force_coefficient(w, p, angle) - even * sine2);
    sum.normal = sum.normal + force;
    sum.stroke_moment = sum.stroke_moment + force * r;
    sum.pitch_moment = sum.pitch_moment + force * strip.chord * (centre_of_pressure(p, angle) - p.axis);
    if (acts(w.coefficients.tangential)) {
      const S along = pressure * tangential_force_coefficient(w, p, angle.angle);
      chordwise.force = chordwise.force + along;
      chordwise.by_radius = chordwise.by_radius + along * r;
    }
  }
  sum.tangential_lift = sum.tangential_lift - chordwise.force * state.cos_psi;
  sum.tangential_moment = sum.tangential_moment - chordwise.by_radius * state.sin_psi;
  return chordwise;
}

}  // namespace wingbeat
