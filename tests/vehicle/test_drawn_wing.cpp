// A wing whose inertia follows from its drawing, in a design.
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

Design<double> drawn() {
  Design<double> d = reference_design();
  d.wing.planform = {};
  d.wing.planform.shape = PlanformShape::semi_ellipse;
  d.wing.planform.length = 63e-3;
  d.wing.planform.root_chord = 25e-3;
  d.wing.areal_density = 0.02;
  d.wing.spar_density = 1e-3;
  return d;
}

std::string refusal(const Design<double>& d) {
  try {
    validate(d);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DrawnWing, HasTheInertiaOfItsStrips) {
  const Design<double> d = drawn();
  EXPECT_EQ(refusal(d), "accepted");
  // sigma pi c_0 R^3/16 + lambda R^3/3.
  const double expected = (0.02 * pi / 16.0 * 25e-3 + 1e-3 / 3.0) * 63e-3 * 63e-3 * 63e-3;
  EXPECT_NEAR(resolve(d).wing_inertia / expected, 1.0, 1e-14);
  EXPECT_EQ(resolve(d, Condition::wingless).wing_inertia, 0.0);
  EXPECT_FALSE(wing_mass(reference_design().wing));
}

TEST(DrawnWing, PaysForItsLengthInInertia) {
  Design<Jet<1>> d = cast<Jet<1>>(drawn());
  d.wing.planform.length = Jet<1>(63e-3, 0);
  const Jet<1> inertia = resolve(d).wing_inertia;
  EXPECT_NEAR(inertia.v[0] * 63e-3 / inertia.a, 3.0, 1e-12);
}

TEST(DrawnWing, IsOneOfThreeWaysToAnInertia) {
  Design<double> d = drawn();
  set_parameter(d, "wing.inertia", 8e-8);
  EXPECT_FALSE(d.wing.areal_density);
  EXPECT_EQ(resolve(d).wing_inertia, 8e-8);
  EXPECT_FALSE(find_parameter<double>("wing.spar_density")->get(d));
  set_parameter(d, "wing.areal_density", 0.03);
  EXPECT_FALSE(find_parameter<double>("wing.inertia")->get(d));
}

TEST(DrawnWing, NeedsAnOutline) {
  Design<double> d = drawn();
  d.wing.planform = reference_design().wing.planform;
  EXPECT_EQ(refusal(d).substr(0, 52), "wing.areal_density: needs the wing's outline: give a");
  d = drawn();
  d.wing.areal_density = 0.0;
  EXPECT_EQ(refusal(d), "wing.areal_density: must be > 0 [kg/m2], got 0");
  d = drawn();
  d.wing.spar_density = -1.0;
  EXPECT_EQ(refusal(d), "wing.spar_density: must be >= 0 [kg/m], got -1");
}

TEST(DrawnWing, MayHaveRibs) {
  Design<double> d = drawn();
  const double plain = resolve(d).wing_inertia;
  d.wing.rib_count = 1.0;
  EXPECT_EQ(refusal(d), "wing.rib_density: 0 or missing beside wing.rib_count = 1: a rib has a mass over its length");
  d.wing.rib_density = 3e-4;
  EXPECT_EQ(refusal(d), "accepted");
  // One rib at half the length, where the chord is c_0 sqrt(3)/2.
  const double rib = 3e-4 * 25e-3 * std::sqrt(0.75) * 31.5e-3 * 31.5e-3;
  EXPECT_NEAR((resolve(d).wing_inertia - plain) / rib, 1.0, 1e-9);
  d.wing.rib_count = 2.5;
  EXPECT_EQ(refusal(d), "wing.rib_count: must be a whole number from 0 to 1000 [1], got 2.5");
  d.wing.rib_count = 0.0;
  EXPECT_EQ(refusal(d),
            "wing.rib_count: 0 or missing beside wing.rib_density = 0.0003 kg/m: there is no rib to have it");
}

}  // namespace
}  // namespace wingbeat
