// Records of signals that repeat with the flapping: their period, and their mean course over one cycle.
#pragma once

#include <optional>
#include <vector>

#include "wingbeat/core/math.hpp"

namespace wingbeat {

/// Signals sampled together, at equal distances in time or not.
struct SignalRecord {
  std::vector<double> time;                   ///< ascending [s]
  std::vector<std::vector<double>> channels;  ///< values of each, one for each time; NaN where none was measured
};

struct PhaseAverageOptions {
  std::optional<double> frequency;  ///< of the cycle, known to a fifth [Hz]; empty: as the signals show
  double time_zero = 0.0;           ///< when the phase is 0 [s]
};

/// One channel over the cycle.
struct AveragedChannel {
  std::vector<double> mean;       ///< in each bin, at its centre
  std::vector<double> deviation;  ///< standard deviations of the means
  double scatter = 0.0;           ///< standard deviation of a sample about the mean course
  /// Variance of a mean of neighbouring samples over that of as many independent ones [1].
  double correlation = 1.0;
  int harmonics = 0;  ///< of the mean course within the bins
};

struct PhaseAverage {
  double frequency = 0.0;        ///< in the middle of the record [Hz]
  double frequency_error = 0.0;  ///< its standard error [Hz]
  double rate = 0.0;             ///< by which it changes [Hz/s]
  double cycles = 0.0;           ///< in the record
  std::vector<double> phase;     ///< centres of the bins that hold samples of every channel [rad], 0 to 2 pi
  std::vector<AveragedChannel> channels;
};

/// Least number of cycles and of samples that a record must hold.
inline constexpr double least_cycles = 3.0;
inline constexpr int least_samples = 32;

/// The period of the signals and their mean course over it. The phase is that of a frequency which changes linearly,
/// \f$\varphi(t) = 2\pi \int f\,\mathrm{d}t\f$, fitted to the phases of successive pieces of the record; its standard
/// error is that of the fit to those phases, so that it has the unsteadiness of the flapping in it. Where several
/// periods explain the signals, the shortest is taken. Within a bin samples are referred to its centre by the harmonics
/// of the record. Deviations are those of a mean of samples that scatter as the residuals do, with their correlation
/// from sample to sample. Throws ParameterError for records that are too short or show no period.
PhaseAverage phase_average(const SignalRecord& record, const PhaseAverageOptions& options = {});

}  // namespace wingbeat
