#include "files/bench_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "wingbeat/core/status.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/phase_average.hpp"

namespace wingbeat::detail {
namespace {

/// A deviation of zero would count a value as exact: the least, in sizes of the values.
constexpr double least_deviation = 1e-6;
/// A last burst that is shorter than this share of the others is left out.
constexpr double whole_burst = 0.75;

constexpr MeasuredQuantity of_frequency{false, Metric::frequency, {}};
constexpr MeasuredQuantity of_voltage{false, Metric::voltage, {}};

bool is_voltage(const MeasuredQuantity& q) { return q.waveform && q.quantity == WaveformQuantity::voltage; }

/// Numbers the bursts of a record that is cut by time; rows behind the last whole one are dropped and counted.
void cut(std::vector<BenchRow>& rows, double duration, const std::string& file, LogNotes& notes) {
  const double start = rows.front().crank_angle;
  if (!((rows.back().crank_angle - start) / duration < double(rows.size()))) {
    throw InputError(file, 0, 0, "burst",
                     fmt::format("{:g} s cuts the record into more bursts than it has rows", duration));
  }
  for (BenchRow& row : rows) row.burst = 1 + int((row.crank_angle - start) / duration);
  const int last = rows.back().burst;
  if (last == 1 || rows.back().crank_angle - start >= (last - 1 + whole_burst) * duration) return;
  const auto behind = std::find_if(rows.begin(), rows.end(), [&](const BenchRow& row) { return row.burst == last; });
  notes.rows_in_short_burst = int(rows.end() - behind);
  rows.erase(behind, rows.end());
}

/// Amplitude of the fundamental of a mean course.
double amplitude(const std::vector<double>& phase, const std::vector<double>& mean) {
  std::complex<double> sum = 0.0;
  for (std::size_t k = 0; k < phase.size(); ++k) sum += mean[k] * std::polar(1.0, -phase[k]);
  return 2.0 * std::abs(sum) / double(phase.size());
}

/// Mean of values without gaps, and its standard error.
struct Mean {
  double value = absent, error = 0.0;
};
Mean mean_of(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const double x : values) {
    if (std::isnan(x)) continue;
    sum += x;
    count += 1.0;
  }
  const double mean = sum / count;
  for (const double x : values) {
    if (!std::isnan(x)) squares += square(x - mean);
  }
  return {mean, std::sqrt(squares / (count * std::max(count - 1.0, 1.0)))};
}

}  // namespace

BenchLog mean_cycles(const BenchLog& record, const LogRequest& request, LogNotes& notes) {
  std::vector<BenchRow> rows = record.rows;
  notes.rows_read = int(rows.size());
  if (request.burst) cut(rows, *request.burst, record.file, notes);
  std::stable_sort(rows.begin(), rows.end(), [](const BenchRow& a, const BenchRow& b) { return a.burst < b.burst; });
  const auto voltage = std::find_if(record.columns.begin(), record.columns.end(), is_voltage);
  const bool has_voltage = voltage != record.columns.end();
  const std::size_t voltage_column = std::size_t(voltage - record.columns.begin());
  if (!request.given_value && !has_voltage && request.needs_point) {
    throw InputError(record.file, 0, 0, "voltage",
                     "missing: give voltage = \"3 V\" (or frequency) in [[log]], or a column of the voltage");
  }
  BenchLog log = record;
  log.in_time = true;
  log.frequency_stated = request.cycle_frequency.has_value();
  log.given = request.given_value ? *request.given : Given::voltage;
  log.rows.clear();
  // The mean voltage of a crank's supply is what was set, or what the set frequency took; a direct drive's is a sine,
  // whose course shows the phase.
  const bool keeps_voltage = has_voltage && request.alternating;
  if (has_voltage && !keeps_voltage) log.columns.erase(log.columns.begin() + std::ptrdiff_t(voltage_column));
  if (log.columns.empty()) throw InputError(record.file, 0, 0, "", "no measured column beside what was set");
  const bool sets_frequency = request.alternating || log.given == Given::frequency;
  if (!sets_frequency) log.columns.push_back(of_frequency);
  if (log.given == Given::frequency && has_voltage && !keeps_voltage) log.columns.push_back(of_voltage);

  for (auto first = rows.begin(); first != rows.end();) {
    const auto last = std::find_if(first, rows.end(), [&](const BenchRow& row) { return row.burst != first->burst; });
    SignalRecord signals;
    signals.channels.resize(record.columns.size());
    for (auto row = first; row != last; ++row) {
      signals.time.push_back(row->crank_angle);
      for (std::size_t c = 0; c < signals.channels.size(); ++c) signals.channels[c].push_back(row->values[c]);
    }
    const Mean volts = has_voltage ? mean_of(signals.channels[voltage_column]) : Mean{};
    if (has_voltage && !keeps_voltage) {
      signals.channels.erase(signals.channels.begin() + std::ptrdiff_t(voltage_column));
    }
    PhaseAverage mean;
    try {
      mean = phase_average(signals, {request.cycle_frequency, log.phase_known ? 0.0 : signals.time.front()});
    } catch (const ParameterError& error) {
      throw InputError(record.file, first->line, 1, error.key(), error.reason());
    }
    double given = request.given_value.value_or(absent);
    if (!request.given_value && has_voltage) {
      given = keeps_voltage ? amplitude(mean.phase, mean.channels[voltage_column].mean) : volts.value;
    }
    // The frequency is measured at a voltage that is known no better than its mean, and follows it about in proportion.
    const double of_voltage_error = keeps_voltage || !has_voltage ? 0.0 : mean.frequency * volts.error / volts.value;
    const double frequency_error =
        std::hypot(std::isfinite(mean.frequency_error) ? mean.frequency_error : 0.0, of_voltage_error);
    LogNotes::Burst burst{first->line, first->burst,   int(last - first),
                          mean.cycles, mean.frequency, frequency_error,
                          mean.rate,   given,          1.0};
    for (std::size_t k = 0; k < mean.phase.size(); ++k) {
      BenchRow row{first->line, given, mean.phase[k], {}};
      row.burst = first->burst;
      if (request.alternating && log.given == Given::voltage) row.drive_frequency = mean.frequency;
      for (const AveragedChannel& channel : mean.channels) {
        const double size = std::abs(*std::max_element(channel.mean.begin(), channel.mean.end(),
                                                       [](double a, double b) { return std::abs(a) < std::abs(b); }));
        row.values.push_back(channel.mean[k]);
        row.deviations.push_back(std::max(channel.deviation[k], least_deviation * size));
        burst.correlation = std::max(burst.correlation, channel.correlation);
      }
      for (std::size_t c = mean.channels.size(); c < log.columns.size(); ++c) {
        const bool frequency = log.columns[c] == of_frequency;
        row.values.push_back(k > 0 ? absent : frequency ? mean.frequency : volts.value);
        row.deviations.push_back(frequency ? std::max(frequency_error, least_deviation * mean.frequency) : absent);
      }
      log.rows.push_back(std::move(row));
    }
    notes.bursts.push_back(burst);
    first = last;
  }
  return log;
}

}  // namespace wingbeat::detail
