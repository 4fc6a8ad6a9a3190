#include "wingbeat/cycle/configurations.hpp"

#include <array>
#include <cmath>

#include "wingbeat/core/base_lanes.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

void one_by_one(const Vehicle<double>& v, std::span<const double> theta,
                std::span<Configuration<double>> configurations) {
  for (std::size_t n = 0; n < theta.size(); ++n)
    configurations[n] = configuration_at(v, std::sin(theta[n]), std::cos(theta[n]));
}

#ifdef WINGBEAT_BASE_LANES

using Lanes = BaseLanes<2>;

void on_lanes(const Vehicle<double>& v, std::span<const double> theta,
              std::span<Configuration<double>> configurations) {
  constexpr std::size_t count = Lanes::lanes;
  const CrankGeometry<Lanes> geometry = geometry_of(cast<Lanes>(v.transmission.slider_crank));
  const double stiffness = v.wing_count * v.spring.stiffness;
  for (std::size_t begin = 0; begin < theta.size(); begin += count) {
    const std::size_t used = std::min(count, theta.size() - begin);
    alignas(64) std::array<double, count> number;
    for (std::size_t n = 0; n < count; ++n) number[n] = theta[begin + std::min(n, used - 1)];
    const Lanes angle = Lanes::load(number.data());
    const CrankKinematics<Lanes> k = crank_kinematics(geometry, sin(angle), cos(angle));
    const auto scatter = [&](const Lanes& from, const auto& to) {
      from.store(number.data());
      for (std::size_t n = 0; n < used; ++n) to(configurations[begin + n]) = number[n];
    };
    scatter(k.stroke_offset, [](auto& c) -> double& { return c.kinematics.stroke_offset; });
    scatter(k.tan_stroke, [](auto& c) -> double& { return c.kinematics.tan_stroke; });
    scatter(k.stroke_slope, [](auto& c) -> double& { return c.kinematics.stroke_slope; });
    scatter(k.stroke_second_derivative, [](auto& c) -> double& { return c.kinematics.stroke_second_derivative; });
    scatter(k.wing_jacobian, [](auto& c) -> double& { return c.kinematics.wing_jacobian; });
    scatter(k.crank_jacobian, [](auto& c) -> double& { return c.kinematics.crank_jacobian; });
    const Lanes beta = stiffness > 0.0 || needs_stroke_angle(v.wings) ? stroke_angle(k) : Lanes(0.0);
    const Lanes twisted = beta - Lanes(v.spring.rest_angle);
    scatter(stiffness > 0.0 ? Lanes(stiffness) * twisted : Lanes(0.0),
            [](auto& c) -> double& { return c.spring_moment; });
    if (needs_stroke_angle(v.wings)) scatter(beta, [](auto& c) -> double& { return c.stroke_angle; });
  }
}

#endif

}  // namespace

void configurations_at(const Vehicle<double>& v, std::span<const double> theta,
                       std::span<Configuration<double>> configurations) {
#ifdef WINGBEAT_BASE_LANES
  if (v.transmission.type == TransmissionType::slider_crank) return on_lanes(v, theta, configurations);
#endif
  one_by_one(v, theta, configurations);
}

}  // namespace wingbeat
