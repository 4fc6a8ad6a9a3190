// Figures 1 and 8: the mechanism, drawn from the vehicle's numbers at a crank angle, and moving.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "report/figure.hpp"
#include "reproduction/sheet.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat::reproduction {
namespace {

constexpr double wing_shown = 3.4;            ///< length of a wing as drawn, in hinge offsets
constexpr double drawn_angle = two_pi / 9.0;  ///< crank angle of the figures

struct Point {
  double x, y;
};

/// Places of the mechanism [mm], the crank axis at the origin.
struct Pose {
  Point pin, slider;
  std::array<Point, 2> hinge, tip;  ///< right, left
};

Pose pose_of(const SliderCrank<double>& c, double theta) {
  const auto k = crank_kinematics(c, std::sin(theta), std::cos(theta));
  const double beta = stroke_angle(k), mm = 1e3;
  Pose p;
  p.pin = {mm * c.crank_radius * std::cos(theta), mm * c.crank_radius * std::sin(theta)};
  p.slider = {0.0, mm * slider_height(c, std::sin(theta), std::cos(theta))};
  for (std::size_t side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1.0 : -1.0, H = mm * c.hinge_offset;
    p.hinge[side] = {sign * H, mm * c.mid_stroke_height};
    // The slider lifts the inner end, so that the wing beyond the hinge goes down.
    p.tip[side] = {sign * (H + wing_shown * H * std::cos(beta)), p.hinge[side].y - wing_shown * H * std::sin(beta)};
  }
  return p;
}

class Sketch {
 public:
  Sketch(PlotFormat format, double x_low, double x_high, double y_low, double y_high)
      : figure_(format, 3.5, 3.5 * (y_high - y_low) / (x_high - x_low)) {
    figure_.add(
        "unset border\nunset tics\nunset grid\nset lmargin at screen 0\nset rmargin at screen 1\n"
        "set tmargin at screen 1\nset bmargin at screen 0\nset xrange [{}:{}]\nset yrange [{}:{}]\n",
        x_low, x_high, y_low, y_high);
  }
  void line(Point a, Point b, double weight, const char* colour, const char* dash = "1", const char* head = "nohead") {
    figure_.add("set arrow from {:.6g},{:.6g} to {:.6g},{:.6g} {} front dt {} lw {} lc rgb '{}'\n", a.x, a.y, b.x, b.y,
                head, dash, weight, colour);
  }
  void path(const std::vector<Point>& points, double weight, const char* colour) {
    for (std::size_t n = 1; n < points.size(); ++n) line(points[n - 1], points[n], weight, colour);
  }
  void disc(Point c, double radius, const char* fill) {
    figure_.add(
        "set object {} circle at {:.6g},{:.6g} size {:.6g} front fillcolor rgb '{}' fillstyle solid border lc rgb "
        "'#202020' lw 0.8\n",
        ++discs_, c.x, c.y, radius, fill);
  }
  void box(Point a, Point b, const char* fill) {
    figure_.box(fmt::format("from {:.6g},{:.6g} to {:.6g},{:.6g}", a.x, a.y, b.x, b.y), fill);
  }
  void text(const std::string& content, Point p, const char* anchor = "center", double size = 7.5) {
    figure_.text(content, size, fmt::format("{:.6g},{:.6g} {}", p.x, p.y, anchor));
  }
  /// With gnuplot's marks for italics and subscripts.
  void symbols(const std::string& content, Point p, const char* anchor = "center", double size = 7.5) {
    figure_.symbols(content, size, fmt::format("{:.6g},{:.6g} {}", p.x, p.y, anchor));
  }
  void dimension(Point a, Point b, const std::string& name, Point at, const char* anchor = "center") {
    line(a, b, 0.6, "#404040", "1", "heads filled size screen 0.015,18");
    text(name, at, anchor);
  }
  void draw(const std::filesystem::path& file) {
    figure_.add("plot NaN\nunset output\n");
    run_gnuplot(figure_.script(), file);
  }

 private:
  Figure figure_;
  int discs_ = 200;  ///< numbered beside the figure's own objects
};

/// A spiral spring around a hinge, wound further by the stroke angle.
std::vector<Point> spiral(Point centre, double radius, double end_angle) {
  constexpr int points = 60;
  constexpr double turns = 2.25 * two_pi;
  std::vector<Point> path;
  for (int n = 0; n <= points; ++n) {
    const double share = double(n) / points;
    const double r = radius * (0.25 + 0.75 * share), angle = end_angle - turns * (1.0 - share);
    path.push_back({centre.x + r * std::cos(angle), centre.y + r * std::sin(angle)});
  }
  return path;
}

void draw_mechanism(const SliderCrank<double>& crank, bool springs, PlotFormat format,
                    const std::filesystem::path& file) {
  const double theta = drawn_angle;
  const Pose p = pose_of(crank, theta);
  const double mm = 1e3, r = mm * crank.crank_radius, H = mm * crank.hinge_offset, y0 = mm * crank.mid_stroke_height;
  const double half = (1.0 + wing_shown) * H * 1.06;
  const double high = std::max(y0 + r, y0 + H) + 1.1 * H, low = -r - 1.0 * H;
  Sketch s(format, -half, half, low, high);
  const char* grey = "#909090";
  // Guide, stroke plane, circle of the crank.
  s.line({0, -r - 0.35 * H}, {0, high - 0.25 * H}, 0.5, grey, "(14,4,3,4)");
  s.line({-half, y0}, {half, y0}, 0.5, grey, "(6,4)");
  std::vector<Point> circle;
  for (int n = 0; n <= 72; ++n) circle.push_back({r * std::cos(two_pi * n / 72), r * std::sin(two_pi * n / 72)});
  s.path(circle, 0.5, grey);
  s.line({0, 0}, {1.35 * r, 0}, 0.5, grey, "(6,4)");
  // Crank, rod, slider with its levers, wings.
  s.line({0, 0}, p.pin, 3.4, "#d55e00");
  s.line(p.pin, p.slider, 2.2, "#0072b2");
  for (std::size_t side = 0; side < 2; ++side) {
    s.line(p.slider, p.hinge[side], 1.6, "#404040");
    s.line(p.hinge[side], p.tip[side], 3.4, "#404040");
    if (springs) s.path(spiral(p.hinge[side], 0.42 * H, -std::numbers::pi / 2), 0.9, "#009e73");
    s.disc(p.hinge[side], 0.1 * H, "#ffffff");
    const double ground = p.hinge[side].y - 0.62 * H;
    if (springs) s.line({p.hinge[side].x, p.hinge[side].y - 0.42 * H}, {p.hinge[side].x, ground}, 0.9, "#009e73");
    if (springs) s.line({p.hinge[side].x - 0.25 * H, ground}, {p.hinge[side].x + 0.25 * H, ground}, 1.4, "#202020");
  }
  s.box({-0.16 * H, p.slider.y - 0.16 * H}, {0.16 * H, p.slider.y + 0.16 * H}, "#e0e0e0");
  s.disc({0, 0}, 0.14 * H, "#ffffff");
  s.disc(p.pin, 0.11 * H, "#ffffff");
  // Angles.
  std::vector<Point> arc;
  for (int n = 0; n <= 20; ++n)
    arc.push_back({0.75 * r * std::cos(theta * n / 20), 0.75 * r * std::sin(theta * n / 20)});
  s.path(arc, 0.7, "#202020");
  s.symbols("{/:Italic θ}", {0.95 * r * std::cos(0.45 * theta), 0.95 * r * std::sin(0.45 * theta)});
  const double beta = stroke_angle(crank_kinematics(crank, std::sin(theta), std::cos(theta)));
  arc.clear();
  for (int n = 0; n <= 20; ++n) {
    arc.push_back({p.hinge[0].x + 2.2 * H * std::cos(beta * n / 20), p.hinge[0].y - 2.2 * H * std::sin(beta * n / 20)});
  }
  s.path(arc, 0.7, "#202020");
  s.symbols("{/:Italic β}",
            {p.hinge[0].x + 2.45 * H * std::cos(0.5 * beta), p.hinge[0].y - 2.45 * H * std::sin(0.5 * beta)});
  // Names and sizes.
  s.text("crank and motor", {-1.35 * r, -0.25 * H}, "right", 7.0);
  s.symbols(fmt::format("{{/:Italic r}}_c = {:.4g} mm", r), {-1.35 * r, -0.25 * H - 0.62 * H}, "right", 7.0);
  s.symbols(fmt::format("rod, {{/:Italic l}} = {:.4g} mm", mm * crank.rod_length),
            {0.5 * (p.pin.x + p.slider.x) + 0.3 * H, 0.5 * (p.pin.y + p.slider.y)}, "left", 7.0);
  s.symbols("{/:Italic F}", {0.25 * p.pin.x + 0.75 * p.slider.x - 0.45 * H, 0.25 * p.pin.y + 0.75 * p.slider.y},
            "center", 8.0);
  {
    const Point a{0.4 * p.pin.x + 0.6 * p.slider.x - 0.2 * H, 0.4 * p.pin.y + 0.6 * p.slider.y};
    const double dx = p.slider.x - p.pin.x, dy = p.slider.y - p.pin.y, d = std::hypot(dx, dy);
    s.line(a, {a.x + 0.9 * H * dx / d, a.y + 0.9 * H * dy / d}, 1.2, "#202020", "1", "head filled size screen 0.02,18");
  }
  const double up = high - 0.55 * H;
  s.line({H, y0 + 0.3 * H}, {H, up + 0.15 * H}, 0.5, grey);
  s.dimension({0, up}, {H, up}, "", {0, 0});
  s.symbols(fmt::format("{{/:Italic H}} = {:.4g} mm", H), {1.15 * H, up}, "left", 7.0);
  s.text("slider on its guide", {-0.35 * H, up}, "right", 7.0);
  s.symbols(springs ? "hinge with spring {/:Italic k}" : "wing hinge",
            {-1.55 * H, y0 - 0.95 * H - (springs ? 0.1 * H : 0.0)}, "center", 7.0);
  s.text("wing (cut)", {p.tip[0].x - 0.9 * H, p.tip[0].y - 0.3 * H}, "center", 7.0);
  s.draw(file);
}

/// The mechanism over one cycle, as an SVG that moves by itself.
std::string moving(const SliderCrank<double>& crank, const CycleCase& cycle, const std::string& label) {
  const auto& rows = cycle.run.cycle;
  constexpr std::size_t frames = 45;
  const double H = 1e3 * crank.hinge_offset, r = 1e3 * crank.crank_radius, y0 = 1e3 * crank.mid_stroke_height;
  const double half = (1.0 + wing_shown) * H * 1.06, high = y0 + 3.2 * H, low = -r - 0.9 * H;
  constexpr double slowed = 40.0;
  const double seconds = slowed * (rows.back().time - rows.front().time);
  std::vector<Pose> poses;
  for (std::size_t n = 0; n <= frames; ++n)
    poses.push_back(pose_of(crank, rows[n * (rows.size() - 1) / frames].crank_angle));
  const auto animated = [&](const char* attribute, const auto& of) {
    std::string values;
    for (const Pose& p : poses) values += fmt::format("{}{:.2f}", values.empty() ? "" : ";", of(p));
    return fmt::format("<animate attributeName=\"{}\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" values=\"{}\"/>",
                       attribute, seconds, values);
  };
  const auto line = [&](const char* colour, double width, const auto& a, const auto& b) {
    return fmt::format(
               "<line stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" x1=\"{:.2f}\" y1=\"{:.2f}\" "
               "x2=\"{:.2f}\" y2=\"{:.2f}\">",
               colour, width, a(poses[0]).x, -a(poses[0]).y, b(poses[0]).x, -b(poses[0]).y) +
           animated("x1", [&](const Pose& p) { return a(p).x; }) +
           animated("y1", [&](const Pose& p) { return -a(p).y; }) +
           animated("x2", [&](const Pose& p) { return b(p).x; }) +
           animated("y2", [&](const Pose& p) { return -b(p).y; }) + "</line>\n";
  };
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.2f} {:.2f} {:.2f} {:.2f}\" width=\"672\" role=\"img\" "
      "font-family=\"sans-serif\" font-size=\"2.1\">\n<title>{}</title>\n"
      "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"#ffffff\"/>\n",
      -half, -high, 2.0 * half, high - low, label, -half, -high, 2.0 * half, high - low);
  svg += fmt::format(
      "<path d=\"M0 {:.2f}V{:.2f}M{:.2f} {:.2f}H{:.2f}\" stroke=\"#b0b0b0\" stroke-width=\"0.15\" stroke-dasharray=\"1 "
      "0.6\" fill=\"none\"/>\n",
      -low - 0.4 * H, -high + 0.5 * H, -half, -y0, half);
  svg += fmt::format("<circle r=\"{:.2f}\" fill=\"none\" stroke=\"#b0b0b0\" stroke-width=\"0.15\"/>\n", r);
  const auto origin = [](const Pose&) { return Point{0.0, 0.0}; };
  const auto pin = [](const Pose& p) { return p.pin; };
  const auto slider = [](const Pose& p) { return p.slider; };
  for (std::size_t side = 0; side < 2; ++side) {
    const auto hinge = [side](const Pose& p) { return p.hinge[side]; };
    const auto tip = [side](const Pose& p) { return p.tip[side]; };
    svg += line("#404040", 0.5, slider, hinge) + line("#404040", 1.1, hinge, tip);
    svg += fmt::format(
        "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" fill=\"#ffffff\" stroke=\"#202020\" stroke-width=\"0.2\"/>\n",
        poses[0].hinge[side].x, -poses[0].hinge[side].y, 0.11 * H);
    if (cycle.of.springs) {
      std::string path;
      for (const Point& q : spiral(poses[0].hinge[side], 0.42 * H, -std::numbers::pi / 2)) {
        path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", q.x, -q.y);
      }
      svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#009e73\" stroke-width=\"0.25\"/>\n", path);
    }
  }
  svg += line("#d55e00", 1.0, origin, pin) + line("#0072b2", 0.7, pin, slider);
  svg += fmt::format("<circle r=\"{:.2f}\" fill=\"#ffffff\" stroke=\"#202020\" stroke-width=\"0.2\"/>\n", 0.14 * H);
  svg += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" fill=\"{}\">{}, {:g} times slowed</text>\n</svg>\n",
                     -half + 0.3 * H, -low - 0.25 * H, style::ink, label, slowed);
  return svg;
}

}  // namespace

std::vector<Sheet> mechanism_sheets(const Material& m) {
  std::vector<Sheet> sheets;
  for (const bool springs : {false, true}) {
    Sheet s;
    const Design<double>& design = m.pair[springs ? 1 : 0];
    const Vehicle<double> vehicle = resolve(design);
    const SliderCrank<double> crank = vehicle.transmission.slider_crank;
    s.id = springs ? "figure-08" : "figure-01";
    s.heading = springs ? "Figure 8. The mechanism with hinge springs" : "Figure 1. The mechanism";
    s.section = "vehicle";
    s.caption =
        springs
            ? fmt::format(
                  "Each hinge has a spring of {:.4g} mN m/rad, relaxed in mid-stroke: with a wing of {:.4g} g mm\u00b2 "
                  "it "
                  "resonates at {:.4g} Hz. Drawn by the program at a crank angle of {:.0f} deg.",
                  1e3 * vehicle.spring.stiffness, 1e9 * vehicle.wing_inertia,
                  std::sqrt(vehicle.spring.stiffness / vehicle.wing_inertia) / two_pi, degrees_per_radian * drawn_angle)
            : fmt::format(
                  "To scale but for the wings, drawn by the program from the vehicle file at a crank angle of {:.0f} "
                  "deg. "
                  "The motor turns the crank; rod and slider swing the wings about their hinges by {:.1f} deg to "
                  "either side. The rod force F (crank reaction force in the paper) loads the joints: their friction "
                  "torque "
                  "is µ rₑ |F| with "
                  "µ rₑ = {:.4g} mm.",
                  degrees_per_radian * drawn_angle, degrees_per_radian * stroke_amplitude(crank),
                  1e3 * design.friction.coefficient);
    const CycleCase* cycle = cycle_of(m.computed.at_frequency, Formulation::rod_force, springs);
    if (cycle) {
      s.animation =
          moving(crank, *cycle,
                 fmt::format("{:g} Hz, {} springs", m.computed.options.frequency, springs ? "with" : "without"));
    }
    Table& t = s.table;
    std::vector<double> angle, height, stroke, wing_lever, crank_lever;
    for (int n = 0; n <= 72; ++n) {
      const double theta = two_pi * n / 72;
      const auto k = crank_kinematics(crank, std::sin(theta), std::cos(theta));
      angle.push_back(theta);
      height.push_back(slider_height(crank, std::sin(theta), std::cos(theta)));
      stroke.push_back(stroke_angle(k));
      wing_lever.push_back(k.wing_lever);
      crank_lever.push_back(k.crank_lever);
    }
    t.add("crank_angle_rad", "rad", "crank angle from the horizontal", angle);
    t.add("slider_height_m", "m", "height of the slider over the crank axis", height);
    t.add("stroke_angle_rad", "rad", "stroke angle", stroke);
    t.add("wing_lever_m", "m", "lever of the rod force on the wings, rod-force", wing_lever);
    t.add("crank_lever_m", "m", "lever of the rod force on the crank", crank_lever);
    s.draw = [crank, springs](PlotFormat format, const std::filesystem::path& file) {
      draw_mechanism(crank, springs, format, file);
    };
    sheets.push_back(std::move(s));
  }
  return sheets;
}

}  // namespace wingbeat::reproduction
