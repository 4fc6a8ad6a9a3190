// What every src/ensemble/instruction_sets/pack_blocks_*.cpp compiles for its instruction set.
#pragma once

#include <type_traits>

#include "wingbeat/ensemble/block_vehicle.hpp"
#include "wingbeat/ensemble/pack_blocks.hpp"
#include "wingbeat/ensemble/pack_kinks.hpp"
#include "wingbeat/ensemble/pack_lag.hpp"
#include "wingbeat/ensemble/pack_mesh.hpp"
#include "wingbeat/ensemble/pack_multiplier.hpp"
#include "wingbeat/ensemble/pack_newton.hpp"
#include "wingbeat/ensemble/pack_orbit.hpp"
#include "wingbeat/ensemble/pack_peaks.hpp"
#include "wingbeat/ensemble/pack_start.hpp"
#include "wingbeat/ensemble/pack_tables.hpp"

namespace wingbeat {

/// The body of solve_block_*() for one instruction set. No containers: what this leaves behind must belong to the
/// instruction set alone.
template <class L>
void solve_block(const EnsembleMember* const* members, int count, const PackSettings& settings,
                 PackResult* const* results) {
  alignas(64) double numbers[std::size_t(L::lanes)];
  // The block is filled up with its last member.
  const auto member = [&](int lane) -> const EnsembleMember& { return *members[lane < count ? lane : count - 1]; };
  const auto gather = [&](const auto& number_of) {
    for (int lane = 0; lane < L::lanes; ++lane) numbers[lane] = number_of(member(lane));
    return L::load(numbers);
  };
  const auto with_states = [&](auto states) {
    constexpr int N = decltype(states)::value;
    BlockVehicle<L> block([&](int lane) -> const Vehicle<double>& { return member(lane).vehicle; });
    Vehicle<L>& vehicle = block.vehicle;
    const Vehicle<double>& first = member(0).vehicle;
    LaneTables<L>& tables = vehicle.wings.coefficients.table;
    tables.from_tables = bool(first.wings.coefficients.table);
    tables.kinks = tables.from_tables || has_pitch_stop(first.wings);
    if (tables.kinks) tables.kink = gather([](const EnsembleMember& m) { return kink_of_coefficients(m.vehicle); });
    if (tables.from_tables) {
      const auto table_of = [](const EnsembleMember& m) { return m.vehicle.wings.coefficients.table->lookup(); };
      for (int lane = 0; lane < L::lanes; ++lane) tables.lookup[lane] = table_of(member(lane));
      tables.front = gather([&](const EnsembleMember& m) { return table_of(m).front; });
      tables.steps_per_angle = gather([&](const EnsembleMember& m) { return table_of(m).steps_per_angle; });
      tables.last_step = gather([&](const EnsembleMember& m) { return double(table_of(m).steps - 1); });
    }
    LaneMechanism<L> mechanism(vehicle.transmission);
    if (!mechanism.is_slider_crank) {
      HalfTurns turns[std::size_t(L::lanes)];
      for (int lane = 0; lane < L::lanes; ++lane) turns[lane] = half_turns(member(lane).vehicle.transmission);
      const auto of_turns = [&](const auto& number_of) {
        for (int lane = 0; lane < L::lanes; ++lane) numbers[lane] = number_of(turns[lane]);
        return L::load(numbers);
      };
      for (std::size_t half = 0; half < 2; ++half) {
        mechanism.middle[half] = of_turns([half](const HalfTurns& h) { return h.middle[half]; });
        mechanism.reach[half] = of_turns([half](const HalfTurns& h) { return h.reach[half]; });
      }
      LaneCurves<L>& curves = vehicle.transmission.tabulated.curve;
      for (int lane = 0; lane < L::lanes; ++lane) curves.of_lane[lane] = turns[lane].curve;
      curves.start = of_turns([](const HalfTurns& h) { return h.curve_start; });
      curves.amplitude = of_turns([](const HalfTurns& h) { return h.curve_amplitude; });
    }
    PackOrbit<L, N> orbit(vehicle, mechanism, settings);
    if (settings.approach == PackApproach::resume) {
      orbit.visit_start([&](L& to, const auto& read) {
        for (int lane = 0; lane < L::lanes; ++lane)
          numbers[lane] = read(results[lane < count ? lane : count - 1]->start);
        to = L::load(numbers);
      });
    }
    const Metrics<L> found =
        orbit.solve(gather([](const EnsembleMember& m) { return m.reporting.mass; }),
                    gather([](const EnsembleMember& m) { return m.reporting.bench_torque_constant; }));
    const auto scatter = [&](const L& from, const auto& to) {
      from.store(numbers);
      for (int lane = 0; lane < count; ++lane) to(*results[lane]) = numbers[lane];
    };
    for (std::size_t m = 0; m < std::size_t(metric_count); ++m) {
      scatter(found.values[m], [m](PackResult& r) -> double& { return r.metrics.values[m]; });
    }
    scatter(orbit.error_estimate(), [](PackResult& r) -> double& { return r.error_estimate; });
    L assessment = L(double(PackAssessment::rotates));
    const auto assess = [&](const Mask<L>& where, PackAssessment as) {
      assessment = select<L>(where, L(double(as)), assessment);
    };
    assess(orbit.in_doubt(), PackAssessment::in_doubt);
    assess(orbit.unresolved(), PackAssessment::unresolved);
    assess(orbit.locked(), PackAssessment::locked);
    assessment.store(numbers);
    for (int lane = 0; lane < count; ++lane) results[lane]->assessment = PackAssessment(int(numbers[lane]));
    orbit.visit_start(
        [&](L& from, const auto& to) { scatter(from, [&](PackResult& r) -> double& { return to(r.start); }); });
  };
  if (settings.current == PackCurrent::state) {
    with_states(std::integral_constant<int, 2>{});
  } else {
    with_states(std::integral_constant<int, 1>{});
  }
}

}  // namespace wingbeat
