// Where the supply's power goes, step by step: the numbers of an energy flow diagram.
#pragma once

#include <string>
#include <vector>

#include "wingbeat/cycle/energy_audit.hpp"

namespace wingbeat {

/// A flow of power that leaves its stage.
struct EnergyBranch {
  std::string name;
  double power;  ///< [W]
};

/// The supply feeds the motor, which loses in copper and viscous friction; the motor output feeds the transmission,
/// which loses in friction and in what its formulation fails to conserve; the air gets the rest.
struct EnergyFlow {
  double supply;                                  ///< P_e [W]
  double motor_output;                            ///< what passes from motor to transmission [W]
  std::vector<EnergyBranch> motor, transmission;  ///< losses of either
  double air;                                     ///< aerodynamic power [W]
};

/// Of a cycle: supply = losses of the motor + motor_output, motor_output = losses of the transmission + air, each to
/// the solver's accuracy. Gearbox and the motor's own friction are losses of the motor.
EnergyFlow energy_flow(const EnergyAudit& audit);

}  // namespace wingbeat
