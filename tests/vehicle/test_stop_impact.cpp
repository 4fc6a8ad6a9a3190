// An impact on a stop: momentum, and where the energy goes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/hinged_design.hpp"
#include "wingbeat/vehicle/impact.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

/// Random cranks and direct drives at random states: calls use(vehicle, kinematics, omega, psi, psi').
template <class Use>
void at_random_states(const Use& use) {
  std::mt19937_64 random(71);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int used = 0;
  for (std::uint32_t n = 0; n < 300; ++n) {
    Design<double> d = n % 4 == 0 ? random_hinged_design(random, true) : random_hinged_crank(n, 9);
    if (n % 4 != 0 && n % 3 == 0) d.motor.gear_efficiency = uniform(0.5, 0.95);
    const Vehicle<double> v = resolve(d);
    const double theta = uniform(0.0, two_pi), psi = uniform(-0.8, 0.8);
    const CrankKinematics<double> k =
        n % 4 == 0 ? direct_kinematics<double>() : crank_kinematics(v.transmission, std::sin(theta), std::cos(theta));
    if (!(k.wing_jacobian > 0.0) || !(effective_inertia(v, k, 1.0) > 0.0 && effective_inertia(v, k, -1.0) > 0.0))
      continue;
    ++used;
    use(v, k, uniform(0.5, 1.5) * 100.0, psi, uniform(-200.0, 200.0));
  }
  EXPECT_GT(used, 200);
}

double energy(const Vehicle<double>& v, const CrankKinematics<double>& k, double omega, double psi, double velocity) {
  const PitchState<double> state = pitch_state(psi, velocity, k.stroke_slope * omega);
  return kinetic_energy(pitch_inertia(v.pitch, v.wing_count * v.wing_inertia, state), state);
}

MotionState<double> at(const CrankKinematics<double>& k, double omega, double psi, double velocity) {
  return {{k, 0.0}, omega, 0.0, 0.0, psi, velocity};
}

TEST(StopImpact, PartsAddUpAndNoneGivesEnergy) {
  at_random_states(
      [](const Vehicle<double>& v, const CrankKinematics<double>& k, double omega, double psi, double velocity) {
        const StopImpact<double> impact = stop_impact(v, at(k, omega, psi, velocity), 1.0);
        const double J = v.motor.inertia, after = omega + impact.shaft_speed, mean = omega + 0.5 * impact.shaft_speed;
        const double rotor = 0.5 * J * (square(omega) - square(after));
        const double wings = energy(v, k, omega, psi, velocity) - energy(v, k, after, psi, 0.0);
        const double size = rotor == 0.0 ? wings : std::abs(rotor) + std::abs(wings);
        EXPECT_NEAR(impact.motor_work + impact.gear_work, rotor, 1e-9 * size);
        EXPECT_NEAR(rotor + wings, impact.gear_work + impact.friction_work + impact.residual_work + impact.stop_work,
                    1e-9 * size);
        EXPECT_NEAR(
            impact.motor_work,
            impact.friction_work + impact.residual_work + impact.rod_impulse * k.wing_jacobian * k.stroke_slope * mean,
            1e-9 * size);
        EXPECT_GE(impact.stop_work, 0.0);
        if (after > 0.0) {
          EXPECT_GE(impact.gear_work, 0.0);
          EXPECT_GE(impact.friction_work, 0.0);
        }
      });
}

TEST(StopImpact, TwoHalvesAreTheWhole) {
  at_random_states(
      [](const Vehicle<double>& v, const CrankKinematics<double>& k, double omega, double psi, double velocity) {
        const double left = 0.3 * velocity;
        const StopImpact<double> whole = stop_impact(v, at(k, omega, psi, velocity), 1.0);
        const StopImpact<double> first = stop_impact(v, at(k, omega, psi, velocity), 1.0, left);
        const StopImpact<double> second = stop_impact(v, at(k, omega + first.shaft_speed, psi, left), 1.0);
        const double size = energy(v, k, omega, psi, velocity) + 0.5 * v.motor.inertia * square(omega);
        EXPECT_NEAR(first.shaft_speed + second.shaft_speed, whole.shaft_speed, 1e-9 * omega);
        EXPECT_NEAR(first.motor_work + second.motor_work, whole.motor_work, 1e-12 * size);
        EXPECT_NEAR(first.stop_work + second.stop_work, whole.stop_work, 1e-12 * size);
        EXPECT_NEAR(first.friction_work + second.friction_work, whole.friction_work, 1e-12 * size);
        EXPECT_NEAR(first.lift + second.lift, whole.lift, 1e-12 * std::abs(whole.lift) + 1e-18);
      });
}

}  // namespace
}  // namespace wingbeat
