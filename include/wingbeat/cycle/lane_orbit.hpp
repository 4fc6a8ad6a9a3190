// The orbits of many vehicles at once, one per lane, on meshes of fixed size.
//
// A lap runs from the lower dead centre through two half laps, on each of which the stroke velocity keeps its sign. The
// half laps' steps end where the rod force changes sign, which differs from lane to lane while the number of steps does
// not. Coarse laps find where, a medium lap corrects it, the fine lap integrates the metrics; lane_peaks.hpp holds the
// search for extremes. Everything is computed
// lane by lane without looking at the neighbours, so that a vehicle gets the same bits in any company.
#pragma once

#include <array>
#include <cmath>

#include "wingbeat/core/lanes.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/half_lap.hpp"
#include "wingbeat/cycle/lane_blocks.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/solve/explicit_step.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

inline constexpr int coarse_half_steps = 8;
inline constexpr int most_energy_extremes = 5;  ///< of the energy stored in wings and springs, within half a lap

/// Where the rod force changes sign within half a lap.
template <class L>
struct ForceSwitches {
  std::array<L, most_force_switches> at;  ///< [rad], growing; pi/2 beyond the count
  L count;
  L first_sign;  ///< sign of the rod force at the start
};

/// The steps of half a lap.
template <class L>
struct HalfMesh {
  std::array<L, most_half_steps + 1> u;
  std::array<L, most_half_steps> force;  ///< sign of the rod force on each step
};

/// Value and derivative by crank angle: |beta'| [rad/s], i [A], -omega and omega [rad/s], |F| [N], energy stored in wings
/// and springs [J].
template <class L>
struct Reading {
  L value, slope;
};

/// What the fine lap leaves at a node.
template <class L, int N>
struct LaneNode {
  std::array<L, N> y;
  L dip, dip_at;  ///< in the step from here: least stored moment by its sign at the start, and where
  std::array<Reading<L>, quantity_count> readings;
};

/// A stretch of a step in which a quantity rises from its start and falls towards its end.
template <class L, int N>
struct PeakBracket {
  L half, u, force;     ///< where the step begins, and its branch
  std::array<L, N> y;
  L x0, v0, d0;         ///< start: distance from u [rad], value, slope
  L x1, v1, d1;         ///< end
  L rises_and_falls;    ///< 1, or 0 where the larger end is all there is
  L estimate;
};

template <class L, int N>
class LaneOrbit {
  using State = std::array<L, N>;
  using Mask = wingbeat::Mask<L>;
  using System = HalfLap<L, N>;
  using Matrix = std::array<std::array<L, N>, N>;
  static constexpr double quarter = 0.5 * pi;
  static constexpr int coarse_samples = 2 * coarse_half_steps + 1;

 public:
  LaneOrbit(const Vehicle<L>& vehicle, const LaneSettings& settings) : vehicle_(vehicle), settings_(settings) {
    no_load_ = no_load_speed(vehicle);
    floor_ = L(1e-4) * no_load_;
    current_scale_ = vehicle.voltage / circuit_resistance(vehicle);
    wanted_ = settings.wanted;
    geometry_ = geometry_of(vehicle.crank);
    if constexpr (N == 2) per_inductance_ = L(1.0) / vehicle.motor.armature_inductance;
  }

  /// Metrics by one fine lap, after as many others as the settings ask for. `mass` [kg] and `bench_torque_constant`
  /// [N m/A] may be absent.
  Metrics<L> solve(const L& mass, const L& bench_torque_constant);

  // After solve():
  const L& error_estimate() const { return error_estimate_; }
  const Mask& doubtful() const { return doubtful_; }
  const Mask& locked() const { return locked_; }
  /// Calls visit(lanes, place), place(LapStart&) being where the number stands there, for all of where the next lap
  /// starts: to set it before solve(), or to keep it afterwards.
  template <class Visit>
  void visit_start(const Visit& visit) {
    for (std::size_t n = 0; n < N; ++n) visit(y_[n], [n](auto& start) -> double& { return start.state[n]; });
    for (std::size_t half = 0; half < 2; ++half) {
      ForceSwitches<L>& s = switches_[half];
      for (std::size_t n = 0; n < most_force_switches; ++n) {
        visit(s.at[n], [half, n](auto& start) -> double& { return start.switch_at[half][n]; });
      }
      visit(s.count, [half](auto& start) -> double& { return start.switch_count[half]; });
      visit(s.first_sign, [half](auto& start) -> double& { return start.first_sign[half]; });
    }
    for (std::size_t n = 0; n < N * N; ++n) {
      visit(monodromy_[n / N][n % N], [n](auto& start) -> double& { return start.monodromy[n]; });
    }
  }

 private:
  System half_lap(int half) const { return {vehicle_, geometry_, per_inductance_, L(half == 0 ? 1.0 : -1.0)}; }

  [[gnu::noinline, gnu::flatten]] void tabulate();
  [[gnu::noinline, gnu::flatten]] void judge_statics();
  [[gnu::noinline, gnu::flatten]] void guess_speed();
  [[gnu::noinline, gnu::flatten]] void start_from_rest();
  template <bool last>
  [[gnu::noinline, gnu::flatten]] void coarse_lap();
  [[gnu::noinline, gnu::flatten]] L find_switches(int half, const L* u, const L* force, int count);
  [[gnu::noinline, gnu::flatten]] void build_mesh(int half, int steps);
  [[gnu::noinline, gnu::flatten]] void advance(int half, int steps, L* force);
  [[gnu::noinline, gnu::flatten]] void medium_lap(int steps);
  [[gnu::noinline, gnu::flatten]] void fine_lap();
  [[gnu::noinline, gnu::flatten]] void visit_node(const System& system, const L& u, const L& force,
                                                  LaneNode<L, N>& node, const Place<L>& place,
                                                  solve::Rates<System>& first);
  [[gnu::noinline, gnu::flatten]] void read(const System& system, const L& u, const State& y, const L& force,
                                            const Motion<L>& m, const State& dy,
                                            const std::array<bool, quantity_count>& wanted,
                                            std::array<Reading<L>, quantity_count>& out) const;
  [[gnu::noinline, gnu::flatten]] PeakBracket<L, N> bracket(int half, Quantity quantity) const;
  [[gnu::noinline, gnu::flatten]] Reading<L> reading_inside(Quantity quantity, const PeakBracket<L, N>& b,
                                                            const L& x) const;
  template <class Visit>
  void for_each_stretch(int half, Quantity quantity, const L& floor, const Visit& visit) const;
  static void keep(const PeakBracket<L, N>& from, const Mask& where, PeakBracket<L, N>& to);
  static L estimate_peak(PeakBracket<L, N>& b);
  [[gnu::noinline, gnu::flatten]] L refine(Quantity quantity, const L& sign, PeakBracket<L, N> b) const;
  [[gnu::noinline, gnu::flatten]] L peak(Quantity quantity) const;
  [[gnu::noinline, gnu::flatten]] L exchanged_energy();
  [[gnu::noinline, gnu::flatten]] L lift_peak(const L& highest_velocity) const;
  [[gnu::noinline, gnu::flatten]] L floquet_multiplier(const State& start);
  template <bool quadratures>
  [[gnu::noinline, gnu::flatten]] void correct_for_offset(const System& system, const HalfMesh<L>& mesh,
                                                          std::size_t node, const StepSights<L>& sights);
  Matrix jacobian_at(const System& system, const Place<L>& place, const State& y, const State& rates,
                     const L& force);
  void append_to_monodromy(const Matrix& a, const Matrix& b, double h);
  [[gnu::noinline, gnu::flatten]] void accelerate(const State& start);
  L residual_weight() const;

  const Vehicle<L>& vehicle_;
  const LaneSettings& settings_;
  CrankGeometry<L> geometry_;
  L per_inductance_, current_scale_, no_load_, floor_;
  Matrix monodromy_;  ///< of a lap, to a few per cent
  std::array<std::array<Place<L>, coarse_samples>, 2> table_;
  State y_;
  Mask doubtful_, locked_;
  std::array<ForceSwitches<L>, 2> switches_{};
  std::array<HalfMesh<L>, 2> mesh_;
  std::array<std::array<LaneNode<L, N>, most_half_steps + 1>, 2> nodes_;
  std::array<L, lane_integrals.size()> integrals_;
  std::array<bool, quantity_count> wanted_;
  L slowest_, residual_, step_error_, switch_offset_;
  L overlooked_;  ///< depth to which the rod force has the wrong sign inside a step, of its largest magnitude
  L error_estimate_;
};

template <class L, int N>
void LaneOrbit<L, N>::tabulate() {
  for (int half = 0; half < 2; ++half) {
    const System system = half_lap(half);
    for (int k = 0; k < coarse_samples; ++k) {
      table_[std::size_t(half)][std::size_t(k)] = system.place(L(quarter * (2.0 * k / (coarse_samples - 1) - 1.0)));
    }
  }
}

/// Marks the lanes that could jam or lock: within a margin, for the table is coarse; static_balance() has the last word.
template <class L, int N>
void LaneOrbit<L, N>::judge_statics() {
  const Vehicle<L>& v = vehicle_;
  const L stall = stall_torque(v);
  doubtful_ = !(stall > breakaway_torque(v));
  locked_ = !doubtful_ && doubtful_;
  // From rest, locking shows by itself, and only jams on the way are left to be told from near ones.
  const bool from_rest = settings_.approach == LaneApproach::from_rest;
  const L inertia_margin(from_rest ? 0.05 : 0.3), lever_margin(from_rest ? 0.02 : 0.1);
  const bool springs = !from_rest && any<L>(v.spring.stiffness > L(0.0));
  for (const auto& half : table_) {
    for (const Place<L>& place : half) {
      const CrankKinematics<L>& k = place.kinematics;
      doubtful_ = doubtful_ || !(least_inertia(v, k) > inertia_margin * v.motor.inertia) ||
                  !(k.wing_lever > lever_margin * v.crank.hinge_offset);
      if (springs) {
        doubtful_ = doubtful_ || !(advance_torque(v, k, place.spring_moment, L(L(0.8) * stall)) > L(0.0));
      }
    }
  }
}

/// Starts at the balanced_speed(); more than one, or none, is doubtful.
template <class L, int N>
void LaneOrbit<L, N>::guess_speed() {
  constexpr int stride = 4, count = coarse_samples / stride;
  std::array<LoadPlace<L>, 2 * count> places;
  for (int n = 0; n < 2 * count; ++n) {
    const Place<L>& at = table_[std::size_t(n / count)][std::size_t(stride / 2 + stride * (n % count))];
    places[std::size_t(n)] = load_place(vehicle_, at.kinematics, at.spring_moment);
  }
  const BalancedSpeed<L> balanced = balanced_speed<L>(vehicle_, places);
  doubtful_ = doubtful_ || !(balanced.count == L(1.0));
  y_[0] = balanced.slowest;
  if constexpr (N == 2) y_[1] = algebraic_current(vehicle_, vehicle_.voltage, y_[0]);
}

/// From rest at crank angle zero, in time, by the classical fourth-order method: over the lower dead centre twice, where
/// the lap may begin. Lanes that come near standing still are doubtful, but for those that come to rest and stay.
template <class L, int N>
void LaneOrbit<L, N>::start_from_rest() {
  using Moving = std::array<L, N + 1>;  // crank angle, state
  const int steps_per_lap = settings_.start_up_steps;
  constexpr int most_laps = 24;
  // The kinks leave an error of the second order, which counts most where the crank almost stands still.
  const L slow_limit = L(1.92 / steps_per_lap) * no_load_;
  constexpr double end = 3.5 * pi;
  const L dt = L(two_pi / double(steps_per_lap)) * inverse_of(no_load_);
  const auto rates = [&](const Moving& x) {
    const L sine = sin(x[0]), cosine = cos(x[0]);
    System system = half_lap(0);
    State y;
    for (std::size_t n = 0; n < N; ++n) y[n] = x[n + 1];
    const CrankKinematics<L> k = crank_kinematics(geometry_, sine, cosine);
    system.half = sign_of(k.stroke_slope);
    const Motion<L> m = system.motion_on_its_branch(system.place_of(k), y);
    Moving r;
    r[0] = y[0];
    r[1] = m.crank_acceleration;
    if constexpr (N == 2) {
      r[2] = motor_loads(vehicle_.motor, m.voltage, y[1], y[0]).voltage_reserve * per_inductance_;
    }
    return r;
  };
  const auto moved = [](const Moving& x, const Moving& rate, const L& by) {
    Moving to;
    for (std::size_t n = 0; n <= N; ++n) to[n] = x[n] + by * rate[n];
    return to;
  };
  Moving x;
  x.fill(L(0.0));
  y_.fill(L(0.0));
  Mask done = L(1.0) < L(0.0), started = done, slow = done, stopped = done;
  L waited(0.0);  // steps at rest, or since the crank was slow: after a few laps' worth others must decide
  for (int n = 0; n < steps_per_lap * most_laps; ++n) {
    if (all<L>(done || stopped || waited > L(2.0 * steps_per_lap))) break;
    const Moving k1 = rates(x);
    const Moving k2 = rates(moved(x, k1, L(0.5) * dt));
    const Moving k3 = rates(moved(x, k2, L(0.5) * dt));
    const Moving k4 = rates(moved(x, k3, dt));
    Moving next;
    for (std::size_t j = 0; j <= N; ++j) {
      next[j] = x[j] + dt * L(1.0 / 6.0) * (k1[j] + L(2.0) * (k2[j] + k3[j]) + k4[j]);
    }
    // Friction holds a crank that has not started; it does not turn it backwards.
    const Mask held = !started && !(next[1] > L(0.0));
    next[0] = select<L>(held, x[0], next[0]);
    next[1] = select<L>(held, L(0.0), next[1]);
    started = started || next[1] > L(0.05) * no_load_;
    slow = slow || (started && !done && !(next[1] > slow_limit));
    waited = select<L>(slow || !started, waited + L(1.0), waited);
    const Mask stops = started && !done && !stopped && !(next[1] > L(0.0));
    const Mask arrives = !done && !stopped && next[0] >= L(end);
    const L part = (L(end) - x[0]) * inverse_of(max(L(next[0] - x[0]), L(1e-300)));
    for (std::size_t j = 0; j < N; ++j) y_[j] = select<L>(arrives, x[j + 1] + part * (next[j + 1] - x[j + 1]), y_[j]);
    done = done || arrives;
    stopped = stopped || stops;
    for (std::size_t j = 0; j <= N; ++j) x[j] = select<L>(stopped && !stops, x[j], next[j]);
  }
  // A crank that has come to rest where friction outweighs the drive, at the present current and at the one that it
  // settles to, stays.
  const L stall = stall_torque(vehicle_);
  const L sine = sin(x[0]), cosine = cos(x[0]);
  const CrankKinematics<L> k = crank_kinematics(geometry_, sine, cosine);
  const L N_k_beta = spring_moment(vehicle_, k);
  L margin = lock_margin(vehicle_, k, N_k_beta, stall);
  if constexpr (N == 2) {
    margin = min(margin, lock_margin(vehicle_, k, N_k_beta, L(vehicle_.motor.torque_constant * x[2])));
  }
  locked_ = stopped && !doubtful_ && margin > L(0.05) * stall;
  doubtful_ = doubtful_ || slow || !done;
}

/// Derivatives of the rates by the state, to four digits.
template <class L, int N>
auto LaneOrbit<L, N>::jacobian_at(const System& system, const Place<L>& place, const State& y, const State& rates,
                                  const L& force) -> Matrix {
  Matrix jacobian;
  for (std::size_t n = 0; n < N; ++n) {
    State moved = y;
    const L by = n == 0 ? L(1e-4) * y[0] : L(1e-4) * current_scale_;
    moved[n] = moved[n] + by;
    const State at = system.template rates_of<false>(system.motion(place, moved, force), moved, force).dy;
    const L per_move = inverse_of(by);
    for (std::size_t row = 0; row < N; ++row) jacobian[row][n] = (at[row] - rates[row]) * per_move;
  }
  return jacobian;
}

/// monodromy := exp(h (a + b) / 2) monodromy, the exponential by its (1, 1) Pade approximation.
template <class L, int N>
void LaneOrbit<L, N>::append_to_monodromy(const Matrix& a, const Matrix& b, double h) {
  const L quarter_h(0.25 * h);
  if constexpr (N == 1) {
    const L z = quarter_h * (a[0][0] + b[0][0]);
    monodromy_[0][0] = monodromy_[0][0] * (L(1.0) + z) * inverse_of(L(L(1.0) - z));
  } else {
    Matrix z;
    for (std::size_t row = 0; row < 2; ++row) {
      for (std::size_t column = 0; column < 2; ++column) z[row][column] = quarter_h * (a[row][column] + b[row][column]);
    }
    // (1 - z)^-1 (1 + z) m = 2 (1 - z)^-1 m - m
    const L p = L(1.0) - z[0][0], q = L(1.0) - z[1][1];
    const L twice_per_det = L(2.0) * inverse_of(L(p * q - z[0][1] * z[1][0]));
    for (std::size_t column = 0; column < 2; ++column) {
      const L m0 = monodromy_[0][column], m1 = monodromy_[1][column];
      monodromy_[0][column] = (q * m0 + z[0][1] * m1) * twice_per_det - m0;
      monodromy_[1][column] = (z[1][0] * m0 + p * m1) * twice_per_det - m1;
    }
  }
}

/// Moves the end of a lap from `start` to where the linearised lap map would settle: y += (1 - M)^-1 M (y - start).
template <class L, int N>
void LaneOrbit<L, N>::accelerate(const State& start) {
  const auto& M = monodromy_;
  if constexpr (N == 1) {
    y_[0] = y_[0] + M[0][0] * (y_[0] - start[0]) * inverse_of(L(L(1.0) - M[0][0]));
  } else {
    const L d0 = y_[0] - start[0], d1 = y_[1] - start[1];
    const L e0 = M[0][0] * d0 + M[0][1] * d1, e1 = M[1][0] * d0 + M[1][1] * d1;
    const L p = L(1.0) - M[0][0], q = L(1.0) - M[1][1];
    const L per_det = inverse_of(L(p * q - M[0][1] * M[1][0]));
    y_[0] = y_[0] + (q * e0 + M[0][1] * e1) * per_det;
    y_[1] = y_[1] + (M[1][0] * e0 + p * e1) * per_det;
  }
}

/// One lap by the classical fourth-order method, each stage on the branch that holds there; the last one finds the
/// switches and the monodromy matrix.
template <class L, int N>
template <bool last>
void LaneOrbit<L, N>::coarse_lap() {
  constexpr double h = pi / coarse_half_steps;
  const State start = y_;
  Matrix jacobian_before, first_jacobian;
  if constexpr (last) {
    for (std::size_t row = 0; row < N; ++row) {
      for (std::size_t column = 0; column < N; ++column) monodromy_[row][column] = L(row == column ? 1.0 : 0.0);
    }
  }
  slowest_ = y_[0];
  std::array<L, coarse_samples> angles;
  for (std::size_t k = 0; k < coarse_samples; ++k) angles[k] = L(quarter * (2.0 * double(k) / (coarse_samples - 1) - 1.0));
  for (int half = 0; half < 2; ++half) {
    const System system = half_lap(half);
    const auto& table = table_[std::size_t(half)];
    std::array<L, coarse_samples> force;
    const auto moved = [](const State& from, const State& slope, double by) {
      State to;
      for (std::size_t n = 0; n < N; ++n) to[n] = from[n] + L(by) * slope[n];
      return to;
    };
    for (std::size_t k = 0; k + 2 < coarse_samples; k += 2) {
      const auto at = [&](std::size_t sample, const State& y) {
        const Motion<L> m = system.motion_on_its_branch(table[sample], y);
        force[sample] = m.force_switch;
        return system.template rates_of<false>(m, y, L(1.0)).dy;
      };
      const State k1 = at(k, y_);
      if constexpr (last) {
        const Matrix jacobian = jacobian_at(system, table[k], y_, k1, sign_of(force[k]));
        if (half > 0 || k > 0) {
          append_to_monodromy(jacobian_before, jacobian, h);
        } else {
          first_jacobian = jacobian;
        }
        jacobian_before = jacobian;
      }
      const State k2 = at(k + 1, moved(y_, k1, 0.5 * h));
      const State k3 = at(k + 1, moved(y_, k2, 0.5 * h));
      const State k4 = at(k + 2, moved(y_, k3, h));
      for (std::size_t n = 0; n < N; ++n) {
        y_[n] = y_[n] + L(h / 6.0) * (k1[n] + L(2.0) * (k2[n] + k3[n]) + k4[n]);
      }
      slowest_ = min(slowest_, y_[0]);
    }
    if constexpr (last) find_switches(half, angles.data(), force.data(), coarse_samples - 1);
  }
  if constexpr (last) {
    append_to_monodromy(jacobian_before, first_jacobian, h);
    accelerate(start);
  }
  doubtful_ = doubtful_ || !(slowest_ > floor_);
}

/// Sign changes of the rod force between the samples force[0..count] at u[0..count] of half a lap, by parabolas. Returns
/// the largest distance from the switches known before [rad].
template <class L, int N>
L LaneOrbit<L, N>::find_switches(int half, const L* u, const L* force, int count) {
  ForceSwitches<L> found;
  found.at.fill(L(quarter));
  found.count = L(0.0);
  found.first_sign = sign_of(force[0]);
  for (int k = 0; k < count; ++k) {
    const L f0 = force[k], f1 = force[k + 1];
    const Mask changes = (f0 >= L(0.0) && f1 < L(0.0)) || (f0 < L(0.0) && f1 >= L(0.0));
    if (!any<L>(changes)) continue;
    // Of the two neighbours the nearer to the switch.
    const L h = u[k + 1] - u[k];
    const L rise = f1 - f0, per_rise = inverse_of(rise);
    const L straight = -(f0 * per_rise);
    L curve;
    const auto left = [&] {
      const L h0 = u[k] - u[k - 1];
      return (rise - (f0 - force[k - 1]) * h * inverse_of(h0)) * h * inverse_of(L(h + h0));
    };
    const auto right = [&] {
      const L h2 = u[k + 2] - u[k + 1];
      return ((force[k + 2] - f1) * h * inverse_of(h2) - rise) * h * inverse_of(L(h + h2));
    };
    if (k == 0) {
      curve = right();
    } else if (k + 1 == count) {
      curve = left();
    } else {
      curve = select<L>(straight < L(0.5), left(), right());
    }
    // f0 + rise t - curve t (1 - t) = 0, by two Newton steps.
    L t = straight + straight * (L(1.0) - straight) * curve * per_rise;
    for (int n = 0; n < 2; ++n) {
      const L value = f0 + rise * t - curve * t * (L(1.0) - t);
      const L slope = rise - curve * (L(1.0) - L(2.0) * t);
      t = t - value * inverse_of(slope);
    }
    t = select<L>(t >= L(0.0) && t <= L(1.0), t, min(max(straight, L(0.0)), L(1.0)));
    const L at = u[k] + h * t;
    for (int n = 0; n < most_force_switches; ++n) {
      found.at[std::size_t(n)] = select<L>(changes && found.count == L(double(n)), at, found.at[std::size_t(n)]);
    }
    found.count = select<L>(changes, found.count + L(1.0), found.count);
  }
  doubtful_ = doubtful_ || found.count > L(double(most_force_switches));
  ForceSwitches<L>& known = switches_[std::size_t(half)];
  L offset(0.0);
  for (std::size_t n = 0; n < most_force_switches; ++n) offset = max(offset, abs(found.at[n] - known.at[n]));
  known = found;
  return offset;
}

/// Steps of equal length between the switches, their number in proportion to the distance.
template <class L, int N>
void LaneOrbit<L, N>::build_mesh(int half, int steps) {
  const ForceSwitches<L>& s = switches_[std::size_t(half)];
  HalfMesh<L>& mesh = mesh_[std::size_t(half)];
  const L all(steps);
  std::array<L, most_force_switches + 2> node, at, per_step;
  node[0] = L(0.0);
  at[0] = L(-quarter);
  for (std::size_t n = 0; n < most_force_switches; ++n) {
    const Mask used = s.count > L(double(n));
    const L wanted = nearest_whole(L((s.at[n] + L(quarter)) * L(steps / pi)));
    const L within = min(max(wanted, node[n] + L(1.0)), all - (s.count - L(double(n))));
    node[n + 1] = select<L>(used, within, all);
    at[n + 1] = select<L>(used, s.at[n], L(quarter));
  }
  node[most_force_switches + 1] = all;
  at[most_force_switches + 1] = L(quarter);
  for (std::size_t n = 0; n <= most_force_switches; ++n) {
    per_step[n] = (at[n + 1] - at[n]) * inverse_of(max(L(node[n + 1] - node[n]), L(0.5)));
  }
  for (int m = 0; m <= steps; ++m) {
    const L here(m);
    L u = at[0] + per_step[0] * here;
    L force = s.first_sign;
    for (std::size_t n = 1; n <= most_force_switches; ++n) {
      const Mask beyond = here >= node[n] && node[n] < all;
      u = select<L>(beyond, at[n] + per_step[n] * (here - node[n]), u);
      force = select<L>(beyond, -force, force);
    }
    mesh.u[std::size_t(m)] = m == steps ? L(quarter) : u;
    if (m < steps) mesh.force[std::size_t(m)] = force;
  }
}

/// Where a node stands off the sign change it was meant for by d, the wrong branch has held, or will hold, over d. The
/// difference of the branches grows linearly from zero there, so that half of d times the difference at the node is the
/// error left behind, up to O(d^3).
template <class L, int N>
template <bool quadratures>
void LaneOrbit<L, N>::correct_for_offset(const System& system, const HalfMesh<L>& mesh, std::size_t node,
                                         const StepSights<L>& sights) {
  const L before = mesh.force[node - 1], after = mesh.force[node];
  const Mask switches = before * after < L(0.0);
  if (!any<L>(switches)) return;
  const Motion<L> motion_before = system.motion(sights.end, y_, before);
  const Motion<L> motion_after = system.motion(sights.end, y_, -before);
  const auto on_before = system.template rates_of<quadratures>(motion_before, y_, before);
  const auto on_after = system.template rates_of<quadratures>(motion_after, y_, -before);
  const L h = mesh.u[node] - mesh.u[node - 1];
  const L rest = L(1.0 - solve::dop853::c[late_stage]) * h;
  const L f = on_before.switches[0];
  const L offset = min(max(f * rest * inverse_of(L(f - sights.late_force_switch)), -h), h);
  const L half_offset = select<L>(switches, L(0.5) * offset, L(0.0));
  if constexpr (quadratures) {
    for (std::size_t q = 0; q < integrals_.size(); ++q) {
      integrals_[q] = integrals_[q] - half_offset * (on_before.dq[q] - on_after.dq[q]);
    }
    switch_offset_ = max(switch_offset_, L(2.0) * abs(half_offset));
  }
  y_[0] = y_[0] - half_offset * (on_before.dy[0] - on_after.dy[0]);
}

/// Half a lap on its mesh without integrals; force[0..steps] receives the switch values at the nodes.
template <class L, int N>
void LaneOrbit<L, N>::advance(int half, int steps, L* force) {
  solve::Rates<System> first;
  solve::StepResult<System> step;
  StepSights<L> sights;
  const System system = half_lap(half);
  const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
  sights.end = system.place(mesh.u[0]);
  for (std::size_t m = 0; m < std::size_t(steps); ++m) {
    evaluate<false>(system, sights.end, y_, mesh.force[m], first);
    force[m] = first.switches[0];
    lane_step<false>(system, mesh.u[m], y_, L(mesh.u[m + 1] - mesh.u[m]), mesh.force[m], first, step, sights);
    y_ = step.y;
    if (m + 1 < std::size_t(steps)) correct_for_offset<false>(system, mesh, m + 1, sights);
    slowest_ = min(slowest_, y_[0]);
  }
  evaluate<false>(system, sights.end, y_, mesh.force[std::size_t(steps - 1)], first);
  force[std::size_t(steps)] = first.switches[0];
}

/// A lap without integrals, which corrects the switches and closes in on the orbit.
template <class L, int N>
void LaneOrbit<L, N>::medium_lap(int steps) {
  const State start = y_;
  for (int half = 0; half < 2; ++half) {
    build_mesh(half, steps);
    std::array<L, most_half_steps + 1> force;
    advance(half, steps, force.data());
    find_switches(half, mesh_[std::size_t(half)].u.data(), force.data(), steps);
  }
  accelerate(start);
}

/// The readings wanted at a state, with the motion there.
template <class L, int N>
void LaneOrbit<L, N>::read(const System& system, const L& u, const State& y, const L& force, const Motion<L>& m,
                           const State& dy, const std::array<bool, quantity_count>& wanted,
                           std::array<Reading<L>, quantity_count>& out) const {
  const auto is_wanted = [&](Quantity q) { return wanted[std::size_t(q)]; };
  const auto at = [&](Quantity q) -> Reading<L>& { return out[std::size_t(q)]; };
  at(Quantity::velocity) = {system.half * m.stroke_velocity, system.half * m.stroke_acceleration * inverse_of(y[0])};
  at(Quantity::speed) = {y[0], dy[0]};
  at(Quantity::slowness) = {-y[0], -dy[0]};
  if constexpr (N == 2) {
    at(Quantity::current) = {y[1], dy[1]};
  } else {
    const L per_resistance = inverse_of(circuit_resistance(vehicle_));
    at(Quantity::current) = {m.current, -(vehicle_.motor.torque_constant * dy[0] * per_resistance)};
  }
  if (is_wanted(Quantity::energy)) {
    const L energy = wing_energy(vehicle_, m.kinematics, m.stroke_velocity);
    // At the dead centres the slope is zero but for rounding; its sign is that of the moment there.
    const L rising = sign_of(L(system.half * m.stored_moment));
    const L steepness = max(abs(L(m.stored_moment * m.kinematics.stroke_slope)), L(1e-30));
    at(Quantity::energy) = {energy, rising * steepness};
  }
  if (is_wanted(Quantity::force)) {
    // The slope along the solution by central differences.
    constexpr double by = 1e-4;
    L ahead[2];
    for (int side = 0; side < 2; ++side) {
      const L move(side == 0 ? -by : by);
      State moved;
      for (std::size_t n = 0; n < N; ++n) moved[n] = y[n] + move * dy[n];
      ahead[side] = system.motion(system.place(u + move), moved, force).rod_force;
    }
    at(Quantity::force) = {force * m.rod_force, force * (ahead[1] - ahead[0]) * L(0.5 / by)};
  }
}

/// Rates and readings at a node of the fine lap.
template <class L, int N>
void LaneOrbit<L, N>::visit_node(const System& system, const L& u, const L& force, LaneNode<L, N>& node,
                                 const Place<L>& place, solve::Rates<System>& first) {
  const Motion<L> motion = system.motion(place, y_, force);
  first = system.template rates_of<true>(motion, y_, force);
  node.y = y_;
  read(system, u, y_, force, motion, first.dy, wanted_, node.readings);
}

/// The largest modulus of the eigenvalues of the lap map's derivative, by central differences on the fine lap's mesh.
template <class L, int N>
L LaneOrbit<L, N>::floquet_multiplier(const State& start) {
  const State kept = y_;
  const L kept_slowest = slowest_;
  Matrix M;
  std::array<L, most_half_steps + 1> ignored;
  for (std::size_t column = 0; column < N; ++column) {
    const L by = column == 0 ? L(2e-4) * start[0] : L(2e-4) * current_scale_;
    std::array<State, 2> ends;
    for (std::size_t side = 0; side < 2; ++side) {
      y_ = start;
      y_[column] = y_[column] + (side == 0 ? -by : by);
      for (int half = 0; half < 2; ++half) advance(half, settings_.fine_steps, ignored.data());
      ends[side] = y_;
    }
    const L per_both = L(0.5) * inverse_of(by);
    for (std::size_t row = 0; row < N; ++row) M[row][column] = (ends[1][row] - ends[0][row]) * per_both;
  }
  y_ = kept;
  slowest_ = kept_slowest;
  if constexpr (N == 1) {
    return abs(M[0][0]);
  } else {
    const L mean = L(0.5) * (M[0][0] + M[1][1]), half_difference = L(0.5) * (M[0][0] - M[1][1]);
    const L determinant = M[0][0] * M[1][1] - M[0][1] * M[1][0];
    const L discriminant = square(half_difference) + M[0][1] * M[1][0];
    const L real = abs(mean) + sqrt(max(discriminant, L(0.0)));
    return select<L>(discriminant >= L(0.0), real, sqrt(max(determinant, L(0.0))));
  }
}

template <class L, int N>
void LaneOrbit<L, N>::fine_lap() {
  const int steps = settings_.fine_steps;
  const State start = y_;
  integrals_.fill(L(0.0));
  std::array<L, 5> error3, error5;
  error3.fill(L(0.0));
  error5.fill(L(0.0));
  switch_offset_ = L(0.0);
  solve::Rates<System> first;
  solve::StepResult<System> step;
  StepSights<L> sights;
  L overlooked(0.0), highest(0.0);
  for (int half = 0; half < 2; ++half) {
    const System system = half_lap(half);
    build_mesh(half, steps);
    const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
    auto& nodes = nodes_[std::size_t(half)];
    std::array<L, most_half_steps + 1> force;
    sights.end = system.place(mesh.u[0]);
    const auto visit = [&](std::size_t m, const L& sign) {
      visit_node(system, mesh.u[m], sign, nodes[m], sights.end, first);
      force[m] = first.switches[0];
      highest = max(highest, abs(force[m]));
    };
    for (std::size_t m = 0; m < std::size_t(steps); ++m) {
      visit(m, mesh.force[m]);
      const L h = mesh.u[m + 1] - mesh.u[m];
      lane_step<true>(system, mesh.u[m], y_, h, mesh.force[m], first, step, sights);
      for (std::size_t q = 0; q < integrals_.size(); ++q) integrals_[q] = integrals_[q] + step.dq[q];
      const L per_omega = inverse_of(y_[0]);
      error3[0] = error3[0] + abs(step.error3[0]) * per_omega;
      error5[0] = error5[0] + abs(step.error5[0]) * per_omega;
      for (std::size_t c = 0; c < System::controlled_integrals.size(); ++c) {
        const std::size_t q = System::controlled_integrals[c];
        error3[c + 1] = error3[c + 1] + abs(step.integral_error3[q]);
        error5[c + 1] = error5[c + 1] + abs(step.integral_error5[q]);
      }
      overlooked = max(overlooked, -step.lowest[0]);
      nodes[m].dip = step.lowest[1];
      nodes[m].dip_at = sights.dip_at;
      y_ = step.y;
      if (m + 1 < std::size_t(steps)) correct_for_offset<true>(system, mesh, m + 1, sights);
      slowest_ = min(slowest_, y_[0]);
    }
    visit(std::size_t(steps), mesh.force[std::size_t(steps - 1)]);
    switch_offset_ = max(switch_offset_, find_switches(half, mesh.u.data(), force.data(), steps));
  }
  overlooked_ = overlooked * inverse_of(max(highest, L(1e-300)));
  residual_ = abs(y_[0] - start[0]) * inverse_of(start[0]);
  if constexpr (N == 2) {
    residual_ = max(residual_, abs(y_[1] - start[1]) * inverse_of(L(abs(start[1]) + L(0.1) * current_scale_)));
  }
  // The embedded errors combined as DOP853 does, over the lap as a whole.
  step_error_ = L(0.0);
  for (std::size_t c = 0; c < error3.size(); ++c) {
    L scale(1.0);
    if (c > 0) scale = inverse_of(max(abs(integrals_[System::controlled_integrals[c - 1]]), L(1e-300)));
    const L e3 = error3[c] * scale, e5 = error5[c] * scale;
    const L combined = square(e5) * root_of(L(square(e5) + L(0.01) * square(e3) + L(1e-60))).inverse;
    step_error_ = max(step_error_, combined);
  }
}

/// What the means feel of a start off the orbit, which fades within the lap: the slower, the more.
template <class L, int N>
L LaneOrbit<L, N>::residual_weight() const {
  L size = abs(monodromy_[0][0]);
  if constexpr (N == 2) size = max(size, abs(L(monodromy_[0][0] + monodromy_[1][1])));
  return L(0.3) + L(2.5) * sqrt(size);
}

template <class L, int N>
Metrics<L> LaneOrbit<L, N>::solve(const L& mass, const L& bench_torque_constant) {
  if (settings_.approach == LaneApproach::resume) {
    doubtful_ = locked_ = L(1.0) < L(0.0);
    slowest_ = y_[0];
  } else {
    tabulate();
    judge_statics();
    if (settings_.approach == LaneApproach::guess) {
      guess_speed();
    } else {
      start_from_rest();
    }
    for (int n = 1; n < settings_.coarse_laps; ++n) coarse_lap<false>();
    coarse_lap<true>();
  }
  for (int n = 0; n < settings_.medium_laps; ++n) {
    const bool last = n + 1 == settings_.medium_laps;
    medium_lap(last || settings_.medium_steps < 6 ? settings_.medium_steps : 6);
  }
  const State start = y_;
  fine_lap();

  CycleIntegrals<L> integrals;
  integrals.fill(L(0.0));
  const auto total = [&](Integral which) -> L& { return integrals[std::size_t(which)]; };
  for (std::size_t q = 0; q < lane_integrals.size(); ++q) total(lane_integrals[q]) = integrals_[q];
  total(Integral::electrical_work) =
      vehicle_.voltage * total(Integral::current) - vehicle_.source_resistance * total(Integral::current_square);
  total(Integral::motor_work) =
      total(Integral::friction_work) + total(Integral::aero_work) + total(Integral::residual_work);
  const auto is_wanted = [&](Quantity q) { return wanted_[std::size_t(q)]; };
  if (is_wanted(Quantity::energy)) total(Integral::reactive_work) = exchanged_energy();

  CycleExtremes<L> extremes;
  extremes.fill(L(0.0));
  const auto seek = [&](Quantity quantity, Extreme extreme) {
    if (is_wanted(quantity)) extremes[std::size_t(extreme)] = peak(quantity);
  };
  seek(Quantity::velocity, Extreme::flapping_velocity);
  if (is_wanted(Quantity::velocity)) {
    extremes[std::size_t(Extreme::lift)] = lift_peak(extremes[std::size_t(Extreme::flapping_velocity)]);
  }
  seek(Quantity::current, Extreme::current);
  seek(Quantity::force, Extreme::rod_force);
  seek(Quantity::slowness, Extreme::crank_speed_min);
  seek(Quantity::speed, Extreme::crank_speed_max);
  const L multiplier = settings_.multipliers ? floquet_multiplier(start) : L(0.0);

  error_estimate_ = L(1.5) * step_error_ + residual_weight() * residual_ + L(0.03) * square(switch_offset_) +
                    overlooked_ * sqrt(overlooked_);
  doubtful_ = doubtful_ || !(slowest_ > floor_);
  accelerate(start);
  return cycle_metrics(vehicle_, integrals, extremes, multiplier, ReportingOf<L>{mass, bench_torque_constant});
}

}  // namespace wingbeat
