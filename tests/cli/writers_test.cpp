// Every output of every command on a full disk and killed: complete under its name, or not there.
#include <gmock/gmock.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>

#include "users_folder.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;

/// An output; the arguments end in the option that takes its name.
struct Writer {
  std::string name;
  std::vector<std::string> arguments;
  std::string output;
  bool kept_under_way = false;  ///< a sweep resumes
};
/// How GoogleTest shows it in the names of tests.
void PrintTo(const Writer& writer, std::ostream* out) { *out << writer.name; }

std::vector<Writer> writers() {
  const std::string vehicle = "vehicle.toml", linear = "linearise", sheet = data + "/motors/0816K003SR.toml";
  const std::string battery = data + "/designs/friction2022-battery.toml";
  std::vector<Writer> all = {
      {"new", {"new"}, "x.toml"},
      {"identify_motor", {"identify-motor", sheet, "-o"}, "x.toml"},
      {"fit", {"fit", "bench.toml", "-o"}, "x.toml"},
      {"fit_plot", {"fit", "bench.toml", "--plot"}, "x.svg"},
      {"tolerance", {"tolerance", "tolerance.toml", "-o"}, "x.nc"},
      {"tolerance_plot", {"tolerance", "tolerance.toml", "--plot"}, "x.pdf"},
      {"optimise_toml", {"optimise", "optimise.toml", "-o"}, "x.toml"},
      {"optimise_nc", {"optimise", "optimise.toml", "-o"}, "x.nc"},
      {"optimise_plot", {"optimise", "optimise.toml", "--plot"}, "x.png"},
      {"sweep", {"sweep", "sweep.toml", "-o"}, "x.nc", true},
      {"sweep_plot", {"sweep", "sweep.toml", "-o", "s.nc", "--plot"}, "x.svg"},
      {"endurance", {"endurance", battery, "-o"}, "x.nc"},
      {"endurance_plot", {"endurance", battery, "--plot"}, "x.svg"},
      {"linearise_plot", {linear, vehicle, "--no-maps", "--plot"}, "x.svg"},
#ifndef WINGBEAT_SANITIZED  // a build with sanitizers makes no binary of FMUs
      {"export_fmu", {"export-fmu", vehicle, "-o"}, "x.fmu"},
#endif
      {"compare_plot", {"compare", "compare.toml", "--plot-power"}, "x.svg"},
  };
  for (const std::string ending : {"csv", "nc"}) {
    all.push_back({"waveforms_" + ending, {"run", vehicle, "--waveforms"}, "x." + ending});
  }
  for (const std::string ending : {"svg", "pdf", "png"}) {
    all.push_back({"plot_" + ending, {"run", vehicle, "--plot"}, "x." + ending});
    all.push_back({"plot_power_" + ending, {"run", vehicle, "--plot-power"}, "x." + ending});
  }
  for (const std::string ending : {"toml", "json", "nc", "mat"}) {
    all.push_back({"linearise_" + ending, {linear, vehicle, "--no-maps", "-o"}, "x." + ending});
  }
  return all;
}

class Writers : public UsersFolder, public testing::WithParamInterface<Writer> {
 protected:
  void SetUp() override {
    fill();
    write("compare.toml",
          "title = \"t\"\nsource = \"s\"\n[designs]\na = \"vehicle.toml\"\n[[value]]\nvoltage = 3\n"
          "metric = \"frequency_hz\"\ndesign = \"a\"\ntolerance = 0.01\npublished = 30.0\n");
    before_ = files();
  }

  std::vector<std::string> command() const {
    std::vector<std::string> all = GetParam().arguments;
    for (std::string& a : all) {
      if (fs::exists(path(a)) || a == "s.nc") a = path(a);
    }
    all.push_back(path(GetParam().output));
    return all;
  }

  /// What is in the folder and was not there at the beginning, but for `allowed`.
  std::vector<std::string> added(const std::vector<std::string>& allowed = {}) const {
    std::vector<std::string> names;
    for (const std::string& name : files()) {
      const auto is = [&](const auto& list) { return std::find(list.begin(), list.end(), name) != list.end(); };
      if (!is(before_) && !is(allowed)) names.push_back(name);
    }
    return names;
  }

  struct Limited {
    int status = -1;
    std::string err;
  };
  /// Runs with a limit on the size of files, which a disk without room looks like; standard streams are pipes.
  Limited run_within(rlim_t size) const {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe(ends.data()), 0);
    std::vector<std::string> arguments = command();
    arguments.insert(arguments.begin(), WINGBEAT_PROGRAM);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
      const rlimit limit{size, size};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      const int nowhere = ::open("/dev/null", O_RDWR);
      ::dup2(nowhere, 0);
      ::dup2(nowhere, 1);
      ::dup2(ends[1], 2);
      ::close(ends[0]);
      ::close(ends[1]);
      ::execv(WINGBEAT_PROGRAM, argv.data());
      ::_exit(99);
    }
    ::close(ends[1]);
    Limited outcome;
    std::array<char, 4096> bytes{};
    for (ssize_t n = 0; (n = ::read(ends[0], bytes.data(), bytes.size())) > 0;)
      outcome.err.append(bytes.data(), std::size_t(n));
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return outcome;
  }

  std::vector<std::string> before_;
};

TEST_P(Writers, AFullDiskIsAnErrorAndNoFile) {
  const std::string output = path(GetParam().output);
  const Outcome complete = run(command());
  ASSERT_EQ(complete.status, 0) << complete.err;
  const std::string content = read(output);
  ASSERT_FALSE(content.empty());
  const std::vector<std::string> with = added();
  const auto expect_error = [&](const Limited& o, rlim_t size) {
    EXPECT_EQ(o.status, 1) << size << " " << o.err;
    EXPECT_THAT(o.err, HasSubstr("wingbeat: ")) << size;
    // A program under the limit may be stopped by it in a place that the system does not report.
    EXPECT_THAT(o.err,
                testing::AnyOf(HasSubstr("File too large"), HasSubstr("is missing"), HasSubstr("cannot be written")))
        << size;
    EXPECT_THAT(o.err, testing::Not(HasSubstr("wrote " + output + "\n"))) << size;
    EXPECT_THAT(o.err, testing::Not(HasSubstr(".part"))) << size;
  };
  if (GetParam().name != "new" && GetParam().name != "sweep") {  // one never replaces, the other is there already
    const rlim_t half = content.size() / 2;
    expect_error(run_within(half), half);
    EXPECT_EQ(read(output) == content, true);
  }
  fs::remove(output);  // and not the data set of a plot, which would be the one without room
  const rlim_t short_of = content.size() - 1;
  const Limited o = run_within(short_of);
  if (GetParam().kept_under_way) {
    EXPECT_EQ(o.status, 1);
    EXPECT_THAT(o.err, HasSubstr("cannot be written: File too large"));
  } else {
    expect_error(o, short_of);
  }
  EXPECT_FALSE(fs::exists(output));
  for (const std::string& name : added()) EXPECT_THAT(with, testing::Contains(name));
}

TEST_P(Writers, KilledItLeavesNothingHalfAndTheNextRunTidiesUp) {
  const std::string output = path(GetParam().output);
  std::vector<std::string> arguments = command();
  arguments.insert(arguments.begin(), WINGBEAT_PROGRAM);
  std::vector<char*> argv;
  for (std::string& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  const auto under_way = [&] {
    const std::vector<std::string> names = files();
    return std::count_if(names.begin(), names.end(), [](const std::string& n) { return n.starts_with(".wingbeat-"); });
  };
  const pid_t child = ::fork();
  if (child == 0) {
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, 1);
    ::dup2(nowhere, 2);
    ::execv(WINGBEAT_PROGRAM, argv.data());
    ::_exit(99);
  }
  int status = 0;
  while (under_way() == 0 && !fs::exists(output + ".part") && ::waitpid(child, &status, WNOHANG) == 0) ::usleep(200);
  ::kill(child, SIGKILL);
  ::waitpid(child, &status, 0);
  const bool was_complete = fs::exists(output);
  const std::string first = was_complete ? read(output) : "";
  if (was_complete && GetParam().name == "new") fs::remove(output);
  const Outcome o = run(command());
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(under_way(), 0);
  EXPECT_FALSE(fs::exists(output + ".part"));
  EXPECT_FALSE(fs::exists(output + ".journal"));
  if (was_complete) {
    EXPECT_EQ(first.size(), read(output).size());
  }
}

INSTANTIATE_TEST_SUITE_P(Outputs, Writers, testing::ValuesIn(writers()),
                         [](const auto& tested) { return tested.param.name; });

class Drawings : public UsersFolder {
 protected:
  /// A program called gnuplot, in place of the one that is installed.
  std::string in_place_of_gnuplot(const std::string& script) const {
    fs::create_directory(path("bin"));
    write("bin/gnuplot", "#!/bin/sh\n" + script);
    fs::permissions(path("bin/gnuplot"), fs::perms::owner_all);
    return path("bin") + ":/usr/bin:/bin";
  }
};

TEST_F(Drawings, ADrawingThatIsCutOffIsNoDrawing) {
  const struct {
    const char *name, *begin, *missing;
  } formats[] = {{"x.svg", "<?xml version=\"1.0\"?>\\n<svg xmlns=\"http://www.w3.org/2000/svg\">", "its end, </svg>"},
                 {"x.pdf", "%%PDF-1.5\\n", "its end, %%EOF"},
                 {"x.png", "\\211PNG\\r\\n\\032\\n", "its end, the chunk IEND"}};
  for (const auto& [name, begin, missing] : formats) {
    const std::string search = in_place_of_gnuplot("cat >/dev/null\nprintf '" + std::string(begin) +
                                                   "'\nhead -c 5000 /dev/zero | tr '\\0' ' '\nexit 0\n");
    const Outcome o = run({"run", springs, "--plot", path(name)}, search);
    EXPECT_EQ(o.status, 1) << name;
    EXPECT_THAT(o.err, HasSubstr(std::string("what it drew lacks ") + missing)) << o.err;
    EXPECT_FALSE(fs::exists(path(name)));
  }
  const std::string search = in_place_of_gnuplot("cat >/dev/null\nprintf 'odd \\033[31mreason\\n' >&2\nexit 1\n");
  const Outcome failed = run({"run", springs, "--plot", path("x.svg")}, search);
  EXPECT_EQ(failed.status, 1);
  EXPECT_EQ(count_of(failed.err, "gnuplot failed: odd \\u001b[31mreason\n"), 1U) << failed.err;
}

TEST_F(Drawings, KilledWhileGnuplotDrawsNothingStays) {
  const std::string search =
      in_place_of_gnuplot("cat >/dev/null\nprintf '<svg>half'\ntouch " + path("drawing") + "\nexec sleep 5\n");
  ::setenv("PATH", search.c_str(), 1);
  const pid_t child = ::fork();
  if (child == 0) {
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, 1);
    ::dup2(nowhere, 2);
    ::execl(WINGBEAT_PROGRAM, "wingbeat", "run", springs.c_str(), "--plot", path("x.svg").c_str(), nullptr);
    ::_exit(99);
  }
  for (int wait = 0; wait < 20000 && !fs::exists(path("drawing")); ++wait) ::usleep(1000);
  ::setenv("PATH", "/usr/local/bin:/usr/bin:/bin", 1);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  fs::remove(path("drawing"));
  fs::remove_all(path("bin"));
  ASSERT_EQ(files().size(), 1U);
  EXPECT_THAT(files().front(), testing::MatchesRegex("\\.wingbeat-.*\\.part\\.svg"));
  ASSERT_EQ(run({"run", springs, "--plot", path("x.svg")}).status, 0);
  EXPECT_THAT(files(), testing::ElementsAre("x.svg"));
}

TEST_F(Drawings, TheUsersSettingsOfGnuplotChangeNothing) {
  ASSERT_EQ(run({"run", springs, "--plot", path("plain.svg")}).status, 0);
  write(".gnuplot", "set terminal nonsense\nset xrange [0:1e-9]\n");
  const std::pair<const char*, std::string> settings[] = {
      {"GNUTERM", "nonsense"},          {"GNUPLOT_LIB", path("")},
      {"GNUPLOT_DRIVER_DIR", path("")}, {"GNUPLOT_PS_DIR", path("")},
      {"GDFONTPATH", "/nowhere"},       {"GNUPLOT_DEFAULT_GDFONT", "nothing"},
      {"GNUPLOT_FONTPATH", "/nowhere"}, {"FIT_LOG", path("fit.log")},
      {"GNUHELP", "/nowhere"},          {"DISPLAY", ":77"},
      {"LC_ALL", "de_DE.UTF-8"},        {"FC_DEBUG", "255"}};
  const std::string home = ::getenv("HOME") ? ::getenv("HOME") : "/";
  ::setenv("HOME", path("").c_str(), 1);
  for (const auto& [name, value] : settings) ::setenv(name, value.c_str(), 1);
  const Outcome o = run({"run", springs, "--plot", path("set.svg")});
  for (const auto& [name, value] : settings) ::unsetenv(name);
  ::setenv("HOME", home.c_str(), 1);
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(read(path("set.svg")) == read(path("plain.svg")));
}

TEST_F(Drawings, OnlyFilesOfProcessesThatAreGoneAreRemoved) {
  const pid_t gone = ::fork();
  if (gone == 0) ::_exit(0);
  ::waitpid(gone, nullptr, 0);
  // The name of this system, from a run that is killed.
  const std::string search = in_place_of_gnuplot("exec sleep 5\n");
  ::setenv("PATH", search.c_str(), 1);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl(WINGBEAT_PROGRAM, "wingbeat", "run", springs.c_str(), "--plot", path("x.svg").c_str(), nullptr);
    ::_exit(99);
  }
  ::setenv("PATH", "/usr/local/bin:/usr/bin:/bin", 1);
  std::string under_way;
  for (int wait = 0; wait < 20000 && under_way.empty(); ++wait, ::usleep(1000)) {
    for (const std::string& name : files()) {
      if (name.starts_with(".wingbeat-")) under_way = name;
    }
  }
  ASSERT_FALSE(under_way.empty());
  const std::string system = under_way.substr(0, std::string(".wingbeat-00000000-").size());
  const std::string start = under_way.substr(under_way.find('-', system.size()));
  const std::string number = std::to_string(child);
  const std::string reused = system + number + "-1-0.part.csv", dead = system + std::to_string(gone) + start;
  const std::string elsewhere = ".wingbeat-00000000-1-1-0.part.csv", old = ".wingbeat-00000000-1-1-1.part.csv";
  const std::string foreign[] = {".wingbeat-notes", ".wingbeat-00000000-1-1-.part", ".1-0.part.svg", "a.part.svg"};
  for (const std::string& name : {reused, dead, elsewhere, old}) write(name, "x");
  for (const std::string& name : foreign) write(name, "x");
  fs::last_write_time(path(old), fs::file_time_type::clock::now() - std::chrono::hours(25));
  ASSERT_EQ(run({"run", plain, "--waveforms", path("w.csv")}).status, 0);
  EXPECT_TRUE(fs::exists(path(under_way)));
  EXPECT_TRUE(fs::exists(path(elsewhere)));
  EXPECT_FALSE(fs::exists(path(old)));
  EXPECT_FALSE(fs::exists(path(reused)));
  EXPECT_FALSE(fs::exists(path(dead)));
  for (const std::string& name : foreign) EXPECT_TRUE(fs::exists(path(name))) << name;
  ::kill(child, SIGTERM);
  ::waitpid(child, nullptr, 0);
  EXPECT_FALSE(fs::exists(path(under_way)));
}

/// A vehicle whose name holds what acts on a terminal: DEL, CSI, a bidi override, a separator of lines.
class HiddenCharacters : public UsersFolder {
 protected:
  void SetUp() override {
    std::string text = read(springs);
    const auto position = text.find("name = "), end = text.find('\n', position);
    text.replace(position, end - position, "name = \"a\\u007F\\u009B31mb\\u202Ec\\u2028d\\u0000e, =1+1 <f>\"");
    write("odd.toml", text);
  }
  static bool holds_hidden(const std::string& text) {
    for (const char* hidden : {"\x7F", "\xC2\x9B", "\xE2\x80\xAE", "\xE2\x80\xA8", "\x1B"}) {
      if (text.find(hidden) != std::string::npos) return true;
    }
    return text.find('\0') != std::string::npos;
  }
};

TEST_F(HiddenCharacters, AreEscapesInAllThatIsPrintedAndWritten) {
  const std::string odd = path("odd.toml");
  const std::string name =
      "a\x7F\xC2\x9B"
      "31mb\xE2\x80\xAE"
      "c\xE2\x80\xA8"
      "d" +
      std::string(1, '\0') + "e, =1+1 <f>";
  const Outcome text = run({"run", odd, "--plot", path("p.svg"), "--waveforms", path("w.nc")});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("\\u009b31mb\\u202ec"));
  EXPECT_FALSE(holds_hidden(text.out));
  EXPECT_FALSE(holds_hidden(read(path("p.svg"))));
  const Outcome json = run({"linearise", odd, "--no-maps", "--json", "-o", path("l.toml")});
  ASSERT_EQ(json.status, 0) << json.err;
  EXPECT_FALSE(holds_hidden(json.out));
  EXPECT_EQ(json.json()["vehicle"].get<std::string>(), name);
  EXPECT_THAT(read(path("l.toml")), HasSubstr("vehicle = \"a\\u007F\\u009B31mb\\u202Ec\\u2028d\\u0000e, =1+1 <f>\""));
  EXPECT_FALSE(holds_hidden(read(path("l.toml"))));
  ASSERT_EQ(run({"linearise", odd, "--no-maps", "-o", path("l.json")}).status, 0);
  EXPECT_FALSE(holds_hidden(read(path("l.json"))));
  // Messages, with keys and names of files.
  write("bad\xC2\x9B.toml", "[motor]\n\"x\\u009B\\u202E\" = 1\n");
  const Outcome refused = run({"run", path("bad\xC2\x9B.toml")});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("bad\\u009b.toml:2:1: "));
  EXPECT_FALSE(holds_hidden(refused.err));
}

TEST_F(HiddenCharacters, NamesOfFilesNeedNotBeUtf8) {
  const std::string odd = path("motor\xFF\x7F.toml");
  fs::copy_file(data + "/motors/0816K003SR.toml", odd);
  ASSERT_EQ(run({"identify-motor", odd, "-o", path("m.toml")}).status, 0);
  EXPECT_THAT(read(path("m.toml")), HasSubstr("motor\\xff\\u007f.toml"));
  ASSERT_EQ(run({"new", path("n\xFF\".toml")}).status, 0);
  EXPECT_THAT(read(path("n\xFF\".toml")), HasSubstr("name = \"n\\uFFFD\\\"\""));
  const Outcome o = run({"sweep", path("none\xFF.toml"), "-o", path("s.nc"), "--json"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("none\\xff.toml"));
}

}  // namespace
