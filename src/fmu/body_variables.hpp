// The variables of a body, side 3 of an FMU.
#pragma once

#include "fmu/body_in_time.hpp"
#include "fmu/variables.hpp"

namespace wingbeat::fmu {

/// Names, units and meanings in the order of BodyState, BodyInputs, BodySettings and BodyInTime::outputs.
struct BodyRow {
  const char* name;
  const char* unit;
  const char* description;
};
inline constexpr BodyRow body_state_rows[] = {
    {"state_body_velocity_x", "m/s", "velocity of the centre of mass, forward, in body axes"},
    {"state_body_velocity_y", "m/s", "to the right"},
    {"state_body_velocity_z", "m/s", "downwards"},
    {"state_body_rate_x", "rad/s", "angular velocity about the forward axis, right side down"},
    {"state_body_rate_y", "rad/s", "about the axis to the right, nose up"},
    {"state_body_rate_z", "rad/s", "about the downward axis, nose to the right"},
    {"state_body_attitude_0", "1", "scalar part of the quaternion from body to earth axes"},
    {"state_body_attitude_1", "1", "its x component"},
    {"state_body_attitude_2", "1", "its y component"},
    {"state_body_attitude_3", "1", "its z component"},
    {"state_body_position_x", "m", "position of the centre of mass, north, in earth axes"},
    {"state_body_position_y", "m", "east"},
    {"state_body_position_z", "m", "down"}};
static_assert(std::size(body_state_rows) == body_state_count);

inline constexpr BodyRow body_input_rows[] = {
    {"wind_x", "m/s", "velocity of the air in earth axes, northwards"},
    {"wind_y", "m/s", "eastwards"},
    {"wind_z", "m/s", "downwards"},
    {"mean_stroke_angle", "rad", "of all wings, forwards"},
    {"stroke_plane_difference", "rad", "right stroke plane nose up, left one nose down"},
    {"incidence_difference", "rad", "angle of attack of the right wings up, of the left ones down"}};

inline constexpr BodyRow body_setting_rows[] = {
    {"gravity", "m/s2", "acceleration of gravity"},
    {"initial_body_position_x", "m", "north, at the start"},
    {"initial_body_position_y", "m", "east"},
    {"initial_body_position_z", "m", "down"},
    {"initial_body_velocity_x", "m/s", "in body axes, forward, at the start"},
    {"initial_body_velocity_y", "m/s", "to the right"},
    {"initial_body_velocity_z", "m/s", "downwards"},
    {"initial_body_roll", "rad", "right side down, at the start"},
    {"initial_body_pitch", "rad", "nose up"},
    {"initial_body_yaw", "rad", "nose to the right"},
    {"initial_body_rate_x", "rad/s", "about the forward axis, at the start"},
    {"initial_body_rate_y", "rad/s", "about the axis to the right"},
    {"initial_body_rate_z", "rad/s", "about the downward axis"}};

inline constexpr BodyRow body_output_rows[] = {
    {"body_position_x", "m", "position of the centre of mass, north, in earth axes"},
    {"body_position_y", "m", "east"},
    {"body_position_z", "m", "down"},
    {"body_velocity_x", "m/s", "velocity of the centre of mass, forward, in body axes"},
    {"body_velocity_y", "m/s", "to the right"},
    {"body_velocity_z", "m/s", "downwards"},
    {"body_rate_x", "rad/s", "angular velocity about the forward axis, right side down"},
    {"body_rate_y", "rad/s", "about the axis to the right, nose up"},
    {"body_rate_z", "rad/s", "about the downward axis, nose to the right"},
    {"body_attitude_0", "1", "scalar part of the quaternion from body to earth axes"},
    {"body_attitude_1", "1", "its x component"},
    {"body_attitude_2", "1", "its y component"},
    {"body_attitude_3", "1", "its z component"},
    {"body_roll", "rad", "roll angle, right side down"},
    {"body_pitch", "rad", "pitch angle, nose up"},
    {"body_yaw", "rad", "yaw angle, nose to the right"},
    {"body_force_x", "N", "force of the air on the vehicle, forward, in body axes"},
    {"body_force_y", "N", "to the right"},
    {"body_force_z", "N", "downwards"},
    {"body_moment_x", "N.m", "moment of the air about the centre of mass, right side down"},
    {"body_moment_y", "N.m", "nose up"},
    {"body_moment_z", "N.m", "nose to the right"},
    {"power_body", "W", "power of the air on the moving body"}};
static_assert(std::size(body_output_rows) == body_output_count);
/// Those before it follow from the state of the body alone.
inline constexpr std::size_t first_body_load = 16;
/// Of the states: those before it act on the motion.
inline constexpr std::size_t first_position = 10;

/// Those of a kind, in their order: states, derivatives, inputs, outputs or settings of a vehicle with a body.
std::vector<Variable> body_variables(const Design<double>& design, VariableKind kind);

}  // namespace wingbeat::fmu
