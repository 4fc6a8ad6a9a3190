#include "wingbeat/cycle/record.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "wingbeat/cycle/recorded_cycle.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

/// A place on a recorded cycle.
template <class System>
struct Place {
  double theta;  ///< crank angle; of a direct drive the phase of the supply [rad]
  double time;   ///< since the cycle's start [s]
  typename System::State y;
};

/// The place at theta in a step that begins at `start_time`.
template <class Recorded, class System = decltype(Recorded::system)>
Place<System> place_inside(const Recorded& recorded, const solver::Step<System>& step, double start_time,
                           double theta) {
  const auto result = solver::evaluate_inside<true>(recorded.system, recorded.cycle, step, theta);
  return {theta, start_time + result.dq[std::size_t(Integral::time)], result.y};
}

template <class System>
WaveformRow row_of(const System& system, const Place<System>& place, const typename System::Signs& signs) {
  const Motion<double> m = system.motion(place.theta, place.y, signs);
  double pitch_angle = absent;
  if constexpr (System::on_hinges) {
    if (pitches(system.vehicle)) pitch_angle = system.local_pitch(place.y);
  }
  return waveform_row(system.vehicle, m, place.time, system.shaft_angle(place.theta, place.y),
                      system.shaft_speed(place.y), system.stroke_angle(m, place.y), pitch_angle);
}

}  // namespace

CycleRecord::CycleRecord(Recorded recorded) : recorded_(std::make_shared<const Recorded>(std::move(recorded))) {}

const CycleRecord::Recorded& CycleRecord::recorded() const {
  static const Recorded none{};
  return recorded_ ? *recorded_ : none;
}

bool CycleRecord::empty() const {
  return visit(*this, [](const auto& recorded) { return recorded.cycle.steps.empty(); });
}

const Vehicle<double>& CycleRecord::vehicle() const {
  return visit(*this, [](const auto& recorded) -> const Vehicle<double>& { return recorded.system.vehicle; });
}

CycleIntegrals<double> CycleRecord::integrals() const {
  return visit(*this, [](const auto& recorded) { return cycle_integrals(recorded.cycle); });
}

double CycleRecord::period() const { return integrals()[std::size_t(Integral::time)]; }

WaveformRow CycleRecord::at(double theta) const {
  return visit(*this, [&](const auto& recorded) {
    double time = 0.0;
    const auto& step = solver::step_at(recorded.cycle, theta);
    for (const auto* before = recorded.cycle.steps.data(); before != &step; ++before) {
      time += before->dq[std::size_t(Integral::time)];
    }
    return row_of(recorded.system, place_inside(recorded, step, time, theta), step.signs);
  });
}

namespace {

/// Moves a place on a crank's cycle by a short `time`, in which the crank turns by the angle `by`, with one step of
/// fourth order. False, nothing changed, where a rate changes so much meanwhile that the step would have an error.
template <class System>
bool move_by_time(const System& system, const typename System::Signs& signs, const solver::Rates<System>& rates,
                  double time, double by, Place<System>& place) {
  Place<System> moved{place.theta + by, place.time + time, place.y};
  auto configuration = solver::configuration_at(system, place.theta);
  if (!solver::move_a_little<false>(system, place.theta, by, signs, rates, moved.y, configuration)) return false;
  const auto after = system.template rates<false>(configuration, moved.y, signs);
  const typename System::State scale = system.error_scale(moved.y);
  for (std::size_t n = 0; n < scale.size(); ++n) {
    if (!(std::abs(by * (after.dy[n] - rates.dy[n])) < 1e-8 * scale[n])) return false;
  }
  place = moved;
  return true;
}

/// The place at a time since the cycle's start in step n, which begins at `start_time`. From `near`, a place in the
/// step, by the angle of a crank in the time t left, to second order:
/// omega t + omega omega' t^2 / 2 = omega t (1 + (d omega / d theta) t / 2).
template <class Recorded, class System = decltype(Recorded::system)>
Place<System> place_at_time(const Recorded& recorded, std::size_t n, double start_time, double time, double period,
                            const Place<System>& near) {
  const System& system = recorded.system;
  const auto& step = recorded.cycle.steps[n];
  Place<System> place = near;
  for (int iteration = 0; iteration < 20 && std::abs(time - place.time) > 1e-14 * period; ++iteration) {
    const double left = time - place.time;
    double by = system.phase_rate(place.y) * left;
    if constexpr (System::turns) {
      const auto rates =
          system.template rates<false>(solver::configuration_at(system, place.theta), place.y, step.signs);
      by *= 1.0 + 0.5 * rates.dy[0] * left;
      const bool is_short = iteration > 0 && std::abs(left) < 1e-6 * period;
      if (is_short && move_by_time(system, step.signs, rates, left, by, place)) break;
    }
    place = place_inside(recorded, step, start_time, std::clamp(place.theta + by, step.x, step.x + step.h));
  }
  return place;
}

/// Moves n and its start time on to the step in which `time` lies.
template <class Steps>
void advance(const Steps& steps, double time, std::size_t& n, double& start_time) {
  while (n + 1 < steps.size() && start_time + steps[n].dq[std::size_t(Integral::time)] <= time) {
    start_time += steps[n].dq[std::size_t(Integral::time)];
    ++n;
  }
}

}  // namespace

double CycleRecord::phase_at(double time) const {
  return visit(*this, [&](const auto& recorded) {
    std::size_t n = 0;
    double start_time = 0.0;
    advance(recorded.cycle.steps, time, n, start_time);
    const auto& step = recorded.cycle.steps[n];
    return place_at_time(recorded, n, start_time, time, period(), {step.x, start_time, step.y}).theta;
  });
}

std::vector<WaveformRow> CycleRecord::waveform(int count) const {
  return visit(*this, [&](const auto& recorded) {
    using System = std::remove_cvref_t<decltype(recorded.system)>;
    const auto& steps = recorded.cycle.steps;
    std::vector<WaveformRow> rows;
    rows.reserve(std::size_t(count));
    const double period_time = period();
    std::size_t n = 0, before = 0;
    double start_time = 0.0;
    Place<System> place{steps[0].x, 0.0, steps[0].y};
    for (int k = 0; k < count; ++k) {
      const double time = period_time * k / (count - 1);
      advance(steps, time, n, start_time);
      if (std::exchange(before, n) != n) place = {steps[n].x, start_time, steps[n].y};
      place = place_at_time(recorded, n, start_time, time, period_time, place);
      rows.push_back(row_of(recorded.system, place, steps[n].signs));
    }
    return rows;
  });
}

}  // namespace wingbeat
