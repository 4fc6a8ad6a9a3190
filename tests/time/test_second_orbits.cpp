// Vehicles with two stable orbits, of which the search alone found the one that a start from rest does not reach, or
// with one for each pitch at which friction of the hinges can hold the wings.
#include <gtest/gtest.h>

#include "vehicle/further_boxes.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/time/transient.hpp"

using namespace wingbeat;

namespace {

struct Known {
  FurtherBox box;
  std::uint32_t n;
};

class SecondOrbit : public testing::TestWithParam<Known> {};

TEST_P(SecondOrbit, TheOneThatAStartFromRestReachesIsReported) {
  const WideVehicle w = further_vehicle(GetParam().box, GetParam().n);
  const Vehicle<double> vehicle = resolve(w.design, w.condition);
  const SteadyFlapping found = find_steady_flapping(vehicle, {}, start_up_in_time());
  const TransientResult simulated = simulate_start_up(vehicle);
  ASSERT_EQ(found.status, FlappingStatus::flapping);
  ASSERT_TRUE(simulated.settled && simulated.metrics);
  const Metrics<double>& reached = *simulated.metrics;
  for (const Metric m : {Metric::frequency, Metric::power_electrical, Metric::power_aerodynamic, Metric::lift_peak}) {
    EXPECT_NEAR(found.metrics[m], reached[m], 1e-5 * std::abs(reached[m])) << metric_info(m).key;
  }
  const SteadyFlapping searched = find_steady_flapping(vehicle, {});
  EXPECT_GT(std::abs(searched.metrics[Metric::power_aerodynamic] / reached[Metric::power_aerodynamic] - 1.0), 0.01)
      << "the search alone finds the same orbit: no longer a vehicle that shows anything";
}

INSTANTIATE_TEST_SUITE_P(Boxes, SecondOrbit,
                         testing::Values(Known{FurtherBox::gear, 273}, Known{FurtherBox::tiny_inductance, 773},
                                         Known{FurtherBox::tiny_inductance, 967}),
                         [](const auto& known) {
                           return std::string(further_box_names[std::size_t(known.param.box)]) + "_" +
                                  std::to_string(known.param.n);
                         });

// Without an offset of the supply, an orbit that is not its own mirror image half a period later has a twin; which of
// them a start from rest reaches is chance here: the motion wanders for hundreds of periods before.
TEST(MirroredOrbit, AnOrbitThatIsNotItsOwnMirrorImageHasATwin) {
  const WideVehicle w = further_vehicle(FurtherBox::direct_losses, 655);
  const SteadyFlapping found = find_steady_flapping(resolve(w.design, w.condition), {}, start_up_in_time());
  ASSERT_EQ(found.status, FlappingStatus::flapping);
  const double amplitude = found.metrics[Metric::stroke_amplitude];
  EXPECT_NEAR(found.evidence.other_amplitude, amplitude, 1e-5 * amplitude);
}

class HeldWings : public testing::TestWithParam<std::uint32_t> {};

TEST_P(HeldWings, AreHeldWhereAStartFromRestLeavesThem) {
  const WideVehicle w = further_vehicle(FurtherBox::soft_wings, GetParam());
  const Vehicle<double> vehicle = resolve(w.design, w.condition);
  ASSERT_TRUE(has_friction(vehicle.pitch.hinge));
  const SteadyFlapping found = find_steady_flapping(vehicle, {}, start_up_in_time());
  const TransientResult simulated = simulate_start_up(vehicle);
  ASSERT_EQ(found.status, FlappingStatus::flapping);
  ASSERT_TRUE(simulated.settled && simulated.metrics);
  const Metrics<double>& reached = *simulated.metrics;
  for (const Metric m : {Metric::frequency, Metric::power_electrical, Metric::power_aerodynamic,
                         Metric::stroke_amplitude, Metric::angle_of_attack_min}) {
    EXPECT_NEAR(found.metrics[m], reached[m], 1e-5 * std::abs(reached[m])) << metric_info(m).key;
  }
  EXPECT_NEAR(found.metrics[Metric::lift_mean], reached[Metric::lift_mean], 1e-9);
  EXPECT_EQ(found.metrics[Metric::pitch_amplitude], 0.0);
}

// A crank whose wings are left away from the middle; direct drives whose search ends where they still slip.
INSTANTIATE_TEST_SUITE_P(SoftWings, HeldWings, testing::Values(230, 562, 948),
                         [](const auto& known) { return "vehicle_" + std::to_string(known.param); });

}  // namespace
