// What must hold among the powers of any cycle, whichever method found it: every identity and every sign.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "wingbeat/core/text.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// What a cycle's powers violate, one line each; `vehicle` is the one that flapped, its motor as warm as it was then.
/// `mean_voltage`: the current follows from a constant voltage, so that its mean is known.
class PowerIdentities {
 public:
  PowerIdentities(const Vehicle<double>& vehicle, const Metrics<double>& metrics, double tolerance,
                  bool constant_voltage = true)
      : v_(vehicle), m_(metrics), tolerance_(tolerance) {
    balance();
    parts();
    efficiencies();
    currents(constant_voltage);
  }

  const std::string& violated() const { return violated_; }

 private:
  double operator[](Metric which) const { return m_[which]; }
  double at(Metric which) const { return std::isfinite(m_[which]) ? m_[which] : 0.0; }

  void require(bool holds, const char* what, double off = 0.0) {
    if (!holds) violated_ += detail::format("%s (off by %.3g)\n", what, off);
  }
  /// Both sides agree to ten times the tolerance of the input.
  void same(double a, double b, const char* what) {
    const double off = std::abs(a - b),
                 input = std::max(std::abs(at(Metric::power_electrical)), std::abs(at(Metric::power_residual)));
    require(off <= 10.0 * tolerance_ * input, what, off / input);
  }
  void exactly(double a, double b, const char* what) {
    require(std::abs(a - b) <= 1e-12 * (std::abs(a) + std::abs(b)), what, std::abs(a - b));
  }
  /// Up to the tolerance of the input.
  void not_negative(Metric which) {
    require(at(which) >= -tolerance_ * at(Metric::power_electrical), metric_info(which).key, at(which));
  }

  void balance() {
    const EnergyAudit a = energy_audit(m_);
    require(closes(a, tolerance_), "the input is the sum of the rows", a.imbalance / a.electrical);
    const double motor = at(Metric::power_motor);
    same(motor, a.electrical - a.copper - a.viscous - a.motor_friction - a.gear,
         "motor = input - copper - viscous - own friction - gear");
    same(motor, a.friction + a.hinge + a.aerodynamic + a.residual, "motor = friction + hinge + aerodynamic + residual");
    exactly(at(Metric::power_loss), a.electrical - a.aerodynamic, "loss = input - aerodynamic");
  }

  void parts() {
    for (const Metric which :
         {Metric::power_copper, Metric::power_viscous, Metric::power_motor_friction, Metric::power_gear,
          Metric::power_friction, Metric::power_hinge, Metric::power_reactive}) {
      not_negative(which);
    }
    const bool formulation = v_.transmission.type == TransmissionType::slider_crank &&
                             v_.transmission.slider_crank.formulation == Formulation::rod_force;
    if (!formulation) same(at(Metric::power_residual), 0.0, "residual = 0");
    if (!has_gear_loss(v_.motor)) require(at(Metric::power_gear) == 0.0, "gear = 0", at(Metric::power_gear));
    const Friction<double>& f = v_.friction;
    if (v_.motor.friction_torque == 0.0) {
      require(at(Metric::power_motor_friction) == 0.0, "own friction = 0", at(Metric::power_motor_friction));
    } else if (drive_of(v_).rotates) {
      const double turning = v_.motor.friction_torque * two_pi * at(Metric::frequency);
      same(at(Metric::power_motor_friction), turning, "own friction = T_c,m times mean speed");
    }
    if (f.radius + f.damping + f.quadratic + f.torque == 0.0) {
      require(at(Metric::power_friction) == 0.0, "friction = 0", at(Metric::power_friction));
    }
    require(std::isfinite(m_[Metric::power_hinge]) == pitches(v_), "hinge exists where wings pitch");
    if (pitches(v_) && v_.pitch.hinge.damping == 0.0 && !has_stop(v_.pitch.hinge)) {
      require(at(Metric::power_hinge) == 0.0, "hinge = 0", at(Metric::power_hinge));
    }
    if (!(v_.wings.air_density > 0.0)) require(at(Metric::power_aerodynamic) == 0.0, "aerodynamic = 0");
  }

  void ratio(Metric which, Metric from, Metric to) {
    if (at(to) > 0.0) exactly(at(which), at(from) / at(to), metric_info(which).key);
    else require(!std::isfinite(m_[which]), metric_info(which).key);
  }
  void efficiencies() {
    ratio(Metric::efficiency_system, Metric::power_aerodynamic, Metric::power_electrical);
    ratio(Metric::efficiency_motor, Metric::power_motor, Metric::power_electrical);
    ratio(Metric::efficiency_mechanism, Metric::power_aerodynamic, Metric::power_motor);
    require(!(at(Metric::efficiency_motor) > 1.0 + 10.0 * tolerance_), "motor efficiency <= 1",
            at(Metric::efficiency_motor));
  }

  void currents(bool constant_voltage) {
    const double rms = at(Metric::current_rms), R = v_.motor.armature_resistance;
    same(at(Metric::power_copper), R * square(rms), "copper = R_a i_rms^2");
    require(rms * (1.0 + tolerance_) >= std::abs(at(Metric::current_mean)), "rms current >= mean");
    require(at(Metric::current_peak) * (1.0 + 2.0 * tolerance_) >= rms, "peak current >= rms");
    if (!constant_voltage || !drive_of(v_).rotates) return;
    const double mean = at(Metric::current_mean), omega = two_pi * at(Metric::frequency);
    same(at(Metric::power_electrical), v_.voltage * mean - v_.source_resistance * square(rms),
         "input = mean current times voltage, less the source's loss");
    const double back_emf = v_.voltage - circuit_resistance(v_) * mean;
    const double off = std::abs(v_.motor.torque_constant * omega - back_emf) / v_.voltage;
    require(off <= 10.0 * tolerance_, "voltage = resistance times mean current + mean back-EMF", off);
  }

  const Vehicle<double>& v_;
  const Metrics<double>& m_;
  double tolerance_;
  std::string violated_;
};

inline std::string violated_power_identities(const Vehicle<double>& vehicle, const Metrics<double>& metrics,
                                             double tolerance, bool constant_voltage = true) {
  return PowerIdentities(vehicle, metrics, tolerance, constant_voltage).violated();
}

}  // namespace wingbeat
