// Optimisation studies: TOML in, a checked study out; reports of its result. See docs/optimise.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/study/optimise.hpp"

namespace wingbeat {

/// One motor of a catalogue, put into the study's vehicle.
struct MotorCandidate {
  std::string model;
  std::string refused;              ///< why it cannot be tried; empty if it can
  std::vector<std::string> derived;  ///< what was derived from other columns, and how
  Design<double> design;
};

struct OptimiseFile {
  std::string title;
  OptimiseStudy study;
  std::vector<MotorCandidate> motors;  ///< empty: the vehicle's own motor alone
};

/// The study in a TOML file; the vehicle file and a motor catalogue that it names are sought beside it. Throws
/// InputError.
OptimiseFile read_optimise_study(const std::filesystem::path& file);

/// A motor of the catalogue with what became of it; `result` is not used where the motor is refused.
struct MotorTrial {
  const MotorCandidate* motor = nullptr;
  OptimiseResult result;
};

/// The trial with the best objective, or null where none found a design.
const MotorTrial* best_trial(const OptimiseFile& file, std::span<const MotorTrial> trials);

/// Readable report of one result; of a catalogue, the table of motors and the best one's result.
std::string text_optimum(const OptimiseFile& file, const OptimiseResult& result);
std::string text_motors(const OptimiseFile& file, std::span<const MotorTrial> trials);

/// One JSON object of a result, or of all motors with the best one first.
std::string json_optimum(const OptimiseFile& file, const OptimiseResult& result);
std::string json_motors(const OptimiseFile& file, std::span<const MotorTrial> trials);

/// Calls `act` for 0 to count - 1 on all cores, at most `threads` at once (0: one for each core).
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& act, int threads = 0);

}  // namespace wingbeat
