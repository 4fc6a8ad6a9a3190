// What do the tolerances of the parts do to the lift, and which part matters most?
//   example_part_tolerances data/designs/friction2022-springs.toml
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <random>
#include <vector>

#include "wingbeat/wingbeat.hpp"

namespace {

using namespace wingbeat;

struct Part {
  const char* key;
  double spread;  ///< standard deviation, share of the value
  double& (*value)(Design<double>&);
};

constexpr Part parts[] = {
    {"motor.torque_constant", 0.05, [](Design<double>& d) -> double& { return d.motor.constants.torque_constant; }},
    {"transmission.crank_radius", 0.01, [](Design<double>& d) -> double& { return d.transmission.crank_radius; }},
    {"friction.radius", 0.15, [](Design<double>& d) -> double& { return d.friction.coefficient; }},
    {"spring.stiffness", 0.10, [](Design<double>& d) -> double& { return *d.spring.stiffness; }},
    {"wing.inertia", 0.05, [](Design<double>& d) -> double& { return d.wing.inertia; }}};

}  // namespace

int main(int argc, char** argv) try {
  Design<double> base = read_design(argc > 1 ? argv[1] : "data/designs/friction2022-springs.toml");
  std::vector<std::string> keys;
  for (const Part& part : parts) keys.push_back(part.key);
  const DesignPoint nominal = gradient(base, keys);
  if (nominal.status != SweepStatus::flapping) throw std::runtime_error(describe(nominal));
  std::printf("nominal lift %.3f mN; each part by one standard deviation:\n", 1e3 * nominal.metrics[Metric::lift_mean]);
  double variance = 0.0;
  for (std::size_t k = 0; k < std::size(parts); ++k) {
    const double change = nominal.gradients[k][std::size_t(Metric::lift_mean)] * parts[k].spread * parts[k].value(base);
    std::printf("  %-26s %4.0f %%: %+.3f mN\n", parts[k].key, 100.0 * parts[k].spread, 1e3 * change);
    variance += change * change;
  }
  std::printf("standard deviation by these slopes: %.3f mN\n", 1e3 * std::sqrt(variance));

  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<Design<double>> designs(4000, base);
  for (Design<double>& design : designs) {
    for (const Part& part : parts) part.value(design) *= 1.0 + part.spread * normal(random);
  }
  std::vector<double> lift;
  for (const EnsembleOutcome& outcome : solve_ensemble(designs)) {
    if (outcome.status == FlappingStatus::flapping) lift.push_back(outcome.metrics[Metric::lift_mean]);
  }
  std::sort(lift.begin(), lift.end());
  double mean = 0.0, square_sum = 0.0;
  for (const double value : lift) mean += value / double(lift.size());
  for (const double value : lift) square_sum += (value - mean) * (value - mean);
  std::printf("of %zu vehicles %zu flap: mean %.3f mN, standard deviation %.3f mN, 95 %% lift at least %.3f mN\n",
              designs.size(), lift.size(), 1e3 * mean, 1e3 * std::sqrt(square_sum / double(lift.size() - 1)),
              1e3 * lift[lift.size() / 20]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
