#include "time/direct_start_up.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wingbeat/cycle/integrals_audit.hpp"

namespace wingbeat::detail {
namespace {

constexpr double farthest_skip = 1.0;  // of the state or its typical size
constexpr int max_failed_skips = 4;
constexpr double nearly_settled = 1e-4;  // off the orbit, where the steps allowed end before the tolerance is reached
constexpr std::size_t window = 16;       // periods over which changes are compared before any is skipped
constexpr int contraction_periods = 4;   // over which the contraction is taken: complex multipliers make it uneven

}  // namespace

double DirectStartUp::piece_end(const TimeModel&, double stop) {
  // Soon after it has come to rest the shaft is looked at: it may stand for good.
  constexpr double soon = 1.0 / 512.0;
  const bool stood = std::exchange(stands_, now_.stuck);
  if (!now_.stuck || stood) return stop;
  return std::min(stop, now_.t + soon * period_);
}

void DirectStartUp::step_taken(Integrator& steps, double from) {
  swing_ = std::max(swing_, std::abs(bent()));
  travel_[now_.moving.angle > stroke_before_] += std::abs(now_.moving.angle - stroke_before_);
  stroke_before_ = now_.moving.angle;
  recorder_.note_current(now_.t, std::abs(now_.moving.current));
  if (!model_.measuring) return;
  track_extremes(steps, from, 4);
  take_rows(steps, period_ * result_.cycles, period_, 0.0, 1e-12);
}

/// The decision that it flaps, with the metrics taken: how far periods are from the orbit, and from each other.
void DirectStartUp::settle(double closure, double change) {
  decide(FlappingStatus::flapping);
  result_.closure = closure;
  std::size_t first = swings_.size();
  while (first > 0 && std::abs(swings_[first - 1] / swings_.back() - 1.0) <= 1e-2) --first;
  result_.time_to_steady = (double(first) + periods_skipped(first)) * period_;
  result_.state = now_.moving;
  result_.crank_speed = now_.moving.speed;
  result_.current = now_.moving.current;
  result_.evidence = {.kind = Evidence::settled_periods,
                      .frequency = model_.vehicle.drive_frequency,
                      .time = result_.time_to_steady,
                      .change = change,
                      .cycles = result_.cycles,
                      .extrapolated = skipped_from_ > 0};
  if (pitches(model_.vehicle)) pitching_.add_to(result_.evidence, model_);
}

/// Of swings that are steady from period `first` on: how many periods a skip just before has left out in which they
/// would not have been, had they gone on as the recurrence says by which it skipped.
double DirectStartUp::periods_skipped(std::size_t first) const {
  constexpr std::size_t max_periods = 20000;
  const std::size_t modes = recurrence_.size();
  if (skipped_from_ <= modes || first + 1 < skipped_from_) return 0.0;
  std::vector<double> away;  // from the last swing, relative
  for (std::size_t n = skipped_from_ - modes; n < skipped_from_; ++n) away.push_back(swings_[n] / swings_.back() - 1.0);
  std::size_t last = 0;
  for (std::size_t n = modes; n < max_periods; ++n) {
    double next = 0.0;
    for (std::size_t i = 0; i < modes; ++i) next -= recurrence_[i] * away[n - modes + i];
    away.push_back(next);
    if (std::abs(next) > 1e-2) last = n + 1 - modes;
  }
  return std::max(0.0, double(skipped_from_ + last) - double(first));
}

/// Without springs nothing returns the shaft to any angle.
bool DirectStartUp::shaft_returns() const {
  return model_.vehicle.spring.stiffness > 0.0 || is_given(model_.vehicle.piezo);
}

std::vector<double> DirectStartUp::scaled_state() const {
  const std::array<double, max_unknowns> y = model_.coordinates_now(), scale = model_.typical();
  std::vector<double> x(model_.indices.count);
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = y[n] / scale[n];
  return x;
}

/// The share of a change that the next period has, where changes become smaller from window to window; else 1.
double DirectStartUp::lasting_rate() const {
  if (changes_.size() < 3 * window) return 1.0;
  double largest[3];
  for (std::size_t back = 0; back < 3; ++back) {
    const auto end = changes_.end() - std::ptrdiff_t(back * window);
    largest[back] = *std::max_element(end - std::ptrdiff_t(window), end);
  }
  if (!(largest[0] < largest[1] && largest[1] < largest[2])) return 1.0;
  return std::pow(largest[0] / largest[2], 1.0 / double(2 * window));
}

/// Continues from where periods settle, where they have approached that linearly for long enough: a wing that little
/// damps takes thousands of them.
void DirectStartUp::skip_ahead(double change) {
  const Vehicle<double>& v = model_.vehicle;
  const bool held = now_.held && !is_clamped(v.pitch.hinge);
  const bool free = !now_.stuck && !held && shaft_returns() && !options_.record;
  if (!free || skips_fail_) return limit_.clear();
  limit_.add(scaled_state());
  const std::size_t since = changes_.size() - skipped_at_;
  const bool again = skipped_at_ > 0;
  const double rate = since < 3 * window ? 1.0 : lasting_rate();
  if (!again && !(rate < 1.0)) return;
  const auto there = limit_.limit();
  if (!there) return;
  const std::vector<double> here = scaled_state();
  double way = 0.0, size = 1.0;
  for (std::size_t n = 0; n < here.size(); ++n) {
    way = std::max(way, std::abs(there->state[n] - here[n]));
    size = std::max(size, std::abs(here[n]));
  }
  // Beyond what the changes so far would add up to, they are not understood.
  const double summed = rate < 1.0 ? std::min(farthest_skip * size, 3.0 * change / (1.0 - rate)) : 0.0;
  if (!(way < std::max(summed, again ? 0.5 * last_way_ : 0.0))) return;

  before_skip_ = now_;
  change_before_skip_ = change;
  last_way_ = way;
  skipped_at_ = changes_.size();
  if (!again) {
    skipped_from_ = swings_.size();
    first_skip_ = skipped_at_;
    recurrence_ = there->recurrence;
  }
  std::array<double, max_unknowns> y = model_.coordinates_now();
  const std::array<double, max_unknowns> scale = model_.typical();
  for (std::size_t n = 0; n < here.size(); ++n) y[n] = there->state[n] * scale[n];
  const PitchHinge<double>& hinge = v.pitch.hinge;
  model_.TimeModel::set(now_.t, y.data());  // no integrals behind them
  if (model_.indices.pitching) {
    now_.moving.pitch_angle = std::clamp(now_.moving.pitch_angle, hinge.stop_low, hinge.stop_high);
  }
  before_ = model_.coordinates_now();
  swing_ = std::abs(bent());
  limit_.clear();
}

/// True where the first period after a skip did not change far less than the one before it: back to before it, for good
/// where that was the first.
bool DirectStartUp::skip_failed(double change) {
  if (skipped_at_ == 0 || changes_.size() != skipped_at_ + 1 || change < 0.1 * change_before_skip_) return false;
  const double t = now_.t, loss = now_.impact_loss;
  const CycleIntegrals<double> impulses = now_.impulses;
  now_ = before_skip_;
  now_.t = t, now_.impact_loss = loss, now_.impulses = impulses;
  before_ = model_.coordinates_now();
  changes_.back() = change_before_skip_;
  swing_ = std::abs(bent());
  skips_fail_ = skipped_at_ == first_skip_ || ++failed_skips_ == max_failed_skips;
  if (skipped_at_ == first_skip_) skipped_from_ = 0;
  limit_.clear();
  return true;
}

void DirectStartUp::period_done() {
  ++result_.cycles;
  cycle_begins();
  event(Kind::revolution);
  swings_.push_back(swing_);
  swing_ = std::abs(bent());
  if (rests_for_good() || creeps_to_rest()) return;

  const auto scale = model_.typical();
  const std::array<double, max_unknowns> y = model_.coordinates_now();
  double change = 0.0;
  for (std::size_t n = 0; n < model_.indices.count; ++n) {
    if (n == 0 && !shaft_returns()) continue;
    change = std::max(change, std::abs(y[n] - before_[n]) / scale[n]);
  }
  before_ = y;
  changes_.push_back(change);
  if (skip_failed(change)) {
    if (model_.measuring) begin_measuring();
    return;
  }
  const std::size_t n = changes_.size(), known = n - skipped_at_;
  double rate = 1.0;
  if (known > contraction_periods + 1) {
    const auto over = [&](std::size_t periods) {
      return std::pow(change / changes_[n - 1 - periods], 1.0 / double(periods));
    };
    rate = std::max(over(contraction_periods), over(contraction_periods - 1));
  }
  const double noise = 100.0 * relative_tolerance_;
  const double off = rate < 1.0 ? change / (1.0 - rate) : infinity;
  const bool close = off < 0.1 * options_.tolerance;
  last_off_ = change / (1.0 - std::min(rate, 0.999));  // no rate can be measured once only rounding is left
  if (model_.measuring) {
    // The metrics of a period of looser steps tell how far its own steps leave them off.
    const std::optional<Metrics<double>> before = std::exchange(last_metrics_, std::nullopt);
    take_metrics(now_.t - period_, now_.t, 1);
    const bool tightest = relative_tolerance_ <= tightest_;
    const double apart = before ? metrics_apart(*before, *result_.metrics) : infinity;
    last_apart_ = std::max(last_off_, apart);
    const bool agree =
        before && (tightest || relative_tolerance_ < 0.2 * measured_with_) && apart < 0.3 * options_.tolerance;
    periods_at_tightest_ += tightest && change < 10.0 * noise;
    const EnergyAudit audit = energy_audit(*result_.metrics);
    const bool balances = closes(audit, options_.tolerance, 0.0, blocked_input(model_.vehicle));
    const bool settled = ((close || change < noise) && agree) || periods_at_tightest_ > 40;
    if (settled && !balances && tightest) return give_up_open_balance(audit);
    if (settled && balances) {
      if (now_.stuck && last_travel_ == 0.0) {
        const StandingTorques<double> torques = model_.standing_torques(now_.moving.angle);
        return decide_held(largest_torque(torques.middle()), torques.friction());
      }
      settle(std::min(off, change / (1.0 - std::min(rate, 0.999))), change);
      return;
    }
    last_metrics_ = std::exchange(result_.metrics, std::nullopt);
    measured_with_ = relative_tolerance_;
    if (close || change < noise) relative_tolerance_ = std::max(tightest_, relative_tolerance_ / 10.0);
  }
  if (rate < 1.0 && off < 1e-2) {
    // What a period's errors leave behind adds up over 1 / (1 - rate) periods; it need not be less than what is to
    // fade.
    const double left = std::max(3e-3 * options_.tolerance, 1e-2 * off);
    relative_tolerance_ = std::min(relative_tolerance_, std::max(tightest_, left * (1.0 - rate)));
  }
  if (!close) skip_ahead(change);
  if (close || change < noise || model_.measuring) begin_measuring();
  if (result_.cycles >= options_.max_cycles || never_repeats()) {
    give_up({.kind = Evidence::cycles_differ, .change = change, .cycles = result_.cycles});
  }
}

bool DirectStartUp::out_of_budget() {
  const auto as_good_as_steps_allow = [&] {
    return last_metrics_ && last_off_ < nearly_settled &&
           closes(energy_audit(*last_metrics_), std::max(options_.tolerance, last_apart_));
  };
  if (result_.steps >= options_.max_steps && as_good_as_steps_allow()) {
    // That it flaps is beyond doubt, its metrics are as good as the steps allowed make them.
    result_.metrics = last_metrics_;
    settle(last_off_, changes_.back());
    result_.evidence.accuracy = last_apart_;
    result_.evidence.steps = options_.max_steps;
  } else if (!steps_spent() && options_.max_time > 0.0 && now_.t >= options_.max_time) {
    give_up({.kind = Evidence::out_of_time, .time = options_.max_time});
  }
  return done_;
}

void DirectStartUp::give_up(StatusEvidence why) {
  done_ = true;
  result_.settled = false;
  result_.status = FlappingStatus::undecided;
  result_.time_to_steady = now_.t;
  why.direct = true;
  result_.evidence = std::move(why);
}

TransientResult DirectStartUp::run() {
  model_.begin_piece();
  before_ = model_.coordinates_now();
  swing_ = std::abs(bent());
  stroke_before_ = now_.moving.angle;
  recorder_.start(std::abs(now_.moving.current));
  recorder_.sample({now_.t, now_.moving.angle, now_.moving.speed, now_.moving.current});
  while (!done_) {
    const double end = double(result_.cycles + 1) * period_;
    const double until = options_.max_time > 0.0 ? std::min(end, options_.max_time) : end;
    pass(until);
    if (done_) break;
    if (now_.t >= end) {
      period_done();
    } else if (now_.stuck && rests_for_good()) {
      break;
    } else {
      out_of_budget();
    }
  }
  result_.end_time = now_.t;
  result_.end_crank_angle = now_.moving.angle;
  return std::move(result_);
}

}  // namespace wingbeat::detail
