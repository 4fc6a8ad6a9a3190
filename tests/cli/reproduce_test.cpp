#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <regex>
#include <set>

#include "program.hpp"
#include "wingbeat/files/netcdf.hpp"
#include "wingbeat/reproduction/reproduce.hpp"

namespace cli {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const char* const expected_claims = WINGBEAT_DATA "/../tests/cli/data/friction2022-claims.csv";

std::vector<std::vector<std::string>> csv_rows(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    else if (c == ',' && !quoted) rows.back().emplace_back();
    else if (c == '\n' && !quoted) rows.push_back({""});
    else rows.back().back() += c;
  }
  rows.pop_back();
  return rows;
}

bool is_number(const std::string& text, double& x) {
  char* end = nullptr;
  x = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex wanted(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), wanted), none; match != none; ++match)
    found.push_back((*match)[1]);
  return found;
}

/// One coarse run, at its first use, serves the tests that only look at what it wrote. ctest makes it before, for other
/// tests as well, and names its folder by WINGBEAT_REPRODUCED.
class Reproduce : public Program {
 protected:
  static void TearDownTestSuite() { the_made().reset(); }
  static std::string made(const std::string& name) { return the_run().at(name); }
  static const Outcome& outcome() { return the_run().outcome; }
  static std::set<std::string> names_in(const std::string& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
  }
  static std::string report() { return read(made("report.html")); }

  struct Browsed {
    int status;
    std::string dom, log;
    std::vector<std::string> requests;  ///< of the page: the browser's own questions to its maker are left out
  };
  Browsed browse(const std::string& page) const {
    const std::string command =
        "timeout 100 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run "
        "--disable-background-networking --disable-component-update --disable-sync --disable-extensions "
        "--host-resolver-rules='MAP * ~NOTFOUND' --user-data-dir='" +
        path("profile") + "' --log-net-log='" + path("net.json") + "' --enable-logging=stderr --dump-dom 'file://" +
        page + "' >'" + path("dom.html") + "' 2>'" + path("log.txt") + "'";
    const int status = std::system(command.c_str());
    Browsed b{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(path("dom.html")), read(path("log.txt")), {}};
    for (const std::string& url : matches(read(path("net.json")), "\"url\":\"([a-z]+://[^\"]*)\"")) {
      if (url.rfind("file://", 0) == 0 && url.find(page) != std::string::npos) continue;
      if (!std::regex_search(url, std::regex("^https?://[a-z0-9.]*(google|googleapis|gvt1)\\.com/")))
        b.requests.push_back(url);
    }
    return b;
  }

 private:
  struct Made : Program {
    Made() {
      if (const char* before = std::getenv("WINGBEAT_REPRODUCED")) {
        folder = before;
        outcome = {0, read(folder + ".out"), read(folder + ".err")};
      } else {
        folder = path("made");
        outcome = run({"reproduce", "friction2022", "--coarse", "-o", folder});
      }
    }
    void TestBody() override {}
    std::string at(const std::string& name) const { return folder + "/" + name; }
    std::string folder;
    Outcome outcome;
  };
  static std::unique_ptr<Made>& the_made() {
    static std::unique_ptr<Made> made;
    return made;
  }
  static const Made& the_run() {
    if (!the_made()) the_made() = std::make_unique<Made>();
    return *the_made();
  }
};

TEST_F(Reproduce, EveryFigureIsThereWithItsData) {
  ASSERT_EQ(outcome().status, 0) << outcome().err;
  EXPECT_THAT(outcome().err, IsEmpty());
  std::vector<std::string> names;
  for (const int n : {1, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22}) {
    names.push_back((n < 10 ? "figure-0" : "figure-") + std::to_string(n));
  }
  for (const char* more : {"figure-22-hinge-held", "figure-22-virtual-work", "figure-22-virtual-work-hinge-held",
                           "friction-laws", "energy-flow", "energy-flow-virtual-work", "power-cycle-springs-off",
                           "power-cycle-springs-on", "scorecard", "friction-law-deviations", "further-physics"}) {
    names.emplace_back(more);
  }
  for (const std::string& name : names) {
    EXPECT_THAT(read(made(name + ".svg")), HasSubstr("<svg")) << name;
    EXPECT_THAT(read(made(name + ".pdf")), StartsWith("%PDF")) << name;
    const auto rows = csv_rows(read(made(name + ".csv")));
    ASSERT_GE(rows.size(), 3U) << name;
    const wingbeat::NetcdfReader data(made(name + ".nc"));
    for (std::size_t column = 0; column < rows[0].size(); ++column) {
      const auto values = data.read(rows[0][column]);
      ASSERT_EQ(values.size() + 1, rows.size()) << name;
      for (std::size_t n = 0; n < values.size(); ++n) {
        double x = NAN;
        if (is_number(rows[n + 1][column], x)) EXPECT_NEAR(x, values[n], 1e-8 * std::abs(values[n]));
        else EXPECT_TRUE(std::isnan(values[n]));
      }
    }
  }
  for (const char* name : {"figure-01-moving.svg", "figure-08-moving.svg"}) {
    EXPECT_THAT(read(made(name)), HasSubstr("repeatCount=\"indefinite\"")) << name;
  }
  EXPECT_THAT(outcome().out, HasSubstr("31 figures written to "));
}

TEST_F(Reproduce, TheClaimsAreThoseCommitted) {
  const auto ours = csv_rows(read(made("claims.csv"))), expected = csv_rows(read(expected_claims));
  ASSERT_EQ(ours.size(), expected.size());
  for (std::size_t n = 0; n < ours.size(); ++n) {
    ASSERT_EQ(ours[n].size(), expected[n].size()) << ours[n][0];
    for (std::size_t column = 0; column < ours[n].size(); ++column) {
      const std::string& name = expected[0][column];
      if (name.size() > 5 && name.substr(name.size() - 5) == "_text") continue;  // the numbers once more
      double x = 0.0, y = 0.0;
      if (is_number(ours[n][column], x) && is_number(expected[n][column], y)) {
        // The place of a flat maximum is known less well than values are.
        const bool place = name.find("_95") != std::string::npos || ours[n][0].find("crank radius of") == 0 ||
                           ours[n][0].find("range of best") == 0 ||
                           ours[n][0].find("at this flapping frequency") != std::string::npos ||
                           ours[n][0].find("near this flapping frequency") != std::string::npos;
        // So are the chord moments that come nearest to two values of which both cannot be met.
        const bool nearest = name.find("own_calibration") != std::string::npos;
        // What virtual work leaves open is rounding.
        const double least = name.find("deviation") != std::string::npos  ? 1.0
                             : name.find("residual") != std::string::npos ? 1e-9
                                                                          : 0.0;
        const double scale = std::max(std::abs(y), least);
        EXPECT_NEAR(x, y, scale * (place ? 5e-3 : nearest ? 1e-4 : 1e-6)) << ours[n][0] << ", " << name;
      } else {
        EXPECT_EQ(ours[n][column], expected[n][column]) << ours[n][0] << ", " << name;
      }
    }
  }
  const Json json = Json::parse(read(made("claims.json")));
  EXPECT_EQ(json["predictions"]["statements"], 32);
  EXPECT_EQ(json["predictions"]["met"]["rod-force"], 22);
  EXPECT_EQ(json["predictions"]["with_changes_as_ratios"]["met"]["rod-force"], 25);
  EXPECT_EQ(json["predictions"]["within_printed_digits"]["met"]["rod-force"], 20);
  EXPECT_EQ(json["section_5"]["stroke_held"]["statements"], 9);
  EXPECT_EQ(json["answer"].size(), 3U);
  EXPECT_FALSE(json["answer"][0]["inside_the_domain"].get<bool>());
  EXPECT_TRUE(json["answer"][1]["inside_the_domain"].get<bool>());
  EXPECT_EQ(json["calibration"].size(), 2U);
  EXPECT_EQ(json["claims"].size() + 1, ours.size());
  EXPECT_EQ(json["friction_laws"].size(), 18U);
}

TEST_F(Reproduce, TwoRunsGiveTheSameBytes) {
  // The second into the folder of the first, which may have got another file since, and by one thread.
  const std::string again = path("again");
  fs::copy(made(""), again);
  std::ofstream(again + "/notes.txt") << "my notes";
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (const auto& entry : fs::directory_iterator(again)) fs::last_write_time(entry.path(), long_ago);
  const Outcome o = run({"reproduce", "friction2022", "--coarse", "--threads", "1", "--json", "-o", again});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.out, read(made("claims.json")));
  EXPECT_EQ(read(again + "/notes.txt"), "my notes");
  fs::remove(again + "/notes.txt");
  const std::set<std::string> first = names_in(made("")), second = names_in(again);
  EXPECT_EQ(first, second);
  for (const std::string& name : first) {
    EXPECT_TRUE(read(made(name)) == read(again + "/" + name)) << name;
    EXPECT_GT(fs::last_write_time(again + "/" + name), long_ago) << name << " was not written anew";
  }
}

TEST_F(Reproduce, TheReportStandsByItself) {
  const std::string html = report();
  EXPECT_THAT(html, StartsWith("<!DOCTYPE html>"));
  for (const char* foreign : {"<img", "<iframe", "@import", " src=", "<object"}) {
    EXPECT_EQ(count_of(html, foreign), 0U) << foreign;
  }
  EXPECT_EQ(count_of(html, "<script"), 1U);
  EXPECT_LT(html.size(), 1500000U);
  for (const std::string& target : matches(html, "href=[\"']([^\"']*)[\"']")) {
    const bool beside = target.find('/') == std::string::npos && fs::is_regular_file(made(target));
    EXPECT_TRUE(target[0] == '#' || target == "data:," || beside) << target;
  }
  // Every name is given once, and every reference finds its name.
  std::map<std::string, int> names;
  for (const std::string& id : matches(html, " id=[\"']([^\"']*)[\"']")) ++names[id];
  for (const auto& [id, times] : names) EXPECT_EQ(times, 1) << id;
  for (const std::string& target : matches(html, "href=[\"']#([^\"']*)[\"']"))
    EXPECT_TRUE(names.contains(target)) << target;
  for (const std::string& target : matches(html, "url\\(#([^)\"']*)\\)")) EXPECT_TRUE(names.contains(target)) << target;
  EXPECT_EQ(count_of(html, "<svg"), 32U);
  for (const std::string bad : {"nan", "inf", "not-a-number"}) {
    EXPECT_EQ(matches(html, "[>\" ](-?" + bad + ")[<\" ,;]").size(), 0U) << bad;
  }
}

TEST_F(Reproduce, TheAnswerStandsBeforeTheTables) {
  const std::string html = report();
  const auto answer = html.find("class=\"answer\""), table = html.find("<table");
  ASSERT_NE(answer, std::string::npos);
  EXPECT_LT(answer, table);
  // The number inside the domain first, the other one marked where it stands.
  const auto inside = html.find("236 mW instead of 414 mW", answer),
             outside = html.find("274 mW instead of 544 mW", answer);
  EXPECT_LT(inside, outside);
  EXPECT_LT(outside, table);
  const std::string box = html.substr(answer, html.find("</div>", answer) - answer);
  EXPECT_THAT(box,
              HasSubstr("<b>outside the domain</b>: without friction the formulation residual is 6.2 % of the input"));
  EXPECT_THAT(box, HasSubstr("Simulation against simulation."));
  EXPECT_THAT(box, HasSubstr("95 % of 256 samples"));
  EXPECT_THAT(
      box,
      HasSubstr("2.26 times the drag (1.88 to 2.64 times) and +6.0 % (3.9 to 8.1 %) (rod-force, outside the domain)"));
  EXPECT_LT(html.find("--set friction.type=none --allow-extrapolation", answer), table);
  EXPECT_LT(html.find("id=\"friction-law-deviations\""), table);
  EXPECT_LT(html.find("id=\"scorecard\""), html.find("class=\"scorecard\""));
  // The long tables are folded.
  for (const char* folded : {"What the paper's own formulation does not", "Parameters, and", "All 72 statements"}) {
    EXPECT_THAT(html, HasSubstr(std::string("<details><summary>") + folded));
  }
}

TEST_F(Reproduce, FiguresAreDrawnForReaders) {
  for (const auto& entry : fs::directory_iterator(made(""))) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".svg" || name.find("-moving") != std::string::npos) continue;
    const std::string svg = read(entry.path().string());
    EXPECT_EQ(count_of(svg, "<title"), 0U) << name;  // gnuplot's commands as tooltips
    EXPECT_EQ(count_of(svg, " using "), 0U) << name;
    for (const std::string& text : matches(svg, "<(?:text|tspan)[^>]*>([^<]*)<")) {
      EXPECT_FALSE(std::regex_search(text, std::regex("[a-z]_[a-z]|[a-z][.][a-z]{3}"))) << name << ": " << text;
    }
  }
  EXPECT_THAT(read(made("figure-20.svg")), HasSubstr(">crank radius (mm)<"));
  // Each of the six calibrated statements is hollow, by both formulations, and so is the entry of the key.
  const std::string scorecard = read(made("scorecard.svg"));
  const auto uses = [&](const char* mark) { return count_of(scorecard, "<use xlink:href='#" + std::string(mark)); };
  const std::size_t defined = 1;  // filled ones are defined by hollow ones
  EXPECT_EQ(uses("gpPt5'") - defined, 6U + 1U);
  EXPECT_EQ(uses("gpPt3'") - defined, 6U);
  // Published peak lifts were used in the calibration, published peak forces were not.
  EXPECT_THAT(read(made("figure-15.svg")), HasSubstr("published, used in the calibration"));
  EXPECT_THAT(read(made("figure-16.svg")), testing::Not(HasSubstr("used in the calibration")));
}

TEST_F(Reproduce, MorePhysicsStartsFromThePapersModel) {
  const auto rows = csv_rows(read(made("further-physics.csv"))), claims = csv_rows(read(made("claims.csv")));
  ASSERT_EQ(rows.size(), 7U);
  const auto claimed = [&](const std::string& beginning) {
    const auto column = std::size_t(std::find(claims[0].begin(), claims[0].end(), "rod_force") - claims[0].begin());
    for (const auto& row : claims) {
      if (row[0].rfind(beginning, 0) == 0) return std::stod(row.at(column));
    }
    return double(NAN);
  };
  EXPECT_NEAR(std::stod(rows[1][2]), claimed("mean electrical input power, change"), 1e-5);
  EXPECT_NEAR(std::stod(rows[1][3]), claimed("mean lift, change by springs at 3 V"), 1e-5);
  EXPECT_NEAR(std::stod(rows[1][4]), claimed("gain in system efficiency"), 1e-5);
  // Whatever is added, a model without friction misses a large part of the input.
  for (std::size_t n = 1; n < rows.size(); ++n) EXPECT_LT(std::stod(rows[n][1]), -0.4) << n;
}

TEST_F(Reproduce, TheReportsCommandsWorkAsTyped) {
  const std::string root = fs::path(data).parent_path().string(), html = report();
  const auto commands = matches(html, "(?:<pre>|\n)build/release/wingbeat ((?:run|compare)[^\n<]*)");
  ASSERT_GE(commands.size(), 6U);
  for (std::string command : commands) {
    for (const std::string file : {"cycle.csv", "cycle.svg"}) {
      if (const auto position = command.find(file); position != std::string::npos)
        command.replace(position, file.size(), path(file));
    }
    const std::string whole =
        "cd '" + root + "' && " + WINGBEAT_PROGRAM + " " + command + " >" + path("out.txt") + " 2>&1";
    const int status = std::system(whole.c_str());
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0) << command << "\n" << read(path("out.txt"));
  }
}

TEST_F(Reproduce, ABrowserShowsTheReportWithoutAskingForAnything) {
  // The reader points at 22 Hz of figure 9, hides a formulation and sorts the statements.
  std::ofstream(path("used.html")) << report() << R"(<script>
addEventListener('load', () => {
  const svg = document.querySelector('#figure-09 svg');
  svg.scrollIntoView();
  const box = JSON.parse(svg.dataset.panels)[0].box, at = svg.getBoundingClientRect();
  const scale = at.width / svg.viewBox.baseVal.width;
  svg.dispatchEvent(new PointerEvent('pointermove', {clientX: at.left + scale * (box[0] + 0.7 * (box[1] - box[0])),
                                                     clientY: at.top + scale * 0.5 * (box[2] + box[3])}));
  document.querySelector('.tools button[value=rod-force]').click();
  const hidden = [...svg.querySelectorAll('[data-formulation=virtual-work]')];
  const table = document.querySelector('#claims ~ details table');
  table.tHead.rows[0].cells[0].click();
  document.title = [hidden.length, hidden.every(g => getComputedStyle(g).display === 'none'),
                    table.tBodies[0].rows[1].cells[0].textContent.slice(0, 30),
                    document.documentElement.scrollWidth <= innerWidth].join('; ');
});
</script>)";
  const Browsed b = browse(path("used.html"));
  EXPECT_THAT(b.dom, HasSubstr("<title>4; true; above 17 Hz springs raise the"));
  EXPECT_THAT(b.dom, HasSubstr("; true</title>"));
  EXPECT_THAT(b.dom, HasSubstr("<div>flapping frequency: 22 Hz</div>"));
  EXPECT_THAT(b.dom, HasSubstr("<div>published: mean electrical input power, change by springs"));
  ASSERT_EQ(b.status, 0) << "chromium (scripts/install-dependencies installs it): " << b.log;
  EXPECT_THAT(b.dom, HasSubstr("Reproducibility assessment"));
  EXPECT_EQ(count_of(b.dom, "<svg"), 32U);
  EXPECT_THAT(b.requests, IsEmpty());
  EXPECT_EQ(count_of(b.log, ":CONSOLE"), 0U) << b.log;
}

TEST_F(Reproduce, TheBrowserWouldHaveNoticed) {
  std::ofstream(path("bad.html")) << "<!DOCTYPE html><body><img src=\"http://figures.example/missing.png\">"
                                     "<script>no_such_function();</script></body>";
  const Browsed b = browse(path("bad.html"));
  EXPECT_THAT(b.requests, Contains(HasSubstr("figures.example")));
  EXPECT_GE(count_of(b.log, ":CONSOLE"), 1U) << b.log;
}

TEST_F(Reproduce, FoldersOfSomethingElseAreLeftAlone) {
  fs::create_directory(path("mine"));
  std::ofstream(path("mine/report.html")) << "mine";
  const Outcome foreign = run({"reproduce", "friction2022", "--coarse", "-o", path("mine")});
  EXPECT_EQ(foreign.status, 2);
  EXPECT_EQ(foreign.err, "wingbeat: -o " + path("mine") +
                             ": holds files of something else; name a new or an empty folder, or --force "
                             "to write among them\n");
  EXPECT_EQ(read(path("mine/report.html")), "mine");

  fs::create_directory(path("empty"));
  EXPECT_NO_THROW(wingbeat::prepare_reproduction_folder(path("empty"), "friction2022"));
  const std::string mine = path("changed");
  fs::copy(made(""), mine);
  std::ofstream(mine + "/notes.txt") << "my notes";
  EXPECT_NO_THROW(wingbeat::prepare_reproduction_folder(mine, "friction2022"));
  std::ofstream(mine + "/figure-04.csv") << "changed by hand";
  const Outcome changed = run({"reproduce", "friction2022", "--coarse", "-o", mine});
  EXPECT_EQ(changed.status, 2);
  EXPECT_THAT(changed.err, HasSubstr("figure-04.csv: exists and was not written by wingbeat"));
  EXPECT_EQ(read(mine + "/figure-04.csv"), "changed by hand");
  ASSERT_EQ(run({"reproduce", "friction2022", "--coarse", "--force", "-o", mine}).status, 0);
  EXPECT_EQ(read(mine + "/notes.txt"), "my notes");
  EXPECT_EQ(read(mine + "/figure-04.csv"), read(made("figure-04.csv")));
}

TEST_F(Reproduce, BadInputIsRefusedInOneSentence) {
  const auto said = [&](std::vector<std::string> arguments) {
    const Outcome o = run(std::move(arguments));
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.out, IsEmpty());
    return o.err;
  };
  EXPECT_EQ(said({"reproduce", "friction2021", "-o", path("o")}),
            "wingbeat: reproduce friction2021: the program knows no such paper; it knows friction2022\n");
  EXPECT_THAT(said({"reproduce", "friction2022"}), HasSubstr("--output is required"));
  EXPECT_EQ(said({"reproduce", "friction2022", "-o", path("a/b")}),
            "wingbeat: -o " + path("a/b") + ": there is no folder " + path("a") + "\n");
  std::ofstream(path("file")) << "a file";
  EXPECT_EQ(said({"reproduce", "friction2022", "-o", path("file")}),
            "wingbeat: -o " + path("file") + ": is a file, not a folder\n");
  EXPECT_THAT(said({"reproduce", "friction2022", "-o", "/proc/wingbeat"}),
              HasSubstr("-o /proc/wingbeat: cannot be made: "));
  EXPECT_FALSE(fs::exists(path("o")));
}

TEST_F(Reproduce, WithoutGnuplotItSaysWhatToDo) {
  const Outcome o = run({"reproduce", "friction2022", "--coarse", "-o", path("o")}, "/nowhere");
  EXPECT_EQ(o.status, 1);
  EXPECT_THAT(o.err, HasSubstr("plots need gnuplot"));
  EXPECT_FALSE(fs::exists(path("o")));
}

}  // namespace
}  // namespace cli
