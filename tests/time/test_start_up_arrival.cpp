// Assessments of start-up that end where iterates of the orbit search take over.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "vehicle/reference_vehicle.hpp"
#include "vehicle/wide_boxes.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/time/transient.hpp"

using namespace wingbeat;

namespace {

TEST(StartUpArrival, EndsTheSimulationAtTheTurnAtWhichItIsTrue) {
  const Vehicle<double> vehicle = resolve(reference_design());
  std::vector<Coordinates<double>> asked;
  TransientOptions options;
  options.arrived = [&](const Coordinates<double>& there) {
    asked.push_back(there);
    return asked.size() == 2;
  };
  const TransientResult ended = simulate_start_up(vehicle, options);
  EXPECT_EQ(ended.status, FlappingStatus::flapping);
  EXPECT_TRUE(ended.settled);
  EXPECT_EQ(ended.cycles, 2);
  EXPECT_FALSE(ended.metrics);
  ASSERT_EQ(asked.size(), 2u);
  EXPECT_EQ(asked[1].angle, 0.0);
  EXPECT_GT(asked[1].speed, 0.0);
  EXPECT_EQ(ended.crank_speed, asked[1].speed);

  options.arrived = [](const Coordinates<double>&) { return false; };
  const TransientResult whole = simulate_start_up(vehicle, options);
  EXPECT_TRUE(whole.settled);
  EXPECT_GT(whole.cycles, 2);
}

/// Iterates that go on from the first turn come to the orbit on which the simulation settles by itself.
TEST(StartUpArrival, IteratesDecideAsTheWholeSimulation) {
  int ended_early = 0, locked = 0;
  for (const FarBox box :
       {FarBox::crank_near_rod, FarBox::strong_springs, FarBox::friction_laws, FarBox::inertia, FarBox::four_bar}) {
    for (std::uint32_t n = 0; n < 150; ++n) {
      const WideVehicle w = wide_vehicle(box, n);
      const Vehicle<double> vehicle = resolve(w.design, w.condition);
      const StartUp in_time = start_up_in_time();
      const StartUp until_arrival = [&](const Vehicle<double>& v, const Arrival& arrived) {
        return in_time(v, [&](const Coordinates<double>& there) {
          const bool ends = arrived && arrived(there);
          ended_early += ends;
          return ends;
        });
      };
      const StartUp whole = [&](const Vehicle<double>& v, const Arrival&) { return in_time(v, {}); };
      const SteadyFlapping quick = find_steady_flapping(vehicle, {}, until_arrival);
      const SteadyFlapping settled = find_steady_flapping(vehicle, {}, whole);
      ASSERT_EQ(quick.status, settled.status) << far_box_names[std::size_t(box)] << " " << n;
      locked += settled.status == FlappingStatus::locked;
      if (settled.status != FlappingStatus::flapping) continue;
      const double f = settled.metrics[Metric::frequency];
      EXPECT_NEAR(quick.metrics[Metric::frequency], f, 1e-6 * f) << far_box_names[std::size_t(box)] << " " << n;
    }
  }
  EXPECT_GE(ended_early, 20);
  EXPECT_GE(locked, 5) << "no vehicles that tell a start that comes to rest from one that does not";
}

}  // namespace
