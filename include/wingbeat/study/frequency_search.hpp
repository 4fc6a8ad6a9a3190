// The voltage at which a vehicle flaps at a wanted frequency, with a wanted lift, or on a wanted power;
// docs/targets.md.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/cycle/steady_options.hpp"

namespace wingbeat {

/// Where an answer may lie.
enum class SearchRange {
  domain,        ///< inside the domain of validity (cycle/domain.hpp)
  coefficients,  ///< where the force coefficients hold: of the domain, the angle of attack and the flow speed alone
  extrapolation  ///< also outside, down to extrapolation_angle_deg and up to extrapolation_flow_speed
};

/// Smallest angle of attack [deg] of SearchRange::extrapolation: there the coefficients have gone round twice, and
/// cycles beyond take up to seconds each.
inline constexpr double extrapolation_angle_deg = -360.0;
/// Largest speed of the wings at S_3/S_2 of SearchRange::extrapolation [m/s]: ten times the domain's.
inline constexpr double extrapolation_flow_speed = 10.0 * flow_speed_max;

/// What came of the search for a frequency; "faster" and "slower" stand for more and less of what is sought.
enum class FrequencyOutcome {
  reached,
  never_flaps,    ///< at no voltage searched
  too_low,        ///< it flaps, but only faster: at the voltage that would do it stands still
  too_high,       ///< it flaps, but slower over all of the range
  jumps,          ///< the frequency jumps past the wanted one as the voltage grows
  outside_domain  ///< it flaps, but inside the domain of validity at no voltage, or not at the one that would do
};

enum class Sought { frequency, lift, power };

/// How a search ended, in numbers; in words: describe() of report/describe.hpp. Behind each kind stand the members that
/// belong to it beside sought, target and range.
struct SearchFinding {
  enum class Kind {
    reached,             ///< evidence
    never_flaps,         ///< at no voltage up to last_voltage; there status with evidence
    no_wings_in_air,     ///< a lift without any
    out_of_range,        ///< `at` lies outside by `limits`; inside from least (of a lift) to most, if anywhere
    beyond_any_voltage,  ///< a frequency: stroke_amplitude, highest_frequency
    jumps,               ///< the value jumps past the target: from least to `at`
    too_low_at_first,    ///< at the lowest voltage tried, `at`, the value is above the target already
    too_low_at_onset,    ///< the same where it starts to flap; below, status with evidence
    too_high             ///< most; last_voltage; of a lift `limits`, where they end the search there
  };
  struct VoltagePoint {
    double voltage;  ///< [V]
    double value;    ///< of what is sought [Hz, N or W]
  };
  Kind kind = Kind::never_flaps;
  Sought sought = Sought::frequency;
  double target = absent;  ///< [Hz, N or W]
  SearchRange range = SearchRange::domain;
  std::optional<VoltagePoint> point = {}, min_point = {}, max_point = {};
  double last_voltage = absent;                     ///< highest tried [V]
  double stroke_amplitude = absent;                 ///< [rad]
  double highest_frequency = absent;                ///< [Hz]: highest_frequency()
  std::vector<DomainEvidence> limits = {};          ///< of the domain, exceeded; none in SearchRange::extrapolation
  FlappingStatus status = FlappingStatus::stalled;  ///< with `evidence`
  StatusEvidence evidence = {};
  /// Pwm supply: the mean voltage at a duty of 1 [V], if that is below the voltage closest to the answer.
  std::optional<double> full_duty_voltage = {};

  /// The answer is refused for the sake of the domain, or known for its inside alone.
  bool inside_domain_only() const;
};

struct FrequencySearch {
  FrequencyOutcome outcome = FrequencyOutcome::never_flaps;
  double voltage = absent;  ///< reached: [V]
  /// Not reached: what the vehicle does at the voltage closest to the answer; flapping for too_high, jumps and
  /// outside_domain.
  FlappingStatus status = FlappingStatus::stalled;
  SearchFinding finding;  ///< what was found, or which frequencies can be reached
  int evaluations = 0;
  /// Not reached: where the vehicle comes closest in the range, such as the peak of the lift or its onset: voltage [V]
  /// and what it reaches there [Hz, N or W]. Absent where no cycle of the range was computed.
  double closest_voltage = absent;
  double closest_value = absent;
};

/// The search for a frequency covers voltages up to this multiple of the one that turns the unloaded motor so fast, the
/// search for a lift at least as many times the one at which the unloaded motor moves the wings fast enough for it.
inline constexpr double frequency_search_span = 100.0;

/// A flapping frequency above which the vehicle is certainly out of the range, whatever its voltage [Hz]: in each cycle
/// the wings travel four stroke amplitudes, so that their peak velocity is at least that much times the frequency.
/// Infinite without air, and for a direct drive.
double highest_frequency(const Vehicle<double>& vehicle, SearchRange range);

/// The refusal of a frequency above highest_frequency(); nothing is computed for it. Its status is flapping.
FrequencySearch refuse_frequency(const Vehicle<double>& vehicle, double frequency, SearchRange range);

/// Finds the constant voltage at which the vehicle flaps at `frequency` [Hz], to within options.tolerance, by the
/// secant method in the logarithms, in a bracket; a voltage at which it does not flap counts as too low.
/// vehicle.voltage is that of a battery at a duty of 1, and else not used. No voltage above `highest_voltage` [V] is
/// tried. From rest, a crank flaps the faster the higher the voltage, so that there is one answer at most. Throws
/// ParameterError unless frequency > 0.
FrequencySearch find_voltage_for_frequency(const Vehicle<double>& vehicle, double frequency,
                                           const SteadyOptions& options = {}, const StartUp& start_up = {},
                                           SearchRange range = SearchRange::extrapolation,
                                           double highest_voltage = HUGE_VAL);

/// Finds the voltage of a mean electrical power [W] as find_voltage_for_frequency() does: it grows with the voltage as
/// well. Throws ParameterError unless power > 0.
FrequencySearch find_voltage_for_power(const Vehicle<double>& vehicle, double power, const SteadyOptions& options = {},
                                       const StartUp& start_up = {}, SearchRange range = SearchRange::extrapolation,
                                       double highest_voltage = HUGE_VAL);

struct LiftSearchOptions {
  double nominal =
      1.0;  ///< usual voltage [V], > 0: ten times as much is searched at least; a direct drive starts there
  SearchRange range = SearchRange::domain;
  double highest_voltage = HUGE_VAL;  ///< none above is tried [V]
};

/// The lowest voltage (direct drive: amplitude) at which the vehicle has the mean lift `lift` [N] in the range, to
/// within options.tolerance; vehicle.voltage is that of a battery at a duty of 1, and else not used. The lift is
/// followed upwards from where the vehicle starts to flap, or from next to none, by cubics through values and exact
/// derivatives, checked half-way, so that neither a peak nor a pair of answers hides between two voltages. A refusal
/// states the peak, or the onset if that lifts too much already. Throws ParameterError unless lift and nominal > 0.
FrequencySearch find_voltage_for_lift(const Vehicle<double>& vehicle, double lift, const SteadyOptions& options = {},
                                      const StartUp& start_up = {}, const LiftSearchOptions& where = {});

}  // namespace wingbeat
