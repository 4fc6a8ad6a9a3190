#include "wingbeat/cycle/cycle_instants.hpp"

#include "wingbeat/cycle/pitch_metrics.hpp"
#include "wingbeat/cycle/recorded_cycle.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

template <class System>
std::vector<CycleInstant> instants_of(const RecordedCycle<System>& recorded) {
  const System& system = recorded.system;
  constexpr auto time = std::size_t(Integral::time);
  const double period = cycle_integrals(recorded.cycle)[time];
  std::vector<CycleInstant> instants;
  for (const auto& step : recorded.cycle.steps) {
    for (std::size_t k = 0; k < detail::gauss_nodes.size(); ++k) {
      const double x = step.x + 0.5 * (1.0 + detail::gauss_nodes[k]) * step.h;
      const auto inside = solver::evaluate_inside<true>(system, recorded.cycle, step, x);
      const Motion<double> m = system.motion(x, inside.y, step.signs);
      const double rate = system.template rates<true>(x, inside.y, step.signs).dq[time];
      double pitch_angle = absent;
      if constexpr (System::on_hinges) {
        if (pitches(system.vehicle)) pitch_angle = system.local_pitch(inside.y);
      }
      instants.push_back({waveform_row(system.vehicle, m, inside.dq[time], system.shaft_angle(x, inside.y),
                                       system.shaft_speed(inside.y), system.stroke_angle(m, inside.y), pitch_angle),
                          0.5 * step.h * detail::gauss_weights[k] * rate / period, x});
    }
  }
  return instants;
}

}  // namespace

std::vector<CycleInstant> cycle_instants(const CycleRecord& cycle) {
  return visit(cycle, [](const auto& recorded) { return instants_of(recorded); });
}

}  // namespace wingbeat
