// The parameter table on the dual numbers of gradients.
#include "vehicle/parameter_rows.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"

namespace wingbeat {

template std::span<const Parameter<GradientJet>> parameter_table<GradientJet>();

}  // namespace wingbeat
