// How a controller changes the sine that drives a direct drive: a bias, and halves of different length.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

/// What is added to v = V sin phi. With all at 0 it is that sine.
template <Scalar S>
struct DriveWave {
  S bias = S(0);  ///< on top [V]
  /// delta: the positive half of the wave takes (1 + delta)/2 of the period; its mean, 2 V delta/pi, is taken out [1],
  /// |delta| < 1/2.
  S split = S(0);
  /// delta: from its peak to its trough, as the falling half of a cosine, the wave takes (1 + delta)/2 of the period;
  /// it has no mean [1], |delta| < 1/2.
  S cosine_split = S(0);
};

/// Where the falling half of the cosine begins: at the peak of the sine.
inline constexpr double cosine_start = 0.5 * pi;

/// The voltage [V] at the phase phi, 0 to 2 pi, of a wave of amplitude V [V]. With the bias \f$v_0\f$, the split
/// \f$\delta\f$ and the split \f$\delta_\mathrm{c}\f$ of the cosine, and \f$\psi = \varphi - \pi/2\f$ from
/// \f$-\pi/2\f$ to \f$3\pi/2\f$:
/// \f[
/// \begin{aligned}
/// v &= V \left( s(\varphi) - \frac{2 \delta}{\pi} + c(\psi) - \sin\varphi \right) + v_0 \cr
/// s(\varphi) &= \begin{cases}
/// \sin\dfrac{\varphi}{1 + \delta} & \varphi < \pi (1 + \delta) \cr
/// \sin\dfrac{\varphi - 2\pi}{1 - \delta} & \text{otherwise} \end{cases} \cr
/// c(\psi) &= \begin{cases}
/// \cos\dfrac{\psi}{1 + \delta_\mathrm{c}} & 0 \le \psi < \pi (1 + \delta_\mathrm{c}) \cr
/// \cos\dfrac{\psi_\mathrm{p}}{1 - \delta_\mathrm{c}} & \text{otherwise} \end{cases}
/// \end{aligned}
/// \f]
/// where \f$\psi_\mathrm{p}\f$ is \f$\psi\f$ before the peak and \f$\psi - 2\pi\f$ after the trough.
template <Scalar S>
S voltage_of_wave(const DriveWave<S>& wave, const S& V, const S& phi) {
  using std::cos;
  using std::sin;
  const double x = value_of(phi);
  // A half that ends at 2 pi is measured from there.
  const S from_end = phi - S(two_pi);
  const bool positive = x < pi * (1.0 + value_of(wave.split));
  const S halves = sin(positive ? S(phi / (S(1.0) + wave.split)) : S(from_end / (S(1.0) - wave.split)));
  const S after = phi - S(cosine_start);
  const bool falls = x >= cosine_start && x < cosine_start + pi * (1.0 + value_of(wave.cosine_split));
  const S to_peak = x < pi ? after : S(after - S(two_pi));
  const S cosine = cos(falls ? S(after / (S(1.0) + wave.cosine_split)) : S(to_peak / (S(1.0) - wave.cosine_split)));
  return V * (halves - S(2.0 / pi) * wave.split + cosine - sin(phi)) + wave.bias;
}

/// The phases between 0 and 2 pi at which its halves meet, where its slope or its curvature jumps.
inline std::array<double, 3> nodes_of(const DriveWave<double>& wave) {
  std::array<double, 3> nodes = {cosine_start, pi * (1.0 + wave.split), cosine_start + pi * (1.0 + wave.cosine_split)};
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace wingbeat
