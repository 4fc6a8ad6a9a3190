// What stands behind a CycleRecord: the periodic system and its iterate, for all that computes along the cycle.
#pragma once

#include <variant>

#include "wingbeat/cycle/cycle_system.hpp"
#include "wingbeat/cycle/record.hpp"

namespace wingbeat {

/// Integrals over a recorded cycle.
template <class System>
CycleIntegrals<double> cycle_integrals(const solver::Iterate<System>& cycle) {
  CycleIntegrals<double> sum{};
  for (const auto& step : cycle.steps) {
    for (std::size_t q = 0; q < sum.size(); ++q) sum[q] += step.dq[q];
  }
  return sum;
}

/// A system and its cycle.
template <class System>
struct RecordedCycle {
  System system;
  solver::Iterate<System> cycle;
};

/// The cycle of one of the systems: of a crank or of a direct drive, of wings under the pitch law or that pitch, with
/// or without inductance, or of any other kind.
using AnyRecordedCycle =
    std::variant<RecordedCycle<CrankSystem<double, 1>>, RecordedCycle<CrankSystem<double, 2>>,
                 RecordedCycle<DirectSystem<double, 2>>, RecordedCycle<DirectSystem<double, 3>>,
                 RecordedCycle<PitchDirectSystem<double, 4>>, RecordedCycle<PitchDirectSystem<double, 5>>,
                 RecordedCycle<PitchCrankSystem<double, 3>>, RecordedCycle<PitchCrankSystem<double, 4>>,
                 RecordedCycle<AnyCrankSystem<double>>, RecordedCycle<AnyDirectSystem<double>>>;
struct CycleRecord::Recorded {
  AnyRecordedCycle cycle;
};

/// Calls use(recorded) with the RecordedCycle of the system whose cycle it is; of an empty record with one that has no
/// steps.
template <class Use>
decltype(auto) visit(const CycleRecord& record, const Use& use) {
  return std::visit(use, record.recorded().cycle);
}

}  // namespace wingbeat
