// Every kind of evidence in words.
#include <gtest/gtest.h>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/status_evidence.hpp"

namespace wingbeat {
namespace {

using Evidence = StatusEvidence::Kind;
using solver::PeriodicStatus;

constexpr double degree = pi / 180.0;

TEST(DescribeStatus, Flapping) {
  EXPECT_EQ(describe(StatusEvidence{}), "");
  StatusEvidence orbit{.kind = Evidence::orbit, .frequency = 17.12345};
  EXPECT_EQ(describe(orbit), "steady flapping at 17.12 Hz");
  orbit.can_lock = true;
  orbit.locks = {{70.0 * degree, 72.5 * degree, 71.0 * degree, 1e-3}, {2.0, 2.0, 200.0 * degree, 0.0}};
  EXPECT_EQ(describe(orbit),
            "steady flapping at 17.12 Hz; the crank also locks at crank angles 70.0 to 72.5 deg, 200.0 deg");
  orbit.assessed = true;
  EXPECT_EQ(describe(orbit),
            "steady flapping at 17.12 Hz; once stopped, the crank also locks at crank angles 70.0 to 72.5 deg, "
            "200.0 deg");
  EXPECT_EQ(describe({.kind = Evidence::response, .frequency = 22.0, .stroke_amplitude = 1.5}),
            "steady flapping at the supply's 22 Hz");
  EXPECT_EQ(describe({.kind = Evidence::response, .frequency = 22.0, .stroke_amplitude = 100.0 * degree}),
            "steady flapping at the supply's 22 Hz; a stroke of +-100 deg passes the quarter turn that wings have room "
            "for");
  EXPECT_EQ(describe({.kind = Evidence::simulated_cycle,
                      .frequency = 17.0,
                      .change = 1e-6,
                      .repeats_after = 2,
                      .search = PeriodicStatus::barrier}),
            "steady flapping at 17 Hz, from its cycle simulated in time to 1e-06, which repeats after 2 turns: the "
            "search for an orbit in crank angle found none that start-up reaches (an iterate ran into the edge of the "
            "admissible region)");
  EXPECT_EQ(describe({.kind = Evidence::simulated_cycle, .frequency = 17.0, .change = 1e-6, .direct = true}),
            "steady flapping at 17 Hz, from its cycle simulated in time to 1e-06: the search for an orbit in the phase "
            "of the supply found none that start-up reaches ()");
}

TEST(DescribeStatus, FlappingInTime) {
  StatusEvidence e{
      .kind = Evidence::settled_cycles, .frequency = 17.1234567, .time = 0.25, .change = 2e-8, .cycles = 12};
  EXPECT_EQ(describe(e), "flaps steadily at 17.1235 Hz from 0.25 s on; after 12 cycles they repeat to 2e-08");
  e.repeats_after = 3;
  EXPECT_EQ(describe(e),
            "flaps steadily at 17.1235 Hz from 0.25 s on; after 12 cycles they repeat to 2e-08 every 3 cycles");
  e.extrapolated = true;
  EXPECT_EQ(describe(e),
            "flaps steadily at 17.1235 Hz from 0.25 s on; after 12 cycles they repeat to 2e-08 (slow convergence, "
            "extrapolated)");
  e = {.kind = Evidence::averaged_cycles, .frequency = 17.1234567, .change = 0.0123, .cycles = 8};
  EXPECT_EQ(describe(e),
            "flaps at 17.1235 Hz, averaged over 8 cycles whose durations differ by up to 1.2 % from their mean");
  e.incommensurate = true;
  EXPECT_EQ(describe(e),
            "flaps at 17.1235 Hz, averaged over 8 cycles whose durations differ by up to 1.2 % from their mean; cycles "
            "and supply share no period");
  e = {.kind = Evidence::settled_periods, .frequency = 22.0, .time = 0.5, .change = 1e-9, .cycles = 40};
  EXPECT_EQ(describe(e), "flaps steadily at the supply's 22 Hz from 0.5 s on; after 40 periods they repeat to 1e-09");
  e.accuracy = 3e-7;
  e.extrapolated = true;
  EXPECT_EQ(describe(e),
            "flaps steadily at the supply's 22 Hz from 0.5 s on; after 40 periods they repeat to 1e-09 (slow "
            "convergence, extrapolated), metrics to about 3e-07");
  e.extrapolated = false;
  e.steps = 3000000;
  EXPECT_EQ(describe(e),
            "flaps steadily at the supply's 22 Hz from 0.5 s on; after 40 periods they repeat to 1e-09, metrics to "
            "about 3e-07: the 3000000 integration steps allowed are used up");
}

TEST(DescribeStatus, Stalled) {
  EXPECT_EQ(describe({.kind = Evidence::weak_motor, .torque = 0.003, .friction_torque = 0.004}),
            "the motor never starts: its stall torque 0.003 N m does not exceed the constant friction 0.004 N m");
  EXPECT_EQ(describe({.kind = Evidence::weak_supply, .frequency = 22.0, .torque = 0.003, .friction_torque = 0.004}),
            "the motor never breaks away: at 22 Hz the supply gives it a torque of 0.003 N m at most, which does not "
            "exceed the constant friction 0.004 N m");
  EXPECT_EQ(
      describe({.kind = Evidence::weak_alternation, .frequency = 22.0, .torque = 0.003, .friction_torque = 0.004}),
      "no motion outlasts the start: at 22 Hz the supply's torque alternates by +-0.003 N m, which does not exceed "
      "the constant friction 0.004 N m");
  EXPECT_EQ(
      describe({.kind = Evidence::stalled_crank, .angle = 30.0 * degree, .torque = 0.003, .friction_torque = 0.004}),
      "the motor cannot turn: stall torque 0.003 N m does not exceed the constant friction of 0.004 N m (crank at "
      "30.0000 deg)");
  EXPECT_EQ(describe({.kind = Evidence::held_shaft, .angle = 30.0 * degree, .torque = 0.003, .friction_torque = 0.004}),
            "rests at stroke angle 30.0000 deg: the constant friction 0.004 N m holds 0.003 N m, all that supply and "
            "springs apply at most");
  EXPECT_EQ(describe({.kind = Evidence::creeping_shaft,
                      .angle = 30.0 * degree,
                      .torque = 0.003,
                      .friction_torque = 0.004,
                      .travel = 0.125 * degree}),
            "creeps to rest near stroke angle 30.0000 deg, the last period by 0.12 deg: the supply gives a torque of "
            "0.003 N m at most, which does not exceed the constant friction 0.004 N m");
  EXPECT_EQ(describe({.kind = Evidence::no_voltage}), "no voltage: nothing moves the wings");
}

TEST(DescribeStatus, LockedAndJammed) {
  StatusEvidence e{.kind = Evidence::no_orbit, .angle = 71.25 * degree, .search = PeriodicStatus::too_many_steps};
  EXPECT_EQ(describe(e),
            "no rotating orbit: cycles end at crank angle 71.2 deg (an iterate needs more steps than allowed)");
  e.can_lock = true;
  e.locks = {{70.0 * degree, 72.5 * degree, 71.0 * degree, 1e-3}};
  EXPECT_EQ(describe(e),
            "no rotating orbit: cycles end at crank angle 71.2 deg (an iterate needs more steps than allowed); the "
            "crank locks at crank angles 70.0 to 72.5 deg");
  e = {.kind = Evidence::friction_holds, .angle = 71.25 * degree, .friction_torque = 0.002, .torque_margin = 0.0005};
  EXPECT_EQ(describe(e),
            "rests at crank angle 71.2500 deg: friction holds 0.002 N m there, 0.0005 N m more than motor and springs "
            "apply");
  e.faster_orbit = 17.123;
  EXPECT_EQ(describe(e),
            "rests at crank angle 71.2500 deg: friction holds 0.002 N m there, 0.0005 N m more than motor and springs "
            "apply; a rotating orbit at 17.12 Hz exists for a faster start");
  EXPECT_EQ(describe({.kind = Evidence::springs_balance, .angle = 71.25 * degree, .torque = 0.003}),
            "rests at crank angle 71.2500 deg: the springs balance the stall torque of 0.003 N m in a stable "
            "equilibrium");
  EXPECT_EQ(describe({.kind = Evidence::swings, .range = AngleRange{-10.0 * degree, 20.0 * degree}}),
            "does not rotate: the crank moves with the supply between -10.0000 and 20.0000 deg");
  EXPECT_EQ(describe({.kind = Evidence::lever_may_vanish, .angle = 45.0 * degree, .lever = -1e-4}),
            "the rod force loses its lever on the wings at crank angle 45.0 deg (least lever -0.0001 m)");
  EXPECT_EQ(describe({.kind = Evidence::inertia_may_vanish, .angle = 45.0 * degree, .inertia = -1e-9}),
            "the equations of motion lose their unique solution at crank angle 45.0 deg: the rotor is too light for "
            "the friction (effective inertia -1e-09 kg m2)");
  EXPECT_EQ(describe({.kind = Evidence::lever_vanishes, .angle = 45.0 * degree, .lever = 1e-9}),
            "jams at crank angle 45.0000 deg: the rod force loses its lever on the wings (g = 1e-09 m)");
  EXPECT_EQ(describe({.kind = Evidence::inertia_vanishes, .angle = 45.0 * degree, .inertia = 1e-15}),
            "jams at crank angle 45.0000 deg: rotor inertia and rod-force friction leave no unique acceleration (J + A "
            "(h - mu r_e) = 1e-15 kg m2)");
}

TEST(DescribeStatus, Undecided) {
  EXPECT_EQ(
      describe({.kind = Evidence::unstable_orbit, .frequency = 17.0, .multiplier = 1.25}),
      "the only orbit found, at 17 Hz, is unstable (Floquet multiplier 1.25), and no simulation shows what start-up "
      "does");
  EXPECT_EQ(describe({.kind = Evidence::unstable_response, .multiplier = 1.25}),
            "the periodic response to the supply is unstable (Floquet multiplier 1.25)");
  EXPECT_EQ(describe({.kind = Evidence::no_response, .search = PeriodicStatus::not_converged}),
            "no periodic response to the supply was found: iterates did not close");
  EXPECT_EQ(describe({.kind = Evidence::no_cycle, .search = PeriodicStatus::not_converged}),
            "it rotates when simulated in time, but neither a periodic orbit in crank angle (iterates did not close) "
            "nor a simulated cycle was found that it settles on");
  EXPECT_EQ(describe({.kind = Evidence::open_balance, .change = 2.5e-4}),
            "the energy balance of the cycle found does not close, not even with finer steps: 0.00025 of the input is "
            "left over");
  StatusEvidence e{.kind = Evidence::out_of_steps, .frequency = 17.0, .steps = 100};
  EXPECT_EQ(describe(e), "no decision within 100 integration steps; it flaps at 17 Hz then");
  e.range = AngleRange{-0.5 * degree, 12.0 * degree};
  EXPECT_EQ(
      describe(e),
      "no decision within 100 integration steps; the crank makes no forward revolutions then, it has been between "
      "-0.5 and 12 deg");
  const auto of_shaft = [](StatusEvidence evidence) {
    evidence.direct = true;
    return describe(evidence);
  };
  EXPECT_EQ(of_shaft({.kind = Evidence::out_of_steps, .steps = 100}), "no decision within 100 integration steps");
  EXPECT_EQ(of_shaft({.kind = Evidence::out_of_time, .time = 0.02}), "no decision within 0.02 s");
  EXPECT_EQ(of_shaft({.kind = Evidence::cycles_differ, .change = 0.012, .cycles = 50}),
            "the state still changes by 0.012 of its size from one period to the next after 50 periods");
  EXPECT_EQ(
      describe({.kind = Evidence::cycles_differ, .frequency = 17.0, .change = 0.012, .cycles = 50}),
      "the state still changes by 0.012 of its size from one cycle to the next after 50 cycles; it flaps at 17 Hz "
      "then");
  EXPECT_EQ(describe({.kind = Evidence::cycles_differ, .frequency = 17.0, .change = infinity, .cycles = 50}),
            "the cycles have not settled after 50; it flaps at 17 Hz then");
  EXPECT_EQ(of_shaft({.kind = Evidence::cancelled}), "cancelled");
  EXPECT_EQ(describe({.kind = Evidence::runs_away, .frequency = 17.0, .crank_speed = -1234.0}),
            "the crank speeds up without bound (-1.23e+03 rad/s): this transmission formulation does not conserve "
            "power and feeds it; it flaps at 17 Hz then");
  EXPECT_EQ(of_shaft({.kind = Evidence::integrator_not_started}), "the integrator could not be started");
  EXPECT_EQ(of_shaft({.kind = Evidence::integrator_failed, .time = 0.5}), "the integrator failed at t = 0.5 s");
  EXPECT_EQ(describe({.kind = Evidence::integrator_failed, .frequency = 17.0, .angle = 45.0 * degree, .time = 0.5}),
            "the integrator failed at t = 0.5 s, crank angle 45.0000 deg; it flaps at 17 Hz then");
}

}  // namespace
}  // namespace wingbeat
