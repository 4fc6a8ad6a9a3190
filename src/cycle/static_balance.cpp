#include "wingbeat/cycle/static_balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "wingbeat/core/minimise.hpp"
#include "wingbeat/core/root.hpp"

namespace wingbeat {
namespace {

constexpr int angle_count = 48;

struct UnitCircle {
  std::array<double, angle_count> angle, sine, cosine;
};

const UnitCircle& unit_circle() {
  static const UnitCircle circle = [] {
    UnitCircle c;
    for (std::size_t n = 0; n < angle_count; ++n) {
      c.angle[n] = two_pi * double(n) / angle_count;
      c.sine[n] = std::sin(c.angle[n]);
      c.cosine[n] = std::cos(c.angle[n]);
    }
    return c;
  }();
  return circle;
}

CrankKinematics<double> kinematics_at(const Vehicle<double>& v, double theta) {
  return crank_kinematics(v.transmission, std::sin(theta), std::cos(theta));
}

/// Least value over the circle from samples, refined around the least sample where `refine` says it matters.
template <class F>
std::pair<double, double> min_on_circle(const F& f, const std::array<double, angle_count>& samples, double refine) {
  const std::size_t n = std::size_t(std::min_element(samples.begin(), samples.end()) - samples.begin());
  const double angle = unit_circle().angle[n];
  if (samples[n] > refine) return {angle, samples[n]};
  const double step = two_pi / angle_count;
  const Minimum refined = minimise(f, angle - step, angle + step, 1e-9);
  return refined.value < samples[n] ? std::pair{wrap_angle(refined.at), refined.value} : std::pair{angle, samples[n]};
}

}  // namespace

double advance_torque(const Vehicle<double>& v, double crank_angle) {
  const CrankKinematics<double> k = kinematics_at(v, crank_angle);
  return advance_torque(v, k, spring_moment(v, k), stall_torque(v));
}

double lock_margin(const Vehicle<double>& v, double crank_angle) {
  const CrankKinematics<double> k = kinematics_at(v, crank_angle);
  return lock_margin(v, k, spring_moment(v, k), stall_torque(v));
}

StaticBalance static_balance(const Vehicle<double>& v) {
  StaticBalance s{};
  s.stall_torque = stall_torque(v);
  s.breakaway_torque = breakaway_torque(v);
  s.has_wings = v.wing_inertia > 0.0;
  s.inertia_min = v.motor.inertia;
  s.lever_min = typical_lever(v.transmission);
  s.advance_min = s.stall_torque - s.breakaway_torque;
  if (!s.has_wings) return s;

  const UnitCircle& circle = unit_circle();
  const bool springs = v.spring.stiffness > 0.0;
  std::array<double, angle_count> inertia, lever, advance;
  for (std::size_t n = 0; n < angle_count; ++n) {
    const CrankKinematics<double> k = crank_kinematics(v.transmission, circle.sine[n], circle.cosine[n]);
    inertia[n] = min_inertia(v, k);
    lever[n] = k.wing_lever;
    if (springs) advance[n] = advance_torque(v, k, spring_moment(v, k), s.stall_torque);
  }
  std::tie(s.inertia_angle, s.inertia_min) = min_on_circle(
      [&](double angle) { return min_inertia(v, kinematics_at(v, angle)); }, inertia, 0.3 * v.motor.inertia);
  std::tie(s.lever_angle, s.lever_min) = min_on_circle([&](double angle) { return kinematics_at(v, angle).wing_lever; },
                                                       lever, 0.1 * typical_lever(v.transmission));
  if (springs) {
    std::tie(s.advance_angle, s.advance_min) =
        min_on_circle([&](double angle) { return advance_torque(v, angle); }, advance, 0.2 * s.stall_torque);
  }
  return s;
}

std::vector<LockInterval> lock_intervals(const Vehicle<double>& v) {
  constexpr int samples = 1440;
  const auto margin = [&](double angle) { return lock_margin(v, angle); };
  std::vector<LockInterval> found;
  // Start where the crank does not lock, so that no interval is cut in two.
  int start = 0;
  while (start < samples && margin(two_pi * start / samples) >= 0.0) ++start;
  if (start == samples) return {{0.0, two_pi, 0.0, margin(0.0)}};

  double before = two_pi * start / samples, margin_before = margin(before);
  LockInterval open{};
  bool is_open = false;
  for (int n = start + 1; n <= start + samples; ++n) {
    const double angle = two_pi * n / samples, at = margin(angle);
    if (!is_open && at < 0.0 && margin_before < 0.0) {
      // Thin intervals, down to the single angles that a spring alone leaves, show as a change of the net torque's
      // sign.
      const auto net = [&](double x) { return advance_torque(v, x); };
      if ((net(before) > 0.0) != (net(angle) > 0.0)) {
        const double edge = sign_change(net, before, angle);
        if (margin(edge) > -1e-9 * stall_torque(v)) {
          found.push_back({edge, edge, wrap_angle(edge), std::max(0.0, margin(edge))});
        }
      }
    } else if (!is_open && at >= 0.0) {
      open = {sign_change(margin, before, angle), angle, angle, at};
      is_open = true;
    } else if (is_open && at >= 0.0) {
      if (at > open.margin) open.angle = angle, open.margin = at;
    } else if (is_open) {
      open.to = sign_change(margin, before, angle);
      if (open.from >= two_pi) open.from -= two_pi, open.to -= two_pi;
      open.angle = wrap_angle(open.angle);
      found.push_back(open);
      is_open = false;
    }
    before = angle;
    margin_before = at;
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
  return found;
}

namespace {

/// Evenly spaced crank angles, the first of them zero; none without wings.
std::vector<LoadPlace<double>> load_places(const Vehicle<double>& v) {
  std::vector<LoadPlace<double>> places;
  if (!(v.wing_inertia > 0.0)) return places;
  const UnitCircle& circle = unit_circle();
  constexpr std::size_t stride = 4;
  places.reserve(angle_count / stride);
  for (std::size_t n = 0; n < angle_count; n += stride) {
    const Configuration<double> at = configuration_at(v, circle.sine[n], circle.cosine[n]);
    places.push_back(load_place(v, at.kinematics, at.spring_moment));
  }
  return places;
}

}  // namespace

BalancedSpeed<double> balanced_speed(const Vehicle<double>& v) {
  const std::vector<LoadPlace<double>> places = load_places(v);
  return balanced_speed(v, places);
}

OrbitGuess<double> guess_orbit(const Vehicle<double>& v) {
  return guess_orbit(v, load_places(v),
                     [&](double angle) { return configuration_at(v, -std::sin(angle), std::cos(angle)); });
}

}  // namespace wingbeat
