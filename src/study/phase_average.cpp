#include "wingbeat/study/phase_average.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "wingbeat/core/status.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/cycle/metric_values.hpp"

namespace wingbeat {
namespace {

using detail::format;

constexpr int max_harmonics = 24;
constexpr int max_bins = 72, min_bins = 16, samples_in_bin = 4;
/// Of the usual distances between samples, as many as samples at most times this may lie within the record.
constexpr double max_gaps = 20.0;
/// The strongest component of the signals is a harmonic of the cycle up to this one.
constexpr int strongest_harmonic = 6;
/// Share of the signals' variance that what a longer period explains beside a shorter one must have.
constexpr double least_share = 1e-3;

/// Phase in cycles, of a frequency that changes linearly, from the middle of the record on.
struct PhaseLaw {
  double middle = 0.0, frequency = 0.0, rate = 0.0;
  double at(double time) const {
    const double t = time - middle;
    return (frequency + 0.5 * rate * t) * t;
  }
};

/// Samples of one channel without gaps, less their mean.
struct Channel {
  std::vector<double> time, value;
  double variance = 0.0;
  std::size_t index = 0;
};

std::vector<Channel> channels_of(const SignalRecord& record) {
  std::vector<Channel> all;
  for (std::size_t c = 0; c < record.channels.size(); ++c) {
    Channel channel;
    channel.index = c;
    double mean = 0.0;
    for (std::size_t n = 0; n < record.time.size(); ++n) {
      if (std::isnan(record.channels[c][n])) continue;
      channel.time.push_back(record.time[n]);
      channel.value.push_back(record.channels[c][n]);
      mean += record.channels[c][n];
    }
    mean /= double(std::max<std::size_t>(channel.value.size(), 1));
    for (double& x : channel.value) {
      x -= mean;
      channel.variance += x * x;
    }
    channel.variance /= double(std::max<std::size_t>(channel.value.size(), 1));
    all.push_back(std::move(channel));
  }
  return all;
}

/// The strongest frequency of all channels between two bounds, each channel in units of its own variance.
double strongest_frequency(const SignalRecord& record, const std::vector<Channel>& channels, double step, double from,
                           double to) {
  const double start = record.time.front(), duration = record.time.back() - start;
  Eigen::VectorXd power;
  double resolution = 1.0;
  for (const Channel& c : channels) {
    if (!(c.variance > 0.0)) continue;
    const std::size_t count = std::size_t(duration / step) + 1;
    std::size_t padded = 1;
    while (padded < 4 * count) padded *= 2;
    std::vector<double> even(padded, 0.0);
    std::size_t n = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double time = start + step * double(k);
      while (n + 2 < c.time.size() && c.time[n + 1] < time) ++n;
      const double width = c.time[n + 1] - c.time[n];
      const double share = width > 0.0 ? std::clamp((time - c.time[n]) / width, 0.0, 1.0) : 0.0;
      const double window = 0.5 - 0.5 * std::cos(two_pi * double(k) / double(count));
      even[k] = window * (c.value[n] + share * (c.value[n + 1] - c.value[n]));
    }
    std::vector<std::complex<double>> spectrum;
    Eigen::FFT<double> transform;
    transform.fwd(spectrum, even);
    if (power.size() == 0) power = Eigen::VectorXd::Zero(Eigen::Index(padded / 2));
    resolution = 1.0 / (step * double(padded));
    for (Eigen::Index k = 0; k < std::min<Eigen::Index>(power.size(), Eigen::Index(padded / 2)); ++k) {
      power[k] += std::norm(spectrum[std::size_t(k)]) / c.variance;
    }
  }
  Eigen::Index best = -1;
  for (Eigen::Index k = 1; k + 1 < power.size(); ++k) {
    const double f = resolution * double(k);
    if (f >= from && f <= to && (best < 0 || power[k] > power[best])) best = k;
  }
  if (best < 0) return 0.0;
  const double before = power[best - 1], here = power[best], after = power[std::min(best + 1, power.size() - 1)];
  const double curvature = before - 2.0 * here + after;
  return resolution * (double(best) + (curvature < 0.0 ? 0.5 * (before - after) / curvature : 0.0));
}

/// Normal equations of a mean and harmonics of a phase: 1, cos, sin, cos 2, sin 2 ...
class HarmonicFit {
 public:
  HarmonicFit(const Channel& channel, const std::vector<double>& cycles, int harmonics)
      : gram_(Eigen::MatrixXd::Zero(2 * harmonics + 1, 2 * harmonics + 1)),
        right_(Eigen::VectorXd::Zero(2 * harmonics + 1)) {
    for (std::size_t n = 0; n < channel.value.size(); ++n) {
      const Eigen::VectorXd row = basis(cycles[n], harmonics);
      gram_.selfadjointView<Eigen::Lower>().rankUpdate(row);
      right_ += channel.value[n] * row;
      squares_ += channel.value[n] * channel.value[n];
    }
    gram_ = gram_.selfadjointView<Eigen::Lower>();
  }

  static Eigen::VectorXd basis(double cycles, int harmonics) {
    Eigen::VectorXd row(2 * harmonics + 1);
    const std::complex<double> turn = std::polar(1.0, two_pi * (cycles - std::floor(cycles)));
    std::complex<double> z = 1.0;
    row[0] = 1.0;
    for (int h = 1; h <= harmonics; ++h) {
      z *= turn;
      row[2 * h - 1] = z.real();
      row[2 * h] = z.imag();
    }
    return row;
  }

  Eigen::VectorXd coefficients(int harmonics) const {
    const Eigen::Index n = 2 * harmonics + 1;
    return gram_.topLeftCorner(n, n).ldlt().solve(right_.head(n));
  }
  std::vector<double> residuals(const Channel& channel, const std::vector<double>& cycles, int harmonics) const {
    const Eigen::VectorXd a = coefficients(harmonics);
    std::vector<double> all;
    for (std::size_t n = 0; n < channel.value.size(); ++n) {
      all.push_back(channel.value[n] - a.dot(basis(cycles[n], harmonics)));
    }
    return all;
  }
  /// Sum of squares that so many harmonics leave.
  double left(int harmonics) const {
    return std::max(squares_ - coefficients(harmonics).dot(right_.head(2 * harmonics + 1)), 1e-24 * squares_ + 1e-300);
  }

 private:
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_;
  double squares_ = 0.0;
};

std::vector<double> cycles_of(const Channel& channel, const PhaseLaw& law) {
  std::vector<double> cycles;
  cycles.reserve(channel.time.size());
  for (const double t : channel.time) cycles.push_back(law.at(t));
  return cycles;
}

/// Of a hundred parts of the cycle, those with samples: samples at few phases determine few harmonics.
int occupied(const std::vector<double>& cycles) {
  bool seen[100] = {};
  for (const double c : cycles) seen[std::min(int(100.0 * (c - std::floor(c))), 99)] = true;
  return int(std::count(std::begin(seen), std::end(seen), true));
}

int harmonics_allowed(const Channel& channel, const std::vector<double>& cycles) {
  const int by_samples = int(channel.value.size() / 6), by_phase = occupied(cycles) / 2 - 1;
  return std::clamp(std::min(by_samples, by_phase), 1, max_harmonics);
}

/// Number of harmonics by the Bayesian information criterion.
int harmonics_by_bic(const HarmonicFit& fit, std::size_t samples, int allowed) {
  int best = 1;
  double least = HUGE_VAL;
  for (int h = 1; h <= allowed; ++h) {
    const double n = double(samples), bic = n * std::log(fit.left(h) / n) + (2.0 * h + 1.0) * std::log(n);
    if (bic < least) least = bic, best = h;
  }
  return best;
}

/// By how much the phases of successive pieces of the record are ahead of a law [cycles], with weights.
struct PhaseShifts {
  std::vector<double> time, shift, weight;
};

/// Corrects the law by the shifts as a polynomial of the time from the middle on. Returns how much the phase changes by
/// it over the record [cycles]; the standard error is that of the slope [Hz].
double correct_by(const PhaseShifts& shifts, PhaseLaw& law, double& frequency_error) {
  const Eigen::Index count = Eigen::Index(shifts.time.size());
  const Eigen::Index order = count >= 8 ? 3 : 2;
  Eigen::MatrixXd design(count, order);
  Eigen::VectorXd right(count);
  for (Eigen::Index b = 0; b < count; ++b) {
    const double t = shifts.time[std::size_t(b)] - law.middle, w = std::sqrt(shifts.weight[std::size_t(b)]);
    for (Eigen::Index p = 0; p < order; ++p) design(b, p) = w * std::pow(t, double(p));
    right[b] = w * shifts.shift[std::size_t(b)];
  }
  const Eigen::VectorXd solution = design.colPivHouseholderQr().solve(right);
  law.frequency += solution[1];
  if (order == 3) law.rate += 2.0 * solution[2];
  const double freedom = double(count - order);
  frequency_error = absent;
  if (freedom > 0.5) {
    const double variance = (design * solution - right).squaredNorm() / freedom;
    const Eigen::MatrixXd information = design.transpose() * design;
    frequency_error = std::sqrt(variance * information.ldlt().solve(Eigen::VectorXd::Unit(order, 1))[1]);
  }
  return std::abs(solution[1]) * (shifts.time.back() - shifts.time.front());
}

/// Refines the frequency of one strong component by the phases that it has in pieces of the record.
void refine_by_component(const std::vector<Channel>& channels, double duration, PhaseLaw& law) {
  for (int iteration = 0; iteration < 4; ++iteration) {
    const int pieces = std::clamp(int(law.frequency * duration / 2.0), 2, 200);
    PhaseShifts shifts;
    // The sum over channels of z times its conjugate in the first piece turns with the law's error alone.
    std::vector<std::vector<std::complex<double>>> z(channels.size(), std::vector<std::complex<double>>(pieces));
    const double start = law.middle - 0.5 * duration;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      for (std::size_t n = 0; n < channels[c].value.size(); ++n) {
        const int piece = std::clamp(int((channels[c].time[n] - start) / duration * pieces), 0, pieces - 1);
        z[c][std::size_t(piece)] += channels[c].value[n] * std::polar(1.0, -two_pi * law.at(channels[c].time[n]));
      }
    }
    double phase = 0.0;
    for (int piece = 0; piece < pieces; ++piece) {
      std::complex<double> turn = 0.0;
      double weight = 0.0;
      for (std::size_t c = 0; c < channels.size(); ++c) {
        if (!(channels[c].variance > 0.0)) continue;
        const auto here = z[c][std::size_t(piece)], before = z[c][std::size_t(std::max(piece - 1, 0))];
        turn += here * std::conj(before) / channels[c].variance;
        weight += std::norm(here) / channels[c].variance;
      }
      if (!(weight > 0.0)) continue;
      if (piece > 0) phase += std::arg(turn) / two_pi;
      shifts.time.push_back(start + (piece + 0.5) * duration / pieces);
      shifts.shift.push_back(phase);
      shifts.weight.push_back(weight);
    }
    double error;
    if (shifts.time.size() < 2 || correct_by(shifts, law, error) < 1e-4) return;
  }
}

/// Refines a law of the whole cycle by all harmonics of all channels; the frequency's standard error.
double refine_by_course(const std::vector<Channel>& channels, double duration, PhaseLaw& law) {
  double error = absent;
  for (int iteration = 0; iteration < 8; ++iteration) {
    const int pieces = std::clamp(int(law.frequency * duration), 2, 100);
    std::vector<double> pull(std::size_t(pieces), 0.0), weight(std::size_t(pieces), 0.0);
    const double start = law.middle - 0.5 * duration;
    for (const Channel& c : channels) {
      if (!(c.variance > 0.0)) continue;
      const std::vector<double> cycles = cycles_of(c, law);
      const int allowed = harmonics_allowed(c, cycles);
      const HarmonicFit fit(c, cycles, allowed);
      const int harmonics = harmonics_by_bic(fit, c.value.size(), allowed);
      const Eigen::VectorXd a = fit.coefficients(harmonics);
      const double noise = fit.left(harmonics) / double(c.value.size()) + 1e-12 * c.variance;
      for (std::size_t n = 0; n < c.value.size(); ++n) {
        const Eigen::VectorXd row = HarmonicFit::basis(cycles[n], harmonics);
        double slope = 0.0;  // by the phase in cycles
        for (int h = 1; h <= harmonics; ++h)
          slope += two_pi * h * (a[2 * h] * row[2 * h - 1] - a[2 * h - 1] * row[2 * h]);
        const int piece = std::clamp(int((c.time[n] - start) / duration * pieces), 0, pieces - 1);
        pull[std::size_t(piece)] += slope * (c.value[n] - a.dot(row)) / noise;
        weight[std::size_t(piece)] += slope * slope / noise;
      }
    }
    PhaseShifts shifts;
    double information = 0.0;
    for (int piece = 0; piece < pieces; ++piece) {
      const double w = weight[std::size_t(piece)];
      if (!(w > 0.0)) continue;
      const double time = start + (piece + 0.5) * duration / pieces;
      shifts.time.push_back(time);
      shifts.shift.push_back(pull[std::size_t(piece)] / w);
      shifts.weight.push_back(w);
      information += w * square(time - law.middle);
    }
    if (shifts.time.size() < 2) return error;
    const double moved = correct_by(shifts, law, error);
    if (!std::isfinite(error) && information > 0.0) error = 1.0 / std::sqrt(information);
    if (moved < 1e-7) break;
  }
  return error;
}

/// Variance of a mean of neighbouring residuals over that of as many independent ones.
double correlation_of(const std::vector<double>& residuals, int lags) {
  double squares = 0.0, factor = 1.0;
  for (const double r : residuals) squares += r * r;
  for (int k = 1; k <= lags && squares > 0.0; ++k) {
    double sum = 0.0;
    for (std::size_t n = std::size_t(k); n < residuals.size(); ++n) sum += residuals[n] * residuals[n - std::size_t(k)];
    const double rho = sum / squares;
    if (rho < 2.0 / std::sqrt(double(residuals.size()))) break;
    factor += 2.0 * rho;
  }
  return factor;
}

/// By how many periods of the strongest component the cycle is longer than one of them.
int periods_in_cycle(const std::vector<Channel>& channels, const PhaseLaw& component, double duration) {
  constexpr int harmonics_of_component = 8;
  std::vector<double> independent(channels.size(), 0.0);
  double least = HUGE_VAL, share_before = 0.0;
  int best = 1;
  for (int j = 1; j <= strongest_harmonic; ++j) {
    PhaseLaw law = component;
    law.frequency /= j;
    law.rate /= j;
    if (j > 1 && law.frequency * duration < least_cycles) break;
    double bic = 0.0, share = 0.0;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      const Channel& c = channels[k];
      if (!(c.variance > 0.0)) continue;
      const std::vector<double> cycles = cycles_of(c, law);
      const int harmonics = std::min(harmonics_of_component * j, harmonics_allowed(c, cycles));
      const HarmonicFit fit(c, cycles, harmonics);
      const double n = double(c.value.size());
      if (j == 1) {
        // Noise that lasts from sample to sample holds fewer independent values.
        const std::vector<double> residuals = fit.residuals(c, cycles, harmonics);
        independent[k] = std::max(n / correlation_of(residuals, int(n / (law.frequency * duration))), 1.0);
      }
      const double left = fit.left(harmonics);
      bic += independent[k] * std::log(left / n) + (2.0 * harmonics + 1.0) * std::log(independent[k]);
      share = std::max(share, 1.0 - left / (n * c.variance));
    }
    if (bic < least && (j == 1 || share > share_before + least_share)) {
      least = bic;
      best = j;
      share_before = share;
    }
  }
  return best;
}

AveragedChannel averaged(const Channel& channel, double mean, const PhaseLaw& law, double zero, int bins,
                         std::vector<int>& counts) {
  const std::vector<double> cycles = cycles_of(channel, law);
  const int allowed = harmonics_allowed(channel, cycles);
  const HarmonicFit fit(channel, cycles, allowed);
  AveragedChannel result;
  result.harmonics = channel.variance > 0.0 ? harmonics_by_bic(fit, channel.value.size(), allowed) : 1;
  const Eigen::VectorXd a =
      channel.variance > 0.0 ? fit.coefficients(result.harmonics) : Eigen::VectorXd::Zero(2 * result.harmonics + 1);
  const std::vector<double> residuals =
      channel.variance > 0.0 ? fit.residuals(channel, cycles, result.harmonics) : channel.value;
  std::vector<double> sums(std::size_t(bins), 0.0);
  counts.assign(std::size_t(bins), 0);
  double squares = 0.0;
  for (std::size_t n = 0; n < channel.value.size(); ++n) {
    const double residual = residuals[n];
    squares += residual * residual;
    const double share = cycles[n] - zero - std::floor(cycles[n] - zero);
    const std::size_t bin = std::size_t(std::min(int(share * bins), bins - 1));
    sums[bin] += residual;
    ++counts[bin];
  }
  const double freedom = std::max(double(residuals.size()) - 2.0 * result.harmonics - 1.0, 1.0);
  result.scatter = std::sqrt(squares / freedom);
  const double in_cycle = double(residuals.size()) / std::max(cycles.back() - cycles.front(), 1.0);
  result.correlation = correlation_of(residuals, int(0.5 * in_cycle));
  for (int bin = 0; bin < bins; ++bin) {
    const double count = std::max(double(counts[std::size_t(bin)]), 1.0);
    const double centre = (bin + 0.5) / bins + zero;
    result.mean.push_back(mean + a.dot(HarmonicFit::basis(centre, result.harmonics)) + sums[std::size_t(bin)] / count);
    result.deviation.push_back(result.scatter * std::sqrt(result.correlation / count));
  }
  return result;
}

}  // namespace

PhaseAverage phase_average(const SignalRecord& record, const PhaseAverageOptions& options) {
  const std::size_t samples = record.time.size();
  if (int(samples) < least_samples) {
    throw ParameterError("time", format("a mean cycle needs at least %d samples, got %zu", least_samples, samples));
  }
  const std::vector<Channel> channels = channels_of(record);
  for (const Channel& c : channels) {
    if (int(c.value.size()) < least_samples) {
      throw ParameterError("time", format("a mean cycle needs at least %d values of each column, got %zu",
                                          least_samples, c.value.size()));
    }
  }
  const double duration = record.time.back() - record.time.front();
  std::vector<double> distances;
  for (std::size_t n = 1; n < samples; ++n) distances.push_back(record.time[n] - record.time[n - 1]);
  std::nth_element(distances.begin(), distances.begin() + std::ptrdiff_t(distances.size() / 2), distances.end());
  const double step = distances[distances.size() / 2];

  if (!(step > 0.0) || !(duration / step < max_gaps * double(samples))) {
    throw ParameterError("time", format("%zu samples over %.4g s, %.4g s apart as a rule, are too uneven for a mean "
                                        "cycle; leave out repeated times and cut the record at its gaps (burst)",
                                        samples, duration, step));
  }

  PhaseLaw law;
  law.middle = record.time.front() + 0.5 * duration;
  if (options.frequency) {
    const double f = *options.frequency;
    if (f * duration < least_cycles) {
      throw ParameterError("time", format("the record holds %.1f cycles of %.4g Hz; at least %.0f are needed",
                                          f * duration, f, least_cycles));
    }
    // The strongest component is one of the harmonics of the frequency that was stated.
    double best_power = -1.0;
    for (int h = 1; h <= strongest_harmonic; ++h) {
      if (0.8 * h * f > 0.5 / step) break;
      PhaseLaw trial = law;
      trial.frequency = strongest_frequency(record, channels, step, 0.8 * h * f, std::min(1.2 * h * f, 0.5 / step));
      if (!(trial.frequency > 0.0)) continue;
      refine_by_component(channels, duration, trial);
      trial.frequency /= h;
      trial.rate /= h;
      double power = 0.0;
      for (const Channel& c : channels) {
        if (!(c.variance > 0.0)) continue;
        const std::vector<double> cycles = cycles_of(c, trial);
        const int harmonics = std::min(8, harmonics_allowed(c, cycles));
        power += 1.0 - HarmonicFit(c, cycles, harmonics).left(harmonics) / (double(c.value.size()) * c.variance);
      }
      if (power > best_power + 1e-9) best_power = power, law = trial;
    }
  } else {
    PhaseLaw component = law;
    component.frequency = strongest_frequency(record, channels, step, 2.0 / duration, 0.5 / step);
    if (component.frequency > 0.0) {
      refine_by_component(channels, duration, component);
      const int periods = periods_in_cycle(channels, component, duration);
      law.frequency = component.frequency / periods;
      law.rate = component.rate / periods;
    }
  }
  if (!(law.frequency > 0.0)) throw ParameterError("time", "the signals show no period");
  PhaseAverage result;
  result.frequency_error = refine_by_course(channels, duration, law);
  result.frequency = law.frequency;
  result.rate = law.rate;
  result.cycles = law.at(record.time.back()) - law.at(record.time.front());
  if (!(result.cycles >= least_cycles) || !std::isfinite(law.frequency)) {
    throw ParameterError("time", format("the record holds %.1f cycles; at least %.0f are needed",
                                        std::isfinite(result.cycles) ? result.cycles : 0.0, least_cycles));
  }
  const int bins = std::clamp(int(samples) / samples_in_bin, min_bins, max_bins);
  std::vector<bool> filled(std::size_t(bins), true);
  std::vector<int> counts;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    double mean = 0.0;
    for (const double x : record.channels[c]) mean += std::isnan(x) ? 0.0 : x;
    mean /= double(channels[c].value.size());
    result.channels.push_back(averaged(channels[c], mean, law, law.at(options.time_zero), bins, counts));
    for (int bin = 0; bin < bins; ++bin) {
      if (counts[std::size_t(bin)] == 0) filled[std::size_t(bin)] = false;
    }
  }
  // Samples that keep step with the flapping lie at few phases: the other bins are empty.
  for (int bin = bins - 1; bin >= 0; --bin) {
    if (filled[std::size_t(bin)]) continue;
    for (AveragedChannel& c : result.channels) {
      c.mean.erase(c.mean.begin() + bin);
      c.deviation.erase(c.deviation.begin() + bin);
    }
  }
  for (int bin = 0; bin < bins; ++bin) {
    if (filled[std::size_t(bin)]) result.phase.push_back(two_pi * (bin + 0.5) / bins);
  }
  return result;
}

}  // namespace wingbeat
