#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <type_traits>
#include <utility>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/vehicle/drive.hpp"

namespace wingbeat {

namespace {

/// One value of each discrete parameter, the last varying fastest.
std::vector<double> values_at(const OptimiseFile& file, std::size_t rest) {
  std::vector<double> values(file.choices.size());
  for (std::size_t k = values.size(); k-- > 0;) {
    values[k] = file.choices[k].values[rest % file.choices[k].values.size()];
    rest /= file.choices[k].values.size();
  }
  return values;
}

}  // namespace

std::vector<MotorTrial> trials_of(const OptimiseFile& file) {
  std::size_t combinations = 1;
  for (const DiscreteParameter& p : file.choices) combinations *= p.values.size();
  std::vector<MotorTrial> trials;
  const auto add = [&](const MotorCandidate* motor) {
    for (std::size_t n = 0; n < combinations; ++n) {
      trials.push_back({motor, values_at(file, n), {}});
      if (trials.back().refused()) return;
    }
  };
  for (const MotorCandidate& motor : file.motors) add(&motor);
  if (file.motors.empty()) add(nullptr);
  return trials;
}

bool go_together(const DriveTrainSearch& search, const std::string& motor, const std::string& gearbox) {
  if (search.compatible.empty()) return true;
  const auto found = search.compatible.find(motor);
  if (found == search.compatible.end()) return false;
  return std::any_of(found->second.begin(), found->second.end(), [&](const std::string& name) {
    return name.ends_with('*') ? gearbox.starts_with(name.substr(0, name.size() - 1)) : gearbox == name;
  });
}

std::vector<MotorTrial> combinations_of(const OptimiseFile& file) {
  // A part that is not listed is the vehicle's.
  const auto usable = [](const auto& list) {
    std::vector<const typename std::remove_cvref_t<decltype(list)>::value_type*> parts;
    for (const auto& part : list) {
      if (part.refused.empty()) parts.push_back(&part);
    }
    if (list.empty()) parts.push_back(nullptr);
    return parts;
  };
  const auto motors = usable(file.motors);
  const auto gearboxes = usable(file.drive_train.gearboxes);
  const auto batteries = usable(file.drive_train.batteries);
  std::size_t combinations = 1;
  for (const DiscreteParameter& p : file.choices) combinations *= p.values.size();
  std::vector<MotorTrial> trials;
  for (const MotorCandidate* motor : motors) {
    for (const GearboxCandidate* gearbox : gearboxes) {
      if (motor && gearbox && !go_together(file.drive_train, motor->model, gearbox->model)) continue;
      for (const BatteryCandidate* battery : batteries) {
        for (std::size_t n = 0; n < combinations; ++n) {
          trials.push_back({motor, values_at(file, n), {}, gearbox, battery});
        }
      }
    }
  }
  return trials;
}

Design<double> with_parts(Design<double> d, const GearboxCandidate* gearbox, const BatteryCandidate* battery) {
  const bool weighed = d.mass.has_value();
  if (gearbox) {
    d.motor.gear_ratio = gearbox->ratio;
    d.motor.gear_inertia = square(gearbox->ratio) * gearbox->inertia;
    d.motor.gear_damping = 0.0;
    d.motor.gear_efficiency = d.motor.constants.gear_efficiency = gearbox->efficiency;
    if (weighed) d.masses.motor = d.masses.motor.value_or(0.0) + gearbox->mass.value_or(0.0);
  }
  if (battery) {
    Battery<double>& b = d.supply.battery;
    b.cells = battery->cells;
    b.capacity = battery->capacity;
    b.internal_resistance = battery->internal_resistance.value_or(b.internal_resistance);
    if (battery->cell_voltage) {
      b.cell_voltage = *battery->cell_voltage;
      b.discharge_curve.clear();
    }
    if (battery->cutoff_voltage) b.cutoff_voltage = battery->cutoff_voltage;
    b.specific_energy.reset();
    if (weighed) d.masses.supply = battery->mass;
    else d.masses.supply.reset();
  }
  return d;
}

namespace {

/// Limits of the parts, as constraints of the study.
void add_limits(const MotorTrial& trial, OptimiseStudy& study) {
  const Design<double>& d = study.design;
  // A crank turns on, of a direct drive the shaft swings with the wings.
  const Metric speed = drive_of(d).rotates ? Metric::crank_speed_max : Metric::flapping_velocity_peak;
  const double ratio = d.motor.gear_ratio.value_or(1.0);
  const auto bound = [&](Metric metric, const std::optional<double>& limit, double factor, const char* part) {
    if (limit) study.constraints.push_back({metric, false, factor * *limit, part});
  };
  if (trial.motor) bound(speed, trial.motor->speed_max, 1.0 / ratio, "speed of the motor");
  if (trial.gearbox) {
    bound(speed, trial.gearbox->speed_max, 1.0 / ratio, "speed of the gearbox");
    study.gear_torque = {trial.gearbox->torque_continuous, trial.gearbox->torque_peak};
  }
  if (trial.battery) bound(Metric::current_rms, trial.battery->current_max, 1.0, "current of the battery");
}

}  // namespace

OptimiseStudy trial_study(const OptimiseFile& file, const MotorTrial& trial) {
  OptimiseStudy study = file.study;
  if (trial.motor) study.design = trial.motor->design;
  study.design = with_parts(std::move(study.design), trial.gearbox, trial.battery);
  for (std::size_t k = 0; k < file.choices.size(); ++k) file.choices[k].parameter.set(study.design, trial.choices[k]);
  if (file.within_nominal_current && trial.motor && trial.motor->nominal_current) {
    study.constraints.push_back({Metric::current_rms, false, study.design.motors * *trial.motor->nominal_current,
                                 "nominal current of the motor"});
  }
  add_limits(trial, study);
  return study;
}

std::string name_of(const OptimiseFile& file, const MotorTrial& trial) {
  std::string name = trial.motor ? trial.motor->model : "";
  if (trial.refused()) return name;
  for (const std::string* part :
       {trial.gearbox ? &trial.gearbox->model : nullptr, trial.battery ? &trial.battery->model : nullptr}) {
    if (part) name += (name.empty() ? "" : ", ") + *part;
  }
  for (std::size_t k = 0; k < file.choices.size(); ++k) {
    const DesignParameter& p = file.choices[k].parameter;
    name += fmt::format("{}{} {:.6g}{}", name.empty() ? "" : ", ", p.key, trial.choices[k],
                        p.unit == "1" ? "" : " " + p.unit);
  }
  return name;
}

std::vector<MotorTrial> choose_drive_train(const OptimiseFile& file, const StartUp& start_up, const ForEach& for_each,
                                           const std::function<void(const std::string&)>& progress,
                                           DriveTrainScreen& screen) {
  const std::vector<MotorTrial> combinations = combinations_of(file);
  const auto counted = [&](std::size_t count, const std::function<void(std::size_t)>& act, const auto& words) {
    std::atomic<std::size_t> finished = 0;
    for_all(for_each, count, [&](std::size_t n) {
      act(n);
      if (progress) progress(words(++finished, count));
    });
  };
  const ForEach screening = [&](std::size_t count, const std::function<void(std::size_t)>& act) {
    counted(count, act, [&](std::size_t done, std::size_t all) {
      return fmt::format("{:.0f} % of {} combinations screened", 100.0 * double(done) / double(all),
                         combinations.size());
    });
  };
  screen = screen_drive_trains(
      combinations.size(), [&](std::size_t n) { return trial_study(file, combinations[n]); },
      std::uint64_t(file.drive_train.screen), start_up, screening);
  std::vector<MotorTrial> trials;
  for (const std::size_t n : screen.ranking) {
    if (trials.size() == std::size_t(file.drive_train.refine)) break;
    trials.push_back(combinations[n]);
  }
  counted(
      trials.size(),
      [&](std::size_t n) { trials[n].result = optimise(trial_study(file, trials[n]), start_up, for_each); },
      [](std::size_t done, std::size_t all) { return fmt::format("{} of {} combinations searched", done, all); });
  return trials;
}

ParetoStudy pareto_study(const OptimiseFile& file) {
  ParetoStudy study;
  for (const MotorCandidate& motor : file.motors) {
    if (motor.refused.empty()) study.vehicles.push_back({motor.model, motor.design});
  }
  if (study.vehicles.empty()) study.vehicles.push_back({"", file.study.design});
  study.condition = file.study.options.condition;
  study.hold = file.study.options.hold;
  study.tolerance = file.study.options.tolerance;
  study.objectives = file.objectives;
  study.parameters = file.study.parameters;
  study.choices = file.choices;
  study.constraints = file.study.constraints;
  study.allow_extrapolation = file.study.allow_extrapolation;
  study.evolution = file.evolution;
  study.screen = file.study.screen;
  study.designs = file.designs;
  return study;
}

const MotorTrial* best_trial(const OptimiseFile& file, std::span<const MotorTrial> trials) {
  const double sign = file.study.maximise ? -1.0 : 1.0;
  const MotorTrial* best = nullptr;
  for (const MotorTrial& t : trials) {
    if (t.refused() || t.result.outcome != OptimiseResult::Outcome::found) continue;
    const auto value = [&](const MotorTrial& trial) { return sign * trial.result.point.metrics[file.study.objective]; };
    if (!best || value(t) < value(*best)) best = &t;
  }
  return best;
}

}  // namespace wingbeat
