// Gradients of direct drives whose wings pitch on hinges.
#include "cycle/repeat_recorded_body.hpp"

namespace wingbeat {

template bool CycleGradient<PitchDirectSystem<double, 4>>::run();
template bool CycleGradient<PitchDirectSystem<double, 5>>::run();

}  // namespace wingbeat

namespace wingbeat::detail {

template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<PitchDirectSystem<double, 4>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);
template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<PitchDirectSystem<double, 5>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);

}  // namespace wingbeat::detail
