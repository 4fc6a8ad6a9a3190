// rod-force beside virtual-work on the vehicle of the 2022 friction paper: the table of docs/formulations.md.
//   example_formulations data/designs/friction2022.toml data/designs/friction2022-springs.toml
//
// The chord moments S_2 and S_3 are not published. The first two columns take those of the vehicle files, the last two
// calibrate them for each formulation to the same two published values: the frequency at 3 V and the peak lift at 22
// Hz, both without springs.
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"

namespace {

using namespace wingbeat;

using Pair = std::array<double, 2>;  // S_2 [m4], S_3 [m5]

constexpr double published_frequency = 21.7;     // at 3 V, springs off [Hz]
constexpr double published_lift_peak = 18.3e-3;  // at 22 Hz, springs off [N]

/// The vehicle without and with springs, in one formulation with the chord moments (S_2, S_3).
struct Vehicles {
  std::array<Design<double>, 2> designs;

  Vehicles with(Formulation formulation, const Pair& moments) const {
    Vehicles v = *this;
    for (Design<double>& d : v.designs) {
      d.transmission.formulation = formulation;
      d.wing.planform.s2 = moments[0];
      d.wing.planform.s3 = moments[1];
    }
    return v;
  }

  std::array<Metrics<double>, 2> at(std::optional<double> frequency) const {
    std::array<Metrics<double>, 2> metrics;
    for (std::size_t n = 0; n < 2; ++n) {
      const RunResult r = run_design(designs[n], {.tolerance = 1e-10, .frequency = frequency});
      if (r.status != FlappingStatus::flapping) throw std::runtime_error(describe(r));
      metrics[n] = r.metrics;
    }
    return metrics;
  }
};

/// Moments that give the published values. The motion depends on S_3 alone, more of it slows the wings; lift is
/// proportional to S_2.
Pair calibrated(const Vehicles& vehicles, Formulation formulation, const Pair& given) {
  double low = 0.1 * given[1], high = 10.0 * given[1];
  while (high - low > 1e-9 * high) {
    const double mid = std::sqrt(low * high);
    const auto metrics = vehicles.with(formulation, {given[0], mid}).at(std::nullopt);
    (metrics[0][Metric::frequency] > published_frequency ? low : high) = mid;
  }
  const auto metrics = vehicles.with(formulation, {given[0], high}).at(22.0);
  return {given[0] * published_lift_peak / metrics[0][Metric::lift_peak], high};
}

}  // namespace

int main(int argc, char** argv) try {
  const Vehicles vehicles{{read_design(argc > 2 ? argv[1] : "data/designs/friction2022.toml"),
                           read_design(argc > 2 ? argv[2] : "data/designs/friction2022-springs.toml")}};
  const auto& planform = vehicles.designs[0].wing.planform;
  const Pair given = {planform.s2, planform.s3};
  const Pair rod = calibrated(vehicles, Formulation::rod_force, given);
  const Pair work = calibrated(vehicles, Formulation::virtual_work, given);
  const std::array<Vehicles, 4> columns = {
      vehicles.with(Formulation::rod_force, given), vehicles.with(Formulation::virtual_work, given),
      vehicles.with(Formulation::rod_force, rod), vehicles.with(Formulation::virtual_work, work)};

  const auto row = [](const char* what, const char* published, const std::array<double, 4>& values) {
    std::printf("| %s | %s |", what, published);
    for (const double value : values) std::printf(" %.4g |", std::abs(value) < 1e-10 ? 0.0 : value);  // rounding
    std::printf("\n");
  };
  std::array<std::array<Metrics<double>, 2>, 4> at_3V, at_22Hz;
  for (std::size_t n = 0; n < 4; ++n) {
    at_3V[n] = columns[n].at(std::nullopt);
    at_22Hz[n] = columns[n].at(22.0);
  }
  const auto each = [](const auto& metrics, const auto& value) {
    std::array<double, 4> values;
    for (std::size_t n = 0; n < 4; ++n) values[n] = value(metrics[n]);
    return values;
  };
  const auto scaled = [](Metric m, std::size_t springs, double scale) {
    return [=](const auto& metrics) { return scale * metrics[springs][m]; };
  };
  const auto ratio = [](Metric m) { return [=](const auto& metrics) { return metrics[1][m] / metrics[0][m]; }; };
  const auto residual = [](std::size_t springs) {
    return [=](const auto& metrics) {
      return 100.0 * metrics[springs][Metric::power_residual] / metrics[springs][Metric::power_motor];
    };
  };

  std::printf("| | published | rod-force | virtual-work | rod-force, recalibrated | virtual-work, recalibrated |\n");
  std::printf("| --- | --- | --- | --- | --- | --- |\n");
  row("S_2 (1e-6 m4)", "", {1e6 * given[0], 1e6 * given[0], 1e6 * rod[0], 1e6 * work[0]});
  row("S_3 (1e-7 m5)", "", {1e7 * given[1], 1e7 * given[1], 1e7 * rod[1], 1e7 * work[1]});
  row("3 V: frequency, springs off (Hz)", "21.7", each(at_3V, scaled(Metric::frequency, 0, 1.0)));
  row("3 V: frequency, springs on (Hz)", "23.3", each(at_3V, scaled(Metric::frequency, 1, 1.0)));
  row("3 V: mean lift, on / off", "1.333", each(at_3V, ratio(Metric::lift_mean)));
  row("3 V: peak flapping velocity, on / off", "1.197", each(at_3V, ratio(Metric::flapping_velocity_peak)));
  row("3 V: mean rod force, on / off", "0.67", each(at_3V, ratio(Metric::rod_force_mean)));
  row("22 Hz: peak lift, off (mN)", "18.3", each(at_22Hz, scaled(Metric::lift_peak, 0, 1e3)));
  row("22 Hz: peak lift, on (mN)", "26.0", each(at_22Hz, scaled(Metric::lift_peak, 1, 1e3)));
  row("22 Hz: peak rod force, off (mN)", "432", each(at_22Hz, scaled(Metric::rod_force_peak, 0, 1e3)));
  row("22 Hz: peak rod force, on (mN)", "315", each(at_22Hz, scaled(Metric::rod_force_peak, 1, 1e3)));
  row("22 Hz: peak flapping velocity, on / off", "1.142", each(at_22Hz, ratio(Metric::flapping_velocity_peak)));
  row("22 Hz: mean lift, on / off", "1.154", each(at_22Hz, ratio(Metric::lift_mean)));
  row("22 Hz: electrical power, on / off", "0.82", each(at_22Hz, ratio(Metric::power_electrical)));
  row("22 Hz: electrical power, off (mW)", "", each(at_22Hz, scaled(Metric::power_electrical, 0, 1e3)));
  row("22 Hz: friction, off (mW)", "", each(at_22Hz, scaled(Metric::power_friction, 0, 1e3)));
  row("22 Hz: aerodynamic power, off (mW)", "", each(at_22Hz, scaled(Metric::power_aerodynamic, 0, 1e3)));
  row("22 Hz: P_residual / P_m, off (%)", "", each(at_22Hz, residual(0)));
  row("22 Hz: P_residual / P_m, on (%)", "", each(at_22Hz, residual(1)));
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
