// What shows the status of a vehicle: a kind and its numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/statics.hpp"
#include "wingbeat/solve/periodic_summary.hpp"

namespace wingbeat {

struct AngleRange {
  double from, to;  ///< [rad]
};

/// Found by statics and the orbit search (find_steady_flapping) or by a simulation in time (simulate_start_up). Behind
/// each kind stand the members that belong to it; the others are absent or 0. In words: describe().
struct StatusEvidence {
  enum class Kind {
    none,  ///< nothing was computed

    // Flapping, by the orbit search
    orbit,            ///< frequency; can_lock with locks, assessed; over_rotation, other_frequency
    response,         ///< of a direct drive to its supply: frequency, stroke_amplitude; over_rotation, other_amplitude
    simulated_cycle,  ///< in place of an orbit: frequency, change (the metrics' error), repeats_after, search, direct
    // Flapping, in time
    settled_cycles,   ///< frequency, time (steady from then on), cycles, change, repeats_after, extrapolated,
                      ///< over_rotation; accuracy where they are further from their limit than asked for
    averaged_cycles,  ///< frequency, cycles, change (largest deviation of a duration from their mean), incommensurate
    settled_periods,  ///< of a direct drive: frequency, time, cycles, change, extrapolated, over_rotation; accuracy
                      ///< where it is worse than asked for, and steps where those ran out

    // Stalled, by statics
    weak_motor,        ///< torque (the stall torque) does not exceed friction_torque
    weak_supply,       ///< direct drive: frequency; torque, the largest of a period, does not exceed friction_torque
    weak_alternation,  ///< the same of a supply with an offset, torque being what it alternates by
    // Stalled, in time
    stalled_crank,   ///< torque (the stall torque) does not exceed friction_torque; angle
    held_shaft,      ///< direct drive: angle; friction_torque holds torque, all that supply and springs apply at most
    creeping_shaft,  ///< direct drive: angle, travel in the last period; torque, at most, and friction_torque
    no_voltage,      ///< direct drive: nothing moves the shaft

    // Locked, by the orbit search
    no_orbit,  ///< angle where cycles end, search; can_lock with locks
    // Locked, in time
    friction_holds,   ///< angle; friction_torque, by torque_margin more than motor and springs apply
    springs_balance,  ///< angle; torque (the stall torque)
    swings,           ///< with a varying supply, within `range`

    // Jammed, by statics
    lever_may_vanish,    ///< lever, the least, at angle
    inertia_may_vanish,  ///< inertia, the least, at angle
    // Jammed, in time
    lever_vanishes,    ///< lever at angle
    inertia_vanishes,  ///< inertia at angle

    // Undecided, by the orbit search
    unstable_orbit,     ///< frequency, multiplier
    unstable_response,  ///< of a direct drive: multiplier
    no_response,        ///< of a direct drive: search
    open_balance,  ///< change: of the input, what the energy balance of the cycle found leaves open; search or direct
    no_steady_temperature,  ///< winding_temperature, the last of a search around cycles that flap
    no_steady_air,          ///< induced_velocity, the last of a search around cycles that flap
    no_cycle,  ///< it rotates in time, but neither an orbit (search, direct) nor a simulated cycle was found
    // Undecided, in time; a crank also has `range` of its angles, or the frequency where it revolves; `search` where an
    // orbit was sought before
    out_of_steps,            ///< steps, as many as allowed
    out_of_time,             ///< time allowed
    cycles_differ,           ///< change from one to the next after `cycles`, as many as allowed; direct
    cancelled,               ///< from outside
    runs_away,               ///< crank_speed
    integrator_not_started,  ///< nothing else
    integrator_failed        ///< time, angle, direct
  };
  Kind kind = Kind::none;

  double frequency = absent;            ///< of flapping; of a direct drive's supply [Hz]
  double angle = absent;                ///< of the crank; of a direct drive the stroke angle [rad]
  double torque = absent;               ///< [N m]
  double friction_torque = absent;      ///< that friction can hold; of a stall its constant part [N m]
  double torque_margin = absent;        ///< [N m]
  double lever = absent;                ///< g of the wings [m]
  double inertia = absent;              ///< J + A (h + s mu r_e) [kg m2]
  double multiplier = absent;           ///< the largest Floquet multiplier [1]
  double stroke_amplitude = absent;     ///< [rad]
  double crank_speed = absent;          ///< omega [rad/s]
  double time = absent;                 ///< since the start [s]
  double change = absent;               ///< relative, of cycles [1]
  double accuracy = absent;             ///< of the metrics, relative [1]
  double travel = absent;               ///< [rad]
  double induced_velocity = absent;     ///< [m/s]
  double winding_temperature = absent;  ///< [degC]; where it stands in the way, of the motor that flaps while colder
  double over_rotation = absent;        ///< of wings that pitch: share of the period with alpha beyond 90 degrees [1]
  double other_amplitude = absent;      ///< stroke amplitude of a second stable response to the same supply [rad]
  double other_frequency = absent;      ///< of a second stable orbit of a crank whose wings pitch [Hz]
  double faster_orbit = absent;  ///< in time, not flapping: frequency of an orbit that only a faster start reaches [Hz]
  long steps = 0;                ///< of the integrator
  int cycles = 0;                ///< periods of a direct drive's supply
  int repeats_after = 1;         ///< cycles after which the motion repeats
  std::optional<AngleRange> range = {};  ///< of the crank angle, not wrapped [rad]
  std::vector<LockInterval> locks = {};  ///< where the crank locks, too, once it has stopped
  solver::PeriodicStatus search = solver::PeriodicStatus::not_tried;  ///< how the search for an orbit ended
  bool can_lock = false;                                              ///< at `locks`
  bool assessed = false;        ///< start-up was asked, or would have been asked in doubt
  bool extrapolated = false;    ///< the cycles converge slowly, their limit was extrapolated
  bool incommensurate = false;  ///< cycles and supply share no period
  bool direct = false;          ///< a direct drive: the orbit was sought in the phase of the supply
};

/// One sentence without a full stop: "rests at crank angle 71.2904 deg: friction holds ...".
std::string describe(const StatusEvidence& evidence);

}  // namespace wingbeat
