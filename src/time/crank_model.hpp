// A crank-driven vehicle on its supply, in time: its equations, its events, and the state that goes with them; model.md
// sections 2 and 12.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/parts/supply.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"
#include "wingbeat/vehicle/pitch_motion.hpp"

namespace wingbeat::detail {

/// The unknowns are theta [rad], not wrapped, omega [rad/s] and, with an inductance, i [A]; behind them, of wings that
/// pitch, psi [rad] and psi' [rad/s].
class CrankModel {
 public:
  /// Everything that moves: copied to save it, assigned to go back.
  struct State {
    double t = 0.0, theta = 0.0, omega = 0.0, i = 0.0;
    Branch<double> branch{1.0, 1.0, 1.0, 1.0};  ///< force and direction; the others follow from the unknowns
    bool force_branch_known = false;            ///< branch.force was set where the force has just changed its sign
    double switched_voltage = 0.0;              ///< of a supply that is no sine, at this moment [V]
    bool stuck = false;                         ///< stands where friction holds it
    bool jammed = false;                        ///< has reached where its equations have no unique solution
    std::int64_t switches = 0;                  ///< of a pwm supply so far: even ones turn on, number 0 at t = 0
    double psi = 0.0, pitch_velocity = 0.0;     ///< of wings that pitch [rad], [rad/s]
    bool held = false;                          ///< a stop holds the wings
    double impact_loss = 0.0;                   ///< energy that stops have taken in impacts so far [J]
    CycleIntegrals<double> impulses{};          ///< what impacts have added to the integrals so far

    /// Calls use(number) for each of them.
    template <class Self, class Use>
    static void each(Self& self, const Use& use) {
      use(self.t), use(self.theta), use(self.omega), use(self.i);
      use(self.branch.stroke), use(self.branch.force), use(self.branch.direction), use(self.branch.stored_power);
      use(self.branch.pitching), use(self.branch.gear), use(self.force_branch_known);
      use(self.switched_voltage), use(self.stuck), use(self.jammed), use(self.switches);
      use(self.psi), use(self.pitch_velocity), use(self.held), use(self.impact_loss);
      for (auto& x : self.impulses) use(x);
    }
  };
  /// Functions of the state whose sign changes are events.
  enum Indicator { force, standstill, jam, stored_moment, reversal, stop, turn, indicator_count };

  /// Throws ParameterError for numbers out of range.
  CrankModel(const Vehicle<double>& vehicle, const Supply<double>& supply);
  /// Sets the state at t = 0 and what follows from it; without inductance the current follows from the voltage instead.
  void start(double theta, double omega, double current, double psi = 0.0, double pitch_velocity = 0.0);
  /// Sets typical sizes, and what follows from them, for voltages up to this one [V]: start() does so for the supply's.
  void scale_to(double highest_voltage);

  // As TimeModel asks.
  bool ended() const { return now.jammed; }
  void begin_piece();
  void unknowns(double* y) const;
  void set(double t, const double* y);
  std::array<int, indicator_count> directions() const;
  void handle(std::size_t indicator);
  /// What a sign change of an indicator is to those who watch, but for impacts and jams.
  std::optional<TransientEvent::Kind> event_at(std::size_t indicator) const;
  bool branch_lost();
  void tolerated(double relative, const double* y, double* errors) const;
  std::array<double, 5> typical() const;
  double longest_step() const { return 0.25 * time_scale; }
  bool stiff() const;

  double voltage(double t) const {
    if (command) return command(t);
    return supply.type == SupplyType::sine ? voltage_at(supply, t) : now.switched_voltage;
  }
  double current_of(double t, const double* y) const {
    return inductive ? y[2] : algebraic_current(vehicle, voltage(t), y[1]);
  }
  CrankKinematics<double> kinematics(double theta) const {
    return crank_kinematics(vehicle.transmission, std::sin(theta), std::cos(theta));
  }
  /// What acts at the unknowns y, on the branch `used`.
  Motion<double> motion(double t, const double* y, Branch<double>* used = nullptr) const;
  /// What acts now, also where friction holds the crank.
  Motion<double> motion_now() const;
  /// What acts at the unknowns y, of wings that pitch.
  PitchMotion<double> pitch_motion(double t, const double* y, Branch<double>* used = nullptr) const;
  /// dy/dt and, where asked for, the integrands of `quadratures` behind them. False: not finite.
  bool rates(double t, const double* y, double* dy, bool quadrature) const;
  std::array<double, indicator_count> indicators(double t, const double* y) const;
  double static_force(const CrankKinematics<double>& k) const;
  double net_static_torque(double theta, double i) const;
  double holding_torque(double theta) const;
  StandingTorques<double> standing_torques(double theta) const;
  double wing_energy() const;
  /// Kinetic energy of the rotor, energy of the inductance [J].
  double motor_energy() const;
  /// The energy of rotor and inductance and all that wings, the air that moves with them, springs and hinges store [J].
  double stored_energy() const;
  double current_slope(double t, const double* y, const double* rates) const;
  /// uniqueness() as the wings stand at the unknowns y.
  double uniqueness_at(const double* y) const;
  double uniqueness_now() const;
  /// The least J + A (h + s mu r_e) of either branch as everything stands [kg m2].
  double least_inertia_now() const;

  /// Where psi stands among the unknowns; psi' is next to it.
  std::size_t pitch_at() const { return inductive ? 3 : 2; }
  /// True of wings that a standing crank would not be shaken by.
  bool wings_rest() const { return !pitching || (now.psi == 0.0 && now.pitch_velocity == 0.0); }
  /// Torques of the motor [N m] between which the crank stands while the wings pitch.
  StandingTorques<double> standing_torques(const double* y) const;
  /// Elastic energy of the hinges and kinetic energy of the pitching, of added mass too, beside wing_energy() [J];
  /// without a stroke velocity that of the pitching alone.
  double pitch_energy(double stroke_velocity = 0.0) const;
  /// Meets the stop that the wings are at and move on to.
  void resume();

  /// Decides the sign of the rod force by the state, or by what it is about to become.
  void choose_force_branch();
  /// When a pwm supply switches next [s].
  double next_switch() const;
  /// Switches it.
  void switch_supply();
  /// Takes a pwm supply for as often switched as it has been by now, after a command in its place.
  void catch_up_with_supply();

  Vehicle<double> vehicle;
  Supply<double> supply;
  std::function<double(double t)> command;  ///< the voltage that drives in the supply's place [V], where there is one
  bool inductive = true;
  bool wingless = false;
  bool pitching = false;
  int coupled = 3;  ///< number of unknowns
  double constant_friction = 0.0;
  double speed_scale = 1.0, current_scale = 1.0, time_scale = 1.0, force_scale = 1.0;
  double pitch_scale = 1.0, pitch_velocity_scale = 1.0;
  double electrical_time = 0.0, mechanical_time = 0.0;  ///< time constants [s]
  double drive_period = 0.0;                            ///< of a supply that varies [s]
  double fastest_decay = 0.0;                           ///< [1/s]
  double jam_below = -std::numeric_limits<double>::infinity(), jam_above = std::numeric_limits<double>::infinity();
  double smallest_inertia = 0.0;  ///< [kg m2]
  State now;

  static constexpr double smallest_margin = 1e-6;  ///< of J: below it the mechanism counts as jammed

 private:
  void find_jams();
  WingsAtPitch<double> wings_standing(const double* y) const;
  double standing_lift(const double* y, const WingsAtPitch<double>& wings) const;
  double start_speed_ = 0.0, start_current_ = 0.0, start_pitch_ = 0.0, start_pitch_velocity_ = 0.0;

  double rotor_inertia() const;  ///< that counts where the mechanism may jam [kg m2]
  double stop_room(double t, const double* y) const;
  void meet_stop();
};

}  // namespace wingbeat::detail
