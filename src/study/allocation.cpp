#include "wingbeat/study/allocation.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "wingbeat/time/simulation.hpp"

namespace wingbeat {
namespace {

/// Cycle means of half of the wings, as those of the right side.
struct SideMeans {
  double lift = absent;
  double lift_sideways = absent;  ///< lift times d + r cos beta [N m]
  double lift_forward = absent;   ///< lift times r sin beta [N m]
  double yaw = absent;            ///< of the drag [N m]
  double frequency = absent;      ///< [Hz]
};

class Sides {
 public:
  Sides(const Linearisation& at, Condition condition, double hinge_offset)
      : vehicle_(resolve(at.operating_point.design, condition)),
        reporting_(reporting_of(at.operating_point.design)),
        hinge_offset_(hinge_offset),
        orbit_(at.orbit) {
    const double s2 = vehicle_.wings.s2;
    centre_ = s2 > 0.0 ? vehicle_.wings.s3 / s2 : 0.0;
  }

  const Vehicle<double>& vehicle() const { return vehicle_; }

  /// In steady flapping at that voltage or amplitude [V].
  SideMeans steady(double voltage) {
    const auto known = known_.find(voltage);
    if (known != known_.end()) return known->second;
    SideMeans means;
    Vehicle<double> there = vehicle_;
    there.voltage = voltage;
    const SteadyFlapping found = find_steady_flapping(there, {1e-8, false, reporting_}, start_up_in_time());
    if (found.status == FlappingStatus::flapping && !found.record.empty()) {
      means = mean_of(found.record.waveform(instants + 1));
    }
    known_[voltage] = means;
    return means;
  }

  /// Of a direct drive at the operating point's amplitude and frequency, the wave changed.
  SideMeans under(double bias, double split) const {
    const double period = 1.0 / vehicle_.drive_frequency, amplitude = vehicle_.voltage;
    const double mean = 2.0 / pi * amplitude * split;  // of the two halves of different length
    const auto wave = [=](double t) {
      const double part = t / period - std::floor(t / period), first = 0.5 * (1.0 + split);
      const double phase = part < first ? pi * part / first : pi * (1.0 + (part - first) / (1.0 - first));
      return amplitude * std::sin(phase) - mean + bias;
    };
    const std::vector<WaveformRow> start = {orbit_.record.at(0.0)};
    SimulationOptions options;
    options.tolerance = 1e-9;
    options.angle = start[0].stroke_angle;
    options.speed = start[0].flapping_velocity;
    options.current = start[0].current;
    if (pitches(vehicle_)) options.pitch_angle = start[0].pitch_angle;
    Simulation flight(warm(), {}, options);
    flight.command(wave);
    SideMeans means, before;
    for (int cycle = 0; cycle < max_cycles; ++cycle) {
      std::vector<WaveformRow> rows = {flight.now()};
      for (int n = 1; n <= simulated_instants; ++n) {
        flight.step_to((cycle + double(n) / simulated_instants) * period);
        rows.push_back(flight.now());
      }
      before = means;
      means = mean_of(rows);
      const double scale = settled * (means.lift * centre_);
      if (std::abs(means.lift_forward - before.lift_forward) < scale &&
          std::abs(means.lift_sideways - before.lift_sideways) < scale && std::abs(means.yaw - before.yaw) < scale) {
        return means;
      }
    }
    return {};  // it drifts away, as without springs under a bias
  }

 private:
  static constexpr int instants = 2000, simulated_instants = 500, max_cycles = 2000;
  static constexpr double settled = 1e-7;  ///< change of a mean from cycle to cycle, of lift times lever

  /// The vehicle with its motor at the operating point's temperatures.
  Vehicle<double> warm() const {
    return heats_up(vehicle_.thermal) ? with_motor_at(vehicle_, orbit_.temperatures) : vehicle_;
  }

  /// Of rows at even distances in time, both ends of the cycle included.
  SideMeans mean_of(const std::vector<WaveformRow>& rows) const {
    SideMeans sum{0.0, 0.0, 0.0, 0.0, 1.0 / (rows.back().time - rows.front().time)};
    for (std::size_t n = 0; n < rows.size(); ++n) {
      const WaveformRow& row = rows[n];
      const double weight = (n == 0 || n + 1 == rows.size() ? 0.25 : 0.5) / double(rows.size() - 1);  // of one side
      const double sideways = centre_ * std::cos(row.stroke_angle);
      sum.lift += weight * row.lift;
      sum.lift_sideways += weight * row.lift * (hinge_offset_ + sideways);
      sum.lift_forward += weight * row.lift * centre_ * std::sin(row.stroke_angle);
      // The drag M_aero / r acts against beta' at p = (0, d, 0) + r e_r.
      sum.yaw +=
          weight * row.aero_moment * (centre_ + hinge_offset_ * std::cos(row.stroke_angle)) / std::max(centre_, 1e-300);
    }
    return sum;
  }

  Vehicle<double> vehicle_;
  Reporting reporting_;
  double hinge_offset_, centre_;
  const SteadyFlapping& orbit_;
  std::map<double, SideMeans> known_;
};

AllocationPoint both(double input, const SideMeans& right, const SideMeans& left) {
  return {input,
          right.lift + left.lift,
          left.lift_sideways - right.lift_sideways,
          right.lift_forward + left.lift_forward,
          right.yaw - left.yaw,
          left.frequency};
}

AllocationPoint at_input(Sides& sides, AllocationInput which, double input) {
  const double voltage = sides.vehicle().voltage;
  switch (which) {
    case AllocationInput::voltage: return both(input, sides.steady(input), sides.steady(input));
    case AllocationInput::differential_voltage:
      return both(input, sides.steady(voltage - 0.5 * input), sides.steady(voltage + 0.5 * input));
    case AllocationInput::bias_voltage: {
      const SideMeans side = sides.under(input, 0.0);
      return both(input, side, side);
    }
    case AllocationInput::split_cycle: return both(input, sides.under(0.0, input), sides.under(0.0, -input));
  }
  return {};
}

}  // namespace

std::vector<AllocationMap> allocation_maps(const Linearisation& at, Condition condition, double hinge_offset) {
  std::vector<AllocationMap> maps;
  if (!at.model) return maps;
  Sides sides(at, condition, hinge_offset);
  const double voltage = sides.vehicle().voltage;
  const bool direct = drive_of(sides.vehicle()).alternating, two = sides.vehicle().motors == 2.0;
  const auto add = [&](AllocationInput which, double from, double to, int count, double centre, double step) {
    AllocationMap map{which, {}, {}};
    for (int n = 0; n < count; ++n) {
      map.points.push_back(at_input(sides, which, from + (to - from) * double(n) / double(count - 1)));
    }
    const AllocationPoint low = at_input(sides, which, centre - step), high = at_input(sides, which, centre + step);
    const auto slope = [&](double AllocationPoint::* member) {
      return (high.*member - low.*member) / (high.input - low.input);
    };
    map.slope = {centre,
                 slope(&AllocationPoint::lift),
                 slope(&AllocationPoint::roll),
                 slope(&AllocationPoint::pitch),
                 slope(&AllocationPoint::yaw),
                 slope(&AllocationPoint::frequency)};
    maps.push_back(std::move(map));
  };
  add(AllocationInput::voltage, 0.5 * voltage, 1.3 * voltage, 17, voltage, 1e-3 * voltage);
  if (two) add(AllocationInput::differential_voltage, -0.5 * voltage, 0.5 * voltage, 11, 0.0, 2e-3 * voltage);
  if (direct) add(AllocationInput::bias_voltage, -0.2 * voltage, 0.2 * voltage, 9, 0.0, 2e-3 * voltage);
  if (direct && two) add(AllocationInput::split_cycle, -0.3, 0.3, 7, 0.0, 2e-3);
  return maps;
}

}  // namespace wingbeat
