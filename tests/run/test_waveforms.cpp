// Waveforms at instants equally spaced in time against the cycle at the same places of the crank.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "wingbeat/cycle/record.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

std::string name_of(const testing::TestParamInfo<const char*>& vehicle) {
  std::string name = vehicle.param;
  std::erase(name, '-');
  return name;
}

class Waveforms : public testing::TestWithParam<const char*> {};

// A crank without inductance, two whose current is stiff (implicit steps), tables, pitch hinges on a crank and on a
// direct drive, a piezo.
INSTANTIATE_TEST_SUITE_P(OfShippedVehicles, Waveforms,
                         testing::Values("friction2022", "two-wing-four-bar", "x-wing-crank", "hawkmoth",
                                         "pitch-hinge-crank", "two-wing-direct-hinge", "robobee-piezo"),
                         name_of);

TEST_P(Waveforms, AreTheCycleAtEqualInstants) {
  const auto vehicle = resolve(read_design(std::string(WINGBEAT_DATA "/designs/") + GetParam() + ".toml", {}));
  const SteadyFlapping orbit = find_steady_flapping(vehicle, {}, start_up_in_time());
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  const double period = orbit.record.period();
  // Few rows are far from each other, many lie within a step.
  for (const int count : {3, 181, 2001}) {
    const std::vector<WaveformRow> rows = orbit.record.waveform(count);
    ASSERT_EQ(rows.size(), std::size_t(count));
    double force = 0.0, current = 0.0, speed = 0.0, lift = 0.0;
    for (const WaveformRow& row : rows) {
      force = std::max(force, std::abs(row.rod_force));
      current = std::max(current, std::abs(row.current));
      speed = std::max(speed, std::abs(row.crank_speed));
      lift = std::max(lift, std::abs(row.lift));
    }
    for (int k = 1; k + 1 < count; ++k) {
      const WaveformRow& row = rows[std::size_t(k)];
      EXPECT_NEAR(row.time, period * k / (count - 1), 1e-13 * period);
      const WaveformRow same = orbit.record.at(orbit.record.phase_at(row.time));
      EXPECT_NEAR(same.time, row.time, 1e-13 * period);
      EXPECT_NEAR(row.crank_speed, same.crank_speed, 1e-10 * speed) << k << " of " << count;
      EXPECT_NEAR(row.current, same.current, 1e-9 * current) << k << " of " << count;
      EXPECT_NEAR(row.lift, same.lift, 1e-9 * lift) << k << " of " << count;
      EXPECT_EQ(std::isnan(row.rod_force), std::isnan(same.rod_force));
      if (!std::isnan(row.rod_force)) {
        EXPECT_NEAR(row.rod_force, same.rod_force, 1e-8 * force) << k << " of " << count;
      }
    }
  }
}

}  // namespace
}  // namespace wingbeat
