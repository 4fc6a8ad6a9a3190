#include "wingbeat/study/flight_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

#include "wingbeat/core/math.hpp"
#include "wingbeat/flight/stability.hpp"

namespace wingbeat {
namespace {

using Complex = std::complex<double>;

/// The oscillation and the two subsidences of three modes; absent where they are of other kinds.
struct HoverModes {
  double doubling_time = absent, period = absent, fast_half_life = absent, slow_half_life = absent;

  explicit HoverModes(const std::vector<Complex>& modes) {
    std::vector<double> subsidences;
    for (const Complex& s : modes) {
      if (s.imag() == 0.0) {
        subsidences.push_back(-FlightMode::doubling_time(s));
        continue;
      }
      doubling_time = FlightMode::doubling_time(s);
      period = FlightMode::period(s);
    }
    if (subsidences.size() != 2) return;
    fast_half_life = std::min(subsidences[0], subsidences[1]);
    slow_half_life = std::max(subsidences[0], subsidences[1]);
  }

  double operator[](FlightNumber which) const {
    switch (which) {
      case FlightNumber::oscillation_doubling_time: return doubling_time;
      case FlightNumber::oscillation_period: return period;
      case FlightNumber::fast_half_life: return fast_half_life;
      case FlightNumber::slow_half_life: return slow_half_life;
      default: return absent;
    }
  }
};

FlightControls stated_controls(const FlightVehicle& vehicle) {
  FlightControls controls;
  controls[FlightControl::voltage] = vehicle.stated_voltage;
  return controls;
}

/// \f$-\partial N / \partial r\f$ of the mean moment about z.
double yaw_damping(AveragedFlight& flight) {
  const FlightControls controls = stated_controls(flight.vehicle());
  const std::optional<MeanFlight> at_rest = flight.at(controls, {});
  if (!at_rest) return absent;
  const double step = 1e-3 * two_pi / at_rest->cycles[0].period;
  SteadyMotion turns;
  turns.rates[2] = step;
  const std::optional<MeanFlight> right = flight.at(controls, turns);
  turns.rates[2] = -step;
  const std::optional<MeanFlight> left = flight.at(controls, turns);
  if (!right || !left) return absent;
  return (left->loads.moment[2] - right->loads.moment[2]) / (2.0 * step);
}

bool is_of_trim(FlightNumber which) {
  return which == FlightNumber::trim_voltage || which == FlightNumber::trim_frequency;
}

}  // namespace

const char* unit_of(FlightNumber number) {
  switch (number) {
    case FlightNumber::trim_voltage: return "V";
    case FlightNumber::trim_frequency: return "Hz";
    case FlightNumber::yaw_damping: return "N m s";
    default: return "s";
  }
}

double load_of(const BodyLoads& loads, FlightLoad which) {
  switch (which) {
    case FlightLoad::lift: return -loads.force[2];
    case FlightLoad::roll_moment: return loads.moment[0];
    case FlightLoad::pitch_moment: return loads.moment[1];
    case FlightLoad::yaw_moment: return loads.moment[2];
  }
  return absent;
}

FlightNumbers flight_numbers(const FlightVehicle& vehicle, const std::vector<FlightNumber>& numbers) {
  FlightNumbers found{std::vector<double>(numbers.size(), absent), std::vector<double>(numbers.size(), absent)};
  AveragedFlight flight(vehicle);
  std::optional<TrimResult> steady;
  if (std::any_of(numbers.begin(), numbers.end(), [](FlightNumber n) { return is_of_trim(n) || is_of_modes(n); })) {
    steady = trim(flight, {});
    if (!steady->flies()) steady.reset();
  }
  std::vector<Complex> averaged, floquet;
  if (steady && std::any_of(numbers.begin(), numbers.end(), is_of_modes)) {
    for (const FlightMode& mode : flight_stability(flight, *steady).modes) {
      if (!mode.longitudinal) continue;
      if (mode.averaged) averaged.push_back(*mode.averaged);
      if (mode.floquet) floquet.push_back(*mode.floquet);
    }
  }
  const HoverModes by_means(averaged), by_floquet(floquet);
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    const FlightNumber which = numbers[n];
    if (which == FlightNumber::yaw_damping) found.averaged[n] = yaw_damping(flight);
    else if (which == FlightNumber::trim_voltage && steady)
      found.averaged[n] = steady->controls[FlightControl::voltage];
    else if (which == FlightNumber::trim_frequency && steady) found.averaged[n] = steady->frequency;
    else if (is_of_modes(which)) found.averaged[n] = by_means[which], found.floquet[n] = by_floquet[which];
  }
  return found;
}

std::vector<double> load_over_control(const FlightVehicle& vehicle, FlightControl control,
                                      const std::vector<double>& settings, FlightLoad load) {
  // Near kinks of hinges and stops cycles repeat no closer. Each is looked for from the last one, on either side.
  AveragedFlight flight(vehicle, {.tolerance = 1e-7});
  const auto loads_at = [&](double way) {
    flight.at(stated_controls(vehicle), {});
    std::vector<double> loads;
    for (const double setting : settings) {
      FlightControls controls = stated_controls(vehicle);
      controls[control] = way * setting;
      const std::optional<MeanFlight> mean = flight.at(controls, {});
      loads.push_back(mean ? load_of(mean->loads, load) : absent);
    }
    return loads;
  };
  std::vector<double> loads = loads_at(1.0);
  if (control == FlightControl::voltage) return loads;
  const std::vector<double> opposite = loads_at(-1.0);
  for (std::size_t n = 0; n < loads.size(); ++n) loads[n] = 0.5 * (loads[n] - opposite[n]);
  return loads;
}

}  // namespace wingbeat
