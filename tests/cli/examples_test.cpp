// The vehicles beside the paper's (docs/examples.md), and the mechanism that a plot shows.
#include <gmock/gmock.h>

#include <cmath>

#include "program.hpp"

namespace cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Examples : public Program {
 protected:
  static std::string design(const std::string& name) { return data + "/designs/" + name + ".toml"; }

  std::string plot(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "run");
    for (const std::string& more : {std::string("--plot"), path("p.svg"), std::string("--force")})
      arguments.push_back(more);
    const Outcome o = run(arguments);
    EXPECT_EQ(o.status, 0) << o.err << o.out;
    return read(path("p.svg"));
  }
};

TEST_F(Examples, EachFlapsHoversAndKeepsItsEnergyBalance) {
  struct Expected {
    const char* name;
    double frequency, voltage;
  };
  for (const auto& [name, frequency, voltage] :
       {Expected{"two-wing-direct", 34.0, 7.87}, {"two-wing-four-bar", 18.2, 7.66}, {"x-wing-crank", 16.6, 3.82}}) {
    EXPECT_EQ(run({"run", design(name)}).status, 0) << name;
    const Outcome o = run({"run", design(name), "--lift-to-weight", "1", "--json"});
    ASSERT_EQ(o.status, 0) << name << o.err;
    const Json json = o.json();
    EXPECT_EQ(json["status"], "flapping");
    EXPECT_EQ(json["domain"], "inside");
    EXPECT_NEAR(json["lift_to_weight"].get<double>(), 1.0, 1e-5);
    EXPECT_NEAR(json["frequency_hz"].get<double>(), frequency, 0.01 * frequency) << name;
    EXPECT_NEAR(json["voltage_v"].get<double>(), voltage, 0.01 * voltage) << name;
    double spent = 0.0;
    for (const char* power : {"copper", "viscous", "motor_friction", "friction", "gear", "aerodynamic", "residual"}) {
      spent += json[std::string("power_") + power + "_w"].get<double>();
    }
    const double input = json["power_electrical_w"].get<double>();
    EXPECT_NEAR(spent, input, 1e-6 * input) << name;
    EXPECT_NEAR(json["power_residual_w"].get<double>(), 0.0, 1e-12 * input) << name;
  }
}

TEST_F(Examples, SimulationInTimeAgrees) {
  for (const char* name :
       {"two-wing-direct", "two-wing-direct-hinge", "two-wing-four-bar", "x-wing-crank", "hawkmoth"}) {
    const Json orbit = run({"run", design(name), "--json"}).json();
    const Json time = run({"run", design(name), "--json", "--method", "transient"}).json();
    for (const char* key : {"frequency_hz", "lift_mean_n", "power_electrical_w", "stroke_amplitude_rad"}) {
      EXPECT_NEAR(time[key].get<double>() / orbit[key].get<double>(), 1.0, 1e-5) << name << " " << key;
    }
  }
}

// Two motors are two halves: half the vehicle's mass on one motor hovers at the same voltage, for half the power.
TEST_F(Examples, TheWholeDirectDriveIsTwoHalves) {
  for (const char* name : {"two-wing-direct", "two-wing-direct-hinge"}) {
    const Json whole = run({"run", design(name), "--json"}).json();
    const Json half =
        run({"run", design(name), "--json", "--set", "vehicle.motors=1", "--set", "vehicle.mass=5.89 g"}).json();
    for (const char* key : {"lift_mean_n", "power_electrical_w", "power_copper_w", "current_rms_a"}) {
      EXPECT_NEAR(whole[key].get<double>() / half[key].get<double>(), 2.0, 1e-9) << name << " " << key;
    }
    for (const char* key : {"lift_to_weight", "stroke_amplitude_rad", "efficiency_system"}) {
      EXPECT_NEAR(whole[key].get<double>() / half[key].get<double>(), 1.0, 1e-9) << name << " " << key;
    }
  }
}

// docs/examples.md: at hover free hinges flip late and over-rotate, the air's own inertia flips them in time.
TEST_F(Examples, FreeHingesFlipLateWithoutAddedMass) {
  const auto hover = [&](const std::string& voltage, const char* added_mass) {
    const Outcome o = run({"run", design("two-wing-direct-hinge"), "--json", "--set", "supply.amplitude=" + voltage,
                           "--set", std::string("aerodynamics.added_mass=") + added_mass});
    EXPECT_EQ(o.status, 0) << o.err;
    const Json json = o.json();
    EXPECT_EQ(json["domain"], "inside");
    EXPECT_NEAR(json["lift_to_weight"].get<double>(), 1.0, 1e-3);
    EXPECT_NEAR(json["pitch_amplitude_deg"].get<double>(), 45.0, 1e-6);
    double spent = 0.0;
    for (const char* power : {"copper", "viscous", "friction", "hinge", "aerodynamic", "residual"}) {
      spent += json[std::string("power_") + power + "_w"].get<double>();
    }
    const double input = json["power_electrical_w"].get<double>();
    EXPECT_NEAR(spent, input, 1e-6 * input);
    return json;
  };
  const Json without = hover("9.2105 V", "false"), with = hover("7.929 V", "true");
  EXPECT_THAT(without["status_detail"].get<std::string>(), HasSubstr("the wings over-rotate"));
  EXPECT_THAT(with["status_detail"].get<std::string>(), Not(HasSubstr("over-rotate")));
  EXPECT_NEAR(without["pitch_phase_deg"].get<double>(), -29.8, 0.1);
  EXPECT_NEAR(with["pitch_phase_deg"].get<double>(), 1.2, 0.1);
  EXPECT_LT(with["power_electrical_w"].get<double>(), 0.85 * without["power_electrical_w"].get<double>());
}

// A stroke beyond 90 deg to either side: lift and powers as of any other, no trace of the slider-crank's tangent.
// Whether its two wings meet is a matter of their shoulders.
TEST_F(Examples, FourBarBeyond90Degrees) {
  const std::vector<std::string> wide = {
      "run", design("two-wing-four-bar"), "--set", "transmission.stroke_ratio=4", "--voltage", "9 V", "--json"};
  std::vector<std::string> apart = wide;
  for (const char* more : {"--set", "wing.planform.shoulder_distance=100 mm"}) apart.emplace_back(more);
  const Json meets = run(wide).json(), json = run(apart).json();
  EXPECT_EQ(meets["domain"], "stroke");
  EXPECT_THAT(meets["domain_detail"].get<std::string>(),
              HasSubstr("the stroke angle reaches 120.5 deg (two wings on one body meet at 93.02 deg)"));
  EXPECT_EQ(meets["lift_mean_n"], json["lift_mean_n"]);
  EXPECT_EQ(json["status"], "flapping");
  EXPECT_EQ(json["domain"], "inside");
  EXPECT_NEAR(json["stroke_amplitude_rad"].get<double>() * 180.0 / M_PI, 120.5, 0.1);
  EXPECT_NEAR(json["power_residual_w"].get<double>(), 0.0, 1e-12);
}

TEST_F(Examples, FourBarsThatCannotTurnAreRefusedInASentence) {
  const auto complaint = [&](const std::string& setting) {
    const Outcome o = run({"run", design("two-wing-four-bar"), "--set", setting});
    EXPECT_EQ(o.status, 2) << setting;
    return o.err;
  };
  EXPECT_THAT(complaint("transmission.crank_radius=7 mm"), HasSubstr("must be the shortest link, or the crank cannot "
                                                                     "turn (Grashof)"));
  EXPECT_THAT(complaint("transmission.coupler_length=20 mm"),
              HasSubstr("with the longest link must be shorter than the other two links together"));
  EXPECT_THAT(complaint("transmission.ground_length=16.99 mm"),
              HasSubstr("must keep the transmission angle between coupler and rocker within 5 to 175 [deg]"));
}

TEST_F(Examples, APlotShowsTheMechanismThatItIs) {
  EXPECT_THAT(plot({springs}), AllOf(HasSubstr("slider-crank: crank 5, rod 20, hinge offset 6 mm"),
                                     HasSubstr("slider<"), HasSubstr("rod force, above 0"), Not(HasSubstr("coupler"))));
  EXPECT_THAT(plot({design("two-wing-four-bar")}),
              AllOf(HasSubstr("four-bar: crank 3, coupler 14, rocker 6, ground 14.5 mm"), HasSubstr("ground<"),
                    HasSubstr("wing, 3 x rocker"), HasSubstr("coupler force, above 0"), Not(HasSubstr("slider"))));
  EXPECT_THAT(plot({design("hawkmoth")}), AllOf(HasSubstr("tabulated: stroke over crank angle (deg); reaction at 5 mm"),
                                                HasSubstr("reaction, above 0"), Not(HasSubstr("crank<"))));
  EXPECT_THAT(plot({design("two-wing-direct")}),
              AllOf(HasSubstr("direct drive: the motor's shaft is the wing hinge"), HasSubstr("motor<"),
                    HasSubstr("current"), Not(HasSubstr("force"))));
}

TEST_F(Examples, SharesOfNoInputAreLeftOut) {
  const Outcome o = run({"run", design("hawkmoth"), "--condition", "wingless"});
  EXPECT_EQ(o.status, 0);
  EXPECT_THAT(o.out, AllOf(HasSubstr("input power is 0 W"), Not(HasSubstr("nan"))));
}

TEST_F(Examples, AMotorTooHotToHaveAFieldStandsByEitherMethod) {
  const std::vector<std::string> hot = {"run",
                                        plain,
                                        "--voltage",
                                        "40 V",
                                        "--json",
                                        "--set",
                                        "motor.thermal_resistance_winding=20 K/W",
                                        "--set",
                                        "motor.thermal_resistance_case=80 K/W",
                                        "--set",
                                        "motor.magnet_temperature_coefficient=-1e-3 1/K"};
  std::vector<std::string> in_time = hot;
  for (const char* more : {"--method", "transient"}) in_time.emplace_back(more);
  EXPECT_EQ(run(hot).json()["status"], "stalled");
  EXPECT_EQ(run(in_time).json()["status"], "stalled");
}

}  // namespace
}  // namespace cli
