// Interpolation over the open-circuit voltages of a flight.
#pragma once

#include <vector>

#include "wingbeat/parts/battery.hpp"

namespace wingbeat::detail {

/// What ends a flight or a part of it.
enum class FlightEvent {
  empty,   ///< no charge is left
  cutoff,  ///< the terminal voltage has fallen to the cut-off
  sinks    ///< lift has fallen to the weight
};

/// Chebyshev's points between two open-circuit voltages; a single one where they are equal.
class VoltageNodes {
 public:
  VoltageNodes(double low, double high);

  const std::vector<double>& voltages() const { return voltages_; }

  /// Integrals of Lagrange's polynomials of these voltages over the state of charge. Gauss's rule of 20 points is exact
  /// for them: they are of degree 10 in a voltage that is a cubic of the charge on each piece of the discharge curve.
  std::vector<double> integrals(const Battery<double>& battery, double from, double to) const;

 private:
  double lagrange(std::size_t j, double voltage) const;

  std::vector<double> voltages_, weights_;
};

}  // namespace wingbeat::detail
