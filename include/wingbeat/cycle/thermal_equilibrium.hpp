// The temperatures at which a motor settles in steady flapping: an outer fixed point around the orbit, for the scalar
// solver, the batched one and simulation in time alike; docs/model.md section 11, docs/motors.md.
#pragma once

#include <optional>

#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/parts/motor_thermal.hpp"

namespace wingbeat {

/// How a search for temperatures ended.
enum class ThermalOutcome {
  searching,
  settled,      ///< the losses lead to the temperatures that they were computed at, to the tolerance
  never_flaps,  ///< not even with the motor as warm as its surroundings
  stops,    ///< the motor heats up until the vehicle no longer flaps; solved last where the heating would lead to then
  runaway,  ///< the winding heats up still at the melting point of copper, where it was solved last
  does_not_settle
};

/// Solves for the temperatures T = G(T), where G are those that the losses of steady flapping with the motor at T lead
/// to. Whoever solves the vehicle does so at(), tells advance() what came out, and goes on until that says that the
/// search is over: secants (of two temperatures Anderson's mixing with one step of memory), from the surroundings on.
/// With the losses of the orbit at T (model.md section 11):
/// \f[
/// G(T) = \begin{pmatrix} T_\mathrm{case} + R_\mathrm{th1} P_\mathrm{cu} \\ T_\mathrm{case} \end{pmatrix}, \qquad
/// T_\mathrm{case} = T_\mathrm{amb} + R_\mathrm{th2} (P_\mathrm{cu} + P_\mathrm{visc} + P_\mathrm{motor})
/// \f]
class ThermalEquilibrium {
 public:
  /// `tolerance`: wanted relative accuracy of the motor's constants.
  ThermalEquilibrium(const MotorThermal<double>& thermal, double tolerance);

  /// Where the vehicle is to be solved next; after the search, where it was solved last [K].
  const MotorTemperatures<double>& at() const { return at_; }
  /// True when the search is over. Of a solution that does not flap, `decided` says whether that is known.
  bool advance(bool flaps, const Metrics<double>& metrics, bool decided = true);
  ThermalOutcome outcome() const { return outcome_; }
  /// ThermalOutcome::stops: winding temperature up to which the vehicle flaps [K].
  double stops_at() const { return stopped_ ? stopped_->winding : absent; }
  int solutions() const { return solutions_; }

 private:
  struct Trial {
    MotorTemperatures<double> assumed, resulting;
  };
  bool end(ThermalOutcome outcome) {
    outcome_ = outcome;
    return true;
  }
  bool towards_stop();
  double weighted(const MotorTemperatures<double>& a, const MotorTemperatures<double>& b) const;
  MotorTemperatures<double> secant(const Trial& last) const;

  MotorThermal<double> thermal_;
  double closeness_;
  MotorTemperatures<double> at_;
  std::optional<Trial> before_;                       ///< the last that flapped
  std::optional<MotorTemperatures<double>> stopped_;  ///< the coolest that did not
  std::optional<Trial> heating_, cooling_;            ///< nearest to the equilibrium on either side, by the winding
  bool at_stop_ = false;
  bool verge_is_unclear_ = false;
  int solutions_ = 0;
  ThermalOutcome outcome_ = ThermalOutcome::searching;
};

/// Says in `status` and `evidence` of the last solution how its search ended. False where there is no steady
/// temperature: what flaps there is then undecided, and its metrics are those of no steady state.
bool conclude(const ThermalEquilibrium& search, FlappingStatus& status, StatusEvidence& evidence);

/// Tolerance of each solution within such a search: its errors must not show in the temperatures.
double tolerance_within_equilibrium(double tolerance);

namespace detail {

/// find_steady_flapping() with the motor's constants and the air as the vehicle has them, whatever either settles at.
SteadyFlapping find_flapping_as_it_is(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                      const StartUp& start_up);

/// find_steady_flapping() of a vehicle whose motor heats up.
SteadyFlapping find_warm_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                  const StartUp& start_up);

}  // namespace detail

}  // namespace wingbeat
