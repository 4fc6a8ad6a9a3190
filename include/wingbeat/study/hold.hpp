// What a study finds the voltage of each design for.
#pragma once

#include <cmath>

#include "wingbeat/cycle/held.hpp"
#include "wingbeat/parts/supply.hpp"
#include "wingbeat/study/frequency_search.hpp"

namespace wingbeat {

struct Hold {
  Held held = Held::frequency;                    ///< not the voltage, which needs no search
  double value = absent;                          ///< > 0 [Hz, N, 1 or W]
  SearchRange range = SearchRange::coefficients;  ///< of a lift alone; with it the others are sought everywhere
  double highest_voltage = HUGE_VAL;              ///< that the supply can give [V]
};

/// Of studies, which assess the other limits of the domain design by design.
constexpr SearchRange search_range(bool allow_extrapolation) {
  return allow_extrapolation ? SearchRange::extrapolation : SearchRange::coefficients;
}

/// A mean lift [N] to be held, whichever of the two it was given as; NaN for the others, and without a mass.
double held_lift(const Hold& hold, const Reporting& reporting);

/// What a search begins with: of a battery, a duty of 1.
void set_full_duty(Supply<double>& supply);

/// The highest mean voltage, or amplitude, that a search may ask of a supply: a battery's without load [V]; infinite of
/// the others, which are what is sought.
double highest_voltage(const Supply<double>& supply);

/// The supply that gives the mean voltage, or amplitude, that a search has found [V]: a battery by its duty.
void set_voltage(Supply<double>& supply, double voltage);

/// find_voltage_for_frequency, _for_power or _for_lift; the vehicle's voltage counts as its usual one.
FrequencySearch find_voltage(const Vehicle<double>& vehicle, const Hold& hold, const SteadyOptions& options,
                             const StartUp& start_up);

}  // namespace wingbeat
