// The orbit search against the simulation from rest.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "vehicle/metrics_apart.hpp"
#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {

/// The orbit to 1e-8 and the start-up to 1e-7, in the air that settles around the orbit.
struct OrbitAndSimulation {
  SteadyFlapping orbit;
  TransientResult time;
};

inline OrbitAndSimulation orbit_and_simulation(const Vehicle<double>& vehicle) {
  TransientOptions options;
  options.tolerance = 1e-7;
  OrbitAndSimulation found{find_steady_flapping(vehicle, {.tolerance = 1e-8}, start_up_in_time()), {}};
  found.time = simulate_start_up(in_air(vehicle, air_of(found.orbit.metrics)), options);
  return found;
}

/// What a comparison saw.
struct Compared {
  bool flaps = false;
  bool meets_stop = false;  ///< wings on hinges, in the last period of the simulation
};

/// Equal statuses; where the vehicle flaps, all metrics to 1e-6 and an energy balance to 1e-7.
inline Compared expect_orbit_as_simulated(const Design<double>& design, int n) {
  validate(design);
  const auto [orbit, transient] = orbit_and_simulation(resolve(design));
  EXPECT_EQ(orbit.status, transient.status)
      << "vehicle " << n << ": " << describe(orbit.evidence) << " / " << describe(transient.evidence);
  Compared seen;
  seen.flaps = orbit.status == FlappingStatus::flapping;
  if (!seen.flaps) return seen;
  const double period = 1.0 / orbit.metrics[Metric::frequency];
  for (const TransientEvent& e : transient.events) {
    const bool last = e.time > transient.end_time - period;
    seen.meets_stop = seen.meets_stop || (last && e.kind == TransientEvent::Kind::stop_impact);
  }
  EXPECT_TRUE(transient.metrics) << "vehicle " << n;
  if (!transient.metrics) return seen;
  std::string where;
  EXPECT_LT(worst_metric(orbit.metrics, *transient.metrics, where), 1e-6) << "vehicle " << n << ", " << where;
  EXPECT_LT(std::abs(energy_audit(orbit.metrics).imbalance), 1e-7 * orbit.metrics[Metric::power_electrical]) << n;
  return seen;
}

/// Packs leave the design to the scalar solver, whose metrics are the outcome's to the bit.
inline void expect_left_to_scalar_solver(const Design<double>& design, std::initializer_list<Metric> metrics) {
  const Vehicle<double> v = resolve(design);
  const EnsembleMember member{v, {}};
  EnsembleOutcome outcome;
  solve_ensemble(std::span(&member, 1), {}, {}, std::span(&outcome, 1));
  const SteadyFlapping alone = find_steady_flapping(v, {.tolerance = EnsembleOptions{}.tolerance});
  EXPECT_EQ(outcome.status, FlappingStatus::flapping);
  EXPECT_TRUE(outcome.scalar);
  for (const Metric m : metrics) EXPECT_EQ(outcome.metrics[m], alone.metrics[m]) << metric_info(m).key;
}

}  // namespace wingbeat
