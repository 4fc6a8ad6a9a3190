// Winding temperature as users meet it: files, runs, sweeps, optima, flights.
#include <gmock/gmock.h>

#include <cmath>

#include "program.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace cli {
namespace {

using testing::HasSubstr;

const std::string battery = data + "/designs/friction2022-battery.toml";

class MotorHeat : public Program {
 protected:
  MotorHeat() { write("warm.toml", thermal); }

  /// A vehicle file with these lines in its section [motor].
  static std::string with(const std::string& file, const std::string& lines) {
    std::string text = read(file);
    return text.insert(text.find("[motor]\n") + 8, lines);
  }
  void write(const std::string& name, const std::string& lines) const {
    std::ofstream(path(name)) << with(plain, lines);
  }
  std::string complaint(const std::string& lines) const {
    write("bad.toml", lines);
    const Outcome o = run({"run", path("bad.toml")});
    EXPECT_EQ(o.status, 2) << o.err;
    return o.err;
  }

  const std::string thermal = "thermal_resistance_winding = \"20 K/W\"\nthermal_resistance_case = \"48 K/W\"\n";
};

TEST_F(MotorHeat, ARunTellsTheTemperatures) {
  const Json warm = run({"run", path("warm.toml"), "--json"}).json(), cold = run({"run", plain, "--json"}).json();
  EXPECT_TRUE(cold["winding_temperature_degc"].is_null());
  EXPECT_NEAR(warm["winding_temperature_degc"].get<double>(), 45.0, 5.0);
  EXPECT_LT(warm["case_temperature_degc"], warm["winding_temperature_degc"]);
  EXPECT_NEAR(warm["winding_temperature_margin_k"].get<double>(),
              125.0 - warm["winding_temperature_degc"].get<double>(), 1e-9);
  EXPECT_THAT(warm["warnings"].dump(), testing::Not(HasSubstr("winding")));
  EXPECT_LT(warm["lift_mean_n"].get<double>(), 0.95 * cold["lift_mean_n"].get<double>());
  const Outcome text = run({"run", path("warm.toml"), "--set", "motor.winding_temperature_max=40 degC"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("OUTSIDE THE MODEL'S DOMAIN (winding_temperature): the winding heats up to "));
  EXPECT_THAT(text.out, HasSubstr("winding temperature"));
  EXPECT_THAT(text.out, HasSubstr("K above the largest allowed"));
}

/// A winding far above what insulation stands hovers nowhere: in a run, a search, an optimum or on a battery.
TEST_F(MotorHeat, AGlowingWindingDoesNotHover) {
  const std::vector<std::string> hot = {"run", path("warm.toml"), "--voltage", "9 V", "--set", "vehicle.mass=0.5 g"};
  std::vector<std::string> as_json = hot, longer = hot;
  as_json.emplace_back("--json");
  const Json json = run(as_json).json();
  EXPECT_GT(json["winding_temperature_degc"].get<double>(), 150.0);
  EXPECT_GT(json["lift_to_weight"].get<double>(), 1.0);
  EXPECT_THAT(json["domain"].get<std::string>(), HasSubstr("winding_temperature"));
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("above motor.winding_temperature_max = 125 degC"));
  EXPECT_THAT(run(hot).out, testing::Not(HasSubstr("can hover")));
  for (const char* more :
       {"--set", "motor.winding_temperature_max=400 degC", "--set", "aerodynamics.pitch_coefficient=0"})
    longer.emplace_back(more);
  EXPECT_THAT(run(longer).out, testing::Not(HasSubstr("winding heats up")));
  std::ofstream(path("study.toml")) << "[study]\nvehicle = \"warm.toml\"\n[objective]\nmaximise = \"lift_mean_n\"\n"
                                    << "[[parameter]]\nkey = \"supply.voltage\"\nlower = \"1 V\"\nupper = \"9 V\"\n";
  const Json best = run({"optimise", path("study.toml"), "--json"}).json();
  EXPECT_LE(best["metrics"]["winding_temperature_degc"].get<double>(), 125.0);
}

TEST_F(MotorHeat, TransientRouteAgrees) {
  const Json orbit = run({"run", path("warm.toml"), "--json"}).json();
  const Json time = run({"run", path("warm.toml"), "--method", "transient", "--json"}).json();
  for (const char* key : {"winding_temperature_degc", "lift_mean_n", "frequency_hz", "current_rms_a"}) {
    EXPECT_NEAR(time[key].get<double>() / orbit[key].get<double>(), 1.0, 1e-5) << key;
  }
}

TEST_F(MotorHeat, BadInputIsNamed) {
  EXPECT_THAT(complaint("thermal_resistance_case = \"48 K/W\"\n"),
              HasSubstr("motor.thermal_resistance_case: needs motor.thermal_resistance_winding, which is not given"));
  EXPECT_THAT(complaint("thermal_resistance_winding = \"20 K/W\"\n"),
              HasSubstr("motor.thermal_resistance_case: missing in [motor]; expected a thermal resistance such "
                        "as \"20 K/W\""));
  EXPECT_THAT(complaint(thermal + "ambient_temperature = 25\n"),
              HasSubstr("must lie between -100 and 727 degC, 173.15 and 1000 [K], got 25"));
  EXPECT_THAT(complaint(thermal + "ambient_temperature = \"25 mm\"\n"),
              HasSubstr("expected a temperature such as \"25 degC\", got \"25 mm\""));
  EXPECT_THAT(complaint(thermal + "copper_temperature_coefficient = \"-0.1 1/K\"\n"), HasSubstr("must be >= 0"));
  EXPECT_THAT(complaint(thermal + "thermal_time_constant_winding = \"3 s\"\n"),
              HasSubstr("motor.thermal_time_constant_case: missing: give both thermal time constants"));
  EXPECT_THAT(complaint(thermal + "ambient = \"25 degC\"\n"), HasSubstr("motor.ambient: unknown key"));
}

TEST_F(MotorHeat, TemperaturesMayStandInAnyUnit) {
  const auto lift_at = [&](const std::string& ambient) {
    return run({"run", path("warm.toml"), "--set", "motor.ambient_temperature=" + ambient, "--json"})
        .json()["lift_mean_n"]
        .get<double>();
  };
  EXPECT_NEAR(lift_at("40 degC"), lift_at("313.15 K"), 1e-12);
  EXPECT_NEAR(lift_at("104 degF"), lift_at("313.15 K"), 1e-12);
}

TEST_F(MotorHeat, ASweepOverTheAmbientTemperature) {
  std::ofstream(path("study.toml")) << "[study]\nvehicle = \"warm.toml\"\n\n[[axis]]\n"
                                       "key = \"motor.ambient_temperature\"\n"
                                       "from = \"-10 degC\"\nto = \"50 degC\"\ncount = 7\n";
  const Outcome sweep = run({"sweep", path("study.toml"), "-o", path("sweep.nc"), "--plot", path("sweep.svg")});
  ASSERT_EQ(sweep.status, 0) << sweep.err;
  const wingbeat::NetcdfReader file(path("sweep.nc"));
  const auto lift = file.read("lift_mean_n"), T_w = file.read("winding_temperature_degc");
  const auto recomputed = file.read("recomputed");
  ASSERT_EQ(lift.size(), 7U);
  for (std::size_t n = 1; n < lift.size(); ++n) {
    EXPECT_LT(lift[n], lift[n - 1]);
    EXPECT_GT(T_w[n], T_w[n - 1]);
  }
  const Json at_20 = run({"run", path("warm.toml"), "--set", "motor.ambient_temperature=20 degC", "--json"}).json();
  EXPECT_NEAR(lift[3] / at_20["lift_mean_n"].get<double>(), 1.0, 2e-6);
  EXPECT_NEAR(T_w[3], at_20["winding_temperature_degc"].get<double>(), 1e-3);
}

TEST_F(MotorHeat, ALimitOfAnOptimum) {
  const std::string common =
      "[study]\nvehicle = \"warm.toml\"\n[objective]\nmaximise = \"lift_mean_n\"\n"
      "[[parameter]]\nkey = \"supply.voltage\"\nlower = \"1 V\"\nupper = \"4.5 V\"\n"
      "[[constraint]]\nmetric = \"winding_temperature_degc\"\nat_most = \"50 degC\"\n";
  std::ofstream(path("study.toml")) << common;
  const Outcome o = run({"optimise", path("study.toml"), "--json"});
  ASSERT_EQ(o.status, 0) << o.err;
  std::ofstream(path("margin.toml"))
      << common.substr(0, common.find("[[constraint]]"))
      << "[set]\nmotor.winding_temperature_max = \"50 degC\"\n"
         "[[constraint]]\nmetric = \"winding_temperature_margin_k\"\nat_least = \"0 K\"\n";
  const Outcome margin = run({"optimise", path("margin.toml"), "--json"});
  ASSERT_EQ(margin.status, 0) << margin.err;
  // Limits of the domain are kept by 1e-5 more.
  EXPECT_NEAR(margin.json()["value"].get<double>() / o.json()["value"].get<double>(), 1.0, 3e-4);
  EXPECT_EQ(run({"optimise", path("study.toml"), "-o", path("best.toml")}).status, 0);
  const Json best = run({"run", path("best.toml"), "--json"}).json();
  EXPECT_NEAR(best["winding_temperature_degc"].get<double>(), 50.0, 0.01);
  // A vehicle that says nothing of heat has no such limit.
  std::ofstream(path("plain.toml")) << read(plain);
  std::string cold = common;
  cold.replace(cold.find("warm.toml"), 9, "plain.toml");
  std::ofstream(path("cold.toml")) << cold;
  EXPECT_THAT(run({"optimise", path("cold.toml")}).err,
              HasSubstr("winding_temperature_degc needs motor.thermal_resistance_winding in the vehicle file"));
}

TEST_F(MotorHeat, AFlightWarmsUp) {
  std::ofstream(path("settled.toml")) << with(battery, thermal);
  std::ofstream(path("slow.toml")) << with(
      battery, thermal + "thermal_time_constant_winding = \"3 s\"\nthermal_time_constant_case = \"120 s\"\n");
  std::ofstream(path("fast.toml")) << with(
      battery, thermal + "thermal_time_constant_winding = \"1 s\"\nthermal_time_constant_case = \"1 s\"\n");
  const Json cold = run({"endurance", battery, "--json"}).json();
  const Json settled = run({"endurance", path("settled.toml"), "--json"}).json();
  const Outcome text = run({"endurance", path("slow.toml"), "-o", path("flight.nc")});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("winding temperature"));
  const Json slow = run({"endurance", path("slow.toml"), "--json"}).json();
  const Json fast = run({"endurance", path("fast.toml"), "--json"}).json();
  const auto time_of = [](const Json& j) { return j["endurance_s"].get<double>(); };
  const auto T_w = [](const Json& j, const char* when) { return j[when]["winding_temperature_degc"].get<double>(); };
  EXPECT_NEAR(T_w(slow, "initial"), 25.0, 1e-9);
  EXPECT_GT(T_w(slow, "final"), 30.0);
  // A warm motor draws less current: between the cold flight and the one that is warm from the start.
  EXPECT_GT(time_of(slow), time_of(cold));
  EXPECT_LT(time_of(slow), time_of(settled));
  EXPECT_NEAR(time_of(fast) / time_of(settled), 1.0, 1e-2);
  EXPECT_GT(time_of(fast), time_of(slow));
  const wingbeat::NetcdfReader file(path("flight.nc"));
  const auto over_time = file.read("winding_temperature_degc");
  EXPECT_EQ(over_time.size(), slow["history"]["winding_temperature_degc"].size());
  EXPECT_GT(over_time[over_time.size() / 3], over_time.front() + 5.0);
}

}  // namespace
}  // namespace cli
