#include "wingbeat/report/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <utility>
#include <vector>

#include "files/toml_document.hpp"
#include "report/described.hpp"
#include "report/result_schemas.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/files/toml_text.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

bool holds(std::string_view text, std::string_view part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

std::vector<const ParameterText*> keys_with(const std::string& filter) {
  std::vector<const ParameterText*> found;
  for (const auto& key : parameter_table<double>()) {
    if (holds(key.path, filter) || holds(key.meaning, filter) || key.unit == filter) found.push_back(&key);
  }
  return found;
}

std::vector<const MetricInfo*> metrics_with(const std::string& filter) {
  std::vector<const MetricInfo*> found;
  for (const MetricInfo& metric : metric_table()) {
    if (holds(metric.key, filter) || holds(metric.long_name, filter) || metric.unit == filter) found.push_back(&metric);
  }
  return found;
}

std::string unit_shown(std::string_view unit) {
  return unit.empty() ? "text" : unit == "1" ? "number" : std::string(unit);
}

/// What a new vehicle states, by key. All else it may state is offered as a comment.
using Statement = std::pair<std::string_view, std::string_view>;

const std::string_view* stated(std::span<const Statement> statements, std::string_view path) {
  const auto found = std::find_if(statements.begin(), statements.end(), [&](const auto& s) { return s.first == path; });
  return found == statements.end() ? nullptr : &found->second;
}

bool has_place(const ParameterText& key, std::span<const Statement> statements) {
  if (key.only_with.empty()) return true;
  const Requirement requirement = requirement_of(key.only_with);
  const std::string_view* choice = stated(statements, requirement.path);
  return choice && requirement.allows(*choice);
}

/// The examples of the table, on a supply and with a friction that suit the drive.
std::vector<Statement> statements_of(TransmissionType transmission) {
  const Drive drive = drive_of(transmission);
  std::vector<Statement> all = {
      {"transmission.type", name_of(transmission)},
      {"supply.type", name_of(drive.alternating ? SupplyType::sine : SupplyType::constant)},
      {"friction.type", name_of(drive.has_rod ? FrictionLaw::load_proportional : FrictionLaw::none)}};
  if (!drive.rotates) all.push_back({"spring.resonance", "22 Hz"});  // what swings does so on springs
  for (const auto& key : parameter_table<double>()) {
    if (!key.example.empty() && has_place(key, all)) all.push_back({key.path, key.example});
  }
  return all;
}

/// "5 mm" as `"5 mm"`, 2 and rows of a table as they are.
std::string toml_value(const ParameterText& key, std::string_view value) {
  return key.unit == "1" || value.starts_with('[') ? std::string(value) : fmt::format("\"{}\"", value);
}

/// A value to put in for a key that a new vehicle does not state: the example of its unit.
std::string example_of(const ParameterText& key) {
  if (key.range.text == "true or false") return "true";
  if (key.unit.empty()) return "\"...\"";
  const std::string example = quantity_example(key.unit);
  const auto quote = example.find('"');
  if (quote != std::string::npos) return example.substr(quote);
  return key.unit == "1" ? "1" : fmt::format("\"1 {}\"", key.unit);
}

/// Lines of at most 120 columns that begin with #.
std::string commented(const std::string& comment) {
  std::string lines = "# ";
  for (const char c : wrapped(comment, 116, 0)) lines += c == '\n' ? std::string("\n#   ") : std::string(1, c);
  return lines + "\n";
}

std::string comment_on(const ParameterText& key, bool is_stated, std::span<const Statement> statements) {
  std::string text = fmt::format("{}; {}", key.meaning, key.range.text);
  const std::vector<std::string> others = alternatives_of(key);
  const Parameter<double>* other = others.empty() ? nullptr : find_parameter<double>(others.front());
  if (other && has_place(*other, statements)) {
    text += fmt::format("; {} {}{}", is_stated ? "or" : "instead of", key.alternatives[0], is_stated ? " instead" : "");
  } else if (!is_stated && default_text(key) != "required") {
    text += fmt::format("; default: {}", default_text(key));
  }
  return text;
}

/// Symbol and definition of each metric as docs/model.md defines it, in the order of the metric table.
struct MetricDefinition {
  Metric metric;
  const char* symbol;
  const char* definition;
};
constexpr MetricDefinition metric_definitions[] = {
    {Metric::voltage, R"($v$)", "mean voltage of the supply; a sine's amplitude"},
    {Metric::frequency, R"($f$)", R"($1 / \int_0^{2\pi} \mathrm{d}\theta / \omega$)"},
    {Metric::current_mean, R"($\overline{i}$)",
     "mean of the motor current; of a direct drive, which alternates, near 0"},
    {Metric::current_peak, R"($\max \lvert i \rvert$)", ""},
    {Metric::current_rms, R"($\sqrt{\overline{i^2}}$)", "heats the winding"},
    {Metric::power_electrical, R"($P_\mathrm{e}$)", R"(mean of $v\, i$ (eq 15))"},
    {Metric::power_motor, R"($P_\mathrm{m}$)",
     R"(mean of $T_\mathrm{m} \omega$ (eq 16), behind gearbox and friction of the motor)"},
    {Metric::power_motor_reference, R"($P_\mathrm{m,ref}$)",
     R"($2 \pi f K_\mathrm{ref} \overline{i}$ (eq 17): estimate of a test bench, `bench.torque_constant` given)"},
    {Metric::power_friction, R"($P_\mathrm{friction}$)",
     R"(mean of $T_\mathrm{f} \omega$ (eq 18), all friction torques of the transmission)"},
    {Metric::power_aerodynamic, R"($P_\mathrm{aero}$)",
     R"(mean of $M_\mathrm{aero} \dot\beta$ (eq 19), of wings on pitch hinges of )"
     R"($M_\mathrm{aero} \dot\beta + M_\mathrm{pitch} \dot\psi$, the whole power into the air)"},
    {Metric::power_reactive, R"($P_\mathrm{re}$)",
     R"(mean of $\lvert (N_\mathrm{w} J_\mathrm{w} \ddot\beta + N_\mathrm{w} k \beta)\, \dot\beta \rvert$ (eq 23))"},
    {Metric::power_copper, R"($P_\mathrm{cu}$)", R"($R_\mathrm{a} \overline{i^2}$)"},
    {Metric::power_viscous, R"($P_\mathrm{visc}$)", R"($b\, \overline{\omega^2}$)"},
    {Metric::power_motor_friction, R"($P_\mathrm{motor}$)",
     R"(mean of $T_\mathrm{c,m} \lvert\omega\rvert$, 0 unless `motor.friction_torque` is given)"},
    {Metric::power_gear, R"($P_\mathrm{gear}$)",
     R"(mean of $(1 - e)\, T_\mathrm{g} \omega$, 0 unless `motor.gear_efficiency` is below 1)"},
    {Metric::power_electronics, R"($P_\mathrm{esc}$)",
     R"($(1/\eta_\mathrm{esc} - 1)\, \overline{v i}$ of a brushless motor; of a piezo the loss of its dielectric and )"
     "of the electronics on the energy that its capacitance gives back"},
    {Metric::power_loss, R"($P_\mathrm{loss}$)", R"($P_\mathrm{e} - P_\mathrm{aero}$ (eq 20))"},
    {Metric::power_residual, R"($P_\mathrm{residual}$)",
     R"(mean of $F (h \omega - g \dot\beta)$: 0 with `virtual-work`, a property of `rod-force`)"},
    {Metric::lift_mean, R"($\overline{L}$)", "mean lift of all wings, normal to the stroke plane (eq 2)"},
    {Metric::lift_peak, R"($\max L$)", ""},
    {Metric::rod_force_peak, R"($\max \lvert F \rvert$)",
     "largest magnitude of the rod force (of a four-bar, the coupler force); not for a direct drive"},
    {Metric::rod_force_mean, R"($\overline{\lvert F \rvert}$)", ""},
    {Metric::stroke_amplitude, R"($\tfrac12 (\beta_\mathrm{max} - \beta_\mathrm{min})$)", ""},
    {Metric::flapping_velocity_peak, R"($\max \lvert \dot\beta \rvert$)", "of a wing about its hinge"},
    {Metric::angle_of_attack_min, R"($\alpha_\mathrm{min}$)",
     R"(of the law $\alpha = 90^\circ - C_\alpha \lvert\dot\beta\rvert\, 180^\circ/\pi$ (eq 14), )"
     "or of the pitch angle"},
    {Metric::crank_speed_min, R"($\omega_\mathrm{min}$)", ""},
    {Metric::crank_speed_max, R"($\omega_\mathrm{max}$)", ""},
    {Metric::efficiency_system, R"($\eta_\mathrm{s}$)", R"($P_\mathrm{aero} / P_\mathrm{e}$ (eq 24))"},
    {Metric::efficiency_motor, R"($\eta_\mathrm{m}$)", R"($P_\mathrm{m} / P_\mathrm{e}$ (eq 25))"},
    {Metric::efficiency_mechanism, R"($\eta_\mathrm{t}$)", R"($P_\mathrm{aero} / P_\mathrm{m}$ (eq 26))"},
    {Metric::floquet_multiplier_max, R"($\max \lvert \mu_\mathrm{F} \rvert$)",
     "growth of a small disturbance in a cycle: below 1 the orbit is stable"},
    {Metric::lift_to_weight, R"($\overline{L} / (m g)$)", "1 hovers; `vehicle.mass` given"},
    {Metric::winding_temperature, R"($T_\mathrm{w}$)", "at which the winding settles; thermal resistances given"},
    {Metric::case_temperature, R"($T_\mathrm{case}$)", "at which the motor's case settles"},
    {Metric::winding_temperature_margin, R"($T_\mathrm{w,max} - T_\mathrm{w}$)",
     "thermal resistances given; 125 degC unless `motor.winding_temperature_max` is given"},
    {Metric::added_mass_inertia_ratio, R"($J_\mathrm{a} / (N_\mathrm{w} J_\mathrm{w})$)",
     "`aerodynamics.added_mass = true`"},
    {Metric::power_hinge, R"($P_\mathrm{hinge}$)",
     R"(mean of $c_\psi \dot\psi^2 + T_\psi |\dot\psi| + c_\tau \dot\tau^2$ of all wings, and the loss at stops in )"
     "impacts; wings that pitch on hinges or twist"},
    {Metric::pitch_amplitude, R"($\tfrac12 (\psi_\mathrm{max} - \psi_\mathrm{min})$)", ""},
    {Metric::pitch_phase, R"($\varphi_\psi$)",
     R"(lead of the first harmonic of $\psi$ over that of $-\dot\beta$: 0 for symmetric flips; )"
     "wings that pitch by 1e-4 rad at least"},
    {Metric::angle_of_attack_max, R"($\alpha_\mathrm{max}$)",
     "of wings on pitch hinges, above 90 degrees at reversals"},
    {Metric::lift_added_mass_share,
     R"($(1 - s_\mathrm{L})\, \overline{p_\mathrm{n} \dot\psi \cos\psi} / \overline{L}$)",
     "`aerodynamics.added_mass = true` on pitch hinges; 0 with `pitch.leading_edge_suction = 1`"},
    {Metric::reynolds_number, R"($\mathit{Re} = \bar c\, 4 \Phi f (R + d) / \nu$)",
     R"($\bar c$ the mean chord, $\Phi$ the stroke amplitude; wings with a shape, in air)"},
    {Metric::stroke_angle_max, R"($\beta_\mathrm{max}$)", "direct drives with `aerodynamics.clap_and_fling`"},
    {Metric::induced_velocity, R"($v_\mathrm{i}$)",
     R"($\kappa \sqrt{\overline{L} / (2 \rho A_0)}$, at which the orbit was found; `aerodynamics.induced_velocity` )"
     R"($\kappa$ given)"},
    {Metric::hover, R"($t_\mathrm{hover}$)",
     "of a flight on a battery, 0 where it does not hover; with `vehicle.mass`, in `run --endurance` and studies that "
     "ask for it"},
    {Metric::endurance, R"($t_\mathrm{end}$)",
     "of a flight on a battery, hovering or not; in `run --endurance` and studies that ask for it"}};
static_assert(std::size(metric_definitions) == std::size_t(metric_count), "a metric lacks its definition");

}  // namespace

std::string text_keys(const std::string& filter) {
  std::string text;
  for (const ParameterText* key : keys_with(filter)) {
    text += fmt::format("{}  [{}]  {}; default: {}\n", key->path, unit_shown(key->unit), key->range.text,
                        default_text(*key));
    std::string meaning(key->meaning);
    if (!key->only_with.empty()) meaning += fmt::format(" (only with {})", with_or(key->only_with));
    text += fmt::format("    {}\n", wrapped(meaning, 92, 4));
  }
  return text;
}

namespace described {
namespace {

std::optional<std::string> text_if_any(std::string text) {
  return text.empty() ? std::nullopt : std::optional(std::move(text));
}

const Description<ParameterText>& key_description() {
  using R = ParameterText;
  std::vector<std::string> names;
  for (const auto& key : parameter_table<double>()) names.emplace_back(key.path);
  static const Description<R> description =
      Description<R>()
          .always("key", "", "", &R::path, schema::one_of(std::move(names)))
          .always("unit", "", "null of texts", [](const R& r) { return text_if_any(std::string(r.unit)); })
          .always("range", "", "", [](const R& r) { return std::string(r.range.text); })
          .always("default", "", "", [](const R& r) { return default_text(r); })
          .always("meaning", "", "", &R::meaning)
          .always("only_with", "", "another key that the vehicle file must have",
                  [](const R& r) { return text_if_any(with_or(r.only_with)); });
  return description;
}

const Description<MetricInfo>& metric_description() {
  using R = MetricInfo;
  static const Description<R> description = Description<R>()
                                                .always("key", "", "", &R::key, schema::metric_key())
                                                .always("unit", "", "", &R::unit)
                                                .always("long_name", "", "", &R::long_name);
  return description;
}

/// Listed by pointers: tables of the library, filtered.
template <class R>
Json listed(const char* name, const Description<R>& description, const std::vector<const R*>& found) {
  Json list = Json::array();
  for (const R* r : found) list.push_back(description.json(*r));
  return {{name, std::move(list)}};
}
template <class R>
Json listed_schema(const char* name, const Description<R>& description) {
  return schema::object({{name, schema::listed(description.schema())}});
}

}  // namespace

Json keys_schema() { return listed_schema("keys", key_description()); }
Json metrics_schema() { return listed_schema("metrics", metric_description()); }

}  // namespace described

std::string json_keys(const std::string& filter) {
  return described::listed("keys", described::key_description(), keys_with(filter)).dump(2) + "\n";
}

std::string text_metrics(const std::string& filter) {
  std::string text;
  for (const MetricInfo* metric : metrics_with(filter)) {
    text += fmt::format("{:<34}{:<8}{}\n", metric->key, metric->unit, metric->long_name);
  }
  return text;
}

std::string json_metrics(const std::string& filter) {
  return described::listed("metrics", described::metric_description(), metrics_with(filter)).dump(2) + "\n";
}

std::string vehicle_file_reference() {
  std::string result;
  std::string section;
  for (const auto& key : parameter_table<double>()) {
    const std::string top(key.path.substr(0, key.path.find('.')));
    if (top != section) {
      section = top;
      result += fmt::format("\n### [{}]\n\n| key | unit | range | default | meaning |\n", section);
      result += "| --- | --- | --- | --- | --- |\n";
    }
    std::string meaning(key.meaning);
    if (!key.only_with.empty()) meaning += " (only with `" + with_or(key.only_with) + "`)";
    const std::string_view unit = key.unit.empty() ? "text" : key.unit == "1" ? "-" : key.unit;
    result += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.path, unit, key.range.text, default_text(key), meaning);
  }
  return result;
}

std::string metric_reference() {
  std::string result = "\n| key | unit | symbol | definition |\n| --- | --- | --- | --- |\n";
  for (const MetricDefinition& described : metric_definitions) {
    const MetricInfo& metric = metric_info(described.metric);
    const std::string_view definition = described.definition;
    result += fmt::format("| `{}` | {} | {} | {}{}{} |\n", metric.key,
                          std::string_view(metric.unit) == "1" ? "-" : metric.unit, described.symbol, metric.long_name,
                          definition.empty() ? "" : ": ", definition);
  }
  return result;
}

std::string starting_vehicle(TransmissionType transmission, const std::string& name) {
  const std::vector<Statement> statements = statements_of(transmission);
  std::string text =
      "# A vehicle file for wingbeat. What stands behind # at the beginning of a line is optional or another choice.\n"
      "# Quantities carry a unit; `wingbeat keys` lists all keys, docs/vehicle-file.md explains them.\n";
  std::string section;
  const auto enter = [&](std::string_view path, bool wanted) {
    const std::string here(path.substr(0, path.rfind('.')));
    if (here == section) return;
    section = here;
    text += fmt::format("\n{}[{}]\n", wanted ? "" : "# ", section);
  };
  const auto section_is_stated = [&](std::string_view path) {
    const std::string_view here = path.substr(0, path.rfind('.') + 1);
    return here == "vehicle." || std::any_of(statements.begin(), statements.end(), [&](const Statement& s) {
             return s.first.starts_with(here) && s.first.find('.', here.size()) == std::string_view::npos;
           });
  };
  for (const auto& key : parameter_table<double>()) {
    // Single coefficients would take the place of the named set: too many for a beginning.
    if (!has_place(key, statements) || key.path.starts_with("aerodynamics.coefficients.")) continue;
    enter(key.path, section_is_stated(key.path));
    const std::string_view leaf = key.path.substr(key.path.rfind('.') + 1);
    const std::string_view* value = stated(statements, key.path);
    const bool is_stated = value || key.path == "vehicle.name";
    std::string line = key.path == "vehicle.name" ? fmt::format("{} = {}", leaf, toml_text(name))
                       : value                    ? fmt::format("{} = {}", leaf, toml_value(key, *value))
                                                  : fmt::format("# {} = {}", leaf, example_of(key));
    const std::string comment = comment_on(key, is_stated, statements);
    if (44 + comment.size() <= 118) {
      text += fmt::format("{:<44}# {}\n", line, comment);
    } else {
      text += fmt::format("{}{}\n", commented(fmt::format("{}: {}", leaf, comment)), line);
    }
  }
  return text;
}

}  // namespace wingbeat
