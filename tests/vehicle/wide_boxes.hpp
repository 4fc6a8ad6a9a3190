// Twelve wide boxes of random vehicles, far from the reference and near every edge at which a vehicle ceases to flap.
#pragma once

#include <array>
#include <memory>
#include <random>
#include <string_view>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

enum class FarBox {
  crank_near_rod,    ///< rods 1.01 to 1.6 cranks long
  near_jam,          ///< light rotors under strong friction, levers near zero
  near_stall,        ///< drives about as strong as friction and springs
  inertia,           ///< rotors of 1e-9 to 1e-3 kg m2
  inductance,        ///< electrical time constants from nothing to far below a step
  strong_springs,    ///< springs of up to 30 times the reference's
  friction_laws,     ///< every law, weak and strong, no friction at all
  tables_and_stops,  ///< coefficient tables, pitch stops
  supplies,          ///< battery, pwm, sine
  direct,
  four_bar,  ///< linkages of every proportion that turns, swing ratios up to 5
  tabulated  ///< stroke laws of two harmonics as tables of 24 to 360 rows
};
inline constexpr std::array<std::string_view, 12> far_box_names = {
    "crank_near_rod", "near_jam",         "near_stall", "inertia", "inductance", "strong_springs",
    "friction_laws",  "tables_and_stops", "supplies",   "direct",  "four_bar",   "tabulated"};

struct WideVehicle {
  Design<double> design;
  Condition condition = Condition::air;
};

/// Vehicle number n of a box: it depends on the box, n and the seed alone.
inline WideVehicle wide_vehicle(FarBox box, std::uint32_t n, std::uint32_t seed = 12) {
  std::seed_seq sequence{seed, std::uint32_t(box), n};
  std::mt19937_64 random(sequence);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto logarithmic = [&](double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); };
  const auto chance = [&](double share) { return uniform(0.0, 1.0) < share; };
  const auto stall_of = [](const Design<double>& d) {
    return d.motor.constants.torque_constant * d.supply.voltage / d.motor.constants.armature_resistance;
  };

  WideVehicle drawn;
  Design<double>& d = drawn.design;
  d = reference_design();
  const double other = uniform(0.0, 1.0);
  drawn.condition = other < 0.03 ? Condition::wingless : other < 0.08 ? Condition::vacuum : Condition::air;
  d.supply.voltage = logarithmic(0.7, 20.0);
  Motor<double>& m = d.motor.constants;
  m.armature_resistance = logarithmic(1.5, 40.0);
  m.armature_inductance = chance(0.2) ? 0.0 : logarithmic(1e-5, 1e-1);
  m.torque_constant = logarithmic(3e-3, 4e-2);
  m.inertia = logarithmic(2e-8, 5e-6);
  m.viscous_damping = logarithmic(2e-7, 2e-5);
  if (chance(0.2)) m.friction_torque = uniform(0.0, 0.7) * stall_of(d);
  auto& t = d.transmission;
  t.crank_radius = logarithmic(2e-3, 2.5e-2);
  t.rod_length = t.crank_radius * logarithmic(1.3, 10.0);
  t.hinge_offset = t.crank_radius * logarithmic(0.4, 4.0);
  t.formulation = chance(0.5) ? Formulation::rod_force : Formulation::virtual_work;
  const double law = uniform(0.0, 1.0);
  d.friction = law < 0.6   ? FrictionDesign<double>{FrictionLaw::load_proportional, logarithmic(1e-4, 5e-3)}
               : law < 0.7 ? FrictionDesign<double>{FrictionLaw::none, 0.0}
               : law < 0.8 ? FrictionDesign<double>{FrictionLaw::viscous, logarithmic(3e-7, 3e-5)}
               : law < 0.9 ? FrictionDesign<double>{FrictionLaw::quadratic, logarithmic(1e-9, 1e-6)}
                           : FrictionDesign<double>{FrictionLaw::constant, uniform(0.0, 0.6) * stall_of(d)};
  if (chance(0.5)) d.spring.stiffness = logarithmic(1e-4, 6e-3);
  d.wing.inertia = logarithmic(5e-9, 1e-6);
  d.wing.planform.s2 = logarithmic(2e-7, 2e-5);
  d.wing.planform.s3 = d.wing.planform.s2 * logarithmic(1e-2, 1e-1);
  d.aerodynamics.pitch_coefficient = chance(0.1) ? 0.0 : logarithmic(5e-4, 2e-2);

  switch (box) {
    case FarBox::crank_near_rod: t.rod_length = t.crank_radius * (1.0 + logarithmic(0.01, 0.6)); break;
    case FarBox::near_jam:
      d.friction = {FrictionLaw::load_proportional, t.crank_radius * logarithmic(0.1, 1.2)};
      m.inertia = logarithmic(1e-9, 3e-7);
      break;
    case FarBox::near_stall:
      if (chance(0.5)) {
        d.friction = {FrictionLaw::constant, stall_of(d) * uniform(0.5, 1.05)};
        m.friction_torque = 0.0;
      } else {
        m.friction_torque = stall_of(d) * uniform(0.5, 1.05);
      }
      if (chance(0.5)) d.spring.stiffness = logarithmic(1e-5, 1e-3);
      break;
    case FarBox::inertia: m.inertia = chance(0.5) ? logarithmic(1e-9, 1e-7) : logarithmic(1e-6, 1e-3); break;
    case FarBox::inductance: m.armature_inductance = m.armature_resistance * logarithmic(1e-8, 1e-4); break;
    case FarBox::strong_springs:
      d.spring.stiffness = logarithmic(1e-3, 4e-2);
      if (chance(0.5)) d.supply.voltage = logarithmic(3.0, 30.0);
      break;
    case FarBox::friction_laws:
      switch (std::uniform_int_distribution<int>(0, 4)(random)) {
        case 0: d.friction = {FrictionLaw::none, 0.0}; break;
        case 1: d.friction = {FrictionLaw::viscous, logarithmic(1e-8, 1e-4)}; break;
        case 2: d.friction = {FrictionLaw::quadratic, logarithmic(1e-10, 1e-5)}; break;
        case 3: d.friction = {FrictionLaw::constant, uniform(0.0, 1.0) * stall_of(d)}; break;
        default: d.friction = {FrictionLaw::load_proportional, logarithmic(1e-5, 1e-2)};
      }
      if (chance(0.3)) m.viscous_damping = 0.0;
      break;
    case FarBox::tables_and_stops: {
      static const auto table = [] {
        std::vector<double> alpha, lift, drag;
        for (int k = -9; k <= 18; ++k) {
          const double a = 5.0 * k / degrees_per_radian;
          alpha.push_back(a);
          lift.push_back(0.2 + 1.6 * std::sin(2.1 * a - 0.12));
          drag.push_back(1.9 - 1.5 * std::cos(2.05 * a - 0.17));
        }
        return std::make_shared<const CoefficientTable>(alpha, lift, drag);
      }();
      const double which = uniform(0.0, 1.0);
      if (which < 0.6) {
        d.aerodynamics.coefficients_name = "table";
        d.aerodynamics.coefficients.table = table;
      }
      if (which > 0.3) d.aerodynamics.angle_of_attack_min = uniform(0.1, 1.4);
      break;
    }
    case FarBox::supplies: {
      const double which = uniform(0.0, 1.0);
      const double voltage = d.supply.voltage;
      if (which < 0.4) {
        d.supply.type = SupplyType::battery;
        d.supply.battery.cells = voltage > 7.0 ? 2.0 : 1.0;
        d.supply.battery.cell_voltage = voltage / d.supply.battery.cells;
        d.supply.battery.internal_resistance = m.armature_resistance * logarithmic(1e-3, 1.0);
        d.supply.battery.capacity = 500.0;
        d.supply.battery.charge = uniform(0.05, 1.0);
      } else if (which < 0.7) {
        d.supply = {SupplyType::pwm, voltage / uniform(0.5, 1.0), logarithmic(1e3, 1e4), 1.0, {}};
        d.supply.duty = voltage / d.supply.voltage;
        // Switched currents that do not settle between two switchings are another vehicle than one on the mean voltage.
        m.armature_inductance = std::max(m.armature_inductance, 3.0 * m.armature_resistance / d.supply.frequency);
      } else {
        d.supply = {SupplyType::sine, voltage, logarithmic(1.0, 100.0), 1.0, {}};
      }
      break;
    }
    case FarBox::direct: {
      d.transmission = {};
      d.transmission.type = TransmissionType::direct;
      drawn.condition = chance(0.1) ? Condition::vacuum : Condition::air;
      d.supply = {SupplyType::sine, logarithmic(0.5, 12.0), logarithmic(5.0, 80.0), 1.0, {}};
      m.inertia = logarithmic(1e-8, 2e-6);
      m.friction_torque = 0.0;
      const double drive = m.torque_constant * d.supply.voltage /
                           std::hypot(m.armature_resistance, two_pi * d.supply.frequency * m.armature_inductance);
      const double kind = uniform(0.0, 1.0);
      d.friction = kind < 0.3   ? FrictionDesign<double>{FrictionLaw::none, 0.0}
                   : kind < 0.5 ? FrictionDesign<double>{FrictionLaw::viscous, logarithmic(3e-7, 3e-5)}
                   : kind < 0.7 ? FrictionDesign<double>{FrictionLaw::quadratic, logarithmic(1e-9, 1e-6)}
                                : FrictionDesign<double>{FrictionLaw::constant, uniform(0.0, 1.1) * drive};
      d.spring = {};
      if (chance(0.9)) d.spring.resonance = d.supply.frequency * logarithmic(0.5, 2.0);
      if (chance(0.3)) d.aerodynamics.angle_of_attack_min = uniform(0.3, 1.2);
      break;
    }
    case FarBox::four_bar: {
      t.type = TransmissionType::four_bar;
      t.hinge_offset.reset();
      // Proportions are drawn until the crank turns and the coupler keeps its lever.
      for (bool turns = false; !turns;) {
        t.rocker_length = t.crank_radius * logarithmic(1.2, 6.0);
        t.ground_length = t.crank_radius * logarithmic(1.5, 10.0);
        t.coupler_length = t.crank_radius * logarithmic(1.5, 10.0);
        t.stroke_ratio = chance(0.5) ? 1.0 : logarithmic(1.0, 5.0);
        try {
          validate(transmission_of(t));
          turns = stroke_amplitude(transmission_of(t)) < 2.0;
        } catch (const ParameterError&) {}
      }
      if (chance(0.2)) t.ground_angle = centred_ground_angle(transmission_of(t).four_bar) + uniform(-0.3, 0.3);
      break;
    }
    case FarBox::tabulated: {
      t.type = TransmissionType::tabulated;
      t.hinge_offset.reset();
      const int rows = int(logarithmic(24.0, 361.0));
      const double amplitude = uniform(0.3, 1.5), second = uniform(-0.15, 0.15), phase = uniform(0.0, two_pi);
      std::vector<std::pair<double, double>> curve;
      for (int k = 0; k < rows; ++k) {
        const double theta = two_pi * k / rows;
        curve.emplace_back(theta, amplitude * (std::sin(theta + phase) + second * std::sin(2.0 * (theta + phase))));
      }
      t.table = {std::make_shared<const StrokeCurve>(std::move(curve)), 1.0, logarithmic(3e-3, 2e-2)};
      break;
    }
  }
  return drawn;
}

}  // namespace wingbeat
