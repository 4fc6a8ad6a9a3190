#include "study/balance_response.hpp"

#include <cmath>

namespace wingbeat {
namespace {

constexpr int half = balance_instants / 2;

std::complex<double> turned(double periods) { return std::polar(1.0, two_pi * (periods - std::floor(periods))); }

}  // namespace

BalanceResponse::BalanceResponse(const Balance& balance, double frequency)
    : balance_(balance), omega_(two_pi * frequency) {}

std::vector<std::complex<double>> BalanceResponse::harmonics_of(std::span<const double> force) {
  static const std::vector<std::complex<double>> turns = [] {
    std::vector<std::complex<double>> all;
    for (int n = 0; n < balance_instants; ++n) all.push_back(std::polar(1.0, -two_pi * n / balance_instants));
    return all;
  }();
  std::vector<std::complex<double>> harmonics(half);
  for (int h = 0; h < half; ++h) {
    std::complex<double> sum = 0.0;
    for (int n = 0; n < balance_instants; ++n)
      sum += force[std::size_t(n)] * turns[std::size_t(h * n % balance_instants)];
    // Each harmonic stands for its conjugate as well.
    harmonics[std::size_t(h)] = (h == 0 ? 1.0 : 2.0) / balance_instants * sum;
  }
  return harmonics;
}

double BalanceResponse::reading(const std::vector<std::complex<double>>& harmonics, double periods) const {
  const auto [m, k, c] = balance_;
  const std::complex<double> turn = turned(periods);
  std::complex<double> z = 1.0;
  double sum = 0.0;
  for (int h = 0; h < half; ++h) {
    const double omega = h * omega_;
    sum += (k / std::complex(k - m * omega * omega, omega * c) * harmonics[std::size_t(h)] * z).real();
    z *= turn;
  }
  return sum;
}

BalanceResponse::Slopes BalanceResponse::slopes(const std::vector<std::complex<double>>& harmonics,
                                                double periods) const {
  using std::complex;
  const auto [m, k, c] = balance_;
  const complex<double> turn = turned(periods), i(0.0, 1.0);
  complex<double> z = 1.0;
  Slopes s{};
  for (int h = 0; h < half; ++h) {
    const double omega = h * omega_;
    const complex<double> divisor(k - m * omega * omega, omega * c), part = harmonics[std::size_t(h)] * z;
    const complex<double> per_square = k / (divisor * divisor) * part;
    s.periods += (k / divisor * part * i * (two_pi * h)).real();
    s.balance.mass += (per_square * omega * omega).real();
    s.balance.stiffness += (part / divisor - per_square).real();
    s.balance.damping -= (per_square * i * omega).real();
    s.frequency += (per_square * (2.0 * m * omega - i * c) * (two_pi * h)).real();
    z *= turn;
  }
  return s;
}

}  // namespace wingbeat
