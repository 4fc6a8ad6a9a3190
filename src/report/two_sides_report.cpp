#include "wingbeat/report/two_sides_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <optional>

#include "report/control_result.hpp"
#include "report/control_tree.hpp"
#include "report/result_schemas.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

constexpr int sides_page_width = 88;

/// How both sides are, a sentence each.
std::string statuses_text(const TwoSidesResult& r) {
  std::string text = r.whole.name.empty() ? std::string() : wrapped(r.whole.name, sides_page_width, 0) + "\n";
  for (const auto& [side, found] : {std::pair("left", &r.left), std::pair("right", &r.right)}) {
    text +=
        wrapped(fmt::format("{}: {}: {}.", side, name_of(found->status), describe(*found)), sides_page_width, 2) + "\n";
    if (found->domain.any()) {
      text += wrapped(fmt::format("OUTSIDE THE MODEL'S DOMAIN ({}): {}.", name_of(found->domain),
                                  describe(found->domain_evidence)),
                      sides_page_width, 2) +
              "\n";
    }
    for (const std::string& warning : warnings_of(*found)) {
      text += wrapped(fmt::format("warning: {}.", warning), sides_page_width, 2) + "\n";
    }
  }
  return text;
}

std::string cell(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : std::string("-"); }

}  // namespace

std::string text_two_sides(const TwoSidesResult& r, const RunOptions& options) {
  std::string text = statuses_text(r);
  auto out = std::back_inserter(text);
  fmt::format_to(out, "  {}, by {}, tolerance {:.0e}\n", name_of(options.condition),
                 options.method == Method::orbit ? "periodic orbits" : "simulations from rest", options.tolerance);
  const auto line = [&](const char* name, const std::string& value) {
    fmt::format_to(out, "  {:<32}{:>14}\n", name, value);
  };
  if (r.status == FlappingStatus::flapping) {
    const Metrics<double>& m = r.metrics;
    text += "\nBoth sides together\n";
    line("voltage", readable(m[Metric::voltage], "V"));
    line("flapping frequency", readable(m[Metric::frequency], "Hz"));
    line("electrical input", readable(m[Metric::power_electrical], "W"));
    line("aerodynamic power", readable(m[Metric::power_aerodynamic], "W"));
    line("mean lift", readable(m[Metric::lift_mean], "N"));
    if (std::isfinite(m[Metric::lift_to_weight])) line("mean lift / weight", cell(m[Metric::lift_to_weight]));
  }
  fmt::format_to(out, "\n{:<46}{:>14}{:>14}\n", "Where the sides differ", "left", "right");
  for (int k = 0; k < metric_count; ++k) {
    const double left = r.left.metrics[Metric(k)], right = r.right.metrics[Metric(k)];
    if (left == right || (std::isnan(left) && std::isnan(right))) continue;
    fmt::format_to(out, "  {:<44}{:>14}{:>14}\n", metric_info(Metric(k)).key, cell(left), cell(right));
  }
  return text;
}

std::string text_two_sides_maps(const TwoSidesMaps& found) {
  std::string text = statuses_text(found.operating_point);
  if (found.maps.empty()) return text;
  fmt::format_to(std::back_inserter(text), "\nOperating point: {}, {}, mean lift {}; stroke axes {} from the middle\n",
                 readable(found.operating_point.metrics[Metric::voltage], "V"),
                 readable(found.operating_point.metrics[Metric::frequency], "Hz"),
                 readable(found.operating_point.metrics[Metric::lift_mean], "N"),
                 readable(found.options.hinge_offset, "m"));
  for (const AllocationMap& map : found.maps) text += detail::map_text(map);
  return text;
}

namespace described {
namespace {

Json status_json(FlappingStatus status) {
  return status == FlappingStatus::undecided ? Json(nullptr) : Json(name_of(status));
}

const Description<RunResult>& side_description() {
  using R = RunResult;
  static const Description<R> description =
      Description<R>()
          .always(
              "status", "", "null if undecided", [](const R& r) { return status_json(r.status); },
              schema::or_null(schema::statuses()))
          .always("status_detail", "", "a sentence with the evidence", [](const R& r) { return describe(r); })
          .always("domain", "", "inside, or the limits that are exceeded; null unless flapping",
                  [](const R& r) {
                    const bool flaps = r.status == FlappingStatus::flapping;
                    return flaps ? std::optional<std::string>(name_of(r.domain)) : std::nullopt;
                  })
          .always("warnings", "", "sentences", &warnings_of)
          .all_of(cycle_metrics_description(), &R::metrics);
  return description;
}

const Description<TwoSidesResult>& two_sides_description() {
  using R = TwoSidesResult;
  static const Description<R> description =
      Description<R>()
          .always(
              "status", "", "flapping if both sides flap, otherwise the status of the other side; null if undecided",
              [](const R& r) { return status_json(r.status); }, schema::or_null(schema::statuses()))
          .all_of(cycle_metrics_description(), &R::metrics)
          .part("left", "the left side as a vehicle of its own", side_description(), &R::left)
          .part("right", "the right side as a vehicle of its own", side_description(), &R::right);
  return description;
}

struct MapsFound {
  const TwoSidesMaps& found;
  const std::string& version;
};

const Description<MapsFound>& two_sides_maps_description() {
  using R = MapsFound;
  static const Description<R> description =
      Description<R>()
          .always("written_by", "", "",
                  [](const R& r) { return fmt::format("Written by wingbeat {} linearise", r.version); })
          .always("vehicle", "", "", [](const R& r) { return r.found.operating_point.whole.name; })
          .part("operating_point", "of both sides", two_sides_description(),
                [](const R& r) -> const auto& { return r.found.operating_point; })
          .always("hinge_offset_m", "m", "of the stroke axes from the middle of the body",
                  [](const R& r) { return r.found.options.hinge_offset; })
          .parts("static_maps", "for control allocation; none where a side does not flap", allocation_description(),
                 [](const R& r) -> const auto& { return r.found.maps; });
  return description;
}

}  // namespace

Json two_sides_schema() { return two_sides_description().schema(); }
Json two_sides_maps_schema() { return two_sides_maps_description().schema(); }

}  // namespace described

std::string json_two_sides(const TwoSidesResult& result) {
  return detail::dumped(described::two_sides_description().json(result));
}

std::string json_two_sides_maps(const TwoSidesMaps& found, const std::string& version) {
  return detail::dumped(described::two_sides_maps_description().json({found, version}));
}

}  // namespace wingbeat
