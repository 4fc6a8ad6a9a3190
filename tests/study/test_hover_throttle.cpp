// The duty, or amplitude, at which the lift carries the weight: batteries under a speed control.
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <filesystem>
#include <random>

#include "study/battery_design.hpp"
#include "study/held_differences.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/study/ensemble_hold.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/study/sweep.hpp"

namespace wingbeat {
namespace {

Design<double> throttled_design() {
  Design<double> d = hovering_design();
  d.supply.throttle = Throttle::hover;
  return d;
}

SteadyFlapping flapping_of(const Design<double>& d, double tolerance = 1e-9) {
  return find_steady_flapping(resolve(d), {tolerance, false, reporting_of(d)});
}

/// By bisection of runs at stated duties; above 1 where none up to 1 carries the weight.
double duty_to_hover(Design<double> d, double charge) {
  d.supply.battery.charge = charge;
  const auto excess = [&](double duty) {
    d.supply.duty = duty;
    const double ratio = flapping_of(d).metrics[Metric::lift_to_weight];
    return std::isfinite(ratio) ? ratio - 1.0 : -1.0;
  };
  if (excess(1.0) < 0.0) return 2.0;
  std::uintmax_t rounds = 100;
  const auto found =
      boost::math::tools::toms748_solve(excess, 0.05, 1.0, boost::math::tools::eps_tolerance<double>(34), rounds);
  return 0.5 * (found.first + found.second);
}

/// Time from one charge to another by a quadrature of its own.
double time_between(const Design<double>& given, double from, double to) {
  Design<double> d = given;
  const auto per_charge = [&](double charge) {
    d.supply.duty = duty_to_hover(given, charge);
    d.supply.battery.charge = charge;
    return d.supply.battery.capacity / (d.supply.duty * flapping_of(d).metrics[Metric::current_mean]);
  };
  std::vector<double> ends{to};
  for (const auto& [charge, voltage] : d.supply.battery.discharge_curve) {
    if (charge > to && charge < from) ends.push_back(charge);
  }
  ends.push_back(from);
  double time = 0.0;
  for (std::size_t k = 1; k < ends.size(); ++k) {
    time += boost::math::quadrature::gauss<double, 7>::integrate(per_charge, ends[k - 1], ends[k]);
  }
  return time;
}

Design<double> random_throttled(std::mt19937_64& random) {
  std::uniform_real_distribution<double> scatter(0.85, 1.15), unit(0.0, 1.0);
  Design<double> d = throttled_design();
  d.supply.battery.internal_resistance = 0.6 * unit(random);
  d.supply.battery.capacity *= scatter(random);
  d.supply.battery.charge = 0.8 + 0.2 * unit(random);
  if (unit(random) < 0.3) d.supply.battery.cutoff_voltage = 2.9;
  *d.mass *= 0.6 + 0.5 * unit(random);
  d.motor.constants.armature_resistance *= scatter(random);
  d.motor.constants.torque_constant *= scatter(random);
  d.aerodynamics.air_density *= scatter(random);
  return d;
}

TEST(HoverThrottle, TimeIsThatOfAnIndependentIntegration) {
  std::mt19937_64 random(20261127);
  int sinks = 0, cut = 0, empty = 0;
  for (int n = 0; n < 20;) {
    const Design<double> d = random_throttled(random);
    const EnduranceResult r = simulate_discharge(d, {.tolerance = 1e-8, .allow_extrapolation = true});
    if (!(r.endurance() > 0.0)) {
      EXPECT_EQ(r.end, EnduranceEnd::sinks) << describe(r);
      EXPECT_GT(duty_to_hover(d, d.supply.battery.charge), 1.0) << describe(r);
      continue;
    }
    SCOPED_TRACE(std::to_string(n++) + ": " + describe(r));
    const double last = r.rows.back().charge;
    if (r.end == EnduranceEnd::sinks) {
      ++sinks;
      EXPECT_GT(duty_to_hover(d, last - 1e-7), 1.0);
      EXPECT_NEAR(duty_to_hover(d, last + 1e-7), 1.0, 1e-5);
    } else if (r.end == EnduranceEnd::cutoff) {
      ++cut;
      EXPECT_NEAR(r.rows.back().terminal_voltage, *r.cutoff_voltage, 1e-8);
    } else {
      ++empty;
      EXPECT_EQ(r.end, EnduranceEnd::empty);
      EXPECT_EQ(last, 0.0);
    }
    const double time = time_between(d, d.supply.battery.charge, last);
    EXPECT_NEAR(r.endurance() / time, 1.0, 1e-6);
    EXPECT_EQ(r.hover, Hover::kept);
    EXPECT_EQ(r.hover_time(), r.endurance());
    const Endurance metric = endurance_of(d, Condition::air, 1e-6, {}, {true, true, true});
    EXPECT_NEAR(metric.hover / time, 1.0, 2e-6);
  }
  EXPECT_GT(sinks, 2);
  EXPECT_GT(cut, 2);
  EXPECT_GT(empty, 2);
}

// Without an internal resistance the motor sees the same at every charge, and the battery gives the same power.
TEST(HoverThrottle, WithoutResistanceTheEnergyLastsForAConstantPower) {
  Design<double> d = throttled_design();
  d.supply.battery.internal_resistance = 0.0;
  *d.mass *= 0.7;
  const EnduranceResult r = simulate_discharge(d, {.allow_extrapolation = true});
  ASSERT_EQ(r.end, EnduranceEnd::empty) << describe(r);
  const double power = r.rows.front().metrics[Metric::power_electrical];
  const double energy = d.supply.battery.capacity * mean_open_circuit_voltage(d.supply.battery);
  EXPECT_NEAR(r.endurance() * power / energy, 1.0, 1e-8);
  for (const EnduranceRow& row : r.rows) {
    EXPECT_NEAR(row.metrics[Metric::power_electrical] / power, 1.0, 1e-8);
    EXPECT_NEAR(row.duty * row.open_circuit_voltage / r.rows.front().open_circuit_voltage, r.rows.front().duty, 1e-8);
  }
}

TEST(HoverThrottle, RowsCarryTheWeightAndSayWhatFullDutyWouldLift) {
  const Design<double> d = throttled_design();
  const EnduranceResult r = simulate_discharge(d, {.allow_extrapolation = true});
  ASSERT_GT(r.rows.size(), 10u) << describe(r);
  const double chemical = d.supply.battery.capacity;
  double energy = 0.0;
  for (std::size_t n = 0; n < r.rows.size(); n += 7) {
    const EnduranceRow& row = r.rows[n];
    EXPECT_NEAR(row.metrics[Metric::lift_to_weight], 1.0, 1e-9);
    Design<double> full = d;
    full.supply.battery.charge = row.charge;
    EXPECT_NEAR(flapping_of(full).metrics[Metric::lift_to_weight] / row.full_lift_to_weight, 1.0, 1e-8);
    EXPECT_EQ(row.full_domain, domain_of(resolve(full), flapping_of(full).metrics));
    EXPECT_GT(row.full_lift_to_weight, 0.999999);
    EXPECT_NEAR(row.battery_current, row.duty * row.metrics[Metric::current_mean], 1e-12);
    EXPECT_NEAR(row.terminal_voltage * row.duty, row.metrics[Metric::voltage], 1e-8);
  }
  const EnduranceRow& last = r.rows.back();
  for (std::size_t n = 1; n < r.rows.size(); ++n) {
    const double drawn = r.rows[n - 1].charge - r.rows[n].charge;
    energy += chemical * drawn * 0.5 * (r.rows[n - 1].open_circuit_voltage + r.rows[n].open_circuit_voltage);
  }
  EXPECT_NEAR((last.energy_electrical + last.energy_internal) / energy, 1.0, 1e-3);
}

TEST(HoverThrottle, HoverIsRefusedByWhatFullThrottleLifts) {
  Design<double> d = throttled_design();
  *d.mass *= 2.0;
  const EnduranceResult r = simulate_discharge(d);
  EXPECT_EQ(r.hover, Hover::never);
  EXPECT_EQ(r.end, EnduranceEnd::sinks);
  EXPECT_EQ(r.endurance(), 0.0);
  EXPECT_EQ(r.hover_time(), 0.0);
  EXPECT_NEAR(r.first_full_lift_to_weight, flapping_of(d).metrics[Metric::lift_to_weight], 1e-9);
  EXPECT_NE(describe(r).find("it does not hover: full throttle lifts 0."), std::string::npos) << describe(r);
  d.mass.reset();
  EXPECT_THROW(validate(d), ParameterError);
}

// Power into the motor is what leaves the battery's terminals, at each instant of the switched connection.
TEST(HoverThrottle, TheSpeedControlLosesNothing) {
  Design<double> d = hovering_design();
  d.supply.duty = 0.8;
  const RunResult r = run_design(d, {.tolerance = 1e-9, .waveform_rows = 721});
  ASSERT_EQ(r.status, FlappingStatus::flapping);
  const double E = open_circuit_voltage(d.supply.battery, d.supply.battery.charge);
  const double R_i = source_resistance(d.supply.battery);
  double motor = 0.0, battery = 0.0;
  for (std::size_t n = 0; n + 1 < r.cycle.size(); ++n) {
    const double i = 0.8 * r.cycle[n].current;
    EXPECT_NEAR(r.cycle[n].voltage, 0.8 * (E - R_i * i), 1e-9);
    motor += r.cycle[n].voltage * r.cycle[n].current;
    battery += (E - R_i * i) * i;
  }
  EXPECT_NEAR(motor / battery, 1.0, 1e-12);
}

TEST(HoverThrottle, RunFindsTheDuty) {
  const Design<double> d = hovering_design();
  const double weight = reporting_of(d).mass * standard_gravity;
  const RunResult by_lift = run_design(d, {.tolerance = 1e-9, .lift = weight, .allow_extrapolation = true});
  ASSERT_EQ(by_lift.search->outcome, FrequencyOutcome::reached) << describe(by_lift);
  EXPECT_NEAR(by_lift.design.supply.duty, duty_to_hover(d, d.supply.battery.charge), 1e-8);
  EXPECT_NEAR(by_lift.metrics[Metric::lift_to_weight], 1.0, 1e-8);
  EXPECT_NEAR(flapping_of(by_lift.design).metrics[Metric::lift_to_weight], 1.0, 1e-8);

  const double frequency = by_lift.metrics[Metric::frequency];
  const RunResult by_frequency =
      run_design(d, {.tolerance = 1e-9, .frequency = frequency, .allow_extrapolation = true});
  EXPECT_NEAR(by_frequency.design.supply.duty / by_lift.design.supply.duty, 1.0, 1e-7);

  const double max_lift = flapping_of(d).metrics[Metric::lift_mean];
  const RunResult beyond = run_design(d, {.lift = 1.01 * max_lift, .allow_extrapolation = true});
  ASSERT_EQ(beyond.search->outcome, FrequencyOutcome::too_high) << describe(beyond);
  EXPECT_NEAR(beyond.search->closest_value / max_lift, 1.0, 1e-5);
  const RunResult faster =
      run_design(d, {.frequency = 1.5 * flapping_of(d).metrics[Metric::frequency], .allow_extrapolation = true});
  EXPECT_EQ(faster.search->outcome, FrequencyOutcome::too_high) << describe(faster);
}

TEST(HoverThrottle, HeldLiftsOfBatteriesInBatchesAreThoseOfOne) {
  std::mt19937_64 random(5);
  std::vector<Design<double>> designs;
  std::vector<EnsembleMember> members;
  std::vector<Hold> holds;
  for (int n = 0; n < 40; ++n) {
    designs.push_back(random_throttled(random));
    members.push_back({resolve(designs.back()), reporting_of(designs.back())});
    holds.push_back({Held::lift_to_weight, 1.0, SearchRange::coefficients, highest_voltage(designs.back().supply)});
  }
  std::vector<EnsembleOutcome> outcomes(members.size());
  std::vector<FrequencyOutcome> reached(members.size());
  EnsembleOptions options;
  options.tolerance = 1e-8;
  solve_ensemble_held(members, holds, options, start_up_in_time(), outcomes, reached);
  int held = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    DesignPointOptions one;
    one.hold = Hold{Held::lift_to_weight, 1.0};
    one.tolerance = 1e-8;
    const DesignPoint point = design_point(designs[n], one, {}, start_up_in_time());
    ASSERT_EQ(point.status == SweepStatus::flapping, reached[n] == FrequencyOutcome::reached) << describe(point);
    if (point.status != SweepStatus::flapping) continue;
    ++held;
    for (const Metric m : {Metric::voltage, Metric::power_electrical, Metric::frequency, Metric::lift_mean}) {
      EXPECT_NEAR(outcomes[n].metrics[m] / point.metrics[m], 1.0, 1e-6) << metric_info(m).key;
    }
    Supply<double> supply = designs[n].supply;
    set_voltage(supply, point.voltage);
    EXPECT_NEAR(supply.duty, duty_to_hover(designs[n], supply.battery.charge), 1e-6);
  }
  EXPECT_GT(held, 15);
  EXPECT_LT(held, 40);
}

TEST(HoverThrottle, DerivativesFollowTheDuty) {
  DesignPointOptions options;
  options.hold = Hold{Held::lift_to_weight, 1.0};
  options.tolerance = 1e-9;
  expect_held_derivatives(
      hovering_design(), options,
      {"vehicle.mass", "supply.internal_resistance", "supply.charge", "motor.armature_resistance", "spring.stiffness"},
      {Metric::power_electrical, Metric::frequency, Metric::voltage, Metric::rod_force_peak}, 2e-6);
}

/// The flight at a stated duty, or amplitude, that a bisection of single runs has found to lift `ratio` at the start.
Endurance flight_from(Design<double> d, double ratio) {
  d.supply.throttle = Throttle::fixed;
  Design<double> lighter = d;
  *lighter.mass *= ratio;
  d.supply.duty = duty_to_hover(lighter, d.supply.battery.charge);
  return endurance_of(d, Condition::air, 1e-8, {}, {true, true, true});
}

// A lift is held at the start; from there a battery of fixed throttle keeps the duty that was found.
TEST(HoverThrottle, AFlightFromAHeldLiftKeepsTheDutyFound) {
  for (const double ratio : {1.02, 1.1}) {
    SCOPED_TRACE(ratio);
    const Design<double> d = hovering_design();
    const Endurance expected = flight_from(d, ratio);
    const Endurance stated = endurance_of(d, Condition::air, 1e-8, {}, {true, true, true});
    ASSERT_GT(expected.hover, 0.0);
    ASSERT_GT(std::abs(expected.time / stated.time - 1.0), 1e-2);

    DesignPointOptions options;
    options.hold = Hold{Held::lift_to_weight, ratio};
    options.tolerance = 1e-8;
    options.flight = {true, true, true};
    const DesignPoint point = expect_held_derivatives(d, options, {"vehicle.mass", "motor.armature_resistance"},
                                                      {Metric::hover, Metric::endurance}, 1e-3, 1e-3);
    EXPECT_NEAR(point.metrics[Metric::hover] / expected.hover, 1.0, 1e-5);
    EXPECT_NEAR(point.metrics[Metric::endurance] / expected.time, 1.0, 1e-5);

    const RunResult run = run_design(d, {.tolerance = 1e-8,
                                         .lift = ratio * reporting_of(d).mass * standard_gravity,
                                         .allow_extrapolation = true,
                                         .endurance = true});
    EXPECT_NEAR(run.metrics[Metric::hover] / expected.hover, 1.0, 1e-5);
    EXPECT_NEAR(run.metrics[Metric::endurance] / expected.time, 1.0, 1e-5);

    Sweep sweep;
    sweep.variants = {{d, Condition::air, true}};
    sweep.hold = options.hold;
    sweep.options.tolerance = 1e-8;
    sweep.options.metrics = {};
    sweep.options.metrics.set(std::size_t(Metric::hover)).set(std::size_t(Metric::endurance));
    sweep.allow_extrapolation = true;
    SweepColumns columns;
    columns.resize(1, 2);
    SweepSolver(sweep, start_up_in_time()).solve(columns, 0, 1);
    const bool hover_first = Metric::hover < Metric::endurance;
    EXPECT_NEAR(columns.metrics[hover_first ? 0 : 1][0] / expected.hover, 1.0, 1e-5);
    EXPECT_NEAR(columns.metrics[hover_first ? 1 : 0][0] / expected.time, 1.0, 1e-5);
  }
}

struct DifferentiatedFlight {
  Design<double> design;
  EnduranceEnd end;
  std::vector<const char*> keys;
};

TEST(HoverThrottle, DerivativesOfTheTimeOfHover) {
  const FlightMetrics wanted{true, true, true};
  Design<double> d = throttled_design();
  d.supply.battery.charge = 0.97;
  Design<double> cut = d, empty = d, by_energy = d, brushless = d;
  cut.supply.battery.cutoff_voltage = 3.2;
  *empty.mass *= 0.6;
  by_energy.supply.battery.specific_energy = 5e5;
  brushless.electronics.efficiency = 0.9;
  const DifferentiatedFlight flights[] = {
      {d, EnduranceEnd::sinks, {"supply.internal_resistance", "supply.charge", "transmission.crank_radius"}},
      {cut, EnduranceEnd::cutoff, {"supply.cutoff_voltage"}},
      {empty, EnduranceEnd::empty, {"vehicle.mass"}},
      {by_energy, EnduranceEnd::sinks, {"supply.capacity"}},
      {brushless, EnduranceEnd::sinks, {"vehicle.mass"}}};
  for (const DifferentiatedFlight& flight : flights) {
    const Design<double>& design = flight.design;
    const std::vector<const char*>& keys = flight.keys;
    const EnduranceEnd end = flight.end;
    SCOPED_TRACE(int(end));
    EXPECT_EQ(simulate_discharge(design, {.tolerance = 1e-6, .allow_extrapolation = true}).end, end);
    std::vector<DesignParameter> parameters;
    for (const char* key : keys) parameters.push_back(design_parameter(key));
    const Endurance e = endurance_of(design, Condition::air, 1e-8, parameters, wanted);
    ASSERT_GT(e.hover, 0.0);
    EXPECT_EQ(e.hover_by_parameter, e.by_parameter);
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      SCOPED_TRACE(keys[k]);
      const double x = *parameters[k].value(design), h = 1e-3 * x;
      const auto hover = [&](double steps) {
        Design<double> moved = design;
        parameters[k].set(moved, x + steps * h);
        return endurance_of(moved, Condition::air, 1e-8, {}, wanted).hover;
      };
      const double difference = (8.0 * (hover(1.0) - hover(-1.0)) - (hover(2.0) - hover(-2.0))) / (12.0 * h);
      EXPECT_NEAR(e.hover_by_parameter[k], difference, 2e-5 * std::abs(difference) + 3e-6 * e.hover / x);
    }
  }
}

// Settled at every charge, and with time constants that are short beside the flight.
TEST(HoverThrottle, AMotorThatWarmsUpSoonFliesAlmostAsASettledOne) {
  Design<double> d = throttled_design();
  d.motor.thermal.resistance_winding = 3.0;
  d.motor.thermal.resistance_case = 8.0;
  const EnduranceResult settled = simulate_discharge(d, {.tolerance = 1e-7, .allow_extrapolation = true});
  ASSERT_GT(settled.endurance(), 0.0) << describe(settled);
  d.motor.thermal.time_constant_winding = 1.0;
  d.motor.thermal.time_constant_case = 3.0;
  const EnduranceResult quick = simulate_discharge(d, {.tolerance = 1e-5, .allow_extrapolation = true});
  EXPECT_EQ(quick.end, settled.end);
  EXPECT_NEAR(quick.endurance() / settled.endurance(), 1.0, 3e-3);
  for (const EnduranceRow& row : quick.rows) EXPECT_NEAR(row.metrics[Metric::lift_to_weight], 1.0, 1e-5);
}

TEST(HoverThrottle, ADirectDriveHoversByItsAmplitude) {
  Design<double> d = read_design(std::filesystem::path(WINGBEAT_DATA) / "designs" / "direct-drive.toml");
  d.supply.type = SupplyType::battery_sine;
  d.supply.battery.cell_voltage = 3.7;
  d.supply.battery.cells = 2.0;
  d.supply.battery.internal_resistance = 0.3;
  d.supply.battery.capacity = 108.0;
  d.supply.throttle = Throttle::hover;
  *d.mass *= 0.5;
  const EnduranceResult r = simulate_discharge(d, {.allow_extrapolation = true});
  ASSERT_EQ(r.end, EnduranceEnd::empty) << describe(r);
  EXPECT_EQ(r.hover, Hover::kept);
  Design<double> there = d;
  there.supply.voltage = r.rows.front().amplitude;
  const double P = flapping_of(there).metrics[Metric::power_electrical];
  EXPECT_NEAR(flapping_of(there).metrics[Metric::lift_to_weight], 1.0, 1e-9);
  const double E = 7.4, R = 0.6, I = (E - std::sqrt(E * E - 4.0 * R * P)) / (2.0 * R);
  EXPECT_NEAR(r.endurance() * I / 108.0, 1.0, 1e-9);
}

}  // namespace
}  // namespace wingbeat
