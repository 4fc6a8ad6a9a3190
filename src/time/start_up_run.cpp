#include "time/start_up_run.hpp"

#include <cmath>
#include <utility>

namespace wingbeat::detail {

std::array<double, CycleModel::indicator_count> CycleModel::indicators(double t, const double* y) const {
  std::array<double, indicator_count> all;
  const auto own = TimeModel::indicators(t, y);
  std::copy(own.begin(), own.end(), all.begin());
  // Kinks of what is summed up, and under the pitch law hardly of the loads.
  if (!measuring) all[stored_moment] = 1.0;
  if (!measuring && !pitches(vehicle)) all[reversal] = 1.0;
  all[cycle_end] = direct ? -1.0 : y[0] - next_cycle;
  return all;
}

std::array<int, CycleModel::indicator_count> CycleModel::directions() const {
  std::array<int, indicator_count> all;
  const auto own = TimeModel::directions();
  std::copy(own.begin(), own.end(), all.begin());
  all[cycle_end] = 1;
  return all;
}

StartUpRun::StartUpRun(const Vehicle<double>& vehicle, const Supply<double>& supply, const TransientOptions& options,
                       double per_tolerance, double per_tolerance_if_stiff)
    : options_(options), model_(vehicle, supply) {
  require(options.tolerance >= 1e-11 && options.tolerance <= 1e-2, "transient.tolerance",
          "must lie between 1e-11 and 1e-2", "1", options.tolerance);
  require(options.max_time >= 0.0, "transient.max_time", "must be >= 0", "s", options.max_time);
  require(options.record_interval >= 0.0, "transient.record_interval", "must be >= 0", "s", options.record_interval);
  const Coordinates<double>& c = options.start;
  require(std::isfinite(c.angle), "transient.crank_angle", "must be finite", "rad", c.angle);
  require(std::isfinite(c.speed), "transient.crank_speed", "must be finite", "rad/s", c.speed);
  require(std::isfinite(c.pitch_angle), "transient.pitch_angle", "must be finite", "rad", c.pitch_angle);
  require(std::isfinite(c.pitch_velocity), "transient.pitch_velocity", "must be finite", "rad/s", c.pitch_velocity);
  require(std::isfinite(c.current), "transient.current", "must be finite", "A", c.current);

  const bool given = c.angle != 0.0 || c.speed != 0.0;
  if (!given && model_.direct) options_.start.angle = vehicle.spring.rest_angle;
  model_.start(options_.start);
  const Vehicle<double>& v = model_.vehicle;
  const double current = model_.current_scale, speed = model_.speed_scale, K = v.motor.torque_constant;
  const double slope = model_.direct ? 1.0 : typical_stroke_slope(v.transmission);
  const double torque = is_given(v.piezo) ? model_.drive_torque : K * current;
  const double force = torque / (model_.direct ? 1.0 : typical_crank_lever(v.transmission));
  const double power = torque * speed + square(current) * circuit_resistance(v);
  const auto size = [&](Integral which) {
    switch (which) {
      case Integral::current: return current;
      case Integral::current_square: return square(current);
      case Integral::speed_square: return square(speed);
      case Integral::travel: return speed;
      case Integral::lift: return v.wings.air_density * v.wings.s2 * square(speed * slope) + 1e-6 * force;
      case Integral::rod_force: return force;
      default: return power;
    }
  };
  for (int k = 0; k < quadrature_count; ++k) quadrature_scale_[k] = model_.time_scale * size(quadratures[k]);

  stiff_ = result_.stiff = model_.stiff();
  relative_tolerance_ = std::max(tightest_, (stiff_ ? per_tolerance_if_stiff : per_tolerance) * options.tolerance);
}

Integrator& StartUpRun::integrator() {
  const bool measuring = model_.measuring;
  std::unique_ptr<Integrator>& slot = measuring ? with_quadratures_ : plain_;
  if (slot) return *slot;
  IntegratorProblem p = problem_of(model_, relative_tolerance_);
  if (measuring) add_quadratures(p, model_, relative_tolerance_, quadrature_scale_);
  p.roots = int(CycleModel::indicator_count);
  p.stiff = stiff_;
  p.rates = [this, measuring](double t, const double* y, double* dy) {
    ++result_.rate_evaluations;
    return model_.rates(t, y, dy, measuring);
  };
  p.root_functions = [this](double t, const double* y, double* values) {
    const auto indicators = model_.indicators(t, y);
    std::copy(indicators.begin(), indicators.end(), values);
  };
  p.longest_step = model_.longest_moving_step();
  slot = make_integrator(which_integrator(), std::move(p));
  return *slot;
}

void StartUpRun::pass(double until) {
  switch (pass_piece(model_, until, *this, [this]() -> Integrator& { return integrator(); })) {
    case PieceOutcome::not_started: return give_up({.kind = Evidence::integrator_not_started});
    case PieceOutcome::failed:
      if (relative_tolerance_ < 1e-9) {
        relative_tolerance_ = tightest_ = 10.0 * relative_tolerance_;
        now_.force_known = now_.moving.speed != 0.0;
        return;
      }
      return give_up({.kind = Evidence::integrator_failed,
                      .angle = model_.direct ? now_.moving.angle : wrap_angle(now_.moving.angle),
                      .time = now_.t});
    case PieceOutcome::event: ++window_events_; return;
    default: return;
  }
}

std::optional<double> StartUpRun::stepped(const TimeModel&, Integrator& steps, double from) {
  step_taken(steps, from);
  if (model_.measuring && pitches(model_.vehicle)) pitching_.step_taken(model_, steps, from);
  recorder_.step_taken({now_.t, now_.moving.angle, now_.moving.speed, now_.moving.current}, [&](double t) {
    const double* y = steps.dense(t);
    return TransientSample{t, y[0], y[1], model_.current_of(t, y)};
  });
  return std::nullopt;
}

bool StartUpRun::happened(const TimeModel&, Kind kind) {
  event(kind);
  return done_;
}

void StartUpRun::cycle_begins() {
  last_cycle_steps_ = result_.steps - cycle_from_step_;
  cycle_from_step_ = result_.steps;
}

/// Ten times tighter steps are less than twice as many. Where there are far more of them, they follow the rounding of
/// what a small inductance divides.
void StartUpRun::loosen_where_rounding_shows() {
  constexpr long far_more = 5;
  if (!stiff_ || last_cycle_steps_ == 0 || relative_tolerance_ > 1e-10) return;
  if (result_.steps - cycle_from_step_ <= far_more * last_cycle_steps_) return;
  relative_tolerance_ = tightest_ = 10.0 * relative_tolerance_;
  cycle_from_step_ = result_.steps;
}

/// Steps so short, or events so dense, that no cycle comes to its end.
bool StartUpRun::stands_still() {
  constexpr long max_steps = 400000;    // within the time of a cycle
  constexpr long steps_per_event = 16;  // that it takes to locate one and to restart from it
  if (now_.t - window_from_ >= model_.time_scale) {
    window_from_ = now_.t;
    window_from_step_ = result_.steps;
    window_events_ = 0;
  }
  return result_.steps - window_from_step_ + steps_per_event * window_events_ > max_steps;
}

bool StartUpRun::steps_spent() {
  ++result_.steps;
  loosen_where_rounding_shows();
  if (result_.steps > options_.max_steps) give_up({.kind = Evidence::out_of_steps, .steps = options_.max_steps});
  else if (stands_still()) give_up({.kind = Evidence::out_of_steps, .steps = result_.steps});
  else if (options_.cancel && result_.steps % 512 == 0 && options_.cancel()) give_up({.kind = Evidence::cancelled});
  return done_;
}

/// True where cycles come no nearer to each other. Whatever settles within `max_cycles` more than halves its changes
/// over the cycles watched.
bool StartUpRun::never_repeats() const {
  constexpr std::ptrdiff_t watched = 250;
  constexpr double far = 1e-2;
  const auto end = changes_.end();
  if (changes_.size() < 4 * watched || changes_.size() % watched != 0) return false;
  const double least = *std::min_element(end - watched, end);
  return least > far && least > 0.5 * *std::min_element(end - 2 * watched, end - watched);
}

/// From now on, with implicit steps.
void StartUpRun::take_stiff() {
  stiff_ = result_.stiff = true;
  plain_.reset();
  with_quadratures_.reset();
  now_.force_known = now_.moving.speed != 0.0;
}

void StartUpRun::begin_measuring() {
  model_.measuring = true;
  model_.totals.fill(0.0);
  extremes_.fill(-infinity);
  variation_ = 0.0;
  energy_mark_ = model_.wing_energy();
  motor_mark_ = model_.motor_energy();
  stored_mark_ = model_.stored_energy();
  impulses_mark_ = now_.impulses;
  measured_from_ = now_.t;
  result_.cycle.clear();
  pitching_.begin(model_);
}

void StartUpRun::add_variation() {
  const double energy = model_.wing_energy();
  variation_ += std::abs(energy - energy_mark_);
  energy_mark_ = energy;
}

void StartUpRun::take_metrics(double start, double end, int cycles) {
  add_variation();
  CycleIntegrals<double>& integrals = result_.integrals;
  for (int k = 0; k < quadrature_count; ++k) {
    const auto which = std::size_t(quadratures[k]);
    integrals[which] = (model_.totals[std::size_t(k)] + now_.impulses[which] - impulses_mark_[which]) / cycles;
  }
  integrals[std::size_t(Integral::time)] = (end - start) / cycles;
  integrals[std::size_t(Integral::reactive_work)] = variation_ / cycles;
  set_gear_work(model_.vehicle.motor, (model_.motor_energy() - motor_mark_) / cycles, integrals);
  result_.metrics = cycle_metrics(model_.vehicle, integrals, extremes_, absent, options_.reporting);
  if (pitches(model_.vehicle)) pitching_.finish(model_, start, end, cycles, *result_.metrics);
  result_.averaged_cycles = cycles;
}

void StartUpRun::give_up_open_balance(const EnergyAudit& audit) {
  result_.metrics.reset();
  give_up({.kind = Evidence::open_balance, .change = std::abs(audit.imbalance / audit.electrical)});
}

void StartUpRun::track_extremes(Integrator& steps, double from, int intervals) {
  raise_extremes(
      [&](double t) {
        const double* y = steps.dense(t);
        Mode<double> mode;
        const Motion<double> m = model_.motion(t, y, &mode);
        return model_.direct ? extreme_candidates(m, m.stroke_velocity, mode, y[0]) : extreme_candidates(m, y[1], mode);
      },
      from, now_.t, intervals, extremes_);
}

void StartUpRun::take_rows(Integrator& steps, double start, double period, double angle_0, double slack) {
  const int last = options_.cycle_rows - 1;
  while (last > 0 && int(result_.cycle.size()) <= last) {
    const double since = period * double(result_.cycle.size()) / last, t = start + since;
    if (t > now_.t + slack * period) return;
    const double* y = steps.dense(std::min(t, now_.t));
    take_row(since, y, model_.motion(t, y), angle_0);
  }
}

void StartUpRun::take_row(double since, const double* y, const Motion<double>& m, double angle_0) {
  result_.cycle.push_back(waveform_row(model_.vehicle, m, since, y[0] - angle_0,
                                       model_.direct ? m.stroke_velocity : y[1],
                                       stroke_angle_at(model_.vehicle, m.kinematics, y[0]),
                                       pitches(model_.vehicle) ? local_pitch(model_.indices.coordinates(y)) : absent));
}

void StartUpRun::end_rows(double start, double angle_0) {
  std::vector<WaveformRow>& rows = result_.cycle;
  if (rows.empty() || int(rows.size()) < options_.cycle_rows - 1) return;
  const double end = now_.t - start;
  if (int(rows.size()) == options_.cycle_rows) {
    if (std::abs(rows.back().time - end) > 1e-3 * end) return;
    rows.pop_back();
  }
  take_row(end, model_.coordinates_now().data(), model_.motion_now(), angle_0);
}

double StartUpRun::shaken_until() const {
  const PitchingWings<double>& wings = model_.vehicle.pitch;
  const double stiffness = is_clamped(wings.hinge) ? wings.torsion.stiffness : wings.hinge.stiffness;
  const double own = two_pi * std::sqrt((wings.pitch_inertia + wings.air.pp) / stiffness);
  return now_.t + 3.0 * own + 2.0 * model_.drive_period + 20.0 * model_.electrical_time;
}

}  // namespace wingbeat::detail
