#include "wingbeat/study/synthesis.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <nlopt.hpp>

#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/any_transmission.hpp"
#include "wingbeat/parts/transmission_angle.hpp"

namespace wingbeat {
namespace {

/// A four-bar by the ends of its rocker's swing; lengths over that of the ground link.
struct DeadCentres {
  double p, phi, swing;

  double distance(double angle) const { return std::sqrt(1.0 + square(p) + 2.0 * p * std::cos(angle)); }
  double direction(double angle) const { return std::atan2(p * std::sin(angle), 1.0 + p * std::cos(angle)); }
  double crank() const { return 0.5 * (distance(phi) - distance(phi + swing)); }
  double coupler() const { return 0.5 * (distance(phi) + distance(phi + swing)); }
  FourBar<double> links() const { return {crank(), coupler(), p, 1.0}; }
  /// Crank angle of one half-stroke beyond 180 deg.
  double quick_return() const { return direction(phi + swing) - direction(phi); }
};

double swept_chord(double swing) { return swing < pi ? 2.0 * std::sin(0.5 * swing) : 2.0; }

/// Longest distance between points that pins and axes reach.
double envelope_of(double r, double l, double p, double d, double swing) {
  return std::max({l + 2.0 * r, d + r, p, p * swept_chord(swing)});
}

TransmissionDesign<double> four_bar_of(const DeadCentres& c, const StrokeTarget& t) {
  const double size = t.envelope / envelope_of(c.crank(), c.coupler(), c.p, 1.0, c.swing);
  TransmissionDesign<double> design;
  design.type = TransmissionType::four_bar;
  design.crank_radius = size * c.crank();
  design.coupler_length = size * c.coupler();
  design.rocker_length = size * c.p;
  design.ground_length = size;
  design.stroke_ratio = t.stroke_ratio;
  return design;
}

/// min t, t >= both cosines, the crank not too short, the half-strokes alike as far as wanted. u = (log p, phi, t).
struct FourBarProblem {
  double swing, shortest, quick_return;
  static constexpr unsigned size = 3;
  static constexpr unsigned constraints = 6;

  DeadCentres centres(const double* u) const { return {std::exp(u[0]), u[1], swing}; }

  std::array<double, constraints> excess(const double* u) const {
    const DeadCentres c = centres(u);
    const double r = c.crank(), l = c.coupler();
    const TransmissionCosines cosines = transmission_cosines(c.links());
    const double shortest_here = shortest * envelope_of(r, l, c.p, 1.0, swing);
    return {cosines.least - u[2],       -cosines.largest - u[2],         shortest_here - r,
            std::max(r - c.p, r - 1.0), c.quick_return() - quick_return, -c.quick_return() - quick_return};
  }
  bool keeps(const double* u) const {
    const auto e = excess(u);
    return std::all_of(e.begin() + 2, e.end(), [](double x) { return x <= 1e-9; });
  }
  double cosine(const double* u) const { return transmission_cosines(centres(u).links()).worst(); }
};

double worst_cosine(unsigned, const double* u, double*, void*) { return u[2]; }
void four_bar_excess(unsigned m, double* result, unsigned, const double* u, double*, void* data) {
  const auto excess = static_cast<const FourBarProblem*>(data)->excess(u);
  std::copy_n(excess.begin(), m, result);
}

using FourBarPoint = std::array<double, FourBarProblem::size>;

/// The best with half-strokes alike, r_c^2 + d^2 = l^2 + p^2: of these the transmission angle grows with the ground
/// link, down to the shortest crank. False where even the most compact one has a crank too short.
bool centric(const FourBarProblem& problem, FourBarPoint& best) {
  const double r = std::sin(0.5 * problem.swing);
  const auto excess = [&](double log_d) {
    const double d = std::exp(log_d), l = std::sqrt(square(d) + square(r) - 1.0);
    return problem.shortest * envelope_of(r, l, 1.0, d, problem.swing) - r;
  };
  // l > r_c from d = 1 on.
  double low = 1e-9, high = std::log(1e4);
  if (problem.swing >= pi || excess(low) > 0.0) return false;
  if (excess(high) > 0.0) {
    std::uintmax_t rounds = 200;
    low = boost::math::tools::toms748_solve(excess, low, high, boost::math::tools::eps_tolerance<double>(50), rounds)
              .first;
  } else {
    low = high;
  }
  const double d = std::exp(low), l = std::sqrt(square(d) + square(r) - 1.0);
  const double reach = l + r;
  best = {-low, std::acos(std::clamp((square(reach) - square(d) - 1.0) / (2.0 * d), -1.0, 1.0)), 0.0};
  best[2] = problem.cosine(best.data());
  return true;
}

/// From the best points of a grid.
bool search(const FourBarProblem& problem, FourBarPoint& best) {
  bool found = centric(problem, best);
  if (problem.quick_return == 0.0) return found;
  const double lowest = std::log(0.02), highest = std::log(10.0), last = pi - problem.swing;
  if (!(last > 0.0)) return found;
  std::vector<FourBarPoint> starts;
  if (found) starts.push_back(best);
  constexpr int grid = 80;
  for (int a = 0; a <= grid; ++a) {
    for (int b = 1; b < grid; ++b) {
      FourBarPoint u{lowest + (highest - lowest) * a / grid, last * b / grid, 0.0};
      u[2] = problem.cosine(u.data());
      if (std::isfinite(u[2]) && problem.keeps(u.data())) starts.push_back(u);
    }
  }
  const std::size_t kept = std::min<std::size_t>(starts.size(), 5);
  std::partial_sort(starts.begin(), starts.begin() + std::ptrdiff_t(kept), starts.end(),
                    [](const FourBarPoint& a, const FourBarPoint& b) { return a[2] < b[2]; });
  for (std::size_t n = 0; n < kept; ++n) {
    nlopt::opt solver(nlopt::LN_COBYLA, FourBarProblem::size);
    solver.set_lower_bounds({lowest, 1e-6, -1.0});
    solver.set_upper_bounds({highest, last - 1e-6, 10.0});
    solver.set_min_objective(&worst_cosine, nullptr);
    FourBarProblem asked = problem;
    solver.add_inequality_mconstraint(&four_bar_excess, &asked,
                                      std::vector<double>(FourBarProblem::constraints, 1e-10));
    solver.set_xtol_abs(1e-10);
    solver.set_maxeval(4000);
    solver.set_initial_step(0.02);
    std::vector<double> u(starts[n].begin(), starts[n].end());
    for (std::size_t k = 0; k < 2; ++k) {
      u[k] = std::clamp(u[k], solver.get_lower_bounds()[k], solver.get_upper_bounds()[k]);
    }
    double value = 0.0;
    try {
      solver.optimize(u, value);
    } catch (const std::exception&) {
      // Rounding ended it: what was reached counts.
    }
    FourBarPoint end{u[0], u[1], problem.cosine(u.data())};
    const FourBarPoint& better = problem.keeps(end.data()) && end[2] < starts[n][2] ? end : starts[n];
    if (!found || better[2] < best[2]) best = better;
    found = true;
  }
  return found;
}

StrokeTarget checked(StrokeTarget t) {
  require(t.stroke > 0.0 && t.stroke <= two_pi, "stroke", "must be > 0, <= 360", "deg", degrees_per_radian * t.stroke);
  require(t.envelope > 0.0, "envelope", "must be > 0", "m", t.envelope);
  if (t.shortest == 0.0) t.shortest = 0.1 * t.envelope;
  require(t.shortest > 0.0 && t.shortest < t.envelope, "shortest", "must be > 0, < envelope", "m", t.shortest);
  require(t.stroke_ratio > 0.0 && std::isfinite(t.stroke_ratio), "stroke_ratio", "must be > 0", "1", t.stroke_ratio);
  require(t.time_ratio >= 1.0 && t.time_ratio <= 10.0, "time_ratio", "must be 1 to 10", "1", t.time_ratio);
  require(t.transmission_angle >= 0.0 && t.transmission_angle < 0.5 * pi, "transmission_angle", "must be >= 0, < 90",
          "deg", degrees_per_radian * t.transmission_angle);
  return t;
}

/// The largest transmission angle of a four-bar for the target; absent where none turns.
double best_angle(const StrokeTarget& t, DeadCentres* centres = nullptr) {
  const double swing = t.stroke / t.stroke_ratio;
  if (!(swing < pi)) return absent;
  const double quick_return = pi * (t.time_ratio - 1.0) / (t.time_ratio + 1.0);
  const FourBarProblem problem{swing, t.shortest / t.envelope, quick_return};
  FourBarPoint best{};
  if (!search(problem, best) || !(best[2] < 1.0)) return absent;
  if (centres) *centres = problem.centres(best.data());
  return std::acos(best[2]);
}

/// The least stroke ratio above `from` with a transmission angle wanted.
double ratio_needed(StrokeTarget t) {
  const auto missing = [&](double ratio) {
    t.stroke_ratio = ratio;
    const double angle = best_angle(t);
    return std::isnan(angle) ? 1.0 : t.transmission_angle - angle;
  };
  double below = t.stroke_ratio, above = below;
  while (missing(above) > 0.0) {
    below = above;
    above *= 1.2;
    // So short a swing takes a crank too short.
    if (above > 50.0 * t.stroke / pi) return absent;
  }
  while (above - below > 1e-3 * above) {
    const double middle = 0.5 * (above + below);
    (missing(middle) > 0.0 ? below : above) = middle;
  }
  return above;
}

FourBar<double> four_bar_from(const TransmissionDesign<double>& design) {
  const FourBar<double> f = FourBar<double>::from(design);
  validate(f);
  return f;
}

/// Stroke angle and B1 at a crank angle.
struct StrokeThere {
  double angle, slope;
};
template <class T>
StrokeThere stroke_there(const T& t, double theta) {
  const CrankKinematics<double> k = crank_kinematics(t, std::sin(theta), std::cos(theta));
  return {stroke_angle(k), k.stroke_slope};
}

/// Crank angles [rad] at which the half-strokes begin, the first of them again at the end.
template <class T>
std::array<double, 3> half_strokes(const T& t) {
  const Reversals r = reversals(t);
  return {r.angle[0], r.angle[1], r.angle[0] + two_pi};
}

/// Crank angles [rad] at which both half-strokes are at the middle of the stroke.
template <class T>
std::array<double, 2> mid_stroke_angles(const T& t) {
  const std::array<double, 3> ends = half_strokes(t);
  const double first = stroke_there(t, ends[0]).angle, last = stroke_there(t, ends[1]).angle;
  std::array<double, 2> found{};
  for (std::size_t half = 0; half < 2; ++half) {
    std::uintmax_t rounds = 100;
    const auto beyond = [&](double theta) { return stroke_there(t, theta).angle - 0.5 * (first + last); };
    found[half] = boost::math::tools::toms748_solve(beyond, ends[half], ends[half + 1],
                                                    boost::math::tools::eps_tolerance<double>(50), rounds)
                      .first;
  }
  return found;
}

template <class T>
void measure_half_strokes(const T& t, MechanismQuality& q) {
  const std::array<double, 3> ends = half_strokes(t);
  constexpr int steps = 2000;
  for (std::size_t half = 0; half < 2; ++half) {
    const double from = ends[half], length = ends[half + 1] - from;
    double largest = 0.0;
    for (int n = 1; n < steps; ++n) {
      largest = std::max(largest, std::abs(stroke_there(t, from + length * n / steps).slope));
    }
    const bool up = stroke_there(t, from + 0.5 * length).slope > 0.0;
    (up ? q.slope_up : q.slope_down) = largest;
  }
  const double one = ends[1] - ends[0], other = two_pi - one;
  q.time_ratio = std::max(one, other) / std::min(one, other);
}

/// What play does at a crank angle: `shifted(theta, side)` is the stroke angle with all of it taken up to one side.
template <class T, class Shifted>
void measure_play(const T& t, const Shifted& shifted, ClearanceCost& cost) {
  const auto play_there = [&](double theta) { return std::abs(shifted(theta, 1.0) - shifted(theta, -1.0)); };
  constexpr int steps = 3600;
  for (int n = 0; n < steps; ++n) cost.play_highest = std::max(cost.play_highest, play_there(two_pi * n / steps));
  for (const double theta : mid_stroke_angles(t)) {
    const double play = play_there(theta);
    cost.play = std::max(cost.play, play);
    cost.phase = std::max(cost.phase, play / std::abs(stroke_there(t, theta).slope));
  }
}

[[noreturn]] void refuse_type() {
  throw ParameterError("transmission.type", "must be slider-crank or four-bar: others have no links");
}

/// Wing angle of a slider-crank whose rod and slider have play; sides as in tan(beta) = (y - y_0) / H.
double slider_crank_stroke(const SliderCrank<double>& c, double theta, double rod, double shift) {
  const double x = c.crank_radius * std::cos(theta);
  const double y = c.crank_radius * std::sin(theta) + std::sqrt(square(rod) - square(x)) + shift;
  return std::atan((y - c.mid_stroke_height) / c.hinge_offset);
}

}  // namespace

MechanismQuality mechanism_quality(const TransmissionDesign<double>& design) {
  MechanismQuality q{};
  if (design.type == TransmissionType::four_bar) {
    const FourBar<double> f = four_bar_from(design);
    const double r = f.crank_radius, l = f.coupler_length, p = f.rocker_length, d = f.ground_length;
    q.transmission_angle = std::acos(transmission_cosines(f).worst());
    q.stroke = 2.0 * stroke_amplitude(f);
    q.envelope = envelope_of(r, l, p, d, q.stroke / f.stroke_ratio);
    q.shortest = std::min({r, l, p, d});
    measure_half_strokes(f, q);
  } else if (design.type == TransmissionType::slider_crank) {
    const SliderCrank<double> c = SliderCrank<double>::from(design);
    validate(c);
    const double r = c.crank_radius, l = c.rod_length, H = c.hinge_offset;
    q.transmission_angle = std::acos(r / l);
    q.stroke = 2.0 * stroke_amplitude(c);
    q.envelope = std::max({l + 2.0 * r, std::hypot(H, c.mid_stroke_height) + r, 2.0 * H});
    q.shortest = std::min({r, l, H});
    measure_half_strokes(c, q);
  } else {
    refuse_type();
  }
  return q;
}

ClearanceCost clearance_cost(const TransmissionDesign<double>& design, double c) {
  require(c >= 0.0 && std::isfinite(c), "clearance", "must be >= 0", "m", c);
  ClearanceCost cost{};
  cost.clearance = c;
  if (design.type == TransmissionType::four_bar) {
    const FourBar<double> f = four_bar_from(design);
    const auto with_play = [&](double side) {
      FourBar<double> moved = f;
      moved.coupler_length += side * 4.0 * c;
      validate(moved);
      return moved;
    };
    const FourBar<double> shorter = with_play(-1.0), longer = with_play(1.0);
    const RockerEnds<double> less = rocker_ends(shorter), more = rocker_ends(longer);
    cost.stroke_highest = f.stroke_ratio * (less.folded - more.stretched);
    cost.stroke_lowest = f.stroke_ratio * (more.folded - less.stretched);
    const auto shifted = [&](double theta, double side) {
      return stroke_there(side > 0.0 ? longer : shorter, theta).angle;
    };
    measure_play(f, shifted, cost);
  } else if (design.type == TransmissionType::slider_crank) {
    const SliderCrank<double> s = SliderCrank<double>::from(design);
    validate(s);
    require(s.rod_length - 3.0 * c > s.crank_radius, "clearance", "must leave the rod longer than the crank", "m", c);
    const auto shifted = [&](double theta, double side) {
      return slider_crank_stroke(s, theta, s.rod_length + side * 3.0 * c, side * 2.0 * c);
    };
    cost.stroke_highest = shifted(0.5 * pi, 1.0) - shifted(-0.5 * pi, -1.0);
    cost.stroke_lowest = shifted(0.5 * pi, -1.0) - shifted(-0.5 * pi, 1.0);
    measure_play(s, shifted, cost);
  } else {
    refuse_type();
  }
  return cost;
}

SynthesisedMechanism synthesise_four_bar(const StrokeTarget& target) {
  constexpr double least_angle = transmission_angle_min_deg / degrees_per_radian;
  SynthesisedMechanism result;
  StrokeTarget& t = result.target = checked(target);
  t.transmission_angle = std::max(t.transmission_angle, least_angle);
  DeadCentres centres{};
  const double angle = best_angle(t, &centres);
  result.quality.transmission_angle = angle;
  if (angle > least_angle) {
    result.transmission = four_bar_of(centres, t);
    result.quality = mechanism_quality(result.transmission);
    result.found = angle >= t.transmission_angle;
  }
  for (const double ratio : {1.0, 1.5, 2.0, 3.0, 4.0}) {
    StrokeTarget other = t;
    other.stroke_ratio = ratio;
    result.ratios.push_back({ratio, best_angle(other)});
  }
  if (!result.found) result.ratio_needed = ratio_needed(t);
  return result;
}

SynthesisedMechanism synthesise_slider_crank(const StrokeTarget& target) {
  SynthesisedMechanism result;
  const StrokeTarget& t = result.target = checked(target);
  require(t.stroke < pi, "stroke", "of a slider-crank must be < 180", "deg", degrees_per_radian * t.stroke);
  require(t.stroke_ratio == 1.0, "stroke_ratio", "of a slider-crank must be 1", "1", t.stroke_ratio);
  const double tangent = std::tan(0.5 * t.stroke);
  const double r = t.shortest * std::max(1.0, tangent), H = r / tangent;
  const double across = std::sqrt(std::max(square(t.envelope - r) - square(H), 0.0));
  const double l = std::min(t.envelope - 2.0 * r, across);
  result.transmission.type = TransmissionType::slider_crank;
  result.transmission.formulation = Formulation::virtual_work;
  result.transmission.crank_radius = r;
  result.transmission.rod_length = l;
  result.transmission.hinge_offset = H;
  result.quality.transmission_angle = absent;
  if (!(l > r) || 2.0 * H > t.envelope) return result;
  result.quality = mechanism_quality(result.transmission);
  result.found = result.quality.transmission_angle >= t.transmission_angle;
  return result;
}

}  // namespace wingbeat
