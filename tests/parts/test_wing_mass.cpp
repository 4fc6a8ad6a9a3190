// Mass moments of membrane and spar.
#include "wingbeat/parts/wing_mass.hpp"

#include <gtest/gtest.h>

namespace wingbeat {
namespace {

constexpr double membrane = 0.08, spar = 1.6e-3;  // [kg/m2], [kg/m]

Planform<double> membrane_wing(PlanformShape shape, double offset) {
  Planform<double> p;
  p.shape = shape;
  p.length = 63e-3;
  p.root_chord = 25e-3;
  p.hub_offset = offset;
  return p;
}

TEST(WingMass, AgreesWithTheSumOverItsArea) {
  for (const PlanformShape shape : {PlanformShape::semi_ellipse, PlanformShape::rectangle}) {
    for (const double d : {0.0, 4e-3}) {
      const Planform<double> p = membrane_wing(shape, d);
      WingMass<double> sum{};
      const int strips = 20000;
      for (int n = 0; n < strips; ++n) {
        const double dr = p.length / strips, x = (n + 0.5) * dr, r = x + d;
        const double c =
            p.root_chord * (shape == PlanformShape::rectangle ? 1.0 : std::sqrt(1.0 - square(x / p.length)));
        sum.mass += (membrane * c + spar) * dr;
        sum.inertia += (membrane * c + spar) * square(r) * dr;
        sum.pitch_inertia += membrane * c * c * c / 3.0 * dr;
        sum.mass_product += membrane * r * c * c / 2.0 * dr;
      }
      const WingMass<double> m = wing_mass(p, membrane, spar);
      EXPECT_NEAR(m.mass, sum.mass, 1e-6 * m.mass);
      EXPECT_NEAR(m.inertia, sum.inertia, 1e-6 * m.inertia);
      EXPECT_NEAR(m.pitch_inertia, sum.pitch_inertia, 1e-6 * m.pitch_inertia);
      EXPECT_NEAR(m.mass_product, sum.mass_product, 1e-6 * m.mass_product);
    }
  }
}

TEST(WingMass, OfARectangleHasItsClosedForm) {
  const double R = 63e-3, c = 25e-3;
  const WingMass<double> m = wing_mass(membrane_wing(PlanformShape::rectangle, 0.0), membrane, 0.0);
  EXPECT_NEAR(m.mass, membrane * c * R, 1e-14 * m.mass);
  EXPECT_NEAR(m.inertia, m.mass * R * R / 3.0, 1e-14 * m.inertia);
  EXPECT_NEAR(m.pitch_inertia, m.mass * c * c / 3.0, 1e-14 * m.pitch_inertia);
  EXPECT_NEAR(m.mass_product, m.mass * R * c / 4.0, 1e-14 * m.mass_product);
}

TEST(WingMass, TablesAreTheirOutline) {
  Planform<double> table = membrane_wing(PlanformShape::tabulated, 4e-3);
  table.chord_table = {{0.0, 25e-3}, {20e-3, 25e-3}, {63e-3, 25e-3}};
  const WingMass<double> m = wing_mass(table, membrane, spar),
                         exact = wing_mass(membrane_wing(PlanformShape::rectangle, 4e-3), membrane, spar);
  EXPECT_NEAR(m.mass, exact.mass, 1e-14 * exact.mass);
  EXPECT_NEAR(m.inertia, exact.inertia, 1e-14 * exact.inertia);
  EXPECT_NEAR(m.pitch_inertia, exact.pitch_inertia, 1e-14 * exact.pitch_inertia);
  EXPECT_NEAR(m.mass_product, exact.mass_product, 1e-14 * exact.mass_product);
}

// Within what a pitching wing must keep to, whatever it is made of.
TEST(WingMass, ProductStaysWithinTheInertias) {
  for (const double heavy : {0.0, 1.0}) {
    for (const double offset : {0.0, 30e-3}) {
      const WingMass<double> m = wing_mass(membrane_wing(PlanformShape::semi_ellipse, offset), membrane, heavy * spar);
      EXPECT_LT(square(m.mass_product), m.inertia * m.pitch_inertia);
    }
  }
}

}  // namespace
}  // namespace wingbeat
