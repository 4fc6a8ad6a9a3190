// Where the search for a crank's steady flapping starts, and what it means that it finds none: model.md sections 2, 12.
#pragma once

#include <algorithm>
#include <cmath>

#include "cycle/flapping_search.hpp"
#include "wingbeat/core/root.hpp"

namespace wingbeat::detail {

template <class System_>
class CrankSearch {
 public:
  using System = System_;
  using State = typename System::State;
  static constexpr long part = pitching_search_work / 3, part_with_orbit = pitching_search_work / 10;

  explicit CrankSearch(const Vehicle<double>& vehicle)
      : vehicle_(vehicle), statics_(static_balance(of_max_inertia(vehicle))), no_load_(no_load_speed(vehicle)) {}

  bool stalls(SteadyFlapping& result) const { return detail::stalls(statics_, result); }

  System system() {
    Coordinates<double> typical{0.0, no_load_, vehicle_.voltage / circuit_resistance(vehicle_)};
    if constexpr (System::on_hinges) {
      balanced_ = balanced_speed(vehicle_);
      const double speed = balanced_.slowest;
      add_typical_wings(vehicle_, typical_stroke_slope(vehicle_.transmission) * speed, speed, typical);
    }
    return {vehicle_, detail::sizes_of_states<System>(vehicle_, typical), 1e-4 * no_load_};
  }

  void search(StableOrbits<System>& orbits) {
    if (statics_.can_jam()) return;
    if constexpr (System::on_hinges) {
      // Where the pitching is lightly damped, the return map does not forget its start, and several orbits may be
      // stable.
      const double slope = crank_kinematics(vehicle_.transmission, 0.0, 1.0).stroke_slope, slow = balanced_.slowest;
      if (!is_hinged(vehicle_)) {
        orbits.attempt(turning(slow, slow), part);
        if (orbits.empty()) orbits.attempt(turning(no_load_, no_load_), part);
        return;
      }
      orbits.attempt(pitched(slow, quasi_static_pitch(slope * slow)), part);
      orbits.attempt(pitched(slow, 0.0), part);
      orbits.attempt(pitched(no_load_, std::min(0.5 * pi, closer_stop(vehicle_.pitch.hinge))),
                     orbits.empty() ? part : part_with_orbit);
      if (orbits.empty()) orbits.attempt(pitched(no_load_, 0.0), part);
    } else {
      const OrbitGuess<double> guess = guess_orbit(vehicle_);
      if (guess.balanced.count > 0.0) {
        orbits.attempt(turning(guess.crank_speed, guess.earlier_speed), orbits.all, guess.multiplier);
      }
      // The fastest start: if cycles from there fail, no slower one can be expected to last.
      if (orbits.empty() && !std::isfinite(orbits.unstable_multiplier())) orbits.attempt(turning(no_load_, no_load_));
      several_speeds_ = guess.balanced.count > 1.0;
    }
  }

  bool in_doubt(StableOrbits<System>& orbits) const {
    if (several_speeds_ || statics_.can_jam() || statics_.can_lock()) return true;
    for (std::size_t n = 0; n < orbits.size(); ++n) {
      if (hardly_returns(vehicle_, orbits[n].multiplier(), 1.0 / orbits[n].frequency())) return true;
    }
    return false;
  }

  /// What statics and search alone say where no stable orbit was found.
  void explain(const StableOrbits<System>& orbits, SteadyFlapping& result) const {
    using Evidence = StatusEvidence::Kind;
    const solver::PeriodicStatus search = orbits.last().status;
    result.status = FlappingStatus::undecided;
    if (statics_.can_jam()) {
      result.status = FlappingStatus::jammed;
      result.evidence = jam_evidence(statics_);
    } else if (std::isfinite(orbits.unstable_multiplier())) {
      result.evidence = {.kind = Evidence::unstable_orbit,
                         .frequency = orbits.unstable_frequency(),
                         .multiplier = orbits.unstable_multiplier()};
    } else if (std::isfinite(orbits.imbalance())) {
      result.evidence = {.kind = Evidence::open_balance, .change = orbits.imbalance(), .search = search};
    } else {
      result.status = FlappingStatus::locked;
      result.evidence = {.kind = Evidence::no_orbit, .angle = orbits.last().stop, .search = search};
      add_locks(vehicle_, statics_, result.evidence);
    }
  }

  StatusEvidence evidence(const Metrics<double>& metrics, const Metrics<double>* other, bool assessed) const {
    StatusEvidence evidence{.kind = StatusEvidence::Kind::orbit,
                            .frequency = metrics[Metric::frequency],
                            .other_frequency = other ? (*other)[Metric::frequency] : absent,
                            .assessed = assessed};
    add_locks(vehicle_, statics_, evidence);
    return evidence;
  }

 private:
  /// The vehicle with the largest inertia that its wings have at any pitch: whether its equations have one solution
  /// must not depend on how they pitch.
  static Vehicle<double> of_max_inertia(Vehicle<double> vehicle) {
    if (System::on_hinges) vehicle.wings.added_inertia = std::max(vehicle.pitch.air.rr, vehicle.pitch.pitch_inertia);
    return vehicle;
  }

  /// At crank angle zero at a crank speed [rad/s], with the quasi-steady current of another.
  State turning(double speed, double earlier_speed) const {
    const double current =
        current_within(vehicle_.electronics, algebraic_current(vehicle_, vehicle_.voltage, earlier_speed));
    return System::state_of({0.0, speed, current}, vehicle_);
  }
  /// turning() with wings pitched by `psi` [rad] against their velocity.
  State pitched(double speed, double psi) const
    requires System::on_hinges
  {
    State y = turning(speed, speed);
    y[System::pitch] = -sign_of(crank_kinematics(vehicle_.transmission, 0.0, 1.0).stroke_slope) * psi;
    return y;
  }

  /// Pitch [rad] at which the hinge balances the air on a wing that moves steadily: the quasi-static pitch law, of
  /// magnitude alone, at most a right angle and the stop.
  double quasi_static_pitch(double stroke_velocity) const {
    const PitchingWings<double>& p = vehicle_.pitch;
    const double max_angle = std::min(0.5 * pi, closer_stop(p.hinge));
    const auto holds = [&](double psi) {
      const PitchState<double> state = pitch_state(-psi, 0.0, std::abs(stroke_velocity));
      return p.hinge.stiffness * psi < aero_loads(vehicle_.wings, p, state, 1.0, 1.0).pitch_moment;
    };
    if (holds(max_angle)) return max_angle;
    return bisect(holds, 0.0, max_angle).before;
  }

  const Vehicle<double>& vehicle_;
  StaticBalance statics_;
  double no_load_;
  BalancedSpeed<double> balanced_{};
  bool several_speeds_ = false;
};

}  // namespace wingbeat::detail
