#include <fmt/format.h>

#include <cmath>
#include <string>

#include "report/described.hpp"
#include "report/report_tools.hpp"
#include "report/result_schemas.hpp"
#include "report/uncertain_report.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/report/tolerance_report.hpp"

namespace wingbeat {
namespace described {
namespace {

struct FlightsFound {
  const ToleranceStudy& study;
  const FlightCondition& condition;
  const FlightToleranceResult& result;
};

const Description<FlightSpread>& spread_description() {
  using R = FlightSpread;
  static const Description<R> description =
      Description<R>()
          .all_of(moments_description(), [](const R& r) -> SampleMoments { return r; })
          .always("centre", "", "at the parameters' means", &R::centre);
  return description;
}

Description<FlightToleranceResult> quantities_description() {
  Description<FlightToleranceResult> d;
  for (std::size_t k = 0; k < flight_quantities().size(); ++k) {
    const FlightQuantity& q = flight_quantities()[k];
    d.part(q.name, q.meaning, spread_description(),
           [k](const FlightToleranceResult& r) -> const FlightSpread& { return r.quantity[k]; });
  }
  return d;
}

const Description<FlightsFound>& flights_description() {
  using R = FlightsFound;
  static const Description<R> description =
      Description<R>()
          .always("title", "", "", [](const R& r) { return r.study.title; })
          .always("method", "", "", [](const R& r) { return r.study.method; })
          .always("samples", "", "vehicles drawn and trimmed", [](const R& r) { return r.result.samples.size(); })
          .always("speed_m_per_s", "m/s", "forward, against the air", [](const R& r) { return r.condition.speed; })
          .parts("parameters", "the uncertain ones", uncertain_description(),
                 [](const R& r) { return uncertain_keys(r.study); })
          .part("flies", "in trim, within the ranges of the controls or beyond", probability_description(),
                [](const R& r) { return r.result.flies; })
          .part("beyond_controls", "of which beyond", probability_description(),
                [](const R& r) { return r.result.beyond_controls; })
          .part("unstable", "a mode grows; of those that fly", probability_description(),
                [](const R& r) { return r.result.unstable; })
          .part("flight", "over the vehicles that fly", quantities_description(),
                [](const R& r) -> const FlightToleranceResult& { return r.result; });
  return description;
}

}  // namespace

Json flight_tolerance_schema() { return flights_description().schema(); }

}  // namespace described

std::string text_flight_tolerance(const ToleranceStudy& study, const FlightCondition& condition,
                                  const FlightToleranceResult& result) {
  std::string text;
  if (!study.title.empty()) text += wrapped(study.title, 100, 0) + "\n";
  text += fmt::format("{} {} samples, each trimmed at {:g} m/s\n\n", result.samples.size(),
                      study.method == ToleranceMethod::sobol ? "scrambled Sobol" : "Monte Carlo", condition.speed);
  text += text_uncertain(study) + probability_head;
  text += probability_line("flies", result.flies);
  if (result.beyond_controls.count > 0) text += probability_line("  beyond its controls", result.beyond_controls);
  if (result.flies.count > 0) text += probability_line("a mode grows", result.unstable, "of those that fly");
  text += fmt::format("\n{:<34}{:>11}{:>11}{:>11}{:>11}{:>11} {:>11}\n", "Flight (those that fly)", "mean", "deviation",
                      "2.5 %", "median", "97.5 %", "at means");
  const auto cell = [](double x) {
    // Rounding errors of what symmetry makes zero are none.
    return !std::isfinite(x) ? std::string("-") : fmt::format("{:.4g}", std::abs(x) < 1e-9 ? 0.0 : x);
  };
  for (std::size_t k = 0; k < result.quantity.size(); ++k) {
    const FlightSpread& s = result.quantity[k];
    text += fmt::format("  {:<32}{:>11}{:>11}{:>11}{:>11}{:>11} {:>11}\n", flight_quantities()[k].name, cell(s.mean),
                        cell(s.deviation), cell(s.p025), cell(s.median), cell(s.p975), cell(s.centre));
  }
  if (std::isnan(result.centre.voltage)) {
    text +=
        wrapped(fmt::format("At the parameters' means the vehicle does not fly: {}.", result.centre_detail), 100, 0) +
        "\n";
  }
  return text + "Modes are those of the flight averaged over the wingbeat.\n";
}

std::string json_flight_tolerance(const ToleranceStudy& study, const FlightCondition& condition,
                                  const FlightToleranceResult& result) {
  return detail::dumped(described::flights_description().json({study, condition, result}));
}

}  // namespace wingbeat
