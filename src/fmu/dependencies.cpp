#include "fmu/dependencies.hpp"

#include <algorithm>

#include "fmu/body_variables.hpp"
#include "fmu/dynamics.hpp"

namespace wingbeat::fmu {
namespace {

/// Of one side.
struct Knowns {
  StateLayout layout;
  std::size_t side;
  std::vector<std::size_t> found;

  void state(std::size_t k) { found.push_back(reference_of(VariableKind::state, k, side)); }
  void input(InputId id) { found.push_back(reference_of(VariableKind::input, std::size_t(id), side)); }
  void voltages(bool sine) {
    input(InputId::voltage);
    if (!sine) return;
    input(InputId::voltage_offset);
    state(layout.phase());
  }
};

/// What of the body's state and inputs its motion through the air depends on.
std::vector<std::size_t> flow_of_body(const Design<double>& design) {
  std::vector<std::size_t> found;
  for (std::size_t n = 0; n < first_position; ++n) found.push_back(reference_of(VariableKind::state, n, body_side));
  for (const Variable& v : body_variables(design, VariableKind::input)) found.push_back(v.reference());
  return found;
}

std::vector<std::size_t> known_on_side(const Design<double>& design, VariableKind kind, std::size_t number,
                                       std::size_t side) {
  Knowns k{StateLayout(resolve(design)), side, {}};
  const StateLayout& layout = k.layout;
  const UnknownIndices& indices = layout.indices;
  const bool sine = layout.has_phase;
  const bool resists = design.supply.type == SupplyType::battery;
  const auto all_states = [&] {
    for (std::size_t n = 0; n < indices.count; ++n) k.state(n);
  };
  // How the body moves through the air, which also makes loads depend on where the wings are.
  const auto flow = [&] {
    if (!has_body(design)) return;
    k.state(0);
    const std::vector<std::size_t> body = flow_of_body(design);
    k.found.insert(k.found.end(), body.begin(), body.end());
  };
  // Everything that forces and accelerations depend on.
  const auto mechanics = [&] {
    all_states();
    flow();
    if (!indices.inductive) k.voltages(sine);
    k.input(InputId::load_torque);
  };
  const auto current = [&] {
    if (indices.inductive) return k.state(indices.current);
    k.state(1);
    k.voltages(sine);
  };
  const auto velocity = [&] {  // of the stroke
    if (indices.rotates) k.state(0);
    k.state(1);
  };
  // What the air does without the accelerations.
  const auto aerodynamics = [&] {
    velocity();
    flow();
    if (indices.pitching) k.state(indices.pitch), k.state(indices.pitch + 1);
  };
  const auto lift = [&] {
    if (indices.pitching || design.body.wing_mass) mechanics();  // the inertia of air or wings
    else velocity(), flow();
  };
  const auto electrical_power = [&] {
    if (!indices.inductive) k.state(1);
    if (indices.inductive) k.state(indices.current);
    k.voltages(sine);
  };
  if (kind == VariableKind::derivative) {
    const std::size_t sum = number - layout.first_sum();
    if (number == 0 || (indices.pitching && number == indices.pitch)) k.state(number == 0 ? 1 : indices.pitch + 1);
    else if (indices.inductive && number == indices.current) k.state(1), k.state(indices.current), k.voltages(sine);
    else if (number < indices.count || sum == 5) mechanics();
    else if (number < layout.first_sum()) k.input(InputId::frequency);
    else if (sum == 0) lift();
    else if (sum <= 2) current();
    else if (sum == 3) k.state(1);
    else if (sum == 4) electrical_power();
    else aerodynamics();
  } else if (kind == VariableKind::output) {
    switch (OutputId(number)) {
      case OutputId::crank_angle: k.state(0); break;
      case OutputId::crank_speed:
      case OutputId::power_viscous:
      case OutputId::power_motor_friction: k.state(1); break;
      case OutputId::stroke_angle: k.state(0); break;
      case OutputId::flapping_velocity: velocity(); break;
      case OutputId::pitch_angle: k.state(indices.pitch); break;
      case OutputId::pitch_velocity: k.state(indices.pitch + 1); break;
      case OutputId::current:
      case OutputId::power_copper: current(); break;
      case OutputId::terminal_voltage:
        if (resists) current();
        if (!resists || indices.inductive) k.voltages(sine);
        break;
      case OutputId::lift: lift(); break;
      case OutputId::drag_moment:
      case OutputId::power_aerodynamic: aerodynamics(); break;
      case OutputId::power_electrical: electrical_power(); break;
      case OutputId::power_load:
        k.state(1);
        k.input(InputId::load_torque);
        break;
      case OutputId::roll_moment:
      case OutputId::pitch_moment:
        lift();
        k.state(0);
        break;
      case OutputId::yaw_moment:
        aerodynamics();
        k.state(0);
        break;
      default: mechanics(); break;
    }
  }
  std::sort(k.found.begin(), k.found.end());
  k.found.erase(std::unique(k.found.begin(), k.found.end()), k.found.end());
  return k.found;
}

std::vector<std::size_t> sorted(std::vector<std::size_t> all) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Of an output of all drives.
std::vector<std::size_t> known_of_drives(const Design<double>& design, OutputId output) {
  if (!has_two_drives(design)) return known_on_side(design, VariableKind::output, std::size_t(output), 0);
  std::vector<std::size_t> both;
  for (const std::size_t side : {1, 2}) {
    for (const std::size_t known : known_on_side(design, VariableKind::output, std::size_t(output), side)) {
      both.push_back(known);
    }
  }
  return both;
}

/// What the loads on the body depend on.
std::vector<std::size_t> known_of_loads(const Design<double>& design) {
  std::vector<std::size_t> all = known_of_drives(design, OutputId::lift);
  for (const OutputId output :
       {OutputId::drag_moment, design.body.wing_mass ? OutputId::motor_torque : OutputId::lift}) {
    for (const std::size_t known : known_of_drives(design, output)) all.push_back(known);
  }
  return sorted(std::move(all));
}

std::vector<std::size_t> known_of_body(const Design<double>& design, VariableKind kind, std::size_t index) {
  const auto states = [](std::size_t from, std::size_t to) {
    std::vector<std::size_t> found;
    for (std::size_t n = from; n < to; ++n) found.push_back(reference_of(VariableKind::state, n, body_side));
    return found;
  };
  constexpr std::size_t rates = 3, attitude = 6;
  if (kind == VariableKind::derivative) {
    if (index < attitude) return known_of_loads(design);
    if (index < first_position) return states(rates, first_position);
    std::vector<std::size_t> found = states(0, rates);
    for (const std::size_t known : states(attitude, first_position)) found.push_back(known);
    return found;
  }
  if (index >= first_body_load) return known_of_loads(design);
  // Outputs are the position, the other states in their order, the angles of the attitude, and the loads.
  constexpr std::size_t positions = 3, numbers = positions + first_position;
  if (index < positions) return states(first_position + index, first_position + index + 1);
  if (index < numbers) return states(index - positions, index - positions + 1);
  return states(attitude, first_position);
}

}  // namespace

std::vector<std::size_t> dependencies_of(const Design<double>& design, std::size_t reference) {
  const VariableKind kind = kind_of(reference);
  if (kind != VariableKind::derivative && kind != VariableKind::output) return {};
  const std::size_t side = side_of(reference), index = index_of(reference);
  if (side == body_side) return known_of_body(design, kind, index);
  if (design.body.wing_mass) {
    // What the body does to a drive depends on all that acts on the body.
    std::vector<std::size_t> own = side != 0 || !has_two_drives(design) ? known_on_side(design, kind, index, side)
                                                                        : known_of_drives(design, OutputId(index));
    const std::size_t velocity = reference_of(VariableKind::state, 0, body_side);
    if (std::find(own.begin(), own.end(), velocity) != own.end()) {
      for (const std::size_t known : known_of_loads(design)) own.push_back(known);
    }
    return sorted(std::move(own));
  }
  if (!has_two_drives(design) || side != 0) return known_on_side(design, kind, index, side);
  std::vector<std::size_t> both;
  for (const std::size_t one : {1, 2}) {
    for (const std::size_t known : known_on_side(design, kind, index, one)) both.push_back(known);
  }
  std::sort(both.begin(), both.end());
  return both;
}

}  // namespace wingbeat::fmu
