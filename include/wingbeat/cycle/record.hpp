// One recorded flapping cycle: the orbit at any crank angle (of a direct drive: phase of the supply), and waveforms.
#pragma once

#include <memory>
#include <vector>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/waveform_row.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

/// A cycle of the crank or of a direct drive, of wings under the pitch law or that pitch, with or without inductance.
/// Copies share the cycle, which does not change. What computes along it includes cycle/recorded_cycle.hpp.
class CycleRecord {
 public:
  struct Recorded;

  CycleRecord() = default;
  explicit CycleRecord(Recorded recorded);

  bool empty() const;
  /// Period of the cycle [s].
  double period() const;
  /// Integrals over the cycle.
  CycleIntegrals<double> integrals() const;
  /// The vehicle that flaps, its motor at the orbit's temperatures.
  const Vehicle<double>& vehicle() const;
  /// The cycle at a crank angle (direct drive: phase of the supply) [rad], 0 to 2 pi, to the accuracy of the orbit.
  WaveformRow at(double theta) const;
  /// The crank angle (direct drive: phase of the supply) [rad] at a time since its zero, 0 to the period [s].
  double phase_at(double time) const;
  /// The cycle at `count` instants equally spaced in time, both ends included; count >= 2.
  std::vector<WaveformRow> waveform(int count) const;
  const Recorded& recorded() const;

 private:
  std::shared_ptr<const Recorded> recorded_;
};

}  // namespace wingbeat
