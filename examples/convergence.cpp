// How the orbit solver's error follows the tolerance asked for: the table of docs/numerics.md.
//   example_convergence data/designs/friction2022.toml
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace {

using namespace wingbeat;

/// Largest relative difference of two cycles' metrics, those absent in either left out, and powers measured by the
/// electrical input: a residual of exactly zero has no relative error.
double largest_difference(const Metrics<double>& a, const Metrics<double>& b) {
  double largest = 0.0;
  for (int n = 0; n < metric_count; ++n) {
    const Metric m = Metric(n);
    if (m == Metric::floquet_multiplier_max || !std::isfinite(a[m]) || !std::isfinite(b[m])) continue;
    const double scale = m == Metric::power_residual ? b[Metric::power_electrical] : std::abs(b[m]);
    if (scale > 0.0) largest = std::max(largest, std::abs(a[m] - b[m]) / scale);
  }
  return largest;
}

}  // namespace

int main(int argc, char** argv) try {
  const Design<double> design = read_design(argc > 1 ? argv[1] : "data/designs/friction2022.toml");
  const Vehicle<double> vehicle = resolve(design);
  const auto solve = [&](double tolerance) {
    return find_steady_flapping(vehicle, {.tolerance = tolerance, .reporting = reporting_of(design)});
  };
  const SteadyFlapping exact = solve(1e-13);
  if (exact.status != FlappingStatus::flapping) {
    std::printf("%s\n", describe(exact.evidence).c_str());
    return 3;
  }
  std::printf("| tolerance | iterates | steps in the last iterate | largest error of a metric | energy imbalance |\n");
  std::printf("| --- | --- | --- | --- | --- |\n");
  bool within = true;
  for (double tolerance = 1e-3; tolerance > 0.5e-12; tolerance *= 0.1) {
    const SteadyFlapping found = solve(tolerance);
    const EnergyAudit audit = energy_audit(found.metrics);
    const double error = largest_difference(found.metrics, exact.metrics);
    std::printf("| %.0e | %d | %d | %.1e | %.1e |\n", tolerance, found.summary.iterates, found.summary.steps, error,
                std::abs(audit.imbalance) / audit.electrical);
    within = within && error <= tolerance;
  }
  if (!within) std::printf("an error exceeds the tolerance asked for\n");
  return within ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
