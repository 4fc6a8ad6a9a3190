// What of the air settles around the orbit: the induced velocity that the mean lift leads to and, of a direct drive
// whose wings clap, the stroke angle at which they reverse. An outer fixed point as that of a motor's temperatures
// (cycle/thermal_equilibrium.hpp), for the scalar solver, the batched one and simulation in time alike; model.md
// section 17.
#pragma once

#include <optional>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/status_evidence.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

struct SettledAir {
  double induced_velocity = 0.0;  ///< v_i [m/s]
  double reversal;                ///< largest stroke angle of a direct drive [rad]; minus infinity: it does not clap
};

/// True of a vehicle around whose orbit something of the air settles.
bool settles_air(const Vehicle<double>& vehicle);

/// What a cycle of these metrics leads to.
SettledAir air_of(const Metrics<double>& metrics);

/// The vehicle in that air.
Vehicle<double> in_air(Vehicle<double> vehicle, const SettledAir& air);

/// The vehicle in the air that settles around its steady flapping, for what computes none of its own: simulation in
/// time by the caller, equations of motion. In air at rest where it does not flap.
Vehicle<double> in_settled_air(const Vehicle<double>& vehicle);

/// How a search for the air ended.
enum class AirOutcome {
  searching,
  settled,         ///< the orbit leads to the air that it was found in, to the tolerance
  does_not_flap,   ///< not even in air at rest
  does_not_settle  ///< the orbits lead to one air after the other, or to one in which the vehicle no longer flaps
};

/// Solves for the air x = G(x), where G is what steady flapping in the air x leads to. Whoever solves the vehicle does
/// so at(), tells advance() what came out, and goes on until that says that the search is over: secants (of two numbers
/// Anderson's mixing with one step of memory), from air at rest on.
class AirEquilibrium {
 public:
  /// `tolerance`: wanted relative accuracy of what settles.
  AirEquilibrium(const Vehicle<double>& vehicle, double tolerance);

  /// Where the vehicle is to be solved next; after the search, where it was solved last.
  const SettledAir& at() const { return at_; }
  /// True when the search is over.
  bool advance(bool flaps, const Metrics<double>& metrics);
  AirOutcome outcome() const { return outcome_; }

 private:
  struct Trial {
    SettledAir assumed, resulting;
  };
  bool end(AirOutcome outcome) {
    outcome_ = outcome;
    return true;
  }

  bool has_wake_, reverses_;
  double closeness_;
  SettledAir at_;
  std::optional<Trial> before_;
  int solutions_ = 0;
  AirOutcome outcome_ = AirOutcome::searching;
};

/// Says in `status` and `evidence` of the last solution how its search ended. False where nothing settles: whether the
/// vehicle flaps is then undecided.
bool conclude(const AirEquilibrium& search, FlappingStatus& status, StatusEvidence& evidence);

namespace detail {

/// find_steady_flapping() with the motor's constants as the vehicle has them, whatever it heats up to.
SteadyFlapping find_flapping_at_given_temperature(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                                  const StartUp& start_up);

}  // namespace detail

}  // namespace wingbeat
