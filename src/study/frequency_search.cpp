#include "wingbeat/study/frequency_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "wingbeat/core/text.hpp"

namespace wingbeat {
namespace {

using detail::format;

/// The metric that is to reach a value, with the words for it.
struct Goal {
  Metric metric;
  double value;
  const char* unit;
  const char* does;   ///< "it ... 22 Hz"
  const char* there;  ///< "and there ... 22 Hz already"
  const char* name;
  bool peaks;  ///< over the voltage, instead of growing with it
};

struct Trial {
  double voltage = 0.0;
  std::optional<double> value;  ///< of the goal's metric; empty: does not flap
  FlappingStatus status = FlappingStatus::stalled;
  std::string detail;
};

class Search {
 public:
  Search(const Vehicle<double>& vehicle, const Goal& goal, const SteadyOptions& options, const StartUp& start_up)
      : vehicle_(vehicle), goal_(goal), target_(goal.value), options_(options), start_up_(start_up) {
    // The root finder must not see the solver's own error.
    closeness_ = std::max(0.1 * options.tolerance, 1e-13) * target_;
    options_.tolerance = std::max(0.01 * options.tolerance, 1e-12);
    options_.stability = false;
  }

  /// From the voltage `first` on: down to the lowest of the span while the goal is reached, else up to its highest.
  FrequencySearch run(double first) {
    Trial high = attempt(first);
    Trial low = high;
    if (reaches(high)) {
      while (reaches(low) && low.voltage > first / frequency_search_span) low = attempt(0.5 * low.voltage);
      if (reaches(low)) return conclude(FrequencyOutcome::too_low, low, format_slowest(low));
    }
    Trial most = high;
    while (!reaches(high)) {
      if (!(high.voltage < frequency_search_span * first)) {
        if (!most.value || !goal_.peaks) return give_up(most, high);
        const Trial peak = climb(most);
        if (!reaches(peak)) return give_up(peak, high);
        return close_in(attempt(most.voltage / 1.5), peak);
      }
      low = high;
      high = attempt(std::min(1.5 * high.voltage, frequency_search_span * first));
      if (high.value && !(most.value > high.value)) most = high;
    }
    return close_in(low, high);
  }

 private:
  Trial attempt(double voltage) {
    ++evaluations_;
    vehicle_.voltage = voltage;
    const SteadyFlapping found = find_steady_flapping(vehicle_, options_, start_up_);
    Trial trial{voltage, std::nullopt, found.status, found.detail};
    if (found.status == FlappingStatus::flapping) trial.value = found.metrics[goal_.metric];
    return trial;
  }

  /// The goal's metric at its peak between the neighbours of the best trial (golden section), or where it is reached.
  Trial climb(const Trial& best) {
    constexpr double golden = 0.6180339887498949;
    double a = best.voltage / 1.5, b = 1.5 * best.voltage;
    const auto value = [](const Trial& t) { return t.value.value_or(-1.0); };
    Trial left = attempt(b - golden * (b - a)), right = attempt(a + golden * (b - a)), top = best;
    while (b - a > 1e-6 * b) {
      for (const Trial* t : {&left, &right}) {
        if (value(*t) > value(top)) top = *t;
      }
      if (reaches(top)) return top;
      if (value(left) >= value(right)) {
        b = right.voltage, right = left, left = attempt(b - golden * (b - a));
      } else {
        a = left.voltage, left = right, right = attempt(a + golden * (b - a));
      }
    }
    return top;
  }

  bool reaches(const Trial& t) const { return t.value && *t.value >= target_; }
  bool close(const Trial& t) const { return t.value && std::abs(*t.value - target_) <= closeness_; }

  /// low stays below the target or does not flap, high reaches it.
  FrequencySearch close_in(Trial low, Trial high) {
    const double narrow = 4e-16 * high.voltage;
    // ITP (Oliveira and Takahashi 2020) with kappa_2 = 1: false position, pulled towards the midpoint enough that no
    // more than n_max steps are ever needed; plain bisection while the lower end does not flap.
    const double epsilon = 1e-15 * high.voltage;
    const double width_0 = high.voltage - low.voltage;
    const int n_max = int(std::ceil(std::log2(width_0 / epsilon))) + 1;
    for (int j = 0; j < n_max + 40; ++j) {
      if (close(high)) return reached(high);
      if (close(low)) return reached(low);
      const double width = high.voltage - low.voltage;
      // Below the flapping range more digits of its edge say nothing more.
      if (!low.value && width < 1e-5 * high.voltage) break;
      if (width <= narrow) break;
      const double middle = 0.5 * (low.voltage + high.voltage);
      double x = middle;
      if (low.value) {
        const double f_low = *low.value - target_, f_high = *high.value - target_;
        const double falsi = (f_high * low.voltage - f_low * high.voltage) / (f_high - f_low);
        const double sigma = middle >= falsi ? 1.0 : -1.0;
        const double delta = 0.1 * width * width / width_0;
        const double truncated = delta <= std::abs(middle - falsi) ? falsi + sigma * delta : middle;
        const double radius = std::max(0.0, epsilon * std::ldexp(1.0, std::max(0, n_max - j)) - 0.5 * width);
        x = std::abs(truncated - middle) <= radius ? truncated : middle - sigma * radius;
      }
      if (!(x > low.voltage && x < high.voltage)) x = middle;
      const Trial trial = attempt(x);
      (reaches(trial) ? high : low) = trial;
    }
    if (low.value) {
      // At the last bits of the voltage a smooth frequency is as close as its own rounding allows.
      const double gap = *high.value - *low.value;
      if (gap < 10.0 * options_.tolerance * target_ + 2.0 * closeness_) return reached(high);
      return conclude(FrequencyOutcome::jumps, high,
                      format("at %.5g V the %s jumps from %.5g %s to %.5g %s: %.5g %s in between cannot be held",
                             high.voltage, goal_.name, *low.value, goal_.unit, *high.value, goal_.unit, target_,
                             goal_.unit));
    }
    return conclude(FrequencyOutcome::too_low, low,
                    format("%.5g %s cannot be reached: from rest it flaps only above %.4g V, and there %s %.4g %s "
                           "already; below, it is %s (%s)",
                           target_, goal_.unit, high.voltage, goal_.there, *high.value, goal_.unit,
                           name_of(low.status), low.detail.c_str()));
  }

  std::string format_slowest(const Trial& slowest) const {
    return format("%.5g %s cannot be reached: at %.4g V, the lowest voltage tried, it %s %.4g %s already", target_,
                  goal_.unit, slowest.voltage, goal_.does, *slowest.value, goal_.unit);
  }

  FrequencySearch give_up(const Trial& most, const Trial& last) {
    if (!most.value) {
      return conclude(FrequencyOutcome::never_flaps, last,
                      format("it flaps at no voltage up to %.4g V; there it is %s: %s", last.voltage,
                             name_of(last.status), last.detail.c_str()));
    }
    return conclude(FrequencyOutcome::too_high, most,
                    format("%.5g %s cannot be reached: up to %.4g V it %s %.4g %s at most, at %.4g V", target_,
                           goal_.unit, last.voltage, goal_.does, *most.value, goal_.unit, most.voltage));
  }

  FrequencySearch reached(const Trial& t) {
    return {FrequencyOutcome::reached, t.voltage, t.status, t.detail, evaluations_};
  }
  FrequencySearch conclude(FrequencyOutcome outcome, const Trial& closest, const std::string& detail) const {
    return {outcome, absent, closest.status, detail, evaluations_};
  }

  Vehicle<double> vehicle_;
  Goal goal_;
  double target_;
  double closeness_;
  SteadyOptions options_;
  const StartUp& start_up_;
  int evaluations_ = 0;
};

}  // namespace

FrequencySearch find_voltage_for_frequency(const Vehicle<double>& vehicle, double frequency,
                                           const SteadyOptions& options, const StartUp& start_up) {
  require(frequency > 0.0 && std::isfinite(frequency), "frequency", "must be > 0 and finite", "Hz", frequency);
  const Goal goal{Metric::frequency, frequency, "Hz", "flaps at", "at", "flapping frequency", false};
  // Where the unloaded motor turns that fast. Only a load that drives the motor would need less.
  const Motor<double>& m = vehicle.motor;
  const double K = m.torque_constant, omega = two_pi * frequency;
  const double unloaded = K * omega + circuit_resistance(vehicle) * (m.viscous_damping * omega + m.friction_torque) / K;
  return Search(vehicle, goal, options, start_up).run(unloaded);
}

FrequencySearch find_voltage_for_lift(const Vehicle<double>& vehicle, double lift, double nominal,
                                      const SteadyOptions& options, const StartUp& start_up) {
  require(lift > 0.0 && std::isfinite(lift), "lift", "must be > 0 and finite", "N", lift);
  require(nominal > 0.0 && std::isfinite(nominal), "voltage", "must be > 0 and finite", "V", nominal);
  const Goal goal{Metric::lift_mean, lift, "N", "lifts", "with", "mean lift", true};
  return Search(vehicle, goal, options, start_up).run(lift_search_start * nominal);
}

}  // namespace wingbeat
