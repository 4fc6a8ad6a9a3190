// Gradients of cranks whose wings pitch on hinges.
#include "cycle/repeat_recorded_body.hpp"

namespace wingbeat {

template class CycleGradient<PitchCrankSystem<double, 3>>;
template class CycleGradient<PitchCrankSystem<double, 4>>;

}  // namespace wingbeat

namespace wingbeat::detail {

template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<PitchCrankSystem<double, 3>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);
template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<PitchCrankSystem<double, 4>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);

}  // namespace wingbeat::detail
