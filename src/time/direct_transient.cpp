#include "time/direct_transient.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "time/integrator.hpp"
#include "time/recorder.hpp"
#include "time/transient_tools.hpp"
#include "wingbeat/cycle/direct_balance.hpp"

namespace wingbeat::detail {
namespace {

using Kind = TransientEvent::Kind;
constexpr double infinity = std::numeric_limits<double>::infinity();

enum Root { root_motion, root_stored_moment, root_velocity, root_count };  // the last two while measuring

constexpr double stiff_decays_per_period = 500.0;
constexpr int sticking_pieces = 512;    // of a period: how often a stuck shaft is looked at
constexpr int creep_periods = 8;        // of ever shorter slips in one direction, that end at rest
constexpr int contraction_periods = 4;  // over which the contraction is taken: complex multipliers make it uneven

class DirectStartUp {
 public:
  DirectStartUp(const Vehicle<double>& vehicle, const TransientOptions& options);
  TransientResult run();

 private:
  double voltage(double t) const { return vehicle_.voltage * std::sin(w_ * t); }
  double current_of(double t, const double* y) const {
    return inductive_ ? y[2] : algebraic_current(vehicle_, voltage(t), y[1]);
  }
  double springs_of(double beta) const { return vehicle_.wing_count * vehicle_.spring.stiffness * beta; }
  /// K i - N_w k beta [N m] at rest.
  double pull(double t, const double* y) const {
    const double i = inductive_ ? y[2] : algebraic_current(vehicle_, voltage(t), 0.0);
    return vehicle_.motor.torque_constant * i - springs_of(y[0]);
  }
  Branch<double> branch_at(const double* y) const;
  Motion<double> motion(double t, const double* y) const;
  bool rates(double t, const double* y, double* dy, bool measuring) const;
  void root_values(double t, const double* y, double* values, bool measuring) const;
  std::unique_ptr<Integrator> integrator(bool measuring);
  double wing_energy() const {
    return 0.5 * vehicle_.wing_count *
           (vehicle_.wing_inertia * square(y_[1]) + vehicle_.spring.stiffness * square(y_[0]));
  }

  void advance(double until);
  void come_to_rest();
  void step_taken(Integrator& steps, double from);
  WaveformRow row(double t, const double* y) const;
  void add_variation();
  void period_done();
  bool rests_for_good();
  bool creeps_to_rest();
  void begin_measuring();
  void take_metrics();
  bool out_of_budget();
  void give_up(const std::string& why);
  void event(Kind kind) { result_.events.push_back({t_, y_[0], kind}); }

  Vehicle<double> vehicle_;
  const TransientOptions& options_;
  TransientResult result_;
  Recorder recorder_{options_, result_};
  double w_, period_;
  bool inductive_, sticks_, stiff_ = false, done_ = false;
  int coupled_;
  double holding_torque_, drive_torque_;
  double stroke_scale_ = 1.0, speed_scale_ = 1.0, current_scale_ = 1.0;
  double relative_tolerance_ = 1e-9, tightest_ = 1e-13;
  double quadrature_scale_[quadrature_count] = {};

  double t_ = 0.0;
  double y_[3] = {};
  double q_[quadrature_count] = {};
  bool stuck_ = false;
  double direction_ = 1.0;  ///< of a slip, where there is constant friction
  std::unique_ptr<Integrator> plain_, with_quadratures_;

  bool measuring_ = false;
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
  double before_[3] = {};
  std::vector<double> changes_;
};

DirectStartUp::DirectStartUp(const Vehicle<double>& vehicle, const TransientOptions& options)
    : vehicle_(vehicle), options_(options) {
  validate(vehicle_.motor);
  validate(vehicle_.friction);
  validate(vehicle_.spring);
  validate(vehicle_.wings);
  require(vehicle_.voltage >= 0.0, "supply.amplitude", "must be >= 0", "V", vehicle_.voltage);
  require(vehicle_.drive_frequency > 0.0, "supply.frequency", "must be > 0", "Hz", vehicle_.drive_frequency);
  require(options.tolerance >= 1e-11 && options.tolerance <= 1e-2, "transient.tolerance",
          "must lie between 1e-11 and 1e-2", "1", options.tolerance);
  const Motor<double>& m = vehicle_.motor;
  w_ = two_pi * vehicle_.drive_frequency;
  period_ = 1.0 / vehicle_.drive_frequency;
  inductive_ = m.armature_inductance > 0.0;
  coupled_ = inductive_ ? 3 : 2;
  const DirectBalance balance = direct_balance(vehicle_);
  drive_torque_ = balance.drive_torque;
  holding_torque_ = balance.breakaway_torque;
  sticks_ = holding_torque_ > 0.0;

  const double inertia = m.inertia + vehicle_.wing_count * vehicle_.wing_inertia;
  const double natural = std::max(w_, std::sqrt(vehicle_.wing_count * vehicle_.spring.stiffness / inertia));
  y_[0] = options.crank_angle;
  y_[1] = options.crank_speed;
  y_[2] = inductive_ ? options.current : 0.0;
  speed_scale_ = balance.responses.empty() ? std::max(0.0, drive_torque_ - holding_torque_) / (inertia * w_)
                                           : std::abs(balance.responses.back().speed);
  speed_scale_ = std::max({speed_scale_, std::abs(y_[1]), std::abs(y_[0]) * natural});
  if (!(speed_scale_ > 0.0)) speed_scale_ = 1.0;
  stroke_scale_ = std::max(speed_scale_ / natural, std::abs(y_[0]));
  current_scale_ = std::max({drive_torque_ / m.torque_constant, std::abs(y_[2]),
                             1e-3 * m.torque_constant * speed_scale_ / m.armature_resistance});

  const double damping = m.viscous_damping + vehicle_.friction.damping;
  const double fastest = inductive_ ? std::max(m.armature_resistance / m.armature_inductance, damping / inertia)
                                    : (damping + square(m.torque_constant) / m.armature_resistance) / inertia;
  stiff_ = fastest * period_ > stiff_decays_per_period;
  result_.stiff = stiff_;
  relative_tolerance_ = std::max(tightest_, (stiff_ ? 1e-3 : 3e-3) * options.tolerance);

  const double power = current_scale_ * (m.torque_constant * speed_scale_ + current_scale_ * m.armature_resistance);
  const auto size = [&](Integral which) {
    switch (which) {
      case Integral::current: return current_scale_;
      case Integral::current_square: return square(current_scale_);
      case Integral::speed_square: return square(speed_scale_);
      case Integral::lift:
        return vehicle_.wings.air_density * vehicle_.wings.s2 * square(speed_scale_) +
               1e-6 * m.torque_constant * current_scale_;
      case Integral::rod_force: return m.torque_constant * current_scale_;
      default: return power;
    }
  };
  for (int k = 0; k < quadrature_count; ++k) quadrature_scale_[k] = period_ * size(quadratures[k]);
}

Branch<double> DirectStartUp::branch_at(const double* y) const {
  const double way = sticks_ ? direction_ : sign_of(y[1]);
  return {way, 1.0, way, 1.0, sign_of(pitch_margin(vehicle_.wings, std::abs(y[1])))};
}

Motion<double> DirectStartUp::motion(double t, const double* y) const {
  const double i = current_of(t, y), v = voltage(t), springs = springs_of(y[0]);
  const Branch<double> branch = branch_at(y);
  const double omega = stuck_ ? 0.0 : y[1];
  const Instant<double> at = instant_at(vehicle_, direct_kinematics<double>(), springs, omega, i, v, branch.stroke,
                                        branch.direction, branch.pitching);
  Motion<double> m = motion_on(vehicle_, at, i, v, branch);
  if (stuck_) {
    m.crank_acceleration = m.stroke_acceleration = 0.0;
    m.rod_force = m.stored_moment = springs;
    m.motor_torque = at.motor.torque;
    m.friction_torque = at.motor.torque - springs;
  }
  return m;
}

bool DirectStartUp::rates(double t, const double* y, double* dy, bool measuring) const {
  const Motion<double> m = motion(t, y);
  dy[0] = m.stroke_velocity;
  dy[1] = m.crank_acceleration;
  if (inductive_) dy[2] = m.voltage_reserve / vehicle_.motor.armature_inductance;
  if (measuring) {
    const CycleIntegrals<double> all = integrands(m, m.stroke_velocity, branch_at(y));
    for (int k = 0; k < quadrature_count; ++k) dy[coupled_ + k] = all[std::size_t(quadratures[k])];
  }
  return std::isfinite(dy[1]) && std::isfinite(y[coupled_ - 1]);
}

void DirectStartUp::root_values(double t, const double* y, double* values, bool measuring) const {
  values[root_motion] = !sticks_ ? 1.0
                        : stuck_ ? (holding_torque_ - std::abs(pull(t, y))) / holding_torque_
                                 : y[1] / speed_scale_;
  if (!measuring) return;
  const double torque = vehicle_.motor.torque_constant * current_scale_;
  values[root_stored_moment] = stuck_ ? 1.0 : motion(t, y).stored_moment / torque;
  values[root_velocity] = stuck_ ? 1.0 : y[1] / speed_scale_;
}

std::unique_ptr<Integrator> DirectStartUp::integrator(bool measuring) {
  IntegratorProblem p;
  p.size = coupled_ + (measuring ? quadrature_count : 0);
  p.coupled = coupled_;
  p.roots = measuring ? int(root_count) : 1;
  p.stiff = stiff_;
  p.rates = [this, measuring](double t, const double* y, double* dy) {
    ++result_.rate_evaluations;
    return rates(t, y, dy, measuring);
  };
  p.root_functions = [this, measuring](double t, const double* y, double* values) {
    root_values(t, y, values, measuring);
  };
  p.tolerated = [this, measuring](const double* y, double* errors) {
    errors[0] = relative_tolerance_ * (std::abs(y[0]) + 0.01 * stroke_scale_);
    errors[1] = relative_tolerance_ * (std::abs(y[1]) + 0.01 * speed_scale_);
    if (inductive_) errors[2] = relative_tolerance_ * (std::abs(y[2]) + 0.01 * current_scale_);
    for (int k = 0; measuring && k < quadrature_count; ++k) {
      errors[coupled_ + k] = relative_tolerance_ * (std::abs(y[coupled_ + k]) + 0.01 * quadrature_scale_[k]);
    }
  };
  p.longest_step = 0.25 * period_;
  p.typical = {stroke_scale_, speed_scale_, current_scale_};
  return make_integrator(options_.integrator, std::move(p));
}

/// The shaft has come to rest where constant friction acts: it is held, or moves on where it is pulled.
void DirectStartUp::come_to_rest() {
  y_[1] = 0.0;
  const double torque = pull(t_, y_);
  const bool was_stuck = stuck_;
  stuck_ = std::abs(torque) <= holding_torque_;
  direction_ = sign_of(torque);
  if (was_stuck && !stuck_) event(Kind::breakaway);
}

/// Integrates to an event or to the time `until`.
void DirectStartUp::advance(double until) {
  if (stuck_) until = std::min(until, t_ + period_ / sticking_pieces);
  if (until - t_ < 1e-13 * until) {
    t_ = until;
    return;
  }
  std::unique_ptr<Integrator>& slot = measuring_ ? with_quadratures_ : plain_;
  if (!slot) slot = integrator(measuring_);
  Integrator& steps = *slot;
  double* y = steps.state();
  std::copy(y_, y_ + coupled_, y);
  if (measuring_) std::copy(q_, q_ + quadrature_count, y + coupled_);
  int directions[root_count] = {stuck_ ? -1 : int(-direction_), 0, 0};
  if (!steps.restart(t_, directions, std::min(period_, until - t_), until)) {
    give_up("the integrator could not be started");
    return;
  }
  while (!done_) {
    const double from = t_;
    const Integrator::Outcome outcome = steps.advance();
    if (outcome == Integrator::Outcome::failed) {
      if (relative_tolerance_ < 1e-9) {
        relative_tolerance_ = tightest_ = 10.0 * relative_tolerance_;
        return;
      }
      give_up(format("the integrator failed at t = %.6g s", t_));
      return;
    }
    t_ = steps.time();
    std::copy(y, y + coupled_, y_);
    if (measuring_) std::copy(y + coupled_, y + coupled_ + quadrature_count, q_);
    step_taken(steps, from);
    if (outcome == Integrator::Outcome::stop) return;
    if (outcome == Integrator::Outcome::root) {
      if (measuring_) add_variation();
      if (steps.found(root_motion)) {
        if (stuck_) {
          stuck_ = false;
          direction_ = sign_of(pull(t_, y_));
          event(Kind::breakaway);
        } else {
          event(Kind::standstill);
          come_to_rest();
        }
        return;
      }
    } else if (sticks_ && !stuck_ && direction_ * y_[1] < -1e-9 * speed_scale_) {
      // A reversal that the integrator did not see.
      come_to_rest();
      return;
    }
    if (out_of_budget()) return;
  }
}

WaveformRow DirectStartUp::row(double t, const double* y) const {
  const Motion<double> m = motion(t, y);
  return waveform_row(vehicle_, m, t - double(result_.laps) * period_, y[0], m.stroke_velocity, y[0]);
}

void DirectStartUp::step_taken(Integrator& steps, double from) {
  swing_ = std::max(swing_, std::abs(y_[0]));
  travel_[y_[0] > stroke_before_] += std::abs(y_[0] - stroke_before_);
  stroke_before_ = y_[0];
  recorder_.note_current(t_, std::abs(current_of(t_, y_)));
  if (measuring_) {
    raise_extremes(
        [&](double t) {
          const double* y = steps.dense(t);
          const Motion<double> m = motion(t, y);
          return extreme_candidates(m, m.stroke_velocity, branch_at(y), y[0]);
        },
        from, t_, extremes_);
    const int last = options_.cycle_rows - 1;
    while (last > 0 && int(result_.cycle.size()) <= last) {
      const double at = period_ * (result_.laps + double(result_.cycle.size()) / last);
      if (at > t_ + 1e-12 * period_) break;
      result_.cycle.push_back(row(std::min(at, t_), steps.dense(std::min(at, t_))));
    }
  }
  recorder_.step_taken({t_, y_[0], y_[1], current_of(t_, y_)}, [&](double t) {
    const double* y = steps.dense(t);
    return TransientSample{t, y[0], y[1], current_of(t, y)};
  });
}

void DirectStartUp::add_variation() {
  const double energy = wing_energy();
  variation_ += std::abs(energy - energy_mark_);
  energy_mark_ = energy;
}

void DirectStartUp::begin_measuring() {
  measuring_ = true;
  std::fill(std::begin(q_), std::end(q_), 0.0);
  extremes_.fill(-infinity);
  variation_ = 0.0;
  energy_mark_ = wing_energy();
  result_.cycle.clear();
}

void DirectStartUp::take_metrics() {
  add_variation();
  CycleIntegrals<double>& integrals = result_.integrals;
  for (int k = 0; k < quadrature_count; ++k) integrals[std::size_t(quadratures[k])] = q_[k];
  integrals[std::size_t(Integral::time)] = period_;
  integrals[std::size_t(Integral::reactive_work)] = variation_;
  result_.metrics = cycle_metrics(vehicle_, integrals, extremes_, absent, options_.reporting);
  result_.averaged_laps = 1;
}

/// True, with the verdict, where nothing moves the shaft any more.
bool DirectStartUp::rests_for_good() {
  const Motor<double>& m = vehicle_.motor;
  const bool no_drive = vehicle_.voltage == 0.0 && std::abs(y_[1]) < 1e-9 * speed_scale_ &&
                        std::abs(y_[0]) < 1e-9 * stroke_scale_ && swing_ < 1e-9 * stroke_scale_;
  double held = infinity;
  if (stuck_) {
    // The current is a sine and what remains of its start.
    const double Z = std::hypot(m.armature_resistance, w_ * m.armature_inductance);
    const double lag = std::atan2(w_ * m.armature_inductance, m.armature_resistance);
    const double remains = inductive_ ? std::abs(y_[2] - vehicle_.voltage / Z * std::sin(w_ * t_ - lag)) : 0.0;
    held = drive_torque_ + std::abs(springs_of(y_[0])) + m.torque_constant * remains;
  }
  if (held > holding_torque_ && !no_drive) return false;
  done_ = true;
  result_.settled = true;
  result_.status = FlappingStatus::stalled;
  result_.time_to_steady = t_;
  result_.lock_angle = y_[0];
  result_.torque_margin = stuck_ ? holding_torque_ - held : 0.0;
  result_.detail = stuck_ ? format(
                                "rests at stroke angle %.4f deg: the constant friction %.4g N m holds %.4g N m, "
                                "all that supply and springs apply at most",
                                y_[0] * degrees_per_radian, holding_torque_, held)
                          : std::string("no voltage: nothing moves the wings");
  return true;
}

/// True, with the verdict, where the drive alone cannot break the shaft away and the springs let it creep towards an
/// angle of rest: from standstill to standstill the angle is a monotone map of itself, and slips in one direction end
/// where there are none.
bool DirectStartUp::creeps_to_rest() {
  const double travel = std::max(travel_[0], travel_[1]), back = std::min(travel_[0], travel_[1]);
  const bool creeps = stuck_ && drive_torque_ <= holding_torque_ && travel < last_travel_ && back <= 1e-6 * travel;
  creeping_ = creeps ? creeping_ + 1 : 0;
  last_travel_ = travel;
  travel_[0] = travel_[1] = 0.0;
  if (creeping_ < creep_periods) return false;
  done_ = true;
  result_.settled = true;
  result_.status = FlappingStatus::stalled;
  result_.time_to_steady = t_;
  result_.lock_angle = y_[0];
  result_.torque_margin = holding_torque_ - drive_torque_;
  result_.detail = format(
      "creeps to rest near stroke angle %.4f deg, the last period by %.2g deg: the supply gives a torque "
      "of %.4g N m at most, which does not exceed the constant friction %.4g N m",
      y_[0] * degrees_per_radian, travel * degrees_per_radian, drive_torque_, holding_torque_);
  return true;
}

void DirectStartUp::period_done() {
  ++result_.laps;
  event(Kind::revolution);
  swings_.push_back(swing_);
  swing_ = std::abs(y_[0]);
  if (rests_for_good() || creeps_to_rest()) return;

  const double scale[3] = {stroke_scale_, speed_scale_, current_scale_};
  double change = 0.0;
  for (int n = 0; n < coupled_; ++n) {
    // Without springs nothing returns the shaft to any angle.
    if (n == 0 && !(vehicle_.spring.stiffness > 0.0)) continue;
    change = std::max(change, std::abs(y_[n] - before_[n]) / scale[n]);
  }
  std::copy(y_, y_ + coupled_, before_);
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
  if (measuring_) {
    // The metrics of a period of looser steps tell how far its own steps leave them off.
    const std::optional<Metrics<double>> before = std::exchange(last_metrics_, std::nullopt);
    take_metrics();
    const bool tightest = relative_tolerance_ <= tightest_;
    const bool agree = before && (tightest || relative_tolerance_ < 0.2 * measured_with_) &&
                       metrics_apart(*before, *result_.metrics) < 0.3 * options_.tolerance;
    periods_at_tightest_ += tightest && change < 10.0 * noise;
    if (((close || change < noise) && agree) || periods_at_tightest_ > 40) {
      done_ = true;
      result_.closure = std::min(off, change / (1.0 - std::min(rate, 0.999)));
      result_.settled = true;
      result_.status = FlappingStatus::flapping;
      std::size_t first = swings_.size();
      while (first > 0 && std::abs(swings_[first - 1] / swings_.back() - 1.0) <= 1e-2) --first;
      result_.time_to_steady = double(first) * period_;
      result_.crank_speed = y_[1];
      result_.current = current_of(t_, y_);
      result_.stroke_angle = y_[0];
      result_.detail = format(
          "flaps steadily at the supply's %.6g Hz from %.4g s on; after %d periods they repeat to "
          "%.1g",
          vehicle_.drive_frequency, result_.time_to_steady, result_.laps, change);
      return;
    }
    last_metrics_ = std::exchange(result_.metrics, std::nullopt);
    measured_with_ = relative_tolerance_;
    if (close || change < noise) relative_tolerance_ = std::max(tightest_, relative_tolerance_ / 10.0);
  }
  if (rate < 1.0 && off < 1e-2) {
    // What a period's errors leave behind adds up over 1 / (1 - rate) periods.
    relative_tolerance_ = std::min(relative_tolerance_, std::max(tightest_, 3e-3 * options_.tolerance * (1.0 - rate)));
  }
  if (close || change < noise || measuring_) begin_measuring();
  if (result_.laps >= options_.max_laps) {
    give_up(format("successive periods still differ by %.2g after %d periods", change, options_.max_laps));
  }
}

bool DirectStartUp::out_of_budget() {
  ++result_.steps;
  if (result_.steps > options_.max_steps) {
    give_up(format("no verdict within %ld integration steps", options_.max_steps));
  } else if (options_.cancel && result_.steps % 512 == 0 && options_.cancel()) {
    give_up("cancelled");
  } else if (options_.max_time > 0.0 && t_ >= options_.max_time) {
    give_up(format("no verdict within %.6g s", options_.max_time));
  }
  return done_;
}

void DirectStartUp::give_up(const std::string& why) {
  done_ = true;
  result_.settled = false;
  result_.status = FlappingStatus::undecided;
  result_.time_to_steady = t_;
  result_.detail = why;
}

TransientResult DirectStartUp::run() {
  if (sticks_) {
    direction_ = sign_of(y_[1]);
    if (y_[1] == 0.0) come_to_rest();
  }
  std::copy(y_, y_ + 3, before_);
  swing_ = std::abs(y_[0]);
  stroke_before_ = y_[0];
  recorder_.start(std::abs(current_of(0.0, y_)));
  recorder_.sample({t_, y_[0], y_[1], current_of(t_, y_)});
  while (!done_) {
    const double end = double(result_.laps + 1) * period_;
    const double until = options_.max_time > 0.0 ? std::min(end, options_.max_time) : end;
    advance(until);
    if (done_) break;
    if (t_ >= end) {
      period_done();
    } else if (stuck_ && rests_for_good()) {
      break;
    } else {
      out_of_budget();
    }
  }
  result_.end_time = t_;
  result_.end_crank_angle = y_[0];
  return std::move(result_);
}

}  // namespace

TransientResult simulate_direct_start_up(const Vehicle<double>& vehicle, const TransientOptions& options) {
  return DirectStartUp(vehicle, options).run();
}

}  // namespace wingbeat::detail
