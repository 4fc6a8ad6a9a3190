#include <fmt/format.h>

#include <utility>

#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/files/optimise_file.hpp"

namespace wingbeat {

std::vector<MotorTrial> trials_of(const OptimiseFile& file) {
  std::size_t combinations = 1;
  for (const DiscreteParameter& p : file.choices) combinations *= p.values.size();
  std::vector<MotorTrial> trials;
  const auto add = [&](const MotorCandidate* motor) {
    for (std::size_t n = 0; n < combinations; ++n) {
      std::vector<double> values(file.choices.size());
      std::size_t rest = n;
      for (std::size_t k = values.size(); k-- > 0;) {
        values[k] = file.choices[k].values[rest % file.choices[k].values.size()];
        rest /= file.choices[k].values.size();
      }
      trials.push_back({motor, std::move(values), {}});
      if (trials.back().refused()) return;
    }
  };
  for (const MotorCandidate& motor : file.motors) add(&motor);
  if (file.motors.empty()) add(nullptr);
  return trials;
}

OptimiseStudy trial_study(const OptimiseFile& file, const MotorTrial& trial) {
  OptimiseStudy study = file.study;
  if (trial.motor) study.design = trial.motor->design;
  for (std::size_t k = 0; k < file.choices.size(); ++k) file.choices[k].parameter.set(study.design, trial.choices[k]);
  if (file.within_nominal_current && trial.motor && trial.motor->nominal_current) {
    study.constraints.push_back({Metric::current_rms, false, study.design.motors * *trial.motor->nominal_current});
  }
  return study;
}

std::string name_of(const OptimiseFile& file, const MotorTrial& trial) {
  std::string name = trial.motor ? trial.motor->model : "";
  if (trial.refused()) return name;
  for (std::size_t k = 0; k < file.choices.size(); ++k) {
    const DesignParameter& p = file.choices[k].parameter;
    name += fmt::format("{}{} {:.6g}{}", name.empty() ? "" : ", ", p.key, trial.choices[k],
                        p.unit == "1" ? "" : " " + p.unit);
  }
  return name;
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
