#include <gmock/gmock.h>
#include <netcdf.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstring>

#include "program.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// A child that is waited for by the test itself.
class Child {
 public:
  Child(std::vector<std::string> arguments, const std::string& errors) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    arguments.insert(arguments.begin(), WINGBEAT_PROGRAM);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    if (::posix_spawn(&id_, WINGBEAT_PROGRAM, &actions, nullptr, argv.data(), environ) != 0) id_ = -1;
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Child() {
    if (id_ > 0) {
      ::kill(id_, SIGKILL);
      wait();
    }
  }
  bool is_running() {
    int status = 0;
    if (id_ > 0 && ::waitpid(id_, &status, WNOHANG) == id_) end(status);
    return id_ > 0;
  }
  /// Nothing once it has been waited for: there is no such process then, and kill(-1) would mean every one.
  void signal(int number) const {
    if (id_ > 0) ::kill(id_, number);
  }
  /// Exit status, or 128 + signal.
  int wait() {
    int status = 0;
    if (id_ > 0) {
      ::waitpid(id_, &status, 0);
      end(status);
    }
    return outcome_;
  }

 private:
  void end(int status) {
    outcome_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    id_ = -1;
  }
  pid_t id_ = -1;
  int outcome_ = -1;
};

class Sweep : public Program {
 protected:
  /// A study of the vehicle with springs.
  std::string study(const std::string& text, const std::string& name = "s.toml") const {
    std::ofstream(path(name)) << "[study]\nvehicle = \"" << springs << "\"\n" << text;
    return path(name);
  }
  std::string small_study() const {
    return study(
        "[[axis]]\nkey = \"springs\"\nvalues = [false, true]\n"
        "[[axis]]\nkey = \"transmission.crank_radius\"\nfrom = \"3 mm\"\nto = \"14 mm\"\ncount = 23\n");
  }
  /// Three chunks, wingless so that each design is quick.
  std::string long_study() const {
    return study(
        "metrics = [\"frequency_hz\", \"power_electrical_w\"]\n[[axis]]\nkey = \"condition\"\n"
        "values = [\"wingless\"]\n[samples]\nmethod = \"sobol\"\ncount = 20000\n[[samples.range]]\n"
        "key = \"supply.voltage\"\nfrom = 2\nto = 4\n[[samples.range]]\nkey = \"motor.inertia\"\n"
        "from = 1e-7\nto = 2e-7\n",
        "long.toml");
  }
  /// The journal's chunks: what lies beyond its header, 16 bytes each.
  static long chunks_in(const std::string& journal, long columns) {
    struct stat found{};
    if (::stat(journal.c_str(), &found) != 0) return 0;
    return (long(found.st_size) - 48 - 8 * (columns + 2)) / 16;
  }
  Outcome shell(const std::string& command) const {
    const std::string whole = command + " >" + path("stdout.txt") + " 2>" + path("stderr.txt");
    const int status = std::system(whole.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(path("stdout.txt")), read(path("stderr.txt"))};
  }
};

TEST_F(Sweep, EachDesignIsWhatARunOfItGives) {
  const Outcome o = run({"sweep", small_study(), "-o", path("o.nc")});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.err, "wrote " + path("o.nc") + "\n");
  EXPECT_THAT(o.out, HasSubstr("46 designs (2 x 23); 46 computed in "));
  EXPECT_THAT(o.out, HasSubstr("\n  flapping "));
  EXPECT_THAT(o.out, HasSubstr("maximum mean lift: "));
  EXPECT_THAT(files(), UnorderedElementsAre("s.toml", "o.nc"));

  const wingbeat::NetcdfReader file(path("o.nc"));
  const auto status = file.read("status"), radius = file.read("transmission_crank_radius");
  ASSERT_EQ(status.size(), 46U);
  for (const std::size_t n : {0U, 4U, 17U, 22U, 23U, 30U, 45U}) {
    char set[80];
    std::snprintf(set, sizeof set, "transmission.crank_radius=%.17g", radius.at(n % 23));
    const Json json = run({"run", n < 23 ? plain : springs, "--json", "--set", set}).json();
    EXPECT_EQ(status[n] == 0.0, json["status"] == "flapping") << n;
    for (const auto& metric : wingbeat::metric_table()) {
      // A data set has no temperatures where no motor is said to heat up, no added mass and no pitching where none is,
      // no Reynolds number of wings without a shape, and the flight where it is asked for.
      const std::string_view key = metric.key;
      const bool pitching = key.starts_with("pitch_") || key == "power_hinge_w" || key == "angle_of_attack_max_deg";
      const bool option = pitching || key.find("temperature") != std::string_view::npos ||
                          key == "added_mass_inertia_ratio" || key == "lift_added_mass_share" ||
                          key == "power_electronics_w" || key == "reynolds_number" || key == "hover_s" ||
                          key == "endurance_s" || key == "stroke_angle_max_rad" || key == "induced_velocity_m_per_s";
      if (json[metric.key].is_null() && option) continue;
      const double swept = file.read(metric.key)[n];
      if (json[metric.key].is_null()) {
        EXPECT_TRUE(std::isnan(swept)) << metric.key;
      } else {
        const double single = json[metric.key];
        EXPECT_NEAR(swept, single, 1e-5 * std::abs(single) + 1e-8) << metric.key;
      }
    }
  }
}

TEST_F(Sweep, TheSameBytesWhateverTheThreads) {
  const std::string s = long_study();
  ASSERT_EQ(run({"sweep", s, "-o", path("one.nc"), "--threads", "1"}).status, 0);
  ASSERT_EQ(run({"sweep", s, "-o", path("two.nc"), "--threads", "2"}).status, 0);
  EXPECT_TRUE(read(path("one.nc")) == read(path("two.nc")));
}

#ifdef WINGBEAT_MPIRUN
TEST_F(Sweep, TheSameBytesWhateverTheRanks) {
  const std::string mpirun = WINGBEAT_MPIRUN " --allow-run-as-root --oversubscribe -n 2 " WINGBEAT_PROGRAM;
  const std::string s = long_study();
  ASSERT_EQ(run({"sweep", s, "-o", path("one.nc"), "--threads", "1"}).status, 0);
  // Open MPI does not free all it allocates, which is not the program's leak.
  setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
  const Outcome o = shell(mpirun + " sweep " + s + " -o " + path("mpi.nc"));
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(count_of(o.err, "wrote " + path("mpi.nc")), 1U) << o.err;
  EXPECT_TRUE(read(path("one.nc")) == read(path("mpi.nc")));
  const Outcome bad = shell(mpirun + " sweep " + s + " -o " + path("none/mpi.nc"));
  unsetenv("ASAN_OPTIONS");
  EXPECT_EQ(bad.status, 2);
  EXPECT_EQ(count_of(bad.err, "there is no folder"), 1U) << bad.err;
}
#endif

TEST_F(Sweep, KilledAndResumedIsTheSameAsNeverKilled) {
  const std::string s = long_study();
  ASSERT_EQ(run({"sweep", s, "-o", path("plain.nc")}).status, 0);
  bool killed = false;
  for (int attempt = 0; attempt < 20 && !fs::exists(path("o.nc")); ++attempt) {
    Child child({"sweep", s, "-o", path("o.nc"), "--threads", "1"}, path("stderr.txt"));
    // Killed as soon as one more chunk is in the journal, at whatever it does then.
    const long before = chunks_in(path("o.nc.journal"), 5);
    while (child.is_running() && chunks_in(path("o.nc.journal"), 5) <= std::max(before, 0L)) ::usleep(500);
    child.signal(SIGKILL);
    killed = child.wait() == 128 + SIGKILL || killed;
  }
  EXPECT_TRUE(killed);
  const Outcome o = run({"sweep", s, "-o", path("o.nc")});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(read(path("o.nc")) == read(path("plain.nc")));
  EXPECT_FALSE(fs::exists(path("o.nc.part")));
  EXPECT_FALSE(fs::exists(path("o.nc.journal")));
}

TEST_F(Sweep, ADamagedChunkIsComputedAgain) {
  const std::string s = long_study();
  ASSERT_EQ(run({"sweep", s, "-o", path("plain.nc")}).status, 0);
  {
    Child child({"sweep", s, "-o", path("o.nc"), "--threads", "1"}, path("stderr.txt"));
    while (child.is_running() && chunks_in(path("o.nc.journal"), 5) < 2) ::usleep(500);
    child.signal(SIGKILL);
    child.wait();
  }
  if (!fs::exists(path("o.nc"))) {
    std::fstream part(path("o.nc.part"), std::ios::in | std::ios::out | std::ios::binary);
    part.seekp(-40, std::ios::end);
    part.write("damaged!", 8);
    std::fstream journal(path("o.nc.journal"), std::ios::in | std::ios::out | std::ios::binary | std::ios::ate);
    journal.write("half a rec", 10);
  }
  ASSERT_EQ(run({"sweep", s, "-o", path("o.nc")}).status, 0);
  EXPECT_TRUE(read(path("o.nc")) == read(path("plain.nc")));
}

TEST_F(Sweep, AJournalThatAKillLeftBesideTheDataSetGoes) {
  const std::string s = long_study();
  {
    Child child({"sweep", s, "-o", path("o.nc"), "--threads", "1"}, path("stderr.txt"));
    while (child.is_running() && chunks_in(path("o.nc.journal"), 5) < 1) ::usleep(500);
    child.signal(SIGKILL);
    child.wait();
  }
  ASSERT_TRUE(fs::exists(path("o.nc.journal")));
  fs::copy_file(path("o.nc.journal"), path("journal"));
  ASSERT_EQ(run({"sweep", s, "-o", path("o.nc")}).status, 0);
  // As it is between the two last steps: the data set has its name, the journal is still there.
  fs::rename(path("journal"), path("o.nc.journal"));
  EXPECT_THAT(run({"sweep", s, "-o", path("o.nc")}).out, HasSubstr("holds this sweep already"));
  EXPECT_FALSE(fs::exists(path("o.nc.journal")));
  // Of another sweep it is left.
  std::ofstream(path("o.nc.journal")) << "wingbeat sweep\n" << std::string(1, '\0') + std::string(32, 'x');
  EXPECT_EQ(run({"sweep", s, "-o", path("o.nc")}).status, 0);
  EXPECT_TRUE(fs::exists(path("o.nc.journal")));
}

TEST_F(Sweep, CtrlCEndsAfterTheChunksUnderWay) {
  const std::string s = long_study();
  Child child({"sweep", s, "-o", path("o.nc"), "--threads", "1"}, path("stderr.txt"));
  while (child.is_running() && chunks_in(path("o.nc.journal"), 5) < 1) ::usleep(500);
  child.signal(SIGINT);
  const int status = child.wait();
  if (status != 0) {
    EXPECT_EQ(status, 1);
    const std::string said = read(path("stderr.txt"));
    EXPECT_THAT(said, HasSubstr("wingbeat: stopped after "));
    EXPECT_THAT(said, HasSubstr(" of 20,000 designs; they are kept in "));
    EXPECT_THAT(said, HasSubstr("o.nc.part, and the same command resumes\n"));
    const Outcome o = run({"sweep", s, "-o", path("o.nc")});
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_THAT(o.out, HasSubstr(" of them from before; "));
  }
  EXPECT_THAT(run({"sweep", s, "-o", path("o.nc")}).out, HasSubstr("holds this sweep already: nothing to compute"));
}

TEST_F(Sweep, WhatIsThereIsNeverOverwritten) {
  const std::string s = small_study();
  const auto refused = [&](const std::string& name, const std::string& reason) {
    const std::string before = read(path(name));
    const Outcome o = run({"sweep", s, "-o", path("o.nc")});
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr(reason));
    EXPECT_EQ(count_of(o.err, "\n"), 1U);
    EXPECT_EQ(read(path(name)), before);
  };
  std::ofstream(path("o.nc")) << "a text";
  refused("o.nc", "o.nc: exists and cannot be read as a data set (foreign, damaged or cut off); it is left as it is");
  fs::remove(path("o.nc"));
  ASSERT_EQ(run({"run", plain, "--waveforms", path("o.nc")}).status, 0);
  refused("o.nc", "exists and is no data set of wingbeat sweep");
  fs::remove(path("o.nc"));
  ASSERT_EQ(run({"sweep", s, "-o", path("o.nc")}).status, 0);
  fs::resize_file(path("o.nc"), fs::file_size(path("o.nc")) - 100);
  refused("o.nc", "(foreign, damaged or cut off)");
  fs::remove(path("o.nc"));
  ASSERT_EQ(run({"sweep", s, "-o", path("o.nc"), "--tolerance", "1e-5"}).status, 0);
  refused("o.nc", "holds another sweep (another study, vehicle, option or version of the program)");
  fs::remove(path("o.nc"));
  std::ofstream(path("o.nc.part")) << "mine";
  refused("o.nc.part", "o.nc.part: exists without o.nc.journal");
  std::ofstream(path("o.nc.journal")) << "a text";
  refused("o.nc.journal", "is no journal of a sweep");
  std::ofstream(path("o.nc.journal")) << "wingbeat sweep\n" << std::string(33, '\0') + "x";
  refused("o.nc.journal", "belongs to another sweep");
}

TEST_F(Sweep, PlacesThatCannotBeWrittenAreRefused) {
  const std::string s = small_study();
  EXPECT_THAT(run({"sweep", s, "-o", path("none/o.nc")}).err, HasSubstr("there is no folder "));
  EXPECT_THAT(run({"sweep", s, "-o", path("o.csv")}).err, HasSubstr("the name must end in .nc"));
  fs::create_directory(path("d.nc"));
  EXPECT_THAT(run({"sweep", s, "-o", path("d.nc")}).err, HasSubstr("is a folder"));
  if (::geteuid() != 0) {
    fs::create_directory(path("closed"));
    ::chmod(path("closed").c_str(), 0555);
    EXPECT_THAT(run({"sweep", s, "-o", path("closed/o.nc")}).err, HasSubstr("Permission denied"));
  }
  const Outcome sealed = run({"sweep", s, "-o", "/proc/self/o.nc"});
  EXPECT_EQ(sealed.status, 2);
  EXPECT_THAT(sealed.err, HasSubstr("cannot be written"));
}

TEST_F(Sweep, NoRoomIsAnErrorThatKeepsNothingHalf) {
  const Outcome o = shell("ulimit -f 100; " WINGBEAT_PROGRAM " sweep " + long_study() + " -o " + path("o.nc"));
  EXPECT_EQ(o.status, 1);
  EXPECT_THAT(o.err, HasSubstr("o.nc.part: cannot be written: File too large; the data set needs 0.9"));
  EXPECT_THAT(files(), ElementsAre("long.toml"));
}

TEST_F(Sweep, WhereNothingFlapsThePlotShowsTheStatuses) {
  const std::string stuck = "[set]\nmotor.friction_torque = \"20 mN m\"\n";
  const std::string volts = "[[axis]]\nkey = \"supply.voltage\"\nfrom = \"0.5 V\"\nto = \"3 V\"\ncount = 6\n";
  const Outcome lines = run({"sweep", study(stuck + volts), "-o", path("o.nc"), "--plot", path("o.svg")});
  EXPECT_EQ(lines.status, 0);
  EXPECT_EQ(lines.err, "wrote " + path("o.nc") + "\nwrote " + path("o.svg") + "\n");
  EXPECT_THAT(read(path("o.svg")), HasSubstr("nothing flaps: 6 stalled"));
  const std::string crank =
      "[[axis]]\nkey = \"transmission.crank_radius\"\nfrom = \"4 mm\"\nto = \"5 mm\"\ncount = 3\n";
  const Outcome contours = run({"sweep", study(stuck + volts + crank), "-o", path("p.nc"), "--plot", path("p.svg")});
  EXPECT_EQ(contours.status, 0);
  EXPECT_EQ(contours.err, "wrote " + path("p.nc") + "\nwrote " + path("p.svg") + "\n");
  EXPECT_THAT(read(path("p.svg")), HasSubstr("nothing flaps: 18 stalled"));
}

TEST_F(Sweep, ADataSetCanBeRunAgain) {
  std::ofstream(path("d.csv")) << "supply.voltage [V],motor.torque_constant [N m/A]\n3,0.01\n2.5,0.011\n";
  const std::string s = study(
      "title = \"again\"\n[set]\nfriction.radius = \"1 mm\"\n[[axis]]\n"
      "key = \"transmission.formulation\"\nvalues = [\"rod-force\", \"virtual-work\"]\n"
      "[samples]\nmethod = \"csv\"\nfile = \"d.csv\"\n");
  ASSERT_EQ(run({"sweep", s, "-o", path("o.nc")}).status, 0);
  fs::remove(s);
  fs::remove(path("d.csv"));
  const Outcome o = run({"sweep", path("o.nc"), "-o", path("p.nc")});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(read(path("o.nc")) == read(path("p.nc")));
  EXPECT_THAT(run({"sweep", path("none.nc"), "-o", path("q.nc")}).err, HasSubstr("none.nc: no such file"));
  ASSERT_EQ(run({"run", plain, "--waveforms", path("w.nc")}).status, 0);
  EXPECT_THAT(run({"sweep", path("w.nc"), "-o", path("q.nc")}).err, HasSubstr("holds no study"));
}

TEST_F(Sweep, HeldFrequenciesComeWithTheirVoltages) {
  const std::string s = study(
      "hold = { frequency = \"22 Hz\" }\n[[axis]]\nkey = \"friction.radius\"\n"
      "values = [\"1 mm\", \"2.5 mm\"]\n");
  ASSERT_EQ(run({"sweep", s, "-o", path("o.nc")}).status, 0);
  const wingbeat::NetcdfReader file(path("o.nc"));
  for (const double f : file.read("frequency_hz")) EXPECT_NEAR(f, 22.0, 22e-6);
  const Json json = run({"run", springs, "--json", "--frequency", "22 Hz"}).json();
  EXPECT_NEAR(file.read("voltage_v")[1] / json["voltage_v"].get<double>(), 1.0, 2e-6);
  EXPECT_NEAR(file.read("lift_mean_n")[1] / json["lift_mean_n"].get<double>(), 1.0, 5e-6);
}

TEST_F(Sweep, XarrayFindsCoordinatesUnitsAndValues) {
  ASSERT_EQ(run({"sweep", small_study(), "-o", path("o.nc")}).status, 0);
  const Outcome o = shell(
      "/usr/bin/python3 -c \"import xarray\nd = xarray.open_dataset('" + path("o.nc") +
      "')\nassert d.lift_mean_n.dims == ('springs', 'transmission_crank_radius')\n"
      "assert d.lift_mean_n.units == 'N' and d.transmission_crank_radius.units == 'm'\n"
      "assert list(d.springs.values) == ['off', 'on']\n"
      "assert d.status.flag_meanings.split()[0] == 'flapping' and list(d.status.flag_values) == [0, 1, 2, 3, 4, 5, 6]\n"
      "x = d.sel(springs='on').sel(transmission_crank_radius=5e-3, method='nearest')\n"
      "assert x.status == 0 and 0.01 < x.lift_mean_n < 0.013\n"
      "assert d.lift_mean_n.where(d.status == 0).notnull().sum() == (d.status == 0).sum()\n"
      "assert 'crank_radius' in d.study and 'armature' in d.vehicle and d.wingbeat_version\nprint('good')\"");
  EXPECT_EQ(o.out, "good\n") << o.err;
}

TEST_F(Sweep, OctaveFindsCoordinatesUnitsAndValues) {
  ASSERT_EQ(run({"sweep", small_study(), "-o", path("o.nc")}).status, 0);
  std::ofstream(path("check.m"))
      << "pkg load netcdf\nf = '" + path("o.nc") +
             "';\n"
             "lift = ncread(f, 'lift_mean_n');\nr = ncread(f, 'transmission_crank_radius');\n"
             "assert(size(lift), [23 2]);\nassert(r(1), 3e-3, 1e-12);\n"
             "assert(ncreadatt(f, 'lift_mean_n', 'units'), 'N');\n"
             "assert(ncreadatt(f, 'transmission_crank_radius', 'units'), 'm');\n"
             "s = ncread(f, 'status');\nassert(double(s(5, 2)), 0);\n"
             "names = ncread(f, 'springs')';\nassert(names(2, 1:2), 'on');\n"
             "assert(strsplit(ncreadatt(f, 'status', 'flag_meanings'), ' '){1}, 'flapping');\n"
             "assert(lift(5, 2) > 0.01 && lift(5, 2) < 0.013);\nprintf('good\\n');\n";
  const Outcome o = shell("octave-cli --no-init-file --quiet " + path("check.m"));
  EXPECT_THAT(o.out, HasSubstr("good\n")) << o.err;
}

TEST_F(Sweep, PlotsAreDrawn) {
  const std::string s = small_study();
  const Outcome lines = run({"sweep", s, "-o", path("o.nc"), "--plot", path("o.svg")});
  ASSERT_EQ(lines.status, 0) << lines.err;
  const std::string svg = read(path("o.svg"));
  for (const char* text : {"crank radius (mm)", "mean lift (mN)", "system efficiency (%)", "springs off", "springs on",
                           "circle: best", "no line: does not flap"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  EXPECT_EQ(run({"sweep", s, "-o", path("o.nc"), "--plot", path("f.pdf"), "--plot-metric", "frequency_hz"}).err,
            "wrote " + path("f.pdf") + "\n");
  EXPECT_THAT(read(path("f.pdf")), testing::StartsWith("%PDF-"));

  const std::string two = study(
      "[[axis]]\nkey = \"transmission.crank_radius\"\nfrom = \"3 mm\"\nto = \"13 mm\"\ncount = 6\n"
      "[[axis]]\nkey = \"supply.voltage\"\nfrom = 1\nto = 8\ncount = 5\n",
      "two.toml");
  ASSERT_EQ(run({"sweep", two, "-o", path("t.nc"), "--plot", path("t.svg")}).status, 0);
  const std::string contours = read(path("t.svg"));
  for (const char* text :
       {"crank radius (mm)", "supply voltage (V)", "circle: best", "grey: does not flap", "dashed: lift = weight"}) {
    EXPECT_THAT(contours, HasSubstr(text));
  }

  // Two numbers beside many are two curves.
  const std::string few = study(
      "[[axis]]\nkey = \"supply.voltage\"\nvalues = [3, 4]\n"
      "[[axis]]\nkey = \"spring.stiffness\"\nfrom = 1e-4\nto = 2e-3\ncount = 10\n",
      "few.toml");
  const Outcome drawn = run({"sweep", few, "-o", path("c.nc"), "--plot", path("c.svg")});
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  const std::string curves = read(path("c.svg"));
  for (const char* text : {"spring stiffness (mN m/rad)", "supply voltage 3 V", "supply voltage 4 V"}) {
    EXPECT_THAT(curves, HasSubstr(text));
  }
}

// The most efficient designs do not carry their weight: report and plots pass them over alike.
TEST_F(Sweep, ReportAndPlotsAgreeAboutTheBestDesign) {
  const auto after = [](const std::string& text, const std::string& label) {
    const auto position = text.rfind(label);
    return position == std::string::npos ? NAN : std::stod(text.substr(position + label.size()));
  };
  const std::string volts = "[[axis]]\nkey = \"supply.voltage\"\nfrom = 1\nto = 8\ncount = 15\n";
  const std::string crank =
      "[[axis]]\nkey = \"transmission.crank_radius\"\nfrom = \"4 mm\"\nto = \"6 mm\"\ncount = 5\n";
  for (const std::string& axes : {volts, volts + crank}) {
    const std::string s = study(axes);
    const Outcome o =
        run({"sweep", s, "-o", path("o.nc"), "--plot", path("o.svg"), "--plot-metrics", "efficiency_system"});
    ASSERT_EQ(o.status, 0) << o.err;
    const wingbeat::NetcdfReader file(path("o.nc"));
    const auto efficiency = file.read("efficiency_system"), weight = file.read("lift_to_weight");
    double best = 0.0, highest = 0.0;
    for (std::size_t n = 0; n < efficiency.size(); ++n) {
      if (!std::isfinite(efficiency[n])) continue;
      highest = std::max(highest, efficiency[n]);
      if (weight[n] >= 1.0) best = std::max(best, efficiency[n]);
    }
    ASSERT_GT(best, 0.0);
    EXPECT_GT(highest, 1.1 * best);
    EXPECT_NEAR(after(o.out, "maximum efficiency: "), 100.0 * best, 0.01);
    EXPECT_THAT(o.out, HasSubstr("weight)"));
    EXPECT_NEAR(after(read(path("o.svg")), "circle: best "), 100.0 * best, 0.01);
    fs::remove(path("o.nc"));
  }
}

TEST_F(Sweep, PlotsThatCannotBeAreRefusedBeforeComputing) {
  const std::string s = small_study();
  const auto refused = [&](std::vector<std::string> more, const std::string& reason) {
    std::vector<std::string> arguments = {"sweep", s, "-o", path("o.nc")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome o = run(arguments);
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr(reason));
    EXPECT_FALSE(fs::exists(path("o.nc")));
  };
  refused({"--plot", path("o.txt")}, "the name must end in .svg, .pdf, .png or .html");
  refused({"--plot", path("o.svg"), "--plot-metric", "lift"}, "\"lift\" is not among the study's metrics: voltage_v,");
  refused({"--plot-metric", "lift_mean_n"}, "--plot-metric requires --plot");
  EXPECT_THAT(run({"sweep", long_study(), "-o", path("o.nc"), "--plot", path("o.svg")}).err,
              HasSubstr("samples have no order to be drawn in"));
}

TEST_F(Sweep, WrongOptionsAreRefused) {
  const std::string s = small_study();
  EXPECT_THAT(run({"sweep", s}).err, HasSubstr("--output is required"));
  EXPECT_THAT(run({"sweep", s, "-o", path("o.nc"), "--isa", "mmx"}).err,
              HasSubstr("--isa mmx: must be sse2, avx2 or avx512"));
  EXPECT_THAT(run({"sweep", s, "-o", path("o.nc"), "--tolerance", "1"}).err,
              HasSubstr("--tolerance 1: must be a number between 1e-12 and 1e-2"));
  EXPECT_EQ(run({"sweep", s, "-o", path("o.nc"), "--threads", "0"}).status, 2);
  EXPECT_THAT(run({"sweep", path("none.toml"), "-o", path("o.nc")}).err, HasSubstr("none.toml: no such file"));
  EXPECT_THAT(run({"sweep", "--help"}).out, HasSubstr("wingbeat sweep crank-radius -o"));
}

}  // namespace
}  // namespace cli
