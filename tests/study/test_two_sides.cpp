// Vehicles whose sides differ: sums of separate solves, maps of two linearisations.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "wingbeat/files/two_sides_file.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

VehicleFile shipped(const char* name) {
  return read_vehicle(std::filesystem::path(WINGBEAT_DATA) / "designs" / (std::string(name) + ".toml"));
}

TwoSides alike(const Design<double>& design) {
  TwoSides sides{design, design, design};
  for (Design<double>* side : {&sides.left, &sides.right}) side->motors = 1.0, side->mass.reset();
  return sides;
}

TEST(TwoSides, AreTheSumOfSeparateSolves) {
  const TwoSides sides = *shipped("sides/purdue-flapper-trimmed").sides;
  const TwoSidesResult together = run_two_sides(sides);
  const RunResult left = run_design(sides.left), right = run_design(sides.right);
  ASSERT_EQ(together.status, FlappingStatus::flapping);
  for (const Metric m : {Metric::lift_mean, Metric::power_electrical, Metric::power_aerodynamic, Metric::power_hinge}) {
    EXPECT_EQ(together.metrics[m], left.metrics[m] + right.metrics[m]) << metric_info(m).key;
    EXPECT_NE(left.metrics[m], right.metrics[m]) << metric_info(m).key;
  }
  EXPECT_NEAR(together.metrics[Metric::frequency], 34.0, 1e-9);
  EXPECT_DOUBLE_EQ(together.metrics[Metric::voltage], 9.3);
  EXPECT_NEAR(together.metrics[Metric::lift_to_weight],
              together.metrics[Metric::lift_mean] / (0.0124481 * standard_gravity), 1e-12);
  EXPECT_TRUE(std::isnan(together.metrics[Metric::stroke_amplitude]));
}

TEST(TwoSides, AlikeAreThePlainVehicle) {
  const Design<double> plain = shipped("purdue-flapper").design;
  const RunResult whole = run_design(plain, {.tolerance = 1e-9});
  const TwoSidesResult together = run_two_sides(alike(plain), {.tolerance = 1e-9});
  for (const Metric m : {Metric::lift_mean, Metric::power_electrical, Metric::power_hinge, Metric::lift_to_weight,
                         Metric::efficiency_system}) {
    EXPECT_NEAR(together.metrics[m], whole.metrics[m], 1e-8 * std::abs(whole.metrics[m])) << metric_info(m).key;
  }
}

TEST(TwoSides, MapsOfSidesAlikeAreThoseOfThePlainVehicle) {
  Design<double> plain = shipped("two-wing-direct").design;
  const ControlModels whole = control_models(plain, {.hinge_offset = 13.95e-3});
  const TwoSidesMaps found = two_sides_maps(alike(plain), {.hinge_offset = 13.95e-3});
  ASSERT_EQ(found.maps.size(), whole.maps.size());
  for (std::size_t k = 0; k < whole.maps.size(); ++k) {
    ASSERT_EQ(found.maps[k].points.size(), whole.maps[k].points.size());
    for (std::size_t n = 0; n < whole.maps[k].points.size(); ++n) {
      for (const AllocationColumn& c : allocation_columns) {
        EXPECT_NEAR(found.maps[k].points[n].*c.member, whole.maps[k].points[n].*c.member, 1e-7)
            << name_of(whole.maps[k].input) << ", " << n << ", " << c.name;
      }
    }
  }
}

// A side in the other's place mirrors roll and yaw.
TEST(TwoSides, ExchangedTheyMirrorTheMoments) {
  const TwoSides sides = *shipped("sides/purdue-flapper-trimmed").sides;
  const TwoSidesMaps one = two_sides_maps(sides, {.hinge_offset = 13.95e-3});
  const TwoSidesMaps other = two_sides_maps({sides.whole, sides.right, sides.left}, {.hinge_offset = 13.95e-3});
  ASSERT_EQ(one.maps.size(), 5u);
  ASSERT_EQ(other.maps.size(), 5u);
  for (const AllocationMap* map : {&one.maps[0], &one.maps[2]}) {
    const AllocationMap& mirrored = other.maps[std::size_t(map - &one.maps[0])];
    for (std::size_t n = 0; n < map->points.size(); ++n) {
      const AllocationPoint &a = map->points[n], &b = mirrored.points[n];
      EXPECT_NEAR(a.lift, b.lift, 1e-12);
      EXPECT_NEAR(a.pitch, b.pitch, 1e-12);
      EXPECT_NEAR(a.roll, -b.roll, 1e-12);
      EXPECT_NEAR(a.yaw, -b.yaw, 1e-12);
    }
  }
  const AllocationPoint& middle = one.maps[1].points[5];
  EXPECT_EQ(middle.input, 0.0);
  EXPECT_GT(std::abs(middle.roll), 1e-5);
  EXPECT_NEAR(middle.lift, one.operating_point.metrics[Metric::lift_mean], 1e-7 * middle.lift);
}

TEST(TwoSides, AWholeLiftIsRefused) {
  const TwoSides sides = alike(shipped("two-wing-direct").design);
  try {
    run_two_sides(sides, {.lift = 0.1});
    FAIL();
  } catch (const ParameterError& error) {
    EXPECT_EQ(std::string(error.what()),
              "lift: is the whole vehicle's, of which neither side has a known part; set the voltage instead");
  }
}

}  // namespace
}  // namespace wingbeat
