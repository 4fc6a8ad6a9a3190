// Pitch as a degree of freedom: moments of the planform, inertia from the kinetic energy, loads and their power, what
// the stroke sees of it.
#include "wingbeat/parts/pitching_wings.hpp"

#include <gtest/gtest.h>

#include <random>

#include "parts/expect_error.hpp"
#include "parts/outline.hpp"
#include "wingbeat/core/jet.hpp"

namespace wingbeat {
namespace {

constexpr double wing_length = 63e-3, wing_root = 25e-3, two_wings = 2.0, sea_level = 1.225;
constexpr double pair_inertia = 2.0 * 7.205e-8;

struct PitchingPair {
  BladeElement<double> w;
  PitchingWings<double> p;
};

PitchingPair pitching_pair(NormalForce normal_force = NormalForce::lift_and_drag, double air_density = sea_level) {
  const Planform<double> outline = outline_of(PlanformShape::semi_ellipse, 3e-3, wing_length, wing_root);
  const ChordMoments<double> s = chord_moments(outline, two_wings);
  PitchingPair pair;
  pair.w = {air_density, 5e-3, s.s2, s.s3, translational_2022()};
  pair.p.hinge = hinges_together<double>({3e-4, 2e-7}, two_wings);
  pair.p.pitch_inertia = two_wings * 4e-9;
  pair.p.mass_product = two_wings * 1.2e-8;
  pair.p.moments = pitch_chord_moments(outline, two_wings);
  pair.p.air = pitch_added_mass(air_density, pair.p.moments, 0.0);
  pair.p.normal_force = normal_force;
  return pair;
}

PitchState<double> random_pitching(std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  return pitch_state(uniform(-1.5, 1.5), uniform(-300.0, 300.0), uniform(-200.0, 200.0));
}

TEST(PitchChordMoments, AgreeWithIntegrals) {
  for (const PlanformShape shape : {PlanformShape::semi_ellipse, PlanformShape::rectangle}) {
    for (const double d : {0.0, 4e-3}) {
      const Planform<double> p = outline_of(shape, d, wing_length, wing_root);
      PitchChordMoments<double> sum;
      const int steps = 20000;
      for (int n = 0; n < steps; ++n) {
        const double x = wing_length * (n + 0.5) / steps, dr = wing_length / steps, r = x + d;
        const double c =
            wing_root * (shape == PlanformShape::rectangle ? 1.0 : std::sqrt(1.0 - square(x / wing_length)));
        sum.s21 += c * c * r * dr;
        sum.s22 += c * c * r * r * dr;
        sum.s30 += c * c * c * dr;
        sum.s31 += c * c * c * r * dr;
        sum.s40 += square(square(c)) * dr;
      }
      const PitchChordMoments<double> m = pitch_chord_moments(p, two_wings);
      EXPECT_NEAR(m.s21, two_wings * sum.s21, 1e-7 * m.s21);
      EXPECT_NEAR(m.s22, two_wings * sum.s22, 1e-7 * m.s22);
      EXPECT_NEAR(m.s30, two_wings * sum.s30, 1e-7 * m.s30);
      EXPECT_NEAR(m.s31, two_wings * sum.s31, 1e-7 * m.s31);
      EXPECT_NEAR(m.s40, two_wings * sum.s40, 1e-7 * m.s40);
      EXPECT_EQ(m.s22, squared_chord_moment(p, two_wings));
    }
  }
}

TEST(PitchChordMoments, OfTablesAreExact) {
  for (const double d : {0.0, 8e-3}) {
    Planform<double> table = outline_of(PlanformShape::tabulated, d, wing_length, wing_root);
    table.chord_table = {{0.0, wing_root}, {0.3 * wing_length, wing_root}, {wing_length, wing_root}};
    const auto m = pitch_chord_moments(table, two_wings),
               exact = pitch_chord_moments(outline_of(PlanformShape::rectangle, d, wing_length, wing_root), two_wings);
    EXPECT_NEAR(m.s21, exact.s21, 1e-14 * exact.s21);
    EXPECT_NEAR(m.s22, exact.s22, 1e-14 * exact.s22);
    EXPECT_NEAR(m.s30, exact.s30, 1e-14 * exact.s30);
    EXPECT_NEAR(m.s31, exact.s31, 1e-14 * exact.s31);
    EXPECT_NEAR(m.s40, exact.s40, 1e-14 * exact.s40);
  }
  Planform<double> triangle = outline_of(PlanformShape::tabulated, 0.0, wing_length, wing_root);
  triangle.chord_table = {{0.0, wing_root}, {wing_length, 0.0}};
  const auto m = pitch_chord_moments(triangle, 1.0);
  EXPECT_NEAR(m.s31, std::pow(wing_root, 3) * wing_length * wing_length / 20.0, 1e-14 * m.s31);
  EXPECT_NEAR(m.s40, std::pow(wing_root, 4) * wing_length / 5.0, 1e-14 * m.s40);
}

TEST(PitchingWings, NormalForceSetIsItsPublishedForm) {
  const PitchingPair pair = pitching_pair(NormalForce::normal_force);
  for (double alpha = -0.5; alpha < 3.6; alpha += 0.07) {
    const double published = 1.8 * std::sin(2.0 * alpha) * std::cos(alpha) + 1.95 * std::sin(alpha) -
                             1.5 * std::cos(2.0 * alpha) * std::sin(alpha);
    EXPECT_NEAR(normal_force_coefficient(pair.w, pair.p, alpha), published, 1e-14);
  }
}

TEST(PitchingWings, CentreOfPressureMovesFromTheLeadingEdgeBackwards) {
  for (double alpha = 0.2; alpha < pi - 0.2; alpha += 0.1) {
    EXPECT_NEAR(centre_of_pressure(alpha), 0.05 + 0.82 * alpha / pi, 0.012);
  }
  EXPECT_NEAR(centre_of_pressure(0.5 * pi), 0.46, 1e-15);
}

// Section 12's equations are those of Lagrange with its kinetic energy: the momenta's rates less the energy's slope.
TEST(PitchingWings, InertiaIsThatOfTheKineticEnergy) {
  using J = Jet<1>;
  const PitchingPair pair = pitching_pair(NormalForce::lift_and_drag, 0.0);
  PitchingPair with_air = pitching_pair();
  with_air.w.air_density = 0.0;  // its inertia, without its forces
  std::mt19937_64 random(14);
  for (const PitchingPair& each : {pair, with_air}) {
    PitchingWings<double> p = each.p;
    p.hinge = {};
    const PitchingWings<J> pj = cast<J>(p);
    for (int n = 0; n < 50; ++n) {
      const PitchState<double> state = random_pitching(random);
      const struct {
        double stroke, pitch;
      } acc{3e4 * std::sin(double(n)), 5e4 * std::cos(2.0 * n)};
      const auto along = [](double value, double rate) {
        J x(value);
        x.v[0] = rate;
        return x;
      };
      const auto moving = pitch_state(along(state.psi, state.velocity), along(state.velocity, acc.pitch),
                                      along(state.stroke_velocity, acc.stroke));
      const PitchInertia<J> m = pitch_inertia(pj, J(pair_inertia), moving);
      const J p_b = m.bb * moving.stroke_velocity + m.bp * moving.velocity;
      const J p_p = m.bp * moving.stroke_velocity + m.pp * moving.velocity;
      const auto turned = pitch_state(J(state.psi, 0), J(state.velocity), J(state.stroke_velocity));
      const double slope = kinetic_energy(pitch_inertia(pj, J(pair_inertia), turned), turned).v[0];

      // The momentum's rate of the stroke drives it, the pitch is driven by p_p' - slope: zero for the free one.
      const WingsAtPitch<double> w = wings_at_pitch(each.w, p, pair_inertia, state, 1.0, 1.0, 1.0);
      const double m_pp = m.pp.a, m_bp = m.bp.a, drive = p_p.v[0] - slope;
      const double pitch = acc.pitch - w.free_acceleration - w.coupling * acc.stroke;
      EXPECT_NEAR(m_pp * pitch, drive, 1e-12 * (std::abs(m_pp * acc.pitch) + std::abs(m_bp * acc.stroke)));
      const double stroke = w.inertia * acc.stroke + w.moment + m_bp * pitch;
      EXPECT_NEAR(stroke, p_b.v[0], 1e-12 * (std::abs(m.bb.a * acc.stroke) + std::abs(m_bp * acc.pitch) + 1e-6));
    }
  }
}

// What drives the stroke goes into kinetic energy, hinge and air, and nowhere else.
TEST(PitchingWings, EveryWattOfTheStrokeIsAccountedFor) {
  using J = Jet<1>;
  std::mt19937_64 random(15);
  for (const NormalForce normal_force : {NormalForce::lift_and_drag, NormalForce::normal_force}) {
    const PitchingPair pair = pitching_pair(normal_force);
    const PitchingWings<J> pj = cast<J>(pair.p);
    for (int n = 0; n < 50; ++n) {
      const PitchState<double> state = random_pitching(random);
      const WingsAtPitch<double> w = wings_at_pitch(pair.w, pair.p, pair_inertia, state, sign_of(state.stroke_velocity),
                                                    sign_of(state.velocity), 1.0);
      const double stroke_acceleration = 4e4 * std::cos(double(n));
      const double pitch_acceleration = w.free_acceleration + w.coupling * stroke_acceleration;
      J psi(state.psi), turn(state.velocity), stroke(state.stroke_velocity);
      psi.v[0] = state.velocity;
      turn.v[0] = pitch_acceleration;
      stroke.v[0] = stroke_acceleration;
      const auto moving = pitch_state(psi, turn, stroke);
      const J energy =
          kinetic_energy(pitch_inertia(pj, J(pair_inertia), moving), moving) + hinge_loads(pj.hinge, psi, turn).energy;
      const double drive = (w.inertia * stroke_acceleration + w.moment) * state.stroke_velocity;
      const double size = std::abs(drive) + std::abs(energy.v[0]) + std::abs(w.aero.power);
      EXPECT_NEAR(drive, energy.v[0] + w.aero.power + w.hinge.loss, 1e-12 * size);
      // Held by a stop, the wings are one body.
      const PitchState<double> still = pitch_state(state.psi, 0.0, state.stroke_velocity);
      const WingsAtPitch<double> held =
          wings_at_pitch(pair.w, pair.p, pair_inertia, still, sign_of(state.stroke_velocity), 1.0, -1.0);
      EXPECT_EQ(held.inertia, pitch_inertia(pair.p, pair_inertia, still).bb);
      EXPECT_EQ(held.moment, held.aero.stroke_moment);
      EXPECT_EQ(held.free_acceleration, 0.0);
      EXPECT_EQ(held.coupling, 0.0);
    }
  }
}

TEST(PitchingWings, BothStrokesAreEachOthersMirrorImage) {
  std::mt19937_64 random(16);
  const PitchingPair pair = pitching_pair();
  for (int n = 0; n < 50; ++n) {
    const PitchState<double> state = random_pitching(random),
                             mirrored = pitch_state(-state.psi, -state.velocity, -state.stroke_velocity);
    const double stroke = sign_of(state.stroke_velocity), turn = sign_of(state.velocity);
    const auto a = wings_at_pitch(pair.w, pair.p, pair_inertia, state, stroke, turn, 1.0);
    const auto b = wings_at_pitch(pair.w, pair.p, pair_inertia, mirrored, -stroke, -turn, 1.0);
    EXPECT_EQ(a.inertia, b.inertia);
    EXPECT_EQ(a.moment, -b.moment);
    EXPECT_EQ(a.free_acceleration, -b.free_acceleration);
    EXPECT_EQ(a.coupling, b.coupling);
    EXPECT_EQ(a.aero.power, b.aero.power);
    EXPECT_EQ(lift_at_pitch(pair.p, a, state, 1e4, -2e4), lift_at_pitch(pair.p, b, mirrored, -1e4, 2e4));
  }
}

TEST(PitchingWings, WingsThatStandUprightMeetTheAirAsUnderALawWithoutPitching) {
  PitchingPair pair = pitching_pair();
  pair.w.pitch_coefficient = 0.0;
  pair.w.added_inertia = added_inertia_of(sea_level, pair.p.moments.s22);
  for (const double velocity : {-120.0, -3.0, 40.0, 150.0}) {
    const PitchState<double> state = pitch_state(0.0, 0.0, velocity);
    const AeroLoads<double> law = aero_loads(pair.w, velocity, sign_of(velocity), 1.0);
    const WingsAtPitch<double> w = wings_at_pitch(pair.w, pair.p, pair_inertia, state, sign_of(velocity), 1.0, -1.0);
    EXPECT_NEAR(w.aero.stroke_moment, law.moment, 1e-14 * std::abs(law.moment));
    EXPECT_NEAR(w.aero.power, law.power, 1e-14 * law.power);
    EXPECT_EQ(w.aero.angle_of_attack, law.angle_of_attack);
    EXPECT_NEAR(w.inertia, pair_inertia + law.added_inertia, 1e-14 * w.inertia);
    EXPECT_EQ(lift_at_pitch(pair.p, w, state, 1e4, 0.0), 0.0);
  }
}

// Under the pitch law the stroke pays for what turns the wings: docs/model.md, section 10 against section 12.
TEST(PitchingWings, HeldToThePitchLawTheyTakeTheMomentOfTheAddedMassUnderIt) {
  PitchingPair pair = pitching_pair();
  const double J_a = pair.p.air.rr, C_alpha = 5e-3;
  pair.p.air = {};
  pair.p.air.rr = J_a;
  pair.p.pitch_inertia = 1e-30;
  pair.p.mass_product = 0.0;
  pair.p.hinge = {};
  pair.w.air_density = 0.0;
  pair.w.pitch_coefficient = C_alpha;
  pair.w.added_inertia = J_a;
  for (const double velocity : {-150.0, -20.0, 60.0, 200.0}) {
    const double acceleration = 2.5e4, stroke = sign_of(velocity);
    const PitchState<double> state = pitch_state(-C_alpha * velocity, -C_alpha * acceleration, velocity);
    const auto wings = wings_at_pitch(pair.w, pair.p, 0.0, state, stroke, sign_of(state.velocity), -1.0);
    const double stroke_power = (wings.inertia * acceleration + wings.moment) * velocity;
    const double turning_power = -wings.pitching_moment * state.velocity;
    const double law = aero_loads(pair.w, velocity, stroke, 1.0).added_inertia * acceleration * velocity;
    EXPECT_NEAR(stroke_power + turning_power, law, 1e-12 * std::abs(law));
    EXPECT_GT(std::abs(turning_power), 1e-3 * std::abs(law));
  }
}

// With the force along the chord in full the lift of the added mass is the rate of the air's momentum.
TEST(PitchingWings, AllOfTheEdgeSuctionMakesTheLiftARateOfMomentum) {
  PitchingPair pair = pitching_pair();
  using J = Jet<1>;
  const PitchingWings<J> dual = cast<J>(pair.p);
  pair.w.air_density = 0.0;  // the added mass stays
  for (const auto& [psi, velocity, stroke] : {std::array{0.5, 150.0, 80.0}, {-0.9, 60.0, -40.0}, {0.2, -220.0, 0.0}}) {
    const double stroke_acceleration = 3e4, pitch_acceleration = -5e4;
    J at_psi(psi), at_velocity(velocity), at_stroke(stroke);
    at_psi.v[0] = velocity;
    at_velocity.v[0] = pitch_acceleration;
    at_stroke.v[0] = stroke_acceleration;
    const PitchState<J> moving = pitch_state(at_psi, at_velocity, at_stroke);
    const double rate = J(air_momentum(dual, moving) * moving.sin_psi).v[0];
    const PitchState<double> state = pitch_state(psi, velocity, stroke);
    const auto wings = wings_at_pitch(pair.w, pair.p, pair_inertia, state, sign_of(stroke), sign_of(velocity), 1.0);
    const auto lift = [&](double suction) {
      pair.p.edge_suction = suction;
      return lift_at_pitch(pair.p, wings, state, stroke_acceleration, pitch_acceleration);
    };
    EXPECT_NEAR(lift(1.0), -rate, 1e-13 * std::abs(rate));
    EXPECT_NEAR(lift(0.0) - lift(1.0), chordwise_lift(pair.p, state), 1e-12 * std::abs(rate));
    EXPECT_GT(std::abs(lift(0.0) - lift(1.0)), 1e-6);
    EXPECT_NEAR(lift(0.25), 0.75 * lift(0.0) + 0.25 * lift(1.0), 1e-13 * std::abs(rate));
  }
}

TEST(PitchingWings, DragMakesThePitchLagAndLagLifts) {
  for (const NormalForce normal_force : {NormalForce::lift_and_drag, NormalForce::normal_force}) {
    PitchingPair pair = pitching_pair(normal_force);
    pair.p.air = {};
    for (const double velocity : {-120.0, 120.0}) {
      const double stroke = sign_of(velocity);
      const auto upright =
          wings_at_pitch(pair.w, pair.p, pair_inertia, pitch_state(0.0, 0.0, velocity), stroke, 1.0, 1.0);
      EXPECT_LT(upright.free_acceleration * velocity, 0.0);
      const PitchState<double> lagging = pitch_state(-stroke * 0.8, 0.0, velocity);
      const auto loads = aero_loads(pair.w, pair.p, lagging, stroke, 1.0);
      EXPECT_NEAR(loads.angle_of_attack, 0.5 * pi - 0.8, 1e-15);
      const auto w = wings_at_pitch(pair.w, pair.p, pair_inertia, lagging, stroke, 1.0, 1.0);
      EXPECT_GT(lift_at_pitch(pair.p, w, lagging, 0.0, 0.0), 0.0);
    }
  }
}

// A slow stroke of light wings: the hinge balances the air, which is the law of section 3, derived.
TEST(PitchingWings, StaticBalanceHoldsTheHingeAgainstTheAir) {
  PitchingPair pair = pitching_pair(NormalForce::normal_force);
  pair.p.air = {};
  pair.p.pitch_inertia = 1e-30;
  pair.p.mass_product = 0.0;
  const double velocity = 100.0;
  double psi = 0.0;
  for (int n = 0; n < 200; ++n) {
    psi = -aero_loads(pair.w, pair.p, pitch_state(psi, 0.0, velocity), 1.0, 1.0).pitch_moment / pair.p.hinge.stiffness;
  }
  const auto w = wings_at_pitch(pair.w, pair.p, pair_inertia, pitch_state(psi, 0.0, velocity), 1.0, 1.0, 1.0);
  EXPECT_LT(psi, -0.1);
  EXPECT_NEAR(w.pitching_moment, 0.0, 1e-14 * pair.p.hinge.stiffness);
}

TEST(PitchingWings, RotationAndItsDampingTakeTheirPower) {
  PitchingPair pair = pitching_pair();
  // Turning at rest of the stroke: damping alone.
  for (const double velocity : {-200.0, 200.0}) {
    const auto loads = aero_loads(pair.w, pair.p, pitch_state(0.4, velocity, 0.0), 1.0, sign_of(velocity));
    EXPECT_NEAR(loads.power, 0.125 * sea_level * 5.0 * std::pow(200.0, 3) * pair.p.moments.s40, 1e-14 * loads.power);
    EXPECT_EQ(loads.normal_force, 0.0);
  }
  // A wing whose angle of attack grows is pressed back by more, one whose angle falls by less.
  const auto grows = aero_loads(pair.w, pair.p, pitch_state(-0.5, 100.0, 80.0), 1.0, 1.0);
  const auto falls = aero_loads(pair.w, pair.p, pitch_state(-0.5, -100.0, 80.0), 1.0, -1.0);
  EXPECT_NEAR(grows.normal_force - falls.normal_force, 2.0 * 0.75 * pi * sea_level * 80.0 * 100.0 * pair.p.moments.s21,
              1e-12 * grows.normal_force);
  pair.p.rotational_coefficient = 0.0;
  EXPECT_EQ(aero_loads(pair.w, pair.p, pitch_state(-0.5, 100.0, 80.0), 1.0, 1.0).normal_force,
            aero_loads(pair.w, pair.p, pitch_state(-0.5, -100.0, 80.0), 1.0, -1.0).normal_force);
}

TEST(PitchingWings, DualNumbersAgreeWithDifferences) {
  using J = Jet<3>;
  std::mt19937_64 random(17);
  const PitchingPair pair = pitching_pair();
  const BladeElement<J> wj = cast<J>(pair.w);
  const PitchingWings<J> pj = cast<J>(pair.p);
  for (int n = 0; n < 40; ++n) {
    PitchState<double> state = random_pitching(random);
    if (n == 0) state = pitch_state(0.3, 0.0, 0.0);  // a reversal of both
    const double stroke = sign_of(state.stroke_velocity), turn = sign_of(state.velocity);
    const auto values = [&](double psi, double velocity, double stroke_velocity) {
      const PitchState<double> s = pitch_state(psi, velocity, stroke_velocity);
      const auto w = wings_at_pitch(pair.w, pair.p, pair_inertia, s, stroke, turn, 1.0);
      return std::array{w.inertia,  w.moment,     w.free_acceleration,
                        w.coupling, w.aero.power, lift_at_pitch(pair.p, w, s, 1e4, 2e4)};
    };
    const PitchState<J> s = pitch_state(J(state.psi, 0), J(state.velocity, 1), J(state.stroke_velocity, 2));
    const auto w = wings_at_pitch(wj, pj, J(pair_inertia), s, J(stroke), J(turn), J(1.0));
    const std::array dual{w.inertia,  w.moment,     w.free_acceleration,
                          w.coupling, w.aero.power, lift_at_pitch(pj, w, s, J(1e4), J(2e4))};
    const double h[] = {1e-4, 0.05, 0.05};
    for (int k = 0; k < 3; ++k) {
      const auto moved = [&](double by) {
        return values(state.psi + (k == 0) * by, state.velocity + (k == 1) * by, state.stroke_velocity + (k == 2) * by);
      };
      const auto a = moved(-2.0 * h[k]), b = moved(-h[k]), c = moved(h[k]), d = moved(2.0 * h[k]);
      for (std::size_t i = 0; i < dual.size(); ++i) {
        const double difference = (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h[k]);
        EXPECT_NEAR(dual[i].v[k], difference, 1e-8 * (std::abs(difference) + std::abs(dual[i].a) / h[k] * 1e-3 + 1e-12))
            << i << " by " << k;
      }
    }
  }
}

TEST(PitchingWings, RefusesWhatNoWingIs) {
  const PitchingWings<double> good = pitching_pair().p;
  const auto refused = [&](const auto& spoil) {
    PitchingWings<double> p = good;
    spoil(p);
    return error_of([&] { validate(p, pair_inertia); });
  };
  using P = PitchingWings<double>;
  EXPECT_EQ(refused([](P&) {}), "no error");
  EXPECT_EQ(refused([](P& p) { p.hinge.stiffness = -1e-4; }), "pitch.stiffness: must be >= 0 [N m/rad], got -0.0001");
  EXPECT_EQ(refused([](P& p) { p.hinge.damping = -1e-7; }), "pitch.damping: must be >= 0 [N m s/rad], got -1e-07");
  EXPECT_EQ(refused([](P& p) { set_stops(p.hinge, -0.1); }),
            "pitch.stop: must be > 0 and < pi [rad], got -0.1 (-5.73 deg)");
  EXPECT_EQ(refused([](P& p) { p.hinge.friction = -1e-6; }), "pitch.friction: must be >= 0 [N m], got -1e-06");
  EXPECT_EQ(refused([](P& p) { p.pitch_inertia = 0.0; }), "wing.pitch_inertia: must be > 0 [kg m2], got 0");
  EXPECT_EQ(refused([](P& p) { p.damping_coefficient = -5.0; }), "pitch.damping_coefficient: must be >= 0 [1], got -5");
  EXPECT_EQ(refused([](P& p) { p.edge_suction = 1.5; }),
            "pitch.leading_edge_suction: must lie between 0 and 1 [1], got 1.5");
  EXPECT_EQ(refused([](P& p) { p.mass_product = -4e-8; }),
            "wing.mass_product: no wing has that much: its square must be below wing.inertia times "
            "wing.pitch_inertia, |P| < 3.395e-08 of 4e-08 kg m2 in all wings");
}

// The nearer stop is that of the half of the range in which the wings are, not that of the sign of their pitch.
TEST(PitchHinge, StopsMayDifferToEitherSide) {
  PitchHinge<double> h;
  EXPECT_FALSE(has_stop(h));
  h.stop_low = -0.1;
  h.stop_high = 0.45;
  EXPECT_EQ(nearer_stop(h, 0.14), -0.1);
  EXPECT_EQ(nearer_stop(h, 0.18), 0.45);
  for (const double between : {-0.0999, 0.0, 0.14, 0.18, 0.4499}) EXPECT_FALSE(is_at_stop(h, between)) << between;
  for (const double beyond : {-0.2, -0.1, 0.45, 0.5}) EXPECT_TRUE(is_at_stop(h, beyond)) << beyond;
  EXPECT_EQ(farther_stop(h), 0.45);
  EXPECT_EQ(closer_stop(h), 0.1);
  // At the upper stop a moment towards a larger pitch presses on it, at the lower one the opposite.
  EXPECT_EQ(holding_margin(h, 0.45, 2e-3), 2e-3);
  EXPECT_EQ(holding_margin(h, -0.1, 2e-3), -2e-3);
  EXPECT_EQ(leaving_side(h, 0.45, -1e-3), -1.0);
  EXPECT_EQ(leaving_side(h, -0.1, 1e-3), 1.0);
  set_stops(h, 0.3);
  EXPECT_EQ(nearer_stop(h, 0.0), 0.3);
  EXPECT_EQ(nearer_stop(h, -1e-9), -0.3);
}

}  // namespace
}  // namespace wingbeat
