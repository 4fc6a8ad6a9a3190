// The vehicles of a block have on lanes the numbers that each has alone.
#include "wingbeat/ensemble/block_vehicle.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <type_traits>
#include <vector>

#include "ensemble/two_registers.hpp"
#include "vehicle/reference_vehicle.hpp"

namespace wingbeat {
namespace {

static_assert(std::is_same_v<decltype(Vehicle<Lanes>::pitch), std::nullptr_t>);
static_assert(std::is_same_v<decltype(Vehicle<Lanes>::electronics), std::nullptr_t>);
static_assert(std::is_same_v<decltype(Vehicle<Lanes>::piezo), std::nullptr_t>);

/// A vehicle for each lane, with a number of its own at every place.
std::vector<Vehicle<double>> numbered_vehicles() {
  std::vector<Vehicle<double>> vehicles(lanes, resolve(reference_design()));
  double next = 1.0;
  for (Vehicle<double>& v : vehicles) for_each_number(v, [&](double& x) { x = next++; });
  return vehicles;
}

BlockVehicle<Lanes> block_of(const std::vector<Vehicle<double>>& vehicles) {
  return BlockVehicle<Lanes>([&](int lane) -> const auto& { return vehicles[std::size_t(lane)]; });
}

/// Expects the number that `place` names of a lane's part to be that of the same part alone, in every lane.
template <class OnLanes, class Alone, class Place>
void expect_same(const OnLanes& on_lanes, const Alone& alone, const Place& place) {
  alignas(64) double numbers[lanes];
  place(on_lanes).store(numbers);
  for (std::size_t n = 0; n < lanes; ++n) EXPECT_EQ(numbers[n], place(alone(n))) << "lane " << n;
}

TEST(BlockVehicle, HasTheNumbersOfEachVehicleBeforeBetweenAndAfterThePartsLeftOut) {
  const std::vector<Vehicle<double>> vehicles = numbered_vehicles();
  const BlockVehicle<Lanes> block = block_of(vehicles);
  const auto expect = [&](const auto& place) {
    expect_same(block.vehicle, [&](std::size_t n) -> const auto& { return vehicles[n]; }, place);
  };
  expect([](const auto& v) { return v.voltage; });
  expect([](const auto& v) { return v.transmission.slider_crank.rod_length; });
  expect([](const auto& v) { return v.wings.wake.velocity; });
  expect([](const auto& v) { return v.wings.wake.swept_area; });  // before the strips
  expect([](const auto& v) { return v.source_resistance; });      // behind them
  expect([](const auto& v) { return v.motors; });                 // before the hinges
  expect([](const auto& v) { return v.load_torque; });            // behind them
  expect([](const auto& v) { return v.voltage_offset; });         // before electronics and piezo
}

TEST(BlockVehicle, HasTheStripsOfEachVehicleWhereAnyHasAWake) {
  std::vector<Vehicle<double>> vehicles = numbered_vehicles();
  for (std::size_t n = 0; n + 1 < lanes; ++n) vehicles[n].wings.wake.velocity = 0.0;
  const BlockVehicle<Lanes> block = block_of(vehicles);
  ASSERT_EQ(block.vehicle.wings.wake.strips, &block.strips);
  for (std::size_t strip = 0; strip < wake_strip_count; ++strip) {
    const auto expect = [&](const auto& place) {
      expect_same(
          block.strips.at[strip], [&](std::size_t n) -> const auto& { return vehicles[n].wings.wake.strips.at[strip]; },
          place);
    };
    expect([](const auto& w) { return w.radius; });
    expect([](const auto& w) { return w.area; });
    expect([](const auto& w) { return w.chord; });
  }
  vehicles.back().wings.wake.velocity = 0.0;
  EXPECT_EQ(block_of(vehicles).vehicle.wings.wake.strips, nullptr);
}

}  // namespace
}  // namespace wingbeat
