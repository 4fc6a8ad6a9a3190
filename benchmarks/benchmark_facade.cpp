// The library's own time for what benchmarks/python_cost asks of it through Python: answers a line for each line of its
// standard input, so that both can take turns.
//
//   benchmark_facade VEHICLE
//     metrics             every metric at the vehicle's voltage, as hexadecimal numbers
//     solve COUNT         seconds for each of so many calls of solve, the voltage a little different each time
//     columns COUNT       seconds for so many designs (voltage and crank radius) on all cores
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/wingbeat.hpp"

namespace {

using namespace wingbeat;

template <class F>
double seconds_of(const F& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double solves(const Design<double>& design, int count) {
  return seconds_of([&] {
           for (int n = 0; n < count; ++n) {
             Design<double> other = design;
             other.supply.voltage = 3.0 + 1e-6 * n;
             if (solve(other).status != FlappingStatus::flapping) throw std::runtime_error("does not flap");
           }
         }) /
         count;
}

double columns(const Design<double>& design, std::size_t count) {
  StudyInput input;
  input.study_name = "columns";
  input.study =
      "[study]\nvehicle = \"vehicle\"\n[[axis]]\nname = \"design\"\n"
      "keys = [\"supply.voltage\", \"transmission.crank_radius\"]\nvalues = [[3.0], [0.005]]\n";
  input.design = design;
  std::vector<double> voltages(count), radii(count);
  for (std::size_t n = 0; n < count; ++n) {
    double whole = 0.0;
    voltages[n] = 2.0 + 3.0 * double(n) / double(count);
    radii[n] = 4e-3 + 2e-3 * std::modf(0.618 * double(n), &whole);
  }
  return seconds_of([&] {
    Sweep sweep = parse_study(input).sweep;
    SweepAxis& axis = sweep.axes.at(0);
    axis.count = count;
    axis.samples = true;
    axis.quantities.at(0).values = voltages;
    axis.quantities.at(1).values = radii;
    if (solve_sweep(sweep).status.size() != count) throw std::runtime_error("designs are missing");
  });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: benchmark_facade VEHICLE\n");
    return 2;
  }
  const Design<double> design = read_design(argv[1]);
  std::string what;
  while (std::cin >> what) {
    if (what == "metrics") {
      for (const double value : solve(design).metrics.values) std::printf("%a ", value);
    } else {
      int count = 0;
      std::cin >> count;
      std::printf("%.9g", what == "solve" ? solves(design, count) : columns(design, std::size_t(count)));
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}
