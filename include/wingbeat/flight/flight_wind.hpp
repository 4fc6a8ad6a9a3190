// Wind of a flight: a steady one, turbulence that a seed decides, and gusts; random numbers that are the same anywhere.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "wingbeat/parts/onset_flow.hpp"

namespace wingbeat {

/// Independent numbers of the normal distribution of mean 0 and standard deviation 1.
class NormalNumbers {
 public:
  explicit NormalNumbers(std::uint64_t seed) : bits_(seed) {}
  double next();

 private:
  std::mt19937_64 bits_;
  double second_ = 0.0;
  bool has_second_ = false;
};

/// A gust that rises and falls once: half its velocity times 1 - cos.
struct Gust {
  double start = 0.0, duration = 1.0;  ///< [s]
  Triple velocity{};                   ///< at its height, earth axes, z down [m/s]
};

/// In earth axes, z down.
struct WindPlan {
  Triple steady{};             ///< [m/s]
  double deviation = 0.0;      ///< standard deviation of each component of the turbulence [m/s]
  double time_constant = 1.0;  ///< of its correlation [s]
  std::uint64_t seed = 1;
  std::vector<Gust> gusts;
};

/// The wind over the time of a flight, everywhere the same. The turbulence is a first-order Gauss-Markov process, drawn
/// twenty times in a time constant, at least every 10 ms, and joined by straight lines; it starts at 0.
std::function<Triple(double time, const Triple& position)> wind_of(const WindPlan& plan, double duration);

}  // namespace wingbeat
