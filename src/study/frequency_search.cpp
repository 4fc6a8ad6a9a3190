#include "wingbeat/study/frequency_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "study/voltage_trials.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

using detail::VoltageTrial;
using detail::VoltageTrials;
using Finding = SearchFinding::Kind;
using VoltagePoint = SearchFinding::VoltagePoint;

/// Widest bracket of the lowest voltage at which a vehicle flaps, relative.
constexpr double onset_width = 1e-5;
/// Widest bracket, relative, in which a frequency may be found to jump. Closer to the voltage at which an orbit ceases
/// to exist a start from rest lingers about it for longer and longer, up to seconds.
constexpr double jump_width = 1e-4;
/// Widest bracket of the voltage at which the range ends, relative.
constexpr double border_width = 1e-4;

class Search {
 public:
  Search(VoltageTrials trials, double target, Sought sought)
      : trials_(std::move(trials)), target_(target), sought_(sought) {}

  /// `unloaded` turns the motor at the wanted frequency without load. Only a load that drives the motor needs less. Of
  /// a power it is the voltage that standstill takes it at, which is less than any that flaps.
  FrequencySearch run(double unloaded, double highest) {
    const double lowest = std::min(unloaded / frequency_search_span, highest);
    double voltage = std::min(unloaded, highest);
    for (int n = 0; n < 200; ++n) {
      const VoltageTrial trial = trials_.at(voltage);
      if (trial.flaps) follow(trial);
      if (trial.flaps && std::abs(value_of(trial) / target_ - 1.0) <= trials_.closeness()) return reached(trial);
      if (trial.flaps && trial.inside && (!inside_ || trial.voltage > inside_->voltage)) inside_ = trial;
      if (trial.flaps && value_of(trial) >= target_) {
        before_high_ = high_;
        high_ = trial;
      } else if (!trial.flaps && low_flaps() && high_ && width() < jump_width * high_->voltage) {
        return jumps();  // between the orbits of either side
      } else if (trial.flaps || !low_flaps() || high_) {
        before_low_ = low_;
        low_ = trial;
      } else {
        ceiling_ = trial;  // it flaps at a lower voltage, but no longer here
      }
      if (const auto answer = decide(lowest, highest)) return *answer;
      voltage = std::clamp(next(), lowest, highest);
    }
    return too_high();
  }

 private:
  double value_of(const VoltageTrial& t) const { return sought_ == Sought::power ? t.power : t.frequency; }
  VoltagePoint point_at(const VoltageTrial& t) const { return {t.voltage, value_of(t)}; }

  /// The slope between the last two trials: a frequency is so nearly proportional to the voltage that this takes one
  /// trial more than an exact slope, at half the cost each.
  void follow(const VoltageTrial& t) {
    const double x = std::log(t.voltage), y = std::log(value_of(t));
    const double slope = (y - last_y_) / (x - last_x_);
    // A slope of more is that of a vehicle that has hardly started to flap, if it is not that of a jump past the
    // target.
    const bool one_side = (value_of(t) < target_) == (last_y_ < std::log(target_));
    const double steepest = low_flaps() && high_ && one_side ? 1e4 : 10.0;
    if (std::abs(y - last_y_) > 10.0 * trials_.accuracy() && slope > 0.1 && slope < steepest) slope_ = slope;
    last_x_ = x;
    last_y_ = y;
  }

  bool low_flaps() const { return low_ && low_->flaps; }
  double width() const { return high_->voltage - low_->voltage; }

  /// Between low_ and high_, both of which flap, the frequency jumps past the target. Where an orbit ceases to exist
  /// its frequency ends like a power of the voltage that is left, f = f_c - c (v_c - v)^p, p = 1/2 at a fold and 1/3 at
  /// a cusp. By the secant s between two voltages on its side, of which v is the farther, it then still changes by no
  /// more than s |v_c - v|/p. The target is beyond reach of either side by that with p = 1/4.
  bool jumps_between() const {
    if (!(width() < jump_width * high_->voltage)) return false;
    const auto reaches = [&](const std::optional<VoltageTrial>& far, const VoltageTrial& near, double end) {
      if (!far || !far->flaps) return true;
      const double secant = std::abs((value_of(near) - value_of(*far)) / (near.voltage - far->voltage));
      return std::abs(target_ - value_of(near)) <=
             4.0 * secant * std::abs(end - far->voltage) + 100.0 * trials_.accuracy() * target_;
    };
    return !reaches(before_low_, *low_, high_->voltage) && !reaches(before_high_, *high_, low_->voltage);
  }

  std::optional<FrequencySearch> decide(double lowest, double highest) {
    // No higher voltage is inside, so that the answer is not, wherever it is.
    if (low_flaps() && low_->beyond) return outside_domain(*low_);
    if (!high_) {
      if (low_->voltage >= highest) return low_->flaps ? too_high() : never_flaps();
      if (ceiling_ && ceiling_->voltage < 1.01 * low_->voltage) return too_high();
      return std::nullopt;
    }
    if (!low_) return high_->voltage > lowest ? std::nullopt : std::optional(too_low());
    if (!low_->flaps) return width() < onset_width * high_->voltage ? std::optional(too_low()) : std::nullopt;
    if (jumps_between()) return jumps();
    if (width() > 4e-16 * high_->voltage) return std::nullopt;
    // At the last bits of the voltage a smooth frequency is as close as its own rounding allows.
    const double gap = value_of(*high_) - value_of(*low_);
    if (gap < (10.0 * trials_.accuracy() + 2.0 * trials_.closeness()) * target_) return reached(*high_);
    return jumps();
  }

  double next() {
    if (!high_) {
      if (ceiling_) return std::sqrt(low_->voltage * ceiling_->voltage);
      return low_->flaps ? secant(*low_, 4.0) : 1.5 * low_->voltage;
    }
    if (!low_) return secant(*high_, 4.0);
    if (!low_->flaps) return 0.5 * (low_->voltage + high_->voltage);
    // The secant's step from the closer end, which the bracket bounds and halves where steps do not shrink it.
    const bool slow = width() > 0.5 * bracket_;
    bracket_ = width();
    const double middle = 0.5 * (low_->voltage + high_->voltage);
    if (slow) stuck_ = !stuck_;
    if (slow && stuck_) return middle;
    const VoltageTrial& from = target_ - value_of(*low_) < value_of(*high_) - target_ ? *low_ : *high_;
    const double guess = secant(from, 4.0);
    return guess > low_->voltage && guess < high_->voltage ? guess : middle;
  }

  /// The secant's step in the logarithms of value and voltage; somewhat further outside a bracket, so that one is
  /// found soon, and twice as far where the trial's own error counts.
  double secant(const VoltageTrial& t, double max_ratio) const {
    const double gap = std::log(target_ / value_of(t));
    double step = gap / slope_;
    if (!(low_ && high_)) step *= std::abs(gap) < 100.0 * trials_.accuracy() ? 2.0 : 1.0 + 0.1 * std::abs(step);
    return t.voltage * std::clamp(std::exp(step), 1.0 / max_ratio, max_ratio);
  }

  /// The trial flaps outside the range, no faster than wanted: how fast does it flap inside?
  FrequencySearch outside_domain(const VoltageTrial& trial) {
    SearchFinding finding = found(Finding::out_of_range);
    finding.point = point_at(trial);
    finding.limits = trial.limits;
    VoltageTrial outside = trial;
    for (int n = 0; n < 40 && !(inside_ && inside_->voltage < outside.voltage); ++n) {
      const VoltageTrial lower = trials_.at(0.7 * outside.voltage);
      if (!lower.flaps) break;
      (lower.inside ? inside_.emplace() : outside) = lower;
    }
    if (!inside_ || !(inside_->voltage < outside.voltage)) {
      return conclude(FrequencyOutcome::outside_domain, trial, finding);
    }
    // Of the limits those count that are exceeded outside: others may be touched all along.
    const auto margin = [limits = outside.excess](const VoltageTrial& t) {
      double max_excess = -1.0;
      for (std::size_t k = 0; k < limits.size(); ++k) {
        if (!(limits[k] <= 0.0)) max_excess = std::isfinite(t.excess[k]) ? std::max(max_excess, t.excess[k]) : 1.0;
      }
      return -max_excess;
    };
    VoltageTrial inside = *inside_;
    const auto margin_at = [&](double voltage) {
      const VoltageTrial t = trials_.at(voltage);
      if (!t.flaps) return -1.0;
      if (!t.inside) return std::min(margin(t), -1e-12);
      inside = t;
      return std::max(margin(t), 0.0);
    };
    find_zero(margin_at, inside.voltage, margin(inside), outside.voltage, margin(outside),
              border_width * outside.voltage);
    finding.max_point = point_at(inside);
    return conclude(FrequencyOutcome::outside_domain, inside, finding);
  }

  FrequencySearch reached(const VoltageTrial& t) {
    if (!t.inside) return outside_domain(t);
    SearchFinding finding = found(Finding::reached);
    finding.status = t.status;
    finding.evidence = t.evidence;
    return {FrequencyOutcome::reached, t.voltage, t.status, finding, trials_.count(), absent, absent};
  }
  FrequencySearch jumps() {
    SearchFinding finding = found(Finding::jumps);
    finding.point = point_at(*high_);
    finding.min_point = point_at(*low_);
    return conclude(FrequencyOutcome::jumps, *high_, finding);
  }
  FrequencySearch never_flaps() {
    SearchFinding finding = found(Finding::never_flaps);
    finding.last_voltage = low_->voltage;
    finding.status = low_->status;
    finding.evidence = low_->evidence;
    return conclude(FrequencyOutcome::never_flaps, *low_, finding);
  }
  FrequencySearch too_high() {
    SearchFinding finding = found(Finding::too_high);
    finding.last_voltage = (ceiling_ ? *ceiling_ : *low_).voltage;
    finding.max_point = point_at(*low_);
    return conclude(FrequencyOutcome::too_high, *low_, finding);
  }
  FrequencySearch too_low() {
    SearchFinding finding = found(low_ ? Finding::too_low_at_onset : Finding::too_low_at_first);
    finding.point = point_at(*high_);
    if (low_) {
      finding.status = low_->status;
      finding.evidence = low_->evidence;
    }
    FrequencySearch result = conclude(FrequencyOutcome::too_low, *high_, finding);
    if (low_) result.status = low_->status;
    return result;
  }
  SearchFinding found(Finding kind) const {
    return {.kind = kind, .sought = sought_, .target = target_, .range = trials_.range()};
  }
  FrequencySearch conclude(FrequencyOutcome outcome, const VoltageTrial& closest, const SearchFinding& finding) const {
    return {outcome,          absent,          closest.status,
            finding,          trials_.count(), closest.flaps ? closest.voltage : absent,
            value_of(closest)};
  }

  VoltageTrials trials_;
  double target_;
  Sought sought_;
  std::optional<VoltageTrial> low_;                       ///< slower than wanted, or not flapping
  std::optional<VoltageTrial> high_;                      ///< faster
  std::optional<VoltageTrial> before_low_, before_high_;  ///< what low_ and high_ were before
  std::optional<VoltageTrial> inside_;                    ///< highest voltage known to be inside the range
  std::optional<VoltageTrial> ceiling_;                   ///< not flapping, above a low_ that flaps
  double last_x_ = absent, last_y_ = absent;              ///< logarithms of the last trial's voltage and value
  double slope_ = 1.0;                                    ///< d ln value / d ln v
  double bracket_ = std::numeric_limits<double>::infinity();
  bool stuck_ = false;
};

}  // namespace

bool SearchFinding::inside_domain_only() const {
  if (range != SearchRange::domain) return false;
  switch (kind) {
    case Finding::out_of_range:
    case Finding::beyond_any_voltage: return true;
    case Finding::too_low_at_first:
    case Finding::too_low_at_onset:
    case Finding::too_high: return sought == Sought::lift;
    case Finding::reached:
    case Finding::never_flaps:
    case Finding::no_wings_in_air:
    case Finding::jumps: break;
  }
  return false;
}

double highest_frequency(const Vehicle<double>& v, SearchRange range) {
  const BladeElement<double>& w = v.wings;
  if (!drive_of(v).stroke_is_fixed || !(w.air_density > 0.0) || !(w.s2 > 0.0 || w.s3 > 0.0)) return infinity;
  const bool domain = range == SearchRange::domain;
  double velocity = infinity;  // peak of |beta'| that the range allows
  const double angle = (domain ? angle_of_attack_lowest_deg : extrapolation_angle_deg) / degrees_per_radian;
  if (w.pitch_coefficient > 0.0 && !(w.angle_of_attack_min >= angle)) velocity = stroke_speed_at(w, angle);
  if (w.s2 > 0.0 && w.s3 > 0.0) {
    velocity = std::min(velocity, (domain ? flow_speed_max : extrapolation_flow_speed) * w.s2 / w.s3);
  }
  return velocity / (4.0 * stroke_amplitude(v.transmission));
}

FrequencySearch refuse_frequency(const Vehicle<double>& vehicle, double frequency, SearchRange range) {
  FrequencySearch result;
  result.outcome = FrequencyOutcome::outside_domain;
  result.status = FlappingStatus::flapping;
  result.finding = {.kind = Finding::beyond_any_voltage,
                    .sought = Sought::frequency,
                    .target = frequency,
                    .range = range,
                    .stroke_amplitude = stroke_amplitude(vehicle.transmission),
                    .highest_frequency = highest_frequency(vehicle, range)};
  return result;
}

FrequencySearch find_voltage_for_frequency(const Vehicle<double>& vehicle, double frequency,
                                           const SteadyOptions& options, const StartUp& start_up, SearchRange range,
                                           double highest_voltage) {
  require(frequency > 0.0 && std::isfinite(frequency), "frequency", "must be > 0 and finite", "Hz", frequency);
  if (frequency > highest_frequency(vehicle, range)) return refuse_frequency(vehicle, frequency, range);
  const double unloaded = detail::unloaded_voltage(vehicle, two_pi * frequency, vehicle.motor.friction_torque);
  return Search(VoltageTrials(vehicle, options, start_up, range, false), frequency, Sought::frequency)
      .run(unloaded, std::min(unloaded * frequency_search_span, highest_voltage));
}

FrequencySearch find_voltage_for_power(const Vehicle<double>& vehicle, double power, const SteadyOptions& options,
                                       const StartUp& start_up, SearchRange range, double highest_voltage) {
  require(power > 0.0 && std::isfinite(power), "power", "must be > 0 and finite", "W", power);
  // A piezo has no resistance of its own.
  const double R = circuit_resistance(vehicle), usual = vehicle.voltage > 0.0 ? vehicle.voltage : 1.0;
  const double standing = R > 0.0 ? std::sqrt(power * R) : usual;
  double highest = frequency_search_span * std::max(standing, usual);
  if (drive_of(vehicle).rotates) {
    // Whatever starts the crank from any angle, so that a power too small to do so is known for that.
    const StaticBalance balance = static_balance(vehicle);
    const double start = (balance.stall_torque - balance.advance_min) * R / vehicle.motor.torque_constant;
    highest = std::max(highest, 10.0 * start);
  }
  return Search(VoltageTrials(vehicle, options, start_up, range, false), power, Sought::power)
      .run(standing, std::min(highest, highest_voltage));
}

}  // namespace wingbeat
