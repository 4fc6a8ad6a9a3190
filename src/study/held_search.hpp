// The search for the voltage at which one of many vehicles has a frequency, a lift or a power.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "study/lift_peak.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {

/// The search for one member's voltage.
struct EnsembleSearch {
  std::size_t member = 0;
  double target = 0.0;          ///< [Hz or N]
  double usual_slope = 1.0;     ///< d ln(value) / d ln(voltage) before two trials have shown it
  double usual_bend = 0.0;      ///< half the second derivative, before three have
  double low = 0.0;             ///< voltage known to be too low, or 0
  double high = 0.0;            ///< voltage known to be high enough, or 0
  std::array<Trial, 3> last{};  ///< that flap with a value > 0, the newest first
  int trials = 0;               ///< in `last`
  double next = 0.0;            ///< voltage to be tried
  bool is_last = false;         ///< the next trial is expected to be the answer
  double limit = 0.0;           ///< no voltage above is tried here
  int still = 0;                ///< trials that did not flap
  int returns = 0;              ///< to lower voltages, from past the peak of the lift
  bool seeks_peak = false;      ///< of lifts that have all been too small
  double too_fast = HUGE_VAL;   ///< the lowest voltage at which the coefficients do not hold
  std::vector<Trial> lifts;     ///< where a lift is sought, all trials that flap with one > 0, by growing voltage
};

EnsembleSearch search_frequency(const Vehicle<double>& vehicle, std::size_t member, double frequency);
EnsembleSearch search_power(const Vehicle<double>& vehicle, std::size_t member, double power);
/// Begins no faster than where the coefficients hold if `in_range`.
EnsembleSearch search_lift(const Vehicle<double>& vehicle, std::size_t member, double lift, bool in_range);

/// Notes what a trial gave, of a lift in `lifts` already, and chooses the next voltage. The trial after it is expected
/// to be the answer where it should miss by less than `closeness`, relative.
void advance(EnsembleSearch& search, bool flaps, double value, int round, double closeness);

/// Notes a lift > 0 of a trial that flaps in `lifts`.
void note_lift(EnsembleSearch& search, double lift);

/// True where a little lower voltage has too small a lift, so that the answer is on the rising side of a peak.
bool rises(const EnsembleSearch& search);

/// Begins again at a voltage.
void begin_again(EnsembleSearch& search, double voltage);

/// Goes on towards the peak of lifts that are all too small; false where nothing more would show it.
bool goes_on_towards_peak(EnsembleSearch& search);

}  // namespace wingbeat::detail
