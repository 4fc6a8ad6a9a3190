// One recorded flapping cycle: the orbit at any crank angle, and waveforms from it.
#pragma once

#include <variant>
#include <vector>

#include "wingbeat/cycle/crank_system.hpp"

namespace wingbeat {

/// One instant of a flapping cycle, in the order of a waveform file (all SI, angle of attack in degrees).
struct WaveformRow {
  double time;                 ///< since crank angle 0 [s]
  double crank_angle;          ///< theta [rad]
  double crank_speed;          ///< omega [rad/s]
  double current;              ///< i [A]
  double stroke_angle;         ///< beta [rad]
  double flapping_velocity;    ///< beta' [rad/s]
  double angle_of_attack_deg;  ///< alpha [deg]
  double lift;                 ///< [N]
  double aero_moment;          ///< M_aero [N m]
  double rod_force;            ///< F [N]
  double motor_torque;         ///< T_m [N m]
  double friction_torque;      ///< T_f [N m]
};

/// A lap of the crank, with (second alternative) or without inductance.
class CycleRecord {
 public:
  template <int N>
  struct Recorded {
    CrankSystem<double, N> system;
    solve::Lap<CrankSystem<double, N>> lap;
  };
  using Laps = std::variant<Recorded<1>, Recorded<2>>;

  CycleRecord() = default;
  explicit CycleRecord(Laps laps) : laps_(std::move(laps)) {}

  bool empty() const;
  /// Period of the cycle [s].
  double period() const;
  /// Integrals over the cycle.
  CycleIntegrals<double> integrals() const;
  /// The cycle at crank angle theta [rad], 0 to 2 pi, to the accuracy of the orbit.
  WaveformRow at(double theta) const;
  /// The cycle at `count` instants equally spaced in time, both ends included; count >= 2.
  std::vector<WaveformRow> waveform(int count) const;
  const Laps& laps() const { return laps_; }

 private:
  Laps laps_;
};

}  // namespace wingbeat
