// The steady flapping of a vehicle file, by the library: example_steady_flapping data/designs/friction2022.toml
#include <cstdio>
#include <exception>

#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

int main(int argc, char** argv) try {
  using wingbeat::Metric;
  const auto design = wingbeat::read_design(argc > 1 ? argv[1] : "data/designs/friction2022.toml");
  const auto vehicle = wingbeat::resolve(design);

  const wingbeat::SteadyOptions options{.tolerance = 1e-9, .reporting = wingbeat::reporting_of(design)};
  const auto found = wingbeat::find_steady_flapping(vehicle, options, wingbeat::start_up_in_time());
  std::printf("%s: %s\n", wingbeat::name_of(found.status), describe(found.evidence).c_str());
  if (found.status != wingbeat::FlappingStatus::flapping) return 3;

  for (const Metric m : {Metric::frequency, Metric::power_electrical, Metric::lift_mean, Metric::rod_force_peak}) {
    const wingbeat::MetricInfo& info = wingbeat::metric_table()[std::size_t(m)];
    std::printf("%-32s %12.6g %s\n", info.long_name, found.metrics[m], info.unit);
  }
  // The cycle at any crank angle, to the accuracy of the orbit.
  std::printf("rod force at crank angle 1 rad: %.6g N\n", found.record.at(1.0).rod_force);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
