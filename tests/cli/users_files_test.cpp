// Nothing of the user's is lost: what is read is never written, outputs never meet, and what the program did not write
// is replaced only on request.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

#include "users_folder.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string reads = "which is never overwritten; give another name";
const std::string foreign = "exists and was not written by wingbeat; give another name, or --force to replace it";

class UsersFiles : public UsersFolder {
 protected:
  /// Exit status 2, one sentence that holds the option with the path and the reason, and the file as it was.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& file, const std::string& option,
                      const std::string& reason) const {
    const std::string before = read(path(file));
    for (const bool force : {false, true}) {
      if (force && reason == foreign) break;
      std::vector<std::string> all = arguments;
      if (force) all.push_back("--force");
      const Outcome o = run(all);
      EXPECT_EQ(o.status, 2) << option << " " << file;
      EXPECT_THAT(o.out, IsEmpty());
      EXPECT_THAT(o.err, HasSubstr("wingbeat: " + option));
      EXPECT_THAT(o.err, HasSubstr(reason));
      EXPECT_EQ(count_of(o.err, "\n"), 1U) << o.err;
      EXPECT_EQ(read(path(file)), before) << option;
    }
    for (const std::string& name : files()) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
  }
};

TEST_F(UsersFiles, NoInputIsWrittenByAnyCommand) {
  fill();
  const std::string link = "air.svg", data_link = "vehicle.nc";
  fs::create_symlink("air.csv", path(link));
  fs::create_hard_link(path("vehicle.toml"), path(data_link));
  fs::create_hard_link(path("vehicle.toml"), path("vehicle.csv"));
  fs::create_hard_link(path("vehicle.toml"), path("vehicle.svg"));
  fs::create_hard_link(path("air.csv"), path("log.toml"));
  const std::string other = "reads and never overwrites; give another name";
  const auto in = [&](const char* name) { return path(name); };

  expect_refused({"run", in("vehicle.toml"), "--waveforms", in("vehicle.csv")}, "vehicle.toml", "--waveforms ", other);
  expect_refused({"run", in("vehicle.toml"), "--waveforms", in("vehicle.nc")}, "vehicle.toml", "--waveforms ", other);
  expect_refused({"run", in("vehicle.toml"), "--plot", in("vehicle.svg")}, "vehicle.toml", "--plot ", other);
  expect_refused({"run", in("vehicle.toml"), "--plot-power", in("vehicle.svg")}, "vehicle.toml", "--plot-power ",
                 other);
  expect_refused({"run", in("vehicle.svg"), "--plot", in("vehicle.svg")}, "vehicle.toml", "--plot ", reads);

  expect_refused({"fit", in("bench.toml"), "-o", in("bench.toml")}, "bench.toml", "-o ", reads);
  expect_refused({"fit", in("bench.toml"), "-o", path("") + "./vehicle.toml"}, "vehicle.toml", "-o ", other);
  expect_refused({"fit", in("bench.toml"), "-o", in("log.toml")}, "air.csv", "-o ", other);
  expect_refused({"fit", in("bench.toml"), "-o", in("air.csv")}, "air.csv", "-o ", "the name must end in .toml");
  expect_refused({"fit", in("bench.toml"), "--plot", in("air.svg")}, "air.csv", "--plot ", other);
  fs::copy_file(path("bench.toml"), path("x.covariance.toml"));
  expect_refused({"fit", in("x.covariance.toml"), "-o", in("x.toml")}, "x.covariance.toml",
                 "-o " + in("x.covariance.toml"), reads);
  EXPECT_FALSE(fs::exists(path("x.toml")));

  expect_refused({"optimise", in("optimise.toml"), "-o", in("optimise.toml")}, "optimise.toml", "-o ", reads);
  expect_refused({"optimise", in("optimise.toml"), "-o", in("vehicle.toml")}, "vehicle.toml", "-o ", reads);
  expect_refused({"optimise", in("optimise.toml"), "--plot", in("vehicle.svg")}, "vehicle.toml", "--plot ", other);

  expect_refused({"tolerance", in("tolerance.toml"), "-o", in("vehicle.nc")}, "vehicle.toml", "-o ", other);
  expect_refused({"tolerance", in("tolerance.toml"), "--plot", in("vehicle.svg")}, "vehicle.toml", "--plot ", other);
  expect_refused({"sweep", in("sweep.toml"), "-o", in("vehicle.nc")}, "vehicle.toml", "-o ", other);
  expect_refused({"sweep", in("sweep.toml"), "-o", in("s.nc"), "--plot", in("vehicle.svg")}, "vehicle.toml", "--plot ",
                 other);
  fs::copy_file(path("sweep.toml"), path("s.nc.journal"));
  expect_refused({"sweep", in("s.nc.journal"), "-o", in("s.nc")}, "s.nc.journal", "-o " + in("s.nc.journal"), reads);

  fs::copy_file(data + "/motors/0816K003SR.toml", path("sheet.toml"));
  expect_refused({"identify-motor", in("sheet.toml"), "-o", in("sheet.toml")}, "sheet.toml", "-o ", reads);
  fs::copy_file(data + "/designs/friction2022-battery.toml", path("battery.toml"));
  fs::create_symlink("battery.toml", path("battery.nc"));
  expect_refused({"endurance", in("battery.toml"), "-o", in("battery.nc")}, "battery.toml", "-o ", other);
  fs::copy_file(data + "/published/friction2022.toml", path("published.svg"));
  write("compare.svg",
        "title = \"t\"\nsource = \"s\"\n[designs]\na = \"vehicle.toml\"\n[[value]]\nvoltage = 3\n"
        "metric = \"frequency_hz\"\ndesign = \"a\"\ntolerance = 0.01\npublished = 30.0\n");
  expect_refused({"compare", in("compare.svg"), "--plot-power", in("compare.svg")}, "compare.svg", "--plot-power ",
                 reads);
  expect_refused({"compare", in("compare.svg"), "--plot-power", in("vehicle.svg")}, "vehicle.toml", "--plot-power ",
                 other);
  for (const char* name : {"vehicle.json", "vehicle.mat", "vehicle.fmu", "same.toml"})
    fs::create_hard_link(path("vehicle.toml"), path(name));
  for (const char* name : {"vehicle.nc", "vehicle.json", "vehicle.mat", "same.toml"}) {
    expect_refused({"linearise", in("vehicle.toml"), "-o", in(name)}, "vehicle.toml", "-o ", other);
  }
  expect_refused({"linearise", in("vehicle.toml"), "--plot", in("vehicle.svg")}, "vehicle.toml", "--plot ", other);
  expect_refused({"export-fmu", in("vehicle.toml"), "-o", in("vehicle.fmu")}, "vehicle.toml", "-o ", other);
  fs::create_symlink("battery.toml", path("battery.svg"));
  expect_refused({"endurance", in("battery.toml"), "--plot", in("battery.svg")}, "battery.toml", "--plot ", other);
}

TEST_F(UsersFiles, WhatAnInputNamesIsAnInputToo) {
  fill();
  std::string vehicle = read(path("vehicle.toml"));
  const auto from = vehicle.find("planform = "), to = vehicle.find('\n', from);
  vehicle.replace(from, to - from, "planform = { shape = \"tabulated\", file = \"chords.csv\" }");
  write("vehicle.toml", vehicle);
  write("chords.csv", "distance_mm,chord_mm\n0,20\n30,22\n60,5\n");
  const std::string other = "reads and never overwrites; give another name";
  expect_refused({"run", path("vehicle.toml"), "--waveforms", path("chords.csv")}, "chords.csv", "--waveforms ",
                 "never over");
  write("catalogue.toml",
        "model,gear_ratio,resistance_ohm,torque_constant_Nm_per_A,rotor_inertia_kgm2,inductance_H,"
        "no_load_current_A,voltage_nominal_V,mass_kg\nA,10,3,0.001,1e-9,0,0.01,3,0.001\n");
  write("motors.toml", read(path("optimise.toml")) + "[motors]\nfile = \"catalogue.toml\"\n");
  const Outcome o = run({"optimise", path("motors.toml"), "-o", path("catalogue.toml")});
  EXPECT_EQ(o.status, 2) << o.err;
  EXPECT_THAT(read(path("catalogue.toml")), testing::StartsWith("model,"));
  write("front.toml", "");
  fs::create_directory(path("designs"));
  std::string front = read(data + "/studies/optimise-pareto.toml");
  const auto named = front.find("vehicle = "), end = front.find('\n', named);
  front.replace(named, end - named, "vehicle = \"../vehicle.toml\"");
  fs::copy_file(springs, path("vehicle.toml"), fs::copy_options::overwrite_existing);
  write("designs/knee.toml", front);
  const Outcome designs = run({"optimise", path("designs/knee.toml"), "--designs", path("designs")});
  EXPECT_EQ(designs.status, 2) << designs.err;
  EXPECT_THAT(designs.err, HasSubstr("--designs " + path("designs/knee.toml") + ": is a file that this command reads"));
  EXPECT_EQ(read(path("designs/knee.toml")), front);
}

TEST_F(UsersFiles, TwoOutputsAreNeverTheSame) {
  fill();
  const std::string same = "is also the file of ";
  expect_refused({"fit", path("bench.toml"), "-o", path("s.svg"), "--plot", path("s.svg")}, "s.svg", "-o ",
                 "the name must end in .toml");
  expect_refused({"run", path("vehicle.toml"), "--plot", path("s.svg"), "--plot-power",
                  path("") + "../" + fs::path(path("")).parent_path().filename().string() + "/s.svg"},
                 "s.svg", "--plot-power ", same + "--plot");
  fs::create_symlink("new.toml", path("link.svg"));
  expect_refused({"fit", path("bench.toml"), "-o", path("new.toml"), "--plot", path("link.svg")}, "new.toml", "--plot ",
                 same + "-o");
  EXPECT_FALSE(fs::exists(path("new.toml")));
}

TEST_F(UsersFiles, NamesSayWhatAFileHolds) {
  fill();
  const auto refused = [&](std::vector<std::string> arguments, const std::string& name, const std::string& endings) {
    arguments.push_back(path(name));
    const Outcome o = run(arguments);
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err,
                HasSubstr(arguments[arguments.size() - 2] + " " + path(name) + ": the name must end in " + endings));
    EXPECT_FALSE(fs::exists(path(name)));
  };
  refused({"optimise", path("optimise.toml"), "-o"}, "x.json", ".toml or .nc\n");
  refused({"fit", path("bench.toml"), "-o"}, "x.json", ".toml\n");
  refused({"fit", path("bench.toml"), "-o"}, "x", ".toml\n");
  refused({"identify-motor", data + "/motors/0816K003SR.toml", "-o"}, "x.json", ".toml\n");
  refused({"tolerance", path("tolerance.toml"), "-o"}, "x.csv", ".nc\n");
  refused({"run", path("vehicle.toml"), "--plot"}, "x.toml", ".svg, .pdf or .png\n");
}

TEST_F(UsersFiles, OwnFilesAreReplacedOthersOnlyByForce) {
  for (const std::string name : {"w.csv", "w.nc", "p.svg", "p.pdf", "p.png"}) {
    const std::string option = name[0] == 'w' ? "--waveforms" : "--plot";
    write(name, "mine");
    const Outcome refused = run({"run", plain, option, path(name)});
    EXPECT_EQ(refused.status, 2);
    EXPECT_EQ(refused.err, "wingbeat: " + option + " " + path(name) + ": " + foreign + "\n");
    EXPECT_EQ(read(path(name)), "mine");
    EXPECT_EQ(run({"run", plain, option, path(name), "--force"}).status, 0);
    EXPECT_NE(read(path(name)), "mine");
    const Outcome again = run({"run", plain, option, path(name)});
    EXPECT_EQ(again.status, 0) << again.err;
  }
  // Drawings of others that come from the same tools.
  std::string drawing = read(path("p.svg"));
  const auto mark = drawing.find("<!-- Drawn by wingbeat -->\n");
  ASSERT_NE(mark, std::string::npos);
  drawing.erase(mark, 27);
  write("p.svg", drawing);
  EXPECT_EQ(run({"run", plain, "--plot", path("p.svg")}).status, 2);
  std::string image = read(path("p.png"));
  image.replace(image.find("Drawn by wingbeat"), 5, "Taken");
  write("p.png", image);
  EXPECT_EQ(run({"run", plain, "--plot", path("p.png")}).status, 2);
  // An empty file holds nothing that could be lost.
  write("e.csv", "");
  EXPECT_EQ(run({"run", plain, "--waveforms", path("e.csv")}).status, 0);

  const std::string sheet = data + "/motors/0816K003SR.toml";
  write("motor.toml", "# my motor\n[motor]\n");
  EXPECT_THAT(run({"identify-motor", sheet, "-o", path("motor.toml")}).err, HasSubstr(foreign));
  EXPECT_EQ(run({"identify-motor", sheet, "-o", path("motor.toml"), "--force"}).status, 0);
  EXPECT_EQ(run({"identify-motor", sheet, "-o", path("motor.toml")}).status, 0);
}

TEST_F(UsersFiles, ADanglingLinkIsFollowedAndStays) {
  fs::create_directory(path("elsewhere"));
  fs::create_symlink("elsewhere/w.csv", path("w.csv"));
  ASSERT_EQ(run({"run", plain, "--waveforms", path("w.csv")}).status, 0);
  EXPECT_TRUE(fs::is_symlink(path("w.csv")));
  EXPECT_THAT(read(path("elsewhere/w.csv")), testing::StartsWith("time_s,"));
  fs::create_symlink("nowhere/w.csv", path("lost.csv"));
  EXPECT_THAT(run({"run", plain, "--waveforms", path("lost.csv")}).err, HasSubstr("there is no folder "));
  fs::create_symlink("b.csv", path("a.csv"));
  fs::create_symlink("a.csv", path("b.csv"));
  EXPECT_THAT(run({"run", plain, "--waveforms", path("a.csv")}).err, HasSubstr("lead round in a circle"));
}

TEST_F(UsersFiles, FileNamesMayHoldLineBreaksAndBackslashes) {
  fs::copy_file(data + "/motors/0816K003SR.toml", path("a\nb = 1.toml"));
  ASSERT_EQ(run({"identify-motor", path("a\nb = 1.toml"), "-o", path("motor.toml")}).status, 0);
  EXPECT_THAT(read(path("motor.toml")), HasSubstr("from a\\nb = 1.toml"));
  fill();
  fs::copy_file(path("optimise.toml"), path("c\nd = 1.toml"));
  ASSERT_EQ(run({"optimise", path("c\nd = 1.toml"), "-o", path("best\n\"x\".toml")}).status, 0);
  EXPECT_EQ(run({"run", path("best\n\"x\".toml")}).status, 0);
  EXPECT_THAT(read(path("best\n\"x\".toml")), HasSubstr("optimise c\\nd = 1.toml:"));

  fs::create_directory(path("with\\backslash"));
  const std::string odd = path("with\\backslash/w\\x.nc");
  const Outcome o = run({"run", plain, "--waveforms", odd});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(wingbeat::NetcdfReader(odd).has("lift_n"));
  const std::string swept = path("with\\backslash/s.nc");
  EXPECT_EQ(run({"sweep", path("sweep.toml"), "-o", swept}).status, 0);
  EXPECT_THAT(run({"sweep", swept, "-o", swept}).out, HasSubstr("holds this sweep already"));
}

TEST_F(UsersFiles, ADiskWithoutRoomIsCalledThat) {
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  // From no room at all to room for nearly all, so that creating, writing and closing each meet the end of it.
  for (const rlim_t room : {0, 2048, 8192, 16384, 40000}) {
    for (const char* name : {"w.nc", "w.csv"}) {
      ::unlink(path("stderr.txt").c_str());
      const rlimit limited{std::max<rlim_t>(room, 512), before.rlim_max};
      ::setrlimit(RLIMIT_FSIZE, &limited);
      const Outcome o = run({"run", plain, "--json", "--waveforms", path(name)}, "", "/dev/null");
      ::setrlimit(RLIMIT_FSIZE, &before);
      EXPECT_EQ(o.status, 1) << name << " " << room;
      EXPECT_THAT(o.err, HasSubstr("File too large")) << name << " " << room;
      EXPECT_THAT(o.err, HasSubstr("wingbeat: --waveforms " + path(name) + ": ")) << name << " " << room;
    }
  }
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(UsersFiles, SignalsLeaveNoFilesBehind) {
  fill();
  write("long.toml", read(data + "/studies/optimise-pareto.toml"));
  std::string text = read(path("long.toml"));
  const auto named = text.find("vehicle = "), end = text.find('\n', named);
  text.replace(named, end - named, "vehicle = \"vehicle.toml\"");
  write("long.toml", text);
  const auto before = files().size();
  for (const int number : {SIGINT, SIGTERM}) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::execl(WINGBEAT_PROGRAM, "wingbeat", "optimise", path("long.toml").c_str(), "-o", path("o.nc").c_str(), "--plot",
              path("o.svg").c_str(), static_cast<char*>(nullptr));
      ::_exit(99);
    }
    const auto parts = [&] {
      std::size_t n = 0;
      for (const std::string& name : files()) n += name.find(".part") != std::string::npos;
      return n;
    };
    for (int wait = 0; wait < 20000 && parts() < 2; ++wait) ::usleep(1000);
    EXPECT_EQ(parts(), 2U);
    ::kill(child, number);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), number);
    EXPECT_EQ(files().size(), before);
  }
}

TEST_F(UsersFiles, ADamagedSweepUnderWayDoesNotBecomeADataSet) {
  fill();
  write("many.toml",
        "[study]\nvehicle = \"vehicle.toml\"\nmetrics = [\"frequency_hz\"]\n[[axis]]\nkey = \"condition\"\n"
        "values = [\"wingless\"]\n[samples]\nmethod = \"sobol\"\ncount = 20000\n[[samples.range]]\n"
        "key = \"supply.voltage\"\nfrom = 2\nto = 4\n");
  ASSERT_EQ(run({"sweep", path("many.toml"), "-o", path("good.nc")}).status, 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl(WINGBEAT_PROGRAM, "wingbeat", "sweep", path("many.toml").c_str(), "-o", path("o.nc").c_str(), "--threads",
            "1", static_cast<char*>(nullptr));
    ::_exit(99);
  }
  const std::string journal = path("o.nc.journal");
  std::error_code error;
  // Beyond the header of the journal: one chunk at least.
  for (int wait = 0; wait < 60000 && fs::file_size(journal, error) + 1 < 48 + 8 * 6 + 16 + 1; ++wait) ::usleep(1000);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ASSERT_TRUE(fs::exists(path("o.nc.part")));
  {
    std::fstream part(path("o.nc.part"), std::ios::in | std::ios::out | std::ios::binary);
    part.seekp(0);
    part.write(std::string(200, '\0').data(), 200);
  }
  const Outcome o = run({"sweep", path("many.toml"), "-o", path("o.nc")});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(read(path("o.nc")) == read(path("good.nc")));
}

}  // namespace
