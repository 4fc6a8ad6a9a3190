#include "wingbeat/study/drive_train.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "study/lift_peak.hpp"
#include "study/optimise_problem.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/study/ensemble_hold.hpp"
#include "wingbeat/study/sampling.hpp"
#include "wingbeat/vehicle/motion.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using Outcome = CombinationOutcome;

/// Limits of a combination that fit a mask.
constexpr std::size_t max_limits = 64;
constexpr std::size_t designs_together = 512;
constexpr double screen_tolerance = 1e-4;

/// What the screening found of one design.
struct TriedDesign {
  SweepStatus status = SweepStatus::invalid;
  DomainStatus domain;
  bool counts = false;  ///< flaps, and inside the domain unless that does not matter
  bool scalar = false;
  bool torque_known = false;
  double objective = absent, excess = absent;
  std::uint64_t beyond = 0;  ///< a bit for each limit: constraints, then torques of the gearbox
  GearTorque torque;
};

double minimised(const OptimiseStudy& study, double objective) { return study.maximise ? -objective : objective; }

bool is_flight(Metric m) { return m == Metric::hover || m == Metric::endurance; }

/// Metrics that the limits and the objective take.
MetricSet wanted_metrics(const OptimiseStudy& study) {
  MetricSet wanted;
  const auto want = [&](Metric m) { wanted.set(std::size_t(m)); };
  const auto want_named = [&](Metric m) {
    if (!is_flight(m)) return want(m);
    want(Metric::power_electrical);
    if (m == Metric::hover) want(Metric::lift_to_weight);
  };
  want_named(study.objective);
  for (const MetricConstraint& c : study.constraints) want_named(c.metric);
  return wanted;
}

/// A metric of the design; of a flight what the battery's energy allows at the power of the first moment.
double metric_of(Metric which, const Design<double>& design, const Metrics<double>& metrics) {
  if (!is_flight(which)) return metrics[which];
  const Supply<double>& supply = design.supply;
  if (!has_battery(supply.type)) return absent;
  if (which == Metric::hover && !(metrics[Metric::lift_to_weight] > 1.0 - 1e-3)) return 0.0;
  const Battery<double>& b = supply.battery;
  return b.charge * b.capacity * mean_open_circuit_voltage(b) / metrics[Metric::power_electrical];
}

/// Designs that are solved together on one thread.
class Block {
 public:
  Block(const std::function<OptimiseStudy(std::size_t)>& study, std::uint64_t designs, const ScrambledSobol& sobol,
        const StartUp& start_up)
      : study_(study), designs_(designs), sobol_(sobol), start_up_(start_up) {}

  void solve(std::vector<TriedDesign>& all, std::size_t begin, std::size_t end) {
    gather(all, begin, end);
    if (members_.empty()) return;
    options_.tolerance = screen_tolerance;
    outcomes_.resize(members_.size());
    reached_.assign(members_.size(), FrequencyOutcome::reached);
    if (holds_.empty()) {
      solve_ensemble(members_, options_, start_up_, outcomes_);
    } else {
      leave_out_what_lifts_too_little(all);
      outcomes_.resize(members_.size());
      reached_.assign(members_.size(), FrequencyOutcome::reached);
      solve_ensemble_held(members_, holds_, options_, start_up_, outcomes_, reached_);
    }
    for (std::size_t n = 0; n < members_.size(); ++n) assess(n, all[rows_[n]]);
  }

 private:
  void gather(std::vector<TriedDesign>& all, std::size_t begin, std::size_t end) {
    std::size_t combination = std::size_t(-1);
    for (std::size_t row = begin; row < end; ++row) {
      if (row / designs_ != combination) {
        combination = row / designs_;
        studies_.push_back(study_(combination));
        options_.metrics |= wanted_metrics(studies_.back());
      }
      const OptimiseStudy& study = studies_.back();
      const detail::OptimiseProblem problem(study, start_up_);
      detail::Vector u(problem.size());
      for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = sobol_(row % designs_, std::size_t(k));
      Design<double> design = problem.design(u);
      std::optional<Hold> hold = study.options.hold;
      try {
        if (hold && hold->held == Held::frequency) set_drive_frequency(design, hold->value);
        validate(design);
        if (hold) {
          hold->range = search_range(study.allow_extrapolation);
          set_full_duty(design.supply);
          hold->highest_voltage = highest_voltage(design.supply);
          holds_.push_back(*hold);
        }
      } catch (const ParameterError&) {
        all[row].status = SweepStatus::invalid;
        continue;
      }
      members_.push_back({resolve(design, study.options.condition), reporting_of(design)});
      rows_.push_back(row);
      of_study_.push_back(studies_.size() - 1);
      given_.push_back(std::move(design));
    }
  }

  /// On a battery: members that at its highest voltage lift less than is held, their lift still growing with the
  /// voltage. They need no search.
  void leave_out_what_lifts_too_little(std::vector<TriedDesign>& all) {
    if (!is_lift(holds_.front().held)) return;
    std::vector<EnsembleMember> highest;
    std::vector<std::size_t> which;
    for (std::size_t n = 0; n < members_.size(); ++n) {
      if (!std::isfinite(holds_[n].highest_voltage) || !drive_of(members_[n].vehicle).voltage_sets_frequency) continue;
      highest.push_back(members_[n]);
      set_mean_voltage(highest.back().vehicle, holds_[n].highest_voltage);
      which.push_back(n);
    }
    EnsembleOptions options;
    options.tolerance = 1e-3;
    options.domain = false;
    options.metrics.reset();
    for (const Metric m : {Metric::lift_mean, Metric::flapping_velocity_peak}) options.metrics.set(std::size_t(m));
    std::vector<EnsembleOutcome> outcomes(highest.size());
    solve_ensemble(highest, options, start_up_, outcomes);
    std::vector<bool> out(members_.size(), false);
    for (std::size_t k = 0; k < which.size(); ++k) {
      const std::size_t n = which[k];
      TriedDesign& d = all[rows_[n]];
      if (outcomes[k].status != FlappingStatus::flapping) continue;
      const Metrics<double>& m = outcomes[k].metrics;
      const double target = held_lift(holds_[n], members_[n].reporting);
      if (!(m[Metric::lift_mean] < (1.0 - 1e-2) * target)) continue;
      if (!lift_grows_up_to(members_[n].vehicle, m[Metric::flapping_velocity_peak])) continue;
      out[n] = true;
      d.status = SweepStatus::unreached;
      d.scalar = outcomes[k].scalar;
    }
    std::size_t kept = 0;
    for (std::size_t n = 0; n < members_.size(); ++n) {
      if (out[n]) continue;
      if (kept != n) {
        members_[kept] = std::move(members_[n]);
        holds_[kept] = holds_[n];
        rows_[kept] = rows_[n];
        of_study_[kept] = of_study_[n];
        given_[kept] = std::move(given_[n]);
      }
      ++kept;
    }
    members_.resize(kept);
    holds_.resize(kept);
    rows_.resize(kept);
    of_study_.resize(kept);
    given_.resize(kept);
  }

  /// Whether no slower sinusoidal stroke lifts as much.
  static bool lift_grows_up_to(const Vehicle<double>& v, double peak) {
    constexpr int strokes = 12;
    const double highest = detail::sinusoidal_lift(v.wings, peak);
    for (int n = 1; n < strokes; ++n) {
      if (!(detail::sinusoidal_lift(v.wings, peak * n / strokes) < highest)) return false;
    }
    return highest > 0.0;
  }

  void assess(std::size_t n, TriedDesign& d) {
    const OptimiseStudy& study = studies_[of_study_[n]];
    const EnsembleOutcome& out = outcomes_[n];
    const bool flaps = out.status == FlappingStatus::flapping;
    const bool unreached = flaps && reached_[n] != FrequencyOutcome::reached;
    d.status = unreached ? SweepStatus::unreached : sweep_status(out.status);
    d.scalar = out.scalar;
    if (!flaps || unreached) return;
    d.domain = out.domain;
    d.counts = study.allow_extrapolation || out.domain.none();
    d.objective = metric_of(study.objective, given_[n], out.metrics);
    d.excess = -HUGE_VAL;
    std::size_t bit = 0;
    for (const MetricConstraint& c : study.constraints) {
      const double x = metric_of(c.metric, given_[n], out.metrics), sign = c.at_least ? 1.0 : -1.0;
      const double excess = sign * (c.limit - x) / (c.limit == 0.0 ? 1.0 : std::abs(c.limit));
      mark(d, bit++, excess, is_held(study, c));
    }
    if (!std::isfinite(d.objective)) d.counts = false;
    const GearTorqueLimits& limits = study.gear_torque;
    if (!d.counts || d.beyond != 0 || !limits.any()) return;
    d.torque = torque_of(n);
    d.torque_known = std::isfinite(d.torque.rms);
    for (const double excess : excess_of(limits, d.torque)) mark(d, bit++, excess, false);
  }

  /// A lift that is held lies at its limit, to within the tolerance.
  static bool is_held(const OptimiseStudy& study, const MetricConstraint& c) {
    const std::optional<Hold>& hold = study.options.hold;
    if (!hold) return false;
    return (c.metric == Metric::lift_to_weight && hold->held == Held::lift_to_weight) ||
           (c.metric == Metric::lift_mean && hold->held == Held::lift) ||
           (c.metric == Metric::frequency && hold->held == Held::frequency);
  }

  static void mark(TriedDesign& d, std::size_t bit, double excess, bool held) {
    d.excess = std::max(d.excess, std::isnan(excess) ? HUGE_VAL : excess);
    if (!(excess <= (held ? screen_tolerance : 0.0)) && bit < max_limits) d.beyond |= std::uint64_t(1) << bit;
  }

  GearTorque torque_of(std::size_t n) const {
    SteadyOptions steady;
    steady.tolerance = 0.01 * screen_tolerance;
    steady.reporting = members_[n].reporting;
    return gear_torque(find_steady_flapping(members_[n].vehicle, steady, start_up_));
  }

  const std::function<OptimiseStudy(std::size_t)>& study_;
  std::uint64_t designs_;
  const ScrambledSobol& sobol_;
  const StartUp& start_up_;
  std::vector<OptimiseStudy> studies_;
  std::vector<EnsembleMember> members_;
  std::vector<std::size_t> rows_, of_study_;
  std::vector<Design<double>> given_;
  std::vector<Hold> holds_;
  EnsembleOptions options_ = [] {
    EnsembleOptions options;
    options.metrics.reset();
    return options;
  }();
  std::vector<EnsembleOutcome> outcomes_;
  std::vector<FrequencyOutcome> reached_;
};

/// Names of a combination's limits, as they are counted.
std::vector<std::string> counted_limits(const OptimiseStudy& study) {
  std::vector<std::string> names;
  for (const MetricConstraint& c : study.constraints) names.push_back(c.part.empty() ? name_of(c) : c.part);
  if (study.gear_torque.continuous) names.emplace_back("continuous torque of the gearbox");
  if (study.gear_torque.peak) names.emplace_back("peak torque of the gearbox");
  return names;
}

}  // namespace

DriveTrainScreen screen_drive_trains(std::size_t count, const std::function<OptimiseStudy(std::size_t)>& study,
                                     std::uint64_t designs, const StartUp& start_up, const ForEach& for_each) {
  DriveTrainScreen screen;
  screen.combinations.resize(count);
  if (count == 0) return screen;
  const OptimiseStudy first = study(0);
  if (first.parameters.empty()) designs = 1;
  const ScrambledSobol sobol(std::max<std::size_t>(1, first.parameters.size()), first.seed);
  std::vector<TriedDesign> all(count * designs);
  screen.designs = all.size();
  for_all(for_each, (all.size() + designs_together - 1) / designs_together, [&](std::size_t n) {
    Block(study, designs, sobol, start_up)
        .solve(all, n * designs_together, std::min(all.size(), (n + 1) * designs_together));
  });

  std::map<std::string, std::size_t> place;
  for (std::size_t n = 0; n < count; ++n) {
    const OptimiseStudy own = study(n);
    const std::vector<std::string> names = counted_limits(own);
    const std::size_t metrics = own.constraints.size();
    ScreenedCombination& c = screen.combinations[n];
    bool flaps = false, inside = false, torque_tried = false;
    std::uint64_t within_some = 0, alone = 0, torque_within = 0;
    const TriedDesign* best = nullptr;
    const auto rank = [&](const TriedDesign& d) {
      return std::tuple(std::max(0.0, d.excess), minimised(own, d.objective));
    };
    for (std::size_t k = n * designs; k < (n + 1) * designs; ++k) {
      const TriedDesign& d = all[k];
      ++screen.status[std::size_t(d.status)];
      screen.recomputed += d.scalar;
      if (d.status != SweepStatus::flapping) continue;
      flaps = true;
      for (std::size_t l = 0; l < screen.beyond.size() && !own.allow_extrapolation; ++l)
        screen.beyond[l] += d.domain[l];
      if (!d.counts) continue;
      inside = true;
      if (!best || rank(d) < rank(*best)) best = &d;
      if (d.beyond == 0) c.outcome = Outcome::within;
      within_some |= ~d.beyond;
      if (d.beyond != 0 && (d.beyond & (d.beyond - 1)) == 0) alone |= d.beyond;
      if (d.torque_known) {
        torque_tried = true;
        torque_within |= ~d.beyond;
      }
    }
    if (best) {
      c.objective = best->objective;
      c.excess = best->excess;
      c.torque = best->torque;
    }
    if (c.outcome != Outcome::within) {
      c.outcome = inside ? Outcome::excluded : flaps ? Outcome::outside : Outcome::does_not_flap;
    }
    ++screen.outcomes[std::size_t(c.outcome)];
    for (std::size_t l = 0; l < names.size(); ++l) {
      const auto [at, fresh] = place.try_emplace(names[l], screen.limits.size());
      if (fresh) screen.limits.push_back({names[l], 0, 0});
      if (c.outcome != Outcome::excluded || l >= max_limits) continue;
      const std::uint64_t bit = std::uint64_t(1) << l;
      // Torques are known of designs within every other limit alone.
      const bool excludes = l < metrics ? !(within_some & bit) : torque_tried && !(torque_within & bit);
      screen.limits[at->second].excluded += excludes;
      screen.limits[at->second].alone += excludes && (alone & bit);
    }
    c.hopeless = !inside || (c.outcome != Outcome::within && own.parameters.empty());
    if (!c.hopeless) screen.ranking.push_back(n);
  }
  const double sign = first.maximise ? -1.0 : 1.0;
  std::stable_sort(screen.ranking.begin(), screen.ranking.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t n) {
      const ScreenedCombination& c = screen.combinations[n];
      return std::tuple(c.outcome != Outcome::within, c.outcome == Outcome::within ? 0.0 : c.excess,
                        sign * c.objective);
    };
    return key(a) < key(b);
  });
  return screen;
}

}  // namespace wingbeat
