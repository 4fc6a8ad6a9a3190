// The batched orbit solver behind plain numbers: one function for each instruction set, none of whose types show.
#pragma once

#include <array>

#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/ensemble/instruction_set.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

inline constexpr int max_half_segments = 12;  ///< of half an iterate
inline constexpr int max_force_switches = 3;  ///< sign changes of the rod force within half an iterate

/// A quantity of which extremes are sought.
enum class Quantity { velocity, current, negated_speed, speed, force, energy };
inline constexpr int quantity_count = 6;

/// Where an iterate begins: near the orbit, at the lower dead centre.
struct IterateStart {
  std::array<double, 2> state;  ///< omega [rad/s], i [A]
  /// Of either half cycle [rad]: of the rod force, then of the pitch margin.
  std::array<std::array<double, max_force_switches>, 4> switch_at;
  std::array<double, 4> switch_count, first_sign;
  std::array<double, 4> monodromy;  ///< of an iterate, to a few per cent
};

enum class PackApproach {
  guess,      ///< from the speed at which the motor balances the mean load
  from_rest,  ///< from rest, in time: what happens there is no longer in doubt
  resume      ///< from the IterateStart that an earlier attempt left
};

/// What the inductance of a block's motors makes of the current.
enum class PackCurrent {
  algebraic,  ///< none
  lagging,    ///< small: the current follows the speed within a fraction of a segment
  state
};

struct PackSettings {
  PackApproach approach = PackApproach::guess;
  int start_up_steps = 48;   ///< from rest: of a turn at the speed without load
  int start_up_cycles = 24;  ///< at most, at that speed
  PackCurrent current = PackCurrent::state;
  int coarse_iterates = 2;
  bool implicit =
      false;  ///< where explicit steps would be unstable, iterates before the collocation take implicit ones
  bool in_one_piece = false;     ///< Newton's method solves a segment's equations as a whole
  int segments = 6;              ///< of half an iterate
  int intervals = 6;             ///< between the nodes of a segment, even
  int newton_iterations = 2;     ///< at most, before the last
  double settled = 1e-7;         ///< fewer where the next correction is expected below, relative
  bool follow_switches = false;  ///< the segments' ends move onto the sign changes after the second one
  double peak_tolerance = 5e-7;  ///< a peak is settled when the cubic at its top promises less, relative
  std::array<bool, quantity_count> wanted{};
  bool velocity_aside = false;  ///< the peak velocity is wanted for the domain alone: no metric, no part in the error
  bool multipliers = false;
};

enum class PackAssessment {
  rotates,
  in_doubt,    ///< from rest it comes near standstill: finer steps must tell
  unresolved,  ///< may lock, stall, jam or have several orbits, or is beyond this solver's means
  locked       ///< from rest it has come to a stop, in time, where it stays
};

struct PackResult {
  Metrics<double> metrics;
  double error_estimate;  ///< of the cycle's means, relative
  PackAssessment assessment;
  IterateStart start;
};

/// Solves `count` members, at most lanes_* of them, alike in formulation, in whether they have springs, coefficient
/// tables and stops of the pitching, in whether they count the added mass, and in what their inductance makes of the
/// current. A member's result does not depend on the others.
void solve_block_base(const EnsembleMember* const* members, int count, const PackSettings& settings,
                      PackResult* const* results);
#ifdef WINGBEAT_HAS_WIDE_LANES
void solve_block_avx2(const EnsembleMember* const* members, int count, const PackSettings& settings,
                      PackResult* const* results);
void solve_block_avx512(const EnsembleMember* const* members, int count, const PackSettings& settings,
                        PackResult* const* results);
#endif

inline constexpr int lanes_base = 4, lanes_avx2 = 8, lanes_avx512 = 16;

}  // namespace wingbeat
