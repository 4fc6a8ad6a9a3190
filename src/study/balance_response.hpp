// What a balance shows of a force that repeats with the flapping: a mass on a damped spring.
#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat {

/// Instants of the cycle, equally spaced in time, at which the force on a balance is computed.
inline constexpr int balance_instants = 256;

/// The reading of a balance under a force with a period. The deflection of its spring is read, in newtons of a force
/// at rest. With mass m, stiffness k and damping c each harmonic of the force, of angular frequency \f$\omega\f$, is
/// read times
/// \f[
/// H(\omega) = \frac{k}{k - m \omega^2 + \mathrm{i} \omega c}
/// \f]
class BalanceResponse {
 public:
  /// Of a force that repeats with `frequency` [Hz].
  BalanceResponse(const Balance& balance, double frequency);

  /// Complex amplitudes of a force given at balance_instants instants: its harmonics 0 to half as many.
  static std::vector<std::complex<double>> harmonics_of(std::span<const double> force);

  /// The reading, at a time in periods, of a force with these harmonics.
  double reading(const std::vector<std::complex<double>>& harmonics, double periods) const;

  /// Derivatives of the reading by what changes the response alone.
  struct Slopes {
    double periods, frequency;
    Balance balance;  ///< by its numbers
  };
  Slopes slopes(const std::vector<std::complex<double>>& harmonics, double periods) const;

 private:
  Balance balance_;
  double omega_;  ///< of the first harmonic [rad/s]
};

}  // namespace wingbeat
