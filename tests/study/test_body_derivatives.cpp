// Cycle-averaged damping by the body's motion, against differences of the whole blade-element forces, strip by strip.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "vehicle/direct_design.hpp"
#include "vehicle/hinged_design.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/study/allocation.hpp"
#include "wingbeat/study/body_derivatives.hpp"

namespace wingbeat {
namespace {

using Eigen::Vector3d;
using Loads = Eigen::Matrix<double, 6, 1>;

Design<double> with_outline(Design<double> design) {
  design.wing.planform = {};
  design.wing.planform.shape = PlanformShape::semi_ellipse;
  design.wing.planform.length = 63e-3;
  design.wing.planform.root_chord = 25e-3;
  design.wing.planform.hub_offset = 5e-3;
  return design;
}

/// Mean forces and moments on a body that moves, of strips in the relative wind of their own: no expansion, no chord
/// moments.
Loads mean_loads(const Design<double>& design, const Vehicle<double>& vehicle, const std::vector<WaveformRow>& rows,
                 double hinge_offset, const Loads& motion) {
  constexpr int strips = 200;
  const Planform<double>& p = design.wing.planform;
  const Vector3d velocity = motion.head<3>(), rate = motion.tail<3>();
  Loads mean = Loads::Zero();
  for (std::size_t n = 0; n + 1 < rows.size(); ++n) {
    const WaveformRow& row = rows[n];
    const double alpha = row.angle_of_attack_deg / degrees_per_radian, beta = row.stroke_angle;
    for (const double side : {1.0, -1.0}) {
      const Vector3d span(std::sin(beta), side * std::cos(beta), 0.0);
      const Vector3d along(std::cos(beta), -side * std::sin(beta), 0.0);
      for (int k = 0; k < strips; ++k) {
        const double x = (k + 0.5) / strips, r = x * p.length + p.hub_offset, chord = chord_at(p, x);
        const Vector3d arm = Vector3d(0.0, side * hinge_offset, 0.0) + r * span;
        const Vector3d moves = row.flapping_velocity * r * along + velocity + rate.cross(arm);
        const double forward = moves.dot(along), sinks = moves.z(), s = sign_of(forward);
        const double inflow = std::atan2(sinks, std::abs(forward));
        double C_L = lift_coefficient(vehicle.wings.coefficients, alpha + inflow);
        double C_D = drag_coefficient(vehicle.wings.coefficients, alpha + inflow);
        if (pitches(vehicle)) {
          const double C_N = normal_force_coefficient(vehicle.wings, vehicle.pitch, alpha + inflow);
          C_L = C_N * std::cos(alpha + inflow);
          C_D = C_N * std::sin(alpha + inflow);
        }
        const double pressure = 0.5 * vehicle.wings.air_density * (forward * forward + sinks * sinks) * chord *
                                p.length / strips * 0.5 * vehicle.wing_count;
        const Vector3d wind = -s * std::cos(inflow) * along - std::sin(inflow) * Vector3d::UnitZ();
        const Vector3d lifts = s * std::sin(inflow) * along - std::cos(inflow) * Vector3d::UnitZ();
        const Vector3d force = pressure * (C_D * wind + C_L * lifts);
        mean.head<3>() += force / double(rows.size() - 1);
        mean.tail<3>() += arm.cross(force) / double(rows.size() - 1);
      }
    }
  }
  return mean;
}

void expect_derivatives(const Design<double>& design, double hinge_offset) {
  const Vehicle<double> vehicle = resolve(design);
  const SteadyFlapping orbit = find_steady_flapping(vehicle, {.tolerance = 1e-10, .stability = false});
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  const BodyDerivatives exact = body_derivatives(design, vehicle, orbit.record, hinge_offset);
  const std::vector<WaveformRow> rows = orbit.record.waveform(2001);
  const double speed = 1e-3, rate = 2e-2;
  for (int k = 0; k < 6; ++k) {
    const double step = k < 3 ? speed : rate;
    const Loads motion = step * Loads::Unit(k);
    const Loads difference = (mean_loads(design, vehicle, rows, hinge_offset, motion) -
                              mean_loads(design, vehicle, rows, hinge_offset, -motion)) /
                             (2.0 * step);
    const double force = difference.head<3>().norm() + 1e-9, moment = difference.tail<3>().norm() + 1e-11;
    EXPECT_LT((exact.col(k).head<3>() - difference.head<3>()).norm(), 2e-3 * force) << body_motions[std::size_t(k)];
    EXPECT_LT((exact.col(k).tail<3>() - difference.tail<3>()).norm(), 2e-3 * moment) << body_motions[std::size_t(k)];
  }
  for (int k = 0; k < 6; ++k) {
    if (k != 1) {
      EXPECT_LT(exact(k, k), 0.0) << "damps " << body_motions[std::size_t(k)];
    }
  }
}

TEST(BodyDerivatives, AgreeWithDifferencesOfStrips) {
  expect_derivatives(with_outline(reference_design()), 0.0);
  expect_derivatives(with_outline(direct_design()), 8e-3);
  expect_derivatives(hinged_design(1e-3), 4e-3);
}

TEST(BodyDerivatives, AreTheFlappingCounterTorqueInYaw) {
  // Without offset N_r = -rho S_3 mean(C_D |beta'|).
  const Design<double> design = reference_design();
  const Vehicle<double> vehicle = resolve(design);
  const SteadyFlapping orbit = find_steady_flapping(vehicle, {.tolerance = 1e-10, .stability = false});
  double mean = 0.0;
  const std::vector<WaveformRow> rows = orbit.record.waveform(4001);
  for (std::size_t n = 0; n + 1 < rows.size(); ++n) {
    const double alpha = rows[n].angle_of_attack_deg / degrees_per_radian;
    mean += drag_coefficient(vehicle.wings.coefficients, alpha) * std::abs(rows[n].flapping_velocity) / 4000.0;
  }
  const double expected = -vehicle.wings.air_density * vehicle.wings.s3 * mean;
  const BodyDerivatives derivatives = body_derivatives(design, vehicle, orbit.record);
  EXPECT_NEAR(derivatives(5, 5), expected, 1e-5 * std::abs(expected));
  // A planform known by S_2 and S_3 alone does not say what translation does to the forces.
  EXPECT_TRUE(std::isnan(derivatives(2, 2)));
  EXPECT_TRUE(std::isfinite(derivatives(4, 0)));
}

TEST(BodyDerivatives, AreZeroInVacuum) {
  const Design<double> design = with_outline(direct_design());
  const Vehicle<double> vehicle = resolve(design, Condition::vacuum);
  const SteadyFlapping orbit = find_steady_flapping(vehicle, {.tolerance = 1e-8, .stability = false});
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  EXPECT_EQ(body_derivatives(design, vehicle, orbit.record, 3e-3).cwiseAbs().maxCoeff(), 0.0);
}

const AllocationMap& map_of(const std::vector<AllocationMap>& maps, AllocationInput input) {
  for (const AllocationMap& map : maps) {
    if (map.input == input) return map;
  }
  throw std::runtime_error("no such map");
}

TEST(Allocation, MapsOfTwoDirectDrives) {
  Design<double> design = with_outline(direct_design());
  design.wing.count = 1.0;
  design.motors = 2.0;
  const Linearisation linearisation = linearise(design);
  ASSERT_TRUE(linearisation.model);
  constexpr double offset = 4e-3;
  const std::vector<AllocationMap> maps = allocation_maps(linearisation, offset);
  ASSERT_EQ(maps.size(), 5u);
  // Where maps meet the operating point they are it, and slopes are those of the linear model.
  const double lift = linearisation.orbit.metrics[Metric::lift_mean];
  const AllocationMap& common = map_of(maps, AllocationInput::voltage);
  EXPECT_NEAR(common.slope.lift, linearisation.model->steady_gain(0, 0), 1e-4 * common.slope.lift);
  for (const AllocationInput which :
       {AllocationInput::differential_voltage, AllocationInput::bias_voltage, AllocationInput::split_cycle}) {
    const AllocationMap& map = map_of(maps, which);
    const AllocationPoint& middle = map.points[map.points.size() / 2];
    EXPECT_EQ(middle.input, 0.0);
    EXPECT_NEAR(middle.lift, lift, 2e-5 * lift) << name_of(which);
    EXPECT_NEAR(map.slope.lift, 0.0, 1e-3 * lift) << name_of(which);
  }
  const AllocationMap& difference = map_of(maps, AllocationInput::differential_voltage);
  EXPECT_GT(difference.slope.roll, 0.0);  // more on the left: right wing down
  EXPECT_LT(difference.slope.roll, 0.5 * common.slope.lift * (68e-3 + offset));
  // A bias turns both wings forward by K V_b / (R N_w k), and lift acts there.
  const Vehicle<double> v = resolve(design);
  const AllocationMap& bias = map_of(maps, AllocationInput::bias_voltage);
  EXPECT_GT(bias.slope.pitch, 0.0);
  const double turned =
      v.motor.torque_constant / v.motor.armature_resistance / (v.wing_count * v.spring.stiffness);  // rad/V
  EXPECT_NEAR(bias.slope.pitch / (lift * v.wings.s3 / v.wings.s2 * turned), 1.0, 0.5);
  EXPECT_NEAR(bias.slope.roll, 0.0, 1e-6 * lift);
  const AllocationMap& split = map_of(maps, AllocationInput::split_cycle);
  EXPECT_NE(split.slope.yaw, 0.0);
  EXPECT_NEAR(split.slope.pitch, 0.0, 1e-2 * std::abs(split.slope.yaw));
}

}  // namespace
}  // namespace wingbeat
