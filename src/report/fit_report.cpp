#include "wingbeat/report/fit_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "files/design_write.hpp"
#include "report/fit_rows.hpp"
#include "report/report_tools.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/bench_report.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/plot_panels.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {

std::string detail::row_name(const BenchFit& fit, std::size_t log, std::size_t row) {
  return fmt::format("{}:{}", fit.logs[log].file, fit.logs[log].rows[row].line);
}

namespace {

using detail::row_name;

std::string given_text(const BenchFit& fit, std::size_t log, std::size_t row) {
  const BenchLog& l = fit.logs[log];
  return fmt::format("{:.4g} {}, {}", l.rows[row].given, l.given == Given::voltage ? "V" : "Hz",
                     condition_name(l.condition, l.springs));
}

std::string short_number(double x, int digits = 4) {
  return std::isfinite(x) ? fmt::format("{:.{}g}", x, digits) : "-";
}

/// As people write it: with an exponent where there would be many zeros.
std::string with_digits(double x, int digits) {
  if (!std::isfinite(x)) return "-";
  if (x == 0.0) return "0";
  const double size = std::abs(x);
  if (size < 1e-3 || size >= 1e5) return fmt::format("{:.{}e}", x, digits - 1);
  return fmt::format("{:.{}f}", x, std::max(0, digits - 1 - int(std::floor(std::log10(size)))));
}

/// Phases and zeros of logs stand apart: nobody asks for them, and there may be many.
bool is_asked_for(const FittedParameter& p) { return p.of != FittedParameter::Of::log; }

/// One row of the table of parameters.
std::string parameter_row(const FittedParameter& p) {
  if (!p.value) return fmt::format("{:<32}{:>11}  {}\n", p.key, "unknown", describe(p.undetermined));
  const detail::ShownUnit shown = detail::shown_unit(p.unit);
  const double f = shown.factor;
  const char* bound = p.at_bound ? "  AT ITS BOUND" : "";
  if (!std::isfinite(p.standard_error)) {
    return fmt::format("{:<32}{:>11}{:>9}  {:^22}  {}{}\n", p.key, with_digits(f * *p.value, 5), "-", "-", shown.name,
                       bound);
  }
  const bool profiled = std::isfinite(p.profile_lower_95) && std::isfinite(p.profile_upper_95);
  const double low = f * (profiled ? p.profile_lower_95 : p.lower_95);
  const double high = f * (profiled ? p.profile_upper_95 : p.upper_95);
  return fmt::format("{:<32}{:>11}{:>9}  {:>10} .. {:<10} {}{}\n", p.key, with_digits(f * *p.value, 5),
                     with_digits(f * p.standard_error, 2), with_digits(low, 4),
                     with_digits(high, 4) + (profiled ? "" : "*"), shown.name, bound);
}

/// Phases and zeros of the logs.
std::string of_logs(const FitResult& r) {
  std::string text;
  for (const FittedParameter& p : r.parameters) {
    if (is_asked_for(p)) continue;
    if (text.empty()) text = "\nAlso fitted\n";
    const bool angle = p.unit == "rad";
    const double factor = angle ? degrees_per_radian : 1.0;
    const std::string value = !p.value ? "unknown"
                              : angle  ? fmt::format("{:.2f} deg", factor * *p.value)
                                       : readable(*p.value, p.unit);
    const std::string error = !p.value || !std::isfinite(p.standard_error) ? ""
                              : angle ? fmt::format(" +- {:.2g} deg", factor * p.standard_error)
                                      : " +- " + readable(p.standard_error, p.unit);
    text += fmt::format("  {:<50} {}{}\n", p.key, value, error);
  }
  return text;
}

/// Correlations, what the data determine, and which condition contributes what.
std::string identifiability(const FitResult& r) {
  std::string text;
  text += "\nCorrelation\n";
  for (std::size_t a = 0; a < r.parameters.size(); ++a) {
    if (!r.parameters[a].value || !is_asked_for(r.parameters[a])) continue;
    text += fmt::format("  {:<31}", r.parameters[a].key);
    for (std::size_t b = 0; b <= a; ++b) {
      if (r.parameters[b].value && is_asked_for(r.parameters[b])) text += fmt::format("{:>7.2f}", r.correlation[a][b]);
    }
    text += "\n";
  }
  text += "\nIdentifiability\n";
  for (const std::string& sentence : describe(r.findings)) text += "  " + wrapped(sentence, 88, 4) + "\n";

  text += "\nShare of the information, the other parameters known\n";
  text += fmt::format("  {:<31}", "");
  for (const ConditionShare& c : r.conditions) text += fmt::format("{:>18}", c.name);
  text += "\n";
  for (std::size_t k = 0; k < r.parameters.size(); ++k) {
    if (!is_asked_for(r.parameters[k])) continue;
    text += fmt::format("  {:<31}", r.parameters[k].key);
    for (const ConditionShare& c : r.conditions) text += fmt::format("{:>16.0f} %", 100.0 * c.share[k]);
    text += "\n";
  }
  text += fmt::format("  {:<31}", "values; rms residual / deviation");
  for (const ConditionShare& c : r.conditions)
    text += fmt::format("{:>17}", fmt::format("{}; {}", c.points, short_number(c.rms, 3)));
  text += "\n";
  return text;
}

std::string residuals_by_quantity(const FitResult& r) {
  std::string text =
      fmt::format("\n{:<40}{:>8}{:>18}{:>20}\n", "Residuals", "values", "rms / deviation", "measured / fitted");
  for (const QuantityResiduals& q : r.quantities) {
    text += fmt::format("  {:<38}{:>8}{:>18}{:>20}\n", name_of(q.quantity), q.values, short_number(q.rms, 3),
                        short_number(q.measured_over_fitted, 4));
  }
  return text;
}

std::string list(const std::vector<std::string>& keys) {
  std::string text;
  for (const std::string& key : keys) text += (text.empty() ? "" : ", ") + key;
  return text;
}

/// "a and b, of which the data know only the product", or the components of the direction.
std::string direction(const FitFinding& f) {
  const std::vector<double>& part = f.numbers;
  if (part.size() == 2 && std::abs(std::abs(part[0] / part[1]) - 1.0) < 0.05) {
    return fmt::format("{} and {}, of which the data know only the {}", f.parameters[0], f.parameters[1],
                       part[0] * part[1] < 0.0 ? "product" : "ratio");
  }
  std::string text;
  const double sign = part.empty() || part[0] > 0.0 ? 1.0 : -1.0;
  for (std::size_t n = 0; n < part.size(); ++n) {
    text += fmt::format("{}{} {:+.2f}", text.empty() ? "" : ", ", f.parameters[n], sign * part[n]);
  }
  return text;
}

/// ", its values 1000 times those of the model", where they are far apart.
std::string proportion(const QuantityResiduals& q) {
  if (!(q.measured_over_fitted > 3.0 || q.measured_over_fitted < 1.0 / 3.0)) return "";
  return fmt::format(", its values {:.3g} times those of the model (is its unit right?)", q.measured_over_fitted);
}

std::string describe(const FitFinding& f) {
  switch (f.kind) {
    case FitFinding::Kind::without_influence:
      return fmt::format(
          "not identifiable, no measured quantity depends on it: {}; no number is returned, the vehicle keeps the "
          "start value",
          list(f.parameters));
    case FitFinding::Kind::left_free:
      return fmt::format(
          "left free by the data: {}{}", direction(f),
          std::isfinite(f.relative_error) ? fmt::format(" (uncertain by {:.0f} %)", 100.0 * f.relative_error) : "");
    case FitFinding::Kind::known_roughly:
      return fmt::format("known only roughly: {} ({:.0f} %)", direction(f), 100.0 * f.relative_error);
    case FitFinding::Kind::determined: return "the data determine " + list(f.parameters);
    case FitFinding::Kind::most_correlated:
      return fmt::format("the strongest correlation is that of {} and {} ({:+.2f})", f.parameters[0], f.parameters[1],
                         f.numbers[0]);
    case FitFinding::Kind::determined_by: return fmt::format("only {} determines {}", f.condition, list(f.parameters));
    case FitFinding::Kind::narrowed_by: {
      std::string wider;
      for (std::size_t n = 0; n < f.parameters.size(); ++n) {
        wider += fmt::format("{}{} {:.1f} times", wider.empty() ? "" : ", ", f.parameters[n], f.numbers[n]);
      }
      return fmt::format("without {} the intervals would be wider: {}", f.condition, wider);
    }
    case FitFinding::Kind::product_of_friction:
      return list(f.parameters) + " is the product mu r_e: no measurement of this kind separates mu from r_e";
  }
  return "";
}

}  // namespace

std::vector<std::string> describe(std::span<const FitFinding> findings) {
  std::vector<std::string> sentences;
  for (const FitFinding& f : findings) {
    if (f.kind == FitFinding::Kind::most_correlated && !sentences.empty()) sentences.back() += "; " + describe(f);
    else sentences.push_back(describe(f));
  }
  return sentences;
}

std::string describe(const Misfit& m) {
  const QuantityResiduals& q = m.worst;
  if (q.estimated) {
    return fmt::format(
        "the residuals of {} are on average {:.3g} times the spread of its values and {:.3g} times their size{}",
        name_of(q.quantity), std::sqrt(q.unexplained), q.relative, proportion(q));
  }
  return fmt::format(
      "chi square is {:.4g} where {:.4g} degrees of freedom lead to expect {:.4g} +- {:.2g}: the values lie {:.3g} "
      "times their stated deviations from the model on average; worst is {}, {:.3g} times its deviation{}",
      m.chi_square, m.freedom, m.freedom, m.spread, m.rms_deviations, name_of(q.quantity), q.rms, proportion(q));
}

std::string describe(Undetermined why) {
  switch (why) {
    case Undetermined::no: return "";
    case Undetermined::without_influence: return "no measured quantity depends on it";
    case Undetermined::free_with_others: return "the data leave it free together with others";
  }
  return "";
}

std::string outlier_advice(const BenchFit& fit, const FitResult& r) {
  constexpr double far = 4.0;    // standard deviations
  constexpr double alone = 3.0;  // times the rms of all others
  if (fit.loss != Loss::none) return "";
  const FitPoint* farthest = nullptr;
  double squares = 0.0;
  int values = 0;
  for (const FitPoint& p : r.points) {
    if (!std::isfinite(p.fitted)) continue;
    squares += square(p.residual());
    ++values;
    if (!farthest || std::abs(p.residual()) > std::abs(farthest->residual())) farthest = &p;
  }
  if (!farthest || values < 3) return "";
  const double off = std::abs(farthest->residual()), others = std::sqrt((squares - off * off) / (values - 1));
  if (!(off > far && off > alone * others)) return "";
  return fmt::format(
      "{} of {} lies {:.1f} standard deviations from the fit, {:.0f} times the rms of all other values. If "
      "it is an outlier, loss = \"huber\" in [fit] keeps it from deciding.",
      name_of(fit.logs[farthest->log].columns[farthest->column]), row_name(fit, farthest->log, farthest->row), off,
      off / others);
}

std::string text_fit(const BenchFit& fit, const FitResult& r) {
  std::string text;
  int rows = 0;
  for (const BenchLog& log : fit.logs) rows += int(log.rows.size());
  const auto counted = [](std::size_t n, const char* what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  if (r.misfit) {
    text +=
        wrapped(fmt::format("MISFIT: the model does not describe the data: {}. The values below are the closest found "
                            "and no estimates; no intervals follow from them.",
                            describe(*r.misfit)),
                88, 2) +
        "\n";
  }
  text += fmt::format("{}, {} with {} in {}; {}\n", counted(fit.parameters.size(), "parameter"),
                      counted(std::size_t(rows), "row"), counted(r.points.size(), "measured value"),
                      counted(fit.logs.size(), "log"),
                      r.converged ? !r.misfit ? "converged" : "the search converged" : "NOT converged: " + r.message);
  for (const BenchLog& log : fit.logs) {
    if (const std::string missing = left_out(log); !missing.empty()) {
      text +=
          wrapped(fmt::format("{}: {}", std::filesystem::path(log.file).filename().string(), missing), 88, 2) + "\n";
    }
  }
  if (fit.starts > 1) {
    text += fmt::format("{} of {} starts end in this least, {} in a higher one\n", r.starts_converged, fit.starts,
                        r.starts_elsewhere);
  }
  if (r.degrees_of_freedom > 0) {
    text += fmt::format("chi square {:.1f} with {} degrees of freedom, AICc {:.1f}\n", r.chi_square,
                        r.degrees_of_freedom, r.aicc);
  }
  text += fmt::format("\n{:<32}{:>11}{:>9}  {:^22}  unit\n", "Parameter", "value", "+-", "95 % interval");
  for (const FittedParameter& p : r.parameters) {
    if (is_asked_for(p)) text += parameter_row(p);
  }
  const bool starred = std::any_of(r.parameters.begin(), r.parameters.end(), [](const FittedParameter& p) {
    return is_asked_for(p) && p.value && std::isfinite(p.standard_error) &&
           !(std::isfinite(p.profile_lower_95) && std::isfinite(p.profile_upper_95));
  });
  if (starred) text += "* from the standard error; the others from the profile\n";
  text += of_logs(r);

  text += !r.misfit ? identifiability(r) : residuals_by_quantity(r);
  if (!r.estimated_deviations.empty()) {
    text += "\nStandard deviations estimated from the residuals\n";
    for (const auto& [q, d] : r.estimated_deviations) {
      text += fmt::format("  {:<40}{}\n", name_of(q), readable(d, unit_of(q)));
    }
  }
  if (!r.unreached.empty()) {
    text += "\nRows that the fitted model does not reach (not in the statistics above)\n";
    for (const UnreachedRow& u : r.unreached) {
      text += "  " +
              wrapped(fmt::format("{} ({}): {}: {}", row_name(fit, u.log, u.row), given_text(fit, u.log, u.row),
                                  name_of(u.status), describe(u)),
                      88, 4) +
              "\n";
    }
  }
  std::vector<const FitPoint*> outliers;
  for (const FitPoint& p : r.points) {
    if (std::isfinite(p.fitted) && std::abs(p.residual()) > 4.0) outliers.push_back(&p);
  }
  if (!outliers.empty()) {
    std::stable_sort(outliers.begin(), outliers.end(), [](const FitPoint* a, const FitPoint* b) {
      return std::abs(a->residual()) > std::abs(b->residual());
    });
    text += "\nValues more than 4 standard deviations off\n";
    for (std::size_t n = 0; n < std::min<std::size_t>(outliers.size(), 10); ++n) {
      const FitPoint& p = *outliers[n];
      const MeasuredQuantity& q = fit.logs[p.log].columns[p.column];
      text += "  " +
              wrapped(fmt::format("{} ({}): {} {:.4g}, fitted {:.4g} {}: {:+.1f}", row_name(fit, p.log, p.row),
                                  given_text(fit, p.log, p.row), name_of(q), p.measured, p.fitted, unit_of(q),
                                  p.residual()),
                      88, 4) +
              "\n";
    }
    if (outliers.size() > 10) text += fmt::format("  and {} more\n", outliers.size() - 10);
  }
  if (const std::string advice = outlier_advice(fit, r); !advice.empty()) text += wrapped(advice, 88, 0) + "\n";
  return text;
}

std::string text_friction(std::span<const FrictionCandidate> candidates) {
  std::string text = "\nFriction laws, best first\n";
  text += fmt::format("  {:<19}{:>11}{:>13}{:>22}", "law", "AICc - best", "rms residual", "left-out prediction");
  const bool springs = std::any_of(candidates.begin(), candidates.end(),
                                   [](const auto& c) { return std::isfinite(c.spring_frequency); });
  if (springs) text += fmt::format("{:>21}", "springs, power ratio");
  text += "\n";
  for (const FrictionCandidate& c : candidates) {
    double squares = 0.0;
    int count = 0;
    for (const FitPoint& p : c.result.points) {
      if (!std::isfinite(p.fitted)) continue;
      squares += p.residual() * p.residual();
      ++count;
    }
    text += fmt::format("  {:<19}{:>11.1f}{:>13.2f}{:>22}", name_of(c.law), c.aicc_excess,
                        std::sqrt(squares / std::max(count, 1)), short_number(c.prediction_error, 3));
    if (springs) text += fmt::format("{:>21}", short_number(c.power_springs_on / c.power_springs_off, 3));
    if (!c.result.unreached.empty()) text += fmt::format("  {} rows not reached", c.result.unreached.size());
    text += "\n";
  }
  text += "  left-out prediction: rms error, in standard deviations, of each condition predicted from the others\n";
  for (const FrictionCandidate& c : candidates) {
    if (!std::isfinite(c.spring_frequency)) continue;
    text += fmt::format("  power ratio: electrical input with over without springs at {:.4g} Hz in air\n",
                        c.spring_frequency);
    break;
  }
  return text;
}

std::string fitted_vehicle_head(const BenchFit& fit, const FitResult& r, const std::string& made_by) {
  std::string text = fmt::format("# {}\n", one_line(made_by, 200));
  for (const FittedParameter& p : r.parameters) {
    if (!is_asked_for(p)) continue;
    const detail::ShownUnit shown = detail::shown_unit(p.unit);
    if (p.value) {
      text += fmt::format("# {} = {:.6g} +- {:.2g} {}\n", p.key, shown.factor * *p.value,
                          shown.factor * p.standard_error, shown.name);
    } else {
      text += fmt::format("# {}: not determined ({}); keeps {:.6g} {}\n", p.key, describe(p.undetermined),
                          shown.factor * p.kept, shown.name);
    }
  }
  for (const UnreachedRow& u : r.unreached) {
    text += fmt::format("# not reached: {} ({})\n", one_line(row_name(fit, u.log, u.row), 120),
                        given_text(fit, u.log, u.row));
  }
  return text + "\n";
}

std::string covariance_file(const FitResult& r, const std::string& vehicle_name, const std::string& made_by) {
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < r.parameters.size(); ++k) {
    if (r.parameters[k].value && r.parameters[k].of == FittedParameter::Of::vehicle) known.push_back(k);
  }
  std::string text =
      fmt::format("# {}\n# Covariance of the fitted parameters, SI units, normal approximation.\n\nvehicle = {}\n",
                  one_line(made_by, 200), toml_text(vehicle_name));
  for (const std::size_t k : known) {
    const FittedParameter& p = r.parameters[k];
    text += fmt::format("\n[[parameter]]\nkey = {}\nunit = {}\nvalue = {:#}\nstandard_error = {:#}\n", toml_text(p.key),
                        toml_text(p.unit), *p.value, p.standard_error);
  }
  text += "\n[covariance]\nmatrix = [\n";
  for (const std::size_t a : known) {
    text += "  [";
    for (const std::size_t b : known) text += fmt::format("{}{:#}", b == known.front() ? "" : ", ", r.covariance[a][b]);
    text += "],\n";
  }
  return text + "]\n";
}

void plot_residuals(const BenchFit& fit, const FitResult& r, PlotFormat format, const std::filesystem::path& file) {
  std::vector<PointPanel> panels;
  bool frequencies = false, voltages = false;
  for (const FitPoint& p : r.points) {
    if (!std::isfinite(p.fitted)) continue;
    const BenchLog& log = fit.logs[p.log];
    const std::string title = condition_name(log.condition, log.springs) + (log.waveform ? ", waveform" : "");
    auto panel =
        std::find_if(panels.begin(), panels.end(), [&](const PointPanel& known) { return known.title == title; });
    if (panel == panels.end()) panel = panels.insert(panels.end(), PointPanel{title, {}});
    const MeasuredQuantity& q = log.columns[p.column];
    std::string name = q.waveform ? name_of(q.quantity) : metric_info(q.metric).long_name;
    std::replace(name.begin(), name.end(), '_', ' ');
    auto series =
        std::find_if(panel->series.begin(), panel->series.end(), [&](const auto& s) { return s.name == name; });
    if (series == panel->series.end()) series = panel->series.insert(panel->series.end(), PointSeries{name, {}});
    const BenchRow& row = log.rows[p.row];
    (log.given == Given::voltage ? voltages : frequencies) = true;
    series->points.emplace_back(log.waveform ? degrees_per_radian * row.crank_angle : row.given, p.residual());
  }
  const bool waveforms = std::any_of(fit.logs.begin(), fit.logs.end(), [](const auto& l) { return l.waveform; });
  std::string x = voltages && frequencies ? "voltage (V) or frequency (Hz)"
                  : voltages              ? "voltage (V)"
                                          : "frequency (Hz)";
  if (waveforms) x += "; waveform: crank angle, or phase in time (deg)";
  plot_panels(panels, {"Residuals of the fit", x, "measured − fitted, in standard deviations", 3.0}, format, file);
}

namespace {

/// As figures show a waveform quantity: name, unit and the number of it in an SI unit.
struct Shown {
  const char *name, *unit;
  double factor;
};
Shown shown(WaveformQuantity q) {
  switch (q) {
    case WaveformQuantity::crank_speed: return {"crank speed", "rad/s", 1.0};
    case WaveformQuantity::current: return {"current", "mA", 1e3};
    case WaveformQuantity::flapping_velocity: return {"flapping velocity", "rad/s", 1.0};
    case WaveformQuantity::lift: return {"lift", "mN", 1e3};
    case WaveformQuantity::rod_force: return {"rod force", "N", 1.0};
    case WaveformQuantity::motor_torque: return {"motor torque", "mN m", 1e3};
    case WaveformQuantity::stroke_angle: return {"stroke angle", "deg", degrees_per_radian};
    case WaveformQuantity::pitch_angle: return {"pitch angle", "deg", degrees_per_radian};
    case WaveformQuantity::voltage: return {"voltage", "V", 1.0};
    case WaveformQuantity::balance_force: return {"balance reading", "mN", 1e3};
  }
  return {"", "", 1.0};
}

}  // namespace

void plot_fitted_cycles(const BenchFit& fit, const FitResult& r, PlotFormat format, const std::filesystem::path& file) {
  constexpr std::size_t max_panels = 12;
  std::vector<CoursePanel> panels;
  for (const FittedCycle& cycle : r.cycles) {
    if (panels.size() == max_panels) break;
    const BenchLog& log = fit.logs[cycle.log];
    const BenchRow& head = log.rows[cycle.row];
    const Shown as = shown(log.columns[cycle.column].quantity);
    CoursePanel panel;
    panel.title = fmt::format("{}: {}, {}", as.name, std::filesystem::path(log.file).filename().string(),
                              given_text(fit, cycle.log, cycle.row));
    panel.y = as.unit;
    for (std::size_t k = 0; k < cycle.values.size(); ++k) {
      panel.curve.emplace_back(double(k) / double(cycle.values.size() - 1), as.factor * cycle.values[k]);
    }
    for (const FitPoint& p : r.points) {
      const BenchRow& row = log.rows[p.log == cycle.log ? p.row : cycle.row];
      if (p.log != cycle.log || p.column != cycle.column || row.burst != head.burst) continue;
      const double turns = (row.crank_angle + cycle.phase) / two_pi;
      panel.points.push_back({turns - std::floor(turns), as.factor * p.measured, as.factor * p.deviation});
    }
    panels.push_back(std::move(panel));
  }
  const bool by_angle = std::none_of(r.cycles.begin(), r.cycles.end(), [](const auto& c) { return c.in_time; });
  plot_courses(
      panels,
      {r.cycles.size() > panels.size() ? fmt::format("The first {} of {} waveforms", panels.size(), r.cycles.size())
                                       : "Measured and fitted waveforms",
       by_angle ? "crank angle / 360 deg" : "time in the cycle / period", ""},
      format, file);
}

}  // namespace wingbeat
