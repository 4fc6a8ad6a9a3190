#include <gmock/gmock.h>

#include <cmath>

#include "program.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;

const std::string battery = data + "/designs/friction2022-battery.toml";

class Endurance : public Program {};

TEST_F(Endurance, ReportJsonFigureAndDataSet) {
  const Outcome report = run({"endurance", battery, "--set", "supply.cells=2", "--set", "vehicle.mass=\"5 g\"", "-o",
                              path("flight.nc"), "--plot", path("flight.svg")});
  EXPECT_EQ(report.status, 0) << report.err;
  // Hover comes first, everywhere.
  EXPECT_THAT(report.out, testing::ContainsRegex("It hovers for 216.6 s, until lift falls below the weight at a charge "
                                                 "of[ \n]+0.04[56]"));
  EXPECT_THAT(report.out, testing::ContainsRegex("the[ \n]+battery is empty after"));
  EXPECT_LT(report.out.find("hovers for   "), report.out.find("flaps for   "));
  EXPECT_THAT(report.out, HasSubstr("lost inside the battery"));
  EXPECT_THAT(read(path("flight.svg")), HasSubstr("Hovers for 216.6 s, flaps for 228.5 s"));
  for (const char* name : {"mean lift", "weight, 49.03 mN", "electrical", "open circuit", "state of charge"}) {
    EXPECT_THAT(read(path("flight.svg")), HasSubstr(name));
  }

  const Json json =
      run({"endurance", battery, "--set", "supply.cells=2", "--set", "vehicle.mass=5e-3", "--json"}).json();
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(
      keys, testing::ElementsAre("status", "status_detail", "hover", "throttle", "hover_s", "lift_to_weight_full",
                                 "end", "endurance_s", "domain", "hover_lost", "charge_initial", "charge_final",
                                 "charge_drawn_c", "energy_chemical_j", "energy_electrical_j", "energy_internal_j",
                                 "energy_aerodynamic_j", "current_mean_a", "power_electrical_w", "power_aerodynamic_w",
                                 "lift_mean_n", "efficiency_system", "initial", "final", "history"));
  EXPECT_EQ(json["hover"], "lost");
  EXPECT_EQ(json["hover_s"], json["hover_lost"]["time_s"]);
  EXPECT_LT(json["hover_s"], json["endurance_s"]);
  EXPECT_NEAR(json["hover_lost"]["lift_to_weight"].get<double>(), 1.0, 1e-9);
  EXPECT_EQ(json["charge_drawn_c"], 108.0);
  const auto& history = json["history"];
  EXPECT_EQ(history["time_s"].back(), json["endurance_s"]);
  EXPECT_EQ(history["time_s"].size(), history["lift_mean_n"].size());

  const wingbeat::NetcdfReader file(path("flight.nc"));
  EXPECT_EQ(file.read("time_s").back(), json["endurance_s"].get<double>());
  EXPECT_EQ(file.read("charge").front(), 1.0);
  EXPECT_EQ(file.read("lift_to_weight").size(), history["time_s"].size());
  EXPECT_EQ(file.attribute("hover"), "lost");
  EXPECT_THAT(*file.attribute("end_detail"), HasSubstr("is empty after"));

  // The vehicle at that moment, computed by itself.
  const double charge = json["hover_lost"]["charge"].get<double>();
  const Json there = run({"run", battery, "--set", "supply.cells=2", "--set", "vehicle.mass=5e-3", "--set",
                          "supply.charge=" + Json(charge).dump(), "--tolerance", "1e-10", "--json"})
                         .json();
  EXPECT_NEAR(there["lift_to_weight"].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(there["voltage_v"].get<double>(), json["hover_lost"]["voltage_v"].get<double>(), 1e-9);
}

TEST_F(Endurance, LiftOverWeightIsThatOfAllMasses) {
  const std::vector<std::string> heavy = {
      "endurance", battery, "--set", "supply.cells=2", "--set", "supply.mass=\"5 g\"", "--set", "vehicle.mass=\"2 g\""};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = heavy;
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  };
  const Json json = with({"--json"}).json();
  const double mean = json["lift_mean_n"].get<double>() / (7e-3 * 9.80665);
  char row[80];
  std::snprintf(row, sizeof row, "  mean lift / weight    %14.4g%14.4g%14.4g\n",
                json["initial"]["lift_to_weight"].get<double>(), mean, json["final"]["lift_to_weight"].get<double>());
  EXPECT_THAT(with({"--plot", path("flight.svg")}).out, HasSubstr(row));
  EXPECT_THAT(read(path("flight.svg")), HasSubstr("weight, 68.65 mN"));
}

TEST_F(Endurance, ABatteryThatCannotStartTheVehicle) {
  const Outcome outcome = run({"endurance", battery, "--set", "supply.internal_resistance=\"800 ohm\"", "--set",
                               "motor.friction_torque=\"1 mN m\"", "--json", "--plot", path("flight.svg")});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(outcome.json()["end"], "never starts");
  EXPECT_EQ(outcome.json()["endurance_s"], 0.0);
  EXPECT_THAT(outcome.json()["status_detail"].get<std::string>(),
              HasSubstr("the battery cannot start the vehicle at a charge of 1 (4.2 V without load)"));
  EXPECT_THAT(outcome.err, HasSubstr("no file was written"));
  EXPECT_FALSE(fs::exists(path("flight.svg")));
}

TEST_F(Endurance, AVehicleThatNeverHoversSaysSo) {
  const Outcome outcome = run({"endurance", battery, "--plot", path("flaps.svg")});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("It does not hover: lift is 0.643"));
  EXPECT_LT(outcome.out.find("does not hover"), outcome.out.find("491.8"));
  EXPECT_THAT(outcome.out, HasSubstr("below weight from the start: cannot hover"));
  EXPECT_THAT(outcome.out, testing::Not(HasSubstr("light")));
  const std::string figure = read(path("flaps.svg"));
  EXPECT_THAT(figure, HasSubstr("Does not hover; flaps for 491.8 s"));
  EXPECT_THAT(figure, testing::Not(HasSubstr("Flight")));
  const Json json = run({"endurance", battery, "--json"}).json();
  EXPECT_EQ(json["hover_s"], 0.0);
  EXPECT_THAT(json["status_detail"].get<std::string>(), testing::StartsWith("it does not hover"));
}

TEST_F(Endurance, BadInput) {
  EXPECT_THAT(run({"endurance", plain}).err, HasSubstr("supply.type: only a battery runs down; expected battery"));
  EXPECT_EQ(run({"endurance", plain}).status, 2);
  EXPECT_THAT(run({"endurance", battery, "--plot", "flight.gif"}).err,
              HasSubstr("--plot flight.gif: the name must end in .svg, .pdf or .png"));
  EXPECT_THAT(run({"endurance", battery, "-o", "flight.csv"}).err,
              HasSubstr("-o flight.csv: the name must end in .nc"));
  EXPECT_THAT(run({"endurance", battery, "--set", "supply.charge=2"}).err,
              HasSubstr("supply.charge: must lie between 0 and 1 [1], got 2"));
}

TEST_F(Endurance, RunOnABattery) {
  const Json json = run({"run", battery, "--json"}).json();
  const double sag = 4.2 - 0.5 * json["current_mean_a"].get<double>();
  EXPECT_NEAR(json["voltage_v"].get<double>(), sag, 1e-12);
  EXPECT_THAT(
      run({"run", battery, "--voltage", "3 V"}).err,
      HasSubstr("--voltage: the supply is a battery, whose charge gives its voltage; use --set supply.charge=0.5"));
  const Json slower = run({"run", battery, "--frequency", "22 Hz", "--json"}).json();
  EXPECT_NEAR(slower["frequency_hz"].get<double>(), 22.0, 1e-4);
  EXPECT_LT(slower["supply_duty"].get<double>(), 1.0);
  EXPECT_THAT(run({"run", battery, "--lift-to-weight", "1"}).err,
              AllOf(HasSubstr("cannot be reached inside the domain of validity: it lifts 0.02106 N at most, at 4.2 V"),
                    HasSubstr("; a duty of 1 gives 4.2 V")));
}

TEST_F(Endurance, HoversAtTheThrottleThatCarriesTheWeight) {
  const std::vector<std::string> two_cells = {battery, "--set", "supply.cells=2", "--set", "vehicle.mass=5 g"};
  const auto with = [&](std::initializer_list<std::string> first, std::initializer_list<std::string> last) {
    std::vector<std::string> all(first);
    all.insert(all.end(), two_cells.begin(), two_cells.end());
    all.insert(all.end(), last);
    return all;
  };
  const Json fixed = run(with({"endurance"}, {"--json"})).json();
  const Json json = run(with({"endurance"}, {"--hover", "--json"})).json();
  EXPECT_EQ(json["throttle"], "hover");
  EXPECT_EQ(json["hover"], "kept");
  EXPECT_EQ(json["end"], "sinks");
  EXPECT_EQ(json["hover_s"], json["endurance_s"]);
  // It gives no lift away, and ends where the fixed one has lost hover.
  EXPECT_GT(json["hover_s"].get<double>(), fixed["hover_s"].get<double>());
  EXPECT_NEAR(json["charge_final"].get<double>(), fixed["hover_lost"]["charge"].get<double>(), 1e-6);
  const Json& history = json["history"];
  EXPECT_NEAR(history["lift_to_weight_full"].front().get<double>(), fixed["initial"]["lift_to_weight"].get<double>(),
              1e-6);
  EXPECT_NEAR(history["lift_to_weight_full"].back().get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(history["duty"].back().get<double>(), 1.0, 1e-6);
  EXPECT_EQ(history["domain_full"].size(), history["time_s"].size());
  const Json run_there = run(with({"run"}, {"--lift-to-weight", "1", "--json"})).json();
  EXPECT_NEAR(history["duty"].front().get<double>(), run_there["supply_duty"].get<double>(), 1e-6);

  const std::string text = run(with({"endurance"}, {"--hover"})).out;
  EXPECT_THAT(
      text, AllOf(HasSubstr("It hovers for "), HasSubstr("until full throttle no longer"), HasSubstr("at full duty")));
  // As a key of the vehicle it counts in every study, and in run.
  const Json metric = run(with({"run"}, {"--set", "supply.throttle=hover", "--endurance", "--json"})).json();
  EXPECT_NEAR(metric["hover_s"].get<double>() / json["hover_s"].get<double>(), 1.0, 1e-5);
  EXPECT_THAT(run({"endurance", battery, "--hover"}).out, HasSubstr("It does not hover: full throttle lifts 0.6"));
  EXPECT_THAT(run({"endurance", plain, "--hover"}).err, HasSubstr("only a battery runs down"));
  EXPECT_THAT(run({"run", plain, "--set", "supply.throttle=hover"}).err,
              HasSubstr("belongs to supply.type = battery or battery-sine"));
  EXPECT_THAT(run({"run", battery, "--set", "supply.throttle=full"}).err, HasSubstr("fixed or hover"));
}

TEST_F(Endurance, DutyForALift) {
  const std::vector<std::string> pwm = {"run",   plain,
                                        "--set", "supply.type=pwm",
                                        "--set", "supply.voltage=7",
                                        "--set", "supply.frequency=20000",
                                        "--set", "supply.duty=0.5"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = pwm;
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  };
  const Json json = with({"--lift", "20 mN", "--json"}).json();
  EXPECT_NEAR(json["lift_mean_n"].get<double>(), 0.02, 1e-7);
  EXPECT_NEAR(json["supply_duty"].get<double>(), json["voltage_v"].get<double>() / 7.0, 1e-12);
  const Json hover = with({"--lift-to-weight", "1", "--json"}).json();
  EXPECT_NEAR(hover["lift_to_weight"].get<double>(), 1.0, 1e-6);
  EXPECT_THAT(with({"--lift", "50 mN"}).err, HasSubstr("more than the 7 V that the supply gives at a duty of 1"));
  EXPECT_EQ(with({"--lift", "50 mN"}).status, 2);
  EXPECT_THAT(with({"--lift", "2 N"}).err, HasSubstr("--lift 2 N: 2 N cannot be reached"));
  EXPECT_THAT(with({"--lift", "0"}).err, HasSubstr("--lift: must be > 0 N"));
  EXPECT_THAT(with({"--lift", "2 V"}).err, HasSubstr("--lift: "));
  EXPECT_EQ(with({"--lift", "20 mN", "--frequency", "20 Hz"}).status, 2);
  const Json ripple = with({"--method", "transient", "--json"}).json();
  EXPECT_NEAR(ripple["start_up"]["current_ripple_a"].get<double>(), 7.0 * 0.25 / (29e-3 * 20e3), 1e-6);
}

TEST_F(Endurance, ALargerBatteryWeighsMore) {
  const auto flight = [&](const std::string& capacity) {
    const Outcome o = run({"endurance", battery, "--set", "supply.cells=2", "--set", "vehicle.mass=\"3 g\"", "--set",
                           "supply.specific_energy=160 W h/kg", "--set", "supply.capacity=" + capacity, "--json"});
    EXPECT_EQ(o.status, 0) << o.err;
    return o.json();
  };
  const Json small = flight("30 mA h"), large = flight("60 mA h"), heavy = flight("600 mA h");
  EXPECT_NEAR(large["endurance_s"].get<double>() / small["endurance_s"].get<double>(), 2.0, 1e-6);
  EXPECT_LT(large["initial"]["lift_to_weight"].get<double>(), small["initial"]["lift_to_weight"].get<double>());
  EXPECT_EQ(heavy["hover"], "never");
  const Outcome both = run({"run", battery, "--set", "supply.specific_energy=160 W h/kg", "--set", "supply.mass=1 g"});
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("not both"));
}

TEST_F(Endurance, OfADirectDriveThroughABridge) {
  const std::vector<std::string> fed = {
      "--set", "supply.type=battery-sine",           "--set", "supply.cell_voltage=3.7 V",
      "--set", "supply.internal_resistance=0.5 ohm", "--set", "supply.capacity=30 mA h"};
  const auto with = [&](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), fed.begin(), fed.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  const std::string direct = data + "/designs/direct-drive.toml";
  const Outcome flight = with({"endurance", direct}, {"--json"});
  ASSERT_EQ(flight.status, 0) << flight.err;
  const Json json = flight.json();
  EXPECT_EQ(json["end"], "empty");
  const double power = run({"run", direct, "--json"}).json()["power_electrical_w"].get<double>();
  EXPECT_NEAR(json["power_electrical_w"].get<double>(), power, 1e-5 * power);
  EXPECT_EQ(json["history"]["terminal_voltage_v"].size(), json["history"]["time_s"].size());
  EXPECT_THAT(with({"endurance", direct}, {}).out, HasSubstr("terminal voltage"));
  const Outcome high = with({"run", direct}, {"--set", "supply.amplitude=4 V"});
  EXPECT_EQ(high.status, 2);
  EXPECT_THAT(high.err, HasSubstr("4 V exceed what the bridge has from the battery, 3.7 V without load"));
}

/// The endurance of the shipped battery as runs, sweeps and optima tell it.
TEST_F(Endurance, AsAMetric) {
  const double flight = run({"endurance", battery, "--json"}).json()["endurance_s"].get<double>();
  const Json asked = run({"run", battery, "--endurance", "--json"}).json();
  EXPECT_NEAR(asked["endurance_s"].get<double>(), flight, 1e-5 * flight);
  EXPECT_EQ(asked["hover_s"], 0.0);
  const Outcome text = run({"run", battery, "--endurance"});
  EXPECT_THAT(text.out, testing::ContainsRegex("hovers for +never +does not hover\n +flaps for +491.8 s"));
  const Json plainly = run({"run", battery, "--json"}).json();  // no flight unless asked for
  EXPECT_TRUE(plainly["endurance_s"].is_null());
  EXPECT_TRUE(plainly["hover_s"].is_null());
  const Outcome refused = run({"run", plain, "--endurance"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("--endurance: only a battery runs down: supply.type is constant"));

  const auto study = [&](const std::string& vehicle, const std::string& more, const std::string& sections) {
    std::ofstream(path("study.toml")) << "[study]\nvehicle = \"" << vehicle << "\"\n" << more << sections;
    return path("study.toml");
  };
  const std::string axis = "[[axis]]\nkey = \"supply.capacity\"\nvalues = [\"30 mA h\", \"60 mA h\"]\n";
  const std::string named = "metrics = [\"endurance_s\", \"lift_to_weight\"]\n";
  ASSERT_EQ(run({"sweep", study(battery, named, axis), "-o", path("named.nc")}).status, 0);
  const auto time = wingbeat::NetcdfReader(path("named.nc")).read("endurance_s");
  ASSERT_EQ(time.size(), 2U);
  EXPECT_NEAR(time[0], flight, 1e-5 * flight);
  EXPECT_NEAR(time[1], 2.0 * flight, 2e-5 * flight);
  EXPECT_EQ(wingbeat::NetcdfReader(path("named.nc")).read("hover_s"), std::vector<double>({0.0, 0.0}));
  ASSERT_EQ(run({"sweep", study(battery, "", axis), "-o", path("all.nc")}).status, 0);
  EXPECT_EQ(read(path("all.nc")).find("endurance_s"), std::string::npos);

  const std::string capacity =
      "[objective]\nmaximise = \"endurance_s\"\nstarts = 2\nscreen = 16\n"
      "[[parameter]]\nkey = \"spring.stiffness\"\nlower = 1e-3\nupper = 2e-3\n";
  const Outcome none = run({"optimise", study(plain, "", capacity)});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("endurance_s needs supply.type = \"battery\" in the vehicle file"));
  const Outcome best = run({"optimise", study(battery, "count_after_hover = true\n", capacity), "--json"});
  ASSERT_EQ(best.status, 0) << best.err;
  const Json json = best.json();
  EXPECT_EQ(json["objective"], "endurance_s");
  EXPECT_GT(json["value"].get<double>(), 0.9 * flight);
  EXPECT_EQ(json["value"], json["metrics"]["endurance_s"]);
}

/// What an optimum of the endurance counts: the time for which lift carries the weight, unless the study says
/// otherwise.
TEST_F(Endurance, AnOptimumCountsWhileTheVehicleHovers) {
  const auto study = [&](const std::string& more, const std::string& metric, const std::string& set) {
    std::ofstream(path("study.toml")) << "[study]\nvehicle = \"" << battery << "\"\n"
                                      << more << set << "[objective]\nmaximise = \"" << metric
                                      << "\"\nstarts = 2\nscreen = 16\n"
                                      << "[[parameter]]\nkey = \"supply.capacity\"\nlower = \"20 mA h\"\n"
                                      << "upper = \"100 mA h\"\n";
    return path("study.toml");
  };
  const std::string two =
      "[set]\nsupply.cells = 2\nvehicle.mass = \"2.5 g\"\nsupply.specific_energy = "
      "\"160 W h/kg\"\n";
  const Outcome o = run({"optimise", study("", "endurance_s", two), "--json", "-o", path("best.toml")});
  ASSERT_EQ(o.status, 0) << o.err;
  const Json json = o.json();
  EXPECT_EQ(json["objective"], "hover_s");
  EXPECT_EQ(json["value"], json["metrics"]["hover_s"]);
  const Json flight = run({"endurance", path("best.toml"), "--json"}).json();
  EXPECT_NEAR(json["value"].get<double>(), flight["hover_s"].get<double>(), 1e-5 * flight["hover_s"].get<double>());
  // More or less capacity hovers for a shorter time.
  for (const double factor : {0.97, 1.03}) {
    const double capacity = factor * json["parameters"]["supply.capacity"].get<double>();
    const Json other =
        run({"endurance", path("best.toml"), "--set", "supply.capacity=" + Json(capacity).dump(), "--json"}).json();
    EXPECT_LT(other["hover_s"].get<double>(), json["value"].get<double>()) << factor;
  }
  EXPECT_THAT(run({"optimise", study("", "endurance_s", two)}).out,
              HasSubstr("most flight time until lift falls below the weight: "));
  const Json all = run({"optimise", study("count_after_hover = true\n", "endurance_s", two), "--json"}).json();
  EXPECT_EQ(all["objective"], "endurance_s");
  EXPECT_GT(all["value"].get<double>(), json["value"].get<double>());

  const Outcome useless = run({"optimise", study("count_after_hover = true\n", "lift_mean_n", "")});
  EXPECT_EQ(useless.status, 2);
  EXPECT_THAT(useless.err, HasSubstr("study.count_after_hover: does not apply here: neither the objective nor a "
                                     "constraint is endurance_s"));
  std::string weightless = read(battery);
  weightless.erase(weightless.find("mass = "),
                   weightless.find('\n', weightless.find("mass = ")) - weightless.find("mass = "));
  std::ofstream(path("weightless.toml")) << weightless;
  std::ofstream(path("unknown.toml")) << "[study]\nvehicle = \"weightless.toml\"\n[objective]\n"
                                      << "maximise = \"endurance_s\"\n[[parameter]]\nkey = \"spring.stiffness\"\n"
                                      << "lower = 1e-3\nupper = 2e-3\n";
  const Outcome unknown = run({"optimise", path("unknown.toml")});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("endurance_s counts while lift carries the weight, which needs vehicle.mass"));
  std::ofstream(path("sweep.toml")) << "[study]\nvehicle = \"" << battery << "\"\ncount_after_hover = true\n"
                                    << "[[axis]]\nkey = \"supply.charge\"\nvalues = [1, 0.5]\n";
  EXPECT_THAT(run({"sweep", path("sweep.toml"), "-o", path("s.nc")}).err,
              HasSubstr("study.count_after_hover: unknown key"));
}

TEST_F(Endurance, TheLongestFlightOnTwoCells) {
  // By one start of the four, from the best of fewer vehicles.
  std::string study = read(data + "/studies/optimise-endurance.toml");
  for (const auto& [words, by] : {std::pair<std::string, std::string>("starts = 4", "starts = 1"),
                                  {"screen = 128", "screen = 32"},
                                  {"../designs/friction2022-battery.toml", battery}}) {
    ASSERT_EQ(count_of(study, words), 1U) << words;
    study.replace(study.find(words), words.size(), by);
  }
  std::ofstream(path("study.toml")) << study;
  const Outcome o = run({"optimise", path("study.toml"), "--json", "-o", path("best.toml")});
  ASSERT_EQ(o.status, 0) << o.err;
  const Json json = o.json();
  EXPECT_EQ(json["active"][0]["limit"], "lift_to_weight >= 1.2");
  EXPECT_NEAR(json["metrics"]["lift_to_weight"].get<double>(), 1.2, 1e-4);
  const double flight = run({"endurance", path("best.toml"), "--json"}).json()["hover_s"].get<double>();
  EXPECT_NEAR(json["value"].get<double>(), flight, 1e-5 * flight);
}

}  // namespace
