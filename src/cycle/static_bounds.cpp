#include "cycle/static_bounds.hpp"

#include <algorithm>
#include <array>

#include "wingbeat/core/members.hpp"

namespace wingbeat::detail {

KinematicBounds kinematic_bounds(const SliderCrank<double>& c, double from, double to) {
  const CircleArc arc = circle_arc(from, to);
  const CrankKinematics<Enclosure> k = crank_kinematics(cast<Enclosure>(c), arc.sine, arc.cosine);
  // Where the levers conserve power, their ratio is the slope.
  const Enclosure ratio =
      c.formulation == Formulation::virtual_work ? k.stroke_slope : k.crank_jacobian * inverse_of(k.wing_jacobian);
  return {atan(k.tan_stroke), k.stroke_slope, k.wing_jacobian, ratio};
}

/// With the diagonal s from the rocker's axis to the crank pin, phi is the angle of the diagonal less that of the
/// triangle of s, rocker and coupler at the rocker's axis. All follow from s, and hardly grow beyond their own range.
KinematicBounds kinematic_bounds(const FourBar<double>& f, double from, double to) {
  const CircleArc arc = circle_arc(from, to);
  const Enclosure r(f.crank_radius), l(f.coupler_length), p(f.rocker_length), d(f.ground_length), n_s(f.stroke_ratio);
  const Enclosure two(2.0), one(1.0);
  const Enclosure s2 = square(r) + square(d) - two * r * d * arc.cosine, s = sqrt(s2);
  const Enclosure ahead = d - r * arc.cosine;
  const Enclosure to_pin = Enclosure(pi) - atan(r * arc.sine / ahead);
  const Enclosure at_axis = two * atan(sqrt((l - s + p) * (l + s - p) / ((s + p - l) * (s + p + l))));
  const Enclosure cos_mu = (square(p) + square(l) - s2) / (two * p * l);
  const Enclosure sin_mu = sqrt(one - square(cos_mu));

  KinematicBounds k;
  k.stroke_angle = n_s * (to_pin - at_axis - Enclosure(f.ground_angle));
  k.stroke_slope = n_s * r / s2 * (r - d * arc.cosine + d * arc.sine * (l / p - cos_mu) / sin_mu);
  k.wing_jacobian = p * sin_mu / n_s;
  k.lever_ratio = k.stroke_slope;
  return k;
}

namespace {

/// A polynomial's coefficients about another origin.
std::array<double, 6> moved(std::array<double, 6> c, double origin) {
  for (std::size_t n = 0; n + 1 < c.size(); ++n) {
    for (std::size_t k = c.size() - 1; k-- > n;) c[k] += origin * c[k + 1];
  }
  return c;
}

template <std::size_t degree>
Interval range_of(const std::array<double, degree>& c, double half_width) {
  const Interval x(-half_width, half_width);
  Interval value(c[degree - 1]);
  for (std::size_t n = degree - 1; n-- > 0;) value = value * x + Interval(c[n]);
  return value;
}

}  // namespace

KinematicBounds kinematic_bounds(const StrokeTable<double>& t, double from, double to) {
  const StrokeCurve& curve = *t.curve;
  KinematicBounds k;
  bool first = true;
  double here = curve.position(from), left = to - from;
  while (first || left > 0.0) {
    const StrokeCurve::Piece& piece = curve.piece(here);
    const double end = curve.end_of(piece), width = std::min(left, std::max(end - here, 0.0));
    const std::array<double, 6> c = moved(piece.coefficient, here + 0.5 * width - piece.x0);
    const std::array<double, 5> slope{c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 5.0 * c[5]};
    const std::array<double, 4> bend{2.0 * c[2], 6.0 * c[3], 12.0 * c[4], 20.0 * c[5]};
    const Interval angle = range_of(c, 0.5 * width), rise = range_of(slope, 0.5 * width);
    const Interval curvature = range_of(bend, 0.5 * width);
    const Enclosure beta(angle, rise), B1(rise, curvature);
    if (first) {
      k.stroke_angle = beta;
      k.stroke_slope = B1;
    } else {
      k.stroke_angle = {hull(k.stroke_angle.value, beta.value), hull(k.stroke_angle.slope, beta.slope)};
      k.stroke_slope = {hull(k.stroke_slope.value, B1.value), hull(k.stroke_slope.slope, B1.slope)};
    }
    first = false;
    left -= width;
    here = end < two_pi ? end : 0.0;
  }
  const Enclosure scale(t.scale);
  k.stroke_angle = scale * k.stroke_angle;
  k.stroke_slope = scale * k.stroke_slope;
  k.wing_jacobian = Enclosure(t.reference_radius);
  k.lever_ratio = k.stroke_slope;
  return k;
}

KinematicBounds StaticBounds::kinematics(double from, double to) const {
  return visit(v_.transmission, [&](const auto& of_type) { return kinematic_bounds(of_type, from, to); });
}

StaticBounds::Torques StaticBounds::torques(double from, double to) const {
  const KinematicBounds k = kinematics(from, to);
  const Enclosure moment = Enclosure(v_.wing_count * v_.spring.stiffness) * k.stroke_angle;
  Torques t{moment * k.lever_ratio + Enclosure(v_.load_torque), Enclosure(v_.friction.torque)};
  if (v_.friction.radius > 0.0) {
    t.friction = t.friction + Enclosure(v_.friction.radius) * abs(moment * inverse_of(k.wing_jacobian));
  }
  return t;
}

/// torque_before_gear(): of an efficiency of at most 1 the larger of both.
Enclosure StaticBounds::before_gear(const Enclosure& load) const {
  if (!has_gear_loss(v_.motor)) return load;
  const Enclosure efficiency(v_.motor.gear_efficiency);
  return max(load * inverse_of(efficiency), load * efficiency);
}

Enclosure StaticBounds::high(double from, double to) const {
  const Torques t = torques(from, to);
  return before_gear(t.load + t.friction) + Enclosure(v_.motor.friction_torque);
}

Enclosure StaticBounds::low(double from, double to) const {
  const Torques t = torques(from, to);
  return -before_gear(t.friction - t.load) - Enclosure(v_.motor.friction_torque);
}

Enclosure StaticBounds::min_inertia(const KinematicBounds& k) const {
  const double J = has_gear_loss(v_.motor) ? v_.motor.gear_efficiency * v_.motor.inertia : v_.motor.inertia;
  const Enclosure wings(v_.wing_count * v_.wing_inertia + v_.wings.added_inertia);
  const bool conserves = !(v_.transmission.type == TransmissionType::slider_crank &&
                           v_.transmission.slider_crank.formulation == Formulation::rod_force);
  Enclosure least = Enclosure(J) + wings * (conserves ? square(k.stroke_slope) : k.stroke_slope * k.lever_ratio);
  if (v_.friction.radius > 0.0) {
    least = least - wings * Enclosure(v_.friction.radius) * abs(k.stroke_slope * inverse_of(k.wing_jacobian));
  }
  return least;
}

Enclosure StaticBounds::min_inertia(double from, double to) const { return min_inertia(kinematics(from, to)); }

Enclosure StaticBounds::uniqueness(double from, double to) const {
  const KinematicBounds k = kinematics(from, to);
  const Enclosure lever = k.wing_jacobian * Enclosure(1.0 / typical_lever(v_.transmission));
  if (!(lever.value.low > 0.0)) return {{-infinity, lever.value.high}, {-infinity, infinity}};
  return min(lever, min_inertia(k) * Enclosure(1.0 / v_.motor.inertia));
}

}  // namespace wingbeat::detail
