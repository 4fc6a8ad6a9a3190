// Loss at the tips, wings in their wake, clap and fling, forces along the chord, pitch axis and centre of pressure:
// against quadratures of their definitions that share no rule, node or moment with the model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "parts/outline.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/parts/wing_mass.hpp"

namespace wingbeat {
namespace {

constexpr double length = 63e-3, root_chord = 25e-3, offset = 4e-3, count = 2.0, density = 1.2;
constexpr PlanformShape shapes[] = {PlanformShape::semi_ellipse, PlanformShape::rectangle, PlanformShape::tabulated};

Planform<double> planform(PlanformShape shape) {
  Planform<double> p = outline_of(shape, offset, length, root_chord);
  if (shape == PlanformShape::tabulated) {
    p.chord_table = {{0.0, 12e-3}, {10e-3, 25e-3}, {30e-3, 27e-3}, {50e-3, 18e-3}, {63e-3, 3e-3}};
  }
  return p;
}

double chord_of(const Planform<double>& p, double x) {
  if (p.shape == PlanformShape::semi_ellipse) return root_chord * std::sqrt(std::max(0.0, 1.0 - square(x / length)));
  if (p.shape == PlanformShape::rectangle) return root_chord;
  for (std::size_t row = 1;; ++row) {
    const auto [x0, c0] = p.chord_table[row - 1];
    const auto [x1, c1] = p.chord_table[row];
    if (x <= x1 || row + 1 == p.chord_table.size()) return c0 + (c1 - c0) * (x - x0) / (x1 - x0);
  }
}

/// Integral of f(r, c) dr of one wing from one part of its length to another, by Simpson's rule.
double over_span(const Planform<double>& p, double from, double to, const std::function<double(double, double)>& f) {
  std::vector<double> ends = {from, to};
  for (const auto& row : p.chord_table) {
    const double part = row.first / length;
    if (part > from && part < to) ends.push_back(part);
  }
  std::sort(ends.begin(), ends.end());
  const bool elliptic = p.shape == PlanformShape::semi_ellipse;
  double sum = 0.0;
  for (std::size_t n = 1; n < ends.size(); ++n) {
    const double a = elliptic ? std::asin(ends[n - 1]) : ends[n - 1], b = elliptic ? std::asin(ends[n]) : ends[n];
    constexpr int panels = 4000;
    const double h = (b - a) / panels;
    for (int k = 0; k <= panels; ++k) {
      const double t = a + h * k, weight = k == 0 || k == panels ? 1.0 : k % 2 ? 4.0 : 2.0;
      const double x = length * (elliptic ? std::sin(t) : t), dx = length * (elliptic ? std::cos(t) : 1.0);
      sum += h / 3.0 * weight * dx * f(offset + x, chord_of(p, x));
    }
  }
  return sum;
}

double part_of(double B) { return (B * (length + offset) - offset) / length; }

struct Wings {
  BladeElement<double> w;
  PitchingWings<double> p;
};

Wings wings_of(const Planform<double>& outline, std::string_view set, double B, double velocity) {
  const ChordMoments<double> s = chord_moments(outline, count);
  Wings wings{{density, 5e-3, s.s2, s.s3, *named_coefficients(set)}, {}};
  if (B < 1.0) wings.w.tip = tip_loss(outline, count, B, drag_coefficient(wings.w.coefficients, 0.0));
  wings.w.wake.strips = wake_strips(outline, count, part_of(B));
  wings.w.wake.velocity = velocity;
  wings.p.moments = pitch_chord_moments(outline, count);
  wings.p.rotational_coefficient = wings.p.damping_coefficient = 0.0;
  return wings;
}

/// Lift and moment of wings at one geometric angle of attack, from the definition.
LiftAndDrag<double> by_definition(const Wings& wings, const Planform<double>& outline, double B, double alpha,
                                  double speed) {
  const ForceCoefficients<double>& c = wings.w.coefficients;
  const double v = wings.w.wake.velocity, end = part_of(B);
  const auto strip = [&](double r, double chord, bool of_moment) {
    const double u = r * speed, phi = std::atan2(v, u), U2 = u * u + v * v;
    const double lift = lift_coefficient(c, alpha - phi) - lift_coefficient(c, 0.0) * square(std::sin(phi));
    const double drag = drag_coefficient(c, alpha - phi);
    return 0.5 * density * chord * U2 *
           (of_moment ? r * (drag * std::cos(phi) + lift * std::sin(phi))
                      : lift * std::cos(phi) - drag * std::sin(phi));
  };
  const double tip = B < 1.0 ? over_span(
                                   outline, end, 1.0,
                                   [&](double r, double chord) {
                                     return 0.5 * density * chord * r * square(r * speed) * drag_coefficient(c, 0.0);
                                   })
                             : 0.0;
  return {count * over_span(outline, 0.0, end, [&](double r, double chord) { return strip(r, chord, false); }),
          count * (tip + over_span(outline, 0.0, end, [&](double r, double chord) { return strip(r, chord, true); }))};
}

TEST(TipLoss, MomentsAndLoadsAgreeWithQuadratures) {
  for (const PlanformShape shape : shapes) {
    const Planform<double> outline = planform(shape);
    for (const double B : {0.75, 0.9, 0.97}) {
      const TipLoss<double> tip = tip_loss(outline, count, B, 0.4);
      const auto beyond = [&](const std::function<double(double, double)>& f) {
        return count * over_span(outline, part_of(B), 1.0, f);
      };
      EXPECT_NEAR(tip.s2 / beyond([](double r, double c) { return c * r * r; }), 1.0, 1e-10);
      EXPECT_NEAR(tip.s3 / beyond([](double r, double c) { return c * r * r * r; }), 1.0, 1e-10);
      EXPECT_NEAR(tip.s22 / beyond([](double r, double c) { return c * c * r * r; }), 1.0, 1e-10);
      const Wings wings = wings_of(outline, "robobee", B, 0.0);
      const AeroLoads<double> loads = aero_loads(wings.w, 120.0);
      const LiftAndDrag<double> expected = by_definition(wings, outline, B, loads.angle_of_attack, 120.0);
      EXPECT_NEAR(loads.lift / expected.lift, 1.0, 1e-9);
      EXPECT_NEAR(loads.moment / expected.drag, 1.0, 1e-9);
    }
  }
}

TEST(TipLoss, DerivativesByTheLiftingSpanAreThoseOfDifferences) {
  for (const PlanformShape shape : shapes) {
    const Planform<double> outline = planform(shape);
    const auto loss = [&](double B) { return tip_loss(outline, count, B, 0.4); };
    const TipLoss<Jet<1>> exact = tip_loss(cast<Jet<1>>(outline), Jet<1>(count), Jet<1>(0.9, 0), Jet<1>(0.4));
    const double h = 1e-5;
    EXPECT_NEAR(exact.s2.v[0] / ((loss(0.9 + h).s2 - loss(0.9 - h).s2) / (2.0 * h)), 1.0, 1e-7);
    EXPECT_NEAR(exact.s3.v[0] / ((loss(0.9 + h).s3 - loss(0.9 - h).s3) / (2.0 * h)), 1.0, 1e-7);
  }
}

// A stated lifting span of 1 is none, with derivatives that are numbers.
TEST(TipLoss, VanishesWhereTheWholeSpanLifts) {
  for (const PlanformShape shape : shapes) {
    const auto outline = cast<Jet<1>>(planform(shape));
    const TipLoss<Jet<1>> tip = tip_loss(outline, Jet<1>(count), Jet<1>(1.0, 0), Jet<1>(0.4));
    EXPECT_NEAR(tip.s2.a, 0.0, 1e-20);
    EXPECT_TRUE(std::isfinite(tip.s2.v[0]));
    const WakeStrips<Jet<1>> strips = wake_strips(outline, Jet<1>(count), Jet<1>(1.0, 0));
    for (const WakeStrip<Jet<1>>& strip : strips.at) EXPECT_TRUE(std::isfinite(strip.radius.v[0] + strip.area.v[0]));
  }
}

TEST(InducedVelocity, LoadsUnderThePitchLawAgreeWithAQuadrature) {
  for (const PlanformShape shape : shapes) {
    const Planform<double> outline = planform(shape);
    for (const char* set : {"translational-2022", "robobee", "normal-tangential"}) {
      for (const double B : {1.0, 0.93}) {
        if (shape == PlanformShape::tabulated && B < 1.0) continue;
        for (const double velocity : {0.5, 2.0}) {
          const Wings wings = wings_of(outline, set, B, velocity);
          double worst = 0.0, lift = 0.0, moment = 0.0;
          for (const double speed : {5.0, 25.0, 70.0, 120.0, 150.0}) {
            const AeroLoads<double> loads = aero_loads(wings.w, speed);
            const LiftAndDrag<double> exact = by_definition(wings, outline, B, loads.angle_of_attack, speed);
            lift = std::max(lift, std::abs(exact.lift));
            moment = std::max(moment, std::abs(exact.drag));
            worst = std::max(
                {worst, std::abs(loads.lift - exact.lift) / lift, std::abs(loads.moment - exact.drag) / moment});
            EXPECT_EQ(loads.power, loads.moment * speed);
          }
          // The curvature of the force along the chord jumps at 45 degrees, where some strip is.
          EXPECT_LT(worst, set == std::string("normal-tangential") ? 1e-3 : 1e-8) << name_of(shape) << set << velocity;
        }
      }
    }
  }
}

// Of a set that lifts at an angle of attack of 0, too.
TEST(InducedVelocity, LoadsAreContinuousWhereTheStrokeReverses) {
  Wings wings = wings_of(planform(PlanformShape::semi_ellipse), "translational-2022", 1.0, 2.0);
  const double scale = aero_loads(wings.w, 100.0).moment;
  EXPECT_NEAR(aero_loads(wings.w, 1e-9, 1.0, 1.0).moment, aero_loads(wings.w, -1e-9, -1.0, 1.0).moment, 1e-9 * scale);
  for (const double psi : {-0.8, 0.0, 0.6}) {
    const auto loads_at = [&](double velocity, double sign) {
      return aero_loads(wings.w, wings.p, pitch_state(psi, 0.0, velocity), sign, 1.0);
    };
    EXPECT_NEAR(loads_at(1e-9, 1.0).stroke_moment, loads_at(-1e-9, -1.0).stroke_moment, 1e-9 * scale);
    PitchState<double> apart = pitch_state(psi, 0.0, -1e-9);
    apart.clap = 1.5;
    EXPECT_NEAR(aero_loads(wings.w, wings.p, apart, -1.0, 1.0).normal_force, loads_at(1e-9, 1.0).normal_force,
                1e-9 * scale / 0.05);
    EXPECT_NEAR(loads_at(1e-9, 1.0).normal_force, loads_at(-1e-9, -1.0).normal_force, 1e-9 * scale / 0.05);
  }
}

TEST(InducedVelocity, WithoutOneTheStripsGiveTheMoments) {
  for (const PlanformShape shape : shapes) {
    Wings wings = wings_of(planform(shape), "translational-2022", 1.0, 1e-12);
    const AeroLoads<double> in_wake = aero_loads(wings.w, 90.0);
    wings.w.wake.velocity = 0.0;
    const AeroLoads<double> plain = aero_loads(wings.w, 90.0);
    EXPECT_NEAR(in_wake.lift / plain.lift, 1.0, 1e-9);
    EXPECT_NEAR(in_wake.moment / plain.moment, 1.0, 1e-9);
  }
}

TEST(InducedVelocity, IsThatOfAnActuatorDisc) {
  InducedVelocity<double> wake;
  wake.share = 0.7;
  wake.sector = 2.0 * square(0.067);
  EXPECT_NEAR(induced_velocity_of(wake, 1.2, 0.1, 1.1), 0.7 * std::sqrt(0.1 / (2.0 * 1.2 * 2.0 * 1.1 * square(0.067))),
              1e-15);
  wake.swept_area = 0.02;
  EXPECT_NEAR(induced_velocity_of(wake, 1.2, 0.1, 1.1), 0.7 * std::sqrt(0.1 / (2.0 * 1.2 * 0.02)), 1e-15);
  EXPECT_EQ(induced_velocity_of(wake, 1.2, -0.1, 1.1), 0.0);
}

TEST(InducedVelocity, LoadsOnHingesAgreeWithAQuadrature) {
  for (const PlanformShape shape : shapes) {
    const Planform<double> outline = planform(shape);
    for (const char* set : {"robobee", "normal-tangential"}) {
      for (const CentreOfPressure centre : {CentreOfPressure::fourier, CentreOfPressure::chen}) {
        for (const double B : {1.0, 0.93}) {
          if (shape == PlanformShape::tabulated && B < 1.0) continue;
          Wings wings = wings_of(outline, set, B, 1.5);
          wings.p.centre_of_pressure = centre;
          wings.p.axis = 0.2;
          const ForceCoefficients<double>& c = wings.w.coefficients;
          const double C_D0 = drag_coefficient(c, 0.0);
          for (const double psi : {-1.1, -0.6, 0.3}) {
            const double speed = 110.0, alpha = 0.5 * pi + psi, end = part_of(B);
            const PitchState<double> state = pitch_state(psi, 40.0, speed);
            const PitchAeroLoads<double> loads = aero_loads(wings.w, wings.p, state, 1.0, 1.0);
            const auto strip_at = [&](double r, bool tip) {
              struct Strip {
                double pressure, normal, along, arm;
              };
              const double u = r * speed, phi = tip ? 0.0 : std::atan2(1.5, u);
              const double angle = alpha - phi, d = centre_of_pressure(wings.p, tip ? alpha : angle);
              const double C_T =
                  tip || std::abs(angle) >= 0.25 * pi ? 0.0 : c.tangential * square(std::cos(2.0 * angle));
              const double C_N =
                  tip ? C_D0 * std::sin(alpha)
                      : lift_coefficient(c, angle) * std::cos(angle) + drag_coefficient(c, angle) * std::sin(angle);
              return Strip{0.5 * density * (u * u + (tip ? 0.0 : 2.25)), C_N, C_T, d - 0.2};
            };
            const auto sum = [&](const auto& f) {
              const auto where = [&](bool tip) {
                return [&f, &strip_at, tip](double r, double chord) { return f(strip_at(r, tip), r, chord); };
              };
              const double inner = over_span(outline, 0.0, end, where(false));
              return count * (inner + (B < 1.0 ? over_span(outline, end, 1.0, where(true)) : 0.0));
            };
            const double normal =
                sum([](const auto& s, double, double chord) { return s.pressure * s.normal * chord; });
            const double stroke = sum([&](const auto& s, double r, double chord) {
              return s.pressure * chord * r * (s.normal * std::cos(psi) + s.along * std::cos(alpha));
            });
            const double pitch =
                sum([](const auto& s, double, double chord) { return s.pressure * chord * chord * s.normal * s.arm; });
            const double lift = sum(
                [&](const auto& s, double, double chord) { return -s.pressure * chord * s.along * std::sin(alpha); });
            // As above; the slope of Chen's curve jumps where the chord is normal to the flow.
            const bool smooth = set == std::string("robobee") && centre == CentreOfPressure::fourier;
            const double accuracy = smooth ? 1e-8 : 1e-3;
            EXPECT_NEAR(loads.normal_force / normal, 1.0, accuracy);
            EXPECT_NEAR(loads.stroke_moment / stroke, 1.0, accuracy);
            EXPECT_NEAR(loads.pitch_moment / pitch, 1.0, 5.0 * accuracy);
            EXPECT_NEAR(loads.tangential_lift, lift, accuracy * std::abs(normal));
          }
        }
      }
    }
  }
}

TEST(CoefficientSets, NormalAndTangentialForcesMakeLiftAndDrag) {
  const ForceCoefficients<double> c = *named_coefficients("normal-tangential");
  for (double degrees = 1.0; degrees < 90.0; degrees += 4.0) {
    const double a = degrees / degrees_per_radian, C_N = 3.4 * std::sin(a);
    const double C_T = degrees < 45.0 ? 0.4 * square(std::cos(2.0 * a)) : 0.0;
    EXPECT_NEAR(lift_coefficient(c, a), C_N * std::cos(a) - C_T * std::sin(a), 1e-14);
    EXPECT_NEAR(drag_coefficient(c, a), C_N * std::sin(a) + C_T * std::cos(a), 1e-14);
  }
  const ForceCoefficients<double> bee = *named_coefficients("robobee");
  EXPECT_NEAR(lift_coefficient(bee, 0.6), 1.8 * std::sin(1.2), 1e-14);
  EXPECT_NEAR(drag_coefficient(bee, 0.6), 1.9 - 1.5 * std::cos(1.2), 1e-14);
}

TEST(CoefficientSets, WingsOnHingesHaveLiftAndDragOfTheSetAtTheirAngle) {
  const Planform<double> outline = planform(PlanformShape::semi_ellipse);
  const Wings wings = wings_of(outline, "normal-tangential", 1.0, 0.0);
  for (const double psi : {-1.2, -0.9, -0.4}) {
    const double speed = 80.0, alpha = 0.5 * pi + psi, pressure = 0.5 * density * speed * speed;
    const PitchAeroLoads<double> loads = aero_loads(wings.w, wings.p, pitch_state(psi, 0.0, speed), 1.0, 1.0);
    EXPECT_NEAR(-loads.normal_force * std::sin(psi) + loads.tangential_lift,
                pressure * wings.w.s2 * lift_coefficient(wings.w.coefficients, alpha), 1e-12 * pressure * wings.w.s2);
    EXPECT_NEAR(loads.stroke_moment, pressure * wings.w.s3 * drag_coefficient(wings.w.coefficients, alpha),
                1e-12 * pressure * wings.w.s3);
  }
}

TEST(CoefficientSets, AllAreNamedWithRangesAndSources) {
  for (const CoefficientSet& set : coefficient_sets) {
    EXPECT_TRUE(named_coefficients(set.name)) << set.name;
    EXPECT_LT(set.reynolds.lowest, set.reynolds.highest);
    EXPECT_GT(set.aspect_ratio, 1.0);
    EXPECT_NE(set.source, std::string());
  }
  EXPECT_FALSE(named_coefficients("none"));
}

TEST(CentreOfPressure, FollowsThePublishedCurve) {
  PitchingWings<double> p;
  p.centre_of_pressure = CentreOfPressure::chen;
  for (const double psi : {-1.4, -0.7, 0.0, 0.5, 1.2}) {
    EXPECT_NEAR(centre_of_pressure(p, 0.5 * pi + psi),
                0.25 + 0.25 / (1.0 + std::exp(5.0 * (1.0 - 4.0 * (0.5 * pi - std::abs(psi)) / pi))), 1e-15);
  }
  p.centre_of_pressure = CentreOfPressure::fourier;
  EXPECT_EQ(centre_of_pressure(p, 0.7), centre_of_pressure(0.7));
}

TEST(PitchAxis, AddedMassHasTheEnergyOfTheStrips) {
  const Planform<double> outline = planform(PlanformShape::semi_ellipse);
  const PitchChordMoments<double> moments = pitch_chord_moments(outline, count);
  for (const double axis : {0.0, 0.25, 0.5}) {
    PitchingWings<double> p;
    p.axis = axis;
    p.air = pitch_added_mass(density, moments, axis);
    const PitchState<double> state = pitch_state(0.5, 70.0, 130.0);
    const double energy =
        count * over_span(outline, 0.0, 1.0, [&](double r, double c) {
          const double normal = r * state.stroke_velocity * state.cos_psi + (0.5 - axis) * c * state.velocity;
          return 0.25 * pi * density * c * c * (0.5 * square(normal) + 0.5 * square(c * state.velocity) / 32.0);
        });
    EXPECT_NEAR(kinetic_energy(pitch_inertia(p, 0.0, state), state) / energy, 1.0, 1e-9);
  }
}

TEST(PitchAxis, MovesMomentsAndMassAsItsPositionSays) {
  const Planform<double> outline = planform(PlanformShape::rectangle);
  Wings wings = wings_of(outline, "robobee", 1.0, 0.0);
  wings.p.damping_coefficient = 5.0;
  const PitchState<double> still = pitch_state(-0.7, 0.0, 100.0), turning = pitch_state(-0.7, 90.0, 0.0);
  const auto about = [&](double axis, const PitchState<double>& state) {
    wings.p.axis = axis;
    return aero_loads(wings.w, wings.p, state, 1.0, 1.0).pitch_moment;
  };
  const double force = aero_loads(wings.w, wings.p, still, 1.0, 1.0).normal_force;
  const double lever = wings.p.moments.s22 / wings.w.s2;  // of a rectangle the chord
  EXPECT_NEAR(about(0.0, still) - about(0.3, still), 0.3 * lever * force, 1e-13);
  // Of a plate that turns in still air the drag of each strip of chord goes with x |x|.
  double both_sides = 0.0;
  constexpr int parts = 20000;
  for (int k = 0; k < parts; ++k) {
    const double x = (k + 0.5) / parts - 0.3;
    both_sides += std::pow(std::abs(x), 3) / parts;
  }
  EXPECT_NEAR(about(0.3, turning) / about(0.0, turning), 4.0 * both_sides, 1e-7);
  EXPECT_NEAR(rotational_coefficient_of(0.3), pi * 0.45, 1e-15);

  const WingMaterial<double> material{0.02, 1e-3, 3e-4, 3.0};
  const WingMass<double> edge = wing_mass(material, outline), axis = wing_mass(material, outline, 0.3);
  // Along the chord: spar at -0.3 c, membrane and ribs from there to 0.7 c.
  const double c = root_chord, spar = 1e-3 * length, area = c * length, ribs = 3.0 * 3e-4 * c;
  const double second = (std::pow(0.7, 3) + std::pow(0.3, 3)) / 3.0;
  EXPECT_NEAR(axis.pitch_inertia, c * c * (spar * 0.09 + (0.02 * area + ribs) * second), 1e-18);
  EXPECT_NEAR(axis.mass_product,
              edge.mass_product -
                  0.3 * c * over_span(outline, 0.0, 1.0, [&](double r, double) { return r * (0.02 * c + 1e-3); }) -
                  0.3 * c * 3e-4 * c * 3.0 * (offset + 0.5 * length),
              1e-14 * edge.mass_product);
}

TEST(ClapAndFling, MultipliesOnTheWayApart) {
  ClapAndFling<double> c;
  EXPECT_EQ(clap_factor(c, 0.3, -1.0), 1.0);
  c = {0.4, 0.2, 1.0, 1.2};
  EXPECT_NEAR(clap_factor(c, 1.2, -1.0), 1.4, 1e-15);
  EXPECT_NEAR(clap_factor(c, 0.7, -1.0), 1.0 + 0.4 * std::exp(-0.5 / 0.2), 1e-15);
  EXPECT_EQ(clap_factor(c, 0.7, 1.0), 1.0);
  Wings wings = wings_of(planform(PlanformShape::semi_ellipse), "robobee", 1.0, 0.0);
  wings.w.clap = c;
  const AeroLoads<double> plain = aero_loads(wings.w, -90.0, -1.0, 1.0),
                          more = aero_loads(wings.w, -90.0, -1.0, 1.0, 1.4);
  EXPECT_NEAR(more.lift / plain.lift, 1.4, 1e-14);
  EXPECT_NEAR(more.moment / plain.moment, 1.4, 1e-14);
  wings.w.wake.velocity = 1.0;
  const double rest = aero_loads(wings.w, -1e-9, -1.0, 1.0).lift;
  EXPECT_NEAR(aero_loads(wings.w, -1e-9, -1.0, 1.0, 1.4).lift, rest, 1e-9 * std::abs(rest));
  c.reach = 1.3;  // the wings reverse too far from each other
  EXPECT_EQ(clap_factor(c, 1.2, -1.0), 1.0);
  // Stations at 0.7 of 0.1 m that are a chord of 20 mm apart.
  const double reach = clap_reach(1.5, 1.0, 20e-3, 0.1);
  EXPECT_NEAR(2.0 * 0.07 * std::sin(1.5 - reach), 20e-3, 1e-15);
}

}  // namespace
}  // namespace wingbeat
