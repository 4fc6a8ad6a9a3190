#include "wingbeat/report/endurance_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "report/described.hpp"
#include "report/figure.hpp"
#include "report/layout.hpp"
#include "report/result_schemas.hpp"
#include "report/result_trees.hpp"
#include "wingbeat/files/netcdf_results.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

double ratio(double a, double b) { return b > 0.0 ? a / b : absent; }

/// Totals and means of a whole flight.
struct Flight {
  explicit Flight(const EnduranceResult& r) : rows(r.rows), last(r.rows.back()) {
    time = last.time;
    drawn = r.capacity * (rows.front().charge - last.charge);
    chemical = last.energy_electrical + last.energy_internal;
    current = ratio(drawn, time);
    power = ratio(last.energy_electrical, time);
    lift = ratio(last.lift_impulse, time);
    aerodynamic = ratio(last.energy_aerodynamic, time);
    efficiency = ratio(last.energy_aerodynamic, last.energy_electrical);
  }
  const std::vector<EnduranceRow>& rows;
  const EnduranceRow& last;
  double time, drawn, chemical, current, power, lift, aerodynamic, efficiency;
};

/// A column of the history: JSON, data set.
struct Column {
  const char* key;
  const char* unit;
  const char* long_name;
  double EnduranceRow::* value;
};
constexpr Column columns[] = {
    {"time_s", "s", "time since the start", &EnduranceRow::time},
    {"charge", "1", "state of charge", &EnduranceRow::charge},
    {"open_circuit_voltage_v", "V", "open-circuit voltage of the battery", &EnduranceRow::open_circuit_voltage},
    {"terminal_voltage_v", "V", "mean voltage at the battery's terminals", &EnduranceRow::terminal_voltage},
    {"battery_current_a", "A", "mean current from the battery", &EnduranceRow::battery_current},
    {"duty", "1", "duty of the speed control", &EnduranceRow::duty},
    {"lift_to_weight_full", "1", "lift over weight at a duty of 1", &EnduranceRow::full_lift_to_weight},
    {"energy_electrical_j", "J", "energy delivered at the terminals since the start", &EnduranceRow::energy_electrical},
    {"energy_internal_j", "J", "energy lost inside the battery since the start", &EnduranceRow::energy_internal},
    {"energy_aerodynamic_j", "J", "energy given to the air since the start", &EnduranceRow::energy_aerodynamic}};

/// Rows outside the model's domain, and every limit that they exceed.
std::pair<std::size_t, DomainStatus> outside(const EnduranceResult& result) {
  std::pair<std::size_t, DomainStatus> sum{0, {}};
  for (const EnduranceRow& row : result.rows) {
    sum.first += row.domain.any();
    sum.second |= row.domain;
  }
  return sum;
}

bool of_a_flight(Metric metric) { return metric == Metric::hover || metric == Metric::endurance; }

bool heated(const Flight& f) { return std::isfinite(f.last.metrics[Metric::winding_temperature]); }

std::string duration(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  return seconds < 100.0 ? readable(seconds, "s") : fmt::format("{:.1f} s", seconds);
}

std::string minutes(double seconds) { return seconds < 100.0 ? "" : fmt::format("{:.2f} min", seconds / 60.0); }

/// Hover first: how long the vehicle flaps is no flight where it cannot carry its weight.
std::string plot_title(const EnduranceResult& result) {
  const std::string flaps = fmt::format("flaps for {}", duration(result.endurance()));
  switch (result.hover) {
    case Hover::unknown: return "Hover unknown without a mass; " + flaps;
    case Hover::never: return "Does not hover; " + flaps;
    case Hover::outside: return "Hover outside the model's domain; " + flaps;
    case Hover::lost: return fmt::format("Hovers for {}, {}", duration(result.hover_lost->time), flaps);
    case Hover::kept: return fmt::format("Hovers for {}, until the flight ends", duration(result.endurance()));
  }
  return flaps;
}

}  // namespace

const char* name_of(EnduranceEnd end) {
  switch (end) {
    case EnduranceEnd::never_starts: return "never starts";
    case EnduranceEnd::empty: return "empty";
    case EnduranceEnd::cutoff: return "cut-off voltage";
    case EnduranceEnd::bridge: return "bridge";
    case EnduranceEnd::stops: return "stops flapping";
    case EnduranceEnd::sinks: return "sinks";
  }
  return "unknown";
}

const char* name_of(Hover hover) {
  switch (hover) {
    case Hover::unknown: return "unknown";
    case Hover::never: return "never";
    case Hover::outside: return "outside domain";
    case Hover::lost: return "lost";
    case Hover::kept: return "kept";
  }
  return "unknown";
}

namespace described {
namespace {

Json history_of(const Flight& flight) {
  Json history = Json::object();
  for (const Column& c : columns) {
    for (const EnduranceRow& row : flight.rows) history[c.key].push_back(detail::number_or_null(row.*c.value));
  }
  for (const Metric m : {Metric::voltage, Metric::current_mean, Metric::frequency, Metric::power_electrical,
                         Metric::power_aerodynamic, Metric::lift_mean, Metric::lift_to_weight,
                         Metric::efficiency_system, Metric::winding_temperature, Metric::case_temperature}) {
    if (lacking_of_heat(m, {}) && !heated(flight)) continue;
    const char* key = metric_info(m).key;
    for (const EnduranceRow& row : flight.rows) history[key].push_back(detail::number_or_null(row.metrics[m]));
  }
  for (const EnduranceRow& row : flight.rows) history["domain"].push_back(name_of(row.domain));
  for (const EnduranceRow& row : flight.rows) {
    const bool known = std::isfinite(row.full_lift_to_weight);
    history["domain_full"].push_back(known ? Json(name_of(row.full_domain)) : Json(nullptr));
  }
  return history;
}

const Description<EnduranceRow>& moment_description() {
  using R = EnduranceRow;
  static const Description<R> description =
      Description<R>()
          .always("time_s", "s", "since the start", &R::time, schema::any_number)
          .always("charge", "1", "state of charge", &R::charge, schema::any_number)
          .always("open_circuit_voltage_v", "V", "of the battery", &R::open_circuit_voltage, schema::any_number)
          .all_of(cycle_metrics_description(), &R::metrics);
  return description;
}

/// A number of the flight, where it flaps at all.
template <class Value>
auto of_the_flight(Value value) {
  return [value](const EnduranceResult& r) {
    return r.rows.empty() ? std::nullopt : std::optional<double>(std::invoke(value, Flight(r)));
  };
}

const Description<EnduranceResult>& endurance_description() {
  using R = EnduranceResult;
  const auto row = [](bool last) {
    return [last](const R& r) {
      return r.rows.empty() ? nullptr : last ? &r.rows.back().metrics : &r.rows.front().metrics;
    };
  };
  static const Description<R> description =
      Description<R>()
          .always(
              "status", "", "at the start", [](const R& r) { return Json(name_of(r.status)); },
              schema::or_null(schema::statuses()))
          .always("status_detail", "", "a sentence with the evidence", [](const R& r) { return describe(r); })
          .always("hover", "",
                  "whether and how long the lift carries the weight: unknown, never, outside domain, lost, kept",
                  [](const R& r) { return name_of(r.hover); })
          .always("throttle", "", "fixed, or hover: the lift is held at the weight",
                  [](const R& r) { return name_of(r.throttle); })
          .always("hover_s", "s", "flight time until lift falls below the weight", &R::hover_time)
          .always("lift_to_weight_full", "1",
                  "lift over weight at full throttle and the first charge; null at a fixed one",
                  &R::first_full_lift_to_weight)
          .always("end", "", "what ends the flight", [](const R& r) { return name_of(r.end); })
          .always("endurance_s", "s", "flight time until the battery's end", &R::endurance, schema::any_number)
          .always("domain", "", "inside, or the limits that are exceeded during the flight",
                  [](const R& r) {
                    return r.rows.empty() ? std::nullopt : std::optional<std::string>(name_of(outside(r).second));
                  })
          .part("hover_lost", "when lift falls below the weight", moment_description(), &R::hover_lost)
          .always("charge_initial", "1", "state of charge at the start",
                  of_the_flight([](const Flight& f) { return f.rows.front().charge; }))
          .always("charge_final", "1", "state of charge at the end",
                  of_the_flight([](const Flight& f) { return f.last.charge; }))
          .always("charge_drawn_c", "C", "charge drawn from the battery", of_the_flight(&Flight::drawn))
          .always("energy_chemical_j", "J", "energy that the battery gave, its own losses included",
                  of_the_flight(&Flight::chemical))
          .always("energy_electrical_j", "J", "energy delivered at the terminals",
                  of_the_flight([](const Flight& f) { return f.last.energy_electrical; }))
          .always("energy_internal_j", "J", "energy lost inside the battery",
                  of_the_flight([](const Flight& f) { return f.last.energy_internal; }))
          .always("energy_aerodynamic_j", "J", "energy given to the air",
                  of_the_flight([](const Flight& f) { return f.last.energy_aerodynamic; }))
          .always("current_mean_a", "A", "mean current from the battery", of_the_flight(&Flight::current))
          .always("power_electrical_w", "W", "mean power at the terminals", of_the_flight(&Flight::power))
          .always("power_aerodynamic_w", "W", "mean power to the air", of_the_flight(&Flight::aerodynamic))
          .always("lift_mean_n", "N", "mean lift of the flight", of_the_flight(&Flight::lift))
          .always("efficiency_system", "1", "energy to the air over energy at the terminals",
                  of_the_flight(&Flight::efficiency))
          .part("initial", "metrics at the start", cycle_metrics_description(), row(false))
          .part("final", "metrics at the end", cycle_metrics_description(), row(true))
          .always(
              "history", "", "lists of one value for each row of the flight",
              [](const R& r) { return r.rows.empty() ? Json(nullptr) : history_of(Flight(r)); },
              schema::or_null(
                  schema::by_name(schema::listed(schema::either({schema::number_if_any, schema::any_text})))));
  return description;
}

}  // namespace

Json endurance_schema() { return endurance_description().schema(); }

}  // namespace described

detail::Json detail::endurance_tree(const EnduranceResult& result) {
  return described::endurance_description().json(result);
}

std::string json_endurance(const EnduranceResult& result) {
  return detail::endurance_tree(result).dump(2, ' ', false, detail::Json::error_handler_t::replace) + "\n";
}

std::string text_endurance(const Design<double>& design, const EnduranceResult& result) {
  std::string text;
  auto out = std::back_inserter(text);
  const auto line = [&](std::string_view name, const std::string& value, const std::string& remark = "") {
    std::string s = fmt::format("  {:<32}{:>14}   {}", name, value, remark);
    while (s.back() == ' ') s.pop_back();
    text += s + "\n";
  };
  const auto charge = [](double c) { return fmt::format("{:.2f} %", 100.0 * c); };
  if (!design.name.empty()) text += wrapped(design.name, 88, 0) + "\n";
  if (const auto [rows, limits] = outside(result); rows > 0) {
    text += wrapped(fmt::format("OUTSIDE THE MODEL'S DOMAIN ({}) in {} of {} rows of the discharge: these rows are "
                                "extrapolated.",
                                name_of(limits), rows, result.rows.size()),
                    88, 2) +
            "\n";
  }
  std::string sentence = describe(result) + ".";
  sentence.front() = char(std::toupper(static_cast<unsigned char>(sentence.front())));
  text += wrapped(sentence, 88, 2) + "\n";
  if (result.rows.empty()) return text;
  const Flight f(result);

  text += "\nOn the battery\n";
  switch (result.hover) {
    case Hover::unknown: line("hovers for", "unknown", "the vehicle file gives no mass"); break;
    case Hover::never: line("hovers for", "never", "below weight from the start: cannot hover"); break;
    case Hover::outside:
      line("hovers for", "not claimed", "lift exceeds the weight, but outside the model's domain");
      break;
    case Hover::kept: line("hovers for", duration(f.time), minutes(f.time) + "   until the flight ends"); break;
    case Hover::lost: {
      const EnduranceRow& lost = *result.hover_lost;
      line("hovers for", duration(lost.time), minutes(lost.time));
      line("  to a charge of", charge(lost.charge));
      line("  terminal voltage", readable(lost.terminal_voltage, "V"),
           fmt::format("{} without load", readable(lost.open_circuit_voltage, "V")));
      line("  mean current", readable(lost.battery_current, "A"));
      line("  flapping frequency", readable(lost.metrics[Metric::frequency], "Hz"));
      break;
    }
  }
  if (result.end != EnduranceEnd::sinks) line("flaps for", duration(f.time), minutes(f.time));

  text += "\nBattery\n";
  line("charge drawn", readable(f.drawn / 3.6, "mA h"),
       fmt::format("from {} to {}", charge(f.rows.front().charge), charge(f.last.charge)));
  line("energy of the cells", readable(f.chemical, "J"));
  const auto share = [&](double energy) { return fmt::format("{:>6.2f} %", 100.0 * energy / f.chemical); };
  if (f.chemical > 0.0) {
    line("  at the terminals", readable(f.last.energy_electrical, "J"), share(f.last.energy_electrical));
    line("  lost inside the battery", readable(f.last.energy_internal, "J"), share(f.last.energy_internal));
    line("  given to the air", readable(f.last.energy_aerodynamic, "J"), share(f.last.energy_aerodynamic));
  }

  fmt::format_to(out, "\n{:<24}{:>14}{:>14}{:>14}\n", "Over the discharge", "first", "mean", "last");
  const EnduranceRow& first = f.rows.front();
  const auto over_flight = [&](const char* name, Metric m, const char* unit, double mean) {
    fmt::format_to(out, "  {:<22}{:>14}{:>14}{:>14}\n", name, readable(first.metrics[m], unit), readable(mean, unit),
                   readable(f.last.metrics[m], unit));
  };
  const auto percent = [](double x) { return std::isfinite(x) ? fmt::format("{:.2f} %", 100.0 * x) : "-"; };
  const auto of_battery = [&](const char* name, double EnduranceRow::* value, const char* unit, double mean) {
    fmt::format_to(out, "  {:<22}{:>14}{:>14}{:>14}\n", name, readable(first.*value, unit), readable(mean, unit),
                   readable(f.last.*value, unit));
  };
  of_battery("terminal voltage", &EnduranceRow::terminal_voltage, "V", ratio(f.last.energy_electrical, f.drawn));
  of_battery("mean current", &EnduranceRow::battery_current, "A", f.current);
  over_flight("electrical power", Metric::power_electrical, "W", f.power);
  over_flight("aerodynamic power", Metric::power_aerodynamic, "W", f.aerodynamic);
  fmt::format_to(out, "  {:<22}{:>14}{:>14}{:>14}\n", "system efficiency",
                 percent(first.metrics[Metric::efficiency_system]), percent(f.efficiency),
                 percent(f.last.metrics[Metric::efficiency_system]));
  over_flight("mean lift", Metric::lift_mean, "N", f.lift);
  if (const auto mass = total_mass(design)) {
    const double weight = *mass * standard_gravity;
    fmt::format_to(out, "  {:<22}{:>14.4g}{:>14.4g}{:>14.4g}\n", "mean lift / weight",
                   first.metrics[Metric::lift_to_weight], f.lift / weight, f.last.metrics[Metric::lift_to_weight]);
  }
  const bool throttled = result.throttle == Throttle::hover, has_duty = std::isfinite(first.duty);
  const bool full_outside = first.full_domain.any() || f.last.full_domain.any();
  if (throttled && has_duty) {
    const auto margin = [](const EnduranceRow& row) {
      if (!std::isfinite(row.full_lift_to_weight)) return std::string("-");
      return fmt::format("{:.4g}{}", row.full_lift_to_weight, row.full_domain.any() ? "*" : "");
    };
    fmt::format_to(out, "  {:<22}{:>14}{:>14}{:>14}\n", "  at full duty", margin(first), "-", margin(f.last));
  }
  if (has_duty && (throttled || first.duty < 1.0)) {
    fmt::format_to(out, "  {:<22}{:>14.4g}{:>14}{:>14.4g}\n", "duty", first.duty, "-", f.last.duty);
  }
  if (std::isfinite(first.amplitude)) of_battery("amplitude", &EnduranceRow::amplitude, "V", absent);
  over_flight("flapping frequency", Metric::frequency, "Hz", absent);
  for (const Metric m : {Metric::winding_temperature, Metric::case_temperature}) {
    if (!heated(f)) break;
    const auto degrees = [&](const EnduranceRow& row) { return fmt::format("{:.1f} degC", row.metrics[m]); };
    fmt::format_to(out, "  {:<22}{:>14}{:>14}{:>14}\n",
                   m == Metric::winding_temperature ? "winding temperature" : "case temperature", degrees(first), "-",
                   degrees(f.last));
  }
  if (throttled && full_outside) text += "  * outside the model's domain at full duty\n";
  return text;
}

void plot_endurance(const Design<double>& design, const EnduranceResult& result, PlotFormat format,
                    const std::filesystem::path& file) {
  if (!(result.endurance() > 0.0)) throw std::runtime_error("no discharge to plot");
  const auto& rows = result.rows;
  const bool weighed = total_mass(design).has_value();
  const double weight = total_mass(design).value_or(absent) * standard_gravity;
  const bool in_minutes = result.endurance() >= 120.0;
  const double time_scale = in_minutes ? 1.0 / 60.0 : 1.0;
  double max_lift = weighed ? weight : 0.0, max_power = 0.0;
  const auto full_lift = [&](const EnduranceRow& r) {
    return std::isfinite(r.full_lift_to_weight) && r.full_domain.none() ? weight * r.full_lift_to_weight : absent;
  };
  bool has_margin = false;
  for (const EnduranceRow& r : rows) {
    max_lift = std::max(max_lift, r.metrics[Metric::lift_mean]);
    if (!std::isnan(full_lift(r))) {
      has_margin = true;
      max_lift = std::max(max_lift, full_lift(r));
    }
    max_power = std::max(max_power, r.metrics[Metric::power_electrical]);
  }
  const bool lift_in_newton = max_lift >= 1.0, power_in_watt = max_power >= 1.0;
  const double lift_scale = lift_in_newton ? 1.0 : 1e3, power_scale = power_in_watt ? 1.0 : 1e3;

  Figure figure(format, 5.6);
  figure.add("$flight << END\n");
  for (const EnduranceRow& r : rows) {
    figure.add("{} {} {} {} {} {} {} {} {}\n", time_scale * r.time, lift_scale * r.metrics[Metric::lift_mean],
               power_scale * r.metrics[Metric::power_electrical], power_scale * r.metrics[Metric::power_aerodynamic],
               r.terminal_voltage, r.open_circuit_voltage, 100.0 * r.charge, lift_scale * full_lift(r), 100.0 * r.duty);
  }
  figure.add("END\nset multiplot\nset xrange [0:{}]\n", time_scale * result.endurance());

  // Margins of the page, in its fractions.
  constexpr double left = 0.15, right = 0.96, top = 0.93, bottom = 0.075, gap = 0.05;
  constexpr double height = (top - bottom - 3.0 * gap) / 4.0;
  figure.add("set lmargin at screen {}\nset rmargin at screen {}\n", left, right);
  page_title(figure, plot_title(result), 0.1);
  double key_height = 0.0;
  const auto panel = [&](int index, const std::string& name, double highest) {
    if (index > 0) figure.next_panel();
    const double panel_top = top - index * (height + gap);
    key_height = panel_top + 0.014;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", panel_top, panel_top - height);
    figure.add("set format x {}\n{}", index == 3 ? "'%g'" : "''",
               AxisMarks(0.0, 1.06 * highest, height * figure.height(), true, false).commands("y"));
    figure.text(name, 7.5,
                fmt::format("screen {},{} center rotate by 90", left - 0.435 / format.width, panel_top - 0.5 * height));
    for (std::size_t n = 0; n + 1 < rows.size(); ++n) {
      if (rows[n].domain.none() && rows[n + 1].domain.none()) continue;
      figure.add(
          "set object {} rectangle from {},graph 0 to {},graph 1 behind fillcolor rgb '#909090' fillstyle transparent "
          "pattern 4 noborder\n",
          1000 + n, time_scale * rows[n].time, time_scale * rows[n + 1].time);
    }
    // Loss of hover runs through all panels.
    if (result.hover_lost) {
      const double time = time_scale * result.hover_lost->time;
      figure.add("set arrow 90 from {0},graph 0 to {0},graph 1 nohead front dt (3,3) lw 0.8 lc rgb '#404040'\n", time);
    }
  };

  constexpr const char* lost_line = "dt (3,3) lw 0.8 lc rgb '#404040'";
  panel(0, fmt::format("lift ({})", lift_in_newton ? "N" : "mN"), lift_scale * max_lift);
  figure.key_entry(left, key_height, style::first_curve, "mean lift");
  if (weighed) {
    figure.key_entry(left + 0.22, key_height, style::reference_line,
                     fmt::format("weight, {:.4g} {}", lift_scale * weight, lift_in_newton ? "N" : "mN"));
    if (result.hover_lost && !has_margin) figure.key_entry(left + 0.56, key_height, lost_line, "hover lost");
  }
  if (has_margin) figure.key_entry(left + 0.56, key_height, style::second_curve, "at full duty");
  figure.add("plot $flight using 1:2 with lines {}", style::first_curve);
  if (has_margin) figure.add(", '' using 1:8 with lines {}", style::second_curve);
  if (weighed) figure.add(", {} with lines {}", lift_scale * weight, style::reference_line);
  figure.add("\n");

  panel(1, power_in_watt ? "power (W)" : "power (mW)", power_scale * max_power);
  figure.key_entry(left, key_height, style::first_curve, "electrical");
  figure.key_entry(left + 0.22, key_height, style::stroke(style::aerodynamic), "aerodynamic");
  if (result.hover_lost && has_margin) figure.key_entry(left + 0.56, key_height, lost_line, "hover lost");
  figure.add("plot $flight using 1:3 with lines {}, '' using 1:4 with lines {}\n", style::first_curve,
             style::stroke(style::aerodynamic));

  panel(2, "voltage (V)", rows.front().open_circuit_voltage);
  figure.key_entry(left, key_height, style::first_curve, "terminals");
  figure.key_entry(left + 0.22, key_height, style::second_curve, "open circuit");
  figure.add("plot $flight using 1:5 with lines {}, '' using 1:6 with lines {}\n", style::first_curve,
             style::second_curve);

  const bool shows_duty = result.throttle == Throttle::hover && std::isfinite(rows.front().duty);
  panel(3, shows_duty ? "charge, duty (%)" : "charge (%)", 100.0);
  const bool hatched = outside(result).first > 0;
  if (hatched) {
    figure.text("hatched: outside the model's domain", style::text_size, fmt::format("screen {},0.014 right", right));
  }
  figure.text(in_minutes ? "time (min)" : "time (s)", 7.5,
              hatched ? fmt::format("screen {},0.014 left", left)
                      : fmt::format("screen {},0.014 center", 0.5 * (left + right)));
  figure.key_entry(left, key_height, style::first_curve, shows_duty ? "charge" : "state of charge");
  if (shows_duty) figure.key_entry(left + 0.22, key_height, style::second_curve, "duty");
  figure.add("plot $flight using 1:7 with lines {}", style::first_curve);
  if (shows_duty) figure.add(", '' using 1:9 with lines {}", style::second_curve);
  figure.add("\n");
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

void write_endurance(const EnduranceResult& result, const Provenance& provenance, const std::filesystem::path& path) {
  if (result.rows.empty()) throw std::runtime_error("no discharge to write");
  NetcdfFile file(path);
  const NetcdfFile::Dimension time = file.define_dimension("time_s", result.rows.size());
  std::vector<NetcdfFile::Variable> variables;
  for (const Column& c : columns) {
    variables.push_back(file.define_variable(c.key, {time}, c.unit, c.long_name));
  }
  std::vector<Metric> metrics;
  for (int m = 0; m < metric_count; ++m) {
    if (!of_a_flight(Metric(m))) metrics.push_back(Metric(m));
  }
  for (const Metric m : metrics) {
    variables.push_back(define_metric(file, m, {time}));
  }
  const auto domain = define_domain(file, {time});
  file.set_attribute("end", name_of(result.end));
  file.set_attribute("end_detail", describe(result));
  file.set_attribute("hover", name_of(result.hover));
  write_provenance(file, provenance);
  std::vector<double> values(result.rows.size());
  const auto write = [&](const NetcdfFile::Variable& variable, const auto& value) {
    std::transform(result.rows.begin(), result.rows.end(), values.begin(), value);
    file.write(variable, values);
  };
  for (std::size_t c = 0; c < std::size(columns); ++c) {
    write(variables[c], [&](const EnduranceRow& row) { return row.*columns[c].value; });
  }
  std::vector<std::int16_t> exceeded;
  for (const EnduranceRow& row : result.rows) exceeded.push_back(std::int16_t(row.domain.to_ulong()));
  file.write_run(domain, 0, std::span<const std::int16_t>(exceeded));
  for (std::size_t n = 0; n < metrics.size(); ++n) {
    write(variables[std::size(columns) + n], [&](const EnduranceRow& row) { return row.metrics[metrics[n]]; });
  }
  file.close();
}

}  // namespace wingbeat
