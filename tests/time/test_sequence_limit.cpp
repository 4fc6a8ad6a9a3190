// Limits of sequences, and direct drives whose simulation skips to where their periods settle.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "time/sequence_limit.hpp"
#include "vehicle/further_boxes.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"

using namespace wingbeat;

namespace {

/// A turning pair of modes, one that fades quickly and one that stays, about a fixed point.
std::vector<double> next(const std::vector<double>& x) {
  const double a = 0.9995 * std::cos(0.3), b = 0.9995 * std::sin(0.3);
  const double u = x[0] - 1.0, v = x[1] + 2.0;
  return {1.0 + a * u - b * v, -2.0 + b * u + a * v, 3.0 - 0.2 * (x[2] - 3.0) + 0.1 * u};
}

TEST(SequenceLimit, IsTheFixedPointOfALinearMap) {
  detail::SequenceLimit sequence;
  std::vector<double> x = {4.0, 1.0, -2.0};
  for (int n = 0; n < 12; ++n) {
    EXPECT_FALSE(sequence.limit()) << n;
    sequence.add(x);
    x = next(x);
  }
  const auto limit = sequence.limit();
  ASSERT_TRUE(limit);
  EXPECT_NEAR(limit->state[0], 1.0, 1e-10);
  EXPECT_NEAR(limit->state[1], -2.0, 1e-10);
  EXPECT_NEAR(limit->state[2], 3.0, 1e-10);
  ASSERT_EQ(limit->recurrence.size(), 3u);  // z^3 + c_2 z^2 + c_1 z + c_0 of the three eigenvalues
  EXPECT_NEAR(limit->recurrence[0], 0.2 * 0.9995 * 0.9995, 1e-10);
  EXPECT_NEAR(limit->recurrence[2], 0.2 - 2.0 * 0.9995 * std::cos(0.3), 1e-10);
  sequence.clear();
  EXPECT_FALSE(sequence.limit());
}

/// Of the logistic map that settles on no point, and near the one it leaves.
TEST(SequenceLimit, IsNoneOfWhatFollowsNoLinearMapOrGrows) {
  detail::SequenceLimit chaos, growing;
  double x = 0.3, y = 1e-6;
  for (int n = 0; n < 60; ++n) {
    chaos.add({x});
    growing.add({y});
    x = 3.9 * x * (1.0 - x), y = -1.01 * y;
    EXPECT_FALSE(chaos.limit()) << n;
    EXPECT_FALSE(growing.limit()) << n;
  }
}

/// Recording, which takes every period as it comes, gives the same metrics and nearly the same time to steady flapping.
TEST(SkippedPeriods, LeadToWhereAllOfThemLead) {
  int skipping = 0;
  double periods = 0.0, all_periods = 0.0;
  for (std::uint32_t n = 0; n < 30; ++n) {
    const WideVehicle w = further_vehicle(FurtherBox::direct_losses, n);
    const Vehicle<double> vehicle = resolve(w.design, w.condition);
    if (drive_of(vehicle).rotates) continue;
    TransientOptions options;
    const TransientResult skipped = simulate_start_up(vehicle, options);
    if (!skipped.evidence.extrapolated) continue;
    options.record = true;
    const TransientResult whole = simulate_start_up(vehicle, options);
    if (!whole.settled) continue;
    const std::string which = "vehicle " + std::to_string(n);
    ++skipping;
    periods += skipped.cycles, all_periods += whole.cycles;
    ASSERT_TRUE(skipped.metrics && whole.metrics) << which;
    EXPECT_FALSE(whole.evidence.extrapolated) << which;
    for (const Metric m :
         {Metric::frequency, Metric::power_electrical, Metric::stroke_amplitude, Metric::current_rms}) {
      const double scale = error_scale(*whole.metrics, m);
      EXPECT_NEAR((*skipped.metrics)[m], (*whole.metrics)[m], 3e-6 * scale) << which << " " << metric_info(m).key;
    }
    EXPECT_NEAR(skipped.time_to_steady, whole.time_to_steady, 0.2 * whole.time_to_steady) << which;
  }
  EXPECT_GE(skipping, 5);
  EXPECT_LT(periods, 0.5 * all_periods);
}

}  // namespace
