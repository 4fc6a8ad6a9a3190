#include "wingbeat/cycle/cycle_map.hpp"

#include <variant>

#include "wingbeat/cycle/cycle_gradient.hpp"

namespace wingbeat {

// Compiled with the gradients in orbit_gradient_*.cpp.
extern template bool CycleGradient<CrankSystem<double, 1>>::run();
extern template bool CycleGradient<CrankSystem<double, 2>>::run();
extern template bool CycleGradient<DirectSystem<double, 2>>::run();
extern template bool CycleGradient<DirectSystem<double, 3>>::run();
extern template bool CycleGradient<PitchCrankSystem<double, 3>>::run();
extern template bool CycleGradient<PitchCrankSystem<double, 4>>::run();
extern template bool CycleGradient<PitchDirectSystem<double, 4>>::run();
extern template bool CycleGradient<PitchDirectSystem<double, 5>>::run();
extern template bool CycleGradient<AnyCrankSystem<double>>::run();
extern template bool CycleGradient<AnyDirectSystem<double>>::run();

namespace {

const CycleSignal crank_speed{"crank_speed", "rad/s", 0.0};
const CycleSignal stroke_angle{"stroke_angle", "rad", 0.0};
const CycleSignal flapping_velocity{"flapping_velocity", "rad/s", 0.0};

/// States of the vehicle, and where they are in the system's.
struct MapStates {
  std::vector<CycleSignal> signals;
  std::vector<std::size_t> places;

  void add(const CycleSignal& signal, std::size_t place) {
    signals.push_back(signal);
    places.push_back(place);
  }
};
template <class System>
MapStates states_of(const Vehicle<double>& v) {
  const UnknownIndices indices(v);
  MapStates states;
  if (!System::turns) states.add(stroke_angle, 0);
  states.add(System::turns ? crank_speed : flapping_velocity, System::shaft);
  for (std::size_t k = 0; k < state_group_count; ++k) {
    if (!indices.has[k]) continue;
    for_states_of<double>(
        StateGroup(k), System::place(StateGroup(k)),
        [&](std::size_t place, const GroupState<double>& state) { states.add({state.name, state.unit, 0.0}, place); });
  }
  return states;
}

/// The inputs, and the vehicle that they are parameters of, as gradient_seed() numbers them.
std::vector<CycleSignal> seed_inputs(const Supply<double>& supply, Vehicle<GradientJet>& v) {
  std::vector<CycleSignal> inputs;
  const auto seed = [&](GradientJet& number, const char* name, const char* unit) {
    number = gradient_seed(number.a, int(inputs.size()));
    inputs.push_back({name, unit, number.a});
  };
  if (supply.type == SupplyType::pwm) {
    const GradientJet duty = gradient_seed(supply.duty, 0);
    v.voltage = duty * supply.voltage;
    inputs.push_back({"duty", "1", supply.duty});
  } else {
    seed(v.voltage, "voltage", "V");
  }
  seed(v.load_torque, "load_torque", "N m");
  if (drive_of(v).alternating) {
    seed(v.drive_frequency, "frequency", "Hz");
    seed(v.spring.stiffness, "spring_stiffness", "N m/rad");
  }
  return inputs;
}

template <class System>
CycleMap linearised(const RecordedCycle<System>& recorded, const Vehicle<double>& vehicle,
                    const Supply<double>& supply) {
  using Gradient = CycleGradient<System>;
  using W = typename Gradient::W;
  constexpr int first_input = gradient_first_slot + Gradient::shift;
  Vehicle<GradientJet> seeded = cast<GradientJet>(vehicle);
  seeded.motor = cast<GradientJet>(recorded.system.vehicle.motor);  // as warm as the orbit's
  CycleMap map;
  map.inputs = seed_inputs(supply, seeded);
  Gradient cycle(recorded, seeded);
  cycle.run();  // whether the orbit itself can be differentiated does not matter to its map

  const MapStates states = states_of<System>(vehicle);
  const auto N = Eigen::Index(states.places.size());
  map.states = states.signals;
  for (std::size_t n = 0; n < states.places.size(); ++n) {
    map.states[n].value = recorded.cycle.steps.front().y[states.places[n]];
  }
  const auto by_states = [&](const W& x, auto row) {
    for (Eigen::Index n = 0; n < N; ++n) row[n] = x.v[Eigen::Index(states.places[std::size_t(n)])];
  };

  const auto total = [&](Integral which) -> const W& { return cycle.totals()[std::size_t(which)]; };
  const W frequency = 1.0 / total(Integral::time);
  map.period = total(Integral::time).a;
  std::vector<W> outputs;
  const auto put = [&](const char* name, const char* unit, const W& value) {
    map.outputs.push_back({name, unit, value.a});
    outputs.push_back(value);
  };
  put("lift_mean", "N", frequency * total(Integral::lift));
  put("power_electrical", "W", frequency * total(Integral::electrical_work));
  put("current_mean", "A", frequency * total(Integral::current));
  put("power_aerodynamic", "W", frequency * total(Integral::aero_work));
  if (drive_of(vehicle).voltage_sets_frequency) {
    put("crank_speed_mean", "rad/s", two_pi * frequency);
    put("frequency", "Hz", frequency);
  }

  const auto inputs = Eigen::Index(map.inputs.size()), rows = Eigen::Index(outputs.size());
  map.a.resize(N, N), map.b.resize(N, inputs), map.c.resize(rows, N), map.d.resize(rows, inputs);
  for (Eigen::Index row = 0; row < N; ++row) {
    const W& end = cycle.end()[states.places[std::size_t(row)]];
    by_states(end, map.a.row(row));
    map.b.row(row) = end.v.segment(first_input, inputs).transpose();
  }
  for (Eigen::Index row = 0; row < rows; ++row) {
    by_states(outputs[std::size_t(row)], map.c.row(row));
    map.d.row(row) = outputs[std::size_t(row)].v.segment(first_input, inputs).transpose();
  }
  return map;
}

}  // namespace

CycleMap cycle_map(const SteadyFlapping& orbit, const Vehicle<double>& vehicle, const Supply<double>& supply) {
  if (orbit.status != FlappingStatus::flapping || orbit.record.empty()) return {};
  return visit(orbit.record, [&](const auto& recorded) { return linearised(recorded, vehicle, supply); });
}

}  // namespace wingbeat
