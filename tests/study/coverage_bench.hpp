// Many small bench fits of known truth, to see how often it lies inside their 95 % intervals.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "study/synthetic_bench.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"

namespace wingbeat {

/// What a bench file says of the deviations of current and crank speed.
enum class StatedDeviations { relative, absolute, estimated, current_estimated };
template <>
inline constexpr std::pair<const char*, StatedDeviations> names_of<StatedDeviations>[] = {
    {"relative", StatedDeviations::relative},
    {"absolute", StatedDeviations::absolute},
    {"estimated", StatedDeviations::estimated},
    {"one estimated", StatedDeviations::current_estimated}};

/// The reference vehicle without inductance, in air at 3 V: current and crank speed at 16 crank angles, so that a fit
/// of its two parameters costs one orbit at a time. Normal noise of 2 per cent.
class CoverageBench {
 public:
  static constexpr double noise = 0.02;

  CoverageBench() : design_(reference_design()) {
    design_.motor.constants.armature_inductance = 0.0;
    const SteadyFlapping orbit = find_steady_flapping(resolve(design_), {.tolerance = 1e-10});
    exact_.file = "waveform";
    exact_.waveform = true;
    exact_.columns = {current(), {true, {}, WaveformQuantity::crank_speed}};
    for (int n = 0; n < 16; ++n) {
      const double theta = two_pi * n / 16.0;
      const WaveformRow row = orbit.record.at(theta);
      exact_.rows.push_back({n + 2, 3.0, theta, {row.current, row.crank_speed}});
    }
  }

  /// `outliers`: share of values that lie another 5 to 20 deviations off, to either side.
  BenchFit fit(Loss loss, StatedDeviations deviations, double outliers, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    BenchFit fit;
    fit.design = design_;
    fit.loss = loss;
    fit.tolerance = 1e-5;
    fit.parameters = {free_parameter("friction.radius", 0.0, 8e-3, 2e-3),
                      free_parameter("aerodynamics.pitch_coefficient", 1e-3, 1e-2, 4e-3)};
    BenchLog log = exact_;
    for (std::size_t c = 0; c < log.columns.size(); ++c) {
      const double absolute = deviation(c);
      const bool relative = deviations == StatedDeviations::relative ||
                            (deviations == StatedDeviations::current_estimated && log.columns[c] != current());
      fit.deviations[log.columns[c]] = relative ? Deviation{Deviation::Kind::relative, noise}
                                       : deviations == StatedDeviations::absolute
                                           ? Deviation{Deviation::Kind::absolute, absolute}
                                           : Deviation{Deviation::Kind::estimated, 0.0};
      for (BenchRow& row : log.rows) {
        const double unit = relative ? noise * row.values[c] : absolute;
        double error = normal(random);
        const double chance = uniform(random), size = 5.0 + 15.0 * uniform(random), side = uniform(random);
        if (chance < outliers) error += side < 0.5 ? -size : size;
        row.values[c] += unit * error;
      }
    }
    fit.logs = {log};
    return fit;
  }

  /// Of the noise of a column, where it is the same for all values [SI].
  double deviation(std::size_t column) const {
    double squares = 0.0;
    for (const BenchRow& row : exact_.rows) squares += row.values[column] * row.values[column];
    return noise * std::sqrt(squares / double(exact_.rows.size()));
  }
  double truth(const FreeParameter& p) const { return *p.parameter.value(design_); }

 private:
  static MeasuredQuantity current() { return {true, {}, WaveformQuantity::current}; }

  Design<double> design_;
  BenchLog exact_;
};

}  // namespace wingbeat
