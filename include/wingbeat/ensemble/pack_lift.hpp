// The largest lift of a cycle on SIMD lanes.
#pragma once

#include "wingbeat/core/pack.hpp"
#include "wingbeat/parts/blade_element.hpp"

namespace wingbeat {

/// The largest lift while |beta'| runs from zero to its peak: at the peak, or where lift falls with speed before it.
template <class L>
[[gnu::noinline, gnu::flatten]] L lift_peak_up_to(const BladeElement<L>& wings, const L& highest_velocity) {
  const auto lift_at = [&](const L& speed) { return aero_loads(wings, speed).lift; };
  L at = highest_velocity, best = lift_at(highest_velocity);
  const auto compare = [&](const L& speed, const Mask<L>& where) {
    const L lift = lift_at(speed);
    const Mask<L> higher = where && lift > best;
    best = select<L>(higher, lift, best);
    at = select<L>(higher, speed, at);
  };
  // Samples find the surroundings of the highest lift, more of them where lift rises and falls several times.
  const Mask<L> all = highest_velocity >= L(0.0), often = wings.pitch_coefficient * highest_velocity > L(2.0);
  constexpr int samples = 12, many = 8;
  for (int n = 1; n < samples; ++n) compare(L(double(n) / samples) * highest_velocity, all);
  if (any<L>(often)) {
    for (int n = 1; n < samples * many; ++n) compare(L(double(n) / (samples * many)) * highest_velocity, often);
  }
  const Mask<L> within = at < highest_velocity || lift_at(L(L(0.999) * highest_velocity)) > best;
  if (!any<L>(within)) return best;
  // Halved towards the maximum until a parabola describes what is left.
  L width = L(1.0 / samples) * select<L>(often, L(1.0 / many), L(1.0)) * highest_velocity;
  for (int n = 0; n < 6; ++n) {
    width = L(0.5) * width;
    const L centre = at;
    compare(max(L(centre - width), L(0.0)), within);
    compare(min(L(centre + width), highest_velocity), within);
  }
  for (int n = 0; n < 2; ++n) {
    const L centre = at, below = lift_at(L(centre - width)), above = lift_at(L(centre + width));
    const L curve = below - L(2.0) * best + above;
    const L move = L(0.5) * width * (below - above) * inverse_of(select<L>(curve < L(0.0), curve, L(-1e300)));
    compare(min(max(centre + min(max(move, -width), width), L(0.0)), highest_velocity), within);
    width = L(0.0625) * width;
  }
  return best;
}

}  // namespace wingbeat
