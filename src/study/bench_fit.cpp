#include "wingbeat/study/bench_fit.hpp"

// g++ 12 takes Eigen's resizing for a use of freed memory.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif
#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "study/fit_misfit.hpp"
#include "study/least_squares.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/study/frequency_search.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/study/sampling.hpp"

namespace wingbeat {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Relative standard errors from which a direction counts as left free, and as known only roughly.
constexpr double free_error = 1.0, rough_error = 0.2;
constexpr double normal_95 = 1.959963984540054;

using detail::format;

/// Student's quantile for 95 %, two-sided, by the expansion of Cornish and Fisher.
double student_95(int freedom) {
  const double z = normal_95, n = std::max(freedom, 3);
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

bool is_peak(Metric m) {
  switch (m) {
    case Metric::current_peak:
    case Metric::lift_peak:
    case Metric::rod_force_peak:
    case Metric::flapping_velocity_peak:
    case Metric::angle_of_attack_min:
    case Metric::crank_speed_min:
    case Metric::crank_speed_max: return true;
    default: return false;
  }
}

/// One operating point of the bench with everything measured there.
struct OperatingPoint {
  Condition condition;
  bool springs;
  Given given;
  double value;
  std::size_t log, row;  ///< of its first measurement
  std::vector<double> crank_angles;
  std::vector<std::size_t> observations;  ///< indices
  bool peaks = false;
};

struct Observation {
  std::size_t log, row, column;
  MeasuredQuantity quantity;
  std::size_t point;
  std::size_t instant = 0;  ///< index of its crank angle at the point
  double measured;
};

struct Prediction {
  bool reached = false;
  FlappingStatus status = FlappingStatus::stalled;
  std::string detail;
};

const GradientJet& at(const GradientInstant& i, WaveformQuantity q) {
  const GradientJet* all[] = {&i.crank_speed, &i.current, &i.flapping_velocity, &i.lift, &i.rod_force, &i.motor_torque};
  return *all[int(q)];
}
double at(const WaveformRow& r, WaveformQuantity q) {
  const double all[] = {r.crank_speed, r.current, r.flapping_velocity, r.lift, r.rod_force, r.motor_torque};
  return all[int(q)];
}

/// The model at all points of the bench, with derivatives; remembers the last parameters it was asked for.
class Bench {
 public:
  Bench(const BenchFit& fit) : fit_(fit) {
    for (std::size_t l = 0; l < fit.logs.size(); ++l) {
      const BenchLog& log = fit.logs[l];
      for (std::size_t r = 0; r < log.rows.size(); ++r) {
        const BenchRow& row = log.rows[r];
        if (!log.waveform || r == 0) {
          points_.push_back({log.condition, log.springs, log.given, row.given, l, r, {}, {}, false});
        }
        OperatingPoint& point = points_.back();
        if (log.waveform) point.crank_angles.push_back(row.crank_angle);
        for (std::size_t c = 0; c < log.columns.size(); ++c) {
          point.observations.push_back(observations_.size());
          point.peaks = point.peaks || (!log.columns[c].waveform && is_peak(log.columns[c].metric));
          observations_.push_back({l, r, c, log.columns[c], points_.size() - 1,
                                   log.waveform ? point.crank_angles.size() - 1 : 0, row.values[c]});
        }
      }
    }
    voltages_.assign(points_.size(), absent);
    frequency_slopes_.assign(points_.size(), absent);
    voltage_slopes_.assign(points_.size(), {});
    predictions_.resize(points_.size());
    orbits_.resize(points_.size());
    fitted_.assign(observations_.size(), absent);
    jacobian_ = Eigen::MatrixXd::Zero(Eigen::Index(observations_.size()), Eigen::Index(fit.parameters.size()));
  }

  const std::vector<OperatingPoint>& points() const { return points_; }
  const std::vector<Observation>& observations() const { return observations_; }
  const std::vector<Prediction>& predictions() const { return predictions_; }
  const std::vector<double>& fitted() const { return fitted_; }
  /// d fitted / d parameter, SI; rows of points not reached are zero.
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }
  int evaluations() const { return evaluations_; }

  Design<double> design_at(const std::vector<double>& x) const {
    Design<double> design = fit_.design;
    for (std::size_t k = 0; k < x.size(); ++k) fit_.parameters[k].parameter.set(design, x[k]);
    return design;
  }

  void evaluate(const std::vector<double>& x, bool derivatives) {
    if (x != x_) {
      x_ = x;
      derivatives_known_ = false;
      const Design<double> design = design_at(x);
      for (std::size_t n = 0; n < points_.size(); ++n) evaluate_point(n, design);
    }
    if (derivatives && !derivatives_known_) {
      jacobian_.setZero();
      for (std::size_t first = 0; first < x.size(); first += gradient_parameters) {
        const std::size_t count = std::min<std::size_t>(gradient_parameters, x.size() - first);
        Design<GradientJet> seeded = cast<GradientJet>(design_at(x));
        for (std::size_t k = 0; k < count; ++k) {
          fit_.parameters[first + k].parameter.set_jet(seeded, gradient_seed(x[first + k], int(k)));
        }
        Design<GradientJet> springless = seeded;
        springless.spring = {};
        for (std::size_t n = 0; n < points_.size(); ++n) {
          if (predictions_[n].reached) {
            differentiate_point(n, points_[n].springs ? seeded : springless, first, count);
          }
        }
      }
      derivatives_known_ = true;
    }
  }

 private:
  SteadyFlapping orbit(Vehicle<double>& vehicle, double voltage, const Reporting& reporting) {
    ++evaluations_;
    vehicle.voltage = voltage;
    return find_steady_flapping(vehicle, {.tolerance = fit_.tolerance, .stability = false, .reporting = reporting});
  }

  void evaluate_point(std::size_t n, Design<double> design) {
    const OperatingPoint& point = points_[n];
    if (!point.springs) design.spring = {};
    Vehicle<double> vehicle = resolve(design, point.condition);
    const Reporting reporting = reporting_of(design);
    SteadyFlapping& found = orbits_[n];
    Prediction& prediction = predictions_[n];
    if (point.given == Given::voltage) {
      found = orbit(vehicle, point.value, reporting);
    } else {
      found = orbit_at_frequency(n, vehicle, reporting);
    }
    prediction.reached = found.status == FlappingStatus::flapping && !found.record.empty();
    prediction.status = found.status;
    prediction.detail = found.detail;
    for (const std::size_t o : point.observations) {
      const Observation& observation = observations_[o];
      double& value = fitted_[o];
      if (!prediction.reached) {
        value = standing_still(observation, vehicle, point);
      } else if (observation.quantity.waveform) {
        value = at(found.record.at(point.crank_angles[observation.instant]), observation.quantity.quantity);
      } else {
        value = found.metrics[observation.quantity.metric];
      }
    }
  }

  /// What a crank that does not turn shows: a prediction far off, so that no fit gains by stalling a row.
  static double standing_still(const Observation& o, const Vehicle<double>& vehicle, const OperatingPoint& point) {
    if (point.given == Given::frequency) return 0.0;
    const double current = point.value / vehicle.motor.armature_resistance;
    if (o.quantity.waveform) return o.quantity.quantity == WaveformQuantity::current ? current : 0.0;
    switch (o.quantity.metric) {
      case Metric::voltage: return point.value;
      case Metric::current_mean:
      case Metric::current_peak:
      case Metric::current_rms: return current;
      case Metric::power_electrical: return point.value * current;
      default: return 0.0;
    }
  }

  SteadyFlapping orbit_at_frequency(std::size_t n, Vehicle<double>& vehicle, const Reporting& reporting) {
    const double wanted = points_[n].value;
    if (vehicle.transmission == TransmissionType::direct) {
      vehicle.drive_frequency = wanted;
      return orbit(vehicle, vehicle.voltage, reporting);
    }
    const double close = std::max(3.0 * fit_.tolerance, 1e-6);
    double& start = voltages_[n];
    double& slope = frequency_slopes_[n];
    const VoltageSlopes& known = voltage_slopes_[n];
    const Motor<double>& m = vehicle.motor;
    double v = start;
    if (std::isfinite(v) && std::isfinite(known.voltage)) {
      double moved = known.voltage;
      for (std::size_t k = 0; k < x_.size(); ++k) moved += known.by_parameter[k] * (x_[k] - known.x[k]);
      if (moved > 0.5 * v && moved < 2.0 * v) v = moved;
    }
    // At first half as much again as the motor needs without load.
    if (!std::isfinite(v)) {
      v = 1.5 * two_pi * wanted * (m.torque_constant + m.armature_resistance * m.viscous_damping / m.torque_constant);
    }
    double v_before = absent, f_before = absent;
    for (int iteration = 0; iteration < 10; ++iteration) {
      SteadyFlapping found = orbit(vehicle, v, reporting);
      if (found.status != FlappingStatus::flapping) break;
      const double f = found.metrics[Metric::frequency];
      if (std::isfinite(v_before) && f != f_before) slope = (f - f_before) / (v - v_before);
      if (std::abs(f / wanted - 1.0) < close) {
        start = v;
        return found;
      }
      if (!(slope > 0.0)) slope = f / v;
      v_before = v;
      f_before = f;
      v += (wanted - f) / slope;
      if (!(v > 0.3 * v_before && v < 3.0 * v_before)) break;
    }
    const FrequencySearch search = find_voltage_for_frequency(
        vehicle, wanted, {.tolerance = fit_.tolerance, .stability = false, .reporting = reporting});
    evaluations_ += search.evaluations;
    if (search.outcome != FrequencyOutcome::reached) {
      start = absent;
      SteadyFlapping none;
      none.status = search.status == FlappingStatus::flapping ? FlappingStatus::stalled : search.status;
      none.detail = search.detail;
      return none;
    }
    start = search.voltage;
    return orbit(vehicle, search.voltage, reporting);
  }

  void differentiate_point(std::size_t n, const Design<GradientJet>& seeded, std::size_t first, std::size_t count) {
    const OperatingPoint& point = points_[n];
    GradientVehicle vehicle = gradient_vehicle(seeded, point.condition);
    // The bench sets the voltage (or the frequency): a free supply voltage plays no part.
    vehicle.vehicle.voltage = GradientJet(vehicle.vehicle.voltage.a);
    if (point.given == Given::frequency) {
      vehicle.vehicle.drive_frequency = GradientJet(vehicle.vehicle.drive_frequency.a);
    }
    const OrbitGradient g = orbit_gradient(orbits_[n], vehicle,
                                           {.held = point.given == Given::voltage ? Held::voltage : Held::frequency,
                                            .peaks = point.peaks,
                                            .crank_angles = point.crank_angles});
    if (point.given == Given::frequency) {
      VoltageSlopes& slopes = voltage_slopes_[n];
      slopes.voltage = orbits_[n].metrics[Metric::voltage];
      slopes.x = x_;
      slopes.by_parameter.resize(x_.size(), 0.0);
      for (std::size_t k = 0; k < count; ++k) {
        slopes.by_parameter[first + k] = g.metrics[Metric::voltage].v[gradient_first_slot + Eigen::Index(k)];
      }
    }
    for (const std::size_t o : point.observations) {
      const Observation& observation = observations_[o];
      const GradientJet& value = observation.quantity.waveform
                                     ? at(g.instants[observation.instant], observation.quantity.quantity)
                                     : g.metrics[observation.quantity.metric];
      for (std::size_t k = 0; k < count; ++k) {
        const double slope = value.v[gradient_first_slot + Eigen::Index(k)];
        jacobian_(Eigen::Index(o), Eigen::Index(first + k)) = g.regular && std::isfinite(slope) ? slope : 0.0;
      }
    }
  }

  const BenchFit& fit_;
  std::vector<OperatingPoint> points_;
  std::vector<Observation> observations_;
  std::vector<Prediction> predictions_;
  std::vector<SteadyFlapping> orbits_;
  // Of points whose frequency is set: the voltage last found, df/dv there, and the voltage's gradient with the voltage
  // and the parameters it belongs to.
  struct VoltageSlopes {
    double voltage = absent;
    std::vector<double> x, by_parameter;
  };
  std::vector<double> voltages_, frequency_slopes_;
  std::vector<VoltageSlopes> voltage_slopes_;
  std::vector<double> fitted_, x_;
  Eigen::MatrixXd jacobian_;
  bool derivatives_known_ = false;
  int evaluations_ = 0;
};

/// Least squares on the bench with some of the parameters free.
class Fitter {
 public:
  explicit Fitter(const BenchFit& fit) : fit_(fit), bench_(fit), deviations_(bench_.observations().size()) {
    for (std::size_t o = 0; o < deviations_.size(); ++o) estimated_[bench_.observations()[o].quantity] = 0.0;
    first_deviations();
  }

  Bench& bench() { return bench_; }
  const std::vector<double>& deviations() const { return deviations_; }
  const std::map<MeasuredQuantity, double>& estimated() const { return estimated_; }

  struct Outcome {
    bool converged = false;
    std::string message;
    double cost = infinity;  ///< sum of rho(r^2)
    std::vector<double> x;
  };

  /// Minimises over the parameters in `free` from x, at the present deviations.
  Outcome solve(std::vector<double> x, const std::vector<std::size_t>& free, int iterations = 100) {
    Outcome outcome;
    if (free.empty()) {
      outcome.converged = true;
      outcome.message = "nothing to fit";
      outcome.x = x;
      bench_.evaluate(x, false);
      outcome.cost = cost();
      return outcome;
    }
    // From 0 at the lower bound to 1 at the upper one.
    std::vector<double> scaled(free.size());
    for (std::size_t k = 0; k < free.size(); ++k) {
      const FreeParameter& p = fit_.parameters[free[k]];
      scaled[k] = std::clamp((x[free[k]] - p.lower) / (p.upper - p.lower), 0.0, 1.0);
    }
    Callback callback{*this, x, free, scaled};
    ceres::Problem::Options problem_options;
    problem_options.evaluation_callback = &callback;
    ceres::Problem problem(problem_options);
    for (std::size_t o = 0; o < deviations_.size(); ++o) {
      problem.AddResidualBlock(new Residual(*this, free, o), loss(), scaled.data());
    }
    for (std::size_t k = 0; k < free.size(); ++k) {
      problem.SetParameterLowerBound(scaled.data(), int(k), 0.0);
      problem.SetParameterUpperBound(scaled.data(), int(k), 1.0);
    }
    const ceres::Solver::Options options = least_squares(iterations, 1e-9, 1e-9);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    outcome.x = callback.natural();
    bench_.evaluate(outcome.x, false);
    outcome.cost = cost();
    outcome.converged = summary.termination_type == ceres::CONVERGENCE;
    outcome.message = summary.message;
    return outcome;
  }

  /// Sum of rho(r^2) at the bench's present state.
  double cost() const {
    double sum = 0.0;
    const std::unique_ptr<ceres::LossFunction> rho(loss());
    for (std::size_t o = 0; o < deviations_.size(); ++o) {
      const double r = residual(o);
      double value[3] = {r * r, 1.0, 0.0};
      if (rho) rho->Evaluate(r * r, value);
      sum += value[0];
    }
    return sum;
  }
  /// Weight of a residual under the robust loss, rho'.
  double weight(std::size_t o) const {
    const std::unique_ptr<ceres::LossFunction> rho(loss());
    if (!rho) return 1.0;
    double value[3];
    rho->Evaluate(residual(o) * residual(o), value);
    return value[1];
  }
  double residual(std::size_t o) const {
    return (bench_.fitted()[o] - bench_.observations()[o].measured) / deviations_[o];
  }

  bool has_estimates() const {
    return std::any_of(fit_.deviations.begin(), fit_.deviations.end(),
                       [](const auto& d) { return d.second.kind == Deviation::Kind::estimated; });
  }

  /// Deviations from the present predictions; largest relative change of one.
  double renew_deviations(std::size_t free_count) {
    const auto& observations = bench_.observations();
    std::map<MeasuredQuantity, std::pair<double, int>> sums;
    int reached = 0;
    for (std::size_t o = 0; o < observations.size(); ++o) {
      if (!bench_.predictions()[observations[o].point].reached) continue;
      ++reached;
      const double error = bench_.fitted()[o] - observations[o].measured;
      auto& [sum, count] = sums[observations[o].quantity];
      // A robust fit's outliers must not widen the rest.
      sum += weight(o) * error * error;
      ++count;
    }
    double change = 0.0;
    for (std::size_t o = 0; o < observations.size(); ++o) {
      const Deviation& d = deviation_of(observations[o].quantity);
      double next = deviations_[o];
      if (d.kind == Deviation::Kind::relative && bench_.predictions()[observations[o].point].reached) {
        next = d.value * std::abs(bench_.fitted()[o]);
      } else if (d.kind == Deviation::Kind::estimated) {
        const auto [sum, count] = sums[observations[o].quantity];
        // Each quantity pays its part of the parameters.
        const double freedom = count * (1.0 - double(free_count) / std::max(reached, 1));
        if (freedom > 0.5) next = std::sqrt(sum / freedom);
        estimated_[observations[o].quantity] = next;
      }
      next = std::max(next, 1e-12 * std::abs(observations[o].measured) + 1e-300);
      change = std::max(change, std::abs(next / deviations_[o] - 1.0));
      deviations_[o] = next;
    }
    return change;
  }

 private:
  const Deviation& deviation_of(const MeasuredQuantity& q) const { return fit_.deviations.at(q); }

  void first_deviations() {
    const auto& observations = bench_.observations();
    std::map<MeasuredQuantity, std::pair<double, int>> squares;
    for (const Observation& o : observations) {
      squares[o.quantity].first += o.measured * o.measured;
      ++squares[o.quantity].second;
    }
    for (std::size_t o = 0; o < observations.size(); ++o) {
      const Deviation& d = deviation_of(observations[o].quantity);
      const auto [sum, count] = squares[observations[o].quantity];
      const double typical = std::sqrt(sum / count);
      switch (d.kind) {
        case Deviation::Kind::absolute: deviations_[o] = d.value; break;
        case Deviation::Kind::relative: deviations_[o] = d.value * std::abs(observations[o].measured); break;
        case Deviation::Kind::estimated: deviations_[o] = 0.02 * (typical > 0.0 ? typical : 1.0); break;
      }
    }
  }

  ceres::LossFunction* loss() const {
    switch (fit_.loss) {
      case Loss::none: return nullptr;
      case Loss::huber: return new ceres::HuberLoss(fit_.loss_scale);
      case Loss::soft_l1: return new ceres::SoftLOneLoss(fit_.loss_scale);
      case Loss::cauchy: return new ceres::CauchyLoss(fit_.loss_scale);
    }
    return nullptr;
  }

  /// Computes the whole bench once for all residuals.
  struct Callback : ceres::EvaluationCallback {
    Callback(Fitter& f, std::vector<double> start, const std::vector<std::size_t>& which, std::vector<double>& s)
        : fitter(f), x(std::move(start)), free(which), scaled(s) {}
    void PrepareForEvaluation(bool jacobians, bool) override { fitter.bench_.evaluate(natural(), jacobians); }
    std::vector<double> natural() const {
      std::vector<double> all = x;
      for (std::size_t k = 0; k < free.size(); ++k) {
        const FreeParameter& p = fitter.fit_.parameters[free[k]];
        all[free[k]] = std::clamp(p.lower + scaled[k] * (p.upper - p.lower), p.lower, p.upper);
      }
      return all;
    }
    Fitter& fitter;
    std::vector<double> x;
    const std::vector<std::size_t>& free;
    std::vector<double>& scaled;
  };

  class Residual : public ceres::CostFunction {
   public:
    Residual(const Fitter& fitter, const std::vector<std::size_t>& free, std::size_t o)
        : fitter_(fitter), free_(free), o_(o) {
      set_num_residuals(1);
      mutable_parameter_block_sizes()->push_back(int(free.size()));
    }
    bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
      residuals[0] = fitter_.residual(o_);
      if (!std::isfinite(residuals[0])) return false;
      if (jacobians && jacobians[0]) {
        for (std::size_t k = 0; k < free_.size(); ++k) {
          const FreeParameter& p = fitter_.fit_.parameters[free_[k]];
          jacobians[0][k] = fitter_.bench_.jacobian()(Eigen::Index(o_), Eigen::Index(free_[k])) * (p.upper - p.lower) /
                            fitter_.deviations_[o_];
        }
      }
      return true;
    }

   private:
    const Fitter& fitter_;
    const std::vector<std::size_t>& free_;
    std::size_t o_;
  };

  const BenchFit& fit_;
  Bench bench_;
  std::vector<double> deviations_;
  std::map<MeasuredQuantity, double> estimated_;
};

void check(const BenchFit& fit) {
  std::set<std::string> keys;
  if (fit.logs.empty()) throw ParameterError("log", "missing: there is nothing to fit to");
  require(fit.starts >= 1 && fit.starts <= most_fit_starts, "fit.starts", "must lie between 1 and 1000", "1",
          fit.starts);
  for (const FreeParameter& p : fit.parameters) {
    if (!keys.insert(p.parameter.key).second) throw ParameterError(p.parameter.key, "is given twice");
    if (!(p.lower < p.upper)) throw ParameterError(p.parameter.key, "the lower bound must lie below the upper one");
    if (!(p.start >= p.lower && p.start <= p.upper)) {
      throw ParameterError(p.parameter.key, format("the start %.6g does not lie within the bounds %.6g to %.6g [%s]",
                                                   p.start, p.lower, p.upper, p.parameter.unit.c_str()));
    }
    for (const double x : {p.lower, p.upper, p.start}) {
      Design<double> design = fit.design;
      if (!p.parameter.set(design, x)) throw ParameterError(p.parameter.key, "has no place in this vehicle");
      validate(design);
    }
    if (p.parameter.key == "wing.count") throw ParameterError(p.parameter.key, "a whole number cannot be fitted");
    if (p.parameter.key.starts_with("supply.")) {
      throw ParameterError(p.parameter.key, "the logs state the supply, it cannot be fitted");
    }
    if (p.parameter.key == "motor.armature_inductance" && !(p.lower > 0.0)) {
      throw ParameterError(p.parameter.key, "the lower bound must be > 0: without inductance the equations change");
    }
  }
  // Alternatives replace each other: two of them cannot both be free.
  Design<double> all = fit.design;
  for (const FreeParameter& p : fit.parameters) p.parameter.set(all, p.start);
  for (const FreeParameter& p : fit.parameters) {
    if (p.parameter.value(all) != p.start) {
      throw ParameterError(p.parameter.key, "another free parameter takes its place in the vehicle");
    }
  }
  if (fit.design.supply.type != SupplyType::constant && fit.design.transmission.type != TransmissionType::direct) {
    throw ParameterError("supply.type", "bench data are fitted with a constant supply");
  }
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

/// Scale of relative changes of a parameter.
double scale_of(const FreeParameter& p, double value) { return value != 0.0 ? std::abs(value) : p.upper - p.lower; }

/// The Fisher information of some observations in relative parameter changes.
Eigen::MatrixXd information(const Fitter& fitter, const Bench& bench, const std::vector<double>& scales,
                            const std::function<bool(const OperatingPoint&)>& counts) {
  const Eigen::Index n = Eigen::Index(scales.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t o = 0; o < bench.observations().size(); ++o) {
    const std::size_t point = bench.observations()[o].point;
    if (!bench.predictions()[point].reached || !counts(bench.points()[point])) continue;
    Eigen::VectorXd row(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      row[k] = bench.jacobian()(Eigen::Index(o), k) * scales[std::size_t(k)] / fitter.deviations()[o];
    }
    sum += fitter.weight(o) * row * row.transpose();
  }
  return sum;
}

std::string direction_text(const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& v) {
  std::vector<std::pair<double, std::string>> parts;
  for (Eigen::Index k = 0; k < v.size(); ++k) {
    if (std::abs(v[k]) > 0.1) parts.emplace_back(v[k], parameters[std::size_t(k)].parameter.key);
  }
  std::sort(parts.begin(), parts.end(),
            [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  if (parts.size() == 2 && std::abs(std::abs(parts[0].first / parts[1].first) - 1.0) < 0.05) {
    const bool product = parts[0].first * parts[1].first < 0.0;
    return format("%s and %s, of which the data know only the %s", parts[0].second.c_str(), parts[1].second.c_str(),
                  product ? "product" : "ratio");
  }
  std::string text;
  const double sign = parts.empty() || parts[0].first > 0.0 ? 1.0 : -1.0;
  for (const auto& [part, key] : parts) {
    text += format("%s%s %+.2f", text.empty() ? "" : ", ", key.c_str(), sign * part);
  }
  return text;
}

void judge(const BenchFit& fit, Fitter& fitter, const std::vector<double>& x, FitResult& result) {
  Bench& bench = fitter.bench();
  bench.evaluate(x, true);
  const Eigen::Index count = Eigen::Index(fit.parameters.size());
  std::vector<double> scales(fit.parameters.size());
  for (std::size_t k = 0; k < scales.size(); ++k) scales[k] = scale_of(fit.parameters[k], x[k]);
  const auto every = [](const OperatingPoint&) { return true; };
  const Eigen::MatrixXd all = information(fitter, bench, scales, every);

  // Without influence: even with all others known the bounds say more.
  std::vector<bool> silent(std::size_t(count), false), loose(std::size_t(count), false);
  for (Eigen::Index k = 0; k < count; ++k) {
    const FreeParameter& p = fit.parameters[std::size_t(k)];
    const double alone = all(k, k) > 0.0 ? scales[std::size_t(k)] / std::sqrt(all(k, k)) : infinity;
    silent[std::size_t(k)] = !(alone < p.upper - p.lower);
  }
  std::vector<Eigen::Index> audible;
  for (Eigen::Index k = 0; k < count; ++k) {
    if (!silent[std::size_t(k)]) audible.push_back(k);
  }
  const Eigen::Index m = Eigen::Index(audible.size());
  const auto restricted = [&](const Eigen::MatrixXd& full) {
    Eigen::MatrixXd part(m, m);
    for (Eigen::Index a = 0; a < m; ++a) {
      for (Eigen::Index b = 0; b < m; ++b) part(a, b) = full(audible[std::size_t(a)], audible[std::size_t(b)]);
    }
    return part;
  };
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Constant(count, count, absent);
  std::vector<std::string> free_directions, rough_directions;
  if (m > 0) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(restricted(all));
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(m, m);
    for (Eigen::Index d = m - 1; d >= 0; --d) {
      const double lambda = eigen.eigenvalues()[d];
      const double noise = 1e-14 * std::max(eigen.eigenvalues()[m - 1], 0.0);
      const double error = lambda > noise ? 1.0 / std::sqrt(lambda) : infinity;
      Eigen::VectorXd full = Eigen::VectorXd::Zero(count);
      for (Eigen::Index a = 0; a < m; ++a) full[audible[std::size_t(a)]] = eigen.eigenvectors()(a, d);
      result.directions.push_back({{full.data(), full.data() + count}, error});
      if (error > free_error) {
        for (Eigen::Index k = 0; k < count; ++k) {
          if (std::abs(full[k]) > 0.1) loose[std::size_t(k)] = true;
        }
        free_directions.push_back(direction_text(fit.parameters, full) +
                                  (std::isfinite(error) ? format(" (uncertain by %.0f %%)", 100.0 * error) : ""));
      } else {
        if (error > rough_error) {
          rough_directions.push_back(direction_text(fit.parameters, full) + format(" (%.0f %%)", 100.0 * error));
        }
        inverse += error * error * eigen.eigenvectors().col(d) * eigen.eigenvectors().col(d).transpose();
      }
    }
    for (Eigen::Index a = 0; a < m; ++a) {
      for (Eigen::Index b = 0; b < m; ++b) {
        const Eigen::Index i = audible[std::size_t(a)], j = audible[std::size_t(b)];
        covariance(i, j) = inverse(a, b) * scales[std::size_t(i)] * scales[std::size_t(j)];
      }
    }
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    if (!loose[std::size_t(k)]) continue;
    covariance.row(k).setConstant(absent);
    covariance.col(k).setConstant(absent);
  }

  int reached = 0;
  for (std::size_t o = 0; o < bench.observations().size(); ++o) {
    reached += bench.predictions()[bench.observations()[o].point].reached;
  }
  result.degrees_of_freedom = reached - int(m);
  const double quantile = fitter.has_estimates() ? student_95(result.degrees_of_freedom) : normal_95;
  for (std::size_t k = 0; k < std::size_t(count); ++k) {
    const FreeParameter& p = fit.parameters[k];
    FittedParameter f;
    f.key = p.parameter.key;
    f.unit = p.parameter.unit;
    f.kept = x[k];
    const double range = p.upper - p.lower;
    f.at_bound = x[k] - p.lower < 1e-6 * range || p.upper - x[k] < 1e-6 * range;
    if (silent[k]) {
      f.reason = "no measured quantity depends on it";
      f.kept = p.start;
    } else if (loose[k]) {
      f.reason = "the data leave it free together with others";
    } else {
      f.value = x[k];
      f.standard_error = std::sqrt(covariance(Eigen::Index(k), Eigen::Index(k)));
      f.lower_95 = std::max(x[k] - quantile * f.standard_error, p.lower);
      f.upper_95 = std::min(x[k] + quantile * f.standard_error, p.upper);
    }
    result.parameters.push_back(f);
  }
  result.covariance.assign(std::size_t(count), std::vector<double>(std::size_t(count), absent));
  result.correlation = result.covariance;
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b) {
      result.covariance[std::size_t(a)][std::size_t(b)] = covariance(a, b);
      result.correlation[std::size_t(a)][std::size_t(b)] =
          covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
    }
  }

  // What each condition contributes.
  std::vector<std::pair<Condition, bool>> conditions;
  for (const OperatingPoint& p : bench.points()) {
    const std::pair<Condition, bool> c{p.condition, p.springs};
    if (std::find(conditions.begin(), conditions.end(), c) == conditions.end()) conditions.push_back(c);
  }
  for (const auto& [condition, springs] : conditions) {
    const auto of_this = [&, c = condition, s = springs](const OperatingPoint& p) {
      return p.condition == c && p.springs == s;
    };
    ConditionShare share;
    share.name = condition_name(condition, springs);
    const Eigen::MatrixXd own = information(fitter, bench, scales, of_this);
    for (Eigen::Index k = 0; k < count; ++k) share.share.push_back(all(k, k) > 0.0 ? own(k, k) / all(k, k) : 0.0);
    share.error_without.assign(std::size_t(count), infinity);
    if (m > 0) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> rest(restricted(all - own));
      for (Eigen::Index a = 0; a < m; ++a) {
        double variance = 0.0;
        for (Eigen::Index d = 0; d < m; ++d) {
          const double component = rest.eigenvectors()(a, d), lambda = rest.eigenvalues()[d];
          const double noise = 1e-12 * std::max(rest.eigenvalues()[m - 1], 0.0);
          if (lambda <= noise ? std::abs(component) > 1e-4 : component * component / lambda > free_error * free_error) {
            variance = infinity;
          } else if (lambda > noise) {
            variance += component * component / lambda;
          }
        }
        const std::size_t k = std::size_t(audible[std::size_t(a)]);
        share.error_without[k] = scales[k] * std::sqrt(variance);
      }
    }
    double squares = 0.0;
    for (std::size_t o = 0; o < bench.observations().size(); ++o) {
      const std::size_t point = bench.observations()[o].point;
      if (!bench.predictions()[point].reached || !of_this(bench.points()[point])) continue;
      squares += fitter.residual(o) * fitter.residual(o);
      ++share.points;
    }
    share.rms = share.points > 0 ? std::sqrt(squares / share.points) : absent;
    result.conditions.push_back(share);
  }

  // In words.
  const auto list = [&](const auto& condition) {
    std::string text;
    for (std::size_t k = 0; k < std::size_t(count); ++k) {
      if (condition(k)) text += (text.empty() ? "" : ", ") + fit.parameters[k].parameter.key;
    }
    return text;
  };
  const std::string without = list([&](std::size_t k) { return silent[k]; });
  if (!without.empty()) {
    result.verdict.push_back("not identifiable, no measured quantity depends on it: " + without +
                             "; no number is returned, the vehicle keeps the start value");
  }
  for (const std::string& d : free_directions) result.verdict.push_back("left free by the data: " + d);
  for (const std::string& d : rough_directions) result.verdict.push_back("known only roughly: " + d);
  if (free_directions.empty() && m > 0) {
    double strongest = 0.0;
    std::string pair;
    for (Eigen::Index a = 0; a < count; ++a) {
      for (Eigen::Index b = 0; b < a; ++b) {
        const double r = result.correlation[std::size_t(a)][std::size_t(b)];
        if (!(std::abs(r) > std::abs(strongest))) continue;
        strongest = r;
        pair = fit.parameters[std::size_t(b)].parameter.key + " and " + fit.parameters[std::size_t(a)].parameter.key;
      }
    }
    const std::string known = list([&](std::size_t k) { return result.parameters[k].value.has_value(); });
    std::string sentence = "the data determine " + known;
    if (!pair.empty()) sentence += format("; most alike are %s (correlation %+.2f)", pair.c_str(), strongest);
    result.verdict.push_back(sentence);
  }
  for (const ConditionShare& c : result.conditions) {
    if (result.conditions.size() < 2) break;
    std::string lost, wider;
    for (std::size_t k = 0; k < std::size_t(count); ++k) {
      const FittedParameter& p = result.parameters[k];
      if (!p.value) continue;
      if (!std::isfinite(c.error_without[k])) {
        lost += (lost.empty() ? "" : ", ") + p.key;
      } else if (c.error_without[k] > 2.0 * p.standard_error) {
        wider +=
            format("%s%s %.1f times", wider.empty() ? "" : ", ", p.key.c_str(), c.error_without[k] / p.standard_error);
      }
    }
    if (!lost.empty()) result.verdict.push_back("only " + c.name + " determines " + lost);
    if (!wider.empty()) result.verdict.push_back("without " + c.name + " the intervals would be wider: " + wider);
  }
  if (std::any_of(fit.parameters.begin(), fit.parameters.end(),
                  [](const auto& p) { return p.parameter.key == "friction.radius"; })) {
    result.verdict.push_back(
        "friction.radius is the product mu r_e: no measurement of this kind separates mu from r_e");
  }
}

/// Profile of parameter k: -2 ln L with k fixed, the others free, until it has risen by the square of the quantile.
void profile(const BenchFit& fit, Fitter& fitter, const std::vector<double>& best, double least,
             const std::vector<std::size_t>& free, std::size_t k, double quantile, FittedParameter& out) {
  const FreeParameter& p = fit.parameters[k];
  std::vector<std::size_t> others;
  for (const std::size_t f : free) {
    if (f != k) others.push_back(f);
  }
  const auto excess = [&](double value, std::vector<double>& x) {
    x[k] = value;
    const Fitter::Outcome outcome = fitter.solve(x, others, 30);
    x = outcome.x;
    const double rise = std::max(outcome.cost - least, 0.0);
    out.profile.push_back({value, rise});
    return std::sqrt(rise);
  };
  for (const int side : {-1, 1}) {
    const double bound = side < 0 ? p.lower : p.upper;
    double& end = side < 0 ? out.profile_lower_95 : out.profile_upper_95;
    std::vector<double> x = best;
    double inner = best[k], inner_root = 0.0, outer = absent, outer_root = absent;
    double next = best[k] + side * quantile * out.standard_error;
    for (int iteration = 0; iteration < 12; ++iteration) {
      const bool clipped = side * (next - bound) >= 0.0;
      if (clipped) next = bound;
      const double root = excess(next, x);
      if (std::abs(root - quantile) < 0.01 * quantile) {
        end = next;
        break;
      }
      if (root < quantile) {
        inner = next, inner_root = root;
        if (clipped) {
          end = bound;  // the likelihood does not end the interval, the bound does
          break;
        }
      } else {
        outer = next, outer_root = root;
      }
      if (std::isfinite(outer)) {
        next = inner + (outer - inner) * (quantile - inner_root) / (outer_root - inner_root);
      } else {
        next = best[k] + (inner - best[k]) * std::clamp(quantile / std::max(inner_root, 1e-9), 1.1, 3.0);
      }
    }
  }
  out.profile.push_back({best[k], 0.0});
  std::sort(out.profile.begin(), out.profile.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
}

void say(const std::function<void(const std::string&)>& progress, const std::string& text) {
  if (progress) progress(text);
}

/// Fits; `reweight` lets relative deviations follow the predictions.
FitResult run_fit(const BenchFit& fit, bool reweight, const std::function<void(const std::string&)>& progress) {
  check(fit);
  FitResult result;
  Fitter fitter(fit);
  Bench& bench = fitter.bench();
  std::vector<double> start;
  for (const FreeParameter& p : fit.parameters) start.push_back(p.start);

  // Parameters without any influence at the start stay out of the fit: the rest would drag them along.
  bench.evaluate(start, true);
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < start.size(); ++k) {
    if (bench.jacobian().col(Eigen::Index(k)).cwiseAbs().maxCoeff() > 0.0) free.push_back(k);
  }
  const LatinHypercube samples{std::uint64_t(std::max(fit.starts - 1, 1)), fit.seed};
  Fitter::Outcome best;
  std::vector<double> costs;
  for (int n = 0; n < fit.starts; ++n) {
    say(progress, format("start %d of %d", n + 1, fit.starts));
    std::vector<double> x = start;
    for (const std::size_t k : free) {
      if (n == 0) break;
      x[k] = fit.parameters[k].lower +
             samples(std::uint64_t(n - 1), k) * (fit.parameters[k].upper - fit.parameters[k].lower);
    }
    const Fitter::Outcome outcome = fitter.solve(x, free);
    costs.push_back(outcome.cost);
    if (n == 0 || outcome.cost < best.cost) best = outcome;
  }
  for (const double cost : costs) {
    const bool same = cost - best.cost < 1e-3 * (1.0 + best.cost);
    ++(same ? result.starts_converged : result.starts_elsewhere);
  }
  bench.evaluate(best.x, false);
  for (int round = 0; round < (fitter.has_estimates() ? 12 : reweight ? 2 : 0); ++round) {
    if (fitter.renew_deviations(free.size()) < 1e-3) break;
    best = fitter.solve(best.x, free);
  }
  result.converged = best.converged;
  result.message = best.message;

  judge(fit, fitter, best.x, result);
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
                             fitter.deviations()[o], fitter.weight(o)});
    if (!is_reached) continue;
    ++reached;
    result.chi_square += fitter.residual(o) * fitter.residual(o);
    log_deviations += 2.0 * std::log(fitter.deviations()[o]);
  }
  for (std::size_t n = 0; n < bench.points().size(); ++n) {
    const Prediction& p = bench.predictions()[n];
    if (!p.reached) result.unreached.push_back({bench.points()[n].log, bench.points()[n].row, p.status, p.detail});
  }
  for (const auto& [quantity, deviation] : fitter.estimated()) {
    if (fit.deviations.at(quantity).kind == Deviation::Kind::estimated) {
      result.estimated_deviations[quantity] = deviation;
    }
  }
  result.deviance = best.cost + log_deviations;
  const double k = double(free.size()) + double(result.estimated_deviations.size());
  result.aicc = reached > k + 1 ? result.deviance + 2.0 * k + 2.0 * k * (k + 1.0) / (reached - k - 1.0) : infinity;

  assess_misfit(fit, int(free.size()), result);
  if (!result.misfit.empty()) withdraw_intervals(result);
  if (fit.profiles && result.misfit.empty()) {
    const double quantile = fitter.has_estimates() ? student_95(result.degrees_of_freedom) : normal_95;
    std::vector<std::size_t> determined;
    for (const std::size_t f : free) {
      if (result.parameters[f].value) determined.push_back(f);
    }
    for (const std::size_t f : determined) {
      say(progress, "profile of " + result.parameters[f].key);
      profile(fit, fitter, best.x, best.cost, determined, f, quantile, result.parameters[f]);
    }
  }
  result.evaluations = bench.evaluations();
  return result;
}

double mean_friction_torque(const BenchFit& fit, double& speed) {
  Design<double> design = fit.design;
  for (const FreeParameter& p : fit.parameters) p.parameter.set(design, p.start);
  double torque = 0.0;
  int count = 0;
  speed = 0.0;
  for (const BenchLog& log : fit.logs) {
    if (log.condition == Condition::wingless || log.given != Given::voltage || log.rows.empty()) continue;
    Design<double> d = design;
    if (!log.springs) d.spring = {};
    d.supply.voltage = log.rows[log.rows.size() / 2].given;
    const SteadyFlapping s = find_steady_flapping(resolve(d, log.condition), {.stability = false});
    if (s.status != FlappingStatus::flapping) continue;
    const double omega = two_pi * s.metrics[Metric::frequency];
    torque += s.metrics[Metric::power_friction] / omega;
    speed += omega;
    ++count;
  }
  if (count > 0) speed /= count;
  return count > 0 ? torque / count : 0.0;
}

}  // namespace

const char* name_of(WaveformQuantity q) {
  constexpr const char* names[] = {"crank_speed", "current", "flapping_velocity", "lift", "rod_force", "motor_torque"};
  return names[int(q)];
}
const char* unit_of(WaveformQuantity q) {
  constexpr const char* units[] = {"rad/s", "A", "rad/s", "N", "N", "N m"};
  return units[int(q)];
}
std::string name_of(const MeasuredQuantity& q) {
  if (q.waveform) return std::string("instantaneous ") + name_of(q.quantity);
  return metric_info(q.metric).key;
}
const char* unit_of(const MeasuredQuantity& q) { return q.waveform ? unit_of(q.quantity) : metric_info(q.metric).unit; }

std::string condition_name(Condition condition, bool springs) {
  const char* name = name_of(condition);
  return springs ? std::string(name) + " with springs" : name;
}

FitResult fit_bench(const BenchFit& fit, const std::function<void(const std::string&)>& progress) {
  return run_fit(fit, true, progress);
}

std::vector<FrictionCandidate> compare_friction(const BenchFit& fit,
                                                const std::function<DesignParameter(const std::string&)>& parameter_of,
                                                const std::function<void(const std::string&)>& progress) {
  check(fit);
  const auto is_friction = [](const FreeParameter& p) { return p.parameter.key.starts_with("friction."); };
  const auto own = std::find_if(fit.parameters.begin(), fit.parameters.end(), is_friction);
  if (own == fit.parameters.end()) {
    throw ParameterError("parameter",
                         "a comparison of friction laws needs a free friction parameter, as friction.radius");
  }
  double speed = 0.0;
  const double torque = mean_friction_torque(fit, speed);
  std::vector<FrictionCandidate> candidates;
  for (const FrictionLaw law : {FrictionLaw::none, FrictionLaw::viscous, FrictionLaw::quadratic, FrictionLaw::constant,
                                FrictionLaw::load_proportional}) {
    say(progress, std::string("friction law ") + name_of(law));
    BenchFit trial = fit;
    trial.profiles = false;
    trial.design.friction.law = law;
    if (law == FrictionLaw::none) trial.design.friction.coefficient = 0.0;
    std::erase_if(trial.parameters, is_friction);
    if (law != FrictionLaw::none && law == fit.design.friction.law) {
      trial.design.friction.coefficient = own->start;
      trial.parameters.push_back(*own);
    } else if (law != FrictionLaw::none) {
      const char* key = law == FrictionLaw::viscous     ? "friction.damping"
                        : law == FrictionLaw::quadratic ? "friction.coefficient"
                        : law == FrictionLaw::constant  ? "friction.torque"
                                                        : "friction.radius";
      // The coefficient that gives the same mean torque where the logs lie.
      const double start = law == FrictionLaw::viscous             ? torque / speed
                           : law == FrictionLaw::quadratic         ? torque / (speed * speed)
                           : law == FrictionLaw::load_proportional ? 0.3 * fit.design.transmission.crank_radius
                                                                   : torque;
      if (!(start > 0.0)) continue;
      trial.design.friction.coefficient = start;
      const double most =
          law == FrictionLaw::load_proportional ? 2.0 * fit.design.transmission.crank_radius : 20.0 * start;
      trial.parameters.push_back({parameter_of(key), 0.0, most, start});
    }
    FrictionCandidate candidate;
    candidate.law = law;
    candidate.result = run_fit(trial, false, {});

    // Every condition predicted from the others.
    std::vector<std::pair<Condition, bool>> conditions;
    for (const BenchLog& log : fit.logs) {
      const std::pair<Condition, bool> c{log.condition, log.springs};
      if (std::find(conditions.begin(), conditions.end(), c) == conditions.end()) conditions.push_back(c);
    }
    double squares = 0.0;
    int count = 0;
    for (const auto& [condition, springs] : conditions) {
      if (conditions.size() < 2) break;
      BenchFit rest = trial, left = trial;
      std::erase_if(rest.logs,
                    [&, c = condition, s = springs](const auto& l) { return l.condition == c && l.springs == s; });
      std::erase_if(left.logs,
                    [&, c = condition, s = springs](const auto& l) { return l.condition != c || l.springs != s; });
      const FitResult without = run_fit(rest, false, {});
      // What the rest cannot determine at all comes from the whole: it is the friction law that is on trial.
      std::vector<double> x;
      for (std::size_t k = 0; k < without.parameters.size(); ++k) {
        x.push_back(without.parameters[k].value ? *without.parameters[k].value : candidate.result.parameters[k].kept);
      }
      Fitter predictor(left);
      predictor.bench().evaluate(x, false);
      double own_squares = 0.0;
      int own_count = 0;
      for (std::size_t o = 0; o < predictor.bench().observations().size(); ++o) {
        const Observation& at_o = predictor.bench().observations()[o];
        double deviation = predictor.deviations()[o];
        // Where deviations are estimated, those of the full fit by this law would flatter it: the given ones serve all.
        if (!predictor.bench().predictions()[at_o.point].reached) own_squares = infinity;
        const double r = (predictor.bench().fitted()[o] - at_o.measured) / deviation;
        own_squares += r * r;
        ++own_count;
      }
      candidate.left_out.emplace_back(condition_name(condition, springs), std::sqrt(own_squares / own_count));
      squares += own_squares;
      count += own_count;
    }
    candidate.prediction_error = count > 0 ? std::sqrt(squares / count) : absent;

    // The spring case.
    const bool has_spring = fit.design.spring.stiffness || fit.design.spring.resonance;
    std::vector<double> frequencies;  // in air, of which the middle one serves
    for (const FitPoint& p : candidate.result.points) {
      const BenchLog& log = fit.logs[p.log];
      if (log.condition != Condition::air || log.columns[p.column].waveform) continue;
      if (log.given == Given::frequency) frequencies.push_back(log.rows[p.row].given);
      if (log.columns[p.column].metric == Metric::frequency) frequencies.push_back(p.measured);
    }
    std::sort(frequencies.begin(), frequencies.end());
    const double frequency = frequencies.empty() ? 0.0 : frequencies[frequencies.size() / 2];
    if (has_spring && frequency > 0.0) {
      candidate.spring_frequency = frequency;
      for (const bool springs : {false, true}) {
        Design<double> design = candidate.result.design;
        if (!springs) design.spring = {};
        RunOptions options;
        options.frequency = frequency;
        options.allow_extrapolation = true;
        const RunResult run = run_design(design, options);
        if (run.status == FlappingStatus::flapping) {
          (springs ? candidate.power_springs_on : candidate.power_springs_off) = run.metrics[Metric::power_electrical];
        }
      }
    }
    candidates.push_back(std::move(candidate));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.result.aicc < b.result.aicc; });
  for (FrictionCandidate& c : candidates) c.aicc_excess = c.result.aicc - candidates.front().result.aicc;
  return candidates;
}

}  // namespace wingbeat
