#include <gmock/gmock.h>

#include <cmath>

#include "program.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace {

using namespace cli;
using testing::HasSubstr, testing::Not;

class Linearise : public Program {};

TEST_F(Linearise, ReportJsonTomlDataSetAndFigure) {
  const Outcome report = run({"linearise", plain, "--no-maps", "-o", path("model.nc"), "--plot", path("steps.svg")});
  EXPECT_EQ(report.status, 0) << report.err;
  for (const char* part : {"One cycle to the next", "Multiplier", "Continuous time", "Cycle-averaged derivatives"}) {
    EXPECT_THAT(report.out, HasSubstr(part));
  }
  for (const char* part :
       {"step of voltage", "step of load torque", "lift mean", "crank speed mean", "per steady change"}) {
    EXPECT_THAT(read(path("steps.svg")), HasSubstr(part));
  }
  // All has settled within two cycles of 46 ms: of the ten that are reported three are drawn.
  EXPECT_THAT(read(path("steps.svg")), HasSubstr("> 120<"));
  EXPECT_THAT(read(path("steps.svg")), Not(HasSubstr("> 200<")));
  ASSERT_EQ(run({"linearise", plain, "--no-maps", "--cycles", "12", "--plot", path("all.svg")}).status, 0);
  EXPECT_THAT(read(path("all.svg")), HasSubstr("> 500<"));
  const Json json = run({"linearise", plain, "--no-maps", "--json"}).json();
  const Json& model = json["model"];
  EXPECT_EQ(model["states"].size(), 2u);
  EXPECT_EQ(model["A"].size(), 2u);
  EXPECT_EQ(model["B"][0].size(), model["inputs"].size());
  EXPECT_EQ(model["step_responses"]["voltage"]["lift_mean"][0], model["D"][0][0]);

  const wingbeat::NetcdfReader file(path("model.nc"));
  const std::vector<double> a = file.read("A"), d = file.read("D");
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(a[n], model["A"][n / 2][n % 2].get<double>());
  EXPECT_EQ(d[0], model["D"][0][0].get<double>());
  EXPECT_EQ(file.read("period")[0], model["period_s"].get<double>());
  EXPECT_EQ(file.read("step_response")[0], d[0]);
  EXPECT_TRUE(file.attribute("vehicle"));

  // Every form says the same, and each may be written again.
  for (const char* name : {"model.toml", "model.json", "model.mat", "model.mat"}) {
    EXPECT_EQ(run({"linearise", plain, "--no-maps", "-o", path(name)}).status, 0) << name;
  }
  EXPECT_EQ(Json::parse(read(path("model.json"))), json);
  EXPECT_THAT(read(path("model.toml")), HasSubstr("A = [[" + model["A"][0][0].dump()));
  EXPECT_THAT(read(path("model.mat")).substr(0, 116), HasSubstr("MATLAB 5.0 MAT-file, Written by wingbeat"));
}

TEST_F(Linearise, MapsHaveSlopesWithTheErrorOfTheirPoints) {
  const std::string file = path("model.nc");
  const Json json = run({"linearise", data + "/designs/two-wing-direct-hinge.toml", "--hinge-offset", "13.95 mm",
                         "--json", "-o", file})
                        .json();
  const Json& maps = json["static_maps"];
  ASSERT_EQ(maps.size(), 5u);
  const auto value_of = [&](std::size_t map, const char* slope, const char* column) {
    return maps[map][slope][column].get<double>();
  };
  EXPECT_EQ(maps[3]["input"], "split_cycle");
  EXPECT_EQ(maps[4]["input"], "split_cycle_cosine");
  for (const auto& [map, column] : {std::pair(0, "lift"), std::pair(1, "roll_moment"), std::pair(2, "pitch_moment"),
                                    std::pair(3, "yaw_moment"), std::pair(4, "yaw_moment")}) {
    const auto which = std::size_t(map);
    EXPECT_NEAR(value_of(which, "slope", column), value_of(which, "slope_of_points", column),
                value_of(which, "slope_of_points_error", column))
        << maps[which]["input"];
  }
  EXPECT_NEAR(value_of(0, "slope", "lift"), json["model"]["steady_gain"][0][0].get<double>(), 1e-10);
  EXPECT_LT(std::abs(value_of(3, "slope", "roll_moment")), 1e-10);
  const wingbeat::NetcdfReader data_set(file);
  EXPECT_EQ(data_set.read("yaw_moment_slope_by_split_cycle")[0], value_of(3, "slope", "yaw_moment"));
  const std::string report = run({"linearise", data + "/designs/two-wing-direct-hinge.toml"}).out;
  for (const char* part : {"split_cycle_cosine [1]", "slope at 0", "from these points", "off by at most about"}) {
    EXPECT_THAT(report, HasSubstr(part));
  }
}

TEST_F(Linearise, OctaveAndScipyLoadTheMatFile) {
  const std::string file = path("model.mat");
  ASSERT_EQ(run({"linearise", data + "/designs/two-wing-direct.toml", "-o", file}).status, 0);
  const std::string script =
      "import scipy.io as io, numpy as np\n"
      "m = io.loadmat('" +
      file +
      "')\n"
      "assert [str(n[0]) for n in m['input_names'][0]] == "
      "['voltage', 'load_torque', 'frequency', 'spring_stiffness']\n"
      "x = np.zeros(len(m['A']))\n"
      "for k in range(5):\n"
      "    np.testing.assert_allclose(m['step_responses'][k, :, 0], m['C'] @ x + m['D'][:, 0], rtol=1e-9)\n"
      "    x = m['A'] @ x + m['B'][:, 0]\n"
      "assert m['map_bias_voltage'][0, 0]['pitch_moment'].shape == (1, 9)\n"
      "assert m['map_split_cycle_cosine'][0, 0]['slope_of_points_error'].shape == (1, 5)\n";
  EXPECT_EQ(std::system(("/usr/bin/python3 -c \"" + script + "\"").c_str()), 0);
  const std::string octave = "m = load('" + file +
                             "'); assert(strcmp(m.state_names{1}, 'stroke_angle')); "
                             "assert(size(m.map_split_cycle.yaw_moment), [1 7]); assert(max(abs(eig(m.A))) < 1);";
  EXPECT_EQ(std::system(("octave-cli --no-init-file --eval \"" + octave + "\"").c_str()), 0);
}

TEST_F(Linearise, RefusesWhatItCannotDo) {
  EXPECT_EQ(run({"linearise", plain, "--voltage", "0 V"}).status, 3);
  const Outcome name = run({"linearise", plain, "-o", path("model.csv")});
  EXPECT_EQ(name.status, 2);
  EXPECT_THAT(name.err, HasSubstr("the name must end in .toml, .json, .nc or .mat"));
  const Outcome offset = run({"linearise", plain, "--hinge-offset", "5 kg"});
  EXPECT_EQ(offset.status, 2);
  EXPECT_THAT(offset.err, HasSubstr("--hinge-offset"));
  const Outcome lift = run({"linearise", plain, "--lift", "5 N"});
  EXPECT_EQ(lift.status, 2);
  EXPECT_THAT(lift.err, HasSubstr("--lift 5 N"));
}

}  // namespace
