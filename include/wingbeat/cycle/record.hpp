// One recorded flapping cycle: the orbit at any crank angle (of a direct drive: phase of the supply), and waveforms.
#pragma once

#include <variant>
#include <vector>

#include "wingbeat/cycle/crank_system.hpp"
#include "wingbeat/cycle/direct_system.hpp"
#include "wingbeat/cycle/pitch_crank_system.hpp"
#include "wingbeat/cycle/pitch_direct_system.hpp"

namespace wingbeat {

/// One instant of a flapping cycle, in the order of a waveform file (all SI, angle of attack in degrees). Current,
/// lift, moments, torques and powers are the sums of all motors, the rod force is that of one.
struct WaveformRow {
  double time;                 ///< since crank angle 0; direct drive: since the supply's phase 0 [s]
  double crank_angle;          ///< theta; direct drive: of the shaft, which is the stroke angle [rad]
  double crank_speed;          ///< omega [rad/s]
  double current;              ///< i [A]
  double stroke_angle;         ///< beta [rad]
  double flapping_velocity;    ///< beta' [rad/s]
  double angle_of_attack_deg;  ///< alpha [deg]
  double lift;                 ///< [N]
  double aero_moment;          ///< M_aero [N m]
  double rod_force;            ///< F [N]; absent where there is no rod
  double motor_torque;         ///< T_m [N m]
  double friction_torque;      ///< T_f [N m]
  double voltage;              ///< v at the motor terminals [V]
  double power_electrical;     ///< v i [W]
  double power_motor;          ///< T_m omega [W]
  double power_friction;       ///< T_f omega [W]
  double power_aerodynamic;    ///< M_aero beta', of wings on pitch hinges with M_pitch psi' [W]
  double spring_moment;        ///< N_w k beta of all hinge springs [N m], towards stroke angle zero
  double inertial_moment;      ///< N_w J_w beta'' of all wings [N m]
  double pitch_angle;          ///< psi [rad]; absent where it follows from the angle of attack by the pitch law
};

/// What acts at one instant, as a row: `stroke_angle` beta and `shaft_angle` theta [rad], omega [rad/s].
WaveformRow waveform_row(const Vehicle<double>& vehicle, const Motion<double>& motion, double time, double shaft_angle,
                         double shaft_speed, double stroke_angle, double pitch_angle = absent);

/// Integrals over a recorded cycle.
template <class System>
CycleIntegrals<double> cycle_integrals(const solver::Iterate<System>& cycle) {
  CycleIntegrals<double> sum{};
  for (const auto& step : cycle.steps) {
    for (std::size_t q = 0; q < sum.size(); ++q) sum[q] += step.dq[q];
  }
  return sum;
}

/// A system and its cycle.
template <class System>
struct RecordedCycle {
  System system;
  solver::Iterate<System> cycle;
};

/// A cycle of the crank or of a direct drive, of wings under the pitch law or that pitch, with or without inductance.
class CycleRecord {
 public:
  template <int N>
  using Recorded = RecordedCycle<CrankSystem<double, N>>;
  using Cycles = std::variant<Recorded<1>, Recorded<2>, RecordedCycle<DirectSystem<double, 2>>,
                              RecordedCycle<DirectSystem<double, 3>>, RecordedCycle<PitchDirectSystem<double, 4>>,
                              RecordedCycle<PitchDirectSystem<double, 5>>, RecordedCycle<PitchCrankSystem<double, 3>>,
                              RecordedCycle<PitchCrankSystem<double, 4>>>;

  CycleRecord() = default;
  explicit CycleRecord(Cycles cycles) : cycles_(std::move(cycles)) {}

  bool empty() const;
  /// Period of the cycle [s].
  double period() const;
  /// Integrals over the cycle.
  CycleIntegrals<double> integrals() const;
  /// The cycle at a crank angle (direct drive: phase of the supply) [rad], 0 to 2 pi, to the accuracy of the orbit.
  WaveformRow at(double theta) const;
  /// The cycle at `count` instants equally spaced in time, both ends included; count >= 2.
  std::vector<WaveformRow> waveform(int count) const;
  const Cycles& cycles() const { return cycles_; }

 private:
  Cycles cycles_;
};

}  // namespace wingbeat
