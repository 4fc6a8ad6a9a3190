// From a stroke to the links of a mechanism, and what play in its joints costs; docs/linkages.md.
#pragma once

#include <string>
#include <vector>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// What a mechanism must do.
struct StrokeTarget {
  double stroke;                    ///< peak-to-peak stroke angle of the wings [rad]
  double envelope;                  ///< longest distance between two points that pins and axes reach [m]
  double shortest = 0.0;            ///< no link is shorter [m]; 0: a tenth of the envelope
  double stroke_ratio = 1.0;        ///< n_s of a four-bar [1]; a slider-crank has 1
  double time_ratio = 1.0;          ///< at most: the longer half-stroke over the shorter at constant crank speed [1]
  double transmission_angle = 0.0;  ///< at least [rad]
};

/// Kinematics of a slider-crank or four-bar.
struct MechanismQuality {
  double stroke;  ///< peak to peak [rad]
  /// Of a four-bar least angle between coupler and rocker, or its least distance from 180 deg, if that is less; of a
  /// slider-crank least angle between the rod and the normal of its guide [rad].
  double transmission_angle;
  double time_ratio;            ///< longer half-stroke over the shorter at constant crank speed [1]
  double slope_up, slope_down;  ///< largest |d beta / d theta| of the half-strokes [1]
  double envelope;              ///< longest distance between two points that pins and axes reach [m]
  double shortest;              ///< link [m]
};

/// Of a transmission that validate() takes and that is a slider-crank or a four-bar; throws ParameterError for others.
MechanismQuality mechanism_quality(const TransmissionDesign<double>& transmission);

/// What radial play in every joint does. Each joint adds its play along the force in coupler or rod, whose length then
/// counts as l - delta or l + delta, with delta = 4 c of a four-bar: the pins and axes of crank and rocker. Of a
/// slider-crank delta = 3 c, crank axis and the rod's pins, and the lever's two joints shift the slider by 2 c more.
struct ClearanceCost {
  double clearance;                      ///< c, radial [m]
  double stroke_lowest, stroke_highest;  ///< where all play is taken up inwards, or outwards, at both ends [rad]
  double play;                           ///< free angle of the wings at a held crank, at mid-stroke [rad]
  double play_highest;                   ///< largest of any crank angle [rad]
  double phase;  ///< the crank turns by that before the wings follow, once the force has changed its sign at mid-stroke
                 ///< [rad]
};

/// Throws ParameterError where the mechanism does not turn with so much play.
ClearanceCost clearance_cost(const TransmissionDesign<double>& transmission, double clearance);

/// The best transmission angle that a stroke ratio allows.
struct StrokeRatioChoice {
  double stroke_ratio;
  double transmission_angle;  ///< [rad]; absent where no four-bar does it
};

struct SynthesisedMechanism {
  StrokeTarget target{};  ///< as searched: with the shortest link, and of a four-bar with the least angle that counts
  bool found = false;
  TransmissionDesign<double> transmission;  ///< the best one, also where its transmission angle is less than wanted
  MechanismQuality quality{};               ///< but for the transmission angle of it alone
  std::vector<StrokeRatioChoice> ratios;    ///< of a four-bar: what gear pairs or strings would allow
  double ratio_needed = absent;             ///< least n_s that keeps the transmission angle wanted, where found is not
};

/// The four-bar of a stroke with the best transmission angle. The two dead centres give crank and coupler from the
/// rocker's length p and its angle \f$\varphi_+\f$ with crank and coupler stretched out, so that the stroke is exact
/// (A the crank's axis, B_+ and B_- the rocker's pin at the ends of its swing):
/// \f[
/// r_\mathrm{c} = \tfrac12 (|AB_+| - |AB_-|), \qquad l = \tfrac12 (|AB_+| + |AB_-|), \qquad
/// \varphi_- = \varphi_+ + \Phi / n_\mathrm{s}
/// \f]
/// p and \f$\varphi_+\f$ are searched by COBYLA from the best points of a grid. Throws ParameterError for a target out
/// of range.
SynthesisedMechanism synthesise_four_bar(const StrokeTarget& target);

/// The slider-crank of a stroke with the longest rod: \f$H = r_\mathrm{c} / \tan(\Phi/2)\f$, the shorter of crank and
/// hinge offset as short as allowed. Throws ParameterError for a target out of range.
SynthesisedMechanism synthesise_slider_crank(const StrokeTarget& target);

}  // namespace wingbeat
