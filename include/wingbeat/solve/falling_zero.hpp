// A zero in a bracket: the Illinois method, as steps that end at a switch need it.
#pragma once

#include <cmath>

namespace wingbeat::solver {

struct FallingZero {
  double argument;
  double slope;  ///< of the function there, by the last secant
};

/// The zero of a function between lo, where it is >= 0, and hi, where it is < 0, to within `close_enough`. It keeps the
/// bracket and converges superlinearly. `whole` is the length to which the bracket belongs: while it is a good part of
/// that, a start next to another zero is kept from drawing the secant there.
template <class Function>
FallingZero falling_zero(const Function& value, double lo, double f_lo, double hi, double f_hi, double whole,
                         double close_enough) {
  double root = hi, slope = (f_hi - f_lo) / whole;
  for (int iteration = 0, side = 0; iteration < 60 && hi - lo > close_enough; ++iteration) {
    const bool from_zero = f_lo < 0.1 * std::abs(f_hi) && iteration < 20 && hi - lo > 0.1 * whole;
    const double next = from_zero ? 0.5 * (lo + hi) : (lo * f_hi - hi * f_lo) / (f_hi - f_lo);
    const double f = value(next);
    if (next != root && iteration > 0) slope = (f - (root == hi ? f_hi : f_lo)) / (next - root);
    const double moved = std::abs(next - root);
    root = next;
    if (f < 0.0) {
      hi = next;
      f_hi = f;
      if (side == -1) f_lo *= 0.5;
      side = -1;
    } else {
      lo = next;
      f_lo = f;
      if (side == 1) f_hi *= 0.5;
      side = 1;
    }
    if (f == 0.0 || (iteration > 0 && !from_zero && moved < close_enough)) break;
  }
  return {root, slope};
}

}  // namespace wingbeat::solver
