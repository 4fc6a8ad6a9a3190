// A direct drive in time: its equations, its events, and the state that goes with them; model.md section 6.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "time/driven_shaft.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {

/// The unknowns are beta [rad], beta' [rad/s] and, with an inductance, i [A].
class DirectModel : public DrivenShaft {
 public:
  static constexpr int other_quadratures = 0;  ///< behind `quadratures`

  /// Everything that moves: copied to save it, assigned to go back.
  struct State {
    double t = 0.0;
    double y[3] = {};
    bool stuck = false;      ///< constant friction holds the shaft
    double direction = 1.0;  ///< of a slip, where there is constant friction

    /// Calls use(number) for each of them.
    template <class Self, class Use>
    static void each(Self& self, const Use& use) {
      use(self.t), use(self.y[0]), use(self.y[1]), use(self.y[2]), use(self.stuck), use(self.direction);
    }
  };
  /// Functions of the state whose sign changes are events: of the motion, the speed or, where the shaft is stuck, what
  /// friction has left to hold; the moment stored in wings and springs; the speed.
  enum Indicator { motion_ends, stored_moment, velocity, indicator_count };
  static constexpr std::size_t plain_indicators = 1;  ///< of them where no metrics are taken
  static constexpr std::size_t interruption = motion_ends;
  static constexpr double longest_part = 0.25;  ///< of a period, that a step of the moving shaft may take

  /// Throws ParameterError for numbers out of range.
  explicit DirectModel(const Vehicle<double>& vehicle);
  /// Sets the state at t = 0 and the scales that follow from it.
  void start(double beta, double speed, double current);
  void start_from(const TransientOptions& from) { start(from.crank_angle, from.crank_speed, from.current); }
  /// Sets typical sizes for voltages up to this one [V]: start() does so for the supply's.
  void scale_to(double highest_voltage);

  // As TimeModel asks.
  void begin_piece();
  void unknowns(double* y) const { std::copy_n(now.y, coupled, y); }
  void set(double t, const double* y) {
    now.t = t;
    std::copy_n(y, coupled, now.y);
  }
  void handle(std::size_t indicator);
  /// What a sign change of an indicator is to those who watch.
  std::optional<TransientEvent::Kind> event_at(std::size_t indicator) const {
    if (indicator != motion_ends) return std::nullopt;
    return now.stuck ? TransientEvent::Kind::breakaway : TransientEvent::Kind::standstill;
  }
  bool branch_lost() { return sticks && !now.stuck && now.direction * now.y[1] < -1e-9 * speed_scale; }
  void tolerated(double relative, const double* y, double* errors) const;
  std::array<double, 3> typical() const { return {stroke_scale, speed_scale, current_scale}; }
  double longest_step() const { return now.stuck ? period / 64.0 : longest_part * period; }
  bool stiff() const;

  double current_of(double t, const double* y) const {
    return inductive ? y[2] : algebraic_current(vehicle, voltage(t), y[1]);
  }
  /// K i - T_x - N_w k beta [N m] at rest.
  double net_torque(double t, const double* y) const {
    const double i = inductive ? y[2] : algebraic_current(vehicle, voltage(t), 0.0);
    return vehicle.motor.torque_constant * i - vehicle.load_torque - springs_of(y[0]);
  }
  Branch<double> branch_at(const double* y) const;
  Motion<double> motion(double t, const double* y) const;
  Motion<double> motion_now() const { return motion(now.t, now.y); }
  /// dy/dt and, where asked for, the integrands of `quadratures` behind them. False: not finite.
  bool rates(double t, const double* y, double* dy, bool quadrature) const;
  std::array<double, indicator_count> indicators(double t, const double* y, bool all = true) const;
  double wing_energy() const { return DrivenShaft::wing_energy(now.y[0], now.y[1]); }
  /// Which sign changes of each indicator count.
  std::array<int, indicator_count> directions() const { return {now.stuck ? -1 : int(-now.direction), 0, 0}; }

  // What a simulation from rest asks, of a PitchDirectModel as well.
  void resume() {}
  /// What happens at a sign change of the indicator `interruption`, or where branch_lost(): a shaft that slips comes to
  /// rest, one that is stuck breaks away.
  std::optional<TransientEvent::Kind> interrupt();
  /// Of a stuck shaft: a bound of the net torque from now on [N m].
  double largest_net_torque() const;
  /// Typical sizes of the other quadratures over a period, `power` [W] being that of power.
  void other_scales(double, double*) const {}
  static double pitch_angle(const double*) { return absent; }
  void put_state(TransientResult& in) const;

  bool sticks;
  int coupled;  ///< number of unknowns
  double holding_torque, drive_torque;
  double stroke_scale = 1.0, speed_scale = 1.0, current_scale = 1.0;
  double fastest_decay = 0.0;  ///< [1/s]
  State now;

 private:
  std::array<double, 3> start_{};

  /// The shaft has come to rest where constant friction acts: it is held, or moves on where it is pulled.
  void come_to_rest();
  /// The net torque has outgrown what friction holds.
  void break_away();
};

}  // namespace wingbeat::detail
