#include "wingbeat/files/optimise_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/netcdf_results.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

using Outcome = OptimiseResult::Outcome;

std::string variable_name(const std::string& key) {
  std::string name = key;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

std::string meaning_of(const DesignParameter& p) { return std::string(find_parameter<double>(p.key)->meaning); }

/// What the best design's own searches found.
void write_best(NetcdfFile& data, const OptimiseStudy& study, const OptimiseResult& r) {
  const MetricInfo& objective = metric_info(study.objective);
  const std::size_t parameters = study.parameters.size();
  const auto each_parameter = [&](const std::string& prefix, const std::string& role,
                                  const std::vector<NetcdfFile::Dimension>& along, std::size_t count,
                                  const auto& value) {
    for (std::size_t k = 0; k < parameters; ++k) {
      const DesignParameter& p = study.parameters[k].parameter;
      std::vector<double> values;
      for (std::size_t n = 0; n < count; ++n) values.push_back(value(n, k));
      const auto variable = data.define_variable(prefix + variable_name(p.key), along, p.unit, meaning_of(p) + role);
      data.set_key(variable, p.key);
      data.write(variable, values);
    }
  };
  for (int m = 0; m < metric_count; ++m) {
    data.write(define_metric(data, Metric(m), {}, "", " of the optimum"),
               std::span(&r.point.metrics.values[std::size_t(m)], 1));
  }
  each_parameter("", ", of the optimum", {}, 1, [&](std::size_t, std::size_t k) { return r.parameters[k]; });
  each_parameter("lower_", ", lower bound", {}, 1,
                 [&](std::size_t, std::size_t k) { return study.parameters[k].lower; });
  each_parameter("upper_", ", upper bound", {}, 1,
                 [&](std::size_t, std::size_t k) { return study.parameters[k].upper; });

  if (!r.searches.empty()) {
    const auto search = data.define_dimension("search", r.searches.size());
    const auto parameter_at = [&](std::size_t n, std::size_t k, const std::vector<double> SearchEnd::* where) {
      const std::vector<double>& x = r.searches[n].*where;
      return x.empty() ? absent : x[k];
    };
    each_parameter("search_start_", ", where the search began", {search}, r.searches.size(),
                   [&](std::size_t n, std::size_t k) { return parameter_at(n, k, &SearchEnd::start); });
    each_parameter("search_end_", ", where the search ended", {search}, r.searches.size(),
                   [&](std::size_t n, std::size_t k) { return parameter_at(n, k, &SearchEnd::end); });
    const auto column = [&](const char* name, const std::string& unit, const std::string& meaning, auto value) {
      std::vector<double> values;
      for (const SearchEnd& s : r.searches) values.push_back(value(s));
      data.write(data.define_variable(name, {search}, unit, meaning), values);
    };
    column("search_began", objective.unit, objective.long_name + std::string(", where the search began"),
           [](const SearchEnd& s) { return s.began; });
    column("search_ended", objective.unit, objective.long_name + std::string(", where the search ended"),
           [](const SearchEnd& s) { return s.ended; });
    column("search_evaluations", "1", "orbits with gradients", [](const SearchEnd& s) { return s.evaluations; });
  }
  if (!study.constraints.empty()) {
    const auto constraint = data.define_dimension("constraint", study.constraints.size());
    std::vector<std::string> names, units;
    std::vector<double> values, limits, costs;
    for (const MetricConstraint& c : study.constraints) {
      names.push_back(name_of(c));
      units.push_back(metric_info(c.metric).unit);
      values.push_back(r.point.metrics[c.metric]);
      limits.push_back(c.limit);
      const auto active =
          std::find_if(r.active.begin(), r.active.end(), [&](const ActiveLimit& a) { return a.name == names.back(); });
      costs.push_back(active == r.active.end() ? 0.0 : active->sensitivity);
    }
    data.define_texts("constraint", constraint, names, "constraint");
    data.define_texts("constraint_unit", constraint, units, "unit of the metric");
    data.write(
        data.define_variable("constraint_value", {constraint}, "1", "value at the optimum, in the unit of the metric"),
        values);
    data.write(data.define_variable("constraint_limit", {constraint}, "1", "limit, in the unit of the metric"), limits);
    data.write(data.define_variable("constraint_sensitivity", {constraint}, "1",
                                    "relative loss for a relative tightening; 0 where it does not hold the optimum"),
               costs);
  }
  if (!r.directions.empty()) {
    std::size_t longest = 0;
    for (const FlatDirection& d : r.directions) longest = std::max(longest, d.walk.size());
    const auto direction = data.define_dimension("direction", r.directions.size());
    const auto step = data.define_dimension("step", longest);
    const auto step_of = [&](std::size_t n) -> const FlatDirection::Step* {
      const FlatDirection& d = r.directions[n / longest];
      return n % longest < d.walk.size() ? &d.walk[n % longest] : nullptr;
    };
    const std::size_t count = longest * r.directions.size();
    each_parameter("walk_", ", on the walk along a free direction", {direction, step}, count,
                   [&](std::size_t n, std::size_t k) { return step_of(n) ? step_of(n)->parameters[k] : absent; });
    const auto walked = [&](const char* name, const std::string& unit, const std::string& meaning, auto value) {
      std::vector<double> values;
      for (std::size_t n = 0; n < count; ++n) values.push_back(step_of(n) ? value(*step_of(n)) : absent);
      data.write(data.define_variable(name, {direction, step}, unit, meaning), values);
    };
    walked("walk_distance", "1", "distance from the optimum in ranges of the bounds",
           [](const FlatDirection::Step& s) { return s.distance; });
    walked("walk_objective", objective.unit, objective.long_name + std::string(", on the walk"),
           [](const FlatDirection::Step& s) { return s.objective; });
    const auto write_column = [&](const char* name, const char* meaning, auto value) {
      std::vector<double> values;
      for (const FlatDirection& d : r.directions) values.push_back(value(d));
      data.write(data.define_variable(name, {direction}, "1", meaning), values);
    };
    write_column("direction_width",
                 "largest share of a parameter's bounds within which the objective is 0.1 % worse at most",
                 [](const FlatDirection& d) { return d.width; });
    write_column("direction_flat", "1 for a null direction", [](const FlatDirection& d) { return d.flat ? 1.0 : 0.0; });
    write_column("direction_curvature",
                 "of the Lagrangian, relative to the objective, per square of the range of the bounds",
                 [](const FlatDirection& d) { return d.curvature; });
  }
}

}  // namespace

void write_optimum(const OptimiseFile& file, std::span<const MotorTrial> trials, const std::string& input,
                   const std::string& version, const std::filesystem::path& output) {
  const OptimiseStudy& study = file.study;
  const MetricInfo& objective = metric_info(study.objective);
  const MotorTrial* best = best_trial(file, trials);
  NetcdfFile data(output);
  write_provenance(data, {.title = file.title.empty() ? "optimum" : file.title,
                          .command = "optimise",
                          .version = version,
                          .vehicle = write_design(best ? best->result.design : study.design),
                          .study = input,
                          .condition = name_of(study.options.condition),
                          .tolerance = study.options.tolerance});
  data.set_attribute("objective", (study.maximise ? "maximise " : "minimise ") + std::string(objective.key));

  const auto trial = data.define_dimension("trial", trials.size());
  std::vector<std::string> names;
  for (const MotorTrial& t : trials) names.push_back(name_of(file, t));
  data.define_texts("trial", trial, names, "motor of the catalogue and discrete values");
  const auto outcome =
      data.define_dense("trial_outcome", {trial}, "1", "what the search found", NetcdfFile::Storage::flag);
  data.set_flags(outcome, std::vector<std::string>{"found", "infeasible", "nothing_flaps", "refused"});
  std::vector<std::int8_t> outcomes;
  for (const MotorTrial& t : trials) outcomes.push_back(std::int8_t(t.refused() ? 3 : int(t.result.outcome)));
  data.write_run(outcome, 0, std::span<const std::int8_t>(outcomes));
  const auto column = [&](const std::string& name, const std::string& unit, const std::string& meaning, auto value) {
    std::vector<double> values;
    for (const MotorTrial& t : trials) {
      values.push_back(!t.refused() && t.result.outcome == Outcome::found ? value(t) : absent);
    }
    data.write(data.define_variable("trial_" + name, {trial}, unit, meaning + ", optimum of the trial"), values);
  };
  column(objective.key, objective.unit, objective.long_name,
         [&](const MotorTrial& t) { return t.result.point.metrics[study.objective]; });
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    const DesignParameter& p = study.parameters[k].parameter;
    column(variable_name(p.key), p.unit, meaning_of(p), [k](const MotorTrial& t) { return t.result.parameters[k]; });
  }
  for (std::size_t k = 0; k < file.choices.size(); ++k) {
    const DesignParameter& p = file.choices[k].parameter;
    column(variable_name(p.key), p.unit, meaning_of(p), [k](const MotorTrial& t) { return t.choices[k]; });
  }
  if (best) write_best(data, trial_study(file, *best), best->result);
  data.close();
}

}  // namespace wingbeat
