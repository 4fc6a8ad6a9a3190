// The strips of wings in their wake, and on a body that moves, on SIMD lanes of the oldest processor of its kind: for a
// scalar solver, which would sum sixteen strips one after the other.
#include <array>
#include <cstddef>

#include "wingbeat/core/base_lanes.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/parts/blade_element.hpp"

namespace wingbeat {
namespace {

#ifdef WINGBEAT_BASE_LANES
using StripLanes = BaseLanes<4>;
#else
using StripLanes = double;
#endif
constexpr std::size_t strip_lanes = std::size_t(ScalarTraits<StripLanes>::lanes);
static_assert(wake_strip_count % strip_lanes == 0);

/// One number of `strip_lanes` strips, from the strip `first` on.
StripLanes gathered_strips(const WakeStrips<double>& strips, std::size_t first, double WakeStrip<double>::* number) {
#ifdef WINGBEAT_BASE_LANES
  alignas(64) std::array<double, strip_lanes> numbers;
  for (std::size_t n = 0; n < strip_lanes; ++n) numbers[n] = strips.at[first + n].*number;
  return StripLanes::load(numbers.data());
#else
  return strips.at[first].*number;
#endif
}

double sum_of_lanes(const StripLanes& x) {
#ifdef WINGBEAT_BASE_LANES
  alignas(64) std::array<double, strip_lanes> numbers;
  x.store(numbers.data());
  double sum = 0.0;
  for (const double number : numbers) sum += number;
  return sum;
#else
  return x;
#endif
}

}  // namespace

LiftAndDrag<double> detail::strips_in_wake(const BladeElement<double>& w, double alpha, double stroke_speed,
                                           double clap) {
  const ForceCoefficients<StripLanes> coefficients = cast<StripLanes>(w.coefficients);
  const StripLanes along_the_flow(force_coefficients<true>(w.coefficients, 0.0).lift), angle(alpha), share(clap);
  const StripLanes half_density(0.5 * w.air_density), velocity(w.wake.velocity), speed(stroke_speed);
  LiftAndDrag<StripLanes> sum{StripLanes(0.0), StripLanes(0.0)};
  for (std::size_t n = 0; n < wake_strip_count; n += strip_lanes) {
    const WakeStrip<StripLanes> strip{gathered_strips(w.wake.strips, n, &WakeStrip<double>::radius),
                                      gathered_strips(w.wake.strips, n, &WakeStrip<double>::area), StripLanes(0.0)};
    add_strip_in_wake(coefficients, half_density, strip, strip_flow(velocity, strip, speed), angle, along_the_flow,
                      share, sum);
  }
  return {sum_of_lanes(sum.lift), sum_of_lanes(sum.drag)};
}

MountLoads<double> detail::strips_of_mount(const ForceCoefficients<double>& of_wing,
                                           const InducedVelocity<double>& wake, const StripDrift<double>& drift,
                                           const MountMotion<double>& motion) {
  const ForceCoefficients<StripLanes> coefficients = cast<StripLanes>(of_wing);
  const StripLanes u0(drift.u0), u1(motion.velocity + drift.u1), w0(drift.w0 - wake.velocity), w1(drift.w1);
  const StripLanes sin_psi(motion.sin_psi), cos_psi(motion.cos_psi), stroke(motion.stroke), scale(motion.scale);
  const StripLanes along_the_flow(motion.along_the_flow), clap(motion.clap);
  MountLoads<StripLanes> sum{StripLanes(0.0), StripLanes(0.0), StripLanes(0.0), StripLanes(0.0)};
  for (std::size_t n = 0; n < wake_strip_count; n += strip_lanes) {
    const WakeStrip<StripLanes> strip{gathered_strips(wake.strips, n, &WakeStrip<double>::radius),
                                      gathered_strips(wake.strips, n, &WakeStrip<double>::area), StripLanes(0.0)};
    add_strip_of_mount(coefficients, scale, strip, StripLanes(u0 + u1 * strip.radius),
                       StripLanes(w0 + w1 * strip.radius), sin_psi, cos_psi, stroke, along_the_flow, clap, sum);
  }
  return {sum_of_lanes(sum.ahead), sum_of_lanes(sum.down), sum_of_lanes(sum.ahead_by_radius),
          sum_of_lanes(sum.down_by_radius)};
}

}  // namespace wingbeat
