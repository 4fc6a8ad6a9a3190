// Gradients of direct drives whose wings follow the pitch law.
#include "cycle/repeat_recorded_body.hpp"

namespace wingbeat {

template bool CycleGradient<DirectSystem<double, 2>>::run();
template bool CycleGradient<DirectSystem<double, 3>>::run();

}  // namespace wingbeat

namespace wingbeat::detail {

template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<DirectSystem<double, 2>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);
template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<DirectSystem<double, 3>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);

}  // namespace wingbeat::detail
