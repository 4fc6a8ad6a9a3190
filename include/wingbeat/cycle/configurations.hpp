// The configuration of a vehicle at many crank angles at once.
#pragma once

#include <span>

#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// What configuration_at() gives at the crank angles `theta` [rad], |theta| < 30, to rounding; `at` is as long. A
/// slider-crank is computed on SIMD lanes where the processor has any.
void configurations_at(const Vehicle<double>& vehicle, std::span<const double> theta,
                       std::span<Configuration<double>> configurations);

}  // namespace wingbeat
