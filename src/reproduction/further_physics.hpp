// What physics beyond the paper's model does to its conclusions.
#pragma once

#include <string>
#include <vector>

#include "wingbeat/study/for_each.hpp"
#include "wingbeat/study/reproduction.hpp"

namespace wingbeat::reproduction {

/// A result and the limits of the domain that it exceeds.
struct FurtherRun {
  Metrics<double> metrics;
  DomainStatus domain;
  double operator[](Metric m) const { return metrics[m]; }
};

/// The paper's vehicles with more physics, by rod-force, each quantity as the paper's statements use it.
struct FurtherVariant {
  std::string name;
  std::vector<std::string> settings;  ///< of the vehicle file, KEY=VALUE
  FurtherRun off, on, no_friction;    ///< at the frequency, without and with springs, without friction or springs
  FurtherRun off_at_voltage, on_at_voltage;  ///< at the voltage of the cycles
  FurtherRun on_at_max_voltage;              ///< with springs at the highest voltage

  double without_friction() const;  ///< relative change of the electrical input when friction is left out [1]
  double saved() const;             ///< relative change of the electrical input by springs [1]
  double lift_gain() const;         ///< relative change of the mean lift by springs at the voltage [1]
  double lift_to_weight() const;    ///< with springs at the highest voltage [1]
  double efficiency_gain() const;   ///< of the system by springs [1]
};

/// The paper's model first. The result does not depend on for_each.
std::vector<FurtherVariant> further_physics(const SpringPair& pair, const ReproductionOptions& options,
                                            const ForEach& for_each);

}  // namespace wingbeat::reproduction
