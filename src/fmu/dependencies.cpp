#include "fmu/dependencies.hpp"

#include "fmu/instant.hpp"

namespace wingbeat::fmu {
namespace {

/// Of the electrical side: current and, without inductance, what it follows from.
struct Knowns {
  Places at;
  std::vector<std::size_t> found;

  void state(std::size_t k) { found.push_back(reference_of(VariableKind::state, k)); }
  void input(InputId id) { found.push_back(reference_of(VariableKind::input, std::size_t(id))); }
  void voltages(bool sine) {
    input(InputId::voltage);
    if (sine) input(InputId::voltage_offset);
  }
};

}  // namespace

std::vector<std::size_t> dependencies_of(const Design<double>& design, std::size_t reference) {
  Knowns k{Places(resolve(design)), {}};
  const Places& at = k.at;
  const bool sine = is_sine(design.supply.type);
  const bool resists = design.supply.type == SupplyType::battery;
  const std::size_t number = number_of(reference);
  const auto all_states = [&] {
    for (std::size_t n = 0; n < at.count; ++n) k.state(n);
  };
  // Everything that forces and accelerations depend on.
  const auto mechanics = [&] {
    all_states();
    if (!at.inductive) k.voltages(sine);
    k.input(InputId::load_torque);
  };
  const auto current = [&] {
    if (at.inductive) return k.state(at.current);
    k.state(1);
    k.voltages(sine);
  };
  const auto velocity = [&] {  // of the stroke
    if (at.crank) k.state(0);
    k.state(1);
  };
  // What the air does without the accelerations.
  const auto aerodynamics = [&] {
    velocity();
    if (at.pitching) k.state(at.pitch), k.state(at.pitch + 1);
  };
  const auto lift = [&] {
    if (at.pitching) mechanics();  // the air's inertia
    else velocity();
  };
  const auto electrical_power = [&] {
    if (!at.inductive) k.state(1);
    if (at.inductive) k.state(at.current);
    k.voltages(sine);
  };
  if (kind_of(reference) == VariableKind::derivative) {
    if (number == 0 || (at.pitching && number == at.pitch)) k.state(number == 0 ? 1 : at.pitch + 1);
    else if (at.inductive && number == at.current) k.state(1), k.state(at.current), k.voltages(sine);
    else if (number < at.count) mechanics();
    else if (number == at.count) lift();
    else if (number <= at.count + 2) current();
    else if (number == at.count + 3) electrical_power();
    else if (number == at.count + 4) mechanics();
    else aerodynamics();
  } else if (kind_of(reference) == VariableKind::output) {
    switch (OutputId(number)) {
      case OutputId::crank_angle: k.state(0); break;
      case OutputId::crank_speed:
      case OutputId::power_viscous: k.state(1); break;
      case OutputId::stroke_angle: k.state(0); break;
      case OutputId::flapping_velocity: velocity(); break;
      case OutputId::pitch_angle: k.state(at.pitch); break;
      case OutputId::pitch_velocity: k.state(at.pitch + 1); break;
      case OutputId::current:
      case OutputId::power_copper: current(); break;
      case OutputId::terminal_voltage:
        if (resists) current();
        if (!resists || at.inductive) k.voltages(sine);
        break;
      case OutputId::lift: lift(); break;
      case OutputId::drag_moment:
      case OutputId::power_aerodynamic: aerodynamics(); break;
      case OutputId::power_electrical: electrical_power(); break;
      case OutputId::power_load:
        k.state(1);
        k.input(InputId::load_torque);
        break;
      default: mechanics(); break;
    }
  }
  return k.found;
}

}  // namespace wingbeat::fmu
