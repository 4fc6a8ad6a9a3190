#include "wingbeat/ensemble/ensemble.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "ensemble/ensemble_run.hpp"
#include "ensemble/plan.hpp"
#include "wingbeat/core/cancellation.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/cycle/thermal_equilibrium.hpp"
#include "wingbeat/ensemble/direct_pack_blocks.hpp"
#include "wingbeat/ensemble/lane_mechanism.hpp"
#include "wingbeat/ensemble/lane_statics.hpp"
#include "wingbeat/ensemble/pack_blocks.hpp"
#include "wingbeat/ensemble/pack_tables.hpp"
#include "wingbeat/solve/collocation.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

struct PackSolver {
  decltype(&solve_block_base) solve;
  decltype(&solve_direct_block_base) solve_direct;
  int lanes;
};

PackSolver solver_for(InstructionSet isa) {
  switch (isa) {
#ifdef WINGBEAT_HAS_WIDE_LANES
    case InstructionSet::avx2: return {solve_block_avx2, solve_direct_block_avx2, lanes_avx2};
    case InstructionSet::avx512: return {solve_block_avx512, solve_direct_block_avx512, lanes_avx512};
#endif
    default: return {solve_block_base, solve_direct_block_base, lanes_base};
  }
}

/// Whether the batched solver knows all of a vehicle.
bool suits_packs(const Vehicle<double>& v) {
  if (pitches(v) || is_of_further_kind(v) || claps(v.wings.clap) || is_given(v.wings.tabulated)) return false;
  if (has_flow(v.wings)) return false;
  // Strips in the wake meet a table's start or a stop at an angle of attack each.
  if (has_wake(v.wings) && (v.wings.coefficients.table || has_pitch_stop(v.wings))) return false;
  if (v.load_torque != 0.0 || v.voltage_offset != 0.0 || v.electronics.efficiency != 1.0) return false;
  if (v.spring.rest_angle != 0.0) return false;
  if (v.transmission.type != TransmissionType::direct) {
    // Of two kinds of kinks beside those of the rod force lanes know one at a time.
    const bool kinks = v.wings.coefficients.table || has_pitch_stop(v.wings);
    return lanes_know_coefficients(v) && !(kinks && has_gear_loss(v.motor)) && has_half_turns(v.transmission);
  }
  // Where constant friction holds a shaft that swings, the equations jump; where coefficients have kinks, their slopes
  // jump.
  return !jumps_at_rest(v) && !v.wings.coefficients.table && !has_pitch_stop(v.wings) && !acts_by_strips(v.wings);
}

/// Whether a crank can jam, or lock where the angles that lanes look at do not show it: statics tell it of any angle.
bool needs_start_up(const Vehicle<double>& v) {
  constexpr double inertia_margin = 0.05, lever_margin = 0.02;  // as PackOrbit holds back of cranks from rest
  if (!(v.wing_inertia > 0.0)) return false;
  const bool locks_seen = lanes_see_locks(v) || certainly_advances(v);
  if (locks_seen && certainly_unique(v)) return false;
  const StaticBalance statics = static_balance(v);
  return statics.inertia_min <= inertia_margin * v.motor.inertia ||
         statics.lever_min <= lever_margin * typical_lever(v.transmission) || (!locks_seen && statics.can_lock());
}

/// Of the rates, beside those at sign changes of the rod force. Linkages' shorter waves ask for as much as few do.
enum class Kinks { none, few, knots };

/// What the cranks of a block have in common.
struct PackKind {
  bool stiff;
  TransmissionType transmission;
  Kinks kinks;
  bool gear_loss, load_free_friction, pitch_stop;
  bool added_mass, virtual_work, springs, strips;
  PackCurrent current;

  auto operator<=>(const PackKind&) const = default;
};

/// Whether current or speed settle within a part of a coarse step at the speed without load, so that explicit steps
/// there would be unstable.
bool is_stiff(const Vehicle<double>& v, PackCurrent current) {
  constexpr double coarse_step = pi / 8.0, stable = 1.8;
  const double R = circuit_resistance(v), K = v.motor.torque_constant, no_load = no_load_speed(v);
  const double inertia = v.motor.inertia + 0.5 * v.wing_count * v.wing_inertia;
  const double braking = (K * K / R + v.motor.viscous_damping) / inertia;
  return (current == PackCurrent::state && R * coarse_step > stable * v.motor.armature_inductance * no_load) ||
         braking * coarse_step > stable * no_load;
}

/// Whether balanced_speed() seeks on a fine grid, about.
bool pitches_far(const Vehicle<double>& v) {
  return v.wings.pitch_coefficient * typical_stroke_slope(v.transmission) * no_load_speed(v) > far_pitch;
}

/// The settings of an attempt for a kind. Stiff designs take at once what others take after a start from rest, and
/// begin again with more points. Where coefficients have kinks, segments have more places to end at, and the rod force
/// may peak there; at a table's knots means converge with the fourth power of the nodes.
PackSettings settings_for(const PackKind& kind, PackSettings settings) {
  settings.current = kind.current;
  settings.in_one_piece = kind.stiff;
  if (kind.stiff && settings.approach == PackApproach::guess) {
    settings.implicit = true;
    settings.newton_iterations += 1;
    settings.segments = max_half_segments;
  } else if (kind.stiff && settings.approach == PackApproach::resume) {
    settings.segments = max_half_segments;
    settings.intervals = std::min(settings.intervals + 2, solver::max_collocation_intervals);
  }
  // A rough first trajectory misses the sign changes that the attempt before has found.
  if (kind.stiff && settings.approach == PackApproach::resume) settings.follow_switches = true;
  settings.follow_switches = settings.follow_switches || kind.gear_loss ||
                             (kind.kinks != Kinks::none && settings.wanted[std::size_t(Quantity::force)]);
  if (kind.kinks == Kinks::few) {
    settings.segments = std::min(settings.segments + 2, max_half_segments);
  } else if (kind.kinks == Kinks::knots) {
    settings.segments = max_half_segments;
    const int more = settings.approach == PackApproach::resume ? 6 : 2;
    settings.intervals = std::min(settings.intervals + more, solver::max_collocation_intervals);
  }
  return settings;
}

/// One run of members through the solvers.
class EnsembleRun {
 public:
  EnsembleRun(std::span<const EnsembleMember> members, const EnsembleOptions& options, const StartUp& start_up,
              std::span<EnsembleOutcome> outcomes)
      : members_(members),
        options_(options),
        start_up_(start_up),
        outcomes_(outcomes),
        plan_(plan_for(options)),
        solver_(solver_for(options.isa)),
        starts_(new IterateStart[members.size()]),  // not cleared
        rotates_(members.size()) {}

  /// Solves the members that `takes(vehicle)` says are to be, their motors as they are.
  template <class Takes>
  void solve(const Takes& takes) {
    std::map<PackKind, std::vector<std::size_t>> by_kind;
    std::array<std::vector<std::size_t>, direct_kinds> direct_by_kind;
    for (std::size_t n = 0; n < members_.size(); ++n) {
      const Vehicle<double>& v = members_[n].vehicle;
      if (!takes(v)) continue;
      const bool by_packs = !options_.scalar_only && has_packs && suits_packs(v);
      const bool stalls = stall_torque(v) <= breakaway_torque(v), rotates = drive_of(v).rotates;
      if (!by_packs || (!stalls && rotates && needs_start_up(v))) {
        solve_by_scalar(n);
      } else if (stalls) {
        settle(n, FlappingStatus::stalled);
      } else if (!rotates) {
        direct_by_kind[direct_kind_of(v)].push_back(n);
      } else {
        by_kind[kind_of(v)].push_back(n);
      }
    }
    for (auto& [kind, alike] : by_kind) {
      // A block in which one wing pitches far balances all loads on a fine grid.
      std::stable_partition(alike.begin(), alike.end(),
                            [&](std::size_t n) { return !pitches_far(members_[n].vehicle); });
      solve_alike(kind, alike);
    }
    for (const std::vector<std::size_t>& alike : direct_by_kind) solve_direct(alike);
  }

 private:
  PackKind kind_of(const Vehicle<double>& v) const {
    const PackCurrent current = current_of(v);
    const bool table = bool(v.wings.coefficients.table), stop = has_pitch_stop(v.wings);
    const bool of_linkage = v.transmission.type != TransmissionType::slider_crank, loses = has_gear_loss(v.motor);
    return {.stiff = is_stiff(v, current),
            .transmission = v.transmission.type,
            .kinks = table                         ? Kinks::knots
                     : stop || loses || of_linkage ? Kinks::few
                                                   : Kinks::none,
            .gear_loss = loses,
            .load_free_friction = load_free_friction(v.friction, 1.0, 1.0) > 0.0,
            .pitch_stop = stop,
            .added_mass = v.wings.added_inertia > 0.0,
            .virtual_work = v.transmission.slider_crank.formulation == Formulation::virtual_work,
            .springs = v.spring.stiffness > 0.0,
            .strips = acts_by_strips(v.wings),
            .current = current};
  }

  static constexpr std::size_t direct_kinds = 4;
  static std::size_t direct_kind_of(const Vehicle<double>& v) {
    return (v.wings.added_inertia > 0.0 ? 2 : 0) + (has_current_state(v) ? 1 : 0);
  }

  PackCurrent current_of(const Vehicle<double>& v) const {
    if (!has_current_state(v)) return PackCurrent::algebraic;
    return electrical_lag(v) < max_lag(options_.tolerance) ? PackCurrent::lagging : PackCurrent::state;
  }

  /// Few need more than the first attempt: all of a kind together fill the lanes of the others.
  void solve_alike(const PackKind& kind, const std::vector<std::size_t>& all) {
    std::vector<std::size_t> unresolved, inexact;
    run(all, settings_for(kind, plan_.first), unresolved, unresolved, inexact);
    std::vector<std::size_t> left;
    if (!kind.springs && !kind.stiff) {
      // A crank that creeps near stall is stiff, whatever it were at the speed without load.
      PackKind creeping = kind;
      creeping.stiff = true;
      std::vector<std::size_t> still_unresolved;
      run(unresolved, settings_for(creeping, plan_.first), still_unresolved, still_unresolved, inexact);
      unresolved.swap(still_unresolved);
    }
    // Without springs nothing brings a crank near standstill on its way but a load that hardly lets it start.
    for (std::size_t n = 0; n < (kind.springs ? plan_.from_rest.size() : 2); ++n) {
      std::vector<std::size_t> in_doubt;
      run(unresolved, settings_for(kind, plan_.from_rest[n]), in_doubt, left, inexact);
      unresolved.swap(in_doubt);
    }
    left.insert(left.end(), unresolved.begin(), unresolved.end());
    if (kind.current == PackCurrent::lagging) {
      // What the lag leaves out no finer mesh brings back.
      const auto lags_far = [&](std::size_t n) {
        return electrical_lag(members_[n].vehicle) >= 0.3 * max_lag(options_.tolerance);
      };
      const auto far =
          std::stable_partition(inexact.begin(), inexact.end(), [&](std::size_t n) { return !lags_far(n); });
      const std::vector<std::size_t> with_state(far, inexact.end());
      inexact.erase(far, inexact.end());
      for (const std::size_t n : with_state) {
        const Vehicle<double>& v = members_[n].vehicle;
        starts_[n].state[1] = algebraic_current(v, v.voltage, starts_[n].state[0]);
      }
      PackKind of_state = kind;
      of_state.current = PackCurrent::state;
      of_state.stiff = true;
      refine(of_state, with_state, left);
    }
    refine(kind, std::move(inexact), left);
    for (const std::size_t n : left) solve_by_scalar(n);
  }

  /// Goes on with inexact ones of a kind; lists in `left` those that stay so.
  void refine(const PackKind& kind, std::vector<std::size_t> inexact, std::vector<std::size_t>& left) {
    // Of the stiff ones that two meshes leave inexact, a third one hardly helps any.
    const std::size_t attempts = kind.stiff ? 2 : plan_.again.size();
    for (std::size_t k = 0; k < attempts; ++k) {
      std::vector<std::size_t> still_inexact;
      run(inexact, settings_for(kind, plan_.again[k]), left, left, still_inexact);
      inexact.swap(still_inexact);
    }
    left.insert(left.end(), inexact.begin(), inexact.end());
  }

  /// Direct drives of a kind. Where a finer mesh cannot help, the scalar solver does.
  void solve_direct(std::vector<std::size_t> open) {
    for (const DirectPackSettings& settings : plan_.direct) {
      std::vector<std::size_t> inexact;
      const auto begin = [](std::size_t, DirectPackResult&) {};
      run_blocks<DirectPackResult>(open, settings, solver_.solve_direct, begin,
                                   [&](std::size_t n, const DirectPackResult& r) {
                                     if (r.error_estimate <= options_.tolerance && balances(r.metrics)) {
                                       accept(n, r.metrics, r.error_estimate);
                                     } else if (std::isfinite(r.error_estimate)) {
                                       inexact.push_back(n);
                                     } else {
                                       solve_by_scalar(n);
                                     }
                                   });
      open.swap(inexact);
    }
    for (const std::size_t n : open) solve_by_scalar(n);
  }

  /// Those members, as many at a time as there are lanes, through the solver: begin(n, result) before, end(n, result)
  /// while the result is still in the processor's cache.
  template <class Result, class Settings, class Solve, class Begin, class End>
  void run_blocks(const std::vector<std::size_t>& which, const Settings& settings, Solve solve, const Begin& begin,
                  const End& end) const {
    std::array<const EnsembleMember*, lanes_avx512> members;
    std::array<Result, lanes_avx512> results;
    std::array<Result*, lanes_avx512> of_members;
    for (std::size_t start = 0; start < which.size(); start += std::size_t(solver_.lanes)) {
      check_cancellation();
      const std::size_t count = std::min(which.size() - start, std::size_t(solver_.lanes));
      for (std::size_t lane = 0; lane < count; ++lane) {
        members[lane] = &members_[which[start + lane]];
        of_members[lane] = &results[lane];
        begin(which[start + lane], results[lane]);
      }
      for (std::size_t next = start + count; next < std::min(start + 2 * count, which.size()); ++next) {
        prefetch(members_[which[next]]);
      }
      solve(members.data(), int(count), settings, of_members.data());
      for (std::size_t lane = 0; lane < count; ++lane) end(which[start + lane], results[lane]);
    }
  }

  static void prefetch(const EnsembleMember& member) {
    const char* const from = reinterpret_cast<const char*>(&member);
    for (std::size_t byte = 0; byte < sizeof(member); byte += 64) __builtin_prefetch(from + byte, 0, 2);
  }

  /// Solves those members; settles the outcomes of the exact ones, and lists the others.
  void run(const std::vector<std::size_t>& which, const PackSettings& settings, std::vector<std::size_t>& in_doubt,
           std::vector<std::size_t>& unresolved, std::vector<std::size_t>& inexact) {
    const auto begin = [&](std::size_t n, PackResult& r) {
      if (settings.approach == PackApproach::resume) r.start = starts_[n];
    };
    run_blocks<PackResult>(which, settings, solver_.solve, begin, [&](std::size_t n, const PackResult& r) {
      if (settings.approach == PackApproach::from_rest) rotates_[n] = r.assessment == PackAssessment::rotates;
      if (r.assessment == PackAssessment::locked) {
        settle(n, FlappingStatus::locked);
      } else if (r.assessment == PackAssessment::in_doubt) {
        in_doubt.push_back(n);
      } else if (r.assessment == PackAssessment::unresolved) {
        unresolved.push_back(n);
      } else if (!(r.error_estimate <= options_.tolerance) || !balances(r.metrics)) {
        starts_[n] = r.start;
        inexact.push_back(n);
      } else {
        accept(n, r.metrics, r.error_estimate);
      }
    });
  }

  bool balances(const Metrics<double>& metrics) const { return closes(energy_audit(metrics), options_.tolerance); }

  void accept(std::size_t n, const Metrics<double>& metrics, double error_estimate) {
    outcomes_[n] = {FlappingStatus::flapping, false, error_estimate, metrics, domain(n, metrics)};
    keep_wanted(options_.metrics, outcomes_[n].metrics);
  }

  DomainStatus domain(std::size_t n, const Metrics<double>& metrics) const {
    return options_.domain ? domain_of(members_[n].vehicle, metrics) : DomainStatus();
  }

  void settle(std::size_t n, FlappingStatus without_flapping) {
    outcomes_[n] = {without_flapping, false, absent, {}};
    outcomes_[n].metrics.values.fill(absent);
  }

  /// The scalar solver's estimate is too low at a table's kinks and near stall.
  double scalar_tolerance(const Vehicle<double>& v) const {
    const bool hard = v.wings.coefficients.table || breakaway_torque(v) > 0.4 * stall_torque(v);
    return options_.tolerance * (hard && !options_.scalar_only ? 0.1 : 1.0);
  }

  /// Whether it rotates from rest is known, and that its orbit is the only one.
  bool start_up_is_known(std::size_t n) const {
    const Vehicle<double>& v = members_[n].vehicle;
    return rotates_[n] && !static_balance(v).can_jam() && balanced_speed(v).count == 1.0;
  }

  void solve_by_scalar(std::size_t n) {
    SteadyOptions steady;
    steady.tolerance = scalar_tolerance(members_[n].vehicle);
    steady.stability = options_.metrics[std::size_t(Metric::floquet_multiplier_max)];
    steady.reporting = members_[n].reporting;
    const StartUp known = [](const Vehicle<double>&, const Arrival&) { return StartUpOutcome{}; };
    SteadyFlapping found;
    if (start_up_is_known(n)) found = detail::find_flapping_as_it_is(members_[n].vehicle, steady, known);
    if (found.status != FlappingStatus::flapping) {
      found = detail::find_flapping_as_it_is(members_[n].vehicle, steady, start_up_);
    }
    const bool flaps = found.status == FlappingStatus::flapping;
    outcomes_[n] = {found.status, true, flaps ? found.summary.error_estimate : absent, found.metrics,
                    flaps ? domain(n, found.metrics) : DomainStatus()};
    if (found.simulated) outcomes_[n].error_estimate = found.simulated->error_estimate;
    keep_wanted(options_.metrics, outcomes_[n].metrics);
  }

  std::span<const EnsembleMember> members_;
  const EnsembleOptions& options_;
  const StartUp& start_up_;
  std::span<EnsembleOutcome> outcomes_;
  Plan plan_;
  PackSolver solver_;
  std::unique_ptr<IterateStart[]> starts_;  ///< of inexact members
  std::vector<char> rotates_;               ///< from rest, as lanes have shown in time
};

}  // namespace

void keep_wanted(const MetricSet& wanted, Metrics<double>& metrics) {
  for (std::size_t m = 0; m < std::size_t(metric_count); ++m) {
    if (!wanted[m]) metrics.values[m] = absent;
  }
}

bool is_available(InstructionSet isa) {
  switch (isa) {
    case InstructionSet::base: return true;
#ifdef WINGBEAT_HAS_WIDE_LANES
    case InstructionSet::avx2: return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512vl");
#endif
    default: return false;
  }
}

InstructionSet best_instruction_set() {
  InstructionSet best = InstructionSet::base;
  for (const auto& [name, isa] : instruction_sets) {
    if (is_available(isa)) best = isa;
  }
  return best;
}

void run_ensemble(std::span<const EnsembleMember> members, const EnsembleOptions& options, const StartUp& start_up,
                  std::span<EnsembleOutcome> outcomes, bool (*takes)(const Vehicle<double>&)) {
  EnsembleRun(members, options, start_up, outcomes).solve(takes);
}

}  // namespace wingbeat
