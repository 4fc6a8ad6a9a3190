#include "wingbeat/study/sweep_gradients.hpp"

#include <algorithm>

#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/sweep.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

std::vector<double> sweep_gradients(const Sweep& sweep, std::span<const std::uint64_t> designs,
                                    std::span<const Metric> metrics, std::span<const DesignParameter> parameters,
                                    const StartUp& start_up, const ForEach& for_each,
                                    const std::function<void(double)>& done) {
  constexpr std::size_t block = 8;
  const std::size_t of_design = metrics.size() * parameters.size();
  std::vector<double> numbers(designs.size() * of_design, absent);
  const auto wants = [&](Metric m) { return std::find(metrics.begin(), metrics.end(), m) != metrics.end(); };
  const auto differentiate = [&](std::size_t n) {
    const SweepDesign row = design_at(sweep, designs[n]);
    DesignPointOptions options;
    options.condition = row.condition;
    options.hold = row.hold;
    options.tolerance = sweep.options.tolerance;
    options.peaks = std::any_of(metrics.begin(), metrics.end(),
                                [drive = drive_of(row.design)](Metric m) { return is_peak(m, drive); });
    options.flight = {wants(Metric::hover), wants(Metric::endurance), false};
    const DesignPoint point = design_point(row.design, options, parameters, start_up);
    double* number = numbers.data() + n * of_design;
    for (const Metric m : metrics) {
      for (std::size_t k = 0; k < parameters.size(); ++k) *number++ = point.gradients[k][std::size_t(m)];
    }
  };
  std::vector<std::function<void()>> tasks;
  for (std::size_t first = 0; first < designs.size(); first += block) {
    tasks.push_back([&differentiate, first, last = std::min(designs.size(), first + block)] {
      for (std::size_t n = first; n < last; ++n) differentiate(n);
    });
  }
  run_tasks(tasks, for_each, done);
  return numbers;
}

}  // namespace wingbeat
