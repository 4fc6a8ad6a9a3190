#include "wingbeat/study/endurance.hpp"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/chebyshev.hpp>
#include <cmath>
#include <map>

#include "study/flight_moment.hpp"
#include "study/flight_path.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/thermal_equilibrium.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

/// What is integrated over the charge drawn.
enum Total { time, electrical, internal, aerodynamic, lift, total_count };
using Totals = std::array<double, total_count>;

/// The integrands between two open-circuit voltages [V].
struct Piece {
  static constexpr std::size_t count = 17;
  double low, high;
  std::array<std::array<double, count>, total_count>
      coefficients;  ///< of Chebyshev's series, the first one halved in it

  double value(Total total, double voltage) const {
    const double x = high > low ? (2.0 * voltage - low - high) / (high - low) : 0.0;
    return boost::math::chebyshev_clenshaw_recurrence(coefficients[total].data(), count, x);
  }
};

using detail::BatteryLoad;
using detail::FlightMoment;
using detail::FlightMoments;

class Flight {
 public:
  Flight(const Design<double>& design, const EnduranceOptions& options)
      : battery_(design.supply.battery),
        options_(options),
        moments_(design, options),
        winding_time_(design.motor.thermal.time_constant_winding),
        case_time_(design.motor.thermal.time_constant_case) {
    result_.capacity = battery_.capacity;
    result_.throttle = design.supply.throttle;
  }

  EnduranceResult run() {
    const double first = battery_.charge;
    FlightMoments::Temperatures ambient;
    if (heats_up(moments_.thermal()) && winding_time_) {
      const double T_amb = moments_.thermal().ambient_temperature;
      ambient = MotorTemperatures<double>{T_amb, T_amb};
    }
    result_.first_charge = first;
    result_.first_voltage = open_circuit_voltage(battery_, first);
    if (battery_.cutoff_voltage) result_.cutoff_voltage = battery_.cells * *battery_.cutoff_voltage;
    if (moments_.weighed()) result_.hover = Hover::never;
    const FlightMoment start = moments_.at(result_.first_voltage, ambient, start_up_in_time());
    result_.status = start.status;
    result_.evidence = start.evidence;
    if (moments_.throttled()) note_full_throttle(ambient);
    if (start.flaps && ambient) {
      discharge_warming_up(start);
    } else if (start.flaps) {
      known_[first] = start;
      const double last = last_charge();
      std::optional<double> hover;
      if (moments_.weighed()) hover = hover_charge(last);
      discharge(last, hover);
    } else if (moments_.throttled() && result_.status == FlappingStatus::flapping) {
      result_.end = EnduranceEnd::sinks;
    }
    result_.evaluations = moments_.evaluations();
    return std::move(result_);
  }

 private:
  /// What the vehicle does at full throttle from rest, which says why it does not hover where it cannot.
  void note_full_throttle(const FlightMoments::Temperatures& ambient) {
    const SteadyFlapping full = moments_.at_full_throttle(result_.first_voltage, ambient, start_up_in_time());
    result_.status = full.status;
    result_.evidence = full.evidence;
    result_.first_full_lift_to_weight = full.metrics[Metric::lift_to_weight];
  }

  /// The turning vehicle at a charge: no start from rest is asked for.
  const FlightMoment& at(double charge) {
    if (battery_.discharge_curve.empty()) charge = battery_.charge;
    const auto found = known_.find(charge);
    if (found != known_.end()) return found->second;
    return known_[charge] = moments_.at(open_circuit_voltage(battery_, charge), {}, {});
  }

  std::optional<EnduranceEnd> end_at(const FlightMoment& moment, double charge) const {
    return moments_.end_at(moment, open_circuit_voltage(battery_, charge));
  }
  bool flies(double charge) { return !end_at(at(charge), charge); }

  /// Charges from the first down to `last`, the rows of a short discharge curve among them.
  std::vector<double> grid(double last) const {
    std::vector<double> charges;
    const double first = battery_.charge;
    for (int n = 0; n <= options_.intervals; ++n) {
      charges.push_back(n == options_.intervals ? last : first + (last - first) * n / options_.intervals);
    }
    if (battery_.discharge_curve.size() <= std::size_t(options_.intervals)) {
      for (const auto& [charge, voltage] : battery_.discharge_curve) {
        if (charge > last && charge < first) charges.push_back(charge);
      }
    }
    std::sort(charges.begin(), charges.end(), std::greater<>());
    charges.erase(std::unique(charges.begin(), charges.end()), charges.end());
    return charges;
  }

  double last_charge() {
    const std::vector<double> charges = grid(0.0);
    for (std::size_t n = 0; n < charges.size(); ++n) {
      if (flies(charges[n])) continue;
      // A voltage at the cut-off counts as below, also where that is so from the start.
      if (n == 0) {
        result_.end = end_at(at(charges[0]), charges[0]).value();
        return charges[0];
      }
      const auto edge = bisect([&](double c) { return flies(c); }, charges[n - 1], charges[n]);
      result_.end = end_at(at(edge.after), edge.after).value();
      return edge.before;
    }
    result_.end = EnduranceEnd::empty;
    return 0.0;
  }

  /// The charge at which lift falls below the weight for the first time.
  std::optional<double> hover_charge(double last) {
    const auto lifts = [&](double charge) { return moments_.carries(at(charge)); };
    const auto hovers = [&](double charge) {
      return lifts(charge) && (options_.allow_extrapolation || at(charge).domain.none());
    };
    if (!hovers(battery_.charge)) {
      result_.hover = lifts(battery_.charge) ? Hover::outside : Hover::never;
      return std::nullopt;
    }
    result_.hover = Hover::kept;
    const std::vector<double> charges = grid(last);
    for (std::size_t n = 1; n < charges.size(); ++n) {
      if (hovers(charges[n])) continue;
      result_.hover = Hover::lost;
      if (!lifts(charges[n])) {
        const double lost = charge_of_equal_lift(charges[n - 1], charges[n]);
        if (hovers(lost)) return lost;
      }
      return bisect(hovers, charges[n - 1], charges[n]).before;  // the domain is left
    }
    return std::nullopt;
  }

  /// The charge, to a part of the tolerance, down to which lift carries the weight: it does at `before`, and no longer
  /// at `after`.
  double charge_of_equal_lift(double before, double after) {
    const auto excess = [&](double drawn) { return at(before - drawn).metrics[Metric::lift_to_weight] - 1.0; };
    const double resolved = std::max(1e-3 * options_.tolerance, 1e-13) * before, drawn = before - after;
    return before - find_zero(excess, 0.0, excess(0.0), drawn, excess(drawn), resolved).before;
  }

  /// What a charge drawn at an open-circuit voltage gives for each unit of it. Through that voltage alone the state of
  /// charge acts on the vehicle.
  Totals at_voltage(double voltage) {
    const FlightMoment s = moments_.at(voltage, {}, {});
    const Metrics<double>& m = s.metrics;
    const BatteryLoad load = moments_.load_of(s, voltage);
    const double per_current = battery_.capacity / load.current;
    return {per_current, m[Metric::power_electrical] * per_current, load.internal_power * per_current,
            m[Metric::power_aerodynamic] * per_current, m[Metric::lift_mean] * per_current};
  }

  const Piece& piece_at(double voltage) const {
    const auto found =
        std::partition_point(pieces_.begin(), pieces_.end(), [&](const Piece& p) { return p.high < voltage; });
    // Rounding may put a voltage a little outside the range of the table.
    return found == pieces_.end() ? pieces_.back() : *found;
  }

  /// Chebyshev's interpolation of at_voltage() between two voltages, bisected until its last coefficients vanish: a
  /// discharge curve of many rows then costs no more orbits than its ends.
  void tabulate(double low, double high, double tail_before = HUGE_VAL, int depth = 0) {
    Piece piece{low, high, {}};
    std::array<Totals, Piece::count> samples;
    constexpr std::size_t last = Piece::count - 1;
    for (std::size_t n = 0; n <= last; ++n) {
      const double between = 0.5 * (low + high) + 0.5 * (high - low) * std::cos(pi * double(n) / last);
      // Not beyond the ends by rounding: a crank that still turns at the lower one does not below it.
      samples[n] = at_voltage(std::clamp(between, low, high));
    }
    double tail = 0.0;
    bool finite = true;
    for (std::size_t q = 0; q < total_count; ++q) {
      auto& c = piece.coefficients[q];
      for (std::size_t k = 0; k <= last; ++k) {
        double sum = 0.0;
        for (std::size_t n = 0; n <= last; ++n) {
          const double end = n == 0 || n == last ? 0.5 : 1.0;
          sum += end * samples[n][q] * std::cos(pi * double((k * n) % (2 * last)) / last);
        }
        c[k] = (k == last ? 1.0 : 2.0) / last * sum;
        finite = finite && std::isfinite(sum);
      }
      const double size = 0.5 * std::abs(c[0]);
      for (std::size_t k = last - 2; k <= last; ++k) {
        if (size > 0.0) tail = std::max(tail, std::abs(c[k]) / size);
      }
    }
    constexpr int deepest = 24;
    const double middle = 0.5 * (low + high);
    // Halves of a kink or a root bring the tail down, halves of what is left of the orbits' own errors do not.
    const bool noise = depth > 1 && tail > 0.9 * tail_before;
    if (!finite || tail <= 0.1 * options_.tolerance || noise || depth == deepest || !(middle > low && middle < high)) {
      pieces_.push_back(piece);
      return;
    }
    tabulate(low, middle, tail, depth + 1);
    tabulate(middle, high, tail, depth + 1);
  }

  /// Integrals from charge b up to a in parts: the open-circuit voltage is smooth between the rows of the discharge
  /// curve alone.
  Totals integral(double b, double a) const {
    const auto& curve = battery_.discharge_curve;
    auto row = std::upper_bound(curve.begin(), curve.end(), b, [](double c, const auto& r) { return c < r.first; });
    Totals sum{};
    for (double from = b; from < a;) {
      const double to = row != curve.end() && row->first < a ? row++->first : a;
      const double half = 0.5 * (to - from), middle = 0.5 * (from + to);
      for (const Total q : {time, electrical, internal, aerodynamic, lift}) {
        const auto integrand = [&](double x) {
          const double voltage = open_circuit_voltage(battery_, middle + half * x);
          return piece_at(voltage).value(q, voltage);
        };
        // From -1 to 1, for which alone Boost 1.74 scales its error.
        constexpr unsigned deepest = 15;
        sum[q] += half * boost::math::quadrature::gauss_kronrod<double, 15>::integrate(integrand, -1.0, 1.0, deepest,
                                                                                       0.1 * options_.tolerance);
      }
      from = to;
    }
    return sum;
  }

  void tabulate_between(double last) {
    const double high = open_circuit_voltage(battery_, battery_.charge);
    const double low = battery_.discharge_curve.empty() ? high : open_circuit_voltage(battery_, last);
    if (low < high) {
      tabulate(low, high);
    } else {
      Piece constant{low, high, {}};
      const Totals value = at_voltage(high);
      for (std::size_t q = 0; q < total_count; ++q) constant.coefficients[q][0] = 2.0 * value[q];
      pieces_.push_back(constant);
    }
  }

  EnduranceRow row(double charge, const Totals& sum, const FlightMoment& s, const FlightMoments::Temperatures& T = {}) {
    const double voltage = open_circuit_voltage(battery_, charge);
    const BatteryLoad load = moments_.load_of(s, voltage);
    EnduranceRow row{sum[time], charge,    voltage,  sum[electrical], sum[internal], sum[aerodynamic],
                     sum[lift], s.metrics, s.domain, load.voltage,    load.current};
    if (!moments_.bridged()) row.duty = s.duty;
    else if (moments_.throttled()) row.amplitude = s.voltage;
    if (moments_.throttled() && !moments_.bridged() && options_.climb_margin) {
      const SteadyFlapping full = moments_.at_full_throttle(voltage, T, {});
      if (full.status == FlappingStatus::flapping) {
        row.full_lift_to_weight = full.metrics[Metric::lift_to_weight];
        row.full_domain = moments_.domain_at_full_throttle(voltage, full.metrics);
      }
    }
    return row;
  }

  void discharge(double last, const std::optional<double>& hover) {
    tabulate_between(last);
    std::vector<double> charges = grid(last);
    if (hover) {
      charges.push_back(*hover);
      std::sort(charges.begin(), charges.end(), std::greater<>());
      charges.erase(std::unique(charges.begin(), charges.end()), charges.end());
    }
    Totals sum{};
    for (std::size_t n = 0; n < charges.size(); ++n) {
      if (n > 0) {
        const Totals piece = integral(charges[n], charges[n - 1]);
        for (std::size_t q = 0; q < total_count; ++q) sum[q] += piece[q];
      }
      result_.rows.push_back(row(charges[n], sum, at(charges[n])));
      if (hover && charges[n] == *hover) result_.hover_lost = result_.rows.back();
    }
  }

  /// Totals over the flight with the motor's two temperatures as states of their own, from the surroundings on: winding
  /// over case with tau_w, case over air with tau_c, each towards what the losses of the moment lead to.
  void discharge_warming_up(const FlightMoment& start) {
    enum { over_case = total_count, casing, state_count };
    using Path = std::array<double, state_count>;
    const MotorThermal<double>& thermal = moments_.thermal();
    const double first = battery_.charge, T_amb = thermal.ambient_temperature;
    const auto state_at = [&](double drawn, const Path& y) {
      return moments_.at(open_circuit_voltage(battery_, std::max(first - drawn, 0.0)),
                         MotorTemperatures<double>{y[casing] + y[over_case], y[casing]}, {});
    };
    const auto rates = [&](double drawn, const Path& y) -> std::optional<Path> {
      const FlightMoment s = state_at(drawn, y);
      if (!s.flaps) return std::nullopt;
      const Metrics<double>& m = s.metrics;
      const BatteryLoad load = moments_.load_of(s, open_circuit_voltage(battery_, std::max(first - drawn, 0.0)));
      const double per_charge = battery_.capacity / load.current;
      if (!std::isfinite(per_charge)) return std::nullopt;
      const double P_cu = m[Metric::power_copper];
      const double P_case = m[Metric::power_viscous] + m[Metric::power_motor_friction];
      const MotorTemperatures<double> target = settled_temperatures(thermal, P_cu, P_case);
      return Path{per_charge,
                  m[Metric::power_electrical] * per_charge,
                  load.internal_power * per_charge,
                  m[Metric::power_aerodynamic] * per_charge,
                  m[Metric::lift_mean] * per_charge,
                  (target.winding - target.casing - y[over_case]) / *winding_time_ * per_charge,
                  (target.casing - y[casing]) / *case_time_ * per_charge};
    };
    const auto row_at = [&](double drawn, const Path& y, const FlightMoment& s) {
      Totals sum;
      std::copy_n(y.begin(), sum.size(), sum.begin());
      return row(std::max(first - drawn, 0.0), sum, s, MotorTemperatures<double>{y[casing] + y[over_case], y[casing]});
    };
    const auto hovers = [&](const FlightMoment& s) {
      return s.flaps && moments_.carries(s) && (options_.allow_extrapolation || s.domain.none());
    };

    // Errors are a part of what a whole discharge gives at the first moment's rates.
    Path y{}, scale{};
    y[casing] = T_amb;
    result_.rows.push_back(row_at(0.0, y, start));
    result_.end = EnduranceEnd::stops;
    const std::optional<Path> at_start = rates(0.0, y);
    if (!at_start) return;
    for (std::size_t q = 0; q < total_count; ++q) scale[q] = std::max(std::abs((*at_start)[q]) * first, 1e-300);
    scale[over_case] = scale[casing] = 100.0;
    detail::FlightPath<state_count, decltype(rates)> path(rates, scale, options_.tolerance, 0.01 * first);

    double drawn = 0.0;
    if (const auto end = end_at(start, first)) {
      result_.end = *end;
      return;
    }
    const bool weighed = moments_.weighed();
    if (weighed) result_.hover = hovers(start) ? Hover::kept : moments_.carries(start) ? Hover::outside : Hover::never;
    result_.end = EnduranceEnd::empty;
    const std::vector<double> charges = grid(0.0);
    for (std::size_t n = 1; n < charges.size(); ++n) {
      const double end = first - charges[n];
      while (drawn < end) {
        const auto step = path.advance(drawn, y, end);
        if (!step) {
          result_.end = moments_.throttled() ? EnduranceEnd::sinks : EnduranceEnd::stops;
          return end_here(row_at(drawn, y, state_at(drawn, y)));
        }
        const double length = step->first;
        const Path next = step->second;
        const FlightMoment state = state_at(drawn + length, next);
        // The last moment of this step at which something still holds: its row.
        const auto last_row = [&](const auto& holds) {
          EnduranceRow row_there = result_.rows.back();
          bisect(
              [&](double h) {
                const auto part = path.take(drawn, y, h);
                if (!part) return false;
                const FlightMoment s = state_at(drawn + h, part->y);
                const bool still = holds(s, drawn + h);
                if (still) row_there = row_at(drawn + h, part->y, s);
                return still;
              },
              0.0, length, [&](const Bracket<double>& h) { return h.after - h.before <= 1e-13 * first; });
          return row_there;
        };
        if (result_.hover == Hover::kept && !hovers(state)) {
          result_.hover = Hover::lost;
          result_.hover_lost = last_row([&](const FlightMoment& s, double) { return hovers(s); });
          end_here(*result_.hover_lost);
        }
        if (const auto why = end_at(state, std::max(first - drawn - length, 0.0))) {
          result_.end = *why;
          return end_here(last_row([&](const FlightMoment& s, double drawn_there) {
            return !end_at(s, std::max(first - drawn_there, 0.0));
          }));
        }
        drawn = length < end - drawn ? drawn + length : end;
        y = next;
        if (drawn == end) result_.rows.push_back(row_at(drawn, y, state));
      }
    }
  }

  void end_here(const EnduranceRow& last) {
    // Not twice at the same charge.
    if (result_.rows.back().charge != last.charge) result_.rows.push_back(last);
  }

  Battery<double> battery_;
  EnduranceOptions options_;
  FlightMoments moments_;
  std::optional<double> winding_time_, case_time_;  ///< tau_w, tau_c [s]
  std::map<double, FlightMoment> known_;
  std::vector<Piece> pieces_;  ///< in the order of voltages
  EnduranceResult result_;
};

}  // namespace

EnduranceResult simulate_discharge(const Design<double>& design, const EnduranceOptions& options) {
  require(options.tolerance >= 1e-10 && options.tolerance <= 1e-2, "endurance.tolerance",
          "must lie between 1e-10 and 1e-2", "1", options.tolerance);
  require(options.intervals >= 1, "endurance.intervals", "must be >= 1", "1", options.intervals);
  if (!has_battery(design.supply.type)) {
    throw ParameterError("supply.type", "only a battery runs down; expected battery or battery-sine");
  }
  return Flight(design, options).run();
}

}  // namespace wingbeat
