// Added mass as users meet it: runs, sweeps, what an optimum asks for.
#include <gmock/gmock.h>

#include "program.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace cli {
namespace {

using testing::HasSubstr;

class AddedMass : public Program {
 protected:
  AddedMass() {
    std::string text = read(plain);
    std::ofstream(path("plain.toml")) << text;
    text.insert(text.find("s3 ="), "s22 = 4e-8, ");
    text.insert(text.find("[aerodynamics]\n") + 15, "added_mass = true\n");
    std::ofstream(path("added.toml")) << text;
  }
  /// A study of one of these vehicles.
  std::string study(const std::string& vehicle, const std::string& sections) const {
    std::ofstream(path("study.toml")) << "[study]\nvehicle = \"" << vehicle << "\"\n" << sections;
    return path("study.toml");
  }
};

TEST_F(AddedMass, ARunTellsItsShareOfTheWingsInertia) {
  const double expected = 0.78539816339744831 * 1.225 * 4e-8 / (2.0 * 7.205e-8);
  const Json json = run({"run", path("added.toml"), "--json"}).json();
  EXPECT_NEAR(json["added_mass_inertia_ratio"].get<double>(), expected, 1e-12);
  EXPECT_TRUE(run({"run", plain, "--json"}).json()["added_mass_inertia_ratio"].is_null());
  const Json vacuum = run({"run", path("added.toml"), "--json", "--condition", "vacuum"}).json();
  EXPECT_TRUE(vacuum["added_mass_inertia_ratio"].is_null());
}

TEST_F(AddedMass, ASweepHasTheColumnWhereItMeansSomething) {
  const std::string axis = "[[axis]]\nkey = \"aerodynamics.air_density\"\nvalues = [\"1 kg/m3\", \"2 kg/m3\"]\n";
  const Outcome o = run({"sweep", study("added.toml", axis), "-o", path("with.nc")});
  ASSERT_EQ(o.status, 0) << o.err;
  const auto ratio = wingbeat::NetcdfReader(path("with.nc")).read("added_mass_inertia_ratio");
  ASSERT_EQ(ratio.size(), 2U);
  EXPECT_NEAR(ratio[1] / ratio[0], 2.0, 1e-12);
  ASSERT_EQ(run({"sweep", study("plain.toml", axis), "-o", path("without.nc")}).status, 0);
  EXPECT_EQ(read(path("without.nc")).find("added_mass_inertia_ratio"), std::string::npos);
}

TEST_F(AddedMass, AnOptimumOfAVehicleWithoutItIsRefused) {
  const std::string objective =
      "[objective]\nminimise = \"added_mass_inertia_ratio\"\n"
      "[[parameter]]\nkey = \"supply.voltage\"\nlower = \"2 V\"\nupper = \"4 V\"\n";
  const Outcome o = run({"optimise", study("plain.toml", objective)});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("added_mass_inertia_ratio needs aerodynamics.added_mass in the vehicle file"));
}

}  // namespace
}  // namespace cli
