// Loads that another program has computed, CFD or a vortex lattice, beside those of the model at the same motion, and
// their disagreement as numbers.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/core/names.hpp"
#include "wingbeat/study/wing_motion.hpp"

namespace wingbeat {

enum class LoadQuantity { lift, stroke_moment, pitch_moment };
template <>
inline constexpr std::pair<const char*, LoadQuantity> names_of<LoadQuantity>[] = {
    {"lift", LoadQuantity::lift},
    {"stroke_moment", LoadQuantity::stroke_moment},
    {"pitch_moment", LoadQuantity::pitch_moment}};
inline constexpr std::size_t load_quantity_count = 3;

/// "N" or "N m".
const char* unit_of(LoadQuantity quantity);

/// Values of one quantity, one for each row, NaN where there is none.
struct LoadSeries {
  std::vector<double> values;
  bool per_wing = false;
};

/// What a file of simulated loads holds: rows in any order, of one cycle or several.
struct SimulatedLoads {
  std::string file;
  /// Of each row: time [s], or cycles since crank angle zero (direct drive: since phase zero of the supply).
  std::vector<double> places;
  bool in_time = false;
  std::optional<double> frequency;    ///< where the rows have both time and phase [Hz]
  std::vector<double> stroke, pitch;  ///< the motion that was simulated [rad]; empty where the rows have none
  std::array<std::optional<LoadSeries>, load_quantity_count> loads;
};

/// Of one quantity. Means over the cycle in phase, of all wings.
struct LoadDisagreement {
  double mean_simulated = absent, mean_model = absent;
  double ratio = absent;           ///< model over simulated, of the means; absent where that of the simulated is 0
  double rms_simulated = absent;   ///< root of the mean square
  double rms_difference = absent;  ///< of model minus simulated, over rms_simulated [1]
  double correlation = absent;     ///< of the variation about the means, -1 to 1
  /// Share of the variance of the simulated quantity that is in phase with the model's: the square of the correlation.
  double variance_in_phase = absent;
  /// By which the first harmonic of the model lags that of the simulated quantity [rad]; absent where either is below a
  /// thousandth of its variation, as of the lift of two equal half-strokes.
  double first_harmonic_lag = absent;
  int strongest_harmonic = 0;     ///< of the simulated quantity, the first to the fourth; 0 of a constant
  double strongest_lag = absent;  ///< of it [rad]
  /// Shares of the mean-square difference: of the means, of the sizes of the variation, and of its phase and shape;
  /// absent where there is no difference.
  double share_mean = absent, share_size = absent, share_phase = absent;
};

struct LoadPoint {
  double cycle;  ///< 0 to 1
  double simulated, model;
};
struct ComparedLoad {
  LoadQuantity quantity;
  LoadDisagreement disagreement;
  std::vector<LoadPoint> points;  ///< in phase
};

struct LoadComparison {
  double frequency = absent;  ///< of the motion that was compared [Hz]
  bool own_motion = true;     ///< that of the vehicle's settled cycle, else that of the file
  int rows = 0;
  double cycles = 0.0;                       ///< that the rows span
  double largest_gap = 0.0;                  ///< between neighbours in phase [cycles]
  std::optional<AngleSeries> stroke, pitch;  ///< the motion of the file
  std::vector<ComparedLoad> loads;
  std::vector<std::string> left_out;  ///< sentences: quantities of the file that the model has not, and why
};

/// The rows from so many cycles on: what came before, a transient of the simulation, is left out.
SimulatedLoads without_first_cycles(const SimulatedLoads& simulated, double cycles, double frequency);

/// Rows further apart in phase than this share of a cycle are refused.
inline constexpr double load_gap_max = 0.1;

/// The numbers of one quantity from values at places in a cycle [cycles], by the trapezoidal rule in phase. Rows of the
/// same phase count as their mean.
LoadDisagreement disagreement_of(const std::vector<LoadPoint>& points);

/// The file's loads beside those of the model at the motion of the file, which repeats with `frequency` [Hz]. Throws
/// ParameterError where the rows do not cover a cycle, hold no quantity that the model has, or lack a pitch.
LoadComparison compare_loads_of_motion(const SimulatedLoads& simulated, const Vehicle<double>& vehicle,
                                       double frequency);
/// The file's loads beside those of a settled cycle; the motion of the file, if any, plays no part.
LoadComparison compare_loads_of_cycle(const SimulatedLoads& simulated, const CycleRecord& cycle);

}  // namespace wingbeat
