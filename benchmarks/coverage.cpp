// How often the truth lies inside the 95 % intervals of `wingbeat fit`: synthetic experiments made by the transient
// solver from the vehicle of the 2022 friction paper, three conditions, 12 frequencies each, fixed seeds.
//   benchmarks/coverage [EXPERIMENTS]     200 unless given
// Exit status 1 if a parameter's share lies outside 90 to 99 %. Ends with the time of a small fit from a cold start.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "study/synthetic_bench.hpp"
#include "vehicle/reference_vehicle.hpp"

using namespace wingbeat;

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  const int experiments = argc > 1 ? std::atoi(argv[1]) : 200;
  const Design<double> truth = reference_design();
  const std::vector<double> voltages = spaced_voltages(1.5, 4.25, 12);
  const std::vector<BenchLog> exact = {
      bench_log(truth, Condition::air, false, voltages,
                {Metric::frequency, Metric::current_mean, Metric::current_peak, Metric::lift_mean}),
      bench_log(truth, Condition::vacuum, false, voltages,
                {Metric::frequency, Metric::current_mean, Metric::current_peak}),
      bench_log(truth, Condition::wingless, false, voltages, {Metric::frequency, Metric::current_mean})};
  bool good = true;
  for (const double noise : {0.01, 0.02}) {
    BenchFit fit;
    fit.design = truth;
    fit.profiles = false;
    fit.tolerance = 1e-6;
    fit.parameters = {free_parameter("friction.radius", 0.0, 8e-3, 1e-3),
                      free_parameter("aerodynamics.pitch_coefficient", 1e-3, 1e-2, 3e-3),
                      free_parameter("motor.inertia", 1e-8, 1e-6, 3e-7),
                      free_parameter("motor.viscous_damping", 0.0, 2e-5, 8e-6),
                      free_parameter("wing.planform.s2", 5e-7, 1e-5, 1.5e-6),
                      free_parameter("wing.planform.s3", 2e-8, 5e-7, 2e-7)};
    std::vector<int> inside(fit.parameters.size());
    std::vector<double> squares(fit.parameters.size()), errors(fit.parameters.size());
    int converged = 0;
    const auto start = std::chrono::steady_clock::now();
    for (int n = 0; n < experiments; ++n) {
      std::mt19937_64 random(std::uint64_t(1000 + n));
      fit.logs.clear();
      for (const BenchLog& log : exact) fit.logs.push_back(with_noise(log, noise, random));
      set_deviations(fit, noise);
      const FitResult r = fit_bench(fit);
      converged += r.converged;
      for (std::size_t k = 0; k < inside.size(); ++k) {
        const FittedParameter& p = r.parameters[k];
        const double value = *fit.parameters[k].parameter.value(truth);
        inside[k] += p.value && value >= p.lower_95 && value <= p.upper_95;
        squares[k] += std::pow((p.kept - value) / value, 2);
        errors[k] += p.standard_error / value;
      }
    }
    std::printf("noise %.0f %%: %d experiments, %d converged, %.2f s each\n", 100.0 * noise, experiments, converged,
                seconds_since(start) / experiments);
    std::printf("  %-32s %22s %12s %20s\n", "parameter", "truth in 95 % interval", "rms error", "mean standard error");
    for (std::size_t k = 0; k < inside.size(); ++k) {
      const double share = 100.0 * inside[k] / experiments;
      good = good && share >= 90.0 && share <= 99.0;
      std::printf("  %-32s %20.1f %% %10.2f %% %18.2f %%\n", fit.parameters[k].parameter.key.c_str(), share,
                  100.0 * std::sqrt(squares[k] / experiments), 100.0 * errors[k] / experiments);
    }
  }

  for (const Given given : {Given::voltage, Given::frequency}) {
    BenchFit fit;
    fit.design = truth;
    fit.profiles = false;
    std::mt19937_64 random(1);
    const Metric follows = given == Given::voltage ? Metric::frequency : Metric::voltage;
    for (const Condition condition : {Condition::air, Condition::vacuum, Condition::wingless}) {
      fit.logs.push_back(with_noise(
          bench_log(truth, condition, false, voltages, {follows, Metric::current_mean}, given), 0.01, random));
    }
    set_deviations(fit, 0.01);
    fit.parameters = {free_parameter("friction.radius", 0.0, 8e-3, 1e-3),
                      free_parameter("aerodynamics.pitch_coefficient", 1e-3, 1e-2, 3e-3),
                      free_parameter("motor.viscous_damping", 0.0, 2e-5, 8e-6)};
    double least = 1e9;
    for (int repeat = 0; repeat < 5; ++repeat) {
      const auto start = std::chrono::steady_clock::now();
      fit_bench(fit);
      least = std::min(least, seconds_since(start));
    }
    std::printf("3 parameters, 36 rows, %s set, from a cold start: %.3f s\n",
                given == Given::voltage ? "voltage" : "frequency", least);
  }
  return good ? 0 : 1;
}
