#include "time/crank_start_up.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "time/model_problem.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

enum Root { root_force, root_standstill, root_cycle, root_jam, root_plain_count };
enum { root_stored_moment = root_plain_count, root_reversal, root_measuring_count };
enum { root_stop = root_measuring_count, root_turn, root_pitching_count };

// A branch that takes more steps is taken as stiff whatever the estimate said.
constexpr int stiff_steps_per_branch = 2000;

}  // namespace

CrankStartUp::CrankStartUp(const Vehicle<double>& vehicle, const TransientOptions& options)
    : options_(options),
      model_(vehicle, options.supply.value_or(Supply<double>{SupplyType::constant, vehicle.voltage, 0.0, 1.0})),
      recorder_(options_, result_) {
  require(options.tolerance >= 1e-11 && options.tolerance <= 1e-2, "transient.tolerance",
          "must lie between 1e-11 and 1e-2", "1", options.tolerance);
  require(options.max_time >= 0.0, "transient.max_time", "must be >= 0", "s", options.max_time);
  require(options.record_interval >= 0.0, "transient.record_interval", "must be >= 0", "s", options.record_interval);
  require(std::isfinite(options.crank_angle), "transient.crank_angle", "must be finite", "rad", options.crank_angle);
  require(std::isfinite(options.crank_speed), "transient.crank_speed", "must be finite", "rad/s", options.crank_speed);
  require(std::isfinite(options.pitch_angle), "transient.pitch_angle", "must be finite", "rad", options.pitch_angle);
  require(std::isfinite(options.pitch_velocity), "transient.pitch_velocity", "must be finite", "rad/s",
          options.pitch_velocity);
  require(std::isfinite(options.current), "transient.current", "must be finite", "A", options.current);
  if (options.supply && options.supply->type == SupplyType::pwm && model_.supply.type == SupplyType::constant) {
    result_.current_ripple = 0.0;
  }
}

void CrankStartUp::prepare() {
  model_.start(
      {options_.crank_angle, options_.crank_speed, options_.current, options_.pitch_angle, options_.pitch_velocity});
  const Vehicle<double>& vehicle = model_.vehicle;
  const Motor<double>& m = vehicle.motor;
  const double R = circuit_resistance(vehicle), K = m.torque_constant;
  const double cycle = model_.time_scale, drive = model_.drive_period;
  const double mechanical = model_.mechanical_time, electrical = model_.electrical_time;
  swing_low_ = swing_high_ = now_.moving.angle;
  const double released = 0.5 * pi * std::sqrt(vehicle.wing_count * vehicle.spring.stiffness / m.inertia);
  runaway_speed_ = 1e3 * std::max({model_.speed_scale, std::abs(now_.moving.speed),
                                   std::abs(now_.moving.current) * R / K, released});

  stiff_ = model_.stiff();
  result_.stiff = stiff_;
  relative_tolerance_ = std::max(tightest_, (stiff_ ? 3e-3 : 1e-2) * options_.tolerance);
  loosest_ = relative_tolerance_;

  end_time_ = options_.max_time > 0.0                  ? options_.max_time
              : model_.supply.type == SupplyType::sine ? 50.0 * (cycle + drive) + 100.0 * (mechanical + electrical)
                                                       : 1000.0 * (cycle + mechanical + electrical + drive);

  window_ = std::max({cycle, 8.0 * drive, 0.5 * mechanical, electrical});
  window_end_ = window_;
  window_low_ = window_high_ = now_.moving.angle;

  const double force = K * model_.current_scale / typical_crank_lever(model_.vehicle.transmission);
  const double power = model_.current_scale * K * model_.speed_scale + model_.current_scale * model_.current_scale * R;
  const auto natural = [&](Integral which) {
    switch (which) {
      case Integral::current: return model_.current_scale;
      case Integral::current_square: return square(model_.current_scale);
      case Integral::speed_square: return square(model_.speed_scale);
      case Integral::travel: return model_.speed_scale;
      case Integral::lift:
        return model_.vehicle.wings.air_density * model_.vehicle.wings.s2 *
                   square(model_.speed_scale * typical_stroke_slope(model_.vehicle.transmission)) +
               1e-6 * force;
      case Integral::rod_force: return force;
      default: return power;
    }
  };
  for (int k = 0; k < quadrature_count; ++k) quadrature_scale_[k] = cycle * natural(quadratures[k]);

  next_cycle_ = two_pi * (std::floor(now_.moving.angle / two_pi) + 1.0);
  recorder_.start(now_.moving.current);
  sample();
}

void CrankStartUp::root_values(double t, const double* y, double* values, bool measuring) {
  const auto indicators = model_.indicators(t, y);
  values[root_force] = last_force_switch_ = indicators[TimeModel::force];
  values[root_standstill] = indicators[TimeModel::standstill];
  values[root_cycle] = y[0] - next_cycle_;
  values[root_jam] = indicators[TimeModel::jam];
  if (!measuring && !model_.indices.pitching) return;
  values[root_stored_moment] = indicators[TimeModel::stored_moment];
  values[root_reversal] = indicators[TimeModel::reversal];
  if (!model_.indices.pitching) return;
  values[root_stop] = indicators[TimeModel::stop];
  values[root_turn] = indicators[TimeModel::turn];
}

std::unique_ptr<Integrator> CrankStartUp::integrator(bool measuring) {
  IntegratorProblem p = measuring ? problem_with_quadratures(model_, relative_tolerance_, quadrature_scale_)
                                  : problem_of(model_, relative_tolerance_);
  p.stiff = stiff_;
  p.roots = model_.indices.pitching ? int(root_pitching_count)
            : measuring             ? int(root_measuring_count)
                                    : int(root_plain_count);
  p.rates = [this, measuring](double t, const double* y, double* dy) {
    ++result_.rate_evaluations;
    return model_.rates(t, y, dy, measuring);
  };
  p.root_functions = [this, measuring](double t, const double* y, double* values) {
    root_values(t, y, values, measuring);
  };
  // A switched supply ends a branch every few microseconds: steps that keep their length from one branch to the next
  // beat those that find their order and length again on each.
  const bool own = options_.integrator == TimeIntegrator::automatic && model_.supply.type == SupplyType::pwm;
  return make_integrator(own ? TimeIntegrator::own_steps : options_.integrator, std::move(p));
}

TransientResult CrankStartUp::run() {
  prepare();
  if (model_.uniqueness_now() <= TimeModel::smallest_margin && !model_.wingless) jam(now_.moving.angle);
  while (!done_) {
    if (now_.moving.speed == 0.0) {
      stand();
    } else {
      now_.direction = sign_of(now_.moving.speed);
    }
    if (!done_) slide();
    if (!done_) out_of_budget();
  }
  result_.end_time = now_.t;
  result_.end_crank_angle = now_.moving.angle;
  result_.cycles = int(crossings_.size());
  if (!crossings_.empty()) {
    result_.crank_speed = crossings_.back().omega;
    result_.current = crossings_.back().current;
    result_.pitch_angle = crossings_.back().psi;
    result_.pitch_velocity = crossings_.back().pitch_velocity;
  }
  return std::move(result_);
}

bool CrankStartUp::out_of_budget() {
  ++result_.steps;
  if (result_.steps > options_.max_steps) {
    give_up({.kind = Evidence::out_of_steps, .steps = options_.max_steps});
  } else if (options_.cancel && result_.steps % 512 == 0 && options_.cancel()) {
    give_up({.kind = Evidence::cancelled});
  } else if (std::abs(now_.moving.speed) > runaway_speed_) {
    give_up({.kind = Evidence::runs_away, .crank_speed = now_.moving.speed});
  } else if (now_.t >= end_time_) {
    give_up({.kind = Evidence::out_of_time, .time = end_time_});
  }
  return done_;
}

void CrankStartUp::switch_supply() {
  const double i = now_.moving.current, duty = model_.supply.duty;
  model_.switch_supply();
  if (now_.switches % 2 == 1) {
    ripple_top_ = i;
  } else {
    if (measuring_ && std::isfinite(ripple_bottom_)) {
      const double line = ripple_bottom_ + duty * (i - ripple_bottom_);
      ripple_sum_ += ripple_top_ - line;
      ++ripple_count_;
    }
    ripple_bottom_ = measuring_ ? i : absent;
  }
  if (options_.record) {
    event(Kind::supply_switch);
    sample();
  }
  recorder_.note_current(now_.t, now_.moving.current);
}

/// Integrates one smooth branch to the next event that ends it.
void CrankStartUp::slide() {
  if (measuring_ && model_.indices.pitching) add_variation();
  model_.resume();
  if (measuring_ && model_.indices.pitching) add_variation();
  if (now_.jammed) return jam(now_.moving.angle);
  if (!now_.stuck) model_.choose_force_branch();
  std::unique_ptr<Integrator>& slot = measuring_ ? with_quadratures_ : plain_;
  if (!slot) slot = integrator(measuring_);
  Integrator& steps = *slot;
  double* y = steps.state();
  model_.unknowns(y);
  if (measuring_) std::copy(q_, q_ + quadrature_count, y + model_.coupled);

  const int halts = now_.stuck ? -1 : int(-now_.direction);
  int directions[root_pitching_count] = {int(-now_.force), halts, 1, -1, 0, 0, -1, 0};
  const double switching = model_.next_switch();
  double stop = std::min(end_time_, switching);
  if (now_.stuck) stop = std::min(stop, stuck_until_);
  if (stop - now_.t < 1e-13 * std::max(now_.t, stop)) {
    now_.t = stop;
    if (stop == switching) switch_supply();
    return;
  }
  if (!steps.restart(now_.t, directions, std::min(model_.time_scale, stop - now_.t), stop)) {
    give_up({.kind = Evidence::integrator_not_started});
    return;
  }
  int branch_steps = 0;
  while (true) {
    const double from = now_.t;
    const Integrator::Outcome outcome = steps.advance();
    if (outcome == Integrator::Outcome::failed) {
      if (relative_tolerance_ < 1e-9) {
        relative_tolerance_ = tightest_ = 10.0 * relative_tolerance_;
        now_.force_known = true;
        return;
      }
      give_up({.kind = Evidence::integrator_failed, .angle = wrap_angle(now_.moving.angle), .time = now_.t});
      return;
    }
    now_.t = steps.time();
    model_.set(now_.t, y);
    if (measuring_) std::copy(y + model_.coupled, y + model_.coupled + quadrature_count, q_);
    step_taken(steps, from);

    bool branch_ends = false;
    if (outcome == Integrator::Outcome::root) {
      if (steps.found(root_jam)) {
        jam(now_.moving.angle);
        return;
      }
      if (steps.found(root_standstill)) {
        if (now_.stuck) {
          const StandingTorques<double> torques = model_.standing_torques(y);
          now_.direction =
              sign_of(2.0 * model_.vehicle.motor.torque_constant * now_.moving.current - torques.low - torques.high);
          now_.stuck = false;
          breaks_away_ = true;
          event(Kind::breakaway);
        } else {
          now_.moving.speed = 0.0;
          event(Kind::standstill);
        }
        branch_ends = true;
      }
      if (steps.found(root_force)) {
        event(Kind::force_sign_change);
        now_.force = -now_.force;
        now_.force_known = now_.moving.speed != 0.0;
        branch_ends = true;
      }
      if (measuring_) add_variation();
      if (model_.indices.pitching && steps.found(root_stop)) {
        meet_or_leave_stop();
        branch_ends = true;
        if (now_.jammed) return jam(now_.moving.angle);
      }
      if (steps.found(root_cycle)) branch_ends = cycle_done() || branch_ends;
    } else if (outcome == Integrator::Outcome::stop) {
      if (measuring_) add_variation();
      if (stop == switching && now_.t >= stop) switch_supply();
      branch_ends = true;
    } else {
      // Roots that the integrator may not see: a sign that was wrong from the start of the branch.
      if (now_.direction * now_.moving.speed < -1e-9 * model_.speed_scale) branch_ends = true;
      if (!model_.wingless && !now_.stuck && now_.force * last_force_switch_ < -1e-8) {
        now_.force = -now_.force;
        now_.force_known = true;
        branch_ends = true;
      }
      if (model_.indices.pitching && !now_.held &&
          std::abs(now_.moving.pitch_angle) > model_.vehicle.pitch.hinge.stop * (1.0 + 1e-9)) {
        meet_or_leave_stop();
        branch_ends = true;
        if (now_.jammed) return jam(now_.moving.angle);
      }
      if (!branch_ends && !now_.stuck && captured()) return;
    }
    if (done_ || swings_repeat() || branch_ends) return;
    if (out_of_budget()) return;
    if (!stiff_ && ++branch_steps > stiff_steps_per_branch) {
      stiff_ = result_.stiff = true;
      plain_.reset();
      with_quadratures_.reset();
      now_.force_known = true;
      return;
    }
  }
}

void CrankStartUp::meet_or_leave_stop() {
  if (measuring_) add_variation();
  const double lost = now_.impact_loss;
  model_.handle(TimeModel::stop);
  if (now_.impact_loss > lost) event(Kind::stop_impact);
  if (measuring_) add_variation();
}

void CrankStartUp::step_taken(Integrator& steps, double from) {
  swing_low_ = std::min(swing_low_, now_.moving.angle);
  swing_high_ = std::max(swing_high_, now_.moving.angle);
  window_low_ = std::min(window_low_, now_.moving.angle);
  window_high_ = std::max(window_high_, now_.moving.angle);
  track_inrush(steps, from);
  if (measuring_) track_extremes(steps, from);
  if (measuring_ && model_.indices.pitching) {
    pitching_.step_taken(model_, steps, from);
    const int last = options_.cycle_rows - 1;
    while (last > 0 && int(result_.cycle.size()) <= last) {
      const double since = crossings_.back().cycle * double(result_.cycle.size()) / last;
      if (measured_from_ + since > now_.t + 1e-6 * crossings_.back().cycle) break;
      const double* state = steps.dense(std::min(measured_from_ + since, now_.t));
      const Motion<double> m = model_.motion(measured_from_ + since, state);
      result_.cycle.push_back(waveform_row(model_.vehicle, m, since, state[0] - measured_angle_, state[1],
                                           stroke_angle(m.kinematics), state[model_.indices.pitch]));
    }
  }
  recorder_.step_taken({now_.t, now_.moving.angle, now_.moving.speed, now_.moving.current}, [&](double t) {
    const double* y = steps.dense(t);
    return TransientSample{t, y[0], y[1], model_.current_of(t, y)};
  });
}

void CrankStartUp::track_inrush(Integrator& steps, double from) {
  const auto slope = [&](double t) {
    double rates[5] = {};
    if (!model_.indices.inductive) rates[1] = steps.dense(t, 1)[1];
    return model_.current_slope(t, steps.dense(t), rates);
  };
  recorder_.note_current(now_.t, now_.moving.current);
  if (now_.moving.current < 0.9 * result_.inrush_current || slope(now_.t) >= 0.0 || slope(from) <= 0.0) return;
  const auto rises = [&](double t) { return slope(t) > 0.0; };
  const auto narrow = [&](const Bracket<double>& b) { return b.after - b.before <= 1e-9 * (now_.t - from); };
  const double top = bisect(rises, from, now_.t, narrow).before;
  recorder_.note_current(top, model_.current_of(top, steps.dense(top)));
}

/// Raises the extremes of the cycle to what they reach within the last step, on the integrator's own interpolant. A
/// heavy rotor takes long steps, however the stroke bends within a few degrees of the crank.
void CrankStartUp::track_extremes(Integrator& steps, double from) {
  constexpr double fine = 0.02;  // [rad]
  const double turned = std::abs(now_.moving.angle - steps.dense(from)[0]);
  raise_extremes(
      [&](double t) {
        const double* y = steps.dense(t);
        Mode<double> mode;
        const Motion<double> m = model_.motion(t, y, &mode);
        return extreme_candidates(m, y[1], mode);
      },
      from, now_.t, int(std::ceil(turned / fine)), extremes_);
}

}  // namespace wingbeat::detail
