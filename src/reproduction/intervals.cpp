#include "reproduction/intervals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reproduction/statement_answers.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"

namespace wingbeat {
namespace {

constexpr std::uint64_t sample_count = 256;

using Samples = std::vector<Metrics<double>>;

Samples solve_samples(const ToleranceStudy& study) {
  const Sweep sweep = tolerance_sweep(study);
  const std::size_t count = std::size_t(sweep.size());
  SweepColumns columns;
  columns.resize(count, study.options.metrics.count());
  SweepSolver(sweep, start_up_in_time()).solve(columns, 0, count);
  Metrics<double> none;
  none.values.fill(absent);
  Samples samples(count, none);
  std::size_t column = 0;
  for (int m = 0; m < metric_count; ++m) {
    if (!study.options.metrics[std::size_t(m)]) continue;
    for (std::size_t n = 0; n < count; ++n) samples[n][Metric(m)] = columns.metrics[column][n];
    ++column;
  }
  return samples;
}

/// The operating points that intervals are asked for, each sampled once.
class SampledPoints {
 public:
  explicit SampledPoints(const PublishedFile& file) : file_(file) {}

  std::size_t add(const Design<double>& design, std::optional<double> frequency) {
    const std::string key = fmt::format("{} at {}", write_design(design), frequency.value_or(0.0));
    const auto [entry, added] = index_.try_emplace(key, points_.size());
    if (added) points_.push_back({published_tolerance(file_, design, frequency, sample_count), {}});
    return entry->second;
  }
  std::size_t size() const { return points_.size(); }
  void solve(std::size_t n) { points_[n].samples = solve_samples(points_[n].study); }
  const Samples& samples(std::size_t n) const { return points_[n].samples; }

 private:
  struct Point {
    ToleranceStudy study;
    Samples samples;
  };
  const PublishedFile& file_;
  std::map<std::string, std::size_t> index_;
  std::vector<Point> points_;
};

Design<double> at_voltage(Design<double> design, std::optional<double> voltage) {
  design.supply.type = SupplyType::constant;
  if (voltage) design.supply = {SupplyType::constant, *voltage, 0.0, 1.0};
  return design;
}

/// A number made of the metrics of one or two operating points.
struct SoughtNumber {
  Interval* interval;
  std::vector<std::size_t> points;
  std::function<double(const Metrics<double>&, const Metrics<double>&)> number;
};

SoughtNumber sought_for(const PublishedValue& v, const PublishedFile& file, Interval& interval, SampledPoints& points) {
  SoughtNumber s{&interval, {points.add(at_voltage(file.designs.at(v.design), v.voltage), v.frequency)}, {}};
  if (v.relative_to)
    s.points.push_back(points.add(at_voltage(file.designs.at(*v.relative_to), v.voltage), v.frequency));
  s.number = [&v](const Metrics<double>& one, const Metrics<double>& other) {
    return v.relative_to ? one[v.metric] / other[v.metric] - (v.change ? 1.0 : 0.0) : one[v.metric];
  };
  return s;
}

Interval interval_of(const SoughtNumber& s, const SampledPoints& points) {
  const Samples &one = points.samples(s.points.front()), &other = points.samples(s.points.back());
  std::vector<double> values;
  for (std::size_t n = 0; n < one.size(); ++n) values.push_back(s.number(one[n], other[n]));
  return middle_95(std::move(values));
}

/// The held frequency of the published values.
std::optional<double> held_frequency(const PublishedFile& file) {
  for (const PublishedValue& v : file.values) {
    if (v.frequency) return v.frequency;
  }
  return std::nullopt;
}

/// The answer's numbers without their intervals, and the two designs behind them.
std::vector<Design<double>> answer_title(TitleAnswer& t, const PublishedFile& file, double frequency) {
  Design<double> with = at_voltage(file.designs.at(calibration_value(file).design), std::nullopt), without = with;
  without.friction = {FrictionLaw::none, 0.0};
  const RunOptions options{.tolerance = 1e-8, .frequency = frequency, .allow_extrapolation = true};
  const RunResult a = run_design(with, options), b = run_design(without, options);
  t.frequency = frequency;
  t.with = a.metrics[Metric::power_electrical];
  t.without = b.metrics[Metric::power_electrical];
  t.change = t.without / t.with - 1.0;
  t.residual_with = residual_share(a.metrics);
  t.residual_without = residual_share(b.metrics);
  t.outside = a.domain.any() || b.domain.any();
  return {with, without};
}

}  // namespace

ToleranceStudy published_tolerance(const PublishedFile& file, const Design<double>& design,
                                   std::optional<double> frequency, std::uint64_t count) {
  ToleranceStudy study;
  study.title = file.title;
  study.design = design;
  if (frequency) study.hold = Hold{Held::frequency, *frequency};
  study.options.tolerance = 1e-6;
  study.options.isa = InstructionSet::base;  // the bytes of the report do not depend on the processor
  study.options.metrics.reset(std::size_t(Metric::floquet_multiplier_max));
  study.count = count;
  study.indices = false;
  study.allow_extrapolation = true;
  for (const UncertainPublished& u : file.uncertain) {
    UncertainParameter p{design_parameter(u.key), {}, false};
    const std::optional<double> value = p.parameter.value(design);
    if (value && *value != 0.0) {
      p.distribution = {DistributionKind::normal, *value, u.relative_deviation * std::abs(*value)};
    } else {
      // Drawn all the same: every study has the same dimensions.
      p.parameter.set = [](Design<double>&, const double&) { return true; };
    }
    study.parameters.push_back(std::move(p));
  }
  return study;
}

Interval middle_95(std::vector<double> values) {
  const std::size_t all = values.size();
  std::erase_if(values, [](double x) { return !std::isfinite(x); });
  if (values.empty() || 10 * values.size() < 9 * all) return {};
  std::sort(values.begin(), values.end());
  return {percentile(values, 0.025), percentile(values, 0.975)};
}

void add_intervals(Assessment& a, std::span<const PublishedFile> files, const ForEach& for_each) {
  std::vector<SampledPoints> points;
  points.reserve(files.size());
  std::vector<std::vector<SoughtNumber>> sought(files.size());
  for (std::size_t f = 0; f < files.size(); ++f) {
    const PublishedFile& file = files[f];
    SampledPoints& p = points.emplace_back(file);
    if (const auto frequency = a.laws.empty() ? std::nullopt : held_frequency(file)) {
      TitleAnswer& t = a.answers[f];
      const auto designs = answer_title(t, file, *frequency);
      const std::size_t with = p.add(designs[0], frequency), without = p.add(designs[1], frequency);
      const auto input = [](const Metrics<double>& one, const Metrics<double>&) {
        return one[Metric::power_electrical];
      };
      const auto change = [](const Metrics<double>& one, const Metrics<double>& other) {
        return one[Metric::power_electrical] / other[Metric::power_electrical] - 1.0;
      };
      sought[f].push_back({&t.with_interval, {with}, input});
      sought[f].push_back({&t.without_interval, {without}, input});
      sought[f].push_back({&t.change_interval, {without, with}, change});
    }
    for (std::size_t n = 0; n < file.values.size(); ++n) {
      sought[f].push_back(sought_for(file.values[n], file, a.claims[n].interval[f], p));
    }
    for (std::size_t n = 0; n < file.trends.size(); ++n) {
      const PublishedTrend& t = file.trends[n];
      if (!rests_on_points(t)) continue;
      SoughtNumber s{&a.claims[file.values.size() + n].interval[f], {}, {}};
      for (const Design<double>& design : designs_of(file, t)) s.points.push_back(p.add(design, t.frequency));
      if (s.points.empty()) continue;
      s.number = [&t](const Metrics<double>& one, const Metrics<double>& other) { return number_of(t, one, other); };
      sought[f].push_back(std::move(s));
    }
  }
  if (files.empty() || files[0].uncertain.empty()) return;
  std::vector<std::function<void()>> tasks;
  for (SampledPoints& p : points) {
    for (std::size_t n = 0; n < p.size(); ++n) tasks.push_back([&p, n] { p.solve(n); });
  }
  run_tasks(tasks, for_each, {});
  a.samples = sample_count;
  for (std::size_t f = 0; f < files.size(); ++f) {
    for (const SoughtNumber& s : sought[f]) *s.interval = interval_of(s, points[f]);
  }
}

}  // namespace wingbeat
