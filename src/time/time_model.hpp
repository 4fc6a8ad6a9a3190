// A vehicle on its supply, in time: its state, its events, and what happens at them; model.md sections 2, 6, 9, 12.
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
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat::detail {

/// The unknowns are those of Coordinates that the vehicle has, in their order; a crank angle is not wrapped.
class TimeModel {
 public:
  /// Everything that moves: copied to save it, assigned to go back.
  struct State {
    double t = 0.0;
    Coordinates<double> moving;
    double direction = 1.0;             ///< as of Mode
    double force = 1.0;                 ///< sign of the rod force, as of Mode; the other signs follow from the unknowns
    bool force_known = false;           ///< `force` was set where the rod force has just changed its sign
    double switched_voltage = 0.0;      ///< of a supply that is no sine, at this moment [V]
    bool stuck = false;                 ///< stands where friction holds it
    bool leaving = false;               ///< has just broken away: friction does not hold it again at once
    bool jammed = false;                ///< has reached where its equations have no unique solution
    std::int64_t switches = 0;          ///< of a pwm supply so far: even ones turn on, number 0 at t = 0
    bool held = false;                  ///< a stop, or friction of their joint, holds the wings
    double turn = 1.0;                  ///< as of Mode, where friction of that joint depends on it
    bool blocked = false;               ///< electronics let no current flow back
    bool limited = false;               ///< they limit the current
    double pitching = 1.0;              ///< as of Mode, where the accelerations jump with it
    double impact_loss = 0.0;           ///< energy that stops have taken in impacts so far [J]
    CycleIntegrals<double> impulses{};  ///< what impacts have added to the integrals so far

    /// Calls use(number) for each of them.
    template <class Self, class Use>
    static void each(Self& self, const Use& use) {
      use(self.t);
      Coordinates<double>::each(self.moving, use);
      use(self.direction), use(self.force), use(self.force_known), use(self.switched_voltage), use(self.stuck);
      use(self.leaving), use(self.jammed), use(self.switches), use(self.held), use(self.turn), use(self.blocked);
      use(self.limited), use(self.pitching), use(self.impact_loss);
      for (auto& x : self.impulses) use(x);
    }
  };
  /// Functions of the state whose sign changes are events.
  enum Indicator {
    force,
    standstill,
    jam,
    stored_moment,
    reversal,
    stop,
    turn,
    local_turn,  ///< of a twisting wing, where its pitch is reported
    bridge,
    limit,
    pitch_bound,  ///< of the angle of attack, where the accelerations jump with it
    indicator_count
  };

  /// The supply of a direct drive is the vehicle's. Throws ParameterError for numbers out of range.
  TimeModel(const Vehicle<double>& vehicle, const Supply<double>& supply);
  /// Sets the state at t = 0 and what follows from it; without inductance the current follows from the voltage instead.
  void start(const Coordinates<double>& from);
  /// Sets typical sizes, and what follows from them, for voltages up to this one [V]: start() does so for the supply's.
  void scale_to(double highest_voltage);

  // What an integrator asks, and the loop through its events (time/event_loop.hpp).
  bool ended() const { return now.jammed; }
  /// Decides on what branch it goes on.
  void begin_piece();
  /// All that an integrator has as unknowns; models that integrate more beside it have more.
  void unknowns(double* y) const;
  /// Of the coordinates alone, 0 behind them.
  std::array<double, max_unknowns> coordinates_now() const;
  void set(double t, const double* y);
  /// dy/dt and, where asked for, the integrands of `quadratures` behind them. False: not finite.
  bool rates(double t, const double* y, double* dy, bool quadrature) const;
  std::array<double, indicator_count> indicators(double t, const double* y) const;
  /// Which sign changes of them count: +1 rising, -1 falling, 0 both.
  std::array<int, indicator_count> directions() const;
  /// One of them has changed its sign.
  void handle(std::size_t indicator);
  /// Whether the integrator starts afresh after it.
  static constexpr bool ends_piece(std::size_t) { return true; }
  /// What that is to those who watch, but for impacts and jams.
  std::optional<TransientEvent::Kind> event_at(std::size_t indicator) const;
  /// True where a sign was wrong from the start of the piece, which an integrator may not see as a change.
  bool branch_lost();
  /// Admissible errors of a step.
  void tolerated(double relative, const double* y, double* errors) const;
  Coordinates<double> typical_coordinates() const;
  std::array<double, max_unknowns> typical() const;
  double longest_step() const;
  double longest_moving_step() const;  ///< where nothing stands
  bool stiff() const;

  double voltage(double t) const {
    if (command) return command(t);
    return supply.type == SupplyType::sine ? voltage_at(supply, t) : now.switched_voltage;
  }
  SupplyMoment<double> supply_at(double t) const;
  double current_of(double t, const double* y) const {
    if (indices.inductive) return y[indices.current];
    return further ? instant(t, y).current : algebraic_current(vehicle, voltage(t), y[1]);
  }
  double current_now() const;
  CrankKinematics<double> kinematics(double angle) const { return configuration_at_angle(vehicle, angle).kinematics; }
  double stroke_angle(double angle) const { return stroke_angle_at(vehicle, kinematics(angle), angle); }
  /// What stands still, the direction and the sign of the rod force; no other sign of it means anything.
  Mode<double> mode() const;
  FullState<double> instant(double t, const double* y) const { return instant(t, indices.coordinates(y)); }
  FullState<double> instant(double t, const Coordinates<double>& place) const;
  /// Torque that the actuator gives a shaft that stands [N m].
  double standing_torque(double t, const double* y) const { return wingbeat::standing_torque(vehicle, instant(t, y)); }
  /// What acts at the unknowns y, in the mode `used`.
  PitchMotion<double> motion(double t, const double* y, Mode<double>* used = nullptr) const;
  PitchMotion<double> motion_now() const;

  /// Torques of the motor between which it stands at the unknowns y [N m]: as the wings pitch, or, at an angle, of
  /// wings that do not.
  StandingTorques<double> standing_torques(const double* y) const;
  StandingTorques<double> standing_torques(double angle) const;
  /// Torque of the motor at a current beyond the middle of those, and half of what lies between them: what friction can
  /// hold [N m].
  double net_static_torque(double angle, double i) const;
  double holding_torque(double angle) const;

  double wing_energy() const { return wingbeat::wing_energy(vehicle, now.moving); }
  /// Kinetic energy of the rotor, energy of the inductance [J].
  double motor_energy() const;
  double stored_energy() const { return wingbeat::stored_energy(vehicle, now.moving); }
  /// di/dt [A/s]; `rates` are needed without inductance only.
  double current_slope(double t, const double* y, const double* rates) const;
  /// uniqueness() as the wings stand at the unknowns y; 1 of a direct drive, which cannot jam.
  double uniqueness_at(const double* y) const;
  double uniqueness_now() const;
  /// The least J + A (h + s mu r_e) of either branch as everything stands [kg m2].
  double least_inertia_now() const;
  /// True of wings that a standing shaft would not be shaken by.
  bool wings_rest() const {
    const Coordinates<double>& c = now.moving;
    return c.pitch_angle == 0.0 && c.pitch_velocity == 0.0 && c.twist_angle == 0.0 && c.twist_velocity == 0.0;
  }
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
  UnknownIndices indices;
  int coupled;         ///< number of unknowns
  bool direct;         ///< the shaft is the wings' hinge, and the cycle a period of the supply
  bool force_matters;  ///< the sign of the rod force matters
  bool wings_pitch;    ///< or twist: pitches()
  bool further;        ///< is_of_further_kind()
  bool wingless = false;
  double constant_friction = 0.0;
  double angle_scale = 0.1, speed_scale = 1.0, current_scale = 1.0, force_scale = 1.0;
  double torque_scale = 1.0;  ///< of the actuator [N m]
  double pitch_scale = 1.0, pitch_velocity_scale = 1.0;
  double time_scale = 1.0;                              ///< of a cycle [s]
  double electrical_time = 0.0, mechanical_time = 0.0;  ///< time constants [s]
  double drive_period = 0.0;                            ///< of a supply that varies [s]
  double drive_torque = 0.0;                            ///< direct drive: amplitude of the torque at rest [N m]
  double fastest_decay = 0.0;                           ///< [1/s]
  double jam_below = -std::numeric_limits<double>::infinity(), jam_above = std::numeric_limits<double>::infinity();
  double smallest_inertia = 0.0;  ///< [kg m2]
  State now;

  static constexpr double smallest_margin = 1e-6;  ///< of J: below it the mechanism counts as jammed

 private:
  void scale_crank(double highest_voltage);
  void scale_direct(double highest_voltage);
  void find_jams();
  double rotor_inertia() const;  ///< that counts where the mechanism may jam [kg m2]
  double stop_room(const double* y, const PitchMotion<double>& motion) const;
  void meet_stop();
  void settle_pitch();
  void settle_electronics();
  void settle_shaft();
  double pressing(const double* y) const;
  double surplus_voltage(double i) const;
  double pitch_margin_at(const double* y) const;

  Coordinates<double> start_;
  bool jumps_;           ///< jumps_at_rest()
  bool jumps_at_bound_;  ///< jumps_at_pitch_stop()
};

}  // namespace wingbeat::detail
