#include "wingbeat/flight/flight_wind.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "wingbeat/core/math.hpp"

namespace wingbeat {

double NormalNumbers::next() {
  if (has_second_) {
    has_second_ = false;
    return second_;
  }
  // Box and Muller; 53 bits, never 0. std::normal_distribution is another one in every library.
  const auto uniform = [&] { return (double(bits_() >> 11) + 0.5) * 0x1p-53; };
  const double size = std::sqrt(-2.0 * std::log(uniform())), angle = two_pi * uniform();
  second_ = size * std::sin(angle);
  has_second_ = true;
  return size * std::cos(angle);
}

std::function<Triple(double, const Triple&)> wind_of(const WindPlan& plan, double duration) {
  const bool calm = plan.steady == Triple{} && !(plan.deviation > 0.0) && plan.gusts.empty();
  if (calm) return {};
  constexpr double longest_step = 0.01;
  const double step = std::min(plan.time_constant / 20.0, longest_step);
  const auto turbulence = std::make_shared<std::vector<Triple>>();
  if (plan.deviation > 0.0) {
    NormalNumbers numbers(plan.seed);
    const double keeps = std::exp(-step / plan.time_constant);
    const double adds = plan.deviation * std::sqrt(-std::expm1(-2.0 * step / plan.time_constant));
    Triple now{};
    for (std::size_t k = 0; double(k) * step <= duration + 2.0 * step; ++k) {
      turbulence->push_back(now);
      for (double& x : now) x = keeps * x + adds * numbers.next();
    }
  }
  return [plan, step, turbulence](double t, const Triple&) {
    Triple wind = plan.steady;
    if (!turbulence->empty()) {
      const double place = std::clamp(t / step, 0.0, double(turbulence->size() - 1));
      const std::size_t k = std::min(std::size_t(place), turbulence->size() - 2);
      const double share = place - double(k);
      const Triple &a = (*turbulence)[k], &b = (*turbulence)[k + 1];
      for (std::size_t i = 0; i < 3; ++i) wind[i] += a[i] + share * (b[i] - a[i]);
    }
    for (const Gust& gust : plan.gusts) {
      const double share = (t - gust.start) / gust.duration;
      if (!(share > 0.0 && share < 1.0)) continue;
      for (std::size_t i = 0; i < 3; ++i) wind[i] += 0.5 * gust.velocity[i] * (1.0 - std::cos(two_pi * share));
    }
    return wind;
  };
}

}  // namespace wingbeat
