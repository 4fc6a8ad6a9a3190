// The orbits of many vehicles at once, one per lane, by collocation on meshes of fixed size.
//
// An iterate runs from the lower dead centre through two half cycles, on each of which the stroke velocity keeps its
// sign. The half cycles' segments end where the rod force changes sign, which differs from lane to lane while the
// number of segments does not. Coarse iterates find where; an iterate with one step per segment gives a first
// trajectory and its derivatives; Newton's method makes it satisfy the equations at the Lobatto points of every
// segment, and the iterate its own end. Everything is computed lane by lane without looking at the neighbours, so that
// a vehicle gets the same bits in any batch.
//
// pack_start.hpp holds the way to the first trajectory, pack_mesh.hpp the segments, pack_newton.hpp Newton's method,
// pack_segment.hpp its step on a stiff segment, pack_lag.hpp the current behind an inductance, pack_peaks.hpp the
// search for extremes, pack_kinks.hpp coefficients with kinks, pack_multiplier.hpp the return map's derivative.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/pack.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/ensemble/half_cycle.hpp"
#include "wingbeat/ensemble/pack_blocks.hpp"
#include "wingbeat/ensemble/pack_lift.hpp"
#include "wingbeat/ensemble/pack_segment.hpp"
#include "wingbeat/solve/collocation.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

inline constexpr int coarse_half_steps = 8;
inline constexpr int max_energy_extremes = 5;  ///< of the energy stored in wings and springs, within half an iterate

/// Where the rod force changes sign within half an iterate.
template <class L>
struct ForceSwitches {
  std::array<L, max_force_switches> angle;  ///< u [rad], growing; the end of the half beyond the count
  L count;
  L first_sign;  ///< sign of the rod force at the start
};

/// The segments of half an iterate.
template <class L>
struct HalfMesh {
  std::array<L, max_half_segments + 1> u;
  std::array<L, max_half_segments> force;  ///< sign of the rod force on each segment
  std::array<L, max_half_segments> kink;   ///< sign of HalfCycle::kink_margin_at() there
};

/// Value and derivative by crank angle: |beta'| [rad/s], i [A], -omega and omega [rad/s], |F| [N], energy stored in
/// wings and springs [J].
template <class L>
struct Observable {
  L value, slope;
};

/// A subinterval between two nodes in which a quantity rises from its start and falls towards its end.
template <class L>
struct PeakBracket {
  L segment;          ///< of the iterate, counted from 0
  L x0, v0, d0;       ///< start: distance from the segment's start [rad], value, slope
  L x1, v1, d1;       ///< end
  L rises_and_falls;  ///< 1, or 0 where the larger end is all there is
  L estimate;
};

/// The trajectory of the state over one segment, another one in every lane.
template <class L, int N>
struct SegmentTrajectory {
  L half, u, length, force, kink;
  std::array<std::array<L, N>, solver::CollocationRule::max_points + 1> legendre;  ///< coefficients of the state
  std::array<L, solver::CollocationRule::max_points + 1> inductive_drop;           ///< and of HalfCycle::inductive_drop
};

template <class L, int N>
class PackOrbit {
  using State = std::array<L, N>;
  using Mask = wingbeat::Mask<L>;
  using System = HalfCycle<L, N>;
  using Matrix = std::array<std::array<L, N>, N>;
  static constexpr std::size_t nodes_per_segment = solver::CollocationRule::max_points;
  static constexpr std::size_t max_nodes = 2 * max_half_segments * nodes_per_segment;
  static constexpr int coarse_samples = 2 * coarse_half_steps + 1;

 public:
  PackOrbit(const Vehicle<L>& vehicle, const LaneMechanism<L>& mechanism, const PackSettings& settings)
      : vehicle_(vehicle),
        mechanism_(mechanism),
        settings_(settings),
        rule_(solver::collocation_rule(settings.intervals)),
        segments_(settings.segments) {
    no_load_ = no_load_speed(vehicle);
    floor_ = L(1e-4) * no_load_;
    per_resistance_ = L(1.0) / circuit_resistance(vehicle);
    current_scale_ = vehicle.voltage * per_resistance_;
    wanted_ = settings.wanted;
    const L stiffness = vehicle.wing_count * vehicle.spring.stiffness;
    compliance_ = select<L>(stiffness > L(0.0), L(0.5) / max(stiffness, L(1e-300)), L(0.0));
    loses_in_gear_ = has_gear_loss(vehicle.motor);
    kinks_ = loses_in_gear_ || kinks_on_lanes(vehicle.wings);
    has_knots_ =
        vehicle.wings.coefficients.table.from_tables || vehicle.transmission.type == TransmissionType::tabulated;
    adds_mass_ = any<L>(vehicle.wings.added_inertia > L(0.0));
    every_law_ = loses_in_gear_ || has_further_laws(vehicle.wings);
    in_one_piece_ = settings.in_one_piece;
    lags_ = N == 1 && settings.current == PackCurrent::lagging;
    if (N == 2 || lags_) per_inductance_ = L(1.0) / vehicle.motor.armature_inductance;
  }

  /// Metrics of the orbit. `mass` [kg] and `bench_torque_constant`
  /// [N m/A] may be absent.
  Metrics<L> solve(const L& mass, const L& bench_torque_constant);

  // After solve():
  const L& error_estimate() const { return error_estimate_; }
  const Mask& unresolved() const { return unresolved_; }
  const Mask& locked() const { return locked_; }
  /// A start from rest that comes so near to standstill that finer steps must tell what follows.
  const Mask& in_doubt() const { return in_doubt_; }
  /// Calls visit(lanes, place), place(IterateStart&) being where the number stands there, for all of where the next
  /// iterate starts: to set it before solve(), or to keep it afterwards.
  template <class Visit>
  void visit_start(const Visit& visit) {
    for (std::size_t n = 0; n < N; ++n) visit(y_[n], [n](auto& start) -> double& { return start.state[n]; });
    for (std::size_t list = 0; list < (kinks_ ? 4 : 2); ++list) {
      ForceSwitches<L>& s = list < 2 ? switches_[list] : kink_switches_[list - 2];
      for (std::size_t n = 0; n < max_force_switches; ++n) {
        visit(s.angle[n], [list, n](auto& start) -> double& { return start.switch_at[list][n]; });
      }
      visit(s.count, [list](auto& start) -> double& { return start.switch_count[list]; });
      visit(s.first_sign, [list](auto& start) -> double& { return start.first_sign[list]; });
    }
    for (std::size_t n = 0; n < N * N; ++n) {
      visit(monodromy_[n / N][n % N], [n](auto& start) -> double& { return start.monodromy[n]; });
    }
  }

 private:
  System half_cycle(int half) const {
    return {vehicle_,
            mechanism_,
            per_inductance_,
            per_resistance_,
            L(half == 0 ? 1.0 : -1.0),
            mechanism_.middle[std::size_t(half)],
            every_law_};
  }

  [[gnu::noinline, gnu::flatten]] void tabulate();
  [[gnu::noinline, gnu::flatten]] void assess_statics();
  [[gnu::noinline, gnu::flatten]] L guess_speed();
  [[gnu::noinline, gnu::flatten]] void start_from_rest();
  [[gnu::noinline]] void replace_stiff(const System& system, const Configuration<L>* over, const L& u, const L& h,
                                       const State& y, const Matrix& jacobian, const Mask& stiff, State& end,
                                       L& force_in_middle, L& force_at_end) const;
  [[gnu::noinline]] Matrix jacobian_on_its_branch(const System& system, const Configuration<L>& configuration,
                                                  const State& y, const State& rates) const;
  template <bool last>
  [[gnu::noinline, gnu::flatten]] void coarse_iterate();
  [[gnu::noinline, gnu::flatten]] L find_switches(ForceSwitches<L>& known, const L* u, const L* force, int count);
  [[gnu::noinline, gnu::flatten]] void build_mesh(int half);
  template <std::size_t max_ends, class Pass>
  void lay_segments(const std::array<L, max_ends>& place, const L& count, const L& reach, HalfMesh<L>& mesh,
                    const Pass& pass) const;
  [[gnu::noinline]] void build_mesh_with_kinks(int half);
  [[gnu::noinline]] void build_mesh_with_layers(int half);
  [[gnu::noinline]] L overlooked_kink(int half) const;
  [[gnu::noinline]] L overlooked_gear_kink(int half) const;
  [[gnu::noinline]] L error_of_peak_on_kink(const L& peak) const;
  [[gnu::noinline]] void march();
  [[gnu::noinline, gnu::flatten]] void place_nodes();
  /// The first one takes the derivatives along the trajectory, the last one integrals and observables.
  enum class Newton { first, middle, last };
  template <Newton which>
  [[gnu::noinline]] void newton_iteration();
  void iterate();
  [[gnu::noinline, gnu::flatten]] void follow_switches();
  static L misplaced(const L& by) { return L(0.15) * square(by); }
  [[gnu::noinline, gnu::flatten]] L dip_between_nodes(std::size_t base, const L& sign) const;
  template <bool renews>
  void propose(std::size_t base, const L& h, State& end, [[maybe_unused]] Matrix& whole) {
    if (in_one_piece_) {
      switch (rule_.intervals) {
        case 6: return propose_in_one_piece<6, renews>(base, h, end, whole);
        case 8: return propose_in_one_piece<8, renews>(base, h, end, whole);
        case 10: return propose_in_one_piece<10, renews>(base, h, end, whole);
        default: return propose_in_one_piece<0, renews>(base, h, end, whole);
      }
    }
    switch (rule_.intervals) {
      case 4: return propose_with<4>(base, h, end);
      case 6: return propose_with<6>(base, h, end);
      case 8: return propose_with<8>(base, h, end);
      default: return propose_with<0>(base, h, end);
    }
  }
  template <int known_intervals>
  [[gnu::noinline, gnu::flatten]] void propose_with(std::size_t base, const L& h, State& end);
  template <int known_intervals, bool renews>
  [[gnu::noinline, gnu::flatten]] void propose_in_one_piece(std::size_t base, const L& h, State& end, Matrix& whole);
  [[gnu::noinline, gnu::flatten]] void correct(State end);
  [[gnu::noinline, gnu::flatten]] void correct_quasi_steady_current();
  [[gnu::noinline, gnu::flatten]] solver::Rates<System> relaxation(System system, std::size_t base,
                                                                   const L& force) const;
  L lag_left_out() const;
  L electrical_to_mechanical_time() const;
  void visit_node(const System& system, std::size_t node, const L& force, solver::Rates<System>& rates) {
    if (every_law_) return visit_node_of<true>(system, node, force, rates);
    visit_node_of<false>(system, node, force, rates);
  }
  template <bool every_law>
  [[gnu::noinline, gnu::flatten]] void visit_node_of(const System& system, std::size_t node, const L& force,
                                                     solver::Rates<System>& rates);
  [[gnu::noinline]] void linearise(const System& system, std::size_t node, const L& force, solver::Rates<System>& rates,
                                   Matrix& jacobian) const;
  using NodeRates = std::array<solver::Rates<System>, nodes_per_segment>;  ///< at a segment's nodes
  [[gnu::noinline, gnu::flatten]] void add_tails(const NodeRates& rates, std::size_t base, const L& h);
  [[gnu::always_inline]] inline Observable<L> observable(const System& system, const Configuration<L>& configuration,
                                                         const State& y, const Motion<L>& m, const State& dy,
                                                         Quantity quantity) const;
  [[gnu::noinline, gnu::flatten]] void follow(const L& segment, SegmentTrajectory<L, N>& trajectory) const;
  [[gnu::noinline, gnu::flatten]] Observable<L> observable_inside(Quantity quantity,
                                                                  const SegmentTrajectory<L, N>& trajectory,
                                                                  const L& x) const;
  template <class Visit>
  void for_each_subinterval(int half, Quantity quantity, const L& floor, const Visit& visit) const;
  static void keep(const PeakBracket<L>& from, const Mask& where, PeakBracket<L>& to);
  static L estimate_peak(PeakBracket<L>& b);
  [[gnu::noinline, gnu::flatten]] L refine(Quantity quantity, const L& sign, PeakBracket<L> b);
  [[gnu::noinline, gnu::flatten]] L error_inside(Quantity quantity, const SegmentTrajectory<L, N>& trajectory,
                                                 const L& x, const L& value) const;
  void refresh(Quantity quantity);
  [[gnu::noinline, gnu::flatten]] L peak(Quantity quantity);
  [[gnu::noinline, gnu::flatten]] L exchanged_energy();
  [[gnu::noinline, gnu::flatten]] L floquet_multiplier();
  [[gnu::noinline, gnu::flatten]] Matrix over_segment(const Matrix* jacobian, const L& h) const;
  [[gnu::noinline]] void lag_with(System system, std::size_t node, const L& by, const L& force,
                                  solver::Rates<System>& below, solver::Rates<System>& above) const;
  template <class RatesAt>
  Matrix derivatives(const State& y, const State& rates, const RatesAt& rates_at) const;
  [[gnu::noinline]] Matrix jacobian_at(const System& system, const Configuration<L>& configuration, const State& y,
                                       const State& rates, const L& force) const;
  [[gnu::noinline]] Matrix jacobian_at_node(System system, std::size_t node, const L& force) const;
  static Mask is_stiff(const Matrix& jacobian, const L& h);
  [[gnu::noinline, gnu::flatten]] static void find_rates(const System& system, const Configuration<L>& configuration,
                                                         const State& y, State& rates, L& force) {
    const typename System::Accelerations a = system.accelerations(configuration, y);
    force = a.force_switch;
    rates = system.slope(a, inverse_of(y[0]));
  }
  template <class Rates>
  [[gnu::noinline]] State implicit_step(const State& y, const L& h, const Matrix& jacobian, const Rates& rates) const;
  static void propagator(const Matrix& jacobian, const L& h, Matrix& out);
  static void append(const Matrix& step, Matrix& product);
  void keep_settled(const Matrix& from, Matrix& to) const {
    for (std::size_t row = 0; row < N; ++row) {
      for (std::size_t n = 0; n < N; ++n) to[row][n] = select<L>(settled_, to[row][n], from[row][n]);
    }
  }
  /// Whether disturbances last longer than the widest interval of a segment; else propagator() is no more than stable.
  Mask resolves(std::size_t base) const {
    const Matrix& step = step_[base + std::size_t(rule_.intervals / 2)];
    Mask resolved = step[0][0] > L(0.4);
    if constexpr (N == 2) resolved = resolved && step[1][1] > L(0.4);
    return resolved;
  }
  static L largest_modulus(const Matrix& M);
  void close_iterate(State& off) const;
  /// Without springs the first guess is as good as what a coarse iterate would make of it.
  int coarse_iterates() const {
    const bool guessed_well = settings_.approach == PackApproach::guess && !any<L>(vehicle_.spring.stiffness > L(0.0));
    return guessed_well ? settings_.coarse_iterates - 1 : settings_.coarse_iterates;
  }

  [[gnu::noinline, gnu::flatten]] static void find_configuration(const System& system, const L& u,
                                                                 Configuration<L>& configuration) {
    configuration = system.configuration(u);
  }
  // One function for all who place nodes: a lane that stays has the bits of one whose neighbours move.
  [[gnu::noinline, gnu::flatten]] static void find_node(const System& system, const L& u, const L& h, const L& x,
                                                        Configuration<L>& configuration) {
    configuration = system.configuration(u + x * h);
  }
  /// Segments that meet share the place of their common node.
  const Configuration<L>& configuration_of(std::size_t node) const {
    return configurations_[node > 0 && node % std::size_t(rule_.intervals + 1) == 0 && node != first_node(1, 0)
                               ? node - 1
                               : node];
  }
  std::size_t first_node(int half, std::size_t segment) const {
    return (std::size_t(half * segments_) + segment) * std::size_t(rule_.intervals + 1);
  }

  const L& reach(int half) const { return mechanism_.reach[std::size_t(half)]; }

  const Vehicle<L>& vehicle_;
  const LaneMechanism<L>& mechanism_;
  const PackSettings& settings_;
  const solver::CollocationRule& rule_;
  int segments_;  ///< of half an iterate
  L per_inductance_, per_resistance_, current_scale_, no_load_, floor_;
  Matrix monodromy_;  ///< of an iterate
  std::array<std::array<Configuration<L>, coarse_samples>, 2> table_;
  State y_;         ///< where an iterate starts
  bool every_law_;  ///< HalfCycle::has_every_law
  bool adds_mass_;  ///< of the air
  bool has_knots_;  ///< in a table of force coefficients or of the stroke
  Mask unresolved_, locked_, in_doubt_;
  Mask settled_;  ///< on the trajectory that the last iteration will start from
  Mask lost_;     ///< the crank comes near standstill on the way to the orbit
  std::array<ForceSwitches<L>, 2> switches_{};
  std::array<HalfMesh<L>, 2> mesh_;

  /// Where a segment starts as march() leaves it.
  struct Subinterval {
    State y, rates;
    Mask stiff;  ///< beyond which the rates at either end say little of what is in between
  };
  std::array<Subinterval, 2 * max_half_segments + 1> subintervals_;
  // At the nodes, segment after segment; where segments meet there is one for either.
  std::array<Configuration<L>, max_nodes> configurations_;
  std::array<State, max_nodes> trajectory_, rates_, correction_;
  std::array<L, max_nodes> force_;
  std::array<L, 2 * max_half_segments>
      off_;                             ///< of each segment's start from the sign change before it [rad], 0 without
  std::array<Matrix, max_nodes> step_;  ///< derivative of the state by that at the node before, or, where segments
                                        ///< are solved in one piece, at the segment's start
  std::array<std::array<Observable<L>, max_nodes>, quantity_count> observables_;

  L compliance_;  ///< of all springs, half of it: their energy per square of their moment [1/(N m)]; 0 without
  std::array<L, pack_integrals.size()> integrals_;
  std::array<L, 5> high_, low_;  ///< sums of the last and last but two coefficients of what limits the error
  std::array<bool, quantity_count> wanted_;
  // Where coefficients or a gearbox have kinks within a half: their switches, as those of the rod force.
  bool kinks_, loses_in_gear_;
  std::array<ForceSwitches<L>, 2> kink_switches_{};
  std::array<L, max_nodes> margin_;  ///< HalfCycle::kink_margin_at() the nodes [rad or N m]
  // The current behind the speed, where the inductance is small.
  bool lags_;
  std::array<L, max_nodes> inductive_drop_;  ///< HalfCycle::inductive_drop at the nodes
  L lag_residual_;                           ///< its last change, of the voltage
  L layer_;                                  ///< largest relaxation() of the speed, relative

  bool in_one_piece_;                       ///< SegmentEquations instead of steps from node to node
  std::array<Matrix, max_nodes> jacobian_;  ///< of the rates, for those
  L slowest_, residual_ = L(0.0);
  L max_move_;                  ///< by Newton's last correction, of all nodes: the speed [rad/s]
  L lift_opposed_;              ///< what the lift's integral is smaller by than that of its magnitude, relative to it
  L switch_error_;              ///< of segments that end off the rod force's sign changes
  L step_error_, speed_error_;  ///< of what the segments' polynomials leave out: at all, and of speed and time
  L overlooked_;  ///< depth to which the rod force has the wrong sign inside a segment, of its largest magnitude
  L peak_error_;
  L error_estimate_;
};

/// Derivatives by the state of the rates, which rates_at(state) gives, to six digits.
template <class L, int N>
template <class RatesAt>
auto PackOrbit<L, N>::derivatives(const State& y, const State& rates, const RatesAt& rates_at) const -> Matrix {
  Matrix jacobian;
  for (std::size_t n = 0; n < N; ++n) {
    State moved = y;
    const L by = n == 0 ? L(1e-7) * y[0] : L(1e-7) * current_scale_;
    moved[n] = moved[n] + by;
    const State there = rates_at(moved);
    const L per_move = inverse_of(by);
    for (std::size_t row = 0; row < N; ++row) jacobian[row][n] = (there[row] - rates[row]) * per_move;
  }
  return jacobian;
}

template <class L, int N>
auto PackOrbit<L, N>::jacobian_at(const System& system, const Configuration<L>& configuration, const State& y,
                                  const State& rates, const L& force) const -> Matrix {
  solver::Rates<System> moved_rates;
  return derivatives(y, rates, [&](const State& moved) -> const State& {
    evaluate<false>(system, configuration, moved, force, moved_rates);
    return moved_rates.dy;
  });
}

/// Newton's method up to its last iteration. A lane stays where it is once its next correction is expected to be small:
/// as much smaller than the last one as that was than the one before. What others still need does not move it.
template <class L, int N>
void PackOrbit<L, N>::iterate() {
  settled_ = L(1.0) < L(0.0);
  for (int n = 0; n < settings_.newton_iterations; ++n) {
    const L before = residual_;
    // Where the equations are stiff, the first trajectory is a poor one.
    if (n == 0 || settings_.implicit) {
      newton_iteration<Newton::first>();
    } else {
      newton_iteration<Newton::middle>();
    }
    if (settings_.follow_switches && n == 1) follow_switches();
    if (lags_ || n < (settings_.follow_switches ? 2 : 1)) continue;
    const L gain = min(L(residual_ * inverse_of(max(before, L(1e-300)))), L(1.0));
    settled_ = settled_ || unresolved_ || locked_ || in_doubt_ || gain * residual_ <= L(settings_.settled);
    if (all<L>(settled_)) break;
  }
  settled_ = L(1.0) < L(0.0);
}

template <class L, int N>
Metrics<L> PackOrbit<L, N>::solve(const L& mass, const L& bench_torque_constant) {
  lost_ = in_doubt_ = L(1.0) < L(0.0);
  if (settings_.approach == PackApproach::resume) {
    unresolved_ = locked_ = lost_;
  } else {
    tabulate();
    assess_statics();
    const L balances = guess_speed();
    if (settings_.approach == PackApproach::guess) {
      unresolved_ = unresolved_ || !(balances == L(1.0));
    } else {
      // A heavy rotor is far from any orbit after the few turns simulated: they do not show which of several it
      // reaches.
      start_from_rest();
      unresolved_ = unresolved_ || balances > L(1.0);
    }
    for (int n = 1; n < coarse_iterates(); ++n) coarse_iterate<false>();
    coarse_iterate<true>();
  }
  march();
  place_nodes();
  if (lags_) inductive_drop_.fill(L(0.0));
  iterate();
  newton_iteration<Newton::last>();

  // What is not integrated here leaves its metrics absent.
  CycleIntegrals<L> integrals;
  integrals.fill(L(absent));
  const auto total = [&](Integral which) -> L& { return integrals[std::size_t(which)]; };
  for (std::size_t q = 0; q < pack_integrals.size(); ++q) total(pack_integrals[q]) = integrals_[q];
  total(Integral::electrical_work) =
      vehicle_.voltage * total(Integral::current) - vehicle_.source_resistance * total(Integral::current_square);
  total(Integral::travel) = L(two_pi);
  total(Integral::motor_work) =
      total(Integral::friction_work) + total(Integral::aero_work) + total(Integral::residual_work);
  const auto is_wanted = [&](Quantity q) { return wanted_[std::size_t(q)]; };
  peak_error_ = L(0.0);
  CycleExtremes<L> extremes;
  extremes.fill(L(0.0));
  const auto seek = [&](Quantity quantity, Extreme extreme) {
    if (is_wanted(quantity)) extremes[std::size_t(extreme)] = peak(quantity);
  };
  seek(Quantity::velocity, Extreme::flapping_velocity);
  if (settings_.velocity_aside) {
    peak_error_ = L(0.0);
  } else if (is_wanted(Quantity::velocity)) {
    extremes[std::size_t(Extreme::lift)] =
        lift_peak_up_to(vehicle_.wings, extremes[std::size_t(Extreme::flapping_velocity)]);
  }
  if (is_wanted(Quantity::energy)) total(Integral::reactive_work) = exchanged_energy();
  seek(Quantity::current, Extreme::current);
  seek(Quantity::force, Extreme::rod_force);
  if (kinks_ && is_wanted(Quantity::force)) {
    peak_error_ = max(peak_error_, error_of_peak_on_kink(extremes[std::size_t(Extreme::rod_force)]));
  }
  seek(Quantity::negated_speed, Extreme::crank_speed_min);
  seek(Quantity::speed, Extreme::crank_speed_max);
  const L multiplier = settings_.multipliers ? floquet_multiplier() : L(0.0);

  // Integrals belong to the trajectory before the last correction: powers change with up to the third power of the
  // speed, and their ratios with the fifth.
  const L of_correction = L(5.0) * residual_;
  error_estimate_ =
      L(1.5) * (step_error_ + of_correction + peak_error_) + switch_error_ + overlooked_ * sqrt(overlooked_);
  error_estimate_ = error_estimate_ + lift_opposed_ * (switch_error_ + L(1.5) * of_correction);
  // A motor near its speed without load draws the small difference of two large voltages.
  const L back_emf = L(two_pi) * vehicle_.motor.torque_constant;
  const L resistive = circuit_resistance(vehicle_) * abs(integrals_[pack_integral(Integral::current)]);
  const L difference = max(L(back_emf * inverse_of(max(resistive, L(1e-300))) - L(1.0)), L(0.0));
  error_estimate_ = error_estimate_ + L(1.5) * difference * (speed_error_ + L(2.0) * residual_);
  if (lags_) error_estimate_ = error_estimate_ + L(1.5) * (difference + L(2.0)) * lag_residual_ + lag_left_out();
  lost_ = lost_ || !(slowest_ > floor_);
  if (settings_.approach == PackApproach::guess) unresolved_ = unresolved_ || lost_;
  unresolved_ = unresolved_ || (!lost_ && hardly_returns(vehicle_, largest_modulus(monodromy_), total(Integral::time)));
  error_estimate_ = select<L>(lost_, L(std::numeric_limits<double>::infinity()), error_estimate_);
  return cycle_metrics(vehicle_, integrals, extremes, multiplier, ReportingOf<L>{mass, bench_torque_constant});
}

}  // namespace wingbeat
