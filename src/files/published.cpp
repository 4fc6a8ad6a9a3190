#include "wingbeat/files/published.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <tuple>
#include <utility>

#include "files/toml_reader.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

constexpr std::pair<const char*, PublishedTrend::Kind> kinds[] = {
    {"crossing", PublishedTrend::Kind::crossing},
    {"peak-at", PublishedTrend::Kind::peak_at},
    {"trough-at", PublishedTrend::Kind::trough_at},
    {"peak", PublishedTrend::Kind::peak},
    {"value", PublishedTrend::Kind::value},
    {"change", PublishedTrend::Kind::change},
    {"difference", PublishedTrend::Kind::difference},
    {"best-range", PublishedTrend::Kind::best_range},
    {"power-balance", PublishedTrend::Kind::power_balance},
    {"between", PublishedTrend::Kind::between},
    {"steadier", PublishedTrend::Kind::steadier},
    {"saturates", PublishedTrend::Kind::saturates},
    {"initial-guesses", PublishedTrend::Kind::initial_guesses},
    {"constant-load-efficiency", PublishedTrend::Kind::constant_load_efficiency},
    {"spring-resonance", PublishedTrend::Kind::spring_resonance},
    {"weight", PublishedTrend::Kind::weight},
    {"best-friction-law", PublishedTrend::Kind::best_friction_law},
    {"generally", PublishedTrend::Kind::generally},
    {"turns", PublishedTrend::Kind::turns},
    {"ordered-conditions", PublishedTrend::Kind::ordered_conditions},
    {"wording", PublishedTrend::Kind::wording}};

constexpr std::pair<const char*, PublishedTrend::Bound> bounds[] = {{"below", PublishedTrend::Bound::below},
                                                                    {"above", PublishedTrend::Bound::above}};

using Kind = TomlNode::Kind;

/// One unit of the last digit of a number that reads `text` and is `value`. Zeros at the end of a whole number are not
/// taken for digits: 30 % is 3 tens.
double last_digit(const std::string& text, double value) {
  const auto begin = text.find_first_of("0123456789"), end = text.find_first_not_of("0123456789.", begin);
  if (begin == std::string::npos || value == 0.0) return absent;
  const std::string digits = text.substr(begin, end == std::string::npos ? end : end - begin);
  const auto point = digits.find('.');
  int power = 0;
  if (point != std::string::npos) power = -int(digits.size() - point - 1);
  else power = int(digits.size() - 1 - std::min(digits.size() - 1, digits.find_last_not_of('0')));
  return std::abs(value) / std::stod(digits) * std::pow(10.0, power);
}

class Reader : TomlReader {
 public:
  Reader(std::string_view text, std::string_view name,
         const std::function<Design<double>(const std::string&)>& design_named)
      : TomlReader(std::string(name)), root_(parse_toml_tree(text, name)), design_named_(design_named) {}

  PublishedFile read() {
    PublishedFile file;
    known_keys(root_, {"title", "source", "tolerance", "designs", "value", "trend", "uncertain"});
    file.title = text_at(root_, "title");
    file.source = text_at(root_, "source");
    if (has(root_, "tolerance")) file.tolerance = tolerance_at(root_, file);
    const TomlNode& designs = need(root_, "designs", "a table of vehicle files");
    if (designs.kind != Kind::table) refuse(designs, "designs", "expected a table of vehicle files");
    for (const auto& [name, node] : designs.members) {
      file.designs[name] = design_named_(text_of(node, "designs." + name));
    }
    for (const TomlNode& value : tables_of(need(root_, "value", "[[value]] tables"), "value")) {
      file.values.push_back(read_value(value, file));
    }
    if (const TomlNode* trends = root_.find("trend")) {
      for (const TomlNode& trend : tables_of(*trends, "trend")) file.trends.push_back(read_trend(trend, file));
    }
    if (const TomlNode* uncertain = root_.find("uncertain")) {
      for (const TomlNode& entry : tables_of(*uncertain, "uncertain")) file.uncertain.push_back(read_uncertain(entry));
    }
    return file;
  }

 private:
  UncertainPublished read_uncertain(const TomlNode& t) const {
    known_keys(t, {"key", "relative_deviation", "why"});
    UncertainPublished u{text_at(t, "key"), number_at(t, "relative_deviation"), text_at(t, "why")};
    try {
      design_parameter(u.key);
    } catch (const ParameterError& e) {
      refuse(*t.find("key"), "key", e.what());
    }
    if (!(u.relative_deviation > 0.0 && u.relative_deviation < 0.3)) {
      refuse(*t.find("relative_deviation"), "relative_deviation", "must lie between 0 and 0.3");
    }
    return u;
  }

  PublishedValue read_value(const TomlNode& t, const PublishedFile& file) {
    known_keys(
        t, {"voltage", "frequency", "metric", "design", "ratio", "published", "change", "tolerance", "where", "basis"});
    PublishedValue v{};
    if (has(t, "voltage") == has(t, "frequency")) refuse(t, "value", "give one of voltage and frequency");
    if (has(t, "voltage")) v.voltage = quantity_at(t, "voltage", "V");
    if (has(t, "frequency")) v.frequency = quantity_at(t, "frequency", "Hz");
    v.metric = metric_at(t, "metric");
    std::tie(v.design, v.relative_to) = designs_at(t, file);
    v.change = has(t, "change");
    if (v.change && (!v.relative_to || has(t, "published"))) {
      refuse(*t.find("change"), "change", "applies only to a ratio, instead of published");
    }
    std::tie(v.published, v.published_text) =
        published_at(t, v.change ? "change" : "published", v.relative_to ? "1" : metric_info(v.metric).unit);
    v.digit = last_digit(v.published_text, v.published);
    v.tolerance = tolerance_at(t, file);
    if (has(t, "where")) v.where = text_at(t, "where");
    if (has(t, "basis")) v.basis = choice_at(t, "basis", names_of<Basis>);
    return v;
  }

  PublishedTrend read_trend(const TomlNode& t, const PublishedFile& file) {
    using Kind = PublishedTrend::Kind;
    PublishedTrend trend{};
    trend.kind = choice_at(t, "kind", kinds);
    trend.statement = text_at(t, "statement");
    trend.where = text_at(t, "where");
    trend.basis = choice_at(t, "basis", names_of<Basis>);
    for (const auto& [key, text] :
         {std::pair("reason", &trend.reason), std::pair("note", &trend.note), std::pair("erratum", &trend.erratum)}) {
      if (has(t, key)) *text = text_at(t, key);
    }
    if (has(t, "restates")) trend.restates = flag_at(t, "restates");
    std::vector<std::string_view> keys{"kind", "statement", "where", "basis", "reason", "note", "erratum", "restates"};
    const auto also = [&](std::initializer_list<std::string_view> more) { keys.insert(keys.end(), more); };
    const auto is = [&](std::initializer_list<Kind> any) {
      return std::find(any.begin(), any.end(), trend.kind) != any.end();
    };
    if (trend.kind == Kind::best_friction_law) {
      also({"published_law"});
      known_keys(t, keys);
      if (has(t, "published_law")) trend.published_law = choice_at(t, "published_law", names_of<FrictionLaw>);
      trend.unit = std::string("1");  // a literal draws a false warning of GCC 12
      return trend;
    }
    if (trend.kind == Kind::wording) {
      known_keys(t, keys);
      if (trend.reason.empty()) refuse(t, "reason", "missing: why there is nothing to compute");
      trend.unit = std::string("1");
      return trend;
    }
    const bool pair =
        is({Kind::crossing, Kind::change, Kind::difference, Kind::steadier, Kind::generally, Kind::turns});
    also({pair ? "ratio" : "design"});
    std::tie(trend.design, trend.relative_to) = designs_at(t, file);
    if (trend.relative_to.has_value() != pair) {
      refuse(t, "ratio",
             "a crossing, change or difference, steadier, generally and turns need a ratio, everything else a design");
    }
    const bool along = is({Kind::crossing, Kind::peak_at, Kind::trough_at, Kind::peak});
    const bool at_point = is({Kind::value, Kind::change, Kind::difference});
    const bool compared = is({Kind::generally, Kind::turns});
    if (along || at_point || compared || is({Kind::best_range, Kind::ordered_conditions})) {
      also({"metric"});
      trend.metric = metric_at(t, "metric");
    }
    if ((along && trend.kind != Kind::crossing) || trend.kind == Kind::value) {
      also({"share_of"});
      if (has(t, "share_of")) trend.share_of = metric_at(t, "share_of");
    }
    std::string unit = "Hz";
    if (along || at_point || is({Kind::best_range, Kind::saturates})) {
      also({"over", "hold_stroke"});
      if (has(t, "over")) {
        trend.over = text_at(t, "over");
        try {
          unit = design_parameter(trend.over).unit;
        } catch (const ParameterError& e) {
          refuse(*t.find("over"), "over", e.what());
        }
        if (!along) {
          also({"at"});
          trend.over_value = quantity_at(t, "at", unit.c_str());
        }
      }
      if (has(t, "hold_stroke")) trend.hold_stroke = flag_at(t, "hold_stroke");
    }
    if (along || compared || is({Kind::best_range, Kind::between, Kind::saturates})) {
      also({"from", "to"});
      const std::string ranged = along || trend.kind == Kind::saturates ? unit : "Hz";
      trend.from = quantity_at(t, "from", ranged.c_str());
      trend.to = quantity_at(t, "to", ranged.c_str());
      if (!(trend.to > trend.from)) refuse(*t.find("to"), "to", "must be above from");
    }
    const bool held = is({Kind::power_balance, Kind::steadier, Kind::ordered_conditions});
    if (at_point) {
      if (has(t, "voltage") == has(t, "frequency")) refuse(t, "trend", "give one of voltage and frequency");
      also({"voltage", "frequency"});
      if (has(t, "voltage")) trend.voltage = quantity_at(t, "voltage", "V");
    }
    if (held || has(t, "frequency")) {
      if (held) also({"frequency"});
      trend.frequency = quantity_at(t, "frequency", "Hz");
    }
    if ((along && !trend.over.empty()) ||
        is({Kind::saturates, Kind::initial_guesses, Kind::constant_load_efficiency})) {
      also({"voltage"});
      trend.voltage = quantity_at(t, "voltage", "V");
    }
    const char* metric_unit = trend.share_of ? "1" : metric_info(trend.metric).unit;
    trend.unit = is({Kind::peak, Kind::value, Kind::difference})        ? metric_unit
                 : is({Kind::crossing, Kind::peak_at, Kind::trough_at}) ? unit
                 : is({Kind::best_range, Kind::spring_resonance})       ? "Hz"
                 : trend.kind == Kind::weight                           ? "N"
                                                                        : "1";
    if (trend.kind == Kind::best_range) {
      also({"published", "tolerance"});
      const TomlNode& node = need(t, "published", "two frequencies");
      if (node.kind != TomlNode::Kind::array || node.items.size() != 2)
        refuse(node, "published", "expected two frequencies");
      const auto [low, low_text] = published_of(node.items[0], "published", "Hz");
      const auto [high, high_text] = published_of(node.items[1], "published", "Hz");
      if (!(high > low)) refuse(node, "published", "the second frequency must be above the first");
      trend.published = low;
      trend.published_end = high;
      trend.published_text = fmt::format("{} to {}", low_text, high_text);
      trend.digit = std::min(last_digit(low_text, low), last_digit(high_text, high));
      trend.tolerance = tolerance_at(t, file);
    } else if (trend.kind == Kind::generally) {
      also({"bound"});
      trend.bound = choice_at(t, "bound", bounds);
    } else if (!compared &&
               !is({Kind::between, Kind::steadier, Kind::saturates, Kind::initial_guesses, Kind::ordered_conditions})) {
      also({"published", "tolerance", "bound", "approximate"});
      if (has(t, "approximate")) trend.approximate = flag_at(t, "approximate");
      if (has(t, "published")) {
        std::tie(trend.published, trend.published_text) = published_at(t, "published", trend.unit.c_str());
        trend.digit = last_digit(trend.published_text, *trend.published);
        if (trend.approximate) trend.published_text = "about " + trend.published_text;
        if (has(t, "bound")) {
          trend.bound = choice_at(t, "bound", bounds);
          trend.published_text = fmt::format("{} {}", text_at(t, "bound"), trend.published_text);
        } else {
          trend.tolerance = tolerance_at(t, file);
        }
      } else if (has(t, "tolerance") || has(t, "bound")) {
        refuse(t, "published", "missing: tolerance and bound belong to it");
      }
    }
    known_keys(t, keys);
    return trend;
  }

  Metric metric_at(const TomlNode& t, const char* key) const {
    const std::string metric = text_at(t, key);
    const int index = metric_index(metric);
    if (index == metric_count) {
      refuse(*t.find(key), key, fmt::format("{} is no metric of wingbeat run --json", in_quotes(metric)));
    }
    return Metric(index);
  }

  std::pair<std::string, std::optional<std::string>> designs_at(const TomlNode& t, const PublishedFile& file) const {
    if (has(t, "design") == has(t, "ratio")) refuse(t, "value", "give one of design and ratio");
    if (has(t, "design")) return {design_in(*t.find("design"), "design", file), std::nullopt};
    const TomlNode& pair = *t.find("ratio");
    if (pair.kind != Kind::array || pair.items.size() != 2) refuse(pair, "ratio", "expected two names of designs");
    return {design_in(pair.items[0], "ratio", file), design_in(pair.items[1], "ratio", file)};
  }

  template <class Name, class E, std::size_t N>
  E choice_at(const TomlNode& t, const char* key, const std::pair<Name, E> (&choices)[N]) const {
    const std::string text = text_at(t, key);
    std::string names;
    for (const auto& [name, value] : choices) {
      if (text == name) return value;
      names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
    }
    refuse(*t.find(key), key, fmt::format("must be one of {}, got {}", names, in_quotes(text)));
  }

  static bool has(const TomlNode& t, std::string_view key) { return t.find(key) != nullptr; }
  void known_keys(const TomlNode& t, const std::vector<std::string_view>& keys) const {
    for (const auto& [key, node] : t.members) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) unknown(node, key, "", keys);
    }
  }
  const TomlNode& need(const TomlNode& t, std::string_view key, std::string_view expected) const {
    const TomlNode* node = t.find(key);
    if (!node) refuse(t, std::string(key), fmt::format("missing: expected {}", expected));
    return *node;
  }
  std::span<const TomlNode> tables_of(const TomlNode& node, const std::string& key) const {
    const std::string expected = fmt::format("expected [[{}]] tables", key);
    if (node.kind != Kind::array) refuse(node, key, expected);
    for (const TomlNode& item : node.items) {
      if (item.kind != Kind::table) refuse(item, key, expected);
    }
    return node.items;
  }
  std::string text_of(const TomlNode& node, const std::string& key) const {
    if (node.kind != Kind::text) refuse(node, key, "expected a text");
    return node.text;
  }
  std::string text_at(const TomlNode& t, std::string_view key) const {
    return text_of(need(t, key, "a text"), std::string(key));
  }
  double number_at(const TomlNode& t, std::string_view key) const {
    const TomlNode& node = need(t, key, "a number");
    if (node.kind != Kind::number || !std::isfinite(node.number)) refuse(node, std::string(key), "expected a number");
    return node.number;
  }
  bool flag_at(const TomlNode& t, const char* key) const {
    const TomlNode& flag = *t.find(key);
    if (flag.kind != Kind::boolean) refuse(flag, key, "expected true or false");
    return flag.number != 0.0;
  }
  /// A quantity in `unit`, either a number of SI units or a text, and how it is written.
  std::pair<double, std::string> published_of(const TomlNode& node, const std::string& key, const char* unit) const {
    if (node.kind == Kind::text) return {quantity(node, key, unit), node.text};
    if (node.kind != Kind::number || !std::isfinite(node.number)) {
      refuse(node, key, "expected a number or a quantity");
    }
    const std::string_view shown_unit = unit;
    return {node.number,
            shown_unit == "1" ? fmt::format("{:g}", node.number) : fmt::format("{:g} {}", node.number, shown_unit)};
  }
  std::pair<double, std::string> published_at(const TomlNode& t, const std::string& key, const char* unit) const {
    const TomlNode& node = need(t, key, "a number or a quantity");
    const auto read = published_of(node, key, unit);
    if (read.first == 0.0 && !has(t, "bound")) refuse(node, key, "0 allows no relative deviation");
    return read;
  }
  double tolerance_at(const TomlNode& t, const PublishedFile& file) const {
    if (!has(t, "tolerance")) {
      if (!std::isfinite(file.tolerance)) refuse(t, "tolerance", "missing here, and the file states none for all");
      return file.tolerance;
    }
    const double tolerance = number_at(t, "tolerance");
    if (!(tolerance > 0.0)) refuse(*t.find("tolerance"), "tolerance", "must be > 0");
    return tolerance;
  }
  double quantity_at(const TomlNode& t, const std::string& key, const char* unit) const {
    const TomlNode& node = need(t, key, quantity_example(unit));
    const double x = published_of(node, key, unit).first;
    if (!(x > 0.0)) refuse(node, key, "must be > 0");
    return x;
  }
  std::string design_in(const TomlNode& node, const char* key, const PublishedFile& file) const {
    const std::string name = text_of(node, key);
    if (!file.designs.contains(name)) refuse(node, key, fmt::format("{} is not among [designs]", in_quotes(name)));
    return name;
  }

  TomlNode root_;
  const std::function<Design<double>(const std::string&)>& design_named_;
};

}  // namespace

PublishedFile parse_published(std::string_view text, std::string_view name,
                              const std::function<Design<double>(const std::string& file)>& design_named) {
  return Reader(text, name, design_named).read();
}

PublishedFile read_published(const std::filesystem::path& file, std::span<const std::string> overrides) {
  const std::string text = read_text_file(file);
  return parse_published(text, input_name(file), [&](const std::string& design) {
    return read_design(find_vehicle(file.parent_path(), design), overrides);
  });
}

std::string operating_point(const std::optional<double>& voltage, const std::optional<double>& frequency) {
  return voltage ? fmt::format("{:.6g} V", *voltage) : fmt::format("{:.6g} Hz", frequency.value_or(absent));
}

}  // namespace wingbeat
