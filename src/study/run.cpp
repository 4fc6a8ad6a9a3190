#include "wingbeat/study/run.hpp"

#include <algorithm>
#include <cmath>

#include "study/pitch_search.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/cycle/thermal_equilibrium.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/study/hold.hpp"
#include "wingbeat/vehicle/drive.hpp"

namespace wingbeat {
namespace {

constexpr double transient_tightest = 1e-11;

using detail::format;

/// Refuses a supply whose voltage cannot be chosen: `wanted` depends on it.
void require_choice_of_voltage(const Supply<double>& supply, const char* wanted, bool lift) {
  if (supply.type == SupplyType::sine) {
    throw ParameterError("supply.type", format("a sine supply has no voltage that sets the %s", wanted));
  }
  if (supply.type == SupplyType::pwm && !(supply.duty > 0.0) && !lift) {
    throw ParameterError("supply.duty", format("is 0: no voltage reaches the motor, so none sets the %s", wanted));
  }
}

void set_duty(Supply<double>& supply, double mean, double lift) {
  const double duty = mean / supply.voltage;
  if (!(duty <= 1.0)) {
    throw ParameterError("supply.voltage", format("%.5g N of lift takes %.4g V on average, more than the %.4g V that "
                                                  "the supply gives at a duty of 1",
                                                  lift, mean, supply.voltage));
  }
  supply.duty = duty;
}

/// What is asked for beside the supply as it is.
std::optional<Hold> hold_of(const RunOptions& options, const Supply<double>& supply) {
  const SearchRange range = options.allow_extrapolation ? SearchRange::extrapolation : SearchRange::domain;
  const double highest = highest_voltage(supply);
  if (options.lift) return Hold{Held::lift, *options.lift, range, highest};
  if (options.power) return Hold{Held::power, *options.power, range, highest};
  if (options.frequency) return Hold{Held::frequency, *options.frequency, range, highest};
  return std::nullopt;
}

/// Names what a duty of 1 gives where the answer would take more.
void note_full_duty(const Supply<double>& supply, const Hold& hold, FrequencySearch& search) {
  const bool needs_more =
      supply.type == SupplyType::pwm && hold.held == Held::lift && search.closest_voltage > supply.voltage;
  const bool needs_all = supply.type == SupplyType::battery && search.outcome == FrequencyOutcome::too_high;
  if (needs_more) search.finding.full_duty_voltage = supply.voltage;
  if (needs_all) search.finding.full_duty_voltage = hold.highest_voltage;
}

void run_orbit(const Vehicle<double>& vehicle, const RunOptions& options, RunResult& result) {
  SteadyOptions steady;
  steady.tolerance = options.tolerance;
  steady.reporting = reporting_of(result.design);
  const SteadyFlapping found = find_steady_flapping(vehicle, steady, start_up_in_time());
  result.status = found.status;
  result.evidence = found.evidence;
  result.metrics = found.metrics;
  result.settled = found.status != FlappingStatus::undecided;
  result.orbit = found.summary;
  result.simulated_cycle = found.simulated.has_value();
  if (result.design.supply.type == SupplyType::pwm) result.mean_voltage = vehicle.voltage;
  if (options.waveform_rows > 1 && !found.record.empty()) {
    result.cycle = found.record.waveform(options.waveform_rows);
  } else if (options.waveform_rows > 1 && found.simulated) {
    Vehicle<double> warm = heats_up(vehicle.thermal) ? with_motor_at(vehicle, found.temperatures) : vehicle;
    warm = in_air(warm, air_of(found.metrics));
    TransientOptions transient;
    transient.tolerance = std::max(options.tolerance, transient_tightest);
    transient.cycle_rows = options.waveform_rows;
    result.cycle = simulate_start_up(warm, transient).cycle;
  }
}

/// Simulates start-ups until the settled cycle leads to what it was simulated at: `simulate` does so where the
/// equilibrium is, `advance(found, metrics)` tells it what came out, metrics that are absent where it does not flap.
template <class Equilibrium, class Simulate, class Advance>
TransientResult simulate_until_settled(Equilibrium& equilibrium, TransientOptions transient, const Simulate& simulate,
                                       const Advance& advance) {
  transient.tolerance = std::max(tolerance_within_equilibrium(transient.tolerance), transient_tightest);
  TransientResult found;
  Metrics<double> metrics;
  do {
    found = simulate(transient);
    metrics.values.fill(absent);
    if (found.status == FlappingStatus::flapping && found.metrics) metrics = *found.metrics;
  } while (!advance(found, metrics));
  if (!conclude(equilibrium, found.status, found.evidence)) {
    found.metrics.reset();
    found.settled = false;
  }
  return found;
}

bool flaps(const TransientResult& found) { return found.status == FlappingStatus::flapping && found.metrics; }

/// Simulates start-ups until the motor is as warm as its losses in the settled cycle make it. `vehicle` is then that
/// one.
TransientResult simulate_warm(Vehicle<double>& vehicle, const TransientOptions& transient) {
  if (!heats_up(vehicle.thermal)) return simulate_start_up(vehicle, transient);
  const Vehicle<double> stated = vehicle;
  ThermalEquilibrium equilibrium(stated.thermal, transient.tolerance);
  return simulate_until_settled(
      equilibrium, transient,
      [&](const TransientOptions& within) {
        vehicle = with_motor_at(stated, equilibrium.at());
        return simulate_start_up(vehicle, within);
      },
      [&](const TransientResult& found, const Metrics<double>& metrics) {
        return equilibrium.advance(flaps(found), metrics, found.status != FlappingStatus::undecided);
      });
}

/// simulate_warm() in the air that the settled cycle leads to.
TransientResult simulate_settled(Vehicle<double>& vehicle, const TransientOptions& transient) {
  if (!settles_air(vehicle)) return simulate_warm(vehicle, transient);
  const Vehicle<double> stated = vehicle;
  AirEquilibrium equilibrium(stated, transient.tolerance);
  return simulate_until_settled(
      equilibrium, transient,
      [&](const TransientOptions& within) {
        vehicle = in_air(stated, equilibrium.at());
        return simulate_warm(vehicle, within);
      },
      [&](const TransientResult& found, const Metrics<double>& metrics) {
        return equilibrium.advance(flaps(found), metrics);
      });
}

void run_transient(Vehicle<double> vehicle, const RunOptions& options, RunResult& result) {
  TransientOptions transient;
  transient.tolerance = std::max(options.tolerance, transient_tightest);
  transient.reporting = reporting_of(result.design);
  if (!drive_of(vehicle).alternating) transient.supply = result.design.supply;
  transient.cycle_rows = options.waveform_rows > 1 ? options.waveform_rows : 0;
  result.start_up = simulate_settled(vehicle, transient);
  const TransientResult& found = *result.start_up;
  result.status = found.status;
  result.evidence = found.evidence;
  result.settled = found.settled;
  if (found.metrics && found.status == FlappingStatus::flapping) {
    result.metrics = *found.metrics;
    result.cycle = found.cycle;
  }
}

void note_domain(const Vehicle<double>& vehicle, RunResult& result) {
  if (result.status != FlappingStatus::flapping || !std::isfinite(result.metrics[Metric::frequency])) return;
  result.domain = domain_of(vehicle, result.metrics);
  result.domain_evidence = domain_evidence(vehicle, result.metrics);
  result.residual_share = notable_residual(vehicle, result.metrics);
  result.added_mass_lift = notable_added_mass_lift(result.metrics);
  result.hot_winding = hot_winding(vehicle, result.metrics);
}

}  // namespace

RunResult run_design(const Design<double>& design, const RunOptions& options) {
  if (options.angle_of_attack || needs_pitch_coefficient(design, options.condition)) {
    return detail::run_at_angle_of_attack(design, options);
  }
  require(options.tolerance >= 1e-12 && options.tolerance <= 1e-2, "tolerance", "must lie between 1e-12 and 1e-2", "1",
          options.tolerance);
  const Supply<double>& supply = design.supply;
  const Drive drive = drive_of(design);
  require(!(options.frequency && options.lift), "lift", "cannot be asked for beside a frequency", "N",
          options.lift.value_or(0.0));
  require(!(options.power && (options.frequency || options.lift)), "power",
          "cannot be asked for beside a frequency or a lift", "W", options.power.value_or(0.0));
  if (options.power) {
    require(*options.power > 0.0 && std::isfinite(*options.power), "power", "must be > 0 and finite", "W",
            *options.power);
  }
  if (options.frequency) {
    require(*options.frequency > 0.0 && std::isfinite(*options.frequency), "frequency", "must be > 0 and finite", "Hz",
            *options.frequency);
  }
  if (options.lift) {
    require(*options.lift > 0.0 && std::isfinite(*options.lift), "lift", "must be > 0 and finite", "N", *options.lift);
  }
  if (options.frequency && drive.voltage_sets_frequency) require_choice_of_voltage(supply, "flapping frequency", false);
  if (options.power && !drive.alternating) require_choice_of_voltage(supply, "electrical power", false);
  if (options.lift && !drive.alternating) require_choice_of_voltage(supply, "lift", true);
  if (supply.type == SupplyType::sine && !drive.alternating && options.method == Method::orbit) {
    throw ParameterError("supply.type",
                         "with a sine supply the crank has no periodic orbit in crank angle; simulate "
                         "it in time with --method transient");
  }
  RunResult result;
  result.metrics.values.fill(absent);
  result.design = design;
  const bool driven = options.frequency && set_drive_frequency(result.design, *options.frequency);
  const std::optional<Hold> hold = driven ? std::nullopt : hold_of(options, supply);
  Design<double> searched = result.design;
  if (hold) set_full_duty(searched.supply);
  if (hold && hold->held == Held::lift) searched.supply.duty = 1.0;  // of pwm the duty is found as well
  Vehicle<double> vehicle = resolve(searched, options.condition);
  if (hold) {
    SteadyOptions steady;
    steady.tolerance = options.tolerance;
    result.search = find_voltage(vehicle, *hold, steady, start_up_in_time());
    note_full_duty(supply, *hold, *result.search);
    if (result.search->outcome != FrequencyOutcome::reached) {
      result.status = result.search->status;
      result.settled = result.status != FlappingStatus::undecided;
      return result;
    }
    if (options.lift && supply.type == SupplyType::pwm) {
      set_duty(result.design.supply, result.search->voltage, *options.lift);
    } else {
      set_voltage(result.design.supply, result.search->voltage);
    }
    set_mean_voltage(vehicle, result.search->voltage);
  }
  if (options.method == Method::orbit) {
    run_orbit(vehicle, options, result);
  } else {
    run_transient(vehicle, options, result);
  }
  note_domain(vehicle, result);
  const bool flies = has_battery(supply.type) && result.status == FlappingStatus::flapping;
  if (options.endurance && flies) {
    const FlightMetrics wanted{true, true, options.allow_extrapolation};
    const Endurance flight = endurance_of(result.design, options.condition, options.tolerance, {}, wanted);
    result.metrics[Metric::hover] = flight.hover;
    result.metrics[Metric::endurance] = flight.time;
  }
  return result;
}

}  // namespace wingbeat
