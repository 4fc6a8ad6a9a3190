// wingbeat run --lift, --lift-to-weight and --frequency: the voltage for a target, or why there is none.
#include <gmock/gmock.h>

#include <sys/resource.h>

#include "cli/program.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;
using testing::MatchesRegex;

/// Processor time of the programs run so far [s].
double children_time() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

class Targets : public Program {
 protected:
  /// The vehicle of docs/tutorials/own-vehicle.md, with springs.
  Targets() {
    const std::string page = read(data + "/../docs/tutorials/own-vehicle.md");
    const std::size_t start = page.find("```toml\n") + 8;
    std::ofstream(path("flapper.toml")) << page.substr(start, page.find("```", start) - start)
                                        << "\n[spring]\nstiffness = \"1e-3 N m/rad\"\n";
  }
  Outcome flapper(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"run", path("flapper.toml")});
    return run(arguments);
  }
};

TEST_F(Targets, HoverIsTheLowestVoltage) {
  const Outcome o = flapper({"--lift-to-weight", "1", "--json"});
  ASSERT_EQ(o.status, 0) << o.err;
  const Json json = o.json();
  EXPECT_NEAR(json["lift_to_weight"].get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(json["voltage_v"].get<double>(), 9.5, 0.01);
  EXPECT_NEAR(json["power_electrical_w"].get<double>(), 0.97, 0.005);
  EXPECT_GT(json["angle_of_attack_min_deg"].get<double>(), 0.0);
}

TEST_F(Targets, LiftAboveThePeakIsRefusedWithThePeak) {
  const Outcome o = flapper({"--lift", "100 mN"});
  EXPECT_EQ(o.status, 2);
  EXPECT_EQ(o.out, "");
  EXPECT_THAT(o.err,
              MatchesRegex("wingbeat: --lift 100 mN: 0.1 N cannot be reached inside the domain of validity: it lifts "
                           "0.09[0-9]* N at most, at 10.[0-9]+ V; at [0-9.]+ V the angle of attack falls to "
                           "-[0-9.]+ deg .*; --allow-extrapolation searches beyond\n"));
  const Outcome beyond = flapper({"--lift", "100 mN", "--allow-extrapolation", "--json"});
  ASSERT_EQ(beyond.status, 0) << beyond.err;
  EXPECT_LT(beyond.json()["angle_of_attack_min_deg"].get<double>(), 0.0);
}

TEST_F(Targets, TheAngleOfAttackIsFoundByThePitchCoefficient) {
  const Outcome o = flapper({"--angle-of-attack", "45 deg", "--lift-to-weight", "1"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("smallest angle of attack             45.00 deg\n  pitch_coefficient "));
  EXPECT_THAT(o.out, HasSubstr(" ms   that was found\n"));
  EXPECT_THAT(o.out, HasSubstr("mean lift / weight                           1"));
  EXPECT_EQ(flapper({"--angle-of-attack", "95 deg"}).err, "wingbeat: --angle-of-attack: must be > 0 deg, < 90 deg\n");
  const Outcome hinge = run({"run", "pitch-hinge", "--angle-of-attack", "45 deg"});
  EXPECT_EQ(hinge.status, 2);
  EXPECT_THAT(hinge.err, HasSubstr("angle_of_attack: follows from the hinge"));
}

TEST_F(Targets, AVehicleStatesTheAngleOfAttack) {
  const std::vector<std::string> key = {"--set", "aerodynamics.angle_of_attack=45 deg"};
  const Outcome by_key = flapper({"--lift-to-weight", "1", key[0], key[1]});
  ASSERT_EQ(by_key.status, 0) << by_key.err;
  EXPECT_EQ(by_key.out, flapper({"--angle-of-attack", "45 deg", "--lift-to-weight", "1"}).out);
  const Outcome both = flapper({key[0], key[1], key[0], "aerodynamics.angle_of_attack_min=30 deg"});
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err,
              HasSubstr("aerodynamics.angle_of_attack: is held by the stop angle_of_attack_min whatever C_alpha is; "
                        "give pitch_coefficient beside it"));
  // What goes through many operating points with one C_alpha.
  const Outcome fmu = run({"export-fmu", path("flapper.toml"), key[0], key[1], "-o", path("flapper.fmu")});
  EXPECT_EQ(fmu.status, 2);
  EXPECT_THAT(fmu.err, HasSubstr("aerodynamics.angle_of_attack: stands for a C_alpha that this does not find; give "
                                 "aerodynamics.pitch_coefficient instead, which wingbeat run prints for the vehicle"));
}

TEST_F(Targets, ThePowerIsFoundByTheVoltage) {
  const Json json = flapper({"--power", "500 mW", "--json"}).json();
  EXPECT_NEAR(json["power_electrical_w"].get<double>(), 0.5, 1e-6);
  const Outcome much = flapper({"--power", "1 kW"});
  EXPECT_EQ(much.status, 2);
  EXPECT_THAT(much.err, HasSubstr("--power 1 kW: 1000 W cannot be reached inside the domain of validity: at "));
  EXPECT_THAT(flapper({"--power", "0 W"}).err, HasSubstr("--power: must be > 0 W"));
  EXPECT_THAT(flapper({"--power", "1 W", "--lift", "1 mN"}).err, HasSubstr("--lift excludes --power"));
}

// By stated laws, in a file that runs.
TEST_F(Targets, ScaleWritesALargerVehicle) {
  const Outcome o = run({"scale", path("flapper.toml"), "--wing", "1.1", "-o", path("larger.toml")});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("wing.planform.length"));
  EXPECT_THAT(read(path("larger.toml")), HasSubstr("with wings 1.1 times as large"));
  EXPECT_EQ(run({"run", path("larger.toml")}).status, 0);
  // As large by one number of the vehicle.
  const Json larger = run({"run", path("larger.toml"), "--json"}).json();
  const Json scaled = flapper({"--set", "wing.planform.scale=1.1", "--json"}).json();
  EXPECT_NEAR(scaled["lift_mean_n"].get<double>() / larger["lift_mean_n"].get<double>(), 1.0, 1e-6);
  EXPECT_EQ(flapper({"--set", "wing.planform.scale=0"}).status, 2);
  const Json json = run({"scale", path("flapper.toml"), "--vehicle", "0.5", "--json"}).json();
  EXPECT_EQ(json["factor"], 0.5);
  for (const Json& p : json["parameters"]) {
    EXPECT_NEAR(p["after"].get<double>(), p["before"].get<double>() * std::pow(0.5, p["exponent"].get<double>()),
                1e-12 * std::abs(p["after"].get<double>()));
  }
  EXPECT_THAT(run({"scale", path("flapper.toml")}).err, HasSubstr("give --wing FACTOR or --vehicle FACTOR"));
  EXPECT_THAT(run({"scale", path("flapper.toml"), "--wing", "-1"}).err,
              HasSubstr("--wing: must lie between 0.001 and 1000, got -1"));
}

TEST_F(Targets, PwmReachesItByItsDuty) {
  const std::string pwm = "supply={type=\"pwm\", voltage=\"12 V\", duty=0.2, frequency=\"20 kHz\"}";
  const Outcome o = flapper({"--lift-to-weight", "1", "--json", "--set", pwm});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_NEAR(o.json()["supply_duty"].get<double>(), 0.792, 1e-3);
  const std::string low = "supply={type=\"pwm\", voltage=\"7 V\", duty=0.2, frequency=\"20 kHz\"}";
  EXPECT_THAT(flapper({"--lift-to-weight", "1", "--set", low}).err,
              HasSubstr("more than the 7 V that the supply gives"));
  EXPECT_THAT(flapper({"--lift-to-weight", "2", "--set", low}).err, HasSubstr("; a duty of 1 gives 7 V"));
}

TEST_F(Targets, LiftBelowTheOnsetIsRefusedWithTheOnset) {
  for (const char* lift : {"0.5 mN", "45 uN"}) {
    const Outcome o = run({"run", springs, "--lift", lift, "--json"});
    EXPECT_EQ(o.status, 3);
    EXPECT_EQ(o.json()["status"], "locked");
    EXPECT_THAT(
        o.json()["status_detail"].get<std::string>(),
        HasSubstr("cannot be reached inside the domain of validity: from rest it flaps only above 1.275 V, and there "
                  "lifts 0.001093 N already; below, it is locked"));
  }
  EXPECT_EQ(run({"run", plain, "--lift", "45 uN"}).status, 0);
}

TEST_F(Targets, FrequenciesOutOfReachAreRefusedAtOnce) {
  for (const std::string& vehicle : {plain, springs, path("flapper.toml")}) {
    for (const char* frequency : {"1e5 Hz", "1e6 Hz"}) {
      for (const bool extrapolate : {false, true}) {
        std::vector<std::string> arguments = {"run", vehicle, "--frequency", frequency};
        if (extrapolate) arguments.push_back("--allow-extrapolation");
        const double before = children_time();
        const Outcome o = run(arguments);
        EXPECT_LT(children_time() - before, 0.5);  // nearly all of it to load the program
        EXPECT_EQ(o.status, 2);
        EXPECT_THAT(o.err, HasSubstr(" Hz cannot be reached in"));
        EXPECT_THAT(o.err, HasSubstr("whatever the voltage, wings that flap at more than "));
      }
    }
  }
}

TEST_F(Targets, FrequencyOutsideTheDomainIsRefusedWithTheFastestInside) {
  const Outcome o = run({"run", plain, "--frequency", "80 Hz"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err,
              MatchesRegex("wingbeat: --frequency 80 Hz: 80 Hz cannot be reached inside the domain of validity: at "
                           "[0-9.]+ V, where it flaps at [0-9.]+ Hz, the angle of attack falls to -[0-9.]+ deg .*; "
                           "inside it flaps at 6[0-9.]+ Hz at most, at 1[0-9.]+ V; --allow-extrapolation searches "
                           "beyond\n"));
  const Outcome beyond = run({"run", plain, "--frequency", "80 Hz", "--json", "--allow-extrapolation"});
  ASSERT_EQ(beyond.status, 0) << beyond.err;
  EXPECT_NEAR(beyond.json()["frequency_hz"].get<double>(), 80.0, 80e-6);
}

// Holding a frequency that no design of an optimum reaches.
TEST_F(Targets, AHeldFrequencyOutOfReachIsQuick) {
  std::ofstream(path("o.toml"))
      << "[study]\nvehicle = \"" << plain << "\"\nhold = { frequency = \"1e6 Hz\" }\n"
      << "[objective]\nminimise = \"power_electrical_w\"\n"
      << "[[parameter]]\nkey = \"friction.radius\"\nlower = \"1 mm\"\nupper = \"3 mm\"\n"
      << "[[parameter]]\nkey = \"transmission.crank_radius\"\nlower = \"4 mm\"\nupper = \"6 mm\"\n";
  const double before = children_time();
  const Outcome o = run({"optimise", path("o.toml")});
  EXPECT_LT(children_time() - before, 2.0);
  EXPECT_NE(o.status, 0);
}

}  // namespace
