#include "wingbeat/cycle/record.hpp"

#include <algorithm>
#include <utility>

#include "wingbeat/cycle/recorded_cycle.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

/// `phase_rate` receives d theta / dt [rad/s].
template <class Recorded>
WaveformRow row_inside(const Recorded& recorded, const solver::Step<decltype(Recorded::system)>& step,
                       double start_time, double theta, double& phase_rate) {
  const auto& system = recorded.system;
  const auto result = solver::evaluate_inside<true>(system, recorded.cycle, step, theta);
  const Motion<double> m = system.motion(theta, result.y, step.signs);
  phase_rate = system.phase_rate(result.y);
  double pitch_angle = absent;
  if constexpr (decltype(Recorded::system)::on_hinges) {
    if (pitches(system.vehicle)) pitch_angle = system.local_pitch(result.y);
  }
  return waveform_row(system.vehicle, m, start_time + result.dq[std::size_t(Integral::time)],
                      system.shaft_angle(theta, result.y), system.shaft_speed(result.y),
                      system.stroke_angle(m, result.y), pitch_angle);
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
    double phase_rate;
    return row_inside(recorded, step, time, theta, phase_rate);
  });
}

namespace {

/// The row of a step at a time since the cycle's start, by Newton, and its crank angle; the step starts at
/// `start_time`.
template <class Recorded>
std::pair<WaveformRow, double> row_at_time(const Recorded& recorded, std::size_t n, double start_time, double time,
                                           double period) {
  const auto& step = recorded.cycle.steps[n];
  double phase_rate = recorded.system.phase_rate(step.y);
  double theta = step.x + std::min(step.h, (time - start_time) * phase_rate);
  WaveformRow row = row_inside(recorded, step, start_time, theta, phase_rate);
  for (int iteration = 0; iteration < 20 && std::abs(row.time - time) > 1e-14 * period; ++iteration) {
    theta = std::clamp(theta + (time - row.time) * phase_rate, step.x, step.x + step.h);
    row = row_inside(recorded, step, start_time, theta, phase_rate);
  }
  return {row, theta};
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
    return row_at_time(recorded, n, start_time, time, period()).second;
  });
}

std::vector<WaveformRow> CycleRecord::waveform(int count) const {
  return visit(*this, [&](const auto& recorded) {
    std::vector<WaveformRow> rows;
    rows.reserve(std::size_t(count));
    const double period_time = period();
    std::size_t n = 0;
    double start_time = 0.0;
    for (int k = 0; k < count; ++k) {
      const double time = period_time * k / (count - 1);
      advance(recorded.cycle.steps, time, n, start_time);
      rows.push_back(row_at_time(recorded, n, start_time, time, period_time).first);
    }
    return rows;
  });
}

}  // namespace wingbeat
