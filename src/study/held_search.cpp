#include "study/held_search.hpp"

#include <algorithm>
#include <cmath>

#include "study/voltage_trials.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/study/frequency_search.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

/// A crank that turns evenly, with its wings: what the motor then has to give on average, and the lift.
class EvenTurn {
 public:
  explicit EvenTurn(const Vehicle<double>& v) : vehicle_(v) {
    for (int n = 0; n < angles; ++n) {
      const double theta = two_pi * (n + 0.5) / angles;
      Place& place = places_[std::size_t(n)];
      place.kinematics = crank_kinematics(v.transmission, std::sin(theta), std::cos(theta));
      place.spring_moment = spring_moment(v, place.kinematics);
    }
  }

  double steepest() const {
    double steepest = 0.0;
    for (const Place& p : places_) steepest = std::max(steepest, std::abs(p.kinematics.stroke_slope));
    return steepest;
  }

  struct Loads {
    double lift;     ///< [N]
    double voltage;  ///< [V]
  };
  /// At that crank speed [rad/s]. The rod force is that of the wings' equation (1) without acceleration of the crank.
  Loads at(double omega) const {
    const double inertia = vehicle_.wing_count * vehicle_.wing_inertia;
    double lift = 0.0, torque = 0.0, aerodynamic = 0.0;
    for (const Place& p : places_) {
      const CrankKinematics<double>& k = p.kinematics;
      const double velocity = k.stroke_slope * omega;
      const AeroLoads<double> aero = aero_loads(vehicle_.wings, std::abs(velocity));
      const double moment = inertia * k.stroke_second_derivative * omega * omega + p.spring_moment +
                            (velocity < 0.0 ? -aero.moment : aero.moment);
      const double force = moment / k.wing_jacobian;
      lift += aero.lift / angles;
      torque += (force * k.crank_jacobian + load_friction(vehicle_.friction, std::abs(force), 1.0)) / angles;
      aerodynamic += aero.power / omega / angles;
    }
    // Where a mechanism all but locks on its way the rod force says nothing.
    constexpr double usual_losses = 1.15, max_losses = 20.0;
    if (!(torque >= aerodynamic && torque <= max_losses * aerodynamic)) torque = usual_losses * aerodynamic;
    torque = torque_before_gear(vehicle_.motor, torque + load_free_friction(vehicle_.friction, omega, 1.0));
    return {lift, unloaded_voltage(vehicle_, omega, torque + vehicle_.motor.friction_torque)};
  }
  double lift(double omega) const { return at(omega).lift; }
  double voltage(double omega) const { return at(omega).voltage; }

 private:
  static constexpr int angles = 16;
  struct Place {
    CrankKinematics<double> kinematics;
    double spring_moment;  ///< [N m]
  };
  const Vehicle<double>& vehicle_;
  std::array<Place, angles> places_;
};

/// The zero of value + slope x + bend x^2 on its rising side, of a slope > 0; by the slope alone where there is none.
double rising_zero(double value, double slope, double bend) {
  const double square_of_root = slope * slope - 4.0 * bend * value;
  return square_of_root > 0.0 ? -2.0 * value / (slope + std::sqrt(square_of_root)) : -value / slope;
}

constexpr double slope_step = 1.05;  ///< of speeds whose voltages show a slope

}  // namespace

EnsembleSearch search_frequency(const Vehicle<double>& v, std::size_t member, double frequency) {
  const double omega = two_pi * frequency;
  const EvenTurn turn(v);
  EnsembleSearch s;
  s.member = member;
  s.target = frequency;
  s.next = turn.voltage(omega);
  s.usual_slope = std::log(slope_step) / std::log(turn.voltage(slope_step * omega) / s.next);
  s.limit = frequency_search_span * unloaded_voltage(v, omega, v.motor.friction_torque);
  return s;
}

EnsembleSearch search_power(const Vehicle<double>& v, std::size_t member, double power) {
  const EvenTurn turn(v);
  const double K = v.motor.torque_constant, R = circuit_resistance(v);
  const auto power_at = [&](double omega) {
    const double voltage = turn.voltage(omega);
    return voltage * (voltage - K * omega) / R;
  };
  double low = 1e-3 * std::sqrt(power * R) / K, high = low;
  while (power_at(high) < power && high < 1e12) high *= 2.0;
  for (int round = 0; round < 30; ++round) {
    const double middle = 0.5 * (low + high);
    (power_at(middle) < power ? low : high) = middle;
  }
  EnsembleSearch s;
  s.member = member;
  s.target = power;
  s.next = turn.voltage(high);
  const double faster = slope_step * high;
  s.usual_slope = std::log(power_at(faster) / power_at(high)) / std::log(turn.voltage(faster) / s.next);
  if (!(s.usual_slope > 1.0 && s.usual_slope < 4.0)) s.usual_slope = 2.5;
  s.limit = frequency_search_span * s.next;
  return s;
}

EnsembleSearch search_lift(const Vehicle<double>& v, std::size_t member, double lift, bool in_range) {
  const EvenTurn turn(v);
  const BladeElement<double>& w = v.wings;
  double fastest = HUGE_VAL;
  if (in_range) fastest = fastest_stroke(w) / turn.steepest();
  double omega = std::min(std::sqrt(2.0 * lift / (w.air_density * w.s2)) / turn.steepest(), fastest);
  EvenTurn::Loads here = turn.at(omega);
  for (int round = 0; round < 8; ++round) {
    const double ratio = here.lift > 0.0 ? std::pow(lift / here.lift, 0.6) : 1.3;
    const double next = std::min(omega * std::clamp(ratio, 0.7, 1.3), fastest);
    if (std::abs(next / omega - 1.0) < 0.01) break;
    here = turn.at(omega = next);
  }
  EnsembleSearch s;
  s.member = member;
  s.target = lift;
  s.next = here.voltage;
  const EvenTurn::Loads faster = turn.at(slope_step * omega), slower = turn.at(omega / slope_step);
  const double up = std::log(faster.voltage / here.voltage), down = std::log(slower.voltage / here.voltage);
  const double slope_up = std::log(faster.lift / here.lift) / up, slope_down = std::log(slower.lift / here.lift) / down;
  s.usual_bend = (slope_up - slope_down) / (up - down);
  s.usual_slope = slope_up - s.usual_bend * up;
  if (!(s.usual_slope > 0.3 && s.usual_slope < 4.0)) s.usual_slope = 1.7, s.usual_bend = 0.0;
  if (!(std::abs(s.usual_bend) < 10.0)) s.usual_bend = 0.0;
  s.next *= std::exp(rising_zero(std::log(here.lift / lift), s.usual_slope, s.usual_bend));
  s.limit = frequency_search_span * s.next;
  return s;
}

namespace {

/// The voltage [ln] at which a curve through the last trials has the value sought; in logarithms it is nearly straight.
double interpolated(const EnsembleSearch& s) {
  const auto& [a, b, c] = s.last;
  const double at_usual_slope = a.ln_voltage + rising_zero(a.gap, s.usual_slope, s.usual_bend);
  if (s.trials == 1) return at_usual_slope;
  const double inverse_slope = (a.ln_voltage - b.ln_voltage) / (a.gap - b.gap);
  if (!(inverse_slope > 0.1 && inverse_slope < 5.0)) return at_usual_slope;
  if (s.trials == 2 && s.usual_bend != 0.0) {
    const double slope = 1.0 / inverse_slope + s.usual_bend * (a.ln_voltage - b.ln_voltage);
    if (slope > 0.0) return a.ln_voltage + rising_zero(a.gap, slope, s.usual_bend);
  }
  double x = a.ln_voltage - a.gap * inverse_slope;
  if (s.trials == 3) {
    const double bend = (inverse_slope - (b.ln_voltage - c.ln_voltage) / (b.gap - c.gap)) / (a.gap - c.gap);
    const double more = a.gap * b.gap * bend;
    if (std::abs(more) < 0.5 * std::abs(a.gap * inverse_slope)) x += more;
  }
  return x;
}

/// The voltage [ln] at which the lift has the value sought, or its peak where the parabola through the last three
/// trials falls short of it; NaN where that does not show it. Towards the peak an inverse slope has no meaning.
double interpolated_lift(const EnsembleSearch& s) {
  const Parabola p(s.last);
  const double zero = p.zero();
  if (p.bend < 0.0 && std::isnan(zero)) return s.last[0].ln_voltage + p.top();
  return s.last[0].ln_voltage + (p.slope > 0.0 || p.bend < 0.0 ? zero : absent);
}

/// About by how much, relative, the value at an interpolated voltage [ln] misses the one sought.
double expected_miss(const EnsembleSearch& s, double ln_voltage) {
  const auto& [a, b, c] = s.last;
  if (s.trials < 2) return 1.0;
  if (s.trials < 3 || s.lifts.empty()) {
    const double of_bend = s.usual_bend != 0.0 ? 0.1 : 1.0;  // what is known of it
    return std::abs(a.gap * b.gap * (s.trials == 3 ? c.gap : of_bend));
  }
  constexpr double third_derivative = 30.0;  // of ln(lift) by ln(voltage), at most, about
  double miss = third_derivative / 6.0;
  for (const Trial& trial : s.last) miss *= std::abs(ln_voltage - trial.ln_voltage);
  return miss;
}

}  // namespace

void advance(EnsembleSearch& s, bool flaps, double value, int round, double closeness) {
  const double tried = s.next;
  if (!flaps) ++s.still;
  (flaps && value >= s.target ? s.high : s.low) = tried;
  const bool shows = flaps && value > 0.0;
  if (shows) {
    std::copy_backward(s.last.begin(), s.last.end() - 1, s.last.end());
    s.last[0] = {std::log(tried), std::log(value / s.target)};
    s.trials = std::min(s.trials + 1, 3);
  }
  double ln_guess = interpolated(s);
  if (s.trials == 3 && !s.lifts.empty()) {
    const double of_lift = interpolated_lift(s);
    if (std::isfinite(of_lift)) ln_guess = of_lift;
  }
  const double guess = shows ? std::exp(ln_guess) : 0.0;
  s.is_last = shows && expected_miss(s, ln_guess) < closeness;
  if (s.high == 0.0) {
    s.next = shows ? std::clamp(guess, tried, 1.6 * tried) : 1.5 * tried;
  } else if (s.low == 0.0) {
    s.next = std::clamp(guess, 0.5 * tried, tried);
  } else {
    // The first trials are rough.
    constexpr double slack = 1e-4;
    const bool inside = guess >= (1.0 - slack) * s.low && guess <= (1.0 + slack) * s.high;
    const bool halves = !inside || (round % 6 == 5 && !s.is_last);
    s.next = halves ? 0.5 * (s.low + s.high) : guess;
    s.is_last = s.is_last && !halves;
  }
}

void note_lift(EnsembleSearch& s, double lift) {
  const Trial trial{std::log(s.next), std::log(lift / s.target)};
  const auto behind = std::upper_bound(s.lifts.begin(), s.lifts.end(), trial,
                                       [](const Trial& x, const Trial& y) { return x.ln_voltage < y.ln_voltage; });
  if (behind != s.lifts.begin() && (behind - 1)->ln_voltage == trial.ln_voltage) return;
  const auto here = s.lifts.insert(behind, trial);
  // The first lift that is enough: the search goes on between it and the one before.
  if (!s.seeks_peak || trial.gap < 0.0) return;
  s.seeks_peak = false;
  if (here == s.lifts.begin()) return;
  s.low = std::exp((here - 1)->ln_voltage);
  s.trials = 0;
  for (auto lower = here; lower != s.lifts.begin() && s.trials < 2;) s.last[std::size_t(s.trials++)] = *--lower;
}

bool rises(const EnsembleSearch& s) {
  constexpr double little = 0.2;
  const double answer = std::log(s.next);
  const auto lower =
      std::find_if(s.lifts.rbegin(), s.lifts.rend(), [&](const Trial& trial) { return trial.ln_voltage < answer; });
  return lower != s.lifts.rend() && lower->gap < 0.0 && lower->ln_voltage > answer - little;
}

void begin_again(EnsembleSearch& s, double voltage) {
  s.next = voltage;
  s.low = s.high = 0.0;
  s.trials = 0;
  s.is_last = false;
}

bool goes_on_towards_peak(EnsembleSearch& s) {
  const double next = towards_peak(s.lifts, s.too_fast);
  if (!(next > 0.0)) return false;
  begin_again(s, next);
  s.seeks_peak = true;
  return true;
}

}  // namespace wingbeat::detail
