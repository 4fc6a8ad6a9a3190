// What the batched solver makes of cranks that can lock or jam within narrow intervals.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ensemble/ensemble_comparison.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/ensemble/lane_statics.hpp"

namespace wingbeat {
namespace {

/// By what the largest torque of springs and friction exceeds that at the lanes' crank angles, of that.
double unseen_torque(Vehicle<double> v) {
  const double stall = stall_torque(v);
  double seen = 0.0;
  for (int k = 0; k < 32; ++k) seen = std::max(seen, stall - advance_torque(v, k * lane_angle_spacing));
  v.voltage *= seen / stall;
  return -static_balance(v).advance_min / seen;
}

TEST(LaneStatics, TheMarginCoversWhatLiesBetweenTheAnglesInTheirFamily) {
  Vehicle<double> v = reference_vehicle(true);
  SliderCrank<double>& c = v.transmission.slider_crank;
  double largest = 0.0;
  int seen = 0;
  for (const Formulation formulation : {Formulation::rod_force, Formulation::virtual_work}) {
    for (const double slope : {0.2, 0.6, 0.9, 1.0, 1.1, 1.2, 1.25}) {
      for (const double obliquity : {0.02, 0.15, 0.3, 0.4, 0.5}) {
        for (double height = -1.0; height <= 1.0; height += 0.25) {
          for (const double friction : {0.0, 0.3, 1.0}) {
            c = {5e-3, 5e-3 / obliquity, 5e-3 / slope, 5e-3 / obliquity + 5e-3 * height, formulation};
            v.friction.radius = friction * c.crank_radius;
            if (!lanes_see_locks(v)) continue;
            ++seen;
            largest = std::max(largest, unseen_torque(v));
          }
        }
      }
    }
  }
  EXPECT_GT(seen, 800);
  EXPECT_LT(largest, 0.9 * lane_torque_margin);
}

TEST(LaneStatics, CranksThatLockOrJamInNarrowIntervalsHaveOneStatus) {
  const StartUp start_up = remembered_start_up();
  std::mt19937_64 random(23);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  std::vector<EnsembleMember> members;
  while (members.size() < 60) {
    Vehicle<double> v = reference_vehicle(members.size() % 2 == 0);
    SliderCrank<double>& c = v.transmission.slider_crank;
    c.formulation = Formulation::virtual_work;
    c.crank_radius = uniform(0.01, 0.04);
    c.rod_length = c.mid_stroke_height = c.crank_radius * uniform(1.1, 3.0);
    c.hinge_offset = c.crank_radius / uniform(2.0, 30.0);
    v.friction.radius = c.hinge_offset * uniform(0.02, 0.2);
    v.voltage = uniform(2.0, 8.0);
    StaticBalance statics = static_balance(v);
    if (v.spring.stiffness > 0.0) {
      // The stall torque just exceeds what springs and friction hold at most, or just not.
      v.voltage *= (statics.stall_torque - statics.advance_min) / statics.stall_torque * uniform(0.5, 1.05);
    } else {
      // The rotor is just heavy enough, or just not.
      Vehicle<double> light = v;
      light.motor.inertia = 1e-16;
      v.motor.inertia = -static_balance(light).inertia_min * uniform(0.9, 1.2);
    }
    members.push_back({v, {}});
  }
  EnsembleOptions scalar;
  scalar.scalar_only = true;
  const auto batched = solve(members, {}, start_up), expected = solve(members, scalar, start_up);
  int locked = 0, jammed = 0, flapping = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    EXPECT_EQ(batched[n].status, expected[n].status) << n;
    locked += expected[n].status == FlappingStatus::locked;
    jammed += expected[n].status == FlappingStatus::jammed;
    flapping += expected[n].status == FlappingStatus::flapping;
  }
  EXPECT_GT(locked, 3);
  EXPECT_GT(jammed, 3);
  EXPECT_GT(flapping, 3);
}

}  // namespace
}  // namespace wingbeat
