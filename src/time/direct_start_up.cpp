#include "time/direct_start_up.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wingbeat::detail {
namespace {

constexpr int sticking_pieces = 512;     // of a period: how often a stuck shaft is looked at
constexpr double nearly_settled = 1e-4;  // off the orbit, where the steps allowed end before the tolerance is reached
constexpr int contraction_periods = 4;   // over which the contraction is taken: complex multipliers make it uneven

}  // namespace

double DirectStartUp::piece_end(const TimeModel&, double stop) {
  return now_.stuck ? std::min(stop, now_.t + period_ / sticking_pieces) : stop;
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
  result_.time_to_steady = double(first) * period_;
  result_.state = now_.moving;
  result_.crank_speed = now_.moving.speed;
  result_.current = now_.moving.current;
  result_.evidence = {.kind = Evidence::settled_periods,
                      .frequency = model_.vehicle.drive_frequency,
                      .time = result_.time_to_steady,
                      .change = change,
                      .cycles = result_.cycles};
  if (pitches(model_.vehicle)) pitching_.add_to(result_.evidence, model_);
}

/// True where periods come no nearer to each other. Whatever settles within `max_cycles` more than halves its changes
/// over the periods watched.
bool DirectStartUp::never_repeats() const {
  constexpr std::ptrdiff_t watched = 250;
  constexpr double far = 1e-2;
  const auto end = changes_.end();
  if (changes_.size() < 4 * watched || changes_.size() % watched != 0) return false;
  const double least = *std::min_element(end - watched, end);
  return least > far && least > 0.5 * *std::min_element(end - 2 * watched, end - watched);
}

void DirectStartUp::period_done() {
  ++result_.cycles;
  event(Kind::revolution);
  swings_.push_back(swing_);
  swing_ = std::abs(bent());
  if (rests_for_good() || creeps_to_rest()) return;

  const auto scale = model_.typical();
  const std::array<double, max_unknowns> y = model_.coordinates_now();
  double change = 0.0;
  for (std::size_t n = 0; n < model_.indices.count; ++n) {
    // Without springs nothing returns the shaft to any angle.
    if (n == 0 && !(model_.vehicle.spring.stiffness > 0.0) && !is_given(model_.vehicle.piezo)) continue;
    change = std::max(change, std::abs(y[n] - before_[n]) / scale[n]);
  }
  before_ = y;
  changes_.push_back(change);
  const std::size_t n = changes_.size();
  double rate = 1.0;
  if (n > contraction_periods + 1) {
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
    const bool balances = closes(audit, options_.tolerance);
    const bool settled = ((close || change < noise) && agree) || periods_at_tightest_ > 40;
    if (settled && !balances && tightest) return give_up_open_balance(audit);
    if (settled && balances) {
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
