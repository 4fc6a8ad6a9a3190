#include "wingbeat/parts/battery.hpp"

#include <string>

namespace wingbeat {

void validate(const Battery<double>& b) {
  require(battery_key::cells, b.cells);
  if (b.discharge_curve.empty()) {
    require(battery_key::cell_voltage, b.cell_voltage);
  } else {
    const auto refuse = [](const std::string& reason) { throw ParameterError("supply.discharge_curve", reason); };
    const auto& curve = b.discharge_curve;
    if (curve.size() < 2) refuse("needs at least two rows; give cell_voltage for a constant voltage");
    for (std::size_t row = 0; row < curve.size(); ++row) {
      const auto [charge, voltage] = curve[row];
      const std::string where = "row " + std::to_string(row + 1) + " of the discharge curve";
      if (!(std::isfinite(charge) && std::isfinite(voltage) && voltage > 0.0)) {
        refuse(where + " must hold a state of charge and a voltage > 0 V");
      }
      if (row > 0 && !(charge > curve[row - 1].first)) {
        refuse(where + " must have a larger state of charge than the row before it");
      }
      if (row > 0 && !(voltage >= curve[row - 1].second)) {
        refuse(where + " must not have a lower voltage than the row before it");
      }
    }
    if (curve.front().first != 0.0 || curve.back().first != 1.0) {
      refuse("the states of charge must run from 0 to 1");
    }
  }
  require(battery_key::internal_resistance, b.internal_resistance);
  require(battery_key::capacity, b.capacity);
  require(battery_key::charge, b.charge);
  if (b.cutoff_voltage) require(battery_key::cutoff_voltage, *b.cutoff_voltage);
  if (b.specific_energy) require(battery_key::specific_energy, *b.specific_energy);
}

namespace detail {

double monotone_slope(const std::vector<std::pair<double, double>>& curve, std::size_t k) {
  const std::size_t last = curve.size() - 1;
  const auto width = [&](std::size_t n) { return curve[n + 1].first - curve[n].first; };
  const auto secant = [&](std::size_t n) { return (curve[n + 1].second - curve[n].second) / width(n); };
  if (last == 1) return secant(0);
  if (k == 0 || k == last) {
    const std::size_t near = k == 0 ? 0 : last - 1, far = k == 0 ? 1 : last - 2;
    const double h0 = width(near), h1 = width(far), s0 = secant(near), s1 = secant(far);
    const double slope = ((2.0 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
    return std::clamp(slope, 0.0, 3.0 * s0);
  }
  const double h0 = width(k - 1), h1 = width(k), s0 = secant(k - 1), s1 = secant(k);
  if (!(s0 > 0.0 && s1 > 0.0)) return 0.0;
  const double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / s0 + w1 / s1);
}

}  // namespace detail

}  // namespace wingbeat
