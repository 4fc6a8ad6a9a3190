#include "wingbeat/ensemble/lane_mechanism.hpp"

namespace wingbeat {

bool has_half_turns(const AnyTransmission<double>& t) {
  return t.type != TransmissionType::direct && reversals(t).count == 2;
}

HalfTurns half_turns(const AnyTransmission<double>& t) {
  const Reversals r = reversals(t);
  const double a = r.angle[0], b = r.angle[1];
  const bool rises_at_zero = r.first_sign > 0.0;
  HalfTurns h{};
  // The stroke from the one reversal to the other, and the one over crank angle zero.
  h.middle[rises_at_zero ? 1 : 0] = 0.5 * (a + b) - (rises_at_zero ? 0.0 : two_pi);
  h.reach[rises_at_zero ? 1 : 0] = 0.5 * (b - a);
  h.middle[rises_at_zero ? 0 : 1] = 0.5 * (a + b) - pi;
  h.reach[rises_at_zero ? 0 : 1] = pi - 0.5 * (b - a);
  if (t.type == TransmissionType::tabulated) {
    h.curve = t.tabulated.curve.get();
    h.curve_start = h.curve->rows().front().first;
    h.curve_amplitude = 0.5 * (h.curve->high() - h.curve->low());
  }
  return h;
}

}  // namespace wingbeat
