#include "report/mechanism_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace wingbeat {
namespace {

constexpr double drawn_crank_angle = two_pi / 9.0;
constexpr const char* crank_colour = "#d55e00";
constexpr const char* rod_colour = "#0072b2";
constexpr const char* rocker_colour = "#cc79a7";
constexpr const char* wing_colour = "#404040";
constexpr const char* spring_colour = "#009e73";
constexpr const char* faint_colour = "#b0b0b0";

struct MechanismPoint {
  double x, y;
};

MechanismPoint on_circle(const MechanismPoint& centre, double radius, double angle) {
  return {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
}

/// Lines and circles in millimetres, kept until their extent is known.
class MechanismSketch {
 public:
  explicit MechanismSketch(double joint) : joint_(joint) {}

  void line(const MechanismPoint& a, const MechanismPoint& b, double weight, const char* colour, const char* dash = "1",
            const char* head = "nohead") {
    see(a);
    see(b);
    fmt::format_to(std::back_inserter(script_),
                   "set arrow from {:.6g},{:.6g} to {:.6g},{:.6g} {} front dt {} lw {} lc rgb '{}'\n", a.x, a.y, b.x,
                   b.y, head, dash, weight, colour);
  }
  void arc(const MechanismPoint& centre, double radius, double from, double to, double weight, const char* colour) {
    constexpr int pieces = 48;
    for (int n = 0; n < pieces; ++n) {
      line(on_circle(centre, radius, from + (to - from) * n / pieces),
           on_circle(centre, radius, from + (to - from) * (n + 1) / pieces), weight, colour);
    }
  }
  void joint(const MechanismPoint& p) { circle(p, joint_, "#ffffff"); }
  void circle(const MechanismPoint& p, double radius, const char* fill) {
    see({p.x - radius, p.y - radius});
    see({p.x + radius, p.y + radius});
    joints_ += fmt::format(
        "set object circle at {:.6g},{:.6g} size {:.6g} front fillcolor rgb '{}' fillstyle solid border "
        "lc rgb '#202020' lw 0.8\n",
        p.x, p.y, radius, fill);
  }
  void box(const MechanismPoint& p, double half, const char* fill) {
    joints_ += fmt::format(
        "set object rectangle from {:.6g},{:.6g} to {:.6g},{:.6g} front fillcolor rgb '{}' fillstyle solid border "
        "lc rgb '#202020' lw 0.6\n",
        p.x - half, p.y - half, p.x + half, p.y + half, fill);
  }
  /// A name beside a point, `anchor` as gnuplot has it.
  void name(std::string text, const MechanismPoint& p, const char* anchor) {
    names_.push_back({std::move(text), fmt::format("{:.6g},{:.6g} {}", p.x, p.y, anchor)});
  }
  /// A fixed axis: a foot on hatched ground.
  void ground(const MechanismPoint& p) {
    const double j = joint_, y = p.y - 3.2 * j;
    line(p, {p.x - 1.6 * j, y}, 0.8, wing_colour);
    line(p, {p.x + 1.6 * j, y}, 0.8, wing_colour);
    line({p.x - 2.6 * j, y}, {p.x + 2.6 * j, y}, 1.2, "#202020");
    for (int n = -2; n <= 2; ++n) line({p.x + n * j, y}, {p.x + (n - 0.7) * j, y - 0.9 * j}, 0.6, "#202020");
    joint(p);
  }
  /// A spiral spring around a hinge.
  void spring(const MechanismPoint& p) {
    constexpr int pieces = 60;
    constexpr double turns = 2.25 * two_pi;
    MechanismPoint before = on_circle(p, 1.2 * joint_, -turns);
    for (int n = 1; n <= pieces; ++n) {
      const double share = double(n) / pieces;
      const MechanismPoint here = on_circle(p, joint_ * (1.2 + 2.2 * share), -turns * (1.0 - share) - 0.25 * two_pi);
      if (n > 1) line(before, here, 0.9, spring_colour);
      before = here;
    }
  }
  /// A wing from its hinge in the direction `zero` + sense beta, its ends of the stroke in grey.
  void wing(const MechanismPoint& hinge, double length, double zero, double sense, double beta,
            const StrokeRange& stroke) {
    for (const double end : {stroke.low, stroke.high}) {
      line(hinge, on_circle(hinge, length, zero + sense * end), 1.6, faint_colour);
    }
    arc(hinge, length, zero + sense * stroke.low, zero + sense * stroke.high, 0.6, faint_colour);
    line(hinge, on_circle(hinge, length, zero + sense * beta), 3.2, wing_colour);
  }

  void draw(Figure& figure, const PanelPlace& place) const {
    const double width = (place.right - place.left) * place.page_width;
    const double height = (place.top - place.bottom) * place.page_height;
    const double scale = 1.06 * std::max((high_.x - low_.x) / width, (high_.y - low_.y) / height);
    const double x = 0.5 * (low_.x + high_.x), y = 0.5 * (low_.y + high_.y);
    figure.add("set xrange [{}:{}]\nset yrange [{}:{}]\n", x - 0.5 * scale * width, x + 0.5 * scale * width,
               y - 0.5 * scale * height, y + 0.5 * scale * height);
    figure.add("unset border\nunset tics\nunset grid\n");
    figure.add("{}{}", script_, joints_);
    for (const auto& [text, placement] : names_) figure.text(text, style::text_size, placement);
    figure.add("plot NaN\nunset object\nset border 3\nset tics nomirror out scale 0.5 noenhanced\n");
    figure.add("set xtics nomirror autofreq\nset ytics nomirror autofreq\nset yrange [*:*]\n");
  }

 private:
  void see(const MechanismPoint& p) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
  }
  std::string script_, joints_;
  std::vector<std::pair<std::string, std::string>> names_;  ///< text, placement
  double joint_;
  MechanismPoint low_{1e300, 1e300}, high_{-1e300, -1e300};
};

MechanismSketch sketch_of(const SliderCrank<double>& c, bool springs, const StrokeRange& stroke) {
  const double mm = 1e3, s = std::sin(drawn_crank_angle), cosine = std::cos(drawn_crank_angle);
  const double r = mm * c.crank_radius, H = mm * c.hinge_offset, y0 = mm * c.mid_stroke_height;
  const MechanismPoint axis{0.0, 0.0}, pin{r * cosine, r * s}, slider{0.0, mm * slider_height(c, s, cosine)};
  const double beta = stroke_angle(crank_kinematics(c, s, cosine));
  MechanismSketch sketch(0.11 * r);
  sketch.line({0.0, -1.3 * r}, {0.0, y0 + 1.9 * r}, 0.5, faint_colour, "(14,4,3,4)");
  sketch.arc(axis, r, 0.0, two_pi, 0.5, faint_colour);
  const double wing_shown = 1.2 * mm * c.rod_length;
  for (const double side : {1.0, -1.0}) {
    const MechanismPoint hinge{side * H, y0};
    // The slider lifts the wing's inner end, so that the wing beyond the hinge goes down.
    sketch.wing(hinge, wing_shown, side > 0.0 ? 0.0 : pi, -side, beta, stroke);
    sketch.line(slider, hinge, 1.4, wing_colour);
    if (springs) sketch.spring(hinge);
    sketch.ground(hinge);
  }
  sketch.line(pin, slider, 2.2, rod_colour);
  sketch.line(axis, pin, 3.2, crank_colour);
  sketch.box(slider, 0.17 * r, "#e0e0e0");
  sketch.name("crank", {1.25 * r, 0.1 * r}, "left");
  sketch.name("rod", {0.5 * (pin.x + slider.x) + 0.3 * r, 0.5 * (pin.y + slider.y)}, "left");
  sketch.name("slider", {0.35 * r, slider.y + 0.55 * r}, "left");
  sketch.ground(axis);
  sketch.joint(pin);
  return sketch;
}

MechanismSketch sketch_of(const FourBar<double>& f, bool springs, const StrokeRange& stroke) {
  const double mm = 1e3, r = mm * f.crank_radius, d = mm * f.ground_length, p = mm * f.rocker_length;
  const double theta = drawn_crank_angle;
  const double beta = stroke_angle(crank_kinematics(f, std::sin(theta), std::cos(theta)));
  const double phi = f.ground_angle + beta / f.stroke_ratio;
  const MechanismPoint axis{0.0, 0.0}, pin = on_circle(axis, r, theta), rocker_axis{d, 0.0};
  const MechanismPoint rocker_pin = on_circle(rocker_axis, p, phi);
  const double joint = 0.045 * (d + p);
  MechanismSketch sketch(joint);
  sketch.line(axis, rocker_axis, 0.6, wing_colour, "(6,4)");
  sketch.arc(axis, r, 0.0, two_pi, 0.5, faint_colour);
  const RockerEnds<double> ends = rocker_ends(f);
  sketch.arc(rocker_axis, p, ends.stretched, ends.folded, 0.5, faint_colour);
  sketch.wing(rocker_axis, 0.9 * (d + p), 0.0, 1.0, beta, stroke);
  sketch.line(rocker_axis, rocker_pin, 2.6, rocker_colour);
  sketch.line(pin, rocker_pin, 2.2, rod_colour);
  sketch.line(axis, pin, 3.2, crank_colour);
  if (springs) sketch.spring(rocker_axis);
  sketch.ground(axis);
  sketch.ground(rocker_axis);
  sketch.name("crank", {-r - joint, 0.6 * r}, "right");
  sketch.name("coupler", {0.5 * (pin.x + rocker_pin.x), 0.5 * (pin.y + rocker_pin.y) + 2.2 * joint}, "right");
  sketch.name("rocker", {rocker_pin.x + 1.4 * joint, rocker_pin.y + 1.8 * joint}, "left");
  sketch.name("ground", {0.5 * d, -1.8 * joint}, "center");
  const MechanismPoint tip = on_circle(rocker_axis, 0.9 * (d + p), beta);
  sketch.name(f.stroke_ratio == 1.0 ? "wing" : fmt::format("wing, {:.3g} x rocker", f.stroke_ratio),
              {tip.x + 1.5 * joint, tip.y}, "left");
  sketch.joint(pin);
  sketch.joint(rocker_pin);
  return sketch;
}

/// One wing on its shaft, seen along the shaft.
MechanismSketch direct_sketch(bool springs, const StrokeRange& stroke) {
  const MechanismPoint shaft{0.0, 0.0};
  MechanismSketch sketch(1.0);
  sketch.circle(shaft, 4.2, "#f0f0f0");
  sketch.wing(shaft, 24.0, 0.0, 1.0, 0.6 * stroke.high, stroke);
  sketch.line(shaft, {31.0, 0.0}, 0.5, faint_colour, "(6,4)");
  if (springs) sketch.spring(shaft);
  sketch.joint(shaft);
  sketch.name("motor", {-5.2, 0.0}, "right");
  const MechanismPoint tip = on_circle(shaft, 24.0, 0.6 * stroke.high);
  sketch.name("wing", {tip.x + 1.5, tip.y}, "left");
  return sketch;
}

/// The curve beta(theta) with the rows of its table.
void draw_stroke_law(Figure& figure, const StrokeTable<double>& table) {
  figure.add("$law << END\n");
  for (int n = 0; n <= 360; ++n) {
    const double theta = two_pi * n / 360.0;
    figure.add("{} {}\n", n,
               degrees_per_radian * stroke_angle(crank_kinematics(table, std::sin(theta), std::cos(theta))));
  }
  figure.add("END\n$rows << END\n");
  for (const auto& [theta, beta] : table.curve->rows()) {
    figure.add("{} {}\n", degrees_per_radian * wrap_angle(theta), degrees_per_radian * table.scale * beta);
  }
  figure.add(
      "END\nset xrange [0:360]\nset xtics 60\nset format x '%g'\nplot $law using 1:2 with lines {}, "
      "$rows using 1:2 with points pt 7 ps 0.3 lc rgb '#000000'\nset xtics nomirror autofreq\n",
      style::first_curve);
}

}  // namespace

const char* internal_force_name(TransmissionType type) {
  switch (type) {
    case TransmissionType::four_bar: return "coupler force";
    case TransmissionType::tabulated: return "reaction";
    case TransmissionType::slider_crank:
    case TransmissionType::direct: break;
  }
  return "rod force";
}

std::string mechanism_caption(const Vehicle<double>& vehicle) {
  const AnyTransmission<double>& t = vehicle.transmission;
  const double mm = 1e3;
  switch (t.type) {
    case TransmissionType::slider_crank:
      return fmt::format("slider-crank: crank {:.4g}, rod {:.4g}, hinge offset {:.4g} mm",
                         mm * t.slider_crank.crank_radius, mm * t.slider_crank.rod_length,
                         mm * t.slider_crank.hinge_offset);
    case TransmissionType::four_bar: {
      const FourBar<double>& f = t.four_bar;
      return fmt::format("four-bar: crank {:.4g}, coupler {:.4g}, rocker {:.4g}, ground {:.4g} mm", mm * f.crank_radius,
                         mm * f.coupler_length, mm * f.rocker_length, mm * f.ground_length);
    }
    case TransmissionType::tabulated:
      return fmt::format("tabulated: stroke over crank angle (deg); reaction at {:.4g} mm",
                         mm * t.tabulated.reference_radius);
    case TransmissionType::direct: break;
  }
  return "direct drive: the motor's shaft is the wing hinge";
}

void draw_mechanism_panel(Figure& figure, const Vehicle<double>& vehicle, const StrokeRange& stroke,
                          const PanelPlace& place) {
  figure.add("set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset bmargin at screen {}\n",
             place.left, place.right, place.top, place.bottom);
  const AnyTransmission<double>& t = vehicle.transmission;
  const bool springs = vehicle.spring.stiffness > 0.0;
  switch (t.type) {
    case TransmissionType::slider_crank: return sketch_of(t.slider_crank, springs, stroke).draw(figure, place);
    case TransmissionType::four_bar: return sketch_of(t.four_bar, springs, stroke).draw(figure, place);
    case TransmissionType::tabulated: return draw_stroke_law(figure, t.tabulated);
    case TransmissionType::direct: return direct_sketch(springs, stroke).draw(figure, place);
  }
}

}  // namespace wingbeat
