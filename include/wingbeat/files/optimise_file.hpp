// Optimisation studies: TOML in, a checked study out, and the trials that it asks for. See docs/optimise.md.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/study/drive_train.hpp"
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
  std::optional<double> speed_max = {};        ///< of its own shaft [rad/s]
};

/// One gearbox of a list. Torques are those behind it, speeds those before it.
struct GearboxCandidate {
  std::string model;
  std::string refused;   ///< why it cannot be tried; empty if it can
  double ratio = 1.0;    ///< n, motor turns per output turn
  double inertia = 0.0;  ///< at the motor's shaft [kg m2]
  double efficiency = 1.0;
  std::vector<std::string> assumed = {};         ///< what the list does not state, and what is taken instead
  std::optional<double> mass = {};               ///< [kg]
  std::optional<double> torque_continuous = {};  ///< limit of the rms torque [N m]
  std::optional<double> torque_peak = {};        ///< [N m]
  std::optional<double> speed_max = {};          ///< [rad/s]
};

/// One battery of a list; what it does not state stays the vehicle's.
struct BatteryCandidate {
  std::string model;
  std::string refused;  ///< why it cannot be tried; empty if it can
  double cells = 1.0;
  double capacity = 0.0;                           ///< [C]
  std::optional<double> mass = {};                 ///< [kg]
  std::optional<double> internal_resistance = {};  ///< of one cell [ohm]
  std::optional<double> cell_voltage = {};         ///< at any charge, instead of the vehicle's curve [V]
  std::optional<double> cutoff_voltage = {};       ///< of one cell [V]
  std::optional<double> current_max = {};          ///< that it may give for any time [A]
};

/// What is searched where gearboxes or batteries are lists.
struct DriveTrainSearch {
  std::vector<GearboxCandidate> gearboxes;  ///< empty: the vehicle's own, or none
  std::vector<BatteryCandidate> batteries;  ///< empty: the vehicle's own, or none
  /// By motor the gearboxes that go with it, a `*` at the end of a name standing for any rest; empty: all do.
  std::map<std::string, std::vector<std::string>> compatible;
  int screen = 16;  ///< designs tried of each combination, where there are bounded parameters
  int refine = 8;   ///< combinations that are searched after the screening

  bool any() const { return !gearboxes.empty() || !batteries.empty(); }
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
  DriveTrainSearch drive_train = {};        ///< of one objective
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
  const GearboxCandidate* gearbox = nullptr;  ///< null: the vehicle's own
  const BatteryCandidate* battery = nullptr;  ///< null: the vehicle's own

  bool refused() const { return motor && !motor->refused.empty(); }
};

/// Every combination of motors and discrete values, in their order; a refused motor once. One without either.
std::vector<MotorTrial> trials_of(const OptimiseFile& file);
/// Every combination of motors, gearboxes, batteries and discrete values of a drive train that can be tried.
std::vector<MotorTrial> combinations_of(const OptimiseFile& file);
/// Whether a list states that the gearbox goes with the motor; true where none does.
bool go_together(const DriveTrainSearch& search, const std::string& motor, const std::string& gearbox);
/// The vehicle with a gearbox and a battery in place of its own; null keeps that. Their masses count where the
/// vehicle's is known.
Design<double> with_parts(Design<double> design, const GearboxCandidate* gearbox, const BatteryCandidate* battery);
/// The study of one of them.
OptimiseStudy trial_study(const OptimiseFile& file, const MotorTrial& trial);
/// "0816K003SR, motor.gear_ratio 10"
std::string name_of(const OptimiseFile& file, const MotorTrial& trial);

/// Screens every combination of a drive train, which `screen` then tells of, and searches from the most promising ones:
/// those, with their results, in that order. `progress` gets a few words now and then, from any thread.
std::vector<MotorTrial> choose_drive_train(const OptimiseFile& file, const StartUp& start_up, const ForEach& for_each,
                                           const std::function<void(const std::string&)>& progress,
                                           DriveTrainScreen& screen);

/// The study of several objectives, with the motors that can be tried.
ParetoStudy pareto_study(const OptimiseFile& file);

/// The trial with the best objective, or null where none found a design.
const MotorTrial* best_trial(const OptimiseFile& file, std::span<const MotorTrial> trials);

}  // namespace wingbeat
