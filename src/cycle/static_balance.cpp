#include "wingbeat/cycle/static_balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cycle/static_bounds.hpp"
#include "wingbeat/core/certain.hpp"
#include "wingbeat/vehicle/motion.hpp"

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

Minimum least_of(const std::array<double, angle_count>& samples) {
  const std::size_t n = std::size_t(std::min_element(samples.begin(), samples.end()) - samples.begin());
  return {unit_circle().angle[n], samples[n]};
}

/// What levers reach over a turn, from the links alone.
struct LeverReach {
  double wing_lever_min;  ///< g [m]
  double crank_jacobian;  ///< |h| [m]
  double ratio_min;       ///< h / B1 [m]
};

LeverReach lever_reach(const SliderCrank<double>& c) {
  const double sine = c.crank_radius / c.rod_length, cosine = std::sqrt(1.0 - square(sine));
  const double along = c.hinge_offset * cosine;
  const double height = std::abs(c.rod_length - c.mid_stroke_height) + c.crank_radius;
  return {c.formulation == Formulation::virtual_work ? along : along - sine * height, c.crank_radius, along};
}

LeverReach lever_reach(const FourBar<double>& f) {
  const auto lever = [&](double diagonal) {
    const double cosine = (square(f.rocker_length) + square(f.coupler_length) - square(diagonal)) /
                          (2.0 * f.rocker_length * f.coupler_length);
    return f.rocker_length * std::sqrt(1.0 - square(cosine)) / f.stroke_ratio;
  };
  const double least = std::min(lever(f.ground_length - f.crank_radius), lever(f.ground_length + f.crank_radius));
  return {least, f.crank_radius, least};
}

LeverReach lever_reach(const StrokeTable<double>& t) { return {t.reference_radius, infinity, t.reference_radius}; }

/// Of any other transmission, which conserves power, from bounds over parts of a turn.
template <class Other>
LeverReach lever_reach(const Other& t) {
  double least = infinity, largest = 0.0;
  for (int n = 0; n < angle_count; ++n) {
    const double width = two_pi / angle_count;
    const detail::KinematicBounds k = detail::kinematic_bounds(t, n * width, (n + 1) * width);
    const Interval h = (k.wing_jacobian * k.lever_ratio).value;
    least = std::min(least, k.wing_jacobian.value.low);
    largest = std::max({largest, -h.low, h.high});
  }
  return {least, largest, least};
}

LeverReach lever_reach(const AnyTransmission<double>& t) {
  return visit(t, [](const auto& of_type) { return lever_reach(of_type); });
}

// Least values that are further from where they matter are not sought exactly.
constexpr double far_inertia = 0.3, far_lever = 0.1, far_torque = 0.2;
constexpr double accuracy = 1e-13;  // of those that are, relative

/// No lever or inertia that is near zero, certainly.
bool is_certainly_unique(const Vehicle<double>& v, const LeverReach& reach) {
  if (!(reach.wing_lever_min > far_lever * typical_lever(v.transmission))) return false;
  const double J = has_gear_loss(v.motor) ? v.motor.gear_efficiency * v.motor.inertia : v.motor.inertia;
  const double wings = v.wing_count * v.wing_inertia + v.wings.added_inertia;
  // With A (h + s mu r_e) = N J_w (r B1^2 +- mu r_e B1) / g, r = h / B1, at the least favourable B1.
  return J - wings * square(v.friction.radius) / (4.0 * reach.ratio_min * reach.wing_lever_min) >
         far_inertia * v.motor.inertia;
}

/// No advance torque that is near zero, certainly.
bool is_certain_to_advance(const Vehicle<double>& v, const LeverReach& reach, double stall) {
  if (!(reach.wing_lever_min > 0.0)) return false;
  const double force = v.wing_count * v.spring.stiffness * stroke_reach(v.transmission) / reach.wing_lever_min;
  const double load = force * (reach.crank_jacobian + v.friction.radius) + std::abs(v.load_torque) + v.friction.torque;
  return stall - torque_before_gear(v.motor, load) - v.motor.friction_torque > far_torque * stall;
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
    lever[n] = k.wing_jacobian;
    if (springs) advance[n] = advance_torque(v, k, spring_moment(v, k), s.stall_torque);
  }
  Minimum least_inertia = least_of(inertia), least_lever = least_of(lever);
  const detail::StaticBounds bounds(v);
  const LeverReach reach = lever_reach(v.transmission);
  if (!is_certainly_unique(v, reach)) {
    const double J = v.motor.inertia, typical = typical_lever(v.transmission);
    least_lever = least_value([&](double angle) { return kinematics_at(v, angle).wing_jacobian; },
                              [&](double from, double to) { return bounds.wing_jacobian(from, to); }, 0.0, two_pi,
                              far_lever * typical, accuracy * typical, least_lever);
    // Beyond a pole of F the inertia says nothing.
    if (least_lever.value > 0.0) {
      least_inertia = least_value([&](double angle) { return min_inertia(v, kinematics_at(v, angle)); },
                                  [&](double from, double to) { return bounds.min_inertia(from, to); }, 0.0, two_pi,
                                  far_inertia * J, accuracy * J, least_inertia);
    }
  }
  s.inertia_angle = wrap_angle(least_inertia.argument), s.inertia_min = least_inertia.value;
  s.lever_angle = wrap_angle(least_lever.argument), s.lever_min = least_lever.value;
  if (springs) {
    Minimum least = least_of(advance);
    if (!is_certain_to_advance(v, reach, s.stall_torque)) {
      const Enclosure stall(s.stall_torque);
      least = least_value([&](double angle) { return advance_torque(v, angle); },
                          [&](double from, double to) { return stall - bounds.high(from, to); }, 0.0, two_pi,
                          far_torque * s.stall_torque, accuracy * s.stall_torque, least);
    }
    s.advance_angle = wrap_angle(least.argument), s.advance_min = least.value;
  }
  return s;
}

namespace {

/// The interval between two cuts in which the crank locks.
LockInterval lock_between(const Vehicle<double>& v, double from, double to) {
  constexpr int samples = 16;
  LockInterval lock{from, to, from, -infinity};
  const auto note = [&](double angle, double margin) {
    if (margin > lock.margin) lock.angle = angle, lock.margin = margin;
  };
  for (int n = 0; n <= samples; ++n) {
    const double angle = from + (to - from) * n / samples;
    note(angle, lock_margin(v, angle));
  }
  const double step = (to - from) / samples;
  if (step > 1e-9) {
    const Minimum best = minimise([&](double angle) { return -lock_margin(v, angle); },
                                  std::max(from, lock.angle - step), std::min(to, lock.angle + step), 1e-9);
    note(best.argument, -best.value);
  }
  if (lock.from >= two_pi) lock.from -= two_pi, lock.to -= two_pi;
  lock.angle = wrap_angle(lock.angle);
  return lock;
}

}  // namespace

std::vector<LockInterval> lock_intervals(const Vehicle<double>& v) {
  const double stall = stall_torque(v);
  const auto torques = [&](double angle) {
    const CrankKinematics<double> k = kinematics_at(v, angle);
    return standing_torques(v, k, static_rod_force(k, spring_moment(v, k)));
  };
  const detail::StaticBounds bounds(v);
  const Enclosure motor(stall);
  // The crank stands where the motor's torque lies between the standing torques.
  std::vector<double> cuts =
      sign_cuts([&](double angle) { return stall - torques(angle).high; },
                [&](double from, double to) { return motor - bounds.high(from, to); }, 0.0, two_pi);
  const std::vector<double> lower =
      sign_cuts([&](double angle) { return stall - torques(angle).low; },
                [&](double from, double to) { return motor - bounds.low(from, to); }, 0.0, two_pi);
  cuts.insert(cuts.end(), lower.begin(), lower.end());
  std::sort(cuts.begin(), cuts.end());
  if (cuts.empty()) {
    if (lock_margin(v, 0.0) < 0.0) return {};
    return {{0.0, two_pi, 0.0, lock_margin(v, 0.0)}};
  }
  const std::size_t count = cuts.size();
  const auto cut = [&](std::size_t n) { return n < count ? cuts[n] : cuts[n - count] + two_pi; };
  constexpr double same = 1e-14;  // cuts of a crank without friction, which are two each
  const auto locks_behind = [&](std::size_t n) {
    const double width = cut(n + 1) - cut(n);
    return width > same && lock_margin(v, cut(n) + 0.5 * width) >= 0.0;
  };
  std::size_t start = 0;
  while (start < count && locks_behind(start + count - 1)) ++start;
  if (start == count) return {{0.0, two_pi, 0.0, lock_margin(v, 0.0)}};
  std::vector<LockInterval> found;
  for (std::size_t n = start; n < start + count; ++n) {
    const double from = cut(n);
    if (locks_behind(n)) {
      while (n + 1 < start + count && locks_behind(n + 1)) ++n;
      found.push_back(lock_between(v, from, cut(n + 1)));
    } else if (n == start || !locks_behind(n - 1)) {
      // A single angle that a spring alone leaves, or that friction just reaches.
      const double margin = lock_margin(v, from), angle = wrap_angle(from);
      const bool known = !found.empty() && std::abs(found.back().from - angle) <= same;
      if (margin > -1e-9 * stall && !known) found.push_back({angle, angle, angle, std::max(0.0, margin)});
    }
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
  return found;
}

bool certainly_unique(const Vehicle<double>& v) { return is_certainly_unique(v, lever_reach(v.transmission)); }

bool certainly_advances(const Vehicle<double>& v) {
  return !(v.spring.stiffness > 0.0) || is_certain_to_advance(v, lever_reach(v.transmission), stall_torque(v));
}

double uniqueness(const Vehicle<double>& v, double crank_angle) {
  const CrankKinematics<double> k = kinematics_at(v, crank_angle);
  const double lever = k.wing_jacobian / typical_lever(v.transmission);
  if (!(lever > 0.0)) return lever;
  return std::min(lever, min_inertia(v, k) / v.motor.inertia);
}

JamAngles nearest_jams(const Vehicle<double>& v, double from, double margin) {
  const auto spare = [&](double angle) { return uniqueness(v, angle) - margin; };
  if (spare(from) <= 0.0) return {from, from};
  JamAngles jams{-infinity, infinity};
  if (margin < 0.5 * far_lever && is_certainly_unique(v, lever_reach(v.transmission))) return jams;
  const detail::StaticBounds bounds(v);
  const Enclosure least(margin);
  std::vector<double> cuts =
      sign_cuts(spare, [&](double a, double b) { return bounds.uniqueness(a, b) - least; }, from, from + two_pi);
  // Each begins or ends what cannot be passed, or touches it, but for those that only come near.
  std::erase_if(cuts, [&](double angle) {
    constexpr double beside = 1e-7;
    return spare(angle) > 0.0 && spare(angle - beside) > 0.0 && spare(angle + beside) > 0.0;
  });
  if (cuts.empty()) return jams;
  return {cuts.back() - two_pi, cuts.front()};
}

namespace {

/// Evenly spaced crank angles, the first of them zero; none without wings. Wings that pitch far have a drag that varies
/// more over the cycle, and the balances of its mean are fewer on few places.
std::vector<LoadPlace<double>> load_places(const Vehicle<double>& v) {
  std::vector<LoadPlace<double>> places;
  if (!(v.wing_inertia > 0.0)) return places;
  const UnitCircle& circle = unit_circle();
  const double pitch = v.wings.pitch_coefficient * typical_stroke_slope(v.transmission) * no_load_speed(v);
  const std::size_t stride = pitch > far_pitch ? 1 : 4;
  places.reserve(angle_count / stride);
  for (std::size_t n = 0; n < angle_count; n += stride) {
    const Configuration<double> configuration = configuration_at(v, circle.sine[n], circle.cosine[n]);
    places.push_back(load_place(v, configuration.kinematics, configuration.spring_moment));
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
