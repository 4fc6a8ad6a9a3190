#include "wingbeat/time/transient.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "time/direct_transient.hpp"
#include "time/integrator.hpp"
#include "time/transient_tools.hpp"
#include "wingbeat/cycle/static_balance.hpp"

namespace wingbeat {

const char* name_of(TransientEvent::Kind kind) {
  switch (kind) {
    case TransientEvent::Kind::force_sign_change: return "force-sign-change";
    case TransientEvent::Kind::standstill: return "standstill";
    case TransientEvent::Kind::breakaway: return "breakaway";
    case TransientEvent::Kind::revolution: return "revolution";
    case TransientEvent::Kind::jam: return "jam";
    case TransientEvent::Kind::supply_switch: return "supply-switch";
  }
  return "unknown";
}

namespace {

using Kind = TransientEvent::Kind;
constexpr double infinity = std::numeric_limits<double>::infinity();

enum Root { root_force, root_standstill, root_lap, root_jam, root_plain_count };
enum { root_stored_moment = root_plain_count, root_dead_centre, root_measuring_count };

// A lap holds some hundred steps of Adams at usual tolerances; only if the fastest decay is much quicker than that do
// the larger steps of BDF make up for its lower order. A branch that takes Adams more steps than the last number is
// taken as stiff whatever the estimate said.
constexpr double stiff_decays_per_lap = 500.0;
constexpr int stiff_steps_per_branch = 2000;
constexpr double smallest_margin = 1e-6;     // of J: below it the mechanism counts as jammed
constexpr double captured_amplitude = 1e-4;  // [rad] swings about a stable equilibrium that are smaller cannot leave
constexpr double captured_creep = 1e-8;      // [rad] the same where friction holds: the angle itself is the answer
constexpr double same_swing = 1e-4;          // [rad] swings with a varying supply that differ less repeat
constexpr int averaged_laps_pwm = 8;
constexpr double settled_without_metrics = 1e-4;
constexpr double largest_rate = 0.99999;  // of contraction: what is left of a change is no more than 1e5 times it
constexpr double lap_spread_settled = 1e-2;
constexpr std::size_t most_turns = 8;  // after which a motion is looked at for repeating

using detail::format, detail::maximum, detail::metrics_apart, detail::raise_extremes;
using detail::quadrature_count, detail::quadratures;

class CrankStartUp {
 public:
  CrankStartUp(const Vehicle<double>& vehicle, const TransientOptions& options);
  TransientResult run();

 private:
  // The model at one instant.
  double voltage(double t) const {
    return supply_.type == SupplyType::sine ? voltage_at(supply_, t) : switched_voltage_;
  }
  double current_of(double t, const double* y) const {
    return inductive_ ? y[2] : algebraic_current(vehicle_, voltage(t), y[1]);
  }
  CrankKinematics<double> kinematics(double theta) const {
    return crank_kinematics(vehicle_.crank, std::sin(theta), std::cos(theta));
  }
  Motion<double> motion(double t, const double* y, Branch<double>* used = nullptr) const;
  double static_force(const CrankKinematics<double>& k) const;
  double net_static_torque(double theta, double i) const;
  double holding_torque(double theta) const;
  double wing_energy() const;
  double current_slope(double t, const double* y, const double* rates) const;
  double uniqueness(double theta) const;

  // What the integrator asks for.
  bool rates(double t, const double* y, double* dy, bool quadrature) const;
  void root_values(double t, const double* y, double* values, bool measuring);
  void tolerated(const double* y, double* errors, bool measuring) const;
  std::unique_ptr<detail::Integrator> integrator(bool measuring);

  // The course of events.
  void prepare();
  void find_jams();
  void slide();
  void stand();
  bool stick(double low, double high);
  void relax(double until);
  void choose_force_branch();
  void step_taken(detail::Integrator& steps, double from);
  void track_inrush(detail::Integrator& steps, double from);
  void track_extremes(detail::Integrator& steps, double from);
  void switch_supply();
  double next_switch() const;
  bool captured();
  bool swings_repeat();
  bool lap_done();
  bool lap_done_constant();
  void lap_measured(double rate);
  bool lap_done_averaging();
  bool jump_ahead(double rate);
  bool jump_by_blocks(std::size_t n, std::size_t block);
  void begin_measuring();
  void take_metrics(int laps);
  double lap_time(std::size_t lap) const { return crossings_[lap].lap; }
  bool repeats_after(std::size_t laps) const;
  double time_of_steadiness(double period) const;
  double lap_scatter(std::size_t laps) const;
  void add_variation();

  void event(Kind kind) { result_.events.push_back({t_, theta_, kind}); }
  void sample() {
    if (options_.record) result_.samples.push_back({t_, theta_, omega_, i_});
  }
  bool out_of_budget();
  void rest(double theta, bool held_by_friction);
  void jam(double theta);
  void flap();
  void give_up(const std::string& why);

  Vehicle<double> vehicle_;
  TransientOptions options_;
  Supply<double> supply_;
  TransientResult result_;
  bool done_ = false;
  bool inductive_ = true;
  bool wingless_ = false;
  int coupled_ = 3;
  bool stiff_ = false;

  double relative_tolerance_ = 1e-8, loosest_ = 1e-8;
  double tightest_ = 1e-13;  // what rounding leaves room for; grows where the integrator finds less
  double speed_scale_ = 1.0, current_scale_ = 1.0, time_scale_ = 1.0, force_scale_ = 1.0;
  double quadrature_scale_[quadrature_count] = {};
  double constant_friction_ = 0.0;
  double end_time_ = 0.0, runaway_speed_ = infinity;
  double jam_below_ = -infinity, jam_above_ = infinity;
  double smallest_inertia_ = 0.0;

  double t_ = 0.0, theta_ = 0.0, omega_ = 0.0, i_ = 0.0;
  double q_[quadrature_count] = {};
  Branch<double> branch_{1.0, 1.0, 1.0, 1.0};
  bool force_branch_known_ = false;
  double switched_voltage_ = 0.0;
  double ripple_top_ = absent, ripple_bottom_ = absent, ripple_sum_ = 0.0;
  long ripple_count_ = 0;
  long switches_ = 0;
  double last_force_switch_ = 0.0;
  double next_lap_ = 0.0;
  double next_sample_ = 0.0;
  double swing_low_ = 0.0, swing_high_ = 0.0;
  double window_ = 0.0, window_end_ = 0.0, window_low_ = 0.0, window_high_ = 0.0, last_low_ = 0.0, last_high_ = 0.0;
  std::size_t window_laps_ = 0;
  int repeats_ = 0;

  std::unique_ptr<detail::Integrator> plain_, with_quadratures_;
  bool measuring_ = false;
  int measured_laps_ = 0, laps_at_tightest_ = 0;
  std::optional<Metrics<double>> last_metrics_;  // of the lap before, found with the relative tolerance
  double measured_with_ = 0.0;
  double contraction_ = 0.0;  // of a lap, as the blocks of laps before a jump have shown it
  int laps_since_jump_ = 0;
  double change_before_jump_ = infinity;
  double variation_ = 0.0, energy_mark_ = 0.0;
  CycleExtremes<double> extremes_{};

  struct Crossing {
    double time, omega, current;
    double lap;      // duration of the lap that ended here [s]
    double skipped;  // time of the laps that a jump left out after it [s]
  };
  std::vector<Crossing> crossings_;
  int laps_compared_ = 0;  // successive laps since the start or the last jump
  double change_ = infinity, rate_ = 1.0, last_rate_ = 1.0;
  bool rate_seen_ = false;
  int stagnant_ = 0;
  bool jumped_ = false;
  std::size_t turns_ = 1;  // after which the motion repeats
};

CrankStartUp::CrankStartUp(const Vehicle<double>& vehicle, const TransientOptions& options)
    : vehicle_(vehicle), options_(options) {
  supply_ = options.supply.value_or(Supply<double>{SupplyType::constant, vehicle.voltage, 0.0, 1.0});
  validate(vehicle_.motor);
  validate(vehicle_.crank);
  validate(vehicle_.friction);
  validate(vehicle_.spring);
  validate(vehicle_.wings);
  validate(supply_);
  require(vehicle_.wing_count >= 0.0, "wing.count", "must be >= 0", "1", vehicle_.wing_count);
  require(vehicle_.wing_inertia >= 0.0, "wing.inertia", "must be >= 0", "kg m2", vehicle_.wing_inertia);
  require(options.tolerance >= 1e-11 && options.tolerance <= 1e-2, "transient.tolerance",
          "must lie between 1e-11 and 1e-2", "1", options.tolerance);
  require(options.max_time >= 0.0, "transient.max_time", "must be >= 0", "s", options.max_time);
  require(options.record_interval >= 0.0, "transient.record_interval", "must be >= 0", "s", options.record_interval);
  require(std::isfinite(options.crank_angle), "transient.crank_angle", "must be finite", "rad", options.crank_angle);
  require(std::isfinite(options.crank_speed), "transient.crank_speed", "must be finite", "rad/s", options.crank_speed);
  require(std::isfinite(options.current), "transient.current", "must be finite", "A", options.current);
  require(vehicle_.source_resistance >= 0.0, "supply.internal_resistance", "must be >= 0", "ohm",
          vehicle_.source_resistance);
  vehicle_.voltage = mean_voltage(supply_);
  const bool steady_pwm = supply_.type == SupplyType::pwm && (supply_.duty <= 0.0 || supply_.duty >= 1.0);
  if (steady_pwm) result_.current_ripple = 0.0;
  if (steady_pwm || supply_.type == SupplyType::battery) {
    supply_ = {SupplyType::constant, vehicle_.voltage, 0.0, 1.0};
  }
}

Motion<double> CrankStartUp::motion(double t, const double* y, Branch<double>* used) const {
  const double sin_theta = std::sin(y[0]);
  const double cos_theta = std::cos(y[0]);
  Branch<double> branch = branch_;
  branch.stroke = sign_of(cos_theta * y[1]);  // B1 has the sign of cos theta as long as the rod outreaches the crank
  const double i = current_of(t, y), v_t = terminal_voltage(vehicle_, voltage(t), i);
  Motion<double> m = motion_at(vehicle_, sin_theta, cos_theta, y[1], i, v_t, branch);
  branch.pitching = sign_of(pitch_margin(vehicle_.wings, std::abs(m.stroke_velocity)));
  if (branch.pitching < 0.0) m = motion_at(vehicle_, sin_theta, cos_theta, y[1], i, v_t, branch);
  if (used) *used = branch;
  return m;
}

bool CrankStartUp::rates(double t, const double* y, double* dy, bool quadrature) const {
  Branch<double> branch;
  const Motion<double> m = motion(t, y, &branch);
  dy[0] = y[1];
  dy[1] = m.crank_acceleration;
  if (inductive_) dy[2] = m.voltage_reserve / vehicle_.motor.armature_inductance;
  if (quadrature) {
    const CycleIntegrals<double> all = integrands(vehicle_, m, y[1], branch);
    for (int k = 0; k < quadrature_count; ++k) dy[coupled_ + k] = all[std::size_t(quadratures[k])];
  }
  return std::isfinite(dy[1]) && std::isfinite(y[coupled_ - 1]);
}

void CrankStartUp::root_values(double t, const double* y, double* values, bool measuring) {
  values[root_standstill] = y[1] / speed_scale_;
  values[root_lap] = y[0] - next_lap_;
  values[root_jam] = std::min({1.0, jam_above_ - y[0], y[0] - jam_below_});
  if (wingless_) {
    values[root_force] = 1.0;
    if (measuring) values[root_stored_moment] = values[root_dead_centre] = 1.0;
    return;
  }
  const Motion<double> m = motion(t, y);
  values[root_force] = last_force_switch_ = m.force_switch / force_scale_;
  if (measuring) {
    values[root_stored_moment] = m.stored_moment / (force_scale_ / vehicle_.motor.inertia);
    values[root_dead_centre] = std::cos(y[0]);
  }
}

void CrankStartUp::tolerated(const double* y, double* errors, bool measuring) const {
  // The crank angle grows for ever: its admissible error must not grow with it.
  errors[0] = relative_tolerance_;
  errors[1] = relative_tolerance_ * (std::abs(y[1]) + 0.01 * speed_scale_);
  if (inductive_) errors[2] = relative_tolerance_ * (std::abs(y[2]) + 0.01 * current_scale_);
  if (!measuring) return;
  for (int k = 0; k < quadrature_count; ++k) {
    errors[coupled_ + k] = relative_tolerance_ * (std::abs(y[coupled_ + k]) + 0.01 * quadrature_scale_[k]);
  }
}

std::unique_ptr<detail::Integrator> CrankStartUp::integrator(bool measuring) {
  detail::IntegratorProblem p;
  p.size = coupled_ + (measuring ? quadrature_count : 0);
  p.coupled = coupled_;
  p.roots = measuring ? int(root_measuring_count) : int(root_plain_count);
  p.stiff = stiff_;
  p.rates = [this, measuring](double t, const double* y, double* dy) {
    ++result_.rate_evaluations;
    return rates(t, y, dy, measuring);
  };
  p.root_functions = [this, measuring](double t, const double* y, double* values) {
    root_values(t, y, values, measuring);
  };
  p.tolerated = [this, measuring](const double* y, double* errors) { tolerated(y, errors, measuring); };
  p.longest_step = 0.25 * time_scale_;
  p.typical = {0.1, speed_scale_, current_scale_};
  return detail::make_integrator(options_.integrator, std::move(p));
}

double CrankStartUp::static_force(const CrankKinematics<double>& k) const {
  if (wingless_) return 0.0;
  return wingbeat::static_rod_force(k, spring_moment(vehicle_, k));
}

/// K i - F_s h [N m]: what would turn the crank at rest.
double CrankStartUp::net_static_torque(double theta, double i) const {
  const CrankKinematics<double> k = kinematics(theta);
  return vehicle_.motor.torque_constant * i - static_force(k) * k.crank_lever;
}

/// mu r_e |F_s| + T_c [N m]: what friction can hold at rest.
double CrankStartUp::holding_torque(double theta) const {
  return wingbeat::holding_torque(vehicle_, static_force(kinematics(theta)));
}

double CrankStartUp::wing_energy() const {
  const CrankKinematics<double> k = kinematics(theta_);
  return wingbeat::wing_energy(vehicle_, k, k.stroke_slope * omega_);
}

/// di/dt [A/s]; `rates` are needed without inductance only.
double CrankStartUp::current_slope(double t, const double* y, const double* rates) const {
  const Motor<double>& m = vehicle_.motor;
  const double R = circuit_resistance(vehicle_);
  if (inductive_) return (voltage(t) - R * y[2] - m.torque_constant * y[1]) / m.armature_inductance;
  const double angular = two_pi * supply_.frequency;
  const double voltage_slope =
      supply_.type == SupplyType::sine ? supply_.voltage * angular * std::cos(angular * t) : 0.0;
  return (voltage_slope - m.torque_constant * rates[1]) / R;
}

/// The smaller of the effective inertias over J, and the wing lever over H: the equations have one solution while
/// it is positive.
double CrankStartUp::uniqueness(double theta) const {
  const CrankKinematics<double> k = kinematics(theta);
  const double lever = k.wing_lever / vehicle_.crank.hinge_offset;
  if (!(lever > 0.0)) return lever;
  return std::min(lever, least_inertia(vehicle_, k) / vehicle_.motor.inertia);
}

/// Nearest crank angles on either side of the start that the crank cannot pass.
void CrankStartUp::find_jams() {
  smallest_inertia_ = vehicle_.motor.inertia;
  if (wingless_) return;
  constexpr int count = 720;
  constexpr double spacing = two_pi / count;
  double margin[count];
  for (int k = 0; k < count; ++k) margin[k] = uniqueness(theta_ + k * spacing);
  const auto at = [&](int k) { return margin[((k % count) + count) % count]; };
  const auto bisect = [&](double free, double jammed) {
    for (int k = 0; k < 60; ++k) {
      const double mid = 0.5 * (free + jammed);
      (uniqueness(mid) > smallest_margin ? free : jammed) = mid;
    }
    return jammed;
  };
  const auto first = [&](int direction) {
    for (int k = 0; k <= count; ++k) {
      const double here = theta_ + direction * k * spacing;
      if (at(direction * k) <= smallest_margin) return k == 0 ? here : bisect(here - direction * spacing, here);
      // A narrow window of jam may hide between two samples.
      const double before = at(direction * (k - 1)), after = at(direction * (k + 1));
      if (at(direction * k) <= std::min(before, after) && at(direction * k) < 0.2) {
        const auto [where, least] = maximum([&](double x) { return -uniqueness(x); }, here - spacing, here + spacing);
        if (-least <= smallest_margin) return bisect(here - direction * spacing, where);
      }
    }
    return direction * infinity;
  };
  smallest_inertia_ *= std::clamp(*std::min_element(margin, margin + count), 1e-3, 1.0);
  jam_above_ = first(1);
  if (std::isfinite(jam_above_)) jam_below_ = first(-1);
}

void CrankStartUp::prepare() {
  const Motor<double>& m = vehicle_.motor;
  const double R = circuit_resistance(vehicle_), K = m.torque_constant;
  theta_ = swing_low_ = swing_high_ = options_.crank_angle;
  omega_ = options_.crank_speed;
  inductive_ = m.armature_inductance > 0.0;
  coupled_ = inductive_ ? 3 : 2;
  wingless_ = vehicle_.wing_count * vehicle_.wing_inertia == 0.0 &&
              vehicle_.wing_count * vehicle_.spring.stiffness == 0.0 &&
              vehicle_.wings.air_density * vehicle_.wings.s3 == 0.0;
  constant_friction_ = breakaway_torque(vehicle_);
  switched_voltage_ = supply_.voltage;
  i_ = inductive_ ? options_.current : algebraic_current(vehicle_, voltage(0.0), omega_);
  find_jams();

  const double damping = m.viscous_damping + vehicle_.friction.damping;
  current_scale_ = supply_.voltage / R;
  speed_scale_ = K * supply_.voltage / (K * K + R * damping);
  if (vehicle_.friction.quadratic > 0.0) {
    speed_scale_ = std::min(speed_scale_, std::sqrt(K * current_scale_ / vehicle_.friction.quadratic));
  }
  if (!(speed_scale_ > 0.0)) speed_scale_ = omega_ != 0.0 ? std::abs(omega_) : 1.0;
  if (!(current_scale_ > 0.0)) current_scale_ = std::max(std::abs(i_), K * speed_scale_ / R);
  const double released = 0.5 * pi * std::sqrt(vehicle_.wing_count * vehicle_.spring.stiffness / m.inertia);
  runaway_speed_ = 1e3 * std::max({speed_scale_, std::abs(omega_), std::abs(i_) * R / K, released});
  const double lap = two_pi / speed_scale_;
  const double electrical = m.armature_inductance / R;
  const double wings =
      vehicle_.wing_count * vehicle_.wing_inertia * square(vehicle_.crank.crank_radius / vehicle_.crank.hinge_offset);
  const double mechanical = (m.inertia + wings) * R / (K * K + R * m.viscous_damping);
  time_scale_ = lap;
  force_scale_ = (m.inertia + wings) * K * current_scale_ * vehicle_.crank.hinge_offset / vehicle_.crank.crank_radius;

  const double fastest =
      inductive_ ? std::max(1.0 / electrical, damping / smallest_inertia_) : (damping + K * K / R) / smallest_inertia_;
  const double drive = supply_.type == SupplyType::constant ? 0.0 : 1.0 / supply_.frequency;
  stiff_ = fastest * (drive > 0.0 ? std::min(lap, drive) : lap) > stiff_decays_per_lap;
  result_.stiff = stiff_;
  relative_tolerance_ = std::max(tightest_, (stiff_ ? 3e-3 : 1e-2) * options_.tolerance);
  loosest_ = relative_tolerance_;

  end_time_ = options_.max_time > 0.0            ? options_.max_time
              : supply_.type == SupplyType::sine ? 50.0 * (lap + drive) + 100.0 * (mechanical + electrical)
                                                 : 1000.0 * (lap + mechanical + electrical + drive);

  window_ = std::max({lap, 8.0 * drive, 0.5 * mechanical, electrical});
  window_end_ = window_;
  window_low_ = window_high_ = theta_;

  const double force = K * current_scale_ / vehicle_.crank.crank_radius;
  const double power = current_scale_ * K * speed_scale_ + current_scale_ * current_scale_ * R;
  const auto natural = [&](Integral which) {
    switch (which) {
      case Integral::current: return current_scale_;
      case Integral::current_square: return square(current_scale_);
      case Integral::speed_square: return square(speed_scale_);
      case Integral::lift:
        return vehicle_.wings.air_density * vehicle_.wings.s2 *
                   square(speed_scale_ * vehicle_.crank.crank_radius / vehicle_.crank.hinge_offset) +
               1e-6 * force;
      case Integral::rod_force: return force;
      default: return power;
    }
  };
  for (int k = 0; k < quadrature_count; ++k) quadrature_scale_[k] = lap * natural(quadratures[k]);

  next_lap_ = two_pi * (std::floor(theta_ / two_pi) + 1.0);
  next_sample_ = options_.record_interval;
  result_.inrush_current = i_;
  sample();
}

bool CrankStartUp::out_of_budget() {
  ++result_.steps;
  if (result_.steps > options_.max_steps) {
    give_up(format("no verdict within %ld integration steps", options_.max_steps));
  } else if (options_.cancel && result_.steps % 512 == 0 && options_.cancel()) {
    give_up("cancelled");
  } else if (std::abs(omega_) > runaway_speed_) {
    give_up(
        format("the crank speeds up without bound (%.3g rad/s): this transmission formulation does not conserve "
               "power and feeds it",
               omega_));
  } else if (t_ >= end_time_) {
    give_up(format("no verdict within %.6g s", end_time_));
  }
  return done_;
}

TransientResult CrankStartUp::run() {
  prepare();
  // A motor that never starts is stalled, jammed or not.
  const double drive = vehicle_.motor.torque_constant * supply_.voltage / circuit_resistance(vehicle_);
  const bool starts = omega_ != 0.0 || theta_ != 0.0 || drive > constant_friction_;
  if (starts && uniqueness(theta_) <= smallest_margin && !wingless_) jam(theta_);
  while (!done_) {
    if (omega_ == 0.0) {
      stand();
    } else {
      branch_.direction = sign_of(omega_);
    }
    if (!done_) slide();
    if (!done_) out_of_budget();
  }
  result_.end_time = t_;
  result_.end_crank_angle = theta_;
  result_.laps = int(crossings_.size());
  if (!crossings_.empty()) {
    result_.crank_speed = crossings_.back().omega;
    result_.current = crossings_.back().current;
  }
  return std::move(result_);
}

/// At a standstill: rests for good, waits for the current to break it away, or moves on in the direction of the torque.
void CrankStartUp::stand() {
  const CrankKinematics<double> k = kinematics(theta_);
  const double load = static_force(k) * k.crank_lever;
  const double hold = vehicle_.friction.radius * std::abs(static_force(k)) + constant_friction_;
  const double K = vehicle_.motor.torque_constant;
  if (!inductive_) i_ = voltage(t_) / circuit_resistance(vehicle_);
  const double net = K * i_ - load;
  if (std::abs(net) > hold) {
    branch_.direction = sign_of(net);
    return;
  }
  const double from = t_;
  if (!stick((load - hold) / K, (load + hold) / K)) return;
  if (t_ > from || crossings_.empty()) event(Kind::breakaway);
}

/// Crank held by friction while the current stays in [low, high]. True when it breaks away, t_, i_ and the direction
/// then being set; false when the verdict is in.
bool CrankStartUp::stick(double low, double high) {
  const Motor<double>& m = vehicle_.motor;
  const double R = circuit_resistance(vehicle_);
  const double tau = m.armature_inductance / R;
  const auto inside = [&](double i) { return i >= low && i <= high; };

  if (supply_.type == SupplyType::constant && inside(switched_voltage_ / R)) {
    rest(theta_, true);
    return false;
  }
  if (supply_.type == SupplyType::pwm) {
    // The current's limit cycle; on the way there it stays between its start and the cycle's ends.
    const double period = 1.0 / supply_.frequency;
    double top = supply_.voltage / R, bottom = 0.0;
    if (inductive_) {
      top *= std::expm1(-supply_.duty * period / tau) / std::expm1(-period / tau);
      bottom = top * std::exp(-(1.0 - supply_.duty) * period / tau);
    }
    if (inside(top) && inside(bottom)) {
      rest(theta_, true);
      return false;
    }
  }
  const double started = t_;
  while (!out_of_budget()) {
    if (supply_.type == SupplyType::sine) {
      const double period = 1.0 / supply_.frequency;
      if (t_ - started > 40.0 * tau + 2.0 * period) {
        rest(theta_, true);
        return false;
      }
      const double before_t = t_, before_i = i_;
      relax(std::min(end_time_, t_ + period / 64.0));
      if (inside(i_)) continue;
      double a = before_t, b = t_;
      for (int k = 0; k < 60; ++k) {
        const double mid = 0.5 * (a + b);
        t_ = before_t;
        i_ = before_i;
        relax(mid);
        (inside(i_) ? a : b) = mid;
      }
      branch_.direction = i_ > high ? 1.0 : -1.0;
      if (!inside(i_)) i_ = i_ > high ? high : low;
      return true;
    }
    const double limit = switched_voltage_ / R;
    const double piece_end = std::min(end_time_, next_switch());
    if (!inside(limit)) {
      const double bound = limit > high ? high : low;
      const double wait = inductive_ ? tau * std::max(0.0, std::log((limit - i_) / (limit - bound))) : 0.0;
      if (t_ + wait <= piece_end) {
        relax(t_ + wait);
        if (inductive_) i_ = bound;
        branch_.direction = limit > high ? 1.0 : -1.0;
        return true;
      }
    }
    relax(piece_end);
    if (piece_end < end_time_) switch_supply();
  }
  return false;
}

/// Lets the current of the standing motor run on to the time `until`, before any switching of the supply.
void CrankStartUp::relax(double until) {
  const Motor<double>& m = vehicle_.motor;
  const double R = circuit_resistance(vehicle_);
  const double tau = m.armature_inductance / R;
  const double start = t_, i_0 = i_, span = until - start;
  const auto forced = [&](double t) {
    if (supply_.type != SupplyType::sine) return switched_voltage_ / R;
    const double angular = two_pi * supply_.frequency, lag = std::atan(angular * tau);
    return supply_.voltage / R * std::cos(lag) * std::sin(angular * t - lag);
  };
  const auto current = [&](double t) {
    return inductive_ ? forced(t) + (i_0 - forced(start)) * std::exp(-(t - start) / tau) : forced(t);
  };
  if (measuring_ && span > 0.0) {
    const double force = std::abs(static_force(kinematics(theta_)));
    double charge = 0.0, heat = 0.0, work = 0.0;
    if (supply_.type == SupplyType::sine) {
      constexpr double node = 0.77459666924148337704;  // three-point Gauss; spans are 1/64 of a drive period at most
      for (const auto& [at, weight] : {std::pair{-node, 5.0 / 18.0}, {0.0, 4.0 / 9.0}, {node, 5.0 / 18.0}}) {
        const double t = start + 0.5 * span * (1.0 + at);
        charge += weight * span * current(t);
        heat += weight * span * square(current(t));
        work += weight * span * current(t) * terminal_voltage(vehicle_, voltage(t), current(t));
      }
    } else {
      const double limit = forced(start);
      const double d = inductive_ ? i_0 - limit : 0.0;
      const double a = inductive_ ? -tau * std::expm1(-span / tau) : 0.0;
      const double b = inductive_ ? -0.5 * tau * std::expm1(-2.0 * span / tau) : 0.0;
      charge = limit * span + d * a;
      heat = square(limit) * span + 2.0 * limit * d * a + square(d) * b;
      work = switched_voltage_ * charge - vehicle_.source_resistance * heat;
    }
    for (int k = 0; k < quadrature_count; ++k) {
      switch (quadratures[k]) {
        case Integral::current: q_[k] += charge; break;
        case Integral::current_square: q_[k] += heat; break;
        case Integral::electrical_work: q_[k] += work; break;
        case Integral::rod_force: q_[k] += force * span; break;
        default: break;
      }
    }
  }
  if (options_.record && options_.record_interval > 0.0) {
    for (; next_sample_ <= until; next_sample_ += options_.record_interval) {
      result_.samples.push_back({next_sample_, theta_, 0.0, current(next_sample_)});
    }
  }
  i_ = current(until);
  t_ = until;
  if (i_ > result_.inrush_current) {
    result_.inrush_current = i_;
    result_.inrush_current_time = t_;
  }
  if (measuring_) {
    double& top = extremes_[std::size_t(Extreme::current)];
    top = std::max(top, i_);
    double& slowest = extremes_[std::size_t(Extreme::crank_speed_min)];
    slowest = std::max(slowest, 0.0);
  }
  if (options_.record_interval == 0.0 && span > 0.0) sample();
}

double CrankStartUp::next_switch() const {
  if (supply_.type != SupplyType::pwm) return infinity;
  // Even switches turn on, odd ones off; number 0 is the switching on at t = 0.
  const long next = switches_ + 1;
  return (double(next / 2) + (next % 2 == 1 ? supply_.duty : 0.0)) / supply_.frequency;
}

void CrankStartUp::switch_supply() {
  ++switches_;
  if (switches_ % 2 == 1) {
    ripple_top_ = i_;
  } else {
    if (measuring_ && std::isfinite(ripple_bottom_)) {
      const double line = ripple_bottom_ + supply_.duty * (i_ - ripple_bottom_);
      ripple_sum_ += ripple_top_ - line;
      ++ripple_count_;
    }
    ripple_bottom_ = measuring_ ? i_ : absent;
  }
  switched_voltage_ = switches_ % 2 == 0 ? supply_.voltage : 0.0;
  if (!inductive_) i_ = algebraic_current(vehicle_, switched_voltage_, omega_);
  if (options_.record) {
    event(Kind::supply_switch);
    sample();
  }
  if (i_ > result_.inrush_current) {
    result_.inrush_current = i_;
    result_.inrush_current_time = t_;
  }
}

void CrankStartUp::choose_force_branch() {
  if (wingless_) return;
  if (force_branch_known_) {
    force_branch_known_ = false;
    return;
  }
  double y[3] = {theta_, omega_, i_};
  double value = motion(t_, y).force_switch / force_scale_;
  if (std::abs(value) < 1e-9) {
    // The sign is about to be decided: look a little ahead, by the midpoint rule.
    const double ahead = 1e-5 * time_scale_;
    double dy[3] = {}, mid[3] = {}, dmid[3] = {};
    rates(t_, y, dy, false);
    for (int k = 0; k < coupled_; ++k) mid[k] = y[k] + 0.5 * ahead * dy[k];
    rates(t_ + 0.5 * ahead, mid, dmid, false);
    for (int k = 0; k < coupled_; ++k) y[k] += ahead * dmid[k];
    value = motion(t_ + ahead, y).force_switch;
  }
  branch_.force = sign_of(value);
}

/// Integrates one smooth branch to the next event that ends it.
void CrankStartUp::slide() {
  choose_force_branch();
  std::unique_ptr<detail::Integrator>& slot = measuring_ ? with_quadratures_ : plain_;
  if (!slot) slot = integrator(measuring_);
  detail::Integrator& steps = *slot;
  double* y = steps.state();
  y[0] = theta_;
  y[1] = omega_;
  if (inductive_) y[2] = i_;
  if (measuring_) std::copy(q_, q_ + quadrature_count, y + coupled_);

  int directions[root_measuring_count] = {int(-branch_.force), int(-branch_.direction), 1, -1, 0, 0};
  const double switching = next_switch();
  const double stop = std::min(end_time_, switching);
  if (stop - t_ < 1e-13 * std::max(t_, stop)) {
    t_ = stop;
    if (stop == switching) switch_supply();
    return;
  }
  if (!steps.restart(t_, directions, std::min(time_scale_, stop - t_), stop)) {
    give_up("the integrator could not be started");
    return;
  }
  int branch_steps = 0;
  while (true) {
    const double from = t_;
    const detail::Integrator::Outcome outcome = steps.advance();
    if (outcome == detail::Integrator::Outcome::failed) {
      if (relative_tolerance_ < 1e-9) {
        relative_tolerance_ = tightest_ = 10.0 * relative_tolerance_;
        force_branch_known_ = true;
        return;
      }
      give_up(format("the integrator failed at t = %.6g s, crank angle %.4f deg", t_,
                     wrap_angle(theta_) * degrees_per_radian));
      return;
    }
    t_ = steps.time();
    theta_ = y[0];
    omega_ = y[1];
    i_ = current_of(t_, y);
    if (measuring_) std::copy(y + coupled_, y + coupled_ + quadrature_count, q_);
    step_taken(steps, from);

    bool branch_ends = false;
    if (outcome == detail::Integrator::Outcome::root) {
      if (steps.found(root_jam)) {
        jam(theta_);
        return;
      }
      if (steps.found(root_standstill)) {
        omega_ = 0.0;
        event(Kind::standstill);
        branch_ends = true;
      }
      if (steps.found(root_force)) {
        event(Kind::force_sign_change);
        branch_.force = -branch_.force;
        force_branch_known_ = omega_ != 0.0;
        branch_ends = true;
      }
      if (measuring_) add_variation();
      if (steps.found(root_lap)) branch_ends = lap_done() || branch_ends;
    } else if (outcome == detail::Integrator::Outcome::stop) {
      if (measuring_) add_variation();
      if (stop == switching && t_ >= stop) switch_supply();
      branch_ends = true;
    } else {
      // Roots that the integrator may not see: a sign that was wrong from the start of the branch.
      if (branch_.direction * omega_ < -1e-9 * speed_scale_) branch_ends = true;
      if (!wingless_ && branch_.force * last_force_switch_ < -1e-8) {
        branch_.force = -branch_.force;
        force_branch_known_ = true;
        branch_ends = true;
      }
      if (!branch_ends && captured()) return;
    }
    if (done_ || swings_repeat() || branch_ends) return;
    if (out_of_budget()) return;
    if (!stiff_ && ++branch_steps > stiff_steps_per_branch) {
      stiff_ = result_.stiff = true;
      plain_.reset();
      with_quadratures_.reset();
      force_branch_known_ = true;
      return;
    }
  }
}

void CrankStartUp::step_taken(detail::Integrator& steps, double from) {
  swing_low_ = std::min(swing_low_, theta_);
  swing_high_ = std::max(swing_high_, theta_);
  window_low_ = std::min(window_low_, theta_);
  window_high_ = std::max(window_high_, theta_);
  track_inrush(steps, from);
  if (measuring_) track_extremes(steps, from);
  if (!options_.record) return;
  if (options_.record_interval == 0.0) {
    sample();
    return;
  }
  for (; next_sample_ <= t_; next_sample_ += options_.record_interval) {
    const double* y = steps.dense(next_sample_);
    result_.samples.push_back({next_sample_, y[0], y[1], current_of(next_sample_, y)});
  }
}

void CrankStartUp::track_inrush(detail::Integrator& steps, double from) {
  const auto note = [&](double t, double i) {
    if (i > result_.inrush_current) {
      result_.inrush_current = i;
      result_.inrush_current_time = t;
    }
  };
  const auto slope = [&](double t) {
    double rates[3] = {};
    if (!inductive_) rates[1] = steps.dense(t, 1)[1];
    return current_slope(t, steps.dense(t), rates);
  };
  note(t_, i_);
  if (i_ < 0.9 * result_.inrush_current || slope(t_) >= 0.0 || slope(from) <= 0.0) return;
  double a = from, b = t_;
  for (int k = 0; k < 50 && b - a > 1e-9 * (t_ - from); ++k) {
    const double mid = 0.5 * (a + b);
    (slope(mid) > 0.0 ? a : b) = mid;
  }
  note(a, current_of(a, steps.dense(a)));
}

/// Raises the extremes of the lap to what they reach within the last step, on the integrator's own interpolant.
void CrankStartUp::track_extremes(detail::Integrator& steps, double from) {
  raise_extremes(
      [&](double t) {
        const double* y = steps.dense(t);
        Branch<double> branch;
        const Motion<double> m = motion(t, y, &branch);
        return extreme_candidates(vehicle_, m, y[1], branch);
      },
      from, t_, extremes_);
}

void CrankStartUp::add_variation() {
  const double energy = wing_energy();
  variation_ += std::abs(energy - energy_mark_);
  energy_mark_ = energy;
}

/// True, with the verdict, when the crank can no longer leave the stable equilibrium that it swings about or creeps
/// towards: kinetic energy, spring energy above the equilibrium's and inductive energy together only fall, and are
/// small already. With Coulomb friction, the equilibrium is where the torque no longer exceeds it: an overdamped crank
/// creeps there without ever standing still.
bool CrankStartUp::captured() {
  if (supply_.type != SupplyType::constant || std::abs(omega_) > 0.02 * speed_scale_) return false;
  const Motor<double>& m = vehicle_.motor;
  const double final_current = switched_voltage_ / circuit_resistance(vehicle_);
  if (wingless_ || vehicle_.spring.stiffness == 0.0) {
    if (final_current > 0.0 || std::abs(omega_) > 1e-7 * speed_scale_) return false;
    rest(theta_, false);
    return true;
  }
  const auto excess_torque = [&](double theta) {
    return net_static_torque(theta, final_current) - branch_.direction * holding_torque(theta);
  };
  double theta = theta_, slope = 0.0;
  for (int k = 0; k < 5; ++k) {
    constexpr double step = 1e-6;
    slope = (excess_torque(theta + step) - excess_torque(theta - step)) / (2.0 * step);
    if (!(slope < 0.0)) return false;
    theta -= excess_torque(theta) / slope;
    if (!(std::abs(theta - theta_) < 0.01)) return false;
  }
  const double scale = m.torque_constant * current_scale_;
  if (std::abs(excess_torque(theta)) > 1e-9 * scale) return false;
  const bool friction = holding_torque(theta) > 1e-9 * scale;
  const double inertia = effective_inertia(vehicle_, kinematics(theta_), 0.0);
  const double energy =
      inertia * square(omega_) - slope * square(theta - theta_) + m.armature_inductance * square(i_ - final_current);
  if (energy > -slope * square(friction ? captured_creep : captured_amplitude)) return false;
  rest(theta, friction);
  return true;
}

/// With a varying supply: true, with the verdict, when the crank swings without rotating and its swings repeat.
bool CrankStartUp::swings_repeat() {
  if (supply_.type == SupplyType::constant || t_ < window_end_) return false;
  const bool same = window_laps_ == crossings_.size() && std::abs(window_low_ - last_low_) < same_swing &&
                    std::abs(window_high_ - last_high_) < same_swing;
  repeats_ = same ? repeats_ + 1 : 0;
  last_low_ = window_low_;
  last_high_ = window_high_;
  window_low_ = window_high_ = theta_;
  window_laps_ = crossings_.size();
  window_end_ = t_ + window_;
  if (repeats_ < 3) return false;
  done_ = true;
  result_.settled = true;
  result_.status = FlappingStatus::locked;
  result_.time_to_steady = t_;
  if (last_high_ - last_low_ < same_swing) result_.lock_angle = wrap_angle(0.5 * (last_low_ + last_high_));
  result_.detail = format("does not rotate: the crank moves with the supply between %.4f and %.4f deg",
                          last_low_ * degrees_per_radian, last_high_ * degrees_per_radian);
  return true;
}

/// A forward crossing of theta = 2 pi n. True if the integrator must start afresh.
bool CrankStartUp::lap_done() {
  const double before = crossings_.empty() ? 0.0 : crossings_.back().time + crossings_.back().skipped;
  crossings_.push_back({t_, omega_, i_, t_ - before, 0.0});
  event(Kind::revolution);
  next_lap_ += two_pi;
  const bool restart = supply_.type == SupplyType::constant ? lap_done_constant() : lap_done_averaging();
  if (!done_ && int(crossings_.size()) >= options_.max_laps) {
    give_up(format("successive laps still differ by %.2g of their speed after %d laps", change_, options_.max_laps));
  }
  return restart;
}

bool CrankStartUp::lap_done_constant() {
  ++laps_compared_;
  ++laps_since_jump_;
  if (crossings_.size() < 2) return false;
  if (turns_ == 1 && laps_compared_ >= 40 && laps_compared_ % 16 == 0) {
    for (std::size_t turns = 2; turns <= most_turns && turns_ == 1; ++turns) {
      if (!repeats_after(turns)) continue;
      turns_ = turns;
      change_ = infinity;
      rate_ = last_rate_ = 1.0;
      rate_seen_ = false;
      laps_compared_ = 0;
      return false;
    }
  }
  if (turns_ > 1 && laps_compared_ % int(turns_) != 0) return false;
  const Crossing& before = crossings_[crossings_.size() - 1 - turns_];
  const double noise = 30.0 * relative_tolerance_;
  const double previous = change_;
  change_ = std::max(std::abs(omega_ - before.omega) / (std::abs(omega_) + 1e-6 * speed_scale_),
                     std::abs(i_ - before.current) / (std::abs(i_) + 0.01 * current_scale_));
  if (laps_compared_ >= 3 && previous > noise && !measuring_) {
    last_rate_ = rate_;
    rate_ = std::min(change_ / previous, 10.0);
    if (!rate_seen_) last_rate_ = rate_;
    rate_seen_ = true;
  }
  // The slower of the last two contractions, since complex multipliers make the changes uneven.
  double rate = std::max(rate_, last_rate_);
  stagnant_ = !measuring_ && change_ < 100.0 * noise && change_ > 0.5 * previous ? stagnant_ + 1 : 0;
  if ((change_ < noise && laps_compared_ >= 3 && !measuring_ && (!rate_seen_ || rate >= 0.3)) || stagnant_ >= 2) {
    // Slow approach or the integrator's own errors? More accuracy tells; at rounding it must be the latter.
    stagnant_ = 0;
    if (relative_tolerance_ <= tightest_ && change_ < 0.1 * options_.tolerance) rate_ = last_rate_ = rate = 0.5;
    relative_tolerance_ = std::max(tightest_, relative_tolerance_ / 30.0);
  }
  const double to_come = rate < 1.0 ? change_ * rate / (1.0 - rate) : infinity;

  if (measuring_) {
    lap_measured(rate);
    return true;
  }
  if (rate < 1.0 && rate > 0.3 && to_come < 1e-2) {
    // Weakly damped: what a lap's errors leave behind adds up over 1 / (1 - rate) laps.
    relative_tolerance_ = std::min(relative_tolerance_, std::max(tightest_, loosest_ * (1.0 - rate)));
  }
  if (!options_.metrics && rate < 0.3 && to_come < settled_without_metrics) {
    flap();
    return true;
  }
  if (to_come < 0.1 * options_.tolerance || (rate < 1.0 && change_ < noise)) {
    relative_tolerance_ = std::max(tightest_, std::min(relative_tolerance_, 1e-3 * options_.tolerance));
    begin_measuring();
    return true;
  }
  return jump_ahead(rate);
}

/// True where a metric is what is left of far larger parts.
bool cancels(const Metrics<double>& m) {
  return !(m[Metric::lift_peak] <= 10.0 * std::abs(m[Metric::lift_mean]) &&
           m[Metric::power_reactive] <= 5.0 * std::abs(m[Metric::power_motor]) &&
           m[Metric::power_electrical] <= 5.0 * std::abs(m[Metric::power_loss]) &&
           m[Metric::current_rms] <= 5.0 * std::abs(m[Metric::current_mean]));
}

/// Takes the metrics of a lap as those of steady flapping where it began close enough to the orbit and a lap of looser
/// steps gives the same. Otherwise the next lap is measured: with tighter steps, and, where laps converge slowly, from
/// where the known contraction leads.
void CrankStartUp::lap_measured(double rate) {
  const double tolerance = options_.tolerance;
  const double gain = 1.0 / (1.0 - std::min(std::max(rate, contraction_), largest_rate));
  // The lap began as far from the orbit as change / (1 - rate).
  const double off = change_ * gain;
  const bool tightest = relative_tolerance_ <= tightest_;
  const std::optional<Metrics<double>> before = std::exchange(last_metrics_, std::nullopt);
  take_metrics(int(turns_));
  ++measured_laps_;
  laps_at_tightest_ += tightest;
  const bool closed = off < 0.1 * tolerance;
  // Where errors neither cancel nor add up over laps, steps of a thousandth are known to be enough.
  const bool enough = gain < 1.5 && relative_tolerance_ <= 1e-3 * tolerance && !cancels(*result_.metrics);
  const bool agree = enough || ((tightest || relative_tolerance_ < 0.2 * measured_with_) && before &&
                                metrics_apart(*before, *result_.metrics) < 0.3 * tolerance);
  const bool rounding = change_ < tolerance && laps_at_tightest_ > (change_ < 30.0 * tightest_ ? 4 : 40);
  if ((closed && agree) || rounding) {
    result_.closure = off;
    flap();
    return;
  }
  last_metrics_ = std::exchange(result_.metrics, std::nullopt);
  measured_with_ = relative_tolerance_;
  if (change_ > 100.0 * tolerance || laps_at_tightest_ > 40) {
    // Not what was known of the contraction: back to plain laps.
    measuring_ = false;
    change_ = infinity;
    rate_ = last_rate_ = 1.0;
    rate_seen_ = false;
    laps_compared_ = 1;
    laps_at_tightest_ = 0;
    contraction_ = 0.0;
    last_metrics_.reset();
    return;
  }
  if (laps_since_jump_ == 2 && change_ > 0.5 * change_before_jump_) contraction_ = 0.0;
  relative_tolerance_ =
      std::max(tightest_, closed ? relative_tolerance_ / 10.0 : std::min(relative_tolerance_, 3e-3 * tolerance / gain));
  if (!closed && contraction_ > 0.0 && laps_since_jump_ >= 2) {
    const Crossing& last = crossings_[crossings_.size() - 2];
    const double share = contraction_ / (1.0 - contraction_);
    omega_ += share * (omega_ - last.omega);
    i_ = inductive_ ? i_ + share * (i_ - last.current) : algebraic_current(vehicle_, voltage(t_), omega_);
    crossings_.back().omega = omega_;
    crossings_.back().current = i_;
    laps_since_jump_ = 0;
    change_before_jump_ = change_;
  }
  begin_measuring();
}

/// True if the state repeats after so many laps, far better than after one.
bool CrankStartUp::repeats_after(std::size_t laps) const {
  const std::size_t n = crossings_.size();
  if (n < 4 * laps) return false;
  for (std::size_t k = n - 2 * laps; k < n; ++k) {
    const Crossing &a = crossings_[k - laps], &b = crossings_[k], &next = crossings_[k - laps + 1];
    const double off = std::abs(a.omega - b.omega) / speed_scale_ + std::abs(a.current - b.current) / current_scale_;
    const double within =
        std::abs(a.omega - next.omega) / speed_scale_ + std::abs(a.current - next.current) / current_scale_;
    if (!(off < 1e-2 * within) || within < 1e-5) return false;
  }
  return true;
}

/// Where laps converge slowly along one direction, skips ahead. Blocks of laps of one size show by how much each moves
/// less than the one before, which single laps of a heavy rotor do not show above the integrator's errors. To the limit
/// (Aitken) once that changes nothing a start-up is looked at for: less than a thousandth. Half of the way, but no more
/// than a fifth of the speed, where a heavy rotor has far to go.
bool CrankStartUp::jump_ahead(double rate) {
  const std::size_t n = crossings_.size();
  if (options_.record || turns_ > 1 || laps_compared_ < 5 || rate < 0.3) return false;
  const std::size_t laps = std::size_t(laps_compared_) - 2;  // the first one after a jump still settles
  for (const std::size_t block : {1, 8, 32, 128}) {
    if (3 * block > laps) break;
    if (block > 1 ? rate < 0.9 || laps % block != 0 : rate >= 1.0) continue;
    if (jump_by_blocks(n, block)) return true;
  }
  return false;
}

bool CrankStartUp::jump_by_blocks(std::size_t n, std::size_t block) {
  const auto difference = [&](std::size_t back) {
    const Crossing& a = crossings_[n - 1 - (back + 1) * block];
    const Crossing& b = crossings_[n - 1 - back * block];
    return std::pair{(b.omega - a.omega) / speed_scale_, inductive_ ? (b.current - a.current) / current_scale_ : 0.0};
  };
  const auto ratio = [&](std::size_t back) {
    const auto [w0, c0] = difference(back + 1);
    const auto [w1, c1] = difference(back);
    return (w0 * w1 + c0 * c1) / (w0 * w0 + c0 * c0);
  };
  const double newer = ratio(0), older = ratio(1);
  if (!(newer > 0.0 && newer < 0.9999)) return false;
  const double gain = newer / (1.0 - newer), per_lap = std::pow(newer, 1.0 / double(block));
  const auto [speed, current] = difference(0);
  const double to_come = std::max(std::abs(speed) * speed_scale_ / std::abs(omega_),
                                  std::abs(current) * current_scale_ / (std::abs(i_) + 0.01 * current_scale_)) *
                         gain;
  const bool to_the_limit = to_come <= 1e-3;
  if (std::abs(newer - older) > (to_the_limit ? 0.05 : 0.2) * (1.0 - newer)) return false;
  double share = 1.0, skipped = 0.0;
  if (!to_the_limit) {
    if (block == 1 || per_lap < 0.98) return false;
    share = std::min(0.5, 0.2 / to_come);
    skipped = std::log1p(-share) / std::log(per_lap);
    if (skipped < double(2 * block)) return false;
  }
  omega_ += share * gain * speed * speed_scale_;
  i_ = inductive_ ? i_ + share * gain * current * current_scale_ : algebraic_current(vehicle_, voltage(t_), omega_);
  Crossing& here = crossings_.back();
  here.omega = omega_;
  here.current = i_;
  here.skipped = skipped * here.lap;
  t_ += here.skipped;
  end_time_ += here.skipped;
  laps_compared_ = 1;
  laps_since_jump_ = 0;
  contraction_ = per_lap;
  change_ = infinity;
  jumped_ = true;
  if (to_the_limit && !options_.metrics) {
    change_ = to_come;
    flap();
  }
  return true;
}

/// Start of the first lap from which on every lap's duration is within 1 % of the period.
double CrankStartUp::time_of_steadiness(double period) const {
  const auto off = [&](std::size_t lap) { return std::abs(period / lap_time(lap) - 1.0); };
  std::size_t lap = crossings_.size();
  while (lap > 0 && off(lap - 1) <= 1e-2) --lap;
  if (lap == 0) return 0.0;
  const Crossing& last = crossings_[lap - 1];
  if (last.skipped == 0.0 || lap == crossings_.size()) return last.time;
  // Among the laps left out, which approach the period geometrically.
  const double before = off(lap - 1), after = std::max(off(lap), 1e-6);
  return last.time + last.skipped * std::clamp(std::log(before / 1e-2) / std::log(before / after), 0.0, 1.0);
}

double CrankStartUp::lap_scatter(std::size_t laps) const {
  const std::size_t n = crossings_.size();
  double mean = 0.0, scatter = 0.0;
  for (std::size_t k = n - laps; k < n; ++k) mean += lap_time(k) / double(laps);
  for (std::size_t k = n - laps; k < n; ++k) scatter = std::max(scatter, std::abs(lap_time(k) / mean - 1.0));
  return scatter;
}

/// Supplies that vary: laps share no period with the supply in general, so averages over several laps are compared.
bool CrankStartUp::lap_done_averaging() {
  constexpr std::size_t window = averaged_laps_pwm;
  const std::size_t n = crossings_.size();
  if (measuring_) {
    if (++measured_laps_ < int(window)) return false;
    result_.lap_scatter = lap_scatter(window);
    take_metrics(int(window));
    flap();
    return true;
  }
  if (n < 5) return false;
  const double newer = lap_time(n - 1) + lap_time(n - 2), older = lap_time(n - 3) + lap_time(n - 4);
  change_ = std::abs(newer / older - 1.0);
  if (change_ > std::max(options_.tolerance, 1e-4) && n < 40) return false;
  begin_measuring();
  return true;
}

void CrankStartUp::begin_measuring() {
  if (!measuring_) measured_laps_ = 0;
  measuring_ = true;
  std::fill(std::begin(q_), std::end(q_), 0.0);
  ripple_sum_ = 0.0;
  ripple_count_ = 0;
  ripple_bottom_ = absent;
  extremes_.fill(-infinity);
  variation_ = 0.0;
  energy_mark_ = wing_energy();
}

void CrankStartUp::take_metrics(int laps) {
  const std::size_t n = crossings_.size();
  const double start = int(n) > laps ? crossings_[n - 1 - std::size_t(laps)].time : 0.0;
  CycleIntegrals<double>& integrals = result_.integrals;
  for (int k = 0; k < quadrature_count; ++k) integrals[std::size_t(quadratures[k])] = q_[k] / laps;
  integrals[std::size_t(Integral::time)] = (t_ - start) / laps;
  integrals[std::size_t(Integral::reactive_work)] = variation_ / laps;
  result_.metrics = cycle_metrics(vehicle_, integrals, extremes_, absent, options_.reporting);
  result_.averaged_laps = laps;
  if (ripple_count_ > 0) result_.current_ripple = ripple_sum_ / double(ripple_count_);
}

void CrankStartUp::flap() {
  done_ = true;
  result_.status = FlappingStatus::flapping;
  const double period =
      options_.metrics ? result_.integrals[std::size_t(Integral::time)] : lap_time(crossings_.size() - 1);
  result_.time_to_steady = time_of_steadiness(period);
  if (supply_.type == SupplyType::constant) {
    result_.settled = true;
    result_.detail = format("flaps steadily at %.6g Hz from %.4g s on; after %d laps they repeat to %.1g%s",
                            1.0 / period, result_.time_to_steady, int(crossings_.size()), change_,
                            jumped_      ? " (slow convergence, extrapolated)"
                            : turns_ > 1 ? format(" every %d laps", int(turns_)).c_str()
                                         : "");
    return;
  }
  result_.settled = result_.lap_scatter < lap_spread_settled;
  result_.detail = format(
      "flaps at %.6g Hz, averaged over %d laps whose durations differ by up to %.2g %% from their "
      "mean%s",
      1.0 / period, result_.averaged_laps, 100.0 * result_.lap_scatter,
      result_.settled ? "" : "; laps and supply share no period");
}

void CrankStartUp::rest(double theta, bool held_by_friction) {
  done_ = true;
  result_.settled = true;
  theta_ = theta;
  omega_ = 0.0;
  const double R = circuit_resistance(vehicle_);
  // A switched supply drives with its mean voltage.
  const double v = supply_.type == SupplyType::pwm ? vehicle_.voltage : supply_.voltage;
  const double stall_torque = vehicle_.motor.torque_constant * v / R;
  const double mean_current = supply_.type == SupplyType::sine ? 0.0 : vehicle_.voltage / R;
  const double angle = wrap_angle(theta);
  const double load = std::abs(net_static_torque(theta, mean_current));
  result_.lock_angle = angle;
  result_.torque_margin = held_by_friction ? std::max(0.0, holding_torque(theta) - load) : 0.0;
  result_.time_to_steady = t_;
  const double degrees = angle * degrees_per_radian;
  if (stall_torque <= constant_friction_) {
    result_.status = FlappingStatus::stalled;
    result_.detail = format(
        "the motor cannot turn: stall torque %.4g N m does not exceed the constant friction of "
        "%.4g N m (crank at %.4f deg)",
        stall_torque, constant_friction_, degrees);
    return;
  }
  result_.status = FlappingStatus::locked;
  result_.detail =
      held_by_friction
          ? format(
                "rests at crank angle %.4f deg: friction holds %.4g N m there, %.4g N m more than motor and springs "
                "apply",
                degrees, holding_torque(theta), *result_.torque_margin)
          : format(
                "rests at crank angle %.4f deg: the springs balance the stall torque of %.4g N m in a stable "
                "equilibrium",
                degrees, stall_torque);
}

void CrankStartUp::jam(double theta) {
  done_ = true;
  event(Kind::jam);
  result_.settled = true;
  result_.status = FlappingStatus::jammed;
  result_.jam_angle = wrap_angle(theta);
  result_.time_to_steady = t_;
  const CrankKinematics<double> k = kinematics(theta);
  const double degrees = *result_.jam_angle * degrees_per_radian;
  if (k.wing_lever <= 2.0 * smallest_margin * vehicle_.crank.hinge_offset) {
    result_.detail = format("jams at crank angle %.4f deg: the rod force loses its lever on the wings (g = %.2g m)",
                            degrees, k.wing_lever);
    return;
  }
  const double inertia = std::min(effective_inertia(vehicle_, k, 1.0), effective_inertia(vehicle_, k, -1.0));
  result_.detail = format(
      "jams at crank angle %.4f deg: rotor inertia and rod-force friction leave no unique "
      "acceleration (J + A (h - mu r_e) = %.2g kg m2)",
      degrees, inertia);
}

void CrankStartUp::give_up(const std::string& why) {
  done_ = true;
  result_.settled = false;
  const std::size_t n = crossings_.size();
  const bool turning = n >= 2 && t_ - crossings_.back().time < 3.0 * lap_time(n - 1);
  result_.status = FlappingStatus::undecided;
  result_.time_to_steady = t_;
  if (turning) {
    if (measuring_ && measured_laps_ > 0 && supply_.type != SupplyType::constant) {
      result_.lap_scatter = lap_scatter(std::size_t(measured_laps_));
    }
    result_.detail = format("%s; it flaps at %.6g Hz then", why.c_str(), 1.0 / lap_time(n - 1));
  } else {
    result_.detail = format("%s; the crank makes no forward revolutions then, it has been between %.4g and %.4g deg",
                            why.c_str(), swing_low_ * degrees_per_radian, swing_high_ * degrees_per_radian);
  }
}

}  // namespace

TransientResult simulate_start_up(const Vehicle<double>& vehicle, const TransientOptions& options) {
  if (vehicle.transmission == TransmissionType::direct) return detail::simulate_direct_start_up(vehicle, options);
  return CrankStartUp(vehicle, options).run();
}

}  // namespace wingbeat
