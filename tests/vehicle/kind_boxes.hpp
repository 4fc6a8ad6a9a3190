// The reference box with one kind of part each: what batches have to know beside the reference vehicle's own.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <string_view>
#include <vector>

#include "vehicle/random_vehicle.hpp"

namespace wingbeat {

enum class KindBox {
  reference,
  no_inductance,
  tables,
  pitch_stop,
  battery,
  pwm,
  coreless,
  small_inductance,
  near_stall,
  four_bar,
  tabulated,
  gear_loss,
  heat
};
inline constexpr std::array<std::string_view, 13> kind_box_names = {
    "reference",        "no_inductance", "tables",   "pitch_stop", "battery",   "pwm", "coreless",
    "small_inductance", "near_stall",    "four_bar", "tabulated",  "gear_loss", "heat"};

/// Force coefficients in rows of 2.5 to 10 degrees, from -5 to 40 degrees up to 90: waves about the reference's, half
/// of them with the scatter of measured values.
inline std::shared_ptr<const CoefficientTable> random_table(std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double spacing = std::array{2.5, 5.0, 10.0}[std::size_t(uniform(0.0, 3.0))];
  const double scatter = uniform(0.0, 1.0) < 0.5 ? 0.0 : 0.002 * spacing;  // the denser, the smoother
  const double peak = uniform(1.3, 1.8), rise = uniform(1.3, 1.7);
  const double low = uniform(0.0, 1.0) < 0.5 ? 0.0 : uniform(0.0, 45.0);
  std::vector<double> alpha, lift, drag;
  for (int row = int((90.0 - low) / spacing); row >= 0; --row) {
    const double a = (90.0 - spacing * row) / degrees_per_radian;
    alpha.push_back(a);
    lift.push_back(0.2 + peak * std::sin(2.1 * a - 0.12) + scatter * uniform(-1.0, 1.0));
    drag.push_back(1.9 - rise * std::cos(2.05 * a - 0.17) + scatter * uniform(-1.0, 1.0));
  }
  return std::make_shared<const CoefficientTable>(alpha, lift, drag);
}

/// A four-bar of about the slider-crank's stroke, as crank-rockers are built: a long coupler, about perpendicular to
/// the rocker in the middle of its swing.
inline void put_four_bar(TransmissionDesign<double>& t, std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double sine = std::sin(std::atan(t.crank_radius / *t.hinge_offset));
  t.type = TransmissionType::four_bar;
  t.hinge_offset.reset();
  for (bool turns = false; !turns;) {
    t.rocker_length = t.crank_radius / sine;
    t.ground_length = t.rocker_length * uniform(2.0, 5.0);
    t.coupler_length = std::hypot(t.ground_length, t.rocker_length) * uniform(0.95, 1.05);
    try {
      validate(transmission_of(t));
      turns = true;
    } catch (const ParameterError&) {}
  }
}

/// A stroke of two harmonics as a table of 24 to 120 rows, half of them at angles a little off equal steps.
inline void put_stroke_table(TransmissionDesign<double>& t, std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const int rows = int(24.0 * std::pow(5.0, uniform(0.0, 1.0)));
  const double amplitude = uniform(0.4, 1.2), second = uniform(-0.1, 0.1), phase = uniform(0.0, two_pi);
  const double uneven = uniform(0.0, 1.0) < 0.5 ? 0.0 : 0.2;
  std::vector<std::pair<double, double>> curve;
  for (int k = 0; k < rows; ++k) {
    const double theta = two_pi * (k + uneven * std::sin(double(k))) / rows;
    curve.emplace_back(theta, amplitude * (std::sin(theta + phase) + second * std::sin(2.0 * (theta + phase))));
  }
  t.table = {std::make_shared<const StrokeCurve>(std::move(curve)), 1.0, *t.hinge_offset};
  t.type = TransmissionType::tabulated;
  t.hinge_offset.reset();
}

/// A design of a box. Of the tables, half are one for all.
inline Design<double> kind_design(KindBox box, std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto logarithmic = [&](double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); };
  if (box == KindBox::coreless) return coreless_design(random);
  Design<double> d = box_design(random);
  Motor<double>& m = d.motor.constants;
  const double voltage = d.supply.voltage;
  switch (box) {
    case KindBox::tables: {
      static const auto common = [] {
        std::mt19937_64 of_its_own(20226);
        return random_table(of_its_own);
      }();
      d.aerodynamics.coefficients_name = "table";
      d.aerodynamics.coefficients.table = uniform(0.0, 1.0) < 0.5 ? common : random_table(random);
      break;
    }
    case KindBox::no_inductance: m.armature_inductance = 0.0; break;
    case KindBox::pitch_stop: d.aerodynamics.angle_of_attack_min = uniform(0.2, 1.4); break;
    case KindBox::battery:
      d.supply.type = SupplyType::battery;
      d.supply.battery.cells = voltage > 3.7 ? 2.0 : 1.0;
      d.supply.battery.cell_voltage = voltage / d.supply.battery.cells;
      d.supply.battery.internal_resistance = m.armature_resistance * logarithmic(1e-2, 0.5);
      d.supply.battery.capacity = 500.0;
      break;
    case KindBox::pwm:
      d.supply = {SupplyType::pwm, voltage / uniform(0.5, 1.0), logarithmic(2e3, 2e4), 1.0, {}};
      d.supply.duty = voltage / d.supply.voltage;
      break;
    case KindBox::small_inductance: m.armature_inductance = m.armature_resistance * logarithmic(1e-8, 1e-3); break;
    case KindBox::near_stall:
      m.friction_torque = m.torque_constant * voltage / m.armature_resistance * uniform(0.5, 1.02);
      break;
    case KindBox::four_bar: put_four_bar(d.transmission, random); break;
    case KindBox::tabulated: put_stroke_table(d.transmission, random); break;
    case KindBox::gear_loss: d.motor.gear_efficiency = uniform(0.5, 1.0); break;
    case KindBox::heat:
      d.motor.thermal.resistance_winding = logarithmic(3.0, 40.0);
      d.motor.thermal.resistance_case = logarithmic(10.0, 80.0);
      if (uniform(0.0, 1.0) < 0.5) d.motor.thermal.magnet_temperature_coefficient = -0.001;
      break;
    default: break;
  }
  return d;
}

}  // namespace wingbeat
