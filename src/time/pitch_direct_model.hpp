// A direct drive whose wings pitch on a hinge, in time: equations, events and state; model.md sections 6, 12.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "time/driven_shaft.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"
#include "wingbeat/vehicle/pitch_motion.hpp"

namespace wingbeat::detail {

/// The unknowns are beta [rad], beta' [rad/s], psi [rad], psi' [rad/s] and, with an inductance, i [A]. Satisfies
/// TimeModel. Of a vehicle without constant friction.
class PitchDirectModel : public DrivenShaft {
 public:
  /// Behind `quadratures`: loss in the damping of the hinges [J]; chordwise_lift() [N s]; integrals of stroke and pitch
  /// times cosine and sine of the supply's phase [rad s].
  enum Other { hinge_work, chordwise, stroke_cosine, stroke_sine, pitch_cosine, pitch_sine, other_quadratures };

  /// Everything that moves: copied to save it, assigned to go back.
  struct State {
    static constexpr bool stuck = false;
    double t = 0.0;
    double y[5] = {};
    bool held = false;                  ///< a stop holds the wings
    double impact_loss = 0.0;           ///< energy that stops have taken in impacts so far [J]
    CycleIntegrals<double> impulses{};  ///< what impacts have added to the integrals so far

    /// Calls use(number) for each of them.
    template <class Self, class Use>
    static void each(Self& self, const Use& use) {
      use(self.t), use(self.y[0]), use(self.y[1]), use(self.y[2]), use(self.y[3]), use(self.y[4]), use(self.held);
      use(self.impact_loss);
      for (auto& x : self.impulses) use(x);
    }
  };
  /// Functions of the state whose sign changes are events: room to the stop or, of wings that it holds, how they press
  /// on it; stroke velocity and pitch velocity, at which the loads are kinked; the moment stored in wings and springs.
  enum Indicator { stop, velocity, turn, stored_moment, indicator_count };
  static constexpr std::size_t plain_indicators = 3;  ///< of them where no metrics are taken
  static constexpr std::size_t interruption = stop;
  static constexpr double longest_part = 1.0 / 16.0;  ///< of a period, that a step may take
  /// Nothing holds the shaft [N m].
  static constexpr double holding_torque = 0.0, drive_torque = infinity;

  /// Throws ParameterError for numbers out of range.
  explicit PitchDirectModel(const Vehicle<double>& vehicle);
  /// Sets the state at t = 0.
  void start(const std::array<double, 5>& y);
  /// Sets typical sizes for voltages up to this one [V]: start() does so for the supply's.
  void scale_to(double highest_voltage);
  void start_from(const TransientOptions& from) {
    start({from.crank_angle, from.crank_speed, from.pitch_angle, from.pitch_velocity, from.current});
  }

  // As TimeModel asks.
  void begin_piece() { resume(); }
  void unknowns(double* y) const { std::copy_n(now.y, coupled, y); }
  void set(double t, const double* y) {
    now.t = t;
    std::copy_n(y, coupled, now.y);
  }
  void handle(std::size_t indicator);
  /// Impacts apart, no sign change of an indicator is an event to those who watch.
  static std::optional<TransientEvent::Kind> event_at(std::size_t) { return std::nullopt; }
  bool branch_lost() const { return !now.held && std::abs(now.y[2]) > vehicle.pitch.hinge.stop * (1.0 + 1e-9); }
  void tolerated(double relative, const double* y, double* errors) const;
  std::array<double, 5> typical() const { return scale; }
  double longest_step() const { return longest_part * period; }
  bool stiff() const;
  /// dy/dt and, where asked for, the integrands of `quadratures` and of Other behind them. False: not finite.
  bool rates(double t, const double* y, double* dy, bool quadrature) const;
  std::array<double, indicator_count> indicators(double t, const double* y, bool all = true) const;
  std::array<int, indicator_count> directions() const { return {-1, 0, 0, 0}; }

  double current_of(double t, const double* y) const {
    return inductive ? y[4] : algebraic_current(vehicle, voltage(t), y[1]);
  }
  static Branch<double> branch_at(const double* y) { return {sign_of(y[1]), 1.0, sign_of(y[1]), 1.0}; }
  PitchMotion<double> pitch_motion(double t, const double* y) const;
  Motion<double> motion(double t, const double* y) const { return pitch_motion(t, y).stroke; }
  Motion<double> motion_now() const { return motion(now.t, now.y); }
  double wing_energy() const { return DrivenShaft::wing_energy(now.y[0], now.y[1]); }
  /// Kinetic energy of rotor, wings and the air that moves with them, elastic energy of springs and hinges, energy of
  /// the inductance [J].
  double stored_energy() const;

  // What a simulation from rest asks, of a DirectModel as well.
  /// Meets the stop that the wings are at and move on to.
  void resume();
  /// What happens at a sign change of the indicator `interruption`, or where branch_lost(): free wings meet a stop,
  /// held ones leave it.
  std::optional<TransientEvent::Kind> interrupt();
  static double largest_net_torque() { return infinity; }
  void other_scales(double power, double* scales) const;
  static double pitch_angle(const double* y) { return y[2]; }
  void put_state(TransientResult& in) const;

  int coupled;                  ///< number of unknowns
  std::array<double, 5> scale;  ///< typical size of each unknown
  State now;

 private:
  std::array<double, 5> start_{};

  double side() const { return sign_of(now.y[2]); }
  void meet_stop();
};

}  // namespace wingbeat::detail
