#include "wingbeat/reproduction/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "report/described.hpp"
#include "reproduction/claim_schemas.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {

int Comparison::outside() const {
  return int(std::count_if(values.begin(), values.end(), [](const ComparedValue& v) { return !v.within; }));
}

const Comparison::Run& Comparison::run_of(const PublishedValue& value, const std::string& design) const {
  for (const Run& run : runs) {
    if (run.design == design && run.voltage == value.voltage && run.frequency == value.frequency) return run;
  }
  throw std::runtime_error("a published value was not computed");
}

Comparison compare(const PublishedFile& file, double tolerance) {
  Comparison comparison;
  const auto run = [&](const std::string& name, const PublishedValue& v) {
    for (const Comparison::Run& known : comparison.runs) {
      if (known.design == name && known.voltage == v.voltage && known.frequency == v.frequency) {
        return known.result.metrics[v.metric];
      }
    }
    Design<double> design = file.designs.at(name);
    if (v.voltage) design.supply = {SupplyType::constant, *v.voltage, 0.0, 1.0};
    if (v.frequency) design.supply.type = SupplyType::constant;
    RunOptions options;
    options.tolerance = tolerance;
    options.frequency = v.frequency;
    options.allow_extrapolation = true;  // what a published vehicle does, wherever that is
    comparison.runs.push_back({name, v.voltage, v.frequency, run_design(design, options)});
    return comparison.runs.back().result.metrics[v.metric];
  };
  for (const PublishedValue& v : file.values) {
    double computed = run(v.design, v);
    if (v.relative_to) computed /= run(*v.relative_to, v);
    const double ratio_deviation = v.change ? computed / (1.0 + v.published) - 1.0 : absent;
    if (v.change) computed -= 1.0;
    const double deviation = computed / v.published - 1.0;
    comparison.values.push_back({v, computed, deviation, std::abs(deviation) <= v.tolerance, ratio_deviation});
  }
  return comparison;
}

std::string text_comparison(const PublishedFile& file, const Comparison& comparison) {
  std::string text = wrapped(file.title, 88, 0) + "\n  " + wrapped("source: " + file.source, 86, 2) + "\n";
  auto out = std::back_inserter(text);
  std::string point, design;
  for (const ComparedValue& v : comparison.values) {
    const PublishedValue& p = v.published;
    const std::string here = operating_point(p.voltage, p.frequency);
    const std::string which = detail::spaced(p.design) + (p.relative_to ? " / " + detail::spaced(*p.relative_to) : "") +
                              (p.change ? ", change" : "");
    if (here != point) {
      fmt::format_to(out, "\n{:<37}{:>11}{:>12}{:>12}{:>12}\n", "At " + here, "published", "computed", "deviation",
                     "tolerance");
      design.clear();
    }
    if (which != design) fmt::format_to(out, "  {}\n", which);
    point = here;
    design = which;
    const auto value = [&](double x) {
      return !p.relative_to      ? readable(x, metric_info(p.metric).unit)
             : !std::isfinite(x) ? "-"
             : p.change          ? fmt::format("{:+.1f} %", 100.0 * x)
                                 : fmt::format("{:#.4g}", x);
    };
    fmt::format_to(out, "    {:<33}{:>11}{:>12}{:>10} %{:>10} %  {}\n", metric_info(p.metric).long_name,
                   p.published_text, value(v.computed),
                   std::isfinite(v.deviation) ? fmt::format("{:+.2f}", 100.0 * v.deviation) : "-",
                   fmt::format("{:.3g}", 100.0 * p.tolerance), v.within ? "ok" : "no");
  }
  const int outside = comparison.outside();
  const std::size_t count = comparison.values.size();
  if (outside == 0) {
    fmt::format_to(out, "\nAll {} values are within their tolerances.\n", count);
  } else {
    fmt::format_to(out, "\n{} of {} values are outside their tolerances.\n", outside, count);
  }
  return text;
}

namespace described {
namespace {

struct ComparisonFound {
  const PublishedFile& file;
  const Comparison& comparison;
};

const Description<ComparedValue>& compared_value_description() {
  using R = ComparedValue;
  const auto published = [](auto member) { return [member](const R& r) { return r.published.*member; }; };
  using P = PublishedValue;
  static const Description<R> description =
      Description<R>()
          .always("voltage_v", "V", "stated for the value", published(&P::voltage))
          .always("frequency_hz", "Hz", "stated for the value", published(&P::frequency))
          .always("metric", "", "", published(&P::metric))
          .always("design", "", "null of a ratio or a change",
                  [](const R& r) {
                    return r.published.relative_to ? std::nullopt : std::optional<std::string>(r.published.design);
                  })
          .always("ratio", "", "the two designs of a ratio or a change",
                  [](const R& r) {
                    using Designs = std::array<std::string, 2>;
                    const auto& second = r.published.relative_to;
                    return second ? std::optional(Designs{r.published.design, *second}) : std::nullopt;
                  })
          .always("change", "", "a ratio less 1", published(&P::change))
          .always("published", "", "the metric's unit; of a ratio or a change a number", published(&P::published),
                  schema::any_number)
          .always("computed", "", "the same of the model", &R::computed)
          .always("deviation", "1", "of the computed value from the published one", &R::deviation)
          .always("tolerance", "1", "of the deviation", published(&P::tolerance), schema::any_number)
          .always("within", "", "the deviation is within the tolerance", &R::within);
  return description;
}

const Description<ComparisonFound>& comparison_description() {
  using R = ComparisonFound;
  static const Description<R> description =
      Description<R>()
          .always("title", "", "", [](const R& r) { return r.file.title; })
          .always("source", "", "", [](const R& r) { return r.file.source; })
          .always("outside", "", "values outside their tolerances", [](const R& r) { return r.comparison.outside(); })
          .parts("values", "", compared_value_description(), [](const R& r) { return r.comparison.values; });
  return description;
}

}  // namespace

Json comparison_schema() { return comparison_description().schema(); }

}  // namespace described

std::string json_comparison(const PublishedFile& file, const Comparison& comparison) {
  return described::comparison_description()
             .json({file, comparison})
             .dump(2, ' ', false, detail::Json::error_handler_t::replace) +
         "\n";
}

}  // namespace wingbeat
