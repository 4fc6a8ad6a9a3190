#include "wingbeat/cycle/orbit_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace wingbeat {
namespace {

using J = GradientJet;
constexpr int slots = gradient_first_slot + gradient_parameters;

/// The recorded lap with its switches where the signs change, and its repetition on dual numbers.
template <class System>
class Repetition {
 public:
  using Jets = decltype(std::declval<System>().template cast<J>());
  using Along = decltype(std::declval<System>().template cast<Jet<1>>());
  using State = typename System::State;
  using JetState = typename Jets::State;
  static constexpr int N = int(std::tuple_size_v<State>);
  static_assert(N <= gradient_first_slot);

  Repetition(const RecordedLap<System>& recorded, const Vehicle<J>& vehicle)
      : system_(recorded.system), lap_(recorded.lap), jets_(recorded.system.template cast<J>()) {
    jets_.vehicle = vehicle;
    sharpen();
    for (auto& constant : inductance_slots_) constant = false;
    if (!(recorded.system.vehicle.motor.armature_inductance > 0.0)) {
      for (int k = 0; k < slots; ++k) inductance_slots_[k] = vehicle.motor.armature_inductance.v[k] != 0.0;
    }
  }

  /// One lap from the orbit's start, its states in the first slots. False where the fixed point is singular.
  bool run() {
    JetState y;
    for (int n = 0; n < N; ++n) y[n] = J(lap_.steps.front().y[n], n);
    totals_.fill(J(0.0));
    starts_.reserve(lap_.steps.size());
    for (std::size_t at = 0; at < lap_.steps.size(); ++at) {
      const auto& step = lap_.steps[at];
      solver::carry_over<true>(jets_, lap_.steps, at, y, &totals_);
      starts_.push_back(y);
      const auto signs = solver::signs_of<Jets>(step);
      const auto first = jets_.template rates<true>(J(step.x), y, signs);
      const auto result = solver::take_step<true>(lap_.method, jets_, J(step.x), y, J(step.h), signs, first);
      for (std::size_t q = 0; q < totals_.size(); ++q) totals_[q] += result.dq[q];
      y = result.y;
    }
    // (I - M) dy/dp = dP/dp, one right-hand side per slot behind the states.
    for (int k = N; k < slots; ++k) {
      double matrix[N * N], change[N];
      for (int row = 0; row < N; ++row) {
        for (int column = 0; column < N; ++column) {
          matrix[row * N + column] = (row == column ? 1.0 : 0.0) - y[row].v[column];
        }
        change[row] = y[row].v[k];
      }
      if (!solver::solve_linear(N, matrix, change)) return false;
      for (int row = 0; row < N; ++row) start_change_[row][k] = change[row];
    }
    return true;
  }

  /// The total derivative: that of the start added, the slots of the states emptied.
  J total(J x) const {
    for (int k = N; k < slots; ++k) {
      for (int n = 0; n < N; ++n) x.v[k] += x.v[n] * start_change_[n][k];
      if (inductance_slots_[k]) x.v[k] = absent;
    }
    for (int n = 0; n < N; ++n) x.v[n] = 0.0;
    return x;
  }

  CycleIntegrals<J> integrals() const {
    CycleIntegrals<J> sums;
    for (std::size_t q = 0; q < sums.size(); ++q) sums[q] = total(totals_[q]);
    return sums;
  }

  CycleExtremes<J> extremes() const {
    CycleExtremes<J> peaks;
    peaks.fill(J(absent));
    const std::array<Place, extreme_count> places = locate();
    for (const Extreme e : System::extremes) {
      const auto c = std::size_t(e);
      const JetState y = state_at(places[c].step, places[c].x);
      const auto signs = solver::signs_of<Jets>(lap_.steps[places[c].step]);
      const Motion<J> m = jets_.motion(J(places[c].x), y, signs);
      peaks[c] = total(jets_.candidates(m, y, signs)[c]);
    }
    return peaks;
  }

  GradientInstant instant(double theta) const {
    std::size_t n = lap_.steps.size() - 1;
    while (n > 0 && lap_.steps[n].x > theta) --n;
    const JetState y = state_at(n, theta);
    const auto signs = solver::signs_of<Jets>(lap_.steps[n]);
    const Motion<J> m = jets_.motion(J(theta), y, signs);
    const Branch<J> branch = Jets::branch(signs);
    const J stroke_speed = branch.stroke * m.stroke_velocity;
    return {total(jets_.shaft_speed(y)),
            total(m.current),
            total(m.stroke_velocity),
            total(lift_force(jets_.vehicle.wings, stroke_speed, branch.pitching)),
            System::has_rod ? total(m.rod_force) : J(absent),
            total(m.motor_torque)};
  }

 private:
  struct Place {
    std::size_t step;
    double x;
  };
  struct Sample {
    double x;
    CycleExtremes<Jet<1>> value;  ///< with the derivative along the solution
  };

  JetState state_at(std::size_t step, double x) const {
    const auto& s = lap_.steps[step];
    if (x == s.x) return starts_[step];
    const auto signs = solver::signs_of<Jets>(s);
    const auto first = jets_.template rates<false>(J(s.x), starts_[step], signs);
    return solver::take_step<false>(lap_.method, jets_, J(s.x), starts_[step], J(x - s.x), signs, first).y;
  }

  /// The state with its derivative along the solution.
  static typename Along::State moving(const State& y, const State& dy) {
    typename Along::State state;
    for (int n = 0; n < N; ++n) {
      state[n].a = y[n];
      state[n].v[0] = dy[n];
    }
    return state;
  }

  /// Moves the step ends at which a sign flips onto the sign change, by Newton from the recorded place. Not those at
  /// fixed nodes (dead centres) and at jumps, which are where they belong.
  void sharpen() {
    constexpr std::size_t switches = std::tuple_size_v<typename System::Switches>;
    for (std::size_t n = 1; n < lap_.steps.size(); ++n) {
      auto& before = lap_.steps[n - 1];
      auto& after = lap_.steps[n];
      std::size_t flipped = switches;
      bool stays = false;
      for (std::size_t k = before.signs.size(); k-- > 0;) {
        if (before.signs[k] == after.signs[k]) continue;
        flipped = k;
        stays = stays || k >= switches || solver::jumps(system_, k);
      }
      if (flipped == switches || stays) continue;
      const auto rates = along_.template rates<false>(Jet<1>(after.x, 0), moving(after.y, after.first.dy),
                                                      solver::signs_of<Along>(after));
      const Jet<1> which = rates.switches[flipped];
      const double move = -which.a / which.v[0];
      if (!(std::abs(move) < 0.25 * std::min(before.h, after.h))) continue;
      before.h += move;
      after.x += move;
      after.h -= move;
      for (int i = 0; i < N; ++i) after.y[i] += move * after.first.dy[i];
    }
  }

  /// Where each extreme lies.
  std::array<Place, extreme_count> locate() const {
    constexpr int pieces = 4;
    std::array<Place, extreme_count> best{};
    std::array<double, extreme_count> highest;
    highest.fill(-std::numeric_limits<double>::infinity());
    struct Bracket {
      std::size_t step;
      double x0, d0, x1, d1, estimate;
    };
    std::array<std::vector<Bracket>, extreme_count> brackets;
    for (std::size_t n = 0; n < lap_.steps.size(); ++n) {
      const auto& step = lap_.steps[n];
      const bool last = n + 1 == lap_.steps.size();
      const State& y1 = last ? lap_.end : lap_.steps[n + 1].y;
      const State& dy1 = last ? lap_.steps.front().first.dy : lap_.steps[n + 1].first.dy;
      Sample before{};
      for (int k = 0; k <= pieces; ++k) {
        const double t = double(k) / pieces;
        Sample sample{step.x + t * step.h, {}};
        const State y = k == 0 ? step.y : solver::detail::hermite<System>(step.y, step.first.dy, y1, dy1, step.h, t);
        sample.value = candidates(n, sample.x, y);
        for (const Extreme e : System::extremes) {
          const auto c = std::size_t(e);
          const Jet<1>& v = sample.value[c];
          if ((k == 0) && v.a > highest[c]) {
            highest[c] = v.a;
            best[c] = {n, sample.x};
          }
          const Jet<1>& u = before.value[c];
          if (k == 0 || !(u.v[0] > 0.0 && v.v[0] <= 0.0)) continue;
          const double h = sample.x - before.x;
          const double t0 = u.v[0] / (u.v[0] - v.v[0]);
          brackets[c].push_back({n, before.x, u.v[0], sample.x, v.v[0], u.a + 0.5 * t0 * h * u.v[0]});
        }
        before = sample;
      }
    }
    for (const Extreme e : System::extremes) {
      const auto c = std::size_t(e);
      double top = highest[c];
      for (const Bracket& b : brackets[c]) top = std::max(top, b.estimate);
      for (Bracket b : brackets[c]) {
        if (b.estimate < top - 0.02 * std::abs(top)) continue;
        const auto& step = lap_.steps[b.step];
        // The zero of the slope by false position in the manner of Illinois.
        double x = b.x0, value = 0.0;
        int side = 0;
        for (int iteration = 0; iteration < 60; ++iteration) {
          const double previous = x;
          x = b.d0 - b.d1 > 0.0 ? b.x0 + (b.x1 - b.x0) * b.d0 / (b.d0 - b.d1) : 0.5 * (b.x0 + b.x1);
          const auto inside = solver::evaluate_inside<false>(system_, lap_, step, x);
          const Jet<1> at = candidates(b.step, x, inside.y)[c];
          value = at.a;
          if (std::abs(x - previous) < 1e-11 || at.v[0] == 0.0) break;
          if (at.v[0] > 0.0) {
            b.x0 = x, b.d0 = at.v[0];
            if (side == 1) b.d1 *= 0.5;
            side = 1;
          } else {
            b.x1 = x, b.d1 = at.v[0];
            if (side == -1) b.d0 *= 0.5;
            side = -1;
          }
        }
        if (value > highest[c]) {
          highest[c] = value;
          best[c] = {b.step, x};
        }
      }
    }
    return best;
  }

  CycleExtremes<Jet<1>> candidates(std::size_t n, double x, const State& y) const {
    const auto signs = solver::signs_of<Along>(lap_.steps[n]);
    const auto state = moving(y, system_.template rates<false>(x, y, lap_.steps[n].signs).dy);
    return along_.candidates(along_.motion(Jet<1>(x, 0), state, signs), state, signs);
  }

  System system_;
  solver::Lap<System> lap_;
  Jets jets_;
  Along along_ = system_.template cast<Jet<1>>();
  CycleIntegrals<J> totals_;
  std::vector<JetState> starts_;
  double start_change_[N][slots] = {};
  bool inductance_slots_[slots];
};

constexpr Metric peak_metrics[] = {Metric::current_peak,           Metric::lift_peak,           Metric::rod_force_peak,
                                   Metric::flapping_velocity_peak, Metric::angle_of_attack_min, Metric::crank_speed_min,
                                   Metric::crank_speed_max};

void make_absent(J& x) { x.v.setConstant(absent); }

template <class System>
OrbitGradient differentiate(const SteadyFlapping& orbit, const RecordedLap<System>& recorded,
                            const GradientVehicle& given, const GradientOptions& options) {
  Vehicle<J> vehicle = given.vehicle;
  vehicle.voltage.a = recorded.system.vehicle.voltage;
  vehicle.drive_frequency.a = recorded.system.vehicle.drive_frequency;
  // A direct drive's frequency is its supply's: no voltage follows it, and its slot is a third state's.
  const bool voltage_varies = vehicle.transmission == TransmissionType::slider_crank;
  if (voltage_varies) vehicle.voltage.v[gradient_voltage_slot] = 1.0;
  Repetition<System> lap(recorded, vehicle);
  OrbitGradient g;
  g.regular = lap.run();
  CycleExtremes<J> extremes;
  extremes.fill(J(absent));
  if (options.peaks) extremes = lap.extremes();
  g.metrics = cycle_metrics(vehicle, lap.integrals(), extremes, J(orbit.metrics[Metric::floquet_multiplier_max]), {});
  const J bench = voltage_varies ? given.bench_torque_constant : J(absent);
  g.metrics[Metric::power_motor_reference] =
      two_pi * bench * g.metrics[Metric::frequency] * g.metrics[Metric::current_mean];
  g.metrics[Metric::lift_to_weight] = g.metrics[Metric::lift_mean] / (given.mass * standard_gravity);
  for (const double theta : options.crank_angles) g.instants.push_back(lap.instant(theta));

  if (options.held == Held::frequency && voltage_varies) {
    const J f = g.metrics[Metric::frequency];
    if (!(std::abs(f.v[gradient_voltage_slot]) > 0.0)) g.regular = false;
    const auto follow = [&](J& x) {
      for (int k = gradient_first_slot; k < slots; ++k) {
        x.v[k] -= x.v[gradient_voltage_slot] * f.v[k] / f.v[gradient_voltage_slot];
      }
      x.v[gradient_voltage_slot] = 0.0;
    };
    for (J& m : g.metrics.values) follow(m);
    for (GradientInstant& at : g.instants) {
      for (J* x : {&at.crank_speed, &at.current, &at.flapping_velocity, &at.lift, &at.rod_force, &at.motor_torque}) {
        follow(*x);
      }
    }
  }
  make_absent(g.metrics[Metric::floquet_multiplier_max]);
  if (!options.peaks) {
    for (const Metric m : peak_metrics) g.metrics[m] = J(orbit.metrics[m]), make_absent(g.metrics[m]);
  }
  // A value is the orbit's own, to the last digit.
  for (int m = 0; m < metric_count; ++m) g.metrics.values[std::size_t(m)].a = orbit.metrics.values[std::size_t(m)];
  return g;
}

}  // namespace

GradientVehicle gradient_vehicle(const Design<GradientJet>& design, Condition condition) {
  GradientVehicle v;
  v.vehicle = resolve(design, condition);
  if (const auto mass = total_mass(design)) v.mass = *mass;
  if (design.bench_torque_constant) v.bench_torque_constant = *design.bench_torque_constant;
  return v;
}

OrbitGradient orbit_gradient(const SteadyFlapping& orbit, const GradientVehicle& vehicle,
                             const GradientOptions& options) {
  return std::visit([&](const auto& recorded) { return differentiate(orbit, recorded, vehicle, options); },
                    orbit.record.laps());
}

MetricGradients metric_gradients(const Design<double>& design, Condition condition, const SteadyFlapping& orbit,
                                 std::span<const DesignParameter> parameters, const GradientOptions& options) {
  MetricGradients result;
  result.by_parameter.resize(parameters.size());
  if (orbit.record.empty()) {  // a cycle simulated in time is no lap to be repeated
    result.regular = false;
    result.by_voltage.fill(absent);
    for (auto& gradient : result.by_parameter) gradient.fill(absent);
    return result;
  }
  const Design<GradientJet> plain = cast<GradientJet>(design);
  for (std::size_t first = 0; first == 0 || first < parameters.size(); first += gradient_parameters) {
    const std::size_t count = std::min<std::size_t>(gradient_parameters, parameters.size() - first);
    Design<GradientJet> seeded = plain;
    for (std::size_t k = 0; k < count; ++k) {
      const DesignParameter& p = parameters[first + k];
      const std::optional<double> value = p.value(design);
      if (!value || !p.set_jet(seeded, gradient_seed(*value, int(k)))) {
        throw ParameterError(p.key, "the vehicle does not have this parameter");
      }
    }
    const OrbitGradient g = orbit_gradient(orbit, gradient_vehicle(seeded, condition), options);
    result.regular = result.regular && g.regular;
    for (std::size_t m = 0; m < metric_count; ++m) {
      const auto& derivative = g.metrics.values[m].v;
      const bool direct = design.transmission.type == TransmissionType::direct;
      result.by_voltage[m] = direct ? absent : derivative[gradient_voltage_slot];
      for (std::size_t k = 0; k < count; ++k) {
        result.by_parameter[first + k][m] = derivative[gradient_first_slot + Eigen::Index(k)];
      }
    }
  }
  return result;
}

}  // namespace wingbeat
