// The gradient of one system's recorded cycle, the temperatures of the motor held. Each kind of system has a file of
// its own that instantiates it, orbit_gradient_*.cpp: they take longest of all to compile.
#pragma once

#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/cycle/recorded_cycle.hpp"

namespace wingbeat::detail {

inline void make_absent(GradientJet& x) { x.v.setConstant(absent); }

template <class System>
OrbitGradient repeat_recorded(const SteadyFlapping& orbit, const RecordedCycle<System>& recorded,
                              const Vehicle<GradientJet>& vehicle, const GradientVehicle& given,
                              const GradientOptions& options);

}  // namespace wingbeat::detail
