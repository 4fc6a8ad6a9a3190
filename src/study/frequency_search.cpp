#include "wingbeat/study/frequency_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace wingbeat {
namespace {

template <class... Args>
std::string format(const char* pattern, Args... args) {
  char text[600];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

struct Trial {
  double voltage = 0.0;
  std::optional<double> frequency;  ///< empty: does not flap
  FlappingStatus status = FlappingStatus::stalled;
  std::string detail;
};

class Search {
 public:
  Search(const Vehicle<double>& vehicle, double frequency, const SteadyOptions& options, const StartUp& start_up)
      : vehicle_(vehicle), target_(frequency), options_(options), start_up_(start_up) {
    // The root finder must not see the solver's own error.
    closeness_ = std::max(0.1 * options.tolerance, 1e-13) * frequency;
    options_.tolerance = std::max(0.01 * options.tolerance, 1e-12);
    options_.stability = false;
  }

  FrequencySearch run() {
    const Motor<double>& m = vehicle_.motor;
    const double K = m.torque_constant;
    const double omega = two_pi * target_;
    const double unloaded =
        K * omega + circuit_resistance(vehicle_) * (m.viscous_damping * omega + m.friction_torque) / K;

    Trial high = attempt(unloaded);
    Trial low = high;
    if (reaches(high)) {
      // A load that drives the motor on the average would be needed for this; look below all the same.
      while (reaches(low) && low.voltage > unloaded / frequency_search_span) low = attempt(0.5 * low.voltage);
      if (reaches(low)) return conclude(FrequencyOutcome::too_low, low, format_slowest(low));
    }
    Trial fastest = high;
    while (!reaches(high)) {
      if (!(high.voltage < frequency_search_span * unloaded)) return give_up(fastest, high);
      low = high;
      high = attempt(std::min(1.5 * high.voltage, frequency_search_span * unloaded));
      if (high.frequency && !(fastest.frequency > high.frequency)) fastest = high;
    }
    return close_in(low, high);
  }

 private:
  Trial attempt(double voltage) {
    ++evaluations_;
    vehicle_.voltage = voltage;
    const SteadyFlapping found = find_steady_flapping(vehicle_, options_, start_up_);
    Trial trial{voltage, std::nullopt, found.status, found.detail};
    if (found.status == FlappingStatus::flapping) trial.frequency = found.metrics[Metric::frequency];
    return trial;
  }

  bool reaches(const Trial& t) const { return t.frequency && *t.frequency >= target_; }
  bool close(const Trial& t) const { return t.frequency && std::abs(*t.frequency - target_) <= closeness_; }

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
      if (!low.frequency && width < 1e-5 * high.voltage) break;
      if (width <= narrow) break;
      const double middle = 0.5 * (low.voltage + high.voltage);
      double x = middle;
      if (low.frequency) {
        const double f_low = *low.frequency - target_, f_high = *high.frequency - target_;
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
    if (low.frequency) {
      // At the last bits of the voltage a smooth frequency is as close as its own rounding allows.
      const double gap = *high.frequency - *low.frequency;
      if (gap < 10.0 * options_.tolerance * target_ + 2.0 * closeness_) return reached(high);
      return conclude(FrequencyOutcome::jumps, high,
                      format("at %.5g V the flapping frequency jumps from %.5g Hz to %.5g Hz: %.5g Hz in between "
                             "cannot be held",
                             high.voltage, *low.frequency, *high.frequency, target_));
    }
    return conclude(FrequencyOutcome::too_low, low,
                    format("%.5g Hz cannot be reached: from rest it flaps only above %.4g V, and there at %.4g Hz "
                           "already; below, it is %s (%s)",
                           target_, high.voltage, *high.frequency, name_of(low.status), low.detail.c_str()));
  }

  std::string format_slowest(const Trial& slowest) const {
    return format("%.5g Hz cannot be reached: at %.4g V, the lowest voltage tried, it flaps at %.4g Hz already",
                  target_, slowest.voltage, *slowest.frequency);
  }

  FrequencySearch give_up(const Trial& fastest, const Trial& last) {
    if (!fastest.frequency) {
      return conclude(FrequencyOutcome::never_flaps, last,
                      format("it flaps at no voltage up to %.4g V; there it is %s: %s", last.voltage,
                             name_of(last.status), last.detail.c_str()));
    }
    return conclude(FrequencyOutcome::too_high, fastest,
                    format("%.5g Hz cannot be reached: up to %.4g V it flaps at %.4g Hz at most, at %.4g V", target_,
                           last.voltage, *fastest.frequency, fastest.voltage));
  }

  FrequencySearch reached(const Trial& t) {
    return {FrequencyOutcome::reached, t.voltage, t.status, t.detail, evaluations_};
  }
  FrequencySearch conclude(FrequencyOutcome outcome, const Trial& closest, const std::string& detail) const {
    return {outcome, absent, closest.status, detail, evaluations_};
  }

  Vehicle<double> vehicle_;
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
  return Search(vehicle, frequency, options, start_up).run();
}

}  // namespace wingbeat
