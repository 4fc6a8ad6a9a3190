// The steady flapping of very many vehicles: SIMD batches first, the scalar solver for what they cannot settle.
#pragma once

#include <bitset>
#include <optional>
#include <span>

#include "wingbeat/core/status.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/steady_options.hpp"
#include "wingbeat/ensemble/instruction_set.hpp"

namespace wingbeat {

/// Indexed by Metric.
using MetricSet = std::bitset<metric_count>;

/// All metrics of a cycle. Those of a flight, which cost one, are asked for by name.
inline MetricSet all_metrics() {
  return MetricSet().set().reset(std::size_t(Metric::hover)).reset(std::size_t(Metric::endurance));
}

struct EnsembleOptions {
  double tolerance = 1e-6;            ///< wanted relative accuracy of every metric, 1e-12 to 1e-2
  MetricSet metrics = all_metrics();  ///< those wanted; the others are absent. Peaks and multipliers cost extra
  InstructionSet isa = best_instruction_set();
  bool scalar_only = false;  ///< every design by the scalar solver
  bool domain = true;        ///< find out the domain status, whichever metrics are wanted
};

struct EnsembleOutcome {
  FlappingStatus status = FlappingStatus::stalled;
  bool scalar = false;             ///< computed by the scalar solver
  double error_estimate = absent;  ///< of the metrics, relative; absent unless flapping
  Metrics<double> metrics;         ///< all absent unless flapping
  DomainStatus domain = {};        ///< limits of the model that it exceeds; none unless flapping
};

/// ensemble/ensemble_member.hpp
struct EnsembleMember;

/// Solves every member into the outcome of the same index, on the calling thread. A member's outcome depends on nothing
/// but the member, the options and the instruction set: not on its neighbours, its place or the number of members.
/// `start_up` assesses, as in find_steady_flapping, what does not rotate for certain. Throws ParameterError for options
/// out of range or an instruction set this processor lacks; never on account of a vehicle.
void solve_ensemble(std::span<const EnsembleMember> members, const EnsembleOptions& options, const StartUp& start_up,
                    std::span<EnsembleOutcome> outcomes);

}  // namespace wingbeat
