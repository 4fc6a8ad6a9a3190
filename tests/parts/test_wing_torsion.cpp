// Strips of a twisting wing: sums against the closed chord integrals, the limit of no twist, the energy of every
// motion, free torsion.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "parts/expect_error.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"
#include "wingbeat/parts/twisting_wings.hpp"

namespace wingbeat {
namespace {

Planform<double> outline(PlanformShape shape) {
  Planform<double> p;
  p.shape = shape;
  p.length = 63e-3;
  p.root_chord = 25e-3;
  p.hub_offset = 7e-3;
  if (shape == PlanformShape::tabulated) p.chord_table = {{0.0, 0.01}, {0.02, 0.026}, {0.05, 0.02}, {0.063, 0.004}};
  return p;
}

struct Wings {
  BladeElement<double> w;
  PitchingWings<double> p;
};
Wings wings_of(PlanformShape shape, NormalForce normal_force = NormalForce::normal_force) {
  const Planform<double> plan = outline(shape);
  Wings wings;
  const ChordMoments<double> moments = chord_moments(plan, 2.0);
  wings.w.air_density = 1.225;
  wings.w.pitch_coefficient = 0.0;
  wings.w.s2 = moments.s2;
  wings.w.s3 = moments.s3;
  wings.w.coefficients = *named_coefficients(normal_force_set);
  wings.p.moments = pitch_chord_moments(plan, 2.0);
  wings.p.air = pitch_added_mass(1.225, wings.p.moments, 0.0);
  wings.p.pitch_inertia = 4e-9;
  wings.p.mass_product = 6e-9;
  wings.p.hinge = {6e-4, 4e-8};
  wings.p.damping_coefficient = 3.0;
  wings.p.normal_force = normal_force;
  wings.p.torsion = wing_torsion(plan, 2.0, 4e-4, 1e-7);
  return wings;
}

constexpr double stroke_inertia = 1.4e-7;
constexpr PlanformShape shapes[] = {PlanformShape::semi_ellipse, PlanformShape::rectangle, PlanformShape::tabulated};

// The error of 8 nodes; of a rectangle and of a table the rules are exact.
double quadrature_error(PlanformShape shape) { return shape == PlanformShape::semi_ellipse ? 2e-9 : 1e-13; }

TEST(WingTorsion, StripsAddUpToTheChordIntegrals) {
  for (const PlanformShape shape : shapes) {
    const Wings wings = wings_of(shape);
    double s2 = 0.0, s3 = 0.0;
    PitchChordMoments<double> sum;
    for (std::size_t k = 0; k < wings.p.torsion.strips->position.size(); ++k) {
      const WingStrip<double> strip = strip_of(wings.p.torsion, k);
      s2 += strip.s2, s3 += strip.s3;
      sum.s21 += strip.moments.s21, sum.s22 += strip.moments.s22, sum.s30 += strip.moments.s30;
      sum.s31 += strip.moments.s31, sum.s40 += strip.moments.s40;
    }
    const PitchChordMoments<double>& exact = wings.p.moments;
    EXPECT_NEAR(s2 / wings.w.s2, 1.0, quadrature_error(shape));
    EXPECT_NEAR(s3 / wings.w.s3, 1.0, quadrature_error(shape));
    EXPECT_NEAR(sum.s21 / exact.s21, 1.0, quadrature_error(shape));
    EXPECT_NEAR(sum.s22 / exact.s22, 1.0, quadrature_error(shape));
    EXPECT_NEAR(sum.s30 / exact.s30, 1.0, quadrature_error(shape));
    EXPECT_NEAR(sum.s31 / exact.s31, 1.0, quadrature_error(shape));
    EXPECT_NEAR(sum.s40 / exact.s40, 1.0, quadrature_error(shape));
  }
}

// Without twist the strips are the wing of the chord integrals, which are another way to the same numbers.
TEST(WingTorsion, AWingThatDoesNotTwistIsTheOneOfTheChordIntegrals) {
  std::mt19937_64 random(3);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  for (const PlanformShape shape : shapes) {
    for (const NormalForce force : {NormalForce::normal_force, NormalForce::lift_and_drag}) {
      const Wings each = wings_of(shape, force);
      for (int n = 0; n < 20; ++n) {
        const PitchState<double> state =
            pitch_state(uniform(-1.2, 1.2), uniform(-300.0, 300.0), uniform(-120.0, 120.0));
        const double stroke = sign_of(state.stroke_velocity), turn = sign_of(state.velocity);
        const WingsAtPitch<double> whole = wings_at_pitch(each.w, each.p, stroke_inertia, state, stroke, turn, -1.0);
        const TwistingWings<double> strips =
            wings_at_twist(each.w, each.p, stroke_inertia, state, {0.0, 0.0}, stroke, turn, -1.0);
        const auto near = [&](double a, double b, double size) {
          EXPECT_NEAR(a, b, 4.0 * quadrature_error(shape) * size);
        };
        // Moments are differences of parts that are as large as these.
        const double V = std::abs(state.stroke_velocity), p_rate = std::abs(state.velocity), rho = 1.225;
        const double on_stroke = 4.0 * rho * V * (V * each.w.s3 + p_rate * each.p.moments.s22);
        const double on_pitch =
            4.0 * rho *
            (V * V * each.p.moments.s22 + V * p_rate * each.p.moments.s31 + p_rate * p_rate * each.p.moments.s40);
        near(strips.aero.stroke_moment, whole.aero.stroke_moment, on_stroke);
        near(strips.aero.pitch_moment, whole.aero.pitch_moment, on_pitch);
        near(strips.aero.power, whole.aero.power, on_stroke * V + on_pitch * p_rate);
        near(strips.chordwise_lift, chordwise_lift(each.p, state), p_rate * (each.p.air.r * V + each.p.air.p * p_rate));
        const StripSums<double> sum = strip_sums(each.w, each.p, stroke_inertia, state, {0.0, 0.0}, stroke);
        const PitchInertia<double> m = pitch_inertia(each.p, stroke_inertia, state);
        near(sum.inertia.bb, m.bb, m.bb);
        near(sum.inertia.bp, m.bp, std::abs(m.bp));
        near(sum.inertia.pp, m.pp, m.pp);
      }
    }
  }
}

// Drive in, kinetic energy, springs, damping and air out: at any motion, with all accelerations as they follow.
TEST(WingTorsion, EveryWattIsAccountedFor) {
  using J = Jet<1>;
  std::mt19937_64 random(4);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  for (const PlanformShape shape : shapes) {
    for (const double held : {1.0, -1.0}) {
      const Wings each = wings_of(shape);
      const PitchingWings<J> pj = cast<J>(each.p);
      const BladeElement<J> wj = cast<J>(each.w);
      for (int n = 0; n < 30; ++n) {
        const double psi = uniform(-1.0, 1.0), psi_rate = held > 0.0 ? uniform(-300.0, 300.0) : 0.0;
        const double stroke_velocity = uniform(-120.0, 120.0), stroke_acceleration = uniform(-4e4, 4e4);
        const TwistState<double> twist{uniform(-0.5, 0.5), uniform(-200.0, 200.0)};
        const double stroke = sign_of(stroke_velocity);
        const TwistingWings<double> w =
            wings_at_twist(each.w, each.p, stroke_inertia, pitch_state(psi, psi_rate, stroke_velocity), twist, stroke,
                           sign_of(psi_rate), held);
        const auto along = [](double x, double rate) {
          J jet(x);
          jet.v[0] = rate;
          return jet;
        };
        const J psi_j = along(psi, psi_rate);
        const J rate_j = along(psi_rate, w.free_acceleration + w.coupling * stroke_acceleration);
        const J stroke_j = along(stroke_velocity, stroke_acceleration);
        const TwistState<J> twist_j{along(twist.angle, twist.velocity),
                                    along(twist.velocity, w.twist_free + w.twist_coupling * stroke_acceleration)};
        const PitchState<J> state = pitch_state(psi_j, rate_j, stroke_j);
        const J energy = kinetic_energy(strip_sums(wj, pj, J(stroke_inertia), state, twist_j, J(stroke)).inertia, state,
                                        twist_j.velocity) +
                         hinge_loads(pj.hinge, psi_j, rate_j).energy +
                         0.5 * pj.torsion.stiffness * square(twist_j.angle);
        const double drive = (w.inertia * stroke_acceleration + w.moment) * stroke_velocity;
        const double size = std::abs(drive) + std::abs(energy.v[0]) + std::abs(w.aero.power);
        EXPECT_NEAR(drive, energy.v[0] + w.aero.power + w.hinge.loss + w.torsion_loss, 1e-11 * size);
      }
    }
  }
}

// However its strips are pitched, the inertia of stroke, pitch and twist is positive up to the largest mass product
// that is admitted, and at zero pitch not much beyond it.
TEST(WingTorsion, MassProductsThatNoStripsCouldHaveAreRefused) {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> angle(-pi, pi);
  for (const PlanformShape shape : shapes) {
    Wings each = wings_of(shape);
    each.w.air_density = 0.0;
    each.p.air = {};
    const auto refused = [&](double product) {
      each.p.mass_product = product;
      return error_of([&] { validate(each.p, stroke_inertia); }) != "no error";
    };
    const double whole = std::sqrt(stroke_inertia * each.p.pitch_inertia);
    const double largest = bisect([&](double product) { return !refused(product); }, 0.0, whole).before;
    EXPECT_LT(largest, 0.95 * whole);
    const auto inertia = [&](double psi, double tau) {
      return wings_at_twist(each.w, each.p, stroke_inertia, pitch_state(psi, 0.0, 0.0), {tau, 0.0}, 1.0, 1.0, 1.0)
          .inertia;
    };
    each.p.mass_product = 0.9999 * largest;
    for (int n = 0; n < 2000; ++n) ASSERT_GT(inertia(angle(random), angle(random)), 0.0);
    each.p.mass_product = 1.05 * largest;
    EXPECT_LT(inertia(0.0, 0.0), 0.0);
  }
}

TEST(WingTorsion, TheRefusalNamesTheBound) {
  Wings wings = wings_of(PlanformShape::semi_ellipse);
  wings.p.mass_product = 2e-8;
  EXPECT_EQ(
      error_of([&] { validate(wings.p, stroke_inertia); }),
      "wing.mass_product: no wing that twists has that much: with its mass spread as that of an even membrane, |P| "
      "< 0.7978 sqrt(J_w I_psi), 1.888e-08 of 2e-08 kg m2 in all wings");
}

// A wing clamped at its root, in vacuum: omega^2 = k_tau / integral (r/R)^2 dI.
TEST(WingTorsion, FreeTorsionHasItsFrequency) {
  for (const PlanformShape shape : shapes) {
    Wings each = wings_of(shape);
    each.w.air_density = 0.0;
    each.p.air = {};
    const Planform<double> plan = outline(shape);
    // The integral by Simpson's rule, from the chord itself.
    constexpr int parts = 20000;
    double inertia = 0.0, all = 0.0;
    for (int n = 0; n <= parts; ++n) {
      const double x = double(n) / parts, weight = n == 0 || n == parts ? 1.0 : n % 2 ? 4.0 : 2.0;
      const double c = chord_at(plan, x);
      inertia += weight * x * x * c * c * c;
      all += weight * c * c * c;
    }
    inertia *= each.p.pitch_inertia / all;
    const double tau = 0.1;
    const TwistingWings<double> w =
        wings_at_twist(each.w, each.p, stroke_inertia, pitch_state(0.0, 0.0, 0.0), {tau, 0.0}, 1.0, 1.0, -1.0);
    EXPECT_NEAR(-w.twist_free / tau, each.p.torsion.stiffness / inertia, 2e-6 * each.p.torsion.stiffness / inertia);
  }
}

}  // namespace
}  // namespace wingbeat
