#include "time/direct_transient.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "time/integrator.hpp"
#include "time/model_problem.hpp"
#include "time/pitch_samples.hpp"
#include "time/recorder.hpp"
#include "time/time_model.hpp"
#include "time/transient_tools.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

using Event = TransientEvent::Kind;
using Evidence = StatusEvidence::Kind;

constexpr int sticking_pieces = 512;     // of a period: how often a stuck shaft is looked at
constexpr int creep_periods = 8;         // of ever shorter slips in one direction, that end at rest
constexpr double nearly_settled = 1e-4;  // off the orbit, where the steps allowed end before the tolerance is reached
constexpr int contraction_periods = 4;   // over which the contraction is taken: complex multipliers make it uneven

class DirectStartUp {
 public:
  DirectStartUp(const Vehicle<double>& vehicle, const TransientOptions& options);
  DirectStartUp(const DirectStartUp&) = delete;
  TransientResult run();

 private:
  std::span<const TimeModel::Indicator> watched(bool measuring) const;
  std::unique_ptr<Integrator> integrator(bool measuring);

  void advance(double until);
  void step_taken(Integrator& steps, double from);
  WaveformRow row(double t, const double* y) const;
  void add_variation();
  void period_done();
  void settle(double closure, double change);
  void changing(const std::function<void()>& change);
  double largest_torque() const;
  bool wings_are_still() const;
  bool rests_for_good();
  bool creeps_to_rest();
  void begin_measuring();
  void take_metrics();
  bool out_of_budget();
  void give_up(StatusEvidence why);
  void event(Event kind) { result_.events.push_back({now_.t, now_.moving.angle, kind}); }

  const TransientOptions& options_;
  TransientResult result_;
  Recorder recorder_{options_, result_};
  TimeModel model_;
  TimeModel::State& now_ = model_.now;
  const double period_ = 1.0 / model_.vehicle.drive_frequency;
  bool stiff_ = false, done_ = false;
  double relative_tolerance_ = 1e-9, tightest_ = 1e-13;
  double quadrature_scale_[quadrature_count] = {};

  double q_[quadrature_count] = {};
  std::unique_ptr<Integrator> plain_, with_quadratures_;

  bool measuring_ = false;
  double last_off_ = infinity;                   ///< how far the last period was from the orbit, relative
  double last_apart_ = infinity;                 ///< that, or how far the last metrics were from those before them
  std::optional<Metrics<double>> last_metrics_;  ///< of the period before, found with the relative tolerance
  double measured_with_ = 0.0;
  int periods_at_tightest_ = 0;
  double variation_ = 0.0, energy_mark_ = 0.0, motor_mark_ = 0.0;
  CycleExtremes<double> extremes_{};
  double swing_ = 0.0;  ///< largest |beta| of this period at the ends of steps
  std::vector<double> swings_;
  double stroke_before_ = 0.0;
  double travel_[2] = {}, last_travel_ = infinity;  ///< of this period: backwards, forwards; the longer of the last
  int creeping_ = 0;                                ///< periods so far
  std::array<double, max_unknowns> before_{};
  CycleIntegrals<double> impulses_mark_{};
  PitchSamples pitching_;
  double stuck_until_ = infinity;  ///< what a shaft has not left by then, it never leaves
  std::vector<double> changes_;
};

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

/// The largest torque of the motor at rest from now on [N m]: its current is a sine and what remains of its start.
double DirectStartUp::largest_torque() const {
  const Motor<double>& m = model_.vehicle.motor;
  const double w = two_pi * model_.vehicle.drive_frequency;
  const double Z = std::hypot(m.armature_resistance, w * m.armature_inductance);
  const double lag = std::atan2(w * m.armature_inductance, m.armature_resistance);
  const double remains = model_.indices.inductive
                             ? std::abs(now_.moving.current - model_.vehicle.voltage / Z * std::sin(w * now_.t - lag))
                             : 0.0;
  return model_.drive_torque + m.torque_constant * remains;
}

/// True, with the decision, where nothing moves the shaft any more. Wings that still pitch shake it: they can only come
/// to rest, so that a shaft which stands long enough does so for good.
bool DirectStartUp::rests_for_good() {
  const bool no_drive = model_.vehicle.voltage == 0.0 && std::abs(now_.moving.speed) < 1e-9 * model_.speed_scale &&
                        std::abs(now_.moving.angle) < 1e-9 * model_.angle_scale && swing_ < 1e-9 * model_.angle_scale &&
                        wings_are_still();
  if (!now_.stuck) stuck_until_ = infinity;
  if (!now_.stuck && !no_drive) return false;
  const StandingTorques<double> torques = model_.standing_torques(now_.moving.angle);
  const double load = 0.5 * (torques.low + torques.high), hold = 0.5 * (torques.high - torques.low);
  const double torque = largest_torque() + std::abs(load);
  if (now_.stuck && !no_drive) {
    if (torque > hold && model_.wings_rest()) return false;
    if (!model_.wings_rest()) {
      const PitchingWings<double>& wings = model_.vehicle.pitch;
      const double own = two_pi * std::sqrt((wings.pitch_inertia + wings.air.pp) / wings.hinge.stiffness);
      if (stuck_until_ == infinity) stuck_until_ = now_.t + 3.0 * own + 2.0 * period_ + 20.0 * model_.electrical_time;
      if (now_.t < stuck_until_) return false;
    }
  }
  done_ = true;
  result_.settled = true;
  result_.status = FlappingStatus::stalled;
  result_.time_to_steady = now_.t;
  result_.lock_angle = now_.moving.angle;
  result_.torque_margin = now_.stuck ? std::max(0.0, hold - torque) : 0.0;
  if (now_.stuck) {
    result_.evidence = {
        .kind = Evidence::held_shaft, .angle = now_.moving.angle, .torque = torque, .friction_torque = hold};
  } else {
    result_.evidence = {.kind = Evidence::no_voltage};
  }
  return true;
}

/// Of wings that pitch: as nearly as the stroke has to be where nothing drives it.
bool DirectStartUp::wings_are_still() const {
  return !model_.indices.pitching || (std::abs(now_.moving.pitch_angle) < 1e-9 * model_.pitch_scale &&
                                      std::abs(now_.moving.pitch_velocity) < 1e-9 * model_.pitch_velocity_scale);
}

/// True, with the decision, where the drive alone cannot break the shaft away and the springs let it creep towards an
/// angle of rest: from standstill to standstill the angle is a monotone map of itself, and slips in one direction end
/// where there are none.
bool DirectStartUp::creeps_to_rest() {
  const double travel = std::max(travel_[0], travel_[1]), back = std::min(travel_[0], travel_[1]);
  const bool creeps =
      now_.stuck && model_.drive_torque <= model_.constant_friction && travel < last_travel_ && back <= 1e-6 * travel;
  creeping_ = creeps ? creeping_ + 1 : 0;
  last_travel_ = travel;
  travel_[0] = travel_[1] = 0.0;
  if (creeping_ < creep_periods) return false;
  done_ = true;
  result_.settled = true;
  result_.status = FlappingStatus::stalled;
  result_.time_to_steady = now_.t;
  result_.lock_angle = now_.moving.angle;
  result_.torque_margin = model_.constant_friction - model_.drive_torque;
  result_.evidence = {.kind = Evidence::creeping_shaft,
                      .angle = now_.moving.angle,
                      .torque = model_.drive_torque,
                      .friction_torque = model_.constant_friction,
                      .travel = travel};
  return true;
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

}  // namespace

TransientResult simulate_direct_start_up(const Vehicle<double>& vehicle, const TransientOptions& options) {
  return DirectStartUp(vehicle, options).run();
}

}  // namespace wingbeat::detail
