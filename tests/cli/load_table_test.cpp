// Vehicles whose loads come from a table: the shipped example, a grid written by the program, what is refused.
#include <gmock/gmock.h>

#include <algorithm>

#include "users_folder.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;

class LoadTable : public UsersFolder {
 protected:
  std::string vehicle(const std::string& air) const {
    std::string text = read(data + "/designs/friction2022.toml");
    const auto from = text.find("[aerodynamics]"), to = text.find("[bench]");
    return text.replace(from, to - from,
                        "[aerodynamics]\nair_density = \"1.225 kg/m3\"\n"
                        "pitch_coefficient = \"5 ms\"\n" +
                            air + "\n");
  }
  static double number(const Json& result, const char* key) { return result[key].get<double>(); }
};

TEST_F(LoadTable, OfTheModelGivesTheVehicleBack) {
  const Outcome model = run({"run", plain, "--voltage", "5.5 V", "--json"});
  const Outcome table = run({"run", data + "/loads/flapper.toml", "--json"});
  ASSERT_EQ(table.status, 0) << table.err;
  for (const char* key : {"frequency_hz", "lift_mean_n", "power_aerodynamic_w", "power_electrical_w"}) {
    EXPECT_NEAR(number(table.json(), key) / number(model.json(), key), 1.0, 5e-5) << key;
  }
  EXPECT_EQ(table.json()["domain"], "inside");
}

TEST_F(LoadTable, GridOfWingsOnHinges) {
  const std::string hinged = data + "/designs/pitch-hinge-crank.toml";
  const Outcome out = run({"export-kinematics", hinged, "--frequency", "22 Hz", "--format", "load-table", "--rows",
                           "25", "-o", path("grid.csv"), "--json"});
  ASSERT_EQ(out.status, 0) << out.err;
  EXPECT_EQ(out.json()["rows"], 25 * 25 * 9);
  const std::string csv = read(path("grid.csv"));
  EXPECT_THAT(csv, HasSubstr("\nflapping_velocity_rad_per_s,pitch_angle_rad,pitch_velocity_rad_per_s,lift_N,"
                             "stroke_moment_N_m,pitch_moment_N_m\n0,"));
  std::string text = read(hinged);
  const auto line = text.find("coefficients = ");
  ASSERT_NE(line, std::string::npos);
  text.replace(line, text.find('\n', line) - line, "type = \"tabulated\"\nfile = \"grid.csv\"");
  write("hinged.toml", text);
  const Outcome model = run({"run", hinged, "--frequency", "22 Hz", "--json"});
  const Outcome table = run({"run", path("hinged.toml"), "--frequency", "22 Hz", "--json"});
  ASSERT_EQ(table.status, 0) << table.err;
  for (const char* key : {"voltage_v", "lift_mean_n", "power_electrical_w"}) {
    EXPECT_NEAR(number(table.json(), key) / number(model.json(), key), 1.0, 0.02) << key;
  }
}

TEST_F(LoadTable, AGridThatGrowsTooLargeIsRefused) {
  const Outcome out = run({"export-kinematics", plain, "--format", "load-table", "--rows", "102", "-o", path("g.csv")});
  EXPECT_EQ(out.status, 2);
  EXPECT_THAT(out.err, HasSubstr("--rows: a load-table has at most 101 flapping velocities, got 102"));
}

TEST_F(LoadTable, HalfOfTheWingsIsHalfOfTheTable) {
  const std::string flapper = data + "/loads/flapper.toml";
  const Outcome whole = run({"run", flapper, "--json"});
  const Outcome same = run({"run", flapper, "--set", "aerodynamics.table_wings=2", "--set",
                            "aerodynamics.table_air_density=1.225 kg/m3", "--json"});
  ASSERT_EQ(same.status, 0) << same.err;
  EXPECT_NEAR(number(same.json(), "lift_mean_n") / number(whole.json(), "lift_mean_n"), 1.0, 1e-9);
  const Outcome fast = run({"run", flapper, "--voltage", "8 V"});
  EXPECT_THAT(fast.out, HasSubstr("the flapping velocity reaches"));
  EXPECT_THAT(fast.out, HasSubstr("OUTSIDE THE MODEL'S DOMAIN (load_table)"));
}

TEST_F(LoadTable, BadTablesAreRefused) {
  const auto refusal = [&](const std::string& air, const std::string& csv) {
    write("v.toml", vehicle(air));
    write("t.csv", csv);
    const Outcome out = run({"run", path("v.toml")});
    EXPECT_EQ(out.status, 2) << out.out;
    EXPECT_EQ(std::count(out.err.begin(), out.err.end(), '\n'), 1) << out.err;
    return out.err;
  };
  const std::string both = "type = \"tabulated\"\nfile = \"t.csv\"";
  const std::string good = "flapping_velocity_rad_per_s,lift_mN,stroke_moment_mN_m\n0,0,0\n50,10,0.2\n100,40,0.8\n";
  EXPECT_THAT(refusal("type = \"tabulated\"", good), HasSubstr("aerodynamics.file: missing"));
  EXPECT_THAT(refusal("file = \"t.csv\"", good), HasSubstr("aerodynamics.file: "));
  EXPECT_THAT(refusal("type = \"cfd\"", good), HasSubstr("aerodynamics.type: expected quasi-steady or tabulated"));
  EXPECT_THAT(refusal(both + "\ncoefficients = \"robobee\"", good),
              HasSubstr("aerodynamics.coefficients: is not for tabulated loads"));
  EXPECT_THAT(refusal(both + "\nlifting_span = 0.9", good), HasSubstr("aerodynamics.lifting_span: "));
  EXPECT_THAT(refusal(both, "flapping_velocity_rad_per_s,lift_mN\n0,0\n"), HasSubstr("t.csv:1:1: too few columns"));
  EXPECT_THAT(refusal(both, "speed,lift_mN\n0,0\n"), HasSubstr("t.csv:1:1: unknown column \"speed\""));
  EXPECT_THAT(refusal(both, "flapping_velocity_rad_per_s,lift_mN,stroke_moment_mN_m\n5,1,1\n9,1,1\n"),
              HasSubstr("the load table needs rows at a flapping_velocity of 0"));
  EXPECT_THAT(refusal(both,
                      "flapping_velocity_rad_per_s,pitch_angle_deg,lift_mN,stroke_moment_mN_m\n"
                      "0,-40,0,0\n0,40,0,0\n9,-40,1,1\n9,40,1,1\n"),
              HasSubstr("depends on the pitch, which follows the stroke here"));
  EXPECT_THAT(
      run({"export-kinematics", data + "/loads/flapper.toml", "--format", "load-table", "-o", path("o.csv")}).err,
      HasSubstr("aerodynamics.type: does not apply to a table of loads"));
}

}  // namespace
