// Optimisation studies: TOML in, a checked study out, and the trials that it asks for. See docs/optimise.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/study/optimise.hpp"
#include "wingbeat/study/pareto.hpp"

namespace wingbeat {

/// One motor of a catalogue, put into the study's vehicle.
struct MotorCandidate {
  std::string model;
  std::string refused;               ///< why it cannot be tried; empty if it can
  std::vector<std::string> derived;  ///< what was derived from other columns, and how
  Design<double> design;
  std::optional<double> nominal_current = {};  ///< of one motor, that it may carry for any time [A]
};

struct OptimiseFile {
  std::string title;
  std::filesystem::path vehicle_file;
  OptimiseStudy study;
  std::vector<MotorCandidate> motors;  ///< empty: the vehicle's own motor alone
  bool within_nominal_current = true;  ///< of a motor that states it: a bound on the rms current of one objective
  std::vector<DiscreteParameter> choices;
  std::vector<ParetoObjective> objectives;  ///< empty: one objective, that of `study`
  EvolutionOptions evolution;               ///< of several objectives
  std::size_t designs = 5;                  ///< picked along their front
};

/// The study in a TOML file; the vehicle file and a motor catalogue that it names are sought beside it. Throws
/// InputError.
OptimiseFile read_optimise_study(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// A motor of the catalogue, or the vehicle's own, with one value of each discrete parameter, and what became of it;
/// `result` is not used where the motor is refused.
struct MotorTrial {
  const MotorCandidate* motor = nullptr;  ///< null: the vehicle's own
  std::vector<double> choices;            ///< by discrete parameter [SI]
  OptimiseResult result;

  bool refused() const { return motor && !motor->refused.empty(); }
};

/// Every combination of motors and discrete values, in their order; a refused motor once. One without either.
std::vector<MotorTrial> trials_of(const OptimiseFile& file);
/// The study of one of them.
OptimiseStudy trial_study(const OptimiseFile& file, const MotorTrial& trial);
/// "0816K003SR, motor.gear_ratio 10"
std::string name_of(const OptimiseFile& file, const MotorTrial& trial);

/// The study of several objectives, with the motors that can be tried.
ParetoStudy pareto_study(const OptimiseFile& file);

/// The trial with the best objective, or null where none found a design.
const MotorTrial* best_trial(const OptimiseFile& file, std::span<const MotorTrial> trials);

}  // namespace wingbeat
