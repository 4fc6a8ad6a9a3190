// How long a battery flies a vehicle: quasi-static discharge through steady flapping.
//
// At every state of charge s the vehicle flaps steadily, for flapping settles within milliseconds to seconds and the
// battery empties over minutes. Then Q ds/dt = -mean(i)(s), with the charge Q of a full battery, so time is a
// quadrature over charge: t = integral of Q / mean(i) ds, and with it the energies. The crank starts from rest at the
// first charge; from then on it turns, and flight goes on while a rotating orbit exists. A motor that heats up has
// settled at every charge, or, where its time constants are given, warms up from its surroundings: two more states,
// d(T_w - T_case)/dt and dT_case/dt, beside the charge.
//
// A speed control passes the battery's power on by its duty D: the motor sees D (E - R_i D i), the battery the mean
// current D i. Throttle::hover sets the duty, or the amplitude of a bridge, so that the mean lift carries the weight at
// every charge, and the flight ends where the largest no longer does.
//
// A bridge between battery and motor loses nothing and holds its amplitude: the battery gives the mean electrical power
// P_e of a cycle at the direct current that its terminal voltage asks for, (E - R_i I) I = P_e.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/study/flight_metrics.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

struct EnduranceOptions {
  Condition condition = Condition::air;
  double tolerance = 1e-9;           ///< wanted relative accuracy of times and energies, 1e-10 to 1e-2
  bool allow_extrapolation = false;  ///< a vehicle outside the model's domain may hover
  /// Least number of rows between the first and the last charge; those of a discharge curve of at most as many are
  /// added.
  int intervals = 64;
  bool climb_margin = true;  ///< of a throttled flight: what each row has at full duty, for an orbit each
};

enum class EnduranceEnd {
  never_starts,  ///< does not flap from rest at the first charge
  empty,         ///< no charge is left
  cutoff,        ///< the mean terminal voltage has fallen to the cut-off voltage
  bridge,        ///< the terminal voltage under load has fallen to the amplitude of the bridge's sine
  sinks,         ///< Throttle::hover: even a duty of 1 no longer carries the weight
  stops          ///< no rotating orbit is left
};

enum class Hover {
  unknown,  ///< the vehicle has no mass
  never,    ///< lift is below the weight from the start
  outside,  ///< lift exceeds the weight at the start, but outside the model's domain
  lost,     ///< lift falls below the weight, or the domain is left, on the way
  kept      ///< lift exceeds the weight to the end
};

/// The vehicle at one moment of the discharge.
struct EnduranceRow {
  double time = 0.0;                  ///< since the start [s]
  double charge = 0.0;                ///< state of charge [1]
  double open_circuit_voltage = 0.0;  ///< of the whole battery [V]
  double energy_electrical = 0.0;     ///< delivered at the terminals since the start [J]
  double energy_internal = 0.0;       ///< lost in the internal resistance since the start [J]
  double energy_aerodynamic = 0.0;    ///< given to the air since the start [J]
  double lift_impulse = 0.0;          ///< time integral of the mean lift since the start [N s]
  Metrics<double> metrics;            ///< of steady flapping at this charge
  DomainStatus domain = {};           ///< limits of the model that are exceeded there
  double terminal_voltage = absent;   ///< mean at the battery's terminals [V]
  double battery_current = absent;    ///< mean from the battery [A]
  double duty = absent;               ///< of the speed control [1]; absent behind a bridge
  double amplitude = absent;          ///< Throttle::hover behind a bridge: of its sine [V]
  /// Lift over weight at a duty of 1, at this charge and these temperatures of the motor; absent without
  /// Throttle::hover, behind a bridge and where it would not flap.
  double full_lift_to_weight = absent;
  DomainStatus full_domain = {};  ///< limits of the model that are exceeded there
};

/// In words: describe() of report/describe.hpp.
struct EnduranceResult {
  EnduranceEnd end = EnduranceEnd::never_starts;
  FlappingStatus status = FlappingStatus::stalled;  ///< at the first charge
  StatusEvidence evidence;                          ///< what shows it
  double first_charge = absent;                     ///< state of charge at the start [1]
  double first_voltage = absent;                    ///< open-circuit voltage of the whole battery there [V]
  std::optional<double> cutoff_voltage;             ///< of the whole battery [V]
  Throttle throttle = Throttle::fixed;
  double first_full_lift_to_weight = absent;  ///< Throttle::hover: at full throttle and the first charge
  Hover hover = Hover::unknown;
  std::optional<EnduranceRow> hover_lost;  ///< the moment of Hover::lost: lift equals weight, or the domain is left
  std::vector<EnduranceRow> rows;          ///< from the first to the last charge; empty if it never starts
  double capacity = 0.0;                   ///< Q [C]
  int evaluations = 0;                     ///< orbits computed

  /// Time to the end [s]; 0 if it never starts.
  double endurance() const { return rows.empty() ? 0.0 : rows.back().time; }
  /// Time for which it hovers from the start on [s]; absent without a mass.
  double hover_time() const {
    if (hover == Hover::unknown) return absent;
    return hover == Hover::kept ? endurance() : hover_lost ? hover_lost->time : 0.0;
  }
};

/// Flies the design's battery from its charge until it is empty, at its cut-off voltage, no longer turns the crank, or,
/// with Throttle::hover, no longer carries the weight.
/// Throws ParameterError for a supply that is no battery and for options out of range. With the mean current
/// \f$\overline{i}(s)\f$ of steady flapping at the charge s, from \f$s_0\f$ at the start (behind a bridge the direct
/// current I that the mean power asks for, \f$(n E - n R_\mathrm{i} I)\, I = P_\mathrm{e}\f$):
/// \f[
/// Q \frac{\mathrm{d}s}{\mathrm{d}t} = -\overline{i}(s), \qquad t(s) = \int_s^{s_0} \frac{Q}{\overline{i}}\,\mathrm{d}s
/// \f]
/// With thermal time constants the motor warms up on the way (model.md section 11):
/// \f[
/// \begin{aligned}
/// \tau_\mathrm{w} \frac{\mathrm{d}(T_\mathrm{w} - T_\mathrm{case})}{\mathrm{d}t}
/// &= R_\mathrm{th1} P_\mathrm{cu} - (T_\mathrm{w} - T_\mathrm{case}) \cr
/// \tau_\mathrm{c} \frac{\mathrm{d}T_\mathrm{case}}{\mathrm{d}t}
/// &= T_\mathrm{amb} + R_\mathrm{th2} (P_\mathrm{cu} + P_\mathrm{visc} + P_\mathrm{motor}) - T_\mathrm{case}
/// \end{aligned}
/// \f]
EnduranceResult simulate_discharge(const Design<double>& design, const EnduranceOptions& options = {});

/// Metric::hover and Metric::endurance of a design on a battery.
struct Endurance {
  double hover = absent;  ///< EnduranceResult::hover_time() [s]
  double time = absent;   ///< EnduranceResult::endurance() [s]
  /// Derivatives, SI; absent where there are none, as where the vehicle never starts or does not hover.
  std::vector<double> hover_by_parameter, by_parameter;
};

/// What is wanted of a flight to a relative `tolerance`, for some fifty orbits, and its derivatives: exact, for eleven
/// orbits with gradients each, where the battery is emptied to its cut-off or to the end and where lift falls below the
/// weight, also at the throttle that carries it; by central differences where no orbit is left before that, where hover
/// ends by leaving the domain, where the motor's temperatures are states of the flight, at a stated duty below 1 and
/// behind a bridge. Throws as simulate_discharge().
Endurance endurance_of(const Design<double>& design, Condition condition, double tolerance,
                       std::span<const DesignParameter> parameters = {}, FlightMetrics wanted = {true, true, false});

}  // namespace wingbeat
