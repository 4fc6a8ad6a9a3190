// Draws docs/img/mechanism.svg: the slider-crank and a wing section with the symbols of docs/model.md.
//
//   draw_mechanism FILE            writes it
//   draw_mechanism --check FILE    fails where the file is not what this program draws
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "report/mechanism_drawing.hpp"
#include "report/svg.hpp"

namespace wingbeat {
namespace {

/// Of elements with that class, by which the styles below know them.
std::string of_class(std::string_view name) { return fmt::format("class=\"{}\"", name); }

class Symbols {
 public:
  std::string drawn() {
    mechanism();
    sizes();
    motor();
    wing_section();
    return svg_.file("viewBox=\"0 0 880 430\" width=\"880\" height=\"430\" role=\"img\"",
                     "Slider-crank mechanism and wing section with the symbols of the model", head());
  }

 private:
  void arrow(const PlanePoint& a, const PlanePoint& b, const char* kind) {
    svg_.line(a, b, fmt::format("class=\"{0}\" marker-end=\"url(#{0})\"", kind));
  }
  void size(const PlanePoint& a, const PlanePoint& b) {
    svg_.line(a, b, "class=\"size\" marker-start=\"url(#tail)\" marker-end=\"url(#size)\"");
  }
  void angle(const PlanePoint& centre, double radius, double from, double to, bool head = true) {
    svg_.arc(centre, radius, from, to, head ? "class=\"size\" marker-end=\"url(#size)\"" : "class=\"size\"");
  }

  static std::string italic(std::string_view text) { return fmt::format("<tspan class=\"i\">{}</tspan>", text); }
  static std::string below(std::string_view text) {
    return fmt::format("<tspan dy=\"4\" font-size=\"12\" class=\"u\">{}</tspan>", text);
  }
  /// Words, on the line again after a subscript.
  static std::string words(std::string_view text, bool after_subscript = false) {
    return fmt::format("<tspan{} class=\"u w\">{}</tspan>", after_subscript ? " dy=\"-4\"" : "", text);
  }
  void text(const PlanePoint& p, std::string_view content, std::string_view kind = "", const char* anchor = "middle") {
    svg_.text(p, fmt::format("text-anchor=\"{}\" class=\"{}\"", anchor, kind), content);
  }

  void mechanism() {
    svg_.line({0.0, -2.4}, {0.0, y_ + 4.2}, of_class("faint"));
    svg_.line({0.0, 0.0}, {r_c_ + 4.6, 0.0}, of_class("faint"));
    svg_.line({-H_ - wing_, y_0_}, {H_ + wing_, y_0_}, of_class("faint"));
    svg_.circle({}, r_c_, of_class("faint none"));
    for (const MechanismPose::Link& link : pose_.links) {
      const char* kind = link.role == LinkRole::lever ? "wing" : name_of(link.role);
      svg_.line(pose_.at(link.from), pose_.at(link.to), of_class(kind));
      if (link.role != LinkRole::wing) continue;
      svg_.polyline(spring_spiral(pose_.at(link.from), 0.7, 2.2), of_class("spring"));
    }
    for (const MechanismPose::Joint& joint : pose_.joints) {
      if (joint.name == "slider") svg_.square(joint.position, 11.0, "rx=\"3\" class=\"joint\"");
      else if (joint.fixed || joint.name == "pin") svg_.circle(joint.position, 0.5, of_class("joint"));
    }
    // The rod's force on the slider, along the rod.
    const PlanePoint slider = pose_.at("slider");
    const auto along_rod = [&](double distance) { return on_circle(slider, distance, 0.5 * pi + gamma_); };
    arrow(along_rod(0.9), along_rod(4.4), "force");
    text({along_rod(4.4).x - 0.6, along_rod(4.4).y - 0.1}, italic("F"), "force", "end");
  }

  void sizes() {
    const PlanePoint pin = pose_.at("pin"), slider = pose_.at("slider"), hinge = pose_.at("hinge"),
                     left_tip = pose_.at("left_tip");
    angle({}, 2.6, 0.0, theta_);
    text({3.25, 1.15}, italic("θ"));
    angle({}, 7.2, -25.0 / degrees_per_radian, 12.0 / degrees_per_radian);
    text({10.6, -2.6}, italic("ω") + words(" = dθ/dt"));
    text({0.5 * pin.x - 0.9, 0.5 * pin.y + 0.7}, italic("r") + below("c"), "crank");
    text({2.9, 0.5 * (pin.y + y_) + 0.3}, italic("l"), "rod", "start");
    angle(slider, 6.4, -0.5 * pi, -0.5 * pi + gamma_, false);
    text({0.9, y_ - 7.6}, italic("γ"));
    size({-2.2, 0.0}, {-2.2, y_});
    text({-3.1, 0.5 * y_ - 1.6}, italic("y"));
    svg_.line(slider, {-2.6, y_}, of_class("thin"));
    svg_.line({}, {-2.6, 0.0}, of_class("thin"));
    size({-5.4, 0.0}, {-5.4, y_0_});
    text({-6.7, 0.5 * y_0_ - 0.8}, italic("y") + below("0"));
    svg_.line({-5.9, 0.0}, {}, of_class("thin"));
    size({0.0, y_ + 3.3}, {H_, y_ + 3.3});
    svg_.line(hinge, {H_, y_ + 3.8}, of_class("thin"));
    text({0.5 * H_, y_ + 4.0}, italic("H"));
    angle(hinge, 10.5, 0.0, -beta_);
    text({H_ + 11.2, y_0_ - 2.4}, italic("β"), "", "start");
    text({-H_ - 0.2, y_0_ - 3.6}, italic("k") + words(" each hinge spring"), "spring");
    const PlanePoint left = pose_.at("left_hinge");
    text({left.x + 0.72 * (left_tip.x - left.x) + 1.5, left.y + 0.72 * (left_tip.y - left.y) - 2.6},
         italic("J") + below("w") + words(" each wing", true));
  }

  void motor() {
    text({0.0, -8.2}, words("motor ") + italic("v, i, K, R") + below("a") + back(", L") + below("a") + back(", J, b"));
  }
  static std::string back(std::string_view text) {
    return fmt::format("<tspan dy=\"-4\" class=\"i\">{}</tspan>", text);
  }

  /// Seen from the tip.
  void wing_section() {
    const PlanePoint centre{36.0, 3.0};
    const double alpha = 58.0 / degrees_per_radian, chord = 7.0;
    const PlanePoint lead = on_circle(centre, 0.5 * chord, alpha), trail = on_circle(centre, -0.5 * chord, alpha),
                     middle = on_circle(centre, 0.15 * chord, alpha);
    svg_.line(lead, trail, of_class("wing"));
    svg_.circle(lead, 0.4, of_class("joint"));
    svg_.line({lead.x - 2.2, lead.y}, {lead.x + 1.0, lead.y}, of_class("faint"));
    arrow({lead.x + 0.8, lead.y}, {lead.x + 4.6, lead.y}, "move");
    text({lead.x + 2.6, lead.y + 0.7}, italic("r β′"));
    angle(lead, 2.0, pi, pi + alpha, false);
    text({lead.x - 2.6, lead.y - 1.6}, italic("α"));
    arrow(middle, {middle.x, middle.y + 5.6}, "force");
    text({middle.x - 0.4, middle.y + 5.9}, words("lift"), "force", "end");
    arrow(middle, {middle.x - 4.4, middle.y}, "force");
    text({middle.x - 4.6, middle.y - 0.3}, words("drag"), "force", "end");
    text({centre.x + 0.3, centre.y - 4.8}, words("wing section at distance"));
    text({centre.x + 0.3, centre.y - 6.1}, italic("r") + words(" from the hinge, chord ") + italic("c") +
                                               "<tspan class=\"u\">(</tspan>" + italic("r") +
                                               "<tspan class=\"u\">)</tspan>");
  }

  struct Colours {
    const char *ink, *back, *grey, *crank, *rod, *spring, *force;
  };
  static std::string coloured(const Colours& c) {
    return fmt::format(
        ".back,.joint{{fill:{back}}} text,.movefill{{fill:{ink}}} .faint,.thin,.size{{stroke:{grey}}} "
        ".wing,.move,.joint{{stroke:{ink}}} .crank{{stroke:{crank}}} .rod{{stroke:{rod}}} .spring{{stroke:{spring}}} "
        ".force{{stroke:{force}}} text.crank{{fill:{crank}}} text.rod{{fill:{rod}}} text.spring{{fill:{spring}}} "
        "text.force,.headfill{{fill:{force}}} .sizefill{{fill:{grey}}}",
        fmt::arg("back", c.back), fmt::arg("ink", c.ink), fmt::arg("grey", c.grey), fmt::arg("crank", c.crank),
        fmt::arg("rod", c.rod), fmt::arg("spring", c.spring), fmt::arg("force", c.force));
  }
  static std::string mark(const char* name, const char* kind, const char* shape, int end = 7) {
    return fmt::format(
        "<marker id=\"{}\" markerWidth=\"9\" markerHeight=\"9\" refX=\"{}\" refY=\"3.5\" orient=\"auto\" "
        "markerUnits=\"userSpaceOnUse\"><path class=\"{}\" d=\"{}\"/></marker>\n",
        name, end, kind, shape);
  }
  static std::string head() {
    const Colours light{
        "#24292f", "#ffffff", "#8c959f", style_of(LinkRole::crank).colour, style_of(LinkRole::rod).colour,
        "#00875f", "#a3397f"},
        dark{"#e6e9ec", "#161b22", "#7d8590", "#ff9a57", "#6cbcf0", "#3fd0a4", "#e59ccb"};
    return fmt::format(
               "<style>\n"
               "line,polyline,circle{{fill:none}}\n"
               "text{{font:17px 'DejaVu Serif','Times New Roman',serif}} .i{{font-style:italic}} "
               ".u{{font-style:normal}}\n"
               ".w{{font-family:'DejaVu Sans',Arial,sans-serif;font-size:13px}}\n"
               ".faint{{stroke-width:1;stroke-dasharray:5 4}} .thin{{stroke-width:0.8}} .size{{stroke-width:1}}\n"
               ".wing{{stroke-width:4;stroke-linecap:round}} .crank{{stroke-width:6;stroke-linecap:round}}\n"
               ".rod{{stroke-width:5;stroke-linecap:round}} .spring{{stroke-width:1.6}} .force,.move{{stroke-width:2}} "
               ".joint{{stroke-width:1.5}}\n"
               "{}\n@media (prefers-color-scheme: dark) {{ {} }}\n"
               "text.crank,text.rod,text.spring,text.force{{stroke:none}}\n"
               "</style>\n<defs>\n",
               coloured(light), coloured(dark)) +
           mark("force", "headfill", "M0,0 L8,3.5 L0,7 z") + mark("move", "movefill", "M0,0 L8,3.5 L0,7 z") +
           mark("size", "sizefill", "M0,0.5 L8,3.5 L0,6.5 z") + mark("tail", "sizefill", "M8,0.5 L0,3.5 L8,6.5 z", 1) +
           "</defs>\n<rect class=\"back\" width=\"880\" height=\"430\" rx=\"6\"/>\n";
  }

  // Proportions that show every angle; not those of a vehicle.
  static constexpr double r_c_ = 6.0, rod_ = 14.0, H_ = 11.0, y_0_ = rod_, wing_ = 16.0;
  static AnyTransmission<double> transmission() {
    AnyTransmission<double> t;
    t.type = TransmissionType::slider_crank;
    t.slider_crank.crank_radius = r_c_;
    t.slider_crank.rod_length = rod_;
    t.slider_crank.hinge_offset = H_;
    t.slider_crank.mid_stroke_height = y_0_;
    return t;
  }

  const double theta_ = 48.0 / degrees_per_radian;
  const MechanismPose pose_ = pose_of(transmission(), theta_, wing_);
  const double y_ = pose_.at("slider").y;
  const double gamma_ = std::asin(pose_.at("pin").x / rod_);
  const double beta_ = std::atan2(y_ - y_0_, H_);
  SvgDrawing svg_{12.0, {330.0, 310.0}, 1};
};

}  // namespace
}  // namespace wingbeat

int main(int count, char** arguments) {
  const bool check = count == 3 && std::string_view(arguments[1]) == "--check";
  if (count != 2 && !check) {
    std::fputs("usage: draw_mechanism [--check] FILE\n", stderr);
    return 2;
  }
  const char* name = arguments[count - 1];
  const std::string svg = wingbeat::Symbols().drawn();
  if (!check) return std::ofstream(name, std::ios::binary) << svg ? 0 : 1;
  std::ifstream file(name, std::ios::binary);
  if (std::string(std::istreambuf_iterator<char>(file), {}) == svg) return 0;
  std::fprintf(stderr, "%s is out of date; run draw_mechanism %s\n", name, name);
  return 1;
}
