// The mechanism between motor and wings as a panel of a figure, to scale but for the wings' length.
#pragma once

#include <string>

#include "report/figure.hpp"
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
