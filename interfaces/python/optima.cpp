// Optima and fronts for Python, by metrics and by functions of the user's own. Nothing is computed here.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "binding.hpp"
#include "report/result_trees.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/report/pareto_report.hpp"
#include "wingbeat/run/evolution_module.hpp"
#include "wingbeat/study/own_search.hpp"

namespace wingbeat::python {
namespace {

/// Of one objective.
py::dict find_best(OptimiseFile study, int threads) {
  const bool drive_trains = study.drive_train.any();
  DriveTrainScreen screen;
  std::vector<MotorTrial> trials = drive_trains ? std::vector<MotorTrial>() : trials_of(study);
  watched(py::none(), [&](const Watch&) {
    const ForEach for_each = side_by_side(threads);
    if (drive_trains) trials = choose_drive_train(study, start_up_in_time(), for_each, {}, screen);
    else
      for (MotorTrial& trial : trials) {
        if (!trial.refused()) trial.result = optimise(trial_study(study, trial), start_up_in_time(), for_each);
      }
    return true;
  });
  const MotorTrial* best = best_trial(study, trials);
  const bool single = !drive_trains && trials.size() == 1 && !trials[0].motor;
  py::dict result =
      drive_trains
          ? reported(detail::drive_trains_tree(study, screen, trials), text_drive_trains(study, screen, trials))
      : single ? reported(detail::optimum_tree(study, trials[0].result), text_optimum(study, trials[0].result))
               : reported(detail::motors_tree(study, trials), text_motors(study, trials));
  result["design"] = best ? py::cast(best->result.design) : py::none();
  return result;
}

/// Of several objectives. `folders`: where pagmo's module may be.
py::dict find_front(const OptimiseFile& file, int threads, const std::vector<std::string>& folders,
                    const py::object& progress) {
  const std::vector<std::filesystem::path> places(folders.begin(), folders.end());
  const Evolve evolve = load_evolution(places);
  const ParetoStudy study = pareto_study(file);
  const ParetoResult found = watched(progress, [&](Watch& watch) {
    const auto tell = [&](std::uint64_t done, std::uint64_t designs) { watch.report({designs, done, done, 0.0}); };
    return pareto_front(study, evolve, start_up_in_time(), side_by_side(threads), tell);
  });
  py::dict result = reported(detail::front_tree(file, study, found), text_front(file, study, found));
  py::list vehicles, picks, metrics, parameters, keys;
  for (const ParetoDesign& design : found.front) vehicles.append(vehicle_of(study, design));
  if (!found.front.empty()) {
    for (const auto& [name, place] : named_picks(study, found)) picks.append(py::make_tuple(name, place));
  }
  const auto column = [&](const auto& value) {
    std::vector<double> numbers;
    for (const ParetoDesign& design : found.front) numbers.push_back(value(design));
    return array_of(std::move(numbers));
  };
  for (std::size_t m = 0; m < std::size_t(metric_count); ++m) {
    metrics.append(column([m](const ParetoDesign& design) { return design.metrics.values[m]; }));
  }
  for (const OptimisedParameter& p : study.parameters) keys.append(p.parameter.key);
  for (const DiscreteParameter& p : study.choices) keys.append(p.parameter.key);
  for (std::size_t k = 0; k < study.parameters.size() + study.choices.size(); ++k) {
    parameters.append(column([k](const ParetoDesign& design) { return design.parameters[k]; }));
  }
  result["vehicles"] = vehicles;
  result["picks"] = picks;
  result["metrics"] = metrics;
  result["keys"] = keys;
  result["parameters"] = parameters;
  return result;
}

py::dict find_optimum(const std::string& name, const std::vector<std::string>& overrides, bool allow_extrapolation,
                      int threads, const std::vector<std::string>& folders, const py::object& progress) {
  forget_files();
  OptimiseFile file = read_optimise_study(find_input(name, InputKind::study), overrides);
  file.study.allow_extrapolation |= allow_extrapolation;
  return file.objectives.empty() ? find_best(std::move(file), threads) : find_front(file, threads, folders, progress);
}

// ---- functions of the user's own

/// A term as Python gives it: the number, or with it its derivatives by metrics (by their places) and by parameters.
OwnTerm term_of(const py::handle& given) {
  OwnTerm term;
  const auto parts = given.cast<py::tuple>();
  term.value = parts[0].cast<double>();
  if (parts.size() == 1) return term;
  term.differentiated = true;
  for (const auto& [metric, slope] : parts[1].cast<py::dict>()) {
    term.by_metric.at(metric.cast<std::size_t>()) = slope.cast<double>();
  }
  term.by_parameter = parts[2].cast<std::vector<double>>();
  return term;
}

/// `evaluate(design, found)` gives the objective and the constraints of a design that flaps, as term_of() reads them;
/// `found` is what run() returns. The study's own objective is not used.
py::dict find_own(const std::string& name, const std::vector<std::string>& overrides, bool allow_extrapolation,
                  const py::function& evaluate, std::size_t constraints) {
  forget_files();
  OptimiseFile file = read_optimise_study(find_input(name, InputKind::study), overrides);
  file.study.allow_extrapolation |= allow_extrapolation;
  if (!file.objectives.empty() || !file.choices.empty() || !file.motors.empty() || file.drive_train.any()) {
    throw InputError("", 0, 0, "objective",
                     "a function of your own is for one objective, parameters between bounds and one motor");
  }
  OwnTerms terms;
  terms.constraints = constraints;
  terms.evaluate = [&](const Design<double>& design, const DesignPoint& point) {
    const Entered own;
    const Vehicle<double> vehicle = resolve(with_any_pitch_coefficient(design), file.study.options.condition);
    RunResult run;
    run.status = FlappingStatus::flapping;
    run.evidence = point.evidence;
    run.metrics = point.metrics;
    run.domain = point.domain;
    run.domain_evidence = domain_evidence(vehicle, point.metrics);
    run.residual_share = notable_residual(vehicle, point.metrics);
    run.added_mass_lift = notable_added_mass_lift(point.metrics);
    const py::dict found = outcome_of(run);
    std::vector<OwnTerm> made;
    for (const py::handle term : evaluate(design, found).cast<py::list>()) made.push_back(term_of(term));
    if (made.size() != constraints + 1) throw py::value_error("expected a term for the objective and each constraint");
    return made;
  };
  const OwnOptimum found = listening([&] { return optimise_own(file.study, terms, start_up_in_time()); });
  py::list searches, keys;
  for (const OptimisedParameter& p : file.study.parameters) keys.append(p.parameter.key);
  for (const SearchEnd& s : found.searches) {
    searches.append(py::make_tuple(s.start, s.end, s.began, s.ended, s.evaluations));
  }
  const bool there = found.outcome == OptimiseResult::Outcome::found;
  const char* outcomes[] = {"found", "infeasible", "nothing_flaps"};
  py::dict result;
  result["outcome"] = outcomes[int(found.outcome)];
  result["keys"] = keys;
  result["parameters"] = found.parameters;
  result["objective"] = found.objective;
  result["starts"] = py::make_tuple(found.starts, found.same, found.elsewhere, found.failed);
  result["evaluations"] = found.evaluations;
  result["gradients"] = found.gradients;
  result["searches"] = searches;
  result["design"] = there ? py::cast(found.design) : py::none();
  return result;
}

}  // namespace

void add_optima(py::module_& m) {
  m.def("optimise", &find_optimum);
  m.def("optimise_own", &find_own);
}

}  // namespace wingbeat::python
