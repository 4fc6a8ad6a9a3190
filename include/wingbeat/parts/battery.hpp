// A battery of equal cells in series: open-circuit voltage against charge behind an internal resistance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

/// Cells in series, n of them, at the state of charge s. Charge, voltages and resistance are those of one cell; the
/// capacity is that of a cell and, the cells being in series, of the whole battery. Under the current i, positive where
/// it empties the battery, the terminals see
/// \f[
/// v = n \left( E(s) - R_\mathrm{i} i \right), \qquad Q \frac{\mathrm{d}s}{\mathrm{d}t} = -i
/// \f]
template <Scalar S>
struct Battery {
  S cells = S(1);         ///< n, cells in series [1], whole number >= 1
  S cell_voltage = S(0);  ///< E of one cell at any charge [V], > 0, where there is no curve
  /// E of one cell: (state of charge [1], voltage [V]), from charge 0 to 1, both growing; empty: cell_voltage.
  std::vector<std::pair<double, double>> discharge_curve = {};
  S internal_resistance = S(0);     ///< R_i of one cell [ohm], >= 0
  S capacity = S(0);                ///< Q, charge that a full battery holds [C], > 0
  S charge = S(1);                  ///< state of charge [1], 0 (empty) to 1 (full)
  std::optional<S> cutoff_voltage;  ///< mean terminal voltage of one cell at which flight ends [V], >= 0
  /// e, open-circuit energy of the full battery over its mass [J/kg], > 0; given, the battery weighs by its capacity.
  std::optional<S> specific_energy;

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.cells, self.cell_voltage, self.discharge_curve, self.internal_resistance, self.capacity,
               self.charge, self.cutoff_voltage, self.specific_energy);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace battery_key {
inline constexpr ParameterKey cells{"supply.cells", "1", range::count};
inline constexpr ParameterKey cell_voltage{"supply.cell_voltage", "V", range::positive};
inline constexpr ParameterKey internal_resistance{"supply.internal_resistance", "ohm", range::not_negative};
inline constexpr ParameterKey capacity{"supply.capacity", "C", range::positive};
inline constexpr ParameterKey charge{"supply.charge", "1", range::zero_to_one};
inline constexpr ParameterKey cutoff_voltage{"supply.cutoff_voltage", "V", range::not_negative};
inline constexpr ParameterKey specific_energy{"supply.specific_energy", "J/kg", range::positive};
}  // namespace battery_key

/// Throws ParameterError for the first parameter out of its range.
void validate(const Battery<double>& battery);

namespace detail {

/// Slope at row k of a monotone cubic interpolant: Fritsch and Butland's weighted harmonic mean inside, at the ends the
/// three-point formula held to the sign and three times the size of the secant (Fritsch and Carlson 1980; Moler,
/// Numerical Computing with MATLAB, section 3.4).
double monotone_slope(const std::vector<std::pair<double, double>>& curve, std::size_t k);

}  // namespace detail

/// Open-circuit voltage of the whole battery at a state of charge [V]: piecewise cubic Hermite interpolation of the
/// discharge curve that keeps it monotone, with a continuous first derivative. From a row \f$(s_0, E_0)\f$ to the next
/// \f$(s_1, E_1)\f$, with slopes \f$d_0\f$, \f$d_1\f$ there, \f$\Delta = s_1 - s_0\f$ and the secant
/// \f$m = (E_1 - E_0)/\Delta\f$:
/// \f[
/// n E(s) = n \left( E_0 + d_0 x + \frac{3 m - 2 d_0 - d_1}{\Delta} x^2 + \frac{d_0 + d_1 - 2 m}{\Delta^2} x^3 \right),
/// \qquad x = s - s_0
/// \f]
template <Scalar S>
S open_circuit_voltage(const Battery<S>& b, const S& charge) {
  const auto& curve = b.discharge_curve;
  if (curve.size() < 2) return b.cells * (curve.empty() ? b.cell_voltage : S(curve.front().second));
  const double used = value_of(charge);
  std::size_t k = 0;
  while (k + 2 < curve.size() && used >= curve[k + 1].first) ++k;
  const auto [x0, y0] = curve[k];
  const auto [x1, y1] = curve[k + 1];
  const double h = x1 - x0, secant = (y1 - y0) / h;
  const double d0 = detail::monotone_slope(curve, k), d1 = detail::monotone_slope(curve, k + 1);
  const S x = charge - S(x0);
  const double c2 = (3.0 * secant - 2.0 * d0 - d1) / h, c3 = (d0 + d1 - 2.0 * secant) / (h * h);
  return b.cells * (S(y0) + x * (S(d0) + x * (S(c2) + x * S(c3))));
}

/// Mean of that voltage over the state of charge, from 0 to 1 [V]: the integral of every cubic in closed form. Times
/// the capacity it is the energy of the full battery.
/// \f[
/// n \overline{E} = n \int_0^1 E\,\mathrm{d}s
/// = n \sum \left( \tfrac12 \Delta (E_0 + E_1) + \tfrac{1}{12} \Delta^2 (d_0 - d_1) \right)
/// \f]
template <Scalar S>
S mean_open_circuit_voltage(const Battery<S>& b) {
  const auto& curve = b.discharge_curve;
  if (curve.size() < 2) return open_circuit_voltage(b, S(1.0));
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
    const auto [x0, y0] = curve[k];
    const auto [x1, y1] = curve[k + 1];
    const double h = x1 - x0;
    const double d0 = detail::monotone_slope(curve, k), d1 = detail::monotone_slope(curve, k + 1);
    sum += 0.5 * h * (y0 + y1) + h * h * (d0 - d1) / 12.0;
  }
  return b.cells * S(sum);
}

/// Mass of a battery that weighs by its capacity [kg]; empty without a specific energy e [J/kg].
/// \f[
/// m = \frac{Q\, n \overline{E}}{e}
/// \f]
template <Scalar S>
std::optional<S> battery_mass(const Battery<S>& b) {
  if (!b.specific_energy) return std::nullopt;
  return b.capacity * mean_open_circuit_voltage(b) / *b.specific_energy;
}

/// Resistance between that voltage and the terminals, \f$n R_\mathrm{i}\f$ [ohm].
template <Scalar S>
S source_resistance(const Battery<S>& b) {
  return b.cells * b.internal_resistance;
}

}  // namespace wingbeat
