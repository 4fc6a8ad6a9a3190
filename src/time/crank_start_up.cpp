#include "time/crank_start_up.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wingbeat/core/root.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

// A piece that takes more steps is taken as stiff whatever the estimate said.
constexpr int stiff_steps_per_piece = 2000;

}  // namespace

CrankStartUp::CrankStartUp(const Vehicle<double>& vehicle, const TransientOptions& options)
    : StartUpRun(vehicle, options.supply.value_or(Supply<double>{SupplyType::constant, vehicle.voltage, 0.0, 1.0}),
                 options, 1e-2, 3e-3) {
  if (options.arrived) options_.metrics = false;
  if (options.supply && options.supply->type == SupplyType::pwm && model_.supply.type == SupplyType::constant) {
    result_.current_ripple = 0.0;
  }
}

void CrankStartUp::prepare() {
  const Vehicle<double>& vehicle = model_.vehicle;
  const double R = circuit_resistance(vehicle), K = vehicle.motor.torque_constant;
  const double cycle = model_.time_scale, drive = model_.drive_period;
  const double mechanical = model_.mechanical_time, electrical = model_.electrical_time;
  swing_low_ = swing_high_ = now_.moving.angle;
  const double released = 0.5 * pi * std::sqrt(vehicle.wing_count * vehicle.spring.stiffness / vehicle.motor.inertia);
  runaway_speed_ = 1e3 * std::max({model_.speed_scale, std::abs(now_.moving.speed),
                                   std::abs(now_.moving.current) * R / K, released});
  loosest_ = relative_tolerance_;

  end_time_ = options_.max_time > 0.0                  ? options_.max_time
              : model_.supply.type == SupplyType::sine ? 50.0 * (cycle + drive) + 100.0 * (mechanical + electrical)
                                                       : 1000.0 * (cycle + mechanical + electrical + drive);

  window_ = std::max({cycle, 8.0 * drive, 0.5 * mechanical, electrical});
  window_end_ = window_;
  window_low_ = window_high_ = now_.moving.angle;

  model_.next_cycle = two_pi * (std::floor(now_.moving.angle / two_pi) + 1.0);
  recorder_.start(now_.moving.current);
  recorder_.sample({now_.t, now_.moving.angle, now_.moving.speed, now_.moving.current});
}

TimeIntegrator CrankStartUp::which_integrator() const {
  // A switched supply ends a branch every few microseconds: steps that keep their length from one branch to the next
  // beat those that find their order and length again on each.
  const bool own = options_.integrator == TimeIntegrator::automatic && model_.supply.type == SupplyType::pwm;
  return own ? TimeIntegrator::own_steps : options_.integrator;
}

TransientResult CrankStartUp::run() {
  prepare();
  if (now_.jammed) jam(now_.moving.angle);
  while (!done_) {
    pass(end_time_);
    if (!done_) out_of_budget();
  }
  result_.end_time = now_.t;
  result_.end_crank_angle = now_.moving.angle;
  result_.cycles = int(crossings_.size());
  if (!crossings_.empty()) {
    result_.state = crossings_.back().state;
    result_.state.angle = 0.0;
    result_.crank_speed = result_.state.speed;
    result_.current = result_.state.current;
  }
  return std::move(result_);
}

double CrankStartUp::piece_end(const TimeModel&, double stop) {
  piece_steps_ = 0;
  if (!now_.stuck) {
    stuck_until_ = infinity;
    return stop;
  }
  if (stands_for_good()) return now_.t;
  return std::min(stop, stuck_until_);
}

bool CrankStartUp::happened(const TimeModel&, Kind kind) {
  switch (kind) {
    case Kind::revolution: return cycle_done();
    case Kind::supply_switch: supply_switched(); return done_;
    case Kind::jam: jam(now_.moving.angle); return true;
    default: event(kind); return done_;
  }
}

bool CrankStartUp::enough(const TimeModel&, bool plain) {
  if (done_) return true;
  if (!now_.stuck && ((plain && captured()) || swings_repeat())) return true;
  if (plain && out_of_budget()) return true;
  if (stiff_ || !plain || ++piece_steps_ <= stiff_steps_per_piece) return false;
  take_stiff();
  return true;
}

bool CrankStartUp::out_of_budget() {
  if (steps_spent()) return true;
  if (std::abs(now_.moving.speed) > runaway_speed_) {
    give_up({.kind = Evidence::runs_away, .crank_speed = now_.moving.speed});
  } else if (now_.t >= end_time_) {
    give_up({.kind = Evidence::out_of_time, .time = end_time_});
  }
  return done_;
}

void CrankStartUp::supply_switched() {
  const double i = current_before_, duty = model_.supply.duty;
  if (now_.switches % 2 == 1) {
    ripple_top_ = i;
  } else {
    if (model_.measuring && std::isfinite(ripple_bottom_)) {
      const double line = ripple_bottom_ + duty * (i - ripple_bottom_);
      ripple_sum_ += ripple_top_ - line;
      ++ripple_count_;
    }
    ripple_bottom_ = model_.measuring ? i : absent;
  }
  if (options_.record) {
    event(Kind::supply_switch);
    recorder_.sample({now_.t, now_.moving.angle, now_.moving.speed, now_.moving.current});
  }
  recorder_.note_current(now_.t, now_.moving.current);
}

void CrankStartUp::step_taken(Integrator& steps, double from) {
  swing_low_ = std::min(swing_low_, now_.moving.angle);
  swing_high_ = std::max(swing_high_, now_.moving.angle);
  window_low_ = std::min(window_low_, now_.moving.angle);
  window_high_ = std::max(window_high_, now_.moving.angle);
  track_inrush(steps, from);
  if (!model_.measuring) return;
  // A heavy rotor takes long steps, however the stroke bends within a few degrees of the crank.
  constexpr double fine = 0.02;  // [rad]
  track_extremes(steps, from, int(std::ceil(std::abs(now_.moving.angle - steps.dense(from)[0]) / fine)));
  if (!crossings_.empty()) take_rows(steps, measured_from_, crossings_.back().cycle, measured_angle_, 1e-6);
}

void CrankStartUp::track_inrush(Integrator& steps, double from) {
  const auto slope = [&](double t) {
    double rates[max_unknowns] = {};
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

}  // namespace wingbeat::detail
