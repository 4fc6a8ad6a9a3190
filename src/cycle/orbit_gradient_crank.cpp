// Gradients of cranks whose wings follow the pitch law.
#include "cycle/repeat_recorded_body.hpp"

namespace wingbeat {

template bool CycleGradient<CrankSystem<double, 1>>::run();
template bool CycleGradient<CrankSystem<double, 2>>::run();

}  // namespace wingbeat

namespace wingbeat::detail {

template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<CrankSystem<double, 1>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);
template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<CrankSystem<double, 2>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);

}  // namespace wingbeat::detail
