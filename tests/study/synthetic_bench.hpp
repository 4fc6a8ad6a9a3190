// Bench measurements of a known vehicle: the transient solver's cycles with noise, for tests and the coverage study.
#pragma once

#include <random>
#include <stdexcept>
#include <vector>

#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/bench_fit.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {

inline MeasuredQuantity measured(Metric metric) { return {false, metric, {}}; }

/// Exact logs of one condition at the voltages, by start-up simulated in time.
inline BenchLog bench_log(Design<double> design, Condition condition, bool springs, const std::vector<double>& voltages,
                          const std::vector<Metric>& metrics, Given given = Given::voltage) {
  BenchLog log;
  log.file = condition_name(condition, springs);
  log.condition = condition;
  log.springs = springs;
  log.given = given;
  for (const Metric m : metrics) log.columns.push_back(measured(m));
  if (!springs) design.spring = {};
  for (const double v : voltages) {
    design.supply.voltage = v;
    RunOptions options;
    options.condition = condition;
    options.method = Method::transient;
    options.tolerance = 1e-8;
    const RunResult run = run_design(design, options);
    if (run.status != FlappingStatus::flapping) throw std::runtime_error("does not flap: " + describe(run));
    BenchRow row{int(log.rows.size()) + 2, given == Given::voltage ? v : run.metrics[Metric::frequency], 0.0, {}};
    for (const Metric m : metrics) row.values.push_back(run.metrics[m]);
    log.rows.push_back(row);
  }
  return log;
}

/// A log with normal noise, relative to each value.
inline BenchLog with_noise(BenchLog log, double relative, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  for (BenchRow& row : log.rows) {
    for (double& x : row.values) x *= 1.0 + relative * normal(random);
  }
  return log;
}

inline std::vector<double> spaced_voltages(double from, double to, int count) {
  std::vector<double> v;
  for (int n = 0; n < count; ++n) v.push_back(from + (to - from) * n / (count - 1));
  return v;
}

inline FreeParameter free_parameter(const char* key, double lower, double upper, double start) {
  return {design_parameter(key), lower, upper, start};
}

/// Every measured quantity of the logs with the same relative deviation.
inline void set_deviations(BenchFit& fit, double relative) {
  for (const BenchLog& log : fit.logs) {
    for (const MeasuredQuantity& q : log.columns) fit.deviations[q] = {Deviation::Kind::relative, relative};
  }
}

}  // namespace wingbeat
