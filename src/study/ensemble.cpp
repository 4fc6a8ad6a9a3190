#include "wingbeat/study/ensemble.hpp"

#include "wingbeat/core/status.hpp"

namespace wingbeat {

bool is_available(InstructionSet isa) {
  switch (isa) {
    case InstructionSet::sse2: return true;
    case InstructionSet::avx2: return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw");
  }
  return false;
}

InstructionSet best_instruction_set() {
  InstructionSet best = InstructionSet::sse2;
  for (const auto& [name, isa] : instruction_sets) {
    if (is_available(isa)) best = isa;
  }
  return best;
}

void solve_ensemble(std::span<const EnsembleMember> members, const EnsembleOptions& options, const StartUp& start_up,
                    std::span<EnsembleOutcome> outcomes) {
  require(options.tolerance >= 1e-12 && options.tolerance <= 1e-2, "tolerance", "must lie between 1e-12 and 1e-2", "1",
          options.tolerance);
  if (!is_available(options.isa)) throw ParameterError("isa", "this processor lacks the instruction set");
  for (std::size_t n = 0; n < members.size(); ++n) {
    SteadyOptions steady;
    steady.tolerance = options.tolerance;
    steady.stability = options.metrics[std::size_t(Metric::floquet_multiplier_max)];
    steady.reporting = members[n].reporting;
    const SteadyFlapping found = find_steady_flapping(members[n].vehicle, steady, start_up);
    EnsembleOutcome& out = outcomes[n];
    out.status = found.status;
    out.scalar = true;
    out.metrics = found.metrics;
    out.error_estimate = found.status == FlappingStatus::flapping ? options.tolerance : absent;
    for (int m = 0; m < metric_count; ++m) {
      if (!options.metrics[std::size_t(m)]) out.metrics.values[std::size_t(m)] = absent;
    }
  }
}

}  // namespace wingbeat
