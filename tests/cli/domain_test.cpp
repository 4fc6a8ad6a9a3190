// What lies outside the model's domain says so, in every output, and is best of nothing.
#include <gmock/gmock.h>
#include <netcdf.h>

#include <cmath>
#include <fstream>

#include "program.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace cli {
namespace {

using testing::HasSubstr;
using testing::Not;

class Domain : public Program {
 protected:
  std::string study(const std::string& text, const std::string& more = "") const {
    fs::copy_file(springs, path("vehicle.toml"), fs::copy_options::overwrite_existing);
    std::ofstream(path("study.toml")) << "[study]\nvehicle = \"vehicle.toml\"\n" << more << text;
    return path("study.toml");
  }
};

const std::string voltages = "[[axis]]\nkey = \"supply.voltage\"\nfrom = \"2 V\"\nto = \"100 V\"\ncount = 25\n";

TEST_F(Domain, AResultInsideSaysSo) {
  const Json json = run({"run", plain, "--json"}).json();
  EXPECT_EQ(json["domain"], "inside");
  EXPECT_TRUE(json["domain_detail"].is_null());
  EXPECT_THAT(run({"run", plain}).out, Not(HasSubstr("DOMAIN")));
}

TEST_F(Domain, TheFirstLinesSayWhatIsOutside) {
  struct Case {
    std::vector<std::string> set;
    std::string limit;
  };
  const Case cases[] = {
      {{"supply.voltage=40 V"}, "angle_of_attack"},
      {{"supply.voltage=400 V"}, "angle_of_attack"},
      {{"spring.stiffness=5e-2 N m/rad", "supply.voltage=100 V"}, "angle_of_attack"},
      {{"transmission.hinge_offset=0.4 mm", "transmission.formulation=virtual-work", "spring.stiffness=0",
        "supply.voltage=5 V"},
       "stroke"},
      {{"aerodynamics.pitch_coefficient=0", "supply.voltage=3000 V", "transmission.formulation=virtual-work"},
       "flow_speed"}};
  for (const Case& c : cases) {
    std::vector<std::string> arguments = {"run", springs};
    for (const std::string& set : c.set) arguments.insert(arguments.end(), {"--set", set});
    const Outcome text = run(arguments);
    ASSERT_EQ(text.status, 0) << c.set[0] << text.err << text.out;
    EXPECT_EQ(text.out.find("OUTSIDE THE MODEL'S DOMAIN ("), text.out.find('\n') + 1) << text.out.substr(0, 300);
    EXPECT_THAT(text.out.substr(0, 250), HasSubstr(c.limit));
    arguments.push_back("--json");
    const Json json = run(arguments).json();
    EXPECT_THAT(json["domain"].get<std::string>(), HasSubstr(c.limit));
    EXPECT_FALSE(json["domain_detail"].get<std::string>().empty());
  }
}

TEST_F(Domain, EfficienciesThatNoVehicleHas) {
  std::vector<std::string> arguments = {"run", plain, "--json"};
  for (const char* set : {"transmission.rod_length=0.02238", "transmission.hinge_offset=0.01435", "friction.type=none",
                          "motor.viscous_damping=1e-10", "wing.inertia=2.191e-08"}) {
    arguments.insert(arguments.end(), {"--set", set});
  }
  const auto with = [&](std::initializer_list<std::string> sets) {
    std::vector<std::string> all = arguments;
    for (const std::string& set : sets) all.insert(all.end(), {"--set", set});
    return run(all).json();
  };
  const Json above_one = with({"spring.stiffness=0.01744", "supply.voltage=4.023", "motor.armature_resistance=0.02012",
                               "transmission.mid_stroke_height=0.01609"});
  EXPECT_GT(above_one["efficiency_system"].get<double>(), 1.2);
  EXPECT_EQ(above_one["domain"], "angle_of_attack, formulation_residual, mechanism_efficiency");
  const Json gives_power = with({"spring.stiffness=0.03759", "supply.voltage=5.504", "motor.armature_resistance=0.6877",
                                 "transmission.mid_stroke_height=0.01497"});
  EXPECT_LT(gives_power["power_electrical_w"].get<double>(), 0.0);
  EXPECT_EQ(gives_power["domain"], "mechanism_efficiency, input_power");
}

TEST_F(Domain, RodForceWarnsOfWhatItDoesNotConserve) {
  const Json json = run({"run", plain, "--json"}).json();
  ASSERT_EQ(json["warnings"].size(), 1u);
  EXPECT_THAT(json["warnings"][0].get<std::string>(),
              HasSubstr("rod-force fails to conserve 2.76 % of the input power"));
  EXPECT_THAT(run({"run", plain}).out, HasSubstr("warning: the formulation rod-force fails to conserve 2.76 %"));
  const std::vector<std::string> other = {"run", plain, "--set", "transmission.formulation=virtual-work", "--json"};
  EXPECT_TRUE(run(other).json()["warnings"].empty());
}

TEST_F(Domain, WithoutFlappingThereIsNoDomain) {
  const Json json = run({"run", plain, "--json", "--set", "motor.friction_torque=1 N m"}).json();
  EXPECT_EQ(json["status"], "stalled");
  EXPECT_TRUE(json["domain"].is_null());
}

TEST_F(Domain, WaveformsCarryIt) {
  ASSERT_EQ(run({"run", plain, "--voltage", "40 V", "--waveforms", path("cycle.nc")}).status, 0);
  EXPECT_EQ(wingbeat::NetcdfReader(path("cycle.nc")).attribute("domain"), "angle_of_attack");
}

TEST_F(Domain, SweepsFlagItAndTheBestIsInside) {
  const std::string file =
      study(voltages, "metrics = [\"lift_mean_n\", \"power_electrical_w\", \"efficiency_system\"]\n");
  const Outcome kept = run({"sweep", file, "-o", path("kept.nc"), "--plot", path("kept.svg")});
  ASSERT_EQ(kept.status, 0) << kept.err;
  EXPECT_THAT(kept.out, HasSubstr("flapping outside the model's domain ("));
  EXPECT_THAT(read(path("kept.svg")), HasSubstr("outside the model's domain"));
  const wingbeat::NetcdfReader data(path("kept.nc"));
  const std::vector<double> domain = data.read("domain"), lift = data.read("lift_mean_n");
  std::size_t best = 0;
  int outside = 0;
  for (std::size_t n = 0; n < lift.size(); ++n) {
    outside += domain[n] != 0.0;
    if (domain[n] == 0.0 && lift[n] > lift[best]) best = n;
  }
  EXPECT_GT(outside, 10);
  EXPECT_THAT(kept.out, HasSubstr(std::to_string(outside)));
  const double volts = 2.0 + 98.0 / 24.0 * double(best);
  EXPECT_LT(volts, 25.0);

  int id = 0, variable = 0;
  ASSERT_EQ(nc_open(path("kept.nc").c_str(), NC_NOWRITE, &id), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(id, "domain", &variable), NC_NOERR);
  short masks[10] = {};
  ASSERT_EQ(nc_get_att_short(id, variable, "flag_masks", masks), NC_NOERR);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(masks[k], 1 << k);  // none of them negative
  std::size_t length = 0;
  ASSERT_EQ(nc_inq_attlen(id, variable, "flag_meanings", &length), NC_NOERR);
  std::string meanings(length, '\0');
  nc_get_att_text(id, variable, "flag_meanings", meanings.data());
  nc_close(id);
  EXPECT_EQ(meanings,
            "angle_of_attack stroke formulation_residual mechanism_efficiency motor_efficiency input_power "
            "flow_speed winding_temperature reynolds_number load_table");

  // Most lift anywhere is far outside; it is best only where that is asked for, on the command or in the study.
  const Outcome free = run({"sweep", file, "-o", path("free.nc"), "--allow-extrapolation"});
  ASSERT_EQ(free.status, 0) << free.err;
  EXPECT_THAT(free.out, HasSubstr("extrapolation is allowed"));
  EXPECT_NE(free.out.substr(free.out.find("maximum mean lift")), kept.out.substr(kept.out.find("maximum mean lift")));
  const std::string asked = study(voltages, "allow_extrapolation = true\n");
  EXPECT_THAT(run({"sweep", asked, "-o", path("asked.nc")}).out, HasSubstr("extrapolation is allowed"));
}

TEST_F(Domain, ContoursAreHatched) {
  const std::string file = study(
      "[[axis]]\nkey = \"supply.voltage\"\nfrom = \"2 V\"\nto = \"60 V\"\ncount = 15\n"
      "[[axis]]\nkey = \"spring.stiffness\"\nfrom = \"0 N m/rad\"\nto = \"5e-3 N m/rad\"\ncount = 6\n",
      "metrics = [\"lift_mean_n\"]\n");
  const Outcome outcome = run({"sweep", file, "-o", path("map.nc"), "--plot", path("map.svg")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(read(path("map.svg")), HasSubstr("hatched: outside the model's domain, no best there"));
}

TEST_F(Domain, OptimaStayInsideAndSayWhatLimitsThem) {
  const std::string text =
      "[objective]\nminimise = \"angle_of_attack_min_deg\"\nstarts = 2\nscreen = 32\n"
      "[[parameter]]\nkey = \"supply.voltage\"\nlower = \"1 V\"\nupper = \"100 V\"\n";
  const Outcome kept = run({"optimise", study(text)});
  ASSERT_EQ(kept.status, 0) << kept.err;
  EXPECT_THAT(kept.out, HasSubstr("domain: angle_of_attack >= 0 deg"));
  EXPECT_THAT(kept.out, HasSubstr("The model's domain limits this optimum"));
  const Json json = run({"optimise", study(text), "--json"}).json();
  EXPECT_EQ(json["domain"], "inside");
  EXPECT_TRUE(json["limited_by_domain"].get<bool>());
  const Outcome free = run({"optimise", study(text), "--allow-extrapolation"});
  ASSERT_EQ(free.status, 0) << free.err;
  EXPECT_THAT(free.out, HasSubstr("OUTSIDE THE MODEL'S DOMAIN (angle_of_attack"));
  // What was found inside stays inside when it is run again.
  ASSERT_EQ(run({"optimise", study(text), "-o", path("best.toml")}).status, 0);
  EXPECT_EQ(run({"run", path("best.toml"), "--json"}).json()["domain"], "inside");
}

TEST_F(Domain, TheKeyOfStudiesIsTrueOrFalse) {
  const Outcome outcome = run({"sweep", study(voltages, "allow_extrapolation = \"yes\"\n"), "-o", path("x.nc")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("study.allow_extrapolation: expected true or false, got \"yes\""));
}

TEST_F(Domain, ToleranceGivesTheShareOutside) {
  const std::string file = study(
      "[samples]\ncount = 64\nindices = false\n[[parameter]]\nkey = \"supply.voltage\"\n"
      "distribution = \"uniform\"\nlower = \"3 V\"\nupper = \"20 V\"\n");
  const Json json = run({"tolerance", file, "--json"}).json();
  EXPECT_GT(json["probability"]["outside_domain"]["share"].get<double>(), 0.2);
  EXPECT_GT(json["outside_domain"]["angle_of_attack"].get<int>(), 10);
  const Json& shares = json["probability"];
  EXPECT_LE(shares["hover"]["count"].get<int>() + shares["outside_domain"]["count"].get<int>(), 64);
  EXPECT_THAT(run({"tolerance", file}).out, HasSubstr("Samples outside the model's domain neither hover nor count"));
}

TEST_F(Domain, EnduranceGivesItForEachRow) {
  const std::string battery = data + "/designs/friction2022-battery.toml";
  const Json inside = run({"endurance", battery, "--json"}).json();
  EXPECT_EQ(inside["domain"], "inside");
  EXPECT_EQ(inside["history"]["domain"].size(), inside["history"]["time_s"].size());
  const Outcome outside = run({"endurance", battery, "--set", "supply.cells=4", "--set", "vehicle.mass=1 g"});
  EXPECT_THAT(outside.out.substr(0, 300), HasSubstr("OUTSIDE THE MODEL'S DOMAIN (angle_of_attack"));
  EXPECT_THAT(outside.out, HasSubstr("not claimed"));
}

}  // namespace
}  // namespace cli
