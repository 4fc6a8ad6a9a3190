// Wings that pitch about an elastic hinge, pitch being a degree of freedom beside the stroke: inertia with the air that
// moves along, loads of blade elements, and what of it the stroke sees; model.md section 12.
//
// Everything is of all wings together. The kinetic energy of wings and added mass is
//   T = 1/2 M_bb beta'^2 + M_bp beta' psi' + 1/2 M_pp psi'^2,
// the equations of motion are M (beta'', psi'') + (h_b, h_p) = loads. Neither of them knows what drives the stroke: a
// crank and a direct drive take the same parts, by the condensed inertia and moment of wings_at_pitch().
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

/// Inertia of wings and added mass in stroke and pitch [kg m2], all of all wings together (model.md section 12).
/// \f[
/// M_{bb} = N_\mathrm{w} J_\mathrm{w} + I_\psi \sin^2\psi + m_{rr} \cos^2\psi, \qquad
/// M_{bp} = (P + m_{rp}) \cos\psi, \qquad M_{pp} = I_\psi + m_{pp}
/// \f]
template <Scalar S>
struct PitchInertia {
  S bb;  ///< \f$M_{bb}\f$
  S bp;  ///< \f$M_{bp}\f$
  S pp;  ///< \f$M_{pp}\f$
};

/// `stroke_inertia`: N_w J_w [kg m2], of what else turns with the stroke as the caller likes.
template <Scalar S>
PitchInertia<S> pitch_inertia(const PitchingWings<S>& w, const S& stroke_inertia, const PitchState<S>& state) {
  return {stroke_inertia + w.pitch_inertia * square(state.sin_psi) + w.air.rr * square(state.cos_psi),
          (w.mass_product + w.air.rp) * state.cos_psi, w.pitch_inertia + w.air.pp};
}

/// Kinetic energy [J] of an inertia at pitch and stroke velocity.
/// \f[
/// T = \tfrac12 M_{bb} \dot\beta^2 + M_{bp} \dot\beta \dot\psi + \tfrac12 M_{pp} \dot\psi^2
/// \f]
template <Scalar S>
S kinetic_energy(const PitchInertia<S>& m, const PitchState<S>& state) {
  return S(0.5) * (m.bb * square(state.stroke_velocity) + m.pp * square(state.velocity)) +
         m.bp * state.stroke_velocity * state.velocity;
}

/// C_N [1] at the angle of attack alpha [rad]: a NormalForceCoefficient, or the components of lift and drag normal to
/// the chord.
/// \f[
/// C_\mathrm{N} = C_\mathrm{L} \cos\alpha + C_\mathrm{D} \sin\alpha
/// \f]
template <Scalar S>
S normal_force_coefficient(const BladeElement<S>& w, const PitchingWings<S>& p, const S& alpha) {
  using std::cos;
  using std::sin;
  if (p.normal_force == NormalForce::normal_force) {
    return p.coefficient.first * sin(alpha) + p.coefficient.third * sin(S(S(3.0) * alpha));
  }
  return lift_coefficient(w.coefficients, alpha) * cos(alpha) + drag_coefficient(w.coefficients, alpha) * sin(alpha);
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
  return S(0.46) - S(0.332) * cos(alpha) - S(0.037) * cos(S(S(3.0) * alpha)) - S(0.013) * cos(S(S(5.0) * alpha));
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
S centre_of_pressure(const PitchingWings<S>& p, const S& alpha) {
  return p.centre_of_pressure == CentreOfPressure::chen ? centre_of_pressure_chen(alpha) : centre_of_pressure(alpha);
}

/// What the air does to wings that pitch, without added mass. Moments oppose positive velocities.
template <Scalar S>
struct PitchAeroLoads {
  S angle_of_attack;  ///< \f$\alpha\f$ [rad], over 90 degrees where the wing over-rotates
  S normal_force;     ///< \f$F_\mathrm{N} + F_\mathrm{rot}\f$, normal to the chord, against a positive velocity [N]
  S stroke_moment;    ///< \f$M_\mathrm{aero}\f$ about the stroke hinges [N m]
  S pitch_moment;     ///< \f$M_\mathrm{pitch}\f$ about the pitch hinges [N m]
  S power;            ///< \f$M_\mathrm{aero} \dot\beta + M_\mathrm{pitch} \dot\psi\f$ [W]
  S tangential_lift = S(0.0);  ///< of the force along the chord, and all lift of a table [N]
};

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
                                      const S& s22, const PitchState<S>& state, const S& stroke, const S& alpha) {
  using std::cos;
  const S speed = stroke * state.stroke_velocity, arm = centre_of_pressure(p, alpha) - p.axis;
  const S rho = w.air_density * state.clap;
  const S q = S(0.5) * rho * normal_force_coefficient(w, p, alpha) * speed * state.stroke_velocity;
  TranslationLoads<S> loads{q * (s2 - w.tip.s2), q * (s3 - w.tip.s3), q * arm * (s22 - w.tip.s22)};
  if (acts(w.tip.s3)) add_tip_drag(w, state, stroke, arm, loads);
  if (acts(w.coefficients.tangential)) {
    const S along = S(0.5) * rho * tangential_force_coefficient(w, p, alpha) * square(state.stroke_velocity);
    loads.tangential_lift = -along * (s2 - w.tip.s2) * state.cos_psi;
    loads.tangential_moment = stroke * along * (s3 - w.tip.s3) * cos(alpha);
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
                       const PitchState<S>& state, const S& stroke, const S& alpha, const S& even,
                       TranslationLoads<S>& sum) {
  using std::cos;
  const StripFlow<S> flow = strip_flow(w.wake.velocity, strip, S(stroke * state.stroke_velocity));
  const S angle = alpha - flow.inflow_angle;
  const S closeness = S(1.0) + (state.clap - S(1.0)) * square(flow.cosine);
  const S pressure = S(0.5) * w.air_density * flow.square_of_speed * strip.area * closeness;
  const S force = stroke * pressure * (normal_force_coefficient(w, p, angle) - even * square(flow.sine));
  sum.normal = sum.normal + force;
  sum.stroke_moment = sum.stroke_moment + force * strip.radius;
  sum.pitch_moment = sum.pitch_moment + force * strip.chord * (centre_of_pressure(p, angle) - p.axis);
  if (acts(w.coefficients.tangential)) {
    const S along = pressure * tangential_force_coefficient(w, p, angle);
    sum.tangential_lift = sum.tangential_lift - along * state.cos_psi;
    sum.tangential_moment = sum.tangential_moment + stroke * along * strip.radius * cos(alpha);
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

/// What the air does at a pitch state; `stroke` and `turn` are the signs of beta' and psi'. With TranslationLoads and
/// the chord moments of all wings (model.md section 12):
/// \f[
/// \begin{aligned}
/// \alpha &= \frac{\pi}{2} + \psi \operatorname{sign}\dot\beta, \qquad
/// q_\mathrm{rot} = C_\mathrm{rot}\, \rho\, |\dot\beta| \dot\psi \cr
/// F_\mathrm{N} + F_\mathrm{rot} &= F_\mathrm{N} + q_\mathrm{rot} S_{21} \cr
/// M_\mathrm{aero} &= M + M_\mathrm{T} + q_\mathrm{rot} S_{22} \cos\psi \cr
/// M_\mathrm{pitch} &= M_\psi + q_\mathrm{rot} \left( \tfrac12 - \hat x_0 \right) S_{31}
/// + \tfrac18 \rho\, C_\mathrm{rd} \left( (1 - \hat x_0)^4 + \hat x_0^4 \right) |\dot\psi| \dot\psi\, S_{40}
/// \end{aligned}
/// \f]
///
/// all of it times the factor of clap and fling. Of a strip the moments are its own, in `s2`, `s3` and `moments`, and
/// so is `in_wake`, which adds its loads to the sum that it is given.
template <Scalar S, class InWake>
PitchAeroLoads<S> aero_loads_of(const BladeElement<S>& w, const PitchingWings<S>& p, const S& s2, const S& s3,
                                const PitchChordMoments<S>& moments, const PitchState<S>& state, const S& stroke,
                                const S& turn, const InWake& in_wake) {
  const S rho = w.air_density * state.clap;
  const S speed = stroke * state.stroke_velocity;
  const S alpha = S(0.5 * pi) + stroke * state.psi;
  TranslationLoads<S> translation;
  if (has_wake(w)) in_wake(alpha, translation);
  else translation = translation_loads(w, p, s2, s3, moments.s22, state, stroke, alpha);
  const S rotation = p.rotational_coefficient * rho * speed * state.velocity;
  const S ahead = p.axis, behind = S(1.0) - p.axis;
  const S breadth = square(square(behind)) + square(square(ahead));
  const S damping = S(0.125) * rho * p.damping_coefficient * turn * square(state.velocity) * moments.s40 * breadth;
  PitchAeroLoads<S> loads;
  loads.angle_of_attack = alpha;
  loads.normal_force = translation.normal + rotation * moments.s21;
  loads.stroke_moment =
      (translation.stroke_moment + rotation * moments.s22) * state.cos_psi + translation.tangential_moment;
  // The force of translation acts at the centre of pressure, that of rotation at mid-chord.
  loads.pitch_moment = translation.pitch_moment + (S(0.5) - p.axis) * rotation * moments.s31 + damping;
  loads.power = loads.stroke_moment * state.stroke_velocity + loads.pitch_moment * state.velocity;
  loads.tangential_lift = translation.tangential_lift;
  return loads;
}

/// aero_loads_of() all wings, or those of a table.
template <Scalar S>
PitchAeroLoads<S> aero_loads(const BladeElement<S>& w, const PitchingWings<S>& p, const PitchState<S>& state,
                             const S& stroke, const S& turn) {
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (is_given(w.tabulated)) {
      const TableLoads<S> loads =
          table_loads<S>(w.tabulated, {state.stroke_angle, state.stroke_velocity, state.psi, state.velocity});
      return {S(0.5 * pi) + stroke * state.psi,
              S(0.0),
              loads.stroke_moment,
              loads.pitch_moment,
              loads.stroke_moment * state.stroke_velocity + loads.pitch_moment * state.velocity,
              loads.lift};
    }
  }
  return aero_loads_of(w, p, w.s2, w.s3, p.moments, state, stroke, turn, [&](const S& alpha, TranslationLoads<S>& sum) {
    const S even = even_normal_force(w, p, state.psi);
    for (const WakeStrip<S>& strip : w.wake.strips.at) {
      add_strip_in_wake(w, p, strip, state, stroke, alpha, even, sum);
    }
    if (acts(w.tip.s3)) {
      add_tip_drag(w, state, stroke, S(centre_of_pressure(p, alpha) - p.axis), sum);
    }
  });
}

/// Wings that pitch, as the stroke sees them. The moment M of the drive and of the stroke's springs turns them with the
/// inertia \f$I\f$ and the moment \f$M_0\f$, and the pitch follows with the coupling \f$\kappa\f$:
/// \f[
/// M = I \ddot\beta + M_0, \qquad \ddot\psi = \ddot\psi_0 + \kappa\, \ddot\beta
/// \f]
template <Scalar S>
struct WingsAtPitch {
  PitchAeroLoads<S> aero;
  PitchHingeLoads<S> hinge;
  S inertia;            ///< \f$I\f$; \f$M_{bb}\f$ where the wings are held at a stop [kg m2]
  S moment;             ///< \f$M_0\f$ of all that acts on the wings but the springs of the stroke [N m]
  S free_acceleration;  ///< \f$\ddot\psi_0\f$ of a stroke at constant velocity [rad/s2]
  S coupling;           ///< \f$\kappa\f$ of psi'' to beta'' [1]
  /// Of wings that are held at a stop: with coupling_moment beta'' it is the moment that presses towards a positive psi
  /// [N m], and the stop's reaction its negative.
  S pitching_moment;
  S coupling_moment;  ///< \f$-M_{bp}\f$ [kg m2]
};

/// The wings with `stroke_inertia` N_w J_w [kg m2]. `stroke` and `turn` as in aero_loads(); `held` is -1 where a stop
/// holds them (psi' is 0 then), else +1. The equation of motion of the pitch, solved for psi'', leaves of that of the
/// stroke (model.md section 12):
/// \f[
/// \begin{aligned}
/// h_b &= 2 (I_\psi - m_{rr}) \sin\psi \cos\psi\, \dot\beta \dot\psi - (P + m_{rp}) \sin\psi\, \dot\psi^2, \qquad
/// h_p = -(I_\psi - m_{rr}) \sin\psi \cos\psi\, \dot\beta^2 \cr
/// \ddot\psi_0 &= -\frac{h_p + k_\psi \psi + c_\psi \dot\psi + M_\mathrm{pitch}}{M_{pp}}, \qquad
/// \kappa = -\frac{M_{bp}}{M_{pp}} \cr
/// I &= M_{bb} - \frac{M_{bp}^2}{M_{pp}}, \qquad M_0 = h_b + M_\mathrm{aero} + M_{bp} \ddot\psi_0
/// \end{aligned}
/// \f]
template <Scalar S>
WingsAtPitch<S> wings_at_pitch(const BladeElement<S>& w, const PitchingWings<S>& p, const S& stroke_inertia,
                               const PitchState<S>& state, const S& stroke, const S& turn, const S& held) {
  const PitchInertia<S> m = pitch_inertia(p, stroke_inertia, state);
  WingsAtPitch<S> wings;
  wings.aero = aero_loads(w, p, state, stroke, turn);
  wings.hinge = hinge_loads(p.hinge, state.psi, state.velocity, select(held >= S(0.0), turn, S(0.0)));
  const S sc = (p.pitch_inertia - p.air.rr) * state.sin_psi * state.cos_psi;
  const S h_b = S(2.0) * sc * state.stroke_velocity * state.velocity -
                (p.mass_product + p.air.rp) * state.sin_psi * square(state.velocity);
  const S h_p = -sc * square(state.stroke_velocity);
  wings.pitching_moment = -(h_p + wings.hinge.moment + wings.aero.pitch_moment);
  wings.coupling_moment = -m.bp;
  const S per_inertia = select(held >= S(0.0), inverse_of(m.pp), S(0.0));
  wings.free_acceleration = wings.pitching_moment * per_inertia;
  wings.coupling = wings.coupling_moment * per_inertia;
  wings.inertia = m.bb + m.bp * wings.coupling;
  wings.moment = h_b + wings.aero.stroke_moment + m.bp * wings.free_acceleration;
  return wings;
}

/// Momentum of the air that moves with the wings, normal to the chord [N s], with \f$m_r\f$ and \f$m_p\f$ of
/// PitchAddedMass.
/// \f[
/// p_\mathrm{n} = m_r \dot\beta \cos\psi + m_p \dot\psi
/// \f]
template <Scalar S>
S air_momentum(const PitchingWings<S>& p, const PitchState<S>& state) {
  return p.air.r * state.stroke_velocity * state.cos_psi + p.air.p * state.velocity;
}

/// Lift that the added mass's force along the chord takes away where it counts in full [N]: its momentum turns with the
/// wings. Over a closed cycle its mean is that of the force normal to the chord (model.md section 12).
/// \f[
/// p_\mathrm{n} \dot\psi \cos\psi
/// \f]
template <Scalar S>
S chordwise_lift(const PitchingWings<S>& p, const PitchState<S>& state) {
  return air_momentum(p, state) * state.velocity * state.cos_psi;
}

/// Lift of all wings normal to the stroke plane [N] at the accelerations beta'' and psi'' [rad/s2]: that of the forces
/// normal to the chord, of which the air's inertia is one, and of the share \f$s_\mathrm{L}\f$ of its force along the
/// chord that counts.
/// \f[
/// \begin{aligned}
/// F_\mathrm{am} &= \dot p_\mathrm{n} = m_r (\ddot\beta \cos\psi - \dot\beta \dot\psi \sin\psi) + m_p \ddot\psi \cr
/// L &= -(F_\mathrm{N} + F_\mathrm{rot} + F_\mathrm{am}) \sin\psi - s_\mathrm{L}\, p_\mathrm{n} \dot\psi \cos\psi
/// + L_\mathrm{T}
/// \end{aligned}
/// \f]
template <Scalar S>
S lift_at_pitch(const PitchingWings<S>& p, const WingsAtPitch<S>& wings, const PitchState<S>& state,
                const S& stroke_acceleration, const S& pitch_acceleration) {
  const S F_am =
      p.air.r * (stroke_acceleration * state.cos_psi - state.stroke_velocity * state.velocity * state.sin_psi) +
      p.air.p * pitch_acceleration;
  return -(wings.aero.normal_force + F_am) * state.sin_psi - p.edge_suction * chordwise_lift(p, state) +
         wings.aero.tangential_lift;
}

}  // namespace wingbeat
