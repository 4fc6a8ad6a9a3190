// Vehicles whose sides differ: one direct drive on either side, each with numbers of its own, on one supply.
//
// The drives share the voltage and nothing else, so that each side flaps as a vehicle of its own with one motor; what
// the whole vehicle has is the sum.
#pragma once

#include "wingbeat/study/control_models.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {

/// The sides as designs of one motor each; `whole` has what is the vehicle's alone: name, supply, mass.
struct TwoSides {
  Design<double> whole, left, right;
};

struct TwoSidesResult {
  Design<double> whole;
  RunResult left, right;
  FlappingStatus status;  ///< flapping where both sides do, else that of the side which does not, the left's first
  /// Of the whole vehicle: voltage and frequency, sums of powers, mean currents and lift, what follows from them. The
  /// others - peaks, which need not coincide, and what a wing or motor has by itself - are absent, and all where a side
  /// does not flap.
  Metrics<double> metrics;
};

/// Both sides, each as run_design() has it. Throws ParameterError for a lift or power of the whole vehicle, which no
/// side has by itself.
TwoSidesResult run_two_sides(const TwoSides& vehicle, const RunOptions& options = {});

/// What `wingbeat linearise` computes of such a vehicle.
struct TwoSidesMaps {
  TwoSidesResult operating_point;
  ControlOptions options;
  std::vector<AllocationMap> maps;  ///< none where a side has no linear model
};
TwoSidesMaps two_sides_maps(const TwoSides& vehicle, const ControlOptions& options = {});

}  // namespace wingbeat
