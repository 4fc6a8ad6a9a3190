#include "wingbeat/reproduction/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

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
  std::string at, of;
  for (const ComparedValue& v : comparison.values) {
    const PublishedValue& p = v.published;
    const std::string here = operating_point(p.voltage, p.frequency);
    const std::string which = detail::spaced(p.design) + (p.relative_to ? " / " + detail::spaced(*p.relative_to) : "") +
                              (p.change ? ", change" : "");
    if (here != at) {
      fmt::format_to(out, "\n{:<37}{:>11}{:>12}{:>12}{:>12}\n", "At " + here, "published", "ours", "deviation",
                     "tolerance");
      of.clear();
    }
    if (which != of) fmt::format_to(out, "  {}\n", which);
    at = here;
    of = which;
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

std::string json_comparison(const PublishedFile& file, const Comparison& comparison) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  Json json;
  json["title"] = file.title;
  json["source"] = file.source;
  json["outside"] = comparison.outside();
  json["values"] = Json::array();
  for (const ComparedValue& v : comparison.values) {
    const PublishedValue& p = v.published;
    Json entry;
    entry["voltage_v"] = p.voltage ? Json(*p.voltage) : Json(nullptr);
    entry["frequency_hz"] = p.frequency ? Json(*p.frequency) : Json(nullptr);
    entry["metric"] = metric_info(p.metric).key;
    entry["design"] = p.relative_to ? Json(nullptr) : Json(p.design);
    entry["ratio"] = p.relative_to ? Json{p.design, *p.relative_to} : Json(nullptr);
    entry["change"] = p.change;
    entry["published"] = p.published;
    entry["computed"] = number(v.computed);
    entry["deviation"] = number(v.deviation);
    entry["tolerance"] = p.tolerance;
    entry["within"] = v.within;
    json["values"].push_back(entry);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace wingbeat
