#include "wingbeat/report/pareto_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/figure.hpp"
#include "report/layout.hpp"
#include "report/read_out.hpp"
#include "report/report_tools.hpp"
#include "report/sweep_scales.hpp"
#include "report/vehicle_counts.hpp"
#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/netcdf_results.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

using detail::optimum_width, detail::with_unit;
const char* algorithm_of(EvolutionMethod method) { return method == EvolutionMethod::nsga2 ? "NSGA-II" : "MOEA/D"; }

/// Parameters, then choices: all that a design of the study sets.
std::vector<const DesignParameter*> parameters_of(const ParetoStudy& study) {
  std::vector<const DesignParameter*> all;
  for (const OptimisedParameter& p : study.parameters) all.push_back(&p.parameter);
  for (const DiscreteParameter& p : study.choices) all.push_back(&p.parameter);
  return all;
}

/// Product of the objectives' units, for UDUNITS.
std::string hypervolume_unit(const ParetoStudy& study) {
  std::string unit;
  for (const ParetoObjective& o : study.objectives) {
    const std::string_view factor = metric_info(o.metric).unit;
    if (factor != "1") unit += fmt::format("{}{}", unit.empty() ? "" : " ", factor);
  }
  return unit.empty() ? "1" : unit;
}

std::string reference_text(const ParetoStudy& study, const ParetoResult& r) {
  std::string text;
  for (std::size_t m = 0; m < study.objectives.size(); ++m) {
    const MetricInfo& metric = metric_info(study.objectives[m].metric);
    text += fmt::format("{}{} = {}", m == 0 ? "" : ", ", metric.key, with_unit(r.reference[m], metric.unit));
  }
  return text;
}

/// Metrics that constraints ask for and objectives do not.
std::vector<Metric> limited_metrics(const ParetoStudy& study) {
  std::vector<Metric> metrics;
  for (const MetricConstraint& c : study.constraints) {
    const bool objective = std::any_of(study.objectives.begin(), study.objectives.end(),
                                       [&](const ParetoObjective& o) { return o.metric == c.metric; });
    if (!objective && std::find(metrics.begin(), metrics.end(), c.metric) == metrics.end()) metrics.push_back(c.metric);
  }
  return metrics;
}

/// The picked designs in the order of the front, each with its shortest name.
std::vector<std::pair<std::string, std::size_t>> columns_of(const ParetoStudy& study, const ParetoResult& r) {
  std::vector<std::pair<std::string, std::size_t>> columns;
  const auto add = [&](std::string name, std::size_t place) {
    const bool there = std::any_of(columns.begin(), columns.end(), [&](const auto& c) { return c.second == place; });
    if (!there) columns.emplace_back(std::move(name), place);
  };
  for (std::size_t m = 0; m < study.objectives.size(); ++m) add(fmt::format("end {}", m + 1), r.picks.ends[m]);
  add("knee", r.picks.knee);
  for (std::size_t n = 0; n < r.picks.even.size(); ++n) add(fmt::format("even {}", n + 1), r.picks.even[n]);
  std::stable_sort(columns.begin(), columns.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return columns;
}

/// What a read-out shows of each design of the front: objectives in the units shown, parameters, motor; its places
/// follow.
ReadOutPanel front_points(const ParetoStudy& study, const ParetoResult& r, const std::vector<Display>& displays) {
  ReadOutPanel panel{};
  for (std::size_t k = 0; k < study.objectives.size(); ++k) {
    panel.columns.push_back({metric_info(study.objectives[k].metric).long_name, displays[k].unit, {}});
    for (const ParetoDesign& d : r.front) {
      panel.columns.back().values.push_back(displays[k].factor * d.metrics[study.objectives[k].metric]);
    }
  }
  const std::vector<const DesignParameter*> parameters = parameters_of(study);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    double largest = 0.0;
    for (const ParetoDesign& d : r.front) largest = std::max(largest, std::abs(d.parameters[k]));
    const Display display = display_for(parameters[k]->unit, largest);
    panel.columns.push_back({words(parameters[k]->key), display.unit, {}});
    for (const ParetoDesign& d : r.front) panel.columns.back().values.push_back(display.factor * d.parameters[k]);
  }
  for (const ParetoDesign& d : r.front) {
    panel.notes.push_back(study.vehicles.size() > 1 ? study.vehicles[d.vehicle].name : "");
    const std::string domain = design_note(0, unsigned(d.domain.to_ulong()));
    if (!domain.empty()) panel.notes.back() += (panel.notes.back().empty() ? "" : "; ") + domain;
  }
  for (const auto& [name, place] : columns_of(study, r)) {
    panel.notes[place] += (panel.notes[place].empty() ? "" : "; ") + name;
  }
  return panel;
}

}  // namespace

std::vector<VehicleCount> count_vehicles(const ParetoStudy& study, const ParetoResult& r) {
  std::vector<VehicleCount> counts(study.vehicles.size());
  for (std::size_t n = 0; n < r.evaluated.size(); ++n) {
    VehicleCount& c = counts[r.evaluated[n].vehicle];
    ++c.solved;
    c.flap += r.status[n] == SweepStatus::flapping;
    c.feasible += r.feasible[n];
  }
  for (const ParetoDesign& d : r.front) ++counts[d.vehicle].front;
  return counts;
}

std::vector<std::string> pick_names(std::span<const ParetoObjective> objectives, std::size_t even) {
  std::vector<std::string> names;
  for (const ParetoObjective& o : objectives) names.push_back(fmt::format("end-{}", metric_info(o.metric).key));
  names.push_back("knee");
  for (std::size_t n = 1; n <= even; ++n) names.push_back(fmt::format("even-{}", n));
  return names;
}

std::vector<std::pair<std::string, std::size_t>> named_picks(const ParetoStudy& study, const ParetoResult& result) {
  std::vector<std::pair<std::string, std::size_t>> picks;
  if (result.front.empty()) return picks;
  std::vector<std::size_t> places = result.picks.ends;
  places.push_back(result.picks.knee);
  places.insert(places.end(), result.picks.even.begin(), result.picks.even.end());
  const std::vector<std::string> names = pick_names(study.objectives, result.picks.even.size());
  for (std::size_t n = 0; n < names.size(); ++n) picks.emplace_back(names[n], places[n]);
  return picks;
}

std::string text_front(const OptimiseFile& file, const ParetoStudy& study, const ParetoResult& r) {
  std::string text;
  auto out = std::back_inserter(text);
  if (!file.title.empty()) fmt::format_to(out, "{}\n", wrapped(file.title, optimum_width, 0));
  std::string aims;
  for (const ParetoObjective& o : study.objectives) {
    aims += fmt::format("{}{} {}", aims.empty() ? "" : ", ", o.maximise ? "maximise" : "minimise",
                        metric_info(o.metric).key);
  }
  for (std::size_t c = 0; c < study.constraints.size(); ++c) {
    aims += (c == 0 ? " with " : ", ") + name_of(study.constraints[c]);
  }
  if (study.hold) aims += "; " + describe(*study.hold);
  fmt::format_to(out, "{}\nscreened {} designs: {} flap, {} of these within every constraint\n",
                 wrapped(aims, optimum_width, 0), study.screen, r.screen.status[0], r.screen.feasible);
  if (r.screen.outside > 0) {
    fmt::format_to(out, "{} that flap are outside the model's domain and are excluded\n", r.screen.outside);
  }
  if (study.allow_extrapolation)
    fmt::format_to(out, "designs outside the model's domain count: extrapolation is allowed\n");
  const auto motors = [&] {
    if (file.motors.empty()) return;
    fmt::format_to(out, "\n{:<30}{:>10}{:>10}{:>10}{:>14}\n", "Motor", "solved", "flap", "feasible", "on the front");
    const std::vector<VehicleCount> counts = count_vehicles(study, r);
    for (std::size_t v = 0; v < counts.size(); ++v) {
      fmt::format_to(out, "{:<30}{:>10}{:>10}{:>10}{:>14}\n", study.vehicles[v].name, counts[v].solved, counts[v].flap,
                     counts[v].feasible, counts[v].front);
    }
    for (const MotorCandidate& motor : file.motors) {
      if (motor.refused.empty()) continue;
      fmt::format_to(out, "{:<30}{}\n", motor.model,
                     wrapped(std::string(30, '_') + motor.refused, optimum_width, 30).substr(30));
    }
  };
  if (r.outcome != ParetoResult::Outcome::found) {
    fmt::format_to(out, "{}\n", wrapped("No design found: " + describe(nothing_found(study, r)), optimum_width, 2));
    motors();
    return text;
  }
  fmt::format_to(out, "{}: {} generations of {}, {} designs solved, {} of them feasible\n\n",
                 algorithm_of(study.evolution.method), study.evolution.generations, study.evolution.population,
                 r.evaluated.size(), std::count(r.feasible.begin(), r.feasible.end(), true));
  fmt::format_to(out, "front of {} designs; hypervolume {:.6g} {} up to\n  {}\n", r.front.size(), r.hypervolume,
                 hypervolume_unit(study), reference_text(study, r));
  if (r.hypervolume > 0.0) {
    fmt::format_to(out, "  after the screening {:.1f} % of it, after half of the generations {:.2f} %\n\n",
                   100.0 * r.history.front() / r.hypervolume, 100.0 * r.history[r.history.size() / 2] / r.hypervolume);
  } else {
    fmt::format_to(out,
                   "  no design is better than the reference in every objective: choose a reference that is worse\n\n");
  }

  const auto columns = columns_of(study, r);
  const std::size_t fit = 6;  // beside the names
  for (std::size_t first = 0; first < columns.size(); first += fit) {
    const std::size_t last = std::min(columns.size(), first + fit);
    if (first > 0) text += "\n";
    fmt::format_to(out, "{:<40}", "Design");
    for (std::size_t c = first; c < last; ++c) fmt::format_to(out, "{:>10}", columns[c].first);
    text += "\n";
    const auto row = [&](std::string_view name, std::string_view unit, const auto& value) {
      fmt::format_to(out, "  {:<38}", unit == "1" ? std::string(name) : fmt::format("{} ({})", name, unit));
      for (std::size_t c = first; c < last; ++c) fmt::format_to(out, "{:>10.4g}", value(r.front[columns[c].second]));
      text += "\n";
    };
    const auto metric = [&](Metric m) {
      row(metric_info(m).key, metric_info(m).unit, [&](const ParetoDesign& d) { return d.metrics[m]; });
    };
    for (const ParetoObjective& o : study.objectives) metric(o.metric);
    for (const Metric m : limited_metrics(study)) metric(m);
    const auto parameters = parameters_of(study);
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const detail::ShownUnit shown = detail::shown_unit(parameters[k]->unit);
      row(parameters[k]->key, shown.name, [&](const ParetoDesign& d) { return shown.factor * d.parameters[k]; });
    }
    if (study.vehicles.size() > 1) {
      for (std::size_t c = first; c < last; ++c) {
        fmt::format_to(out, "  motor of {}: {}\n", columns[c].first,
                       study.vehicles[r.front[columns[c].second].vehicle].name);
      }
    }
  }
  motors();
  return text;
}

void write_front(const ParetoStudy& study, const ParetoResult& r, const std::string& title, const std::string& input,
                 const std::string& version, const std::filesystem::path& file) {
  NetcdfFile data(file);
  write_provenance(data, {.title = title.empty() ? "Pareto front" : title,
                          .command = "optimise",
                          .version = version,
                          .vehicle = write_design(study.vehicles[0].design),
                          .study = input,
                          .condition = name_of(study.condition),
                          .method = algorithm_of(study.evolution.method),
                          .tolerance = study.tolerance});
  const auto parameters = parameters_of(study);
  const auto designs = [&](const std::string& dimension, const std::string& prefix, const char* role,
                           std::span<const ParetoDesign> list, const MetricSet& metrics) {
    const auto along = data.define_dimension(dimension, list.size());
    std::vector<double> values(list.size());
    const auto column = [&](const std::string& name, std::string_view unit, const std::string& meaning,
                            const auto& value) {
      std::transform(list.begin(), list.end(), values.begin(), value);
      const auto variable = data.define_variable(prefix + name, {along}, std::string(unit), meaning + role);
      data.write(variable, values);
      return variable;
    };
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      std::string name = parameters[k]->key;
      std::replace(name.begin(), name.end(), '.', '_');
      const std::string& key = parameters[k]->key;
      data.set_key(column(name, parameters[k]->unit, std::string(find_parameter<double>(key)->meaning),
                          [k](const ParetoDesign& d) { return d.parameters[k]; }),
                   key);
    }
    for (std::size_t m = 0; m < metric_count; ++m) {
      if (!metrics[m]) continue;
      std::transform(list.begin(), list.end(), values.begin(),
                     [m](const ParetoDesign& d) { return d.metrics.values[m]; });
      data.write(define_metric(data, Metric(m), {along}, prefix, role), values);
    }
    std::vector<std::int16_t> exceeded;
    for (const ParetoDesign& d : list) exceeded.push_back(std::int16_t(d.domain.to_ulong()));
    data.write_run(define_domain(data, {along}, prefix, role), 0, std::span<const std::int16_t>(exceeded));
    if (study.vehicles.size() > 1) {
      std::vector<std::string> names;
      for (const ParetoDesign& d : list) names.push_back(study.vehicles[d.vehicle].name);
      data.define_texts(prefix + "motor", along, names, std::string("motor of the catalogue") + role);
    }
    return along;
  };
  MetricSet shown = all_metrics();
  for (const ParetoObjective& o : study.objectives) shown.set(std::size_t(o.metric));
  for (const MetricConstraint& c : study.constraints) shown.set(std::size_t(c.metric));
  const auto along = designs("design", "", "", r.front, shown);
  std::vector<std::string> picks(r.front.size());
  for (const auto& [name, place] : named_picks(study, r)) picks[place] += (picks[place].empty() ? "" : " ") + name;
  data.define_texts("pick", along, picks, "names under which the design is picked");

  MetricSet asked;
  for (const ParetoObjective& o : study.objectives) asked.set(std::size_t(o.metric));
  for (const MetricConstraint& c : study.constraints) asked.set(std::size_t(c.metric));
  const auto solved = designs("evaluated", "evaluated_", ", of every design solved", r.evaluated, asked);
  const auto write_flags = [&](const NetcdfFile::Variable& variable, const auto& value) {
    std::vector<std::int8_t> values;
    for (std::size_t n = 0; n < r.evaluated.size(); ++n) values.push_back(std::int8_t(value(n)));
    data.write_run(variable, 0, std::span<const std::int8_t>(values));
  };
  write_flags(define_status(data, {solved}, "evaluated_"), [&](std::size_t n) { return r.status[n]; });
  const auto feasible =
      data.define_dense("evaluated_feasible", {solved}, "1",
                        "flapping, inside the model's domain and within every constraint", NetcdfFile::Storage::flag);
  data.set_flags(feasible, std::vector<std::string>{"no", "yes"});
  write_flags(feasible, [&](std::size_t n) { return r.feasible[n] ? 1 : 0; });

  const auto objective = data.define_dimension("objective", study.objectives.size());
  std::vector<std::string> names, senses, units;
  for (const ParetoObjective& o : study.objectives) {
    names.push_back(metric_info(o.metric).key);
    senses.push_back(o.maximise ? "maximise" : "minimise");
    units.push_back(metric_info(o.metric).unit);
  }
  data.define_texts("objective", objective, names, "metric");
  data.define_texts("sense", objective, senses, "whether the objective is minimised or maximised");
  data.define_texts("objective_unit", objective, units, "unit of the metric");
  data.write(data.define_variable("reference", {objective}, "1",
                                  "reference point of the hypervolume, in the unit of the objective"),
             r.reference);
  const std::string unit = hypervolume_unit(study);
  data.write(data.define_variable("hypervolume", {}, unit, "hypervolume that the front dominates up to the reference"),
             std::span(&r.hypervolume, 1));
  const auto generation = data.define_dimension("generation", r.history.size());
  data.write(data.define_variable("hypervolume_history", {generation}, unit,
                                  "hypervolume after the screening and after each generation"),
             r.history);
  data.close();
}

void plot_front(const ParetoStudy& study, const ParetoResult& r, const std::string& title, PlotFormat format,
                const std::filesystem::path& file) {
  const std::size_t m = study.objectives.size();
  std::vector<std::pair<std::size_t, std::size_t>> panels = {{0, 1}};
  if (m == 3) panels = {{0, 1}, {0, 2}, {1, 2}};
  const double panel = 2.45, inches = 0.45 + panel * double(panels.size());
  Figure figure(format, inches);
  const auto y = [&](double from_top) { return 1.0 - from_top / inches; };
  std::vector<Display> displays;
  for (const ParetoObjective& o : study.objectives) {
    double largest = 0.0;
    for (const ParetoDesign& d : r.front) largest = std::max(largest, std::abs(d.metrics[o.metric]));
    displays.push_back(display_of(o.metric, largest));
  }
  const auto value = [&](const ParetoDesign& d, std::size_t k) {
    return displays[k].factor * d.metrics[study.objectives[k].metric];
  };

  // A drawing with every design solved would be too large; those left out look like their neighbours.
  std::vector<const ParetoDesign*> cloud;
  for (std::size_t n = 0; n < r.evaluated.size(); ++n) {
    if (r.feasible[n]) cloud.push_back(&r.evaluated[n]);
  }
  const std::size_t stride = cloud.size() / 1500 + 1;
  const auto block = [&](const char* name, const auto& each) {
    figure.add("${} << END\n", name);
    each([&](const ParetoDesign& d) {
      for (std::size_t k = 0; k < m; ++k) figure.add("{} ", value(d, k));
      figure.add("\n");
    });
    figure.add("END\n");
  };
  block("cloud", [&](const auto& put) {
    for (std::size_t n = 0; n < cloud.size(); n += stride) put(*cloud[n]);
  });
  block("front", [&](const auto& put) {
    for (const ParetoDesign& d : r.front) put(d);
  });
  block("ends", [&](const auto& put) {
    for (const std::size_t n : r.picks.ends) put(r.front[n]);
  });
  block("knee", [&](const auto& put) { put(r.front[r.picks.knee]); });

  figure.add("set multiplot\nset lmargin at screen 0.16\nset rmargin at screen 0.96\n");
  const std::string heading = title.empty() ? "Pareto front" : title;
  page_title(figure, heading, 0.12);
  int keys = 900;
  const auto key = [&](double x, const char* style, const char* name) {
    figure.add("set label {} '' at screen {},{} point {}\n", ++keys, x, y(0.32), style);
    figure.text(name, 7.0, fmt::format("screen {},{} left", x + 0.02, y(0.32)));
  };
  const char *grey = "pt 7 ps 0.2 lc rgb '#bdbdbd'", *blue = "pt 7 ps 0.3 lc rgb '#000000'";
  const char *end = "pt 9 ps 0.8 lc rgb '#653a92'", *knee = "pt 13 ps 0.9 lc rgb '#8d68b5'";
  key(0.16, grey, "feasible designs");
  key(0.48, blue, "front");
  key(0.66, end, "ends");
  key(0.82, knee, "knee");
  const auto label = [&](std::size_t k) {
    return metric_info(study.objectives[k].metric).long_name + displays[k].in_brackets();
  };
  const auto range = [&](const char* axis, std::size_t k) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    const auto take = [&](const ParetoDesign& d) {
      low = std::min(low, value(d, k));
      high = std::max(high, value(d, k));
    };
    for (const ParetoDesign* d : cloud) take(*d);
    for (const ParetoDesign& d : r.front) take(d);
    const double margin = high > low ? 0.04 * (high - low) : std::max(0.04 * std::abs(low), 1e-12);
    figure.add("set {}range [{}:{}]\n", axis, low - margin, high + margin);
    return std::pair(low - margin, high + margin);
  };
  std::vector<ReadOutPanel> pages;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const auto [a, b] = panels[p];
    const double top = 0.5 + panel * double(p), bottom = top + panel - 0.55;
    if (p > 0) figure.next_panel();
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", y(top), y(bottom));
    fitted_text(figure, label(a), 7.5, 0.86 * format.width, 0.56 * format.width, bottom + 0.36, "center");
    axis_title(figure, label(b), 7.5, panel - 0.1, 0.16 - 0.44 / format.width, y(0.5 * (top + bottom)));
    const auto [x_low, x_high] = range("x", a);
    const auto [y_low, y_high] = range("y", b);
    if (format == PlotFormat::html) {
      ReadOutPanel& page = pages.emplace_back(front_points(study, r, displays));
      page.name = label(b) + " over " + label(a);
      page.left = 0.16, page.right = 0.96, page.top = top / inches, page.bottom = bottom / inches;
      for (const ParetoDesign& d : r.front) {
        page.x.push_back(share_of_axis(value(d, a), x_low, x_high, false));
        page.y.push_back(share_of_axis(value(d, b), y_low, y_high, false));
      }
    }
    figure.add(
        "plot $cloud using {0}:{1} with points {2}, $front using {0}:{1} with points {3}, "
        "$ends using {0}:{1} with points {4}, $knee using {0}:{1} with points {5}\n",
        a + 1, b + 1, grey, blue, end, knee);
  }
  figure.add("unset multiplot\nunset output\n");
  write_figure(figure, format, heading, pages, file);
}

}  // namespace wingbeat
