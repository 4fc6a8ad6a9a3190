// Mass properties of a wing from its drawing: against sums over strips, closed forms, derivatives.
#include "wingbeat/parts/wing_mass.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parts/outline.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/members.hpp"

namespace wingbeat {
namespace {

constexpr double drawn_length = 63e-3, drawn_chord = 25e-3;

Planform<double> outline(PlanformShape shape, double hub_offset) {
  Planform<double> p = outline_of(shape, hub_offset, drawn_length, drawn_chord);
  if (shape == PlanformShape::tabulated) p.chord_table = {{0.0, 10e-3}, {20e-3, 25e-3}, {drawn_length, 5e-3}};
  return p;
}

double chord(PlanformShape shape, double x) {
  if (shape == PlanformShape::rectangle) return drawn_chord;
  if (shape == PlanformShape::semi_ellipse) return drawn_chord * std::sqrt(1.0 - square(x / drawn_length));
  return x < 20e-3 ? 10e-3 + 15e-3 * x / 20e-3 : 25e-3 - 20e-3 * (x - 20e-3) / 43e-3;
}

TEST(WingMass, IsTheSumOverItsStrips) {
  const WingMaterial<double> material{0.02, 1e-3};
  for (const PlanformShape shape : {PlanformShape::semi_ellipse, PlanformShape::rectangle, PlanformShape::tabulated}) {
    for (const double d : {0.0, 4e-3}) {
      WingMass<double> sum{};
      constexpr int count = 200000;
      for (int n = 0; n < count; ++n) {
        const double x = drawn_length * (n + 0.5) / count, r = x + d, c = chord(shape, x), dr = drawn_length / count;
        const double strip = (0.02 * c + 1e-3) * dr;
        sum.mass += strip;
        sum.inertia += strip * r * r;
        sum.pitch_inertia += 0.02 * c * c * c / 3.0 * dr;
        sum.mass_product += 0.02 * c * c / 2.0 * r * dr;
      }
      const WingMass<double> m = wing_mass(material, outline(shape, d));
      EXPECT_NEAR(m.mass / sum.mass, 1.0, 1e-8);
      EXPECT_NEAR(m.inertia / sum.inertia, 1.0, 1e-8);
      EXPECT_NEAR(m.pitch_inertia / sum.pitch_inertia, 1.0, 1e-8);
      EXPECT_NEAR(m.mass_product / sum.mass_product, 1.0, 1e-8);
    }
  }
}

// Each rib by itself as a rod of the chord's length where it is.
TEST(WingMass, RibsAddTheirRods) {
  for (const PlanformShape shape : {PlanformShape::semi_ellipse, PlanformShape::rectangle, PlanformShape::tabulated}) {
    const Planform<double> p = outline(shape, 4e-3);
    const WingMass<double> plain = wing_mass(WingMaterial<double>{0.02, 1e-3}, p),
                           ribbed = wing_mass(WingMaterial<double>{0.02, 1e-3, 3e-4, 3.0}, p);
    WingMass<double> ribs{};
    for (const double part : {0.25, 0.5, 0.75}) {
      const double x = part * drawn_length, c = chord(shape, x), r = x + 4e-3;
      ribs.mass += 3e-4 * c;
      ribs.inertia += 3e-4 * c * r * r;
      ribs.pitch_inertia += 3e-4 * c * c * c / 3.0;
      ribs.mass_product += 3e-4 * c * c * r / 2.0;
    }
    EXPECT_NEAR((ribbed.mass - plain.mass) / ribs.mass, 1.0, 1e-12);
    EXPECT_NEAR((ribbed.inertia - plain.inertia) / ribs.inertia, 1.0, 1e-12);
    EXPECT_NEAR((ribbed.pitch_inertia - plain.pitch_inertia) / ribs.pitch_inertia, 1.0, 1e-12);
    EXPECT_NEAR((ribbed.mass_product - plain.mass_product) / ribs.mass_product, 1.0, 1e-12);
  }
}

// A plate: m R^2/3 about the hinge, m c^2/3 about the edge, m (R/2) (c/2) between; a rod along the edge: m R^2/3 alone.
TEST(WingMass, OfAPlateAndARod) {
  const Planform<double> p = outline(PlanformShape::rectangle, 0.0);
  const WingMass<double> plate = wing_mass(WingMaterial<double>{0.05, 0.0}, p);
  EXPECT_DOUBLE_EQ(plate.mass, 0.05 * drawn_length * drawn_chord);
  EXPECT_DOUBLE_EQ(plate.inertia, plate.mass * drawn_length * drawn_length / 3.0);
  EXPECT_DOUBLE_EQ(plate.pitch_inertia, plate.mass * drawn_chord * drawn_chord / 3.0);
  EXPECT_DOUBLE_EQ(plate.mass_product, plate.mass * drawn_length * drawn_chord / 4.0);
  const WingMass<double> both = wing_mass(WingMaterial<double>{0.05, 2e-3}, p);
  EXPECT_NEAR(both.inertia - plate.inertia, 2e-3 * drawn_length * drawn_length * drawn_length / 3.0, 1e-20);
  EXPECT_EQ(both.pitch_inertia, plate.pitch_inertia);
  EXPECT_EQ(both.mass_product, plate.mass_product);
}

// The inertia of the membrane is its areal density times the chord moment s_2 that lift has.
TEST(WingMass, SharesTheChordMomentOfLift) {
  for (const PlanformShape shape : {PlanformShape::semi_ellipse, PlanformShape::rectangle, PlanformShape::tabulated}) {
    const Planform<double> p = outline(shape, 3e-3);
    EXPECT_NEAR(wing_mass(WingMaterial<double>{0.02, 0.0}, p).inertia / (0.02 * one_wing_moments(p).s2), 1.0, 1e-13);
  }
}

TEST(WingMass, FollowsItsChordRatioWithDerivatives) {
  Planform<double> p = outline(PlanformShape::semi_ellipse, 0.0);
  p.chord_ratio = drawn_chord / drawn_length;
  const WingMaterial<double> material{0.02, 0.0};
  EXPECT_DOUBLE_EQ(wing_mass(material, p).inertia,
                   wing_mass(material, outline(PlanformShape::semi_ellipse, 0.0)).inertia);
  Planform<Jet<1>> dual = cast<Jet<1>>(p);
  dual.length = Jet<1>(drawn_length, 0);
  const WingMass<Jet<1>> m = wing_mass(cast<Jet<1>>(material), dual);
  EXPECT_NEAR(m.inertia.v[0] * drawn_length / m.inertia.a, 4.0, 1e-12);  // all lengths grow alike
  EXPECT_NEAR(m.pitch_inertia.v[0] * drawn_length / m.pitch_inertia.a, 4.0, 1e-12);
  EXPECT_NEAR(m.mass.v[0] * drawn_length / m.mass.a, 2.0, 1e-12);
}

}  // namespace
}  // namespace wingbeat
