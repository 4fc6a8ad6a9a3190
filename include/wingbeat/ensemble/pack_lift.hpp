// The largest lift of a cycle on SIMD lanes.
#pragma once

#include "wingbeat/core/pack.hpp"
#include "wingbeat/parts/blade_element.hpp"

namespace wingbeat {

namespace detail {

// Speeds at which the lift is sampled first, each a share of the highest velocity. The lift coefficient is a wave in
// the angle of attack: beyond many_waves radians of it, every interval is sampled samples_within times as often.
inline constexpr int lift_samples = 12, samples_within = 8;
inline constexpr double many_waves = 2.0;
// A share of the highest velocity just below it: lift is higher there where the maximum lies inside.
inline constexpr double just_below = 0.999;
// The interval around the best sample is halved so often that a parabola describes the lift within it. Each parabola
// then leaves an error of the third order, so that the next one is laid through points this much closer.
inline constexpr int lift_halvings = 6, lift_parabolas = 2;
inline constexpr double next_parabola_width = 1.0 / 16.0;
// A parabola without a maximum is replaced by one so steep that its step is zero.
inline constexpr double no_maximum_curvature = -1e300;

}  // namespace detail

/// The largest lift while |beta'| runs from zero to its peak: at the peak, or where lift falls with speed before it.
template <class L>
[[gnu::noinline, gnu::flatten]] L lift_peak_up_to(const BladeElement<L>& wings, const L& highest_velocity) {
  using namespace detail;
  const auto lift_at = [&](const L& speed) { return aero_loads(wings, speed).lift; };
  L best_speed = highest_velocity, best = lift_at(highest_velocity);
  const auto compare = [&](const L& speed, const Mask<L>& where) {
    const L lift = lift_at(speed);
    const Mask<L> higher = where && lift > best;
    best = select<L>(higher, lift, best);
    best_speed = select<L>(higher, speed, best_speed);
  };
  // Samples find the surroundings of the highest lift, more of them where lift rises and falls several times.
  const Mask<L> all = highest_velocity >= L(0.0), often = wings.pitch_coefficient * highest_velocity > L(many_waves);
  for (int n = 1; n < lift_samples; ++n) compare(L(double(n) / lift_samples) * highest_velocity, all);
  if (any<L>(often)) {
    constexpr int samples = lift_samples * samples_within;
    for (int n = 1; n < samples; ++n) compare(L(double(n) / samples) * highest_velocity, often);
  }
  const Mask<L> within = best_speed < highest_velocity || lift_at(L(L(just_below) * highest_velocity)) > best;
  if (!any<L>(within)) return best;
  L width = L(1.0 / lift_samples) * select<L>(often, L(1.0 / samples_within), L(1.0)) * highest_velocity;
  for (int n = 0; n < lift_halvings; ++n) {
    width = L(0.5) * width;
    const L centre = best_speed;
    compare(max(L(centre - width), L(0.0)), within);
    compare(min(L(centre + width), highest_velocity), within);
  }
  for (int n = 0; n < lift_parabolas; ++n) {
    const L centre = best_speed, below = lift_at(L(centre - width)), above = lift_at(L(centre + width));
    const L curve = below - L(2.0) * best + above;
    const L curvature = select<L>(curve < L(0.0), curve, L(no_maximum_curvature));
    const L move = L(0.5) * width * (below - above) * inverse_of(curvature);
    compare(min(max(centre + min(max(move, -width), width), L(0.0)), highest_velocity), within);
    width = L(next_parabola_width) * width;
  }
  return best;
}

}  // namespace wingbeat
