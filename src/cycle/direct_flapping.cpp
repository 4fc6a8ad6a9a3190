// How the steady flapping of a direct drive is found: docs/direct-drive.md.
#include <cmath>

#include "wingbeat/cycle/direct_balance.hpp"
#include "wingbeat/cycle/orbit_search.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

using Evidence = StatusEvidence::Kind;

template <int N>
SteadyFlapping search_response(const Vehicle<double>& vehicle, const SteadyOptions& options, const StartUp& start_up,
                               solver::WorkBudget& work) {
  using System = DirectSystem<double, N>;
  using State = typename System::State;
  SteadyFlapping result;
  const DirectBalance balance = direct_balance(vehicle);
  if (stalls(vehicle, balance, result)) return result;

  const auto state = [](double stroke, double speed, double current) {
    State y{};
    y[0] = stroke;
    y[1] = speed;
    if constexpr (N == 3) y[2] = current;
    return y;
  };
  // Constant friction that a harmonic motion cannot overcome leaves short slips: their size, from what is left of the
  // drive.
  const double w = two_pi * vehicle.drive_frequency;
  const double inertia = vehicle.motor.inertia + vehicle.wing_count * vehicle.wing_inertia;
  const double slip_speed = (balance.drive_torque - balance.breakaway_torque) / (inertia * w);
  const double speed = balance.responses.empty() ? slip_speed : std::abs(balance.responses.back().speed);
  const double current = balance.drive_torque / vehicle.motor.torque_constant;
  OrbitSearch<System> orbit(System(vehicle, state(speed / w, speed, current)), options, work);

  const auto from_rest = [&] { return orbit.search(state(0.0, 0.0, 0.0)); };
  const auto from_harmonic = [&](const HarmonicResponse& r) {
    return orbit.search(state(r.stroke.imag(), r.speed.imag(), r.current.imag()));
  };
  bool found = balance.responses.empty() ? from_rest() : from_harmonic(balance.responses.front());
  if (!found && !balance.responses.empty()) found = from_rest();
  // Nothing returns a shaft without springs to any angle: a multiplier of 1 there.
  const bool springs = vehicle.spring.stiffness > 0.0;
  const auto is_stable = [&] { return !springs || orbit.multiplier() < 1.0; };
  if ((balance.responses.size() > 1 || !found || !is_stable()) && start_up) {
    const StartUpOutcome outcome = start_up(vehicle);
    result.summary = orbit.summary();
    if (outcome.status != FlappingStatus::flapping) {
      result.status = outcome.status;
      result.evidence = outcome.evidence;
      if (result.status == FlappingStatus::undecided) result.evidence.search = orbit.summary().status;
      return result;
    }
    if (outcome.settled) {
      const State reached = state(outcome.stroke_angle, outcome.crank_speed, outcome.current);
      found = (orbit.search(reached) || orbit.search_near(reached)) && is_stable();
      result.summary = orbit.summary();
    }
    if (!found) {
      fill_simulated(outcome, options, true, result);
      return result;
    }
  }
  result.summary = orbit.summary();
  if (!found || !is_stable()) {
    result.status = FlappingStatus::undecided;
    if (found) result.evidence = {.kind = Evidence::unstable_response, .multiplier = orbit.multiplier()};
    else result.evidence = {.kind = Evidence::no_response, .search = orbit.summary().status};
    return result;
  }
  orbit.fill(result);
  if (!springs) result.metrics[Metric::floquet_multiplier_max] = absent;
  result.status = FlappingStatus::flapping;
  result.evidence = {.kind = Evidence::response,
                     .frequency = vehicle.drive_frequency,
                     .stroke_amplitude = result.metrics[Metric::stroke_amplitude]};
  return result;
}

}  // namespace

SteadyFlapping find_direct_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                    const StartUp& start_up, SharedSearch& shared) {
  return has_current_state(vehicle) ? search_response<3>(vehicle, options, start_up, shared.work)
                                    : search_response<2>(vehicle, options, start_up, shared.work);
}

}  // namespace wingbeat::detail
