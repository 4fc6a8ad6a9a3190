#include "wingbeat/parts/body.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"

namespace wingbeat {
namespace {

double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double norm(const Triple& a) { return std::sqrt(dot(a, a)); }

/// v turned by the attitude, or, `back`, the other way.
Triple turned(const std::array<double, 4>& q, const Triple& v, bool back) {
  const double length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  const Triple axis = {q[1], q[2], q[3]};
  const Triple once = cross(axis, v), twice = cross(axis, once);
  const double sense = back ? -1.0 : 1.0;
  Triple result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = v[k] + 2.0 / length2 * (sense * q[0] * once[k] + twice[k]);
  return result;
}

}  // namespace

Triple to_earth(const std::array<double, 4>& attitude, const Triple& v) { return turned(attitude, v, false); }
Triple to_body(const std::array<double, 4>& attitude, const Triple& v) { return turned(attitude, v, true); }

Triple euler_angles(const std::array<double, 4>& attitude) {
  const Triple x = to_earth(attitude, {1.0, 0.0, 0.0});
  const Triple y = to_earth(attitude, {0.0, 1.0, 0.0}), z = to_earth(attitude, {0.0, 0.0, 1.0});
  return {std::atan2(y[2], z[2]), -std::asin(std::clamp(x[2], -1.0, 1.0)), std::atan2(x[1], x[0])};
}

std::array<double, 4> attitude_of(const Triple& angles) {
  const double c_r = std::cos(0.5 * angles[0]), s_r = std::sin(0.5 * angles[0]);
  const double c_p = std::cos(0.5 * angles[1]), s_p = std::sin(0.5 * angles[1]);
  const double c_y = std::cos(0.5 * angles[2]), s_y = std::sin(0.5 * angles[2]);
  return {c_r * c_p * c_y + s_r * s_p * s_y, s_r * c_p * c_y - c_r * s_p * s_y, c_r * s_p * c_y + s_r * c_p * s_y,
          c_r * c_p * s_y - s_r * s_p * c_y};
}

Triple inertia_times(const Body& b, const Triple& W) {
  return {b.inertia_roll * W[0] - b.inertia_product * W[2], b.inertia_pitch * W[1],
          b.inertia_yaw * W[2] - b.inertia_product * W[0]};
}

Triple inertia_solve(const Body& b, const Triple& M) {
  const double determinant = b.inertia_roll * b.inertia_yaw - square(b.inertia_product);
  return {(b.inertia_yaw * M[0] + b.inertia_product * M[2]) / determinant, M[1] / b.inertia_pitch,
          (b.inertia_roll * M[2] + b.inertia_product * M[0]) / determinant};
}

BodyLoads plate_loads(const Body& body, const Triple& velocity, const Triple& rates) {
  BodyLoads loads;
  const double half_density = 0.5 * body.air_density;
  const auto moves = [&](const Triple& place) {
    const Triple turning = cross(rates, place);
    return Triple{velocity[0] + turning[0], velocity[1] + turning[1], velocity[2] + turning[2]};
  };
  const Triple at{0.0, 0.0, body.drag_below}, v = moves(at);
  const double speed = norm(v);
  add_force(at,
            {-half_density * body.drag_area[0] * speed * v[0], -half_density * body.drag_area[1] * speed * v[1],
             -half_density * body.drag_area[2] * speed * v[2]},
            loads);
  for (const Plate& plate : body.plates) {
    if (!(plate.area > 0.0)) continue;
    const Triple u = moves(plate.place);
    const double force = -half_density * plate.coefficient * plate.area * norm(u) * dot(u, plate.normal);
    add_force(plate.place, {force * plate.normal[0], force * plate.normal[1], force * plate.normal[2]}, loads);
  }
  return loads;
}

BodyState body_rates(const Body& body, const BodyState& state, const BodyLoads& loads, double gravity) {
  BodyState rates;
  const Triple weight = to_body(state.attitude, {0.0, 0.0, gravity});
  const Triple& W = state.rates;
  const Triple turning = cross(W, state.velocity), momentum = cross(W, inertia_times(body, W));
  for (std::size_t k = 0; k < 3; ++k) rates.velocity[k] = loads.force[k] / body.mass + weight[k] - turning[k];
  rates.rates = inertia_solve(
      body, {loads.moment[0] - momentum[0], loads.moment[1] - momentum[1], loads.moment[2] - momentum[2]});
  const auto& q = state.attitude;
  rates.attitude = {-0.5 * (q[1] * W[0] + q[2] * W[1] + q[3] * W[2]), 0.5 * (q[0] * W[0] + q[2] * W[2] - q[3] * W[1]),
                    0.5 * (q[0] * W[1] + q[3] * W[0] - q[1] * W[2]), 0.5 * (q[0] * W[2] + q[1] * W[1] - q[2] * W[0])};
  rates.position = to_earth(q, state.velocity);
  return rates;
}

double body_energy(const Body& body, const BodyState& state, double gravity) {
  return 0.5 * (body.mass * dot(state.velocity, state.velocity) + dot(state.rates, inertia_times(body, state.rates))) -
         body.mass * gravity * state.position[2];
}

}  // namespace wingbeat
