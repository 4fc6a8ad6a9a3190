#include "wingbeat/reproduction/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "reproduction/intervals.hpp"
#include "reproduction/searched_intervals.hpp"
#include "reproduction/statement_answers.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/study/bench_fit.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

constexpr int loss_points = 13;
constexpr double max_loss_stiffness = 1.5;  ///< of the springs of the vehicle that has them

std::string design_words(const std::string& design) {
  return design == "spring_off"  ? "without springs"
         : design == "spring_on" ? "with springs"
                                 : "of " + detail::spaced(design);
}
std::string ratio_words(const std::string& design, const std::string& other) {
  return design == "spring_on" && other == "spring_off"
             ? "with / without springs"
             : fmt::format("{} / {}", detail::spaced(design), detail::spaced(other));
}

StatementOutcome outcome_of(const Claim& c) {
  if (!c.reason.empty()) return StatementOutcome::not_checkable;
  if (c.published_text == "-") return StatementOutcome::no_published_value;
  if (c.within[0] && c.within[1]) return StatementOutcome::reproduced;
  return c.within[0] || c.within[1] ? StatementOutcome::depends_on_formulation : StatementOutcome::not_reproduced;
}

/// The two published peak lifts, without and with springs at one frequency, that S_2 and S_3 were calibrated to.
struct LiftTargets {
  SpringPair pair;
  double frequency;
  std::array<double, 2> lift_peaks;
};
std::optional<LiftTargets> lift_targets(const PublishedFile& file) {
  const PublishedValue* found[2] = {nullptr, nullptr};
  for (const PublishedValue& v : file.values) {
    if (v.metric != Metric::lift_peak || v.basis != Basis::calibrated || v.relative_to || !v.frequency) continue;
    found[resolve(file.designs.at(v.design)).spring.stiffness > 0.0 ? 1 : 0] = &v;
  }
  if (!found[0] || !found[1] || *found[0]->frequency != *found[1]->frequency) return std::nullopt;
  return LiftTargets{{file.designs.at(found[0]->design), file.designs.at(found[1]->design)},
                     *found[0]->frequency,
                     {found[0]->published, found[1]->published}};
}

PublishedFile with_formulation(PublishedFile file, Formulation formulation) {
  for (auto& [name, design] : file.designs) design.transmission.formulation = formulation;
  return file;
}

/// The rival with its one free number chosen so that the vehicle without springs has the published frequency.
LawPrediction calibrated(PublishedFile& file, std::size_t rival, std::size_t variant) {
  const PublishedValue& target = calibration_value(file);
  Design<double> design = file.designs.at(target.design);
  design.supply = {SupplyType::constant, *target.voltage, 0.0, 1.0};
  LawPrediction p;
  p.variant = variant;
  p.rival = rival;
  p.law = calibrate_friction(design, rivals[rival].law, target.published);
  if (rivals[rival].own_drag) {
    design.friction = {FrictionLaw::none, 0.0};
    p.drag_factor = calibrate_drag(design, target.published);
    p.law.calibrated = std::isfinite(p.drag_factor);
    if (p.law.calibrated) p.law.frequency = target.published;
    else p.drag_factor = 1.0;
  }
  for (auto& [name, varied] : file.designs) {
    varied.friction = {rivals[rival].law, p.law.coefficient};
    if (p.drag_factor != 1.0) varied = with_drag_factor(varied, p.drag_factor);
  }
  return p;
}

LawPrediction predict(PublishedFile file, std::size_t rival, std::size_t variant) {
  LawPrediction p = calibrated(file, rival, variant);
  const PublishedValue& target = calibration_value(file);
  double stiffness = 0.0;
  for (const auto& [name, design] : file.designs) stiffness = std::max(stiffness, resolve(design).spring.stiffness);
  p.comparison = compare(file);
  double squares = 0.0, squares_of_ratios = 0.0;
  std::optional<double> frequency;
  for (std::size_t n = 0; n < p.comparison.values.size(); ++n) {
    const ComparedValue& c = p.comparison.values[n];
    const PublishedValue& v = c.published;
    if (v.design == target.design) continue;
    if (v.frequency) frequency = v.frequency;
    if (v.basis == Basis::calibrated) {
      p.seen.push_back(n);
      continue;
    }
    p.tests.push_back(n);
    squares += std::pow(c.deviation, 2.0);
    squares_of_ratios += std::pow(v.change ? c.ratio_deviation : c.deviation, 2.0);
  }
  if (!p.tests.empty()) {
    p.rms = std::sqrt(squares / double(p.tests.size()));
    p.rms_of_ratios = std::sqrt(squares_of_ratios / double(p.tests.size()));
  }
  if (frequency && stiffness > 0.0 && variant != recalibrated) {
    p.loss =
        loss_along_stiffness(file.designs.at(target.design), *frequency, max_loss_stiffness * stiffness, loss_points);
  }
  return p;
}

/// The published change of the electrical input at a held frequency.
const PublishedValue* input_change(const PublishedFile& file) {
  for (const PublishedValue& v : file.values) {
    if (v.metric == Metric::power_electrical && v.change && v.frequency && v.relative_to) return &v;
  }
  return nullptr;
}

/// Drag of a rival, calibrated anew for each uncertain parameter, and what springs then do to the input.
void add_intervals_of_drag(LawPrediction& p, const PublishedFile& file) {
  const PublishedValue* v = input_change(file);
  if (!rivals[p.rival].own_drag || !p.law.calibrated || !v || p.variant == recalibrated) return;
  const auto numbers = [&](PublishedFile which) -> std::vector<double> {
    const LawPrediction there = calibrated(which, p.rival, p.variant);
    if (!there.law.calibrated) return {absent, absent};
    const auto input = [&](const std::string& design) {
      const RunOptions options{.tolerance = 1e-8, .frequency = v->frequency, .allow_extrapolation = true};
      return run_design(which.designs.at(design), options).metrics[Metric::power_electrical];
    };
    return {there.drag_factor, input(v->design) / input(*v->relative_to) - 1.0};
  };
  const auto intervals = propagated(file, numbers(file), numbers);
  p.drag_interval = intervals[0];
  p.input_change_interval = intervals[1];
}

Claim claim_of(const PublishedValue& v, const Assessment& a, std::size_t n) {
  const MetricInfo& info = metric_info(v.metric);
  Claim c;
  const std::string point = operating_point(v.voltage, v.frequency);
  c.statement = v.relative_to ? v.change && v.design == "spring_on"
                                    ? fmt::format("{}, change by springs at {}", info.long_name, point)
                                    : fmt::format("{}, ratio {} at {}", info.long_name,
                                                  ratio_words(v.design, *v.relative_to), point)
                              : fmt::format("{} {} at {}", info.long_name, design_words(v.design), point);
  c.where = v.where;
  c.basis = v.basis;
  c.unit = v.relative_to ? "1" : info.unit;
  c.published = v.published;
  c.published_text = v.published_text;
  c.tolerance = v.tolerance;
  c.digits = 0.5 * v.digit;
  for (std::size_t f = 0; f < a.variants; ++f) {
    const Comparison& comparison = a.comparisons[f];
    c.ours[f] = comparison.values[n].computed;
    c.ratio_deviation[f] = comparison.values[n].ratio_deviation;
    c.ours_text[f] = v.change ? fmt::format("{:+#.4g} %", 100.0 * c.ours[f]) : number_text(c.ours[f], c);
    c.residual[f] = std::abs(residual_share(comparison.run_of(v, v.design).result.metrics));
    if (v.relative_to) {
      const double other = residual_share(comparison.run_of(v, *v.relative_to).result.metrics);
      c.residual[f] = std::max(c.residual[f], std::abs(other));
    }
    if (const std::string remark = residual_remark(c.residual[f]); !remark.empty()) c.ours_text[f] += "; " + remark;
  }
  return c;
}

Claim claim_of(const PublishedTrend& t, const Assessment& a, const std::vector<Answer>& answers) {
  using Kind = PublishedTrend::Kind;
  Claim c;
  c.statement = t.statement;
  c.where = t.where;
  c.basis = t.basis;
  c.unit = t.unit;
  c.reason = t.reason;
  c.note = t.note;
  c.erratum = t.erratum;
  c.restates = t.restates;
  if (t.over == "transmission.crank_radius") c.reading = readings[t.hold_stroke ? 1 : 0];
  c.digits = (t.approximate ? 1.0 : 0.5) * t.digit;
  if (t.to > t.from && t.kind != Kind::saturates) {
    const std::string unit = t.over.empty() || t.kind == Kind::best_range ? "Hz" : design_parameter(t.over).unit;
    c.window = fmt::format("{} to {}", readable(t.from, unit), readable(t.to, unit));
  }
  c.published = t.published;
  if (t.published_end) c.published = 0.5 * (*t.published + *t.published_end);
  const bool of_numbers = t.published.has_value();
  if (of_numbers && t.bound == PublishedTrend::Bound::none) c.tolerance = t.tolerance;
  c.published_text = of_numbers ? t.published_text : "-";
  if (t.kind == Kind::difference && t.unit == "1") {
    if (const auto position = c.published_text.rfind(" %"); position != std::string::npos) {
      c.published_text.replace(position, 2, " percentage points");
    }
  }
  const bool yes_or_no = t.kind == Kind::between || t.kind == Kind::steadier || t.kind == Kind::saturates ||
                         t.kind == Kind::generally || t.kind == Kind::turns || t.kind == Kind::ordered_conditions;
  if (yes_or_no || t.kind == Kind::initial_guesses || t.kind == Kind::wording) c.published_text = "as stated";
  for (std::size_t f = 0; f < a.variants; ++f) {
    c.ours[f] = answers[f].value;
    c.ours_text[f] = answers[f].text;
    c.residual[f] = answers[f].residual;
    c.within[f] = yes_or_no && answers[f].holds;
    if (of_numbers && t.bound != PublishedTrend::Bound::none) {
      c.within[f] = t.bound == PublishedTrend::Bound::below ? c.ours[f] < *c.published : c.ours[f] > *c.published;
    }
  }
  if (t.kind == Kind::best_friction_law) {
    for (std::size_t f = 0; f < a.variants; ++f) {
      const auto first = a.laws.begin() + long(f * std::size(rivals));
      const auto best = std::min_element(first, first + long(std::size(rivals)),
                                         [](const LawPrediction& p, const LawPrediction& q) { return p.rms < q.rms; });
      c.ours_text[f] = fmt::format("{} ({:.1f} % rms)", rivals[best->rival].name, 100.0 * best->rms);
      c.within[f] = t.published_law == best->law.law && !rivals[best->rival].own_drag;
      // Of the runs that the chosen law is scored by.
      for (const Comparison::Run& run : best->comparison.runs) {
        const double share = std::abs(residual_share(run.result.metrics));
        if (std::isfinite(share)) c.residual[f] = std::isfinite(c.residual[f]) ? std::max(c.residual[f], share) : share;
      }
    }
    c.published_text = t.published_law ? name_of(*t.published_law) : "-";
  }
  return c;
}

/// Deviations, and what is within the tolerance.
void settle(Claim& c) {
  const bool compared = c.published && std::isfinite(c.tolerance) && c.reason.empty();
  for (std::size_t f = 0; f < variant_count; ++f) {
    c.outside[f] = c.residual[f] > formulation_residual_max;
    if (!compared || !std::isfinite(c.ours[f])) continue;
    c.deviation[f] = c.ours[f] / *c.published - 1.0;
    c.within[f] = std::abs(c.deviation[f]) <= c.tolerance;
  }
  c.outcome = outcome_of(c);
}

}  // namespace

const char* name_of(StatementOutcome outcome) {
  constexpr const char* names[] = {"reproduced", "not reproduced", "depends on the formulation", "not checkable",
                                   "no published value"};
  return names[std::size_t(outcome)];
}

const char* variant_name(std::size_t variant) {
  constexpr const char* names[variant_count] = {"rod-force", "virtual-work", "virtual-work, own calibration"};
  return names[variant];
}

bool Claim::counted() const {
  return basis == Basis::predicted && !restates && outcome != StatementOutcome::not_checkable &&
         outcome != StatementOutcome::no_published_value;
}

int Assessment::count(StatementOutcome outcome) const {
  return int(std::count_if(claims.begin(), claims.end(), [&](const Claim& c) { return c.outcome == outcome; }));
}

bool Claim::met(std::size_t variant, Scoring scoring, double accepted) const {
  if (!std::isfinite(deviation[variant])) return within[variant];
  if (scoring == Scoring::digits) return std::abs(ours[variant] - *published) <= digits * (1.0 + 1e-9);
  const bool as_ratio = scoring == Scoring::ratios && std::isfinite(ratio_deviation[variant]);
  return std::abs(as_ratio ? ratio_deviation[variant] : deviation[variant]) <= accepted;
}

Score Assessment::score(const std::string& reading, Scoring scoring, std::optional<double> tolerance) const {
  Score s;
  double squares = 0.0;
  int radii = 0;
  for (const Claim& c : claims) {
    if (!c.counted() || c.reading != reading) continue;
    ++s.statements;
    std::array<bool, variant_count> within{};
    for (std::size_t f = 0; f < variants; ++f) {
      within[f] = c.met(f, scoring, tolerance.value_or(c.tolerance));
      s.met[f] += within[f];
    }
    (within[0] && within[1] ? s.reproduced : within[0] || within[1] ? s.depends : s.not_reproduced) += 1;
    if (c.unit == "m" && std::isfinite(c.deviation[0])) {
      squares += c.deviation[0] * c.deviation[0];
      ++radii;
    }
  }
  if (radii > 0) s.rms_crank_radius = std::sqrt(squares / radii);
  return s;
}

double Assessment::rms_of_predicted_values(std::size_t variant, Scoring scoring) const {
  double squares = 0.0;
  int count = 0;
  for (const ComparedValue& v : comparisons[variant].values) {
    if (v.published.basis != Basis::predicted) continue;
    const double off = scoring == Scoring::ratios && v.published.change ? v.ratio_deviation : v.deviation;
    squares += off * off;
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : absent;
}

const PublishedValue& calibration_value(const PublishedFile& file) {
  for (const PublishedValue& v : file.values) {
    if (v.metric == Metric::frequency && v.voltage && !v.relative_to) return v;
  }
  throw std::runtime_error("the published values hold no flapping frequency at a voltage to calibrate friction to");
}

Assessment assess(const PublishedFile& file, const ForEach& for_each, const std::function<void(double)>& done) {
  Assessment a;
  std::array<PublishedFile, variant_count> files;
  for (std::size_t f = 0; f < 2; ++f) files[f] = with_formulation(file, both_formulations[f]);
  if (const auto targets = lift_targets(file)) {
    a.calibrations.resize(2);
    for_each(2, [&](std::size_t f) {
      a.calibrations[f] =
          calibrate_moments(targets->pair, both_formulations[f], targets->frequency, targets->lift_peaks);
    });
    if (std::isfinite(a.calibrations[1].s3)) {
      files[recalibrated] = file;
      for (auto& [name, design] : files[recalibrated].designs) design = with_moments(design, a.calibrations[1]);
      a.variants = variant_count;
    }
  }
  const std::size_t trends = file.trends.size();
  std::vector<std::vector<Answer>> answers(trends, std::vector<Answer>(variant_count));
  std::vector<std::array<Interval, variant_count>> searched(trends);
  const bool laws_wanted = std::any_of(file.trends.begin(), file.trends.end(), [](const PublishedTrend& t) {
    return t.kind == PublishedTrend::Kind::best_friction_law;
  });
  SolvedPoints points;
  std::vector<std::function<void()>> tasks;
  for (std::size_t f = 0; f < a.variants; ++f) {
    tasks.push_back([&, f] { a.comparisons[f] = compare(files[f]); });
    for (std::size_t t = 0; t < trends; ++t) {
      tasks.push_back([&, f, t] {
        answers[t][f] = answer_to(files[f], file.trends[t], points);
        if (rests_on_points(file.trends[t])) return;
        searched[t][f] = searched_interval(files[f], file.trends[t], answers[t][f], points);
      });
    }
  }
  if (laws_wanted) {
    constexpr std::size_t count = std::size(rivals);
    a.laws.resize(a.variants * count);
    for (std::size_t n = 0; n < a.laws.size(); ++n) {
      tasks.push_back([&, n] {
        a.laws[n] = predict(files[n / count], n % count, n / count);
        add_intervals_of_drag(a.laws[n], files[n / count]);
      });
    }
  }
  run_tasks(tasks, for_each, done);

  for (std::size_t n = 0; n < file.values.size(); ++n) a.claims.push_back(claim_of(file.values[n], a, n));
  for (std::size_t n = 0; n < trends; ++n) {
    a.claims.push_back(claim_of(file.trends[n], a, answers[n]));
    if (rests_on_points(file.trends[n])) continue;
    a.claims.back().interval = searched[n];
    a.claims.back().searched = true;
  }
  for (Claim& c : a.claims) settle(c);
  add_intervals(a, std::span<const PublishedFile>(files.data(), a.variants), for_each);
  return a;
}

}  // namespace wingbeat
