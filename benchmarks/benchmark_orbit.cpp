// One steady state of the reference vehicle at 1e-6 from a cold start: the orbit solver against CVODE run to steady
// state.
//
//   benchmark_orbit            times by Google Benchmark, then the ratio with the accuracy that each reached
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/time/transient.hpp"

namespace {

using namespace wingbeat;

constexpr double tolerance = 1e-6;

Metrics<double> by_orbit(bool springs) {
  return find_steady_flapping(reference_vehicle(springs), {.tolerance = tolerance, .stability = false}).metrics;
}

Metrics<double> by_cvode(bool springs) {
  TransientOptions options;
  options.tolerance = tolerance;
  return *simulate_start_up(reference_vehicle(springs), options).metrics;
}

void orbit(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(by_orbit(state.range(0) != 0));
}
void cvode(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(by_cvode(state.range(0) != 0));
}
void orbit_with_floquet(benchmark::State& state) {
  const Vehicle<double> vehicle = reference_vehicle(state.range(0) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(find_steady_flapping(vehicle, {.tolerance = tolerance}).metrics);
}
BENCHMARK(orbit)->Arg(0)->Arg(1)->ArgName("springs")->Unit(benchmark::kMicrosecond);
BENCHMARK(orbit_with_floquet)->Arg(0)->Arg(1)->ArgName("springs")->Unit(benchmark::kMicrosecond);
BENCHMARK(cvode)->Arg(0)->Arg(1)->ArgName("springs")->Unit(benchmark::kMicrosecond);

template <class F>
double seconds(const F& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();

  std::printf("\n%-8s %14s %14s %8s   %s\n", "springs", "orbit [us]", "CVODE [us]", "ratio",
              "largest error of lift and power (orbit, CVODE)");
  for (const bool springs : {false, true}) {
    // Interleaved, the best of each: a busy machine slows both alike.
    double best_orbit = 1e9, best_cvode = 1e9;
    for (int round = 0; round < 30; ++round) {
      constexpr int orbits = 40;
      best_orbit = std::min(best_orbit, seconds([&] {
                                          for (int n = 0; n < orbits; ++n) benchmark::DoNotOptimize(by_orbit(springs));
                                        }) / orbits);
      best_cvode = std::min(best_cvode, seconds([&] { benchmark::DoNotOptimize(by_cvode(springs)); }));
    }
    const Metrics<double> exact =
        find_steady_flapping(reference_vehicle(springs), {.tolerance = 1e-12, .stability = false}).metrics;
    const auto error = [&](const Metrics<double>& m) {
      double largest = 0.0;
      for (const Metric k : {Metric::lift_mean, Metric::power_electrical, Metric::power_friction}) {
        largest = std::max(largest, std::abs(m[k] / exact[k] - 1.0));
      }
      return largest;
    };
    std::printf("%-8s %14.1f %14.1f %8.1f   %.1e  %.1e\n", springs ? "on" : "off", 1e6 * best_orbit, 1e6 * best_cvode,
                best_cvode / best_orbit, error(by_orbit(springs)), error(by_cvode(springs)));
  }
  return 0;
}
