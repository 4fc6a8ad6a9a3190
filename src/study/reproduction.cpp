#include "wingbeat/study/reproduction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wingbeat/core/root.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/study/ensemble_hold.hpp"
#include "wingbeat/study/trend.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

std::vector<double> evenly(double from, double to, int count) {
  std::vector<double> x;
  for (int n = 0; n < count; ++n) x.push_back(from + (to - from) * n / (count - 1));
  return x;
}

EnsembleOptions ensemble_options() {
  EnsembleOptions options;
  options.tolerance = 1e-7;
  // The narrowest instructions, so that the bytes of a data set do not depend on the processor.
  options.isa = InstructionSet::base;
  return options;
}

std::vector<Metrics<double>> metrics_of(const std::vector<EnsembleOutcome>& outcomes) {
  std::vector<Metrics<double>> metrics;
  for (const EnsembleOutcome& outcome : outcomes) metrics.push_back(outcome.metrics);
  return metrics;
}

/// Runs a vehicle along an axis: `place` sets the design of one point; a frequency is held where the axis is one.
void run_along(TrendCurve& curve, const std::vector<double>& axis, bool frequency,
               const std::function<Design<double>(double)>& place) {
  std::vector<EnsembleMember> members;
  std::vector<std::size_t> indices;
  for (std::size_t n = 0; n < axis.size(); ++n) {
    const Design<double> design = place(axis[n]);
    try {
      validate(design);
    } catch (const ParameterError&) {
      continue;  // a rod shorter than its crank
    }
    members.push_back({resolve(design, curve.flapping_case.condition), reporting_of(design)});
    indices.push_back(n);
  }
  std::vector<EnsembleOutcome> outcomes(members.size());
  const StartUp start_up = start_up_in_time();
  if (frequency) {
    std::vector<FrequencyOutcome> reached(members.size());
    std::vector<Hold> held;
    for (const std::size_t n : indices) held.push_back({Held::frequency, axis[n]});
    solve_ensemble_held(members, held, ensemble_options(), start_up, outcomes, reached);
  } else {
    solve_ensemble(members, ensemble_options(), start_up, outcomes);
  }
  Metrics<double> none;
  none.values.fill(absent);
  curve.metrics.assign(axis.size(), none);
  curve.domain.assign(axis.size(), {});
  for (std::size_t k = 0; k < indices.size(); ++k) {
    curve.metrics[indices[k]] = outcomes[k].metrics;
    if (std::isfinite(outcomes[k].metrics[Metric::power_electrical])) {
      curve.domain[indices[k]] = domain_of(members[k].vehicle, outcomes[k].metrics);
    }
  }
}

void set_constant(Design<double>& design, double voltage) { design.supply = {SupplyType::constant, voltage, 0.0, 1.0}; }

CycleCase cycle_of(const SpringPair& pair, const FlappingCase& which, std::optional<double> voltage,
                   std::optional<double> frequency, int rows) {
  Design<double> design = design_of(pair, which);
  if (voltage) set_constant(design, *voltage);
  RunOptions options;
  options.tolerance = 1e-9;
  options.frequency = frequency;
  options.allow_extrapolation = true;
  options.waveform_rows = rows;
  CycleCase result{which, run_design(design, options), {}};
  const CrankGeometry<double> geometry = geometry_of(resolve(result.run.design).transmission.slider_crank);
  for (const WaveformRow& row : result.run.cycle) {
    const auto k = crank_kinematics(geometry, std::sin(row.crank_angle), std::cos(row.crank_angle));
    result.stored_power.push_back((row.rod_force * k.wing_jacobian - row.aero_moment) * row.flapping_velocity);
  }
  return result;
}

}  // namespace

Design<double> design_of(const SpringPair& pair, const FlappingCase& which) {
  Design<double> design = pair[which.springs ? 1 : 0];
  design.transmission.formulation = which.formulation;
  return design;
}

Reproduction reproduce(const SpringPair& pair, const ReproductionOptions& options, const ForEach& for_each,
                       const std::function<void(double)>& done) {
  using enum Formulation;
  Reproduction r;
  r.options = options;
  const auto points = [&](int fine, int coarse) { return options.coarse ? coarse : fine; };
  r.frequency.axis = evenly(8.0, 28.0, points(81, 21));
  r.crank_fixed_hinge.axis = evenly(2e-3, 14e-3, points(121, 25));
  r.crank_fixed_stroke.axis = r.crank_fixed_hinge.axis;
  r.rod.axis = evenly(8e-3, 40e-3, points(129, 33));
  r.supply_fixed_hinge.axis = evenly(1.0, options.max_voltage, points(81, 17));
  r.supply_fixed_stroke.axis = r.supply_fixed_hinge.axis;

  std::vector<std::function<void()>> tasks;
  const auto task_along = [&](TrendSet& set, std::size_t curve, bool frequency, const auto& place) {
    tasks.push_back([&set, curve, frequency, place] { run_along(set.curves[curve], set.axis, frequency, place); });
  };
  for (const Formulation formulation : {rod_force, virtual_work}) {
    for (const FlappingCase& which :
         {FlappingCase{formulation, false, Condition::air}, FlappingCase{formulation, true, Condition::air},
          FlappingCase{formulation, false, Condition::vacuum}, FlappingCase{formulation, false, Condition::wingless}}) {
      // Without wings there is no rod force, and nothing for a formulation to differ in.
      if (which.condition == Condition::wingless && formulation == virtual_work) continue;
      r.frequency.curves.push_back({which, absent, {}, {}});
      task_along(r.frequency, r.frequency.curves.size() - 1, true,
                 [design = design_of(pair, which)](double) { return design; });
    }
    for (const bool springs : {false, true}) {
      const FlappingCase which{formulation, springs, Condition::air};
      Design<double> design = design_of(pair, which);
      set_constant(design, options.voltage);
      const SliderCrank<double> crank = resolve(design).transmission.slider_crank;
      const double stroke = std::atan(crank.crank_radius / crank.hinge_offset);

      r.crank_fixed_hinge.curves.push_back({which, absent, {}, {}});
      task_along(r.crank_fixed_hinge, r.crank_fixed_hinge.curves.size() - 1, false, [design](double radius) {
        Design<double> d = design;
        d.transmission.crank_radius = radius;
        return d;
      });
      r.crank_fixed_stroke.curves.push_back({which, absent, {}, {}});
      task_along(r.crank_fixed_stroke, r.crank_fixed_stroke.curves.size() - 1, false, [design, stroke](double radius) {
        Design<double> d = design;
        d.transmission.crank_radius = radius;
        d.transmission.hinge_offset.reset();
        d.transmission.stroke_amplitude = stroke;
        return d;
      });
      r.rod.curves.push_back({which, absent, {}, {}});
      task_along(r.rod, r.rod.curves.size() - 1, false, [design](double length) {
        Design<double> d = design;
        d.transmission.rod_length = length;
        return d;
      });
      for (const double radius : options.crank_radii) {
        for (const bool hold_stroke : {false, true}) {
          TrendSet& set = hold_stroke ? r.supply_fixed_stroke : r.supply_fixed_hinge;
          Design<double> sized = design;
          sized.transmission.crank_radius = radius;
          if (hold_stroke) {
            sized.transmission.hinge_offset.reset();
            sized.transmission.stroke_amplitude = stroke;
          }
          set.curves.push_back({which, radius, {}, {}});
          task_along(set, set.curves.size() - 1, false, [sized](double voltage) {
            Design<double> d = sized;
            set_constant(d, voltage);
            return d;
          });
        }
      }
    }
  }
  r.at_frequency.resize(4);
  r.at_voltage.resize(4);
  const int rows = points(361, 91);
  for (std::size_t n = 0; n < 4; ++n) {
    const FlappingCase which{n < 2 ? rod_force : virtual_work, n % 2 == 1, Condition::air};
    tasks.push_back([&, which, n] {
      r.at_frequency[n] = cycle_of(pair, which, std::nullopt, options.frequency, rows);
      r.at_voltage[n] = cycle_of(pair, which, options.voltage, std::nullopt, rows);
    });
  }

  run_tasks(tasks, for_each, done);
  return r;
}

namespace {

/// Flapping frequency [Hz], exact enough to calibrate to it; absent where the design does not flap.
double exact_frequency(const Design<double>& design) {
  SteadyOptions options;
  options.tolerance = 1e-11;
  options.stability = false;
  const SteadyFlapping found = find_steady_flapping(resolve(design), options, start_up_in_time());
  return found.status == FlappingStatus::flapping ? found.metrics[Metric::frequency] : absent;
}

bool is_narrow(const Bracket<double>& b) { return b.after - b.before <= 1e-10 * b.after; }

}  // namespace

CalibratedLaw calibrate_friction(Design<double> design, FrictionLaw law, double frequency) {
  const auto flapping_at = [&](double coefficient) {
    design.friction = {law, coefficient};
    return exact_frequency(design);
  };
  CalibratedLaw result{law, design.transmission.formulation, 0.0, flapping_at(0.0), false};
  if (law == FrictionLaw::none || !(result.frequency > frequency)) return result;
  // Friction that dissipates at the rate of a tenth of a milliwatt, then more of it until the vehicle is too slow.
  const double omega = two_pi * frequency;
  const double torque = 1e-4 / omega;
  constexpr double rod_force = 0.1;  // [N]
  double low = 0.0, high = coefficient_for(law, torque, omega, rod_force);
  for (int n = 0; n < 40 && flapping_at(high) > frequency; ++n) {
    low = high;
    high *= 2.0;
  }
  // What does not flap counts as too slow, so a plain bisection it is.
  const auto too_fast = [&](double coefficient) { return flapping_at(coefficient) > frequency; };
  result.coefficient = bisect(too_fast, low, high, is_narrow).before;
  result.frequency = flapping_at(result.coefficient);
  result.calibrated = std::abs(result.frequency / frequency - 1.0) < 1e-8;
  return result;
}

Design<double> with_drag_factor(Design<double> design, double factor) {
  const Vehicle<double> vehicle = resolve(design);
  design.wing.planform = {};
  design.wing.planform.s2 = vehicle.wings.s2;
  design.wing.planform.s3 = factor * vehicle.wings.s3;
  return design;
}

double calibrate_drag(Design<double> design, double frequency) {
  const auto too_fast = [&](double factor) { return exact_frequency(with_drag_factor(design, factor)) > frequency; };
  double high = 1.0;
  if (!too_fast(high)) return absent;
  while (high < 64.0 && too_fast(high)) high *= 2.0;
  if (too_fast(high)) return absent;
  return bisect(too_fast, 0.5 * high, high, is_narrow).before;
}

LossCurve loss_along_stiffness(const Design<double>& design, double frequency, double max_stiffness, int points) {
  LossCurve curve;
  curve.stiffness = evenly(0.0, max_stiffness, points);
  std::vector<EnsembleMember> members;
  for (const double stiffness : curve.stiffness) {
    Design<double> d = design;
    d.spring = {};
    if (stiffness > 0.0) d.spring.stiffness = stiffness;
    members.push_back({resolve(d), reporting_of(d)});
  }
  std::vector<EnsembleOutcome> outcomes(members.size());
  std::vector<FrequencyOutcome> reached(members.size());
  const std::vector<Hold> held(members.size(), {Held::frequency, frequency});
  solve_ensemble_held(members, held, ensemble_options(), start_up_in_time(), outcomes, reached);
  curve.metrics = metrics_of(outcomes);
  return curve;
}

double best_constant_load_efficiency(const Motor<double>& motor, double voltage) {
  const auto efficiency = [&](double omega) {
    const double current = (voltage - motor.torque_constant * omega) / motor.armature_resistance;
    const MotorLoads<double> loads = motor_loads(motor, voltage, current, omega);
    return (loads.torque - loads.drag_torque - motor.friction_torque) * omega / (voltage * current);
  };
  const double fastest = no_load_speed(motor, voltage);
  return highest_along(efficiency, 1e-3 * fastest, 0.999 * fastest, 200).value;
}

}  // namespace wingbeat
