// Figures 1 and 8: the mechanism, drawn from the vehicle's numbers at a crank angle, and moving.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/mechanism_drawing.hpp"
#include "report/svg.hpp"
#include "reproduction/sheet.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat::reproduction {
namespace {

void draw_mechanism(const AnyTransmission<double>& transmission, bool springs, PlotFormat format,
                    const std::filesystem::path& file) {
  const SliderCrank<double>& crank = transmission.slider_crank;
  const double theta = drawn_crank_angle, mm = 1e3, r = crank.crank_radius, H = crank.hinge_offset,
               y0 = crank.mid_stroke_height, wing = 3.4 * H;
  const MechanismPose pose = pose_of(transmission, theta, wing);
  MechanismSketch s = mechanism_sketch(transmission, springs, pose);
  const PlanePoint pin = pose.at("pin"), slider = pose.at("slider"), hinge = pose.at("hinge");
  const char *grey = "#909090", *ink = "#202020";
  s.line({-H - wing, y0}, {H + wing, y0}, 0.5, grey, "(6,4)");
  s.line({0, 0}, {1.35 * r, 0}, 0.5, grey, "(6,4)");
  // Angles.
  s.arc({0, 0}, 0.75 * r, 0.0, theta, 0.7, ink);
  s.name("{/:Italic θ}", on_circle({0, 0}, 0.95 * r, 0.45 * theta), "center", true);
  const double beta = stroke_angle(crank_kinematics(crank, std::sin(theta), std::cos(theta)));
  s.arc(hinge, 2.2 * H, 0.0, -beta, 0.7, ink);
  s.name("{/:Italic β}", on_circle(hinge, 2.45 * H, -0.5 * beta), "center", true);
  // Names and sizes.
  s.name("crank and motor", {-1.35 * r, -0.25 * H}, "right");
  s.name(fmt::format("{{/:Italic r}}_c = {:.4g} mm", mm * r), {-1.35 * r, -0.87 * H}, "right", true);
  s.name(fmt::format("rod, {{/:Italic l}} = {:.4g} mm", mm * crank.rod_length),
         {0.5 * (pin.x + slider.x) + 0.3 * H, 0.5 * (pin.y + slider.y)}, "left", true);
  s.name("{/:Italic F}", {0.25 * pin.x + 0.75 * slider.x - 0.45 * H, 0.25 * pin.y + 0.75 * slider.y}, "center", true);
  const PlanePoint tail{0.4 * pin.x + 0.6 * slider.x - 0.2 * H, 0.4 * pin.y + 0.6 * slider.y};
  s.line(tail, on_circle(tail, 0.9 * H, std::atan2(slider.y - pin.y, slider.x - pin.x)), 1.2, ink, style::solid,
         "head filled size screen 0.02,18");
  const double up = std::max(y0 + r, y0 + H) + 0.55 * H;
  s.line({0, y0}, {0, up + 0.3 * H}, 0.5, grey, "(14,4,3,4)");
  s.line({H, y0 + 0.3 * H}, {H, up + 0.15 * H}, 0.5, grey);
  s.line({0, up}, {H, up}, 0.6, "#404040", style::solid, "heads filled size screen 0.015,18");
  s.name(fmt::format("{{/:Italic H}} = {:.4g} mm", mm * H), {1.15 * H, up}, "left", true);
  s.name("slider on its guide", {-0.35 * H, up}, "right");
  s.name(springs ? "hinge with spring {/:Italic k}" : "wing hinge", {-0.35 * H, y0 - 1.2 * H}, "right", true);
  s.name("wing (cut)", {pose.at("tip").x - 0.9 * H, pose.at("tip").y - 0.3 * H}, "center");
  s.include({0, -r - H});
  Figure figure(format, 3.5, 3.5 * s.aspect());
  s.draw(figure, {0.0, 1.0, 0.0, 1.0, figure.width(), figure.height()});
  run_gnuplot(figure.script(), file);
}

/// The mechanism over one cycle, as an SVG that moves by itself.
std::string moving(const AnyTransmission<double>& transmission, const CycleCase& cycle, const std::string& label) {
  const auto& rows = cycle.run.cycle;
  constexpr std::size_t frames = 45;
  constexpr double slowed = 40.0, mm = 1e3;
  const SliderCrank<double>& crank = transmission.slider_crank;
  const double H = crank.hinge_offset, r = crank.crank_radius, y0 = crank.mid_stroke_height;
  const double wing = drawn_wing_length(transmission), half = 1.05 * (H + wing), high = y0 + 3.2 * H,
               low = -r - 0.9 * H;
  const double seconds = slowed * (rows.back().time - rows.front().time);
  std::vector<MechanismPose> poses;
  for (std::size_t n = 0; n <= frames; ++n) {
    poses.push_back(pose_of(transmission, rows[n * (rows.size() - 1) / frames].crank_angle, wing));
  }
  SvgDrawing svg(mm, {}, 2);
  const char* faint = "stroke=\"#b0b0b0\" stroke-width=\"0.15\" stroke-dasharray=\"1 0.6\"";
  svg.line({0.0, low + 0.4 * H}, {0.0, high - 0.5 * H}, faint);
  svg.line({-half, y0}, {half, y0}, faint);
  svg.circle({}, r, "fill=\"none\" stroke=\"#b0b0b0\" stroke-width=\"0.15\"");
  for (const MechanismPose::Link& link : poses.front().links) {
    const auto animation = [&](const char* attribute, std::string_view joint, auto coordinate) {
      std::vector<double> values;
      for (const MechanismPose& p : poses) values.push_back((svg.*coordinate)(p.at(joint)));
      return svg.animation(attribute, values, seconds);
    };
    const MechanismStyle style = style_of(link.role);
    // Where nothing moves, as on paper, it is at its first frame.
    svg.line(poses.front().at(link.from), poses.front().at(link.to),
             fmt::format("stroke=\"{}\" stroke-width=\"{:.2f}\" stroke-linecap=\"round\"", style.colour,
                         0.33 * style.weight),
             animation("x1", link.from, &SvgDrawing::x) + animation("y1", link.from, &SvgDrawing::y) +
                 animation("x2", link.to, &SvgDrawing::x) + animation("y2", link.to, &SvgDrawing::y));
  }
  for (const MechanismPose::Joint& joint : poses.front().joints) {
    if (!joint.fixed) continue;
    if (cycle.flapping_case.springs && joint.name != "axis") {
      svg.polyline(spring_spiral(joint.position, 0.1 * H, 0.42 * H),
                   "fill=\"none\" stroke=\"#009e73\" stroke-width=\"0.25\"");
    }
    svg.circle(joint.position, 0.12 * H, "fill=\"#ffffff\" stroke=\"#202020\" stroke-width=\"0.2\"");
  }
  svg.text({-half + 0.3 * H, low + 0.25 * H}, fmt::format("fill=\"{}\"", style::ink),
           fmt::format("{}, {:g} times slowed", label, slowed));
  const std::string box =
      fmt::format("{:.2f} {:.2f} {:.2f} {:.2f}", -mm * half, -mm * high, 2.0 * mm * half, mm * (high - low));
  return svg.file(
      fmt::format("viewBox=\"{}\" width=\"672\" role=\"img\" font-family=\"sans-serif\" font-size=\"2.1\"", box), label,
      fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"#ffffff\"/>\n", -mm * half,
                  -mm * high, 2.0 * mm * half, mm * (high - low)));
}

}  // namespace

std::vector<Sheet> mechanism_sheets(const Material& m) {
  std::vector<Sheet> sheets;
  for (const bool springs : {false, true}) {
    Sheet s;
    const Design<double>& design = m.pair[springs ? 1 : 0];
    const Vehicle<double> vehicle = resolve(design);
    const AnyTransmission<double> transmission = vehicle.transmission;
    const SliderCrank<double>& crank = transmission.slider_crank;
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
                  std::sqrt(vehicle.spring.stiffness / vehicle.wing_inertia) / two_pi,
                  degrees_per_radian * drawn_crank_angle)
            : fmt::format(
                  "To scale but for the wings, drawn by the program from the vehicle file at a crank angle of {:.0f} "
                  "deg. "
                  "The motor turns the crank; rod and slider swing the wings about their hinges by {:.1f} deg to "
                  "either side. The rod force F (crank reaction force in the paper) loads the joints: their friction "
                  "torque "
                  "is µ rₑ |F| with "
                  "µ rₑ = {:.4g} mm.",
                  degrees_per_radian * drawn_crank_angle, degrees_per_radian * stroke_amplitude(crank),
                  1e3 * design.friction.coefficient);
    const CycleCase* cycle = cycle_of(m.computed.at_frequency, Formulation::rod_force, springs);
    if (cycle) {
      s.animation =
          moving(transmission, *cycle,
                 fmt::format("{:g} Hz, {} springs", m.computed.options.frequency, springs ? "with" : "without"));
    }
    Table& t = s.table;
    std::vector<double> angle, height, stroke, wing_jacobian, crank_jacobian;
    for (int n = 0; n <= 72; ++n) {
      const double theta = two_pi * n / 72;
      const auto k = crank_kinematics(crank, std::sin(theta), std::cos(theta));
      angle.push_back(theta);
      height.push_back(slider_height(crank, std::sin(theta), std::cos(theta)));
      stroke.push_back(stroke_angle(k));
      wing_jacobian.push_back(k.wing_jacobian);
      crank_jacobian.push_back(k.crank_jacobian);
    }
    t.add("crank_angle_rad", "rad", "crank angle from the horizontal", angle);
    t.add("slider_height_m", "m", "height of the slider over the crank axis", height);
    t.add("stroke_angle_rad", "rad", "stroke angle", stroke);
    t.add("wing_lever_m", "m", "lever of the rod force on the wings, rod-force", wing_jacobian);
    t.add("crank_lever_m", "m", "lever of the rod force on the crank", crank_jacobian);
    s.draw = [transmission, springs](PlotFormat format, const std::filesystem::path& file) {
      draw_mechanism(transmission, springs, format, file);
    };
    sheets.push_back(std::move(s));
  }
  return sheets;
}

}  // namespace wingbeat::reproduction
