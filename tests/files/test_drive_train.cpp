// Lists of gearboxes and batteries, and the screening of every combination against one-by-one solutions.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include <unistd.h>

#include "files/drive_train_parts.hpp"
#include "files/motor_catalogue.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;
using detail::StatedTable;
using testing::ElementsAre;
using testing::HasSubstr;
using Outcome = CombinationOutcome;

std::vector<GearboxCandidate> gearboxes(const std::string& text, bool weighed = true, const StatedTable& form = {}) {
  return detail::parse_gearboxes(text, "list.csv", form, weighed);
}
std::vector<BatteryCandidate> batteries(const std::string& text, bool weighed = true) {
  Design<double> design = reference_design();
  design.supply.type = SupplyType::battery;
  design.supply.battery.cell_voltage = 3.7;
  design.supply.battery.internal_resistance = 0.25;
  design.supply.battery.capacity = 100.0;
  return detail::parse_batteries(text, "list.csv", {}, weighed, design);
}
template <class Parse>
std::string complaint(const Parse& parse) {
  try {
    parse();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(GearboxList, NamesUnitsAndLimitsInUse) {
  const std::string expected_header =
      "Type;Reduction;Weight (g);Mass inertia [g cm2];Max efficiency [%];Max continuous torque [mN m];"
      "Intermittent torque [mN m];Max input speed [rpm]\n";
  const auto list = gearboxes(expected_header + "GP 6;3,9;1,8;0,0005;81;2,5;5;40000\n");
  ASSERT_EQ(list.size(), 1U);
  const GearboxCandidate& g = list[0];
  EXPECT_EQ(g.refused, "");
  EXPECT_EQ(g.model, "GP 6");
  EXPECT_NEAR(g.ratio, 3.9, 1e-12);
  EXPECT_NEAR(g.mass.value_or(0.0), 1.8e-3, 1e-15);
  EXPECT_NEAR(g.inertia, 5e-11, 1e-23);
  EXPECT_NEAR(g.efficiency, 0.81, 1e-12);
  EXPECT_NEAR(g.torque_continuous.value_or(0.0), 2.5e-3, 1e-15);
  EXPECT_NEAR(g.torque_peak.value_or(0.0), 5e-3, 1e-15);
  EXPECT_NEAR(g.speed_max.value_or(0.0), 40000.0 * two_pi / 60.0, 1e-9);
}

// Headers without units, SI, "inf" where there is no limit and "nan" where nothing is known.
TEST(GearboxList, OfTheMotorGearboxDatabase) {
  const auto list = gearboxes(
      "key,manufacturer,ID,type,stages,ratio,mass,inertia,efficiency,direction,max_int_torque,max_cont_torque\n"
      "FH_A_R14,Faulhaber,A_R14,planetary,2,14.1,0.0028,1e-10,0.8,1,0.12,0.06\n"
      "FH_B_R4,Faulhaber,B_R4,planetary,1,4,nan,nan,nan,1,inf,inf\n");
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].model, "FH_A_R14");
  EXPECT_EQ(list[0].torque_peak, 0.12);
  EXPECT_EQ(list[0].torque_continuous, 0.06);
  EXPECT_EQ(list[0].inertia, 1e-10);
  EXPECT_EQ(list[1].refused, "incomplete, no mass");
  EXPECT_FALSE(list[1].torque_peak);
  EXPECT_THAT(list[1].assumed, ElementsAre(HasSubstr("no efficiency stated"), HasSubstr("no inertia stated")));
  const auto motors = detail::parse_motor_catalogue(
      "key,manufacturer,ID,type,V,k_t,R,L,mass,inertia,omega_nl,I_nl,I_nom,max_int_torque,max_int_speed,max_cont_speed,"
      "max_cont_power,coulomb_friction,viscous_friction,Rth1,Rth2\n"
      "FH_0816,Faulhaber,0816K003SR,DC,3,0.00211,5.4,53e-6,0.0045,5.1e-9,1388,0.016,0.37,inf,inf,1500,inf,3.4e-5,nan,"
      "20,48\n",
      "motors.csv", 1.0, 0.002, reference_design());
  ASSERT_EQ(motors.size(), 1U);
  EXPECT_EQ(motors[0].refused, "");
  EXPECT_EQ(motors[0].model, "FH_0816");
  EXPECT_EQ(motors[0].design.motor.constants.torque_constant, 0.00211);
  EXPECT_EQ(motors[0].design.motor.constants.armature_inductance, 53e-6);
  EXPECT_EQ(motors[0].speed_max, 1500.0);
}

TEST(GearboxList, WhatCannotBeTriedSaysWhy) {
  const auto list = gearboxes("model,ratio,mass [g],efficiency\na,,1,0.9\nb,-3,1,0.9\nc,5,1,1.2\nd,5,,0.9\n");
  EXPECT_EQ(list[0].refused, "incomplete, no ratio");
  EXPECT_EQ(list[1].refused, "ratio must be > 0, got -3");
  EXPECT_EQ(list[2].refused, "efficiency must be > 0 and <= 1, got 1.2");
  EXPECT_EQ(list[3].refused, "incomplete, no mass");
  EXPECT_EQ(gearboxes("model,ratio\na,5\n", false)[0].refused, "");
  EXPECT_THAT(complaint([] { gearboxes("model,ratio,torque_peak\na,5,1\n"); }),
              HasSubstr("list.csv:1:13: torque_peak: names no unit; write torque_peak_N m or"));
  EXPECT_THAT(complaint([] { gearboxes("model,ratio,torque_peak [mN m]\na,5,-1\n"); }),
              HasSubstr("list.csv:2:5: torque_peak [mN m]: expected a limit > 0, got \"-1\""));
  EXPECT_THAT(complaint([] { gearboxes("model,weight [g]\na,5\n"); }),
              HasSubstr("ratio: missing; expected a column of that name, or gearboxes.columns"));
}

TEST(BatteryList, NamesAndUnitsInUse) {
  const auto list = batteries(
      "Name,Cells,Capacity (mAh),Cell resistance [mohm],Weight [g],C-rating\n2S 150,2,150,200,7.4,20\n"
      "half,1.5,150,200,1,5\n");
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].refused, "");
  EXPECT_EQ(list[0].cells, 2.0);
  EXPECT_NEAR(list[0].capacity, 540.0, 1e-9);
  EXPECT_NEAR(list[0].internal_resistance.value_or(0.0), 0.2, 1e-12);
  EXPECT_NEAR(list[0].mass.value_or(0.0), 7.4e-3, 1e-15);
  EXPECT_NEAR(list[0].current_max.value_or(0.0), 3.0, 1e-12);
  EXPECT_THAT(list[1].refused, HasSubstr("supply.cells: must be a whole number >= 1"));
}

TEST(Compatibility, IsByNamesAndTheirBeginnings) {
  DriveTrainSearch search;
  EXPECT_TRUE(go_together(search, "any", "any"));
  search.compatible = detail::parse_compatibility("# a remark\nM1, G_A*, G_B4\r\nM2,G_B4\n\n");
  EXPECT_TRUE(go_together(search, "M1", "G_A12"));
  EXPECT_TRUE(go_together(search, "M1", "G_B4"));
  EXPECT_FALSE(go_together(search, "M1", "G_B5"));
  EXPECT_FALSE(go_together(search, "M2", "G_A12"));
  EXPECT_FALSE(go_together(search, "M3", "G_A12"));
}

TEST(DriveTrain, PartsTakeTheirPlaces) {
  Design<double> d = reference_design();
  d.mass = 2e-3;
  d.masses.motor = 1e-3;
  d.motor.gear_ratio = 3.0;
  d.motor.gear_damping = 1e-7;
  d.supply.type = SupplyType::battery;
  d.supply.battery.specific_energy = 5e5;
  GearboxCandidate g;
  g.ratio = 12.0;
  g.inertia = 2e-10;
  g.efficiency = 0.81;
  g.mass = 0.5e-3;
  BatteryCandidate b;
  b.cells = 2.0;
  b.capacity = 360.0;
  b.mass = 4e-3;
  d = with_parts(d, &g, &b);
  EXPECT_EQ(d.motor.gear_ratio, 12.0);
  EXPECT_DOUBLE_EQ(d.motor.gear_inertia, 144.0 * 2e-10);
  EXPECT_EQ(d.motor.gear_damping, 0.0);
  EXPECT_EQ(d.motor.constants.gear_efficiency, 0.81);
  EXPECT_DOUBLE_EQ(*total_mass(d), 2e-3 + 1e-3 + 0.5e-3 + 4e-3);
}

/// Studies in a folder of their own, with lists of 3 motors, 4 gearboxes and 3 batteries.
class DriveTrains : public testing::Test {
 protected:
  DriveTrains() : folder_(fs::temp_directory_path() / ("drive-trains-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    write("motors.csv",
          "model,resistance_ohm,torque_constant_Nm_per_A,rotor_inertia_kgm2,inductance_H,friction_torque_Nm,"
          "viscous_friction_Nms,mass_kg,nominal_current_A\n"
          "small,6,0.8e-3,2e-9,1e-4,1e-4,1e-9,0.003,0.9\nlarge,2.9,0.92e-3,3e-9,1.16e-4,1.6e-4,1e-9,0.0045,1.2\n"
          "slow,20,4e-3,5e-9,2e-4,3e-5,1e-9,0.0045,0.2\n");
    write(
        "gearboxes.csv",
        "model,ratio,mass [g],inertia [kg m2],efficiency,torque_continuous [mN m],torque_peak [mN m],speed_max [rpm]\n"
        "g8,8,0.7,2e-10,0.9,1000,1000,60000\ng16,16,1,2e-10,0.81,1000,1000,60000\n"
        "g22,22,1.2,2e-10,0.81,1000,1000,60000\ng30,30,1.5,2e-10,0.81,1000,1000,25000\n");
    write("batteries.csv",
          "model,cells,capacity [mAh],internal_resistance [mohm],mass [g]\n1S,1,150,200,3.7\n1L,1,450,67,11.1\n"
          "2S,2,100,300,4.9\n");
  }
  ~DriveTrains() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  OptimiseFile study(const std::string& held, const std::string& rest) const {
    write("study.toml", "[study]\nvehicle = \"" + std::string(WINGBEAT_DATA) + "/designs/x-wing-battery.toml\"\n" +
                            held +
                            "[drive_train]\nmass_without = \"7 g\"\n[motors]\ncatalogue = \"motors.csv\"\n"
                            "[gearboxes]\ncatalogue = \"gearboxes.csv\"\n[batteries]\ncatalogue = \"batteries.csv\"\n" +
                            rest);
    return read_optimise_study(folder_ / "study.toml");
  }
  static DriveTrainScreen screened(const OptimiseFile& file, const std::vector<MotorTrial>& all,
                                   const GearTorqueLimits& torque = {}) {
    return screen_drive_trains(
        all.size(),
        [&](std::size_t n) {
          OptimiseStudy s = trial_study(file, all[n]);
          if (torque.any()) s.gear_torque = torque;
          return s;
        },
        1, start_up_in_time());
  }

  fs::path folder_;
};

/// One combination by the scalar solver and the metrics of its orbit, without the code of studies.
struct OneByOne {
  Outcome outcome = Outcome::does_not_flap;
  double objective = absent;
  GearTorque torque;
};
OneByOne alone(const OptimiseStudy& study) {
  OneByOne one;
  const Vehicle<double> vehicle = resolve(study.design, study.options.condition);
  const SteadyFlapping orbit =
      find_steady_flapping(vehicle, {.tolerance = 1e-8, .reporting = reporting_of(study.design)}, start_up_in_time());
  if (orbit.status != FlappingStatus::flapping) return one;
  one.outcome = Outcome::outside;
  if (domain_of(domain_excess(vehicle, orbit.metrics)).any()) return one;
  one.outcome = Outcome::within;
  one.objective = orbit.metrics[study.objective];
  one.torque = gear_torque(orbit);
  for (const MetricConstraint& c : study.constraints) {
    const double x = orbit.metrics[c.metric];
    if (c.at_least ? x < c.limit : x > c.limit) one.outcome = Outcome::excluded;
  }
  return one;
}

TEST_F(DriveTrains, TheScreeningAgreesWithEveryCombinationOnItsOwn) {
  const OptimiseFile file = study("",
                                  "[objective]\nminimise = \"power_electrical_w\"\n"
                                  "[[constraint]]\nmetric = \"lift_to_weight\"\nat_least = 0.8\n");
  const std::vector<MotorTrial> all = combinations_of(file);
  ASSERT_EQ(all.size(), 36U);
  const DriveTrainScreen screen = screened(file, all);
  std::size_t best = all.size();
  double least = HUGE_VAL;
  std::map<std::string, std::uint64_t> beyond;
  std::array<int, 4> outcomes{};
  for (std::size_t n = 0; n < all.size(); ++n) {
    const OptimiseStudy s = trial_study(file, all[n]);
    const OneByOne one = alone(s);
    ++outcomes[std::size_t(one.outcome)];
    EXPECT_EQ(int(screen.combinations[n].outcome), int(one.outcome)) << name_of(file, all[n]);
    if (std::isnan(one.objective)) continue;
    EXPECT_NEAR(screen.combinations[n].objective / one.objective, 1.0, 2e-4) << name_of(file, all[n]);
    if (one.outcome == Outcome::within && one.objective < least) {
      least = one.objective;
      best = n;
    }
  }
  // Every kind occurs, or the comparison would show little.
  EXPECT_GT(outcomes[std::size_t(Outcome::within)], 2);
  EXPECT_GT(outcomes[std::size_t(Outcome::excluded)], 2);
  ASSERT_FALSE(screen.ranking.empty());
  EXPECT_EQ(screen.ranking[0], best);
  std::uint64_t sum = 0;
  for (const std::uint64_t count : screen.outcomes) sum += count;
  EXPECT_EQ(sum, 36U);

  // The searches from the best of the screening end at the same one, with its numbers.
  DriveTrainScreen again;
  const std::vector<MotorTrial> trials = choose_drive_train(file, start_up_in_time(), {}, {}, again);
  const MotorTrial* winner = best_trial(file, trials);
  ASSERT_TRUE(winner);
  EXPECT_EQ(name_of(file, *winner), name_of(file, all[best]));
  EXPECT_NEAR(winner->result.point.metrics[Metric::power_electrical] / least, 1.0, 1e-6);
}

// At a held lift: by the voltage search of one design.
TEST_F(DriveTrains, AtAHeldLiftAsWell) {
  const OptimiseFile file =
      study("hold = { lift_to_weight = 1 }\n", "[objective]\nminimise = \"power_electrical_w\"\n");
  const std::vector<MotorTrial> all = combinations_of(file);
  const DriveTrainScreen screen = screened(file, all);
  int within = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const OptimiseStudy s = trial_study(file, all[n]);
    const DesignPoint one = design_point(s.design, s.options, {}, start_up_in_time());
    const bool flaps = one.status == SweepStatus::flapping && one.domain.none();
    const bool flapped =
        screen.combinations[n].outcome == Outcome::within || screen.combinations[n].outcome == Outcome::excluded;
    EXPECT_EQ(flapped, flaps) << name_of(file, all[n]);
    if (!flaps || !flapped) continue;
    ++within;
    EXPECT_NEAR(screen.combinations[n].objective / one.metrics[Metric::power_electrical], 1.0, 5e-4)
        << name_of(file, all[n]);
  }
  EXPECT_GT(within, 5);
}

TEST_F(DriveTrains, ATorqueLimitExcludesWhatItShould) {
  const OptimiseFile file = study("", "[objective]\nminimise = \"power_electrical_w\"\n");
  const std::vector<MotorTrial> all = combinations_of(file);
  std::vector<OneByOne> ones;
  std::vector<double> rms, peak;
  for (const MotorTrial& t : all) {
    ones.push_back(alone(trial_study(file, t)));
    if (ones.back().outcome != Outcome::within) continue;
    rms.push_back(ones.back().torque.rms);
    peak.push_back(ones.back().torque.peak);
  }
  ASSERT_GT(rms.size(), 8U);
  std::sort(rms.begin(), rms.end());
  std::sort(peak.begin(), peak.end());
  // Between two torques that occur.
  const GearTorqueLimits limits{0.5 * (rms[rms.size() / 2] + rms[rms.size() / 2 - 1]),
                                0.5 * (peak[3 * peak.size() / 4] + peak[3 * peak.size() / 4 - 1])};
  const DriveTrainScreen screen = screened(file, all, limits);
  std::uint64_t continuous = 0, momentary = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (ones[n].outcome != Outcome::within) continue;
    const bool over = ones[n].torque.rms > *limits.continuous, peaks = ones[n].torque.peak > *limits.peak;
    continuous += over;
    momentary += peaks;
    EXPECT_EQ(screen.combinations[n].outcome == Outcome::excluded, over || peaks) << name_of(file, all[n]);
  }
  const auto excluded = [&](const std::string& name) {
    for (const LimitCount& l : screen.limits) {
      if (l.limit == name) return l.excluded;
    }
    return std::uint64_t(-1);
  };
  EXPECT_GT(continuous, 0U);
  EXPECT_GT(momentary, 0U);
  EXPECT_EQ(excluded("continuous torque of the gearbox"), continuous);
  EXPECT_EQ(excluded("peak torque of the gearbox"), momentary);
}

TEST_F(DriveTrains, SpeedsAndCurrentsExcludeAndAreNamed) {
  const OptimiseFile file = study("", "[objective]\nminimise = \"power_electrical_w\"\n");
  const std::vector<MotorTrial> all = combinations_of(file);
  const DriveTrainScreen screen = screened(file, all);
  std::uint64_t fast = 0, strong = 0;
  for (const MotorTrial& t : all) {
    const OptimiseStudy s = trial_study(file, t);
    const RunResult run = run_design(s.design, {.tolerance = 1e-6});
    if (run.status != FlappingStatus::flapping || run.domain.any()) continue;
    const double motor_speed = run.metrics[Metric::crank_speed_max] * t.gearbox->ratio;
    fast += motor_speed > *t.gearbox->speed_max;
    strong += run.metrics[Metric::current_rms] > *t.motor->nominal_current;
  }
  std::map<std::string, std::uint64_t> counted;
  for (const LimitCount& l : screen.limits) counted[l.limit] = l.excluded;
  EXPECT_EQ(counted.at("speed of the gearbox"), fast);
  EXPECT_EQ(counted.at("nominal current of the motor"), strong);
  EXPECT_GT(fast, 0U);
  EXPECT_GT(strong, 0U);
  const std::string text = text_drive_trains(file, screen, {});
  EXPECT_THAT(text, HasSubstr("36 combinations of 3 motors, 4 gearboxes and 3 batteries"));
  EXPECT_THAT(text, HasSubstr("speed of the gearbox"));
}

TEST_F(DriveTrains, WhatAStudyMayNotAskIsRefused) {
  const std::string minimise = "[objective]\nminimise = \"power_electrical_w\"\n";
  const auto said = [&](const std::string& rest) { return complaint([&] { study("", minimise + rest); }); };
  EXPECT_THAT(said("[[parameter]]\nkey = \"motor.gear_ratio\"\nlower = 2\nupper = 9\n"),
              HasSubstr("motor.gear_ratio is stated by the list of gearboxes"));
  EXPECT_THAT(said("[[parameter]]\nkey = \"supply.capacity\"\nlower = 2\nupper = 9\n"),
              HasSubstr("supply.capacity is stated by the list of batteries"));
  write("batteries.csv", "model,cells,capacity [mAh]\na,1,100\n");
  EXPECT_THAT(said(""), HasSubstr("batteries.catalogue: holds no battery that can be tried: a: incomplete, no mass"));
}

}  // namespace
}  // namespace wingbeat
