#include "wingbeat/io/optimise_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure.hpp"
#include "wingbeat/io/design_file.hpp"
#include "wingbeat/io/design_keys.hpp"
#include "wingbeat/io/netcdf.hpp"
#include "wingbeat/io/report.hpp"

namespace wingbeat {
namespace {

using Outcome = OptimiseResult::Outcome;

std::string variable_name(const std::string& key) {
  std::string name = key;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

std::string meaning_of(const DesignParameter& p) { return std::string(find_key<double>(p.key)->meaning); }

double share(const OptimisedParameter& p, double x) {
  return p.logarithmic ? std::log(x / p.lower) / std::log(p.upper / p.lower) : (x - p.lower) / (p.upper - p.lower);
}

/// What the best design's own searches found.
void write_best(NetcdfFile& data, const OptimiseStudy& study, const OptimiseResult& r) {
  const MetricInfo& objective = metric_info(study.objective);
  const std::size_t parameters = study.parameters.size();
  const auto each_parameter = [&](const std::string& prefix, const std::string& of,
                                  const std::vector<NetcdfFile::Dimension>& along, std::size_t count,
                                  const auto& value) {
    for (std::size_t k = 0; k < parameters; ++k) {
      const DesignParameter& p = study.parameters[k].parameter;
      std::vector<double> values;
      for (std::size_t n = 0; n < count; ++n) values.push_back(value(n, k));
      const auto variable = data.define_variable(prefix + variable_name(p.key), along, p.unit, meaning_of(p) + of);
      data.set_key(variable, p.key);
      data.write(variable, values);
    }
  };
  for (int m = 0; m < metric_count; ++m) {
    const MetricInfo& metric = metric_info(Metric(m));
    data.write(data.define_variable(metric.key, {}, metric.unit, metric.long_name + std::string(" of the optimum")),
               std::span(&r.point.metrics.values[std::size_t(m)], 1));
  }
  each_parameter("", ", of the optimum", {}, 1, [&](std::size_t, std::size_t k) { return r.parameters[k]; });
  each_parameter("lower_", ", lower bound", {}, 1, [&](std::size_t, std::size_t k) { return study.parameters[k].lower; });
  each_parameter("upper_", ", upper bound", {}, 1, [&](std::size_t, std::size_t k) { return study.parameters[k].upper; });

  if (!r.searches.empty()) {
    const auto search = data.define_dimension("search", r.searches.size());
    const auto at = [&](std::size_t n, std::size_t k, const std::vector<double> SearchEnd::*where) {
      const std::vector<double>& x = r.searches[n].*where;
      return x.empty() ? absent : x[k];
    };
    each_parameter("search_start_", ", where the search began", {search}, r.searches.size(),
                   [&](std::size_t n, std::size_t k) { return at(n, k, &SearchEnd::start); });
    each_parameter("search_end_", ", where the search ended", {search}, r.searches.size(),
                   [&](std::size_t n, std::size_t k) { return at(n, k, &SearchEnd::end); });
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
    std::vector<std::string> names;
    std::vector<double> values, limits, costs;
    for (const MetricConstraint& c : study.constraints) {
      names.push_back(name_of(c));
      values.push_back(r.point.metrics[c.metric]);
      limits.push_back(c.limit);
      const auto active = std::find_if(r.active.begin(), r.active.end(),
                                       [&](const ActiveLimit& a) { return a.name == names.back(); });
      costs.push_back(active == r.active.end() ? 0.0 : active->sensitivity);
    }
    data.define_texts("constraint", constraint, names, "constraint");
    data.write(data.define_variable("constraint_value", {constraint}, "1",
                                    "value at the optimum, in the unit of the metric"), values);
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
    const auto at = [&](std::size_t n) -> const FlatDirection::Step* {
      const FlatDirection& d = r.directions[n / longest];
      return n % longest < d.walk.size() ? &d.walk[n % longest] : nullptr;
    };
    const std::size_t count = longest * r.directions.size();
    each_parameter("walk_", ", on the walk along a free direction", {direction, step}, count,
                   [&](std::size_t n, std::size_t k) { return at(n) ? at(n)->parameters[k] : absent; });
    const auto walked = [&](const char* name, const std::string& unit, const std::string& meaning, auto value) {
      std::vector<double> values;
      for (std::size_t n = 0; n < count; ++n) values.push_back(at(n) ? value(*at(n)) : absent);
      data.write(data.define_variable(name, {direction, step}, unit, meaning), values);
    };
    walked("walk_distance", "1", "distance from the optimum in ranges of the bounds",
           [](const FlatDirection::Step& s) { return s.distance; });
    walked("walk_objective", objective.unit, objective.long_name + std::string(", on the walk"),
           [](const FlatDirection::Step& s) { return s.objective; });
    const auto of = [&](const char* name, const char* meaning, auto value) {
      std::vector<double> values;
      for (const FlatDirection& d : r.directions) values.push_back(value(d));
      data.write(data.define_variable(name, {direction}, "1", meaning), values);
    };
    of("direction_width", "largest share of a parameter's bounds within which the objective is 0.1 % worse at most",
       [](const FlatDirection& d) { return d.width; });
    of("direction_flat", "1 for a null direction", [](const FlatDirection& d) { return d.flat ? 1.0 : 0.0; });
    of("direction_curvature", "of the Lagrangian, relative to the objective, per square of the range of the bounds",
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
                          .condition = name_of(study.options.condition)});
  data.set_attribute("objective", (study.maximise ? "maximise " : "minimise ") + std::string(objective.key));

  const auto trial = data.define_dimension("trial", trials.size());
  std::vector<std::string> names;
  for (const MotorTrial& t : trials) names.push_back(name_of(file, t));
  data.define_texts("trial", trial, names, "motor of the catalogue and discrete values");
  const auto outcome = data.define_dense("trial_outcome", {trial}, "1", "what the search found",
                                         NetcdfFile::Storage::flag);
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
  if (best) write_best(data, study, best->result);
  data.close();
}

void plot_optimum(const OptimiseFile& file, const MotorTrial& trial, PlotFormat format,
                  const std::filesystem::path& output) {
  const OptimiseStudy& study = file.study;
  const OptimiseResult& r = trial.result;
  const MetricInfo& objective = metric_info(study.objective);
  const bool walks = !r.directions.empty(), searches = !r.searches.empty();
  const double rows = 0.2 * double(study.parameters.size()), panel = 1.3;
  const double bounds_top = 0.72 + (searches ? panel + 0.75 : 0.0), walks_top = bounds_top + rows + 0.85;
  const double inches = walks ? walks_top + panel + 0.55 : bounds_top + rows + 0.55;
  Figure figure(format, 3.5, inches);
  const auto y = [&](double from_top) { return 1.0 - from_top / inches; };
  const std::string unit = std::string_view(objective.unit) == "1" ? "" : fmt::format(" ({})", objective.unit);
  const std::string chosen = name_of(file, trial);
  figure.add("set multiplot\nset rmargin at screen 0.96\nset datafile missing 'nan'\n");
  const std::string title = file.title.empty() ? "Optimum" : file.title;
  figure.text(title, 8.0 * std::min(1.0, 52.0 / double(title.size())), fmt::format("screen 0.5,{} center", y(0.12)));
  if (!chosen.empty()) figure.text(chosen, 7.0, fmt::format("screen 0.5,{} center", y(0.28)));
  int marks = 900;
  const auto mark = [&](double x, double from_top, const char* style, const std::string& name) {
    figure.add("set label {} '' at screen {},{} point {}\n", ++marks, x, y(from_top), style);
    figure.text(name, 6.5, fmt::format("screen {},{} left", x + 0.02, y(from_top)));
  };
  const char *begun = "pt 6 ps 0.5 lc rgb '#7f7f7f'", *ended = "pt 7 ps 0.5 lc rgb '#0072b2'";

  if (searches) {
    figure.add("$searches << END\n");
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t n = 0; n < r.searches.size(); ++n) {
      const SearchEnd& s = r.searches[n];
      figure.add("{} {} {}\n", n + 1, s.began, s.ended);
      for (const double x : {s.began, s.ended}) {
        if (!std::isfinite(x)) continue;
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    const double margin = std::max(0.08 * (high - low), 1e-6 * std::abs(high));
    figure.add("END\nset lmargin at screen 0.2\nset tmargin at screen {}\nset bmargin at screen {}\n", y(0.62),
               y(0.62 + panel));
    figure.add("set xrange [0:{}]\nset yrange [{}:{}]\n", r.searches.size() + 1, low - margin, high + margin);
    mark(0.22, 0.46, begun, "where a search began");
    mark(0.6, 0.46, ended, "where it ended");
    figure.text("local search", 7.0, fmt::format("screen 0.58,{} center", y(0.62 + panel + 0.33)));
    figure.text(objective.long_name + unit, 6.5,
                fmt::format("screen 0.03,{} center rotate by 90", y(0.62 + 0.5 * panel)));
    figure.add("plot $searches using 1:2 with points {}, $searches using 1:3 with points {}\n", begun, ended);
    figure.next_panel();
  }

  // Each parameter between its bounds: where the optimum is, and how far the free directions reach.
  figure.add("set lmargin at screen 0.46\nset tmargin at screen {}\nset bmargin at screen {}\n", y(bounds_top),
             y(bounds_top + rows));
  figure.add("set xrange [-0.02:1.02]\nset yrange [{}:0.5]\nunset ytics\nset border 1\n",
             0.5 - double(study.parameters.size()));
  if (!study.parameters.empty()) {
    figure.add("$optimum << END\n");
    for (std::size_t k = 0; k < study.parameters.size(); ++k) {
      const OptimisedParameter& p = study.parameters[k];
      double low = share(p, r.parameters[k]), high = low;
      for (const FlatDirection& d : r.directions) {
        for (const double x : {d.from[k], d.to[k]}) {
          low = std::min(low, share(p, x));
          high = std::max(high, share(p, x));
        }
      }
      figure.add("{} {} {} {}\n", share(p, r.parameters[k]), -double(k), low, high);
    }
    figure.add("END\n");
    for (std::size_t k = 0; k < study.parameters.size(); ++k) {
      const double row = bounds_top + rows * (double(k) + 0.5) / double(study.parameters.size());
      figure.text(study.parameters[k].parameter.key, 6.5, fmt::format("screen 0.44,{} right", y(row)));
    }
    figure.text(fmt::format("optimum between its bounds; bar: within {:g} % of it", 100.0 * flat_loss), 6.5,
                fmt::format("screen 0.5,{} center", y(bounds_top - 0.12)));
    figure.text("share of the bounds", 7.0, fmt::format("screen 0.71,{} center", y(bounds_top + rows + 0.33)));
    figure.add("plot $optimum using 3:2:($4-$3):(0) with vectors nohead lw 5 lc rgb '#9ecae1', "
               "$optimum using 1:2 with points {}\n", ended);
  }

  if (walks) {
    static constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#000000"};
    const std::size_t drawn = std::min<std::size_t>(4, r.directions.size());
    figure.next_panel();
    figure.add("set lmargin at screen 0.2\nset tmargin at screen {}\nset bmargin at screen {}\n", y(walks_top),
               y(walks_top + panel));
    figure.add("set border 3\nset ytics nomirror out scale 0.5\nset autoscale x\nset yrange [{}:{}]\n", -5.0 * flat_loss, 110.0 * flat_loss);
    const double best = r.point.metrics[study.objective];
    std::string plot;
    double reach = 0.0;
    for (std::size_t d = 0; d < drawn; ++d) {
      for (const FlatDirection::Step& s : r.directions[d].walk) reach = std::max(reach, std::abs(s.distance));
    }
    // Three or four tics on either side would run into each other.
    if (reach > 0.0) {
      const double power = std::pow(10.0, std::floor(std::log10(reach)));
      figure.add("set xtics {}\n", reach / power >= 4.0 ? 4.0 * power : reach / power >= 2.0 ? 2.0 * power : power);
    }
    for (std::size_t d = 0; d < drawn; ++d) {
      figure.add("$walk{} << END\n", d);
      for (const FlatDirection::Step& s : r.directions[d].walk) {
        const double loss = (study.maximise ? best - s.objective : s.objective - best) / std::abs(best);
        figure.add("{} {}\n", s.distance, 100.0 * loss);
      }
      figure.add("END\n");
      plot += fmt::format("{}$walk{} using 1:2 with linespoints pt 7 ps 0.3 dt {} lw 1.3 lc rgb '{}'",
                          d == 0 ? "" : ", ", d, d + 1, colours[d]);
      figure.key_entry(0.06 + 0.235 * double(d), y(walks_top - 0.12),
                       fmt::format("dt {} lw 1.3 lc rgb '{}'", d + 1, colours[d]).c_str(),
                       fmt::format("direction {}", d + 1));
    }
    figure.text("distance along a free direction (ranges of the bounds)", 7.0,
                fmt::format("screen 0.58,{} center", y(walks_top + panel + 0.33)));
    figure.text("objective worse by (%)", 6.5, fmt::format("screen 0.03,{} center rotate by 90",
                                                            y(walks_top + 0.5 * panel)));
    figure.add("plot {}\n", plot);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), output);
}

}  // namespace wingbeat
