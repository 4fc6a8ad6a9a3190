// Exact derivatives of the metrics of very many designs.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/steady_options.hpp"
#include "wingbeat/study/for_each.hpp"

namespace wingbeat {

struct DesignParameter;
struct Sweep;

/// Derivatives of metrics by parameters, of these designs of a sweep: numbers [design][metric][parameter], SI per SI
/// unit of the parameter. The flapping frequency is held where the sweep holds it, otherwise the voltage. All are
/// absent of a design that does not flap or is out of its range, and of a metric that has no derivative. Each orbit is
/// found by the scalar solver to the sweep's tolerance. `done`, if given, is called with the share of the designs that
/// is finished, 0 to 1, by one thread at a time. Throws ParameterError for a parameter without a value in a design.
std::vector<double> sweep_gradients(const Sweep& sweep, std::span<const std::uint64_t> designs,
                                    std::span<const Metric> metrics, std::span<const DesignParameter> parameters,
                                    const StartUp& start_up, const ForEach& for_each = {},
                                    const std::function<void(double)>& done = {});

}  // namespace wingbeat
