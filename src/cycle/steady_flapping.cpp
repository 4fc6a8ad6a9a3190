#include "wingbeat/cycle/steady_flapping.hpp"

#include <cmath>

#include "wingbeat/cycle/orbit_search.hpp"
#include "wingbeat/cycle/thermal_equilibrium.hpp"

namespace wingbeat {
namespace {

using detail::format;
using detail::OrbitSearch;

double in_degrees(double angle) { return degrees_per_radian * angle; }

template <int N>
class CrankSearch : public OrbitSearch<CrankSystem<double, N>> {
 public:
  CrankSearch(const Vehicle<double>& vehicle, const SteadyOptions& options)
      : OrbitSearch<CrankSystem<double, N>>(
            {vehicle, 1e-4 * no_load_speed(vehicle), vehicle.voltage / circuit_resistance(vehicle)}, options) {}

  /// One search from crank speed omega at crank angle zero; without a current, the quasi-steady one is assumed.
  bool from(double omega, double current = absent) {
    const auto& system = this->system();
    if (!(omega > system.speed_floor)) return false;
    if constexpr (N == 2) {
      return this->search(
          {omega, std::isfinite(current) ? current : algebraic_current(system.vehicle, system.vehicle.voltage, omega)});
    } else {
      return this->search({omega});
    }
  }
  /// The same from where a simulation in time has settled.
  bool near(double omega, double current) {
    if (!(omega > this->system().speed_floor)) return false;
    if constexpr (N == 2) {
      return this->search_near({omega, current});
    } else {
      return this->search_near({omega});
    }
  }
  double crank_speed() const { return this->start()[0]; }
};

std::string stall_detail(const StaticBalance& s) {
  return format("the motor never starts: its stall torque %.4g N m does not exceed the constant friction %.4g N m",
                s.stall_torque, s.breakaway_torque);
}

std::string jam_detail(const StaticBalance& s) {
  if (s.lever_min <= 0.0) {
    return format("the rod force loses its lever on the wings at crank angle %.1f deg (least lever %.3g m)",
                  in_degrees(s.lever_angle), s.lever_min);
  }
  return format(
      "the equations of motion lose their unique solution at crank angle %.1f deg: the rotor is too light "
      "for the friction (effective inertia %.3g kg m2)",
      in_degrees(s.inertia_angle), s.inertia_min);
}

std::string lock_list(const Vehicle<double>& vehicle) {
  std::string text;
  for (const LockInterval& lock : lock_intervals(vehicle)) {
    if (!text.empty()) text += ", ";
    text += lock.to - lock.from < 1e-6 ? format("%.1f deg", in_degrees(lock.angle))
                                       : format("%.1f to %.1f deg", in_degrees(lock.from), in_degrees(lock.to));
  }
  return text;
}

template <int N>
SteadyFlapping search(const Vehicle<double>& vehicle, const SteadyOptions& options, const StartUp& start_up) {
  SteadyFlapping result;
  result.metrics.values.fill(absent);
  result.balance = static_balance(vehicle);
  const StaticBalance& statics = result.balance;
  if (statics.stalled()) {
    result.status = FlappingStatus::stalled;
    result.detail = stall_detail(statics);
    return result;
  }

  CrankSearch<N> orbit(vehicle, options);
  bool found = false, ambiguous = false;
  if (!statics.can_jam()) {
    const BalancedSpeed<double> balanced = balanced_speed(vehicle);
    found = balanced.count > 0.0 && orbit.from(balanced.slowest);
    // The fastest start: if cycles from there fail, no slower one can be expected to last.
    if (!found) found = orbit.from(no_load_speed(vehicle));
    ambiguous = balanced.count > 1.0 || (found && hardly_returns(vehicle, orbit.multiplier(), 1.0 / orbit.frequency()));
  }

  std::optional<StartUpOutcome> outcome;
  if ((statics.can_jam() || statics.can_lock() || ambiguous || !found) && start_up) {
    outcome = start_up(vehicle);
    if (outcome->status != FlappingStatus::flapping) {
      result.status = outcome->status;
      result.detail = outcome->detail;
      if (found) {
        result.detail += format("; a rotating orbit at %.4g Hz exists for a faster start", orbit.frequency());
      }
      result.summary = orbit.summary();
      return result;
    }
    if (outcome->settled) {
      const auto is_reached = [&](double closeness) {
        return std::abs(orbit.crank_speed() - outcome->crank_speed) < closeness * outcome->crank_speed &&
               orbit.multiplier() < 1.0;
      };
      found = (found && is_reached(1e-3)) || (orbit.near(outcome->crank_speed, outcome->current) && is_reached(1e-2));
    } else if (ambiguous) {
      found = false;  // it rotates, but nobody says on which orbit
    }
  } else if (found) {
    found = orbit.multiplier() < 1.0;
  }
  result.summary = orbit.summary();
  if (found) {
    result.status = FlappingStatus::flapping;
    result.detail = format("steady flapping at %.4g Hz", orbit.frequency());
    if (statics.can_lock()) {
      result.detail += start_up ? "; once stopped, the crank also locks at crank angles "
                                : "; the crank also locks at crank angles ";
      result.detail += lock_list(vehicle);
    }
    orbit.fill(result);
    return result;
  }
  if (outcome) {
    detail::fill_simulated(*outcome, options, "crank angle", result);
    return result;
  }
  if (statics.can_jam()) {
    result.status = FlappingStatus::jammed;
    result.detail = jam_detail(statics);
  } else if (result.summary.status == solver::PeriodicStatus::converged) {
    result.status = FlappingStatus::undecided;
    result.detail = format(
        "the only orbit found, at %.4g Hz, is unstable (Floquet multiplier %.4g), and nobody says what "
        "start-up does",
        orbit.frequency(), orbit.multiplier());
  } else {
    result.status = FlappingStatus::locked;
    result.detail = format("no rotating orbit: cycles end at crank angle %.1f deg (%s)",
                           in_degrees(result.summary.stop), result.summary.message.c_str());
    if (statics.can_lock()) result.detail += "; the crank locks at crank angles " + lock_list(vehicle);
  }
  return result;
}

}  // namespace

void detail::fill_simulated(const StartUpOutcome& outcome, const SteadyOptions& options, const char* variable,
                            SteadyFlapping& result) {
  if (outcome.settled && outcome.cycle) result.simulated = outcome.cycle(options.tolerance, options.reporting);
  const std::string& why = result.summary.message;
  if (!result.simulated) {
    result.status = FlappingStatus::undecided;
    result.detail = format(
        "it rotates when simulated in time, but neither a periodic orbit in %s (%s) nor a simulated "
        "cycle was found that it settles on",
        variable, why.c_str());
    return;
  }
  result.status = FlappingStatus::flapping;
  result.metrics = result.simulated->metrics;
  result.crank_speed = outcome.crank_speed;
  result.current = outcome.current;
  result.detail = format(
      "steady flapping at %.4g Hz, from its cycle simulated in time to %.1g%s: the search for an orbit "
      "in %s found none that start-up reaches (%s)",
      result.metrics[Metric::frequency], result.simulated->error_estimate,
      result.simulated->cycles > 1 ? format(", which repeats after %d turns", result.simulated->cycles).c_str() : "",
      variable, why.c_str());
}

SteadyFlapping detail::find_flapping_as_it_is(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                              const StartUp& start_up) {
  if (!drive_of(vehicle).rotates) return detail::find_direct_flapping(vehicle, options, start_up);
  return vehicle.motor.armature_inductance > 0.0 ? search<2>(vehicle, options, start_up)
                                                 : search<1>(vehicle, options, start_up);
}

SteadyFlapping find_steady_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                    const StartUp& start_up) {
  return heats_up(vehicle.thermal) ? detail::find_warm_flapping(vehicle, options, start_up)
                                   : detail::find_flapping_as_it_is(vehicle, options, start_up);
}

}  // namespace wingbeat
