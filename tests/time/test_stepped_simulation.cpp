// Simulation: vehicles in time under commanded voltages, with events, saved and restored.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "vehicle/pitching_vehicle.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/time/simulation.hpp"

namespace wingbeat {
namespace {

using Kind = TransientEvent::Kind;

const Supply<double> three_volts{SupplyType::constant, 3.0, 0.0, 1.0};

Vehicle<double> without_inductance(Vehicle<double> v) {
  v.motor.armature_inductance = 0.0;
  return v;
}

/// Same time and, to `tolerance` of each number's size or 1, same state.
void expect_same_place(const Simulation& a, const Simulation& b, double tolerance) {
  EXPECT_EQ(a.time(), b.time());
  ASSERT_EQ(a.state().size(), b.state().size());
  for (std::size_t n = 0; n < a.state().size(); ++n) {
    EXPECT_NEAR(a.state()[n], b.state()[n], tolerance * std::max(1.0, std::abs(a.state()[n]))) << a.state_names()[n];
  }
}

TEST(SteppedSimulation, ACommandedVoltageIsASupplyThatGivesIt) {
  for (const Vehicle<double>& v : {reference_vehicle(true), without_inductance(reference_vehicle())}) {
    Simulation supplied(v, three_volts), held(v), asked(v), sampled(v, {SupplyType::constant, 9.0, 0.0, 1.0});
    held.command(3.0);
    asked.command([](double) { return 3.0; });
    sampled.command({0.0, 1.0}, {3.0, 3.0});
    for (Simulation* each : {&supplied, &held, &asked, &sampled}) each->step_to(0.2);
    EXPECT_EQ(supplied.state(), held.state());
    EXPECT_EQ(supplied.state(), asked.state());
    expect_same_place(supplied, sampled, 1e-6);  // of other typical sizes
    EXPECT_GT(supplied.state()[1], 50.0);
  }
}

TEST(SteppedSimulation, AFunctionOfTimeIsTheSupplyOfThatForm) {
  const double voltage = 3.0, frequency = 22.0;
  const auto sine = [=](double t) { return voltage * std::sin(two_pi * frequency * t); };
  Vehicle<double> swinging = reference_vehicle();
  swinging.spring.stiffness = 0.02;
  Simulation supplied(swinging, {SupplyType::sine, voltage, frequency, 1.0}), asked(swinging, three_volts);
  asked.command(sine);
  for (Simulation* each : {&supplied, &asked}) each->step_to(0.1);
  expect_same_place(supplied, asked, 1e-6);

  std::mt19937_64 random(17);
  for (int n = 0; n < 6; ++n) {
    Vehicle<double> v = n < 3 ? resolve(random_direct_design(random, n == 2)) : random_pitching_vehicle(random, n == 5);
    Simulation own(v), other(v);
    other.command([&](double t) { return v.voltage * std::sin(two_pi * v.drive_frequency * t); });
    for (Simulation* each : {&own, &other}) each->step_to(2.3 / v.drive_frequency);
    EXPECT_EQ(own.state(), other.state()) << n;
  }
}

TEST(SteppedSimulation, SamplesAreStraightLinesWithJumps) {
  for (const Vehicle<double>& v : {reference_vehicle(), without_inductance(reference_vehicle())}) {
    Simulation sampled(v, three_volts), pieces(v, three_volts);
    sampled.command({0.01, 0.05, 0.05, 0.08}, {1.0, 3.0, 2.0, 4.0});
    sampled.step_to(0.1);
    pieces.command(1.0);
    pieces.step_to(0.01);
    pieces.command([](double t) { return 1.0 + 2.0 * (t - 0.01) / 0.04; });
    pieces.step_to(0.05);
    pieces.command([](double t) { return 2.0 + 2.0 * (t - 0.05) / 0.03; });
    pieces.step_to(0.08);
    pieces.command(4.0);
    pieces.step_to(0.1);
    expect_same_place(sampled, pieces, 1e-7);
  }
}

/// Every kind of vehicle and of command.
std::vector<Simulation> one_of_each() {
  std::vector<Simulation> all;
  std::mt19937_64 random(5);
  Vehicle<double> swinging = reference_vehicle();
  swinging.spring.stiffness = 0.02;
  swinging.motor.friction_torque = 1e-4;
  Vehicle<double> pitching_crank = reference_vehicle();
  pitching_crank.pitch = pitching_vehicle(2e-4).pitch;
  set_stops(pitching_crank.pitch.hinge, 0.5);
  for (const Vehicle<double>& v : {reference_vehicle(true), without_inductance(swinging), swinging, pitching_crank}) {
    all.emplace_back(v, three_volts);
    all.emplace_back(v, Supply<double>{SupplyType::pwm, 4.0, 500.0, 0.75});
  }
  for (int n = 0; n < 4; ++n) all.emplace_back(resolve(random_direct_design(random, n % 2 == 1)));
  for (int n = 0; n < 4; ++n) all.emplace_back(random_pitching_vehicle(random, n % 2 == 1));
  return all;
}

TEST(SteppedSimulation, GoesOnToTheSameBitsFromASavedState) {
  int number = 0;
  for (const Simulation& started : one_of_each()) {
    for (const bool commanded : {false, true}) {
      Simulation first = started, second = started;  // the second still at its start
      const auto command = [&](Simulation& s) {
        if (commanded) s.command({0.0, 0.04, 0.06}, {1.0, 5.0, -2.0});
      };
      command(first);
      first.step_to(0.0313);
      const SimulationState saved = first.save();
      std::vector<std::size_t> events;
      for (Simulation* s : {&first, &second}) {
        command(*s);
        s->restore(saved);
        EXPECT_EQ(s->save(), saved) << number;
        events.push_back(s->step_to(0.05).size() + s->step_to(0.08).size());
      }
      EXPECT_EQ(first.save(), second.save()) << number;
      EXPECT_EQ(events[0], events[1]) << number;
      EXPECT_EQ(first.time(), 0.08);
    }
    ++number;
  }
}

TEST(SteppedSimulation, StopsAtRevolutions) {
  for (const Vehicle<double>& v : {reference_vehicle(true), without_inductance(reference_vehicle())}) {
    Simulation simulation(v, three_volts), throughout(v, three_volts);
    std::vector<TransientEvent> seen;
    for (int turn = 1; turn <= 5; ++turn) {
      const std::vector<TransientEvent> events = simulation.step_to(1.0, {.until_event = Kind::revolution});
      ASSERT_EQ(events.back().kind, Kind::revolution);
      EXPECT_EQ(events.back().time, simulation.time());
      EXPECT_NEAR(simulation.state()[0], turn * two_pi, 1e-12 * turn);
      seen.push_back(events.back());
    }
    std::vector<TransientEvent> all = throughout.step_to(simulation.time() + 1e-3);
    std::erase_if(all, [](const TransientEvent& e) { return e.kind != Kind::revolution; });
    ASSERT_EQ(all.size(), 5u);
    for (int turn = 0; turn < 5; ++turn) EXPECT_NEAR(all[turn].time, seen[turn].time, 1e-9);
  }
}

TEST(SteppedSimulation, TellsWhatHappens) {
  Vehicle<double> sticking = reference_vehicle();
  sticking.motor.friction_torque = 1e-3;
  for (const Vehicle<double>& v : {sticking, without_inductance(sticking)}) {
    Simulation simulation(v);
    simulation.command(0.5);  // below what the friction holds
    EXPECT_TRUE(simulation.step_to(0.1).empty());
    EXPECT_TRUE(simulation.stands());
    const WaveformRow held = simulation.now();
    EXPECT_EQ(held.crank_speed, 0.0);
    EXPECT_NEAR(held.current, 0.5 / 9.0, 1e-9);
    EXPECT_NEAR(held.friction_torque, held.motor_torque, 1e-15);
    EXPECT_EQ(held.lift, 0.0);
    simulation.command(4.0);
    const auto events = simulation.step_to(1.0, {.until_event = Kind::revolution});
    ASSERT_GE(events.size(), 2u);
    EXPECT_EQ(events.front().kind, Kind::breakaway);
    EXPECT_FALSE(simulation.stands());
    simulation.command(0.0);
    bool rests = false;
    for (const TransientEvent& e : simulation.step_to(3.0)) rests |= e.kind == Kind::standstill;
    EXPECT_TRUE(rests);
    EXPECT_TRUE(simulation.stands());
  }
  Vehicle<double> jamming = reference_vehicle();
  jamming.motor.inertia = 1e-9;
  jamming.friction.radius = 3e-3;
  Simulation jams(jamming, three_volts);
  const auto events = jams.step_to(1.0);
  EXPECT_EQ(events.back().kind, Kind::jam);
  EXPECT_TRUE(jams.ended());
  const double end = jams.time();
  EXPECT_LT(end, 1.0);
  EXPECT_TRUE(jams.step_to(2.0).empty());
  EXPECT_EQ(jams.time(), end);

  Vehicle<double> stopped = pitching_vehicle(2e-4);
  set_stops(stopped.pitch.hinge, 0.5);
  Simulation hinged(stopped);
  int impacts = 0;
  for (const TransientEvent& e : hinged.step_to(0.3)) impacts += e.kind == Kind::stop_impact;
  EXPECT_GE(impacts, 8);  // two a period of 45 ms, once the swing has grown
}

TEST(SteppedSimulation, ThePwmSupplyGoesOnWhereTheClockIs) {
  const Supply<double> pwm{SupplyType::pwm, 4.0, 500.0, 0.75};
  Simulation simulation(reference_vehicle(), pwm);
  int switched = 0;
  for (const TransientEvent& e : simulation.step_to(0.0101)) switched += e.kind == Kind::supply_switch;
  EXPECT_EQ(switched, 10);
  simulation.command(3.0);
  for (const TransientEvent& e : simulation.step_to(0.0159)) EXPECT_NE(e.kind, Kind::supply_switch);
  simulation.release();
  EXPECT_EQ(simulation.now().voltage, 0.0);  // switched off at 0.0155
  auto events = simulation.step_to(0.0176);
  std::erase_if(events, [](const TransientEvent& e) { return e.kind != Kind::supply_switch; });
  ASSERT_EQ(events.size(), 2u);
  EXPECT_NEAR(events[0].time, 0.016, 1e-12);
  EXPECT_NEAR(events[1].time, 0.0175, 1e-12);
}

TEST(SteppedSimulation, StandsWhereItBeganWhenACommandThrows) {
  Simulation simulation(reference_vehicle(), three_volts);
  simulation.step_to(0.02);
  const SimulationState before = simulation.save();
  simulation.command([](double t) -> double {
    if (t > 0.04) throw std::runtime_error("no more");
    return 3.0;
  });
  EXPECT_THROW(simulation.step_to(0.1), std::runtime_error);
  EXPECT_EQ(simulation.save(), before);
  int steps = 0;
  EXPECT_THROW(simulation.step_to(0.1, {.check =
                                            [&] {
                                              if (++steps == 3) throw std::runtime_error("enough");
                                            }}),
               std::runtime_error);
  EXPECT_EQ(simulation.save(), before);
}

TEST(SteppedSimulation, WhatIsRefused) {
  Simulation simulation(reference_vehicle(), three_volts);
  const auto refused = [](const auto& act) {
    try {
      act();
    } catch (const ParameterError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(refused([&] { simulation.command({0.0, 1.0}, {3.0}); }),
            "voltage: must have as many samples as times, at least one");
  EXPECT_EQ(refused([&] { simulation.command({1.0, 0.0}, {3.0, 3.0}); }), "voltage: has times that fall");
  EXPECT_EQ(refused([&] { simulation.command(std::nan("")); }), "voltage: must be a finite number");
  simulation.step_to(0.02);
  EXPECT_EQ(refused([&] { simulation.step_to(0.01); }),
            "time: must not lie in the past: the simulation is at 0.02 s, got 0.01 s");
  EXPECT_TRUE(simulation.step_to(0.02).empty());
  EXPECT_EQ(refused([&] { simulation.restore(Simulation(pitching_vehicle(2e-4)).save()); }),
            "state: is that of another kind of vehicle");
  EXPECT_EQ(refused([&] { Simulation(reference_vehicle(), three_volts, {.tolerance = 1.0}); }),
            "tolerance: must be a number between 1e-12 and 1e-2");
}

}  // namespace
}  // namespace wingbeat
