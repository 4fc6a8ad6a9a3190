// A vehicle larger or smaller than a known one, by laws that are stated.
#pragma once

#include <string>
#include <vector>

#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

enum class ScaledPart {
  wing,    ///< outline, masses and moments of the wings; drive and body, with the distance of the shoulders, stay
  vehicle  ///< everything
};

struct ScaledParameter {
  std::string key, unit;
  double before, after;  ///< SI
  int exponent;          ///< after = before * factor^exponent
};

struct ScaledDesign {
  Design<double> design;
  std::vector<ScaledParameter> parameters;  ///< that change, in the order of the reference
  bool chords = false;                      ///< radii and chords of a tabulated outline grow with the factor, too
};

/// A design `factor` times as large, > 0. All lengths grow with the factor. Densities, stresses, voltages and speeds
/// stay, so that times grow with it, masses with its third power, currents with its second, and a quantity of any other
/// unit as its dimensions say: torques by 3, stiffnesses of hinges by 3, moments of inertia by 5, torque constants
/// by 1. Two numbers do not follow: the air keeps its kinematic viscosity, and the armature resistance grows by -3
/// instead of -2, for the resistivity of copper stays. ScaledPart::wing changes the wings' own numbers alone, as far as
/// they are lengths, masses and their moments. Throws ParameterError for a factor out of range, or where the larger or
/// smaller vehicle is out of a range.
ScaledDesign scaled(const Design<double>& design, double factor, ScaledPart part);

}  // namespace wingbeat
