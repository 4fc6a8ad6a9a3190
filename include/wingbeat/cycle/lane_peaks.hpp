// Extremes of a fine lap on SIMD lanes: the part of LaneOrbit that looks for them.
#pragma once

#include "wingbeat/cycle/lane_orbit.hpp"

namespace wingbeat {

/// A quantity, with the motion, at distance x from the start of a step.
template <class L, int N>
Reading<L> LaneOrbit<L, N>::reading_inside(Quantity quantity, const PeakBracket<L, N>& b, const L& x) const {
  std::array<bool, quantity_count> wanted{};
  wanted[std::size_t(quantity)] = true;
  const System system = {vehicle_, geometry_, per_inductance_, b.half};
  solve::Rates<System> first;
  solve::StepResult<System> step;
  StepSights<L> sights;
  evaluate<false>(system, system.place(b.u), b.y, b.force, first);
  lane_step<false>(system, b.u, b.y, x, b.force, first, step, sights);
  const L u = b.u + x;
  const Motion<L> motion = system.motion(sights.end, step.y, b.force);
  const State dy = system.template rates_of<false>(motion, step.y, b.force).dy;
  std::array<Reading<L>, quantity_count> readings;
  read(system, u, step.y, b.force, motion, dy, wanted, readings);
  return readings[std::size_t(quantity)];
}

/// Calls visit(bracket, mask) for each stretch of half a lap, in order: the steps, and where the cubic through a step's
/// ends turns twice inside, its two parts; the latter only where the step may rise above `floor`.
template <class L, int N>
template <class Visit>
void LaneOrbit<L, N>::for_each_stretch(int half, Quantity quantity, const L& floor, const Visit& visit) const {
  const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
  const auto& nodes = nodes_[std::size_t(half)];
  for (std::size_t m = 0; m < std::size_t(settings_.fine_steps); ++m) {
    const Reading<L>& from = nodes[m].readings[std::size_t(quantity)];
    const Reading<L>& to = nodes[m + 1].readings[std::size_t(quantity)];
    PeakBracket<L, N> b = {L(half == 0 ? 1.0 : -1.0), mesh.u[m], mesh.force[m], nodes[m].y, L(0.0), from.value,
                           from.slope, mesh.u[m + 1] - mesh.u[m], to.value, to.slope, L(0.0), L(0.0)};
    const L slope = (b.v1 - b.v0) * inverse_of(b.x1);
    const L c2 = L(3.0) * slope - L(2.0) * b.d0 - b.d1, c3 = b.d0 + b.d1 - L(2.0) * slope;
    const L discriminant = square(c2) - L(3.0) * c3 * b.d0;
    const L per_3c3 = inverse_of(select<L>(c3 == L(0.0), L(1e-300), L(3.0) * c3));
    const L middle = -(c2 * per_3c3), reach = sqrt(max(discriminant, L(0.0))) * abs(per_3c3);
    Mask twice = b.d0 * b.d1 > L(0.0) && discriminant > L(0.0) && middle - reach > L(0.0) &&
                       middle + reach < L(1.0) &&
                       max(b.v0, b.v1) + abs(b.v1 - b.v0) + L(0.1) * b.x1 * (abs(b.d0) + abs(b.d1)) > floor;
    L split = middle;
    if (quantity == Quantity::energy) {
      // The stages have seen what a cubic may miss.
      const Mask dips = sign_of(b.d0) == sign_of(b.d1) && nodes[m].dip < L(0.0);
      split = select<L>(dips, nodes[m].dip_at, split);
      twice = twice || dips;
    }
    visit(b, !twice);
    if (!any<L>(twice)) continue;
    const L x = select<L>(twice, split, L(0.5)) * b.x1;
    const Reading<L> at = reading_inside(quantity, b, x);
    PeakBracket<L, N> first = b, second = b;
    first.x1 = second.x0 = x;
    first.v1 = second.v0 = at.value;
    first.d1 = second.d0 = at.slope;
    visit(first, twice);
    visit(second, twice);
  }
}

/// The highest stretch of half a lap, by the cubics through values and slopes.
template <class L, int N>
PeakBracket<L, N> LaneOrbit<L, N>::bracket(int half, Quantity quantity) const {
  PeakBracket<L, N> best{};
  best.estimate = L(-1e300);
  L highest_node(-1e300);
  for (int m = 0; m <= settings_.fine_steps; ++m) {
    highest_node = max(highest_node, nodes_[std::size_t(half)][std::size_t(m)].readings[std::size_t(quantity)].value);
  }
  for_each_stretch(half, quantity, highest_node, [&](PeakBracket<L, N> b, const Mask& where) {
    estimate_peak(b);
    keep(b, where && b.estimate > best.estimate, best);
  });
  return best;
}

template <class L, int N>
void LaneOrbit<L, N>::keep(const PeakBracket<L, N>& from, const Mask& where, PeakBracket<L, N>& to) {
  const auto choose = [&](L PeakBracket<L, N>::*member) { to.*member = select<L>(where, from.*member, to.*member); };
  using P = PeakBracket<L, N>;
  for (L P::*member : {&P::half, &P::u, &P::force, &P::x0, &P::v0, &P::d0, &P::x1, &P::v1, &P::d1, &P::rises_and_falls,
                       &P::estimate}) {
    choose(member);
  }
  for (std::size_t n = 0; n < N; ++n) to.y[n] = select<L>(where, from.y[n], to.y[n]);
}

/// Distance from x0, as a fraction of the bracket, of the maximum of the cubic through its ends; sets the estimate.
template <class L, int N>
L LaneOrbit<L, N>::estimate_peak(PeakBracket<L, N>& b) {
  const L h = b.x1 - b.x0;
  const L slope = (b.v1 - b.v0) * inverse_of(max(h, L(1e-300)));
  const L z = b.d0 + b.d1 - L(3.0) * slope;
  const L root = sqrt(max(L(z * z - b.d0 * b.d1), L(0.0)));
  const Mask turns = b.d0 > L(0.0) && b.d1 < L(0.0);
  const L below = select<L>(turns, L(b.d0 - b.d1 + L(2.0) * root), L(1.0));
  const L t = min(max(L((b.d0 + root - z) * inverse_of(below)), L(0.0)), L(1.0));
  const L c2 = L(3.0) * slope - L(2.0) * b.d0 - b.d1, c3 = b.d0 + b.d1 - L(2.0) * slope;
  b.rises_and_falls = select<L>(turns, L(1.0), L(0.0));
  b.estimate = select<L>(turns, b.v0 + h * t * (b.d0 + t * (c2 + t * c3)), max(b.v0, b.v1));
  return t;
}

/// The maximum within a bracket: a step of the integrator to the cubic's maximum, and again within the bracket that this leaves.
template <class L, int N>
L LaneOrbit<L, N>::refine(Quantity quantity, const L& sign, PeakBracket<L, N> b) const {
  L highest = max(b.v0, b.v1);
  const Mask inside = b.rises_and_falls > L(0.0);
  Mask active = inside;
  for (int n = 0; n < 8 && any<L>(active); ++n) {
    const L t = estimate_peak(b);
    const L x = b.x0 + t * (b.x1 - b.x0);
    const Reading<L> at = reading_inside(quantity, b, x);
    const L v = sign * at.value, d = sign * at.slope;
    const Mask rising = active && d > L(0.0), falling = active && !rising;
    b.x0 = select<L>(rising, x, b.x0);
    b.v0 = select<L>(rising, v, b.v0);
    b.d0 = select<L>(rising, d, b.d0);
    b.x1 = select<L>(falling, x, b.x1);
    b.v1 = select<L>(falling, v, b.v1);
    b.d1 = select<L>(falling, d, b.d1);
    highest = select<L>(active, max(highest, v), highest);
    // What is left to gain, by the cubic through the shrunken bracket.
    estimate_peak(b);
    active = active && b.estimate - highest > L(settings_.peak_tolerance) * abs(highest);
  }
  return select<L>(inside, max(highest, b.estimate), highest);
}

/// The maximum of a quantity over the lap. Of two half laps with almost the same peak both are refined.
template <class L, int N>
L LaneOrbit<L, N>::peak(Quantity quantity) const {
  PeakBracket<L, N> best = bracket(0, quantity), other = bracket(1, quantity);
  const PeakBracket<L, N> first = best;
  const Mask second_is_higher = other.estimate > best.estimate;
  keep(other, second_is_higher, best);
  keep(first, second_is_higher, other);
  const L highest = refine(quantity, L(1.0), best);
  // The cubics err by a small part of what they rise above their ends.
  const L rise = other.estimate - min(other.v0, other.v1) + best.estimate - min(best.v0, best.v1);
  const Mask close = other.estimate + L(0.2) * rise > best.estimate;
  if (!any<L>(close)) return highest;
  return select<L>(close, max(highest, refine(quantity, L(1.0), other)), highest);
}

/// The work that wings and springs exchange with the rest, |power| integrated over the lap [J]: the energy that they store
/// rises and falls by it between its extremes.
template <class L, int N>
L LaneOrbit<L, N>::exchanged_energy() {
  L total(0.0);
  for (int half = 0; half < 2; ++half) {
    const auto& nodes = nodes_[std::size_t(half)];
    std::array<PeakBracket<L, N>, most_energy_extremes> extremes;
    std::array<L, most_energy_extremes> signs;
    L count(0.0);
    for_each_stretch(half, Quantity::energy, L(-1e300), [&](PeakBracket<L, N> b, const Mask& where) {
      const L sign = sign_of(b.d0);
      const Mask turns = where && !(sign_of(b.d1) == sign);
      if (!any<L>(turns)) return;
      for (L* part : {&b.v0, &b.d0, &b.v1, &b.d1}) *part = sign * *part;
      estimate_peak(b);
      for (std::size_t n = 0; n < most_energy_extremes; ++n) {
        const Mask here = turns && count == L(double(n));
        keep(b, here, extremes[n]);
        signs[n] = select<L>(here, sign, signs[n]);
      }
      count = select<L>(turns, count + L(1.0), count);
    });
    doubtful_ = doubtful_ || count > L(double(most_energy_extremes));
    L before = nodes[0].readings[std::size_t(Quantity::energy)].value;
    for (std::size_t n = 0; n < most_energy_extremes; ++n) {
      const Mask exists = count > L(double(n));
      if (!any<L>(exists)) break;
      const L here = signs[n] * refine(Quantity::energy, signs[n], extremes[n]);
      total = select<L>(exists, total + abs(here - before), total);
      before = select<L>(exists, here, before);
    }
    const L end = nodes[std::size_t(settings_.fine_steps)].readings[std::size_t(Quantity::energy)].value;
    total = total + abs(end - before);
  }
  return total;
}

/// The largest lift while |beta'| runs from zero to its peak: at the peak, or where lift falls with speed before it.
template <class L, int N>
L LaneOrbit<L, N>::lift_peak(const L& highest_velocity) const {
  const BladeElement<L>& w = vehicle_.wings;
  // Samples of lift over speed find the highest stretch; a parabola's vertex, twice, the maximum in it.
  constexpr int samples = 12;
  L at = highest_velocity, best = lift_force(w, highest_velocity);
  for (int n = 1; n < samples; ++n) {
    const L u = L(double(n) / samples) * highest_velocity;
    const L lift = lift_force(w, u);
    const Mask higher = lift > best;
    best = select<L>(higher, lift, best);
    at = select<L>(higher, u, at);
  }
  const Mask within = at < highest_velocity || lift_force(w, L(L(0.999) * highest_velocity)) > best;
  if (!any<L>(within)) return best;
  L width = L(1.0 / samples) * highest_velocity;
  for (int n = 0; n < 6; ++n) {
    const L below = lift_force(w, L(at - width)), here = lift_force(w, at), above = lift_force(w, L(at + width));
    const L curve = below - L(2.0) * here + above;
    const L move = L(0.5) * width * (below - above) * inverse_of(select<L>(curve < L(0.0), curve, L(-1e300)));
    at = min(max(at + min(max(move, -width), width), L(0.0)), highest_velocity);
    best = select<L>(within, max(best, lift_force(w, at)), best);
    width = L(0.25) * width;
  }
  return best;
}

}  // namespace wingbeat
