// The strokes that lanes divide a turn into, and their kinematics beside those of plain numbers.
#include "wingbeat/ensemble/lane_mechanism.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "ensemble/two_registers.hpp"
#include "vehicle/kind_boxes.hpp"
#include "wingbeat/core/pack.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

std::vector<Vehicle<double>> drawn(KindBox box, std::size_t count) {
  std::mt19937_64 random(77);
  std::vector<Vehicle<double>> vehicles;
  while (vehicles.size() < count) {
    const Vehicle<double> v = resolve(kind_design(box, random));
    // Lanes share the formulation.
    const bool by_rod_force = v.transmission.slider_crank.formulation == Formulation::rod_force;
    if (has_half_turns(v.transmission) && by_rod_force) vehicles.push_back(v);
  }
  return vehicles;
}

CrankKinematics<double> at(const AnyTransmission<double>& t, double angle) {
  return crank_kinematics(t, std::sin(angle), std::cos(angle));
}

TEST(LaneMechanism, StrokesGoUpAndThenDownFromReversalToReversal) {
  for (const KindBox box : {KindBox::reference, KindBox::four_bar, KindBox::tabulated}) {
    for (const Vehicle<double>& v : drawn(box, 40)) {
      const HalfTurns h = half_turns(v.transmission);
      EXPECT_GT(h.middle[0] - h.reach[0], -two_pi);
      EXPECT_LE(h.middle[0] - h.reach[0], 0.0);
      EXPECT_NEAR(h.middle[0] + h.reach[0], h.middle[1] - h.reach[1], 1e-12);
      EXPECT_NEAR(2.0 * (h.reach[0] + h.reach[1]), two_pi, 1e-12);
      for (std::size_t half = 0; half < 2; ++half) {
        for (const double part : {-0.999, -0.3, 0.0, 0.8, 0.999}) {
          const double slope = at(v.transmission, h.middle[half] + part * h.reach[half]).stroke_slope;
          EXPECT_GT(half == 0 ? slope : -slope, 0.0) << kind_box_names[std::size_t(box)] << " " << part;
        }
      }
    }
  }
}

// Every lane another transmission at another angle, before the first turn and beyond the second.
TEST(LaneMechanism, KinematicsAreThoseOfPlainNumbers) {
  std::mt19937_64 random(78);
  std::uniform_real_distribution<double> angles(-two_pi, 2.0 * two_pi);
  for (const KindBox box : {KindBox::reference, KindBox::four_bar, KindBox::tabulated}) {
    const std::vector<Vehicle<double>> vehicles = drawn(box, lanes);
    AnyTransmission<Lanes> t = in_packs<Lanes, AnyTransmission>(
        [&](int lane) -> const AnyTransmission<double>& { return vehicles[std::size_t(lane)].transmission; });
    alignas(64) std::array<double, lanes> start{}, angle{}, found{};
    for (std::size_t n = 0; n < lanes; ++n) {
      const HalfTurns h = half_turns(vehicles[n].transmission);
      t.tabulated.curve.of_lane[n] = h.curve;
      start[n] = h.curve_start;
    }
    t.tabulated.curve.start = Lanes::load(start.data());
    const LaneMechanism<Lanes> mechanism(t);
    for (int trial = 0; trial < 200; ++trial) {
      for (double& a : angle) a = angles(random);
      const CrankKinematics<Lanes> k = mechanism.kinematics(Lanes::load(angle.data()));
      const auto compare = [&](Lanes CrankKinematics<Lanes>::* of_lanes, double CrankKinematics<double>::* expected) {
        (k.*of_lanes).store(found.data());
        for (std::size_t n = 0; n < lanes; ++n) {
          const double value = at(vehicles[n].transmission, angle[n]).*expected;
          EXPECT_NEAR(found[n], value, 1e-11 * (1e-3 + std::abs(value))) << kind_box_names[std::size_t(box)];
        }
      };
      compare(&CrankKinematics<Lanes>::stroke_offset, &CrankKinematics<double>::stroke_offset);
      compare(&CrankKinematics<Lanes>::tan_stroke, &CrankKinematics<double>::tan_stroke);
      compare(&CrankKinematics<Lanes>::stroke_slope, &CrankKinematics<double>::stroke_slope);
      compare(&CrankKinematics<Lanes>::stroke_second_derivative, &CrankKinematics<double>::stroke_second_derivative);
      compare(&CrankKinematics<Lanes>::wing_jacobian, &CrankKinematics<double>::wing_jacobian);
      compare(&CrankKinematics<Lanes>::crank_jacobian, &CrankKinematics<double>::crank_jacobian);
    }
  }
}

// A crank that waits: its stroke turns four times in a turn.
TEST(LaneMechanism, StrokesThatTurnMoreOftenAreNoHalfTurns) {
  std::vector<std::pair<double, double>> rows;
  for (int n = 0; n < 72; ++n) {
    const double theta = two_pi * n / 72;
    rows.emplace_back(theta, 0.3 * std::sin(theta) + 0.4 * std::sin(3.0 * theta));
  }
  AnyTransmission<double> t{};
  t.type = TransmissionType::tabulated;
  t.tabulated = {std::make_shared<const StrokeCurve>(rows), 1.0, 5e-3};
  EXPECT_FALSE(has_half_turns(t));
  t.type = TransmissionType::direct;
  EXPECT_FALSE(has_half_turns(t));
}

}  // namespace
}  // namespace wingbeat
