// Gradients of cranks whose wings pitch on hinges.
#include "cycle/repeat_recorded_body.hpp"

namespace wingbeat {

template bool CycleGradient<PitchCrankSystem<double, 3>>::run();
template bool CycleGradient<PitchCrankSystem<double, 4>>::run();

}  // namespace wingbeat

namespace wingbeat::detail {

template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<PitchCrankSystem<double, 3>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);
template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<PitchCrankSystem<double, 4>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);

}  // namespace wingbeat::detail
