// What the --json of fit has: fitted parameters, what the data determine, residuals, friction laws.
#include "report/described.hpp"
#include "report/fit_rows.hpp"
#include "report/result_schemas.hpp"
#include "report/result_trees.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/fit_report.hpp"

namespace wingbeat {
namespace described {
namespace {

struct FitFound {
  const BenchFit& fit;
  const FitResult& result;
  std::span<const FrictionCandidate> candidates;
};
/// A row or a value with the logs that it is of.
template <class X>
struct OfLogs {
  const BenchFit& fit;
  const X& found;
};
template <class X>
std::vector<OfLogs<X>> of_logs(const BenchFit& fit, const std::vector<X>& list) {
  std::vector<OfLogs<X>> all;
  for (const X& x : list) all.push_back({fit, x});
  return all;
}

const Description<FittedParameter>& fitted_parameter_description() {
  using R = FittedParameter;
  static const Description<R> description =
      Description<R>()
          .always("key", "", "of the vehicle file", &R::key)
          .always("unit", "", "", &R::unit)
          .always("of", "", "vehicle, balance or log that has the parameter", &R::of)
          .always("value", "", "null where the data do not determine it", &R::value)
          .always(
              "standard_error", "", "",
              [](const R& r) { return r.value ? std::optional(r.standard_error) : std::nullopt; },
              schema::number_if_any)
          .always("lower_95", "", "95 % interval from the standard error", &R::lower_95)
          .always("upper_95", "", "its upper end", &R::upper_95)
          .always("profile_lower_95", "", "95 % interval from the profile of the loss", &R::profile_lower_95)
          .always("profile_upper_95", "", "its upper end", &R::profile_upper_95)
          .always("quantile_95", "1", "half width of the first interval in standard errors", &R::quantile_95)
          .always("profile_rise_95", "1", "rise of the loss at the ends of the second interval", &R::profile_rise_95)
          .always("at_bound", "", "", &R::at_bound)
          .always("reason", "", "why the data do not determine it; else empty",
                  [](const R& r) { return describe(r.undetermined); })
          .always("profile", "", "values with the rise of the loss, the others free", [](const R& r) {
            std::vector<std::array<double, 2>> points;
            for (const auto& point : r.profile) points.push_back({point.value, point.excess});
            return points;
          });
  return description;
}

const Description<FitDirection>& fit_direction_description() {
  using R = FitDirection;
  static const Description<R> description =
      Description<R>()
          .always("components", "1", "relative change of each parameter, of unit length", &R::components,
                  schema::listed(schema::any_number))
          .always("relative_error", "1", "standard error along it; null where nothing is known", &R::relative_error);
  return description;
}

const Description<ConditionShare>& condition_description() {
  using R = ConditionShare;
  static const Description<R> description =
      Description<R>()
          .always("name", "", "", &R::name)
          .always("values", "", "number of measured values", &R::points)
          .always("rms_residual", "1", "in standard deviations", &R::rms)
          .always("share", "1", "of the information on each parameter, the others known", &R::share)
          .always("standard_error_without", "", "of each parameter without this condition; null: lost",
                  &R::error_without);
  return description;
}

const Description<OfLogs<UnreachedRow>>& unreached_description() {
  using R = OfLogs<UnreachedRow>;
  static const Description<R> description =
      Description<R>()
          .always("row", "", "file and line",
                  [](const R& r) { return detail::row_name(r.fit, r.found.log, r.found.row); })
          .always("status", "", "", [](const R& r) { return name_of(r.found.status); })
          .always("detail", "", "a sentence with the evidence", [](const R& r) { return describe(r.found); });
  return description;
}

const Description<OfLogs<FitPoint>>& point_description() {
  using R = OfLogs<FitPoint>;
  static const Description<R> description =
      Description<R>()
          .always("row", "", "file and line",
                  [](const R& r) { return detail::row_name(r.fit, r.found.log, r.found.row); })
          .always("quantity", "", "",
                  [](const R& r) { return std::string(name_of(r.fit.logs[r.found.log].columns[r.found.column])); })
          .always(
              "measured", "", "SI", [](const R& r) { return r.found.measured; }, schema::any_number)
          .always("fitted", "", "SI; null where the model does not reach the row",
                  [](const R& r) { return r.found.fitted; })
          .always(
              "deviation", "", "standard deviation, SI", [](const R& r) { return r.found.deviation; },
              schema::any_number);
  return description;
}

const Description<OfLogs<FittedCycle>>& cycle_description() {
  using R = OfLogs<FittedCycle>;
  static const Description<R> description =
      Description<R>()
          .always("row", "", "file and line of its first row",
                  [](const R& r) { return detail::row_name(r.fit, r.found.log, r.found.row); })
          .always("quantity", "", "",
                  [](const R& r) { return std::string(name_of(r.fit.logs[r.found.log].columns[r.found.column])); })
          .always("in_time", "", "values are equally spaced in time; else by the crank angle",
                  [](const R& r) { return r.found.in_time; })
          .always("phase_rad", "rad", "of the cycle where the log's phase is 0",
                  [](const R& r) { return r.found.phase; })
          .always("values", "", "SI, over the cycle, both ends included", [](const R& r) { return r.found.values; });
  return description;
}

const Description<FrictionCandidate>& candidate_description() {
  using R = FrictionCandidate;
  static const Description<R> description =
      Description<R>()
          .always("law", "", "", &R::law)
          .always("aicc", "1", "corrected Akaike information criterion", [](const R& r) { return r.result.aicc; })
          .always("aicc_excess", "1", "over the best law's", &R::aicc_excess)
          .always(
              "parameters", "", "fitted values, SI, by key",
              [](const R& r) {
                std::vector<std::pair<std::string, std::optional<double>>> values;
                for (const FittedParameter& p : r.result.parameters) values.emplace_back(p.key, p.value);
                return values;
              },
              schema::by_name(schema::number_if_any))
          .always("left_out", "1", "rms error, in standard deviations, of each condition predicted from the others",
                  &R::left_out)
          .always("prediction_error", "1", "rms over all of them", &R::prediction_error)
          .always("spring_frequency_hz", "Hz", "of the next two, in air", &R::spring_frequency)
          .always("power_springs_off_w", "W", "electrical input without the springs", &R::power_springs_off)
          .always("power_springs_on_w", "W", "electrical input with the springs", &R::power_springs_on);
  return description;
}

const Description<FitResult>& fit_starts_description() {
  using R = FitResult;
  static const Description<R> description = Description<R>()
                                                .always("same_least", "", "ended in this minimum", &R::starts_converged)
                                                .always("higher", "", "ended in a higher one", &R::starts_elsewhere);
  return description;
}

const Description<FitResult>& fit_result_description() {
  using R = FitResult;
  static const Description<R> description =
      Description<R>()
          .always("converged", "", "", &R::converged)
          .always("message", "", "of the search", &R::message)
          .always("misfit", "", "how the fitted model misses the data; null where it describes them",
                  [](const R& r) { return r.misfit ? std::optional(describe(*r.misfit)) : std::nullopt; })
          .always("chi_square", "1", "of the rows reached", &R::chi_square)
          .always("degrees_of_freedom", "", "", &R::degrees_of_freedom, schema::of_type("integer"))
          .always("p_value", "1", "chance of residuals as large under the stated deviations", &R::p_value)
          .always("aicc", "1", "corrected Akaike information criterion", &R::aicc)
          .part("starts", "starts by where they ended", fit_starts_description(), std::identity{})
          .parts("parameters", "fitted", fitted_parameter_description(), &R::parameters)
          .always("covariance", "", "of the parameters in their order, SI; null: not determined", &R::covariance)
          .always("correlation", "1", "", &R::correlation)
          .parts("directions", "of relative changes of the parameters, best known first", fit_direction_description(),
                 &R::directions)
          .always("verdict", "", "sentences on what the data determine",
                  [](const R& r) {
                    return r.misfit
                               ? std::vector<std::string>{"nothing can be said of it while the model misses the data"}
                               : describe(r.findings);
                  })
          .parts("conditions", "what each condition contributes", condition_description(), &R::conditions);
  return description;
}

const Description<FitFound>& fit_description() {
  using R = FitFound;
  static const Description<R> description =
      Description<R>()
          .all_of(fit_result_description(), [](const R& r) -> const FitResult& { return r.result; })
          .always("advice", "", "about a lone outlier; null where there is none",
                  [](const R& r) {
                    const std::string advice = outlier_advice(r.fit, r.result);
                    return advice.empty() ? std::nullopt : std::optional(advice);
                  })
          .parts("unreached", "rows that the fitted model does not reach", unreached_description(),
                 [](const R& r) { return of_logs(r.fit, r.result.unreached); })
          .parts("points", "measured values beside those of the fitted model", point_description(),
                 [](const R& r) { return of_logs(r.fit, r.result.points); })
          .parts("cycles", "the fitted model's courses of the waveforms", cycle_description(),
                 [](const R& r) { return of_logs(r.fit, r.result.cycles); })
          .always(
              "friction", "", "friction laws, best first; null unless compared",
              [](const R& r) {
                return r.candidates.empty() ? Json(nullptr) : candidate_description().list(r.candidates);
              },
              schema::or_null(schema::listed(candidate_description().schema())));
  return description;
}

}  // namespace

Json fit_schema() { return fit_description().schema(); }

}  // namespace described

detail::Json detail::fit_tree(const BenchFit& fit, const FitResult& result,
                              std::span<const FrictionCandidate> candidates) {
  return described::fit_description().json({fit, result, candidates});
}

std::string json_fit(const BenchFit& fit, const FitResult& result, std::span<const FrictionCandidate> candidates) {
  return detail::dumped(detail::fit_tree(fit, result, candidates));
}

}  // namespace wingbeat
