// What the wings' air does to a body over a cycle, as means, and their exact derivatives by what commands a drive.
//
// The integrals are those of the solver's own steps, to its tolerance: they end at every event, and what an impact on a
// stop adds at once is counted. Derivatives are taken by dual numbers along the cycle, over impacts by their saltation
// matrix, and closed to the orbit, as in cycle/orbit_gradient.hpp.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/parts/drive_wave.hpp"

namespace wingbeat {

/// Means over a cycle, of all wings together.
enum class WingLoad {
  lift,             ///< [N]
  lift_sideways,    ///< lift cos beta [N]
  lift_forward,     ///< lift sin beta [N]
  moment,           ///< M_aero about the stroke axis, against a positive stroke velocity [N m]
  moment_sideways,  ///< M_aero cos beta [N m]
  frequency         ///< [Hz]
};
inline constexpr std::size_t wing_load_count = 6;
using WingLoads = std::array<double, wing_load_count>;

/// Means over the cycle of an orbit.
WingLoads wing_loads(const CycleRecord& orbit);

/// What they are differentiated by: the voltage or amplitude [V] of the vehicle and, of a direct drive, what changes
/// its sine.
enum class DriveInput { voltage, bias, split, cosine_split };
inline constexpr std::size_t drive_input_count = 4;

/// Derivatives of the means, the motor's temperatures held, indexed by DriveInput; those of a crank by the wave are 0.
/// Absent where they do not exist: where a multiplier is 1, as that of a shaft without springs, of all that depends on
/// what drifts.
using WingLoadSlopes = std::array<WingLoads, drive_input_count>;
WingLoadSlopes wing_load_slopes(const CycleRecord& orbit);

/// The means of a direct drive under a changed wave.
struct LoadsUnderWave {
  WingLoads loads;
  std::vector<double> start;  ///< state at phase 0
};

/// What the vehicle of `orbit` settles to when its wave is changed: the stable orbit near the state `near`, which is
/// one of a neighbouring wave (of `orbit` itself, where empty) or, where there is none, where cycles from the start of
/// `orbit` on repeat. None where nothing settles, and without springs, where nothing holds the wings' mean angle.
std::optional<LoadsUnderWave> loads_under_wave(const CycleRecord& orbit, const DriveWave<double>& wave,
                                               const std::vector<double>& near = {});

}  // namespace wingbeat
