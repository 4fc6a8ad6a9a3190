#include "wingbeat/cycle/record.hpp"

#include <algorithm>

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
  if constexpr (requires { Recorded::system.pitch; }) pitch_angle = result.y[system.pitch];
  return waveform_row(system.vehicle, m, start_time + result.dq[std::size_t(Integral::time)],
                      system.shaft_angle(theta, result.y), system.shaft_speed(result.y),
                      system.stroke_angle(m, result.y), pitch_angle);
}

}  // namespace

WaveformRow waveform_row(const Vehicle<double>& v, const Motion<double>& m, double time, double shaft_angle,
                         double shaft_speed, double stroke_angle, double pitch_angle) {
  const double spring_moment = v.wing_count * spring_loads(v.spring, stroke_angle).moment;
  WaveformRow row;
  row.time = time;
  row.crank_angle = shaft_angle;
  row.crank_speed = shaft_speed;
  row.current = m.current;
  row.stroke_angle = stroke_angle;
  row.flapping_velocity = m.stroke_velocity;
  row.angle_of_attack_deg = degrees_per_radian * m.aero.angle_of_attack;
  row.lift = m.aero.lift;
  row.aero_moment = m.aero.moment;
  row.rod_force = drive_of(v).has_rod ? m.rod_force / v.motors : absent;
  row.motor_torque = m.motor_torque;
  row.friction_torque = m.friction_torque;
  row.voltage = m.voltage;
  row.power_electrical = m.voltage * m.current;
  row.power_motor = m.motor_torque * shaft_speed;
  row.power_friction = m.friction_torque * shaft_speed;
  row.power_aerodynamic = m.aero.power;
  row.spring_moment = spring_moment;
  row.inertial_moment = v.wing_count * v.wing_inertia * m.stroke_acceleration;
  row.pitch_angle = pitch_angle;
  return row;
}

bool CycleRecord::empty() const {
  return std::visit([](const auto& recorded) { return recorded.cycle.steps.empty(); }, cycles_);
}

CycleIntegrals<double> CycleRecord::integrals() const {
  return std::visit([](const auto& recorded) { return cycle_integrals(recorded.cycle); }, cycles_);
}

double CycleRecord::period() const { return integrals()[std::size_t(Integral::time)]; }

WaveformRow CycleRecord::at(double theta) const {
  return std::visit(
      [&](const auto& recorded) {
        double time = 0.0;
        const auto& step = solver::step_at(recorded.cycle, theta);
        for (const auto* before = recorded.cycle.steps.data(); before != &step; ++before) {
          time += before->dq[std::size_t(Integral::time)];
        }
        double phase_rate;
        return row_inside(recorded, step, time, theta, phase_rate);
      },
      cycles_);
}

std::vector<WaveformRow> CycleRecord::waveform(int count) const {
  return std::visit(
      [&](const auto& recorded) {
        std::vector<WaveformRow> rows;
        rows.reserve(std::size_t(count));
        const double period_time = period();
        std::size_t n = 0;
        double start_time = 0.0;
        const auto& steps = recorded.cycle.steps;
        for (int k = 0; k < count; ++k) {
          const double time = period_time * k / (count - 1);
          while (n + 1 < steps.size() && start_time + steps[n].dq[std::size_t(Integral::time)] <= time) {
            start_time += steps[n].dq[std::size_t(Integral::time)];
            ++n;
          }
          // Newton for the crank angle at this time.
          double phase_rate = recorded.system.phase_rate(steps[n].y);
          double theta = steps[n].x + std::min(steps[n].h, (time - start_time) * phase_rate);
          WaveformRow row = row_inside(recorded, steps[n], start_time, theta, phase_rate);
          for (int iteration = 0; iteration < 20 && std::abs(row.time - time) > 1e-14 * period_time; ++iteration) {
            theta = std::clamp(theta + (time - row.time) * phase_rate, steps[n].x, steps[n].x + steps[n].h);
            row = row_inside(recorded, steps[n], start_time, theta, phase_rate);
          }
          rows.push_back(row);
        }
        return rows;
      },
      cycles_);
}

}  // namespace wingbeat
