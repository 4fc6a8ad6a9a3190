// 10,000 designs at once, voltage by crank radius: which of them lifts most inside the model's domain?
#include <cstdio>

#include "wingbeat/wingbeat.hpp"

int main(int argc, char** argv) {
  using namespace wingbeat;
  const Design<double> base = read_design(argc > 1 ? argv[1] : "data/designs/friction2022-springs.toml");
  std::vector<Design<double>> designs(10000, base);
  for (std::size_t n = 0; n < designs.size(); ++n) {
    designs[n].supply.voltage = 1.0 + 0.04 * double(n % 100);
    designs[n].transmission.crank_radius = 4e-3 + 5e-5 * double(n / 100);
  }
  const std::vector<EnsembleOutcome> outcomes = solve_ensemble(designs);
  std::size_t best = 0, flapping = 0;
  for (std::size_t n = 0; n < outcomes.size(); ++n) {
    if (outcomes[n].status != FlappingStatus::flapping || outcomes[n].domain.any()) continue;
    ++flapping;
    if (!(outcomes[n].metrics[Metric::lift_mean] < outcomes[best].metrics[Metric::lift_mean])) best = n;
  }
  std::printf("%zu of %zu flap inside the domain; most lift, %.4g mN, at %.4g V and %.4g mm\n", flapping,
              designs.size(), 1e3 * outcomes[best].metrics[Metric::lift_mean], designs[best].supply.voltage,
              1e3 * designs[best].transmission.crank_radius);
}
