// Every number of a vehicle by name, so that no parameter can be forgotten in a comparison of scalars.
#pragma once

#include <array>
#include <utility>

#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

inline constexpr int parameter_count = 33;

// The numbers, transmission and formulation and the pointer to the coefficient table: a new parameter must be listed
// below.
static_assert(sizeof(Vehicle<double>) ==
              parameter_count * sizeof(double) + 2 * sizeof(double) + sizeof(std::shared_ptr<const CoefficientTable>));

template <Scalar S>
std::array<std::pair<const char*, S*>, parameter_count> parameters(Vehicle<S>& v) {
  CoefficientWave<S>& lift = v.wings.coefficients.lift;
  CoefficientWave<S>& drag = v.wings.coefficients.drag;
  return {{{"voltage", &v.voltage},
           {"armature_resistance", &v.motor.armature_resistance},
           {"armature_inductance", &v.motor.armature_inductance},
           {"torque_constant", &v.motor.torque_constant},
           {"inertia", &v.motor.inertia},
           {"viscous_damping", &v.motor.viscous_damping},
           {"friction_torque", &v.motor.friction_torque},
           {"crank_radius", &v.crank.crank_radius},
           {"rod_length", &v.crank.rod_length},
           {"hinge_offset", &v.crank.hinge_offset},
           {"mid_stroke_height", &v.crank.mid_stroke_height},
           {"friction.radius", &v.friction.radius},
           {"friction.damping", &v.friction.damping},
           {"friction.quadratic", &v.friction.quadratic},
           {"friction.torque", &v.friction.torque},
           {"stiffness", &v.spring.stiffness},
           {"wing_count", &v.wing_count},
           {"wing_inertia", &v.wing_inertia},
           {"air_density", &v.wings.air_density},
           {"pitch_coefficient", &v.wings.pitch_coefficient},
           {"s2", &v.wings.s2},
           {"s3", &v.wings.s3},
           {"lift.offset", &lift.offset},
           {"lift.amplitude", &lift.amplitude},
           {"lift.rate", &lift.rate},
           {"lift.phase", &lift.phase},
           {"drag.offset", &drag.offset},
           {"drag.amplitude", &drag.amplitude},
           {"drag.rate", &drag.rate},
           {"drag.phase", &drag.phase},
           {"source_resistance", &v.source_resistance},
           {"angle_of_attack_min", &v.wings.angle_of_attack_min},
           {"drive_frequency", &v.drive_frequency}}};
}

}  // namespace wingbeat
