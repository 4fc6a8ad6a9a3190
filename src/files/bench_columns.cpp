#include "files/bench_columns.hpp"

#include <utility>

namespace wingbeat::detail {
namespace {

/// Names that benches give to what the program calls otherwise; only with a unit of the quantity itself.
constexpr ColumnAlias aliases[] = {{"u", "voltage"},
                                   {"supply_voltage", "voltage"},
                                   {"f", "frequency"},
                                   {"freq", "frequency"},
                                   {"flapping_frequency", "frequency"},
                                   {"flap_frequency", "frequency"},
                                   {"i", "current_mean"},
                                   {"current", "current_mean"},
                                   {"mean_current", "current_mean"},
                                   {"average_current", "current_mean"},
                                   {"rms_current", "current_rms"},
                                   {"lift", "lift_mean"},
                                   {"mean_lift", "lift_mean"},
                                   {"average_lift", "lift_mean"},
                                   {"thrust", "lift_mean"},
                                   {"mean_thrust", "lift_mean"},
                                   {"power", "power_electrical"},
                                   {"electrical_power", "power_electrical"},
                                   {"input_power", "power_electrical"},
                                   {"stroke", "stroke_amplitude"},
                                   {"angle", "crank_angle"},
                                   {"t", "time"},
                                   {"i", "current"},
                                   {"u", "voltage"},
                                   {"supply_voltage", "voltage"},
                                   {"stroke", "stroke_angle"},
                                   {"pitch", "pitch_angle"},
                                   {"force", "balance_force"},
                                   {"thrust", "balance_force"},
                                   {"balance", "balance_force"}};

std::vector<const NamedColumn*> listed(std::span<const ColumnName> known) {
  std::vector<const NamedColumn*> list;
  for (const ColumnName& c : known) list.push_back(&c);
  return list;
}

RecognisedColumn of_bench(RecognisedHeader found) {
  return {static_cast<const ColumnName*>(found.column), found.factor, std::move(found.unit), found.renamed,
          std::move(found.complaint)};
}

}  // namespace

const ColumnName* column_named(std::string_view name, std::span<const ColumnName> known) {
  return static_cast<const ColumnName*>(find_column(name, listed(known), aliases));
}

RecognisedColumn recognise(std::string_view header, std::span<const ColumnName> known) {
  return of_bench(recognise_header(header, listed(known), aliases));
}

RecognisedColumn recognise_stated(std::string_view name, std::string_view header, std::span<const ColumnName> known) {
  return of_bench(recognise_stated(name, header, listed(known), aliases));
}

const std::vector<ColumnName>& metric_columns() {
  static const std::vector<ColumnName> columns = [] {
    std::vector<ColumnName> all;
    for (int m = 0; m < metric_count; ++m) {
      const MetricInfo& info = metric_info(Metric(m));
      const Metric metric = Metric(m);
      const bool negative = metric == Metric::lift_mean || metric == Metric::lift_peak ||
                            metric == Metric::power_residual || metric == Metric::angle_of_attack_min ||
                            metric == Metric::power_aerodynamic || metric == Metric::lift_to_weight ||
                            lacking_of_heat(metric, {}) != nullptr;
      all.push_back({{base_name(info.key), info.key, info.unit}, {false, metric, {}}, negative});
    }
    return all;
  }();
  return columns;
}

const std::vector<ColumnName>& waveform_quantities() {
  static const std::vector<ColumnName> columns = [] {
    std::vector<ColumnName> all;
    for (int q = 0; q < waveform_quantity_count; ++q) {
      const auto quantity = WaveformQuantity(q);
      all.push_back({{name_of(quantity), name_of(quantity), unit_of(quantity)}, {true, {}, quantity}, true});
    }
    return all;
  }();
  return columns;
}

const std::vector<ColumnName>& waveform_columns() {
  static const std::vector<ColumnName> columns = [] {
    std::vector<ColumnName> all = waveform_quantities();
    for (const char* place : {"crank_angle", "phase"}) {
      all.push_back({{place, place, "rad"}, {}, true, ColumnName::Part::place});
    }
    for (const ColumnName& c : waveform_quantities()) {
      for (const char* suffix : {"_std", "_sd", "_scatter"}) {
        all.push_back({{c.name + suffix, c.name + suffix, c.unit}, c.quantity, false, ColumnName::Part::scatter});
      }
    }
    return all;
  }();
  return columns;
}

const std::vector<ColumnName>& record_columns() {
  static const std::vector<ColumnName> columns = [] {
    std::vector<ColumnName> all = waveform_quantities();
    all.push_back({{"time", "time", "s"}, {}, true, ColumnName::Part::place});
    all.push_back({{"burst", "burst", "1"}, {}, true, ColumnName::Part::burst});
    return all;
  }();
  return columns;
}

}  // namespace wingbeat::detail
