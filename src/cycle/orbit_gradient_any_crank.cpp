// Gradients of cranks of any kind.
#include "cycle/repeat_recorded_body.hpp"

namespace wingbeat {

template bool CycleGradient<AnyCrankSystem<double>>::run();

}  // namespace wingbeat

namespace wingbeat::detail {

template OrbitGradient repeat_recorded(const SteadyFlapping&, const RecordedCycle<AnyCrankSystem<double>>&,
                                       const Vehicle<GradientJet>&, const GradientVehicle&, const GradientOptions&);

}  // namespace wingbeat::detail
