#include "wingbeat/study/flight_tolerance.hpp"

#include <cmath>

#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {
namespace {

constexpr FlightQuantity quantities[] = {
    {"voltage_v", "of the drives", [](const FlightSample& s) { return s.voltage; }},
    {"power_electrical_w", "mean, at the terminals of all drives", [](const FlightSample& s) { return s.power; }},
    {"frequency_hz", "of the first drive", [](const FlightSample& s) { return s.frequency; }},
    {"pitch_rad", "attitude, nose up", [](const FlightSample& s) { return s.pitch; }},
    {"longitudinal_growth_per_s", "real part of the least stable longitudinal mode, averaged flight",
     [](const FlightSample& s) { return s.longitudinal.real(); }},
    {"longitudinal_frequency_rad_per_s", "its imaginary part; 0 where it does not oscillate",
     [](const FlightSample& s) { return s.longitudinal.imag(); }},
    {"lateral_growth_per_s", "real part of the least stable lateral mode, averaged flight",
     [](const FlightSample& s) { return s.lateral.real(); }},
    {"lateral_frequency_rad_per_s", "its imaginary part; 0 where it does not oscillate",
     [](const FlightSample& s) { return s.lateral.imag(); }}};

FlightSample sample_of(const Design<double>& design, const FlightCondition& condition, const TrimResult* near,
                       TrimResult* found = nullptr) {
  FlightSample sample;
  AveragedFlight flight(flight_vehicle(design));
  const TrimResult steady = trim(flight, condition, {}, near);
  if (found) *found = steady;
  sample.status = steady.status;
  if (!steady.flies()) return sample;
  sample.voltage = steady.controls[FlightControl::voltage];
  sample.power = steady.power;
  sample.frequency = steady.frequency;
  sample.pitch = steady.pitch;
  for (const FlightMode& mode : averaged_modes(flight, steady)) {
    std::complex<double>& least = mode.longitudinal ? sample.longitudinal : sample.lateral;
    if (std::isnan(least.real())) least = *mode.averaged;
  }
  return sample;
}

}  // namespace

std::span<const FlightQuantity> flight_quantities() { return quantities; }

FlightToleranceResult flight_tolerance(const ToleranceStudy& study, const FlightCondition& condition,
                                       const ForEach& for_each, const std::function<void(double)>& progress) {
  if (study.hold) throw ParameterError("study.hold", "trim finds the voltage of each vehicle: leave it out");
  if (study.condition != Condition::air)
    throw ParameterError("study.condition", "must be air: the vehicles are to fly");
  ToleranceStudy plain = study;
  plain.indices = false;
  const Sweep sweep = tolerance_sweep(plain);
  FlightToleranceResult result;
  TrimResult centre;
  Design<double> at_means = study.design;
  for (const UncertainParameter& p : study.parameters) p.parameter.set(at_means, p.distribution.mean());
  result.centre = sample_of(at_means, condition, nullptr, &centre);
  result.centre_detail = centre.detail;

  result.samples.resize(std::size_t(sweep.size()));
  std::vector<std::function<void()>> tasks;
  for (std::size_t n = 0; n < result.samples.size(); ++n) {
    tasks.push_back([&, n] {
      const Design<double> design = design_at(sweep, n).design;
      try {
        validate(design);
        result.samples[n] = sample_of(design, condition, centre.flies() ? &centre : nullptr);
      } catch (const ParameterError&) {
        result.samples[n] = {};  // drawn beyond what a vehicle can be: it does not fly
      }
    });
  }
  run_tasks(tasks, for_each, progress);

  std::uint64_t fly = 0, beyond = 0, unstable = 0;
  for (const FlightSample& s : result.samples) {
    if (std::isnan(s.voltage)) continue;
    ++fly;
    beyond += s.status == TrimStatus::beyond_controls;
    unstable += s.unstable();
  }
  result.flies = probability_of(fly, result.samples.size());
  result.beyond_controls = probability_of(beyond, result.samples.size());
  if (fly > 0) result.unstable = probability_of(unstable, fly);
  for (const FlightQuantity& quantity : quantities) {
    std::vector<double> values;
    for (const FlightSample& s : result.samples) values.push_back(quantity.of(s));
    result.quantity.push_back({moments_of(values), quantity.of(result.centre)});
  }
  return result;
}

}  // namespace wingbeat
