#include "time/direct_transient.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "time/direct_model.hpp"
#include "time/integrator.hpp"
#include "time/model_problem.hpp"
#include "time/period_averages.hpp"
#include "time/pitch_direct_model.hpp"
#include "time/recorder.hpp"
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

/// Of a DirectModel or a PitchDirectModel.
template <class Model>
class DirectStartUp {
 public:
  DirectStartUp(const Vehicle<double>& vehicle, const TransientOptions& options);
  DirectStartUp(const DirectStartUp&) = delete;
  TransientResult run();

 private:
  void root_values(double t, const double* y, double* values, bool measuring) const;
  std::unique_ptr<Integrator> integrator(bool measuring);

  void advance(double until);
  void step_taken(Integrator& steps, double from);
  WaveformRow row(double t, const double* y) const;
  void add_variation();
  void period_done();
  void settle(double closure, double change);
  void interrupt();
  bool rests_for_good();
  bool creeps_to_rest();
  void begin_measuring();
  void take_metrics();
  bool out_of_budget();
  void give_up(StatusEvidence why);
  void event(Event kind) { result_.events.push_back({now_.t, now_.y[0], kind}); }

  const TransientOptions& options_;
  TransientResult result_;
  Recorder recorder_{options_, result_};
  Model model_;
  typename Model::State& now_ = model_.now;
  bool stiff_ = false, done_ = false;
  double relative_tolerance_ = 1e-9, tightest_ = 1e-13;
  static constexpr int count = quadrature_count + Model::other_quadratures;
  double quadrature_scale_[count] = {};

  double q_[count] = {};
  std::unique_ptr<Integrator> plain_, with_quadratures_;

  bool measuring_ = false;
  double last_off_ = infinity;                   ///< how far the last period was from the orbit, relative
  double last_apart_ = infinity;                 ///< that, or how far the last metrics were from those before them
  std::optional<Metrics<double>> last_metrics_;  ///< of the period before, found with the relative tolerance
  double measured_with_ = 0.0;
  int periods_at_tightest_ = 0;
  double variation_ = 0.0, energy_mark_ = 0.0;
  CycleExtremes<double> extremes_{};
  double swing_ = 0.0;  ///< largest |beta| of this period at the ends of steps
  std::vector<double> swings_;
  double stroke_before_ = 0.0;
  double travel_[2] = {}, last_travel_ = infinity;  ///< of this period: backwards, forwards; the longer of the last
  int creeping_ = 0;                                ///< periods so far
  double before_[5] = {};
  PeriodAverages<Model> reading_;
  std::vector<double> changes_;
};

template <class Model>
DirectStartUp<Model>::DirectStartUp(const Vehicle<double>& vehicle, const TransientOptions& options)
    : options_(options), model_(vehicle) {
  require(options.tolerance >= 1e-11 && options.tolerance <= 1e-2, "transient.tolerance",
          "must lie between 1e-11 and 1e-2", "1", options.tolerance);
  model_.start_from(options);
  const auto typical = model_.typical();
  const double speed_scale = typical[1], current_scale = typical.back();
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
  for (int k = 0; k < quadrature_count; ++k) quadrature_scale_[k] = model_.period * size(quadratures[k]);
  model_.other_scales(power, quadrature_scale_ + quadrature_count);
}

template <class Model>
void DirectStartUp<Model>::root_values(double t, const double* y, double* values, bool measuring) const {
  const auto indicators = model_.indicators(t, y, measuring);
  std::copy_n(indicators.begin(), measuring ? indicators.size() : Model::plain_indicators, values);
}

template <class Model>
std::unique_ptr<Integrator> DirectStartUp<Model>::integrator(bool measuring) {
  IntegratorProblem p = measuring ? problem_with_quadratures(model_, relative_tolerance_, quadrature_scale_)
                                  : problem_of(model_, relative_tolerance_);
  p.stiff = stiff_;
  p.roots = int(measuring ? std::size_t(Model::indicator_count) : Model::plain_indicators);
  p.rates = [this, measuring](double t, const double* y, double* dy) {
    ++result_.rate_evaluations;
    return model_.rates(t, y, dy, measuring);
  };
  p.root_functions = [this, measuring](double t, const double* y, double* values) {
    root_values(t, y, values, measuring);
  };
  p.longest_step = Model::longest_part * model_.period;
  return make_integrator(options_.integrator, std::move(p));
}

/// Integrates to an event or to the time `until`.
template <class Model>
void DirectStartUp<Model>::advance(double until) {
  if (now_.stuck) until = std::min(until, now_.t + model_.period / sticking_pieces);
  if (until - now_.t < 1e-13 * until) {
    now_.t = until;
    return;
  }
  if (measuring_) add_variation();
  model_.resume();
  if (measuring_) add_variation();
  std::unique_ptr<Integrator>& slot = measuring_ ? with_quadratures_ : plain_;
  if (!slot) slot = integrator(measuring_);
  Integrator& steps = *slot;
  double* y = steps.state();
  std::copy(now_.y, now_.y + model_.coupled, y);
  if (measuring_) std::copy(q_, q_ + count, y + model_.coupled);
  auto directions = model_.directions();
  if (!steps.restart(now_.t, directions.data(), std::min(model_.period, until - now_.t), until)) {
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
      give_up({.kind = Evidence::integrator_failed, .angle = now_.y[0], .time = now_.t});
      return;
    }
    now_.t = steps.time();
    std::copy(y, y + model_.coupled, now_.y);
    if (measuring_) std::copy(y + model_.coupled, y + model_.coupled + count, q_);
    step_taken(steps, from);
    if (outcome == Integrator::Outcome::stop) return;
    if (outcome == Integrator::Outcome::root) {
      if (measuring_) add_variation();
      if (steps.found(Model::interruption)) {
        interrupt();
        return;
      }
    } else if (model_.branch_lost()) {
      // A reversal or a stop that the integrator did not see.
      interrupt();
      return;
    }
    if (out_of_budget()) return;
  }
}

template <class Model>
WaveformRow DirectStartUp<Model>::row(double t, const double* y) const {
  const Motion<double> m = model_.motion(t, y);
  return waveform_row(model_.vehicle, m, t - double(result_.cycles) * model_.period, y[0], m.stroke_velocity, y[0],
                      Model::pitch_angle(y));
}

template <class Model>
void DirectStartUp<Model>::step_taken(Integrator& steps, double from) {
  swing_ = std::max(swing_, std::abs(now_.y[0]));
  travel_[now_.y[0] > stroke_before_] += std::abs(now_.y[0] - stroke_before_);
  stroke_before_ = now_.y[0];
  recorder_.note_current(now_.t, std::abs(model_.current_of(now_.t, now_.y)));
  if (measuring_) {
    raise_extremes(
        [&](double t) {
          const double* y = steps.dense(t);
          const Motion<double> m = model_.motion(t, y);
          return extreme_candidates(m, m.stroke_velocity, model_.branch_at(y), y[0]);
        },
        from, now_.t, 4, extremes_);
    reading_.step_taken(model_, steps, from);
    const int last = options_.cycle_rows - 1;
    while (last > 0 && int(result_.cycle.size()) <= last) {
      const double row_time = model_.period * (result_.cycles + double(result_.cycle.size()) / last);
      if (row_time > now_.t + 1e-12 * model_.period) break;
      result_.cycle.push_back(row(std::min(row_time, now_.t), steps.dense(std::min(row_time, now_.t))));
    }
  }
  recorder_.step_taken({now_.t, now_.y[0], now_.y[1], model_.current_of(now_.t, now_.y)}, [&](double t) {
    const double* y = steps.dense(t);
    return TransientSample{t, y[0], y[1], model_.current_of(t, y)};
  });
}

template <class Model>
void DirectStartUp<Model>::add_variation() {
  const double energy = model_.wing_energy();
  variation_ += std::abs(energy - energy_mark_);
  energy_mark_ = energy;
}

template <class Model>
void DirectStartUp<Model>::begin_measuring() {
  measuring_ = true;
  std::fill(std::begin(q_), std::end(q_), 0.0);
  extremes_.fill(-infinity);
  variation_ = 0.0;
  energy_mark_ = model_.wing_energy();
  result_.cycle.clear();
  reading_.begin(model_);
}

/// What ends a piece of the motion: standstill, breakaway, a stop.
template <class Model>
void DirectStartUp<Model>::interrupt() {
  if (measuring_) add_variation();
  if (const auto kind = model_.interrupt()) event(*kind);
  if (measuring_) add_variation();
}

template <class Model>
void DirectStartUp<Model>::take_metrics() {
  add_variation();
  CycleIntegrals<double>& integrals = result_.integrals;
  for (int k = 0; k < quadrature_count; ++k) integrals[std::size_t(quadratures[k])] = q_[k];
  integrals[std::size_t(Integral::time)] = model_.period;
  integrals[std::size_t(Integral::reactive_work)] = variation_;
  reading_.add_impulses(model_, integrals);
  result_.metrics = cycle_metrics(model_.vehicle, integrals, extremes_, absent, options_.reporting);
  result_.averaged_cycles = 1;
  reading_.finish(model_, q_ + quadrature_count, *result_.metrics);
}

/// True, with the decision, where nothing moves the shaft any more.
template <class Model>
bool DirectStartUp<Model>::rests_for_good() {
  const auto typical = model_.typical();
  const bool no_drive = model_.vehicle.voltage == 0.0 && std::abs(now_.y[1]) < 1e-9 * typical[1] &&
                        std::abs(now_.y[0]) < 1e-9 * typical[0] && swing_ < 1e-9 * typical[0];
  const double held = now_.stuck ? model_.largest_net_torque() : infinity;
  if (held > model_.holding_torque && !no_drive) return false;
  done_ = true;
  result_.settled = true;
  result_.status = FlappingStatus::stalled;
  result_.time_to_steady = now_.t;
  result_.lock_angle = now_.y[0];
  result_.torque_margin = now_.stuck ? model_.holding_torque - held : 0.0;
  if (now_.stuck) {
    result_.evidence = {
        .kind = Evidence::held_shaft, .angle = now_.y[0], .torque = held, .friction_torque = model_.holding_torque};
  } else {
    result_.evidence = {.kind = Evidence::no_voltage};
  }
  return true;
}

/// True, with the decision, where the drive alone cannot break the shaft away and the springs let it creep towards an
/// angle of rest: from standstill to standstill the angle is a monotone map of itself, and slips in one direction end
/// where there are none.
template <class Model>
bool DirectStartUp<Model>::creeps_to_rest() {
  const double travel = std::max(travel_[0], travel_[1]), back = std::min(travel_[0], travel_[1]);
  const bool creeps =
      now_.stuck && model_.drive_torque <= model_.holding_torque && travel < last_travel_ && back <= 1e-6 * travel;
  creeping_ = creeps ? creeping_ + 1 : 0;
  last_travel_ = travel;
  travel_[0] = travel_[1] = 0.0;
  if (creeping_ < creep_periods) return false;
  done_ = true;
  result_.settled = true;
  result_.status = FlappingStatus::stalled;
  result_.time_to_steady = now_.t;
  result_.lock_angle = now_.y[0];
  result_.torque_margin = model_.holding_torque - model_.drive_torque;
  result_.evidence = {.kind = Evidence::creeping_shaft,
                      .angle = now_.y[0],
                      .torque = model_.drive_torque,
                      .friction_torque = model_.holding_torque,
                      .travel = travel};
  return true;
}

/// The decision that it flaps, with the metrics taken: how far periods are from the orbit, and from each other.
template <class Model>
void DirectStartUp<Model>::settle(double closure, double change) {
  done_ = true;
  result_.closure = closure;
  result_.settled = true;
  result_.status = FlappingStatus::flapping;
  std::size_t first = swings_.size();
  while (first > 0 && std::abs(swings_[first - 1] / swings_.back() - 1.0) <= 1e-2) --first;
  result_.time_to_steady = double(first) * model_.period;
  model_.put_state(result_);
  result_.evidence = {.kind = Evidence::settled_periods,
                      .frequency = model_.vehicle.drive_frequency,
                      .time = result_.time_to_steady,
                      .change = change,
                      .cycles = result_.cycles};
  reading_.add_to(result_.evidence, model_);
}

template <class Model>
void DirectStartUp<Model>::period_done() {
  ++result_.cycles;
  event(Event::revolution);
  swings_.push_back(swing_);
  swing_ = std::abs(now_.y[0]);
  if (rests_for_good() || creeps_to_rest()) return;

  const auto scale = model_.typical();
  double change = 0.0;
  for (int n = 0; n < model_.coupled; ++n) {
    // Without springs nothing returns the shaft to any angle.
    if (n == 0 && !(model_.vehicle.spring.stiffness > 0.0)) continue;
    change = std::max(change, std::abs(now_.y[n] - before_[n]) / scale[std::size_t(n)]);
  }
  std::copy(now_.y, now_.y + model_.coupled, before_);
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

template <class Model>
bool DirectStartUp<Model>::out_of_budget() {
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

template <class Model>
void DirectStartUp<Model>::give_up(StatusEvidence why) {
  done_ = true;
  result_.settled = false;
  result_.status = FlappingStatus::undecided;
  result_.time_to_steady = now_.t;
  why.direct = true;
  result_.evidence = std::move(why);
}

template <class Model>
TransientResult DirectStartUp<Model>::run() {
  model_.begin_piece();
  std::copy(now_.y, now_.y + model_.coupled, before_);
  swing_ = std::abs(now_.y[0]);
  stroke_before_ = now_.y[0];
  recorder_.start(std::abs(model_.current_of(0.0, now_.y)));
  recorder_.sample({now_.t, now_.y[0], now_.y[1], model_.current_of(now_.t, now_.y)});
  while (!done_) {
    const double end = double(result_.cycles + 1) * model_.period;
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
  result_.end_crank_angle = now_.y[0];
  return std::move(result_);
}

}  // namespace

TransientResult simulate_direct_start_up(const Vehicle<double>& vehicle, const TransientOptions& options) {
  if (pitches(vehicle)) return DirectStartUp<PitchDirectModel>(vehicle, options).run();
  return DirectStartUp<DirectModel>(vehicle, options).run();
}

}  // namespace wingbeat::detail
