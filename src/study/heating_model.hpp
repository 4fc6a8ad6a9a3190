// The two lumps of a motor under what a heating curve imposes on it, in time.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "wingbeat/core/math.hpp"
#include "wingbeat/study/motor_heating.hpp"

namespace wingbeat::detail::heat {

/// Logarithms of the four constants and of the winding's resistance at the start.
enum Unknown { ln_R1, ln_R2, ln_tau_w, ln_tau_c, ln_R_start, unknowns };

/// A column that varies by no more than this is taken as constant: the mean is more exact than what was read.
inline constexpr double constant_to = 0.02;

inline bool is_known(double x) { return !std::isnan(x); }

inline double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double x : values) {
    if (is_known(x)) sum += x, ++count;
  }
  return count > 0 ? sum / double(count) : std::nan("");
}

inline double scatter_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double squares = 0.0;
  std::size_t count = 0;
  for (const double x : values) {
    if (is_known(x)) squares += square(x - mean), ++count;
  }
  return count > 1 ? std::sqrt(squares / double(count - 1)) : 0.0;
}

/// What is imposed on the motor, at the times of the curve: linear between them.
struct Imposed {
  std::vector<double> current, voltage;  ///< empty where it is not imposed
};

/// A column with gaps filled by straight lines.
inline std::vector<double> filled(const std::vector<double>& time, std::vector<double> values) {
  if (scatter_of(values) <= constant_to * std::abs(mean_of(values))) {
    std::fill(values.begin(), values.end(), mean_of(values));
    return values;
  }
  std::size_t last = values.size();
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (!is_known(values[n])) continue;
    const std::size_t from = last == values.size() ? 0 : last + 1;
    for (std::size_t k = from; k < n; ++k) {
      const double share = last == values.size() ? 1.0 : (time[k] - time[last]) / (time[n] - time[last]);
      values[k] = last == values.size() ? values[n] : values[last] + share * (values[n] - values[last]);
    }
    last = n;
  }
  for (std::size_t k = last + 1; last < values.size() && k < values.size(); ++k) values[k] = values[last];
  return values;
}

inline Imposed imposed_on(const HeatingCurve& c) {
  const auto constant = [&](double x) { return std::vector<double>(c.time.size(), x); };
  Imposed imposed;
  const bool current = c.held_current || !c.current.empty(), voltage = c.held_voltage || !c.voltage.empty();
  const auto current_series = [&] { return c.held_current ? constant(*c.held_current) : filled(c.time, c.current); };
  const auto voltage_series = [&] { return c.held_voltage ? constant(*c.held_voltage) : filled(c.time, c.voltage); };
  if (c.motor == HeatedMotor::idling) {
    imposed.current = current_series();
    imposed.voltage = voltage_series();
    return imposed;
  }
  // Of two columns the steadier one is what the supply holds.
  bool by_voltage = voltage && !current;
  if (current && voltage) {
    const auto spread = [](const std::vector<double>& x) { return scatter_of(x) / std::abs(mean_of(x)); };
    by_voltage = c.held_voltage || (!c.held_current && spread(c.voltage) < spread(c.current));
  }
  (by_voltage ? imposed.voltage : imposed.current) = by_voltage ? voltage_series() : current_series();
  return imposed;
}

/// State of the two lumps: rise of the winding over the case and of the case over the air [K].
template <class T>
struct Rises {
  T winding, casing;
};

class Heating {
 public:
  explicit Heating(const HeatingCurve& curve) : curve_(curve), imposed_(imposed_on(curve)) {
    start_ = curve.start_temperature.value_or(curve.ambient_temperature);
    cold_ = 1.0 + curve.copper_temperature_coefficient * (start_ - curve.reference_temperature);
  }

  double start_temperature() const { return start_; }
  /// Of the winding at the start over that at the reference temperature.
  double start_over_cold() const { return cold_; }
  bool by_voltage() const { return curve_.motor == HeatedMotor::stalled && !imposed_.voltage.empty(); }
  double imposed_current(std::size_t n) const { return imposed_.current[n]; }
  double imposed_voltage(std::size_t n) const { return imposed_.voltage[n]; }

  template <class T>
  T winding_temperature(const Rises<T>& r) const {
    return r.winding + r.casing + curve_.ambient_temperature;
  }
  template <class T>
  T resistance(const T* x, const T& winding_temperature) const {
    using std::exp;
    const double a = curve_.copper_temperature_coefficient;
    return exp(x[ln_R_start]) * (1.0 + a * (winding_temperature - curve_.reference_temperature)) / cold_;
  }

  /// Calls visit(n, rises) at every time of the curve. Between two times the powers are taken as linear in steps of a
  /// fraction of the shorter time constant, the lumps' own decay being exact (exponential Runge-Kutta of order 2, Cox
  /// and Matthews 2002).
  template <class T, class Visit>
  void run(const T* x, const Visit& visit) const {
    using std::exp;
    const T R1 = exp(x[ln_R1]), R2 = exp(x[ln_R2]), tau_w = exp(x[ln_tau_w]), tau_c = exp(x[ln_tau_c]);
    Rises<T> r{T(0.0), T(start_ - curve_.ambient_temperature)};
    const double shortest = std::min(value_of_(tau_w), value_of_(tau_c));
    double before = 0.0;
    for (std::size_t n = 0; n < curve_.time.size(); ++n) {
      const double whole = curve_.time[n] - before;
      const std::size_t from = n == 0 ? 0 : n - 1;
      constexpr double steps_per_constant = 10.0, max_steps = 400.0;
      const int steps = int(std::clamp(std::ceil(steps_per_constant * whole / shortest), 1.0, max_steps));
      const double h = whole / steps;
      if (whole > 0.0) {
        const Decay<T> of_winding(h, tau_w), of_case(h, tau_c);
        for (int k = 0; k < steps; ++k) {
          const auto first = powers(x, r, from, n, double(k) / steps);
          Rises<T> ahead{of_winding.constant(r.winding, T(R1 * first.copper)),
                         of_case.constant(r.casing, T(R2 * (first.copper + first.casing)))};
          const auto second = powers(x, ahead, from, n, double(k + 1) / steps);
          const T copper = second.copper - first.copper, casing = second.casing - first.casing;
          r = {ahead.winding + of_winding.growing(T(R1 * copper)),
               ahead.casing + of_case.growing(T(R2 * (copper + casing)))};
          keep_finite(r.winding);
          keep_finite(r.casing);
        }
      }
      visit(n, r);
      before = curve_.time[n];
    }
  }

 private:
  /// Trials of a fit may run away under a held current: a temperature that no motor has tells the fit enough.
  template <class T>
  static void keep_finite(T& rise) {
    constexpr double highest = 1e5;
    if (!(std::abs(value_of_(rise)) < highest)) rise = T(highest);
  }

  static double value_of_(double x) { return x; }
  template <class Jet>
  static double value_of_(const Jet& x) {
    return x.a;
  }

  /// What a lump does in a step of h under a power that is constant, and under one that grows from 0.
  template <class T>
  struct Decay {
    Decay(double h, const T& tau) {
      using std::exp;
      const T z = T(h) / tau;
      kept = exp(-z);
      // 1 - (1 - e^-z)/z, by its series where that cancels
      grown = value_of_(z) < 1e-3 ? T(z * (0.5 - z / 6.0)) : T(1.0 - (1.0 - kept) / z);
    }
    T constant(const T& rise, const T& settled) const { return kept * rise + (1.0 - kept) * settled; }
    T growing(const T& settled) const { return grown * settled; }
    T kept, grown;
  };

  template <class T>
  struct Powers {
    T copper, casing;
  };
  /// Losses [W], the imposed quantities being those at a share of the way between two times.
  template <class T>
  Powers<T> powers(const T* x, const Rises<T>& r, std::size_t from, std::size_t to, double share) const {
    const auto between = [&](const std::vector<double>& series) {
      return series[from] + share * (series[to] - series[from]);
    };
    const T R = resistance(x, winding_temperature(r));
    if (by_voltage()) return {T(square(between(imposed_.voltage))) / R, T(0.0)};
    const double i = between(imposed_.current);
    const T copper = R * (i * i);
    if (curve_.motor == HeatedMotor::stalled) return {copper, T(0.0)};
    return {copper, T(between(imposed_.voltage) * i) - copper};
  }

  const HeatingCurve& curve_;
  Imposed imposed_;
  double start_ = 0.0, cold_ = 1.0;
};

}  // namespace wingbeat::detail::heat
