#include "wingbeat/study/sweep.hpp"

#include <algorithm>
#include <cmath>

#include "study/ensemble_pitch.hpp"
#include "study/pitch_search.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/study/ensemble_hold.hpp"

namespace wingbeat {
namespace {

/// Sets the numbers of one place along each axis; gives what is held.
std::optional<Hold> set_numbers(const Sweep& sweep, std::span<const std::uint64_t> place, SweepVariant& variant) {
  std::optional<Hold> hold = sweep.hold;
  if (hold) hold->range = search_range(sweep.allow_extrapolation);
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const SweepAxis& axis = sweep.axes[a];
    for (std::size_t q = 0; q < axis.quantities.size(); ++q) {
      const SweptQuantity& quantity = axis.quantities[q];
      if (quantity.kind == SweptQuantity::Kind::number) quantity.set(variant.design, axis.value(q, place[a]));
      if (quantity.kind == SweptQuantity::Kind::held) hold->value = axis.value(q, place[a]);
    }
  }
  if (!variant.springs) variant.design.spring = {};
  if (hold && hold->held == Held::frequency) set_drive_frequency(variant.design, hold->value);
  if (hold) {
    set_full_duty(variant.design.supply);
    hold->highest_voltage = highest_voltage(variant.design.supply);
  }
  return hold;
}

std::size_t variant_at(const Sweep& sweep, std::span<const std::uint64_t> place) {
  if (!sweep.drawn_variants.empty()) return sweep.drawn_variants[std::size_t(place.back())];
  std::uint64_t variant = 0;
  for (std::size_t a = 0; a < place.size(); ++a) variant += sweep.variant_stride[a] * place[a];
  return std::size_t(variant);
}

void next(const Sweep& sweep, std::span<std::uint64_t> place) {
  for (std::size_t a = place.size(); a-- > 0;) {
    if (++place[a] < sweep.axes[a].count) return;
    place[a] = 0;
  }
}

static_assert(domain_limit_count <= 15, "bits of a column's whole numbers");

}  // namespace

double SweepAxis::value(std::size_t quantity, std::uint64_t place) const {
  const SweptQuantity& q = quantities[quantity];
  if (!q.values.empty()) return q.values[place];
  const double u = sobol ? (*sobol)(place, quantity) : (*latin_hypercube)(place, quantity);
  if (q.logarithmic) return std::clamp(q.low * std::exp(u * std::log(q.high / q.low)), q.low, q.high);
  return std::clamp(q.low + u * (q.high - q.low), q.low, q.high);
}

std::uint64_t Sweep::size() const {
  std::uint64_t product = 1;
  for (const SweepAxis& axis : axes) product *= axis.count;
  return product;
}

std::vector<std::uint64_t> places(const Sweep& sweep, std::uint64_t index) {
  std::vector<std::uint64_t> place(sweep.axes.size());
  for (std::size_t a = place.size(); a-- > 0;) {
    place[a] = index % sweep.axes[a].count;
    index /= sweep.axes[a].count;
  }
  return place;
}

const char* name_of(SweepStatus status) {
  switch (status) {
    case SweepStatus::unreached: return "unreached";
    case SweepStatus::invalid: return "invalid";
    case SweepStatus::undecided: return name_of(FlappingStatus::undecided);
    default: return name_of(FlappingStatus(int(status)));
  }
}

SweepStatus sweep_status(FlappingStatus status) {
  static_assert(int(SweepStatus::jammed) == int(FlappingStatus::jammed));
  return status == FlappingStatus::undecided ? SweepStatus::undecided : SweepStatus(int(status));
}

SweepDesign design_at(const Sweep& sweep, std::uint64_t index) {
  const auto place = places(sweep, index);
  SweepVariant variant = sweep.variants[variant_at(sweep, place)];
  const std::optional<Hold> hold = set_numbers(sweep, place, variant);
  return {variant.design, variant.condition, hold};
}

void SweepColumns::resize(std::size_t designs, std::size_t metrics_kept) {
  status.resize(designs);
  recomputed.resize(designs);
  domain.resize(designs);
  error_estimate.resize(designs);
  metrics.resize(metrics_kept);
  for (auto& column : metrics) column.resize(designs);
}

SweepSolver::SweepSolver(const Sweep& sweep, StartUp start_up)
    : sweep_(sweep), start_up_(std::move(start_up)), variants_(sweep.variants) {
  for (int m = 0; m < metric_count; ++m) {
    if (sweep.options.metrics[std::size_t(m)]) kept_.push_back(m);
  }
  members_.reserve(sweep_block);
  rows_.reserve(sweep_block);
  holds_.reserve(sweep_block);
}

void SweepSolver::gather(SweepColumns& columns, std::size_t begin, std::size_t end) {
  members_.clear();
  rows_.clear();
  holds_.clear();
  angles_.clear();
  auto place = places(sweep_, columns.first + begin);
  for (std::size_t row = begin; row < end; ++row, next(sweep_, place)) {
    SweepVariant& variant = variants_[variant_at(sweep_, place)];
    const std::optional<Hold> hold = set_numbers(sweep_, place, variant);
    try {
      validate(variant.design);
    } catch (const ParameterError&) {
      columns.status[row] = std::int8_t(SweepStatus::invalid);
      continue;
    }
    const bool at_angle = needs_pitch_coefficient(variant.design, variant.condition);
    members_.push_back({at_angle ? resolve(with_any_pitch_coefficient(variant.design), variant.condition)
                                 : resolve(variant.design, variant.condition),
                        reporting_of(variant.design)});
    angles_.push_back(at_angle ? *variant.design.aerodynamics.angle_of_attack : absent);
    rows_.push_back(row);
    if (hold) holds_.push_back(*hold);
  }
}

void SweepSolver::solve(SweepColumns& columns, std::size_t begin, std::size_t end) {
  gather(columns, begin, end);
  for (std::size_t row = begin; row < end; ++row) {
    columns.recomputed[row] = columns.domain[row] = 0;
    columns.error_estimate[row] = absent;
    for (auto& column : columns.metrics) column[row] = absent;
  }
  outcomes_.resize(members_.size());
  reached_.assign(members_.size(), FrequencyOutcome::reached);
  if (std::any_of(angles_.begin(), angles_.end(), [](double angle) { return std::isfinite(angle); })) {
    detail::solve_ensemble_at_angles(members_, angles_, holds_, sweep_.options, start_up_, outcomes_, reached_);
  } else if (sweep_.hold) {
    solve_ensemble_held(members_, holds_, sweep_.options, start_up_, outcomes_, reached_);
  } else {
    solve_ensemble(members_, sweep_.options, start_up_, outcomes_);
  }
  for (std::size_t n = 0; n < members_.size(); ++n) {
    const std::size_t row = rows_[n];
    const EnsembleOutcome& out = outcomes_[n];
    const bool flaps = out.status == FlappingStatus::flapping;
    const bool unreached = flaps && reached_[n] != FrequencyOutcome::reached;
    columns.status[row] = std::int8_t(unreached ? SweepStatus::unreached : sweep_status(out.status));
    columns.recomputed[row] = out.scalar ? 1 : 0;
    if (!flaps || unreached) continue;
    columns.domain[row] = std::int16_t(out.domain.to_ulong());
    columns.error_estimate[row] = out.error_estimate;
    for (std::size_t m = 0; m < kept_.size(); ++m) {
      columns.metrics[m][row] = out.metrics.values[std::size_t(kept_[m])];
    }
    fly(columns, row, members_[n].vehicle);
  }
}

/// The metrics of a whole flight, where the sweep selects them.
void SweepSolver::fly(SweepColumns& columns, std::size_t row, const Vehicle<double>& found) const {
  const FlightMetrics wanted = flight_metrics(sweep_.options.metrics, sweep_.allow_extrapolation);
  if (!wanted.any()) return;
  SweepDesign point = design_at(sweep_, columns.first + row);
  if (!has_battery(point.design.supply.type)) return;
  if (sweep_.hold) set_voltage(point.design.supply, found.voltage);
  if (needs_pitch_coefficient(point.design, point.condition)) {
    point.design = detail::with_pitch_coefficient(point.design, found.wings.pitch_coefficient);
  }
  const Endurance flight = endurance_of(point.design, point.condition, sweep_.options.tolerance, {}, wanted);
  for (std::size_t m = 0; m < kept_.size(); ++m) {
    if (Metric(kept_[m]) == Metric::hover) columns.metrics[m][row] = flight.hover;
    if (Metric(kept_[m]) == Metric::endurance) columns.metrics[m][row] = flight.time;
  }
}

}  // namespace wingbeat
