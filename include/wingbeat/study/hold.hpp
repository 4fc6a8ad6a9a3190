// What a study finds the voltage of each design for.
#pragma once

#include "wingbeat/cycle/held.hpp"
#include "wingbeat/study/frequency_search.hpp"

namespace wingbeat {

struct Hold {
  Held held = Held::frequency;                    ///< not the voltage, which needs no search
  double value = absent;                          ///< > 0 [Hz, N or 1]
  SearchRange range = SearchRange::coefficients;  ///< where a lift is sought; a frequency is sought everywhere
};

/// Of studies, which assess the other limits of the domain design by design.
constexpr SearchRange search_range(bool allow_extrapolation) {
  return allow_extrapolation ? SearchRange::extrapolation : SearchRange::coefficients;
}

/// A mean lift [N] to be held, whichever of the two it was given as; NaN for a frequency, and without a mass.
double held_lift(const Hold& hold, const Reporting& reporting);

/// find_voltage_for_frequency or find_voltage_for_lift; the vehicle's voltage counts as its usual one.
FrequencySearch find_voltage(const Vehicle<double>& vehicle, const Hold& hold, const SteadyOptions& options,
                             const StartUp& start_up);

}  // namespace wingbeat
