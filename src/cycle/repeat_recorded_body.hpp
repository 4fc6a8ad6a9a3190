// The definition of repeat_recorded(), for the files that instantiate it.
#pragma once

#include "cycle/repeat_recorded.hpp"
#include "wingbeat/cycle/cycle_gradient.hpp"

namespace wingbeat::detail {

/// What wings that pitch have instead of the metrics of the pitch law.
inline void set_pitch_metrics(const PitchGradient& gradient, Metrics<GradientJet>& m) {
  m[Metric::pitch_amplitude] = degrees_per_radian * gradient.amplitude;
  m[Metric::pitch_phase] = degrees_per_radian * gradient.phase;
  if (!(gradient.amplitude.a > still_pitch))
    m[Metric::pitch_phase] = GradientJet(absent), make_absent(m[Metric::pitch_phase]);
  m[Metric::angle_of_attack_min] = degrees_per_radian * gradient.angle_of_attack_min;
  m[Metric::angle_of_attack_max] = degrees_per_radian * gradient.angle_of_attack_max;
}

template <class System>
OrbitGradient repeat_recorded(const SteadyFlapping& orbit, const RecordedCycle<System>& recorded,
                              const Vehicle<GradientJet>& vehicle, const GradientVehicle& given,
                              const GradientOptions& options) {
  const bool voltage_varies = drive_of(vehicle).voltage_sets_frequency;
  CycleGradient<System> cycle(recorded, vehicle);
  OrbitGradient g;
  g.regular = cycle.run();
  CycleExtremes<GradientJet> extremes;
  extremes.fill(GradientJet(absent));
  if (options.peaks) extremes = cycle.extremes();
  g.metrics = cycle_metrics(vehicle, cycle.integrals(), extremes,
                            GradientJet(orbit.metrics[Metric::floquet_multiplier_max]), {});
  if constexpr (CycleGradient<System>::pitching) {
    if (pitches(vehicle)) {
      g.metrics[Metric::power_hinge] = cycle.hinge_power();
      g.metrics[Metric::lift_added_mass_share] =
          added_mass_share(vehicle.pitch, cycle.chordwise_share(), GradientJet(1.0));
      if (options.peaks) set_pitch_metrics(cycle.pitch_gradient(), g.metrics);
    }
  }
  const GradientJet bench = voltage_varies ? given.bench_torque_constant : GradientJet(absent);
  g.metrics[Metric::power_motor_reference] =
      two_pi * bench * g.metrics[Metric::frequency] * g.metrics[Metric::current_mean];
  g.metrics[Metric::lift_to_weight] = g.metrics[Metric::lift_mean] / (given.mass * standard_gravity);
  for (const double theta : options.crank_angles) g.instants.push_back(cycle.instant(theta));
  return g;
}

}  // namespace wingbeat::detail
