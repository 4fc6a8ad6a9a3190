#include "study/voltage_nodes.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "wingbeat/core/math.hpp"

namespace wingbeat::detail {

VoltageNodes::VoltageNodes(double low, double high) {
  const int last = high > low ? 10 : 0;
  for (int j = 0; j <= last; ++j) {
    voltages_.push_back(last == 0 ? low : 0.5 * (low + high) - 0.5 * (high - low) * std::cos(pi * j / last));
    weights_.push_back((j % 2 ? -1.0 : 1.0) * (j == 0 || j == last ? 0.5 : 1.0));
  }
}

std::vector<double> VoltageNodes::integrals(const Battery<double>& battery, double from, double to) const {
  std::vector<double> result(voltages_.size(), 0.0), ends{from};
  for (const auto& [charge, voltage] : battery.discharge_curve) {
    if (charge > from && charge < to) ends.push_back(charge);
  }
  ends.push_back(to);
  for (std::size_t k = 1; k < ends.size(); ++k) {
    for (std::size_t j = 0; j < voltages_.size(); ++j) {
      const auto polynomial = [&](double charge) { return lagrange(j, open_circuit_voltage(battery, charge)); };
      result[j] += boost::math::quadrature::gauss<double, 20>::integrate(polynomial, ends[k - 1], ends[k]);
    }
  }
  return result;
}

/// In barycentric form (Berrut and Trefethen 2004).
double VoltageNodes::lagrange(std::size_t j, double voltage) const {
  double sum = 0.0;
  for (std::size_t n = 0; n < voltages_.size(); ++n) {
    if (voltage == voltages_[n]) return n == j ? 1.0 : 0.0;
    sum += weights_[n] / (voltage - voltages_[n]);
  }
  return weights_[j] / (voltage - voltages_[j]) / sum;
}

}  // namespace wingbeat::detail
