#include "wingbeat/io/published.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "wingbeat/io/report.hpp"
#include "wingbeat/io/units.hpp"

namespace wingbeat {
namespace {

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : path_(file), name_(file.string()) {}

  PublishedFile read() {
    const std::string text = read_text_file(path_);
    toml::table root;
    try {
      root = toml::parse(text, name_);
    } catch (const toml::parse_error& e) {
      throw InputError(name_, int(e.source().begin.line), int(e.source().begin.column), "",
                       fmt::format("not TOML: {}", e.description()));
    }
    PublishedFile file;
    known_keys(root, {"title", "source", "designs", "value"});
    file.title = text_at(root, "title");
    file.source = text_at(root, "source");
    const toml::table* designs = need(root, "designs", "a table of vehicle files").as_table();
    if (!designs) refuse(*root.get("designs"), "designs", "expected a table of vehicle files");
    for (const auto& [key, node] : *designs) {
      const std::string name(key.str());
      file.designs[name] = read_design(path_.parent_path() / text_of(node, "designs." + name));
    }
    const toml::array* values = need(root, "value", "[[value]] tables").as_array();
    if (!values) refuse(*root.get("value"), "value", "expected [[value]] tables");
    for (const toml::node& node : *values) {
      if (!node.is_table()) refuse(node, "value", "expected [[value]] tables");
      file.values.push_back(read_value(*node.as_table(), file));
    }
    return file;
  }

 private:
  PublishedValue read_value(const toml::table& t, const PublishedFile& file) {
    known_keys(t, {"voltage", "frequency", "metric", "design", "ratio", "published", "tolerance"});
    PublishedValue v{};
    if (t.contains("voltage") == t.contains("frequency")) refuse(t, "value", "give one of voltage and frequency");
    if (t.contains("voltage")) v.voltage = quantity_at(t, "voltage", "V");
    if (t.contains("frequency")) v.frequency = quantity_at(t, "frequency", "Hz");
    const std::string metric = text_at(t, "metric");
    const int index = metric_index(metric);
    if (index == metric_count) {
      refuse(*t.get("metric"), "metric", fmt::format("{} is no metric of wingbeat run --json", in_quotes(metric)));
    }
    v.metric = Metric(index);
    if (t.contains("design") == t.contains("ratio")) refuse(t, "value", "give one of design and ratio");
    if (t.contains("design")) {
      v.design = design_in(*t.get("design"), "design", file);
    } else {
      const toml::array* pair = t.get("ratio")->as_array();
      if (!pair || pair->size() != 2) refuse(*t.get("ratio"), "ratio", "expected two names of designs");
      v.design = design_in(*pair->get(0), "ratio", file);
      v.relative_to = design_in(*pair->get(1), "ratio", file);
    }
    v.published = number_at(t, "published");
    v.tolerance = number_at(t, "tolerance");
    if (v.published == 0.0) refuse(*t.get("published"), "published", "0 allows no relative deviation");
    if (!(v.tolerance > 0.0)) refuse(*t.get("tolerance"), "tolerance", "must be > 0");
    return v;
  }

  [[noreturn]] void refuse(const toml::node& node, const std::string& key, const std::string& message) const {
    throw InputError(name_, int(node.source().begin.line), int(node.source().begin.column), key, message);
  }
  void known_keys(const toml::table& t, std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, node] : t) {
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end()) {
        refuse(node, std::string(key.str()), fmt::format("unknown key; known here: {}", fmt::join(keys, ", ")));
      }
    }
  }
  const toml::node& need(const toml::table& t, std::string_view key, std::string_view expected) const {
    const toml::node* node = t.get(key);
    if (!node) refuse(t, std::string(key), fmt::format("missing: expected {}", expected));
    return *node;
  }
  std::string text_of(const toml::node& node, const std::string& key) const {
    const auto text = node.value_exact<std::string>();
    if (!text) refuse(node, key, "expected a text");
    return *text;
  }
  std::string text_at(const toml::table& t, std::string_view key) const {
    return text_of(need(t, key, "a text"), std::string(key));
  }
  double number_at(const toml::table& t, std::string_view key) const {
    const toml::node& node = need(t, key, "a number");
    const auto number = node.value<double>();
    if (!node.is_number() || !number || !std::isfinite(*number)) refuse(node, std::string(key), "expected a number");
    return *number;
  }
  double quantity_at(const toml::table& t, const std::string& key, const char* unit) const {
    const toml::node& node = *t.get(key);
    double x = 0.0;
    if (const auto text = node.value_exact<std::string>()) {
      try {
        x = parse_quantity(*text, unit);
      } catch (const UnitError& e) {
        refuse(node, key, e.what());
      }
    } else {
      x = number_at(t, key);
    }
    if (!(x > 0.0)) refuse(node, key, "must be > 0");
    return x;
  }
  std::string design_in(const toml::node& node, const char* key, const PublishedFile& file) const {
    const std::string name = text_of(node, key);
    if (!file.designs.contains(name)) refuse(node, key, fmt::format("{} is not among [designs]", in_quotes(name)));
    return name;
  }

  std::filesystem::path path_;
  std::string name_;
};

std::string spaced(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

const MetricInfo& info(Metric metric) { return metric_table()[std::size_t(metric)]; }

}  // namespace

PublishedFile read_published(const std::filesystem::path& file) { return Reader(file).read(); }

int Comparison::outside() const {
  return int(std::count_if(values.begin(), values.end(), [](const ComparedValue& v) { return !v.within; }));
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
    comparison.runs.push_back({name, v.voltage, v.frequency, run_design(design, options)});
    return comparison.runs.back().result.metrics[v.metric];
  };
  for (const PublishedValue& v : file.values) {
    double computed = run(v.design, v);
    if (v.relative_to) computed /= run(*v.relative_to, v);
    const double deviation = computed / v.published - 1.0;
    comparison.values.push_back({v, computed, deviation, std::abs(deviation) <= v.tolerance});
  }
  return comparison;
}

std::string operating_point(const std::optional<double>& voltage, const std::optional<double>& frequency) {
  return voltage ? fmt::format("{:.6g} V", *voltage) : fmt::format("{:.6g} Hz", frequency.value_or(absent));
}

std::string text_comparison(const PublishedFile& file, const Comparison& comparison) {
  std::string text = wrapped(file.title, 88, 0) + "\n  " + wrapped("source: " + file.source, 86, 2) + "\n";
  auto out = std::back_inserter(text);
  std::string at, of;
  for (const ComparedValue& v : comparison.values) {
    const PublishedValue& p = v.published;
    const std::string here = operating_point(p.voltage, p.frequency);
    const std::string which = spaced(p.design) + (p.relative_to ? " / " + spaced(*p.relative_to) : "");
    if (here != at) {
      fmt::format_to(out, "\n{:<37}{:>11}{:>12}{:>12}{:>12}\n", "At " + here, "published", "ours", "deviation",
                     "tolerance");
      of.clear();
    }
    if (which != of) fmt::format_to(out, "  {}\n", which);
    at = here;
    of = which;
    const auto value = [&](double x) {
      return !p.relative_to ? readable(x, info(p.metric).unit) : std::isfinite(x) ? fmt::format("{:#.4g}", x) : "-";
    };
    fmt::format_to(out, "    {:<33}{:>11}{:>12}{:>10} %{:>10} %  {}\n", info(p.metric).long_name, value(p.published),
                   value(v.computed), std::isfinite(v.deviation) ? fmt::format("{:+.2f}", 100.0 * v.deviation) : "-",
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
    if (p.voltage) entry["voltage_v"] = *p.voltage;
    if (p.frequency) entry["frequency_hz"] = *p.frequency;
    entry["metric"] = info(p.metric).key;
    if (p.relative_to) {
      entry["ratio"] = {p.design, *p.relative_to};
    } else {
      entry["design"] = p.design;
    }
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
