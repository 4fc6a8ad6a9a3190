// Means over a cycle of what the air does to a body, their slopes, and the static maps that are made of them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "study/slope_differences.hpp"
#include "vehicle/map_vehicles.hpp"
#include "wingbeat/cycle/cycle_instants.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/time/simulation.hpp"

namespace wingbeat {
namespace {

/// Wings that pitch between stops, a motor for either.
Design<double> with_stops() {
  return read_design(std::filesystem::path(WINGBEAT_DATA) / "designs" / "two-wing-direct-hinge.toml");
}

const AllocationMap& map_by(const std::vector<AllocationMap>& maps, AllocationInput input) {
  for (const AllocationMap& map : maps) {
    if (map.input == input) return map;
  }
  throw std::runtime_error("no such map");
}

TEST(DriveWave, OfNothingIsASine) {
  for (double phi = 0.0; phi < two_pi; phi += 0.01) {
    EXPECT_NEAR(voltage_of_wave<double>({}, 3.0, phi), 3.0 * std::sin(phi), 1e-14);
  }
}

TEST(DriveWave, HalvesMeetAndHaveTheirLengths) {
  constexpr double V = 3.0, bias = 0.2, tiny = 1e-9;
  for (const double delta : {-0.3, -0.05, 0.1, 0.3}) {
    for (const bool cosine : {false, true}) {
      DriveWave<double> wave{bias};
      (cosine ? wave.cosine_split : wave.split) = delta;
      const auto voltage_at = [&](double phi) { return voltage_of_wave(wave, V, phi); };
      const double mean = cosine ? bias : bias - 2.0 * V * delta / pi;
      // The half from end to end, and what the wave is there.
      const double from = cosine ? 0.5 * pi : 0.0, to = from + pi * (1.0 + delta);
      EXPECT_NEAR(voltage_at(from + tiny), mean + (cosine ? V : 0.0), 1e-7);
      EXPECT_NEAR(voltage_at(to - tiny), mean + (cosine ? -V : 0.0), 1e-7);
      EXPECT_NEAR(voltage_at(to + tiny), voltage_at(to - tiny), 1e-7);
      EXPECT_NEAR(voltage_at(0.5 * (from + to)), mean + (cosine ? 0.0 : V), 1e-12);
      EXPECT_NEAR(voltage_at(two_pi - tiny), voltage_at(0.0), 1e-7);
      double sum = 0.0;
      constexpr int count = 20000;
      for (int n = 0; n < count; ++n) sum += voltage_at(two_pi * (n + 0.5) / count) / count;
      EXPECT_NEAR(sum, bias, 1e-6);
    }
  }
}

TEST(DriveWave, OfACosineIsThatOfThePurdueSimulation) {
  // u = V cos(2 pi f t / (2 sigma)) for t < sigma / f, V cos((2 pi f t - 2 pi) / (2 (1 - sigma))) after, sigma = 1/2 +
  // sc.
  constexpr double V = 12.0, sc = 0.1, sigma = 0.5 + sc;
  DriveWave<double> wave;
  wave.cosine_split = 2.0 * sc;
  for (double part = 0.0; part < 1.0; part += 0.001) {
    const double u = V * std::cos(part < sigma ? pi * part / sigma : (pi * part - pi) / (1.0 - sigma));
    const double phase = std::fmod(two_pi * part + 0.5 * pi, two_pi);
    EXPECT_NEAR(voltage_of_wave(wave, V, phase), u, 1e-12) << part;
  }
}

TEST(WingLoads, AreTheMeansOfTheOrbit) {
  // Impacts move air at once where the design has added mass: their impulse is a part of the lift.
  Design<double> heavy_air = hinged_design(3e-4);
  heavy_air.pitch.stop = 0.3;
  for (const Design<double>& design : {with_stops(), heavy_air, map_vehicle(MapKind::hinged_crank, true, 3),
                                       map_vehicle(MapKind::crank, false, 1), reference_design()}) {
    const SteadyFlapping orbit = find_steady_flapping(resolve(design), {.tolerance = 1e-10, .stability = false});
    ASSERT_EQ(orbit.status, FlappingStatus::flapping);
    const WingLoads loads = wing_loads(orbit.record);
    const double lift = orbit.metrics[Metric::lift_mean], frequency = orbit.metrics[Metric::frequency];
    EXPECT_NEAR(loads[std::size_t(WingLoad::lift)], lift, 1e-8 * lift);
    EXPECT_NEAR(loads[std::size_t(WingLoad::frequency)], frequency, 1e-9 * frequency);
    EXPECT_LT(loads[std::size_t(WingLoad::lift_sideways)], lift);
    EXPECT_GT(loads[std::size_t(WingLoad::lift_sideways)], 0.3 * lift);
  }
}

TEST(WingLoads, RowsOfACycleAddUpToItsMeans) {
  // Without added mass nothing is moved at once, so that instants between events give the whole lift, stops or not.
  const SteadyFlapping orbit = find_steady_flapping(resolve(with_stops()), {.tolerance = 1e-10, .stability = false});
  double lift = 0.0, weight = 0.0, power = 0.0;
  for (const auto& [row, share, phase] : cycle_instants(orbit.record)) {
    lift += share * row.lift;
    power += share * row.power_electrical;
    weight += share;
  }
  EXPECT_NEAR(weight, 1.0, 1e-12);
  EXPECT_NEAR(lift, orbit.metrics[Metric::lift_mean], 1e-8 * lift);
  EXPECT_NEAR(power, orbit.metrics[Metric::power_electrical], 1e-8 * power);
}

TEST(WingLoads, UnderAWaveAreThoseOfTheSimulation) {
  const Vehicle<double> vehicle = resolve(with_stops());
  const SteadyFlapping orbit = find_steady_flapping(vehicle, {.tolerance = 1e-10, .stability = false});
  const DriveWave<double> waves[] = {{0.8, 0.0, 0.0}, {0.0, 0.15, 0.0}, {0.0, 0.0, 0.15}};
  for (const DriveWave<double>& wave : waves) {
    const auto found = loads_under_wave(orbit.record, wave);
    ASSERT_TRUE(found);
    const double period = 1.0 / vehicle.drive_frequency;
    SimulationOptions options;
    options.tolerance = 1e-9;
    const WaveformRow start = orbit.record.at(0.0);
    options.angle = start.stroke_angle;
    options.speed = start.flapping_velocity;
    options.pitch_angle = start.pitch_angle;
    Simulation flight(vehicle, {}, options);
    flight.command([&](double t) {
      const double part = t / period - std::floor(t / period);
      return voltage_of_wave(wave, vehicle.voltage, two_pi * part);
    });
    constexpr int settling = 60, instants = 20000;
    flight.step_to(settling * period);
    double lift = 0.0, forward = 0.0, moment = 0.0;
    for (int n = 0; n <= instants; ++n) {
      flight.step_to((settling + double(n) / instants) * period);
      const WaveformRow row = flight.now();
      const double weight = (n == 0 || n == instants ? 0.5 : 1.0) / instants;
      lift += weight * row.lift;
      forward += weight * row.lift * std::sin(row.stroke_angle);
      moment += weight * row.aero_moment;
    }
    // What rows at even distances miss is about the jumps at stops by their distance.
    EXPECT_NEAR(found->loads[std::size_t(WingLoad::lift)], lift, 3e-4 * lift);
    EXPECT_NEAR(found->loads[std::size_t(WingLoad::lift_forward)], forward, 3e-4 * lift);
    EXPECT_NEAR(found->loads[std::size_t(WingLoad::moment)], moment, 3e-4 * load_scales(orbit.metrics)[3]);
  }
}

TEST(Allocation, SlopesAreThoseOfCyclesBesideTheOperatingPoint) {
  for (std::size_t kind = 0; kind < map_kind_names.size(); ++kind) {
    for (const bool stops : {false, true}) {
      int flapping = 0;
      for (std::uint32_t n = 0; n < 40 && flapping < 2; ++n) {
        const Design<double> design = map_vehicle(MapKind(kind), stops, n, 7);
        const Linearisation linearisation = linearise(design);
        if (!linearisation.model) continue;
        ++flapping;
        const SlopeCheck check = slopes_against_cycles(linearisation.orbit);
        EXPECT_EQ(check.beyond, 0) << map_kind_names[kind] << ' ' << n << ' ' << check.where << ' ' << check.worst;
      }
      EXPECT_EQ(flapping, 2) << map_kind_names[kind];
    }
  }
}

TEST(Allocation, SlopesWhereWingsHitStopsAreThoseOfThePoints) {
  for (const double amplitude : {12.0, 9.5}) {
    Design<double> design = with_stops();
    design.supply.voltage = amplitude;
    const Linearisation linearisation = linearise(design);
    ASSERT_TRUE(linearisation.model);
    const std::vector<AllocationMap> maps = allocation_maps(linearisation, 13.95e-3);
    ASSERT_EQ(maps.size(), 5u);
    EXPECT_LT(lift_slope_apart(linearisation, maps[0].slope.lift), 1e-8) << amplitude << " V";
    const SlopeCheck points = slopes_against_points(maps);
    EXPECT_EQ(points.beyond, 0) << amplitude << " V: " << points.where << ' ' << points.worst;
    // A difference of voltages leaves lift and pitch, a split leaves lift and roll: none of that is in their slopes.
    const AllocationPoint& differential = map_by(maps, AllocationInput::differential_voltage).slope;
    EXPECT_EQ(differential.lift, 0.0);
    EXPECT_EQ(differential.pitch, 0.0);
    EXPECT_GT(differential.roll, 0.0);
    for (const AllocationInput which : {AllocationInput::split_cycle, AllocationInput::split_cycle_cosine}) {
      const AllocationPoint& split = map_by(maps, which).slope;
      EXPECT_EQ(split.lift, 0.0);
      EXPECT_LT(std::abs(split.roll), 1e-6 * std::abs(split.yaw)) << name_of(which);
    }
    // The longer half of the voltage, and the longer half of its fall, turn the body to opposite sides.
    EXPECT_LT(map_by(maps, AllocationInput::split_cycle).slope.yaw, 0.0);
    EXPECT_GT(map_by(maps, AllocationInput::split_cycle_cosine).slope.yaw, 0.0);
  }
}

// The roll moment of a differential voltage is odd: the kinks where either side's wings begin to reach their stops
// cancel in the curvatures of the map's points, whose error estimate missed them (6.6 times what it allowed).
TEST(Allocation, BendsOnBothSidesOfTheOperatingPointAreFound) {
  const Linearisation linearisation = linearise(map_vehicle(MapKind::hinged_crank, true, 3));
  ASSERT_TRUE(linearisation.model);
  const std::vector<AllocationMap> maps = allocation_maps(linearisation, 4e-3);
  const SlopeCheck points = slopes_against_points(maps);
  EXPECT_EQ(points.compared, 8);
  EXPECT_EQ(points.beyond, 0) << points.where << ' ' << points.worst;
  const AllocationMap& map = map_by(maps, AllocationInput::differential_voltage);
  const double of_map = map.points[6].input - map.points[5].input, step = map.slope_of_points_step.roll;
  EXPECT_LT(step, 0.6 * of_map);
  EXPECT_GT(step, of_map / 300.0);
  // Within the stated error by itself, without the thousandth that slopes_against_points() allows.
  EXPECT_LE(std::abs(map.slope.roll - map.slope_of_points.roll), map.slope_of_points_error.roll);
  EXPECT_LT(map.slope_of_points_error.roll, 0.1 * std::abs(map.slope.roll));
}

TEST(Allocation, MapsHoldTheMotorsTemperatures) {
  Design<double> design = reference_design();
  design.motor.thermal.resistance_winding = 20.0;
  design.motor.thermal.resistance_case = 40.0;
  const Linearisation linearisation = linearise(design);
  ASSERT_TRUE(linearisation.model);
  const std::vector<AllocationMap> maps = allocation_maps(linearisation);
  EXPECT_LT(lift_slope_apart(linearisation, maps[0].slope.lift), 1e-8);
  EXPECT_EQ(slopes_against_points(maps).beyond, 0);
}

TEST(Allocation, WithoutSpringsNothingHoldsTheMeanAngle) {
  Design<double> design = direct_design();
  design.spring = {};
  design.motors = 2.0;
  design.wing.count = 1.0;
  const Linearisation linearisation = linearise(design);
  ASSERT_TRUE(linearisation.model);
  const std::vector<AllocationMap> maps = allocation_maps(linearisation);
  const AllocationMap& voltage = map_by(maps, AllocationInput::voltage);
  EXPECT_GT(voltage.slope.lift, 0.0);
  EXPECT_NEAR(voltage.slope.lift, voltage.slope_of_points.lift,
              voltage.slope_of_points_error.lift + 1e-4 * voltage.slope.lift);
  const AllocationMap& bias = map_by(maps, AllocationInput::bias_voltage);
  EXPECT_TRUE(std::isnan(bias.slope.lift));
  EXPECT_TRUE(std::isnan(bias.points.front().lift));
  EXPECT_FALSE(std::isnan(bias.points[4].lift));
}

}  // namespace
}  // namespace wingbeat
