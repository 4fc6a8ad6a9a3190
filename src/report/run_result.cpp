// What a run's --json has: status, domain, warnings, metrics, the start-up.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/result_schemas.hpp"
#include "report/run_result.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace described {
namespace {

constexpr const char* unless_asked_for =
    "; of a vehicle on a battery; null unless asked for: run --endurance, a study that names it";

Description<Metrics<double>> first_metrics(int count) {
  Description<Metrics<double>> d;
  for (int m = 0; m < count; ++m) {
    const MetricInfo& metric = metric_table()[std::size_t(m)];
    const bool of_a_flight = Metric(m) == Metric::hover || Metric(m) == Metric::endurance;
    d.always(metric.key, "",
             fmt::format("{} [{}]{}", metric.long_name, metric.unit, of_a_flight ? unless_asked_for : ""),
             [m](const Metrics<double>& metrics) { return metrics.values[std::size_t(m)]; });
  }
  return d;
}

Description<TransientResult> start_up_events() {
  using Kind = TransientEvent::Kind;
  constexpr std::array<std::pair<Kind, const char*>, 5> kinds = {
      {{Kind::revolution, "revolutions of the crank; of a direct drive, periods of the supply"},
       {Kind::force_sign_change, "changes of the rod force's sign"},
       {Kind::standstill, "times that the crank comes to rest"},
       {Kind::breakaway, "times that it breaks away from rest"},
       {Kind::jam, "times that it jams"}}};
  Description<TransientResult> d;
  for (const auto& [kind, meaning] : kinds) {
    std::string name = name_of(kind);
    for (char& c : name) c = c == ' ' || c == '-' ? '_' : c;
    d.always(name, "", meaning, [kind = kind](const TransientResult& r) {
      return std::count_if(r.events.begin(), r.events.end(), [&](const TransientEvent& e) { return e.kind == kind; });
    });
  }
  return d;
}

const Description<TransientResult>& start_up_description() {
  using R = TransientResult;
  static const Description<R> description =
      Description<R>()
          .always("settled", "", "false where time, cycles or steps ran out first", &R::settled)
          .always("time_to_steady_s", "s",
                  "until each cycle's frequency is within 1 % of the last one's, or until the crank rests or jams",
                  &R::time_to_steady)
          .always("inrush_current_a", "A", "highest current of the start-up", &R::inrush_current)
          .always("inrush_current_time_s", "s", "time of the highest current", &R::inrush_current_time)
          .always("simulated_time_s", "s", "time simulated", &R::end_time)
          .always("cycles", "", "cycles simulated", &R::cycles)
          .always("averaged_cycles", "", "cycles behind the metrics", &R::averaged_cycles)
          .always("cycle_scatter", "1", "largest deviation of their durations from the mean one", &R::cycle_scatter)
          .always("current_ripple_a", "A", "ripple of the current of a pwm supply, peak to peak", &R::current_ripple)
          .part("events", "number of events by kind", start_up_events(), std::identity{});
  return description;
}

}  // namespace

const Description<Metrics<double>>& metrics_description() {
  static const Description<Metrics<double>> description = first_metrics(metric_count);
  return description;
}

const Description<Metrics<double>>& cycle_metrics_description() {
  static const Description<Metrics<double>> description = first_metrics(int(Metric::hover));
  return description;
}

const Description<RunResult>& run_description() {
  using R = RunResult;
  static const Description<R> description =
      Description<R>()
          .always(
              "status", "", "null if undecided",
              [](const R& r) {
                return r.status == FlappingStatus::undecided ? Json(nullptr) : Json(name_of(r.status));
              },
              schema::or_null(schema::statuses()))
          .always("status_detail", "", "a sentence with the evidence", [](const R& r) { return describe(r); })
          .always("domain", "", "inside, or the limits that are exceeded",
                  [](const R& r) {
                    const bool assessed =
                        r.status == FlappingStatus::flapping && std::isfinite(r.metrics[Metric::frequency]);
                    return assessed ? std::optional<std::string>(name_of(r.domain)) : std::nullopt;
                  })
          .always("domain_detail", "", "the same in a sentence with numbers; null inside the domain",
                  [](const R& r) {
                    return r.domain_evidence.empty() ? std::nullopt : std::optional(describe(r.domain_evidence));
                  })
          .always("warnings", "", "sentences", &warnings_of)
          .all_of(metrics_description(), &R::metrics)
          .sometimes(
              "supply_duty", "1", "of a pwm supply or a battery",
              [](const R& r) {
                const SupplyType type = r.design.supply.type;
                const bool switched = type == SupplyType::pwm || type == SupplyType::battery;
                return switched ? std::optional(r.design.supply.duty) : std::nullopt;
              },
              schema::any_number)
          .sometimes("pitch_coefficient_s", "s", "C_alpha that was found for an angle of attack", &R::pitch_coefficient)
          .sometimes_part("start_up", "of a run simulated from rest", start_up_description(), &R::start_up);
  return description;
}

Json run_schema() { return run_description().schema(); }

}  // namespace described

std::string json_report(const RunResult& result) {
  return described::run_description().json(result).dump(2, ' ', false, detail::Json::error_handler_t::replace) + "\n";
}

}  // namespace wingbeat
