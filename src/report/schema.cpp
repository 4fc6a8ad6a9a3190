#include "wingbeat/report/schema.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "report/schema_tools.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/files/published.hpp"
#include "wingbeat/study/evolution.hpp"
#include "wingbeat/study/sweep.hpp"
#include "wingbeat/study/tolerance.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

using namespace schema;

constexpr const char* unless_asked_for =
    "; of a vehicle on a battery; null unless asked for: run --endurance, a study that names it";

SchemaKeys metrics(int count = metric_count) {
  SchemaKeys keys;
  for (int m = 0; m < count; ++m) {
    const MetricInfo& metric = metric_table()[std::size_t(m)];
    const bool of_a_flight = Metric(m) == Metric::hover || Metric(m) == Metric::endurance;
    keys.push_back({metric.key, with_text(number_if_any, fmt::format("{} [{}]{}", metric.long_name, metric.unit,
                                                                     of_a_flight ? unless_asked_for : ""))});
  }
  return keys;
}

/// Numbers of designs, or what `value` is, by status.
SchemaKeys by_status(const Json& value) {
  SchemaKeys keys;
  for (int s = 0; s < sweep_status_count; ++s) keys.push_back({name_of(SweepStatus(s)), value});
  return keys;
}

Json run_schema() {
  const Json events = object({{"revolution", any_count},
                              {"force_sign_change", any_count},
                              {"standstill", any_count},
                              {"breakaway", any_count},
                              {"jam", any_count}});
  const Json start_up = object({{"settled", yes_or_no},
                                {"time_to_steady_s", number_if_any},
                                {"inrush_current_a", number_if_any},
                                {"inrush_current_time_s", number_if_any},
                                {"simulated_time_s", number_if_any},
                                {"cycles", any_count},
                                {"averaged_cycles", any_count},
                                {"cycle_scatter", number_if_any},
                                {"current_ripple_a", number_if_any},
                                {"events", events}});
  return object(SchemaKeys{{"status", or_null(statuses())},
                           {"status_detail", with_text(any_text, "a sentence with the evidence")},
                           {"domain", or_null(domain)},
                           {"domain_detail", text_if_any},
                           {"warnings", listed(any_text)}} +
                    metrics(),
                {{"supply_duty", with_text(any_number, "of a pwm supply")},
                 {"start_up", with_text(start_up, "of a run simulated from rest")}});
}

Json compare_schema() {
  const Json value = object({{"voltage_v", number_if_any},
                             {"frequency_hz", number_if_any},
                             {"metric", metric_key()},
                             {"design", text_if_any},
                             {"ratio", or_null(pair_of(any_text))},
                             {"change", yes_or_no},
                             {"published", any_number},
                             {"computed", number_if_any},
                             {"deviation", number_if_any},
                             {"tolerance", any_number},
                             {"within", yes_or_no}});
  return object({{"title", any_text}, {"source", any_text}, {"outside", any_count}, {"values", listed(value)}});
}

Json sweep_schema() {
  const Json parameters = by_name(either({any_number, any_text}));
  const auto best = [&](Metric metric) {
    return or_null(object({{"index", any_count}, {metric_info(metric).key, any_number}}, {{"parameters", parameters}}));
  };
  return object({{"title", text_if_any},
                 {"data_set", any_text},
                 {"plot", text_if_any},
                 {"designs", any_count},
                 {"axes", listed(object({{"name", any_text}, {"count", any_count}}))},
                 {"computed", any_count},
                 {"resumed", any_count},
                 {"computing_time_s", any_number},
                 {"recomputed", any_count},
                 {"status", object(by_status(any_count))},
                 {"max_lift_mean", best(Metric::lift_mean)},
                 {"max_efficiency_system", best(Metric::efficiency_system)}});
}

Json identify_motor_schema() {
  const Json constant =
      object({{"value", number_if_any}, {"standard_error", number_if_any}, {"unit", any_text}, {"source", any_text}});
  const Json check =
      object({{"name", any_text}, {"published", any_number}, {"identified", any_number}, {"deviation", any_number}});
  const Json contradiction = object({{"constant", any_text},
                                     {"first", any_text},
                                     {"second", any_text},
                                     {"first_value", any_number},
                                     {"second_value", any_number},
                                     {"size", any_number},
                                     {"sentence", any_text}});
  return object({{"name", any_text},
                 {"complete", yes_or_no},
                 {"birge_ratio", any_number},
                 {"gear_efficiency", number_if_any},
                 {"motor", by_name(constant)},
                 {"checks", listed(check)},
                 {"contradictions", listed(contradiction)},
                 {"remarks", listed(any_text)},
                 {"missing", listed(any_text)}});
}

Json fit_schema() {
  const Json parameter = object({{"key", any_text},
                                 {"unit", any_text},
                                 {"value", number_if_any},
                                 {"standard_error", number_if_any},
                                 {"lower_95", number_if_any},
                                 {"upper_95", number_if_any},
                                 {"profile_lower_95", number_if_any},
                                 {"profile_upper_95", number_if_any},
                                 {"quantile_95", number_if_any},
                                 {"profile_rise_95", number_if_any},
                                 {"at_bound", yes_or_no},
                                 {"reason", any_text},
                                 {"profile", listed(pair_of(number_if_any))}});
  const Json direction = object({{"components", listed(any_number)}, {"relative_error", number_if_any}});
  const Json condition = object({{"name", any_text},
                                 {"values", any_count},
                                 {"rms_residual", number_if_any},
                                 {"share", listed(number_if_any)},
                                 {"standard_error_without", listed(number_if_any)}});
  const Json point = object({{"row", any_text},
                             {"quantity", any_text},
                             {"measured", any_number},
                             {"fitted", number_if_any},
                             {"deviation", any_number}});
  const Json candidate = object({{"law", one_of_names<FrictionLaw>()},
                                 {"aicc", number_if_any},
                                 {"aicc_excess", number_if_any},
                                 {"parameters", by_name(number_if_any)},
                                 {"left_out", by_name(number_if_any)},
                                 {"prediction_error", number_if_any},
                                 {"spring_frequency_hz", number_if_any},
                                 {"power_springs_off_w", number_if_any},
                                 {"power_springs_on_w", number_if_any}});
  return object({{"converged", yes_or_no},
                 {"message", any_text},
                 {"misfit", text_if_any},
                 {"chi_square", number_if_any},
                 {"degrees_of_freedom", of_type("integer")},
                 {"p_value", number_if_any},
                 {"aicc", number_if_any},
                 {"starts", object({{"same_least", any_count}, {"higher", any_count}})},
                 {"parameters", listed(parameter)},
                 {"covariance", listed(listed(number_if_any))},
                 {"correlation", listed(listed(number_if_any))},
                 {"directions", listed(direction)},
                 {"verdict", listed(any_text)},
                 {"conditions", listed(condition)},
                 {"unreached", listed(object({{"row", any_text}, {"status", any_text}, {"detail", any_text}}))},
                 {"points", listed(point)},
                 {"friction", or_null(listed(candidate))}});
}

Json tolerance_schema() {
  const Json probability =
      object({{"count", any_count}, {"share", any_number}, {"lower_95", any_number}, {"upper_95", any_number}});
  const Json parameter = object({{"key", any_text},
                                 {"unit", any_text},
                                 {"mean", any_number},
                                 {"deviation", any_number},
                                 {"correlated", yes_or_no}});
  const Json factor = object({{"name", any_text}}, {{"linear_share", number_if_any},
                                                    {"first", number_if_any},
                                                    {"first_95", pair_of(number_if_any)},
                                                    {"total", number_if_any},
                                                    {"total_95", pair_of(number_if_any)}});
  const Json output = object({{"mean", number_if_any},
                              {"deviation", number_if_any},
                              {"least", number_if_any},
                              {"percentile_2_5", number_if_any},
                              {"median", number_if_any},
                              {"percentile_97_5", number_if_any},
                              {"most", number_if_any},
                              {"linear_mean", number_if_any},
                              {"linear_deviation", number_if_any}},
                             {{"factors", listed(factor)}, {"rows", any_count}});
  SchemaKeys limits;
  for (const DomainLimitInfo& limit : domain_limit_table()) limits.push_back({limit.key, any_count});
  return object({{"title", any_text},
                 {"method", one_of_names<ToleranceMethod>()},
                 {"samples", any_count},
                 {"vehicles", any_count},
                 {"parameters", listed(parameter)},
                 {"probability", object(by_status(probability) + SchemaKeys{{"outside_domain", probability},
                                                                            {"hover", or_null(probability)},
                                                                            {"hover_linear", number_if_any}})},
                 {"outside_domain", object(limits)},
                 {"allow_extrapolation", yes_or_no},
                 {"outputs", by_name(output)}});
}

const Json outcomes = one_of({"found", "infeasible", "nothing_flaps"});

Json screened() {
  return object(by_status(any_count) + SchemaKeys{{"feasible", any_count}, {"outside_domain", any_count}});
}

Json optimum_schema() {
  const Json direction = object({{"flat", yes_or_no},
                                 {"width", any_number},
                                 {"curvature", number_if_any},
                                 {"from", listed(any_number)},
                                 {"to", listed(any_number)}});
  return object(
      {{"outcome", outcomes},
       {"objective", metric_key()},
       {"maximise", yes_or_no},
       {"screened", screened()},
       {"allow_extrapolation", yes_or_no},
       {"reason", text_if_any},
       {"domain", or_null(domain)},
       {"limited_by_domain", or_null(yes_or_no)},
       {"value", number_if_any},
       {"parameters", or_null(by_name(any_number))},
       {"metrics", or_null(object(metrics()))},
       {"active", or_null(listed(object({{"limit", any_text}, {"sensitivity", number_if_any}})))},
       {"directions", or_null(listed(direction))},
       {"starts",
        or_null(object({{"all", any_count}, {"same", any_count}, {"elsewhere", any_count}, {"failed", any_count}}))},
       {"evaluations", or_null(any_count)}});
}

Json front_schema() {
  const Json motor = either({object({{"model", any_text},
                                     {"solved", any_count},
                                     {"flap", any_count},
                                     {"feasible", any_count},
                                     {"front", any_count}}),
                             object({{"model", any_text}, {"refused", any_text}})});
  const Json design = object({{"parameters", by_name(any_number)}, {"metrics", object(metrics())}, {"domain", domain}},
                             {{"motor", any_text}});
  return object({{"outcome", outcomes},
                 {"objectives", listed(object({{"metric", metric_key()}, {"maximise", yes_or_no}}))},
                 {"method", one_of_names<EvolutionMethod>()},
                 {"population", any_count},
                 {"generations", any_count},
                 {"screened", screened()},
                 {"allow_extrapolation", yes_or_no}},
                {{"motors", listed(motor)},
                 {"reason", any_text},
                 {"evaluations", any_count},
                 {"reference", by_name(any_number)},
                 {"hypervolume", any_number},
                 {"hypervolume_history", listed(any_number)},
                 {"picks", by_name(any_count)},
                 {"front", listed(design)}});
}

Json optimise_schema() {
  const Json trial =
      either({object({{"model", text_if_any}, {"refused", any_text}}),
              object({{"model", text_if_any}, {"result", optimum_schema()}}, {{"choices", by_name(Json(true))}})});
  const Json trials = object({{"best", text_if_any}}, {{"choices", listed(trial)}, {"motors", listed(trial)}});
  return either({with_text(optimum_schema(), "one objective"),
                 with_text(trials, "one objective, a catalogue of motors or choices"),
                 with_text(front_schema(), "several objectives")});
}

Json endurance_schema() {
  const Json state = object(metrics(int(Metric::hover)));
  const Json moment =
      object(SchemaKeys{{"time_s", any_number}, {"charge", any_number}, {"open_circuit_voltage_v", any_number}} +
             metrics(int(Metric::hover)));
  return object({{"status", or_null(statuses())},
                 {"status_detail", any_text},
                 {"hover", any_text},
                 {"hover_s", number_if_any},
                 {"end", any_text},
                 {"endurance_s", any_number},
                 {"domain", or_null(domain)},
                 {"hover_lost", or_null(moment)},
                 {"charge_initial", number_if_any},
                 {"charge_final", number_if_any},
                 {"charge_drawn_c", number_if_any},
                 {"energy_chemical_j", number_if_any},
                 {"energy_electrical_j", number_if_any},
                 {"energy_internal_j", number_if_any},
                 {"energy_aerodynamic_j", number_if_any},
                 {"current_mean_a", number_if_any},
                 {"power_electrical_w", number_if_any},
                 {"power_aerodynamic_w", number_if_any},
                 {"lift_mean_n", number_if_any},
                 {"efficiency_system", number_if_any},
                 {"initial", or_null(state)},
                 {"final", or_null(state)},
                 {"history", or_null(by_name(listed(either({number_if_any, any_text}))))}});
}

Json reproduce_schema() {
  const std::vector<std::string> variants = {"rod-force", "virtual-work", "virtual-work-own-calibration"};
  const Json interval = or_null(pair_of(any_number));
  const Json side = object({{"value", number_if_any},
                            {"text", any_text},
                            {"deviation", number_if_any},
                            {"ratio_deviation", number_if_any},
                            {"interval_95", interval},
                            {"interval_from", text_if_any},
                            {"residual", number_if_any},
                            {"domain", any_text},
                            {"within", or_null(yes_or_no)}});
  SchemaKeys met, sides;
  for (const std::string& variant : variants) {
    met.push_back({variant, any_count});
    sides.push_back({variant, side});
  }
  const SchemaKeys counts = {{"reproduced", any_count},
                             {"depends_on_the_formulation", any_count},
                             {"not_reproduced", any_count},
                             {"met", object({}, met)}};
  const SchemaKeys score = counts + SchemaKeys{{"statements", any_count},
                                               {"with_changes_as_ratios", object(counts)},
                                               {"within_printed_digits", object(counts)}};
  const Json answer = object({{"formulation", any_text},
                              {"frequency_hz", number_if_any},
                              {"power_electrical_w", number_if_any},
                              {"power_electrical_w_95", interval},
                              {"without_friction_w", number_if_any},
                              {"without_friction_w_95", interval},
                              {"change", number_if_any},
                              {"change_95", interval},
                              {"residual", number_if_any},
                              {"residual_without_friction", number_if_any},
                              {"inside_the_domain", yes_or_no}});
  const Json calibration = object({{"formulation", one_of_names<Formulation>()},
                                   {"s2_m4", number_if_any},
                                   {"s3_m5", number_if_any},
                                   {"lift_peak_n", pair_of(number_if_any)},
                                   {"published_n", pair_of(any_number)},
                                   {"met", yes_or_no}});
  const Json claim = object({{"statement", any_text},
                             {"where", any_text},
                             {"basis", one_of_names<Basis>()},
                             {"counted", yes_or_no},
                             {"reading", text_if_any},
                             {"unit", any_text},
                             {"published", number_if_any},
                             {"published_text", any_text},
                             {"tolerance", number_if_any},
                             {"printed_digits", number_if_any},
                             {"searched_in", text_if_any},
                             {"outcome", any_text}},
                            sides + SchemaKeys{{"reason", any_text}, {"note", any_text}, {"erratum", any_text}});
  const Json law = object({{"law", one_of_names<FrictionLaw>()},
                           {"drag_factor", any_number},
                           {"drag_factor_95", interval},
                           {"input_change_by_springs_95", interval},
                           {"formulation", any_text},
                           {"coefficient", any_number},
                           {"calibrated", yes_or_no},
                           {"frequency_hz", number_if_any},
                           {"values", any_count},
                           {"rms_deviation", number_if_any},
                           {"rms_deviation_as_ratios", number_if_any}});
  return object({{"title", any_text},
                 {"source", any_text},
                 {"predictions", object(score)},
                 {"calibration", listed(calibration)},
                 {"answer", listed(answer)},
                 {"samples", any_count},
                 {"claims", listed(claim)},
                 {"friction_laws", listed(law)}},
                {{"section_5", by_name(object(score + SchemaKeys{{"crank_radius_rms_deviation", number_if_any}}))}});
}

Json keys_schema() {
  std::vector<std::string> names;
  for (const auto& key : parameter_table<double>()) names.emplace_back(key.path);
  return object({{"keys", listed(object({{"key", one_of(std::move(names))},
                                         {"unit", text_if_any},
                                         {"range", any_text},
                                         {"default", any_text},
                                         {"meaning", any_text},
                                         {"only_with", text_if_any}}))}});
}

Json metrics_schema() {
  return object({{"metrics", listed(object({{"key", metric_key()}, {"unit", any_text}, {"long_name", any_text}}))}});
}

constexpr std::array<std::pair<std::string_view, Json (*)()>, 12> schemas = {{{"run", run_schema},
                                                                              {"compare", compare_schema},
                                                                              {"sweep", sweep_schema},
                                                                              {"identify-motor", identify_motor_schema},
                                                                              {"fit", fit_schema},
                                                                              {"tolerance", tolerance_schema},
                                                                              {"optimise", optimise_schema},
                                                                              {"endurance", endurance_schema},
                                                                              {"linearise", linearise_schema},
                                                                              {"reproduce", reproduce_schema},
                                                                              {"keys", keys_schema},
                                                                              {"metrics", metrics_schema}}};

}  // namespace

const std::vector<std::string_view>& schema_commands() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const auto& [name, schema] : schemas) all.push_back(name);
    return all;
  }();
  return names;
}

std::string json_schema(std::string_view command) {
  const auto* found = std::find_if(schemas.begin(), schemas.end(), [&](const auto& s) { return s.first == command; });
  if (found == schemas.end()) return "";
  Json json;
  json["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  json["title"] = fmt::format("wingbeat {} --json", command);
  json.update(found->second());
  return json.dump(2) + "\n";
}

}  // namespace wingbeat
