#include "wingbeat/study/load_comparison.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numeric>
#include <string>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

constexpr double same_phase = 1e-9;  ///< [cycles]
constexpr int harmonics_max = 32;    ///< of a motion that is read from rows

double phase_of(double place) {
  const double phase = place - std::floor(place);
  return phase > 1.0 - same_phase ? 0.0 : phase;
}

/// Weights of the trapezoidal rule over a closed cycle; they add up to 1.
struct PhaseWeights {
  std::vector<double> weights;
  std::size_t groups = 0;  ///< different phases
  double largest_gap = 1.0, gap_after = 0.0;
};

PhaseWeights weights_in_phase(const std::vector<double>& phases) {
  std::vector<std::size_t> order(phases.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return phases[a] < phases[b]; });
  std::vector<std::size_t> first;  // of each group, as a place in `order`
  for (std::size_t n = 0; n < order.size(); ++n) {
    if (first.empty() || phases[order[n]] - phases[order[first.back()]] > same_phase) first.push_back(n);
  }
  PhaseWeights result;
  result.weights.assign(phases.size(), 0.0);
  result.groups = first.size();
  if (first.size() < 2) return result;
  result.largest_gap = 0.0;
  const auto phase = [&](std::size_t group) { return phases[order[first[group]]]; };
  std::vector<double> gaps(first.size());  // behind each group
  for (std::size_t g = 0; g < first.size(); ++g) {
    gaps[g] = g + 1 < first.size() ? phase(g + 1) - phase(g) : 1.0 + phase(0) - phase(g);
    if (gaps[g] > result.largest_gap) result.largest_gap = gaps[g], result.gap_after = phase(g);
  }
  for (std::size_t g = 0; g < first.size(); ++g) {
    const std::size_t end = g + 1 < first.size() ? first[g + 1] : order.size();
    const double weight = 0.5 * (gaps[g] + gaps[g == 0 ? first.size() - 1 : g - 1]) / double(end - first[g]);
    for (std::size_t n = first[g]; n < end; ++n) result.weights[order[n]] = weight;
  }
  return result;
}

std::string decimals_of(double x) {
  std::string text = std::to_string(x);
  return text.substr(0, text.find('.') + 4);
}

void require_whole_cycle(const PhaseWeights& weights, const char* what) {
  if (weights.largest_gap <= load_gap_max) return;
  const double end = weights.gap_after + weights.largest_gap;
  throw ParameterError(what, "the rows leave " + decimals_of(weights.largest_gap) + " of a cycle out, from " +
                                 decimals_of(weights.gap_after) + " to " + decimals_of(end) +
                                 "; expected a whole cycle without a gap above " + decimals_of(load_gap_max));
}

/// The angle of the rows as a series, by least squares.
AngleSeries series_of_rows(const std::vector<double>& phases, const std::vector<double>& values, const char* what) {
  std::vector<double> places, x;
  for (std::size_t n = 0; n < phases.size(); ++n) {
    if (std::isfinite(values[n])) places.push_back(phases[n]), x.push_back(values[n]);
  }
  const PhaseWeights weights = weights_in_phase(places);
  require_whole_cycle(weights, what);
  const int by_count = int(weights.groups - 1) / 4, by_gap = int(1.0 / (3.0 * weights.largest_gap));
  const int harmonics = std::max(1, std::min({harmonics_max, by_count, by_gap}));
  Eigen::MatrixXd terms(Eigen::Index(x.size()), 2 * harmonics + 1);
  Eigen::VectorXd right(Eigen::Index(x.size()));
  for (Eigen::Index n = 0; n < terms.rows(); ++n) {
    // Rows that stand close together count as one.
    const double root = std::sqrt(weights.weights[std::size_t(n)]);
    terms(n, 0) = root;
    for (int k = 1; k <= harmonics; ++k) {
      terms(n, 2 * k - 1) = root * std::cos(two_pi * k * places[std::size_t(n)]);
      terms(n, 2 * k) = root * std::sin(two_pi * k * places[std::size_t(n)]);
    }
    right[n] = root * x[std::size_t(n)];
  }
  const Eigen::VectorXd found = terms.colPivHouseholderQr().solve(right);
  AngleSeries series;
  series.mean = found[0];
  for (int k = 1; k <= harmonics; ++k) {
    series.cosine.push_back(found[2 * k - 1]);
    series.sine.push_back(found[2 * k]);
  }
  double squares = 0.0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    const double error = series.at(places[n]) - x[n];
    series.error_max = std::max(series.error_max, std::abs(error));
    squares += weights.weights[n] * square(error);
  }
  series.error_rms = std::sqrt(squares);
  return series;
}

double air_load_of(const AirLoads& loads, LoadQuantity quantity) {
  switch (quantity) {
    case LoadQuantity::lift: return loads.lift;
    case LoadQuantity::stroke_moment: return loads.stroke_moment;
    default: return loads.pitch_moment;
  }
}

using LoadsAt = std::function<AirLoads(double phase)>;

LoadComparison compared_loads(const SimulatedLoads& simulated, const Vehicle<double>& v, double frequency,
                              LoadComparison result, const LoadsAt& loads_at) {
  result.frequency = frequency;
  result.rows = int(simulated.places.size());
  std::vector<double> phases;
  for (const double place : simulated.places) phases.push_back(simulated.in_time ? place * frequency : place);
  const auto [first, last] = std::minmax_element(phases.begin(), phases.end());
  if (!phases.empty()) result.cycles = *last - *first;
  for (double& phase : phases) phase = phase_of(phase);
  const PhaseWeights all = weights_in_phase(phases);
  require_whole_cycle(all, simulated.in_time ? "time" : "phase");
  result.largest_gap = all.largest_gap;

  std::vector<AirLoads> model;
  for (const double phase : phases) model.push_back(loads_at(phase));
  for (std::size_t q = 0; q < load_quantity_count; ++q) {
    const auto& series = simulated.loads[q];
    if (!series) continue;
    const auto quantity = LoadQuantity(q);
    if (!std::isfinite(air_load_of(model.front(), quantity))) {
      result.left_out.push_back(std::string(name_of(quantity)) +
                                (pitches(v)
                                     ? ": the model gives the lift alone of wings that twist"
                                     : ": under the pitch law the model computes no moment about the pitch axis"));
      continue;
    }
    ComparedLoad load{quantity, {}, {}};
    const double wings = series->per_wing ? v.wing_count : 1.0;
    std::vector<double> kept;
    for (std::size_t n = 0; n < phases.size(); ++n) {
      if (!std::isfinite(series->values[n])) continue;
      load.points.push_back({phases[n], wings * series->values[n], air_load_of(model[n], quantity)});
      kept.push_back(phases[n]);
    }
    require_whole_cycle(weights_in_phase(kept), name_of(quantity));
    std::stable_sort(load.points.begin(), load.points.end(),
                     [](const LoadPoint& a, const LoadPoint& b) { return a.cycle < b.cycle; });
    load.disagreement = disagreement_of(load.points);
    result.loads.push_back(std::move(load));
  }
  if (result.loads.empty()) {
    throw ParameterError(simulated.file, result.left_out.empty() ? "holds no load" : result.left_out.front());
  }
  return result;
}

double wrapped(double angle) { return std::remainder(angle, two_pi); }

}  // namespace

const char* unit_of(LoadQuantity quantity) { return quantity == LoadQuantity::lift ? "N" : "N m"; }

SimulatedLoads without_first_cycles(const SimulatedLoads& simulated, double cycles, double frequency) {
  SimulatedLoads kept = simulated;
  std::vector<bool> late;
  for (const double place : simulated.places) {
    late.push_back((simulated.in_time ? place * frequency : place) >= cycles - same_phase);
  }
  const auto keep = [&](std::vector<double>& column) {
    std::size_t n = 0;
    std::erase_if(column, [&](double) { return !late[n++]; });
  };
  keep(kept.places), keep(kept.stroke), keep(kept.pitch);
  for (auto& series : kept.loads) {
    if (series) keep(series->values);
  }
  if (kept.places.empty()) throw ParameterError(simulated.file, "no row is left after the cycles that are skipped");
  return kept;
}

LoadDisagreement disagreement_of(const std::vector<LoadPoint>& points) {
  std::vector<double> phases;
  for (const LoadPoint& p : points) phases.push_back(phase_of(p.cycle));
  const std::vector<double> weights = weights_in_phase(phases).weights;
  const auto mean = [&](const auto& value) {
    double sum = 0.0;
    for (std::size_t n = 0; n < points.size(); ++n) sum += weights[n] * value(points[n]);
    return sum;
  };
  LoadDisagreement d;
  d.mean_simulated = mean([](const LoadPoint& p) { return p.simulated; });
  d.mean_model = mean([](const LoadPoint& p) { return p.model; });
  if (d.mean_simulated != 0.0) d.ratio = d.mean_model / d.mean_simulated;
  d.rms_simulated = std::sqrt(mean([](const LoadPoint& p) { return square(p.simulated); }));
  const double squares = mean([](const LoadPoint& p) { return square(p.model - p.simulated); });
  if (d.rms_simulated > 0.0) d.rms_difference = std::sqrt(squares) / d.rms_simulated;
  const double sigma_x = std::sqrt(mean([&](const LoadPoint& p) { return square(p.simulated - d.mean_simulated); }));
  const double sigma_m = std::sqrt(mean([&](const LoadPoint& p) { return square(p.model - d.mean_model); }));
  const double product =
      mean([&](const LoadPoint& p) { return (p.simulated - d.mean_simulated) * (p.model - d.mean_model); });
  if (sigma_x > 0.0 && sigma_m > 0.0) {
    d.correlation = std::clamp(product / (sigma_x * sigma_m), -1.0, 1.0);
    d.variance_in_phase = square(d.correlation);
  }
  if (squares > 0.0) {
    d.share_mean = square(d.mean_model - d.mean_simulated) / squares;
    d.share_size = square(sigma_m - sigma_x) / squares;
    d.share_phase = std::max(0.0, 1.0 - d.share_mean - d.share_size);
  }

  using Complex = std::complex<double>;
  const auto harmonic = [&](int k, bool of_model) {
    Complex sum = 0.0;
    for (std::size_t n = 0; n < points.size(); ++n) {
      const double x = of_model ? points[n].model - d.mean_model : points[n].simulated - d.mean_simulated;
      sum += 2.0 * weights[n] * x * std::polar(1.0, -two_pi * k * phases[n]);
    }
    return sum;
  };
  const auto lag = [&](int k) {
    constexpr double least = 1e-3;
    const Complex x = harmonic(k, false), m = harmonic(k, true);
    return std::abs(x) > least * sigma_x && std::abs(m) > least * sigma_m ? wrapped(std::arg(x) - std::arg(m)) : absent;
  };
  d.first_harmonic_lag = lag(1);
  double largest = 0.0;
  for (int k = 1; k <= 4 && sigma_x > 0.0; ++k) {
    const double size = std::abs(harmonic(k, false));
    if (size > largest) largest = size, d.strongest_harmonic = k;
  }
  if (d.strongest_harmonic > 0) d.strongest_lag = lag(d.strongest_harmonic);
  return d;
}

LoadComparison compare_loads_of_motion(const SimulatedLoads& simulated, const Vehicle<double>& v, double frequency) {
  require(frequency > 0.0 && std::isfinite(frequency), "frequency", "must be > 0", "Hz", frequency);
  if (simulated.stroke.empty()) {
    throw ParameterError("stroke_angle", "is missing: a motion is stated by its stroke angle, or by both angles");
  }
  if (pitches(v) && simulated.pitch.empty()) {
    throw ParameterError("pitch_angle", "is missing: of wings on hinges the stroke alone does not give the pitch");
  }
  std::vector<double> phases;
  for (const double place : simulated.places) phases.push_back(phase_of(simulated.in_time ? place * frequency : place));
  LoadComparison result;
  result.own_motion = false;
  result.stroke = series_of_rows(phases, simulated.stroke, "stroke_angle");
  if (!simulated.pitch.empty()) result.pitch = series_of_rows(phases, simulated.pitch, "pitch_angle");
  const PeriodicAngle stroke = periodic_angle(*result.stroke);
  const PeriodicAngle pitch = result.pitch ? periodic_angle(*result.pitch) : PeriodicAngle{};
  const bool pitch_stated = result.pitch.has_value();
  return compared_loads(simulated, v, frequency, std::move(result), [&](double phase) {
    const double time = phase / frequency;
    const AngleMotion beta = motion_of(stroke, frequency, time), psi = motion_of(pitch, frequency, time);
    return air_loads(v, beta, pitch_stated ? &psi : nullptr);
  });
}

LoadComparison compare_loads_of_cycle(const SimulatedLoads& simulated, const CycleRecord& cycle) {
  return compared_loads(simulated, cycle.vehicle(), 1.0 / cycle.period(), {},
                        [&](double phase) { return wing_instant(cycle, phase).loads; });
}

}  // namespace wingbeat
