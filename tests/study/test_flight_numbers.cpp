// Numbers of insects in hover: closed forms of their damping, and where averaging holds.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/flight/stability.hpp"
#include "wingbeat/parts/planform.hpp"
#include "wingbeat/study/flight_numbers.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

Design<double> insect(const std::string& name) {
  return read_design(WINGBEAT_DATA "/designs/insects/" + name + ".toml");
}

/// Amplitude of the stroke [rad], a sine, and its frequency at the stated voltage [Hz].
double amplitude_of(const Design<double>& d) { return d.transmission.table.scale / degrees_per_radian; }
double stated_frequency(const Design<double>& d) {
  return d.supply.voltage / d.motor.constants.torque_constant / two_pi;
}

// A strip at r that yaws at W moves with r (beta' +- W): N = -rho C_D S_3 mean |beta'| W, with mean |beta'| = 4 f phi.
TEST(FlightNumbers, YawDampingIsItsClosedForm) {
  const Design<double> fly = insect("fruit-fly");
  const double alpha = 45.0 / degrees_per_radian;
  const double C_D = drag_coefficient(translational_2022(), alpha);
  const double s3 = chord_moments(fly.wing.planform, 2.0).s3;
  const double closed = fly.aerodynamics.air_density * C_D * s3 * 4.0 * stated_frequency(fly) * amplitude_of(fly);
  const double found = flight_numbers(flight_vehicle(fly), {FlightNumber::yaw_damping}).averaged[0];
  fmt::print("yaw damping of a fruit fly: {:.2f} pN m s, closed form {:.2f}\n", 1e12 * found, 1e12 * closed);
  EXPECT_NEAR(found, closed, 2e-3 * closed);
}

// Heaving at w turns the flow by w / (r beta'): Z = -1/2 rho S_1 mean |beta'| (C_L' + C_D) w.
TEST(FlightNumbers, TheSlowSubsidenceIsTheDampingOfHeave) {
  const Design<double> bee = insect("bumblebee");
  const FlightNumbers numbers =
      flight_numbers(flight_vehicle(bee), {FlightNumber::slow_half_life, FlightNumber::trim_frequency});
  const double alpha = *bee.aerodynamics.angle_of_attack_min, h = 1e-5;
  const ForceCoefficients<double> set = translational_2022();
  const double lift_slope = (lift_coefficient(set, alpha + h) - lift_coefficient(set, alpha - h)) / (2.0 * h);
  const double s1 = first_chord_moment(bee.wing.planform, 2.0);
  const double damping = 0.5 * bee.aerodynamics.air_density * s1 * 4.0 * numbers.averaged[1] * amplitude_of(bee) *
                         (lift_slope + drag_coefficient(set, alpha));
  const double half_life = std::log(2.0) * *bee.mass / damping;
  EXPECT_NEAR(numbers.averaged[0], half_life, 0.01 * half_life);
  EXPECT_NEAR(numbers.floquet[0], half_life, 0.05 * half_life);
}

/// Distance of averaging from Floquet theory, of the least stable longitudinal mode, over the latter.
double error_of_averaging(const Design<double>& design) {
  AveragedFlight flight(flight_vehicle(design));
  const TrimResult steady = trim(flight, {});
  EXPECT_TRUE(steady.flies());
  for (const FlightMode& mode : flight_stability(flight, steady).modes) {
    if (!mode.longitudinal) continue;
    EXPECT_TRUE(mode.averaged && mode.floquet);
    if (!mode.averaged || !mode.floquet) return absent;
    return std::abs(*mode.averaged - *mode.floquet) / std::abs(*mode.floquet);
  }
  return absent;
}

// Wu and Sun (2012): averaging fails for a hawkmoth, whose wings are heavy and slow, and holds for a fast insect.
TEST(FlightNumbers, AveragingIsWorseForAHawkmothThanForABee) {
  const double moth = error_of_averaging(insect("hawkmoth")), bee = error_of_averaging(insect("bumblebee"));
  Design<double> light = insect("hawkmoth");
  light.body.wing_mass.reset();
  light.body.wing_centre = 0.0;
  const double without_mass = error_of_averaging(light);
  fmt::print("averaging off by: hawkmoth {:.4f}, without mass of the wings {:.4f}, bumblebee {:.4f}\n", moth,
             without_mass, bee);
  EXPECT_LT(bee, 0.05);
  EXPECT_GT(moth, 2.0 * bee);
}

TEST(FlightNumbers, ControlsDoWhatTheirMapsSay) {
  const FlightVehicle purdue = flight_vehicle(read_design(WINGBEAT_DATA "/designs/flight-purdue.toml"));
  AveragedFlight flight(purdue);
  FlightControls controls;
  controls[FlightControl::voltage] = purdue.stated_voltage;
  controls[FlightControl::voltage_difference] = 1.0;
  const auto right = flight.at(controls, {});
  ASSERT_TRUE(right);
  const auto roll = load_over_control(purdue, FlightControl::voltage_difference, {1.0, -1.0}, FlightLoad::roll_moment);
  EXPECT_NEAR(roll[0], right->loads.moment[0], 1e-3 * std::abs(roll[0]));
  EXPECT_NEAR(roll[1], -roll[0], 1e-4 * std::abs(roll[0]));
  EXPECT_LT(roll[0], 0.0);  // more voltage right lifts that side
  const auto lift = load_over_control(purdue, FlightControl::voltage, {8.0, 9.0}, FlightLoad::lift);
  EXPECT_GT(lift[1], lift[0]);
}

}  // namespace
}  // namespace wingbeat
