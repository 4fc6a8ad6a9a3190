// What every src/ensemble/instruction_sets/pack_blocks_*.cpp compiles of direct drives for its instruction set.
#pragma once

#include "wingbeat/ensemble/block_vehicle.hpp"
#include "wingbeat/ensemble/direct_pack_balance.hpp"
#include "wingbeat/ensemble/direct_pack_blocks.hpp"
#include "wingbeat/ensemble/direct_pack_metrics.hpp"
#include "wingbeat/ensemble/direct_pack_newton.hpp"
#include "wingbeat/ensemble/direct_pack_orbit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// The body of solve_direct_block_*() for one instruction set. No containers: what this leaves behind must belong to
/// the instruction set alone.
template <class L, int N>
void solve_direct_block_of(const EnsembleMember* const* members, int count, const DirectPackSettings& settings,
                           DirectPackResult* const* results) {
  alignas(64) double numbers[std::size_t(L::lanes)];
  // The block is filled up with its last member.
  const auto member = [&](int lane) -> const EnsembleMember& { return *members[lane < count ? lane : count - 1]; };
  const auto gather = [&](const auto& number_of) {
    for (int lane = 0; lane < L::lanes; ++lane) numbers[lane] = number_of(member(lane));
    return L::load(numbers);
  };
  const auto scatter = [&](const L& from, const auto& to) {
    from.store(numbers);
    for (int lane = 0; lane < count; ++lane) to(*results[lane], numbers[lane]);
  };
  const BlockVehicle<L> block([&](int lane) -> const Vehicle<double>& { return member(lane).vehicle; });
  DirectPackOrbit<L, N> orbit(block.vehicle, settings);
  const Metrics<L> found =
      orbit.solve(gather([](const EnsembleMember& m) { return m.reporting.mass; }),
                  gather([](const EnsembleMember& m) { return m.reporting.bench_torque_constant; }));
  for (std::size_t m = 0; m < std::size_t(metric_count); ++m) {
    scatter(found.values[m], [m](DirectPackResult& r, double x) { r.metrics.values[m] = x; });
  }
  scatter(orbit.error_estimate(), [](DirectPackResult& r, double x) { r.error_estimate = x; });
}

template <class L>
void solve_direct_block(const EnsembleMember* const* members, int count, const DirectPackSettings& settings,
                        DirectPackResult* const* results) {
  if (has_current_state(members[0]->vehicle)) {
    solve_direct_block_of<L, 3>(members, count, settings, results);
  } else {
    solve_direct_block_of<L, 2>(members, count, settings, results);
  }
}

}  // namespace wingbeat
