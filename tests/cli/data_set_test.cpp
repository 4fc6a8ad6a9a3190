// What every data set the program writes has in common.
#include <gmock/gmock.h>
#include <netcdf.h>

#include "program.hpp"

namespace cli {
namespace {

using testing::HasSubstr;

class DataSets : public Program {
 protected:
  std::string study(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << "[study]\nvehicle = \"" << plain << "\"\n" << text;
    return path(name);
  }

  /// The attributes that all files carry, and units and long_name of every variable but texts.
  void expect_alike(const std::string& file, const std::string& command) const {
    SCOPED_TRACE(file);
    int id = 0, variables = 0;
    ASSERT_EQ(nc_open(path(file).c_str(), NC_NOWRITE, &id), NC_NOERR);
    const auto text = [&](int variable, const char* name) {
      std::size_t length = 0;
      nc_type type = 0;
      if (nc_inq_att(id, variable, name, &type, &length) != NC_NOERR || type != NC_CHAR) return std::string();
      std::string value(length, '\0');
      nc_get_att_text(id, variable, name, value.data());
      return value;
    };
    EXPECT_EQ(text(NC_GLOBAL, "Conventions"), "CF-1.8");
    EXPECT_NE(text(NC_GLOBAL, "title"), "");
    EXPECT_THAT(text(NC_GLOBAL, "vehicle"), HasSubstr("torque_constant"));
    EXPECT_EQ(text(NC_GLOBAL, "input"), "");
    const std::string version = text(NC_GLOBAL, "wingbeat_version");
    EXPECT_NE(version, "");
    EXPECT_EQ(text(NC_GLOBAL, "source"), "wingbeat " + version + " " + command);
    EXPECT_NE(text(NC_GLOBAL, "tolerance"), "");
    ASSERT_EQ(nc_inq_nvars(id, &variables), NC_NOERR);
    EXPECT_GT(variables, 3);
    for (int v = 0; v < variables; ++v) {
      char name[NC_MAX_NAME + 1];
      nc_type type = 0;
      ASSERT_EQ(nc_inq_var(id, v, name, &type, nullptr, nullptr, nullptr), NC_NOERR);
      EXPECT_NE(text(v, "long_name"), "") << name;
      if (type != NC_CHAR) {
        EXPECT_NE(text(v, "units"), "") << name;
      }
      EXPECT_STRNE(name, "time");
      const std::string unit = text(v, "units");
      if (std::string(name).ends_with("_nm")) {
        EXPECT_EQ(unit, "N m") << name;
      }
      if (std::string(name) == "time_s") {
        EXPECT_EQ(unit, "s");
      }
    }
    nc_close(id);
  }
};

TEST_F(DataSets, CarryTheSameAttributes) {
  const std::string voltage = "[[parameter]]\nkey = \"supply.voltage\"\nlower = \"2.5 V\"\nupper = \"3.5 V\"\n";
  const auto expect_written = [&](std::vector<std::string> arguments, const std::string& file) {
    const Outcome o = run(arguments);
    ASSERT_EQ(o.status, 0) << o.err;
    expect_alike(file, arguments.front());
  };
  expect_written({"run", plain, "--waveforms", path("w.nc")}, "w.nc");
  expect_written({"linearise", plain, "--no-maps", "-o", path("l.nc")}, "l.nc");
  expect_written({"endurance", data + "/designs/friction2022-battery.toml", "-o", path("e.nc")}, "e.nc");
  expect_written(
      {"sweep", study("s.toml", "[[axis]]\nkey = \"supply.voltage\"\nfrom = \"2 V\"\nto = \"3 V\"\ncount = 3\n"), "-o",
       path("s.nc")},
      "s.nc");
  expect_written({"tolerance",
                  study("t.toml",
                        "[samples]\ncount = 64\n[[parameter]]\nkey = \"supply.voltage\"\n"
                        "distribution = \"normal\"\nrelative_deviation = 0.03\n"),
                  "-o", path("t.nc")},
                 "t.nc");
  expect_written({"optimise", study("o.toml", "[objective]\nmaximise = \"lift_mean_n\"\nstarts = 2\n" + voltage), "-o",
                  path("o.nc")},
                 "o.nc");
  const std::string objectives =
      "[[objective]]\nmaximise = \"lift_mean_n\"\nreference = \"0 N\"\n"
      "[[objective]]\nminimise = \"power_electrical_w\"\nreference = \"4 W\"\n";
  expect_written({"optimise", study("p.toml", "[search]\npopulation = 20\ngenerations = 2\n" + objectives + voltage),
                  "-o", path("p.nc")},
                 "p.nc");
}

}  // namespace
}  // namespace cli
