// Cycle-averaged forces and moments of the air on a body that moves: stability derivatives by quasi-steady blade
// elements, the flapping and the pitching of the wings held as they are in hover (flapping counter-forces and
// counter-torques; Cheng and Deng, IEEE Trans. Robotics 27, 2011).
//
// Axes: x forward, y to the right, z down; origin midway between the stroke axes, which are parallel to z and, without
// hinge_offset, one. The stroke plane is the x-y plane; a positive stroke angle beta swings either wing forward, from y
// (right) or -y (left) towards x. Half of the blade moments S_n is on either side.
//
// A strip at r has the span direction e_r = (sin beta, +-cos beta, 0), moves along e_t = (cos beta, -+sin beta, 0) and
// gains dV = v + omega x p, p = (0, +-d, 0) + r e_r, from the body: the force on it follows from its velocity
// (parts/strip_force.hpp), to first order in dV; rotational lift and added mass are left out.
#pragma once

#include <Eigen/Core>
#include <array>

#include "wingbeat/cycle/record.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// Rows: forces X, Y, Z [N] and moments L, M, N [N m]; columns: velocities u, v, w [m/s] and rates p, q, r [rad/s].
using BodyDerivatives = Eigen::Matrix<double, 6, 6>;

inline constexpr std::array<const char*, 6> body_loads = {"X", "Y", "Z", "L", "M", "N"};
inline constexpr std::array<const char*, 6> body_motions = {"u", "v", "w", "p", "q", "r"};

/// The derivatives over the cycle of an orbit. `vehicle` is what it was found for, of `design`; hinge_offset d: from
/// the body's middle plane to either stroke axis [m]. What needs S_1 of a planform that is given by its moments alone
/// is absent.
BodyDerivatives body_derivatives(const Design<double>& design, const Vehicle<double>& vehicle, const CycleRecord& cycle,
                                 double hinge_offset = 0.0);

}  // namespace wingbeat
