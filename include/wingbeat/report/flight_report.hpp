// Trim and stability as text and JSON, and drawn.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "wingbeat/flight/stability.hpp"
#include "wingbeat/flight/trim.hpp"
#include "wingbeat/report/plot.hpp"

namespace wingbeat {

/// Steady flights of one vehicle.
struct TrimReport {
  std::string vehicle;
  std::vector<TrimResult> flights;
  double battery_energy = absent;  ///< that flights can take from the battery [J]; absent without one
};

/// Energy that a battery gives from its charge until it is empty, through no resistance [J].
double usable_energy(const Battery<double>& battery);

std::string text_trim(const FlightVehicle& vehicle, const TrimReport& report);
std::string json_trim(const TrimReport& report);
/// Power, attitude, voltage and, with a battery, endurance and range over the speed. Throws like plot_cycle.
void plot_trim(const FlightVehicle& vehicle, const TrimReport& report, PlotFormat format,
               const std::filesystem::path& file);

struct StabilityReport {
  std::string vehicle;
  StabilityResult result;
  std::vector<ModeSensitivity> sensitivities;
};

std::string text_stability(const StabilityReport& report);
std::string json_stability(const StabilityReport& report);
/// The modes in the complex plane, by averaging and by Floquet theory. Throws like plot_cycle.
void plot_stability(const StabilityReport& report, PlotFormat format, const std::filesystem::path& file);

}  // namespace wingbeat
