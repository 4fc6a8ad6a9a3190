#include "wingbeat/study/validation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>
#include <type_traits>

#include "study/residual_fit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/study/body_derivatives.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using Numbers = std::vector<double>;

constexpr double orbit_tolerance = 1e-6;

/// The indices of the points that fits see.
std::vector<std::size_t> fitted_points(const ValidationSet& set) {
  std::vector<std::size_t> which;
  for (std::size_t n = 0; n < set.points.size(); ++n) {
    if (set.points[n].fitted) which.push_back(n);
  }
  return which;
}
Numbers of_points(const Numbers& all, const std::vector<std::size_t>& which) {
  Numbers some;
  for (const std::size_t n : which) some.push_back(all[n]);
  return some;
}
Numbers measured_at(const ValidationSet& set, const std::vector<std::size_t>& which) {
  Numbers some;
  for (const std::size_t n : which) some.push_back(set.points[n].measured);
  return some;
}

void add_misses(const ValidationSet& set, ValidationStage& stage) {
  for (std::size_t q = 0; q < set.quantities.size(); ++q) {
    for (const bool fitted : {true, false}) {
      ValidationMiss miss{.quantity = q, .fitted = fitted};
      double squares = 0.0, sum = 0.0, size = 0.0;
      for (std::size_t n = 0; n < set.points.size(); ++n) {
        const ValidationPoint& p = set.points[n];
        if (p.quantity != q || p.fitted != fitted) continue;
        const double off = stage.predicted[n] - p.measured;
        if (!std::isfinite(off)) {
          ++miss.unreached;
          continue;
        }
        ++miss.points;
        squares += off * off;
        sum += off;
        size += p.measured * p.measured;
      }
      if (miss.points + miss.unreached == 0) continue;
      if (miss.points > 0) {
        miss.rms = std::sqrt(squares / miss.points);
        miss.mean = sum / miss.points;
        miss.relative = set.quantities[q].has_size && size > 0.0 ? std::sqrt(squares / size) : absent;
      }
      stage.misses.push_back(miss);
    }
  }
}

std::string stage_name(const std::vector<FreeParameter>& parameters) {
  std::string name;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    name += (k == 0 ? "" : ", ") + parameters[k].parameter.key;
  }
  return name + " fitted";
}

/// The stages "nothing fitted", one parameter, all parameters of a model that `computed` gives at every point.
std::vector<ValidationStage> stages_by_residuals(
    const ValidationSet& set, const std::vector<std::vector<FreeParameter>>& fits,
    const std::function<Numbers(const std::vector<FreeParameter>&, const Numbers& x)>& computed) {
  std::vector<ValidationStage> stages;
  ValidationStage nothing;
  nothing.name = "nothing fitted";
  nothing.predicted = computed({}, {});
  stages.push_back(std::move(nothing));
  const std::vector<std::size_t> which = fitted_points(set);
  for (const std::vector<FreeParameter>& parameters : fits) {
    if (which.size() < parameters.size()) continue;
    ValidationStage stage;
    stage.name = stage_name(parameters);
    const ResidualFit fit = fit_residuals([&](const Numbers& x) { return of_points(computed(parameters, x), which); },
                                          measured_at(set, which), parameters);
    stage.converged = fit.converged;
    stage.parameters = fit.parameters;
    stage.predicted = computed(parameters, fit.x);
    stages.push_back(std::move(stage));
  }
  return stages;
}

/// One parameter alone, then all where there are more.
std::vector<std::vector<FreeParameter>> fits_of(const std::vector<FreeParameter>& parameters, std::size_t one) {
  std::vector<std::vector<FreeParameter>> fits;
  if (parameters.empty()) return fits;
  fits.push_back({parameters[one]});
  if (parameters.size() > 1) fits.push_back(parameters);
  return fits;
}

FreeParameter plain_parameter(const char* key, const char* unit, double lower, double upper, double start) {
  FreeParameter p{{}, lower, upper, start};
  p.parameter.key = key;
  p.parameter.unit = unit;
  return p;
}

// ---- a stated stroke and pitch

struct PrescribedVariant {
  const char* name;
  const char* coefficients;
  bool rotation, added_mass;
  StripForceDirection direction;
};
constexpr PrescribedVariant prescribed_variants[] = {
    {"translational-2022, C_L as under the pitch law", "translational-2022", false, false,
     StripForceDirection::lift_and_drag},
    {"translational-2022 normal to the chord, translation", "translational-2022", false, false,
     StripForceDirection::normal},
    {"the same with rotational lift", "translational-2022", true, false, StripForceDirection::normal},
    {"the same with rotational lift and added mass", "translational-2022", true, true, StripForceDirection::normal},
    {"normal-force-robofly, translation", "normal-force-robofly", false, false, StripForceDirection::normal},
    {"the same with added mass", "normal-force-robofly", true, true, StripForceDirection::normal}};

std::vector<ValidationStage> stages_of(const ValidationSet& set, const PrescribedProblem& problem) {
  const FreeParameter factor = plain_parameter("factor on the force", "1", 0.01, 10.0, 1.0);
  const FreeParameter suction = plain_parameter(pitch_key::edge_suction.path, "1", 0.0, 1.0, 0.5);
  std::vector<ValidationStage> bare, fitted;
  for (const PrescribedVariant& variant : prescribed_variants) {
    PrescribedWings wings = prescribed_wings(problem.planform, problem.count, problem.air_density, variant.coefficients,
                                             variant.rotation, variant.added_mass);
    wings.direction = variant.direction;
    const auto lifts = [&](const std::vector<FreeParameter>& parameters, const Numbers& x) {
      const bool scales = !parameters.empty() && parameters[0].parameter.key == factor.parameter.key;
      wings.pitching.edge_suction = parameters.empty() || scales ? 0.0 : x[0];
      Numbers all;
      for (const PrescribedFlapping& motion : problem.motions) {
        all.push_back((scales ? x[0] : 1.0) * prescribed_loads(wings, motion).lift / problem.unit);
      }
      return all;
    };
    std::vector<std::vector<FreeParameter>> fits = {{factor}};
    if (variant.added_mass) fits.push_back({suction});
    for (ValidationStage& stage : stages_by_residuals(set, fits, lifts)) {
      stage.variant = variant.name;
      (stage.parameters.empty() ? bare : fitted).push_back(std::move(stage));
    }
  }
  bare.insert(bare.end(), std::make_move_iterator(fitted.begin()), std::make_move_iterator(fitted.end()));
  return bare;
}

std::vector<ValidationStage> stages_of(const ValidationSet& set, const PrescribedFlightProblem& problem) {
  std::vector<ValidationStage> stages;
  for (const auto& [name, coefficients, rotation] :
       {std::tuple{"translational-2022, translation", "translational-2022", false},
        {"translational-2022 with rotational lift and damping", "translational-2022", true},
        {"robobee, translation", "robobee", false},
        {"normal-force-robofly, translation", "normal-force-robofly", false}}) {
    const PrescribedWings wings =
        prescribed_wings(problem.planform, problem.count, problem.air_density, coefficients, rotation, false);
    const PrescribedFlightLoads mean = prescribed_flight_loads(wings, problem.planform, problem.count, problem.motion,
                                                               problem.speed, problem.stroke_plane_tilt);
    const auto computed = [&](const std::vector<FreeParameter>&, const Numbers&) {
      Numbers all;
      for (const auto member : problem.gives) all.push_back(mean.*member);
      return all;
    };
    for (ValidationStage& stage : stages_by_residuals(set, {}, computed)) {
      stage.variant = name;
      stages.push_back(std::move(stage));
    }
  }
  return stages;
}

// ---- steady flapping over voltage and frequency

/// At every point, in its unit.
Numbers bench_numbers(const BenchProblem& problem, const Design<double>& design, const ForEach& for_each) {
  Numbers numbers(problem.voltages.size(), absent);
  for_all(for_each, numbers.size(), [&](std::size_t n) {
    Vehicle<double> vehicle = resolve(design);
    vehicle.voltage = problem.voltages[n];
    if (std::isfinite(problem.frequencies[n])) vehicle.drive_frequency = problem.frequencies[n];
    const SteadyFlapping found = find_steady_flapping(
        vehicle, {.tolerance = orbit_tolerance, .stability = false, .reporting = reporting_of(design)});
    if (found.status == FlappingStatus::flapping) {
      numbers[n] = found.metrics[problem.metric] / problem.metric_per_value;
    }
  });
  return numbers;
}

/// The fitted points as the logs of a bench: one for each voltage where frequencies were set.
BenchFit bench_of(const ValidationSet& set, const BenchProblem& problem, std::vector<FreeParameter> parameters) {
  BenchFit fit;
  fit.design = problem.design;
  fit.parameters = std::move(parameters);
  fit.profiles = false;
  fit.tolerance = orbit_tolerance;
  const MeasuredQuantity quantity{.metric = problem.metric};
  fit.deviations[quantity] = {};
  std::map<double, BenchLog> logs;
  for (const std::size_t n : fitted_points(set)) {
    const bool by_frequency = std::isfinite(problem.frequencies[n]);
    BenchLog& log = logs[by_frequency ? problem.voltages[n] : 0.0];
    log.file = set.name;
    log.springs = problem.design.spring.stiffness || problem.design.spring.resonance;
    log.columns = {quantity};
    log.given = by_frequency ? Given::frequency : Given::voltage;
    if (by_frequency) log.amplitude = problem.voltages[n];
    BenchRow row;
    row.line = int(n) + 1;
    row.given = by_frequency ? problem.frequencies[n] : problem.voltages[n];
    row.values = {set.points[n].measured * problem.metric_per_value};
    log.rows.push_back(std::move(row));
  }
  for (auto& [voltage, log] : logs) fit.logs.push_back(std::move(log));
  return fit;
}

std::vector<ValidationStage> stages_of(const ValidationSet& set, const BenchProblem& problem, const ForEach& for_each,
                                       const std::function<void(const std::string&)>& progress) {
  std::vector<ValidationStage> stages(1);
  stages[0].name = "nothing fitted";
  stages[0].predicted = bench_numbers(problem, problem.design, for_each);
  for (const std::vector<FreeParameter>& parameters : fits_of(problem.parameters, problem.one)) {
    ValidationStage stage;
    stage.name = stage_name(parameters);
    if (progress) progress(stage.name);
    const FitResult fit = fit_bench(bench_of(set, problem, parameters), progress, for_each);
    stage.converged = fit.converged;
    stage.parameters = fit.parameters;
    stage.misfit = fit.misfit;
    stage.predicted = bench_numbers(problem, fit.design, for_each);
    stages.push_back(std::move(stage));
  }
  return stages;
}

// ---- passive pitch

std::vector<ValidationStage> stages_of(const ValidationSet& set, const PassivePitchProblem& problem,
                                       const ForEach& for_each) {
  const auto computed = [&](const std::vector<FreeParameter>& parameters, const Numbers& x) {
    Design<double> design = problem.design;
    for (std::size_t k = 0; k < parameters.size(); ++k) parameters[k].parameter.set(design, x[k]);
    const Vehicle<double> vehicle = resolve(design);
    Numbers numbers(set.points.size(), absent);
    for_all(for_each, numbers.size(), [&](std::size_t n) {
      const PassivePitch pitch = passive_pitch(vehicle, {0.0, {{problem.strokes[n], 0.0}}}, problem.frequency);
      const double amplitude = problem.first_harmonics ? pitch.first_harmonic : pitch.amplitude;
      numbers[n] = degrees_per_radian * (set.points[n].quantity == 0 ? amplitude : pitch.phase);
    });
    return numbers;
  };
  return stages_by_residuals(set, fits_of(problem.parameters, problem.one), computed);
}

// ---- ratios of a vehicle at hover

double ratio_at_hover(const RunResult& hover, RatiosProblem::Kind kind) {
  if (hover.status != FlappingStatus::flapping) return absent;
  if (kind == RatiosProblem::Kind::damping_ratio) {
    const Vehicle<double> vehicle = resolve(hover.design);
    const SteadyFlapping found = find_steady_flapping(
        vehicle, {.tolerance = orbit_tolerance, .stability = false, .reporting = reporting_of(hover.design)});
    if (found.record.empty()) return absent;
    const BodyDerivatives slopes = body_derivatives(hover.design, vehicle, found.record);
    return slopes(0, 0) / slopes(2, 2);
  }
  constexpr double step = 0.01;
  const double frequency = hover.metrics[Metric::frequency];
  double lift[2];
  for (int n = 0; n < 2; ++n) {
    RunOptions options;
    options.frequency = frequency * (n == 0 ? 1.0 - step : 1.0 + step);
    options.allow_extrapolation = true;
    const RunResult near = run_design(hover.design, options);
    if (near.status != FlappingStatus::flapping) return absent;
    lift[n] = near.metrics[Metric::lift_mean];
  }
  return std::log(lift[1] / lift[0]) / std::log((1.0 + step) / (1.0 - step));
}

std::vector<ValidationStage> stages_of(const ValidationSet& set, const RatiosProblem& problem) {
  if (!problem.design.mass) throw ParameterError("vehicle.mass", "missing: ratios are those at hover");
  RunOptions options;
  options.lift = *problem.design.mass * standard_gravity;
  options.allow_extrapolation = true;
  const RunResult hover = run_design(problem.design, options);
  return stages_by_residuals(set, {}, [&](const std::vector<FreeParameter>&, const Numbers&) {
    Numbers numbers;
    for (const RatiosProblem::Kind kind : problem.kinds) numbers.push_back(ratio_at_hover(hover, kind));
    return numbers;
  });
}

// ---- static maps

Numbers map_numbers(const ValidationSet& set, const MapsProblem& problem) {
  Numbers numbers(set.points.size(), absent);
  const Linearisation linearisation = linearise(problem.design);
  for (std::size_t q = 0; q < problem.maps.size(); ++q) {
    const MapsProblem::Map& map = problem.maps[q];
    Numbers inputs;
    const bool voltage = map.input == AllocationInput::voltage;
    if (!voltage) inputs.push_back(0.0);
    for (std::size_t n = 0; n < set.points.size(); ++n) {
      if (set.points[n].quantity != q) continue;
      inputs.push_back(problem.inputs[n]);
      if (!voltage) inputs.push_back(-problem.inputs[n]);
    }
    std::sort(inputs.begin(), inputs.end());
    inputs.erase(std::unique(inputs.begin(), inputs.end()), inputs.end());
    for (const AllocationPoint& p : allocation_points(linearisation, map.input, inputs, problem.hinge_offset)) {
      for (std::size_t n = 0; n < set.points.size(); ++n) {
        if (set.points[n].quantity == q && problem.inputs[n] == p.input) numbers[n] = p.*map.gives / map.per_value;
      }
    }
  }
  return numbers;
}

std::vector<ValidationStage> stages_of(const ValidationSet& set, const MapsProblem& problem) {
  return stages_by_residuals(
      set, {}, [&](const std::vector<FreeParameter>&, const Numbers&) { return map_numbers(set, problem); });
}

// ---- a vehicle with a body in hover

std::vector<ValidationStage> stages_of(const ValidationSet& set, const FlightProblem& problem) {
  const FlightNumbers numbers = flight_numbers(problem.vehicle, problem.numbers);
  Numbers averaged = numbers.averaged, floquet = numbers.floquet;
  for (const FlightProblem::Map& map : problem.maps) {
    const Numbers loads = load_over_control(problem.vehicle, map.control, map.settings, map.load);
    averaged.insert(averaged.end(), loads.begin(), loads.end());
  }
  floquet.resize(averaged.size(), absent);
  const bool modes = std::any_of(problem.numbers.begin(), problem.numbers.end(), is_of_modes);
  std::vector<ValidationStage> stages;
  for (Numbers* numbers_of_stage : {&averaged, &floquet}) {
    if (!modes && numbers_of_stage == &floquet) continue;
    ValidationStage stage;
    stage.name = "nothing fitted";
    if (modes) stage.variant = numbers_of_stage == &averaged ? "averaged over the wingbeat" : "Floquet, whole flight";
    stage.predicted = std::move(*numbers_of_stage);
    for (std::size_t n = 0; n < set.points.size(); ++n) {
      stage.predicted[n] /= problem.per_value[set.points[n].quantity];
    }
    stages.push_back(std::move(stage));
  }
  return stages;
}

// ---- the resistance of a battery

std::vector<ValidationStage> stages_of(const ValidationSet& set, const ResistanceProblem&) {
  double largest = 0.0;
  for (const ValidationPoint& p : set.points) largest = std::max(largest, p.measured);
  const std::vector<FreeParameter> one = {plain_parameter("resistance", "ohm", 0.0, 2.0 * largest, largest)};
  std::vector<ValidationStage> stages =
      stages_by_residuals(set, {one}, [&](const std::vector<FreeParameter>& parameters, const Numbers& x) {
        return Numbers(set.points.size(), parameters.empty() ? absent : x[0]);
      });
  stages.erase(stages.begin());  // without a fit there is no resistance
  return stages;
}

}  // namespace

void split_alternately(ValidationSet& set, const std::vector<std::size_t>& operating_points) {
  for (std::size_t n = 0; n < set.points.size(); ++n) set.points[n].fitted = operating_points[n] % 2 == 0;
}

ValidationResult validate_set(const ValidationSet& set, const std::function<void(const std::string&)>& progress,
                              const ForEach& for_each) {
  ValidationResult result;
  result.stages = std::visit(
      [&](const auto& problem) -> std::vector<ValidationStage> {
        using P = std::decay_t<decltype(problem)>;
        if constexpr (std::is_same_v<P, std::monostate>) return {};
        else if constexpr (std::is_same_v<P, BenchProblem>) return stages_of(set, problem, for_each, progress);
        else if constexpr (std::is_same_v<P, PassivePitchProblem>) return stages_of(set, problem, for_each);
        else return stages_of(set, problem);
      },
      set.problem);
  for (ValidationStage& stage : result.stages) add_misses(set, stage);
  return result;
}

}  // namespace wingbeat
