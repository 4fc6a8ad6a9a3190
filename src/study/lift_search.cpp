// The lift over the voltage is followed upwards; study/frequency_search.hpp says what is promised.
#include <algorithm>
#include <cmath>
#include <optional>

#include "study/voltage_trials.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

using detail::Hermite;
using detail::VoltageTrial;
using detail::VoltageTrials;
using Finding = SearchFinding::Kind;

SearchFinding::VoltagePoint lift_at(const VoltageTrial& t) { return {t.voltage, t.lift}; }

/// The lift coefficient is a wave in the angle of attack: between two trials the smallest angle changes by no more than
/// this share of a radian of the wave, so that no more than an eighth of it passes unseen.
constexpr double max_phase = pi / 4.0;
/// The largest change of angle between two trials for a table of coefficients, whose features are not known [deg].
constexpr double max_table_step_deg = 10.0;
/// A cubic between two trials is trusted where it misses the trial half-way by no more than this share of the lift.
constexpr double max_misfit = 0.02;
/// Intervals narrower than this, in ln v, are edges or jumps.
constexpr double narrowest = 1e-5;
/// The narrowest interval [ln v] at edges below which wings that pitch do not settle: they have no sharp place. What
/// the lift does within this of one passes unseen.
constexpr double blurred_edge = 0.02;
/// To which a cubic's zero is found, as a share of its interval.
constexpr double cubic_width = 0x1p-50;

double log_width(const VoltageTrial& a, const VoltageTrial& b) { return std::log(b.voltage / a.voltage); }

class LiftTrace {
 public:
  LiftTrace(VoltageTrials trials, double lift, const LiftSearchOptions& where)
      : trials_(std::move(trials)), target_(lift), where_(where) {
    const BladeElement<double>& w = trials_.vehicle().wings;
    const double rate = std::abs(w.coefficients.lift.rate);
    step_deg_ = w.coefficients.table || is_given(w.tabulated)
                    ? max_table_step_deg
                    : std::min(degrees_per_radian * max_phase / std::max(rate, 1e-3), 30.0);
  }

  FrequencySearch run() {
    const double guess = first_voltage();
    limit_ = std::min(highest_voltage(guess), where_.highest_voltage);
    VoltageTrial a = at(std::min(0.5 * guess, limit_));
    // Down to where no peak can lie below.
    for (int n = 0; n < 60 && a.flaps && !(a.lift < target_ && a.pitching < step_deg_); ++n) a = at(0.5 * a.voltage);
    int still = 0;
    while (a.voltage < limit_ && !(a.flaps && a.beyond) && still < 4) {
      const VoltageTrial b = at(std::min(a.voltage * std::exp(step(a)), limit_));
      if (auto answer = explore(a, b)) return *answer;
      still = b.flaps || !first_ ? 0 : still + 1;
      a = b;
    }
    return refuse(a);
  }

 private:
  using Answer = std::optional<FrequencySearch>;

  /// About the lowest voltage that could do: it turns the unloaded motor fast enough for wings at the best angle.
  double first_voltage() const {
    const Vehicle<double>& v = trials_.vehicle();
    if (!drive_of(v).rotates) return 0.2 * where_.nominal;
    double max_coefficient = 0.0;
    if (is_given(v.wings.tabulated)) {
      max_coefficient = 2.0;  // about that of any wing
    } else if (const auto& table = v.wings.coefficients.table) {
      for (const double c : table->lift()) max_coefficient = std::max(max_coefficient, std::abs(c));
    } else {
      max_coefficient = std::abs(v.wings.coefficients.lift.offset) + std::abs(v.wings.coefficients.lift.amplitude);
    }
    double slope = 0.0;
    for (int n = 0; n < 48; ++n) {
      const double theta = two_pi * n / 48.0;
      slope =
          std::max(slope, std::abs(crank_kinematics(v.transmission, std::sin(theta), std::cos(theta)).stroke_slope));
    }
    const double omega = std::sqrt(2.0 * target_ / (v.wings.air_density * v.wings.s2 * max_coefficient)) / slope;
    return detail::unloaded_voltage(v, omega, breakaway_torque(v));
  }

  /// Well above what any lift in the range takes, and what starts the crank from any angle.
  double highest_voltage(double guess) const {
    const Vehicle<double>& v = trials_.vehicle();
    double highest = std::max(frequency_search_span * guess, 10.0 * where_.nominal);
    const double fastest = highest_frequency(v, where_.range);
    if (std::isfinite(fastest)) {
      highest = std::max(highest, 10.0 * detail::unloaded_voltage(v, two_pi * fastest, breakaway_torque(v)));
    }
    if (drive_of(v).rotates) {
      const StaticBalance balance = static_balance(v);
      const double start =
          (balance.stall_torque - balance.advance_min) * circuit_resistance(v) / v.motor.torque_constant;
      highest = std::max(highest, 10.0 * start);
    }
    return highest;
  }

  VoltageTrial at(double voltage) {
    VoltageTrial t = trials_.at(voltage);
    if (!t.flaps) {
      if (!first_) below_ = t;
      return t;
    }
    if (!first_ || t.voltage < first_->voltage) first_ = t;
    if (!t.inside) return t;
    if (!max_ || t.lift > max_->lift) max_ = t;
    if (!min_ || t.lift < min_->lift) min_ = t;
    return t;
  }

  double step(const VoltageTrial& t) const {
    if (!t.flaps) return std::log(1.5);
    const double rate = t.pitching * std::max(std::abs(t.frequency_slope), 0.3);
    return std::clamp(step_deg_ / std::max(rate, 1e-9), 0.02, std::log(2.0));
  }

  /// Lift over the step from a to b; the chord's slope stands for one that is not known.
  static Hermite cubic(const VoltageTrial& a, const VoltageTrial& b) {
    const double h = log_width(a, b), chord = b.lift - a.lift;
    return {a.lift, a.exact ? h * a.lift_slope : chord, b.lift, b.exact ? h * b.lift_slope : chord};
  }

  VoltageTrial between(const VoltageTrial& a, const VoltageTrial& b, double t) {
    return at(a.voltage * std::exp(t * log_width(a, b)));
  }

  /// Everything from a to b, refined until cubics describe it.
  Answer explore(const VoltageTrial& a, const VoltageTrial& b) {
    if (!a.flaps && !b.flaps) return std::nullopt;
    if (a.flaps != b.flaps) return explore_edge(a, b);
    if (log_width(a, b) < narrowest) {
      if ((a.lift < target_) != (b.lift < target_) && !jump_low_) jump_low_ = a, jump_high_ = b;
      return std::nullopt;
    }
    const VoltageTrial m = between(a, b, 0.5);
    if (!m.flaps || !described(a, m, b)) {
      if (auto answer = explore(a, m)) return answer;
      return explore(m, b);
    }
    if (auto answer = resolve(a, m, 0)) return answer;
    return resolve(m, b, 0);
  }

  bool described(const VoltageTrial& a, const VoltageTrial& m, const VoltageTrial& b) const {
    if (std::abs(b.pitching - a.pitching) > 1.5 * step_deg_) return false;
    if (!a.exact || !m.exact || !b.exact) return true;
    const Hermite lift = cubic(a, b);
    const double size = std::max({std::abs(a.lift), std::abs(m.lift), std::abs(b.lift)});
    const double h = log_width(a, b);
    const Hermite frequency{std::log(a.frequency), h * a.frequency_slope, std::log(b.frequency), h * b.frequency_slope};
    return std::abs(lift.value(0.5) - m.lift) <= max_misfit * size &&
           std::abs(lift.slope(0.5) - h * m.lift_slope) <= 8.0 * max_misfit * size &&
           std::abs(frequency.value(0.5) - std::log(m.frequency)) <= max_misfit;
  }

  /// Where the vehicle starts to flap, or ceases to.
  Answer explore_edge(VoltageTrial a, VoltageTrial b) {
    // Below the first peak the lift only rises: where it is still small, the edge does not matter.
    if (!a.flaps && b.lift < target_ && b.lift_slope > 0.0 && b.pitching < step_deg_ && b.inside) return std::nullopt;
    const VoltageTrial low = a, high = b;
    const double width = !a.flaps && !trials_.simulates() ? blurred_edge : narrowest;
    while (log_width(a, b) > width) {
      const VoltageTrial m = between(a, b, 0.5);
      (m.flaps == a.flaps ? a : b) = m;
    }
    if (low.flaps) return low.voltage < a.voltage ? explore(low, a) : std::nullopt;
    below_ = a;
    return b.voltage < high.voltage ? explore(b, high) : std::nullopt;
  }

  /// The interval from a to b, where a cubic holds.
  Answer resolve(const VoltageTrial& a, const VoltageTrial& b, int depth) {
    if (!a.exact || !b.exact) return monotone(a, b);
    if ((a.lift_slope > 0.0) != (b.lift_slope > 0.0)) {
      const VoltageTrial s = stationary(a, b);
      if (auto answer = monotone(a, s)) return answer;
      return monotone(s, b);
    }
    // The cubic may turn twice in between.
    const Hermite lift = cubic(a, b);
    const double bend = lift.d0 + lift.d1 - 2.0 * (lift.y1 - lift.y0);  // slope(t) = d0 + ... + 3 bend t^2
    const double turn = bend != 0.0 ? -(3.0 * (lift.y1 - lift.y0) - 2.0 * lift.d0 - lift.d1) / (3.0 * bend) : -1.0;
    if (depth < 6 && turn > 0.0 && turn < 1.0 && lift.slope(turn) * lift.d0 < 0.0) {
      const VoltageTrial s = between(a, b, std::clamp(turn, 0.1, 0.9));
      if (!s.flaps) return explore(a, b);
      if (auto answer = resolve(a, s, depth + 1)) return answer;
      return resolve(s, b, depth + 1);
    }
    return monotone(a, b);
  }

  /// The peak or trough between a and b, whose slopes differ in sign.
  VoltageTrial stationary(VoltageTrial a, VoltageTrial b) {
    VoltageTrial s = a;
    for (int n = 0; n < 30; ++n) {
      const Hermite lift = cubic(a, b);
      double t = sign_change([&](double x) { return lift.slope(x); }, 0.0, 1.0, cubic_width);
      if (n % 4 == 3) t = 0.5;
      s = between(a, b, std::clamp(t, 1e-3, 1.0 - 1e-3));
      if (!s.flaps) break;
      const double size = std::max({std::abs(a.lift), std::abs(b.lift), std::abs(s.lift)});
      const double h = log_width(a, b);
      // What is left to the very top is about slope^2 over twice the curvature, which a and b bound.
      const double curvature = std::abs(b.lift_slope - a.lift_slope) / h;
      if (!s.exact) break;
      (s.lift_slope > 0.0) == (a.lift_slope > 0.0) ? a = s : b = s;
      if (s.lift_slope * s.lift_slope <= 2e-9 * size * curvature || h < 1e-7) break;
    }
    return s;
  }

  /// From a to b the lift only rises or only falls.
  Answer monotone(const VoltageTrial& a, const VoltageTrial& b) {
    if (!a.flaps || !b.flaps) return std::nullopt;
    if ((a.lift < target_) != (b.lift < target_)) {
      if (auto answer = root(a, b)) return answer;
    }
    if (a.inside != b.inside) find_border(a, b);
    return std::nullopt;
  }

  Answer root(VoltageTrial a, VoltageTrial b) {
    const auto close = [&](const VoltageTrial& t) {
      // A mean of parts that cancel is only as exact as they are.
      return std::abs(t.lift - target_) <=
             std::max(trials_.closeness() * target_, 0.1 * trials_.accuracy() * std::abs(t.lift_peak));
    };
    VoltageTrial t = std::abs(a.lift - target_) < std::abs(b.lift - target_) ? a : b;
    for (int n = 0; n < 200 && !close(t); ++n) {
      const double width = log_width(a, b);
      if (width <= 4e-16) {
        // At the last bits of the voltage a smooth lift is as close as its own rounding allows.
        const double gap = std::abs(b.lift - a.lift);
        if (gap < 10.0 * trials_.accuracy() * target_ + 2.0 * trials_.closeness() * target_) break;
        if (!jump_low_) jump_low_ = a, jump_high_ = b;
        return std::nullopt;
      }
      const Hermite lift = cubic(a, b);
      double x = sign_change([&](double s) { return lift.value(s) - target_; }, 0.0, 1.0, cubic_width);
      if (n % 4 == 3) x = 0.5;
      x = std::clamp(x, 1e-6, 1.0 - 1e-6);
      double v = a.voltage * std::exp(x * width);
      if (!(v > a.voltage && v < b.voltage)) v = 0.5 * (a.voltage + b.voltage);
      t = at(v);
      if (!t.flaps) return std::nullopt;
      (t.lift < target_) == (a.lift < target_) ? a = t : b = t;
    }
    if (!t.inside) {
      if (!outside_root_) outside_root_ = t;
      return std::nullopt;
    }
    SearchFinding finding = found(Finding::reached);
    finding.status = t.status;
    finding.evidence = t.evidence;
    return FrequencySearch{FrequencyOutcome::reached, t.voltage, t.status, finding, trials_.count(), absent, absent};
  }

  /// Where the range ends between a and b: the lift may be largest there.
  void find_border(VoltageTrial a, VoltageTrial b) {
    if (max_ && std::max(a.lift, b.lift) <= max_->lift) return;
    for (int n = 0; n < 20 && log_width(a, b) > 1e-6; ++n) {
      const double from = detail::largest_excess(a), to = detail::largest_excess(b);
      const double guess = from / (from - to);
      const bool usable = n % 3 != 2 && guess > 0.0 && guess < 1.0 && where_.range != SearchRange::extrapolation;
      const VoltageTrial m = between(a, b, usable ? std::clamp(guess, 1e-3, 1.0 - 1e-3) : 0.5);
      if (!m.flaps) return;
      (m.inside == a.inside ? a : b) = m;
    }
  }

  SearchFinding found(Finding kind) const {
    return {.kind = kind, .sought = Sought::lift, .target = target_, .range = where_.range};
  }

  FrequencySearch refuse(const VoltageTrial& last) const {
    const auto conclude = [&](FrequencyOutcome outcome, const VoltageTrial& closest, const SearchFinding& finding) {
      return FrequencySearch{outcome,     absent,          closest.status,
                             finding,     trials_.count(), closest.flaps ? closest.voltage : absent,
                             closest.lift};
    };
    if (!first_) {
      SearchFinding finding = found(Finding::never_flaps);
      finding.last_voltage = last.voltage;
      finding.status = last.status;
      finding.evidence = last.evidence;
      return conclude(FrequencyOutcome::never_flaps, last, finding);
    }
    if (!max_) {
      SearchFinding finding = found(Finding::out_of_range);
      finding.point = lift_at(*first_);
      finding.limits = first_->limits;
      return conclude(FrequencyOutcome::outside_domain, *first_, finding);
    }
    if (jump_low_) {
      SearchFinding finding = found(Finding::jumps);
      finding.point = lift_at(*jump_high_);
      finding.min_point = lift_at(*jump_low_);
      return conclude(FrequencyOutcome::jumps, *jump_high_, finding);
    }
    if (outside_root_) {
      SearchFinding finding = found(Finding::out_of_range);
      finding.point = lift_at(*outside_root_);
      finding.limits = outside_root_->limits;
      finding.min_point = lift_at(*min_);
      finding.max_point = lift_at(*max_);
      return conclude(FrequencyOutcome::outside_domain, *max_, finding);
    }
    if (min_->lift > target_ && !below_) {
      SearchFinding finding = found(Finding::too_low_at_first);
      finding.point = lift_at(*min_);
      return conclude(FrequencyOutcome::too_low, *min_, finding);
    }
    if (min_->lift > target_) {
      SearchFinding finding = found(Finding::too_low_at_onset);
      finding.point = lift_at(*first_);
      finding.status = below_->status;
      finding.evidence = below_->evidence;
      FrequencySearch result = conclude(FrequencyOutcome::too_low, *first_, finding);
      result.status = below_->status;
      return result;
    }
    SearchFinding finding = found(Finding::too_high);
    finding.max_point = lift_at(*max_);
    finding.last_voltage = last.voltage;
    if (last.beyond && where_.range != SearchRange::extrapolation) finding.limits = last.limits;
    return conclude(FrequencyOutcome::too_high, *max_, finding);
  }

  VoltageTrials trials_;
  double target_;
  LiftSearchOptions where_;
  double step_deg_;
  double limit_ = 0.0;
  std::optional<VoltageTrial> below_;         ///< highest voltage known not to flap, below all that do
  std::optional<VoltageTrial> first_;         ///< lowest voltage that flaps
  std::optional<VoltageTrial> max_, min_;     ///< lift, inside the range
  std::optional<VoltageTrial> outside_root_;  ///< has the lift, outside the range
  std::optional<VoltageTrial> jump_low_, jump_high_;
};

}  // namespace

FrequencySearch find_voltage_for_lift(const Vehicle<double>& vehicle, double lift, const SteadyOptions& options,
                                      const StartUp& start_up, const LiftSearchOptions& where) {
  require(lift > 0.0 && std::isfinite(lift), "lift", "must be > 0 and finite", "N", lift);
  require(where.nominal > 0.0 && std::isfinite(where.nominal), "voltage", "must be > 0 and finite", "V", where.nominal);
  VoltageTrials trials(vehicle, options, start_up, where.range, true);
  const BladeElement<double>& w = vehicle.wings;
  if (!(w.air_density > 0.0 && w.s2 > 0.0)) {
    const VoltageTrial t = trials.at(where.nominal);
    const FrequencyOutcome outcome = t.flaps ? FrequencyOutcome::too_high : FrequencyOutcome::never_flaps;
    const SearchFinding finding{
        .kind = Finding::no_wings_in_air, .sought = Sought::lift, .target = lift, .range = where.range};
    return {outcome, absent, t.status, finding, trials.count(), t.flaps ? t.voltage : absent, t.lift};
  }
  if (pitches(vehicle)) {
    // Wings without a spring on their hinges do not settle at low voltages, and a simulation that comes to no decision
    // takes seconds. Where they do settle the orbit search finds it, as a rule: simulations only if the lift is missed.
    const VoltageTrials orbits(vehicle, options, start_up, where.range, true, false);
    const FrequencySearch by_orbits = LiftTrace(orbits, lift, where).run();
    if (by_orbits.outcome == FrequencyOutcome::reached) return by_orbits;
  }
  return LiftTrace(std::move(trials), lift, where).run();
}

}  // namespace wingbeat
