// Statuses in words. Here and not in report: the bare core says them, too.
#include <cmath>

#include "wingbeat/core/text.hpp"
#include "wingbeat/cycle/pitch_metrics.hpp"
#include "wingbeat/cycle/status_evidence.hpp"

namespace wingbeat {
namespace {

using detail::format;

double in_degrees(double angle) { return degrees_per_radian * angle; }

std::string lock_list(const StatusEvidence& e) {
  std::string text;
  for (const LockInterval& lock : e.locks) {
    if (!text.empty()) text += ", ";
    text += lock.to - lock.from < 1e-6 ? format("%.1f deg", in_degrees(lock.angle))
                                       : format("%.1f to %.1f deg", in_degrees(lock.from), in_degrees(lock.to));
  }
  return text;
}

const char* phase_of(const StatusEvidence& e) { return e.direct ? "the phase of the supply" : "crank angle"; }

/// What is to be said of wings that pitch on a hinge.
std::string describe_pitching(const StatusEvidence& e) {
  std::string text;
  if (e.over_rotation > notable_over_rotation) {
    text += format("; the wings over-rotate: their angle of attack is beyond 90 deg for %.0f %% of the period",
                   100.0 * e.over_rotation);
  }
  if (std::isfinite(e.other_frequency)) {
    text += format("; a second stable orbit exists, at %.4g Hz", e.other_frequency);
  }
  if (std::isfinite(e.other_amplitude)) {
    text += format("; a second stable response to the same supply exists, with a stroke of +-%.1f deg",
                   in_degrees(e.other_amplitude));
  }
  return text;
}

std::string describe_flapping(const StatusEvidence& e) {
  switch (e.kind) {
    case StatusEvidence::Kind::orbit: {
      std::string text = format("steady flapping at %.4g Hz", e.frequency);
      if (e.can_lock) {
        text += e.assessed ? "; once stopped, the crank also locks at crank angles "
                           : "; the crank also locks at crank angles ";
        text += lock_list(e);
      }
      return text + describe_pitching(e);
    }
    case StatusEvidence::Kind::response: {
      std::string text = format("steady flapping at the supply's %.4g Hz", e.frequency);
      if (e.stroke_amplitude > 0.5 * pi) {
        text += format("; a stroke of +-%.0f deg passes the quarter turn that wings have room for",
                       in_degrees(e.stroke_amplitude));
      }
      return text + describe_pitching(e);
    }
    case StatusEvidence::Kind::simulated_cycle:
      return format(
          "steady flapping at %.4g Hz, from its cycle simulated in time to %.1g%s: the search for an orbit "
          "in %s found none that start-up reaches (%s)",
          e.frequency, e.change,
          e.repeats_after > 1 ? format(", which repeats after %d turns", e.repeats_after).c_str() : "", phase_of(e),
          describe(e.search));
    case StatusEvidence::Kind::settled_cycles: {
      std::string text = format("flaps steadily at %.6g Hz from %.4g s on; after %d cycles they repeat to %.1g%s",
                                e.frequency, e.time, e.cycles, e.change,
                                e.extrapolated        ? " (slow convergence, extrapolated)"
                                : e.repeats_after > 1 ? format(" every %d cycles", e.repeats_after).c_str()
                                                      : "");
      if (std::isfinite(e.accuracy)) text += format(", within about %.1g of where they converge", e.accuracy);
      return text + describe_pitching(e);
    }
    case StatusEvidence::Kind::averaged_cycles:
      return format(
          "flaps at %.6g Hz, averaged over %d cycles whose durations differ by up to %.2g %% from their mean%s",
          e.frequency, e.cycles, 100.0 * e.change, e.incommensurate ? "; cycles and supply share no period" : "");
    case StatusEvidence::Kind::settled_periods: {
      std::string text =
          format("flaps steadily at the supply's %.6g Hz from %.4g s on; after %d periods they repeat to %.1g%s",
                 e.frequency, e.time, e.cycles, e.change, e.extrapolated ? " (slow convergence, extrapolated)" : "");
      if (std::isfinite(e.accuracy)) text += format(", metrics to about %.1g", e.accuracy);
      if (e.steps > 0) text += format(": the %ld integration steps allowed are used up", e.steps);
      return text + describe_pitching(e);
    }
    default: return "";
  }
}

std::string describe_stall(const StatusEvidence& e) {
  switch (e.kind) {
    case StatusEvidence::Kind::weak_motor:
      return format("the motor never starts: its stall torque %.4g N m does not exceed the constant friction %.4g N m",
                    e.torque, e.friction_torque);
    case StatusEvidence::Kind::weak_supply:
      return format(
          "the motor never breaks away: at %.4g Hz the supply gives it a torque of %.4g N m at most, "
          "which does not exceed the constant friction %.4g N m",
          e.frequency, e.torque, e.friction_torque);
    case StatusEvidence::Kind::weak_alternation:
      return format(
          "no motion outlasts the start: at %.4g Hz the supply's torque alternates by +-%.4g N m, "
          "which does not exceed the constant friction %.4g N m",
          e.frequency, e.torque, e.friction_torque);
    case StatusEvidence::Kind::stalled_crank:
      return format(
          "the motor cannot turn: stall torque %.4g N m does not exceed the constant friction of "
          "%.4g N m (crank at %.4f deg)",
          e.torque, e.friction_torque, in_degrees(e.angle));
    case StatusEvidence::Kind::held_shaft:
      return format(
          "rests at stroke angle %.4f deg: the constant friction %.4g N m holds %.4g N m, "
          "all that supply and springs apply at most",
          in_degrees(e.angle), e.friction_torque, e.torque);
    case StatusEvidence::Kind::creeping_shaft:
      return format(
          "creeps to rest near stroke angle %.4f deg, the last period by %.2g deg: the supply gives a torque "
          "of %.4g N m at most, which does not exceed the constant friction %.4g N m",
          in_degrees(e.angle), in_degrees(e.travel), e.torque, e.friction_torque);
    case StatusEvidence::Kind::no_voltage: return "no voltage: nothing moves the wings";
    default: return "";
  }
}

std::string describe_lock_or_jam(const StatusEvidence& e) {
  switch (e.kind) {
    case StatusEvidence::Kind::no_orbit: {
      std::string text =
          format("no rotating orbit: cycles end at crank angle %.1f deg (%s)", in_degrees(e.angle), describe(e.search));
      if (e.can_lock) text += "; the crank locks at crank angles " + lock_list(e);
      return text;
    }
    case StatusEvidence::Kind::friction_holds:
      return format(
          "rests at crank angle %.4f deg: friction holds %.4g N m there, %.4g N m more than motor and springs apply",
          in_degrees(e.angle), e.friction_torque, e.torque_margin);
    case StatusEvidence::Kind::springs_balance:
      return format(
          "rests at crank angle %.4f deg: the springs balance the stall torque of %.4g N m in a stable equilibrium",
          in_degrees(e.angle), e.torque);
    case StatusEvidence::Kind::swings:
      return format("does not rotate: the crank moves with the supply between %.4f and %.4f deg",
                    in_degrees(e.range->from), in_degrees(e.range->to));
    case StatusEvidence::Kind::lever_may_vanish:
      return format("the rod force loses its lever on the wings at crank angle %.1f deg (least lever %.3g m)",
                    in_degrees(e.angle), e.lever);
    case StatusEvidence::Kind::inertia_may_vanish:
      return format(
          "the equations of motion lose their unique solution at crank angle %.1f deg: the rotor is too light "
          "for the friction (effective inertia %.3g kg m2)",
          in_degrees(e.angle), e.inertia);
    case StatusEvidence::Kind::lever_vanishes:
      return format("jams at crank angle %.4f deg: the rod force loses its lever on the wings (g = %.2g m)",
                    in_degrees(e.angle), e.lever);
    case StatusEvidence::Kind::inertia_vanishes:
      return format(
          "jams at crank angle %.4f deg: rotor inertia and rod-force friction leave no unique "
          "acceleration (J + A (h - mu r_e) = %.2g kg m2)",
          in_degrees(e.angle), e.inertia);
    default: return "";
  }
}

/// Why a simulation in time was given up.
std::string describe_giving_up(const StatusEvidence& e) {
  switch (e.kind) {
    case StatusEvidence::Kind::out_of_steps: return format("no decision within %ld integration steps", e.steps);
    case StatusEvidence::Kind::out_of_time: return format("no decision within %.6g s", e.time);
    case StatusEvidence::Kind::cycles_differ:
      if (!std::isfinite(e.change)) return format("the cycles have not settled after %d", e.cycles);
      return format("the state still changes by %.2g of its size from one %s to the next after %d %ss", e.change,
                    e.direct ? "period" : "cycle", e.cycles, e.direct ? "period" : "cycle");
    case StatusEvidence::Kind::cancelled: return "cancelled";
    case StatusEvidence::Kind::runs_away:
      return format(
          "the crank speeds up without bound (%.3g rad/s): this transmission formulation does not conserve "
          "power and feeds it",
          e.crank_speed);
    case StatusEvidence::Kind::integrator_not_started: return "the integrator could not be started";
    case StatusEvidence::Kind::integrator_failed:
      return e.direct
                 ? format("the integrator failed at t = %.6g s", e.time)
                 : format("the integrator failed at t = %.6g s, crank angle %.4f deg", e.time, in_degrees(e.angle));
    default: return "";
  }
}

std::string describe_doubt(const StatusEvidence& e) {
  switch (e.kind) {
    case StatusEvidence::Kind::unstable_orbit:
      return format(
          "the only orbit found, at %.4g Hz, is unstable (Floquet multiplier %.4g), and no simulation shows what "
          "start-up does",
          e.frequency, e.multiplier);
    case StatusEvidence::Kind::unstable_response:
      return format("the periodic response to the supply is unstable (Floquet multiplier %.4g)", e.multiplier);
    case StatusEvidence::Kind::no_response:
      return format("no periodic response to the supply was found: %s", describe(e.search));
    case StatusEvidence::Kind::no_cycle:
      return format(
          "it rotates when simulated in time, but neither a periodic orbit in %s (%s) nor a simulated "
          "cycle was found that it settles on",
          phase_of(e), describe(e.search));
    case StatusEvidence::Kind::open_balance:
      return format(
          "the energy balance of the cycle found does not close, not even with finer steps: %.2g of the input "
          "is left over",
          e.change);
    case StatusEvidence::Kind::no_steady_temperature:
      return format("it flaps, but no steady winding temperature was found, at last near %.4g degC",
                    e.winding_temperature);
    case StatusEvidence::Kind::no_steady_air:
      return format(
          "it flaps in air at rest, but no steady state with the air that it sets in motion was found, at "
          "last near an induced velocity of %.4g m/s",
          e.induced_velocity);
    default: break;
  }
  const std::string why = describe_giving_up(e);
  if (e.direct) return why;
  if (!e.range) return format("%s; it flaps at %.6g Hz then", why.c_str(), e.frequency);
  return format("%s; the crank makes no forward revolutions then, it has been between %.4g and %.4g deg", why.c_str(),
                in_degrees(e.range->from), in_degrees(e.range->to));
}

}  // namespace

std::string describe(const StatusEvidence& e) {
  using Kind = StatusEvidence::Kind;
  if (e.kind == Kind::none) return "";
  std::string text = e.kind < Kind::weak_motor       ? describe_flapping(e)
                     : e.kind < Kind::no_orbit       ? describe_stall(e)
                     : e.kind < Kind::unstable_orbit ? describe_lock_or_jam(e)
                                                     : describe_doubt(e);
  const bool simulated = e.kind >= Kind::out_of_steps;
  if (simulated && e.search != solver::PeriodicStatus::not_tried && e.search != solver::PeriodicStatus::converged) {
    text += format("; the search for an orbit ended without one before (%s)", describe(e.search));
  }
  if (std::isfinite(e.faster_orbit)) {
    text += format("; a rotating orbit at %.4g Hz exists for a faster start", e.faster_orbit);
  }
  if (std::isfinite(e.winding_temperature) && e.kind != Kind::no_steady_temperature) {
    text += format("; while the motor is colder it flaps, and heats up until the winding is at %.4g degC",
                   e.winding_temperature);
  }
  return text;
}

}  // namespace wingbeat
