#include "wingbeat/flight/trim.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "wingbeat/core/text.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"

namespace wingbeat {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

/// Mean lift of all drives on a body at rest, where each has this voltage or amplitude [V]; absent where they do not
/// flap.
double lift_at(const FlightVehicle& v, double voltage) {
  double lift = 0.0;
  for (const FlightDrive& drive : v.drives) {
    Vehicle<double> at_rest = drive.vehicle;
    at_rest.wings.flow = nullptr;
    if (drive.supply.type == SupplyType::battery) set_mean_voltage(at_rest, voltage);
    else at_rest.voltage = voltage;
    const SteadyFlapping found = find_steady_flapping(at_rest);
    if (found.status != FlappingStatus::flapping) return absent;
    lift += found.metrics[Metric::lift_mean];
  }
  return lift;
}

/// The least voltage at which the lift carries the weight, about, or that with the largest lift below it.
double lifting_voltage(const FlightVehicle& v) {
  constexpr int parts = 24;
  const double weight = v.body.mass * standard_gravity;
  const double highest = v.ranges[std::size_t(FlightControl::voltage)].high;
  double before = absent, best = -infinity, best_at = v.stated_voltage;
  for (int n = 1; n <= parts; ++n) {
    const double voltage = highest * n / parts, lift = lift_at(v, voltage);
    if (lift >= weight) {
      if (!(before < weight)) return voltage;
      return voltage - highest / parts * (lift - weight) / (lift - before);
    }
    if (lift > best) best = lift, best_at = voltage;
    before = lift;
  }
  return best_at;
}

/// What is adjusted, and how its values are reported.
struct Unknown {
  enum class Kind { pitch, roll, control } kind;
  FlightControl control = FlightControl::voltage;
  double size = 1.0;  ///< of a step that changes the flight a little
};

/// Which of the six accelerations are to vanish: forces X, Y, Z, then moments.
using Equations = std::vector<std::size_t>;

class TrimProblem {
 public:
  TrimProblem(AveragedFlight& flight, const FlightCondition& condition)
      : flight_(flight), vehicle_(flight.vehicle()), condition_(condition) {
    symmetric_ = condition.turn_rate == 0.0 && sides_alike();
    unknowns_.push_back(
        {Unknown::Kind::control, FlightControl::voltage, 0.05 * std::max(vehicle_.stated_voltage, 0.1)});
    unknowns_.push_back({Unknown::Kind::pitch, FlightControl::voltage, 0.05});
    add_control(pitch_control(vehicle_));
    equations_ = {0, 2};
    if (unknowns_.size() == 3) equations_.push_back(4);
    if (symmetric_) return;
    unknowns_.push_back({Unknown::Kind::roll, FlightControl::voltage, 0.05});
    equations_.push_back(1);
    const std::size_t before = unknowns_.size();
    add_control(roll_control(vehicle_));
    if (unknowns_.size() > before) equations_.push_back(3);
    const std::size_t between = unknowns_.size();
    add_control(yaw_control(vehicle_));
    if (unknowns_.size() > between) equations_.push_back(5);
  }

  Eigen::Index count() const { return Eigen::Index(unknowns_.size()); }
  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  bool symmetric() const { return symmetric_; }
  /// Accelerations over gravity, moments over weight times reach.
  bool has_equation(std::size_t which) const {
    return std::find(equations_.begin(), equations_.end(), which) != equations_.end();
  }

  VectorXd start(const TrimResult* near) const {
    VectorXd x = VectorXd::Zero(count());
    for (Eigen::Index n = 0; n < count(); ++n) {
      const Unknown& u = unknowns_[std::size_t(n)];
      if (near && u.kind == Unknown::Kind::pitch) x[n] = near->pitch;
      if (near && u.kind == Unknown::Kind::roll) x[n] = near->roll;
      if (near && u.kind == Unknown::Kind::control) x[n] = near->controls[u.control];
    }
    if (!near) x[0] = lifting_voltage(vehicle_);
    return x;
  }
  void place(const VectorXd& x, TrimResult& result) const {
    result.roll = result.pitch = 0.0;
    result.controls = {};
    for (Eigen::Index n = 0; n < count(); ++n) {
      const Unknown& u = unknowns_[std::size_t(n)];
      if (u.kind == Unknown::Kind::pitch) result.pitch = x[n];
      else if (u.kind == Unknown::Kind::roll) result.roll = x[n];
      else result.controls[u.control] = x[n];
    }
  }
  /// All six accelerations, scaled; none where the vehicle does not flap.
  std::optional<VectorXd> accelerations(const VectorXd& x, TrimResult& result) const {
    place(x, result);
    const BodyState body = steady_body(condition_, result.roll, result.pitch);
    result.flight = flight_.at(result.controls, motion_of(body));
    if (!result.flight) return std::nullopt;
    const MeanAcceleration a = mean_acceleration(vehicle_.body, body, result.flight->loads);
    result.acceleration = a.linear, result.angular_acceleration = a.angular;
    const double arm = flight_.vehicle().drives[0].vehicle.wings.wake.strips.at.back().radius;
    const double per_moment = 1.0 / (vehicle_.body.mass * standard_gravity * arm);
    const Triple M = inertia_times(vehicle_.body, a.angular);
    VectorXd all(6);
    for (Eigen::Index k = 0; k < 3; ++k) {
      all[k] = a.linear[std::size_t(k)] / standard_gravity;
      all[k + 3] = M[std::size_t(k)] * per_moment;
    }
    return all;
  }
  VectorXd chosen(const VectorXd& all) const {
    VectorXd some{Eigen::Index(equations_.size())};
    for (std::size_t k = 0; k < equations_.size(); ++k) some[Eigen::Index(k)] = all[Eigen::Index(equations_[k])];
    return some;
  }

 private:
  bool sides_alike() const {
    if (vehicle_.drives.size() == 1) return true;
    const Vehicle<double>&a = vehicle_.drives[0].vehicle, &b = vehicle_.drives[1].vehicle;
    bool alike = true;
    std::vector<double> numbers;
    for_each_number(a, [&](const auto& x) { numbers.push_back(value_or_zero(x)); });
    std::size_t n = 0;
    for_each_number(b, [&](const auto& x) {
      const double y = value_or_zero(x);
      alike = alike && (numbers[n] == y || (std::isnan(y) && std::isnan(numbers[n])));
      ++n;
    });
    return alike;
  }
  static double value_or_zero(double x) { return x; }
  static double value_or_zero(const std::optional<double>& x) { return x.value_or(0.0); }

  void add_control(const std::optional<FlightControl>& which) {
    if (!which) return;
    const ControlRange& range = vehicle_.ranges[std::size_t(*which)];
    unknowns_.push_back({Unknown::Kind::control, *which, 0.1 * range.high});
  }

  AveragedFlight& flight_;
  const FlightVehicle& vehicle_;
  FlightCondition condition_;
  std::vector<Unknown> unknowns_;
  Equations equations_;
  bool symmetric_ = true;
};

std::string range_sentence(const FlightVehicle& vehicle, const FlightControls& controls) {
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    const ControlRange& range = vehicle.ranges[k];
    if (!range.given() || (controls.at[k] >= range.low && controls.at[k] <= range.high)) continue;
    return detail::format("%s would have to be %.4g %s, it goes from %.4g to %.4g", name_of(FlightControl(k)),
                          controls.at[k], flight_control_units[k], range.low, range.high);
  }
  return {};
}

}  // namespace

std::optional<FlightControl> pitch_control(const FlightVehicle& v) {
  for (const FlightControl which : {FlightControl::mean_stroke_angle, FlightControl::bias}) {
    if (v.has(which)) return which;
  }
  return std::nullopt;
}
std::optional<FlightControl> roll_control(const FlightVehicle& v) {
  for (const FlightControl which : {FlightControl::voltage_difference, FlightControl::incidence_difference}) {
    if (v.has(which)) return which;
  }
  return std::nullopt;
}
std::optional<FlightControl> yaw_control(const FlightVehicle& v) {
  for (const FlightControl which : {FlightControl::stroke_plane_difference, FlightControl::split_difference}) {
    if (v.has(which)) return which;
  }
  return std::nullopt;
}

BodyState steady_body(const FlightCondition& c, double roll, double pitch) {
  BodyState body;
  body.attitude = attitude_of({roll, pitch, 0.0});
  body.velocity = to_body(body.attitude, {c.speed, 0.0, -c.climb});
  body.rates = to_body(body.attitude, {0.0, 0.0, c.turn_rate});
  return body;
}

SteadyMotion motion_of(const BodyState& body) { return {body.velocity, body.rates}; }

MeanAcceleration mean_acceleration(const Body& body, const BodyState& state, const BodyLoads& loads) {
  const BodyState rates = body_rates(body, state, loads, standard_gravity);
  return {rates.velocity, rates.rates};
}

TrimResult trim(AveragedFlight& flight, const FlightCondition& condition, const TrimOptions& options,
                const TrimResult* near) {
  constexpr int max_iterations = 30;
  const TrimProblem problem(flight, condition);
  const FlightVehicle& vehicle = flight.vehicle();
  TrimResult result;
  result.condition = condition;
  VectorXd x = problem.start(near);
  std::optional<VectorXd> all = problem.accelerations(x, result);
  // A voltage at which it flaps.
  for (double factor = 1.5; !all && factor < 5.0; factor *= 1.5) {
    x = problem.start(near);
    x[0] *= factor;
    all = problem.accelerations(x, result);
  }
  const auto ends = [&](TrimStatus status, std::string sentence) {
    result.status = status;
    result.detail = std::move(sentence);
    return result;
  };
  if (!all) return ends(TrimStatus::does_not_flap, "the wings do not settle to a cycle at the stated voltage or above");
  double off = problem.chosen(*all).norm();
  for (int iteration = 0; iteration < max_iterations && off > options.tolerance; ++iteration) {
    MatrixXd slopes(problem.chosen(*all).size(), problem.count());
    TrimResult beside = result;
    bool known = true;
    for (Eigen::Index n = 0; n < problem.count() && known; ++n) {
      const double step = 0.02 * problem.unknowns()[std::size_t(n)].size;
      VectorXd next = x;
      next[n] += step;
      const std::optional<VectorXd> there = problem.accelerations(next, beside);
      known = there.has_value();
      if (known) slopes.col(n) = (problem.chosen(*there) - problem.chosen(*all)) / step;
    }
    if (!known) break;
    const VectorXd correction = slopes.completeOrthogonalDecomposition().solve(problem.chosen(*all));
    double longest = 0.0;
    for (Eigen::Index n = 0; n < problem.count(); ++n) {
      longest = std::max(longest, std::abs(correction[n]) / (6.0 * problem.unknowns()[std::size_t(n)].size));
    }
    double share = longest > 1.0 ? 1.0 / longest : 1.0;
    bool taken = false;
    for (int halving = 0; halving < 6 && !taken; ++halving, share *= 0.5) {
      TrimResult there = result;
      const VectorXd next = x - share * correction;
      if (!(next[0] > 0.0)) continue;
      const std::optional<VectorXd> at_next = problem.accelerations(next, there);
      if (!at_next) continue;
      const double off_next = problem.chosen(*at_next).norm();
      if (off_next > 0.98 * off) continue;
      x = next, all = at_next, off = off_next, result = there, taken = true;
    }
    if (!taken) break;
  }
  const Triple& a = result.acceleration;
  if (off > options.tolerance) {
    return ends(
        TrimStatus::untrimmable,
        detail::format("no settings found: %.3g, %.3g and %.3g m/s2 along x, y and z are left", a[0], a[1], a[2]));
  }
  // Moments that nothing acts on.
  const double weight = vehicle.body.mass * standard_gravity;
  for (const auto& [equation, axis] :
       {std::pair{std::size_t(3), "roll"}, {std::size_t(4), "pitch"}, {std::size_t(5), "yaw"}}) {
    if (problem.has_equation(equation)) continue;
    const double left = (*all)[Eigen::Index(equation)];
    if (std::abs(left) <= 1e3 * options.tolerance) continue;
    return ends(TrimStatus::untrimmable,
                detail::format("a moment of %s remains that the vehicle has no control for: %.3g N m, the weight of "
                               "%.3g N at %.3g mm",
                               axis, inertia_times(vehicle.body, result.angular_acceleration)[equation - 3], weight,
                               1e3 * inertia_times(vehicle.body, result.angular_acceleration)[equation - 3] / weight));
  }
  result.power = result.flight->electrical;
  result.frequency = 1.0 / result.flight->cycles[0].period;
  const std::string beyond = range_sentence(vehicle, result.controls);
  if (!beyond.empty()) return ends(TrimStatus::beyond_controls, beyond);
  return ends(TrimStatus::trimmed, "all mean accelerations vanish");
}

std::vector<TrimResult> trim_all(const FlightVehicle& vehicle, const std::vector<FlightCondition>& conditions,
                                 const TrimOptions& options) {
  AveragedFlight flight(vehicle, options.cycle);
  std::vector<TrimResult> results;
  std::optional<TrimResult> near;
  for (const FlightCondition& condition : conditions) {
    results.push_back(trim(flight, condition, options, near ? &*near : nullptr));
    if (results.back().flies()) near = results.back();
  }
  return results;
}

}  // namespace wingbeat
