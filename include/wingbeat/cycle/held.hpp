// What stays as it is while a parameter of a design changes.
#pragma once

#include "wingbeat/cycle/metric_values.hpp"

namespace wingbeat {

/// Other than the voltage itself: the supply's voltage follows, whatever it was given as.
enum class Held {
  voltage,
  frequency,       ///< a direct drive has it from the supply: its voltage stays
  lift,            ///< mean
  lift_to_weight,  ///< the mass of a design counts
  power            ///< mean electrical
};

constexpr bool is_lift(Held held) { return held == Held::lift || held == Held::lift_to_weight; }

/// The metric that is held.
constexpr Metric metric_of(Held held) {
  switch (held) {
    case Held::frequency: return Metric::frequency;
    case Held::lift: return Metric::lift_mean;
    case Held::lift_to_weight: return Metric::lift_to_weight;
    case Held::power: return Metric::power_electrical;
    default: return Metric::voltage;
  }
}

}  // namespace wingbeat
