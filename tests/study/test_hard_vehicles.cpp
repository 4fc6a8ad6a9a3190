// Vehicles whose orbits or start-ups once took half a minute: the right answer within a bounded amount of work.
#include <gtest/gtest.h>

#include <string>

#include "vehicle/wide_boxes.hpp"
#include "wingbeat/cycle/orbit_search.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/frequency_search.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {
namespace {

Vehicle<double> vehicle_of(const std::string& name) {
  return resolve(read_design(WINGBEAT_CASES "/" + name + ".toml"), Condition::air);
}

/// One solution at the temperature of the surroundings by orbit search alone, and what it took.
struct Searched {
  SteadyFlapping found;
  solver::WorkBudget work;
};
Searched search_alone(const Vehicle<double>& vehicle) {
  detail::SharedSearch shared;
  shared.work.limit = detail::search_work(vehicle);
  Searched result;
  result.found = detail::find_flapping_among(vehicle, {}, {}, shared);
  result.work = shared.work;
  return result;
}

TEST(HardVehicles, AllStartsShareTheWorkOfASearch) {
  for (const char* name : {"p136", "p221", "undecided-901-2"}) {
    const Searched s = search_alone(vehicle_of(name));
    EXPECT_EQ(s.found.status, FlappingStatus::flapping) << name;
    // What an iterate takes when the work is used up is not taken back.
    EXPECT_LT(s.work.used, s.work.limit + s.work.limit / 4) << name;
  }
}

TEST(HardVehicles, StiffHingeFlapsAsRigidWingsDo) {
  const Searched s = search_alone(vehicle_of("undecided-901-2"));
  ASSERT_EQ(s.found.status, FlappingStatus::flapping);
  EXPECT_NEAR(s.found.metrics[Metric::frequency], 5.89, 0.005);
}

TEST(HardVehicles, SearchEndsWhereItsWorkIsUsedUp) {
  detail::SharedSearch shared;
  shared.work.limit = 500;
  const SteadyFlapping found = detail::find_flapping_among(vehicle_of("p136"), {}, {}, shared);
  EXPECT_EQ(found.status, FlappingStatus::undecided);
  EXPECT_EQ(found.summary.status, solver::PeriodicStatus::out_of_work);
  EXPECT_LT(shared.work.used, 20000);
}

TEST(HardVehicles, LiftIsRefusedUnderThermalRunawayWithoutRefiningIt) {
  const Vehicle<double> v = vehicle_of("slow-lift-9");
  const FrequencySearch search = find_voltage_for_lift(v, 0.62, {}, start_up_in_time(), {.nominal = v.voltage});
  EXPECT_EQ(search.outcome, FrequencyOutcome::too_high);
  EXPECT_LT(search.evaluations, 200);
}

// Its pitch law turns the wings by several right angles; two crank speeds almost balance, of which few crank angles
// show one.
TEST(HardVehicles, OfTwoOrbitsItIsTheOneReachedFromRest) {
  const WideVehicle drawn = wide_vehicle(FarBox::crank_near_rod, 579);
  const SteadyFlapping found = find_steady_flapping(resolve(drawn.design, drawn.condition), {}, start_up_in_time());
  ASSERT_EQ(found.status, FlappingStatus::flapping);
  EXPECT_NEAR(found.metrics[Metric::frequency], 26.696, 0.001);
}

// At a third more than its voltage the wing turns over: no period repeats the one before, however many are waited for.
TEST(HardVehicles, MotionThatDoesNotRepeatIsGivenUpEarly) {
  Design<double> design = read_design(std::string(WINGBEAT_DATA) + "/designs/robobee-piezo.toml");
  design.supply.voltage = 120.0;
  const TransientResult found = simulate_start_up(resolve(design), {});
  EXPECT_EQ(found.status, FlappingStatus::undecided);
  EXPECT_EQ(found.evidence.kind, StatusEvidence::Kind::cycles_differ);
  EXPECT_EQ(found.evidence.cycles, 1000);
  EXPECT_GT(found.evidence.change, 0.1);
}

}  // namespace
}  // namespace wingbeat
