#include <algorithm>
#include <cmath>

#include "study/bench_fitter.hpp"
#include "study/bench_unknowns.hpp"
#include "study/fit_stages.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

double mean_friction_torque(const BenchFit& fit, double& speed) {
  Design<double> design = fit.design;
  for (const FreeParameter& p : fit.parameters) {
    if (!p.of_bench) p.parameter.set(design, p.start);
  }
  double torque = 0.0;
  int count = 0;
  speed = 0.0;
  for (const BenchLog& log : fit.logs) {
    if (log.condition == Condition::wingless || log.given != Given::voltage || log.rows.empty()) continue;
    Design<double> d = design;
    if (!log.springs) d.spring = {};
    d.supply.voltage = log.rows[log.rows.size() / 2].given;
    const SteadyFlapping s = find_steady_flapping(resolve(d, log.condition), {.stability = false});
    if (s.status != FlappingStatus::flapping) continue;
    const double omega = two_pi * s.metrics[Metric::frequency];
    torque += s.metrics[Metric::power_friction] / (omega * d.motors);
    speed += omega;
    ++count;
  }
  if (count > 0) speed /= count;
  return count > 0 ? torque / count : 0.0;
}

}  // namespace

std::vector<FrictionCandidate> compare_friction(const BenchFit& given,
                                                const std::function<DesignParameter(const std::string&)>& parameter_of,
                                                const std::function<void(const std::string&)>& progress,
                                                const ForEach& for_each) {
  const BenchFit fit = on_bench_supply(given);
  check_fit(fit);
  const auto is_friction = [](const FreeParameter& p) { return p.parameter.key.starts_with("friction."); };
  const auto own = std::find_if(fit.parameters.begin(), fit.parameters.end(), is_friction);
  if (own == fit.parameters.end()) {
    throw ParameterError("parameter",
                         "a comparison of friction laws needs a free friction parameter, as friction.radius");
  }
  double speed = 0.0;
  const double torque = mean_friction_torque(fit, speed);
  std::vector<FrictionCandidate> candidates;
  std::vector<FrictionLaw> laws;
  for (const auto& [name, law] : names_of<FrictionLaw>) laws.push_back(law);
  std::stable_partition(laws.begin(), laws.end(), [](FrictionLaw l) { return l != FrictionLaw::load_proportional; });
  for (const FrictionLaw law : laws) {
    if (progress) progress(std::string("friction law ") + name_of(law));
    BenchFit trial = fit;
    trial.profiles = false;
    trial.design.friction.law = law;
    if (law == FrictionLaw::none) trial.design.friction.coefficient = 0.0;
    std::erase_if(trial.parameters, is_friction);
    if (law != FrictionLaw::none && law == fit.design.friction.law) {
      trial.design.friction.coefficient = own->start;
      trial.parameters.push_back(*own);
    } else if (law != FrictionLaw::none) {
      // The coefficient that gives the same mean torque where the logs lie.
      const bool by_load = law == FrictionLaw::load_proportional;
      const double lever = fit.design.transmission.crank_radius;
      const double start = by_load ? 0.3 * lever : coefficient_for(law, torque, speed, 0.0);
      if (!(start > 0.0)) continue;
      trial.design.friction.coefficient = start;
      const double upper = by_load ? 2.0 * lever : 20.0 * start;
      trial.parameters.push_back({parameter_of(key_of(law)->path), 0.0, upper, start});
    }
    FrictionCandidate candidate;
    candidate.law = law;
    candidate.result = run_fit(trial, FitPurpose::comparison, {}, for_each);

    // Every condition predicted from the others.
    std::vector<std::pair<Condition, bool>> conditions;
    for (const BenchLog& log : fit.logs) {
      const std::pair<Condition, bool> c{log.condition, log.springs};
      if (std::find(conditions.begin(), conditions.end(), c) == conditions.end()) conditions.push_back(c);
    }
    double squares = 0.0;
    int count = 0;
    for (const auto& [condition, springs] : conditions) {
      if (conditions.size() < 2) break;
      BenchFit rest = trial, left = trial;
      std::erase_if(rest.logs,
                    [&, c = condition, s = springs](const auto& l) { return l.condition == c && l.springs == s; });
      std::erase_if(left.logs,
                    [&, c = condition, s = springs](const auto& l) { return l.condition != c || l.springs != s; });
      const FitResult without = run_fit(rest, FitPurpose::comparison, {}, for_each);
      // What the rest cannot determine at all comes from the whole: it is the friction law that is on trial.
      std::vector<double> x;
      for (std::size_t k = 0; k < trial.parameters.size(); ++k) {
        x.push_back(without.parameters[k].value ? *without.parameters[k].value : candidate.result.parameters[k].kept);
      }
      // Phases and zeros of the logs left out are their own.
      left = with_bench_unknowns(left);
      std::vector<std::size_t> of_logs;
      for (std::size_t k = x.size(); k < left.parameters.size(); ++k) {
        of_logs.push_back(k);
        x.push_back(left.parameters[k].start);
      }
      BenchFitter predictor(left, for_each);
      x = predictor.solve(predictor.bench().aligned(x), of_logs).x;
      predictor.bench().evaluate(x, false);
      double own_squares = 0.0;
      int own_count = 0;
      for (std::size_t o = 0; o < predictor.bench().observations().size(); ++o) {
        const Observation& at_o = predictor.bench().observations()[o];
        double deviation = predictor.deviations()[o];
        // Where deviations are estimated, those of the full fit by this law would flatter it: the given ones serve all.
        if (!predictor.bench().predictions()[at_o.point].reached) own_squares = infinity;
        const double r = (predictor.bench().fitted()[o] - at_o.measured) / deviation;
        own_squares += r * r;
        ++own_count;
      }
      candidate.left_out.emplace_back(condition_name(condition, springs), std::sqrt(own_squares / own_count));
      squares += own_squares;
      count += own_count;
    }
    candidate.prediction_error = count > 0 ? std::sqrt(squares / count) : absent;

    // The spring case.
    const bool has_spring = fit.design.spring.stiffness || fit.design.spring.resonance;
    std::vector<double> frequencies;  // in air, of which the middle one serves
    for (const FitPoint& p : candidate.result.points) {
      const BenchLog& log = fit.logs[p.log];
      if (log.condition != Condition::air || log.columns[p.column].waveform) continue;
      if (log.given == Given::frequency) frequencies.push_back(log.rows[p.row].given);
      if (log.columns[p.column].metric == Metric::frequency) frequencies.push_back(p.measured);
    }
    std::sort(frequencies.begin(), frequencies.end());
    const double frequency = frequencies.empty() ? 0.0 : frequencies[frequencies.size() / 2];
    if (has_spring && frequency > 0.0) {
      candidate.spring_frequency = frequency;
      for (const bool springs : {false, true}) {
        Design<double> design = candidate.result.design;
        if (!springs) design.spring = {};
        RunOptions options;
        options.frequency = frequency;
        options.allow_extrapolation = true;
        const RunResult run = run_design(design, options);
        if (run.status == FlappingStatus::flapping) {
          (springs ? candidate.power_springs_on : candidate.power_springs_off) = run.metrics[Metric::power_electrical];
        }
      }
    }
    candidates.push_back(std::move(candidate));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.result.aicc < b.result.aicc; });
  for (FrictionCandidate& c : candidates) c.aicc_excess = c.result.aicc - candidates.front().result.aicc;
  return candidates;
}

}  // namespace wingbeat
