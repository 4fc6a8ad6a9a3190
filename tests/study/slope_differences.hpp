// Exact slopes of static maps against differences of cycles that are found for themselves, and against the points of
// the maps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "wingbeat/cycle/wing_loads.hpp"
#include "wingbeat/study/allocation.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

struct SlopeCheck {
  double worst = 0.0;  ///< largest distance of a slope from differences, over what it may be
  double apart = 0.0;  ///< the same over load scale by input scale
  int compared = 0, beyond = 0;
  std::string where;

  void add(double distance, double allowed, double scale, const std::string& name) {
    ++compared;
    if (!(distance <= allowed)) ++beyond;
    apart = std::max(apart, distance / scale);
    if (distance / allowed > worst || std::isnan(distance)) worst = distance / allowed, where = name;
  }
};

/// What a load is measured by: the lift, or the moment that takes the aerodynamic power.
inline std::array<double, wing_load_count> load_scales(const Metrics<double>& m) {
  const double lift = std::max(std::abs(m[Metric::lift_mean]), 1e-3 * std::abs(m[Metric::lift_peak]));
  const double moment = m[Metric::power_aerodynamic] / m[Metric::flapping_velocity_peak];
  return {lift, lift, lift, moment, moment, m[Metric::frequency]};
}

/// A derivative from differences, and three times the error that they show of it.
struct DifferenceQuotient {
  double value, error;
};

/// Of all loads by an input, by Richardson's rule from two steps [of the input] to either side; none where nothing
/// flaps there.
template <class LoadsAt>
std::optional<std::array<DifferenceQuotient, wing_load_count>> difference_quotients(const LoadsAt& loads_at,
                                                                                    double step) {
  std::array<WingLoads, 4> shifted;  // -2, -1, 1, 2 steps
  for (std::size_t n = 0; n < shifted.size(); ++n) {
    const std::optional<WingLoads> loads = loads_at((n < 2 ? double(n) - 2.0 : double(n) - 1.0) * step);
    if (!loads) return std::nullopt;
    shifted[n] = *loads;
  }
  std::array<DifferenceQuotient, wing_load_count> quotients;
  for (std::size_t load = 0; load < wing_load_count; ++load) {
    const double near = (shifted[2][load] - shifted[1][load]) / (2.0 * step),
                 far = (shifted[3][load] - shifted[0][load]) / (4.0 * step);
    quotients[load] = {(4.0 * near - far) / 3.0, std::abs(near - far)};
  }
  return quotients;
}

/// Slopes of all loads by all inputs against differences over a quarter and half a percent: within three times the
/// error that these show, and a hundred-thousandth. Where a switch of the equations, or an impact, begins or ends so
/// near to the operating point that they are not, over a tenth of that.
inline SlopeCheck slopes_against_cycles(const SteadyFlapping& orbit) {
  static constexpr const char* load_names[] = {"lift",   "lift_sideways",   "lift_forward",
                                               "moment", "moment_sideways", "frequency"};
  static constexpr const char* input_names[] = {"voltage", "bias", "split", "cosine_split"};
  Vehicle<double> vehicle = orbit.record.vehicle();
  vehicle.thermal = {};
  const WingLoadSlopes slopes = wing_load_slopes(orbit.record);
  const auto scales = load_scales(orbit.metrics);
  SlopeCheck check;
  for (std::size_t input = 0; input < drive_input_count; ++input) {
    const auto which = DriveInput(input);
    if (which != DriveInput::voltage && !drive_of(vehicle).alternating) continue;
    const double scale = which == DriveInput::voltage || which == DriveInput::bias ? vehicle.voltage : 1.0;
    const auto loads_at = [&](double change) -> std::optional<WingLoads> {
      if (which == DriveInput::voltage) {
        Vehicle<double> there = vehicle;
        there.voltage += change;
        const SteadyFlapping found = find_steady_flapping(there, {1e-10, false, {}}, start_up_in_time());
        if (found.status != FlappingStatus::flapping || found.record.empty()) return std::nullopt;
        return wing_loads(found.record);
      }
      DriveWave<double> wave;
      (which == DriveInput::bias ? wave.bias : which == DriveInput::split ? wave.split : wave.cosine_split) = change;
      const auto found = loads_under_wave(orbit.record, wave);
      return found ? std::optional(found->loads) : std::nullopt;
    };
    const auto wide = difference_quotients(loads_at, 2.5e-3 * scale);
    if (!wide) continue;
    auto narrow = wide;
    bool is_narrow = false;
    for (std::size_t load = 0; load < wing_load_count; ++load) {
      if (!(scales[load] > 0.0)) continue;
      const double unit = scales[load] / scale, slope = slopes[input][load];
      const auto distance = [&](const auto& from) { return std::abs(slope - (*from)[load].value); };
      const auto allowed = [&](const auto& from) { return (*from)[load].error + 1e-5 * unit; };
      if (!(distance(wide) <= allowed(wide)) && !is_narrow) {
        is_narrow = true;
        if (const auto found = difference_quotients(loads_at, 2.5e-4 * scale)) narrow = found;
      }
      const auto& from = distance(wide) <= allowed(wide) ? wide : narrow;
      check.add(distance(from), allowed(from), unit, std::string(load_names[load]) + " by " + input_names[input]);
    }
  }
  return check;
}

/// The slopes of maps against their own points, within their stated error and a thousandth of what the map spans.
inline SlopeCheck slopes_against_points(const std::vector<AllocationMap>& maps) {
  SlopeCheck check;
  for (const AllocationMap& map : maps) {
    for (const AllocationColumn& column : allocation_columns) {
      const double slope = map.slope.*column.member, of_points = map.slope_of_points.*column.member;
      if (std::isnan(slope) || std::isnan(of_points)) continue;
      double low = map.points.front().*column.member, high = low;
      for (const AllocationPoint& p : map.points) {
        const double value = p.*column.member;
        if (std::isnan(value)) continue;
        if (!(value >= low)) low = value;
        if (!(value <= high)) high = value;
      }
      const double unit = (high - low) / (map.points.back().input - map.points.front().input);
      // What symmetry leaves out is rounding.
      const double least = 1e-9 * std::abs(map.points[map.points.size() / 2].lift) / map.points.back().input;
      if (!(unit > least)) continue;
      check.add(std::abs(slope - of_points), map.slope_of_points_error.*column.member + 1e-3 * unit, unit,
                std::string(column.name) + " by " + name_of(map.input));
    }
  }
  return check;
}

/// A slope of the lift by the voltage and the steady gain of the linear model, apart by so much of it.
inline double lift_slope_apart(const Linearisation& linearisation, double slope) {
  const bool pwm = linearisation.operating_point.design.supply.type == SupplyType::pwm;
  const double gain =
      linearisation.model->steady_gain(0, 0) / (pwm ? linearisation.operating_point.design.supply.voltage : 1.0);
  return std::abs(slope - gain) / std::abs(gain);
}

}  // namespace wingbeat
