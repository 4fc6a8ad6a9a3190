// Every figure that commands draw, at both widths: no text leaves the page or meets another (docs/commands.md).
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "drawn_texts.hpp"
#include "program.hpp"

namespace cli {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Figures : public Program {
 protected:
  static std::string design(const std::string& name) { return data + "/designs/" + name + ".toml"; }
  static std::string study(const std::string& name) { return data + "/studies/" + name + ".toml"; }

  /// Draws by that command, at both widths, and looks at every text.
  void look(std::vector<std::string> arguments, const std::string& option = "--plot") const {
    for (const auto& [width, millimetres] : {std::pair{"89 mm", 89.0}, {"183 mm", 183.0}}) {
      std::vector<std::string> all = arguments;
      for (const std::string& more :
           {option, path("figure.svg"), std::string("--plot-width"), std::string(width), std::string("--force")}) {
        all.push_back(more);
      }
      const Outcome o = run(all);
      ASSERT_EQ(o.status, 0) << testing::PrintToString(all) << o.err;
      const std::string svg = read(path("figure.svg"));
      EXPECT_THAT(text_flaws(svg), IsEmpty()) << testing::PrintToString(all);
      EXPECT_GT(page_of(svg).texts.size(), 10U);
      EXPECT_NEAR(page_of(svg).width / 192.0 * 25.4, millimetres, 0.1);
    }
  }
};

std::vector<std::string> flaws_of(const std::string& name) {
  return text_flaws(read(std::string(WINGBEAT_CASES) + "/../cli/data/figures/" + name + ".svg"));
}

// Texts of figures as they were drawn once: the checks above would not have let them pass.
TEST(FigureTexts, FlawsThatWereDrawnAreFound) {
  EXPECT_THAT(flaws_of("clipped-note"), ElementsAre(HasSubstr("leaves the page: dashed: lift = weight")));
  EXPECT_THAT(flaws_of("overlapping-key"), AllOf(Contains("leaves the page: pitch amplitude, half peak to peak"),
                                                 Contains("meet: root mean square of the current | mean lift")));
  EXPECT_THAT(flaws_of("clipped-key"), ElementsAre("leaves the page: residual"));
  EXPECT_THAT(flaws_of("merged-marks"), Contains("meet: −600 | −500"));
  EXPECT_THAT(flaws_of("clipped-title"), Contains(HasSubstr("leaves the page: supply voltage: constant")));
}

TEST(FigureTexts, WidthsAreThoseOfTheFont) {
  // "mN" of DejaVu Sans: 1995 + 1532 of 2048 units.
  EXPECT_NEAR(wingbeat::text_width("mN", 72.0), 3527.0 / 2048.0, 1e-12);
  EXPECT_NEAR(wingbeat::text_width("−1 µm²", 72.0), (1716 + 1303 + 651 + 1303 + 1995 + 821) / 2048.0, 1e-12);
  EXPECT_THAT(wingbeat::broken_lines("outside the domain", 7.0, wingbeat::text_width("outside the", 7.0) + 1e-9),
              ElementsAre("outside the", "domain"));
  EXPECT_THAT(wingbeat::broken_lines("§§§", 7.0, 1e-3), ElementsAre("§", "§", "§"));
}

TEST_F(Figures, Cycles) {
  for (const char* name : {"friction2022-springs", "hawkmoth", "two-wing-four-bar", "two-wing-direct-hinge",
                           "pitch-hinge-crank", "x-wing-crank"}) {
    look({"run", design(name)});
  }
  look({"run", plain, "--condition", "vacuum"});
}

TEST_F(Figures, Powers) {
  for (const char* name : {"friction2022-springs", "two-wing-direct-hinge", "x-wing-crank"}) {
    look({"run", design(name)}, "--plot-power");
  }
  look({"run", plain, "--set", "transmission.formulation=virtual-work"}, "--plot-power");
  look({"compare", data + "/published/friction2022.toml"}, "--plot-power");
}

TEST_F(Figures, Sweeps) {
  for (const char* name : {"crank-radius", "voltage-crank-radius", "trend-stiffness", "pitch-hinge"}) {
    look({"sweep", study(name), "-o", path(std::string(name) + ".nc")});
  }
  look({"sweep", study("crank-radius"), "-o", path("crank-radius.nc"), "--plot-metric",
        "voltage_v,power_electrical_w,rod_force_peak_n,angle_of_attack_min_deg"});
}

TEST_F(Figures, NothingThatFlaps) {
  std::ofstream(path("idle.toml")) << "[study]\ntitle = \"A battery that is nearly empty, and springs off and on\"\n"
                                   << "vehicle = \"" << springs << "\"\n[[axis]]\nkey = \"springs\"\n"
                                   << "values = [false, true]\n[[axis]]\nkey = \"supply.voltage\"\nfrom = \"0.01 V\"\n"
                                   << "to = \"0.2 V\"\ncount = 12\n";
  look({"sweep", path("idle.toml"), "-o", path("idle.nc")});
}

TEST_F(Figures, Discharges) {
  look({"endurance", design("friction2022-battery")});
  look({"endurance", design("friction2022-battery"), "--set", "supply.cells=2", "--set", "vehicle.mass=\"5 g\""});
}

TEST_F(Figures, Fits) {
  look({"fit", data + "/bench/flapper.toml", "--no-profiles"});
  // The bench of pitch hinges without its damping, which ends at a bound: the fit of all three takes a minute.
  std::string bench = read(data + "/bench/pitch-hinge.toml");
  const auto begin = bench.find("[[parameter]]\nkey = \"pitch.damping\""), end = bench.find("[[parameter]]", begin + 1);
  ASSERT_LT(begin, end);
  bench.erase(begin, end - begin);
  const std::string vehicle = "../designs/pitch-hinge.toml";
  bench.replace(bench.find(vehicle), vehicle.size(), design("pitch-hinge"));
  std::ofstream(path("bench.toml")) << bench;
  fs::copy(data + "/bench/pitch-hinge.csv", path("pitch-hinge.csv"));
  look({"fit", path("bench.toml"), "--no-profiles"});
}

TEST_F(Figures, OptimaAndTolerance) {
  look({"optimise", study("optimise-motor")});
  look({"tolerance", study("tolerance-hover")});
  look({"tolerance", study("tolerance-model-form")});
}

TEST_F(Figures, StepResponses) { look({"linearise", springs, "--no-maps"}); }

TEST_F(Figures, OtherWidthsAreRefused) {
  const Outcome o = run({"run", plain, "--plot", path("p.svg"), "--plot-width", "10 cm"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("--plot-width: must be 89 mm, one column of a journal, or 183 mm, both; got \"10 cm\""));
  EXPECT_EQ(run({"run", plain, "--plot-width", "5 kg"}).status, 2);
}

/// The strokes of the dashes of lines one pixel wide and more, in the order of the drawing.
std::size_t dashed_strokes(const std::string& svg) { return count_of(svg, "stroke-dasharray"); }

TEST_F(Figures, TheKeyDashesWhatIsDashed) {
  ASSERT_EQ(run({"sweep", study("trend-stiffness"), "-o", path("s.nc"), "--plot", path("s.svg")}).status, 0);
  // The second formulation in two panels, and its entry of the key.
  EXPECT_EQ(dashed_strokes(read(path("s.svg"))), 3U);
}

/// From where to where the strokes of a named curve reach, first panel [px].
std::pair<double, double> reach_of(const std::string& svg, const std::string& curve) {
  const auto group = svg.find("data-curve=\"" + curve + "\"");
  const auto path = svg.find(" d='", group);
  double low = 1e9, high = -1e9;
  const std::string points = svg.substr(path + 4, svg.find('\'', path + 4) - path - 4);
  for (std::size_t position = 0; position != std::string::npos; position = points.find_first_of("ML ", position + 1)) {
    double x = 0.0, y = 0.0;
    if (std::sscanf(points.c_str() + position, "%*[ML ]%lf,%lf", &x, &y) != 2) continue;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return {low, high};
}

TEST_F(Figures, BandsOutsideTheDomainAreThoseOfTheirCurves) {
  ASSERT_EQ(run({"sweep", study("crank-radius"), "-o", path("c.nc"), "--plot", path("c.svg")}).status, 0);
  const std::string svg = read(path("c.svg"));
  EXPECT_THAT(svg, HasSubstr("grey band: outside the model's domain"));
  // The axis runs from 3 to 14 mm, from 0.125 to 0.965 of the page. Springs off: outside from 7.2 mm on, to the last
  // design that flaps; springs on: from 7.0 to 10.4 mm.
  const double width = page_of(svg).width;
  const auto millimetres = [&](double x) { return 3.0 + 11.0 * (x / width - 0.125) / 0.84; };
  const auto off = reach_of(svg, "outside 0"), on = reach_of(svg, "outside 1");
  EXPECT_NEAR(millimetres(off.first), 7.15, 0.02);
  EXPECT_NEAR(millimetres(off.second), 12.4, 0.02);
  EXPECT_NEAR(millimetres(on.first), 6.95, 0.02);
  EXPECT_NEAR(millimetres(on.second), 10.45, 0.02);
}

TEST_F(Figures, WhatCannotHoverIsNoFlight) {
  ASSERT_EQ(run({"endurance", design("friction2022-battery"), "--plot", path("e.svg")}).status, 0);
  EXPECT_THAT(read(path("e.svg")), AllOf(HasSubstr("Does not hover"), Not(HasSubstr("Flight"))));
}

}  // namespace
}  // namespace cli
