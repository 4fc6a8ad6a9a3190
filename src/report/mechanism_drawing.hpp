// The mechanism between motor and wings as a panel of a figure, to scale but for the wings' length.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/figure.hpp"
#include "wingbeat/parts/mechanism_pose.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// Where a panel stands on the page: fractions of the page, and the page's size [in].
struct PanelPlace {
  double left, right, bottom, top;
  double page_width, page_height;
};

/// Lowest and highest stroke angle of a cycle [rad].
struct StrokeRange {
  double low, high;
};

/// Crank angle of drawings [rad].
inline constexpr double drawn_crank_angle = two_pi / 9.0;

/// How a link is drawn: its colour, its weight in gnuplot's unit, its dash.
struct MechanismStyle {
  const char* colour;
  double weight;
  const char* dash = style::solid;
};
MechanismStyle style_of(LinkRole role);

/// A spiral spring around a hinge.
std::vector<PlanePoint> spring_spiral(const PlanePoint& centre, double inner, double outer);

/// Lines, circles and names [m], kept until their extent is known.
class MechanismSketch {
 public:
  /// `joint`: radius of a joint.
  explicit MechanismSketch(double joint) : joint_(joint) {}

  void line(const PlanePoint& a, const PlanePoint& b, double weight, const char* colour,
            const char* dash = style::solid, const char* head = "nohead");
  void path(std::span<const PlanePoint> points, double weight, const char* colour);
  void arc(const PlanePoint& centre, double radius, double from, double to, double weight, const char* colour);
  void circle(const PlanePoint& p, double radius, const char* fill);
  void box(const PlanePoint& p, double half, const char* fill);
  /// A name beside a point, `anchor` as gnuplot has it; `marked`: with its marks for italics and subscripts.
  void name(std::string text, const PlanePoint& p, const char* anchor, bool marked = false);
  /// A fixed axis: a foot on hatched ground.
  void ground(const PlanePoint& p);
  /// Makes room for a point.
  void include(const PlanePoint& p);

  double aspect() const { return (high_.y - low_.y) / (high_.x - low_.x); }
  void draw(Figure& figure, const PanelPlace& place) const;

 private:
  struct Name {
    std::string text, placement;
    bool marked;
  };
  std::string script_, joints_;
  std::vector<Name> names_;
  double joint_;
  PlanePoint low_{1e300, 1e300}, high_{-1e300, -1e300};
};

/// The mechanism in a pose, but for names; with the ends of a stroke in grey.
MechanismSketch mechanism_sketch(const AnyTransmission<double>& t, bool springs, const MechanismPose& pose,
                                 const StrokeRange* stroke = nullptr);

/// Kind and sizes of the mechanism in a line.
std::string mechanism_caption(const Vehicle<double>& vehicle);

/// Draws the mechanism that the vehicle has: crank, rod and slider; crank, coupler, rocker and ground; a stroke law as
/// its curve; or the motor's shaft in the wing hinge. Links stand at a crank angle of 40 deg, wings at the ends of the
/// stroke in grey.
void draw_mechanism_panel(Figure& figure, const Vehicle<double>& vehicle, const StrokeRange& stroke,
                          const PanelPlace& place);

/// What the waveform of the internal force is called.
const char* internal_force_name(TransmissionType type);

}  // namespace wingbeat
