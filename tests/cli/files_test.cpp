#include <gmock/gmock.h>
#include <netcdf.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <map>

#include "program.hpp"
#include "wingbeat/files/waveform_file.hpp"

namespace cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string direct_drive = data + "/designs/direct-drive.toml";

const char* const header =
    "time_s,crank_angle_rad,crank_speed_rad_per_s,current_a,stroke_angle_rad,flapping_velocity_rad_per_s,"
    "angle_of_attack_deg,lift_n,aero_moment_nm,rod_force_n,motor_torque_nm,friction_torque_nm,"
    "voltage_v,power_electrical_w,power_motor_w,power_friction_w,power_aerodynamic_w,"
    "spring_moment_nm,inertial_moment_nm";

using Columns = std::map<std::string, std::vector<double>>;

/// An empty cell, of what the vehicle does not have, is left out of the columns.
Columns read_csv(const std::string& file, bool with_gaps = false) {
  std::istringstream in(read(file));
  std::string line, cell;
  std::getline(in, line);
  EXPECT_EQ(line, header);
  std::vector<std::string> names;
  for (std::istringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
  Columns columns;
  while (std::getline(in, line)) {
    std::size_t k = 0;
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) {
      const std::string& name = names.at(k++);
      if (!with_gaps || !cell.empty()) columns[name].push_back(std::stod(cell));
    }
    EXPECT_EQ(k, names.size());
  }
  return columns;
}

double time_mean(const Columns& c, const std::vector<double>& y) {
  const auto& t = c.at("time_s");
  double sum = 0.0;
  for (std::size_t k = 1; k < t.size(); ++k) sum += 0.5 * (y[k] + y[k - 1]) * (t[k] - t[k - 1]);
  return sum / (t.back() - t.front());
}

double largest(const std::vector<double>& y) {
  double highest = 0.0;
  for (const double x : y) highest = std::max(highest, std::abs(x));
  return highest;
}

class Files : public Program {
 protected:
  void expect_consistent(const Columns& c, const Json& json) const {
    ASSERT_EQ(c.at("time_s").size(), 361U);
    EXPECT_NEAR(c.at("time_s").back() * json["frequency_hz"].get<double>(), 1.0, 1e-8);
    EXPECT_EQ(c.at("time_s").front(), 0.0);
    EXPECT_NEAR(c.at("crank_angle_rad").front(), 0.0, 1e-6);
    EXPECT_NEAR(c.at("crank_angle_rad").back(), 2.0 * M_PI, 1e-6);
    EXPECT_NEAR(time_mean(c, c.at("lift_n")) / json["lift_mean_n"].get<double>(), 1.0, 1e-4);
    EXPECT_NEAR(time_mean(c, c.at("current_a")) / json["current_mean_a"].get<double>(), 1.0, 1e-4);
    EXPECT_NEAR(largest(c.at("rod_force_n")) / json["rod_force_peak_n"].get<double>(), 1.0, 1e-3);
    EXPECT_NEAR(largest(c.at("lift_n")) / json["lift_peak_n"].get<double>(), 1.0, 1e-3);
    for (const char* power : {"power_electrical_w", "power_motor_w", "power_friction_w", "power_aerodynamic_w"}) {
      EXPECT_NEAR(time_mean(c, c.at(power)) / json[power].get<double>(), 1.0, 1e-3) << power;
    }
    std::vector<double> motor(361), square(361);
    for (std::size_t k = 0; k < 361; ++k) {
      motor[k] = c.at("motor_torque_nm")[k] * c.at("crank_speed_rad_per_s")[k];
      square[k] = c.at("current_a")[k] * c.at("current_a")[k];
    }
    EXPECT_NEAR(time_mean(c, motor) / json["power_motor_w"].get<double>(), 1.0, 1e-3);
    EXPECT_NEAR(std::sqrt(time_mean(c, square)) / json["current_rms_a"].get<double>(), 1.0, 1e-4);
    for (const auto& [name, y] : c) {
      if (name == "time_s" || name == "crank_angle_rad") continue;
      EXPECT_NEAR(y.front(), y.back(), 1e-4 * largest(y)) << name;
    }
  }
};

TEST_F(Files, CsvHoldsOneCycleThatGivesBackTheMetrics) {
  for (const char* method : {"orbit", "transient"}) {
    const Outcome o = run({"run", plain, "--json", "--method", method, "--waveforms", path("w.csv")});
    ASSERT_EQ(o.status, 0) << o.err;
    expect_consistent(read_csv(path("w.csv")), o.json());
    EXPECT_THAT(files(), ElementsAre("w.csv"));
  }
}

TEST_F(Files, WaveformsHoldVoltageAndTheMomentsOfTheWings) {
  const std::vector<std::string> vehicles[] = {{springs}, {springs, "--method", "transient"}, {direct_drive}};
  for (const auto& vehicle : vehicles) {
    std::vector<std::string> arguments = {"run", "--json", "--waveforms", path("w.csv")};
    arguments.insert(arguments.end(), vehicle.begin(), vehicle.end());
    const Outcome o = run(arguments);
    ASSERT_EQ(o.status, 0) << o.err;
    const bool is_direct = vehicle.front() == direct_drive;
    const Columns c = read_csv(path("w.csv"), is_direct);
    const double stiffness = is_direct ? 0.0 : 2.0 * 1.377e-3;
    double highest = 0.0, volts = 0.0;
    for (std::size_t k = 0; k < c.at("time_s").size(); ++k) {
      if (!is_direct) {
        EXPECT_NEAR(c.at("spring_moment_nm")[k], stiffness * c.at("stroke_angle_rad")[k], 1e-12);
      }
      EXPECT_NEAR(c.at("power_electrical_w")[k], c.at("voltage_v")[k] * c.at("current_a")[k], 1e-12);
      volts = std::max(volts, std::abs(c.at("voltage_v")[k]));
      highest = std::max(highest, std::abs(c.at("inertial_moment_nm")[k]));
    }
    EXPECT_NEAR(volts / o.json()["voltage_v"].get<double>(), 1.0, 1e-4);
    // Over a cycle the stroke velocity returns: the inertial moment has no mean.
    EXPECT_GT(highest, 1e-4);
    EXPECT_NEAR(time_mean(c, c.at("inertial_moment_nm")) / highest, 0.0, 2e-3);
  }
}

TEST_F(Files, CsvWithoutInductance) {
  const Outcome o = run({"run", plain, "--json", "--method", "transient", "--set", "motor.armature_inductance=0 H",
                         "--waveforms", path("w.csv")});
  ASSERT_EQ(o.status, 0) << o.err;
  expect_consistent(read_csv(path("w.csv")), o.json());
}

TEST_F(Files, NetcdfHoldsWhatCsvHolds) {
  const Outcome o = run({"run", plain, "--json", "--set", "friction.radius=2 mm", "--waveforms", path("w.nc")});
  ASSERT_EQ(o.status, 0) << o.err;
  ASSERT_EQ(run({"run", plain, "--set", "friction.radius=2 mm", "--waveforms", path("w.csv")}).status, 0);
  const Columns csv = read_csv(path("w.csv"));

  int file = 0, id = 0;
  ASSERT_EQ(nc_open(path("w.nc").c_str(), NC_NOWRITE, &file), NC_NOERR);
  const auto text = [&](int variable, const char* name) {
    std::size_t length = 0;
    nc_type type = 0;
    EXPECT_EQ(nc_inq_att(file, variable, name, &type, &length), NC_NOERR) << name;
    EXPECT_EQ(type, NC_CHAR) << name;
    std::string value(length, '\0');
    EXPECT_EQ(nc_get_att_text(file, variable, name, value.data()), NC_NOERR);
    return value;
  };
  std::size_t length = 0;
  ASSERT_EQ(nc_inq_dimid(file, "time_s", &id), NC_NOERR);
  ASSERT_EQ(nc_inq_dimlen(file, id, &length), NC_NOERR);
  ASSERT_EQ(length, 361U);
  for (const auto& [name, y] : csv) {
    ASSERT_EQ(nc_inq_varid(file, name.c_str(), &id), NC_NOERR) << name;
    std::vector<double> values(length);
    ASSERT_EQ(nc_get_var_double(file, id, values.data()), NC_NOERR);
    EXPECT_EQ(values, y) << name;
    EXPECT_FALSE(text(id, "units").empty());
    EXPECT_FALSE(text(id, "long_name").empty());
  }
  // CF: a coordinate has a value everywhere, and no fill value.
  ASSERT_EQ(nc_inq_varid(file, "time_s", &id), NC_NOERR);
  EXPECT_EQ(nc_inq_attid(file, id, "_FillValue", nullptr), NC_ENOTATT);
  ASSERT_EQ(nc_inq_varid(file, "lift_n", &id), NC_NOERR);
  EXPECT_EQ(nc_inq_attid(file, id, "_FillValue", nullptr), NC_NOERR);
  EXPECT_THAT(text(NC_GLOBAL, "title"), HasSubstr("One flapping cycle"));
  EXPECT_THAT(run({"--version"}).out, HasSubstr(text(NC_GLOBAL, "wingbeat_version")));
  // The input can be run again as it stands, overrides included.
  std::ofstream(path("again.toml")) << text(NC_GLOBAL, "vehicle");
  nc_close(file);
  EXPECT_EQ(run({"run", path("again.toml"), "--json"}).out, o.out);
}

TEST_F(Files, NetcdfErrorsAreSentences) {
  try {
    wingbeat::NetcdfFile file(path("no/such/folder/x.nc"));
    FAIL();
  } catch (const wingbeat::NetcdfError& e) {
    EXPECT_THAT(e.what(), HasSubstr("x.nc: cannot create the file: "));
  }
  wingbeat::NetcdfFile file(path("x.nc"));
  const auto d = file.define_dimension("d", 3);
  const auto v = file.define_variable("v", {d}, "m", "a length");
  EXPECT_THROW(file.define_variable("v", {d}, "m", "a length"), wingbeat::NetcdfError);
  EXPECT_THROW(file.write(v, std::vector<double>{1.0, 2.0}), wingbeat::NetcdfError);
  file.write(v, std::vector<double>{1.0, 2.0, 3.0});
  file.close();
}

TEST_F(Files, PlotsAreDrawnInEachFormat) {
  const std::string start[] = {"<?xml", "%PDF-", "\x89PNG"};
  const char* const extensions[] = {".svg", ".pdf", ".png"};
  for (int k = 0; k < 3; ++k) {
    const std::string cycle = path(std::string("cycle") + extensions[k]);
    const std::string power = path(std::string("power") + extensions[k]);
    const Outcome o = run({"run", springs, "--plot", cycle, "--plot-power", power});
    ASSERT_EQ(o.status, 0) << o.err;
    EXPECT_EQ(o.err, "wrote " + cycle + "\nwrote " + power + "\n");
    for (const std::string& file : {cycle, power}) {
      EXPECT_THAT(read(file), testing::StartsWith(start[k]));
      EXPECT_GT(read(file).size(), 4000U) << file;
    }
  }
  const std::string cycle = read(path("cycle.svg"));
  for (const char* title :
       {"stroke angle (deg)", "velocity (rad/s)", "lift (mN)", "rod force (mN)", "power (mW)",
        "time since stroke reversal (ms)", "electrical", "motor output", "aerodynamic", "3.000 V, 23.4"}) {
    EXPECT_THAT(cycle, HasSubstr(title));
  }
  EXPECT_GE(count_of(cycle, "stroke-dasharray"), 4U);
  const std::string power = read(path("power.svg"));
  for (const char* title : {"copper", "viscous", "friction", "aerodynamic", "residual", "power (mW)", "51 %"}) {
    EXPECT_THAT(power, HasSubstr(title));
  }
}

TEST_F(Files, EveryConditionAndFormulationCanBePlotted) {
  for (const char* condition : {"vacuum", "wingless"}) {
    const Outcome o =
        run({"run", plain, "--condition", condition, "--plot", path("c.svg"), "--plot-power", path("p.svg")});
    EXPECT_EQ(o.status, 0) << o.err;
  }
  const std::string form = "transmission.formulation=virtual-work";
  EXPECT_EQ(run({"run", plain, "--set", form, "--plot-power", path("p.svg")}).status, 0);
}

TEST_F(Files, NoNameIsTakenForACommand) {
  const std::string odd = path("| touch 'gone'; `touch gone`\"$(touch gone).svg");
  ASSERT_EQ(run({"run", plain, "--plot", odd}).status, 0);
  EXPECT_THAT(files(), ElementsAre(fs::path(odd).filename().string()));
}

TEST_F(Files, WithoutGnuplotItSaysWhatToInstall) {
  std::ofstream(path("old.svg")) << "old";
  const Outcome o = run({"run", plain, "--json", "--force", "--plot", path("old.svg")}, path("nowhere"));
  EXPECT_EQ(o.status, 1) << o.err;
  EXPECT_THAT(o.err, HasSubstr("apt-get install gnuplot-nox"));
  EXPECT_EQ(read(path("old.svg")), "old");
  EXPECT_THAT(files(), ElementsAre("old.svg"));
}

TEST_F(Files, AGoodFileSurvivesAFailedRun) {
  std::ofstream(path("w.csv")) << "old";
  EXPECT_EQ(run({"run", springs, "--voltage", "0.3 V", "--force", "--waveforms", path("w.csv")}).status, 3);
  EXPECT_EQ(read(path("w.csv")), "old");
  EXPECT_EQ(run({"run", plain, "--force", "--waveforms", path("w.csv"), "--set", "motor.inertia=0"}).status, 2);
  EXPECT_EQ(read(path("w.csv")), "old");
  EXPECT_THAT(files(), ElementsAre("w.csv"));
}

TEST_F(Files, LinksAndModesStay) {
  std::ofstream(path("real.csv")) << "old";
  ::chmod(path("real.csv").c_str(), 0640);
  fs::create_symlink("real.csv", path("link.csv"));
  ASSERT_EQ(run({"run", plain, "--force", "--waveforms", path("link.csv")}).status, 0);
  EXPECT_TRUE(fs::is_symlink(path("link.csv")));
  EXPECT_THAT(read(path("real.csv")), testing::StartsWith("time_s,"));
  struct stat found{};
  ::stat(path("real.csv").c_str(), &found);
  EXPECT_EQ(found.st_mode & 0777, 0640U);
}

TEST_F(Files, PlacesThatCannotBeWrittenAreRefused) {
  fs::create_directory(path("folder.csv"));
  EXPECT_THAT(run({"run", plain, "--waveforms", path("folder.csv")}).err, HasSubstr("it is a folder"));
  ::mkfifo(path("pipe.csv").c_str(), 0600);
  EXPECT_THAT(run({"run", plain, "--waveforms", path("pipe.csv")}).err, HasSubstr("not a regular file"));
  fs::copy_file(plain, path("vehicle.csv"));
  EXPECT_THAT(run({"run", path("vehicle.csv"), "--waveforms", path("vehicle.csv")}).err,
              HasSubstr("is a file that this command reads, which is never overwritten"));
  if (::geteuid() != 0) {
    std::ofstream(path("kept.csv")) << "old";
    fs::permissions(path("kept.csv"), fs::perms::owner_read);
    const Outcome o = run({"run", plain, "--waveforms", path("kept.csv")});
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr("Permission denied"));
  }
}

TEST_F(Files, CompareShowsPublishedValuesBesideOurs) {
  const std::string published = data + "/published/friction2022.toml";
  const Outcome table = run({"compare", published, "--plot-power", path("p.svg")});
  EXPECT_EQ(table.status, 0) << table.out;
  EXPECT_THAT(table.out, HasSubstr("At 3 V"));
  EXPECT_THAT(table.out, HasSubstr("At 22 Hz"));
  EXPECT_THAT(table.out, HasSubstr("5 of 12 values are outside their tolerances."));
  EXPECT_THAT(read(path("p.svg")), HasSubstr("22 Hz, spring on"));
  std::istringstream lines(table.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 90U) << line;

  const Json json = run({"compare", published, "--json"}).json();
  EXPECT_EQ(json["outside"], 5);
  ASSERT_EQ(json["values"].size(), 12U);
  for (const Json& v : json["values"]) {
    EXPECT_NEAR(v["deviation"].get<double>(), v["computed"].get<double>() / v["published"].get<double>() - 1.0, 1e-12);
    EXPECT_EQ(v["tolerance"], 0.05);
    EXPECT_EQ(v["change"].get<bool>(), v["design"].is_null());
  }
}

TEST_F(Files, CompareCountsValuesOutsideTheTolerances) {
  const auto with = [&](const std::string& value) {
    std::ofstream(path("p.toml")) << "title = \"t\"\nsource = \"s\"\n[designs]\na = \"" + plain + "\"\n[[value]]\n" +
                                         value;
    return run({"compare", path("p.toml")});
  };
  const std::string good = "voltage = 3\nmetric = \"frequency_hz\"\ndesign = \"a\"\ntolerance = 0.01\n";
  const Outcome off = with(good + "published = 30.0\n");
  EXPECT_EQ(off.status, 0);
  EXPECT_THAT(off.out, HasSubstr("1 of 1 values are outside their tolerances."));
  EXPECT_EQ(with(good + "published = 21.95\n").status, 0);
  EXPECT_THAT(with(good).err, HasSubstr("published: missing"));
  EXPECT_THAT(with(good + "published = 1\nspeed = 2\n").err, HasSubstr("speed: unknown key"));
  EXPECT_THAT(with("voltage = \"3 kg\"\nmetric = \"frequency_hz\"\n").err, HasSubstr("expected a voltage"));
  EXPECT_THAT(with("voltage = 3\nmetric = \"speed\"\n").err, HasSubstr("is no metric"));
  EXPECT_THAT(with("voltage = 3\nmetric = \"frequency_hz\"\ndesign = \"b\"\n").err, HasSubstr("not among [designs]"));
}

}  // namespace
}  // namespace cli
