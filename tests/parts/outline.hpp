// The outline of a wing of given shape and size.
#pragma once

#include "wingbeat/parts/planform.hpp"

namespace wingbeat {

inline Planform<double> outline_of(PlanformShape shape, double hub_offset, double length, double root_chord) {
  Planform<double> p;
  p.shape = shape;
  p.length = length;
  p.root_chord = root_chord;
  p.hub_offset = hub_offset;
  return p;
}

}  // namespace wingbeat
