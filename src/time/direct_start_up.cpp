#include "time/direct_start_up.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "time/model_problem.hpp"
#include "wingbeat/cycle/energy_audit.hpp"

namespace wingbeat::detail {
namespace {

constexpr int sticking_pieces = 512;     // of a period: how often a stuck shaft is looked at
constexpr double nearly_settled = 1e-4;  // off the orbit, where the steps allowed end before the tolerance is reached
constexpr int contraction_periods = 4;   // over which the contraction is taken: complex multipliers make it uneven

}  // namespace

DirectStartUp::DirectStartUp(const Vehicle<double>& vehicle, const TransientOptions& options)
    : options_(options), model_(vehicle, {}) {
  require(options.tolerance >= 1e-11 && options.tolerance <= 1e-2, "transient.tolerance",
          "must lie between 1e-11 and 1e-2", "1", options.tolerance);
  model_.start(
      {options.crank_angle, options.crank_speed, options.current, options.pitch_angle, options.pitch_velocity});
  const double speed_scale = model_.speed_scale, current_scale = model_.current_scale;
  const Motor<double>& m = model_.vehicle.motor;
  stiff_ = model_.stiff();
  result_.stiff = stiff_;
  relative_tolerance_ = std::max(tightest_, (stiff_ ? 1e-3 : 3e-3) * options.tolerance);

  const double power = current_scale * (m.torque_constant * speed_scale + current_scale * m.armature_resistance);
  const auto size = [&](Integral which) {
    switch (which) {
      case Integral::current: return current_scale;
      case Integral::current_square: return square(current_scale);
      case Integral::speed_square: return square(speed_scale);
      case Integral::travel: return speed_scale;
      case Integral::lift:
        return model_.vehicle.wings.air_density * model_.vehicle.wings.s2 * square(speed_scale) +
               1e-6 * m.torque_constant * current_scale;
      case Integral::rod_force: return m.torque_constant * current_scale;
      default: return power;
    }
  };
  for (int k = 0; k < quadrature_count; ++k) quadrature_scale_[k] = period_ * size(quadratures[k]);
}

/// Those of the model's indicators that end a piece of the motion, then, in a period that is measured, the others.
std::span<const TimeModel::Indicator> DirectStartUp::watched(bool measuring) const {
  using enum TimeModel::Indicator;
  static constexpr TimeModel::Indicator all[] = {standstill, force, stop, reversal, turn, stored_moment};
  // Under the pitch law the loads hardly bend where the stroke turns back.
  return std::span(all).first(measuring ? 6 : model_.indices.pitching ? 5 : 2);
}

std::unique_ptr<Integrator> DirectStartUp::integrator(bool measuring) {
  IntegratorProblem p = measuring ? problem_with_quadratures(model_, relative_tolerance_, quadrature_scale_)
                                  : problem_of(model_, relative_tolerance_);
  p.stiff = stiff_;
  p.roots = int(watched(measuring).size());
  p.rates = [this, measuring](double t, const double* y, double* dy) {
    ++result_.rate_evaluations;
    return model_.rates(t, y, dy, measuring);
  };
  p.root_functions = [this, measuring](double t, const double* y, double* values) {
    const auto indicators = model_.indicators(t, y);
    for (const TimeModel::Indicator which : watched(measuring)) *values++ = indicators[which];
  };
  p.longest_step = period_ / (model_.indices.pitching ? 16.0 : 4.0);
  return make_integrator(options_.integrator, std::move(p));
}

/// Integrates to an event or to the time `until`.
void DirectStartUp::advance(double until) {
  changing([&] { model_.begin_piece(); });
  if (now_.stuck) until = std::min(until, now_.t + period_ / sticking_pieces);
  if (until - now_.t < 1e-13 * until) {
    now_.t = until;
    return;
  }
  std::unique_ptr<Integrator>& slot = measuring_ ? with_quadratures_ : plain_;
  if (!slot) slot = integrator(measuring_);
  Integrator& steps = *slot;
  double* y = steps.state();
  model_.unknowns(y);
  if (measuring_) std::copy(q_, q_ + quadrature_count, y + model_.coupled);
  const auto which_way = model_.directions();
  const auto roots = watched(measuring_);
  int directions[TimeModel::indicator_count];
  for (std::size_t k = 0; k < roots.size(); ++k) directions[k] = which_way[roots[k]];
  if (!steps.restart(now_.t, directions, std::min(period_, until - now_.t), until)) {
    give_up({.kind = Evidence::integrator_not_started});
    return;
  }
  while (!done_) {
    const double from = now_.t;
    const Integrator::Outcome outcome = steps.advance();
    if (outcome == Integrator::Outcome::failed) {
      if (relative_tolerance_ < 1e-9) {
        relative_tolerance_ = tightest_ = 10.0 * relative_tolerance_;
        return;
      }
      give_up({.kind = Evidence::integrator_failed, .angle = now_.moving.angle, .time = now_.t});
      return;
    }
    model_.set(steps.time(), y);
    if (measuring_) std::copy(y + model_.coupled, y + model_.coupled + quadrature_count, q_);
    step_taken(steps, from);
    if (outcome == Integrator::Outcome::stop) return;
    bool piece_ends = false;
    if (outcome == Integrator::Outcome::root) {
      if (measuring_) add_variation();
      for (std::size_t k = 0; k < roots.size(); ++k) {
        const TimeModel::Indicator which = roots[k];
        const bool ends = which == TimeModel::standstill || which == TimeModel::force || which == TimeModel::stop;
        if (!ends || !steps.found(int(k))) continue;
        const std::optional<Event> kind = model_.event_at(which);
        changing([&] { model_.handle(which); });
        if (kind) event(*kind);
        piece_ends = true;
      }
    } else {
      // A reversal or a stop that the integrator did not see.
      changing([&] { piece_ends = model_.branch_lost(); });
    }
    if (piece_ends || out_of_budget()) return;
  }
}

/// Changes the model, with what that adds to variation and events.
void DirectStartUp::changing(const std::function<void()>& change) {
  if (measuring_) add_variation();
  const double lost = now_.impact_loss;
  change();
  if (now_.impact_loss > lost) event(Event::stop_impact);
  if (measuring_) add_variation();
}

WaveformRow DirectStartUp::row(double t, const double* y) const {
  const Motion<double> m = model_.motion(t, y);
  return waveform_row(model_.vehicle, m, t - double(result_.cycles) * period_, y[0], m.stroke_velocity, y[0],
                      model_.indices.pitching ? y[model_.indices.pitch] : absent);
}

void DirectStartUp::step_taken(Integrator& steps, double from) {
  swing_ = std::max(swing_, std::abs(now_.moving.angle));
  travel_[now_.moving.angle > stroke_before_] += std::abs(now_.moving.angle - stroke_before_);
  stroke_before_ = now_.moving.angle;
  recorder_.note_current(now_.t, std::abs(now_.moving.current));
  if (measuring_) {
    raise_extremes(
        [&](double t) {
          const double* y = steps.dense(t);
          Mode<double> mode;
          const Motion<double> m = model_.motion(t, y, &mode);
          return extreme_candidates(m, m.stroke_velocity, mode, y[0]);
        },
        from, now_.t, 4, extremes_);
    if (model_.indices.pitching) pitching_.step_taken(model_, steps, from);
    const int last = options_.cycle_rows - 1;
    while (last > 0 && int(result_.cycle.size()) <= last) {
      const double row_time = period_ * (result_.cycles + double(result_.cycle.size()) / last);
      if (row_time > now_.t + 1e-12 * period_) break;
      result_.cycle.push_back(row(std::min(row_time, now_.t), steps.dense(std::min(row_time, now_.t))));
    }
  }
  recorder_.step_taken({now_.t, now_.moving.angle, now_.moving.speed, now_.moving.current}, [&](double t) {
    const double* y = steps.dense(t);
    return TransientSample{t, y[0], y[1], model_.current_of(t, y)};
  });
}

void DirectStartUp::add_variation() {
  const double energy = model_.wing_energy();
  variation_ += std::abs(energy - energy_mark_);
  energy_mark_ = energy;
}

void DirectStartUp::begin_measuring() {
  measuring_ = true;
  std::fill(std::begin(q_), std::end(q_), 0.0);
  extremes_.fill(-infinity);
  variation_ = 0.0;
  energy_mark_ = model_.wing_energy();
  motor_mark_ = model_.motor_energy();
  result_.cycle.clear();
  impulses_mark_ = now_.impulses;
  pitching_.begin(model_);
}

void DirectStartUp::take_metrics() {
  add_variation();
  CycleIntegrals<double>& integrals = result_.integrals;
  for (int k = 0; k < quadrature_count; ++k) {
    const auto which = std::size_t(quadratures[k]);
    integrals[which] = q_[k] + now_.impulses[which] - impulses_mark_[which];
  }
  integrals[std::size_t(Integral::time)] = period_;
  integrals[std::size_t(Integral::reactive_work)] = variation_;
  set_gear_work(model_.vehicle.motor, model_.motor_energy() - motor_mark_, integrals);
  result_.metrics = cycle_metrics(model_.vehicle, integrals, extremes_, absent, options_.reporting);
  result_.averaged_cycles = 1;
  if (model_.indices.pitching) pitching_.finish(model_, now_.t - period_, now_.t, 1, *result_.metrics);
}

/// The decision that it flaps, with the metrics taken: how far periods are from the orbit, and from each other.
void DirectStartUp::settle(double closure, double change) {
  done_ = true;
  result_.closure = closure;
  result_.settled = true;
  result_.status = FlappingStatus::flapping;
  std::size_t first = swings_.size();
  while (first > 0 && std::abs(swings_[first - 1] / swings_.back() - 1.0) <= 1e-2) --first;
  result_.time_to_steady = double(first) * period_;
  result_.stroke_angle = now_.moving.angle;
  result_.crank_speed = now_.moving.speed;
  result_.current = now_.moving.current;
  result_.pitch_angle = now_.moving.pitch_angle;
  result_.pitch_velocity = now_.moving.pitch_velocity;
  result_.evidence = {.kind = Evidence::settled_periods,
                      .frequency = model_.vehicle.drive_frequency,
                      .time = result_.time_to_steady,
                      .change = change,
                      .cycles = result_.cycles};
  if (model_.indices.pitching) pitching_.add_to(result_.evidence, model_);
}

void DirectStartUp::period_done() {
  ++result_.cycles;
  event(Event::revolution);
  swings_.push_back(swing_);
  swing_ = std::abs(now_.moving.angle);
  if (rests_for_good() || creeps_to_rest()) return;

  const auto scale = model_.typical();
  std::array<double, max_unknowns> y{};
  model_.unknowns(y.data());
  double change = 0.0;
  for (std::size_t n = 0; n < model_.indices.count; ++n) {
    // Without springs nothing returns the shaft to any angle.
    if (n == 0 && !(model_.vehicle.spring.stiffness > 0.0)) continue;
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
  if (measuring_) {
    // The metrics of a period of looser steps tell how far its own steps leave them off.
    const std::optional<Metrics<double>> before = std::exchange(last_metrics_, std::nullopt);
    take_metrics();
    const bool tightest = relative_tolerance_ <= tightest_;
    const double apart = before ? metrics_apart(*before, *result_.metrics) : infinity;
    last_apart_ = std::max(last_off_, apart);
    const bool agree =
        before && (tightest || relative_tolerance_ < 0.2 * measured_with_) && apart < 0.3 * options_.tolerance;
    periods_at_tightest_ += tightest && change < 10.0 * noise;
    const EnergyAudit audit = energy_audit(*result_.metrics);
    const bool balances = closes(audit, options_.tolerance);
    const bool settled = ((close || change < noise) && agree) || periods_at_tightest_ > 40;
    if (settled && !balances && tightest) {
      result_.metrics.reset();
      give_up({.kind = Evidence::open_balance, .change = std::abs(audit.imbalance / audit.electrical)});
      return;
    }
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
  if (close || change < noise || measuring_) begin_measuring();
  if (result_.cycles >= options_.max_cycles) {
    give_up({.kind = Evidence::cycles_differ, .change = change, .cycles = options_.max_cycles});
  }
}

bool DirectStartUp::out_of_budget() {
  ++result_.steps;
  const auto as_good_as_steps_allow = [&] {
    return last_metrics_ && last_off_ < nearly_settled &&
           closes(energy_audit(*last_metrics_), std::max(options_.tolerance, last_apart_));
  };
  if (result_.steps > options_.max_steps && as_good_as_steps_allow()) {
    // That it flaps is beyond doubt, its metrics are as good as the steps allowed make them.
    result_.metrics = last_metrics_;
    settle(last_off_, changes_.back());
    result_.evidence.accuracy = last_apart_;
    result_.evidence.steps = options_.max_steps;
  } else if (result_.steps > options_.max_steps) {
    give_up({.kind = Evidence::out_of_steps, .steps = options_.max_steps});
  } else if (options_.cancel && result_.steps % 512 == 0 && options_.cancel()) {
    give_up({.kind = Evidence::cancelled});
  } else if (options_.max_time > 0.0 && now_.t >= options_.max_time) {
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
  model_.unknowns(before_.data());
  swing_ = std::abs(now_.moving.angle);
  stroke_before_ = now_.moving.angle;
  recorder_.start(std::abs(now_.moving.current));
  recorder_.sample({now_.t, now_.moving.angle, now_.moving.speed, now_.moving.current});
  while (!done_) {
    const double end = double(result_.cycles + 1) * period_;
    const double until = options_.max_time > 0.0 ? std::min(end, options_.max_time) : end;
    advance(until);
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
