// The voltage at which a vehicle flaps at a wanted frequency, or with a wanted lift.
#pragma once

#include <string>

#include "wingbeat/cycle/steady_flapping.hpp"

namespace wingbeat {

/// What came of the search for a frequency; "faster" and "slower" stand for more and less lift where that is sought.
enum class FrequencyOutcome {
  reached,
  never_flaps,  ///< at no voltage searched
  too_low,      ///< it flaps, but only faster: at the voltage that would do it stands still
  too_high,     ///< it flaps, but slower up to the highest voltage searched
  jumps         ///< the frequency jumps past the wanted one as the voltage grows
};

struct FrequencySearch {
  FrequencyOutcome outcome = FrequencyOutcome::never_flaps;
  double voltage = absent;  ///< reached: [V]
  /// Not reached: what the vehicle does at the voltage closest to the answer; flapping for too_high and jumps.
  FlappingStatus status = FlappingStatus::stalled;
  std::string detail;  ///< one sentence: what was found, or which frequencies can be reached
  int evaluations = 0;
};

/// The search covers voltages up to this multiple of the one that turns the unloaded motor at the wanted frequency.
inline constexpr double frequency_search_span = 100.0;

/// Finds the constant voltage at which the vehicle flaps at `frequency` [Hz], to within options.tolerance, by a
/// bracketed solve on find_steady_flapping; a voltage at which it does not flap counts as too low. vehicle.voltage is
/// not used. Where the frequency is no steady function of the voltage, any of the answers may come out.
/// Throws ParameterError unless frequency > 0.
FrequencySearch find_voltage_for_frequency(const Vehicle<double>& vehicle, double frequency,
                                           const SteadyOptions& options = {}, const StartUp& start_up = {});

/// The search for a lift starts at this fraction of the nominal voltage.
inline constexpr double lift_search_start = 0.1;

/// The same for a mean lift [N]. `nominal` [V] is the size of voltage to look at first: the search runs upwards from a
/// tenth of it, so that where lift peaks over the voltage, the lower of two voltages is found.
/// Throws ParameterError unless lift and nominal > 0.
FrequencySearch find_voltage_for_lift(const Vehicle<double>& vehicle, double lift, double nominal,
                                      const SteadyOptions& options = {}, const StartUp& start_up = {});

}  // namespace wingbeat
