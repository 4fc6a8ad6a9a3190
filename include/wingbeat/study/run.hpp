// One vehicle in, its steady flapping out, by either method: what `wingbeat run` and every study on top of it need.
#pragma once

#include <optional>
#include <vector>

#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/cycle/status_evidence.hpp"
#include "wingbeat/cycle/waveform_row.hpp"
#include "wingbeat/solve/periodic_summary.hpp"
#include "wingbeat/study/frequency_search.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

enum class Method {
  orbit,     ///< periodic orbit in crank angle, or in the phase of a direct drive's supply
  transient  ///< simulated from rest until steady
};
template <>
inline constexpr std::pair<const char*, Method> names_of<Method>[] = {{"orbit", Method::orbit},
                                                                      {"transient", Method::transient}};

struct RunOptions {
  Condition condition = Condition::air;
  Method method = Method::orbit;
  double tolerance = 1e-6;  ///< wanted relative accuracy of every metric, 1e-12 to 1e-2
  /// [Hz]; given: the supply's voltage is replaced by the one that yields it, or a direct drive's supply has this
  /// frequency
  std::optional<double> frequency = {};
  /// [N]; given instead of the frequency: the same for the mean lift, which a pwm supply reaches by its duty. On a
  /// battery both are reached by the duty.
  std::optional<double> lift = {};
  std::optional<double> power = {};  ///< [W]; given instead of both: the same for the mean electrical power
  /// [rad], > 0, < pi/2; given: C_alpha is replaced by the one that leads to this least angle of attack of the cycle,
  /// which the wings have at mid-stroke. It goes before the angle that a design states, for which C_alpha is found,
  /// too.
  std::optional<double> angle_of_attack = {};
  bool allow_extrapolation = false;  ///< a search for a frequency, a lift or a power may leave the model's domain
  int waveform_rows = 0;             ///< instants of one cycle to return, both ends included; 0: none
  bool endurance = false;            ///< of a vehicle on a battery: Metric::hover and Metric::endurance, too
};

/// In words: describe() of report/describe.hpp.
struct RunResult {
  FlappingStatus status = FlappingStatus::stalled;
  StatusEvidence evidence;  ///< what shows the status, unless `search` says why nothing was computed
  /// False: no steady state was shown within the solvers' limits; the status is undecided, or the metrics are averages
  /// over cycles that still differ.
  bool settled = true;
  bool simulated_cycle = false;  ///< Method::orbit found flapping in time only: the metrics are the simulated cycle's
  Metrics<double> metrics;       ///< all absent unless flapping
  DomainStatus domain;           ///< limits of the model that the cycle exceeds; none unless flapping
  std::vector<DomainEvidence> domain_evidence;  ///< the same with numbers
  std::optional<double> residual_share;         ///< notable_residual(), of a vehicle that flaps
  std::optional<double> added_mass_lift;        ///< notable_added_mass_lift(), of a vehicle that flaps
  std::optional<double> hot_winding;            ///< hot_winding(), of a vehicle that flaps [degC]
  std::vector<WaveformRow> cycle;
  solver::PeriodicSummary orbit;            ///< of Method::orbit
  std::optional<TransientResult> start_up;  ///< of Method::transient
  std::optional<FrequencySearch> search;    ///< where a frequency or a lift was asked for
  std::optional<double> pitch_coefficient;  ///< C_alpha that was found for an angle of attack [s]
  std::optional<double> mean_voltage;       ///< of a pwm supply, which Method::orbit took for constant [V]
  Design<double> design;                    ///< as computed: with the voltage or duty and the C_alpha found
};

/// Computes one validated design. Throws ParameterError for a crank on a sine supply where Method::orbit, a frequency
/// or a lift is asked for (it has no periodic orbit in crank angle), for a duty of pwm above 1, for options out of
/// range, and for an angle of attack that no C_alpha leads to.
RunResult run_design(const Design<double>& design, const RunOptions& options = {});

}  // namespace wingbeat
