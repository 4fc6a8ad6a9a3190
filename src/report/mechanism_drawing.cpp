#include "report/mechanism_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace wingbeat {
namespace {

constexpr const char* faint_colour = "#b0b0b0";
constexpr const char* spring_colour = "#009e73";

void set_margins(Figure& figure, const PanelPlace& place) {
  figure.add("set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset bmargin at screen {}\n",
             place.left, place.right, place.top, place.bottom);
}

double joint_radius(const AnyTransmission<double>& t) {
  if (t.type == TransmissionType::slider_crank) return 0.11 * t.slider_crank.crank_radius;
  return (t.type == TransmissionType::four_bar ? 0.05 : 0.042) * drawn_wing_length(t);
}

/// A wing with the ends of its stroke.
void add_wing(MechanismSketch& sketch, const AnyTransmission<double>& t, double crank_angle,
              const MechanismPose::Link& wing, const StrokeRange& stroke) {
  std::vector<PlanePoint> tips;
  for (int n = 0; n <= 24; ++n) {
    const double beta = stroke.low + (stroke.high - stroke.low) * n / 24.0;
    const MechanismPose pose = pose_of(t, crank_angle, beta, drawn_wing_length(t));
    tips.push_back(pose.at(wing.to));
    if (n == 0 || n == 24) sketch.line(pose.at(wing.from), tips.back(), 1.6, faint_colour);
  }
  sketch.path(tips, 0.6, faint_colour);
}

/// Circles and lines on which joints move.
void add_guides(MechanismSketch& sketch, const AnyTransmission<double>& t) {
  const PlanePoint axis{};
  if (t.type == TransmissionType::slider_crank) {
    const double r = t.slider_crank.crank_radius;
    sketch.line({0.0, -1.3 * r}, {0.0, t.slider_crank.mid_stroke_height + 1.9 * r}, 0.5, faint_colour, "(14,4,3,4)");
    sketch.arc(axis, r, 0.0, two_pi, 0.5, faint_colour);
  } else if (t.type == TransmissionType::four_bar) {
    const RockerEnds<double> ends = rocker_ends(t.four_bar);
    sketch.arc(axis, t.four_bar.crank_radius, 0.0, two_pi, 0.5, faint_colour);
    sketch.arc({t.four_bar.ground_length, 0.0}, t.four_bar.rocker_length, ends.stretched, ends.folded, 0.5,
               faint_colour);
  } else {
    sketch.circle(axis, 4.2 * joint_radius(t), "#f0f0f0");
    sketch.line(axis, {1.3 * drawn_wing_length(t), 0.0}, 0.5, faint_colour, "(6,4)");
  }
}

void add_names(MechanismSketch& sketch, const Vehicle<double>& vehicle, const MechanismPose& pose) {
  const AnyTransmission<double>& t = vehicle.transmission;
  const double j = joint_radius(t);
  const PlanePoint tip = pose.at("tip");
  if (t.type == TransmissionType::slider_crank) {
    const double r = t.slider_crank.crank_radius;
    const PlanePoint pin = pose.at("pin"), slider = pose.at("slider");
    sketch.name("crank", {1.25 * r, 0.1 * r}, "left");
    sketch.name("rod", {0.5 * (pin.x + slider.x) + 0.3 * r, 0.5 * (pin.y + slider.y)}, "left");
    sketch.name("slider", {0.35 * r, slider.y + 0.55 * r}, "left");
  } else if (t.type == TransmissionType::four_bar) {
    const FourBar<double>& f = t.four_bar;
    const PlanePoint pin = pose.at("pin"), rocker = pose.at("rocker");
    sketch.name("crank", {-f.crank_radius - j, 0.6 * f.crank_radius}, "right");
    sketch.name("coupler", {0.5 * (pin.x + rocker.x), 0.5 * (pin.y + rocker.y) + 2.2 * j}, "right");
    sketch.name("rocker", {rocker.x + 1.4 * j, rocker.y + 1.8 * j}, "left");
    sketch.name("ground", {0.5 * f.ground_length, -1.8 * j}, "center");
    sketch.name(f.stroke_ratio == 1.0 ? "wing" : fmt::format("wing, {:.3g} x rocker", f.stroke_ratio),
                {tip.x + 1.5 * j, tip.y}, "left");
  } else {
    sketch.name(is_given(vehicle.piezo) ? "piezo" : "motor", {-5.2 * j, 0.0}, "right");
    sketch.name("wing", {tip.x + 1.5 * j, tip.y}, "left");
  }
}

/// The curve beta(theta) with the rows of its table.
void draw_stroke_law(Figure& figure, const StrokeTable<double>& table, const PanelPlace& place) {
  set_margins(figure, place);
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

MechanismStyle style_of(LinkRole role) {
  switch (role) {
    case LinkRole::ground: return {"#404040", 0.6, "(6,4)"};
    case LinkRole::wing: return {"#404040", 3.2};
    case LinkRole::lever: return {"#404040", 1.5};
    case LinkRole::rocker: return {"#cc79a7", 2.6};
    case LinkRole::rod: return {"#0072b2", 2.2};
    case LinkRole::crank: break;
  }
  return {"#d55e00", 3.2};
}

std::vector<PlanePoint> spring_spiral(const PlanePoint& centre, double inner, double outer) {
  constexpr int pieces = 60;
  constexpr double turns = 2.25;
  std::vector<PlanePoint> points;
  for (int n = 0; n <= pieces; ++n) {
    const double share = double(n) / pieces;
    points.push_back(on_circle(centre, inner + (outer - inner) * share, -two_pi * (turns * (1.0 - share) + 0.25)));
  }
  return points;
}

void MechanismSketch::line(const PlanePoint& a, const PlanePoint& b, double weight, const char* colour,
                           const char* dash, const char* head) {
  include(a);
  include(b);
  fmt::format_to(std::back_inserter(script_),
                 "set arrow from {:.6g},{:.6g} to {:.6g},{:.6g} {} front dt {} lw {} lc rgb '{}'\n", a.x, a.y, b.x, b.y,
                 head, dash, weight, colour);
}

void MechanismSketch::path(std::span<const PlanePoint> points, double weight, const char* colour) {
  for (std::size_t n = 1; n < points.size(); ++n) line(points[n - 1], points[n], weight, colour);
}

void MechanismSketch::arc(const PlanePoint& centre, double radius, double from, double to, double weight,
                          const char* colour) {
  constexpr int pieces = 48;
  std::vector<PlanePoint> points;
  for (int n = 0; n <= pieces; ++n) points.push_back(on_circle(centre, radius, from + (to - from) * n / pieces));
  path(points, weight, colour);
}

void MechanismSketch::circle(const PlanePoint& p, double radius, const char* fill) {
  include({p.x - radius, p.y - radius});
  include({p.x + radius, p.y + radius});
  fmt::format_to(std::back_inserter(joints_),
                 "set object circle at {:.6g},{:.6g} size {:.6g} front fillcolor rgb '{}' fillstyle solid border "
                 "lc rgb '#202020' lw 0.8\n",
                 p.x, p.y, radius, fill);
}

void MechanismSketch::box(const PlanePoint& p, double half, const char* fill) {
  fmt::format_to(std::back_inserter(joints_),
                 "set object rectangle from {:.6g},{:.6g} to {:.6g},{:.6g} front fillcolor rgb '{}' fillstyle solid "
                 "border lc rgb '#202020' lw 0.6\n",
                 p.x - half, p.y - half, p.x + half, p.y + half, fill);
}

void MechanismSketch::name(std::string text, const PlanePoint& p, const char* anchor, bool marked) {
  names_.push_back({std::move(text), fmt::format("{:.6g},{:.6g} {}", p.x, p.y, anchor), marked});
}

void MechanismSketch::ground(const PlanePoint& p) {
  const double j = joint_, y = p.y - 3.2 * j;
  line(p, {p.x - 1.6 * j, y}, 0.8, "#404040");
  line(p, {p.x + 1.6 * j, y}, 0.8, "#404040");
  line({p.x - 2.6 * j, y}, {p.x + 2.6 * j, y}, 1.2, "#202020");
  for (int n = -2; n <= 2; ++n) line({p.x + n * j, y}, {p.x + (n - 0.7) * j, y - 0.9 * j}, 0.6, "#202020");
  circle(p, joint_, "#ffffff");
}

void MechanismSketch::draw(Figure& figure, const PanelPlace& place) const {
  set_margins(figure, place);
  const double width = (place.right - place.left) * place.page_width;
  const double height = (place.top - place.bottom) * place.page_height;
  const double scale = 1.06 * std::max((high_.x - low_.x) / width, (high_.y - low_.y) / height);
  const double x = 0.5 * (low_.x + high_.x), y = 0.5 * (low_.y + high_.y);
  figure.add("set xrange [{}:{}]\nset yrange [{}:{}]\n", x - 0.5 * scale * width, x + 0.5 * scale * width,
             y - 0.5 * scale * height, y + 0.5 * scale * height);
  figure.add("unset border\nunset tics\nunset grid\n");
  figure.add("{}{}", script_, joints_);
  for (const auto& [text, placement, marked] : names_) {
    if (marked) figure.symbols(text, style::text_size, placement);
    else figure.text(text, style::text_size, placement);
  }
  figure.add("plot NaN\nunset object\nset border 3\nset tics nomirror out scale 0.5 noenhanced\n");
  figure.add("set xtics nomirror autofreq\nset ytics nomirror autofreq\nset yrange [*:*]\n");
}

void MechanismSketch::include(const PlanePoint& p) {
  low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
  high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
}

MechanismSketch mechanism_sketch(const AnyTransmission<double>& t, bool springs, const MechanismPose& pose,
                                 const StrokeRange* stroke) {
  const double j = joint_radius(t);
  MechanismSketch sketch(j);
  add_guides(sketch, t);
  for (const MechanismPose::Link& link : pose.links) {
    if (link.role == LinkRole::wing && stroke) add_wing(sketch, t, drawn_crank_angle, link, *stroke);
    const MechanismStyle style = style_of(link.role);
    sketch.line(pose.at(link.from), pose.at(link.to), style.weight, style.colour, style.dash);
    if (link.role == LinkRole::wing && springs) {
      sketch.path(spring_spiral(pose.at(link.from), 1.2 * j, 3.4 * j), 0.9, spring_colour);
    }
  }
  for (const MechanismPose::Joint& joint : pose.joints) {
    const bool is_shaft = t.type == TransmissionType::direct;
    if (joint.name == "slider") sketch.box(joint.position, 1.55 * j, "#e0e0e0");
    else if (joint.fixed && !is_shaft) sketch.ground(joint.position);
    else if (joint.name == "pin" || joint.name == "rocker" || joint.fixed) sketch.circle(joint.position, j, "#ffffff");
  }
  return sketch;
}

const char* internal_force_name(TransmissionType type) {
  if (type == TransmissionType::four_bar) return "coupler force";
  if (type == TransmissionType::tabulated) return "reaction";
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
    case TransmissionType::direct:
      return is_given(vehicle.piezo) ? "piezo: its tip swings the wing through a flexure transmission"
                                     : "direct drive: the motor's shaft is the wing hinge";
    default: return name_of(t.type);
  }
}

void draw_mechanism_panel(Figure& figure, const Vehicle<double>& vehicle, const StrokeRange& stroke,
                          const PanelPlace& place) {
  const AnyTransmission<double>& t = vehicle.transmission;
  if (t.type == TransmissionType::tabulated) return draw_stroke_law(figure, t.tabulated, place);
  const double wing = drawn_wing_length(t);
  const MechanismPose pose = t.type == TransmissionType::direct ? pose_of(t, 0.0, 0.6 * stroke.high, wing)
                                                                : pose_of(t, drawn_crank_angle, wing);
  MechanismSketch sketch = mechanism_sketch(t, vehicle.spring.stiffness > 0.0, pose, &stroke);
  add_names(sketch, vehicle, pose);
  sketch.draw(figure, place);
}

}  // namespace wingbeat
