// Nine wide boxes of random vehicles on top of wide_boxes.hpp: parts whose losses, events and statuses earlier boxes
// exercise little.
#pragma once

#include "vehicle/model_options.hpp"
#include "vehicle/wide_boxes.hpp"

namespace wingbeat {

enum class FurtherBox {
  stops,            ///< wings on hinges with stops, on every transmission, behind lossy gears and not
  gear,             ///< lossy gearboxes, with wings on hinges and not
  heat,             ///< warm motors on every supply and transmission
  pwm,              ///< switched supplies
  tiny_inductance,  ///< electrical lags far below an angle that matters
  long_cranks,      ///< hinges beside a long crank, where levers grow and fall within a few degrees
  direct_losses,    ///< direct drives: constant friction, friction by the load, lossy gearboxes, wings on hinges or not
  soft_wings,       ///< wings that twist, with hinges and without, and hinges with friction, on every transmission
  actuators         ///< brushless motors behind electronics, and piezos, rigid and compliant
};
inline constexpr std::array<std::string_view, 9> further_box_names = {
    "stops", "gear", "heat", "pwm", "tiny_inductance", "long_cranks", "direct_losses", "soft_wings", "actuators"};

/// A vehicle as drawn, which need not be a valid one.
inline WideVehicle drawn_further_vehicle(FurtherBox box, std::uint32_t n, std::uint32_t seed = 12) {
  std::seed_seq sequence{seed, 2000u + std::uint32_t(box), n};
  std::mt19937_64 random(sequence);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto logarithmic = [&](double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); };
  const auto chance = [&](double share) { return uniform(0.0, 1.0) < share; };
  constexpr std::array mechanisms = {FarBox::friction_laws, FarBox::four_bar, FarBox::tabulated, FarBox::direct};
  const auto base = [&](std::size_t kinds) {
    return wide_vehicle(mechanisms[std::size_t(uniform(0.0, double(kinds)))], n, seed + 1);
  };
  const auto add = [&](WideVehicle& v, ModelOption option) { add_model_option(v.design, option, n, seed); };

  // Wings on hinges that somebody could build: S_2 and S_3 drawn apart ask for root chords of up to metres. The
  // semi-ellipse of the same S_2 that is 1.5 to 8 root chords long.
  const auto put_on_hinges = [&](Design<double>& d) {
    add_model_option(d, ModelOption::pitch, n, seed);
    Planform<double>& p = d.wing.planform;
    const double chords = logarithmic(1.5, 8.0);
    p.length = std::pow(16.0 * p.s2 * chords / (pi * d.wing.count), 0.25);
    p.root_chord = p.length / chords;
  };

  WideVehicle drawn;
  switch (box) {
    case FurtherBox::stops:
      drawn = base(4);
      put_on_hinges(drawn.design);
      drawn.design.pitch.stop = uniform(0.02, 1.2);
      if (chance(0.4)) add(drawn, ModelOption::gear);
      break;
    case FurtherBox::gear:
      drawn = base(3);
      add(drawn, ModelOption::gear);
      if (chance(0.3)) put_on_hinges(drawn.design);
      break;
    case FurtherBox::heat:
      drawn = chance(0.3) ? wide_vehicle(FarBox::supplies, n, seed + 1) : base(4);
      add(drawn, ModelOption::heat);
      if (chance(0.3)) drawn.design.motor.thermal.ambient_temperature = uniform(250.0, 350.0);
      break;
    case FurtherBox::pwm: {
      drawn = base(3);
      Design<double>& d = drawn.design;
      const double voltage = d.supply.voltage;
      d.supply = {SupplyType::pwm, voltage / uniform(0.2, 1.0), logarithmic(1e3, 3e4), 1.0, {}};
      d.supply.duty = voltage / d.supply.voltage;
      Motor<double>& m = d.motor.constants;
      // Switched currents that do not settle between two switchings are another vehicle than one on the mean voltage.
      m.armature_inductance = std::max(m.armature_inductance, 3.0 * m.armature_resistance / d.supply.frequency);
      break;
    }
    case FurtherBox::tiny_inductance:
      drawn = base(4);
      if (chance(0.25)) put_on_hinges(drawn.design);
      drawn.design.motor.constants.armature_inductance =
          drawn.design.motor.constants.armature_resistance * logarithmic(1e-17, 1e-6);
      break;
    case FurtherBox::long_cranks: {
      drawn = wide_vehicle(chance(0.5) ? FarBox::crank_near_rod : FarBox::strong_springs, n, seed + 1);
      auto& t = drawn.design.transmission;
      t.hinge_offset = t.crank_radius * logarithmic(0.02, 0.4);
      if (chance(0.5)) drawn.design.supply.voltage *= logarithmic(0.05, 1.0);
      break;
    }
    case FurtherBox::direct_losses: {
      drawn = wide_vehicle(FarBox::direct, n, seed + 1);
      Design<double>& d = drawn.design;
      const double kind = uniform(0.0, 1.0);
      if (kind < 0.4) {
        const double torque =
            d.motor.constants.torque_constant * d.supply.voltage / d.motor.constants.armature_resistance;
        d.friction = {FrictionLaw::constant, torque * logarithmic(1e-3, 0.3)};
      } else if (kind < 0.8) {
        d.friction = {FrictionLaw::load_proportional, logarithmic(1e-5, 2e-3), 5e-3};
      }
      if (kind > 0.6) add(drawn, ModelOption::gear);
      if (kind < 0.4 || chance(0.5)) put_on_hinges(d);
      if (d.pitch.stiffness && chance(0.3)) d.pitch.stop = uniform(0.05, 1.2);
      break;
    }
    case FurtherBox::soft_wings: {
      drawn = base(4);
      Design<double>& d = drawn.design;
      put_on_hinges(d);
      const double kind = uniform(0.0, 1.0), stiffness = *d.pitch.stiffness;
      if (kind < 0.7) {
        d.wing.torsion = {stiffness * logarithmic(0.3, 10.0), uniform(0.0, 1.0) * d.pitch.damping};
        *d.wing.mass_product *= 0.7;  // of an even semi-ellipse that twists, at most 0.735 sqrt(J_w I_psi)
        if (kind < 0.3) d.pitch.stiffness.reset();
      }
      if (kind > 0.5) d.pitch.friction = stiffness * logarithmic(1e-3, 0.1);
      if (d.pitch.stiffness && chance(0.3)) d.pitch.stop = uniform(0.1, 1.2);
      break;
    }
    case FurtherBox::actuators: {
      if (chance(0.5)) {
        drawn = base(3);
        Design<double>& d = drawn.design;
        d.electronics.efficiency = uniform(0.7, 1.0);
        const double stalled = d.supply.voltage / d.motor.constants.armature_resistance;
        if (chance(0.5)) d.electronics.current_max = stalled * uniform(0.1, 0.9);
        if (chance(0.3)) put_on_hinges(d);
        break;
      }
      drawn = wide_vehicle(FarBox::direct, n, seed + 1);
      Design<double>& d = drawn.design;
      if (chance(0.5)) put_on_hinges(d);
      // The torque that the motor gave at rest, from a tip that moves half a millimetre for a radian.
      const double ratio = 2000.0 * logarithmic(0.5, 2.0), V = 100.0;
      const double torque =
          d.motor.constants.torque_constant * d.supply.voltage / d.motor.constants.armature_resistance;
      const Vehicle<double> v = resolve(d);
      d.piezo.force_per_volt = torque * ratio / V;
      d.piezo.constants.transmission_ratio = ratio;
      d.piezo.constants.mass = d.motor.constants.inertia * square(ratio);
      d.piezo.constants.stiffness = uniform(0.3, 1.0) * v.wing_count * v.spring.stiffness * square(ratio) + 1.0;
      d.piezo.constants.damping = d.motor.constants.viscous_damping * square(ratio);
      d.piezo.constants.capacitance = logarithmic(1e-9, 1e-7);
      d.piezo.constants.loss_tangent = uniform(0.0, 0.03);
      d.piezo.constants.recovered_share = uniform(0.0, 1.0);
      if (chance(0.4)) d.piezo.constants.transmission_cubic = ratio * square(ratio) * logarithmic(1e-2, 1.0);
      if (chance(0.4)) d.piezo.series_stiffness = d.piezo.constants.stiffness * logarithmic(2.0, 20.0);
      if (chance(0.3)) d.piezo.constants.voltage_factor = logarithmic(1e-4, 3e-3);
      d.motor = {};
      d.spring = {v.spring.stiffness, {}, {}, {}};
      d.wing.resonance.reset();
      if (!d.wing.areal_density) d.wing.inertia = v.wing_inertia;
      d.supply = {SupplyType::sine, V, v.drive_frequency, 1.0, {}, chance(0.5) ? uniform(0.0, V) : 0.0};
      d.supply_resonance_ratio.reset();
      break;
    }
  }
  return drawn;
}

/// Vehicle number n of a box, the first valid one that is drawn: it depends on the box, n and the seed alone.
inline WideVehicle further_vehicle(FurtherBox box, std::uint32_t n, std::uint32_t seed = 12) {
  for (std::uint32_t k = n;; k += 1000000) {
    WideVehicle drawn = drawn_further_vehicle(box, k, seed);
    try {
      validate(drawn.design);
      return drawn;
    } catch (const ParameterError&) {}
  }
}

}  // namespace wingbeat
