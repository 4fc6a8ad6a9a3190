#include "wingbeat/study/bench_fit.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>

#include "study/bench_fitter.hpp"
#include "study/bench_unknowns.hpp"
#include "study/fit_covariance.hpp"
#include "study/fit_identifiability.hpp"
#include "study/fit_misfit.hpp"
#include "study/fit_profile.hpp"
#include "study/fit_stages.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/study/sampling.hpp"
#include "wingbeat/vehicle/drive.hpp"

namespace wingbeat {
namespace {

using detail::format;

/// Calls `act` for 0 to count - 1, each with a copy of the fitter. Returns how many orbits the copies computed.
int on_copies(const BenchFitter& fitter, std::size_t count, const char* what, const FitProgress& progress,
              const ForEach& for_each, const std::function<void(BenchFitter&, std::size_t)>& act) {
  std::mutex mutex;
  std::size_t finished = 0;
  int evaluations = 0;
  const auto tell = [&] {
    if (progress) progress(format("%s %zu of %zu", what, std::min(finished + 1, count), count));
  };
  tell();
  for_all(for_each, count, [&](std::size_t n) {
    BenchFitter own = fitter;
    act(own, n);
    const std::lock_guard<std::mutex> lock(mutex);
    evaluations += own.bench().evaluations() - fitter.bench().evaluations();
    ++finished;
    tell();
  });
  return evaluations;
}

/// Instants of the computed cycles that a result has.
constexpr int drawn_instants = 181;

/// The strongest component of signals may be twice the flapping frequency, or more: of a current whose half-strokes are
/// alike. Throws where a log's frequency is a multiple of the model's, or a fraction.
void check_frequencies(const BenchModel& bench) {
  for (std::size_t o = 0; o < bench.observations().size(); ++o) {
    const Observation& at_o = bench.observations()[o];
    const BenchLog& log = bench.fit().logs[at_o.log];
    if (!log.in_time || log.frequency_stated || at_o.quantity.waveform || at_o.quantity.metric != Metric::frequency ||
        !bench.predictions()[at_o.point].reached) {
      continue;
    }
    const double ratio = at_o.measured / bench.fitted()[o];
    const double nearest = ratio > 1.0 ? std::round(ratio) : 1.0 / std::round(1.0 / ratio);
    if (nearest == 1.0 || std::abs(ratio / nearest - 1.0) > 0.15) continue;
    throw ParameterError(
        "log.cycle_frequency",
        format("the signals of %s repeat at %.4g Hz, and the vehicle with its start values flaps at %.4g Hz: equal "
               "half-strokes, or equal cycles of another kind, may hide the cycle; state about which frequency it has",
               log.file.c_str(), at_o.measured, bench.fitted()[o]));
  }
}

}  // namespace

BenchFit on_bench_supply(BenchFit fit) {
  Supply<double>& supply = fit.design.supply;
  if (supply.type != SupplyType::battery) return fit;
  const std::optional<double> mass = battery_mass(supply.battery);
  if (mass) fit.design.masses.supply = fit.design.masses.supply.value_or(0.0) + *mass;
  supply.voltage = open_circuit_voltage(supply.battery, supply.battery.charge);
  supply.type = SupplyType::constant;
  return fit;
}

void check_fit(const BenchFit& fit) {
  std::set<std::string> keys;
  if (fit.logs.empty()) throw ParameterError("log", "missing: there is nothing to fit to");
  require(fit.starts >= 1 && fit.starts <= max_fit_starts, "fit.starts", "must lie between 1 and 1000", "1",
          fit.starts);
  if (fit.loss != Loss::none) {
    require(fit.loss_scale >= min_loss_scale && fit.loss_scale <= max_loss_scale, "fit.loss_scale",
            "must lie between 1 and 4: elsewhere the coverage of intervals is not as stated", "1", fit.loss_scale);
  }
  for (const FreeParameter& p : fit.parameters) {
    if (!keys.insert(p.parameter.key).second) throw ParameterError(p.parameter.key, "is given twice");
    if (!(p.lower < p.upper)) throw ParameterError(p.parameter.key, "the lower bound must lie below the upper one");
    if (!(p.start >= p.lower && p.start <= p.upper)) {
      throw ParameterError(p.parameter.key, format("the start %.6g does not lie within the bounds %.6g to %.6g [%s]",
                                                   p.start, p.lower, p.upper, p.parameter.unit.c_str()));
    }
    if (p.of_bench) continue;
    for (const double x : {p.lower, p.upper, p.start}) {
      Design<double> design = fit.design;
      if (!p.parameter.set(design, x)) throw ParameterError(p.parameter.key, "does not apply to this vehicle");
      validate(design);
    }
    if (p.parameter.key == "vehicle.motors" || p.parameter.key == "wing.count")
      throw ParameterError(p.parameter.key, "a whole number cannot be fitted");
    if (p.parameter.key.starts_with("supply.")) {
      throw ParameterError(p.parameter.key, "the logs state the supply, it cannot be fitted");
    }
    if (p.parameter.key == "motor.armature_inductance" && !(p.lower > 0.0)) {
      throw ParameterError(p.parameter.key, "the lower bound must be > 0: without inductance the equations change");
    }
  }
  // Alternatives replace each other: two of them cannot both be free.
  Design<double> all = fit.design;
  for (const FreeParameter& p : fit.parameters) {
    if (!p.of_bench) p.parameter.set(all, p.start);
  }
  for (const FreeParameter& p : fit.parameters) {
    if (!p.of_bench && p.parameter.value(all) != p.start) {
      throw ParameterError(p.parameter.key, "another free parameter takes its place in the vehicle");
    }
  }
  if (fit.design.supply.type != SupplyType::constant && !drive_of(fit.design).alternating) {
    throw ParameterError(
        "supply.type",
        "bench data are fitted with a constant supply, or with a battery, for which the bench's supply stands in");
  }
  check_bench(fit);
  for (const BenchLog& log : fit.logs) {
    for (const MeasuredQuantity& q : log.columns) {
      if (q.waveform) continue;
      if (q.metric == Metric::power_motor_reference && !fit.design.bench_torque_constant) {
        throw ParameterError("bench.torque_constant", "missing in the vehicle file: power_motor_reference needs it");
      }
      if (q.metric == Metric::lift_to_weight && !fit.design.mass) {
        throw ParameterError("vehicle.mass", "missing in the vehicle file: lift_to_weight needs it");
      }
      if (q.metric == Metric::floquet_multiplier_max) {
        throw ParameterError("log.measured", "a Floquet multiplier cannot be fitted");
      }
    }
    if (log.springs && !fit.design.spring.stiffness && !fit.design.spring.resonance) {
      throw ParameterError("spring", "a log was taken with springs, but the vehicle file has none");
    }
  }
}

FitResult run_fit(const BenchFit& given, FitPurpose purpose, const FitProgress& progress, const ForEach& for_each) {
  check_fit(given);
  const BenchFit fit = with_bench_unknowns(given);
  FitResult result;
  BenchFitter fitter(fit, for_each);
  BenchModel& bench = fitter.bench();
  std::vector<double> start;
  for (const FreeParameter& p : fit.parameters) start.push_back(p.start);
  start = bench.aligned(start);
  check_frequencies(bench);

  // Parameters without any influence at the start stay out of the fit: the rest would drag them along.
  bench.evaluate(start, true);
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < start.size(); ++k) {
    if (bench.jacobian().col(Eigen::Index(k)).cwiseAbs().maxCoeff() > 0.0) free.push_back(k);
  }
  fitter.use_convex_loss();
  const LatinHypercube samples{std::uint64_t(std::max(fit.starts - 1, 1)), fit.seed};
  std::vector<BenchFitter::Outcome> outcomes(std::size_t(fit.starts));
  result.evaluations += on_copies(fitter, outcomes.size(), "start", progress, for_each, [&](auto& own, std::size_t n) {
    std::vector<double> x = start;
    for (const std::size_t k : free) {
      if (n == 0) break;
      if (fit.parameters[k].of_bench && fit.parameters[k].of_bench->kind >= BenchUnknown::Kind::phase) continue;
      x[k] = fit.parameters[k].lower +
             samples(std::uint64_t(n - 1), k) * (fit.parameters[k].upper - fit.parameters[k].lower);
    }
    outcomes[n] = own.solve(n == 0 ? x : own.bench().aligned(x), free);
  });
  BenchFitter::Outcome best = outcomes.front();
  std::vector<double> costs;
  for (const BenchFitter::Outcome& outcome : outcomes) {
    costs.push_back(outcome.cost);
    if (outcome.cost < best.cost) best = outcome;
  }
  for (const double cost : costs) {
    const bool same = cost - best.cost < 1e-3 * (1.0 + best.cost);
    ++(same ? result.starts_converged : result.starts_elsewhere);
  }
  bench.evaluate(best.x, false);
  const bool intervals = purpose == FitPurpose::intervals;
  const int rounds = fitter.has_estimates() ? 20 : intervals ? 2 : 0;
  // Deviations that the convex loss leaves serve as a start for the other.
  if (fit.loss == Loss::cauchy) {
    if (rounds > 0) fitter.renew_deviations(free);
    fitter.use_own_loss();
    best = fitter.solve(best.x, free);
  }
  for (int round = 0; round < rounds; ++round) {
    if (fitter.renew_deviations(free) < 1e-3) break;
    best = fitter.solve(best.x, free);
  }
  result.converged = best.converged;
  result.message = best.message;

  if (intervals) refuse_few_values(fit, fitter, free);
  assess_identifiability(fit, fitter, best.x, free, result);
  std::vector<double> kept = best.x;
  for (std::size_t k = 0; k < kept.size(); ++k) kept[k] = result.parameters[k].kept;
  result.design = bench.design_at(kept);

  const auto& observations = bench.observations();
  double log_deviations = 0.0;
  int reached = 0;
  for (std::size_t o = 0; o < observations.size(); ++o) {
    const Observation& at_o = observations[o];
    const bool is_reached = bench.predictions()[at_o.point].reached;
    result.points.push_back({at_o.log, at_o.row, at_o.column, at_o.measured, is_reached ? bench.fitted()[o] : absent,
                             fitter.deviations()[o], fitter.loss_at(o).weight});
    if (!is_reached) continue;
    ++reached;
    result.chi_square += fitter.residual(o) * fitter.residual(o);
    log_deviations += 2.0 * std::log(fitter.deviations()[o]);
  }
  result.cycles = bench.cycles(drawn_instants);
  for (std::size_t n = 0; n < bench.points().size(); ++n) {
    const Prediction& p = bench.predictions()[n];
    if (!p.reached)
      result.unreached.push_back({bench.points()[n].log, bench.points()[n].row, p.status, p.evidence, p.refused});
  }
  for (const auto& [quantity, deviation] : fitter.estimated()) {
    if (fit.deviations.at(quantity).kind == Deviation::Kind::estimated) {
      result.estimated_deviations[quantity] = deviation;
    }
  }
  result.deviance = best.cost + log_deviations;
  const double k = double(free.size()) + double(result.estimated_deviations.size());
  result.aicc = reached > k + 1 ? result.deviance + 2.0 * k + 2.0 * k * (k + 1.0) / (reached - k - 1.0) : infinity;

  assess_misfit(fit, fitter.freedom(free), result);
  if (result.misfit) withdraw_intervals(result);
  if (fit.profiles && !result.misfit) {
    std::vector<std::size_t> determined;
    for (const std::size_t f : free) {
      const auto& b = fit.parameters[f].of_bench;
      if (b && b->kind >= BenchUnknown::Kind::phase) continue;  // numbers of the log, of no further use
      if (result.parameters[f].value) determined.push_back(f);
    }
    std::vector<ProfileSide> sides(2 * determined.size());
    result.evaluations += on_copies(
        fitter, sides.size(), "side of the profiles", progress, for_each, [&](BenchFitter& own, std::size_t n) {
          sides[n] = profile_loss(fit, own, best.x, best.cost, free, result, determined[n / 2], n % 2 == 0 ? -1 : 1);
        });
    for (std::size_t n = 0; n < determined.size(); ++n) {
      add_profile(sides[2 * n], sides[2 * n + 1], best.x[determined[n]], result.parameters[determined[n]]);
    }
  }
  result.evaluations += bench.evaluations();
  return result;
}

namespace {

struct WaveformName {
  const char *name, *unit;
};
constexpr WaveformName waveform_names[] = {
    {"crank_speed", "rad/s"}, {"current", "A"},        {"flapping_velocity", "rad/s"}, {"lift", "N"},
    {"rod_force", "N"},       {"motor_torque", "N m"}, {"stroke_angle", "rad"},        {"pitch_angle", "rad"},
    {"voltage", "V"},         {"balance_force", "N"}};
static_assert(std::size(waveform_names) == waveform_quantity_count);

}  // namespace

const char* name_of(WaveformQuantity q) { return waveform_names[int(q)].name; }
const char* unit_of(WaveformQuantity q) { return waveform_names[int(q)].unit; }
std::string name_of(const MeasuredQuantity& q) {
  if (q.waveform) return std::string("instantaneous ") + name_of(q.quantity);
  return metric_info(q.metric).key;
}
const char* unit_of(const MeasuredQuantity& q) { return q.waveform ? unit_of(q.quantity) : metric_info(q.metric).unit; }

std::string condition_name(Condition condition, bool springs) {
  const char* name = name_of(condition);
  return springs ? std::string(name) + " with springs" : name;
}

FitResult fit_bench(const BenchFit& fit, const std::function<void(const std::string&)>& progress,
                    const ForEach& for_each) {
  FitResult result = run_fit(on_bench_supply(fit), FitPurpose::intervals, progress, for_each);
  result.design.supply = fit.design.supply;
  result.design.masses.supply = fit.design.masses.supply;
  return result;
}

}  // namespace wingbeat
