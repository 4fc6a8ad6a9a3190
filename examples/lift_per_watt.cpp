// Which crank radius and which hinge springs give the most lift per watt at 3 V, and which without losing lift?
//   example_lift_per_watt data/designs/friction2022-springs.toml
#include <cstdio>
#include <exception>
#include <vector>

#include "wingbeat/wingbeat.hpp"

namespace {

using namespace wingbeat;

double lift_per_watt(const Metrics<double>& m) { return m[Metric::lift_mean] / m[Metric::power_electrical]; }

void print(const char* what, const Design<double>& design, const Metrics<double>& m) {
  std::printf("%-19s crank %.2f mm, springs %.2f mN m/rad: %.1f Hz, %.2f mN, %.1f mW, %.2f mN/W\n", what,
              1e3 * design.transmission.crank_radius, 1e3 * design.spring.stiffness.value_or(0.0), m[Metric::frequency],
              1e3 * m[Metric::lift_mean], 1e3 * m[Metric::power_electrical], 1e3 * lift_per_watt(m));
}

}  // namespace

int main(int argc, char** argv) try {
  Design<double> base = read_design(argc > 1 ? argv[1] : "data/designs/friction2022-springs.toml");
  base.supply.voltage = 3.0;
  std::vector<Design<double>> designs = {base};
  for (int radius = 0; radius <= 60; ++radius) {
    for (int spring = 0; spring <= 80; ++spring) {
      designs.push_back(base);
      designs.back().transmission.crank_radius = 3e-3 + 5e-5 * radius;
      designs.back().spring.stiffness = 5e-5 * spring;
    }
  }

  const std::vector<EnsembleOutcome> found = solve_ensemble(designs);
  if (found[0].status != FlappingStatus::flapping) {
    std::fprintf(stderr, "the vehicle does not flap at 3 V\n");
    return 3;
  }
  std::size_t flapping = 0, inside = 0, frugal = 0, best = 0;
  for (std::size_t n = 0; n < found.size(); ++n) {
    if (found[n].status != FlappingStatus::flapping) continue;
    ++flapping;
    // Outside the model's domain of validity numbers exist, but a design must not be chosen by them.
    if (found[n].domain.any()) continue;
    ++inside;
    const double ratio = lift_per_watt(found[n].metrics);
    if (ratio > lift_per_watt(found[frugal].metrics)) frugal = n;
    const bool lifts = found[n].metrics[Metric::lift_mean] >= found[0].metrics[Metric::lift_mean];
    if (lifts && ratio > lift_per_watt(found[best].metrics)) best = n;
  }
  std::printf("%zu designs: %zu flap from rest, %zu of them inside the domain of validity\n", found.size(), flapping,
              inside);
  print("as it is:", designs[0], found[0].metrics);
  print("most lift per watt:", designs[frugal], found[frugal].metrics);
  print("with no less lift:", designs[best], found[best].metrics);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
