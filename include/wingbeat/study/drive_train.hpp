// Very many combinations of parts, screened by batches: which of them flap within every limit, and what excludes the
// others.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "wingbeat/study/optimise.hpp"

namespace wingbeat {

/// What the screening found of one combination.
enum class CombinationOutcome {
  within,        ///< a design flaps inside the domain, within every limit
  excluded,      ///< designs flap inside the domain, each beyond some limit
  outside,       ///< designs flap, all of them outside the model's domain
  does_not_flap  ///< at any of its designs, or what is held cannot be reached
};

struct ScreenedCombination {
  CombinationOutcome outcome = CombinationOutcome::does_not_flap;
  double objective = absent;  ///< of its best design: of the least excess, then of the best objective [SI]
  double excess = absent;     ///< of that over its limits, the largest, relative; <= 0 within
  GearTorque torque;          ///< of that design, where the gearbox has limits and it is within the others
  bool hopeless = true;       ///< no search can be started from it
};

/// How many combinations a limit excludes: those that flap inside the domain, but with no design within it.
struct LimitCount {
  std::string limit;  ///< "lift_to_weight >= 1", "speed of the gearbox"
  std::uint64_t excluded = 0;
  std::uint64_t alone = 0;  ///< of these, those with a design within every other limit
};

struct DriveTrainScreen {
  std::vector<ScreenedCombination> combinations;           ///< as given
  std::array<std::uint64_t, 4> outcomes{};                 ///< by CombinationOutcome
  std::array<std::uint64_t, sweep_status_count> status{};  ///< of all designs
  std::array<std::uint64_t, domain_limit_count> beyond{};  ///< designs outside the domain, by limit
  std::vector<LimitCount> limits;    ///< of the study's constraints, then by part in order of appearance
  std::uint64_t designs = 0;         ///< solved
  std::uint64_t recomputed = 0;      ///< of these, by the scalar solver
  std::vector<std::size_t> ranking;  ///< places of combinations from which a search can start, the best first
};

/// Screens the combinations `study(0)` to `study(count - 1)`, whose parameters, objective and what is held must be the
/// same, with `designs` designs of each between the bounds of the parameters (scrambled Sobol, the same of each), or
/// the one that there is without parameters. Batches solve them; torques behind a gearbox with limits come from the
/// scalar solver, for designs within every other limit. Flight metrics are estimated there: energy of the battery over
/// the electrical power. The result does not depend on `for_each`.
DriveTrainScreen screen_drive_trains(std::size_t count, const std::function<OptimiseStudy(std::size_t)>& study,
                                     std::uint64_t designs, const StartUp& start_up, const ForEach& for_each = {});

}  // namespace wingbeat
