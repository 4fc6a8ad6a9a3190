#include "wingbeat/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "report/report_tools.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/report/describe.hpp"

namespace wingbeat {
namespace {

constexpr int table_width = 88;

std::map<TransientEvent::Kind, int> event_counts(const TransientResult& start_up) {
  std::map<TransientEvent::Kind, int> counts;
  for (const TransientEvent& event : start_up.events) ++counts[event.kind];
  return counts;
}

/// Builds the lines of the table: groups of quantities, names left, values right.
class Table {
 public:
  explicit Table(const Metrics<double>& metrics) : metrics_(metrics) {}

  void group(const char* name) { fmt::format_to(out_, "\n{}\n", name); }
  void line(std::string_view name, const std::string& value, std::string_view remark = "") {
    fmt::format_to(out_, "  {:<32}{:>14}", name, value);
    if (!remark.empty()) fmt::format_to(out_, "   {}", remark);
    while (text_.back() == ' ') text_.pop_back();
    text_ += '\n';
  }
  void metric(std::string_view name, Metric which, std::string_view unit, std::string_view remark = "") {
    line(name, readable(metrics_[which], unit), remark);
  }
  void angle(std::string_view name, double degrees, std::string_view remark = "") {
    line(name, std::isfinite(degrees) ? fmt::format("{:.2f} deg", degrees) : "-", remark);
  }
  void percent(std::string_view name, Metric which, std::string_view remark = "") {
    const double x = metrics_[which];
    line(name, std::isfinite(x) ? fmt::format("{:.2f} %", 100.0 * x) : "-", remark);
  }
  void text(const std::string& s) { text_ += s; }
  std::string take() { return std::move(text_); }

 private:
  const Metrics<double>& metrics_;
  std::string text_;
  std::back_insert_iterator<std::string> out_{text_};
};

void power_group(Table& table, const Metrics<double>& m, bool piezo) {
  const EnergyAudit a = energy_audit(m);
  const auto share = [&](double power) {
    const double percent = 100.0 * power / a.electrical;
    if (!std::isfinite(percent)) return fmt::format("{:>9}", "-");  // of no input
    return fmt::format("{:>7.2f} %", std::abs(percent) < 0.005 ? 0.0 : percent);
  };
  table.group("Power, mean over a cycle                              of input");
  const auto power = [&](const char* name, double value, const char* remark) {
    table.line(name, readable(value, "W"), fmt::format("{}   {}", share(value), remark));
  };
  const bool electronics = std::isfinite(m[Metric::power_electronics]);
  power("electrical input", a.electrical, electronics ? "of the electronics" : "v i");
  if (electronics) {
    power("  electronics", a.electronics, piezo ? "dielectric, energy not recovered" : "(1/eta - 1) v i");
  }
  if (!piezo) power("  copper loss", a.copper, "R_a i^2");
  power(piezo ? "  damping of the piezo" : "  viscous loss of the motor", a.viscous, piezo ? "c_a x'^2" : "b omega^2");
  if (a.motor_friction != 0.0) power("  friction of the motor", a.motor_friction, "T_c,m omega");
  if (a.gear != 0.0) power("  gearbox", a.gear, "(1 - e) T_g omega");
  power(a.motor_friction != 0.0 ? "  friction of the mechanism" : "  friction", a.friction, "T_f omega");
  if (std::isfinite(m[Metric::power_hinge]))
    power("  pitch hinges", a.hinge, "damping, friction, torsion, impacts on stops");
  const bool hinged = std::isfinite(m[Metric::power_hinge]);
  power("  aerodynamic", a.aerodynamic, hinged ? "M_aero beta' + M_pitch psi'" : "M_aero beta'");
  const bool rounding = std::abs(a.residual) < 1e-14 * std::abs(a.electrical);
  power("  formulation residual", rounding ? 0.0 : a.residual, "F (h omega - g beta')");
  const double error = std::abs(a.imbalance / a.electrical);
  table.line("  energy-balance error", readable(a.imbalance, "W"),
             std::isfinite(error) ? fmt::format("{:>9.0e}   input minus the above", error)
                                  : fmt::format("{:>9}   input minus the above", "-"));
  power(piezo ? "piezo output" : "motor output", m[Metric::power_motor], piezo ? "F_t x_t'" : "T_m omega");
  if (std::isfinite(m[Metric::power_motor_reference])) {
    power("  as a test bench estimates it", m[Metric::power_motor_reference], "2 pi f K_ref i");
  }
  power("all but aerodynamic", m[Metric::power_loss], "");
  power("reactive, mean magnitude", m[Metric::power_reactive], "");
}

void heat_group(Table& table, const Metrics<double>& m) {
  if (!std::isfinite(m[Metric::winding_temperature])) return;
  table.group("Heat of the motor, settled");
  const double margin = m[Metric::winding_temperature_margin];
  table.line("winding temperature", fmt::format("{:.1f} degC", m[Metric::winding_temperature]),
             std::isfinite(margin)
                 ? fmt::format("{:.1f} K {} the largest allowed", std::abs(margin), margin < 0.0 ? "above" : "below")
                 : "");
  table.line("case temperature", fmt::format("{:.1f} degC", m[Metric::case_temperature]));
}

/// How long the battery lasts, where that was asked for.
void flight_group(Table& table, const Metrics<double>& m) {
  const double hover = m[Metric::hover], end = m[Metric::endurance];
  if (!std::isfinite(end)) return;
  table.group("On the battery");
  table.line("hovers for",
             std::isnan(hover) ? "unknown"
             : hover > 0.0     ? readable(hover, "s")
                               : "never",
             std::isnan(hover) ? "the vehicle file gives no mass"
             : hover > 0.0     ? ""
                               : "does not hover");
  table.line("flaps for", readable(end, "s"));
}

void start_up_group(Table& table, const TransientResult& s, bool flapping) {
  using Kind = TransientEvent::Kind;
  auto counts = event_counts(s);
  table.group("Start-up from rest");
  table.line(flapping ? "time to steady flapping" : "time until it rests or jams", readable(s.time_to_steady, "s"),
             flapping ? "frequency within 1 % from there on" : "");
  table.line("inrush current", readable(s.inrush_current, "A"),
             fmt::format("at {}", readable(s.inrush_current_time, "s")));
  table.line("simulated", readable(s.end_time, "s"), fmt::format("{} cycles, {} steps", s.cycles, s.steps));
  if (s.averaged_cycles > 1) {
    table.line("averaged", fmt::format("{} cycles", s.averaged_cycles),
               fmt::format("durations within {:.2g} % of their mean", 100.0 * s.cycle_scatter));
  }
  if (s.current_ripple) {
    table.line("ripple of the current", readable(*s.current_ripple, "A"), "peak to peak within a switching period");
  }
  table.line("changes of the rod force's sign", fmt::format("{}", counts[Kind::force_sign_change]));
  table.line("standstills", fmt::format("{}", counts[Kind::standstill]));
}

/// What the angle at mid-stroke is worth under the pitch law, where that is less than half of the best. For a given
/// lift the aerodynamic power grows with C_D / C_L^(3/2).
std::string pitch_remark(const RunResult& result) {
  const double angle = result.metrics[Metric::angle_of_attack_min] / degrees_per_radian;
  const AerodynamicsDesign<double>& air = result.design.aerodynamics;
  if (!follows_pitch_law(result.design) || !std::isfinite(angle) || air.load_table) return "";
  const ForceCoefficients<double>& c = air.coefficients;
  const auto lift_per_power = [&](double alpha) {
    return std::pow(std::max(lift_coefficient(c, alpha), 0.0), 1.5) / std::max(drag_coefficient(c, alpha), 1e-12);
  };
  double best = 0.0, best_angle = 0.0;
  for (int degree = 5; degree <= 90; ++degree) {
    const double here = lift_per_power(degree / degrees_per_radian);
    if (here > best) best = here, best_angle = degree;
  }
  const double share = lift_per_power(angle) / best;
  if (!(share < 0.5)) return "";
  return fmt::format("{:.0f} % of the best lift/power, at {:.0f} deg", 100.0 * share, best_angle);
}

}  // namespace

std::string readable(double value, std::string_view unit) {
  if (!std::isfinite(value)) return "-";
  constexpr std::pair<double, const char*> prefixes[] = {{1e6, "M"}, {1e3, "k"}, {1.0, ""}, {1e-3, "m"}, {1e-6, "u"}};
  const double size = std::abs(value);
  double scale = 1e-9;
  const char* prefix = "n";
  for (const auto& [factor, name] : prefixes) {
    // Rounding to four digits must not carry into a fifth.
    if (size >= 0.99995 * factor) {
      scale = factor;
      prefix = name;
      break;
    }
  }
  if (size < 0.99995e-9) {
    if (size == 0.0) return fmt::format("0 {}", unit);
    return fmt::format("{:.1e} {}", value, unit);
  }
  const double x = value / scale;
  const int decimals = std::abs(x) >= 999.95 ? 0 : std::abs(x) >= 99.995 ? 1 : std::abs(x) >= 9.9995 ? 2 : 3;
  return fmt::format("{:.{}f} {}{}", x, decimals, prefix, unit);
}

std::string wrapped(std::string_view text, int width, int indent) {
  const auto columns = [](std::string_view s) {
    int n = 0;
    for (const char c : s) n += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    return n;
  };
  std::string out;
  int column = 0;
  for (std::size_t position = 0; position < text.size();) {
    std::size_t end = position;
    while (end < text.size() && static_cast<unsigned char>(text[end]) > 0x20 && text[end] != 0x7F) ++end;
    const std::string word = detail::printable(text.substr(position, end - position));
    if (!word.empty()) {
      if (column > 0 && column + 1 + columns(word) > width) {
        out += '\n' + std::string(std::size_t(indent), ' ');
        column = indent;
      } else if (column > 0) {
        out += ' ';
        ++column;
      }
      out += word;
      column += columns(word);
    }
    position = end + 1;
  }
  return out;
}

std::vector<std::string> warnings_of(const RunResult& result) {
  std::vector<std::string> sentences;
  if (result.residual_share) sentences.push_back(residual_warning(*result.residual_share));
  if (result.added_mass_lift) {
    sentences.push_back(added_mass_warning(*result.added_mass_lift, result.design.pitch.edge_suction));
  }
  if (result.hot_winding) {
    const double allowed = *result.hot_winding + result.metrics[Metric::winding_temperature_margin];
    sentences.push_back(winding_warning(*result.hot_winding, allowed));
  }
  return sentences;
}

std::string text_report(const RunResult& result, const RunOptions& options) {
  const Metrics<double>& m = result.metrics;
  const bool flapping = result.status == FlappingStatus::flapping;
  Table table(m);
  if (!result.design.name.empty()) table.text(wrapped(result.design.name, table_width, 0) + "\n");
  if (result.domain.any()) {
    table.text(wrapped(fmt::format("OUTSIDE THE MODEL'S DOMAIN ({}): {}. The numbers below are extrapolated.",
                                   name_of(result.domain), describe(result.domain_evidence)),
                       table_width, 2) +
               "\n");
  }
  table.text(wrapped(fmt::format("{}: {}.", name_of(result.status), describe(result)), table_width, 2) + "\n");
  if (result.residual_share) {
    table.text(wrapped(fmt::format("warning: {}.", residual_warning(*result.residual_share)), table_width, 2) + "\n");
  }
  if (result.added_mass_lift) {
    const std::string sentence = added_mass_warning(*result.added_mass_lift, result.design.pitch.edge_suction);
    table.text(wrapped(fmt::format("warning: {}.", sentence), table_width, 2) + "\n");
  }
  std::string how = fmt::format(
      "{}, by {}, tolerance {:.0e}", name_of(options.condition),
      options.method == Method::orbit && !result.simulated_cycle ? "periodic orbit" : "simulation from rest",
      options.tolerance);
  if (options.method == Method::orbit && result.orbit.iterates > 0 && !result.simulated_cycle) {
    how += fmt::format("; {} iterate{}", result.orbit.iterates, result.orbit.iterates == 1 ? "" : "s");
    if (result.orbit.newton_steps > 0) how += fmt::format(", {} Newton steps", result.orbit.newton_steps);
    if (flapping) how += fmt::format(", closed to {:.0e}", result.orbit.residual);
  }
  table.text(wrapped(how, table_width, 2) + "\n");
  if (result.start_up) start_up_group(table, *result.start_up, flapping);
  if (!std::isfinite(m[Metric::frequency])) return table.take();
  flight_group(table, m);

  table.group("Operating point");
  table.metric("voltage", Metric::voltage, "V");
  if (result.design.supply.type == SupplyType::pwm) {
    table.line("duty", fmt::format("{:.4g}", result.design.supply.duty),
               fmt::format("of {}", readable(result.design.supply.voltage, "V")));
  }
  if (result.design.supply.type == SupplyType::battery && result.design.supply.duty < 1.0) {
    table.line("duty", fmt::format("{:.4g}", result.design.supply.duty), "of the battery's voltage");
  }
  if (result.design.motors > 1.0) {
    table.line("motors", fmt::format("{:.0f}", result.design.motors), "totals of all motors");
  }
  table.metric("flapping frequency", Metric::frequency, "Hz");
  table.metric("mean current", Metric::current_mean, "A");
  table.metric("peak current", Metric::current_peak, "A");
  table.metric("rms current", Metric::current_rms, "A");
  const bool piezo = result.design.piezo.force_per_volt.has_value();
  power_group(table, m, piezo);
  heat_group(table, m);

  table.group("Efficiency");
  table.percent("system", Metric::efficiency_system, "aerodynamic / electrical");
  const std::string actuator = piezo ? "piezo" : "motor";
  table.percent(actuator, Metric::efficiency_motor, actuator + " output / electrical");
  table.percent("mechanism", Metric::efficiency_mechanism, "aerodynamic / " + actuator + " output");

  table.group("Lift, all wings");
  table.metric("mean lift", Metric::lift_mean, "N");
  table.metric("peak lift", Metric::lift_peak, "N");
  if (std::isfinite(m[Metric::lift_to_weight])) {
    // A voltage found for hovering gives the weight to within the tolerance.
    const bool hovers = m[Metric::lift_to_weight] >= 1.0 - 10.0 * options.tolerance;
    table.line("mean lift / weight", fmt::format("{:.4g}", m[Metric::lift_to_weight]),
               !hovers               ? "below weight: cannot hover"
               : result.domain.any() ? "outside the model's domain: not claimed"
                                     : "can hover");
  }
  if (std::isfinite(m[Metric::induced_velocity])) {
    table.metric("induced velocity", Metric::induced_velocity, "m/s", "of the wake that the mean lift leads to");
  }

  table.group("Mechanism and wings");
  table.metric("peak rod force, magnitude", Metric::rod_force_peak, "N",
               result.design.motors > 1.0 ? "of one rod" : "");
  table.metric("mean rod force, magnitude", Metric::rod_force_mean, "N");
  table.angle("stroke amplitude", degrees_per_radian * m[Metric::stroke_amplitude], "half peak to peak");
  table.metric("peak flapping velocity", Metric::flapping_velocity_peak, "rad/s");
  table.angle("smallest angle of attack", m[Metric::angle_of_attack_min], pitch_remark(result));
  if (result.pitch_coefficient)
    table.line("pitch_coefficient", readable(*result.pitch_coefficient, "s"), "that was found");
  if (std::isfinite(m[Metric::reynolds_number])) {
    table.line("Reynolds number", fmt::format("{:.0f}", m[Metric::reynolds_number]),
               "mean chord, mean speed of the tips");
  }
  if (std::isfinite(m[Metric::pitch_amplitude])) {
    table.angle("largest angle of attack", m[Metric::angle_of_attack_max], "beyond 90 deg the wings over-rotate");
    table.angle("pitch amplitude", m[Metric::pitch_amplitude], "half peak to peak");
    if (std::isfinite(m[Metric::pitch_phase])) {
      table.angle("pitch phase", m[Metric::pitch_phase], "ahead of the pitch that opposes the flapping velocity");
    }
  }
  table.metric("lowest crank speed", Metric::crank_speed_min, "rad/s");
  table.metric("highest crank speed", Metric::crank_speed_max, "rad/s");

  if (std::isfinite(m[Metric::floquet_multiplier_max])) {
    const double multiplier = m[Metric::floquet_multiplier_max];
    table.group("Stability");
    table.line("largest Floquet multiplier", fmt::format("{:.3g}", multiplier),
               multiplier < 1.0 ? "below 1: stable" : "not below 1: disturbances do not die out");
  }
  return table.take();
}

}  // namespace wingbeat
