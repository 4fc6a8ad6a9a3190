#include "wingbeat/cycle/domain.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

bool in_air(const Vehicle<double>& v) { return v.wings.air_density > 0.0 && (v.wings.s2 > 0.0 || v.wings.s3 > 0.0); }

bool has_wings(const Vehicle<double>& v) { return v.wing_inertia > 0.0 || v.wings.s2 > 0.0 || v.wings.s3 > 0.0; }

/// Range of the force coefficients [deg]. A table may be narrower than 0 to 90 deg; it does not widen the range: the
/// pitch law is meant for wings that have not turned over.
struct Range {
  double low, high;
};
Range angle_range(const Vehicle<double>& v) {
  // A wing on a hinge lags behind the reversals, beyond 90 deg of attack, where its coefficients are continued.
  Range range{angle_of_attack_lowest_deg, pitches(v) ? pitching_angle_highest_deg : angle_of_attack_highest_deg};
  if (const auto& table = v.wings.coefficients.table) {
    range.low = std::max(range.low, degrees_per_radian * table->alpha().front());
    range.high = std::min(range.high, degrees_per_radian * table->alpha().back());
  }
  return range;
}

/// Rounding of a table's ends in other units.
constexpr double angle_slack_deg = 0.1;

double stroke_reach_deg(const Vehicle<double>& v) { return degrees_per_radian * stroke_reach(v.transmission); }

/// Radius at which the speed of the wings is compared [m].
double reference_radius(const Vehicle<double>& v) { return v.wings.s2 > 0.0 ? v.wings.s3 / v.wings.s2 : 0.0; }

/// Where two wings on one body meet [deg], infinite where none do.
double meeting_angle_deg(const Vehicle<double>& v) {
  return has_wings(v) ? degrees_per_radian * v.wing_limits.stroke_max : std::numeric_limits<double>::infinity();
}

/// The largest stroke that the drive's own law has [deg].
double law_stroke_max_deg(const Vehicle<double>& v) {
  return v.transmission.type == TransmissionType::slider_crank ? tan_law_stroke_max_deg : other_stroke_max_deg;
}

/// Of one coordinate of a table of loads: how far the motion goes, and how far the table does, to either side.
template <class S>
struct TableReach {
  DomainEvidence::Quantity quantity;
  S largest;
  double limit;
};

/// The coordinates of a vehicle's table that metrics tell: not the pitch velocity.
template <class S>
std::vector<TableReach<S>> table_reaches(const Vehicle<double>& v, const Metrics<S>& m) {
  using Quantity = DomainEvidence::Quantity;
  std::vector<TableReach<S>> reaches;
  if (!is_given(v.wings.tabulated)) return reaches;
  const auto add = [&](LoadCoordinate coordinate, Quantity quantity, const S& largest, double unit) {
    const LoadTable::Axis* axis = v.wings.tabulated.table->axis(coordinate);
    if (axis) reaches.push_back({quantity, largest, unit * std::min(-axis->knots.front(), axis->knots.back())});
  };
  add(LoadCoordinate::stroke_angle, Quantity::table_stroke_angle,
      drive_of(v).stroke_is_fixed ? S(stroke_reach_deg(v)) : m[Metric::stroke_amplitude] * S(degrees_per_radian),
      degrees_per_radian);
  add(LoadCoordinate::flapping_velocity, Quantity::table_flapping_velocity, m[Metric::flapping_velocity_peak], 1.0);
  const S ahead = S(90.0) - m[Metric::angle_of_attack_min];
  const S behind = pitches(v) ? m[Metric::angle_of_attack_max] - S(90.0) : ahead;
  add(LoadCoordinate::pitch_angle, Quantity::table_pitch_angle, value_of(behind) > value_of(ahead) ? behind : ahead,
      degrees_per_radian);
  return reaches;
}

/// For double and dual numbers.
template <class S>
std::array<S, domain_limit_count> excess_of(const Vehicle<double>& v, const Metrics<S>& m) {
  std::array<S, domain_limit_count> excess;
  excess.fill(S(-1.0));
  const auto excess_of = [&](DomainLimit limit) -> S& { return excess[std::size_t(limit)]; };
  const auto larger = [](const S& a, const S& b) {
    return value_of(a) > value_of(b) || std::isnan(value_of(a)) ? a : b;
  };
  const bool air = in_air(v);

  if (air) {
    const Range range = angle_range(v);
    excess_of(DomainLimit::angle_of_attack) =
        (S(range.low) - m[Metric::angle_of_attack_min]) / S(angle_of_attack_highest_deg);
    // At the reversals alpha is 90 deg, whatever the pitching.
    if (pitches(v)) {
      excess_of(DomainLimit::angle_of_attack) =
          larger(m[Metric::angle_of_attack_max] / S(range.high) - S(1.0), excess_of(DomainLimit::angle_of_attack));
    } else if (range.high < angle_of_attack_highest_deg - angle_slack_deg) {
      excess_of(DomainLimit::angle_of_attack) =
          larger(S(1.0 - range.high / angle_of_attack_highest_deg), excess_of(DomainLimit::angle_of_attack));
    }
    excess_of(DomainLimit::flow_speed) =
        m[Metric::flapping_velocity_peak] * S(reference_radius(v) / flow_speed_max) - S(1.0);
  }
  if (drive_of(v).stroke_is_fixed) {
    if (has_wings(v)) excess_of(DomainLimit::stroke) = S(stroke_reach_deg(v) / stroke_max_deg(v) - 1.0);
  } else {
    excess_of(DomainLimit::stroke) = m[Metric::stroke_amplitude] * S(degrees_per_radian / stroke_max_deg(v)) - S(1.0);
  }

  if (heats_up(v.thermal)) {
    excess_of(DomainLimit::winding_temperature) =
        (m[Metric::winding_temperature] + S(zero_celsius)) / S(v.thermal.winding_temperature_max) - S(1.0);
  }

  const WingLimits<double>& wings = v.wing_limits;
  if (air && !std::isnan(wings.reynolds_number_per_speed)) {
    const S& Re = m[Metric::reynolds_number];
    S& excess_Re = excess_of(DomainLimit::reynolds_number);
    if (wings.reynolds_number_min > 0.0) excess_Re = S(1.0) - Re / S(wings.reynolds_number_min);
    if (std::isfinite(wings.reynolds_number_max)) {
      excess_Re = larger(Re / S(wings.reynolds_number_max) - S(1.0), excess_Re);
    }
  }

  for (const TableReach<S>& r : table_reaches(v, m)) {
    S& excess_reach = excess_of(DomainLimit::load_table);
    excess_reach = larger(r.limit > 0.0 ? S(r.largest / S(r.limit) - S(1.0)) : S(1.0), excess_reach);
  }

  const S& P_e = m[Metric::power_electrical];
  const S& P_m = m[Metric::power_motor];
  const S& P_aero = m[Metric::power_aerodynamic];
  const S& P_residual = m[Metric::power_residual];
  const auto beyond = [&](const S& efficiency) {
    return larger(efficiency - S(1.0 + efficiency_slack), -efficiency - S(efficiency_slack));
  };
  if (!(value_of(P_e) > 0.0 && std::isfinite(value_of(P_e)))) {
    excess_of(DomainLimit::input_power) = S(1.0);
  } else {
    const S share = value_of(P_residual) < 0.0 ? -P_residual / P_e : P_residual / P_e;
    excess_of(DomainLimit::formulation_residual) = share / S(formulation_residual_max) - S(1.0);
    excess_of(DomainLimit::motor_efficiency) = beyond(P_m / P_e);
  }
  if (air && value_of(P_m) > 0.0) {
    excess_of(DomainLimit::mechanism_efficiency) = beyond(P_aero / P_m);
  } else if (air && !(std::abs(value_of(P_aero)) <= efficiency_slack * std::abs(value_of(P_e)))) {
    excess_of(DomainLimit::mechanism_efficiency) = S(1.0);
  }
  return excess;
}

}  // namespace

const std::array<DomainLimitInfo, domain_limit_count>& domain_limit_table() {
  static const std::array<DomainLimitInfo, domain_limit_count> table = {{
      {"angle_of_attack",
       "angle of attack within 0 to 90 deg, of wings that pitch on a hinge to 180 deg, and within a table of "
       "coefficients, over the whole cycle"},
      {"stroke",
       "stroke angle of a slider-crank up to 85 deg to either side, of another mechanism to 180 deg, stroke "
       "amplitude of a direct drive to 180 deg; of two and more wings on one body to where they meet, 90 deg and by as "
       "much more as wing.planform.shoulder_distance leaves room for"},
      {"formulation_residual", "formulation residual at most 5 % of the input power"},
      {"mechanism_efficiency", "mechanism efficiency from 0 to 1"},
      {"motor_efficiency", "motor efficiency from 0 to 1"},
      {"input_power", "input power positive and finite"},
      {"flow_speed", "speed of the wings at S_3/S_2 up to 103 m/s (Mach 0.3)"},
      {"winding_temperature",
       "winding temperature of a motor with thermal resistances up to motor.winding_temperature_max, 125 degC unless "
       "given"},
      {"reynolds_number",
       "Reynolds number of wings with a shape within that of the named force coefficients, 100 to 26000, or within "
       "aerodynamics.reynolds_number_min and reynolds_number_max"},
      {"load_table",
       "stroke angle, flapping velocity and pitch angle within the table of loads, to either side as far as it reaches "
       "to both"},
  }};
  return table;
}

double stroke_max_deg(const Vehicle<double>& vehicle) {
  return std::min(law_stroke_max_deg(vehicle), meeting_angle_deg(vehicle));
}

DomainExcess domain_excess(const Vehicle<double>& vehicle, const Metrics<double>& metrics) {
  return excess_of(vehicle, metrics);
}

DomainExcess domain_excess_slopes(const Vehicle<double>& vehicle, const Metrics<double>& metrics,
                                  const Metrics<double>& slopes) {
  using Dual = ceres::Jet<double, 1>;
  Metrics<Dual> m;
  for (std::size_t k = 0; k < std::size_t(metric_count); ++k) {
    m.values[k].a = metrics.values[k];
    m.values[k].v[0] = slopes.values[k];
  }
  const auto excess = excess_of(vehicle, m);
  DomainExcess result;
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = excess[k].v[0];
  return result;
}

std::bitset<metric_count> domain_metrics() {
  std::bitset<metric_count> needed;
  for (const Metric m :
       {Metric::power_electrical, Metric::power_motor, Metric::power_aerodynamic, Metric::power_residual,
        Metric::angle_of_attack_min, Metric::stroke_amplitude, Metric::flapping_velocity_peak,
        Metric::winding_temperature, Metric::angle_of_attack_max, Metric::reynolds_number}) {
    needed.set(std::size_t(m));
  }
  return needed;
}

DomainStatus domain_of(const DomainExcess& excess) {
  DomainStatus status;
  for (std::size_t k = 0; k < excess.size(); ++k) status[k] = !(excess[k] <= 0.0);
  return status;
}

DomainStatus domain_of(const Vehicle<double>& vehicle, const Metrics<double>& metrics) {
  return domain_of(domain_excess(vehicle, metrics));
}

std::string name_of(DomainStatus status) {
  if (status.none()) return "inside";
  std::string names;
  for (std::size_t k = 0; k < status.size(); ++k) {
    if (status[k]) names += (names.empty() ? "" : ", ") + std::string(domain_limit_table()[k].key);
  }
  return names;
}

std::vector<DomainEvidence> domain_evidence(const Vehicle<double>& v, const Metrics<double>& m) {
  using Quantity = DomainEvidence::Quantity;
  const DomainStatus status = domain_of(v, m);
  std::vector<DomainEvidence> rows;
  const auto add = [&](DomainLimit limit, Quantity quantity, double value, double lowest, double highest) {
    if (status[std::size_t(limit)]) rows.push_back({limit, quantity, value, lowest, highest});
  };
  const double P_e = m[Metric::power_electrical], P_m = m[Metric::power_motor], P_aero = m[Metric::power_aerodynamic];
  const Range range = angle_range(v);
  const bool short_table = !pitches(v) && range.high < angle_of_attack_highest_deg - angle_slack_deg;
  if (m[Metric::angle_of_attack_max] > range.high) {
    add(DomainLimit::angle_of_attack, Quantity::angle_of_attack_max, m[Metric::angle_of_attack_max], range.low,
        range.high);
  } else {
    add(DomainLimit::angle_of_attack, short_table ? Quantity::angle_of_attack_range : Quantity::angle_of_attack_min,
        m[Metric::angle_of_attack_min], range.low, range.high);
  }
  const bool fixed = drive_of(v).stroke_is_fixed, meet = meeting_angle_deg(v) < law_stroke_max_deg(v);
  const double max_stroke = stroke_max_deg(v);
  add(DomainLimit::stroke,
      meet    ? Quantity::wings_meet
      : fixed ? Quantity::stroke_angle
              : Quantity::stroke_amplitude,
      fixed ? stroke_reach_deg(v) : degrees_per_radian * m[Metric::stroke_amplitude], fixed ? -max_stroke : 0.0,
      max_stroke);
  add(DomainLimit::formulation_residual, Quantity::residual_share, std::abs(m[Metric::power_residual] / P_e), 0.0,
      formulation_residual_max);
  if (P_m > 0.0) {
    add(DomainLimit::mechanism_efficiency, Quantity::mechanism_efficiency, P_aero / P_m, 0.0, 1.0);
  } else {
    add(DomainLimit::mechanism_efficiency, Quantity::aerodynamic_power, P_aero, 0.0, P_m);
  }
  add(DomainLimit::motor_efficiency, Quantity::motor_efficiency, P_m / P_e, 0.0, 1.0);
  add(DomainLimit::input_power, Quantity::input_power, P_e, 0.0, std::numeric_limits<double>::infinity());
  add(DomainLimit::flow_speed, Quantity::flow_speed, m[Metric::flapping_velocity_peak] * reference_radius(v), 0.0,
      flow_speed_max);
  const double T_w = m[Metric::winding_temperature], T_max = v.thermal.winding_temperature_max - zero_celsius;
  const bool runaway = T_w > copper_melting_point - zero_celsius;
  add(DomainLimit::winding_temperature, runaway ? Quantity::thermal_runaway : Quantity::winding_temperature, T_w,
      -zero_celsius, T_max);
  add(DomainLimit::reynolds_number, Quantity::reynolds_number, m[Metric::reynolds_number],
      v.wing_limits.reynolds_number_min, v.wing_limits.reynolds_number_max);
  for (const TableReach<double>& r : table_reaches(v, m)) {
    if (!(r.largest <= r.limit)) add(DomainLimit::load_table, r.quantity, r.largest, -r.limit, r.limit);
  }
  return rows;
}

std::optional<double> notable_residual(const Vehicle<double>& v, const Metrics<double>& m) {
  if (v.transmission.type != TransmissionType::slider_crank ||
      v.transmission.slider_crank.formulation != Formulation::rod_force) {
    return std::nullopt;
  }
  const double share = std::abs(m[Metric::power_residual] / m[Metric::power_electrical]);
  if (!(share > formulation_residual_warn) || !(m[Metric::power_electrical] > 0.0)) return std::nullopt;
  return share;
}

std::optional<double> notable_added_mass_lift(const Metrics<double>& m) {
  const double share = m[Metric::lift_added_mass_share];
  if (!(std::abs(share) > added_mass_lift_warn)) return std::nullopt;
  return share;
}

std::optional<double> hot_winding(const Vehicle<double>& v, const Metrics<double>& m) {
  const double T_w = m[Metric::winding_temperature];
  if (!heats_up(v.thermal) || !(T_w + zero_celsius > v.thermal.winding_temperature_max)) return std::nullopt;
  return T_w;
}

}  // namespace wingbeat
