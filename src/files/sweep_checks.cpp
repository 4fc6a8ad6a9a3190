#include "files/sweep_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <set>

#include "files/design_settings.hpp"
#include "files/study_sections.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::detail {
namespace {

constexpr std::uint64_t max_designs = 1000000000000;
constexpr std::size_t max_variants = 1000;
constexpr std::string_view own_variables[] = {"status", "recomputed", "error_estimate", "sample"};

class SweepChecks {
 public:
  SweepChecks(Sweep& sweep, const TomlReader& reader, const SweepPlaces& places, const StudyInput& input)
      : sweep_(sweep), reader_(reader), places_(places), input_(input) {}

  void run() {
    check_names();
    check_size();
    make_variants();
    check_supply();
    check_places();
    check_ranges();
  }

 private:
  void check_names() const {
    std::set<std::string, std::less<>> names(std::begin(own_variables), std::end(own_variables));
    for (const MetricInfo& metric : metric_table()) names.insert(metric.key);
    for (std::size_t a = 0; a < sweep_.axes.size(); ++a) {
      const SweepAxis& axis = sweep_.axes[a];
      std::set<std::string> here;
      if (!axis.samples) here.insert(axis.name);
      for (const SweptQuantity& q : axis.quantities) here.insert(q.name);
      for (const std::string& name : here) {
        if (!names.insert(name).second) {
          reader_.refuse(places_.axes[a], "axis.name", fmt::format("{} is the name of another variable", name));
        }
      }
    }
  }

  void check_size() const {
    std::uint64_t product = 1;
    for (std::size_t a = 0; a < sweep_.axes.size(); ++a) {
      if (sweep_.axes[a].count > max_designs / product) {
        reader_.refuse(places_.axes[a], "axis", "the study has more than 1e12 designs");
      }
      product *= sweep_.axes[a].count;
    }
  }

  static bool has_choice(const SweepAxis& axis) {
    return std::any_of(axis.quantities.begin(), axis.quantities.end(),
                       [](const SweptQuantity& q) { return q.kind == SweptQuantity::Kind::choice; });
  }

  void make_variants() {
    Sweep& sweep = sweep_;
    sweep.variant_stride.assign(sweep.axes.size(), 0);
    std::size_t count = 1;
    for (std::size_t a = sweep.axes.size(); a-- > 0;) {
      if (!has_choice(sweep.axes[a])) continue;
      sweep.variant_stride[a] = count;
      if (sweep.axes[a].count > max_variants / count) {
        reader_.refuse(places_.axes[a], "axis", fmt::format("more than {} combinations of choices", max_variants));
      }
      count *= std::size_t(sweep.axes[a].count);
    }
    for (std::size_t v = 0; v < count; ++v) sweep.variants.push_back(variant(v));
  }

  SweepVariant variant(std::size_t index) {
    SweepVariant result;
    std::vector<Setting> settings;
    for (std::size_t a = 0; a < sweep_.axes.size(); ++a) {
      const SweepAxis& axis = sweep_.axes[a];
      if (sweep_.variant_stride[a] == 0) continue;
      const std::size_t n = index / sweep_.variant_stride[a] % std::size_t(axis.count);
      for (const SweptQuantity& q : axis.quantities) {
        if (q.key == "condition") {
          result.condition = *from_name<Condition>(q.labels[n]);
        } else if (q.key == "springs") {
          result.springs = q.labels[n] == "on";
        } else if (q.kind != SweptQuantity::Kind::held) {
          TomlNode value;
          value.kind = q.labels.empty() ? Kind::number : Kind::text;
          if (q.labels.empty()) value.number = q.values[n];
          else value.text = q.labels[n];
          const SourceLocation place = places_.keys.at(q.key);
          settings.push_back({q.key, std::move(value), {reader_.file(), place.line, place.column, true}});
        }
      }
    }
    if (settings.empty() && input_.design) {
      result.design = *input_.design;
      return result;
    }
    try {
      if (!vehicle_) {
        const char* name = "the vehicle with [set]";
        vehicle_ = input_.design ? document_of(*input_.design, name) : parse_document(input_.vehicle, name);
      }
      result.design = design_of(*vehicle_, settings);
    } catch (const InputError& error) {
      if (settings.empty()) throw;
      const Origin& first = settings.front().origin;
      const bool of_setting = error.file() == first.file;
      reader_.refuse({of_setting ? error.line() : first.line, of_setting ? error.column() : first.column}, "axis",
                     reason_of(error));
    }
    return result;
  }

  /// `source_of` gives the place of a key that the study varies.
  void check_hold(const HeldKey& held, const Design<double>& design,
                  const std::function<SourceLocation(const char*)>& source_of) const {
    const std::string why = no_hold(held, design);
    if (!why.empty() && !places_.keys.contains("vehicle.mass")) {
      reader_.refuse(source_of("vehicle.mass"), "vehicle.mass", why);
    }
    if (design.supply.type == SupplyType::pwm && !(design.supply.duty > 0.0)) {
      const char* name = held.held == Held::frequency ? "flapping frequency" : held.name;
      reader_.refuse(source_of("supply.duty"), "supply.duty", fmt::format("is 0: no voltage sets the {}", name));
    }
    const std::string no_effect = fmt::format("has no effect where the {} is held", held.name);
    for (const char* key : {"supply.frequency", "supply.resonance_ratio"}) {
      if (held.held == Held::frequency && places_.keys.contains(key)) reader_.refuse(source_of(key), key, no_effect);
    }
    for (const char* key : {"supply.voltage", "supply.duty", "supply.amplitude"}) {
      if (places_.keys.contains(key) && is_void_at(held, key, design)) {
        const bool duty = design.supply.type == SupplyType::battery;
        reader_.refuse(source_of(key), key,
                       fmt::format("{}: the {} is found for it", no_effect, duty ? "duty" : "voltage"));
      }
    }
  }

  void check_supply() const {
    const auto source_of = [&](const char* key) {
      const auto found = places_.keys.find(key);
      return found == places_.keys.end() ? places_.study : found->second;
    };
    const HeldKey* held = sweep_.hold ? &held_key(sweep_.hold->held) : nullptr;
    for (const SweepVariant& v : sweep_.variants) {
      if (swings_a_crank(v.design)) reader_.refuse(source_of("supply.type"), "supply.type", no_swinging_crank);
      if (held) check_hold(*held, v.design, source_of);
    }
    const bool by_axis = sweep_.hold && std::isnan(sweep_.hold->value);
    if (held && !by_axis && places_.set_voltage) {
      reader_.refuse(*places_.set_voltage, "set.supply.voltage",
                     fmt::format("has no effect where the {} is held", held->name));
    }
  }

  /// A number of the study at a fraction of the way along its axis.
  static double number_at(const SweepAxis& axis, std::size_t q, double fraction) {
    const SweptQuantity& quantity = axis.quantities[q];
    if (quantity.values.empty()) return quantity.low + fraction * (quantity.high - quantity.low);
    return quantity.values[std::size_t(fraction * double(quantity.values.size() - 1))];
  }

  template <class Do>
  void for_each_number(const Do& act) const {
    for (std::size_t a = 0; a < sweep_.axes.size(); ++a) {
      for (std::size_t q = 0; q < sweep_.axes[a].quantities.size(); ++q) {
        if (sweep_.axes[a].quantities[q].kind == SweptQuantity::Kind::number) act(sweep_.axes[a], q);
      }
    }
  }

  /// Every key has a place in every variant, and no key undoes another.
  void check_places() const {
    for (const SweepVariant& variant : sweep_.variants) {
      Design<double> d = variant.design;
      for_each_number([&](const SweepAxis& axis, std::size_t q) {
        const SweptQuantity& quantity = axis.quantities[q];
        if (quantity.set(d, number_at(axis, q, 0.5))) return;
        const std::string_view only_with = find_parameter<double>(quantity.key)->only_with;
        reader_.refuse(
            places_.keys.at(quantity.key), quantity.key,
            only_with.empty() ? "does not apply to this vehicle" : fmt::format("only with {}", with_or(only_with)));
      });
      for_each_number([&](const SweepAxis& axis, std::size_t q) {
        const SweptQuantity& quantity = axis.quantities[q];
        const auto found = find_parameter<double>(quantity.key)->get(d);
        if (!found || *found != number_at(axis, q, 0.5)) {
          reader_.refuse(places_.keys.at(quantity.key), quantity.key, "another varied key takes its place");
        }
      });
      const auto spring = [](const std::optional<double>& x) { return x && *x > 0.0; };
      const auto place = places_.keys.find("springs");
      if (place != places_.keys.end() && variant.springs && !spring(d.spring.stiffness) &&
          !spring(d.spring.resonance)) {
        reader_.refuse(place->second, "springs",
                       "the vehicle has none to switch on; give spring.stiffness or spring.resonance "
                       "in the vehicle file, in [set] or as an axis");
      }
    }
  }

  /// Why no design with these numbers is possible, or nothing if one is: other axes at either end and in the middle.
  std::optional<ParameterError> impossible(const std::function<void(Design<double>&)>& set,
                                           std::string_view blamed) const {
    std::optional<ParameterError> reason;
    for (const SweepVariant& variant : sweep_.variants) {
      for (const double fraction : {0.0, 0.5, 1.0}) {
        Design<double> d = variant.design;
        for_each_number(
            [&](const SweepAxis& axis, std::size_t q) { axis.quantities[q].set(d, number_at(axis, q, fraction)); });
        set(d);
        if (!variant.springs) d.spring = {};
        try {
          validate(d);
          return std::nullopt;
        } catch (const ParameterError& error) {
          if (!blamed.empty() && error.key() != blamed) return std::nullopt;
          if (!reason) reason = error;
        }
      }
    }
    return reason;
  }

  void check_ranges() const {
    for_each_number([&](const SweepAxis& axis, std::size_t q) {
      const SweptQuantity& quantity = axis.quantities[q];
      if (!places_.table_lines.empty() && axis.samples) return;
      std::vector<double> tried = {number_at(axis, q, 0.0), number_at(axis, q, 1.0)};
      if (quantity.low == quantity.high) tried = quantity.values;
      for (const double x : tried) {
        const auto reason = impossible([&](Design<double>& d) { quantity.set(d, x); }, quantity.key);
        if (reason) reader_.refuse(places_.keys.at(quantity.key), quantity.key, reason->reason());
      }
    });
    for (std::size_t row = 0; row < places_.table_lines.size(); ++row) {
      const SweepAxis& axis = sweep_.axes.back();
      const auto reason = impossible(
          [&](Design<double>& d) {
            for (const SweptQuantity& q : axis.quantities) {
              if (q.set) q.set(d, q.values[row]);
            }
          },
          "");
      if (reason) throw InputError(input_.table_name, places_.table_lines[row], 1, reason->key(), reason->reason());
    }
  }

  Sweep& sweep_;
  const TomlReader& reader_;
  const SweepPlaces& places_;
  const StudyInput& input_;
  std::optional<Document> vehicle_;
};

}  // namespace

void complete_sweep(Sweep& sweep, const TomlReader& reader, const SweepPlaces& places, const StudyInput& input) {
  SweepChecks(sweep, reader, places, input).run();
}

}  // namespace wingbeat::detail
