// A wing that a piezo swings, as large as a bee's, and random ones about it.
#pragma once

#include <cmath>
#include <random>

#include "vehicle/hinged_design.hpp"

namespace wingbeat {

inline Design<double> piezo_design() {
  Design<double> d = hinged_design(3e-6);
  d.motor = {};
  d.piezo.force_per_volt = 0.4e-3;
  d.piezo.constants.stiffness = 240.0;
  d.piezo.constants.damping = 0.02;
  d.piezo.constants.mass = 6e-6;
  d.piezo.constants.transmission_ratio = 2666.6;
  d.supply = {SupplyType::sine, 90.0, 150.0, 1.0, {}, 90.0};
  d.spring = {30e-6, {}, {}, {}};
  d.wing.count = 1.0;
  d.wing.planform.length = 12.42e-3;
  d.wing.planform.root_chord = 5.58e-3;
  d.wing.planform.hub_offset = 5.58e-3;
  d.wing.areal_density = 10.1e-3;
  d.wing.spar_density = 0.0;
  d.pitch.damping = 2e-9;
  return d;
}

/// With and without capacitance, cubic transmission, compliance, offset and a pitch hinge.
inline Design<double> random_piezo_design(std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto logarithmic = [&](double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); };
  Design<double> d = piezo_design();
  Piezo<double>& p = d.piezo.constants;
  d.piezo.force_per_volt = logarithmic(0.1e-3, 0.5e-3);
  p.stiffness = logarithmic(100.0, 600.0);
  p.damping = logarithmic(0.003, 0.1);
  p.mass = logarithmic(2e-6, 20e-6);
  p.capacitance = logarithmic(1e-9, 30e-9);
  p.loss_tangent = uniform(0.0, 0.03);
  p.recovered_share = uniform(0.0, 1.0);
  if (uniform(0.0, 1.0) < 0.4) p.transmission_cubic = logarithmic(1e8, 5e9);
  if (uniform(0.0, 1.0) < 0.4) p.voltage_factor = logarithmic(1e-4, 3e-3);
  if (uniform(0.0, 1.0) < 0.5) d.piezo.series_stiffness = p.stiffness * logarithmic(1.0, 20.0);
  d.supply.frequency = uniform(80.0, 220.0);
  d.supply.voltage = uniform(30.0, 100.0);
  d.supply.offset = uniform(0.0, 1.0) < 0.5 ? d.supply.voltage : uniform(-20.0, 20.0);
  if (uniform(0.0, 1.0) < 0.3) {
    d.pitch = {};
    d.aerodynamics.pitch_coefficient = 0.5 / (two_pi * d.supply.frequency * 0.6);
    d.aerodynamics.coefficients_name = "translational-2022";
    d.aerodynamics.coefficients = translational_2022();
    d.aerodynamics.added_mass = false;
  } else {
    d.pitch.stiffness = logarithmic(1e-6, 1e-5);
  }
  return d;
}

}  // namespace wingbeat
