#include <algorithm>
#include <cmath>

#include "report/figure.hpp"
#include "report/mechanism_drawing.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/vehicle/drive.hpp"

namespace wingbeat {
namespace {

StrokeRange stroke_of(const AnyTransmission<double>& t) {
  StrokeRange stroke{infinity, -infinity};
  for (int n = 0; n < 360; ++n) {
    const double theta = two_pi * n / 360.0;
    const double beta = stroke_angle(crank_kinematics(t, std::sin(theta), std::cos(theta)));
    stroke = {std::min(stroke.low, beta), std::max(stroke.high, beta)};
  }
  return stroke;
}

std::string drawn(const Vehicle<double>& vehicle, const StrokeRange& stroke, PlotFormat format) {
  const double width = 3.4, height = vehicle.transmission.type == TransmissionType::tabulated ? 2.0 : 1.8;
  const bool law = vehicle.transmission.type == TransmissionType::tabulated;
  Figure figure(format, width, height);
  figure.add("set multiplot\n");
  figure.text(mechanism_caption(vehicle), 7.0, fmt::format("screen 0.5,{} center", 1.0 - 0.12 / height));
  draw_mechanism_panel(figure, vehicle, stroke,
                       {.left = law ? 0.15 : 0.03,
                        .right = law ? 0.85 : 0.97,
                        .bottom = law ? 0.15 : 0.03,
                        .top = 1.0 - 0.25 / height,
                        .page_width = width,
                        .page_height = height});
  figure.add("unset multiplot\n");
  return drawing_of(figure.script());
}

}  // namespace

std::string drawn_mechanism(const Design<double>& design, double stroke_amplitude, PlotFormat format) {
  const Vehicle<double> vehicle = resolve(with_any_pitch_coefficient(design));
  const bool fixed = drive_of(vehicle).stroke_is_fixed;
  const StrokeRange stroke = fixed ? stroke_of(vehicle.transmission) : StrokeRange{-stroke_amplitude, stroke_amplitude};
  return drawn(vehicle, stroke, format);
}

std::string drawn_mechanism(const TransmissionDesign<double>& transmission, PlotFormat format) {
  Vehicle<double> vehicle{};
  vehicle.transmission = transmission_from<double>(transmission);
  return drawn(vehicle, stroke_of(vehicle.transmission), format);
}

}  // namespace wingbeat
